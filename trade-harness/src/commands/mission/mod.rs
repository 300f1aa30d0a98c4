//! `mission`: mission files written, checked and described.

mod check;
mod quiet_run;

use interface::mission::{embedded, schema};
use study::StudyError;

use super::out::Out;
use super::shared::Verdict;
use crate::HarnessError;
use crate::cli::{MissionCommand, MissionNewArgs};
use crate::output::{prepare_file, write_whole};

pub(super) fn mission(command: &MissionCommand, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    match command {
        MissionCommand::New(args) => new(args, out),
        MissionCommand::Check(args) => check::check(args, out),
        MissionCommand::Schema => out.say(schema().trim_end()).map(|()| Verdict::Done),
    }
}

/// Writes the file of a mission that comes with the project under another name, comments and all.
fn new(args: &MissionNewArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let from = embedded(&args.from).map_err(StudyError::from)?;
    let path = args.out.join(format!("{}.toml", args.name));
    if path.exists() {
        return Err(HarnessError::Exists { path });
    }
    let mut document = interface::mission::Document::parse(from.name, from.text).map_err(StudyError::from)?;
    document
        .set("name", &format!("{:?}", args.name))
        .map_err(StudyError::from)?;
    // A name that none can have is told before anything is written.
    document.mission().map_err(StudyError::from)?;
    prepare_file(&path)?;
    let head = format!(
        "# {} was begun from the mission {}. Every key is described in docs/MISSION.md; `trade-harness mission check` flies it.\n",
        args.name, from.name
    );
    write_whole(&path, format!("{head}{}", document.text()).as_bytes())?;
    out.say(&format!(
        "{}\nNext: trade-harness mission check {0}\n      trade-harness compare --mission {0}",
        path.display()
    ))?;
    Ok(Verdict::Done)
}
