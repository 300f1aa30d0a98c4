//! Gives the library its GUID, as `FMU_GUID`, before it is linked; `trade-harness pack` reads it from cargo's messages.
#![allow(clippy::print_stdout, reason = "how a build script talks to cargo")]

use std::collections::BTreeSet;
use std::io;
use std::path::Path;

fn main() -> io::Result<()> {
    let name = env!("CARGO_PKG_NAME");
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let inputs = build_identity::Inputs::of(&workspace, name)?;
    let features: BTreeSet<String> = std::env::vars()
        .filter_map(|(key, _)| key.strip_prefix("CARGO_FEATURE_").map(str::to_owned))
        .collect();
    println!("cargo:rustc-env=FMU_GUID={}", inputs.guid(&features)?);
    for path in inputs.watched() {
        println!("cargo:rerun-if-changed={}", path.display());
    }
    Ok(())
}
