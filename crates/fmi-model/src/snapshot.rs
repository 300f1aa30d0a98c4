//! The whole state of an instance, and the bytes it is saved as.

use serde::{Deserialize, Serialize};
use uuid::Uuid;

use crate::error::InstanceError;
use crate::model::{Experiment, Model};
use crate::phase::Phase;

/// Whose states are put into bytes, and by which kind of FMU: what keeps states of different FMUs apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seal {
    /// First bytes of every state, one sequence for each standard.
    pub magic: [u8; 8],
    /// What made the FMU, for messages.
    pub tool: &'static str,
    /// What ties the FMU's library to its description and to what it was packed with.
    pub guid: Uuid,
}

/// All that later calls depend on, except for the logging settings.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Snapshot<M> {
    pub(crate) phase: Phase,
    /// End of the last step, s; before the first one the start time.
    pub(crate) time: f64,
    pub(crate) experiment: Experiment,
    /// A variable was set in initialization mode since the model initialised.
    pub(crate) stale: bool,
    pub(crate) model: M,
}

impl<M: Model> Snapshot<M> {
    /// A new instance with the start column applied.
    pub(crate) fn start() -> Self {
        let mut model = M::blank();
        M::table().apply_start(&mut model);
        Self {
            phase: Phase::Instantiated,
            time: 0.0,
            experiment: Experiment::default(),
            stale: false,
            model,
        }
    }

    /// The bytes of this state, for an FMU.
    ///
    /// # Errors
    /// [`InstanceError::StateCoding`] if serde cannot write the model.
    pub fn to_bytes(&self, seal: &Seal) -> Result<Vec<u8>, InstanceError> {
        let payload = postcard::to_stdvec(self)?;
        let mut bytes = Vec::with_capacity(PAYLOAD + payload.len() + CHECKSUM);
        bytes.extend(seal.magic);
        bytes.extend(FORMAT.to_le_bytes());
        bytes.extend(seal.guid.into_bytes());
        bytes.extend((payload.len() as u64).to_le_bytes());
        bytes.extend(payload);
        let checksum = fnv1a(&bytes);
        bytes.extend(checksum.to_le_bytes());
        Ok(bytes)
    }

    /// The state in `bytes`, if the FMU wrote them and nothing happened to them since.
    ///
    /// # Errors
    /// What is wrong with the bytes: one of the variants of [`InstanceError`] that begin with `State`, or
    /// [`InstanceError::NotAState`].
    pub fn from_bytes(bytes: &[u8], seal: &Seal) -> Result<Self, InstanceError> {
        let mut rest = bytes;
        if take(&mut rest) != Some(seal.magic) {
            return Err(InstanceError::NotAState { tool: seal.tool });
        }
        let truncated = |expected: usize| InstanceError::StateLength {
            expected: expected as u64,
            given: bytes.len(),
        };
        let header = || truncated(PAYLOAD + CHECKSUM);
        let format = u32::from_le_bytes(take(&mut rest).ok_or_else(header)?);
        if format != FORMAT {
            return Err(InstanceError::StateFormat {
                found: format,
                known: FORMAT,
            });
        }
        let found = Uuid::from_bytes(take(&mut rest).ok_or_else(header)?);
        if found != seal.guid {
            return Err(InstanceError::StateOfOtherFmu {
                found: braced(found),
                own: braced(seal.guid),
            });
        }
        let length = u64::from_le_bytes(take(&mut rest).ok_or_else(header)?);
        let expected = length.saturating_add((PAYLOAD + CHECKSUM) as u64);
        if expected != bytes.len() as u64 {
            return Err(InstanceError::StateLength {
                expected,
                given: bytes.len(),
            });
        }
        let (checked, checksum) = bytes.split_last_chunk().ok_or_else(|| truncated(CHECKSUM))?;
        if fnv1a(checked) != u64::from_le_bytes(*checksum) {
            return Err(InstanceError::StateChecksum);
        }
        match postcard::take_from_bytes(&checked[PAYLOAD..])? {
            (snapshot, []) => Ok(snapshot),
            // Bytes to spare mean another layout of the model's state than ours.
            (_, spare) => Err(InstanceError::StateSpare { count: spare.len() }),
        }
    }
}

/// A GUID as FMI writes it.
pub fn braced(guid: Uuid) -> String {
    format!("{{{guid}}}")
}

/// Raised whenever the layout of [`Snapshot`] or of the bytes around it changes.
const FORMAT: u32 = 2;
/// Where the payload begins: after magic, format, GUID and length.
const PAYLOAD: usize = 8 + 4 + 16 + 8;
const CHECKSUM: usize = 8;

fn take<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (head, tail) = rest.split_first_chunk()?;
    *rest = tail;
    Some(*head)
}

/// 64-bit FNV-1a: each step is a bijection of the hash, so no single changed byte goes unnoticed.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::fnv1a;

    /// Test vectors of the FNV authors.
    #[test]
    fn val_fnv1a_published_vectors() {
        assert_eq!(fnv1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }
}
