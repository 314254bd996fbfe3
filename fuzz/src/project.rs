//! Projects under fire: what lies behind the checksums is reached only by files whose checksums are right.

use std::ops::ControlFlow;
use std::path::Path;

use pliant::project::{MeshChoice, open};

/// The first bytes of every project, and the number of bytes before the first block.
const MARK: [u8; 8] = *b"\x89Pliant\n";
const HEAD: usize = 20;

/// Opens an input as it came, and once more with right checksums: a corpus of saved projects leads far.
///
/// # Panics
///
/// Where a message is no single clear line.
pub fn opens_or_refuses(bytes: &[u8], folder: &Path) {
    let file = folder.join("input.pliant");
    for content in [bytes.to_vec(), resealed(bytes)] {
        std::fs::write(&file, content).expect("a temporary folder can be written to");
        if let Err(error) = open(&file, &MeshChoice::Named, &mut |_| ControlFlow::Continue(())) {
            let said = error.to_string();
            assert!(!said.is_empty() && !said.contains('\n') && said.chars().count() < 2000, "{said}");
        }
    }
}

/// The blocks of a project, as long as they say or as far as there are bytes, with the checksums that belong to them.
fn resealed(bytes: &[u8]) -> Vec<u8> {
    let (head, mut rest) = bytes.split_at(HEAD.min(bytes.len()));
    let mut blocks = Vec::new();
    while let Some((length, behind)) = rest.split_first_chunk::<8>() {
        let length = u64::from_le_bytes(*length).min(behind.len() as u64) as usize;
        let (block, behind) = behind.split_at(length);
        blocks.push(block);
        rest = behind.get(4..).unwrap_or_default();
    }
    let mut out = MARK.to_vec();
    out.extend(head.get(8..12).unwrap_or(&[1, 0, 0, 0]));
    out.extend((blocks.len() as u32).to_le_bytes());
    out.extend(crc32fast::hash(&out).to_le_bytes());
    for (number, block) in (0_u32..).zip(blocks) {
        let mut hasher = crc32fast::Hasher::new();
        hasher.update(&number.to_le_bytes());
        hasher.update(&(block.len() as u64).to_le_bytes());
        hasher.update(block);
        out.extend((block.len() as u64).to_le_bytes());
        out.extend(block);
        out.extend(hasher.finalize().to_le_bytes());
    }
    out
}
