//! Many 3 × 3 matrices, each as eight numbers in one cache line and a ninth elsewhere.
//!
//! A sum of matrices from all over memory then takes one line each, and hardly more, since the ninth numbers of
//! neighboring matrices share theirs. With columns c₀ c₁ c₂ the order is
//!
//! ```text
//! eight = [c₀x c₀y c₀z c₂x | c₁x c₁y c₁z c₂y],  ninth = c₂z
//! ```
//!
//! so that a product of vectors, or of a matrix and a vector, is eight products side by side and one more: a bᵀ is
//! `rows(a) · columns(b)`, and M v is what `folded` makes of `M · columns(v)`. See [`Wide`](crate::kernels::wide::Wide).

use glam::DMat3;

/// Eight numbers in one cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Eight(pub(crate) [f64; 8]);

impl Eight {
    pub(crate) const ZERO: Eight = Eight([0.0; 8]);
}

/// A 3 × 3 matrix in this order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nine {
    pub(crate) eight: Eight,
    pub(crate) ninth: f64,
}

impl Nine {
    /// Entries column by column.
    #[inline(always)]
    pub(crate) fn entries(self) -> [f64; 9] {
        let [ax, ay, az, cx, bx, by, bz, cy] = self.eight.0;
        [ax, ay, az, bx, by, bz, cx, cy, self.ninth]
    }

    #[inline(always)]
    pub(crate) fn from_entries(m: [f64; 9]) -> Nine {
        Nine { eight: Eight([m[0], m[1], m[2], m[6], m[3], m[4], m[5], m[7]]), ninth: m[8] }
    }
}

impl From<DMat3> for Nine {
    fn from(m: DMat3) -> Nine {
        Nine::from_entries(m.to_cols_array())
    }
}

impl From<Nine> for DMat3 {
    fn from(m: Nine) -> DMat3 {
        DMat3::from_cols_array(&m.entries())
    }
}

/// A list of matrices.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Nines {
    pub(crate) eights: Vec<Eight>,
    pub(crate) ninths: Vec<f64>,
}

impl Clone for Nines {
    fn clone(&self) -> Nines {
        Nines { eights: self.eights.clone(), ninths: self.ninths.clone() }
    }

    /// Into the same memory, which a derived one would not use.
    fn clone_from(&mut self, other: &Nines) {
        self.eights.clone_from(&other.eights);
        self.ninths.clone_from(&other.ninths);
    }
}

impl Nines {
    pub(crate) fn resize(&mut self, n: usize) {
        self.eights.resize(n, Eight::ZERO);
        self.ninths.resize(n, 0.0);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.ninths.is_empty()
    }

    pub(crate) fn set(&mut self, i: usize, matrix: DMat3) {
        let Nine { eight, ninth } = matrix.into();
        (self.eights[i], self.ninths[i]) = (eight, ninth);
    }

    pub(crate) fn get(&self, i: usize) -> DMat3 {
        self.as_slices().get(i).into()
    }

    #[inline(always)]
    pub(crate) fn as_slices(&self) -> NinesRef<'_> {
        NinesRef { eights: &self.eights, ninths: &self.ninths }
    }
}

/// A list of matrices to be read.
#[derive(Clone, Copy)]
pub(crate) struct NinesRef<'a> {
    pub(crate) eights: &'a [Eight],
    pub(crate) ninths: &'a [f64],
}

impl<'a> NinesRef<'a> {
    /// The same; a loop that begins with it checks one bound per matrix instead of two.
    #[inline(always)]
    pub(crate) fn of_one_length(self) -> NinesRef<'a> {
        let n = self.eights.len().min(self.ninths.len());
        NinesRef { eights: &self.eights[..n], ninths: &self.ninths[..n] }
    }

    #[inline(always)]
    pub(crate) fn get(self, i: usize) -> Nine {
        Nine { eight: self.eights[i], ninth: self.ninths[i] }
    }
}
