//! The text of an XML file, by its byte order mark, the encoding that it declares, or UTF-8.

use std::borrow::Cow;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE};

/// Makes text of an XML file.
///
/// # Errors
/// Where and why the bytes are none.
pub(super) fn decode(xml: &[u8]) -> Result<Cow<'_, str>, (usize, String)> {
    // Its byte order mark begins as that of UTF-16.
    if let [b'<' | 0xff, 0 | 0xfe, 0, 0, ..] | [0, 0, 0 | 0xfe, b'<' | 0xff, ..] = xml {
        return Err((0, "the file is in UTF-32: save it as UTF-8".to_owned()));
    }
    let (encoding, mark) = match Encoding::for_bom(xml) {
        Some(found) => found,
        None => (declared(xml)?, 0),
    };
    let body = &xml[mark..];
    if encoding == UTF_8 {
        let text = std::str::from_utf8(body).map_err(|e| (mark + e.valid_up_to(), "not UTF-8".to_owned()))?;
        return Ok(text.into());
    }
    let text = encoding.decode_without_bom_handling_and_without_replacement(body);
    text.ok_or_else(|| {
        (
            0,
            format!("the bytes are not {}, which the file declares", encoding.name()),
        )
    })
}

/// The encoding of a file without byte order mark.
fn declared(xml: &[u8]) -> Result<&'static Encoding, (usize, String)> {
    // UTF-16 shows in the first character, which must be `<`.
    match xml {
        [b'<', 0, ..] => return Ok(UTF_16LE),
        [0, b'<', ..] => return Ok(UTF_16BE),
        _ => {}
    }
    let Some(label) = label(xml) else { return Ok(UTF_8) };
    match Encoding::for_label(label) {
        // A declaration that could be read byte by byte is not written in UTF-16.
        Some(encoding) if encoding == UTF_16LE || encoding == UTF_16BE => Ok(UTF_8),
        Some(encoding) => Ok(encoding),
        None => {
            let label = String::from_utf8_lossy(label);
            Err((
                0,
                format!("the encoding {label:?} is not known: save the file as UTF-8"),
            ))
        }
    }
}

/// What the XML declaration gives as encoding.
fn label(xml: &[u8]) -> Option<&[u8]> {
    let declaration = xml.strip_prefix(b"<?xml")?;
    let declaration = &declaration[..find(declaration, b"?>")?];
    let after = &declaration[find(declaration, b"encoding")? + b"encoding".len()..];
    let value = after.trim_ascii_start().strip_prefix(b"=")?.trim_ascii_start();
    let (quote, rest) = value.split_first().filter(|(first, _)| matches!(first, b'"' | b'\''))?;
    Some(&rest[..rest.iter().position(|byte| byte == quote)?])
}

fn find(bytes: &[u8], what: &[u8]) -> Option<usize> {
    bytes.windows(what.len()).position(|window| window == what)
}
