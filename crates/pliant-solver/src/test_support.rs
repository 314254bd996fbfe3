//! Shapes, handle motions and slow but plain reference computations shared by the tests.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::{Analysis, LooseComponents, Mesh, Neighborhoods, Rigidity, Solver, VertexId, Weights};

/// A small deterministic generator (a linear congruence; the high bits are used).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(2).wrapping_add(1))
    }

    /// Uniform in -1..1.
    pub(crate) fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }
}

/// The surface of a box of `cells` cells along x, y, z and the given `size`, one corner at the origin; every cell is
/// cut by a diagonal, alternating like a checkerboard.
pub(crate) fn box_bar(cells: [usize; 3], size: DVec3) -> Mesh {
    let mut positions = Vec::new();
    let mut numbers = std::collections::BTreeMap::new();
    let mut triangles = Vec::new();
    let mut number = |cell: [usize; 3]| {
        *numbers.entry(cell).or_insert_with(|| {
            let at = |axis: usize| cell[axis] as f64 / cells[axis] as f64;
            positions.push(DVec3::new(at(0), at(1), at(2)) * size);
            positions.len() as u32 - 1
        })
    };
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for far in [false, true] {
            for a in 0..cells[u] {
                for b in 0..cells[v] {
                    let mut corner = |da: usize, db: usize| {
                        let mut cell = [0; 3];
                        (cell[axis], cell[u], cell[v]) = (if far { cells[axis] } else { 0 }, a + da, b + db);
                        number(cell)
                    };
                    let (p, q, r, s) = (corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
                    let mut pair = if (a + b) % 2 == 0 { [[p, q, r], [p, r, s]] } else { [[p, q, s], [q, r, s]] };
                    if !far {
                        pair.iter_mut().for_each(|t| t.swap(1, 2));
                    }
                    triangles.extend(pair);
                }
            }
        }
    }
    Mesh::new(positions, triangles).expect("a box is valid")
}

/// An open sheet of n × n irregularly spaced vertices with bumps, scrambled in numbering.
pub(crate) fn bumpy_sheet(n: usize) -> Mesh {
    let mut random = Random::new(7);
    let mut positions = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let jitter = random.vector() * 0.25;
            let (x, y) = (i as f64 + jitter.x, j as f64 + jitter.y);
            positions.push(DVec3::new(x, y, 1.5 * (0.5 * x).sin() * (0.4 * y).cos() + jitter.z));
        }
    }
    // Multiplication by a number without common factor permutes the vertices.
    let total = n * n;
    let step = (total / 3..).find(|step| gcd(*step, total) == 1).expect("one of any run of numbers");
    let place = |v: usize| (v * step) % total;
    let mut scrambled = vec![DVec3::ZERO; total];
    (0..total).for_each(|v| scrambled[place(v)] = positions[v]);
    let mut triangles = Vec::new();
    for i in 0..n - 1 {
        for j in 0..n - 1 {
            let at = |di: usize, dj: usize| place((i + di) * n + j + dj) as u32;
            if random.signed() > 0.0 {
                triangles.extend([[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]]);
            } else {
                triangles.extend([[at(0, 0), at(1, 0), at(0, 1)], [at(1, 0), at(1, 1), at(0, 1)]]);
            }
        }
    }
    Mesh::new(scrambled, triangles).expect("a sheet is valid")
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Sizes from 1 to `max` in patches.
pub(crate) fn mixed_rigidity(n_vertices: usize, max: u16) -> Rigidity {
    Rigidity::new((0..n_vertices).map(|v| 1 + (v * 7 / 5) as u16 % max).collect()).expect("in range")
}

/// Both ends of a bar along x, and where a bend by `angle` carries them: x = 0 stays, x = L goes around an arc.
pub(crate) fn arc(mesh: &Mesh, length: f64, angle: f64) -> (Vec<VertexId>, Vec<DVec3>) {
    let radius = length / angle;
    let mut held = Vec::new();
    let mut targets = Vec::new();
    for (v, &p) in mesh.positions().iter().enumerate() {
        if p.x == 0.0 {
            targets.push(p);
        } else if p.x == length {
            let from_axis = radius - (p.y - 0.5);
            targets.push(DVec3::new(from_axis * angle.sin(), 0.5 + radius - from_axis * angle.cos(), p.z));
        } else {
            continue;
        }
        held.push(VertexId(v as u32));
    }
    (held, targets)
}

/// A solver with everything that it needs.
pub(crate) fn solver(mesh: Mesh, weights: Weights, rigidity: &Rigidity, held: &[VertexId]) -> Solver {
    let analysis = Arc::new(Analysis::new(Arc::new(mesh), weights));
    let neighborhoods = Neighborhoods::new(&analysis, rigidity).expect("one size per vertex");
    Solver::new(analysis, neighborhoods, rigidity, held, LooseComponents::KeepAtRest).expect("solvable")
}

/// N(k, r) by breadth-first search over the mesh in the caller's numbering, without any of the solver's structures.
pub(crate) fn plain_neighborhood(mesh: &Mesh, k: u32, r: u16) -> Vec<usize> {
    let mut distance = vec![u16::MAX; mesh.n_vertices()];
    distance[k as usize] = 0;
    let mut queue = vec![k];
    let mut next = 0;
    while next < queue.len() {
        let v = queue[next];
        next += 1;
        for &w in mesh.neighbors(VertexId(v)) {
            if distance[w as usize] == u16::MAX {
                distance[w as usize] = distance[v as usize] + 1;
                queue.push(w);
            }
        }
    }
    let near = |v: u32| distance[v as usize] < r;
    (0..mesh.n_edges()).filter(|&e| mesh.edges()[e].iter().any(|&v| near(v))).collect()
}

/// Eq. (1) by its definition.
pub(crate) fn plain_energy(mesh: &Mesh, w: &[f64], r: &[u16], positions: &[DVec3], rotations: &[DMat3]) -> f64 {
    let mut energy = 0.0;
    for k in 0..mesh.n_vertices() {
        for e in plain_neighborhood(mesh, k as u32, r[k]) {
            let [i, j] = mesh.edges()[e].map(|v| v as usize);
            let rest = mesh.positions()[i] - mesh.positions()[j];
            energy += w[e] * (positions[i] - positions[j] - rotations[k] * rest).length_squared();
        }
    }
    energy
}

/// The largest distance between two lists of points, with its place.
pub(crate) fn farthest(a: &[DVec3], b: &[DVec3]) -> (usize, f64) {
    assert_eq!(a.len(), b.len());
    let distances = a.iter().zip(b).map(|(a, b)| a.distance(*b)).enumerate();
    distances.fold((0, 0.0), |most, one| if one.1 > most.1 || one.1.is_nan() { one } else { most })
}
