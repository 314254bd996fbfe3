//! When the surface has come to rest: the energy has stopped falling.

/// Relative decrease of the energy below which the surface counts as at rest. The paper's γ is 1e-3 for a result; a
/// thousandth of that is below what can be seen on a screen (by eye).
const SETTLED_BELOW: f64 = 1e-6;
/// The iterations that together must not lower the energy by more. One of L-BFGS may be cut short, or be the plain one
/// because what was learned misled, and the next but one, with what that one taught, be long again.
const QUIET_STEPS: usize = 3;

/// The energies since the last change, as many as are compared.
#[derive(Debug, Default)]
pub(super) struct Stillness {
    /// Oldest first.
    energies: [f64; QUIET_STEPS],
    known: usize,
}

impl Stillness {
    /// Something changed: energies from before do not compare.
    pub(super) fn changed(&mut self) {
        self.known = 0;
    }

    /// Takes the energy after an iteration. Says whether it has stopped falling; none at all (the solver reports
    /// rounding as 0) cannot fall.
    pub(super) fn is_reached(&mut self, energy: f64) -> bool {
        let before = self.energies[0];
        self.energies.rotate_left(1);
        self.energies[QUIET_STEPS - 1] = energy;
        let is_known = self.known == QUIET_STEPS;
        self.known = (self.known + 1).min(QUIET_STEPS);
        energy == 0.0 || is_known && before - energy < SETTLED_BELOW * before.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// After how many of these energies it says so first.
    fn reached(energies: &[f64]) -> Option<usize> {
        let mut stillness = Stillness::default();
        energies.iter().position(|&energy| stillness.is_reached(energy)).map(|place| place + 1)
    }

    #[test]
    fn a_single_iteration_that_stalls_does_not_end_a_slope() {
        assert_eq!(reached(&[4.0, 3.0, 3.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0]), None);
    }

    #[test]
    fn three_iterations_that_together_change_nothing_settle_it() {
        assert_eq!(reached(&[4.0, 3.0, 3.0, 3.0, 3.0]), Some(5));
        let barely = 3.0 - 3.0 * 0.9e-6;
        assert_eq!(reached(&[3.0, 3.0, 3.0, barely]), Some(4));
        assert_eq!(reached(&[3.0, 3.0, 3.0, 3.0 - 3.0 * 1.1e-6]), None);
    }

    #[test]
    fn no_energy_is_rest_at_once_and_negative_ones_fall_as_well() {
        assert_eq!(reached(&[0.0]), Some(1));
        assert_eq!(reached(&[-1.0, -1.1, -1.2, -1.3, -1.4]), None);
        assert_eq!(reached(&[-1.0, -1.0, -1.0, -1.0]), Some(4));
    }

    #[test]
    fn energies_from_before_a_change_do_not_count() {
        let mut stillness = Stillness::default();
        assert_eq!([1.0; 3].map(|energy| stillness.is_reached(energy)), [false; 3]);
        stillness.changed();
        assert_eq!([1.0; 4].map(|energy| stillness.is_reached(energy)), [false, false, false, true]);
    }
}
