//! How L is kept for solving: by rows, a few columns at a time.
//!
//! The columns of a node are cut into panels of up to [`WIDTH`]. A panel begins with the inverse of its triangle on the
//! diagonal, packed by rows; then come its entries in every row below: first the later columns of the same node, then
//! the rows of the node. Both triangular solves walk through all panels once, in order or backward, with the unknowns of
//! a panel in registers.

use super::plan::Node;

/// Columns of a panel: eight sums of a vector register each, and room for what is being added.
pub(super) const WIDTH: usize = 8;

/// Number of values of a panel with so many columns and rows below its triangle.
pub(super) fn n_values(width: usize, n_rows: usize) -> usize {
    triangle(width) + width * n_rows
}

/// Number of values of a packed triangle.
pub(super) fn triangle(width: usize) -> usize {
    width * (width + 1) / 2
}

/// A few columns of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panel {
    /// First column within the node.
    pub(super) first: usize,
    pub(super) width: usize,
    /// Later columns of the node.
    pub(super) inside: usize,
}

/// The panels of a node, first to last.
pub(super) fn panels(node_width: usize) -> impl DoubleEndedIterator<Item = Panel> {
    (0..node_width.div_ceil(WIDTH)).map(move |p| {
        let first = p * WIDTH;
        let width = WIDTH.min(node_width - first);
        Panel { first, width, inside: node_width - first - width }
    })
}

/// Number of values of all panels of a node.
pub(super) fn values_of_node(node: &Node) -> usize {
    panels(node.width as usize).map(|panel| n_values(panel.width, panel.inside + node.height())).sum()
}

/// Takes over a node's columns from a factored front (by columns, `n_rows` each).
pub(super) fn store(front: &[f64], n_rows: usize, node: &Node, values: &mut [f64]) {
    let mut rest = values;
    for panel in panels(node.width as usize) {
        let (mine, later) = rest.split_at_mut(n_values(panel.width, panel.inside + node.height()));
        rest = later;
        let (inverse, below) = mine.split_at_mut(triangle(panel.width));
        let entry = |row: usize, column: usize| front[(panel.first + column) * n_rows + row];
        invert(|row, column| entry(panel.first + row, column), inverse, panel.width);
        let first_row = panel.first + panel.width;
        for column in 0..panel.width {
            let from = &front[(panel.first + column) * n_rows..][first_row..n_rows];
            for (to, &from) in below.chunks_exact_mut(panel.width).zip(from) {
                to[column] = from;
            }
        }
    }
}

/// The inverse of a lower triangle, packed by rows.
fn invert(l: impl Fn(usize, usize) -> f64, inverse: &mut [f64], width: usize) {
    for i in 0..width {
        let pivot = 1.0 / l(i, i);
        for j in 0..i {
            let sum: f64 = (j..i).map(|p| l(i, p) * inverse[triangle(p) + j]).sum();
            inverse[triangle(i) + j] = -sum * pivot;
        }
        inverse[triangle(i) + i] = pivot;
    }
}

/// The diagonal of L in a node's columns: (column within the node, entry).
pub(super) fn diagonal<'a>(node: &Node, values: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
    let height = node.height();
    let mut at = 0;
    panels(node.width as usize).flat_map(move |panel| {
        let inverse = &values[at..at + triangle(panel.width)];
        at += n_values(panel.width, panel.inside + height);
        (0..panel.width).map(move |i| (panel.first + i, 1.0 / inverse[triangle(i) + i]))
    })
}
