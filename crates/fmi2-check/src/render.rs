//! The rules as a document.

use std::fmt::Write;

use crate::rules::all;

/// Every rule as a Markdown table.
pub fn rule_table() -> String {
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
