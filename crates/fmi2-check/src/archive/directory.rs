//! Names in the archive's own list, in which one may stand twice: readers keep only the last of equal names.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use crate::finding::Findings;
use crate::rules::archive as rules;

/// Longest end of an archive: its record and a comment.
const TAIL: u64 = 22 + 65_535;

/// Every name of the central directory; nothing where it is of the 64-bit kind or not as it should be.
pub(super) fn names(file: &mut File) -> io::Result<Option<Vec<String>>> {
    let length = file.seek(SeekFrom::End(0))?;
    let begin = length.saturating_sub(TAIL);
    file.seek(SeekFrom::Start(begin))?;
    let mut tail = Vec::new();
    file.read_to_end(&mut tail)?;
    let Some(at) = tail.windows(4).rposition(|w| w == b"PK\x05\x06") else {
        return Ok(None);
    };
    let (Some(count), Some(size)) = (number(&tail, at + 10, 2), number(&tail, at + 12, 4)) else {
        return Ok(None);
    };
    let Some(start) = (begin + at as u64).checked_sub(size as u64) else {
        return Ok(None);
    };
    file.seek(SeekFrom::Start(start))?;
    let mut list = vec![0; size];
    if file.read_exact(&mut list).is_err() {
        return Ok(None);
    }
    file.rewind()?;
    Ok(entries(&list, count))
}

fn entries(list: &[u8], count: usize) -> Option<Vec<String>> {
    let mut found = Vec::new();
    let mut at = 0;
    for _ in 0..count {
        if list.get(at..at + 4)? != b"PK\x01\x02" {
            return None;
        }
        let length = |place| number(list, at + place, 2);
        let (name, extra, comment) = (length(28)?, length(30)?, length(32)?);
        let bytes = list.get(at + 46..at + 46 + name)?;
        found.push(String::from_utf8_lossy(bytes).into_owned());
        at += 46 + name + extra + comment;
    }
    Some(found)
}

/// A little-endian number of some bytes.
fn number(bytes: &[u8], at: usize, length: usize) -> Option<usize> {
    let bytes = bytes.get(at..at + length)?;
    Some(bytes.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte)))
}

/// Finds names that are the same, or would be on a system that ignores case.
pub(super) fn check(names: &[String], findings: &mut Findings) {
    let mut seen: BTreeMap<String, &str> = BTreeMap::new();
    for name in names {
        if let Some(other) = seen.insert(name.to_lowercase(), name) {
            let what = if other == name {
                "there are two entries of this name".to_owned()
            } else {
                format!("it differs from {other} in upper and lower case only")
            };
            findings.add(&rules::DUPLICATE, name, what);
        }
    }
}
