//! Which texts are values of the types that the schema uses.

/// Type of an attribute.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    /// Any text.
    Text,
    /// `xs:double`.
    Double,
    /// `xs:int`.
    Int,
    /// `xs:unsignedInt`.
    Unsigned,
    /// `xs:boolean`.
    Boolean,
    /// `xs:dateTime`.
    DateTime,
    /// One of these words.
    OneOf(&'static [&'static str]),
    /// `xs:unsignedInt`s with spaces between.
    UnsignedList,
    /// Words of these, with spaces between.
    ListOf(&'static [&'static str]),
}

impl Kind {
    /// Whether this text is a value of the type.
    pub(crate) fn takes(self, text: &str) -> bool {
        match self {
            Self::Text => true,
            Self::Double => double(text).is_some(),
            Self::Int => int(text).is_some(),
            Self::Unsigned => unsigned(text).is_some(),
            Self::Boolean => boolean(text).is_some(),
            Self::DateTime => date_time(text.trim()),
            Self::OneOf(words) => words.contains(&text),
            Self::UnsignedList => text.split_whitespace().all(|word| unsigned(word).is_some()),
            Self::ListOf(words) => text.split_whitespace().all(|word| words.contains(&word)),
        }
    }

    /// What it is, for people.
    pub(crate) fn described(self) -> String {
        match self {
            Self::Text => "text".to_owned(),
            Self::Double => "a number (xs:double)".to_owned(),
            Self::Int => "a 32-bit integer (xs:int)".to_owned(),
            Self::Unsigned => "an integer from 0 on (xs:unsignedInt)".to_owned(),
            Self::Boolean => "true or false (xs:boolean)".to_owned(),
            Self::DateTime => "a date and time (xs:dateTime)".to_owned(),
            Self::OneOf(words) => format!("one of {}", words.join(", ")),
            Self::UnsignedList => "a list of integers from 0 on".to_owned(),
            Self::ListOf(words) => format!("a list of {}", words.join(", ")),
        }
    }
}

/// The number that `xs:double` reads.
pub(crate) fn double(text: &str) -> Option<f64> {
    match text.trim() {
        "INF" => Some(f64::INFINITY),
        "-INF" => Some(f64::NEG_INFINITY),
        "NaN" => Some(f64::NAN),
        // Rust reads words that the schema does not know.
        other if other.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c)) => other.parse().ok(),
        _ => None,
    }
}

/// The number that `xs:int` reads.
pub(crate) fn int(text: &str) -> Option<i32> {
    text.trim().parse().ok()
}

/// The number that `xs:unsignedInt` reads.
pub(crate) fn unsigned(text: &str) -> Option<u32> {
    text.trim().parse().ok()
}

/// The truth that `xs:boolean` reads.
pub(crate) fn boolean(text: &str) -> Option<bool> {
    match text.trim() {
        "true" | "1" => Some(true),
        "false" | "0" => Some(false),
        _ => None,
    }
}

/// `YYYY-MM-DDThh:mm:ss`, a fraction, and a zone, both optional.
fn date_time(text: &str) -> bool {
    let Some((date, time)) = text.split_once('T') else {
        return false;
    };
    let (clock, zone) = match time.find(['Z', '+', '-']) {
        Some(at) => time.split_at(at),
        None => (time, ""),
    };
    let (clock, fraction) = clock.split_once('.').unwrap_or((clock, "0"));
    let numbers = |text: &str, separator: char, lengths: &[usize]| -> Option<Vec<u32>> {
        let parts: Vec<&str> = text.split(separator).collect();
        let fits = parts.len() == lengths.len()
            && parts
                .iter()
                .zip(lengths)
                .all(|(part, length)| part.len() == *length && part.bytes().all(|b| b.is_ascii_digit()));
        fits.then(|| parts.iter().filter_map(|part| part.parse().ok()).collect())
    };
    let days = numbers(date.strip_prefix('-').unwrap_or(date), '-', &[4, 2, 2])
        .is_some_and(|d| (1..=12).contains(&d[1]) && (1..=31).contains(&d[2]));
    let hours = numbers(clock, ':', &[2, 2, 2]).is_some_and(|c| c[0] <= 24 && c[1] < 60 && c[2] < 60);
    let zoned = match zone {
        "" | "Z" => true,
        other => numbers(&other[1..], ':', &[2, 2]).is_some_and(|z| z[0] <= 14 && z[1] < 60),
    };
    days && hours && zoned && !fraction.is_empty() && fraction.bytes().all(|b| b.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_values_as_the_schema_language_has_them() {
        for (kind, good, bad) in [
            (
                Kind::Double,
                &["1", "-1.5e-3", ".5", "+2.", "INF", "-INF", "NaN", " 1 "][..],
                &["", "1,5", "inf", "infinity", "nan", "0x1", "1d3", "e", "1 2"][..],
            ),
            (
                Kind::Int,
                &["-2147483648", "+7", "007"],
                &["2147483648", "1.0", "", "1e3"],
            ),
            (Kind::Unsigned, &["0", "4294967295"], &["-1", "4294967296", "a"]),
            (Kind::Boolean, &["true", "false", "1", "0"], &["True", "yes", "", "2"]),
            (
                Kind::DateTime,
                &[
                    "2026-01-31T12:00:00Z",
                    "2026-01-31T12:00:00",
                    "2026-01-31T12:00:00.25+01:00",
                ],
                &[
                    "2026-01-31",
                    "2026-13-31T12:00:00Z",
                    "2026-1-31T12:00:00Z",
                    "31.01.2026 12:00",
                    "2026-01-31T12:00:00.Z",
                ],
            ),
            (Kind::OneOf(&["a", "b"]), &["a"], &["A", "", "a b"]),
            (Kind::UnsignedList, &["", "1 2  3"], &["1,2", "-1"]),
            (Kind::ListOf(&["a", "b"]), &["", "a b a"], &["a,b", "c"]),
        ] {
            for text in good {
                assert!(kind.takes(text), "{kind:?} {text:?}");
            }
            for text in bad {
                assert!(!kind.takes(text), "{kind:?} {text:?}");
            }
        }
    }
}
