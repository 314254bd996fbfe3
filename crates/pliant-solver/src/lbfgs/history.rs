//! The small half of L-BFGS: inner products of what is remembered, and the coefficients of the direction.
//!
//! See [`super`] for the letters. Every vector of a direction is v, an s or a w, so the two loops of the recursion need
//! only these products, and all of them follow from products of f with the remembered vectors, taken once per step:
//! y_j = f_before − f_after, so s_i·y_j is a difference of two f·s_i, and y_j·w_i one of two f·w_i.

/// Pairs remembered. Bends of a bar, a cylinder and an uneven body by 70 to 80° took 462, 42 and 55 steps to within 1 % of
/// the lowest energy with five, over 500, 43 and 69 with three, 457, 40 and 57 with ten.
pub(super) const PAIRS: usize = 5;

/// A stands for the Hessian of motions that no pair knows. It is too stiff for nearly all of them, the more so the
/// gentler they are, and the newest pair tells by how much. Beyond 2 a step may overshoot where A is right. The bends
/// above took 342, 32 and 43 steps with 2, 333, 31 and 44 with 10, and 462, 42 and 55 with 1.
const MOST_STRETCH: f64 = 2.0;

/// Flatter than this against A, a pair tells of rounding: A⁻¹ would be exaggerated by its reciprocal.
const LEAST_CURVATURE: f64 = 1e-9;

/// Products of f with what is in the slots, and with v of the step before.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Products {
    pub(super) fs: [f64; PAIRS],
    pub(super) fw: [f64; PAIRS],
    pub(super) fv_before: f64,
}

/// d = v_part v + Σ over slots (s_part s + w_part w).
#[derive(Clone, Copy, Debug)]
pub(super) struct Direction {
    pub(super) v_part: f64,
    pub(super) s_part: [f64; PAIRS],
    pub(super) w_part: [f64; PAIRS],
    /// Which slots take part.
    pub(super) slots: [usize; PAIRS],
    pub(super) n_slots: usize,
    /// f·d: half of what the energy falls per unit of step, at first.
    pub(super) fd: f64,
}

impl Direction {
    /// d = v; `fv` is f·v.
    pub(super) fn plain(fv: f64) -> Direction {
        let none = [0.0; PAIRS];
        Direction { v_part: 1.0, s_part: none, w_part: none, slots: [0; PAIRS], n_slots: 0, fd: fv }
    }

    /// The slots that take part.
    pub(super) fn slots(&self) -> &[usize] {
        &self.slots[..self.n_slots]
    }
}

/// A step whose change of gradient is not known yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending {
    /// Where its s is kept.
    pub(super) slot: usize,
    /// w and y of the pair are those of the step times this: they are kept in units of s.
    pub(super) factor: f64,
    /// Products of f before the step; `fs` of the slot is that of the new s.
    pub(super) products: Products,
    /// f·v before the step.
    pub(super) fv: f64,
}

/// Which slots hold pairs, and their products.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    /// Slots in use, oldest first.
    slots: [usize; PAIRS],
    n_slots: usize,
    /// s_i·y_j, for j not older than i.
    sy: [[f64; PAIRS]; PAIRS],
    /// y_i·w_j.
    yw: [[f64; PAIRS]; PAIRS],
}

impl History {
    pub(super) fn clear(&mut self) {
        self.n_slots = 0;
    }

    /// Number of pairs.
    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.n_slots
    }

    fn slots(&self) -> &[usize] {
        &self.slots[..self.n_slots]
    }

    /// A free slot, or else the oldest, which is forgotten.
    pub(super) fn make_room(&mut self) -> usize {
        if self.n_slots == PAIRS {
            let oldest = self.slots[0];
            self.slots.rotate_left(1);
            self.n_slots -= 1;
            return oldest;
        }
        (0..PAIRS).find(|slot| !self.slots().contains(slot)).unwrap_or(0)
    }

    /// Completes a step to a pair, now that f, with `now` its products and `fv` the one with the new v, is known.
    /// Puts the product of f with the slot's w into `now`. A pair without positive curvature is left out.
    pub(super) fn complete(&mut self, pending: &Pending, now: &mut Products, fv: f64) {
        let Pending { slot, factor, products: before, fv: fv_before } = *pending;
        for i in self.slots[..self.n_slots].iter().copied().chain([slot]) {
            self.sy[i][slot] = (before.fs[i] - now.fs[i]) * factor;
            let yw = (before.fw[i] - now.fw[i]) * factor;
            (self.yw[i][slot], self.yw[slot][i]) = (yw, yw);
        }
        now.fw[slot] = (now.fv_before - fv) * factor;
        self.yw[slot][slot] = (fv_before - 2.0 * now.fv_before + fv) * factor * factor;
        let (sy, yw) = (self.sy[slot][slot], self.yw[slot][slot]);
        if sy > LEAST_CURVATURE * yw && sy > 0.0 && sy.is_finite() {
            self.slots[self.n_slots] = slot;
            self.n_slots += 1;
        }
    }

    /// The direction H f by the recursion of two loops, with A⁻¹, stretched, in the place of the first H.
    pub(super) fn direction(&self, products: &Products, fv: f64) -> Direction {
        let Products { fs, fw, .. } = products;
        let slots = self.slots();
        let mut alpha = [0.0; PAIRS];
        for (place, &i) in slots.iter().enumerate().rev() {
            let newer = slots[place + 1..].iter().map(|&j| alpha[j] * self.sy[i][j]).sum::<f64>();
            alpha[i] = (fs[i] - newer) / self.sy[i][i];
        }
        let stretch = slots.last().map_or(1.0, |&i| (self.sy[i][i] / self.yw[i][i]).clamp(1.0, MOST_STRETCH));
        let mut direction = Direction { slots: self.slots, n_slots: self.n_slots, ..Direction::plain(fv) };
        direction.v_part = stretch;
        direction.fd = stretch * fv;
        for &i in slots {
            direction.w_part[i] = -stretch * alpha[i];
            direction.fd -= stretch * alpha[i] * fw[i];
        }
        for (place, &i) in slots.iter().enumerate() {
            let from_v = stretch * (fw[i] - slots.iter().map(|&j| alpha[j] * self.yw[i][j]).sum::<f64>());
            let older = slots[..place].iter().map(|&j| direction.s_part[j] * self.sy[j][i]).sum::<f64>();
            direction.s_part[i] = alpha[i] - (from_v + older) / self.sy[i][i];
            direction.fd += direction.s_part[i] * fs[i];
        }
        direction
    }
}
