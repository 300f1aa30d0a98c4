//! Archives as no tool packs them, byte by byte.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// A description that any master takes.
pub(crate) const DESCRIPTION: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="tank" guid="{tank-1}">
  <CoSimulation modelIdentifier="tank"/>
  <ModelVariables><ScalarVariable name="level" valueReference="1" causality="output"><Real/></ScalarVariable></ModelVariables>
  <ModelStructure><Outputs><Unknown index="1"/></Outputs></ModelStructure>
</fmiModelDescription>
"#;

/// An archive of entries that are packed as a tool packs them.
pub fn deflated(entries: &[(&str, &[u8])]) -> Vec<u8> {
    packed(entries, CompressionMethod::Deflated)
}

/// An archive of entries that are stored as they are.
pub fn stored(entries: &[(&str, &[u8])]) -> Vec<u8> {
    packed(entries, CompressionMethod::Stored)
}

fn packed(entries: &[(&str, &[u8])], method: CompressionMethod) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(method)
        .last_modified_time(zip::DateTime::default());
    for (name, contents) in entries {
        zip.start_file(*name, options).unwrap();
        zip.write_all(contents).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// One entry of an archive that is written by hand, and what it says of itself.
#[derive(Debug, Clone)]
pub struct Entry<'a> {
    /// Its name, as bytes.
    pub name: &'a [u8],
    /// What stands in the archive.
    pub contents: &'a [u8],
    /// 0: stored, 8: deflated.
    pub method: u16,
    /// Length that it claims to unpack to.
    pub length: u32,
    /// Checksum that it claims.
    pub crc: u32,
    /// Unix mode, as of `stat`; what it is.
    pub mode: u32,
    /// The entry, by its place, whose bytes it shares instead of its own.
    pub shares: Option<usize>,
}

impl<'a> Entry<'a> {
    /// An honest one, stored.
    pub fn of(name: &'a [u8], contents: &'a [u8]) -> Self {
        Self {
            name,
            contents,
            method: 0,
            length: contents.len() as u32,
            crc: crc32fast::hash(contents),
            mode: 0o100_644,
            shares: None,
        }
    }
}

