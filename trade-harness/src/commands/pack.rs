//! `pack`: our FMUs as files.

use super::out::Out;
use super::shared::Verdict;
use crate::HarnessError;
use crate::cli::PackArgs;
use crate::pack::default_folder;

pub(super) fn pack(args: &PackArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let folder = args.out.clone().unwrap_or_else(|| default_folder(&args.workspace));
    let mut told = Vec::new();
    for packed in crate::pack::pack(&args.workspace, &folder, args.mission.as_deref(), args.quiet)? {
        told.push(packed.path.clone());
        let state = if packed.written { "written" } else { "up to date" };
        out.say(&format!("{} ({state})", packed.path.display()))?;
    }
    out.tell("files", told)?;
    Ok(Verdict::Done)
}
