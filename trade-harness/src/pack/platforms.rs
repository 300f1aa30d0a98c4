//! Platforms of an archive: what each is built for, with what, and what is missing here for it.
//!
//! Libraries for a platform that was asked for by name do not know the machine that they were made on: paths are given other
//! names, symbols and times are left out, and the C library is an old one. So one commit gives one archive, in any folder.

use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::ValueEnum;
use fat_macho::FatWriter;
use fmi2_import::{LIBRARY_SUFFIX, PLATFORM};

use crate::HarnessError;

/// A platform by the name that FMI gives to its folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Platform {
    /// Linux on x86_64, glibc 2.17 (2012) or newer
    Linux64,
    /// Windows on x86_64
    Win64,
    /// macOS on x86_64 and on arm64, in one file
    Darwin64,
    /// Linux on arm64; FMI 2.0 names no folder for it, so it is no part of `all`
    #[value(name = "aarch64-linux")]
    Aarch64Linux,
}

/// What `--platforms` takes: a platform, or all that FMI 2.0 names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// linux64, win64 and darwin64.
    All,
    /// This one.
    One(Platform),
}

impl ValueEnum for Wanted {
    fn value_variants<'a>() -> &'a [Self] {
        &[
            Self::All,
            Self::One(Platform::Linux64),
            Self::One(Platform::Win64),
            Self::One(Platform::Darwin64),
            Self::One(Platform::Aarch64Linux),
        ]
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        match self {
            Self::All => Some(clap::builder::PossibleValue::new("all").help("linux64, win64 and darwin64")),
            Self::One(platform) => platform.to_possible_value(),
        }
    }
}

/// The platforms of a list, each once.
pub fn chosen(wanted: &[Wanted]) -> BTreeSet<Platform> {
    let all = [Platform::Linux64, Platform::Win64, Platform::Darwin64];
    wanted
        .iter()
        .flat_map(|wanted| match wanted {
            Wanted::All => all.to_vec(),
            Wanted::One(platform) => vec![*platform],
        })
        .collect()
}

/// How the C side of a target is linked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Linker {
    /// Zig, called by cargo-zigbuild: knows every glibc, and macOS without Apple's SDK.
    Zig,
    /// MinGW's GCC.
    Mingw,
}

/// One target of the compiler.
struct Target {
    /// Its names: the first whose standard library is installed, else the first, with a standard library built for it.
    names: &'static [&'static str],
    /// What FMI 3.0 calls it.
    fmi3: &'static str,
    /// Version of glibc that is linked against, as cargo-zigbuild takes it.
    glibc: &'static str,
    linker: Linker,
}

impl Platform {
    fn folder(self) -> &'static str {
        match self {
            Self::Linux64 => "linux64",
            Self::Win64 => "win64",
            Self::Darwin64 => "darwin64",
            Self::Aarch64Linux => "aarch64-linux",
        }
    }

    fn suffix(self) -> &'static str {
        match self {
            Self::Linux64 | Self::Aarch64Linux => "so",
            Self::Win64 => "dll",
            Self::Darwin64 => "dylib",
        }
    }

    /// Its library is made of those for all of these.
    fn targets(self) -> Vec<Target> {
        let target = |names, fmi3, glibc, linker| Target {
            names,
            fmi3,
            glibc,
            linker,
        };
        match self {
            Self::Linux64 => vec![target(
                &["x86_64-unknown-linux-gnu"],
                "x86_64-linux",
                ".2.17",
                Linker::Zig,
            )],
            Self::Aarch64Linux => vec![target(
                &["aarch64-unknown-linux-gnu"],
                "aarch64-linux",
                ".2.17",
                Linker::Zig,
            )],
            // The first asks for nothing that came after Windows 7, the second for Windows 10.
            Self::Win64 => vec![target(
                &["x86_64-win7-windows-gnu", "x86_64-pc-windows-gnu"],
                "x86_64-windows",
                "",
                Linker::Mingw,
            )],
            Self::Darwin64 => vec![
                target(&["x86_64-apple-darwin"], "x86_64-darwin", "", Linker::Zig),
                target(&["aarch64-apple-darwin"], "aarch64-darwin", "", Linker::Zig),
            ],
        }
    }
}

/// What libraries were built for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RunsOn {
    /// Folder of FMI 2.0.
    pub(crate) fmi2: &'static str,
    /// Folder of FMI 3.0.
    pub(crate) fmi3: &'static str,
    /// Name of the compiler's target; `None` for that of this machine.
    pub(crate) target: Option<&'static str>,
}

