//! Checks FMUs that are named on the command line and prints a line for each finding.

use std::io::Write;
use std::path::Path;
use std::process::{Command, ExitCode};

use fmi2_check::{CheckError, Finding, Running, Severity, check, serve};

/// First word of the command line of a process that makes a trial.
const TRIAL: &str = "--trial";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let ended = match &words[..] {
        [first, job, trial] if first == TRIAL => serve(Path::new(job), trial).map(|()| false),
        files => files.iter().try_fold(false, |bad, file| Ok(all_of(file)? || bad)),
    };
    match ended {
        Ok(false) => ExitCode::SUCCESS,
        Ok(true) => ExitCode::from(1),
        Err(error) => {
            let causes = std::iter::successors(Some(&error as &dyn std::error::Error), |e| e.source());
            let text: Vec<String> = causes.map(ToString::to_string).collect();
            say(&mut std::io::stderr(), &format!("error: {}", text.join(": ")));
            ExitCode::from(2)
        }
    }
}

/// Whether there are errors among what is found.
fn all_of(file: &str) -> Result<bool, CheckError> {
    let running = Running {
        program: Box::new(|| {
            let mut program = Command::new(std::env::current_exe().unwrap_or_default());
            program.arg(TRIAL);
            program
        }),
        limit: Running::LIMIT,
        with_tool: false,
    };
    let findings = check(Path::new(file), Some(&running))?;
    for Finding {
        rule,
        element,
        what,
        line,
    } in &findings.0
    {
        let line = line.map_or_else(String::new, |line| format!(":{line}"));
        let text = format!("{file}{line}: {} {}: {element}: {what}", rule.severity.name(), rule.id);
        say(&mut std::io::stdout(), &text);
    }
    Ok(findings.count(Severity::Error) > 0)
}

/// Nobody can be told when that fails.
fn say(out: &mut dyn Write, text: &str) {
    let _ = writeln!(out, "{text}");
}
