//! Mirror images by how the mesh hangs together, whatever its pose.
//!
//! Everything follows from one edge in the middle: either the seam runs along it, so that its ends stay and its two
//! triangles change places, or the seam cuts it in half, so that its ends change places and its triangles stay. If nobody
//! names such an edge, those that look most like it in space are tried, piece by piece of the surface. Pieces that lie
//! wholly on one side are found by their places.

use super::walk::{Pair, Walk, Walked};
use super::{MirrorMap, NONE, Plane};
use crate::face_neighbors::{self, FaceNeighbors};
use crate::face_patches::FacePatches;
use crate::incidence::Incidence;
use glam::DVec3;
use std::collections::HashMap;

/// Middle edges that are tried, the likeliest first; wrong ones differ after a few triangles. By eye.
const MOST_SEEDS: usize = 4096;
/// All trials together may meet this many times the triangles of the mesh (measured: 14 s in all for a million vertices
/// that are nowhere symmetric).
const MOST_ROUNDS: usize = 4;
/// Triangles of a piece off the middle that are tried, in order; the first is right unless places are crowded. By eye.
const MOST_TRIES_BY_PLACE: usize = 8;

/// What is known of the seam between the sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seam {
    /// An edge of the middle, if somebody knows one.
    pub edge: Option<[u32; 2]>,
    /// About where the middle is, to look for such edges, and for pieces that lie on one side.
    pub plane: Plane,
    /// How near the image of a vertex must be to say so by its place.
    pub tolerance: f64,
}

/// A vertex, and the one that would have to be its image where the two sides first differ.
pub type Uneven = [u32; 2];

impl MirrorMap {
    /// Pairs of vertices that are met at the same time on both sides of the seam; and where the sides first differ, if
    /// they do. What differs has no partner. O(n log n).
    pub fn by_topology(positions: &[DVec3], triangles: &[[u32; 3]], seam: Seam) -> (MirrorMap, Option<Uneven>) {
        let neighbors = FaceNeighbors::new(positions.len(), triangles);
        let pieces = FacePatches::new(positions, triangles, f64::INFINITY);
        let mut search = Search {
            positions,
            triangles,
            neighbors: &neighbors,
            piece: pieces.of_face(),
            walk: Walk::new(positions.len(), triangles, &neighbors),
            best: HashMap::new(),
            uneven: None,
        };
        if let Some(edge) = seam.edge {
            search.try_edge(edge);
        }
        // Pieces off the middle first: an eye is symmetric in itself, too.
        search.try_places(seam);
        if seam.edge.is_none() {
            search.try_likely_edges(seam.plane);
        }
        search.settle_for_best();
        (MirrorMap::new(search.walk.of), search.uneven)
    }
}

struct Search<'a> {
    positions: &'a [DVec3],
    triangles: &'a [[u32; 3]],
    neighbors: &'a FaceNeighbors,
    /// Which piece of the surface each triangle is in.
    piece: &'a [u32],
    walk: Walk<'a>,
    /// The seeds that led farthest in each piece which no seed has covered, and how far.
    best: HashMap<u32, (Walked, [Pair; 2])>,
    uneven: Option<Uneven>,
}

