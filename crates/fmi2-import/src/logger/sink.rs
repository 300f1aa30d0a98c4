//! Where the messages of one instance go: each kind once, with a count.

use std::collections::VecDeque;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::references::resolved;
use crate::description::ModelDescription;
use crate::status::Status;

/// Kinds of messages kept for each instance; the one not heard for longest makes room.
const KEPT: usize = 256;

/// Messages quoted in an error.
const SHOWN: usize = 5;

/// A message of an FMU, and how often it came.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogMessage {
    /// Status it was logged with.
    pub status: Status,
    /// Category it was logged under; may be empty.
    pub category: String,
    /// The text when it came first, its arguments filled in and variables by name.
    pub text: String,
    /// How often it came since messages were last taken: those of the same status, category and text are one, whatever
    /// numbers stand in it.
    pub count: u64,
}

/// On one line, with the count if it came more than once.
impl fmt::Display for LogMessage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} [{}] {}", self.status, self.category, self.text)?;
        if self.count > 1 {
            write!(f, " (x {})", self.count)?;
        }
        Ok(())
    }
}

/// Where the messages of one instance go. An FMU may log from any of its threads.
#[derive(Debug)]
pub(crate) struct Sink {
    description: Arc<ModelDescription>,
    heard: Mutex<Heard>,
    /// Messages logged so far, dropped ones included.
    logged: AtomicUsize,
}

#[derive(Debug, Default)]
struct Heard {
    kinds: Vec<Kind>,
    /// The last few, each with its number.
    last: VecDeque<(usize, String)>,
}

#[derive(Debug)]
struct Kind {
    message: LogMessage,
    masked: String,
    /// Number of the last one.
    last: usize,
}

impl Sink {
    pub(crate) fn new(description: Arc<ModelDescription>) -> Self {
        Self {
            description,
            heard: Mutex::default(),
            logged: AtomicUsize::new(0),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Heard> {
        // A message list is never half-changed, so a poisoned lock is as good as another.
        self.heard.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn push(&self, status: Status, category: String, message: &str) {
        let text = resolved(message, &self.description);
        let masked = masked(&text);
        let mut heard = self.lock();
        let number = self.logged.fetch_add(1, Ordering::Relaxed);
        if heard.last.len() == SHOWN {
            heard.last.pop_front();
        }
        heard.last.push_back((number, text.clone()));
        let same = |kind: &&mut Kind| {
            let known = &kind.message;
            (known.status, &known.category, &kind.masked) == (status, &category, &masked)
        };
        if let Some(kind) = heard.kinds.iter_mut().find(same) {
            kind.message.count += 1;
            kind.last = number;
            return;
        }
        if heard.kinds.len() == KEPT {
            let oldest = heard.kinds.iter().enumerate().min_by_key(|(_, kind)| kind.last);
            if let Some((place, _)) = oldest {
                heard.kinds.remove(place);
            }
        }
        heard.kinds.push(Kind {
            message: LogMessage {
                status,
                category,
                text,
                count: 1,
            },
            masked,
            last: number,
        });
    }

    /// Takes all messages, in the order in which each came first.
    pub(crate) fn drain(&self) -> Vec<LogMessage> {
        let kinds = std::mem::take(&mut self.lock().kinds);
        kinds.into_iter().map(|kind| kind.message).collect()
    }

    /// A mark to be given to [`Sink::since`].
    pub(crate) fn mark(&self) -> usize {
        self.logged.load(Ordering::Relaxed)
    }

    /// Texts of the last few messages logged after `mark`, oldest first, leaving them in place.
    pub(crate) fn since(&self, mark: usize) -> Vec<String> {
        let heard = self.lock();
        let new = heard.last.iter().filter(|(number, _)| *number >= mark);
        new.map(|(_, text)| text.clone()).collect()
    }
}

/// A text with every number replaced; digits that are part of a name stay.
fn masked(text: &str) -> String {
    let mut mask = String::with_capacity(text.len());
    let mut rest = text;
    let mut in_name = false;
    while let Some(next) = rest.chars().next() {
        let length = if in_name { 0 } else { number(rest) };
        if length > 0 {
            mask.push('\0');
            rest = &rest[length..];
        } else {
            mask.push(next);
            rest = &rest[next.len_utf8()..];
            in_name = next.is_alphanumeric() || next == '_';
        }
    }
    mask
}

/// Bytes of the number that `text` begins with; 0 if it begins with none.
fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let sign = |at: usize| usize::from(matches!(bytes.get(at), Some(b'-' | b'+')));
    let begin = sign(0);
    let whole = digits(begin);
    if whole == 0 {
        return 0;
    }
    let mut end = begin + whole;
    if matches!(bytes.get(end), Some(b'.' | b',')) {
        let fraction = digits(end + 1);
        end += if fraction > 0 { 1 + fraction } else { 0 };
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = sign(end + 1);
        let exponent = digits(end + 1 + sign);
        end += if exponent > 0 { 1 + sign + exponent } else { 0 };
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_masked_and_names_are_not() {
        let same = |a: &str, b: &str| masked(a) == masked(b);
        assert!(same("at 1.5 s", "at 17 s"));
        assert!(same("at -1.5e-12 m", "at +3E5 m"));
        assert!(same("x[1] = 3", "x[27] = 4e0"));
        assert!(same("1", "-2,5"));
        assert!(!same("tank2 is full", "tank3 is full"));
        assert!(!same("at 1 s", "at 1 m"));
        assert!(!same("1.", "1"), "the end of a sentence is no part of the number");
        assert!(!same("2 e", "2e"));
        assert!(same("\u{fc} 1 \u{fc}", "\u{fc} 2 \u{fc}"));
    }
}
