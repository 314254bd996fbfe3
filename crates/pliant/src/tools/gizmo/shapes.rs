//! The gizmo's parts as strokes: what is drawn is what can be taken.

use glam::Vec3;

use super::{Gizmo, GizmoPart, GizmoShown};
use crate::tools::View;

/// Radius of the rings, in arrows, and of the one that faces the viewer (by eye).
const RING: f32 = 0.72;
const VIEW_RING: f32 = 1.36;
/// From where to where the squares reach along both axes, in arrows.
const SQUARE: (f32, f32) = (0.30, 0.46);
/// Parallel strokes that make up a square.
const SQUARE_STROKES: u8 = 5;
/// Place of the knobs beyond the arrows.
const KNOB_AT: f32 = 1.18;
/// Segments of a ring.
const RING_SEGMENTS: usize = 64;
/// An arrow seen more from its end than this says nothing about a way along it: cosine of 10°.
const END_ON: f32 = 0.985;
/// A square seen at a smaller slope than this is a line: sine of 10°.
const FLAT: f32 = 0.17;

/// A straight stroke of constant width on screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) a: Vec3,
    pub(super) b: Vec3,
    pub(super) width_px: f32,
}

impl Gizmo {
    /// What is shown and can be taken in this view, the small parts first: where two are equally near, they win.
    pub(super) fn parts(&self, view: &View) -> Vec<GizmoPart> {
        let shows = |kind| self.shown == GizmoShown::All || self.shown == kind;
        let toward = self.toward_eye(view);
        let slope = |axis: usize| toward.dot(self.axis(axis)).abs();
        let mut parts = Vec::with_capacity(14);
        if shows(GizmoShown::Scale) {
            parts.push(GizmoPart::Scale);
            parts.extend((0..3).filter(|&axis| slope(axis) < END_ON).map(GizmoPart::ScaleAxis));
        }
        if shows(GizmoShown::Move) {
            parts.extend((0..3).filter(|&axis| slope(axis) > FLAT).map(GizmoPart::MovePlane));
            parts.extend((0..3).filter(|&axis| slope(axis) < END_ON).map(GizmoPart::Move));
        }
        if shows(GizmoShown::Turn) {
            parts.extend((0..3).map(GizmoPart::Rotate));
            parts.push(GizmoPart::RotateView);
        }
        parts
    }

    /// A part's strokes.
    pub(super) fn strokes(&self, part: GizmoPart, view: &View) -> Vec<Stroke> {
        match part {
            GizmoPart::Free => Vec::new(),
            GizmoPart::Move(axis) => self.arrow(axis),
            GizmoPart::MovePlane(normal) => self.square(normal),
            GizmoPart::Rotate(axis) => self.ring(axis, view),
            GizmoPart::RotateView => self.view_ring(),
            GizmoPart::Scale => vec![self.knob(self.view_knob(), 11.0)],
            GizmoPart::ScaleAxis(axis) => vec![self.knob(self.at(self.axis(axis) * KNOB_AT), 9.0)],
        }
    }

    fn arrow(&self, axis: usize) -> Vec<Stroke> {
        let unit = self.axis(axis);
        let stroke = |a: Vec3, b: Vec3| Stroke { a: self.at(a), b: self.at(b), width_px: 2.5 };
        let barb = |k: usize| {
            let side = self.axis((axis + 1 + k / 2) % 3) * if k.is_multiple_of(2) { 0.055 } else { -0.055 };
            stroke(unit, unit * 0.86 + side)
        };
        std::iter::once(stroke(unit * 0.2, unit)).chain((0..4).map(barb)).collect()
    }

    fn square(&self, normal: usize) -> Vec<Stroke> {
        let (u, v) = (self.axis((normal + 1) % 3), self.axis((normal + 2) % 3));
        let (lo, hi) = SQUARE;
        let stroke = |k: u8| {
            let height = lo + (hi - lo) * f32::from(k) / f32::from(SQUARE_STROKES - 1);
            Stroke { a: self.at(u * lo + v * height), b: self.at(u * hi + v * height), width_px: 3.0 }
        };
        (0..SQUARE_STROKES).map(stroke).collect()
    }

    /// The half before the pivot: three full rings are a thicket.
    fn ring(&self, axis: usize, view: &View) -> Vec<Stroke> {
        let (u, v) = (self.axis((axis + 1) % 3), self.axis((axis + 2) % 3));
        let toward = self.toward_eye(view);
        let is_near = |stroke: &Stroke| (stroke.a - self.center).dot(toward) >= -0.05 * self.length;
        self.circle(u, v, RING).filter(is_near).collect()
    }

    fn view_ring(&self) -> Vec<Stroke> {
        self.circle(self.view_axes.x_axis.as_vec3(), self.view_axes.y_axis.as_vec3(), VIEW_RING).collect()
    }

    fn circle(&self, u: Vec3, v: Vec3, radius: f32) -> impl Iterator<Item = Stroke> + '_ {
        let point = move |k: usize| {
            let angle = (k % RING_SEGMENTS) as f32 / RING_SEGMENTS as f32 * std::f32::consts::TAU;
            self.at((u * angle.cos() + v * angle.sin()) * radius)
        };
        (0..RING_SEGMENTS).map(move |k| Stroke { a: point(k), b: point(k + 1), width_px: 2.0 })
    }

    /// Right and up on the outer ring, where no arrow reaches.
    fn view_knob(&self) -> Vec3 {
        let diagonal = (self.view_axes.x_axis + self.view_axes.y_axis).normalize().as_vec3();
        self.at(diagonal * VIEW_RING)
    }

    fn knob(&self, at: Vec3, width_px: f32) -> Stroke {
        // Strokes have round ends: hardly longer than a point it is a knob.
        let half = self.view_axes.x_axis.as_vec3() * self.length * 0.5 / super::ARROW_PX;
        Stroke { a: at - half, b: at + half, width_px }
    }

    /// Unit direction from the gizmo to the eye.
    pub(super) fn toward_eye(&self, view: &View) -> Vec3 {
        let px = view.camera.project(self.center, view.size).map_or(view.size * 0.5, |(px, _)| px);
        -view.camera.ray(px, view.size).direction
    }

    fn at(&self, offset: Vec3) -> Vec3 {
        self.center + offset * self.length
    }

    /// A point of the ring about an axis, in the given direction from the middle.
    pub(super) fn on_ring(&self, direction: Vec3) -> Vec3 {
        self.at(direction * RING)
    }

    /// Radius of the rings on screen, in points.
    pub(super) const RING_PX: f32 = super::ARROW_PX * RING;
}
