//! Drags on 250,000 and a million vertices.

use std::sync::Arc;
use std::time::{Duration, Instant};

use pliant::document::{Command, GroupKind, Model};
use pliant::editor::{Opened, Session};
use pliant_solver::VertexId;

use crate::sheet::bumpy_sheet;
use crate::{FRAME, FRAMES, answered_in, motion, print_times};

/// Drags on meshes whose iterations are slower than the screen: surfaces a second, and the longest wait for one.
pub(crate) fn large_drags() {
    for cells in [500, 1000] {
        let mut session = Session::new(|| {}).expect("a solver thread");
        let model = Model::from_file(bumpy_sheet(cells)).expect("a good mesh");
        session.show(Opened::new(Arc::new(model)), None);
        session.apply(Command::FillAll(2));
        session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (0..=cells).map(VertexId).collect() });
        let last_row = (cells * (cells + 1)..(cells + 1) * (cells + 1)).map(VertexId).collect();
        answered_in(&mut session, Command::Hold { kind: GroupKind::Handle, vertices: last_row });
        let handle = session.document().and_then(|document| document.scene().groups.last()).expect("just placed").id;
        // What is needed to follow is made in the background; a person looks at the mesh for longer before dragging.
        for frame in 0..3 {
            answered_in(&mut session, Command::Move { group: handle, motion: motion(frame) });
            std::thread::sleep(Duration::from_secs(2));
            session.poll();
        }
        let (mut shown, mut waits) = (Instant::now(), Vec::new());
        let mut last = None;
        let start = Instant::now();
        for frame in 3..FRAMES {
            let begun = Instant::now();
            session.apply(Command::Move { group: handle, motion: motion(frame) });
            while begun.elapsed() < FRAME {
                session.poll();
                let frame = session.open().map(|open| Arc::as_ptr(open.surface.frame()));
                if frame != last {
                    waits.push(shown.elapsed());
                    (shown, last) = (Instant::now(), frame);
                }
                std::thread::sleep(Duration::from_micros(500));
            }
        }
        let rate = waits.len() as f64 / start.elapsed().as_secs_f64();
        println!("drag on {} vertices, r 2, without drawing", (cells + 1) * (cells + 1));
        println!("  surfaces a second        {rate:8.1}");
        print_times("  wait for a surface    ", &mut waits);
        let ms = session.status.report.as_ref().map_or(0.0, |report| report.iteration_ms);
        println!("  solver iteration, median {ms:8.2} ms");
    }
}
