//! Corners of faces: `v`, `v/vt`, `v//vn` or `v/vt/vn`.

use super::super::text::Word;
use super::NONE;
use crate::Fault;

/// Zero-based indices of vertex, texture coordinate and normal.
pub(super) type CornerIndex = [u32; 3];

/// A number that no list has: a texture coordinate or normal that does not exist, which is told from one that is not
/// named.
pub(super) const NOT_THERE: u32 = NONE - 1;

/// Reads a corner. Negative numbers count back from the last one `known` so far; `relative` is called with the place in
/// the corner of each.
///
/// Without `from_start` the known are those of the piece alone, and a result below zero, which stands in an earlier piece,
/// is given in two's complement.
pub(super) fn corner(
    word: &Word<'_>,
    known: [usize; 3],
    from_start: bool,
    line: usize,
    relative: impl FnMut(usize),
) -> Result<CornerIndex, Fault> {
    match plain(word.bytes) {
        Some(corner) => Ok(corner),
        None => any(word, known, from_start, line, relative),
    }
}

/// Digits of numbers that surely fit: larger ones are read with care.
const SHORT: usize = 9;

/// The usual kind: one to three whole numbers from 1.
fn plain(bytes: &[u8]) -> Option<CornerIndex> {
    let mut corner = [NONE; 3];
    let (mut k, mut value, mut n_digits) = (0, 0, 0);
    for &byte in bytes {
        let digit = byte.wrapping_sub(b'0');
        if digit <= 9 {
            n_digits += 1;
            if n_digits > SHORT {
                return None;
            }
            value = value * 10 + u32::from(digit);
        } else if byte == b'/' && k < 2 {
            if n_digits > 0 {
                corner[k] = value.checked_sub(1)?;
            } else if k == 0 {
                return None;
            }
            (k, value, n_digits) = (k + 1, 0, 0);
        } else {
            return None;
        }
    }
    if n_digits > 0 {
        corner[k] = value.checked_sub(1)?;
    } else if k == 0 {
        return None;
    }
    Some(corner)
}

fn any(
    word: &Word<'_>,
    known: [usize; 3],
    from_start: bool,
    line: usize,
    mut relative: impl FnMut(usize),
) -> Result<CornerIndex, Fault> {
    let bad = |problem: String| Fault::at(format!("line {line}, face corner {}", word.shown()), problem);
    let mut indices = [NONE; 3];
    let mut n = 0;
    for (k, field) in word.bytes.split(|&b| b == b'/').enumerate() {
        n = k;
        if k > 2 || (field.is_empty() && k > 0) {
            continue;
        }
        let text = std::str::from_utf8(field).unwrap_or_default();
        let index: i64 = text.parse().map_err(|_| bad("is not a vertex number".into()))?;
        let zero_based = if index < 0 { known[k] as i64 + index } else { index - 1 };
        if index < 0 && !from_start {
            let within = i32::try_from(zero_based).map_err(|_| bad("is far before its piece".into()))?;
            indices[k] = within.cast_unsigned();
            relative(k);
            continue;
        }
        indices[k] = match u32::try_from(zero_based) {
            Ok(index) if index < NOT_THERE => index,
            // Texture coordinates and normals that do not exist are passed over, vertices are not.
            _ if k > 0 => NOT_THERE,
            _ if index == 0 => return Err(bad("vertices are numbered from 1, there is no vertex 0".into())),
            _ => return Err(bad(format!("there are {} vertices so far", known[0]))),
        };
    }
    if n > 2 {
        return Err(bad("has more than three indices".into()));
    }
    Ok(indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quick_way_reads_what_the_careful_one_reads() {
        for text in [
            "1",
            "7/8",
            "7//9",
            "7/8/9",
            "12/",
            "12//",
            "12/3/",
            "999999999/1/1",
            "1000000000",
            "4294967295",
            "0",
            "1/0",
            "1/0/2",
            "",
            "/",
            "/1",
            "//",
            "1/2/3/4",
            "1/2/3/",
            "+5",
            "x",
            "1x",
            "1/x",
            "99999999999999999999",
        ] {
            let word = Word { bytes: text.as_bytes(), start: 0, end: text.len() };
            let careful = any(&word, [9; 3], true, 1, |_| {});
            match plain(text.as_bytes()) {
                Some(quick) => assert_eq!(Some(quick), careful.ok(), "{text:?}"),
                None => assert!(careful.is_err() || text.len() > SHORT || text.contains(['+', '0']), "{text:?}"),
            }
        }
    }
}
