//! Eq. (1) of the paper minimized slowly and plainly: vertex sets by breadth-first search, sums term by term, a dense
//! factorization, rotations by singular values. It shares no code with the solver and has none of its shortcuts.
//!
//! ```text
//! E(p', R) = Σ_k Σ_{(i,j) ∈ N(k, r_k)} w_ij ‖(p'_i − p'_j) − R_k (p_i − p_j)‖²
//! (i,j) ∈ N(k, r)  ⇔  min(d(k,i), d(k,j)) ≤ r − 1
//! ```

mod dense;
mod rotation;

use std::collections::{BTreeMap, VecDeque};

use crate::shapes::{Shape, Vector};
use dense::Factor;
use rotation::{Matrix, best_rotation, identity, times};

/// Weights of the edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceWeights {
    /// Half the sum of the cotangents of the opposite angles (eq. 2), as they are.
    Cotangent,
    /// 1.
    Uniform,
}

/// What the iteration went through.
#[derive(Clone, Debug)]
pub struct ReferenceRun {
    /// Positions after the last iteration.
    pub positions: Vec<Vector>,
    /// Energy after each iteration.
    pub energies: Vec<f64>,
}

/// The reduced matrix has a pivot that is not positive: eq. (1) has no minimum in the positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Indefinite;

struct Edge {
    ends: [usize; 2],
    weight: f64,
    rest: Vector,
}

/// `iterations` global and local steps from the identity, with rigidity `r` of each vertex and the given vertices held
/// at the given positions.
pub fn run(
    shape: &Shape,
    weights: ReferenceWeights,
    r: &[u16],
    handles: &[(usize, Vector)],
    iterations: usize,
) -> Result<ReferenceRun, Indefinite> {
    let edges = edges(shape, weights);
    let neighborhoods = neighborhoods(shape.positions.len(), &edges, r);
    let system = System::new(shape.positions.len(), &edges, &neighborhoods, handles)?;
    let mut rotations = vec![identity(); shape.positions.len()];
    let mut positions = shape.positions.clone();
    let mut energies = Vec::new();
    for _ in 0..iterations {
        system.global_step(&edges, &neighborhoods, &rotations, &mut positions);
        for (rotation, neighborhood) in rotations.iter_mut().zip(&neighborhoods) {
            *rotation = fit(&edges, neighborhood, &positions);
        }
        energies.push(energy(&edges, &neighborhoods, &rotations, &positions));
    }
    Ok(ReferenceRun { positions, energies })
}

/// Every edge once, with its weight summed over the triangles around it.
fn edges(shape: &Shape, weights: ReferenceWeights) -> Vec<Edge> {
    let mut by_ends = BTreeMap::new();
    for &triangle in &shape.triangles {
        let corners = triangle.map(|corner| corner as usize);
        for opposite in 0..3 {
            let [apex, i, j] = [0, 1, 2].map(|step| corners[(opposite + step) % 3]);
            *by_ends.entry([i.min(j), i.max(j)]).or_insert(0.0) += 0.5 * cotangent(shape, apex, i, j);
        }
    }
    let edge = |(ends, weight): ([usize; 2], f64)| Edge {
        ends,
        weight: if weights == ReferenceWeights::Uniform { 1.0 } else { weight },
        rest: minus(shape.positions[ends[0]], shape.positions[ends[1]]),
    };
    by_ends.into_iter().map(edge).collect()
}

/// Cotangent of the angle at `apex` between `i` and `j`.
fn cotangent(shape: &Shape, apex: usize, i: usize, j: usize) -> f64 {
    let at = |vertex: usize| shape.positions[vertex];
    let (u, v) = (minus(at(i), at(apex)), minus(at(j), at(apex)));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    dot(u, v) / dot(cross, cross).sqrt()
}

/// Numbers of the edges in N(k, r_k), for every k.
fn neighborhoods(n_vertices: usize, edges: &[Edge], r: &[u16]) -> Vec<Vec<usize>> {
    let mut incident = vec![Vec::new(); n_vertices];
    for (number, edge) in edges.iter().enumerate() {
        for end in edge.ends {
            incident[end].push(number);
        }
    }
    let neighborhood = |k: usize| {
        let mut distance = BTreeMap::from([(k, 0_u16)]);
        let mut waiting = VecDeque::from([k]);
        let mut members = std::collections::BTreeSet::new();
        while let Some(vertex) = waiting.pop_front() {
            // An edge belongs to N(k, r) if one of its ends is at most r − 1 edges away.
            if distance[&vertex] + 1 > r[k] {
                continue;
            }
            for &number in &incident[vertex] {
                members.insert(number);
                let [i, j] = edges[number].ends;
                let other = if i == vertex { j } else { i };
                if !distance.contains_key(&other) {
                    distance.insert(other, distance[&vertex] + 1);
                    waiting.push_back(other);
                }
            }
        }
        members.into_iter().collect()
    };
    (0..n_vertices).map(neighborhood).collect()
}

