//! Registers of four and of eight numbers, whatever the processor has, and the choice of the best at run time.
//!
//! Every operation is the one of the standard for each number, so results are the same whether there are four or eight
//! at once. A product with a sum is rounded once on x86-64 processors with AVX2 (since 2013) and twice on all others,
//! which therefore differ in the last digit.

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

impl Wide for Scalar {
    type Four = [f64; 4];
    type Eight = [f64; 8];

    #[inline(always)]
    fn four(self, numbers: [f64; 4]) -> [f64; 4] {
        numbers
    }

    #[inline(always)]
    fn array4(self, four: [f64; 4]) -> [f64; 4] {
        four
    }

    #[inline(always)]
    fn splat4(self, number: f64) -> [f64; 4] {
        [number; 4]
    }

    #[inline(always)]
    fn add4(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|l| a[l] + b[l])
    }

    #[inline(always)]
    fn sub4(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|l| a[l] - b[l])
    }

    #[inline(always)]
    fn mul4(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|l| a[l] * b[l])
    }

    #[inline(always)]
    fn fma4(self, a: [f64; 4], b: [f64; 4], c: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|l| a[l] * b[l] + c[l])
    }

    #[inline(always)]
    fn fma8(self, a: [f64; 8], b: [f64; 8], c: [f64; 8]) -> [f64; 8] {
        std::array::from_fn(|l| a[l] * b[l] + c[l])
    }

    #[inline(always)]
    fn xor4(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|l| f64::from_bits(a[l].to_bits() ^ b[l].to_bits()))
    }

    #[inline(always)]
    fn eight(self, numbers: [f64; 8]) -> [f64; 8] {
        numbers
    }

    #[inline(always)]
    fn array8(self, eight: [f64; 8]) -> [f64; 8] {
        eight
    }

    #[inline(always)]
    fn splat8(self, number: f64) -> [f64; 8] {
        [number; 8]
    }

    #[inline(always)]
    fn add8(self, a: [f64; 8], b: [f64; 8]) -> [f64; 8] {
        std::array::from_fn(|l| a[l] + b[l])
    }

    #[inline(always)]
    fn sub8(self, a: [f64; 8], b: [f64; 8]) -> [f64; 8] {
        std::array::from_fn(|l| a[l] - b[l])
    }

    #[inline(always)]
    fn mul8(self, a: [f64; 8], b: [f64; 8]) -> [f64; 8] {
        std::array::from_fn(|l| a[l] * b[l])
    }

    #[inline(always)]
    fn join(self, [a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4]) -> [f64; 8] {
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    fn each<const I: usize>(self, a: [f64; 8]) -> [f64; 8] {
        std::array::from_fn(|l| a[l / 4 * 4 + I])
    }

    #[inline(always)]
    fn next(self, [x, y, z, w, a, b, c, d]: [f64; 8]) -> [f64; 8] {
        [y, z, x, w, b, c, a, d]
    }

    #[inline(always)]
    fn rows(self, [x, y, z, _]: [f64; 4]) -> [f64; 8] {
        [x, y, z, x, x, y, z, y]
    }

    #[inline(always)]
    fn columns(self, [x, y, z, _]: [f64; 4]) -> [f64; 8] {
        [x, x, x, z, y, y, y, z]
    }

    #[inline(always)]
    fn folded(self, a: [f64; 8], b: [f64; 4]) -> [f64; 4] {
        [a[0] + a[4] + a[3], a[1] + a[5] + a[7], a[2] + a[6] + b[2], 0.0]
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::{__m256d, __m512d};

    use pulp::cast;
    use pulp::x86::{V3, V4};

    use super::Wide;

    /// What both have in common.
    macro_rules! fours {
        () => {
            type Four = __m256d;

            #[inline(always)]
            fn four(self, numbers: [f64; 4]) -> __m256d {
                cast(numbers)
            }

            #[inline(always)]
            fn array4(self, four: __m256d) -> [f64; 4] {
                cast(four)
            }

            #[inline(always)]
            fn splat4(self, number: f64) -> __m256d {
                self.avx._mm256_set1_pd(number)
            }

            #[inline(always)]
            fn add4(self, a: __m256d, b: __m256d) -> __m256d {
                self.avx._mm256_add_pd(a, b)
            }

            #[inline(always)]
            fn sub4(self, a: __m256d, b: __m256d) -> __m256d {
                self.avx._mm256_sub_pd(a, b)
            }

            #[inline(always)]
            fn mul4(self, a: __m256d, b: __m256d) -> __m256d {
                self.avx._mm256_mul_pd(a, b)
            }

            #[inline(always)]
            fn fma4(self, a: __m256d, b: __m256d, c: __m256d) -> __m256d {
                self.fma._mm256_fmadd_pd(a, b, c)
            }

            #[inline(always)]
            fn xor4(self, a: __m256d, b: __m256d) -> __m256d {
                self.avx._mm256_xor_pd(a, b)
            }
        };
    }

    impl Wide for V3 {
        fours!();
        type Eight = [__m256d; 2];

        #[inline(always)]
        fn eight(self, [a, b, c, d, e, f, g, h]: [f64; 8]) -> [__m256d; 2] {
            [cast([a, b, c, d]), cast([e, f, g, h])]
        }

        #[inline(always)]
        fn array8(self, [low, high]: [__m256d; 2]) -> [f64; 8] {
            let ([a, b, c, d], [e, f, g, h]): ([f64; 4], [f64; 4]) = (cast(low), cast(high));
            [a, b, c, d, e, f, g, h]
        }

        #[inline(always)]
        fn splat8(self, number: f64) -> [__m256d; 2] {
            [self.splat4(number); 2]
        }

        #[inline(always)]
        fn add8(self, a: [__m256d; 2], b: [__m256d; 2]) -> [__m256d; 2] {
            [self.add4(a[0], b[0]), self.add4(a[1], b[1])]
        }

        #[inline(always)]
        fn sub8(self, a: [__m256d; 2], b: [__m256d; 2]) -> [__m256d; 2] {
            [self.sub4(a[0], b[0]), self.sub4(a[1], b[1])]
        }

        #[inline(always)]
        fn mul8(self, a: [__m256d; 2], b: [__m256d; 2]) -> [__m256d; 2] {
            [self.mul4(a[0], b[0]), self.mul4(a[1], b[1])]
        }

        #[inline(always)]
        fn fma8(self, a: [__m256d; 2], b: [__m256d; 2], c: [__m256d; 2]) -> [__m256d; 2] {
            [self.fma4(a[0], b[0], c[0]), self.fma4(a[1], b[1], c[1])]
        }

        #[inline(always)]
        fn join(self, low: __m256d, high: __m256d) -> [__m256d; 2] {
            [low, high]
        }

        #[inline(always)]
        fn each<const I: usize>(self, a: [__m256d; 2]) -> [__m256d; 2] {
            let avx2 = self.avx2;
            // Not a map: closures are not compiled for the processor.
            let [low, high] = a;
            match I {
                0 => [
                    avx2._mm256_permute4x64_pd::<0b00_00_00_00>(low),
                    avx2._mm256_permute4x64_pd::<0b00_00_00_00>(high),
                ],
                1 => [
                    avx2._mm256_permute4x64_pd::<0b01_01_01_01>(low),
                    avx2._mm256_permute4x64_pd::<0b01_01_01_01>(high),
                ],
                2 => [
                    avx2._mm256_permute4x64_pd::<0b10_10_10_10>(low),
                    avx2._mm256_permute4x64_pd::<0b10_10_10_10>(high),
                ],
                _ => [
                    avx2._mm256_permute4x64_pd::<0b11_11_11_11>(low),
                    avx2._mm256_permute4x64_pd::<0b11_11_11_11>(high),
                ],
            }
        }

        #[inline(always)]
        fn next(self, [low, high]: [__m256d; 2]) -> [__m256d; 2] {
            let avx2 = self.avx2;
            [avx2._mm256_permute4x64_pd::<0b11_00_10_01>(low), avx2._mm256_permute4x64_pd::<0b11_00_10_01>(high)]
        }

        #[inline(always)]
        fn rows(self, xyz: __m256d) -> [__m256d; 2] {
            let avx2 = self.avx2;
            [avx2._mm256_permute4x64_pd::<0b00_10_01_00>(xyz), avx2._mm256_permute4x64_pd::<0b01_10_01_00>(xyz)]
        }

        #[inline(always)]
        fn columns(self, xyz: __m256d) -> [__m256d; 2] {
            let avx2 = self.avx2;
            [avx2._mm256_permute4x64_pd::<0b10_00_00_00>(xyz), avx2._mm256_permute4x64_pd::<0b10_01_01_01>(xyz)]
        }

        #[inline(always)]
        fn folded(self, [low, high]: [__m256d; 2], b: __m256d) -> __m256d {
            let fourths = self.avx._mm256_unpackhi_pd(low, high);
            let fourths = self.avx2._mm256_permute4x64_pd::<0b11_10_11_10>(fourths);
            self.add4(self.add4(low, high), self.avx._mm256_blend_pd::<0b1100>(fourths, b))
        }
    }

    impl Wide for V4 {
        fours!();
        type Eight = __m512d;

        #[inline(always)]
        fn eight(self, numbers: [f64; 8]) -> __m512d {
            cast(numbers)
        }

        #[inline(always)]
        fn array8(self, eight: __m512d) -> [f64; 8] {
            cast(eight)
        }

        #[inline(always)]
        fn splat8(self, number: f64) -> __m512d {
            self.avx512f._mm512_set1_pd(number)
        }

        #[inline(always)]
        fn add8(self, a: __m512d, b: __m512d) -> __m512d {
            self.avx512f._mm512_add_pd(a, b)
        }

        #[inline(always)]
        fn sub8(self, a: __m512d, b: __m512d) -> __m512d {
            self.avx512f._mm512_sub_pd(a, b)
        }

        #[inline(always)]
        fn mul8(self, a: __m512d, b: __m512d) -> __m512d {
            self.avx512f._mm512_mul_pd(a, b)
        }

        #[inline(always)]
        fn fma8(self, a: __m512d, b: __m512d, c: __m512d) -> __m512d {
            self.avx512f._mm512_fmadd_pd(a, b, c)
        }

        #[inline(always)]
        fn join(self, low: __m256d, high: __m256d) -> __m512d {
            self.avx512f._mm512_insertf64x4::<1>(self.avx512f._mm512_castpd256_pd512(low), high)
        }

        #[inline(always)]
        fn each<const I: usize>(self, a: __m512d) -> __m512d {
            match I {
                0 => self.avx512f._mm512_permutex_pd::<0b00_00_00_00>(a),
                1 => self.avx512f._mm512_permutex_pd::<0b01_01_01_01>(a),
                2 => self.avx512f._mm512_permutex_pd::<0b10_10_10_10>(a),
                _ => self.avx512f._mm512_permutex_pd::<0b11_11_11_11>(a),
            }
        }

        #[inline(always)]
        fn next(self, a: __m512d) -> __m512d {
            self.avx512f._mm512_permutex_pd::<0b11_00_10_01>(a)
        }

        #[inline(always)]
        fn rows(self, xyz: __m256d) -> __m512d {
            let order = cast([0u64, 1, 2, 0, 0, 1, 2, 1]);
            self.avx512f._mm512_permutexvar_pd(order, self.avx512f._mm512_castpd256_pd512(xyz))
        }

        #[inline(always)]
        fn columns(self, xyz: __m256d) -> __m512d {
            let order = cast([0u64, 0, 0, 2, 1, 1, 1, 2]);
            self.avx512f._mm512_permutexvar_pd(order, self.avx512f._mm512_castpd256_pd512(xyz))
        }

        #[inline(always)]
        fn folded(self, a: __m512d, b: __m256d) -> __m256d {
            let low = self.avx512f._mm512_castpd512_pd256(a);
            let high = self.avx512f._mm512_extractf64x4_pd::<1>(a);
            let fourths = self.avx._mm256_unpackhi_pd(low, high);
            let fourths = self.avx2._mm256_permute4x64_pd::<0b11_10_11_10>(fourths);
            self.add4(self.add4(low, high), self.avx._mm256_blend_pd::<0b1100>(fourths, b))
        }
    }
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
