//! Single vertices that fell out of line brought back into it.

use rayon::prelude::*;

use crate::{Mesh, Rigidity, VertexId};

impl Rigidity {
    /// Majority among neighbors: a vertex takes the size that more than half of its neighbors have, if there is one.
    /// All vertices at once, up to `rounds` times, until nothing changes. Borders between regions stay where they are,
    /// gradual changes too; only specks vanish, larger ones with more rounds. Learned sizes need it where poses are few
    /// or noisy.
    ///
    /// Sizes of another mesh (more or fewer than vertices) come back as they are.
    pub fn smoothed(&self, mesh: &Mesh, rounds: usize) -> Rigidity {
        let mut sizes = self.as_slice().to_vec();
        if sizes.len() != mesh.n_vertices() {
            return self.clone();
        }
        for _ in 0..rounds {
            let next: Vec<u16> = (0..sizes.len() as u32)
                .into_par_iter()
                .with_min_len(MIN_VERTICES)
                .map(|v| majority(&sizes, mesh.neighbors(VertexId(v))).unwrap_or(sizes[v as usize]))
                .collect();
            if next == sizes {
                break;
            }
            sizes = next;
        }
        Rigidity::new(sizes).expect("sizes are those of neighbors")
    }
}

/// Vertices that one thread takes at once: some tens of microseconds.
const MIN_VERTICES: usize = 2048;

/// The size of more than half of some vertices. Boyer and Moore: pairs of different sizes cancel, and only what is left
/// over can have been the majority.
fn majority(sizes: &[u16], neighbors: &[u32]) -> Option<u16> {
    let (mut candidate, mut lead) = (0, 0usize);
    for &v in neighbors {
        let size = sizes[v as usize];
        match lead {
            0 => (candidate, lead) = (size, 1),
            _ if size == candidate => lead += 1,
            _ => lead -= 1,
        }
    }
    let votes = neighbors.iter().filter(|&&v| sizes[v as usize] == candidate).count();
    Some(candidate).filter(|_| 2 * votes > neighbors.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::bumpy_sheet;

    #[test]
    fn specks_vanish_and_borders_stay() {
        let mesh = bumpy_sheet(20);
        let half = mesh.positions().iter().map(|p| if p.x < 9.5 { 2 } else { 6 });
        let clean = Rigidity::new(half.collect()).expect("in range").smoothed(&mesh, 50);
        let inner = (0..mesh.n_vertices()).find(|&v| {
            let p = mesh.positions()[v];
            (3.0..6.0).contains(&p.x) && (5.0..15.0).contains(&p.y)
        });
        let speck = inner.expect("the sheet has an inside");
        let mut sizes = clean.as_slice().to_vec();
        sizes[speck] = 5;
        let spotted = Rigidity::new(sizes).expect("in range");
        assert_eq!(spotted.smoothed(&mesh, 0), spotted);
        assert_eq!(spotted.smoothed(&mesh, 1), clean);
        assert!(clean.min() == 2 && clean.max() == 6, "both halves are still there");
        let foreign = Rigidity::uniform(7, 3);
        assert_eq!(foreign.smoothed(&mesh, 3), foreign);
    }

    #[test]
    fn a_majority_is_more_than_half() {
        let sizes = [1, 2, 2, 3, 3, 3];
        assert_eq!(majority(&sizes, &[1, 2, 3]), Some(2));
        assert_eq!(majority(&sizes, &[1, 2, 3, 4]), None);
        assert_eq!(majority(&sizes, &[0, 3, 1, 4, 5]), Some(3));
        assert_eq!(majority(&sizes, &[]), None);
    }
}
