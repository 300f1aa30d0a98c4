//! Files that people write: text in UTF-8, and no more of it than anybody writes.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Most bytes of a mission, a study or a file of names: some hundred thousand lines.
pub const LIMIT: u64 = 4 << 20;

/// Reads a file; a byte order mark is left out.
///
/// # Errors
/// What the system says; a file beyond [`LIMIT`], which may be a device without end; what is not UTF-8, with its line.
pub fn read(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    File::open(path)?.take(LIMIT + 1).read_to_end(&mut bytes)?;
    let wrong = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
    if bytes.len() as u64 > LIMIT {
        return Err(wrong(format!(
            "it has more than {LIMIT} bytes, and is no text that is meant here"
        )));
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(wrong("it is in UTF-16; save it as UTF-8".to_owned()));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text)),
        Err(error) => {
            let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = 1 + good.iter().filter(|byte| **byte == b'\n').count();
            Err(wrong(format!("line {line} is not UTF-8; save the file as UTF-8")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(bytes: &[u8]) -> Result<String, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("text");
        std::fs::write(&path, bytes).unwrap();
        read(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn text_is_read_and_what_is_none_is_told_with_its_place() {
        assert_eq!(of(b"\xef\xbb\xbfa = \"\xc3\xa4\"\n").as_deref(), Ok("a = \"\u{e4}\"\n"));
        for (bytes, says) in [
            (&b"a = 1\nb = \"\xe4\"\n"[..], "line 2 is not UTF-8"),
            (b"\xff\xfea\0", "UTF-16"),
            (b"\xfe\xff\0a", "UTF-16"),
            (&vec![b'\n'; LIMIT as usize + 1], "more than 4194304 bytes"),
        ] {
            let error = of(bytes).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
        assert!(of(&vec![b'\n'; LIMIT as usize]).is_ok());
    }

    #[test]
    #[cfg(unix)]
    fn a_device_without_end_is_no_text() {
        let error = read(Path::new("/dev/zero")).unwrap_err().to_string();
        assert!(error.contains("more than"), "{error}");
    }
}
