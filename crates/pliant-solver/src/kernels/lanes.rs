//! As many numbers side by side as the processor computes with at once, with the operators of one.
//!
//! Every operation is the one of the standard for each lane, so results are the same for any number of lanes; only
//! products with a sum are rounded once or twice, see [`wide`](super::wide).

use std::ops::{Add, Div, Mul, Sub};

use pulp::Simd;

/// Lanes that one register holds.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    value: S::f64s,
}

/// A truth per lane.
#[derive(Clone, Copy)]
pub(crate) struct Mask<S: Simd> {
    simd: S,
    value: S::m64s,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, value: S::f64s) -> Lanes<S> {
        Lanes { simd, value }
    }

    #[inline(always)]
    pub(crate) fn value(self) -> S::f64s {
        self.value
    }

    /// The same number in every lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, number: f64) -> Lanes<S> {
        Lanes { simd, value: simd.splat_f64s(number) }
    }

    /// `self` · `factor` + `term`, rounded once where the processor can.
    #[inline(always)]
    pub(crate) fn times_plus(self, factor: Lanes<S>, term: Lanes<S>) -> Lanes<S> {
        Lanes { simd: self.simd, value: self.simd.mul_add_e_f64s(self.value, factor.value, term.value) }
    }

    /// `minuend` − `self` · `factor`, rounded once where the processor can.
    #[inline(always)]
    pub(crate) fn times_from(self, factor: Lanes<S>, minuend: Lanes<S>) -> Lanes<S> {
        Lanes { simd: self.simd, value: self.simd.neg_f64s(self.value) }.times_plus(factor, minuend)
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Lanes<S> {
        Lanes { simd: self.simd, value: self.simd.abs_f64s(self.value) }
    }

    #[inline(always)]
    pub(crate) fn max(self, other: Lanes<S>) -> Lanes<S> {
        Lanes { simd: self.simd, value: self.simd.max_f64s(self.value, other.value) }
    }

    /// False for anything that is not a number.
    #[inline(always)]
    pub(crate) fn is_less(self, other: Lanes<S>) -> Mask<S> {
        Mask { simd: self.simd, value: self.simd.less_than_f64s(self.value, other.value) }
    }

    /// Lanes of `self` where `mask` is true, of `other` elsewhere.
    #[inline(always)]
    pub(crate) fn where_else(self, mask: Mask<S>, other: Lanes<S>) -> Lanes<S> {
        Lanes { simd: self.simd, value: self.simd.select_f64s(mask.value, self.value, other.value) }
    }
}

impl<S: Simd> Mask<S> {
    #[inline(always)]
    pub(crate) fn and(self, other: Mask<S>) -> Mask<S> {
        Mask { simd: self.simd, value: self.simd.and_m64s(self.value, other.value) }
    }

    #[inline(always)]
    pub(crate) fn or(self, other: Mask<S>) -> Mask<S> {
        Mask { simd: self.simd, value: self.simd.or_m64s(self.value, other.value) }
    }

    #[inline(always)]
    pub(crate) fn not(self) -> Mask<S> {
        Mask { simd: self.simd, value: self.simd.not_m64s(self.value) }
    }

    /// Whether it is true in any lane.
    #[inline(always)]
    pub(crate) fn any(self) -> bool {
        self.simd.first_true_m64s(self.value) < S::F64_LANES
    }
}

macro_rules! operator {
    ($Trait:ident, $method:ident, $simd_method:ident) => {
        impl<S: Simd> $Trait for Lanes<S> {
            type Output = Lanes<S>;

            #[inline(always)]
            fn $method(self, other: Lanes<S>) -> Lanes<S> {
                Lanes { simd: self.simd, value: self.simd.$simd_method(self.value, other.value) }
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);
