//! What modelDescription.xml says, beyond its schema.

mod aliases;
mod names;
mod structure;
mod units;
mod variables;
pub(crate) mod view;
mod whole;

use crate::finding::Findings;
use view::View;

/// Checks all of it.
pub(crate) fn check(view: &View<'_>, findings: &mut Findings) {
    whole::check(view, findings);
    units::check(view, findings);
    variables::check(view, findings);
    names::check(view, findings);
    aliases::check(view, findings);
    structure::check(view, findings);
}
