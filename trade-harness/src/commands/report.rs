//! `report`: the HTML page of a study, from its files.

use html_report::Format;

use super::out::Out;
use super::shared::Verdict;
use crate::HarnessError;
use crate::cli::ReportArgs;
use crate::output::OutputFolder;

const PAGE: &str = "report.html";

pub(super) fn report(args: &ReportArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    // Before anything is written: what is no study stays as it is.
    let page = html_report::html(&args.dir)?;
    let mut files = vec![(PAGE.to_owned(), page.into_bytes())];
    for (wanted, format) in [(args.svg, Format::Svg), (args.png, Format::Png)] {
        if wanted {
            files.extend(html_report::drawn(&args.dir, format)?);
        }
    }
    let folder = OutputFolder::prepare(&args.dir)?;
    let names = folder.write_all(files)?;
    out.tell("folder", folder.path())?;
    out.tell("files", &names)?;
    for name in names {
        if !args.quiet {
            out.say(&folder.path().join(name).display().to_string())?;
        }
    }
    Ok(Verdict::Done)
}

/// Writes the page into the folder of a finished study; returns its name.
pub(super) fn write_page(folder: &OutputFolder) -> Result<String, HarnessError> {
    folder.write(PAGE, html_report::html(folder.path())?.as_bytes())?;
    Ok(PAGE.to_owned())
}
