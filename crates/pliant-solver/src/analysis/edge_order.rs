//! The order of the edges: along strips of faces.
//!
//! A neighborhood costs two sums per run of consecutive edges, and a run ends wherever an edge lies in N(k, r) and the
//! next does not. So the best order makes few neighborhoods part two consecutive edges: a shortest tour through all of
//! them. Edges of one face are as close as two edges can be, hence the tour goes from face to face through shared edges
//! and lists each edge with the first of its faces. It always continues at the neighbor with the fewest ways on, so that
//! it leaves no holes, and from a dead end goes to the nearest face that still has edges to give. Ends of runs per
//! vertex, in place of those along a Hilbert curve through the midpoints (irregular torus, 12,800 vertices):
//!
//! | r | 2 | 3 | 6 | 10 | 20 |
//! |---|---|---|---|---|---|
//! | Hilbert curve | 17.2 | 28.1 | 61 | 106 | 220 |
//! | strips | 13.4 | 21.0 | 45 | 77 | 160 |
//!
//! Strips wander, so each stays in a window of faces that are neighbors along the Hilbert curve. Then memory is still
//! walked nearly in order.

use std::ops::Range;

use rayon::prelude::*;

use crate::Mesh;
use crate::analysis::hilbert::Curve;
use crate::analysis::topology::NO_EDGE;

/// Faces per window. Measured at r = 10: 1024 has 4 % more ends of runs, none has 3 % fewer; the prefix sums of this
/// one, half a megabyte, stay in the second-level cache.
const WINDOW: usize = 4096;

/// Over an edge with more faces than this there is no way on: each of them would have to look at all the others. Two are
/// usual, and a strip that ends there goes on somewhere near.
const MOST_FACES: u32 = 16;

/// Faces among which a dead end looks for the next one. By eye: a dead end has left few holes near it or none.
const JUMP: usize = 300;

/// All edges by component, then along the strips.
pub(crate) fn edge_order(mesh: &Mesh, sides: &[[u32; 3]], curve: &Curve) -> Vec<u32> {
    let faces = ranked_faces(mesh, curve);
    let (offsets, at_edge) = faces_of_edges(mesh.n_edges(), sides);
    let mut window = vec![0; sides.len()];
    let bounds = windows(mesh, &faces);
    for (w, pair) in bounds.windows(2).enumerate() {
        faces[pair[0]..pair[1]].iter().for_each(|&face| window[face as usize] = w as u32);
    }
    let mut walk = Walk {
        sides,
        offsets,
        at_edge,
        window,
        is_listed: vec![false; mesh.n_edges()],
        looked_at: vec![0; sides.len()],
        n_looks: 0,
        path: Vec::with_capacity(sides.len()),
    };
    bounds.windows(2).for_each(|pair| walk.through(&faces, pair[0]..pair[1]));
    edges_along(sides, &walk.path, mesh.n_edges())
}

/// Faces by component, then along the curve, then by number.
fn ranked_faces(mesh: &Mesh, curve: &Curve) -> Vec<u32> {
    let along = curve.positions(mesh.triangles().len(), |face| {
        let [a, b, c] = mesh.triangles()[face].map(|v| mesh.positions()[v as usize] / 3.0);
        a + b + c
    });
    let component = |face: u32| mesh.components()[mesh.triangles()[face as usize][0] as usize];
    let mut keyed: Vec<(u32, u64, u32)> =
        (0u32..).zip(along).map(|(face, along)| (component(face), along, face)).collect();
    keyed.par_sort_unstable();
    keyed.into_iter().map(|key| key.2).collect()
}

/// Where windows begin among the ranked faces, and the end of the last.
fn windows(mesh: &Mesh, faces: &[u32]) -> Vec<usize> {
    let component = |place: usize| mesh.components()[mesh.triangles()[faces[place] as usize][0] as usize];
    let mut bounds = vec![0];
    let mut first = 0;
    for place in 1..faces.len() {
        if place - first == WINDOW || component(place) != component(first) {
            bounds.push(place);
            first = place;
        }
    }
    bounds.push(faces.len());
    bounds
}

