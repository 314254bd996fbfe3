//! A balanced tree of boxes whose shape depends only on how many items it holds.
//!
//! The items are sorted so that each half of a node's range lies on one side of a median; nodes then need no links: node
//! i has the children 2i + 1 and 2i + 2, and the leaves share the items evenly. So the tree can be neither deep nor
//! lopsided whatever the input, children come after their parents, and moving the items only means filling the boxes
//! again from the last to the first. Meshes are tessellated evenly enough for medians to do as well as costlier
//! splits; what is asked here is a few rays per frame.

use crate::bounds::Bounds;
use glam::Vec3;
use rayon::prelude::*;

/// Items per leaf: reading a few boxes in a row costs less than another level. By eye; 2 to 8 are alike.
const ITEMS_PER_LEAF: usize = 4;
/// Below this many items a split is not worth a task of its own.
const PARALLEL_ITEMS: usize = 8192;

/// The tree: items by number, a box for every node.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    /// Item numbers; each leaf owns a range of them.
    items: Vec<u32>,
    /// One box per node, root first.
    bounds: Vec<Bounds>,
    /// A power of two, or 0 when there are no items.
    n_leaves: usize,
}

/// What a walk meets.
pub(crate) enum Node<'a> {
    /// The two children.
    Inner([usize; 2]),
    /// The items of a leaf.
    Leaf(&'a [u32]),
}

impl Tree {
    /// Builds the tree over items 0..n with these boxes. O(n log n), parallel, the same for the same boxes.
    pub(crate) fn new(boxes: &[Bounds]) -> Tree {
        if boxes.is_empty() {
            return Tree::default();
        }
        let n_leaves = boxes.len().div_ceil(ITEMS_PER_LEAF).next_power_of_two();
        let mut items: Vec<u32> = (0..boxes.len() as u32).collect();
        let leaves = Leaves { n_items: boxes.len(), n_leaves };
        sort_by_medians(&mut items, leaves, 0..n_leaves, boxes);
        let mut tree = Tree { items, bounds: vec![Bounds::EMPTY; 2 * n_leaves - 1], n_leaves };
        tree.refit(|item| boxes[item as usize]);
        tree
    }

    /// Fills every node's box again. O(n), no allocation, parallel over the leaves.
    pub(crate) fn refit(&mut self, bounds_of: impl Fn(u32) -> Bounds + Sync) {
        let Some(first_leaf) = self.n_leaves.checked_sub(1) else {
            return;
        };
        let leaves = Leaves { n_items: self.items.len(), n_leaves: self.n_leaves };
        let items = &self.items;
        let (inner, leaf_bounds) = self.bounds.split_at_mut(first_leaf);
        leaf_bounds.par_iter_mut().with_min_len(PARALLEL_ITEMS / ITEMS_PER_LEAF).enumerate().for_each(|(leaf, out)| {
            let range = leaves.first_item(leaf)..leaves.first_item(leaf + 1);
            *out = items[range].iter().map(|&item| bounds_of(item)).fold(Bounds::EMPTY, Bounds::union);
        });
        for node in (0..inner.len()).rev() {
            self.bounds[node] = self.bounds[2 * node + 1].union(self.bounds[2 * node + 2]);
        }
    }

    /// The root, unless the tree is empty.
    pub(crate) fn root(&self) -> Option<usize> {
        (self.n_leaves > 0).then_some(0)
    }

    /// The box of a node.
    pub(crate) fn bounds(&self, node: usize) -> &Bounds {
        &self.bounds[node]
    }

    /// The children or items of a node.
    pub(crate) fn node(&self, node: usize) -> Node<'_> {
        let first_leaf = self.n_leaves - 1;
        if node < first_leaf {
            return Node::Inner([2 * node + 1, 2 * node + 2]);
        }
        let leaves = Leaves { n_items: self.items.len(), n_leaves: self.n_leaves };
        let leaf = node - first_leaf;
        Node::Leaf(&self.items[leaves.first_item(leaf)..leaves.first_item(leaf + 1)])
    }

    /// The item whose place is nearest to `point`, among those within `reach`; the lowest of equally near ones. Items must
    /// lie in the boxes the tree was built from.
    pub(crate) fn nearest(&self, point: Vec3, reach: f32, place: impl Fn(u32) -> Vec3) -> Option<u32> {
        let mut best = (if reach >= 0.0 { reach * reach } else { -1.0 }, None);
        let mut open: Vec<(f32, usize)> = self.root().map(|root| (0.0, root)).into_iter().collect();
        while let Some((far, node)) = open.pop() {
            if far > best.0 {
                continue;
            }
            match self.node(node) {
                Node::Inner(children) => {
                    let mut near = children.map(|child| (self.bounds[child].distance_squared(point), child));
                    near.sort_by(|a, b| b.0.total_cmp(&a.0));
                    open.extend(near); // the nearer one on top
                }
                Node::Leaf(items) => {
                    for &item in items {
                        let distance = place(item).distance_squared(point);
                        let is_first = best.1.is_none_or(|known| item < known);
                        if distance < best.0 || distance == best.0 && is_first {
                            best = (distance, Some(item));
                        }
                    }
                }
            }
        }
        best.1
    }

    /// Calls `visit` with each item whose leaf's box overlaps `bounds`.
    pub(crate) fn for_each_near(&self, bounds: &Bounds, mut visit: impl FnMut(u32)) {
        let mut stack = NodeStack::default();
        stack.extend(self.root());
        while let Some(node) = stack.pop() {
            if !self.bounds(node).overlaps(bounds) {
                continue;
            }
            match self.node(node) {
                Node::Inner(children) => stack.extend(children),
                Node::Leaf(items) => items.iter().for_each(|&item| visit(item)),
            }
        }
    }
}

