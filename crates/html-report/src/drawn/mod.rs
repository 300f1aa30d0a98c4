//! The figures as files for papers and slides: SVG and PNG.
//!
//! `over_time` and `compared` make a `sheet` of what the page draws, `axis` its axes, and `canvas` draws it.

mod axis;
mod canvas;
mod compared;
mod over_time;
pub(crate) mod regret;
mod sheet;

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use plotters::style::FontStyle;

use crate::ReportError;
use crate::figures;
use crate::folder::Folder;
use crate::reproduced;
use sheet::Sheet;

/// Kind of picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Lines and text.
    Svg,
    /// Pixels, twice as many as the SVG says.
    Png,
}

/// Where systems keep a sans-serif font, upright and bold.
const FONTS: [[&str; 2]; 6] = [
    [
        "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
        "/usr/share/fonts/truetype/liberation/LiberationSans-Bold.ttf",
    ],
    [
        "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
        "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf",
    ],
    [
        "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
        "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans-Bold.ttf",
    ],
    [
        "/usr/share/fonts/TTF/DejaVuSans.ttf",
        "/usr/share/fonts/TTF/DejaVuSans-Bold.ttf",
    ],
    [
        "/System/Library/Fonts/Supplemental/Arial.ttf",
        "/System/Library/Fonts/Supplemental/Arial Bold.ttf",
    ],
    ["C:\\Windows\\Fonts\\arial.ttf", "C:\\Windows\\Fonts\\arialbd.ttf"],
];

/// Every figure of every study of a folder, or of a folder of `reproduce` or `regret`.
///
/// * returns: names and contents, `figures/SCENARIO_CASE_WHAT.svg` or `.png`; of `regret`, `figures/MISSION_regret.svg` or `.png`.
///
/// # Errors
/// [`ReportError`]: those of [`crate::html`], and [`ReportError::NoFont`], [`ReportError::Drawing`].
pub fn drawn(folder: &Path, format: Format) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    use_a_font()?;
    let extension = match format {
        Format::Svg => "svg",
        Format::Png => "png",
    };
    let drawn = |(name, sheet): (String, Sheet)| {
        let bytes = match format {
            Format::Svg => canvas::svg(&sheet)?,
            Format::Png => canvas::png(&sheet)?,
        };
        Ok((format!("figures/{name}.{extension}"), bytes))
    };
    sheets(folder)?.into_iter().map(drawn).collect()
}

/// Every figure with its name.
fn sheets(folder: &Path) -> Result<Vec<(String, Sheet)>, ReportError> {
    if folder.join(reproduced::TABLE).is_file() {
        let learning = reproduced::learning(folder)?;
        let sheet = learning.map(|l| ("learning_curve".to_owned(), over_time::learning(&l)));
        return Ok(sheet.into_iter().collect());
    }
    if folder.join(regret::TABLE).is_file() {
        return regret::sheets(folder);
    }
    let folder = Folder::read(folder)?;
    let mut sheets = Vec::new();
    for (study, figures) in folder.manifest.studies.iter().zip(figures::all(&folder)?) {
        let mut add = |what: &str, sheet: Option<Sheet>| {
            let name = format!("{}_{}_{what}", study.scenario, study.case);
            sheets.extend(sheet.map(|sheet| (name, sheet)));
        };
        for search in &figures.search {
            add(&format!("search_{}", search.filter), Some(compared::search(search)));
        }
        let cases = figures.cases.as_ref();
        add("cases", cases.map(|m| compared::matrix(m, "position RMSE [m] by case")));
        let phases = figures.phases.as_ref();
        add(
            "phases",
            phases.map(|m| compared::matrix(m, "position RMSE [m] by phase")),
        );
        for filter in &figures.filters {
            let series = filter.series.as_ref();
            add(
                &format!("error_{}", filter.name),
                series.map(|series| over_time::errors(&figures, filter, series)),
            );
        }
        let any = figures.filters.iter().any(|f| f.series.is_some());
        add("consistency", any.then(|| over_time::consistency(&figures)));
        let told = figures.filters.iter().any(|f| f.jerk_root().is_some());
        add("process_noise", told.then(|| over_time::process_noise(&figures)));
        add("path", figures.path.as_ref().map(|path| compared::path(path, &figures)));
        for (index, [quantity, _]) in figures.errors.iter().enumerate() {
            add(&format!("paired_{quantity}"), compared::pairs(&figures, index));
            add(&format!("runs_{quantity}"), compared::runs(&figures, index));
        }
    }
    Ok(sheets)
}

/// Registers the first font of the system that there is.
fn use_a_font() -> Result<(), ReportError> {
    static FONT: OnceLock<Option<[Vec<u8>; 2]>> = OnceLock::new();
    let read = |[upright, bold]: &[&str; 2]| {
        let upright = fs::read(upright).ok()?;
        let bold = fs::read(bold).unwrap_or_else(|_| upright.clone());
        Some([upright, bold])
    };
    let found = FONT.get_or_init(|| FONTS.iter().find_map(read));
    let fonts = found.as_ref().ok_or(ReportError::NoFont)?;
    for (font, style) in fonts.iter().zip([FontStyle::Normal, FontStyle::Bold]) {
        plotters::style::register_font("sans-serif", style, font).map_err(|_| ReportError::NoFont)?;
    }
    Ok(())
}
