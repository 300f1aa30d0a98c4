//! Finished runs in a file that only grows, so that nothing that happens later can take them away.
//!
//! The file is a sequence of frames: a mark, the length of what follows, its checksum, and the run. A frame that was being
//! written when the power went is cut off when the file is opened again; every frame before it stands.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::StudyError;
use crate::outcome::Outcome;

/// Begins a file; the number is that of the format, which is that of [`Outcome`] too.
const HEAD: &[u8; 8] = b"rnt-run\x05";
/// Begins a frame.
const MARK: [u8; 4] = *b"run:";
/// Mark, length and checksum.
const FRAME_HEAD: usize = 12;

/// The runs of one study that are over.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    state: Mutex<State>,
    /// Memory of frames that are written, for the next: they take some megabytes each.
    spare: Mutex<Vec<Vec<u8>>>,
}

/// By run: where its frame's contents begin, and their length.
type Places = BTreeMap<u32, (u64, u32)>;

#[derive(Debug)]
struct State {
    /// `None` while nothing is written: a study of many cases keeps all its journals at hand.
    file: Option<File>,
    /// Where the next frame goes.
    end: u64,
    places: Places,
}

impl Journal {
    /// Opens the journal of a study, or begins it.
    ///
    /// * `identity`: tells this study from any other.
    ///
    /// # Errors
    /// [`StudyError::Journal`]; [`StudyError::OtherJournal`] for that of another study.
    pub fn open(path: &Path, identity: &str) -> Result<Self, StudyError> {
        let failed = |source| StudyError::Journal {
            path: path.to_owned(),
            source,
        };
        let mut options = OpenOptions::new();
        let mut file = options
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        let mut head = HEAD.to_vec();
        head.extend((identity.len() as u32).to_le_bytes());
        head.extend(identity.as_bytes());
        let length = file.metadata().map_err(failed)?.len();
        let mut found = vec![0; head.len().min(length as usize)];
        file.read_exact(&mut found).map_err(failed)?;
        if found != head[..found.len()] {
            return Err(StudyError::OtherJournal { path: path.to_owned() });
        }
        let (end, places) = if found.len() < head.len() {
            file.set_len(0).map_err(failed)?;
            file.seek(SeekFrom::Start(0)).map_err(failed)?;
            file.write_all(&head).map_err(failed)?;
            (head.len() as u64, BTreeMap::new())
        } else {
            let (end, places) = scan(&file, head.len() as u64, length).map_err(failed)?;
            file.set_len(end).map_err(failed)?;
            (end, places)
        };
        Ok(Self {
            path: path.to_owned(),
            state: Mutex::new(State {
                file: Some(file),
                end,
                places,
            }),
            spare: Mutex::default(),
        })
    }

    /// Numbers of the runs that it holds, in order.
    pub fn runs(&self) -> Vec<u32> {
        self.state().places.keys().copied().collect()
    }

    /// A run; `None` for one that it does not hold.
    ///
    /// # Errors
    /// [`StudyError::Journal`].
    pub fn read(&self, run: u32) -> Result<Option<Outcome>, StudyError> {
        let Some((begin, length)) = self.state().places.get(&run).copied() else {
            return Ok(None);
        };
        let mut contents = vec![0; length as usize];
        let read = File::open(&self.path).and_then(|mut file| {
            file.seek(SeekFrom::Start(begin))?;
            file.read_exact(&mut contents)
        });
        read.map_err(|source| self.failed(source))?;
        let outcome = Outcome::from_bytes(&contents);
        outcome
            .map(Some)
            .map_err(|e| self.damaged(format!("run {run} at byte {begin}: {e}")))
    }

    /// Adds a run, whole or not at all.
    ///
    /// # Errors
    /// [`StudyError::Journal`], as when the disk is full; the runs before it stand.
    pub fn append(&self, outcome: &Outcome) -> Result<(), StudyError> {
        let mut head = self.spare().pop().unwrap_or_default();
        head.resize(FRAME_HEAD, 0);
        let mut frame = outcome.to_bytes(head).map_err(|e| self.failed(io::Error::other(e)))?;
        let contents = &frame[FRAME_HEAD..];
        let length = u32::try_from(contents.len()).map_err(|e| self.failed(io::Error::other(e)))?;
        let checksum = crc32fast::hash(contents);
        frame[..4].copy_from_slice(&MARK);
        frame[4..8].copy_from_slice(&length.to_le_bytes());
        frame[8..12].copy_from_slice(&checksum.to_le_bytes());
        let mut state = self.state();
        let begin = state.end;
        let file = match &mut state.file {
            Some(file) => file,
            resting => resting.insert(self.reopened()?),
        };
        let written = file.seek(SeekFrom::Start(begin)).and_then(|_| file.write_all(&frame));
        if let Err(source) = written {
            // What was written of it is cut off at the next opening, if not now.
            let _ = file.set_len(begin);
            return Err(self.failed(source));
        }
        state.end += frame.len() as u64;
        state.places.insert(outcome.run, (begin + FRAME_HEAD as u64, length));
        drop(state);
        frame.clear();
        self.spare().push(frame);
        Ok(())
    }

    /// Lets go of file and memory until the next run is added.
    pub fn rest(&self) {
        self.state().file = None;
        self.spare().clear();
    }

