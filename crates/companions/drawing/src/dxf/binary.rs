//! Converts the binary form of DXF to the equivalent text.

use super::tags::cut;
use crate::Error;

/// First bytes of the binary form.
const BINARY_SENTINEL: &[u8] = b"AutoCAD Binary DXF\r\n\x1a\0";

/// Converts a binary DXF to the equivalent text. Returns `None` if the bytes are not a binary DXF.
///
/// # Errors
/// If the file ends within a group.
pub(super) fn as_text(bytes: &[u8]) -> Result<Option<Vec<u8>>, Error> {
    let Some(mut rest) = bytes.strip_prefix(BINARY_SENTINEL) else { return Ok(None) };
    // Since release 13, codes have two bytes. Such a file begins with two zero bytes, which are the first code.
    let is_wide = rest.starts_with(&[0, 0]);
    let mut text = Vec::with_capacity(2 * bytes.len());
    while !rest.is_empty() {
        let is_end = text.ends_with(b"0\nEOF\n");
        match pair(&mut rest, is_wide) {
            Some((code, value)) if !is_end => {
                text.extend(format!("{code}\n").bytes());
                // A value is one line.
                text.extend(value.into_iter().map(|byte| if matches!(byte, b'\r' | b'\n') { b' ' } else { byte }));
                text.push(b'\n');
            }
            _ if is_end => break,
            _ => return Err(Error { line: None, ..cut(0) }),
        }
    }
    Ok(Some(text))
}

/// Reads the next code and its value as text. Returns `None` if the bytes end too early.
fn pair(rest: &mut &[u8], is_wide: bool) -> Option<(i32, Vec<u8>)> {
    let code = match (is_wide, *rest.first()?) {
        (false, code) if code < 255 => i32::from(take_bytes::<1>(rest)?[0]),
        (false, _) => {
            take_bytes::<1>(rest)?;
            i32::from(i16::from_le_bytes(take_bytes(rest)?))
        }
        (true, _) => i32::from(i16::from_le_bytes(take_bytes(rest)?)),
    };
    let value = match code {
        10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => f64::from_le_bytes(take_bytes(rest)?).to_string(),
        60..=79 | 170..=179 | 270..=289 | 370..=389 | 400..=409 | 1060..=1070 => {
            i16::from_le_bytes(take_bytes(rest)?).to_string()
        }
        90..=99 | 420..=429 | 440..=459 | 1071 => i32::from_le_bytes(take_bytes(rest)?).to_string(),
        160..=169 => i64::from_le_bytes(take_bytes(rest)?).to_string(),
        290..=299 => take_bytes::<1>(rest)?[0].to_string(),
        310..=319 | 1004 => {
            let length = usize::from(take_bytes::<1>(rest)?[0]);
            *rest = rest.get(length..)?;
            String::new()
        }
        _ => {
            let length = rest.iter().position(|byte| *byte == 0)?;
            let value = rest[..length].to_vec();
            *rest = &rest[length + 1..];
            return Some((code, value));
        }
    };
    Some((code, value.into_bytes()))
}

fn take_bytes<const SIZE: usize>(rest: &mut &[u8]) -> Option<[u8; SIZE]> {
    let (value, after) = rest.split_first_chunk()?;
    *rest = after;
    Some(*value)
}
