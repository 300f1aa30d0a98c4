//! What a command says: text for people, or one JSON document for programs.

use std::io::Write;

use serde::Serialize;
use serde_json::{Map, Value};

use crate::HarnessError;

/// Where a command's results go.
pub(crate) struct Out<'a> {
    writer: &'a mut dyn Write,
    /// What is told instead of text.
    told: Option<Map<String, Value>>,
}

impl<'a> Out<'a> {
    /// * `json`: a document at the end instead of lines as they come.
    pub(crate) fn new(writer: &'a mut dyn Write, json: bool) -> Self {
        Self {
            writer,
            told: json.then(Map::new),
        }
    }

    /// A line, or several, for people.
    ///
    /// # Errors
    /// [`HarnessError::Write`].
    pub(crate) fn say(&mut self, text: &str) -> Result<(), HarnessError> {
        if self.told.is_some() {
            return Ok(());
        }
        self.line(text)
    }

    /// A fact for programs.
    ///
    /// # Errors
    /// [`HarnessError::Json`].
    pub(crate) fn tell(&mut self, name: &str, value: impl Serialize) -> Result<(), HarnessError> {
        if let Some(told) = &mut self.told {
            told.insert(name.to_owned(), serde_json::to_value(value)?);
        }
        Ok(())
    }

    /// Writes the document, if it is one.
    ///
    /// # Errors
    /// [`HarnessError::Json`], [`HarnessError::Write`].
    pub(crate) fn end(mut self) -> Result<(), HarnessError> {
        match self.told.take() {
            Some(told) => self.line(&serde_json::to_string_pretty(&told)?),
            None => Ok(()),
        }
    }

    /// Forgets what was told: an error takes its place.
    ///
    /// * returns: whether there is a document at all.
    pub(crate) fn start_over(&mut self) -> bool {
        self.told.as_mut().map(Map::clear).is_some()
    }

    fn line(&mut self, text: &str) -> Result<(), HarnessError> {
        writeln!(self.writer, "{text}").map_err(|source| HarnessError::Write {
            path: "the output".into(),
            source,
        })
    }
}
