//! Every reader of files of this project, one function for each kind of file, fed with what nobody should have written.
//!
//! A function takes bytes, hands them to the reader and panics where the reader breaks its promise: an error that does not name the
//! file, something written beside the place meant for it, something left behind. A panic of the reader is one of its own accord. The
//! fuzz targets in `fuzz/` call these functions, and so do the tests of this crate, with every file of `fuzz/corpus` and
//! `fuzz/regressions`, every seed, and every truncation of each: [`KINDS`] lists them all. Nothing of it goes into an FMU or a command.

#![allow(
    clippy::panic,
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a broken promise ends a test or a fuzz run by panic"
)]

mod archive;
mod cage;
mod description;
mod mission;
mod run_record;
pub mod saved_state;
mod study_file;
mod system_structure;
pub mod zips;

/// A kind of file.
#[derive(Debug, Clone, Copy)]
pub struct Kind {
    /// Name of the fuzz target, and of its folders in `fuzz/`.
    pub name: &'static str,
    /// Feeds bytes to the readers; panics where one breaks its promise.
    pub feed: fn(&[u8]),
    /// Good files and near ones to begin with, by name, made from what the project has.
    pub seeds: fn() -> Vec<(String, Vec<u8>)>,
}

/// All of them.
pub const KINDS: &[Kind] = &[
    archive::KIND,
    description::KIND,
    system_structure::KIND,
    mission::KIND,
    study_file::KIND,
    run_record::KIND,
    saved_state::KIND,
];

/// The kind of a name.
///
/// # Panics
/// Where there is none.
pub fn kind(name: &str) -> &'static Kind {
    let found = KINDS.iter().find(|kind| kind.name == name);
    found.unwrap_or_else(|| panic!("no kind of file is called {name}"))
}

/// Holds an error to its promise: it names the file, and says something.
fn told(error: &dyn std::error::Error, file: &str) {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(inner) = cause {
        text = format!("{text}: {inner}");
        cause = inner.source();
    }
    assert!(text.contains(file), "an error does not name {file}: {text}");
    assert!(text.len() > file.len() + 10, "an error says nothing: {text}");
}
