//! The rules as a document.

use std::fmt::Write;

use crate::rules::all;

/// `docs/check.md`: what is checked, how it is read, and the rules.
pub fn document() -> String {
    format!("{}## Rules\n\n{}", include_str!("document.md"), rule_table())
}

/// Every rule as a Markdown table.
fn rule_table() -> String {
    let mut table = "| rule | severity | section | demands | otherwise |\n|---|---|---|---|---|\n".to_owned();
    for rule in all() {
        let cell = |text: &str| text.replace('|', "\\|");
        // Writing to a string cannot fail.
        let _ = writeln!(
            table,
            "| `{}` | {} | {} | {} | {} |",
            rule.id,
            rule.severity.name(),
            rule.section,
            cell(rule.demands),
            cell(rule.advice)
        );
    }
    table
}
