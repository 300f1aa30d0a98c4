//! What a library can reach, by what it asks the loader for.
//!
//! One that imports nothing by which a folder is changed, a signal handler installed or another library opened, and that needs none
//! but libraries of the system, changes neither in a step; to look for it each time would cost more than the step. The raw system
//! call is not counted: the standard library of Rust waits by it, and nobody installs handlers so.

use object::{BinaryFormat, File, Object};

/// Functions by which the folder or a signal's handler is changed, or a library opened that may.
const BEYOND: [&str; 16] = [
    "chdir",
    "fchdir",
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

/// Whether the library of these bytes can change folder and handlers; yes where it is not known.
pub(crate) fn is_wide(library: &[u8]) -> bool {
    imports(library).is_none_or(|imports| {
        let known = |name: &String| PLAIN.contains(&name.as_str());
        !imports.libraries.iter().all(known) || imports.functions.iter().any(|name| BEYOND.contains(&name.as_str()))
    })
}

/// Names that a library asks the loader for.
struct Imports {
    libraries: Vec<String>,
    functions: Vec<String>,
}

/// `None` where they cannot be read.
fn imports(library: &[u8]) -> Option<Imports> {
    let file = File::parse(library)
        .ok()
        .filter(|file| file.format() == BinaryFormat::Elf)?;
    let text = |name: &[u8]| String::from_utf8(name.to_vec()).ok();
    let libraries = file.import_libraries().ok()?;
    let functions = file.imports().ok()?;
    Some(Imports {
        libraries: libraries
            .map(|library| text(library.ok()?.name()))
            .collect::<Option<_>>()?,
        functions: functions
            .map(|import| text(import.ok()?.name().name()?))
            .collect::<Option<_>>()?,
    })
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
            .arg(&c)
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
        ] {
            assert!(is_wide(&built(folder.path(), wide).unwrap()), "{wide}");
        }
        for end in [0, 4, 64, narrow.len() / 2] {
            assert!(is_wide(&narrow[..end]), "{end} bytes");
        }
        // Any other library may call what it likes.
        let name = b"libc.so.6";
        let at = narrow.windows(name.len()).position(|w| w == name).unwrap();
        let mut other = narrow.clone();
        other[at + 3] = b'X';
        assert!(is_wide(&other));
    }
}
