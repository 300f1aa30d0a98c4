//! What each command of the command line does.

mod check;
mod compare;
mod files;
mod finished;
mod inspect;
mod kept;
mod list;
mod merge;
mod mission;
mod out;
mod pack;
mod preload;
mod progress;
mod recorded;
mod regret;
mod replay;
mod report;
mod reproduce;
mod rerun;
mod shared;
mod tune;
mod worker;

use std::io;
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser as _};
use study::{StudyError, chain};

use crate::HarnessError;
use crate::cli::{Cli, Command, ListArgs, Listed};
use crate::temporary::Temporary;
use out::Out;
use shared::{INTERRUPTED, Verdict, note};

/// Reads the command line and runs its command; a line that is not understood ends with exit code 2.
pub fn run() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => execute(cli),
        Err(error) => misread(&error),
    }
}

/// Help, version, or what is wrong with the command line: for programs, too, where they asked for a document.
fn misread(error: &clap::Error) -> ExitCode {
    // Nothing is left to do where it cannot be told.
    let _ = error.print();
    if error.use_stderr() && std::env::args().any(|word| word == "--json") {
        let text = error.to_string();
        let text = text.trim().trim_start_matches("error: ");
        let mut stdout = io::stdout().lock();
        let mut out = Out::new(&mut stdout, true);
        let _ = out
            .tell("error", text)
            .and_then(|()| out.tell("causes", [(); 0]))
            .and_then(|()| out.end());
    }
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
}

/// Runs a command: exit code 0 when done, 1 when bounds were missed or a standard is broken, 2 when it could not do its work, 130 when it was asked to
/// stop.
pub fn execute(cli: Cli) -> ExitCode {
    let mut stdout = io::stdout().lock();
    let mut out = Out::new(&mut stdout, cli.json);
    // A worker's is its parent's.
    let _temporary = if matches!(cli.command, Command::Worker(_) | Command::CheckTrial(_)) {
        None
    } else {
        Temporary::begin()
    };
    let result = match cli.command {
        Command::List(args) => list::list(&args, &mut out),
        Command::Pack(args) => pack::pack(&args, &mut out),
        Command::Compare(args) => compare::compare(&args, &mut out),
        Command::Merge(args) => merge::merge(&args, &mut out),
        Command::Report(args) => report::report(&args, &mut out),
        Command::Tune(args) => tune::tune(&args, &mut out),
        Command::Regret(args) => regret::regret(&args, &mut out),
        Command::Replay(args) => replay::replay(&args, &mut out),
        Command::Rerun(args) => rerun::rerun(&args, &mut out),
        Command::Reproduce(args) => reproduce::reproduce(&args, &mut out),
        Command::Inspect(args) => inspect::inspect(&args, &mut out),
        Command::Check(args) => check::check(&args, &mut out),
        Command::Mission(command) => mission::mission(&command, &mut out),
        Command::Columns => list::list(&ListArgs::of(Listed::Metrics), &mut out),
        Command::Completions { shell } => completions(shell, &mut out),
        Command::Worker(args) => worker::worker(&args),
        Command::CheckTrial(args) => check::trial(&args),
    };
    let result = result.and_then(|verdict| out.tell("verdict", verdict).map(|()| verdict));
    let code = match result {
        Ok(Verdict::Done) => ExitCode::SUCCESS,
        Ok(Verdict::BoundsMissed | Verdict::StandardBroken) => ExitCode::from(1),
        // Whoever reads our output has seen enough, as in `list | head`.
        Err(HarnessError::Write { source, .. }) if source.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(HarnessError::Study(error)) if matches!(*error, StudyError::Stopped) => {
            out.start_over();
            note("stopped as asked; every finished run is kept: the same command with --resume goes on");
            ExitCode::from(INTERRUPTED)
        }
        Err(error) => {
            if out.start_over() {
                // Whether or not it can be told.
                let _ = out
                    .tell("error", error.to_string())
                    .and_then(|()| out.tell("causes", causes(&error)));
            }
            note(&format!("error: {}", chain(&error)));
            ExitCode::from(2)
        }
    };
    match out.end() {
        Ok(()) => code,
        Err(HarnessError::Write { source, .. }) if source.kind() == io::ErrorKind::BrokenPipe => code,
        Err(error) => {
            note(&format!("error: {}", chain(&error)));
            ExitCode::from(2)
        }
    }
}

/// A script for a shell.
fn completions(shell: clap_complete::Shell, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    // Written whole first: the generator panics where nobody reads on.
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "trade-harness", &mut script);
    let script = String::from_utf8_lossy(&script);
    out.say(script.trim_end())?;
    out.tell("script", script.trim_end())?;
    Ok(Verdict::Done)
}

/// What lies below an error, from the nearest on.
fn causes(error: &dyn std::error::Error) -> Vec<String> {
    std::iter::successors(error.source(), |cause| cause.source())
        .map(ToString::to_string)
        .collect()
}