/// Faces at edge e, none if they are too many: `faces[offsets[e]..offsets[e + 1]]`.
fn faces_of_edges(n_edges: usize, sides: &[[u32; 3]]) -> (Vec<u32>, Vec<u32>) {
    let edges = || sides.iter().enumerate().flat_map(|(face, sides)| sides.map(|e| (face as u32, e)));
    let mut n_faces = vec![0u32; n_edges];
    edges().filter(|&(_, e)| e != NO_EDGE).for_each(|(_, e)| n_faces[e as usize] += 1);
    let real = || edges().filter(|&(_, e)| e != NO_EDGE && n_faces[e as usize] <= MOST_FACES);
    let mut offsets = vec![0u32; n_edges + 1];
    real().for_each(|(_, e)| offsets[e as usize + 1] += 1);
    (0..n_edges).for_each(|e| offsets[e + 1] += offsets[e]);
    let mut next = offsets.clone();
    let mut faces = vec![0; offsets[n_edges] as usize];
    for (face, e) in real() {
        faces[next[e as usize] as usize] = face;
        next[e as usize] += 1;
    }
    (offsets, faces)
}

/// A tour through faces.
struct Walk<'a> {
    sides: &'a [[u32; 3]],
    offsets: Vec<u32>,
    at_edge: Vec<u32>,
    /// Window of each face.
    window: Vec<u32>,
    is_listed: Vec<bool>,
    /// Number of the look around that last came by a face.
    looked_at: Vec<u32>,
    n_looks: u32,
    path: Vec<u32>,
}

impl Walk<'_> {
    /// Visits faces of one window until all edges of all of them are listed.
    fn through(&mut self, faces: &[u32], places: Range<usize>) {
        let window = self.window[faces[places.start] as usize];
        let mut queue = Vec::new();
        for place in places {
            let mut next = Some(faces[place]).filter(|&face| self.has_more(face, window));
            while let Some(face) = next {
                self.path.push(face);
                for edge in self.sides[face as usize].into_iter().filter(|&e| e != NO_EDGE) {
                    self.is_listed[edge as usize] = true;
                }
                next = self.best_neighbor(face, window).or_else(|| self.nearest(face, window, &mut queue));
            }
        }
    }

    /// Whether a face is of the window and has an edge that is not listed.
    fn has_more(&self, face: u32, window: u32) -> bool {
        self.window[face as usize] == window
            && self.sides[face as usize].iter().any(|&e| e != NO_EDGE && !self.is_listed[e as usize])
    }

    fn neighbors(&self, face: u32) -> impl Iterator<Item = u32> {
        let edges = self.sides[face as usize].into_iter().filter(|&e| e != NO_EDGE).map(|e| e as usize);
        edges
            .flat_map(|e| &self.at_edge[self.offsets[e] as usize..self.offsets[e + 1] as usize])
            .copied()
            .filter(move |&other| other != face)
    }

    /// How many ways lead on from a face.
    fn n_ways(&self, face: u32, window: u32) -> usize {
        self.neighbors(face).filter(|&other| self.has_more(other, window)).count()
    }

    fn best_neighbor(&self, face: u32, window: u32) -> Option<u32> {
        let open = self.neighbors(face).filter(|&other| self.has_more(other, window));
        open.min_by_key(|&other| (self.n_ways(other, window), other))
    }

    /// The best of the nearest faces with edges to list.
    fn nearest(&mut self, from: u32, window: u32, queue: &mut Vec<u32>) -> Option<u32> {
        self.n_looks += 1;
        self.looked_at[from as usize] = self.n_looks;
        queue.clear();
        queue.push(from);
        let mut ring = 0..1;
        while !ring.is_empty() && queue.len() < JUMP {
            for place in ring.clone() {
                for edge in self.sides[queue[place] as usize].into_iter().filter(|&e| e != NO_EDGE) {
                    for at in self.offsets[edge as usize]..self.offsets[edge as usize + 1] {
                        let other = self.at_edge[at as usize];
                        let looked_at = &mut self.looked_at[other as usize];
                        if *looked_at != self.n_looks && self.window[other as usize] == window {
                            *looked_at = self.n_looks;
                            queue.push(other);
                        }
                    }
                }
            }
            ring = ring.end..queue.len();
            let open = queue[ring.clone()].iter().copied().filter(|&other| self.has_more(other, window));
            if let Some(best) = open.min_by_key(|&other| (self.n_ways(other, window), other)) {
                return Some(best);
            }
        }
        None
    }
}

