//! When to show the surface: between two iterations, from the times of those before.
//!
//! Showing often makes a drag smooth; iterating longer makes each surface better. An iteration that follows new targets
//! only spreads them, and L-BFGS knows more than the plain iteration from the third on. So there are three iterations
//! between surfaces where they fit into two frames of the screen, and more where they fit into one.

use std::time::Duration;

/// Shorter than a frame of a screen at 60 Hz, by as much as the times vary: every frame then has a surface of its own
/// (measured: 58 surfaces a second with 16 ms, 68 to 78 with 12).
const FRAME: Duration = Duration::from_millis(12);
/// Two frames of the screen: 30 surfaces a second still look like motion (by eye).
const LONGEST: Duration = Duration::from_millis(33);
/// Iterations after new targets, if they fit into [`LONGEST`].
const WANTED_STEPS: u32 = 3;

/// What to do after an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// Another one.
    GoOn,
    /// Show the surface.
    Report,
}

/// Time since the last surface, and what filled it. It looks at no clock: it is told.
#[derive(Debug, Default)]
pub(super) struct Pace {
    since_report: Duration,
    /// Iterations since the last surface or the last wish, whichever came later.
    steps: u32,
}

impl Pace {
    /// The surface was shown, and making it ready took so long.
    pub(super) fn reported(&mut self, took: Duration) {
        *self = Pace { since_report: took, steps: 0 };
    }

    /// A new wish was taken, and turning to it took so long.
    pub(super) fn turned(&mut self, took: Duration) {
        self.since_report += took;
        self.steps = 0;
    }

    /// An iteration took so long, and the next will take as long.
    pub(super) fn stepped(&mut self, took: Duration) -> Next {
        self.since_report += took;
        self.steps += 1;
        let limit = if self.steps < WANTED_STEPS { LONGEST } else { FRAME };
        if self.since_report + took <= limit { Next::GoOn } else { Next::Report }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn us(us: u64) -> Duration {
        Duration::from_micros(us)
    }

    /// Iterations between two surfaces, when each takes as long as the other.
    fn steps_between(pace: &mut Pace, step: Duration) -> u32 {
        let mut steps = 1;
        while pace.stepped(step) == Next::GoOn {
            steps += 1;
        }
        pace.reported(Duration::ZERO);
        steps
    }

    #[test]
    fn short_iterations_fill_a_frame_of_the_screen_and_no_more() {
        for (step, expected) in [(us(100), 120), (us(1000), 12), (us(4000), 3), (us(5000), 3)] {
            assert_eq!(steps_between(&mut Pace::default(), step), expected, "{step:?}");
        }
    }

    #[test]
    fn three_iterations_lie_between_surfaces_where_they_fit_into_two_frames() {
        for (step, expected) in [(us(6000), 3), (us(11_000), 3), (us(11_001), 2), (us(16_500), 2)] {
            assert_eq!(steps_between(&mut Pace::default(), step), expected, "{step:?}");
        }
    }

    #[test]
    fn a_surface_is_never_later_than_two_frames_unless_a_single_iteration_is() {
        for step in (100..60_000).step_by(100).map(us) {
            let mut pace = Pace::default();
            let steps = steps_between(&mut pace, step);
            assert!(steps * step <= LONGEST || steps == 1, "{steps} of {step:?}");
        }
    }

    #[test]
    fn wishes_that_never_end_do_not_put_the_surface_off() {
        let mut pace = Pace::default();
        let mut steps = 0;
        loop {
            pace.turned(us(10));
            steps += 1;
            if pace.stepped(us(4000)) == Next::Report {
                break;
            }
            assert!(steps < 100, "no surface");
        }
        assert!(steps * us(4010) <= LONGEST, "{steps} iterations of 4 ms");
    }

    #[test]
    fn after_a_wish_there_are_three_iterations_with_it() {
        let mut pace = Pace::default();
        assert_eq!([us(3000); 3].map(|step| pace.stepped(step)), [Next::GoOn; 3]);
        pace.turned(us(10));
        assert_eq!([us(3000); 3].map(|step| pace.stepped(step)), [Next::GoOn, Next::GoOn, Next::Report]);
    }

    #[test]
    fn work_on_a_wish_and_on_the_surface_counts_too() {
        let mut pace = Pace::default();
        pace.turned(us(40_000));
        assert_eq!(pace.stepped(us(1000)), Next::Report);
        pace.reported(us(8000));
        assert_eq!([us(3000); 3].map(|step| pace.stepped(step)), [Next::GoOn, Next::GoOn, Next::Report]);
    }
}
