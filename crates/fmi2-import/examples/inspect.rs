//! Prints what an FMU says about itself: `cargo run -p fmi2-import --example inspect -- target/fmu/fmu-nav.fmu`.

use std::error::Error;
use std::io::Write;

use fmi2_import::{Fmu, PLATFORM};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).ok_or("usage: inspect FILE.fmu")?;
    let fmu = Fmu::open(&path)?;
    let about = fmu.description();
    let mut out = std::io::stdout().lock();

    let facts = [
        ("model", Some(about.model_name.as_str())),
        ("about", about.description.as_deref()),
        ("version", about.version.as_deref()),
        ("guid", Some(about.guid.as_str())),
        ("licence", about.license.as_deref()),
        ("written by", about.generation_tool.as_deref()),
    ];
    for (label, text) in facts {
        writeln!(out, "{label:<12}{}", text.unwrap_or("-"))?;
    }
    let here = if fmu.platforms().iter().any(|p| p == PLATFORM) {
        "runs here"
    } else {
        "does not run here"
    };
    writeln!(out, "{:<12}{} ({here})", "platforms", fmu.platforms().join(", "))?;

    writeln!(
        out,
        "\n{:<40} {:<12} {:<20} {:<10} start",
        "variable", "type", "causality", "unit"
    )?;
    for variable in &about.variables {
        let start = variable
            .start()
            .map_or(String::new(), |value| variable.format_value(&value));
        writeln!(
            out,
            "{:<40} {:<12} {:<20} {:<10} {start}",
            variable.name,
            variable.base_type(),
            variable.causality,
            variable.unit().unwrap_or(""),
        )?;
    }

    for annotation in &about.vendor_annotations {
        writeln!(out, "\nfor {}:\n{}", annotation.tool, annotation.xml)?;
    }
    Ok(())
}
