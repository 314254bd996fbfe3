//! Shapes as the zero set of a function that is negative inside: rounded parts, softly joined.
//!
//! The functions are close to the signed distance near the surface, which is all that polygonizing and projecting need.

use glam::DVec3;

/// A smooth shape: negative inside, positive outside.
pub(crate) trait Field: Sync {
    /// About the signed distance from the surface.
    fn at(&self, p: DVec3) -> f64;

    /// Slope of [`at`](Field::at) by central differences. The step is small against any detail (a tenth of a
    /// millimeter in a shape two units tall) and large against rounding.
    fn slope(&self, p: DVec3) -> DVec3 {
        const STEP: f64 = 1e-4;
        let along = |e: DVec3| (self.at(p + e * STEP) - self.at(p - e * STEP)) / (2.0 * STEP);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    /// The point moved onto the surface by Newton steps along the slope.
    fn project(&self, mut p: DVec3, n_steps: usize) -> DVec3 {
        for _ in 0..n_steps {
            let slope = self.slope(p);
            let steepness = slope.length_squared();
            if steepness > 1e-6 {
                p -= slope * (self.at(p) / steepness);
            }
        }
        p
    }

    /// One step of [`project`](Field::project) for a point that is near the surface and whose normal is about known: two
    /// evaluations instead of seven. Where the normal is far from the slope it is a full step.
    fn project_along(&self, p: DVec3, normal: DVec3) -> DVec3 {
        const STEP: f64 = 1e-4;
        let d = self.at(p);
        let steepness = (self.at(p + normal * STEP) - d) / STEP;
        if steepness > 0.5 { p - normal * (d / steepness) } else { self.project(p, 1) }
    }
}

/// A building block.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part {
    /// A stick with round ends whose radius changes evenly from one end to the other.
    Limb { from: DVec3, to: DVec3, radii: [f64; 2] },
    /// An ellipsoid with axes along x, y, z.
    Ellipsoid { center: DVec3, radii: DVec3 },
    /// A limb with `n` ribs along it, `depth` times its radius deep.
    Ribbed { from: DVec3, to: DVec3, radii: [f64; 2], n: u32, depth: f64 },
}

/// A ball.
pub(crate) fn ball(center: DVec3, radius: f64) -> Part {
    Part::Limb { from: center, to: center, radii: [radius; 2] }
}

impl Part {
    /// About the signed distance from the part's surface.
    pub(crate) fn at(&self, p: DVec3) -> f64 {
        match *self {
            Part::Limb { from, to, radii } => {
                let t = along(p, from, to);
                p.distance(from.lerp(to, t)) - (radii[0] + t * (radii[1] - radii[0]))
            }
            Part::Ellipsoid { center, radii } => {
                let scaled = ((p - center) / radii).length();
                let slope = ((p - center) / (radii * radii)).length();
                // At the very center the slope vanishes; anything well below zero will do.
                if slope < 1e-9 { -radii.min_element() } else { scaled * (scaled - 1.0) / slope }
            }
            Part::Ribbed { from, to, radii, n, depth } => {
                let t = along(p, from, to);
                let radius = radii[0] + t * (radii[1] - radii[0]);
                let away = p - from.lerp(to, t);
                away.length() - radius * (1.0 + depth * ribs(away, to - from, n))
            }
        }
    }
}

impl Part {
    /// A box that contains the part and the swelling of a seam.
    fn box_around(&self, width: f64) -> (DVec3, DVec3) {
        let (from, to, reach) = match *self {
            Part::Limb { from, to, radii } => (from, to, DVec3::splat(radii[0].max(radii[1]))),
            Part::Ellipsoid { center, radii } => (center, center, radii),
            Part::Ribbed { from, to, radii, depth, .. } => {
                (from, to, DVec3::splat(radii[0].max(radii[1]) * (1.0 + depth)))
            }
        };
        let reach = reach + width;
        (from.min(to) - reach, from.max(to) + reach)
    }
}

/// Where along the stick a point lies, 0 to 1.
fn along(p: DVec3, from: DVec3, to: DVec3) -> f64 {
    let axis = to - from;
    let length = axis.length_squared();
    if length == 0.0 { 0.0 } else { ((p - from).dot(axis) / length).clamp(0.0, 1.0) }
}

/// cos(n φ) of the angle around the axis, fading to zero towards it: the real part of a complex power, so that no
/// trigonometry is needed.
fn ribs(away: DVec3, axis: DVec3, n: u32) -> f64 {
    let axis = axis.normalize();
    let first = axis.any_orthonormal_vector();
    let (x, y) = (away.dot(first), away.dot(axis.cross(first)));
    let length = away.length().max(1e-12);
    let (x, y) = (x / length, y / length);
    let (mut re, mut im) = (1.0, 0.0);
    for _ in 0..n {
        (re, im) = (re * x - im * y, re * y + im * x);
    }
    re
}

