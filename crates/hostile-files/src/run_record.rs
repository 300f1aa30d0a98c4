//! Journals of finished runs, and the runs in them.

use nalgebra::Vector3;
use study::{Journal, Outcome, Part, PathPoint, Quantity, Record, RunRow, SlaveTime};

use crate::cage::{Cage, cage};
use crate::{Kind, told};

pub(crate) const KIND: Kind = Kind {
    name: "run-record",
    feed,
    seeds,
};

/// What tells the study of these journals from any other.
const IDENTITY: &str = "a study";

/// Marks bytes as a whole journal; others are the contents of one frame, which gets a head with the right length and checksum.
const WHOLE: &[u8] = b"rnt-run";

fn feed(bytes: &[u8]) {
    let cage = cage();
    let whole = if bytes.starts_with(WHOLE) {
        bytes.to_vec()
    } else {
        let mut whole = journal(&cage, &[]);
        whole.extend(b"run:");
        whole.extend((bytes.len() as u32).to_le_bytes());
        whole.extend(crc32fast::hash(bytes).to_le_bytes());
        whole.extend(bytes);
        whole
    };
    let path = cage.put("given.journal", &whole);
    match Journal::open(&path, IDENTITY) {
        Ok(journal) => {
            let runs = journal.runs();
            for run in runs.iter().take(20) {
                match journal.read(*run) {
                    Ok(found) => {
                        let outcome = found.expect("a run that is listed is there");
                        // Whether it belongs to a study of these lengths is told, not tried.
                        let _ = outcome.fits(*run, 1, 3);
                    }
                    Err(error) => told(&error, "given.journal"),
                }
            }
            // It goes on from there.
            journal.append(&outcome(7)).unwrap();
            assert!(journal.read(7).unwrap().is_some());
        }
        Err(error) => told(&error, "given.journal"),
    }
    cage.check(&[&path]);
}

/// A journal with these runs.
fn journal(cage: &Cage, runs: &[Outcome]) -> Vec<u8> {
    let path = cage.put("made.journal", &[]);
    let journal = Journal::open(&path, IDENTITY).unwrap();
    runs.iter().for_each(|run| journal.append(run).unwrap());
    let bytes = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    bytes
}

fn outcome(run: u32) -> Outcome {
    let records = (0..3).map(|epoch| {
        let mut record = Record::new(epoch);
        record.set(
            Quantity::Position,
            Some(Vector3::new(1.0, -0.0, 2.0)),
            Some(Vector3::repeat(4.0)),
        );
        record.set_nees(Some(0.3), None);
        record
    });
    Outcome {
        run,
        steps: 7,
        truth_time: SlaveTime::default(),
        path: vec![PathPoint {
            epoch: 0,
            relative: Vector3::zeros(),
            chaser: None,
        }],
        messages: vec!["nav: lacks conviction".to_owned()],
        parts: vec![Part {
            row: RunRow {
                run,
                rmse: [Some(1.0), None, None],
                mean_squares: [Some(Vector3::zeros()), None, None],
                true_acceleration_mean_square: None,
                nees: Some(0.3),
                nees6: None,
                nis: None,
                diverged: false,
                calculated: vec![("nav.s".to_owned(), 1e-6)],
                missing: 0,
                failure: None,
            },
            records: records.collect(),
            time: SlaveTime::default(),
        }],
    }
}

fn seeds() -> Vec<(String, Vec<u8>)> {
    let cage = cage();
    let empty = journal(&cage, &[]);
    let one = journal(&cage, &[outcome(0)]);
    // Behind mark, length and checksum.
    let frame = one[empty.len() + 12..].to_vec();
    vec![
        ("empty".to_owned(), empty),
        ("one".to_owned(), one),
        (
            "three".to_owned(),
            journal(&cage, &[outcome(2), outcome(0), outcome(2)]),
        ),
        ("frame".to_owned(), frame),
    ]
}
