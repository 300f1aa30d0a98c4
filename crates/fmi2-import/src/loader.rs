//! Loading a shared library by its path, for whoever runs one that is an FMU's.
#![allow(unsafe_code, reason = "loading runs the initializers of a library")]

use std::path::Path;

use fmi2_abi::symbols::Symbol;
use libloading::Library;

/// Loads a library with all its symbols resolved at once: a missing one is an error here rather than an abort later.
///
/// # Safety
/// As [`Library::new`].
#[cfg(unix)]
pub unsafe fn open(file: &Path) -> Result<Library, libloading::Error> {
    use libloading::os::unix::{Library as Unix, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: passed on to the caller.
    unsafe { Unix::open(Some(file), RTLD_NOW | RTLD_LOCAL) }.map(Library::from)
}

/// Loads a library whose own dependencies may lie beside it.
///
/// # Safety
/// As [`Library::new`].
#[cfg(windows)]
pub unsafe fn open(file: &Path) -> Result<Library, libloading::Error> {
    use libloading::os::windows::{LOAD_WITH_ALTERED_SEARCH_PATH, Library as Windows};
    // SAFETY: passed on to the caller.
    unsafe { Windows::load_with_flags(file, LOAD_WITH_ALTERED_SEARCH_PATH) }.map(Library::from)
}

/// A function that an FMU exports, if it does.
///
/// # Safety
/// The library gives the function the type that the standard has for its name.
pub unsafe fn function<F: Copy>(library: &Library, symbol: &Symbol<F>) -> Option<F> {
    // SAFETY: as the caller vouches.
    unsafe { library.get::<F>(symbol.name) }.ok().map(|function| *function)
}

/// The loader's own words, which `libloading` keeps in the source of its error.
pub fn loader_text(error: &libloading::Error) -> String {
    std::error::Error::source(error).map_or_else(|| error.to_string(), ToString::to_string)
}

/// `path`, which must be absolute, as a `file:` URI.
pub fn file_uri(path: &Path) -> String {
    let text = path.to_string_lossy().replace('\\', "/");
    let mut uri = String::from(if text.starts_with('/') { "file://" } else { "file:///" });
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~:".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            uri.push_str(&format!("%{byte:02X}"));
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_uris_escape_what_uris_cannot_hold() {
        assert_eq!(file_uri(Path::new("/tmp/a b/ü%")), "file:///tmp/a%20b/%C3%BC%25");
    }
}
