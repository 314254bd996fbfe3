//! Thousands of damaged files: each is opened or refused, and what opens is sound.

use super::support::{OBJ, saved, seam_glb};
use crate::{Format, from_bytes};
use glam::DVec3;

/// A generator of numbers that are the same in every run (Marsaglia's xorshift).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n.max(1) as u64) as usize
    }
}

pub(crate) fn mutated(original: &[u8], numbers: &mut Numbers) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..=numbers.below(4) {
        let at = numbers.below(bytes.len());
        let digits = b"0123456789-.e/[]{},:\" \n\\\xff";
        match numbers.below(6) {
            0 => bytes.truncate(at),
            1 if !bytes.is_empty() => bytes[at] = numbers.below(256) as u8,
            2 => bytes.insert(at.min(bytes.len()), digits[numbers.below(digits.len())]),
            3 if !bytes.is_empty() => bytes[at] = digits[numbers.below(digits.len())],
            4 if !bytes.is_empty() => drop(bytes.remove(at)),
            _ => {
                let end = (at + numbers.below(40)).min(bytes.len());
                let piece = bytes[at.min(end)..end].to_vec();
                let to = numbers.below(bytes.len() + 1);
                bytes.splice(to..to, piece);
            }
        }
    }
    bytes
}

pub(super) fn survives(original: &[u8], format: Format, seed: u64, n: usize) {
    let mut numbers = Numbers(seed);
    for round in 0..n {
        let bytes = mutated(original, &mut numbers);
        let Ok(file) = from_bytes(&bytes, format, "mutated") else { continue };
        let n = file.positions.len();
        assert!(file.positions.iter().all(|p| p.is_finite()), "round {round}: a position is not finite");
        assert!(file.triangles.iter().flatten().all(|&v| (v as usize) < n), "round {round}: index beyond {n}");
        let covered: usize = file.parts.iter().map(|part| part.triangles.len()).sum();
        assert_eq!(covered, file.triangles.len(), "round {round}: triangles in parts");
    }
}

/// Of the damaged files that open, one in `every` is saved as it was and bent: what a reader lets pass, a writer has to
/// stand.
pub(super) fn survives_saving(original: &[u8], format: Format, seed: u64, [n, every]: [usize; 2]) {
    let mut numbers = Numbers(seed);
    let name = format!("damaged.{}", format.extension());
    let mut n_opened = 0;
    for round in 0..n {
        let bytes = mutated(original, &mut numbers);
        let Ok(file) = from_bytes(&bytes, format, "mutated") else { continue };
        n_opened += 1;
        if n_opened % every != 0 {
            continue;
        }
        let (same, _) = saved(&file, &name, &file.points(), None);
        assert!(same == bytes, "round {round}: changed without an edit");
        // Small numbers everywhere: a damaged one may be as large as its type allows, and would pass it when bent.
        let points: Vec<DVec3> =
            file.points().iter().map(|p| (*p * 0.5).clamp(DVec3::splat(-1e30), DVec3::splat(1e30))).collect();
        let rigidity: Vec<u16> = (0..points.len()).map(|i| 1 + i as u16 % 1000).collect();
        let (_, again) = saved(&file, &name, &points, Some(&rigidity));
        assert_eq!(again.triangles.len(), file.triangles.len(), "round {round}");
        let expected: Vec<u16> = file.weld.point_of_vertex.iter().map(|&point| rigidity[point as usize]).collect();
        assert_eq!(again.rigidity, Some(expected), "round {round}");
    }
}

#[test]
fn damaged_obj_text_is_opened_or_refused() {
    survives(OBJ.as_bytes(), Format::Obj, 0x5eed_0001, 4000);
}

#[test]
fn damaged_glb_files_are_opened_or_refused() {
    survives(&seam_glb(), Format::Glb, 0x5eed_0002, 4000);
}

#[test]
fn damaged_documents_are_opened_or_refused() {
    // Mutating the JSON alone, with the lengths around it right, gets past the container.
    let (document, binary) = super::support::seam();
    let text = document.to_string().into_bytes();
    let mut numbers = Numbers(0x5eed_0003);
    for _ in 0..4000 {
        let json = mutated(&text, &mut numbers);
        if let Ok(document) = serde_json::from_slice(&json) {
            let _ = from_bytes(&super::support::glb(&document, &binary), Format::Glb, "mutated");
        }
    }
}
