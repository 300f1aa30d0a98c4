//! Studies that are killed, stopped, split and begun twice: what is finished stays finished, and the bytes are those of a study
//! that nobody disturbed.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod common;

use common::{command, harness, harness_ok, in_shell, results};
use rand::RngExt;
use std::io::Read;
use std::path::Path;
use std::process::{Child, ExitStatus, Stdio};
use std::time::{Duration, Instant};

const STUDY: [&str; 7] = study("60");

/// The same, so long that whatever happens to it happens before it is over.
const LONG: [&str; 7] = study("3000");

const fn study(runs: &str) -> [&str; 7] {
    [
        "compare",
        "--scenario",
        "leo_venting",
        "--filters",
        "fixed_q,snc",
        "--runs",
        runs,
    ]
}

/// How long to wait for what must happen, on a machine with much else to do.
const PATIENCE: Duration = Duration::from_secs(120);

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A study at work, which does not outlive its test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn start(study: &[&str], out: &Path, more: &[&str]) -> Running {
    let arguments = [study, more, &["--out", text(out)]].concat();
    let mut command = command(&arguments);
    Running(command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap())
}

fn signal(study: &Running, name: &str) {
    let sent = std::process::Command::new("kill")
        .args([&format!("-{name}"), &study.0.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

fn ended(mut study: Running) -> (ExitStatus, String) {
    wait_until(&mut study, "it did not end", || false);
    let mut said = String::new();
    study.0.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    (study.0.wait().unwrap(), said)
}

/// Waits until something has happened or the study is over, whichever comes first.
fn wait_until(study: &mut Running, otherwise: &str, happened: impl Fn() -> bool) {
    let begun = Instant::now();
    while !happened() && study.0.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < PATIENCE, "{otherwise} in {PATIENCE:?}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Finished runs of a folder, as whoever goes on finds them.
fn finished(folder: &Path) -> usize {
    let kept = folder.join(".unfinished");
    let Ok(identity) = std::fs::read_to_string(kept.join("identity")) else {
        return 0;
    };
    let journal = kept.join("leo_venting_nominal.journal");
    study::Journal::open(&journal, &identity).unwrap().runs().len()
}

/// Size of the journals of a folder.
fn journal(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder.join(".unfinished"))
        .into_iter()
        .flatten()
        .flatten();
    let journals = entries.filter(|e| e.path().extension().is_some_and(|e| e == "journal"));
    // One that is cleared up meanwhile is none.
    journals.filter_map(|e| Some(e.metadata().ok()?.len())).sum()
}

/// Waits until the journals of a folder hold more than `size`, or the study is over.
fn wait_for_more(study: &mut Running, out: &Path, size: u64) {
    wait_until(study, "no run was kept", || journal(out) > size);
}

#[test]
fn killed_at_any_moment_a_study_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, killed) = (folder.path().join("whole"), folder.path().join("killed"));
    harness_ok(&[&STUDY[..], &["--out", text(&whole)]].concat());
    let expected = results(&whole);
    assert!(expected.contains_key("runs.csv") && !whole.join(".unfinished").exists());
    let mut moments = numerics::stream(8, 0, numerics::Source::Search);
    let (mut grown, mut last) = (0, 0);
    for time in 0..24 {
        let mut child = start(&STUDY, &killed, if time == 0 { &[] } else { &["--resume"] });
        // Now while it sets itself up, now among its runs: by what has happened, since how fast it goes differs.
        if time % 3 != 2 {
            wait_for_more(&mut child, &killed, journal(&killed));
        }
        let moment = Duration::from_millis(moments.random_range(0..60));
        std::thread::sleep(moment);
        drop(child);
        if killed.join("manifest.json").exists() {
            break;
        }
        let kept = finished(&killed);
        assert!(kept >= last, "what was finished is lost after {moment:?}");
        grown += u32::from(kept > last);
        last = kept;
    }
    assert!(grown >= 3, "killed among its runs {grown} times");
    // Without --resume nothing is thrown away.
    if killed.join(".unfinished/identity").exists() {
        let (status, said) = ended(start(&STUDY, &killed, &[]));
        assert!(
            status.code() == Some(2) && said.contains("--resume") && said.contains("--force"),
            "{said}"
        );
    }
    harness_ok(&[&STUDY[..], &["--resume", "--out", text(&killed)]].concat());
    assert!(results(&killed) == expected, "bytes differ");
    assert!(!killed.join(".unfinished").exists());
    // Once more: it is complete, and stays as it is.
    let said = harness_ok(&[&STUDY[..], &["--resume", "--out", text(&killed)]].concat());
    assert!(said.contains("complete"), "{said}");
    // Killed while it cleared up after itself, it is complete too, and whoever comes next clears up.
    std::fs::create_dir(killed.join(".unfinished")).unwrap();
    std::fs::write(killed.join(".unfinished/leo_venting_nominal.journal"), "").unwrap();
    let said = harness_ok(&[&STUDY[..], &["--resume", "--out", text(&killed)]].concat());
    assert!(
        said.contains("complete") && !killed.join(".unfinished").exists(),
        "{said}"
    );
    // Its runs are those of a study with other requirements, but it was not judged by them.
    let other = ["--resume", "--require", "metric = \"pos_rmse_m\", at_most = 5"];
    let refused = harness(&[&STUDY[..], &other, &["--out", text(&killed)]].concat());
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("other requirements"), "{said}");
}

