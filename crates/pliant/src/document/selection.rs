//! Sets of surface points, as sorted lists: small where little is selected, and joined in one pass where much is.

use std::cmp::Ordering;
use std::sync::Arc;

use pliant_solver::VertexId;

/// How newly selected vertices join those already selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelectMode {
    /// Only the new ones.
    Replace,
    /// Both.
    Add,
    /// The old ones without the new ones.
    Remove,
}

/// A set of surface points, sorted. Cheap to clone.
#[derive(Clone, Debug, Default)]
pub struct Selection(Arc<[VertexId]>);

/// Selections share their lists with older states of the scene, so most comparisons end at the pointers.
impl PartialEq for Selection {
    fn eq(&self, other: &Selection) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl Eq for Selection {}

impl Selection {
    /// Sorts and removes duplicates. O(n) for what is sorted already.
    pub fn new(mut vertices: Vec<VertexId>) -> Selection {
        vertices.sort_unstable();
        vertices.dedup();
        Selection(vertices.into())
    }

    /// The vertices whose flag is set.
    pub fn of_flags(flags: &[bool]) -> Selection {
        Selection((0..).zip(flags).filter(|&(_, &flag)| flag).map(|(v, _)| VertexId(v)).collect())
    }

    /// One flag for each of `n` vertices: whether it is selected.
    pub fn flags(&self, n: usize) -> Vec<bool> {
        let mut flags = vec![false; n];
        self.0.iter().for_each(|v| flags[v.index()] = true);
        flags
    }

    /// The selected points, sorted.
    pub fn vertices(&self) -> &[VertexId] {
        &self.0
    }

    /// Number of selected points.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether `v` is selected. O(log n).
    pub fn contains(&self, v: VertexId) -> bool {
        self.0.binary_search(&v).is_ok()
    }

    /// This selection after `new` joined it. O(n) of both.
    pub fn combined(&self, new: Selection, mode: SelectMode) -> Selection {
        match mode {
            SelectMode::Replace => new,
            SelectMode::Add if self.is_empty() => new,
            SelectMode::Add | SelectMode::Remove if new.is_empty() => self.clone(),
            SelectMode::Add => self.merged(&new, |_| true),
            SelectMode::Remove => self.merged(&new, |side| side == Ordering::Less),
        }
    }

    /// Walks both lists at once and keeps what `keeps`: `Less` is in this one only, `Greater` in the other only.
    fn merged(&self, other: &Selection, keeps: impl Fn(Ordering) -> bool) -> Selection {
        let (mut a, mut b) = (self.vertices(), other.vertices());
        let mut out = Vec::with_capacity(a.len() + b.len());
        loop {
            let (side, v) = match (a.first(), b.first()) {
                (None, None) => return Selection(out.into()),
                (Some(&v), None) => (Ordering::Less, v),
                (None, Some(&v)) => (Ordering::Greater, v),
                (Some(&v), Some(&w)) => (v.cmp(&w), v.min(w)),
            };
            a = if side.is_le() { &a[1..] } else { a };
            b = if side.is_ge() { &b[1..] } else { b };
            if keeps(side) {
                out.push(v);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn selections_combine_as_sets_do() {
        let list = |step: u32, n: u32| (0..n).map(|k| VertexId(k * step % 97)).collect::<Vec<_>>();
        for (a, b) in
            [(list(3, 40), list(5, 30)), (list(1, 10), vec![]), (vec![], list(7, 9)), (list(2, 9), list(2, 9))]
        {
            let (old, new) = (Selection::new(a.clone()), Selection::new(b.clone()));
            let (a, b): (BTreeSet<_>, BTreeSet<_>) = (a.into_iter().collect(), b.into_iter().collect());
            let got = |mode| old.combined(new.clone(), mode).vertices().to_vec();
            assert_eq!(got(SelectMode::Add), a.union(&b).copied().collect::<Vec<_>>());
            assert_eq!(got(SelectMode::Remove), a.difference(&b).copied().collect::<Vec<_>>());
            assert_eq!(got(SelectMode::Replace), b.iter().copied().collect::<Vec<_>>());
            assert_eq!(Selection::of_flags(&old.flags(97)), old);
        }
    }
}