/// The union of two shapes with the seam rounded off over a width of about `width` (a cubic blend: smooth slopes).
pub(crate) fn soft_union(a: f64, b: f64, width: f64) -> f64 {
    let overlap = (1.0 - (a - b).abs() / width).max(0.0);
    a.min(b) - overlap * overlap * overlap * width / 6.0
}

/// The common part of two shapes, its edge rounded off likewise.
pub(crate) fn soft_intersection(a: f64, b: f64, width: f64) -> f64 {
    -soft_union(-a, -b, width)
}

/// Parts joined one after the other, each with its own width of seam.
#[derive(Clone, Debug, Default)]
pub(crate) struct Union {
    parts: Vec<(Part, f64)>,
    /// Box that contains everything.
    low: DVec3,
    high: DVec3,
}

impl Union {
    /// Adds a part with a seam of this width.
    pub(crate) fn join(&mut self, part: Part, width: f64) -> &mut Self {
        let (low, high) = part.box_around(width);
        let first = self.parts.is_empty();
        self.low = if first { low } else { self.low.min(low) };
        self.high = if first { high } else { self.high.max(high) };
        self.parts.push((part, width));
        self
    }

    /// The soft union of these parts with a shape whose value here is `d`. Parts that lie too far away to matter are not
    /// looked at one by one.
    pub(crate) fn joined_to(&self, d: f64, p: DVec3, width: f64) -> f64 {
        let at_least = p.distance(p.clamp(self.low, self.high));
        if at_least > d + width { d } else { soft_union(d, self.at(p), width) }
    }

    /// Adds a chain of limbs through points with radii, along a smooth curve (Catmull and Rom's).
    pub(crate) fn chain(&mut self, points: &[(DVec3, f64)], width: f64) -> &mut Self {
        /// Limbs between two of the points: enough that no kink shows at the samples' size.
        const N_LIMBS: usize = 4;
        let n = if points.len() > 2 { N_LIMBS } else { 1 };
        for piece in 0..points.len().saturating_sub(1) {
            let around = [piece.saturating_sub(1), piece, piece + 1, (piece + 2).min(points.len() - 1)];
            let on_curve = |step: usize| through(around.map(|i| points[i]), step as f64 / n as f64);
            for step in 0..n {
                let ((from, a), (to, b)) = (on_curve(step), on_curve(step + 1));
                // Within one curve the limbs continue each other: hardly a seam, which would swell at every joint.
                let width = if piece + step == 0 { width } else { 0.06 * a.min(b) };
                self.join(Part::Limb { from, to, radii: [a, b] }, width);
            }
        }
        self
    }
}

/// The point and radius at `t` of 0 to 1 between the second and third of four points of a curve.
fn through([p, q, r, s]: [(DVec3, f64); 4], t: f64) -> (DVec3, f64) {
    let (t2, t3) = (t * t, t * t * t);
    let weights = [2.0 * t2 - t - t3, 2.0 - 5.0 * t2 + 3.0 * t3, t + 4.0 * t2 - 3.0 * t3, t3 - t2].map(|w| 0.5 * w);
    let [a, b, c, d] = weights;
    (p.0 * a + q.0 * b + r.0 * c + s.0 * d, p.1 * a + q.1 * b + r.1 * c + s.1 * d)
}

impl Field for Union {
    fn at(&self, p: DVec3) -> f64 {
        self.parts.iter().fold(f64::INFINITY, |d, (part, width)| match d.is_finite() {
            true => soft_union(d, part.at(p), *width),
            false => part.at(p),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_negative_inside_and_zero_on_the_surface() {
        let limb = Part::Limb { from: DVec3::ZERO, to: DVec3::X, radii: [0.1, 0.3] };
        assert_eq!(limb.at(DVec3::new(-0.1, 0.0, 0.0)), 0.0);
        assert!((limb.at(DVec3::new(1.0, 0.3, 0.0))).abs() < 1e-12);
        let egg = Part::Ellipsoid { center: DVec3::Y, radii: DVec3::new(1.0, 2.0, 3.0) };
        assert!(egg.at(DVec3::Y) < 0.0);
        assert!(egg.at(DVec3::new(0.0, 1.0, 3.0)).abs() < 1e-12);
    }

    #[test]
    fn projecting_lands_on_the_surface() {
        let mut shape = Union::default();
        shape.join(ball(DVec3::ZERO, 1.0), 0.1).join(ball(DVec3::X, 0.7), 0.2);
        let p = shape.project(DVec3::new(0.8, 0.8, 0.3), 6);
        assert!(shape.at(p).abs() < 1e-9, "{}", shape.at(p));
    }
}