/// What this program runs on, as FMI 3.0 calls it.
const HERE: &str = if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
    "x86_64-linux"
} else if cfg!(all(target_os = "macos", target_arch = "x86_64")) {
    "x86_64-darwin"
} else if cfg!(all(target_os = "macos", target_arch = "aarch64")) {
    "aarch64-darwin"
} else if cfg!(all(target_os = "windows", target_arch = "x86_64")) {
    "x86_64-windows"
} else if cfg!(all(target_os = "windows", target_arch = "aarch64")) {
    "aarch64-windows"
} else {
    // As FMI 2.0 has it, which knows no name of its own for others.
    PLATFORM
};

/// A call of cargo that gives one library of each FMU.
#[derive(Debug)]
pub(crate) struct Call {
    /// What it is for.
    pub(crate) target: Option<&'static str>,
    /// The same as FMI 3.0 calls it.
    pub(crate) fmi3: &'static str,
    /// Cargo, or what stands before it.
    pub(crate) program: String,
    /// What it is asked for, without packages.
    pub(crate) arguments: Vec<String>,
    /// Beside the environment that is.
    pub(crate) environment: Vec<(&'static str, String)>,
}

/// What one folder below `binaries` is made by.
#[derive(Debug)]
pub(crate) struct Recipe {
    /// Name of the folder.
    pub(crate) folder: &'static str,
    /// Suffix of its library, without the dot.
    pub(crate) suffix: &'static str,
    /// The library is [`joined`] of what these make.
    pub(crate) calls: Vec<Call>,
}

/// How to build for these platforms; for none, for the one that this program runs on, as cargo does by itself.
///
/// # Errors
/// [`HarnessError::Platforms`] says everything that is missing for any of them.
pub(crate) fn recipes(platforms: &BTreeSet<Platform>, workspace: &Path) -> Result<Vec<Recipe>, HarnessError> {
    if platforms.is_empty() {
        return Ok(vec![Recipe {
            folder: PLATFORM,
            suffix: LIBRARY_SUFFIX,
            calls: vec![Call {
                target: None,
                fmi3: HERE,
                program: cargo(),
                arguments: vec!["build".to_owned(), "--release".to_owned()],
                environment: Vec::new(),
            }],
        }]);
    }
    let compiler = Compiler::here(workspace);
    let mut missing = BTreeMap::<String, BTreeSet<&str>>::new();
    let recipes = platforms
        .iter()
        .map(|platform| Recipe {
            folder: platform.folder(),
            suffix: platform.suffix(),
            calls: platform
                .targets()
                .iter()
                .map(|target| {
                    compiler.call(target, &mut |what| {
                        missing.entry(what).or_default().insert(platform.folder());
                    })
                })
                .collect(),
        })
        .collect();
    if missing.is_empty() {
        return Ok(recipes);
    }
    let lines = missing.into_iter().map(|(what, platforms)| {
        let platforms: Vec<&str> = platforms.into_iter().collect();
        format!("without {what} not {}", platforms.join(", "))
    });
    Err(HarnessError::Platforms {
        missing: lines.collect::<Vec<_>>().join("; "),
    })
}

/// The library of a platform, of one for each of its processors.
///
/// # Errors
/// [`HarnessError::Universal`] for files that are no libraries of macOS.
pub(crate) fn joined(mut libraries: Vec<Vec<u8>>) -> Result<Vec<u8>, HarnessError> {
    if libraries.len() == 1 {
        return Ok(libraries.remove(0));
    }
    let failed = |source| HarnessError::Universal { source };
    let mut file = FatWriter::new();
    for library in libraries {
        file.add(library).map_err(failed)?;
    }
    let mut bytes = Vec::new();
    file.write_to(&mut bytes).map_err(failed)?;
    Ok(bytes)
}

fn cargo() -> String {
    env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned())
}

/// The compiler that cargo will call.
struct Compiler {
    sysroot: PathBuf,
    /// What is built.
    workspace: PathBuf,
}

impl Recipe {
    /// What its library runs on.
    pub(crate) fn built(&self) -> impl Iterator<Item = RunsOn> {
        self.calls.iter().map(|call| RunsOn {
            fmi2: self.folder,
            fmi3: call.fmi3,
            target: call.target,
        })
    }
}

impl Compiler {
    fn here(workspace: &Path) -> Self {
        let program = env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
        Self {
            sysroot: answer(&program, &["--print", "sysroot"]).unwrap_or_default().into(),
            workspace: workspace.canonicalize().unwrap_or_else(|_| workspace.to_owned()),
        }
    }

    /// The standard library's sources.
    fn sources(&self) -> PathBuf {
        self.sysroot.join("lib/rustlib/src/rust")
    }

    /// The same relative to the workspace, where they lie in it: by every name that links give either of them.
    fn sources_inside(&self) -> Vec<PathBuf> {
        let named = |path: &Path| [Some(path.to_owned()), path.canonicalize().ok()].into_iter().flatten();
        let workspaces: Vec<PathBuf> = named(&self.workspace).collect();
        let inside = named(&self.sources()).flat_map(|sources| {
            let relative = workspaces.iter().filter_map(|w| sources.strip_prefix(w).ok());
            relative.map(Path::to_owned).collect::<Vec<_>>()
        });
        let mut inside: Vec<PathBuf> = inside.collect();
        inside.dedup();
        inside
    }