#[test]
fn asked_to_stop_a_study_ends_at_once_and_says_how_to_go_on() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["INT", "TERM"] {
        let out = folder.path().join(name);
        let mut child = start(&LONG, &out, &[]);
        wait_for_more(&mut child, &out, 1_000_000);
        // Held while it is asked, so that what it keeps from here on it keeps in spite of that, however slow the machine is.
        signal(&child, "STOP");
        let before = journal(&out);
        signal(&child, name);
        signal(&child, "CONT");
        let (status, said) = ended(child);
        assert_eq!(status.code(), Some(130), "{said}");
        assert!(said.contains("--resume"), "{said}");
        let (size, kept) = (journal(&out), finished(&out));
        assert!(kept > 0, "what was finished is lost");
        // Runs under way are broken off at their next step; of as many as five the two threads may have been at the end.
        let more = (size - before) as f64 / (size as f64 / kept as f64);
        assert!(more < 5.0, "{more:.1} runs were kept after {name}");
    }
}

/// Who asks twice waits for nothing, and what was finished is kept.
#[test]
fn asked_twice_a_study_ends_at_once_and_can_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("twice");
    let mut child = start(&LONG, &out, &[]);
    wait_for_more(&mut child, &out, 1_000_000);
    signal(&child, "INT");
    signal(&child, "INT");
    let (status, said) = ended(child);
    assert_eq!(status.code(), Some(130), "{said}");
    let size = journal(&out);
    assert!(size >= 1_000_000, "{size}");
    let refused = harness(&[&LONG[..], &["--seed", "2", "--out", text(&out)]].concat());
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("another study"), "{said}");
}

/// A folder that goes elsewhere while a study works in it.
#[test]
fn a_folder_that_goes_takes_what_is_finished_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let (out, elsewhere) = (folder.path().join("gone"), folder.path().join("elsewhere"));
    let mut child = start(&LONG, &out, &[]);
    wait_for_more(&mut child, &out, 0);
    std::fs::rename(&out, &elsewhere).unwrap();
    signal(&child, "INT");
    let (status, said) = ended(child);
    assert_eq!(status.code(), Some(130), "{said}");
    assert!(elsewhere.join(".unfinished").exists());
}

#[test]
fn a_folder_belongs_to_one_study_and_one_process() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("mine");
    let mut first = start(&LONG, &out, &[]);
    wait_for_more(&mut first, &out, 0);
    let (status, said) = ended(start(&LONG, &out, &["--resume"]));
    assert!(status.code() == Some(2) && said.contains("in use"), "{said}");
    drop(first);
    let other = [&STUDY[..], &["--seed", "2", "--out", text(&out)]].concat();
    let refused = harness(&other);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(
        refused.status.code() == Some(2) && said.contains("another study") && said.contains("--force"),
        "{said}"
    );
    assert!(journal(&out) > 0);
    harness_ok(&[&other[..], &["--force"]].concat());
    let aside = folder.path().join("mine.old-1");
    assert!(journal(&aside) > 0 && out.join("manifest.json").exists());
    // A complete study of another kind is refused alike.
    let refused = harness(&[&STUDY[..], &["--out", text(&out)]].concat());
    assert_eq!(refused.status.code(), Some(2));
}

/// A folder with all that is in it.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().map(Result::unwrap) {
        let there = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &there);
        } else {
            std::fs::copy(entry.path(), there).unwrap();
        }
    }
}

#[test]
fn parts_merged_are_the_bytes_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    let study = [
        "compare",
        "--scenario",
        "leo_venting,nrho_venting",
        "--filters",
        "snc",
        "--runs",
        "7",
    ];
    let part = |shard: &str| harness_ok(&[&study[..], &["--shard", shard, "--out", text(&parts)]].concat());
    harness_ok(&[&study[..], &["--out", text(&whole)]].concat());
    part("2/3");
    part("1/3");
    let early = harness(&["merge", text(&parts)]);
    let said = String::from_utf8(early.stderr).unwrap();
    assert!(early.status.code() == Some(2) && said.contains("2 of 7 runs"), "{said}");
    part("3/3");
    let (shards, kept) = (parts.join("shards"), folder.path().join("kept"));
    copy(&shards, &kept);
    harness_ok(&["merge", text(&parts)]);
    assert!(results(&parts) == results(&whole), "bytes differ");
    // Killed before the parts were removed: they go, and nothing else happens.
    copy(&kept, &shards);
    let again = harness_ok(&["merge", text(&parts)]);
    assert!(again.contains("holds this study, complete"), "{again}");
    assert!(results(&parts) == results(&whole) && !shards.exists());
    assert!(!parts.join(".unfinished").exists());
    let none = harness(&["merge", text(&whole)]);
    assert_eq!(none.status.code(), Some(2));
}

/// A disk that is full: what is finished is kept, and the message says so.
#[test]
fn a_full_disk_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("full");
    let arguments = [&STUDY[..], &["--out", text(&out)]].concat();
    let command = command(&arguments);
    // A limit on the size of a file stands in for the disk.
    // In blocks of 512 bytes: 15 MB, the FMUs unpacked and some runs.
    let output = in_shell("trap '' XFSZ; ulimit -f 30000", &command).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        output.status.code() == Some(2) && said.contains("every finished run before it is safe"),
        "{said}"
    );
    let kept = journal(&out);
    assert!(kept > 1_000_000, "{kept}");
    harness_ok(&[&arguments[..], &["--resume"]].concat());
    let whole = folder.path().join("whole");
    harness_ok(&[&STUDY[..], &["--out", text(&whole)]].concat());
    assert!(results(&out) == results(&whole), "bytes differ");
}
