//! `pack`: our FMUs as files.

use super::out::Out;
use super::shared::Verdict;
use crate::HarnessError;
use crate::cli::PackArgs;
use crate::pack::platforms::chosen;
use crate::pack::{default_folder, pack_for};

pub(super) fn pack(args: &PackArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let folder = args.out.clone().unwrap_or_else(|| default_folder(&args.workspace));
    let platforms = chosen(&args.platforms);
    let packed = pack_for(
        &platforms,
        &args.workspace,
        &folder,
        args.mission.as_deref(),
        args.quiet,
    )?;
    let mut told = Vec::new();
    for packed in packed {
        told.push(packed.path.clone());
        let state = if packed.written { "written" } else { "up to date" };
        out.say(&format!("{} ({state})", packed.path.display()))?;
    }
    out.tell("files", told)?;
    Ok(Verdict::Done)
}
