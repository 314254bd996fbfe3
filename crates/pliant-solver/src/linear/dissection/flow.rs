//! The fewest vertices that separate two sets.
//!
//! By Menger's theorem that is the largest number of paths from one set to the other without a common vertex. Paths are
//! added as in Dinic's algorithm: breadth-first distances, then depth-first searches along them, until none is left.
//!
//! Every vertex v of the band is two states, entered and left; a path through v goes from one to the other. A new path
//! may go from left(u) to entered(w) for neighbors u, w; through v if no other path goes through it; and back along an
//! old path, whose parts are then exchanged.

use super::piece::{Piece, SEPARATOR};

/// No vertex, such as the one before the first of a path; out of reach.
const NONE: u32 = u32::MAX;

/// The vertices among which the separator is sought, in their own numbering.
pub(super) struct Band {
    /// Number in the piece.
    vertices: Vec<u32>,
    offsets: Vec<u32>,
    neighbors: Vec<u32>,
    /// Has a neighbor outside of the band on side 0, on side 1.
    touches: Vec<[bool; 2]>,
    /// Vertices of the piece on side 0 and on side 1 without the band.
    outside: [usize; 2],
    /// Whether a path goes through the vertex, and which vertex is before it there.
    used: Vec<bool>,
    before: Vec<u32>,
    /// Distance of states from the start: entered(v) is 2v, left(v) is 2v + 1.
    distance: Vec<u32>,
    /// Edges of left(v) that are done with in this round.
    tried: Vec<u32>,
}

impl Band {
    /// `sides` of vertices in the band is overwritten by their numbers in the band plus 2.
    pub(super) fn new(piece: &Piece, vertices: Vec<u32>, sides: &mut [u32]) -> Band {
        let n = vertices.len();
        for (i, &v) in vertices.iter().enumerate() {
            sides[v as usize] = i as u32 + 2;
        }
        let above = sides.iter().filter(|&&side| side == 1).count();
        let mut offsets = Vec::with_capacity(n + 1);
        offsets.push(0);
        let mut neighbors = Vec::with_capacity(6 * n);
        let mut touches = vec![[false; 2]; n];
        for (&v, touches) in vertices.iter().zip(&mut touches) {
            for &w in piece.neighbors(v as usize) {
                match sides[w as usize] {
                    side @ (0 | 1) => touches[side as usize] = true,
                    number => neighbors.push(number - 2),
                }
            }
            offsets.push(neighbors.len() as u32);
        }
        let outside = [piece.len() - n - above, above];
        Band {
            vertices,
            offsets,
            neighbors,
            touches,
            outside,
            used: vec![false; n],
            before: vec![NONE; n],
            distance: vec![NONE; 2 * n],
            tried: vec![0; n],
        }
    }

    /// Writes the sides of the vertices of the band and returns how many vertices of the piece are on sides 0 and 1.
    pub(super) fn cut(mut self, sides: &mut [u32]) -> (usize, usize) {
        let mut queue = Vec::new();
        let mut path = Vec::new();
        while self.measure(&mut queue) {
            self.tried.fill(0);
            for v in 0..self.vertices.len() {
                if self.touches[v][0] && self.find_path(2 * v as u32, &mut path) {
                    self.add_path(&path);
                }
            }
        }
        // Distances are now finite just for what can still be reached from side 0.
        let near_0 = self.sides_near_0();
        let near_1 = self.sides_near_1(&mut queue);
        let counted = |chosen: &[u32]| {
            let on = |side| chosen.iter().filter(|&&s| s == side).count();
            (self.outside[0] + on(0), self.outside[1] + on(1))
        };
        let (counts_0, counts_1) = (counted(&near_0), counted(&near_1));
        let smaller = |(a, b): (usize, usize)| a.min(b);
        let (chosen, counts) =
            if smaller(counts_0) >= smaller(counts_1) { (near_0, counts_0) } else { (near_1, counts_1) };
        for (&v, side) in self.vertices.iter().zip(chosen) {
            sides[v as usize] = side;
        }
        counts
    }

    fn edges(&self, v: u32) -> std::ops::Range<usize> {
        self.offsets[v as usize] as usize..self.offsets[v as usize + 1] as usize
    }