/// The linear system of the global step, factored.
struct System {
    /// Number of each free vertex among the unknowns.
    unknown: Vec<Option<usize>>,
    /// How many neighborhoods each edge is in.
    multiplicity: Vec<f64>,
    factor: Factor,
    handles: Vec<(usize, Vector)>,
}

impl System {
    fn new(
        n_vertices: usize,
        edges: &[Edge],
        neighborhoods: &[Vec<usize>],
        handles: &[(usize, Vector)],
    ) -> Result<System, Indefinite> {
        let mut multiplicity = vec![0.0; edges.len()];
        for &number in neighborhoods.iter().flatten() {
            multiplicity[number] += 1.0;
        }
        let mut unknown: Vec<Option<usize>> = vec![Some(0); n_vertices];
        for &(vertex, _) in handles {
            unknown[vertex] = None;
        }
        for (number, slot) in unknown.iter_mut().flatten().enumerate() {
            *slot = number;
        }
        let n = n_vertices - unknown.iter().filter(|slot| slot.is_none()).count();
        let mut matrix = vec![vec![0.0; n]; n];
        for (edge, d) in edges.iter().zip(&multiplicity) {
            let [i, j] = edge.ends.map(|end| unknown[end]);
            for end in [i, j].into_iter().flatten() {
                matrix[end][end] += d * edge.weight;
            }
            if let (Some(i), Some(j)) = (i, j) {
                matrix[i][j] -= d * edge.weight;
                matrix[j][i] -= d * edge.weight;
            }
        }
        let factor = Factor::new(matrix).ok_or(Indefinite)?;
        Ok(System { unknown, multiplicity, factor, handles: handles.to_vec() })
    }

    /// Positions that minimize eq. (1) for these rotations.
    fn global_step(
        &self,
        edges: &[Edge],
        neighborhoods: &[Vec<usize>],
        rotations: &[Matrix],
        positions: &mut [Vector],
    ) {
        for &(vertex, target) in &self.handles {
            positions[vertex] = target;
        }
        // Σ_k over the neighborhoods of an edge of R_k (p_i − p_j).
        let mut turned = vec![[0.0; 3]; edges.len()];
        for (rotation, neighborhood) in rotations.iter().zip(neighborhoods) {
            for &number in neighborhood {
                turned[number] = plus(turned[number], times(rotation, edges[number].rest));
            }
        }
        let n = self.unknown.iter().flatten().count();
        let mut right = vec![[0.0; 3]; n];
        for (number, edge) in edges.iter().enumerate() {
            let pull = scaled(turned[number], edge.weight);
            let [i, j] = edge.ends;
            for (this, other, pull) in [(i, j, pull), (j, i, scaled(pull, -1.0))] {
                let Some(row) = self.unknown[this] else { continue };
                right[row] = plus(right[row], pull);
                if self.unknown[other].is_none() {
                    let known = scaled(positions[other], self.multiplicity[number] * edge.weight);
                    right[row] = plus(right[row], known);
                }
            }
        }
        let solved = self.factor.solve(right);
        for (vertex, slot) in self.unknown.iter().enumerate() {
            if let Some(row) = slot {
                positions[vertex] = solved[*row];
            }
        }
    }
}

/// argmax tr(R S) with S = Σ w (p_i − p_j)(p'_i − p'_j)ᵀ.
fn fit(edges: &[Edge], neighborhood: &[usize], positions: &[Vector]) -> Matrix {
    let mut sum = [[0.0; 3]; 3];
    for &number in neighborhood {
        let edge = &edges[number];
        let posed = minus(positions[edge.ends[0]], positions[edge.ends[1]]);
        for (row, rest) in sum.iter_mut().zip(edge.rest) {
            for (entry, posed) in row.iter_mut().zip(posed) {
                *entry += edge.weight * rest * posed;
            }
        }
    }
    best_rotation(&sum)
}

/// Eq. (1), term by term.
fn energy(edges: &[Edge], neighborhoods: &[Vec<usize>], rotations: &[Matrix], positions: &[Vector]) -> f64 {
    let mut sum = 0.0;
    for (rotation, neighborhood) in rotations.iter().zip(neighborhoods) {
        for &number in neighborhood {
            let edge = &edges[number];
            let posed = minus(positions[edge.ends[0]], positions[edge.ends[1]]);
            let off = minus(posed, times(rotation, edge.rest));
            sum += edge.weight * dot(off, off);
        }
    }
    sum
}

fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|value| value * factor)
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
