//! The page `documentation/index.html` of an FMU.

use fmi2_import::{Causality, ModelDescription};
use interface::annotation::Filters;

/// Variables of an FMU by kind, with headings.
pub(crate) const GROUPS: [(&str, Causality); 5] = [
    ("Parameters", Causality::Parameter),
    ("Calculated parameters", Causality::CalculatedParameter),
    ("Inputs", Causality::Input),
    ("Outputs", Causality::Output),
    ("Local variables", Causality::Local),
];

const STYLE: &str = "body{font:15px/1.5 sans-serif;margin:2em auto;max-width:70em;padding:0 1em}\
table{border-collapse:collapse}td,th{border-bottom:1px solid #ccc;padding:.2em .7em;text-align:left;vertical-align:top}\
code{white-space:nowrap}h2{margin-top:1.6em}.eq{font:1.15em/1.6 serif;margin:.6em 2em}";

/// Place of the page in an FMU.
pub(super) const PAGE: &str = "documentation/index.html";

/// The reference results, where there are any; `NAME` for that of the model.
const REFERENCE: &str = "reference/NAME_ref.csv";

/// Files beside the page, and what they are.
const FILES: [(&str, &str); 4] = [
    (
        REFERENCE,
        "what this FMU answers in its default experiment, as the FMI cross-check rules write it",
    ),
    (
        "licenses/license.txt",
        "its licence, and where those of everything that is linked in stand",
    ),
    ("licenses/dependencies.csv", "every crate that is linked in"),
    ("sbom.json", "the same for machines (CycloneDX)"),
];

/// The page: what the FMU is, its presets and its variables.
///
/// * `reference`: whether there are reference results beside it.
/// * `model`: what it simulates, as HTML; `standard`: by which it is packed.
pub(super) fn html(d: &ModelDescription, filters: &Filters, reference: bool, model: &str, standard: &str) -> String {
    let name = escape(&d.model_name);
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{name}</title><style>{STYLE}</style></head>\n<body>\n<h1>{name}</h1>\n<p>{}</p>\n<p>Co-simulation by {standard}; version {}, licence {}.</p>\n",
        escape(d.description.as_deref().unwrap_or_default()),
        escape(d.version.as_deref().unwrap_or("unknown")),
        escape(d.license.as_deref().unwrap_or("not stated")),
    );
    page.push_str("<p><img src=\"picture.svg\" alt=\"\" width=\"160\" height=\"160\"></p>\n");
    page.push_str(model);
    page.push_str("<h2>Files</h2>\n<ul>\n");
    for (file, about) in FILES.into_iter().filter(|(file, _)| reference || *file != REFERENCE) {
        let file = file.replace("NAME", &name);
        page.push_str(&format!("<li><a href=\"{file}\">{file}</a>: {about}</li>\n"));
    }
    page.push_str("</ul>\n");
    if !filters.presets.is_empty() {
        page.push_str("<h2>Presets</h2>\n<table>\n<tr><th>preset</th><th>sets</th><th>meaning</th></tr>\n");
        for p in &filters.presets {
            let sets: Vec<String> = p
                .sets
                .iter()
                .map(|s| format!("<code>{}={}</code>", escape(&s.variable), escape(&s.value)))
                .collect();
            let label = format!("{}@{}", p.filter, p.name);
            let cells = [
                format!("<code>{}</code>", escape(&label)),
                sets.join(" "),
                escape(&p.about),
            ];
            push_row(&mut page, &cells);
        }
        page.push_str("</table>\n");
    }
    for (title, causality) in GROUPS {
        let of_kind = || d.variables.iter().filter(|v| v.causality == causality);
        if of_kind().next().is_none() {
            continue;
        }
        page.push_str(&format!("<h2>{title}</h2>\n<table>\n"));
        page.push_str("<tr><th>name</th><th>type</th><th>unit</th><th>start</th><th>meaning</th></tr>\n");
        for v in of_kind() {
            let start = v.start().map(|s| v.format_value(&s)).unwrap_or_default();
            let cells = [
                format!("<code>{}</code>", escape(&v.name)),
                v.base_type().to_string(),
                escape(v.unit().unwrap_or_default()),
                escape(&start),
                escape(v.description.as_deref().unwrap_or_default()),
            ];
            push_row(&mut page, &cells);
        }
        page.push_str("</table>\n");
    }
    page.push_str("</body>\n</html>\n");
    page
}

fn push_row(page: &mut String, cells: &[String]) {
    let cells: Vec<String> = cells.iter().map(|c| format!("<td>{c}</td>")).collect();
    page.push_str(&format!("<tr>{}</tr>\n", cells.concat()));
}

pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
