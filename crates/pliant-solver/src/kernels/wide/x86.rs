//! Registers of x86-64: four at once with AVX2 (V3), eight with AVX-512 (V4).

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
            0 => [avx2._mm256_permute4x64_pd::<0b00_00_00_00>(low), avx2._mm256_permute4x64_pd::<0b00_00_00_00>(high)],
            1 => [avx2._mm256_permute4x64_pd::<0b01_01_01_01>(low), avx2._mm256_permute4x64_pd::<0b01_01_01_01>(high)],
            2 => [avx2._mm256_permute4x64_pd::<0b10_10_10_10>(low), avx2._mm256_permute4x64_pd::<0b10_10_10_10>(high)],
            _ => [avx2._mm256_permute4x64_pd::<0b11_11_11_11>(low), avx2._mm256_permute4x64_pd::<0b11_11_11_11>(high)],
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