    /// Breadth-first distances of states from side 0. False if side 1 cannot be reached.
    fn measure(&mut self, queue: &mut Vec<u32>) -> bool {
        self.distance.fill(NONE);
        queue.clear();
        for v in 0..self.vertices.len() {
            // A path that begins at v is in the way of another one only through v itself.
            if self.touches[v][0] {
                self.distance[2 * v] = 0;
                queue.push(2 * v as u32);
            }
        }
        let mut reached = false;
        let mut next = 0;
        while let Some(&state) = queue.get(next) {
            next += 1;
            let v = state / 2;
            let distance = self.distance[state as usize] + 1;
            let visit = |state: u32, queue: &mut Vec<u32>, distances: &mut [u32]| {
                if distances[state as usize] == NONE {
                    distances[state as usize] = distance;
                    queue.push(state);
                }
            };
            if state % 2 == 0 {
                if !self.used[v as usize] {
                    visit(state + 1, queue, &mut self.distance);
                } else if self.before[v as usize] != NONE {
                    visit(2 * self.before[v as usize] + 1, queue, &mut self.distance);
                }
            } else {
                reached |= self.touches[v as usize][1];
                if self.used[v as usize] {
                    visit(state - 1, queue, &mut self.distance);
                }
                for e in self.edges(v) {
                    visit(2 * self.neighbors[e], queue, &mut self.distance);
                }
            }
        }
        reached
    }

    /// A path of states, each one farther from side 0 than the one before, that ends beside side 1.
    fn find_path(&mut self, start: u32, path: &mut Vec<u32>) -> bool {
        path.clear();
        path.push(start);
        while let Some(&state) = path.last() {
            if state % 2 == 1 && self.touches[state as usize / 2][1] {
                return true;
            }
            if let Some(next) = self.advance(state) {
                path.push(next);
            } else {
                self.distance[state as usize] = NONE;
                path.pop();
            }
        }
        false
    }

    fn advance(&mut self, state: u32) -> Option<u32> {
        let v = state as usize / 2;
        let distance = self.distance[state as usize].wrapping_add(1);
        let follows = |next: u32, distances: &[u32]| distances[next as usize] == distance;
        if state.is_multiple_of(2) {
            let next = match (self.used[v], self.before[v]) {
                (false, _) => state + 1,
                (true, NONE) => return None,
                (true, before) => 2 * before + 1,
            };
            return follows(next, &self.distance).then_some(next);
        }
        let edges = self.edges(v as u32);
        while (self.tried[v] as usize) < edges.len() {
            let next = 2 * self.neighbors[edges.start + self.tried[v] as usize];
            if follows(next, &self.distance) {
                return Some(next);
            }
            self.tried[v] += 1;
        }
        (self.used[v] && follows(state - 1, &self.distance)).then_some(state - 1)
    }

    /// Adds a path and gives up the parts of old ones that it goes back along.
    fn add_path(&mut self, path: &[u32]) {
        self.before[path[0] as usize / 2] = NONE;
        for step in path.windows(2) {
            let (v, w) = (step[0] as usize / 2, step[1] as usize / 2);
            let leaves = step[0] % 2 == 1;
            if v == w {
                self.used[v] = !leaves;
                if leaves {
                    self.before[v] = NONE;
                }
            } else if leaves {
                self.before[w] = v as u32;
            }
        }
    }

    /// The separator as close to side 0 as possible: entered can be reached, left cannot.
    fn sides_near_0(&self) -> Vec<u32> {
        let reached = |state: usize| self.distance[state] != NONE;
        let side = |v: usize| match (reached(2 * v), reached(2 * v + 1)) {
            (_, true) => 0,
            (true, false) => SEPARATOR,
            (false, false) => 1,
        };
        (0..self.vertices.len()).map(side).collect()
    }

    /// The separator as close to side 1 as possible: from left side 1 can be reached, from entered it cannot.
    fn sides_near_1(&self, queue: &mut Vec<u32>) -> Vec<u32> {
        let n = self.vertices.len();
        let mut reaches = vec![false; 2 * n];
        queue.clear();
        for v in (0..n).filter(|&v| self.touches[v][1]) {
            reaches[2 * v + 1] = true;
            queue.push(2 * v as u32 + 1);
        }
        while let Some(state) = queue.pop() {
            let v = state / 2;
            let mut visit = |state: u32, queue: &mut Vec<u32>| {
                if !std::mem::replace(&mut reaches[state as usize], true) {
                    queue.push(state);
                }
            };
            let neighbors = &self.neighbors[self.edges(v)];
            if state % 2 == 0 {
                neighbors.iter().for_each(|&u| visit(2 * u + 1, queue));
                if self.used[v as usize] {
                    visit(state + 1, queue);
                }
            } else {
                if !self.used[v as usize] {
                    visit(state - 1, queue);
                }
                let after = neighbors.iter().filter(|&&w| self.used[w as usize] && self.before[w as usize] == v);
                after.for_each(|&w| visit(2 * w, queue));
            }
        }
        let side = |v: usize| match (reaches[2 * v], reaches[2 * v + 1]) {
            (true, _) => 1,
            (false, true) => SEPARATOR,
            (false, false) => 0,
        };
        (0..n).map(side).collect()
    }
}
