//! `report`: the HTML page of a study, from its files.

use std::fs;
use std::path::Path;

use html_report::Format;

use super::out::Out;
use super::shared::Verdict;
use crate::HarnessError;
use crate::cli::ReportArgs;
use crate::output::OutputFolder;
use crate::parquet::from_csv;

const PAGE: &str = "report.html";

/// Folders of a study that hold histories.
const HISTORIES: [&str; 3] = ["epochs", "run_errors", "paths"];

pub(super) fn report(args: &ReportArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    // Before anything is written: what is no study stays as it is.
    let page = html_report::html(&args.dir)?;
    let mut files = vec![(PAGE.to_owned(), page.into_bytes())];
    for (wanted, format) in [(args.svg, Format::Svg), (args.png, Format::Png)] {
        if wanted {
            files.extend(html_report::drawn(&args.dir, format)?);
        }
    }
    if args.parquet {
        files.extend(histories(&args.dir)?);
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

/// The histories of a study as Parquet files, each by its name in the folder.
fn histories(dir: &Path) -> Result<Vec<(String, Vec<u8>)>, HarnessError> {
    let mut files = Vec::new();
    for kind in HISTORIES {
        let folder = dir.join(kind);
        let unread = |source| HarnessError::Read {
            path: folder.clone(),
            source,
        };
        for entry in fs::read_dir(&folder).map_err(unread)? {
            let path = entry.map_err(unread)?.path();
            let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            if let (Some(stem), true) = (stem, path.extension().is_some_and(|extension| extension == "csv")) {
                let read = fs::read(&path).map_err(|source| HarnessError::Read { path, source })?;
                files.push((format!("{kind}/{stem}.parquet"), from_csv(&read)?));
            }
        }
    }
    files.sort();
    Ok(files)
}

/// Writes the page into the folder of a finished study; returns its name.
pub(super) fn write_page(folder: &OutputFolder) -> Result<String, HarnessError> {
    folder.write(PAGE, html_report::html(folder.path())?.as_bytes())?;
    Ok(PAGE.to_owned())
}
