//! `check`: FMUs against the standard.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use fmi2_check::{Finding, Findings, Rule, Running, Severity};
use serde_json::json;

use super::out::Out;
use super::preload::{PRELOAD, preloaded};
use super::shared::Verdict;
use crate::HarnessError;
use crate::cli::{CheckArgs, CheckTrialArgs};
use crate::format::TERMINAL;

/// Breaches of one rule that are shown, unless all are asked for.
const SHOWN: usize = 5;

pub(super) fn check(args: &CheckArgs, out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    if args.rules {
        return rules(out);
    }
    let running = if args.no_run { None } else { Some(running(args)?) };
    let mut told = Vec::new();
    let mut broken = false;
    for (place, file) in args.files.iter().enumerate() {
        let findings = fmi2_check::check(file, running.as_ref())?;
        broken |= findings.count(Severity::Error) > 0;
        if place > 0 {
            out.say("")?;
        }
        show(file, &findings, args.all, out)?;
        told.push(json!({
            "file": file,
            "errors": findings.count(Severity::Error),
            "warnings": findings.count(Severity::Warning),
            "notes": findings.count(Severity::Note),
            "findings": findings,
        }));
    }
    out.tell("files", told)?;
    Ok(if broken { Verdict::StandardBroken } else { Verdict::Done })
}

/// A process of this program that makes one trial of a library.
pub(super) fn trial(args: &CheckTrialArgs) -> Result<Verdict, HarnessError> {
    fmi2_check::serve(&args.job, &args.trial)?;
    Ok(Verdict::Done)
}

fn running(args: &CheckArgs) -> Result<Running, HarnessError> {
    let own = std::env::current_exe().map_err(|source| HarnessError::Read {
        path: "the path of this program".into(),
        source,
    })?;
    let scratch = tempfile::env::temp_dir();
    let preload = preloaded(&args.preload)?;
    let program = move || {
        let mut command = Command::new(&own);
        command.arg("check-trial").env("TMPDIR", &scratch);
        if !preload.is_empty() {
            command.env(PRELOAD, &preload);
        }
        command
    };
    Ok(Running {
        program: Box::new(program),
        limit: Duration::from_secs_f64(args.limit),
        with_tool: args.with_tool,
    })
}

fn rules(out: &mut Out<'_>) -> Result<Verdict, HarnessError> {
    let all: Vec<&Rule> = fmi2_check::rules::all().collect();
    for rule in &all {
        out.say(&headline(rule))?;
        out.say(&indented(rule.demands, "  "))?;
    }
    let told = all.iter().map(|rule| {
        json!({
            "rule": rule.id,
            "severity": rule.severity,
            "section": rule.section,
            "demands": rule.demands,
            "advice": rule.advice,
        })
    });
    out.tell("rules", told.collect::<Vec<_>>())?;
    Ok(Verdict::Done)
}

fn headline(rule: &Rule) -> String {
    format!("{:8} {:34} FMI 2.0.4, {}", rule.severity.name(), rule.id, rule.section)
}

fn show(file: &Path, findings: &Findings, all: bool, out: &mut Out<'_>) -> Result<(), HarnessError> {
    let counts = [Severity::Error, Severity::Warning, Severity::Note].map(|severity| {
        let count = findings.count(severity);
        format!("{count} {}{}", severity.name(), if count == 1 { "" } else { "s" })
    });
    out.say(&textwrap::fill(
        &format!("{}: {}", file.display(), counts.join(", ")),
        TERMINAL,
    ))?;
    // Rules in the order of their first breach, which is the worst first.
    let mut by_rule: Vec<(&Rule, Vec<&Finding>)> = Vec::new();
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    for finding in &findings.0 {
        let place = *places.entry(finding.rule.id).or_insert_with(|| {
            by_rule.push((finding.rule, Vec::new()));
            by_rule.len() - 1
        });
        by_rule[place].1.push(finding);
    }
    for (rule, breaches) in by_rule {
        out.say(&headline(rule))?;
        let shown = if all { breaches.len() } else { SHOWN };
        for finding in breaches.iter().take(shown) {
            let line = finding.line.map_or_else(String::new, |line| format!(" (line {line})"));
            out.say(&indented(&format!("{}{line}: {}", finding.element, finding.what), "  "))?;
        }
        if let Some(more) = breaches.len().checked_sub(shown).filter(|more| *more > 0) {
            out.say(&format!("  and {more} more, which --all shows"))?;
        }
        out.say(&indented(rule.advice, "  -> "))?;
    }
    Ok(())
}

fn indented(text: &str, first: &str) -> String {
    let further = " ".repeat(first.len() + 2);
    let options = textwrap::Options::new(TERMINAL)
        .initial_indent(first)
        .subsequent_indent(&further);
    textwrap::fill(text, options)
}
