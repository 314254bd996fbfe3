//! Three coordinates and a lane of nothing: one vector register.

use glam::DVec3;

/// x, y, z and a fourth number that is 0 unless stated otherwise; aligned so that it loads as one register.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Quad(pub(crate) [f64; 4]);

impl Quad {
    pub(crate) const ZERO: Quad = Quad([0.0; 4]);

    /// The three coordinates.
    #[inline]
    pub(crate) fn xyz(self) -> DVec3 {
        let [x, y, z, _] = self.0;
        DVec3::new(x, y, z)
    }
}

impl From<DVec3> for Quad {
    #[inline]
    fn from(v: DVec3) -> Quad {
        Quad([v.x, v.y, v.z, 0.0])
    }
}
