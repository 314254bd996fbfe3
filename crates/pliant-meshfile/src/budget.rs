//! The most a file may ask for. Beyond these limits it is refused by name, before memory is reserved.
//!
//! The figures are generous for a person's machine (a 20 M vertex mesh needs some gigabytes to solve) and small enough
//! that a hostile file cannot exhaust it.

use crate::Fault;

/// Size of any one file, in bytes.
pub(crate) const FILE_BYTES: u64 = 2 << 30;
/// Size of the JSON part of a glTF file, in bytes.
pub(crate) const JSON_BYTES: u64 = 256 << 20;
/// Size of a material library or a rigidity file, in bytes.
pub(crate) const TEXT_BYTES: u64 = 256 << 20;
/// File vertices of one model.
pub(crate) const VERTICES: u64 = 20_000_000;
/// File vertices of one glTF model, or numbers in the keys of one animation, that no data lies behind: a few bytes could otherwise ask for
/// gigabytes. By eye: a mesh that is zero but for a few vertices is a curiosity at any size.
pub(crate) const ZEROS: u64 = 1_000_000;
/// Triangles of one model.
pub(crate) const TRIANGLES: u64 = 40_000_000;
/// Texture coordinates or normals of an OBJ file, elements of a glTF accessor: some writers give every corner its own.
pub(crate) const CORNERS: u64 = 3 * TRIANGLES;
/// Elements read from the accessors of one model: each triangle and vertex a few times over, since accessors may be
/// shared and a file can name one of them any number of times.
pub(crate) const ELEMENTS: u64 = 8 * TRIANGLES;
/// Bytes of the pictures of one model, as they are stored.
pub(crate) const PICTURE_BYTES: u64 = 256 << 20;
/// Pictures of one model.
pub(crate) const PICTURES: usize = 1024;
/// Bytes of one part's name; a longer one is cut.
pub(crate) const NAME_BYTES: usize = 1 << 10;
/// Bytes of the names of all parts: one name can serve every part of a file.
pub(crate) const ALL_NAME_BYTES: u64 = 256 << 20;
/// Bytes that the compressed geometry of one glTF file is decoded to: as many vertices as a model may have with positions,
/// normals and texture coordinates, and as many triangles. A stream of a kilobyte can stand for gigabytes.
pub(crate) const DECODED_BYTES: u64 = VERTICES * 32 + TRIANGLES * 12;
/// Nodes of one glTF scene graph.
pub(crate) const NODES: u64 = 1_000_000;
/// Numbers in the keys of one glTF animation: half an hour at 60 frames a second of 25 joints is 10 million.
pub(crate) const KEY_NUMBERS: u64 = 64_000_000;
/// Poses of one file, frames of all its animations included.
pub(crate) const POSES: u64 = 100_000;
/// Bytes kept to compute the poses of one file: as many vertices as a model may have, each with its place and the joints
/// and weights of two sets, are 2.0 GB.
pub(crate) const POSE_BYTES: u64 = 2 << 30;
/// Steps to compute all poses of one file, of which every vertex takes one a pose, one more for each displacement and
/// four for each set of joints, and every number of a key one. A step was measured to take 25 ns, all of them 8 minutes; 200,000 vertices
/// with 60 displacements in 1,000 frames are 12 billion.
pub(crate) const POSE_WORK: u64 = 20_000_000_000;
/// Corners of one polygon.
pub(crate) const POLYGON_CORNERS: u64 = 65_536;

/// Refuses `found` beyond `limit`, naming `what` is counted.
pub(crate) fn check(what: &'static str, found: u64, limit: u64) -> Result<(), Fault> {
    if found > limit {
        return Err(Fault::Budget { what, found, limit });
    }
    Ok(())
}

/// A limit on a sum, spent bit by bit.
#[derive(Debug)]
pub(crate) struct Purse {
    what: &'static str,
    spent: u64,
    limit: u64,
}

impl Purse {
    pub(crate) fn new(what: &'static str, limit: u64) -> Purse {
        Purse { what, spent: 0, limit }
    }

    /// Refuses what would go beyond the limit.
    pub(crate) fn spend(&mut self, n: usize) -> Result<(), Fault> {
        self.spent = self.spent.saturating_add(n as u64);
        check(self.what, self.spent, self.limit)
    }

    /// What may still be spent.
    pub(crate) fn left(&self) -> u64 {
        self.limit.saturating_sub(self.spent)
    }

    /// What was spent so far.
    pub(crate) fn spent(&self) -> u64 {
        self.spent
    }

    /// For the names of parts, of which one can serve every part of a file.
    pub(crate) fn of_names() -> Purse {
        Purse::new("bytes in the names of parts", ALL_NAME_BYTES)
    }
}

/// A name of at most [`NAME_BYTES`].
pub(crate) fn short_name(mut name: String) -> String {
    name.truncate(name.floor_char_boundary(NAME_BYTES));
    name.shrink_to_fit();
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_is_refused_where_it_passes_its_limit() {
        let mut purse = Purse::new("pieces", 5);
        purse.spend(3).expect("three of five");
        purse.spend(2).expect("five of five");
        let fault = purse.spend(1).expect_err("six of five").to_string();
        assert_eq!(fault, "6 pieces are more than the limit of 5");
    }
}