/// Nodes still to visit, depth first: at most one sibling a level and 31 levels for 2³² items, so no allocation.
#[derive(Default)]
pub(crate) struct NodeStack {
    nodes: [usize; 32],
    len: usize,
}

impl NodeStack {
    pub(crate) fn push(&mut self, node: usize) {
        self.nodes[self.len] = node;
        self.len += 1;
    }

    pub(crate) fn pop(&mut self) -> Option<usize> {
        self.len = self.len.checked_sub(1)?;
        Some(self.nodes[self.len])
    }

    pub(crate) fn extend(&mut self, nodes: impl IntoIterator<Item = usize>) {
        nodes.into_iter().for_each(|node| self.push(node));
    }
}

/// How the items are shared out: evenly.
#[derive(Clone, Copy)]
struct Leaves {
    n_items: usize,
    n_leaves: usize,
}

impl Leaves {
    fn first_item(self, leaf: usize) -> usize {
        (leaf as u128 * self.n_items as u128 / self.n_leaves as u128) as usize
    }
}

/// Sorts `items`, which belong to the leaves `range`, so that each half of the leaves gets one side of the median along
/// the longest axis. Recursion is as deep as the tree, which is balanced: at most 32.
fn sort_by_medians(items: &mut [u32], leaves: Leaves, range: std::ops::Range<usize>, boxes: &[Bounds]) {
    if range.len() <= 1 {
        return;
    }
    let middle = range.start + range.len() / 2;
    let n_left = leaves.first_item(middle) - leaves.first_item(range.start);
    let (mut low, mut high) = (glam::Vec3::INFINITY, glam::Vec3::NEG_INFINITY);
    for &item in items.iter() {
        let center = boxes[item as usize].center();
        (low, high) = (low.min(center), high.max(center));
    }
    let axis = (high - low).max_position();
    if n_left < items.len() {
        items.select_nth_unstable_by(n_left, |&a, &b| {
            let along = |item: u32| boxes[item as usize].center()[axis];
            along(a).total_cmp(&along(b)).then(a.cmp(&b))
        });
    }
    let (left, right) = items.split_at_mut(n_left);
    let mut split_left = || sort_by_medians(left, leaves, range.start..middle, boxes);
    let mut split_right = || sort_by_medians(right, leaves, middle..range.end, boxes);
    if range.len() * ITEMS_PER_LEAF > PARALLEL_ITEMS {
        rayon::join(split_left, split_right);
    } else {
        split_left();
        split_right();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_is_found_whatever_their_number() {
        for n in [0_usize, 1, 2, 3, 4, 5, 7, 16, 17, 100, 1025] {
            let boxes: Vec<Bounds> =
                (0..n).map(|i| Bounds { min: Vec3::splat(i as f32), max: Vec3::splat(i as f32 + 0.5) }).collect();
            let tree = Tree::new(&boxes);
            for (i, b) in boxes.iter().enumerate() {
                let mut found = false;
                tree.for_each_near(b, |item| found |= item as usize == i);
                assert!(found, "item {i} of {n}");
            }
        }
    }

    #[test]
    fn the_nearest_item_is_that_of_a_plain_search() {
        let mut noise = crate::test_shapes::Noise(8);
        let mut places: Vec<Vec3> = (0..300).map(|_| noise.point()).collect();
        places.extend_from_within(..20); // twice at the same place
        let tree = Tree::new(&places.iter().map(|&p| Bounds { min: p, max: p }).collect::<Vec<_>>());
        for reach in [0.05, 0.3, f32::INFINITY] {
            for _ in 0..200 {
                let point = noise.point();
                let by_distance = |&i: &u32| places[i as usize].distance_squared(point);
                let expected = (0..places.len() as u32).min_by(|a, b| by_distance(a).total_cmp(&by_distance(b)));
                let expected = expected.filter(|i| by_distance(i) <= reach * reach);
                assert_eq!(tree.nearest(point, reach, |i| places[i as usize]), expected, "{point} within {reach}");
            }
        }
        assert_eq!(Tree::new(&[]).nearest(Vec3::ZERO, 1.0, |_| Vec3::ZERO), None);
    }

    #[test]
    fn a_million_equal_boxes_make_a_balanced_tree() {
        let boxes = vec![Bounds { min: Vec3::ZERO, max: Vec3::ONE }; 1_000_000];
        let mut n_found = 0;
        Tree::new(&boxes).for_each_near(&boxes[0], |_| n_found += 1);
        assert_eq!(n_found, 1_000_000);
    }
}
