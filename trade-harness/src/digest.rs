//! SHA-256 of what a study is made of, in hexadecimal digits.

use std::fs;
use std::path::Path;

use sha2::{Digest, Sha256};

use crate::HarnessError;

/// Digest of bytes.
pub fn of_bytes(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Digest of the contents of a file.
///
/// # Errors
/// [`HarnessError::Read`].
pub fn of_file(path: &Path) -> Result<String, HarnessError> {
    let bytes = fs::read(path).map_err(|source| HarnessError::Read {
        path: path.to_owned(),
        source,
    })?;
    Ok(of_bytes(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The one-block example of FIPS 180-2.
    #[test]
    fn digests_of_bytes_and_of_a_file() {
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(of_bytes(b"abc"), expected);
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("abc");
        fs::write(&file, "abc").unwrap();
        assert_eq!(of_file(&file).unwrap(), expected);
        let error = of_file(&dir.path().join("none")).unwrap_err();
        assert!(matches!(error, HarnessError::Read { .. }), "{error}");
    }
}
