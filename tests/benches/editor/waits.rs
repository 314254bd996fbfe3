//! Waits for a surface after a dab of the brush and after a new handle.

use std::time::Duration;

use glam::{DAffine3, DVec3};
use pliant::document::{Command, GroupKind, Model};
use pliant::editor::{Opened, Session};
use pliant_solver::VertexId;
use std::sync::Arc;

use crate::sheet::{CELLS, bumpy_sheet, patch};
use crate::{answered_in, print_times};

/// From a wish to the surface that knows of it, while the surface before is still on its way.
pub(crate) fn waits() {
    let mut session = Session::new(|| {}).expect("a solver thread");
    let model = Model::from_file(bumpy_sheet(CELLS)).expect("a good mesh");
    session.show(Opened::new(Arc::new(model)), None);
    let rim = (0..=CELLS).map(VertexId).collect();
    session.apply(Command::FillAll(2));
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: rim });
    let first = answered_in(&mut session, Command::Hold { kind: GroupKind::Handle, vertices: patch(150, 300, 2) });
    let group = session.document().and_then(|document| document.scene().groups.last()).expect("just placed").id;
    let motion = DAffine3::from_translation(DVec3::new(0.0, 0.1, 0.2));
    answered_in(&mut session, Command::Move { group, motion });
    let dabs = (0..9).map(|k| {
        let values = patch(30 + 30 * k, 40 + 25 * k, 12).into_iter().map(|v| (v, 6)).collect();
        answered_in(&mut session, Command::Paint { values })
    });
    let mut dabs: Vec<Duration> = dabs.collect();
    let handles = (0..9).map(|k| {
        let vertices = patch(285 - 30 * k, 40 + 20 * k, 2);
        answered_in(&mut session, Command::Hold { kind: GroupKind::Handle, vertices })
    });
    let mut handles: Vec<Duration> = handles.collect();
    let report = session.status.report.as_ref().expect("it has answered");
    println!("waits for a surface: {} vertices, r 2", (CELLS + 1) * (CELLS + 1));
    println!("  first build              {:8.1} ms", first.as_secs_f64() * 1e3);
    print_times("  dab of 469 to r 6     ", &mut dabs);
    print_times("  handle of 19          ", &mut handles);
    println!("  solver iteration, median {:8.2} ms", report.iteration_ms);
}
