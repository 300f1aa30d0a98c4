//! How much of anybody's archive is read: a few bytes may stand for as many as a disk has.

use std::io::{self, Read, Write};

/// Largest `modelDescription.xml`, bytes.
pub const DESCRIPTION: u64 = 64 << 20;

/// Most entries of an archive.
pub const ENTRIES: usize = 100_000;

/// Most bytes that an archive may unpack to.
const MOST: u64 = 4 << 30;

/// What any archive may unpack to, however small it is, bytes.
const ALWAYS: u64 = 256 << 20;

/// Most bytes for each byte of the archive beyond that: deflate makes up to a thousand of one, data of a model a few dozen.
const RATIO: u64 = 200;

/// What an archive may still unpack to. Real bytes are counted, since the sizes that an archive declares may be lies.
#[derive(Debug, Clone)]
pub struct Budget {
    limit: u64,
    left: u64,
}

/// Why an entry was not copied to its end.
#[derive(Debug)]
pub enum Stopped {
    /// The entry cannot be read: packed in an unknown way, cut off, or not what its checksum says.
    Read(io::Error),
    /// The copy cannot be written.
    Write(io::Error),
    /// The archive unpacks to more than [`Budget::limit`].
    Full,
}

impl Budget {
    /// For an archive of so many bytes.
    #[must_use]
    pub fn of(archive: u64) -> Self {
        let limit = archive.saturating_mul(RATIO).clamp(ALWAYS, MOST);
        Self { limit, left: limit }
    }

    /// Most bytes that the archive may unpack to.
    #[must_use]
    pub fn limit(&self) -> u64 {
        self.limit
    }

    /// Copies an entry.
    ///
    /// # Errors
    /// [`Stopped`], after a part of it was written.
    pub fn copy(&mut self, mut entry: impl Read, to: &mut impl Write) -> Result<(), Stopped> {
        let mut buffer = [0; 1 << 16];
        loop {
            let count = match entry.read(&mut buffer) {
                Ok(0) => return Ok(()),
                Ok(count) => count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(Stopped::Read(error)),
            };
            self.left = self.left.checked_sub(count as u64).ok_or(Stopped::Full)?;
            to.write_all(&buffer[..count]).map_err(Stopped::Write)?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_archives_have_room_and_no_archive_has_more_than_the_most() {
        assert_eq!(Budget::of(0).limit(), ALWAYS);
        assert_eq!(Budget::of(2_000_000).limit(), 400_000_000);
        assert_eq!(Budget::of(u64::MAX).limit(), MOST);
    }

    #[test]
    fn entries_share_what_there_is() {
        let mut budget = Budget { limit: 10, left: 10 };
        let mut copy = Vec::new();
        assert!(budget.copy(&[1; 6][..], &mut copy).is_ok());
        assert!(budget.copy(&[2; 4][..], &mut copy).is_ok());
        assert_eq!(copy, [1, 1, 1, 1, 1, 1, 2, 2, 2, 2]);
        assert!(matches!(budget.copy(&[3][..], &mut copy), Err(Stopped::Full)));
        let mut full = &mut [0; 2][..];
        let stopped = Budget::of(0).copy(&[4; 3][..], &mut full);
        assert!(matches!(stopped, Err(Stopped::Write(_))));
    }
}
