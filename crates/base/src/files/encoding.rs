//! Text from bytes: UTF-8, and UTF-16 that says so. All else is refused, for a guessed µ may be
//! another letter.

use crate::error::{Error, Place, Result};

const HINT: &str = "save the file as UTF-8 (in Excel: \"CSV UTF-8\")";

/// The text of a file's bytes, without a byte-order mark: UTF-8, or UTF-16 with its mark (Excel's
/// "Unicode Text"). `file` only names it in errors.
///
/// # Errors
/// [`Error::Input`] where the bytes are neither; it says what they look like.
pub fn text_of_bytes(file: &str, bytes: Vec<u8>) -> Result<String> {
    match *bytes.as_slice() {
        [0xFF, 0xFE, ref rest @ ..] => utf_16(file, rest, u16::from_le_bytes),
        [0xFE, 0xFF, ref rest @ ..] => utf_16(file, rest, u16::from_be_bytes),
        // Latin letters have one zero byte each
        [a, b, c, d, ..] if (a == 0) != (b == 0) && (a == 0) == (c == 0) && (b == 0) == (d == 0) => {
            Err(Error::Input {
                at: Place::whole_file(file),
                found: "UTF-16 without a byte-order mark".into(),
                expected: "UTF-8 text".into(),
                hint: Some(HINT.into()),
            })
        }
        _ => utf_8(file, bytes),
    }
}

fn utf_8(file: &str, bytes: Vec<u8>) -> Result<String> {
    let text = String::from_utf8(bytes).map_err(|e| {
        let valid = e.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&e.as_bytes()[..valid]).into_owned();
        let byte = e.as_bytes()[valid];
        // Latin-1 is the first 256 characters of Unicode; below 0xA0 it has no letters
        let latin_1 = match byte {
            0xA0.. => format!(", which is \"{}\" in Latin-1 (Windows-1252)", char::from(byte)),
            _ => String::new(),
        };
        Error::Input {
            at: Place::of_offset(file, &before, valid),
            found: format!("byte 0x{byte:02X}{latin_1}"),
            expected: "UTF-8 text".into(),
            hint: Some(HINT.into()),
        }
    })?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

fn utf_16(file: &str, bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String> {
    let refused = |before: &str, found: &str| Error::Input {
        at: Place::of_offset(file, before, before.len()),
        found: found.into(),
        expected: "whole UTF-16 text, or UTF-8".into(),
        hint: Some(HINT.into()),
    };
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    let mut text = String::with_capacity(bytes.len() / 2);
    for letter in char::decode_utf16(units) {
        match letter {
            Ok(letter) => text.push(letter),
            Err(_) => return Err(refused(&text, "half a character of UTF-16")),
        }
    }
    match bytes.len() % 2 {
        0 => Ok(text),
        _ => Err(refused(&text, "half a character of UTF-16")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(bytes: &[u8]) -> String {
        text_of_bytes("f.csv", bytes.to_vec()).unwrap_err().to_string()
    }

    #[test]
    fn a_byte_order_mark_is_dropped() {
        assert_eq!(text_of_bytes("f", b"\xEF\xBB\xBFaxis".to_vec()).unwrap(), "axis");
    }

    #[test]
    fn utf_16_is_read_in_either_order() {
        let text = "axis\tdz_µm 𝛥\n";
        let (mut little, mut big) = (vec![0xFF, 0xFE], vec![0xFE, 0xFF]);
        for unit in text.encode_utf16() {
            little.extend(unit.to_le_bytes());
            big.extend(unit.to_be_bytes());
        }
        assert_eq!(text_of_bytes("f", little.clone()).unwrap(), text);
        assert_eq!(text_of_bytes("f", big).unwrap(), text);
        little.pop();
        assert_eq!(
            message(&little),
            "f.csv:1:13: half a character of UTF-16, expected whole UTF-16 text, or UTF-8"
        );
        let lone = message(b"\xFF\xFEa\0\x00\xD8b\0");
        assert_eq!(lone, "f.csv:1:2: half a character of UTF-16, expected whole UTF-16 text, or UTF-8");
        assert_eq!(text_of_bytes("f", vec![0xFF, 0xFE]).unwrap(), "");
    }

    #[test]
    fn what_says_nothing_of_itself_is_refused_with_what_it_looks_like() {
        assert_eq!(message(b"a\0x\0"), "f.csv: UTF-16 without a byte-order mark, expected UTF-8 text");
        assert_eq!(message(b"\0a\0x"), "f.csv: UTF-16 without a byte-order mark, expected UTF-8 text");
        assert_eq!(
            message(b"axis\n\xB5m"),
            "f.csv:2:1: byte 0xB5, which is \"µ\" in Latin-1 (Windows-1252), expected UTF-8 text"
        );
        assert_eq!(message(b"a\x84"), "f.csv:1:2: byte 0x84, expected UTF-8 text");
    }
}
