//! Damage that any file may take.

use crate::random::Random;

/// Bytes that mean something in one format or another.
const MEANINGFUL: &[u8] = b"0123456789-+.eEnfx/[]{},:\"# \t\r\n\\\0\xff\x80";

/// A piece is cut, copied or overwritten up to this length.
const PIECE: usize = 64;

/// One kind of damage; `other` is a file to take pieces from.
pub(super) fn damaged(mut bytes: Vec<u8>, other: &[u8], random: &mut Random) -> Vec<u8> {
    let at = random.below(bytes.len() + 1);
    let end = (at + random.below(PIECE)).min(bytes.len());
    match random.below(9) {
        0 => bytes.truncate(at),
        1 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
        2 if at < bytes.len() => bytes[at] = *random.pick(MEANINGFUL),
        3 => bytes.insert(at, *random.pick(MEANINGFUL)),
        4 => drop(bytes.drain(at..end)),
        5 => {
            let piece = bytes[at..end].to_vec();
            let to = random.below(bytes.len() + 1);
            bytes.splice(to..to, piece);
        }
        6 => {
            let from = random.below(other.len() + 1);
            let piece = &other[from..(from + random.below(4 * PIECE)).min(other.len())];
            bytes.splice(at..end, piece.iter().copied());
        }
        _ => overwrite(&mut bytes, random),
    }
    bytes
}

/// Another number where a binary format may have a length, a count, an index or a coordinate.
fn overwrite(bytes: &mut [u8], random: &mut Random) {
    let at = random.below(bytes.len());
    let at = if random.below(4) > 0 { at & !3 } else { at };
    let number: [u8; 8] = match random.below(12) {
        0 => 0u64.to_le_bytes(),
        1 => u64::MAX.to_le_bytes(),
        2 => (u64::from(u32::MAX) >> 1).to_le_bytes(),
        3 => (1u64 << random.below(64)).to_le_bytes(),
        4 => (bytes.len() as u64).to_le_bytes(),
        5 => (bytes.len() as u64 + 1).to_be_bytes(),
        6 => u64::from(f32::NAN.to_bits()).to_le_bytes(),
        7 => u64::from(f32::INFINITY.to_bits()).to_le_bytes(),
        8 => f64::NAN.to_le_bytes(),
        9 => f64::MAX.to_be_bytes(),
        10 => u64::from(f32::MAX.to_bits()).to_le_bytes(),
        _ => random.bits().to_le_bytes(),
    };
    let width = *random.pick(&[1, 2, 4, 4, 4, 8]);
    for (byte, new) in bytes.iter_mut().skip(at).zip(&number[..width]) {
        *byte = *new;
    }
}
