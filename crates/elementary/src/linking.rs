//! The C library's functions by their own names, for what calls them by name: the solver's exponential cones, the tails of the
//! normal distribution.
//!
//! They are defined under the names that the linker looks for, hidden from everything outside of the library: a visible `exp`
//! would, on Linux, be seen by the host and taken for its own. On Linux and with MinGW the linker is told to send each call of
//! `exp` to `__wrap_exp`, since a name with a version of glibc must not be defined twice; [`tell_cargo`], called by the build
//! script of a shared library, tells it. Elsewhere a definition inside goes before the system's.

/// The function's name as the linker of this target knows it, and what hides it.
#[cfg(target_vendor = "apple")]
macro_rules! hidden {
    ($name:ident) => {
        concat!(
            ".globl _",
            stringify!($name),
            "\n.private_extern _",
            stringify!($name),
            "\n_",
            stringify!($name),
            ":"
        )
    };
}
#[cfg(target_env = "msvc")]
macro_rules! hidden {
    ($name:ident) => {
        concat!(".globl ", stringify!($name), "\n", stringify!($name), ":")
    };
}
// A library of Windows shows nothing that it is not told to.
#[cfg(all(windows, not(target_env = "msvc")))]
macro_rules! hidden {
    ($name:ident) => {
        concat!(".globl __wrap_", stringify!($name), "\n__wrap_", stringify!($name), ":")
    };
}
#[cfg(not(any(target_vendor = "apple", windows)))]
macro_rules! hidden {
    ($name:ident) => {
        concat!(
            ".globl __wrap_",
            stringify!($name),
            "\n.hidden __wrap_",
            stringify!($name),
            "\n__wrap_",
            stringify!($name),
            ":"
        )
    };
}

#[cfg(target_arch = "x86_64")]
macro_rules! jump {
    () => {
        "jmp {function}"
    };
}
#[cfg(target_arch = "aarch64")]
macro_rules! jump {
    () => {
        "b {function}"
    };
}

/// Defines the functions, and lists their names.
macro_rules! linked {
    ($($name:ident($($x:ident),+);)+) => {
        /// Names in the C library.
        pub const FUNCTIONS: &[&str] = &[$(stringify!($name)),+];

        // Assembly, since Rust exports every function whose name it is told. Each jumps to its like in Rust.
        #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
        #[allow(unsafe_code, reason = "names that a linker knows")]
        mod symbols {
            $(
                extern "C" fn $name($($x: f64),+) -> f64 {
                    libm::$name($($x),+)
                }
                // SAFETY: a jump to a C function of these arguments and this value, from where one is called.
                std::arch::global_asm!(".text", hidden!($name), jump!(), function = sym $name);
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
    let defined = ["x86_64", "aarch64"].contains(&target("ARCH").as_str());
    if !defined || target("VENDOR") == "apple" || target("ENV") == "msvc" {
        return;
    }
    for name in FUNCTIONS {
        println!("cargo:rustc-cdylib-link-arg=-Wl,--wrap={name}");
    }
}
