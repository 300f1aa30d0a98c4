#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! With [`check`]; [`rules`] holds every rule with its section. `archive`, `xml`, `description` and `binary` each check what they
//! are called after.

mod archive;
mod binary;
mod description;
mod error;
mod finding;
mod functions;
mod options;
mod render;
mod role;
mod rule;
pub mod rules;
mod xml;

use std::path::Path;

pub use binary::serve;
pub use error::CheckError;
pub use finding::{Finding, Findings};
pub use options::Running;
pub use render::document;
pub use rule::{Rule, Severity};

use archive::Archive;
use description::view::View;
use xml::conform::conform;
use xml::schema;
use xml::tree::{Node, parse};

/// Checks an FMU.
///
/// * `running`: how its library is run; nothing leaves it alone.
///
/// # Errors
/// [`CheckError`] where there is nothing to check; all that is wrong with an FMU is found instead.
pub fn check(path: &Path, running: Option<&Running>) -> Result<Findings, CheckError> {
    let mut findings = Findings::default();
    let mut archive = Archive::open(path, &mut findings)?;
    let description = archive.description(&mut findings);
    let root = description.and_then(|bytes| parse(&bytes, &mut findings));
    let interfaces: Vec<&Node> = ["ModelExchange", "CoSimulation"]
        .into_iter()
        .flat_map(|name| root.iter().flat_map(move |root| root.named(name)))
        .collect();
    let of_this_version = root.as_ref().is_none_or(|root| of_this_version(root, &mut findings));
    if of_this_version {
        archive.files(&interfaces, &mut findings);
    }
    if let Some(root) = root.as_ref().filter(|_| of_this_version) {
        conform(root, &schema::DESCRIPTION, &mut findings);
        let view = View::new(root);
        description::check(&view, &mut findings);
        if let Some(running) = running {
            binary::check(&mut archive, &view, running, &mut findings)?;
        }
    }
    Ok(findings.sorted())
}

/// Other versions have other elements, and so no other rule of these.
fn of_this_version(root: &Node, findings: &mut Findings) -> bool {
    match root.get("fmiVersion") {
        Some("2.0") | None => true,
        Some(other) => {
            let what = format!("fmiVersion is {other}, and nothing else was checked");
            findings.at(root.line, &rules::description::VERSION, &root.path, what);
            false
        }
    }
}
