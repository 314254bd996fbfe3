//! How strained a pose is, whatever made it: the energy of eq. (1) with r = 1 and the best rotations, vertex by vertex.
//!
//! Every method lowers an energy of its own, in its own units. This one is asked of any of their results, so that they can
//! be compared.

use glam::{DMat3, DQuat, DVec3};

use crate::kernels::parallel::{chunks, on_pool};
use crate::kernels::rotations::{Ties, best_rotation};
use crate::kernels::sums::outer;
use crate::mesh::is_usable;
use crate::{Analysis, SolveError};

/// Edges are off by this many unit roundoffs of the largest coordinate, now and at rest, and after a rotation.
const EDGE_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// E_k of every vertex for r = 1, in the caller's numbering: the energy by which ARAP (Sorkine and Alexa 2007) judges these
/// positions. Exactly 0 where it could not be told from rounding.
///
/// # Errors
/// [`SolveError::WrongLength`], `TargetNotFinite`.
pub fn arap_energies(analysis: &Analysis, positions: &[DVec3]) -> Result<Vec<f64>, SolveError> {
    let layout = &analysis.layout;
    let n = layout.n_vertices();
    if positions.len() != n {
        return Err(SolveError::WrongLength { what: "positions", got: positions.len(), expected: n });
    }
    if let Some(bad) = positions.iter().position(|&p| !is_usable(p)) {
        return Err(SolveError::TargetNotFinite { vertex: bad as u32 });
    }
    let reach = positions.iter().chain(&layout.rest).fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    let smallest = (EDGE_ROUNDING * reach).powi(2);
    let at = |v: usize| positions[layout.to_caller[v] as usize];
    let mut internal = vec![0.0; n];
    on_pool(n, || {
        chunks(&mut internal, |first, out| {
            for (k, out) in (first..).zip(out) {
                let edges = || {
                    layout.spokes(k).iter().map(|spoke| {
                        let (j, w) = (spoke.vertex as usize, layout.weight[spoke.edge as usize]);
                        (layout.rest[k] - layout.rest[j], at(k) - at(j), w)
                    })
                };
                let t = edges().fold(DMat3::ZERO, |t, (rest, now, w)| t + outer(now * w, rest));
                let r = DMat3::from_quat(best_rotation(t, DQuat::IDENTITY, Ties::Nearest));
                let square = |rest: DVec3, now: DVec3| (now - r * rest).length_squared();
                let sum: f64 = edges().map(|(rest, now, w)| w * square(rest, now)).sum();
                let floor: f64 = edges().map(|(.., w)| w.abs() * smallest).sum();
                *out = if sum.abs() <= floor { 0.0 } else { sum };
            }
        });
    });
    Ok(layout.to_internal.iter().map(|&v| internal[v as usize]).collect())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::test_support::{arc, box_bar, bumpy_sheet, solver};
    use crate::{Rigidity, Weights};

    #[test]
    fn the_strain_of_a_pose_is_its_energy_at_r_1() {
        let mesh = box_bar([12, 3, 3], DVec3::new(4.0, 1.0, 1.0));
        let (held, targets) = arc(&mesh, 4.0, 2.5);
        let mut solver = solver(mesh, Weights::Clamped, &Rigidity::uniform(164, 1), &held);
        solver.set_targets(&targets).expect("finite");
        (0..5).for_each(|_| _ = solver.step());
        let energies = arap_energies(&solver.analysis, &solver.positions()).expect("as many");
        let (got, expected) = (energies.iter().sum::<f64>(), solver.energy());
        // Rotations are the best ones to eight digits and E is level there; the sums differ in order.
        assert!((got - expected).abs() < 1e-9 * expected, "{got}, expected {expected}");
        for (v, (got, expected)) in energies.iter().zip(solver.vertex_energies()).enumerate() {
            assert!((got - expected).abs() < 1e-9 * solver.energy(), "vertex {v}: {got}, expected {expected}");
        }
    }

    #[test]
    fn a_moved_and_turned_surface_is_not_strained_at_all() {
        let mesh = bumpy_sheet(20);
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 3.0);
        let moved: Vec<DVec3> = mesh.positions().iter().map(|&p| turn * p + DVec3::new(3e3, -4.0, 7.0)).collect();
        let analysis = Analysis::new(Arc::new(mesh), Weights::Clamped);
        assert!(arap_energies(&analysis, &moved).expect("as many").iter().all(|&e| e == 0.0));
        assert!(arap_energies(&analysis, &moved[1..]).is_err());
    }
}
