//! Mode ATTRIBUTES: differences between consecutive elements, byte by byte.
//!
//! Elements come in blocks of at most 256. In a block the first bytes of all elements come first, then the second ones,
//! and so on, each as differences in groups of 16, packed as tightly as the group allows.
//!
//! | part of the stream | length |
//! |---|---|
//! | version, 0xa0 or 0xa1 | 1 |
//! | blocks: control bits (version 1 only), then one packed list per byte of an element | as it comes |
//! | padding up to the least length of what follows | as it comes |
//! | element before the first | an element |
//! | kind of difference per four bytes (version 1 only) | a quarter of an element |

use super::Stream;

/// Elements of one group.
const GROUP: usize = 16;
/// Bits of a packed difference in each mode of a group, in version 0 and for the two packings of version 1.
const BITS_0: [u8; 4] = [0, 2, 4, 8];
const BITS_1: [[u8; 4]; 2] = [[0, 1, 2, 4], [1, 2, 4, 8]];

/// `count` elements of `stride` bytes, a multiple of four from 4 to 256.
pub(super) fn decode(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, &'static str> {
    let is_new = match bytes.first() {
        Some(0xa0) => false,
        Some(0xa1) => true,
        _ => return Err("is of an unknown version"),
    };
    let (kinds_length, least_tail) = if is_new { (stride / 4, 24) } else { (0, 32) };
    let tail = stride + kinds_length;
    let body = bytes.len().checked_sub(tail.max(least_tail)).filter(|&end| end >= 1).ok_or("breaks off")?;
    let (first, kinds) = bytes[bytes.len() - tail..].split_at(stride);
    let kinds = (0..stride / 4).map(|c| Kind::of(kinds.get(c).copied().unwrap_or(0))).collect::<Result<Vec<_>, _>>()?;
    let mut body = Stream(&bytes[1..body]);
    let mut previous = first.to_vec();
    let mut decoded = Vec::new();
    let longest = ((8192 / stride) & !(GROUP - 1)).min(256);
    let mut deltas = vec![0; longest * stride];
    let mut left = count;
    while left > 0 {
        let n = left.min(longest);
        let padded = n.next_multiple_of(GROUP);
        let control = if is_new { body.take(stride / 4)? } else { &[] };
        for (k, deltas) in deltas.chunks_exact_mut(padded).take(stride).enumerate() {
            match control.get(k / 4).map(|control| control >> (2 * (k % 4)) & 3) {
                None => unpack(&mut body, BITS_0, deltas)?,
                Some(2) => deltas.fill(0),
                Some(3) => deltas[..n].copy_from_slice(body.take(n)?),
                Some(packing) => unpack(&mut body, BITS_1[usize::from(packing)], deltas)?,
            }
        }
        let start = decoded.len();
        decoded.resize(start + n * stride, 0);
        for (c, &kind) in kinds.iter().enumerate() {
            let last = previous[4 * c..4 * c + 4].try_into().expect("four bytes");
            let of_byte = |k: usize| &deltas[(4 * c + k) * padded..][..n];
            let elements = decoded[start..].chunks_exact_mut(stride).map(|element| &mut element[4 * c..4 * c + 4]);
            kind.sum_up([of_byte(0), of_byte(1), of_byte(2), of_byte(3)], last, elements);
        }
        previous.copy_from_slice(&decoded[decoded.len() - stride..]);
        left -= n;
    }
    body.end()?;
    Ok(decoded)
}

/// Reads whole groups of differences: two bits for each group first, then the groups.
fn unpack(body: &mut Stream<'_>, bits: [u8; 4], deltas: &mut [u8]) -> Result<(), &'static str> {
    let n_groups = deltas.len() / GROUP;
    let header = body.take(n_groups.div_ceil(4))?;
    for (g, group) in deltas.chunks_exact_mut(GROUP).enumerate() {
        let bits = usize::from(bits[usize::from(header[g / 4] >> (2 * (g % 4)) & 3)]);
        match bits {
            0 => group.fill(0),
            8 => group.copy_from_slice(body.take(GROUP)?),
            _ => {
                let packed = body.take(GROUP * bits / 8)?;
                // All bits set stand for a byte behind the packed ones.
                let sentinel = (1u8 << bits) - 1;
                let per_byte = 8 / bits;
                for (i, delta) in group.iter_mut().enumerate() {
                    // Single bits run from the lowest, pairs and halves from the highest.
                    let at = if bits == 1 { i % 8 } else { 8 - bits * (i % per_byte + 1) };
                    *delta = packed[i / per_byte] >> at & sentinel;
                    if *delta == sentinel {
                        *delta = body.byte()?;
                    }
                }
            }
        }
    }
    Ok(())
}

/// What the differences of four bytes are between.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Bytes,
    Pairs,
    /// Exclusive or, turned left by so many bits for storing.
    Bits(u32),
}

impl Kind {
    fn of(byte: u8) -> Result<Kind, &'static str> {
        match (byte & 15, byte >> 4) {
            (0, 0) => Ok(Kind::Bytes),
            (1, 0) => Ok(Kind::Pairs),
            (2, turn) => Ok(Kind::Bits(turn.into())),
            _ => Err("holds an unknown kind of difference"),
        }
    }

    /// Turns the differences of four bytes into the bytes of each element; `last` are those before the first.
    fn sum_up<'a>(self, deltas: [&[u8]; 4], last: [u8; 4], elements: impl Iterator<Item = &'a mut [u8]>) {
        let mut last = last;
        for (i, element) in elements.enumerate() {
            let delta = deltas.map(|of_byte| of_byte[i]);
            match self {
                Kind::Bytes => {
                    for (last, delta) in last.iter_mut().zip(delta) {
                        *last = last.wrapping_add(if delta & 1 == 0 { delta >> 1 } else { !(delta >> 1) });
                    }
                }
                Kind::Pairs => {
                    for k in [0, 2] {
                        let delta = u16::from_le_bytes([delta[k], delta[k + 1]]);
                        let delta = if delta & 1 == 0 { delta >> 1 } else { !(delta >> 1) };
                        let sum = u16::from_le_bytes([last[k], last[k + 1]]).wrapping_add(delta);
                        [last[k], last[k + 1]] = sum.to_le_bytes();
                    }
                }
                Kind::Bits(turn) => {
                    let bits = u32::from_le_bytes(last) ^ u32::from_le_bytes(delta).rotate_right(turn);
                    last = bits.to_le_bytes();
                }
            }
            element.copy_from_slice(&last);
        }
    }
}
