//! Surfaces between two poses, one after the other, each from the one before.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::Segment;
use crate::document::Pose;
use crate::solving::{Engine, Groundwork, SolveRequest, SolveState};
use crate::viewport::SurfaceFrame;

/// A surface between two poses.
#[derive(Clone)]
pub struct Solved {
    /// Where it is.
    pub pose: Pose,
    /// The same for a picture.
    pub frame: Arc<SurfaceFrame>,
}

/// Iterations after which a surface counts as settled whatever it does: far more than any took that settled.
const AT_MOST: usize = 3000;

/// Solves `n` surfaces at equal times strictly between the poses of a segment. `template` says mesh, method and sizes.
/// `each` is told every surface by its number from 0; `goes_on` is asked before every iteration.
///
/// # Errors
/// Why a surface cannot be solved. `None` if it was stopped.
pub fn inbetweens(
    (ground, template): (&Arc<Groundwork>, &SolveRequest),
    segment: &Segment,
    n: usize,
    goes_on: &(dyn Fn() -> bool + Sync),
    each: &mut dyn FnMut(usize, Solved),
) -> Result<Option<()>, String> {
    let mut pose = Pose { positions: segment.from().positions.clone() };
    let mut engine: Option<Engine> = None;
    for k in 0..n {
        let t = (k + 1) as f64 / (n + 1) as f64;
        let wish = SolveRequest {
            revision: k as u64 + 1,
            epoch: 0,
            pose: pose.clone(),
            groups: segment.groups(t),
            measure: None,
            ..template.clone()
        };
        let engine = engine.get_or_insert_with(|| Engine::beside(ground.clone(), &wish));
        let watch = &mut |_: f64| if goes_on() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
        if engine.adopt(wish, watch).is_break() {
            return Ok(None);
        }
        let mut steps = 0;
        while engine.is_busy() && steps < AT_MOST {
            if !goes_on() || engine.step(&mut || goes_on()).is_none() {
                return Ok(None);
            }
            steps += 1;
        }
        let report = engine.report();
        if let SolveState::Failed(why) = report.state {
            return Err(why);
        }
        pose = report.pose.unwrap_or(pose);
        let frame = report.frame.unwrap_or_else(|| Arc::new(ground.frame(&pose)));
        each(k, Solved { pose: pose.clone(), frame });
    }
    Ok(Some(()))
}