    fn reopened(&self) -> Result<File, StudyError> {
        let file = OpenOptions::new().write(true).open(&self.path);
        file.map_err(|source| self.failed(source))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn spare(&self) -> MutexGuard<'_, Vec<Vec<u8>>> {
        self.spare.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// That a run in it is none of the study, though its checksum is right.
    pub(crate) fn damaged(&self, problem: String) -> StudyError {
        StudyError::DamagedJournal {
            path: self.path.clone(),
            problem,
        }
    }

    fn failed(&self, source: io::Error) -> StudyError {
        StudyError::Journal {
            path: self.path.clone(),
            source,
        }
    }
}

/// Finds the frames from `begin` on, up to the first that is not whole.
fn scan(file: &File, begin: u64, length: u64) -> io::Result<(u64, Places)> {
    let mut reader = BufReader::with_capacity(1 << 20, file);
    reader.seek(SeekFrom::Start(begin))?;
    let (mut end, mut places) = (begin, BTreeMap::new());
    let mut contents = Vec::new();
    loop {
        let mut head = [0; FRAME_HEAD];
        if end + FRAME_HEAD as u64 > length {
            break;
        }
        reader.read_exact(&mut head)?;
        let word = |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
        let size = word(4);
        let next = end + FRAME_HEAD as u64 + u64::from(size);
        if head[..4] != MARK || next > length {
            break;
        }
        contents.resize(size as usize, 0);
        reader.read_exact(&mut contents)?;
        // The number of the run stands first.
        let run = postcard::take_from_bytes::<u32>(&contents).map(|(run, _)| run);
        let (true, Ok(run)) = (crc32fast::hash(&contents) == word(8), run) else {
            break;
        };
        places.insert(run, (end + FRAME_HEAD as u64, size));
        end = next;
    }
    Ok((end, places))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fold::RunRow;
    use crate::outcome::Part;
    use crate::record::{Quantity, Record};
    use crate::run::{Ending, SlaveTime};
    use nalgebra::Vector3;

    fn outcome(run: u32) -> Outcome {
        let mut record = Record::new(3);
        record.set(
            Quantity::Position,
            Some(Vector3::new(f64::from(run), -0.0, f64::MIN_POSITIVE)),
            None,
        );
        record.set_nees(Some(0.1 + 0.2), None);
        Outcome {
            run,
            steps: 7,
            truth_time: SlaveTime::default(),
            path: Vec::new(),
            messages: vec!["snc: is told".to_owned()],
            parts: vec![Part {
                row: RunRow::new(run, &[record], 0, &Ending::default()),
                records: vec![record],
                time: SlaveTime::default(),
            }],
        }
    }

    fn same(a: &Outcome, b: &Outcome) -> bool {
        format!("{a:?}") == format!("{b:?}")
    }

    #[test]
    fn runs_come_back_as_they_went_in_whatever_was_cut_off() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("journal");
        let journal = Journal::open(&path, "mine").unwrap();
        for run in [2, 0, 5] {
            journal.append(&outcome(run)).unwrap();
        }
        assert_eq!(journal.runs(), [0, 2, 5]);
        drop(journal);
        let whole = std::fs::read(&path).unwrap();
        let ends: Vec<usize> = (0..=whole.len())
            .filter(|end| {
                std::fs::write(&path, &whole[..*end]).unwrap();
                let journal = Journal::open(&path, "mine").unwrap();
                let runs = journal.runs();
                // In the order of writing, and whole.
                assert!(
                    [&[][..], &[2], &[0, 2], &[0, 2, 5]].contains(&runs.as_slice()),
                    "{runs:?}"
                );
                assert!(
                    runs.iter()
                        .all(|run| same(&journal.read(*run).unwrap().unwrap(), &outcome(*run)))
                );
                assert!(journal.read(7).unwrap().is_none());
                // It goes on from there.
                journal.append(&outcome(7)).unwrap();
                assert!(same(&journal.read(7).unwrap().unwrap(), &outcome(7)));
                runs.len() == 3
            })
            .collect();
        assert_eq!(ends, [whole.len()]);
    }

    #[test]
    fn a_flipped_bit_costs_what_follows_and_no_more() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("journal");
        let journal = Journal::open(&path, "mine").unwrap();
        (0..3).for_each(|run| journal.append(&outcome(run)).unwrap());
        drop(journal);
        let whole = std::fs::read(&path).unwrap();
        let head = HEAD.len() + 4 + "mine".len();
        for at in (head..whole.len()).step_by(5) {
            let mut changed = whole.clone();
            changed[at] ^= 0x10;
            std::fs::write(&path, &changed).unwrap();
            let runs = Journal::open(&path, "mine").unwrap().runs();
            assert!(
                runs.len() < 3 && (0..).zip(&runs).all(|(i, run)| i == *run),
                "{at}: {runs:?}"
            );
        }
    }

    #[test]
    fn the_journal_of_another_study_is_left_alone() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("journal");
        Journal::open(&path, "mine").unwrap().append(&outcome(0)).unwrap();
        let before = std::fs::read(&path).unwrap();
        assert!(matches!(
            Journal::open(&path, "hers"),
            Err(StudyError::OtherJournal { .. })
        ));
        assert_eq!(std::fs::read(&path).unwrap(), before);
    }
}