impl Search<'_> {
    /// From an edge that the user names: along it or across it, whichever leads farther.
    fn try_edge(&mut self, edge: [u32; 2]) {
        let is_it = |&(face, k): &(u32, usize)| {
            let t = self.triangles[face as usize];
            let [a, b] = [t[k], t[(k + 1) % 3]];
            self.neighbors.of(face)[k] != face_neighbors::NONE && ([a, b] == edge || [b, a] == edge)
        };
        let all = (0..self.triangles.len() as u32).flat_map(|face| (0..3).map(move |k| (face, k)));
        match all.into_iter().find(is_it) {
            Some((face, k)) => {
                for across in [false, true] {
                    self.attempt(self.seeds(face, k, across));
                }
            }
            None => self.uneven = Some(edge),
        }
    }

    /// From the edges that look most like a middle one.
    fn try_likely_edges(&mut self, plane: Plane) {
        let is_middle = self.pieces_across(plane);
        let mut likely: Vec<(f64, u32, usize, bool)> = Vec::new();
        for face in (0..self.triangles.len() as u32).filter(|&f| is_middle[self.piece[f as usize] as usize]) {
            for (k, beyond) in self.neighbors.of(face).into_iter().enumerate() {
                if beyond != face_neighbors::NONE && face < beyond {
                    let scores = self.scores(face, k, plane);
                    likely.extend([(scores[0], face, k, false), (scores[1], face, k, true)]);
                }
            }
        }
        let order = |a: &(f64, u32, usize, bool), b: &(f64, u32, usize, bool)| {
            a.0.total_cmp(&b.0).then((a.1, a.2, a.3).cmp(&(b.1, b.2, b.3)))
        };
        if likely.len() > MOST_SEEDS {
            likely.select_nth_unstable_by(MOST_SEEDS, order);
            likely.truncate(MOST_SEEDS);
        }
        likely.sort_unstable_by(order);
        let mut left = MOST_ROUNDS * self.triangles.len();
        for (_, face, k, across) in likely {
            if !self.walk.has_met(face) {
                left = left.saturating_sub(self.attempt(self.seeds(face, k, across)));
            }
            if left == 0 {
                break;
            }
        }
    }

    /// For each piece of the surface whether it has corners on both sides of a plane, or on it.
    fn pieces_across(&self, plane: Plane) -> Vec<bool> {
        let n_pieces = self.piece.iter().max().map_or(0, |&last| last as usize + 1);
        let mut sides = vec![[false; 2]; n_pieces];
        for (corners, &piece) in self.triangles.iter().zip(self.piece) {
            for p in corners.iter().filter_map(|&v| self.positions.get(v as usize)) {
                let off = p[plane.axis.min(2)] - plane.at;
                sides[piece as usize][0] |= off <= 0.0;
                sides[piece as usize][1] |= off >= 0.0;
            }
        }
        sides.into_iter().map(|side| side == [true; 2]).collect()
    }

    /// How far an edge and the tips of its triangles are from where they would be in the middle, with the seam along the
    /// edge and across it.
    fn scores(&self, face: u32, k: usize, plane: Plane) -> [f64; 2] {
        let [a, b, c, d] = self.rhombus(face, k).map(|v| self.positions[v as usize]);
        let off = |p: DVec3| plane.mirrored(p).distance(p);
        [off(a) + off(b) + plane.mirrored(c).distance(d), off(c) + off(d) + plane.mirrored(a).distance(b)]
    }

    /// Ends of an edge, then the tips of the triangle itself and of the one beyond.
    fn rhombus(&self, face: u32, k: usize) -> [u32; 4] {
        let t = self.triangles[face as usize];
        let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
        let beyond = self.triangles[self.neighbors.of(face)[k] as usize];
        [a, b, c, beyond.into_iter().find(|&v| v != a && v != b).unwrap_or(c)]
    }

    /// The first pairs if the seam runs along an edge, or across it.
    fn seeds(&self, face: u32, k: usize, across: bool) -> [Pair; 2] {
        let [a, b, c, d] = self.rhombus(face, k);
        let beyond = self.neighbors.of(face)[k];
        let image_of = |v: u32| match (across, v) {
            (true, v) if v == a => b,
            (true, v) if v == b => a,
            (false, v) if v == c => d,
            (false, v) if v == d => c,
            _ => v,
        };
        let pair = |face: u32, image: u32| Pair { face, image, corners: self.triangles[face as usize].map(image_of) };
        if across { [pair(face, face), pair(beyond, beyond)] } else { [pair(face, beyond), pair(beyond, face)] }
    }

    /// Walks, and keeps the pairs if both sides are alike to the end. Returns what it cost.
    fn attempt(&mut self, seeds: [Pair; 2]) -> usize {
        let walked = self.walk.go(&seeds, true);
        if walked.uneven.is_some() {
            self.walk.forget();
            let best = self.best.entry(self.piece[seeds[0].face as usize]).or_insert((walked, seeds));
            if walked.n_faces > best.0.n_faces {
                *best = (walked, seeds);
            }
        }
        walked.n_faces
    }

    /// Pieces that lie on one side: from a triangle whose corners have partners by their places in another piece.
    fn try_places(&mut self, seam: Seam) {
        let has_open = (0..self.triangles.len() as u32).any(|face| !self.walk.has_met(face));
        if !has_open {
            return;
        }
        let places = MirrorMap::by_plane(self.positions, seam.plane, seam.tolerance);
        let incidence = Incidence::new(self.positions.len(), self.triangles);
        let mut tries: HashMap<u32, usize> = HashMap::new();
        for face in 0..self.triangles.len() as u32 {
            let piece = self.piece[face as usize];
            if self.walk.has_met(face) || self.neighbors.of(face) == [face_neighbors::NONE; 3] {
                continue;
            }
            let partners = self.triangles[face as usize].map(|v| places.partner(v).unwrap_or(NONE));
            if partners.contains(&NONE) {
                continue;
            }
            let is_image = |&&f: &&u32| self.triangles[f as usize].iter().all(|v| partners.contains(v));
            let image = incidence.around(partners[0] as usize).iter().find(is_image).copied();
            let n_tries = tries.entry(piece).or_default();
            if let Some(image) = image.filter(|&f| self.piece[f as usize] != piece && *n_tries < MOST_TRIES_BY_PLACE) {
                *n_tries += 1;
                let seed = Pair { face, image, corners: partners };
                if self.walk.go(&[seed], true).uneven.is_some() {
                    self.walk.forget();
                } else {
                    self.best.remove(&piece);
                    self.best.remove(&self.piece[image as usize]);
                }
            }
        }
    }

    /// Pieces whose sides differ: what can be paired from the seed that led farthest, and where they differ.
    fn settle_for_best(&mut self) {
        let mut best: Vec<_> = std::mem::take(&mut self.best).into_iter().collect();
        best.sort_unstable_by_key(|&(piece, (walked, _))| (std::cmp::Reverse(walked.n_faces), piece));
        for (_, (walked, seeds)) in best {
            if !self.walk.has_met(seeds[0].face) {
                self.walk.go(&seeds, false);
                self.uneven = self.uneven.or(walked.uneven);
            }
        }
    }
}
