//! Names of variables: the structured convention, and arrays with all their elements.

use std::collections::{BTreeMap, BTreeSet};

use super::view::View;
use crate::finding::Findings;
use crate::rules::variable as rules;

pub(super) fn check(view: &View<'_>, findings: &mut Findings) {
    let structured = view.root.get("variableNamingConvention") == Some("structured");
    let mut arrays: BTreeMap<&str, Vec<(Vec<u32>, usize)>> = BTreeMap::new();
    for variable in &view.variables {
        let name = variable.name;
        if variable.node.get("name").is_some() && (name.trim().is_empty() || name.chars().any(char::is_control)) {
            let what = "the name is empty or has a line break or another control character in it";
            findings.at(variable.node.line, &rules::NAME, variable.called(), what);
        } else if structured && !name.is_empty() {
            if !is_structured(name) {
                let what = "the name does not follow the grammar of structured names";
                findings.at(variable.node.line, &rules::STRUCTURED, variable.called(), what);
            } else if let Some((array, indices)) = element(name) {
                arrays.entry(array).or_default().push((indices, variable.node.line));
            }
        }
    }
    for (array, elements) in arrays {
        of_array(array, &elements, findings);
    }
}

fn of_array(array: &str, elements: &[(Vec<u32>, usize)], findings: &mut Findings) {
    let (first, line) = &elements[0];
    if let Some((odd, line)) = elements.iter().find(|(indices, _)| indices.len() != first.len()) {
        let what = format!("elements have {} and {} indices", first.len(), odd.len());
        findings.at(*line, &rules::ARRAY, array, what);
        return;
    }
    let there: BTreeSet<&Vec<u32>> = elements.iter().map(|(indices, _)| indices).collect();
    let mut whole: u64 = 1;
    for axis in 0..first.len() {
        let along = || there.iter().map(|indices| indices[axis]);
        // Counting from 0 is allowed, and seen.
        let (low, high) = (along().min().unwrap_or(1).min(1), along().max().unwrap_or(1));
        whole = whole.saturating_mul(u64::from(high - low) + 1);
    }
    let count = there.len() as u64;
    if count < whole {
        let what = format!("{count} of {whole} elements are there");
        findings.at(*line, &rules::ARRAY, array, what);
    }
}

/// The array and the indices of a name that ends in indices.
fn element(name: &str) -> Option<(&str, Vec<u32>)> {
    let (array, indices) = name.strip_suffix(']')?.rsplit_once('[')?;
    let indices: Option<Vec<u32>> = indices.split(',').map(|index| index.trim().parse().ok()).collect();
    Some((array, indices?))
}

/// Whether a name follows the grammar: identifiers with dots between, each with indices or none, or the derivative of one.
fn is_structured(name: &str) -> bool {
    match name.strip_prefix("der(").and_then(|inner| inner.strip_suffix(')')) {
        Some(inner) => match inner.rsplit_once(',') {
            // The order of the derivative; a comma may also be inside of indices or quotes.
            Some((identifier, order)) if is_number(order.trim()) => is_identifier(identifier),
            _ => is_identifier(inner),
        },
        None => is_identifier(name),
    }
}

fn is_identifier(text: &str) -> bool {
    let mut rest = text;
    loop {
        let Some(after) = part(rest).and_then(indices) else {
            return false;
        };
        match after.strip_prefix('.') {
            Some(further) => rest = further,
            None => return after.is_empty(),
        }
    }
}

/// What follows the plain or quoted part that a text begins with.
fn part(text: &str) -> Option<&str> {
    let Some(quoted) = text.strip_prefix('\'') else {
        let end = text
            .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .unwrap_or(text.len());
        let good = end > 0 && !text.starts_with(|c: char| c.is_ascii_digit());
        return good.then(|| &text[end..]);
    };
    let mut characters = quoted.char_indices();
    while let Some((at, c)) = characters.next() {
        match c {
            '\'' => return (at > 0).then(|| &quoted[at + 1..]),
            '\\' if !characters.next().is_some_and(|(_, c)| "'\"?\\abfnrtv".contains(c)) => return None,
            c if c.is_control() => return None,
            _ => (),
        }
    }
    None
}

/// What follows the indices that a text begins with, if it does.
fn indices(text: &str) -> Option<&str> {
    let Some(inside) = text.strip_prefix('[') else {
        return Some(text);
    };
    let (indices, after) = inside.split_once(']')?;
    indices.split(',').all(|index| is_number(index.trim())).then_some(after)
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_follow_the_grammar_or_do_not() {
        for good in [
            "a",
            "_a1",
            "a.b.c",
            "a[1]",
            "a[1,2].b[3]",
            "der(a)",
            "der(a.b[1],2)",
            "der(a[1,2])",
            "'a b'.c",
            "'it\\'s'",
            "a[0]",
        ] {
            assert!(is_structured(good), "{good}");
        }
        for bad in [
            "", "1a", "a.", ".a", "a..b", "a b", "a[", "a[x]", "a[]", "a[1]b", "der(a", "der()", "'a", "''", "a-b",
            "a'b'", "'\\x'",
        ] {
            assert!(!is_structured(bad), "{bad}");
        }
    }

    #[test]
    fn elements_of_arrays_are_told_from_other_names() {
        assert_eq!(element("a.b[2, 3]"), Some(("a.b", vec![2, 3])));
        assert_eq!(element("a[1].b"), None);
        assert_eq!(element("a"), None);
    }
}
