//! Plain numbers, for processors of which nothing is known.

use pulp::Scalar;

use super::Wide;

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
