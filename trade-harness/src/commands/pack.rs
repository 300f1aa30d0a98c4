//! `pack`: our FMUs as files.

use std::io::Write;

use super::shared::{Verdict, say};
use crate::HarnessError;
use crate::cli::PackArgs;
use crate::pack::default_folder;

pub(super) fn pack(args: &PackArgs, out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    let folder = args.out.clone().unwrap_or_else(|| default_folder(&args.workspace));
    for packed in crate::pack::pack(&args.workspace, &folder, args.mission.as_deref(), args.quiet)? {
        let state = if packed.written { "written" } else { "up to date" };
        say(out, &format!("{} ({state})", packed.path.display()))?;
    }
    Ok(Verdict::Done)
}
