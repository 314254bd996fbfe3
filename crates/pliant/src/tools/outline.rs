//! What is inside a closed line on screen, asked for very many points.
//!
//! Even–odd: a point is inside if a line from it to the left meets the outline an odd number of times. The sides are
//! sorted into rows once, so that each point meets only those beside it, however long the line was drawn.

use glam::Vec2;

/// More rows than this are no faster: a lasso has fewer sides beside a point of a screen than this has (by eye).
const MOST_ROWS: usize = 4096;

/// A closed line, ready to be asked.
pub(super) struct Outline {
    lo: Vec2,
    hi: Vec2,
    /// Sides that reach into each row between `lo.y` and `hi.y`.
    rows: Vec<Vec<[Vec2; 2]>>,
}

impl Outline {
    /// The closed line through `points`; the last is joined to the first. Points that are not finite are left out.
    pub(super) fn new(points: &[Vec2]) -> Outline {
        let points: Vec<Vec2> = points.iter().copied().filter(|p| p.is_finite()).collect();
        let (lo, hi) = points.iter().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
        let n_rows = if lo.y <= hi.y { ((hi.y - lo.y) as usize).clamp(1, MOST_ROWS) } else { 0 };
        let mut outline = Outline { lo, hi, rows: vec![Vec::new(); n_rows] };
        for (k, &b) in points.iter().enumerate() {
            let a = points[(k + points.len() - 1) % points.len()];
            if a.y != b.y {
                for row in outline.row(a.y.min(b.y))..=outline.row(a.y.max(b.y)) {
                    outline.rows[row].push([a, b]);
                }
            }
        }
        outline
    }

    /// Whether a point is inside.
    pub(super) fn contains(&self, p: Vec2) -> bool {
        if !(p.cmpge(self.lo).all() && p.cmple(self.hi).all()) {
            return false;
        }
        let meets =
            |&&[a, b]: &&[Vec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        self.rows.get(self.row(p.y)).is_some_and(|sides| sides.iter().filter(meets).count() % 2 == 1)
    }

    fn row(&self, y: f32) -> usize {
        let n = self.rows.len();
        let height = (self.hi.y - self.lo.y).max(f32::MIN_POSITIVE);
        (((y - self.lo.y) / height * n as f32) as usize).min(n.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even–odd by all sides.
    fn slow(points: &[Vec2], p: Vec2) -> bool {
        let sides = (0..points.len()).map(|k| (points[(k + points.len() - 1) % points.len()], points[k]));
        let meets =
            |(a, b): (Vec2, Vec2)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        sides.filter(|&side| meets(side)).count() % 2 == 1
    }

    fn line(points: &[(f32, f32)]) -> Vec<Vec2> {
        points.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    #[test]
    fn a_figure_that_crosses_itself_is_empty_where_it_covers_twice() {
        // A star with five points, drawn in one go: its middle is enclosed twice.
        let star: Vec<Vec2> = (0..5).map(|k| Vec2::from_angle(k as f32 * 0.8 * std::f32::consts::PI) * 100.0).collect();
        let outline = Outline::new(&star);
        assert!(!outline.contains(Vec2::ZERO), "the middle is enclosed twice");
        assert!(outline.contains(star[0] * 0.8), "a tip is enclosed once");
        let eight = Outline::new(&line(&[(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]));
        assert!(eight.contains(Vec2::new(9.0, 5.0)) && eight.contains(Vec2::new(1.0, 5.0)));
        assert!(!eight.contains(Vec2::new(5.0, 9.0)) && !eight.contains(Vec2::new(5.0, 1.0)));
    }

    #[test]
    fn every_point_is_answered_as_by_a_search_of_all_sides() {
        let spiral: Vec<Vec2> = (0..400).map(|k| Vec2::from_angle(k as f32 * 0.1) * (k as f32 + 20.0)).collect();
        // Corners, sides along rows and points at the height of corners.
        let comb =
            line(&[(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (6.0, 2.0), (4.0, 8.0), (4.0, 8.0), (2.0, 2.0), (0.0, 8.0)]);
        let tall = line(&[(0.0, -1e6), (3.0, 1e6), (-3.0, 2.0)]);
        for points in [spiral, comb, tall] {
            let outline = Outline::new(&points);
            for y in -450..=450 {
                for x in -45..=45 {
                    for p in [Vec2::new(x as f32, y as f32), Vec2::new(x as f32, y as f32) * 0.25] {
                        assert_eq!(outline.contains(p), slow(&points, p), "{p}");
                    }
                }
            }
        }
    }

    #[test]
    fn lines_without_inside_hold_nothing() {
        for points in [vec![], line(&[(1.0, 1.0)]), line(&[(0.0, 0.0), (5.0, 5.0)]), line(&[(0.0, 3.0), (9.0, 3.0)])] {
            let outline = Outline::new(&points);
            assert!((0..100).all(|k| !outline.contains(Vec2::new((k % 10) as f32, (k / 10) as f32))), "{points:?}");
        }
        assert!(!Outline::new(&[Vec2::NAN, Vec2::INFINITY, Vec2::ZERO]).contains(Vec2::ZERO));
    }
}
