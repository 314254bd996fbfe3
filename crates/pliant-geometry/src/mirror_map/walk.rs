//! Walks both sides of a seam in step: triangles that are met at the same time are mirror images.

use super::NONE;
use crate::face_neighbors::{self, FaceNeighbors};
use std::collections::VecDeque;

/// A triangle, its mirror image, and the image of each of its corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) face: u32,
    pub(super) image: u32,
    pub(super) corners: [u32; 3],
}

/// What a walk came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Walked {
    /// Triangles that were met, with their images.
    pub(super) n_faces: usize,
    /// A vertex and what would have to be its image, where the two sides first differ.
    pub(super) uneven: Option<[u32; 2]>,
}

/// The pairs found so far.
pub(super) struct Walk<'a> {
    triangles: &'a [[u32; 3]],
    neighbors: &'a FaceNeighbors,
    /// Image of each vertex, or [`NONE`].
    pub(super) of: Vec<u32>,
    is_met: Vec<bool>,
    /// What the current walk has set, to be taken back.
    new_vertices: Vec<u32>,
    new_faces: Vec<u32>,
}

impl<'a> Walk<'a> {
    pub(super) fn new(n_vertices: usize, triangles: &'a [[u32; 3]], neighbors: &'a FaceNeighbors) -> Walk<'a> {
        Walk {
            triangles,
            neighbors,
            of: vec![NONE; n_vertices],
            is_met: vec![false; triangles.len()],
            new_vertices: Vec::new(),
            new_faces: Vec::new(),
        }
    }

    /// Whether a walk has met a triangle.
    pub(super) fn has_met(&self, face: u32) -> bool {
        self.is_met[face as usize]
    }

    /// Walks from pairs until nothing new is met. A strict walk ends at the first difference; any other leaves out what
    /// differs and goes on around it.
    pub(super) fn go(&mut self, seeds: &[Pair], strict: bool) -> Walked {
        self.new_vertices.clear();
        self.new_faces.clear();
        let mut uneven = None;
        let mut open = VecDeque::new();
        for &seed in seeds {
            let corners = self.triangles[seed.face as usize];
            let clash = (0..3).find(|&k| !self.join(corners[k], seed.corners[k]));
            match clash {
                Some(k) => uneven = uneven.or(Some([corners[k], seed.corners[k]])),
                None => self.meet(seed, &mut open),
            }
        }
        while let Some(pair) = open.pop_front() {
            if strict && uneven.is_some() {
                break;
            }
            for k in 0..3 {
                if let Err(difference) = self.cross(pair, k, &mut open) {
                    uneven = uneven.or(Some(difference));
                }
            }
        }
        Walked { n_faces: self.new_faces.len(), uneven }
    }

    /// Takes back the last walk.
    pub(super) fn forget(&mut self) {
        self.new_vertices.drain(..).for_each(|v| self.of[v as usize] = NONE);
        self.new_faces.drain(..).for_each(|f| self.is_met[f as usize] = false);
    }

    /// Goes over the edge from corner k to corner k + 1 and over its image.
    fn cross(&mut self, pair: Pair, k: usize, open: &mut VecDeque<Pair>) -> Result<(), [u32; 2]> {
        let (corners, image) = (self.triangles[pair.face as usize], self.triangles[pair.image as usize]);
        let edge = [corners[k], corners[(k + 1) % 3]];
        let edge_image = [pair.corners[k], pair.corners[(k + 1) % 3]];
        let across_image = (0..3).find(|&i| {
            let (a, b) = (image[i], image[(i + 1) % 3]);
            [a, b] == edge_image || [b, a] == edge_image
        });
        let beyond = self.neighbors.of(pair.face)[k];
        let beyond_image = across_image.map_or(face_neighbors::NONE, |i| self.neighbors.of(pair.image)[i]);
        match (beyond, beyond_image) {
            (face_neighbors::NONE, face_neighbors::NONE) => return Ok(()),
            (face_neighbors::NONE, _) | (_, face_neighbors::NONE) => return Err([edge[0], edge_image[0]]),
            _ => {}
        }
        let tip = |face: u32, edge: [u32; 2]| self.triangles[face as usize].into_iter().find(|v| !edge.contains(v));
        let (Some(tip), Some(tip_image)) = (tip(beyond, edge), tip(beyond_image, edge_image)) else { return Ok(()) };
        if !self.join(tip, tip_image) {
            return Err([tip, tip_image]);
        }
        let image_of = |v: u32| match v {
            v if v == edge[0] => edge_image[0],
            v if v == edge[1] => edge_image[1],
            _ => tip_image,
        };
        let corners = self.triangles[beyond as usize].map(image_of);
        self.meet(Pair { face: beyond, image: beyond_image, corners }, open);
        Ok(())
    }

    /// Makes two vertices each other's image, unless one of them has another.
    fn join(&mut self, v: u32, image: u32) -> bool {
        match (self.of[v as usize], self.of[image as usize]) {
            (NONE, NONE) => {
                self.of[v as usize] = image;
                self.of[image as usize] = v;
                self.new_vertices.extend([v, image]);
                true
            }
            known => known == (image, v),
        }
    }

    fn meet(&mut self, pair: Pair, open: &mut VecDeque<Pair>) {
        if self.is_met[pair.face as usize] {
            return;
        }
        for face in [pair.face, pair.image] {
            if !std::mem::replace(&mut self.is_met[face as usize], true) {
                self.new_faces.push(face);
            }
        }
        open.push_back(pair);
    }
}