/// An archive of such entries.
pub fn by_hand(entries: &[Entry<'_>]) -> Vec<u8> {
    let (mut bytes, mut list) = (Vec::new(), Vec::new());
    let mut places: Vec<u32> = Vec::new();
    for entry in entries {
        let own = bytes.len() as u32;
        let at = entry.shares.map_or(own, |other| places[other]);
        places.push(at);
        // From "version needed" to "extra length" both headers say the same.
        let mut common = Vec::new();
        common.extend(20_u16.to_le_bytes());
        common.extend(0_u16.to_le_bytes());
        common.extend(entry.method.to_le_bytes());
        common.extend([0, 0, 0x21, 0]);
        common.extend(entry.crc.to_le_bytes());
        common.extend((entry.contents.len() as u32).to_le_bytes());
        common.extend(entry.length.to_le_bytes());
        common.extend((entry.name.len() as u16).to_le_bytes());
        common.extend(0_u16.to_le_bytes());
        if entry.shares.is_none() {
            bytes.extend(b"PK\x03\x04");
            bytes.extend(&common);
            bytes.extend(entry.name);
            bytes.extend(entry.contents);
        }
        // Made by Unix, so that the mode counts.
        list.extend(b"PK\x01\x02\x14\x03");
        list.extend(&common);
        list.extend([0; 6]);
        list.extend((entry.mode << 16).to_le_bytes());
        list.extend(at.to_le_bytes());
        list.extend(entry.name);
    }
    let begin = bytes.len() as u32;
    bytes.extend(&list);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend((entries.len() as u16).to_le_bytes());
    bytes.extend((entries.len() as u16).to_le_bytes());
    bytes.extend((list.len() as u32).to_le_bytes());
    bytes.extend(begin.to_le_bytes());
    bytes.extend(0_u16.to_le_bytes());
    bytes
}

/// Zeros, deflated: a thousand times as many as bytes of the stream.
pub fn zeros(count: usize) -> Vec<u8> {
    let name = "z";
    let whole = deflated(&[(name, &vec![0; count])]);
    // Behind the local header and the name, up to the central directory.
    let begin = 30 + name.len();
    let end = whole.windows(4).rposition(|w| w == b"PK\x01\x02").unwrap();
    // A streamed entry has its lengths behind it; the writer here can seek and has none.
    whole[begin..end].to_vec()
}

/// Archives that no master should take, each an FMU but for its fault, and all of them small.
pub fn hostile() -> Vec<(&'static str, Vec<u8>)> {
    let description = Entry::of(b"modelDescription.xml", DESCRIPTION.as_bytes());
    let with = |entries: &[Entry<'_>]| by_hand(&[std::slice::from_ref(&description), entries].concat());
    let named = |name: &'static [u8]| with(&[Entry::of(name, b"x")]);
    let mut all: Vec<(&'static str, Vec<u8>)> = vec![
        ("dots", named(b"resources/../../evil.txt")),
        ("dots-first", named(b"../evil.txt")),
        ("dots-backslash", named(b"resources\\..\\..\\evil.txt")),
        ("absolute", named(b"/evil.txt")),
        ("drive", named(b"C:\\evil.txt")),
        ("share", named(b"\\\\host\\share\\evil.txt")),
        ("nul", named(b"resources/a\0b")),
        ("dot-dot-alone", named(b"..")),
        (
            "link",
            with(&[Entry {
                mode: 0o120_777,
                ..Entry::of(b"resources/evil", b"/etc/passwd")
            }]),
        ),
        (
            "through-a-link",
            with(&[
                Entry {
                    mode: 0o120_777,
                    ..Entry::of(b"resources/out", b"../../..")
                },
                Entry::of(b"resources/out/evil.txt", b"x"),
            ]),
        ),
        (
            "twice",
            with(&[Entry::of(b"resources/a", b"x"), Entry::of(b"resources/a", b"y")]),
        ),
        ("described-twice", with(std::slice::from_ref(&description))),
        (
            "twice-by-slashes",
            with(&[Entry::of(b"resources/a", b"x"), Entry::of(b"resources\\a", b"y")]),
        ),
        (
            "twice-by-dots",
            with(&[Entry::of(b"resources/a", b"x"), Entry::of(b"resources/./b/../a", b"y")]),
        ),
        (
            "twice-by-bytes",
            with(&[Entry::of(b"resources/\xfe", b"x"), Entry::of(b"resources/\xff", b"y")]),
        ),
        (
            "shared-bytes",
            with(&[
                Entry::of(b"resources/a", b"x"),
                Entry {
                    shares: Some(1),
                    ..Entry::of(b"resources/b", b"x")
                },
            ]),
        ),
        (
            "wrong-crc",
            with(&[Entry {
                crc: 7,
                ..Entry::of(b"resources/a", b"x")
            }]),
        ),
        (
            "described-with-wrong-crc",
            by_hand(&[Entry {
                crc: 7,
                ..description.clone()
            }]),
        ),
        (
            "unknown-method",
            with(&[Entry {
                method: 99,
                ..Entry::of(b"resources/a", b"x")
            }]),
        ),
        (
            "no-deflate-stream",
            with(&[Entry {
                method: 8,
                ..Entry::of(b"resources/a", b"not deflated")
            }]),
        ),
        (
            "file-as-folder",
            with(&[Entry::of(b"resources/a", b"x"), Entry::of(b"resources/a/b", b"y")]),
        ),
    ];
    let zeros = zeros(1 << 20);
    all.push((
        "length-that-lies",
        with(&[Entry {
            method: 8,
            length: 3,
            crc: 0,
            ..Entry::of(b"resources/a", &zeros)
        }]),
    ));
    all
}
