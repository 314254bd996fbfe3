//! Neighborhood sizes, one per vertex.

use std::sync::Arc;

use crate::RigidityError;

/// Neighborhood size r ≥ 1 of every vertex, in rings of edges. Immutable, cheap to clone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rigidity {
    r: Arc<[u16]>,
    min: u16,
    max: u16,
    sum: u64,
}

impl Rigidity {
    /// The largest size. By eye: far beyond the diameter of what moves at interactive rates.
    pub const MAX: u16 = 1000;

    /// The same size for all; an `r` outside 1..=[`Rigidity::MAX`] is brought to the nearest end.
    pub fn uniform(n_vertices: usize, r: u16) -> Rigidity {
        Rigidity::of_valid(vec![r.clamp(1, Self::MAX); n_vertices].into())
    }

    /// One size per vertex.
    ///
    /// # Errors
    /// [`RigidityError::OutOfRange`] for the first value outside 1..=[`Rigidity::MAX`].
    pub fn new(r: Vec<u16>) -> Result<Rigidity, RigidityError> {
        Rigidity::checked(r.into())
    }

    /// These sizes after `edit`: one copy of two bytes a vertex and two passes over them, so that a dab of a brush costs
    /// the same few microseconds for ten changed vertices as for ten thousand.
    ///
    /// # Errors
    /// [`RigidityError::OutOfRange`] for the first value outside 1..=[`Rigidity::MAX`].
    pub fn edited(&self, edit: impl FnOnce(&mut [u16])) -> Result<Rigidity, RigidityError> {
        let mut r: Arc<[u16]> = Arc::from(&*self.r);
        edit(Arc::make_mut(&mut r));
        Rigidity::checked(r)
    }

    fn checked(r: Arc<[u16]>) -> Result<Rigidity, RigidityError> {
        let rigidity = Rigidity::of_valid(r);
        let valid = 1..=Self::MAX;
        if valid.contains(&rigidity.min) && valid.contains(&rigidity.max) {
            return Ok(rigidity);
        }
        let vertex = rigidity.r.iter().position(|r| !valid.contains(r)).unwrap_or(0);
        Err(RigidityError::OutOfRange { vertex, r: rigidity.r[vertex], max: Self::MAX })
    }

    fn of_valid(r: Arc<[u16]>) -> Rigidity {
        Rigidity {
            min: r.iter().copied().min().unwrap_or(1),
            max: r.iter().copied().max().unwrap_or(1),
            sum: r.iter().map(|&r| u64::from(r)).sum(),
            r,
        }
    }

    /// One size per vertex, in the caller's numbering.
    pub fn as_slice(&self) -> &[u16] {
        &self.r
    }

    /// The smallest size, known already (1 for an empty list).
    pub fn min(&self) -> u16 {
        self.min
    }

    /// The largest size, known already (1 for an empty list).
    pub fn max(&self) -> u16 {
        self.max
    }

    /// The mean size, known already (1 for an empty list).
    pub fn mean(&self) -> f64 {
        if self.r.is_empty() { 1.0 } else { self.sum as f64 / self.r.len() as f64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_outside_the_range_are_refused_by_vertex() {
        let refused = Rigidity::new(vec![1, 2, 0, 5]);
        assert_eq!(refused, Err(RigidityError::OutOfRange { vertex: 2, r: 0, max: Rigidity::MAX }));
        assert!(Rigidity::new(vec![1, Rigidity::MAX + 1]).is_err());
    }

    #[test]
    fn an_edit_changes_a_copy_and_is_checked_like_the_whole() {
        let r = Rigidity::uniform(4, 2);
        let edited = r.edited(|r| r[3] = 9).expect("in range");
        assert_eq!(edited, Rigidity::new(vec![2, 2, 2, 9]).expect("in range"));
        assert_eq!(r, Rigidity::uniform(4, 2), "the original stays");
        let refused = r.edited(|r| r[1] = 0);
        assert_eq!(refused, Err(RigidityError::OutOfRange { vertex: 1, r: 0, max: Rigidity::MAX }));
    }

    #[test]
    fn statistics_are_those_of_the_values() {
        let r = Rigidity::new(vec![1, 2, 6]).expect("in range");
        assert_eq!((r.min(), r.max(), r.mean()), (1, 6, 3.0));
        assert_eq!(Rigidity::uniform(3, 0), Rigidity::uniform(3, 1));
    }
}
