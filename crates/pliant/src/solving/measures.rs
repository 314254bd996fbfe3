//! What the surface can be colored by besides r: one number a vertex, measured on the pose that is reported.
//!
//! | measure | at each vertex | unit |
//! |---|---|---|
//! | energy | its share E_k of eq. 1 (Fig. 3 of the paper) or of another method's energy; where vertices have none (embedded deformation), E_k at r = 1 | squared file units |
//! | energy difference | the largest difference of that share to a neighbor (Fig. 3c, e, g) | the same |
//! | stretch | ln(length / length at rest) of the edge that changed most | – |
//!
//! Numbers are scaled to 0..=1 for the ramp here, off the window's thread, and the ends of the scale go along for the legend.

use std::sync::Arc;

use glam::DVec3;
use pliant_geometry::{edge_stretch, largest_difference};
use rayon::prelude::*;

use crate::document::Model;

/// What to measure at every vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Its share in the energy.
    Energy,
    /// The largest difference of that share to a neighboring vertex.
    EnergyDifference,
    /// How far its edges are from their length at rest.
    Stretch,
}

/// One number a vertex, scaled for a color ramp.
#[derive(Clone, Debug)]
pub struct Measured {
    /// What was measured.
    pub measure: Measure,
    /// One value a vertex in 0..=1. Of stretch, 0.5 is unchanged.
    pub values: Arc<[f32]>,
    /// What 0 and 1 stand for: energies in squared file units, or ratios of length.
    pub ends: [f64; 2],
}

/// The part of the vertices that the scale of energies covers: a few spikes would leave all the rest dark.
const COVERED: f64 = 0.99;
/// Energies below this part of the squared diagonal are rounding (edges of a rigidly moved mesh are off by some 1e-15 of it)
/// and far below what is seen: an edge that is off by 1e-9 of the diagonal.
const INVISIBLE: f64 = 1e-18;
/// Ends of the scale of stretch; the first that covers nearly all vertices is taken, so that the scale changes seldom.
const RATIOS: [f64; 9] = [1.02, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0];

impl Measured {
    /// The stretch of a pose.
    pub(super) fn stretch(model: &Model, positions: &[DVec3]) -> Measured {
        let logs = edge_stretch(model.mesh.edges(), model.mesh.positions(), positions);
        let reached = covered(logs.iter().map(|log| log.abs()).collect());
        let last = RATIOS[RATIOS.len() - 1];
        let end = RATIOS.into_iter().find(|ratio| ratio.ln() >= reached).unwrap_or(last);
        let scaled = |log: &f64| (0.5 + 0.5 * log / end.ln()).clamp(0.0, 1.0) as f32;
        let values = logs.par_iter().map(scaled).collect::<Vec<_>>().into();
        Measured { measure: Measure::Stretch, values, ends: [1.0 / end, end] }
    }

    /// Energies of the vertices, or their differences.
    pub(super) fn energies(model: &Model, measure: Measure, energies: Vec<f64>) -> Measured {
        let energies = match measure {
            Measure::EnergyDifference => largest_difference(model.mesh.edges(), &energies),
            Measure::Energy | Measure::Stretch => energies,
        };
        let least = INVISIBLE * f64::from(model.diagonal()).powi(2);
        let top = covered(energies.clone()).max(least).max(f64::MIN_POSITIVE);
        let scaled = |energy: &f64| (energy / top).clamp(0.0, 1.0) as f32;
        Measured { measure, values: energies.par_iter().map(scaled).collect::<Vec<_>>().into(), ends: [0.0, top] }
    }
}

/// The value that nearly all others do not exceed; 0 for none.
fn covered(mut values: Vec<f64>) -> f64 {
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let rank = ((values.len() as f64 * COVERED) as usize).min(last);
    *values.select_nth_unstable_by(rank, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant_meshfile::MeshFile;

    /// A strip of triangles along x.
    fn strip() -> Model {
        let positions = (0..200).map(|i| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0)).collect();
        let triangles = (0..198).map(|i| if i % 2 == 0 { [i, i + 2, i + 1] } else { [i, i + 1, i + 2] }).collect();
        Model::from_file(MeshFile::from_triangles("strip", positions, triangles)).expect("a sound strip")
    }

    #[test]
    fn stretch_of_the_rest_shape_is_in_the_middle_of_the_smallest_scale() {
        let model = strip();
        let measured = Measured::stretch(&model, model.mesh.positions());
        assert!(measured.values.iter().all(|&value| value == 0.5));
        assert_eq!(measured.ends, [1.0 / 1.02, 1.02]);
    }

    #[test]
    fn the_scale_of_stretch_covers_what_is_there() {
        let model = strip();
        let twice: Vec<DVec3> = model.mesh.positions().iter().map(|&p| p * 2.0).collect();
        let measured = Measured::stretch(&model, &twice);
        assert_eq!(measured.ends[1], 2.0);
        assert!(measured.values.iter().all(|&value| (value - 1.0).abs() < 1e-6), "at the stretched end");
        let crushed: Vec<DVec3> = model.mesh.positions().iter().map(|_| DVec3::ZERO).collect();
        let measured = Measured::stretch(&model, &crushed);
        assert!(measured.values.iter().all(|&value| value == 0.0), "at the compressed end");
    }

    #[test]
    fn a_spike_does_not_darken_the_rest_and_rounding_shows_no_color() {
        let model = strip();
        let mut energies = vec![1.0; 200];
        energies[7] = 1e9;
        let measured = Measured::energies(&model, Measure::Energy, energies.clone());
        assert!(measured.values.iter().all(|&value| value == 1.0));
        assert_eq!(measured.ends, [0.0, 1.0]);
        let differences = Measured::energies(&model, Measure::EnergyDifference, energies);
        let n_high = differences.values.iter().filter(|&&value| value == 1.0).count();
        assert_eq!(n_high, 5, "the spike and its four neighbors");
        let rounding = Measured::energies(&model, Measure::Energy, vec![1e-28; 200]);
        assert!(rounding.values.iter().all(|&value| value < 1e-9));
    }
}