    /// * `lacks`: told each thing that is not here.
    fn call(&self, target: &Target, lacks: &mut dyn FnMut(String)) -> Call {
        let installed = |name: &&&str| self.sysroot.join("lib/rustlib").join(name).join("lib").is_dir();
        let found = target.names.iter().find(installed);
        let name = found.or(target.names.first()).copied().unwrap_or_default();
        let mut arguments = vec!["--release".to_owned(), format!("--target={name}{}", target.glibc)];
        let mut environment = vec![("CARGO_ENCODED_RUSTFLAGS", self.flags(name).join("\x1f"))];
        // The oldest system that Rust's standard library knows there; Zig would take a newer one.
        match name {
            "x86_64-apple-darwin" => environment.push(("MACOSX_DEPLOYMENT_TARGET", "10.12".to_owned())),
            "aarch64-apple-darwin" => environment.push(("MACOSX_DEPLOYMENT_TARGET", "11.0".to_owned())),
            _ => {}
        }
        if found.is_none() {
            if !self.sources().join("library/Cargo.toml").is_file() {
                let last = target.names.last().copied().unwrap_or_default();
                lacks(format!(
                    "the standard library of {last} (`rustup target add {last}`) or its sources (`rustup component add rust-src`, Debian: rust-web-src)"
                ));
            }
            arguments.push("-Zbuild-std=std,panic_unwind".to_owned());
            environment.push(("RUSTC_BOOTSTRAP", "1".to_owned()));
        }
        let program = match target.linker {
            Linker::Zig => {
                if answer("cargo-zigbuild", &["--version"]).is_none() {
                    lacks("cargo-zigbuild (`pip install cargo-zigbuild` brings it and Zig)".to_owned());
                }
                arguments.insert(0, "zigbuild".to_owned());
                "cargo-zigbuild".to_owned()
            }
            Linker::Mingw => {
                let linker = "x86_64-w64-mingw32-gcc";
                if answer(linker, &["--version"]).is_none() {
                    lacks(format!("{linker} (Debian: gcc-mingw-w64-x86-64)"));
                }
                arguments.insert(0, "build".to_owned());
                cargo()
            }
        };
        Call {
            target: Some(name),
            fmi3: target.fmi3,
            program,
            arguments,
            environment,
        }
    }

    /// Flags for code that does not know where it was made. Sources of the workspace cargo names relative to it.
    fn flags(&self, target: &str) -> Vec<String> {
        let mut flags = Vec::new();
        // Of several that fit, the compiler takes the last.
        let mut remap = |from: &Path, to: &str| {
            for from in [Some(from.to_owned()), from.canonicalize().ok()].into_iter().flatten() {
                flags.push(format!("--remap-path-prefix={}={to}", from.display()));
            }
        };
        let home = env::var_os("CARGO_HOME").map(PathBuf::from);
        if let Some(home) = home.or_else(|| env::home_dir().map(|home| home.join(".cargo"))) {
            // One folder for each registry that crates came from.
            for registry in home.join("registry/src").read_dir().into_iter().flatten().flatten() {
                remap(&registry.path(), "crates");
            }
        }
        remap(&self.sources(), "rust");
        // Cargo names what lies in the workspace relative to it.
        let inside = self.sources_inside();
        flags.extend(
            inside
                .iter()
                .map(|from| format!("--remap-path-prefix={}=rust", from.display())),
        );
        if target.contains("apple") {
            // By the linker: the compiler would call a tool that not every installation has.
            flags.extend(["-Cstrip=none", "-Clink-arg=-Wl,-S", "-Clink-arg=-Wl,-x"].map(str::to_owned));
        } else {
            flags.push("-Cstrip=symbols".to_owned());
        }
        if target.contains("windows") {
            flags.push("-Clink-arg=-Wl,--no-insert-timestamp".to_owned());
        }
        flags
    }
}

