//! Blocks of bytes in one file, each with its length and a checksum.
//!
//! | bytes | what |
//! |---|---|
//! | 8 | the mark: not text, so that programs that change line ends destroy it |
//! | 4 | version |
//! | 4 | number of blocks |
//! | 4 | checksum of the 16 bytes before |
//! | each block: 8 | its length |
//! | length | its bytes |
//! | 4 | checksum of its number, length and bytes |
//!
//! The checksum is CRC-32, which tells any one changed byte for sure, and other damage but for one in four billion.

use std::io::{Result, Write};
use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::error::Flaw;

/// The first bytes of every project.
const MARK: [u8; 8] = *b"\x89Pliant\n";
/// Goes up when older programs would misread what newer ones write.
pub(super) const VERSION: u32 = 1;
const HEAD: usize = 20;

/// Number of a block in the file. The header is block 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub(super) struct Block(u32);

/// Blocks that are to be written.
#[derive(Default)]
pub(super) struct Writer {
    blocks: Vec<Arc<Vec<u8>>>,
}

impl Writer {
    /// Adds a block and tells its number.
    pub(super) fn put(&mut self, bytes: impl Into<Arc<Vec<u8>>>) -> Block {
        self.blocks.push(bytes.into());
        Block(self.blocks.len() as u32)
    }

    /// Bytes of all blocks.
    pub(super) fn length(&self) -> u64 {
        self.blocks.iter().map(|block| block.len() as u64).sum()
    }

    /// Writes the file: the header, then the blocks in the order in which they were added.
    pub(super) fn write(&self, header: &[u8], out: &mut dyn Write) -> Result<()> {
        let mut head = MARK.to_vec();
        head.extend(VERSION.to_le_bytes());
        head.extend((self.blocks.len() as u32 + 1).to_le_bytes());
        let checksum = crc32fast::hash(&head);
        out.write_all(&head)?;
        out.write_all(&checksum.to_le_bytes())?;
        let all = std::iter::once(header).chain(self.blocks.iter().map(|block| block.as_slice()));
        for (number, bytes) in (0_u32..).zip(all) {
            out.write_all(&(bytes.len() as u64).to_le_bytes())?;
            out.write_all(bytes)?;
            out.write_all(&checksum_of(number, bytes).to_le_bytes())?;
        }
        Ok(())
    }
}

fn checksum_of(number: u32, bytes: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&number.to_le_bytes());
    hasher.update(&(bytes.len() as u64).to_le_bytes());
    hasher.update(bytes);
    hasher.finalize()
}

/// Why a file is not taken apart.
#[derive(Debug, PartialEq)]
pub(super) enum Refusal {
    /// It does not begin like a project.
    NotAProject,
    /// Of this version.
    Newer(u32),
    /// Cut or changed.
    Damaged(Flaw),
}

/// A file, whole and undamaged.
#[derive(Debug)]
pub(super) struct Reader {
    file: Vec<u8>,
    blocks: Vec<Range<usize>>,
}

impl Reader {
    /// Takes a file apart and checks every byte of it.
    pub(super) fn new(file: Vec<u8>) -> std::result::Result<Reader, Refusal> {
        let damaged = |problem: String| Refusal::Damaged(Flaw(problem));
        if !file.starts_with(&MARK) {
            return Err(Refusal::NotAProject);
        }
        let cut = || damaged("it is cut off".into());
        let head = file.get(..HEAD).ok_or_else(cut)?;
        if number(&head[16..]) != crc32fast::hash(&head[..16]) {
            return Err(damaged("its first bytes are not as they were written".into()));
        }
        let (version, n_blocks) = (number(&head[8..]), number(&head[12..]));
        if version != VERSION {
            return Err(Refusal::Newer(version));
        }
        let mut blocks = Vec::new();
        let mut at = HEAD;
        for index in 0..n_blocks {
            let rest = &file[at..];
            let length = rest.get(..8).ok_or_else(cut)?;
            let length = u64::from_le_bytes(length.try_into().map_err(|_| cut())?);
            let length = usize::try_from(length).map_err(|_| cut())?;
            let end = length.checked_add(12).filter(|&end| end <= rest.len()).ok_or_else(cut)?;
            if checksum_of(index, &rest[8..8 + length]) != number(&rest[8 + length..]) {
                return Err(damaged(format!("block {index} is not as it was written")));
            }
            blocks.push(at + 8..at + 8 + length);
            at += end;
        }
        if at != file.len() {
            return Err(damaged(format!("{} bytes follow its end", file.len() - at)));
        }
        Ok(Reader { file, blocks })
    }

    /// Bytes of the whole file.
    pub(super) fn length(&self) -> usize {
        self.file.len()
    }

    /// The bytes of every block, the header first.
    #[cfg(test)]
    pub(super) fn all(&self) -> impl Iterator<Item = &[u8]> {
        self.blocks.iter().map(|range| &self.file[range.clone()])
    }

    /// The bytes of the header.
    pub(super) fn header(&self) -> std::result::Result<&[u8], Flaw> {
        self.bytes(Block(0), "header")
    }

    /// The bytes of a block; `what` it holds is for the message.
    pub(super) fn bytes(&self, block: Block, what: &str) -> std::result::Result<&[u8], Flaw> {
        let range = self.blocks.get(block.0 as usize).ok_or_else(|| Flaw(format!("there is no block for {what}")))?;
        Ok(&self.file[range.clone()])
    }
}

fn number(bytes: &[u8]) -> u32 {
    bytes.first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file() -> Vec<u8> {
        let mut writer = Writer::default();
        writer.put(vec![1, 2, 3]);
        writer.put(Vec::new());
        let mut out = Vec::new();
        writer.write(b"{}", &mut out).expect("memory takes it");
        out
    }

    #[test]
    fn blocks_come_back_as_they_were_put() {
        let reader = Reader::new(file()).expect("whole");
        assert_eq!(reader.header(), Ok(&b"{}"[..]));
        assert_eq!(reader.bytes(Block(1), "a"), Ok(&[1, 2, 3][..]));
        assert_eq!(reader.bytes(Block(2), "b"), Ok(&[][..]));
        assert!(reader.bytes(Block(3), "c").is_err());
    }

    #[test]
    fn every_changed_byte_every_cut_and_every_addition_is_told() {
        let whole = file();
        for at in 0..whole.len() {
            for flip in [1, 0x80, 0xff] {
                let mut changed = whole.clone();
                changed[at] ^= flip;
                assert!(Reader::new(changed).is_err(), "byte {at} changed by {flip:#x} was not noticed");
            }
            assert!(Reader::new(whole[..at].to_vec()).is_err(), "cut at {at}");
        }
        assert_eq!(
            Reader::new([whole, vec![0]].concat()).err(),
            Some(Refusal::Damaged(Flaw::new("1 bytes follow its end")))
        );
    }

    #[test]
    fn another_version_is_told_by_its_number_and_claims_of_size_reserve_nothing() {
        let mut head = MARK.to_vec();
        head.extend(7_u32.to_le_bytes());
        head.extend(1_u32.to_le_bytes());
        let checksum = crc32fast::hash(&head);
        head.extend(checksum.to_le_bytes());
        assert_eq!(Reader::new(head).err(), Some(Refusal::Newer(7)));
        let mut head = MARK.to_vec();
        head.extend(VERSION.to_le_bytes());
        head.extend(u32::MAX.to_le_bytes());
        let checksum = crc32fast::hash(&head);
        head.extend(checksum.to_le_bytes());
        head.extend(u64::MAX.to_le_bytes());
        assert!(matches!(Reader::new(head), Err(Refusal::Damaged(_))));
    }
}
