//! Notes what this program is built from: commit, whether files differ from it, compiler.
//!
//! Outside a checkout, or without git, there is nothing to note, and that is no mistake.

use std::path::Path;
use std::process::Command;

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    // What is built and where the branch stands; the index changes whenever somebody looks.
    let watched = [
        "Cargo.lock",
        "Cargo.toml",
        "crates",
        "fmu-nav",
        "fmu-truth",
        "missions",
        "trade-harness",
        ".git/HEAD",
        ".git/logs/HEAD",
    ];
    for path in watched
        .map(|path| root.join(path))
        .into_iter()
        .filter(|path| path.exists())
    {
        println!("cargo::rerun-if-changed={}", path.display());
    }
    let git = |arguments: &[&str]| said(Command::new("git").arg("-C").arg(&root).args(arguments));
    // The repository of somebody who has unpacked the project into another one is not the project's.
    if root.join(".git").exists()
        && let Some(commit) = git(&["rev-parse", "HEAD"])
    {
        println!("cargo::rustc-env=TRADE_HARNESS_COMMIT={commit}");
        if let Some(changes) = git(&["status", "--porcelain", "--untracked-files=no"]) {
            println!("cargo::rustc-env=TRADE_HARNESS_DIRTY={}", !changes.is_empty());
        }
    }
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    if let Some(version) = said(Command::new(rustc).arg("--version")) {
        println!("cargo::rustc-env=TRADE_HARNESS_COMPILER={version}");
    }
}

fn said(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}
