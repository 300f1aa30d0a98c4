//! Archives that nobody should have packed: each is refused with the reason, nothing is written outside and nothing left behind.

#![allow(clippy::print_stdout, reason = "counts, for whoever looks")]
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "what fails in a helper is a failed test"
)]

use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

use fmi2_import::Fmu;
use hostile_files::zips::{Entry, by_hand, deflated, hostile, zeros};
use tempfile::TempDir;

/// Where everything temporary of this process goes.
fn temporary() -> &'static Path {
    static FOLDER: OnceLock<(TempDir, PathBuf)> = OnceLock::new();
    let (_, temporary) = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let temporary = folder.path().join("a/b/c/temporary");
        std::fs::create_dir_all(&temporary).unwrap();
        tempfile::env::override_temp_dir(&temporary).unwrap();
        (folder, temporary)
    });
    temporary
}

/// A folder for files of a test, where no reader puts its own.
fn elsewhere() -> TempDir {
    tempfile::tempdir_in(std::env::temp_dir()).unwrap()
}

/// Opens and unpacks, and says why not.
fn refusal(name: &str, bytes: &[u8]) -> String {
    // One at a time: each is held to leave nothing behind.
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let temporary = temporary();
    let folder = tempfile::tempdir_in(temporary.parent().unwrap()).unwrap();
    let path = folder.path().join(format!("{name}.fmu"));
    std::fs::write(&path, bytes).unwrap();
    let told = match Fmu::open(&path).and_then(|fmu| fmu.unpack()) {
        Ok(_) => panic!("{name} was unpacked"),
        Err(error) => error.to_string(),
    };
    assert!(told.contains(&format!("{name}.fmu")), "{name}: {told}");
    assert_eq!(
        std::fs::read_dir(temporary).unwrap().count(),
        0,
        "{name} left something behind"
    );
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        1,
        "{name} wrote beside itself"
    );
    told
}

/// Rules that the checker finds broken.
fn broken(name: &str, bytes: &[u8]) -> Vec<(String, String)> {
    let folder = elsewhere();
    let path = folder.path().join(format!("{name}.fmu"));
    std::fs::write(&path, bytes).unwrap();
    let findings = fmi2_check::check(&path, None).unwrap_or_else(|error| panic!("{name}: {error}"));
    findings.0.into_iter().map(|f| (f.rule.id.to_owned(), f.what)).collect()
}

#[test]
fn every_hostile_archive_is_refused_by_its_fault() {
    // (archive, what the importer says of it, the rule that the checker finds broken)
    let expected = [
        (
            "dots",
            "\"resources/../../evil.txt\" points outside the archive",
            "archive.path",
        ),
        (
            "dots-first",
            "\"../evil.txt\" points outside the archive",
            "archive.path",
        ),
        ("dots-backslash", "points outside the archive", "archive.path"),
        ("absolute", "\"/evil.txt\" points outside the archive", "archive.path"),
        ("drive", "points outside the archive", "archive.path"),
        ("share", "points outside the archive", "archive.path"),
        ("nul", "points outside the archive", ""),
        ("dot-dot-alone", "points outside the archive", "archive.path"),
        ("link", "\"resources/evil\" is a symbolic link", "archive.link"),
        ("through-a-link", "\"resources/out\" is a symbolic link", "archive.link"),
        ("twice", "two entries have one name", "archive.duplicate"),
        ("described-twice", "two entries have one name", "archive.duplicate"),
        (
            "twice-by-slashes",
            "would be unpacked over another entry",
            "archive.backslash",
        ),
        ("twice-by-dots", "would be unpacked over another entry", "archive.path"),
        ("twice-by-bytes", "would be unpacked over another entry", "archive.name"),
        ("shared-bytes", "two entries share their bytes", "archive.entry"),
        ("wrong-crc", "entry resources/a: Invalid checksum", "archive.entry"),
        (
            "described-with-wrong-crc",
            "entry modelDescription.xml: Invalid checksum",
            "archive.entry",
        ),
        ("unknown-method", "entry resources/a", "archive.entry"),
        ("no-deflate-stream", "entry resources/a", "archive.entry"),
        ("file-as-folder", "cannot unpack", ""),
        ("length-that-lies", "entry resources/a", "archive.entry"),
    ];
    let all = hostile();
    assert_eq!(all.len(), expected.len());
    for ((name, bytes), (known, says, rule)) in all.iter().zip(expected) {
        assert_eq!(*name, known);
        let told = refusal(name, bytes);
        assert!(told.contains(says), "{name}: {told}");
        let rules = broken(name, bytes);
        assert!(
            rule.is_empty() || rules.iter().any(|(id, _)| id == rule),
            "{name}: {rules:?}"
        );
    }
    println!("{} hostile archives refused", all.len());
}

/// 257 MiB of zeros in a quarter of a megabyte, and the same once more as 65 files.
#[test]
fn bombs_are_refused_before_they_fill_the_disk() {
    let description = include_bytes!("../../fmi2-check/tests/good/modelDescription.xml");
    let part = zeros(4 << 20);
    let entry = Entry {
        method: 8,
        length: 4 << 20,
        crc: crc32fast::hash(&vec![0; 4 << 20]),
        ..Entry::of(b"", &part)
    };
    let names: Vec<String> = (0..65).map(|n| format!("resources/{n}")).collect();
    let mut many = vec![Entry::of(b"modelDescription.xml", description)];
    many.extend(names.iter().map(|name| Entry {
        name: name.as_bytes(),
        ..entry.clone()
    }));
    let many = by_hand(&many);
    let one = deflated(&[
        ("modelDescription.xml", description),
        ("resources/0", &vec![0; 257 << 20]),
    ]);
    for (name, bomb) in [("many", many), ("one", one)] {
        assert!(bomb.len() < 1 << 20);
        let told = refusal(name, &bomb);
        assert!(told.contains("exceeds the limit of 268435456 bytes"), "{told}");
        let found = broken(name, &bomb);
        let says = "the archive unpacks to more than 268435456 bytes";
        assert!(
            found.iter().any(|(id, what)| id == "archive.entry" && what == says),
            "{found:?}"
        );
    }
}

/// A directory that is as large as it may be, of entries that are nothing.
#[test]
fn entries_are_counted() {
    let names: Vec<String> = (0..65_000).map(|n| format!("resources/{n}")).collect();
    let entries: Vec<Entry<'_>> = names.iter().map(|name| Entry::of(name.as_bytes(), b"")).collect();
    let told = refusal("entries", &by_hand(&entries));
    assert!(told.contains("holds no modelDescription.xml"), "{told}");
}

#[test]
fn a_system_structure_with_two_entries_of_one_name_is_refused() {
    let folder = elsewhere();
    let path = folder.path().join("two.ssp");
    let twice = [
        Entry::of(b"SystemStructure.ssd", b"<a/>"),
        Entry::of(b"SystemStructure.ssd", b"<b/>"),
    ];
    std::fs::write(&path, by_hand(&twice)).unwrap();
    let told = ssp::Package::open(&path).unwrap_err().to_string();
    assert!(
        told.contains("two.ssp") && told.contains("two entries have one name"),
        "{told}"
    );
    let wrong = [Entry {
        crc: 7,
        ..Entry::of(b"SystemStructure.ssd", b"<a/>")
    }];
    std::fs::write(&path, by_hand(&wrong)).unwrap();
    let error = ssp::Package::open(&path).unwrap_err();
    let told = study::chain(&error);
    assert!(
        told.contains("SystemStructure.ssd") && told.contains("Invalid checksum"),
        "{told}"
    );
}