/// The edges of the faces of a path, each once; the one that leads to the next face last.
fn edges_along(sides: &[[u32; 3]], path: &[u32], n_edges: usize) -> Vec<u32> {
    let mut is_listed = vec![false; n_edges];
    let mut order = Vec::with_capacity(n_edges);
    for (place, &face) in path.iter().enumerate() {
        let next = path.get(place + 1).map_or([NO_EDGE; 3], |&next| sides[next as usize]);
        let mut own = sides[face as usize];
        own.sort_by_key(|edge| next.contains(edge));
        for edge in own.into_iter().filter(|&e| e != NO_EDGE) {
            if !std::mem::replace(&mut is_listed[edge as usize], true) {
                order.push(edge);
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::analysis::topology::sides_of_faces;
    use crate::test_support::{Random, box_bar, bumpy_sheet};

    fn order_of(mesh: &Mesh) -> Vec<u32> {
        edge_order(mesh, &sides_of_faces(mesh), &Curve::around(mesh.positions()))
    }

    #[test]
    fn every_edge_of_any_faces_comes_once_and_components_one_after_the_other() {
        let mut random = Random::new(5);
        let points: Vec<DVec3> = (0..300).map(|_| random.vector()).collect();
        // Fans with many faces at one edge, faces with one corner twice or thrice, duplicates, and several components.
        let corner = |i: u32, x: f64| 30 * (i % 10) + ((x + 1.0) * 10.0) as u32;
        let faces: Vec<[u32; 3]> =
            (0..700).map(|i| random.vector().to_array().map(|x| corner(i, x))).chain([[4; 3], [3, 3, 9]]).collect();
        for mesh in [Mesh::new(points, faces).expect("valid"), bumpy_sheet(40), box_bar([3, 3, 400], DVec3::ONE)] {
            let order = order_of(&mesh);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.iter().copied().eq(0..mesh.n_edges() as u32), "{} edges listed", order.len());
            let component = |e: &u32| mesh.components()[mesh.edges()[*e as usize][0] as usize];
            assert!(order.is_sorted_by_key(component));
        }
    }

    #[test]
    fn a_book_of_many_pages_and_a_wheel_of_many_spokes_are_listed_in_no_time() {
        // Whoever looks from every face at all others of the edge, or at all edges of the hub, does not come back.
        let n = 60_000;
        let points: Vec<DVec3> = (0..n + 2).map(|v| DVec3::new(0.0, f64::from(v), f64::from(v % 7))).collect();
        let book = (2..n).map(|v| [0, 1, v]).collect();
        let wheel = (1..n).map(|v| [0, v, v + 1]).collect();
        for faces in [book, wheel] {
            let mesh = Mesh::new(points.clone(), faces).expect("valid");
            let mut order = order_of(&mesh);
            order.sort_unstable();
            assert!(order.iter().copied().eq(0..mesh.n_edges() as u32), "{} edges listed", order.len());
        }
    }

    #[test]
    fn consecutive_edges_are_nearly_always_sides_of_one_face() {
        let mesh = bumpy_sheet(60);
        let order = order_of(&mesh);
        let sides = sides_of_faces(&mesh);
        let (offsets, faces) = faces_of_edges(mesh.n_edges(), &sides);
        let faces_at = |e: u32| &faces[offsets[e as usize] as usize..offsets[e as usize + 1] as usize];
        let n_jumps = order.windows(2).filter(|pair| !faces_at(pair[0]).iter().any(|f| faces_at(pair[1]).contains(f)));
        let share = n_jumps.count() as f64 / order.len() as f64;
        // Jumps are from dead ends: one strip in ten edges would be no strip.
        assert!(share < 0.1, "{share} of the steps are jumps");
    }
}
