//! What a process that runs the library leaves behind, line by line, so that nothing is lost when it dies.

use std::cell::RefCell;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::rule::Rule;

/// Name of the journal of a trial.
pub(super) fn path(folder: &Path, trial: &str) -> PathBuf {
    folder.join(format!("{trial}.journal"))
}

/// File that takes what the process of a trial prints.
pub(super) fn output(folder: &Path, trial: &str) -> PathBuf {
    folder.join(format!("{trial}.out"))
}

#[derive(Debug, Serialize, Deserialize)]
enum Line {
    /// A function is called.
    Calling(String),
    /// Something is found.
    Found {
        rule: String,
        element: String,
        what: String,
    },
    /// The trial is over; whether it went as far as it should.
    Over(bool),
}

/// The writing end.
#[derive(Debug)]
pub(super) struct Journal {
    file: RefCell<File>,
    last: RefCell<&'static str>,
}

impl Journal {
    pub(super) fn begin(path: &Path) -> io::Result<Self> {
        Ok(Self {
            file: RefCell::new(File::create(path)?),
            last: RefCell::new(""),
        })
    }

    /// A function is called now.
    pub(super) fn calling(&self, function: &'static str) {
        if self.last.replace(function) != function {
            self.write(&Line::Calling(function.to_owned()));
        }
    }

    /// Something is found.
    pub(super) fn found(&self, rule: &'static Rule, element: &str, what: impl Into<String>) {
        self.write(&Line::Found {
            rule: rule.id.to_owned(),
            element: element.to_owned(),
            what: what.into(),
        });
    }

    pub(super) fn over(&self, good: bool) {
        self.write(&Line::Over(good));
    }

    /// A journal that cannot be written is found to end too early.
    fn write(&self, line: &Line) {
        if let Ok(mut text) = serde_json::to_vec(line) {
            text.push(b'\n');
            let _ = self.file.borrow_mut().write_all(&text);
        }
    }
}

/// A journal that is read.
#[derive(Debug, Default)]
pub(super) struct Account {
    /// The function that was called last.
    pub(super) last: Option<String>,
    /// Rule, element and what is wrong.
    pub(super) found: Vec<(String, String, String)>,
    /// How the trial ended, if it did.
    pub(super) over: Option<bool>,
}

/// Reads as much as there is; a last line that is cut off is left out.
pub(super) fn read(path: &Path) -> Account {
    let mut account = Account::default();
    let bytes = fs::read(path).unwrap_or_default();
    for line in bytes.split(|b| *b == b'\n') {
        match serde_json::from_slice(line) {
            Ok(Line::Calling(function)) => account.last = Some(function),
            Ok(Line::Found { rule, element, what }) => account.found.push((rule, element, what)),
            Ok(Line::Over(good)) => account.over = Some(good),
            Err(_) => (),
        }
    }
    account
}
