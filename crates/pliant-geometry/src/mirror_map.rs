//! Which vertex is whose mirror image.
//!
//! Two ways to find out, for two kinds of meshes. *By a plane*: the vertex nearest to the mirrored place, within a
//! tolerance; right for any triangulation of a symmetric shape. *By topology*: both sides of a middle edge are walked in
//! step, triangle by triangle, and what is met at the same time is a pair; right for a symmetric mesh in any pose.

mod by_plane;
mod by_topology;
mod walk;

pub use by_plane::Plane;
pub use by_topology::{Seam, Uneven};

/// No vertex.
const NONE: u32 = u32::MAX;

/// For each vertex the one across that it takes after, and the other way round.
///
/// On a symmetric mesh these are pairs. Where the triangulation differs from side to side, several vertices may take after
/// one; *partners* are those that take after each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MirrorMap {
    of: Vec<u32>,
    /// The vertices that take after v: `across[starts[v]..starts[v + 1]]`, ascending.
    starts: Vec<u32>,
    across: Vec<u32>,
    n_alone: usize,
}

impl MirrorMap {
    /// From the vertex that each vertex takes after, or [`NONE`].
    fn new(of: Vec<u32>) -> MirrorMap {
        let mut starts = vec![0_u32; of.len() + 1];
        of.iter().filter(|&&v| v != NONE).for_each(|&v| starts[v as usize + 1] += 1);
        for v in 0..of.len() {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut across = vec![0_u32; starts[of.len()] as usize];
        for (v, &source) in (0..).zip(&of) {
            if source != NONE {
                across[next[source as usize] as usize] = v;
                next[source as usize] += 1;
            }
        }
        let n_alone = of.iter().filter(|&&v| v == NONE).count();
        MirrorMap { of, starts, across, n_alone }
    }

    /// The vertex that `v` takes after: what happens to that one happens to `v`.
    pub fn source(&self, v: u32) -> Option<u32> {
        self.of.get(v as usize).copied().filter(|&v| v != NONE)
    }

    /// The vertex that `v` takes after, if it takes after `v` in turn. A vertex of the middle is its own partner.
    pub fn partner(&self, v: u32) -> Option<u32> {
        self.source(v).filter(|&w| self.source(w) == Some(v))
    }

    /// The vertices that take after `v`, ascending.
    pub fn across(&self, v: u32) -> &[u32] {
        match self.starts.get(v as usize..v as usize + 2) {
            Some(&[start, end]) => &self.across[start as usize..end as usize],
            _ => &[],
        }
    }

    /// How many vertices take after none.
    pub fn n_alone(&self) -> usize {
        self.n_alone
    }

    /// How many vertices there are.
    pub fn n_vertices(&self) -> usize {
        self.of.len()
    }
}

#[cfg(test)]
mod tests;
