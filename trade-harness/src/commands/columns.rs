//! `columns`: what the files of a study hold.

use std::io::Write;

use comfy_table::{ContentArrangement, Table, presets};

use super::shared::{Verdict, say};
use crate::HarnessError;
use crate::format::lines;
use crate::report::columns::all;

pub(super) fn columns(out: &mut dyn Write) -> Result<Verdict, HarnessError> {
    for file in all() {
        let mut table = Table::new();
        table
            .load_style(presets::NOTHING)
            .set_content_arrangement(ContentArrangement::Dynamic)
            .set_header(["  column", "unit", "meaning"]);
        table.add_rows(file.columns.iter().map(|[name, unit, meaning]| {
            let name = format!("  {name}");
            [name, (*unit).to_owned(), (*meaning).to_owned()]
        }));
        say(
            out,
            &format!("{}: one row for {}\n{}\n", file.file, file.about, lines(&table)),
        )?;
    }
    Ok(Verdict::Done)
}
