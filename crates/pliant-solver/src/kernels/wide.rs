//! Registers of four and of eight numbers, whatever the processor has, and the choice of the best at run time.
//!
//! Every operation is the one of the standard for each number, so results are the same whether there are four or eight
//! at once. A product with a sum is rounded once on x86-64 processors with AVX2 (since 2013) and twice on all others,
//! which therefore differ in the last digit.

mod scalar;
#[cfg(target_arch = "x86_64")]
mod x86;

use pulp::{Scalar, Simd};

/// A computation that is compiled for each kind of processor.
pub(crate) trait Kernel {
    type Output;

    /// To be inlined always, with all that it calls: only then is it compiled for the processor.
    fn run<W: Wide>(self, wide: W) -> Self::Output;
}

/// Runs a computation in the form that is best for this processor.
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    {
        use pulp::x86::{V3, V4};
        if let Some(wide) = V4::try_new() {
            return wide.vectorize(
                #[inline(always)]
                || kernel.run(wide),
            );
        }
        if let Some(wide) = V3::try_new() {
            return wide.vectorize(
                #[inline(always)]
                || kernel.run(wide),
            );
        }
    }
    kernel.run(Scalar::new())
}

/// What a processor computes with.
pub(crate) trait Wide: Simd {
    /// Four numbers.
    type Four: Copy;
    /// Eight numbers.
    type Eight: Copy;

    fn four(self, numbers: [f64; 4]) -> Self::Four;
    fn array4(self, four: Self::Four) -> [f64; 4];
    fn splat4(self, number: f64) -> Self::Four;
    fn add4(self, a: Self::Four, b: Self::Four) -> Self::Four;
    fn sub4(self, a: Self::Four, b: Self::Four) -> Self::Four;
    fn mul4(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// a b + c, rounded once where the processor can.
    fn fma4(self, a: Self::Four, b: Self::Four, c: Self::Four) -> Self::Four;
    /// Exclusive or of the bits.
    fn xor4(self, a: Self::Four, b: Self::Four) -> Self::Four;

    fn eight(self, numbers: [f64; 8]) -> Self::Eight;
    fn array8(self, eight: Self::Eight) -> [f64; 8];
    fn splat8(self, number: f64) -> Self::Eight;
    fn add8(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    fn sub8(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    fn mul8(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// a b + c, rounded once where the processor can.
    fn fma8(self, a: Self::Eight, b: Self::Eight, c: Self::Eight) -> Self::Eight;

    /// Two fours side by side.
    fn join(self, low: Self::Four, high: Self::Four) -> Self::Eight;
    /// In each half, its number `I` four times.
    fn each<const I: usize>(self, a: Self::Eight) -> Self::Eight;
    /// In each half, [y z x w].
    fn next(self, a: Self::Eight) -> Self::Eight;

    /// [x y z x | x y z y].
    fn rows(self, xyz: Self::Four) -> Self::Eight;
    /// [x x x z | y y y z].
    fn columns(self, xyz: Self::Four) -> Self::Eight;
    /// [a₀ + a₄ + a₃, a₁ + a₅ + a₇, a₂ + a₆ + b₂, …]; the last is anything.
    fn folded(self, a: Self::Eight, b: Self::Four) -> Self::Four;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation on whole numbers, which no order of rounding changes.
    struct Everything;

    impl Kernel for Everything {
        type Output = ([[f64; 4]; 7], [[f64; 8]; 13]);

        #[inline(always)]
        fn run<W: Wide>(self, wide: W) -> Self::Output {
            let (a, b, c) = (wide.four([1.0, 2.0, 3.0, 4.0]), wide.four([5.0, -7.0, 11.0, 13.0]), wide.splat4(-2.0));
            let d = wide.eight([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
            let e = wide.eight([9.0, -8.0, 7.0, -6.0, 5.0, -4.0, 3.0, -2.0]);
            let [x, y, z, _] = wide.array4(wide.folded(d, b));
            let sign = wide.xor4(a, wide.four([-0.0, 0.0, -0.0, 0.0]));
            let fours = [wide.add4(a, b), wide.sub4(a, b), wide.mul4(a, b), wide.fma4(a, b, c), sign, c];
            let eights = [
                wide.add8(d, e),
                wide.sub8(d, e),
                wide.mul8(d, e),
                wide.fma8(d, e, d),
                wide.rows(b),
                wide.splat8(3.0),
                wide.join(a, b),
                wide.each::<0>(d),
                wide.each::<1>(d),
                wide.each::<2>(d),
                wide.each::<3>(d),
                wide.next(d),
            ];
            let (mut four, mut eight) = ([[x, y, z, 0.0]; 7], [wide.array8(wide.columns(b)); 13]);
            for (out, value) in four.iter_mut().zip(fours) {
                *out = wide.array4(value);
            }
            for (out, value) in eight.iter_mut().zip(eights) {
                *out = wide.array8(value);
            }
            (four, eight)
        }
    }

    #[test]
    fn all_kinds_of_processors_compute_the_same() {
        let plain = Everything.run(Scalar::new());
        assert_eq!(plain.0[6][..3], [1.0 + 5.0 + 4.0, 2.0 + 6.0 + 8.0, 3.0 + 7.0 + 11.0], "folded");
        assert_eq!(plain.1[8], [2.0, 2.0, 2.0, 2.0, 6.0, 6.0, 6.0, 6.0], "each");
        assert_eq!(plain.1[11], [2.0, 3.0, 1.0, 4.0, 6.0, 7.0, 5.0, 8.0], "next");
        assert_eq!(dispatch(Everything), plain, "the best of this processor");
        #[cfg(target_arch = "x86_64")]
        if let Some(wide) = pulp::x86::V3::try_new() {
            assert_eq!(
                wide.vectorize(
                    #[inline(always)]
                    || Everything.run(wide)
                ),
                plain,
                "without registers of eight"
            );
        }
    }
}
