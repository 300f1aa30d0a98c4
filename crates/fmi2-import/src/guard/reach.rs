//! What a library can reach, by what it asks the loader for.
//!
//! One that imports nothing by which a folder or the locale is changed, a signal handler installed or another library opened, and
//! that takes all it imports from libraries of the system, changes none of these in a step by ordinary means; to look for it each
//! time would cost more than the step. Raw system calls are not counted: the standard library of Rust waits by one, and a library
//! that makes them to install a handler is seen in its first calls and when it is unloaded.

use object::{BinaryFormat, File, Import, Object};

/// Functions by which the folder, the locale or a signal's handler is changed, or what is looked up or opened may do so.
const BEYOND: [&str; 29] = [
    "chdir",
    "fchdir",
    "chroot",
    "daemon",
    "fts_open",
    "fts64_open",
    "fts_read",
    "fts64_read",
    "nftw",
    "nftw64",
    "setlocale",
    "signal",
    "sigaction",
    "__sigaction",
    "sigset",
    "sigignore",
    "sigvec",
    "siginterrupt",
    "bsd_signal",
    "ssignal",
    "sysv_signal",
    "__sysv_signal",
    "dlopen",
    "dlmopen",
    "dlsym",
    "dlvsym",
    "__libc_dlopen_mode",
    "__libc_dlsym",
    "__libc_dlvsym",
];

/// Libraries of the system that call none of these on their own.
const PLAIN: [&str; 8] = [
    "libc.so.6",
    "libm.so.6",
    "libgcc_s.so.1",
    "libpthread.so.0",
    "librt.so.1",
    "libdl.so.2",
    "ld-linux-x86-64.so.2",
    "ld-linux-aarch64.so.1",
];

/// Whether the library of these bytes can change folder, locale and handlers; yes where it is not known.
pub(crate) fn is_wide(library: &[u8]) -> bool {
    reaches_beyond(library).unwrap_or(true)
}

/// `None` where it cannot be read.
fn reaches_beyond(library: &[u8]) -> Option<bool> {
    let file = File::parse(library)
        .ok()
        .filter(|file| file.format() == BinaryFormat::Elf)?;
    let plain = |name: &[u8]| PLAIN.iter().any(|known| known.as_bytes() == name);
    let libraries = file.import_libraries().ok()?.collect::<Result<Vec<_>, _>>().ok()?;
    let functions = file.imports().ok()?.collect::<Result<Vec<_>, _>>().ok()?;
    // Tables that are not there read as empty ones, and a library that needs nothing brings all of the system with it.
    if libraries.is_empty() || functions.is_empty() {
        return Some(true);
    }
    let foreign = libraries.iter().any(|library| !plain(library.name()));
    let beyond = functions.iter().any(|import| {
        let named = import
            .name()
            .name()
            .is_none_or(|name| BEYOND.iter().any(|beyond| beyond.as_bytes() == name));
        // What no library of the system is named for comes from whatever happens to be loaded.
        named || !(import.is_weak() || plain(Import::library(import)))
    });
    Some(foreign || beyond)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    #![allow(clippy::unwrap_used, reason = "helpers of tests fail by panic, too")]

    use super::*;
    use std::path::Path;
    use std::process::Command;

    fn built(folder: &Path, source: &str) -> Option<Vec<u8>> {
        let (c, so) = (folder.join("library.c"), folder.join("library.so"));
        std::fs::write(&c, source).unwrap();
        let ran = Command::new("cc")
            .args(["-shared", "-fPIC", "-o"])
            .arg(&so)
            .args([&c, Path::new("-lm")])
            .output();
        let done = ran.ok()?;
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        Some(std::fs::read(so).unwrap())
    }

    /// By what is imported; where that cannot be read, what is watched is all.
    #[test]
    fn a_library_is_wide_by_what_it_imports_or_when_nobody_can_tell() {
        let folder = tempfile::tempdir().unwrap();
        let plain =
            "#include <math.h>\n#include <stdlib.h>\ndouble f(double x) { return x > 0 ? sin(x) : atof(\"1\"); }";
        let Some(narrow) = built(folder.path(), plain) else {
            use std::io::Write;
            let _ = writeln!(
                std::io::stderr(),
                "SKIPPED reach of libraries: needs the system package gcc"
            );
            return;
        };
        assert!(!is_wide(&narrow));
        for wide in [
            "#include <unistd.h>\nint f(void) { return chdir(\"/\"); }",
            "#include <signal.h>\nvoid f(void) { signal(SIGINT, SIG_IGN); }",
            "#include <signal.h>\nint f(struct sigaction *a) { return sigaction(SIGINT, a, a); }",
            "#include <dlfcn.h>\nvoid *f(void) { return dlopen(\"libz.so\", RTLD_NOW); }",
            "#include <locale.h>\nchar *f(void) { return setlocale(LC_ALL, \"\"); }",
            "#include <stdlib.h>\nvoid other(void);\nint f(void) { other(); return atoi(\"1\"); }",
            "int f(void) { return 1; }",
        ] {
            assert!(is_wide(&built(folder.path(), wide).unwrap()), "{wide}");
        }
        for end in [0, 4, 64, narrow.len() / 2] {
            assert!(is_wide(&narrow[..end]), "{end} bytes");
        }
        // Without its sections, nobody can read what it imports, but it loads: e_shoff, e_shnum and e_shstrndx.
        let mut stripped = narrow.clone();
        stripped[0x28..0x30].fill(0);
        stripped[0x3c..0x40].fill(0);
        assert!(is_wide(&stripped));
        // Any other library may call what it likes.
        let name = b"libc.so.6";
        let at = narrow.windows(name.len()).position(|w| w == name).unwrap();
        let mut other = narrow.clone();
        other[at + 3] = b'X';
        assert!(is_wide(&other));
    }
}