/// First line of what a program says, if it is there and content.
fn answer(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program)
        .args(arguments)
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    output
        .status
        .success()
        .then(|| text.lines().next().unwrap_or_default().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_what_fmi_names_and_each_is_taken_once() {
        let all = chosen(&[Wanted::One(Platform::Win64), Wanted::All]);
        let folders: Vec<&str> = all.iter().map(|p| p.folder()).collect();
        assert_eq!(folders, ["linux64", "win64", "darwin64"]);
        assert!(chosen(&[]).is_empty());
    }

    #[test]
    fn a_compiler_without_anything_is_told_what_it_lacks_and_how_to_get_it() {
        let folder = tempfile::tempdir().unwrap();
        let compiler = Compiler {
            sysroot: folder.path().to_owned(),
            workspace: PathBuf::new(),
        };
        let target = Target {
            names: &["one-target", "another-target"],
            fmi3: "one",
            glibc: "",
            linker: Linker::Mingw,
        };
        let told = |compiler: &Compiler| {
            let mut lacks = BTreeSet::new();
            let call = compiler.call(&target, &mut |what| {
                lacks.insert(what);
            });
            lacks.retain(|what| what.contains("standard library"));
            (call, lacks)
        };
        let (_, lacks) = told(&compiler);
        assert!(
            lacks.iter().all(|l| l.contains("rustup target add another-target")) && lacks.len() == 1,
            "{lacks:?}"
        );

        let sources = folder.path().join("lib/rustlib/src/rust/library");
        std::fs::create_dir_all(&sources).unwrap();
        std::fs::write(sources.join("Cargo.toml"), "").unwrap();
        let (call, lacks) = told(&compiler);
        assert!(lacks.is_empty(), "{lacks:?}");
        assert!(call.arguments.iter().any(|a| a.starts_with("-Zbuild-std")), "{call:?}");
        assert!(call.arguments.contains(&"--target=one-target".to_owned()), "{call:?}");

        std::fs::create_dir_all(folder.path().join("lib/rustlib/another-target/lib")).unwrap();
        let (call, lacks) = told(&compiler);
        assert!(lacks.is_empty(), "{lacks:?}");
        assert_eq!(call.arguments, ["build", "--release", "--target=another-target"]);
    }

    #[test]
    fn sources_of_the_standard_library_have_one_name_wherever_they_lie() {
        let flags = |workspace: &str| {
            let compiler = Compiler {
                sysroot: "/w/target/rust".into(),
                workspace: workspace.into(),
            };
            let flags = compiler.flags("x86_64-unknown-linux-gnu");
            flags
                .into_iter()
                .filter(|flag| flag.ends_with("=rust"))
                .collect::<Vec<_>>()
        };
        let whole = "--remap-path-prefix=/w/target/rust/lib/rustlib/src/rust=rust";
        assert_eq!(flags("/other"), [whole]);
        let relative = "--remap-path-prefix=target/rust/lib/rustlib/src/rust=rust";
        assert_eq!(flags("/w"), [whole, relative]);
    }

    /// Debian's sources are a link within the system root.
    #[cfg(unix)]
    #[test]
    fn sources_behind_a_link_have_the_same_name_by_either_path() {
        let folder = tempfile::tempdir().unwrap();
        let workspace = folder.path().canonicalize().unwrap();
        let sysroot = workspace.join("target/usr");
        std::fs::create_dir_all(sysroot.join("lib/rustlib/src")).unwrap();
        std::fs::create_dir_all(sysroot.join("src/rustc")).unwrap();
        std::os::unix::fs::symlink("../../../src/rustc", sysroot.join("lib/rustlib/src/rust")).unwrap();
        let compiler = Compiler { sysroot, workspace };
        let flags = compiler.flags("x86_64-pc-windows-gnu");
        for path in ["target/usr/lib/rustlib/src/rust", "target/usr/src/rustc"] {
            let flag = format!("--remap-path-prefix={path}=rust");
            assert!(flags.contains(&flag), "{flag}: {flags:?}");
        }
    }

    /// The header of a library for macOS, without load commands.
    fn library(processor: u32) -> Vec<u8> {
        let (magic, dylib) = (0xfeed_facf_u32, 6);
        let words = [magic, processor, 0, dylib, 0, 0, 0, 0];
        words.iter().flat_map(|word: &u32| word.to_le_bytes()).collect()
    }

    #[test]
    fn two_libraries_of_macos_are_joined_whole_and_one_stays_what_it_is() {
        let (x86_64, arm64) = (library(0x0100_0007), library(0x0100_000c));
        assert_eq!(joined(vec![b"any".to_vec()]).unwrap(), b"any");
        let both = joined(vec![x86_64.clone(), arm64.clone()]).unwrap();
        // Apple's fat_header and fat_arch are in network order.
        let word = |at: usize| u32::from_be_bytes(both[at..at + 4].try_into().unwrap());
        assert_eq!((word(0), word(4)), (0xcafe_babe, 2));
        let parts = [0, 1].map(|k| {
            let (offset, size) = (word(16 + 20 * k) as usize, word(20 + 20 * k) as usize);
            (word(8 + 20 * k), both[offset..offset + size].to_vec())
        });
        assert!(parts.contains(&(0x0100_0007, x86_64)) && parts.contains(&(0x0100_000c, arm64)));
        assert!(joined(vec![b"no".to_vec(), b"library".to_vec()]).is_err());
    }
}
