//! In place of Parquet files, in a program that was built without them.

use crate::HarnessError;

/// There are none.
///
/// # Errors
/// [`HarnessError::NoParquet`].
pub fn from_csv(_csv: &[u8]) -> Result<Vec<u8>, HarnessError> {
    Err(HarnessError::NoParquet)
}
