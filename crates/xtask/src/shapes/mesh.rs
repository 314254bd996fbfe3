//! A triangle mesh under construction, and what can be asked of it.

use glam::DVec3;
use rayon::prelude::*;
#[cfg(test)]
use std::collections::BTreeMap;

/// Vertices and triangles, counterclockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Shape {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// Positions rounded to what a file with single precision holds.
    pub(crate) fn rounded_to_f32(mut self) -> Shape {
        self.positions.iter_mut().for_each(|p| *p = p.as_vec3().as_dvec3());
        self
    }

    /// Numbers of the vertices that satisfy a condition on their position.
    pub(crate) fn vertices_where(&self, wanted: impl Fn(DVec3) -> bool) -> Vec<u32> {
        (0..self.positions.len() as u32).filter(|&v| wanted(self.positions[v as usize])).collect()
    }

    /// Every directed edge (from, to) with its triangle, sorted.
    pub(crate) fn directed_edges(&self) -> Edges {
        let of_triangle = |(i, t): (usize, &[u32; 3])| [0, 1, 2].map(|c| ((t[c], t[(c + 1) % 3]), i as u32));
        let mut edges: Vec<_> = self.triangles.iter().enumerate().flat_map(of_triangle).collect();
        edges.par_sort_unstable();
        Edges(edges)
    }

    /// Corners of a triangle.
    pub(crate) fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|v| self.positions[v as usize])
    }
}

/// Directed edges (from, to), each with its triangle, sorted.
pub(crate) struct Edges(pub(crate) Vec<((u32, u32), u32)>);

impl Edges {
    /// The first triangle with this edge.
    pub(crate) fn triangle(&self, from: u32, to: u32) -> Option<u32> {
        let at = self.0.partition_point(|&(edge, _)| edge < (from, to));
        self.0.get(at).filter(|(edge, _)| *edge == (from, to)).map(|(_, triangle)| *triangle)
    }

    /// Whether two vertices are joined.
    pub(crate) fn joins(&self, a: u32, b: u32) -> bool {
        self.triangle(a, b).is_some() || self.triangle(b, a).is_some()
    }
}

/// Twice the area, along the normal.
pub(crate) fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

#[cfg(test)]
impl Shape {
    /// What is wrong with the connections: every edge must have one triangle on either side (or, where borders are
    /// allowed, one at least) with agreeing orientation, and the triangles around a vertex must hang together.
    pub(crate) fn flaws(&self, borders_allowed: bool) -> Vec<String> {
        let edges = self.directed_edges();
        let mut flaws = Vec::new();
        for pair in edges.0.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            flaws.push(format!("edge {:?} is used twice in one direction", pair[0].0));
        }
        for &((a, b), _) in &edges.0 {
            if !borders_allowed && edges.triangle(b, a).is_none() {
                flaws.push(format!("edge {a}-{b} is a border"));
            }
        }
        let mut links: Vec<Vec<(u32, u32)>> = vec![Vec::new(); self.positions.len()];
        for t in &self.triangles {
            (0..3).for_each(|i| links[t[i] as usize].push((t[(i + 1) % 3], t[(i + 2) % 3])));
        }
        for (v, link) in links.iter().enumerate() {
            if link.is_empty() {
                flaws.push(format!("vertex {v} is used by no triangle"));
            } else if !is_one_chain(link) {
                flaws.push(format!("the triangles around vertex {v} do not hang together"));
            }
        }
        flaws
    }

    /// The smallest angle of all triangles, in degrees.
    pub(crate) fn smallest_angle(&self) -> f64 {
        let angles = self.triangles.iter().flat_map(|&t| {
            let p = self.corners(t);
            (0..3).map(move |i| (p[(i + 1) % 3] - p[i]).angle_between(p[(i + 2) % 3] - p[i]).to_degrees())
        });
        angles.fold(180.0, f64::min)
    }

    /// Six times the enclosed volume; positive when the triangles face outwards.
    pub(crate) fn volume(&self) -> f64 {
        self.triangles.iter().map(|&t| self.corners(t)).map(|[a, b, c]| a.dot(b.cross(c))).sum()
    }
}

/// Whether the edges opposite to a vertex form a single loop or path.
#[cfg(test)]
fn is_one_chain(link: &[(u32, u32)]) -> bool {
    let next: BTreeMap<u32, u32> = link.iter().copied().collect();
    let ends: std::collections::BTreeSet<u32> = next.values().copied().collect();
    let start = next.keys().copied().find(|v| !ends.contains(v)).unwrap_or(link[0].0);
    let mut at = start;
    for n_steps in 1..=link.len() {
        match next.get(&at) {
            Some(&to) => at = to,
            None => return false,
        }
        if n_steps == link.len() {
            return next.len() == link.len();
        }
        if at == start {
            return false;
        }
    }
    false
}
