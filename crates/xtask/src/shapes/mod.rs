//! The shapes that Pliant brings along, made here from formulas.
//!
//! Everything is computed with operations whose result IEEE 754 fixes to the last bit (+ − × ÷ √) or with the `libm`
//! crate, in one fixed order, so that every machine makes the same bytes.

pub(crate) mod bar;
pub(crate) mod body;
pub(crate) mod cactus;
pub(crate) mod creature;
pub(crate) mod field;
pub(crate) mod flips;
pub(crate) mod gecko;
pub(crate) mod handles;
pub(crate) mod jointed_bar;
pub(crate) mod mesh;
pub(crate) mod polygonize;
pub(crate) mod posed;
pub(crate) mod sheet;
pub(crate) mod skeleton;

pub(crate) use handles::Handles;
pub(crate) use mesh::Shape;

/// How to make a shape and what goes with it.
pub(crate) struct Sample {
    /// File name without ending.
    pub(crate) name: &'static str,
    pub(crate) make: fn() -> Shape,
    /// What comes between name and `.handles.json` (empty, or like `.150`), and the handles on the shape made.
    pub(crate) handles: fn(&Shape) -> Vec<(&'static str, Handles)>,
    /// r of every vertex, for a demonstration.
    pub(crate) rigidity: Option<fn(&Shape) -> Vec<u16>>,
}

/// All samples, in the order in which they are reported.
pub(crate) const ALL: [Sample; 5] = [bar::BAR, bar::THIN_BAR, cactus::CACTUS, sheet::SHEET, creature::CREATURE];

/// All sets of poses.
pub(crate) const POSED: [posed::PoseSet; 2] = [gecko::GECKO, jointed_bar::JOINTED_BAR];

#[cfg(test)]
mod tests {
    use super::*;

    /// The samples with their shapes as they are in `assets/`: making them takes seconds, and another test sees to it
    /// that the files are what is made.
    fn samples() -> Vec<(Sample, Shape)> {
        let load = |sample: Sample| {
            let path = crate::assets::folder().join(format!("{}.glb", sample.name));
            let mesh = pliant_meshfile::open(&path).expect("a sample opens");
            let shape = Shape { positions: mesh.positions, triangles: mesh.triangles };
            (sample, shape)
        };
        ALL.into_iter().map(load).collect()
    }

    #[test]
    fn samples_are_surfaces_like_spheres_or_a_sheet_facing_outwards() {
        for (Sample { name, .. }, shape) in samples() {
            let open = name == "sheet";
            assert_eq!(shape.flaws(open), Vec::<String>::new(), "{name}");
            let edges = shape.directed_edges();
            let n_edges = edges.0.iter().filter(|((a, b), _)| a < b || edges.triangle(*b, *a).is_none()).count();
            let euler = shape.positions.len() as i64 - n_edges as i64 + shape.triangles.len() as i64;
            assert_eq!(euler, if open { 1 } else { 2 }, "{name}: vertices - edges + triangles");
            assert!(open || shape.volume() > 0.0, "{name} is inside out");
        }
    }

    #[test]
    fn no_sample_crosses_itself() {
        for (Sample { name, .. }, shape) in samples() {
            let pairs = pliant_geometry::crossings(&shape.positions, &shape.triangles);
            assert_eq!(pairs, Vec::<[u32; 2]>::new(), "{name}");
        }
    }

    #[test]
    fn triangles_are_well_shaped_and_their_number_as_wanted() {
        // Vertices from, to; smallest angle in degrees.
        let wanted = [
            ("bar", 1154, 1154, 44.0),
            ("thin-bar", 1154, 1154, 26.0),
            ("cactus", 4000, 6000, 20.0),
            ("sheet", 3000, 4000, 5.0),
            ("creature", 10_000, 15_000, 20.0),
        ];
        assert_eq!(ALL.len(), wanted.len());
        for ((Sample { name, .. }, shape), (wanted_name, low, high, angle)) in samples().into_iter().zip(wanted) {
            assert_eq!(name, wanted_name);
            let n = shape.positions.len();
            assert!((low..=high).contains(&n), "{name}: {n} vertices");
            let got = shape.smallest_angle();
            assert!(got > angle, "{name}: an angle of {got}°");
        }
    }

    #[test]
    fn the_creature_stands_on_the_ground_two_units_tall() {
        let (_, creature) = &samples()[4];
        let heights = || creature.positions.iter().map(|p| p.y);
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        assert!(low.abs() < 0.01 && (high - 2.0).abs() < 0.05, "from {low} to {high}");
    }

    #[test]
    fn handles_are_vertices_and_none_is_given_twice() {
        for (Sample { name, handles, .. }, shape) in samples() {
            let handles = handles(&shape);
            assert!(!handles.is_empty(), "{name}");
            for (suffix, handles) in handles {
                let moved = handles.moved.iter().map(|(v, _)| *v);
                let grouped = handles.groups.iter().flat_map(|(vertices, _)| vertices.iter().copied());
                let mut all: Vec<u32> = handles.fixed.iter().copied().chain(moved).chain(grouped).collect();
                assert!(!handles.fixed.is_empty() && all.len() > handles.fixed.len(), "{name}{suffix}");
                assert!(all.iter().all(|&v| (v as usize) < shape.positions.len()), "{name}{suffix}");
                all.sort_unstable();
                assert!(all.windows(2).all(|w| w[0] < w[1]), "{name}{suffix}: a vertex is given twice");
            }
        }
    }

    #[test]
    fn demonstration_rigidity_is_soft_at_joints_and_stiff_between() {
        let (sample, creature) = &samples()[4];
        let r = sample.rigidity.expect("the creature has one")(creature);
        assert_eq!(r.len(), creature.positions.len());
        let share = |wanted: std::ops::RangeInclusive<u16>| {
            r.iter().filter(|r| wanted.contains(r)).count() as f64 / r.len() as f64
        };
        assert_eq!(share(1..=6), 1.0);
        assert!(share(1..=2) > 0.1 && share(5..=6) > 0.4, "{} soft, {} stiff", share(1..=2), share(5..=6));
    }
}
