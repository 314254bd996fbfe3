//! Where the matrix has entries, and the plan of its factorization.

use glam::DVec3;

use super::dissection::nested_dissection;
use super::elimination::postordered;
use super::plan::Plan;
use super::symbolic::Supernodes;

/// Lower triangle of the mesh Laplacian by columns, diagonal first, and the plan of its factorization.
pub(crate) struct Pattern {
    pub(super) columns: Vec<u32>,
    pub(super) rows: Vec<u32>,
    pub(super) plan: Result<Plan, OutOfRange>,
}

/// The factor does not fit memory or 32-bit indices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutOfRange;

/// A pattern in an order that is not analyzed yet.
pub(crate) struct Ordered {
    columns: Vec<u32>,
    rows: Vec<u32>,
    /// The neighbors of every row.
    offsets: Vec<u32>,
    neighbors: Vec<u32>,
    order: Vec<u32>,
}

impl Ordered {
    /// `edges`: unordered pairs (lower, upper) of rows, which are `points` in space. Returns also the place of each
    /// edge's value in the pattern; row `i` keeps its diagonal at [`Pattern::diagonal`].
    pub(crate) fn new(points: &[DVec3], edges: &[[u32; 2]]) -> (Ordered, Vec<u32>) {
        let (columns, rows, slots) = lower_triangle(points.len(), edges);
        let (offsets, neighbors) = graph(&columns, &rows);
        let order = nested_dissection(points, &offsets, &neighbors);
        (Ordered { columns, rows, offsets, neighbors, order }, slots)
    }

    /// As [`Ordered::new`] for a matrix of blocks of `size` rows each: one for each of the `points`, full, and a full
    /// one for every link (lower, upper) between two of them. The places are those of (a, b) for a < b within the blocks
    /// of the points, one after the other, and then of all (a, b) of every link.
    pub(crate) fn of_blocks(points: &[DVec3], links: &[[u32; 2]], size: u32) -> (Ordered, Vec<u32>) {
        let n = points.len() as u32;
        let within = (0..n).flat_map(|i| (0..size).flat_map(move |a| (a + 1..size).map(move |b| (i, a, i, b))));
        let between = links.iter().flat_map(|&[i, j]| (0..size * size).map(move |ab| (i, ab / size, j, ab % size)));
        let edges: Vec<[u32; 2]> = within.chain(between).map(|(i, a, j, b)| [i * size + a, j * size + b]).collect();
        let (columns, rows, slots) = lower_triangle(points.len() * size as usize, &edges);
        // The blocks are cut as wholes.
        let (block_columns, block_rows, _) = lower_triangle(points.len(), links);
        let (offsets, neighbors) = graph(&block_columns, &block_rows);
        let blocks = nested_dissection(points, &offsets, &neighbors);
        let order: Vec<u32> = blocks.iter().flat_map(|&i| i * size..(i + 1) * size).collect();
        let (offsets, neighbors) = graph(&columns, &rows);
        (Ordered { columns, rows, offsets, neighbors, order }, slots)
    }

    /// The symbolic factorization: one thread's work.
    pub(crate) fn analyzed(self) -> Pattern {
        let Ordered { columns, rows, offsets, neighbors, order } = self;
        let order = postordered(&order, &offsets, &neighbors);
        let plan =
            Supernodes::new(&columns, &rows, &order).map(|supernodes| Plan::new(order, &supernodes, (&columns, &rows)));
        Pattern { columns, rows, plan }
    }
}

impl Pattern {
    /// Place of the diagonal value of a row.
    pub(crate) fn diagonal(&self, row: usize) -> usize {
        self.columns[row] as usize
    }

    /// Number of values.
    pub(crate) fn n_values(&self) -> usize {
        self.rows.len()
    }

    /// The product of the matrix with a vector.
    #[cfg(test)]
    pub(super) fn times(&self, values: &[f64], x: &[crate::kernels::quad::Quad]) -> Vec<DVec3> {
        let mut product = vec![DVec3::ZERO; x.len()];
        for j in 0..x.len() {
            let slots = self.columns[j] as usize..self.columns[j + 1] as usize;
            for (&i, &value) in self.rows[slots.clone()].iter().zip(&values[slots]) {
                let i = i as usize;
                product[i] += x[j].xyz() * value;
                if i != j {
                    product[j] += x[i].xyz() * value;
                }
            }
        }
        product
    }
}

/// Columns and rows of the lower triangle with a diagonal, and the place of each edge (lower, upper) in it.
fn lower_triangle(n: usize, edges: &[[u32; 2]]) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let mut columns = vec![1u32; n + 1];
    columns[0] = 0;
    for edge in edges {
        columns[edge[0] as usize + 1] += 1;
    }
    for i in 0..n {
        columns[i + 1] += columns[i];
    }
    let mut by_ends: Vec<u32> = (0..edges.len() as u32).collect();
    by_ends.sort_unstable_by_key(|&e| edges[e as usize]);
    let mut next: Vec<u32> = columns[..n].to_vec();
    let mut rows = vec![0u32; n + edges.len()];
    for (i, next) in next.iter_mut().enumerate() {
        rows[*next as usize] = i as u32;
        *next += 1;
    }
    let mut slots = vec![0u32; edges.len()];
    for e in by_ends {
        let [lower, upper] = edges[e as usize];
        let slot = &mut next[lower as usize];
        rows[*slot as usize] = upper;
        slots[e as usize] = *slot;
        *slot += 1;
    }
    (columns, rows, slots)
}

/// Neighbors of every row, from the lower triangle.
fn graph(columns: &[u32], rows: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let n = columns.len() - 1;
    let below = |j: usize| &rows[columns[j] as usize + 1..columns[j + 1] as usize];
    let mut offsets = vec![0u32; n + 1];
    for j in 0..n {
        offsets[j + 1] += below(j).len() as u32;
        below(j).iter().for_each(|&i| offsets[i as usize + 1] += 1);
    }
    (0..n).for_each(|j| offsets[j + 1] += offsets[j]);
    let mut next = offsets.clone();
    let mut neighbors = vec![0u32; offsets[n] as usize];
    for j in 0..n {
        for &i in below(j) {
            for (here, there) in [(j, i), (i as usize, j as u32)] {
                neighbors[next[here] as usize] = there;
                next[here] += 1;
            }
        }
    }
    (offsets, neighbors)
}
