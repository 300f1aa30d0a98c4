//! Names that the standard gives to the platform of this process.

/// Folder under `binaries/` for this platform: `linux64`, `win64`, `darwin64`, their 32-bit forms, or
/// `<architecture>-<system>` where FMI 2.0 has no name of its own.
pub const PLATFORM: &str = if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
    "linux64"
} else if cfg!(all(target_os = "linux", target_arch = "x86")) {
    "linux32"
} else if cfg!(all(target_os = "linux", target_arch = "aarch64")) {
    "aarch64-linux"
} else if cfg!(all(target_os = "windows", target_pointer_width = "64")) {
    "win64"
} else if cfg!(target_os = "windows") {
    "win32"
} else if cfg!(target_os = "macos") {
    "darwin64"
} else {
    "unknown"
};

/// Suffix of shared libraries on this platform, without the dot.
pub const LIBRARY_SUFFIX: &str = if cfg!(target_os = "windows") {
    "dll"
} else if cfg!(target_os = "macos") {
    "dylib"
} else {
    "so"
};
