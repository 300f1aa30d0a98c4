//! The C library's functions by their own names, for what calls them by name: the solver's exponential cones, the tails of the
//! normal distribution.
//!
//! A shared library that defined `exp` for itself would, on Linux, have it seen by the host and taken for the host's own. There
//! and with MinGW the linker is told to send each call of `exp` to `__wrap_exp` instead; [`tell_cargo`], called by the build
//! script of a shared library, tells it. The libraries of Apple's and Microsoft's linkers are bound to one another by name and
//! file, so there a definition of our own is taken inside and seen by nobody.

/// Defines the functions, and lists their names.
macro_rules! linked {
    ($($name:ident($($x:ident),+);)+) => {
        /// Names in the C library.
        pub const FUNCTIONS: &[&str] = &[$(stringify!($name)),+];

        #[allow(unsafe_code, reason = "names that a linker knows")]
        mod symbols {
            $(
                // SAFETY: the name is ours on Linux; elsewhere it is the C library's, whose function this is: same arguments, same value.
                #[cfg_attr(
                    any(target_vendor = "apple", target_env = "msvc"),
                    unsafe(export_name = stringify!($name))
                )]
                #[cfg_attr(
                    not(any(target_vendor = "apple", target_env = "msvc")),
                    unsafe(export_name = concat!("__wrap_", stringify!($name)))
                )]
                extern "C" fn $name($($x: f64),+) -> f64 {
                    libm::$name($($x),+)
                }
            )+
        }
    };
}

linked! {
    acos(x);
    acosh(x);
    asin(x);
    asinh(x);
    atan(x);
    atan2(y, x);
    atanh(x);
    cbrt(x);
    cos(x);
    cosh(x);
    exp(x);
    exp2(x);
    expm1(x);
    hypot(x, y);
    log(x);
    log10(x);
    log1p(x);
    log2(x);
    pow(x, y);
    sin(x);
    sinh(x);
    tan(x);
    tanh(x);
}

/// What the build script of a shared library does, so that no function of [`FUNCTIONS`] is the C library's in it.
#[allow(clippy::print_stdout, reason = "how a build script talks to cargo")]
pub fn tell_cargo() {
    let target = |name: &str| std::env::var(format!("CARGO_CFG_TARGET_{name}")).unwrap_or_default();
    if target("VENDOR") == "apple" || target("ENV") == "msvc" {
        return;
    }
    for name in FUNCTIONS {
        println!("cargo:rustc-cdylib-link-arg=-Wl,--wrap={name}");
    }
    // What comes out of the archives of other crates is not for the host: only the FMI functions, which are in the FMU's own crate.
    println!("cargo:rustc-cdylib-link-arg=-Wl,--exclude-libs=ALL");
}
