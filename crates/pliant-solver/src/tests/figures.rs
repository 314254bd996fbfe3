//! Numbers that the paper prints or that a straightforward reference computed.

use std::f64::consts::PI;

use glam::DVec3;

use crate::test_support::{arc, box_bar, solver};
use crate::{Rigidity, Start, Weights};

#[test]
fn larger_neighborhoods_converge_in_fewer_iterations_as_in_table_1() {
    // The thin bar of 1154 vertices along an arc of 180°, γ = 1e-3, raw cotangents, R = I at rest. The counts are those
    // of an independent plain implementation (the paper prints 201, 124, 63, 33 for its own bar).
    for (r, expected) in [(1, 510), (2, 162), (4, 91), (6, 63), (10, 44)] {
        let mesh = box_bar([143, 2, 2], DVec3::new(36.0, 1.0, 1.0));
        assert_eq!(mesh.n_vertices(), 1154);
        let (held, targets) = arc(&mesh, 36.0, PI);
        let mut solver = solver(mesh, Weights::Cotangent, &Rigidity::uniform(1154, r), &held);
        solver.set_targets(&targets).expect("finite");
        solver.start(Start::Rest);
        let mut before = f64::INFINITY;
        let got = loop {
            let report = solver.step();
            assert!(report.energy <= before, "r = {r}: {} after {before} at {}", report.energy, report.iteration);
            before = report.energy;
            if report.relative_decrease < 1e-3 {
                break report.iteration;
            }
        };
        // At r = 1 the first global step squeezes 284 neighborhoods onto a line and rounding decides how they turn; plain
        // implementations with other rounding took 494 to 513.
        let tolerance = if r == 1 { 40 } else { 1 };
        assert!(got.abs_diff(expected) <= tolerance, "r = {r}: {got} iterations instead of {expected}");
    }
}
