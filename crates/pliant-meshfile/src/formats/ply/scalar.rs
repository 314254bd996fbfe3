//! The number types of PLY.

/// A number type. Double precision holds every value of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    /// By the first names of the format or those that tell the size.
    pub(super) fn of(word: &[u8]) -> Option<Scalar> {
        Some(match word {
            b"char" | b"int8" => Scalar::I8,
            b"uchar" | b"uint8" => Scalar::U8,
            b"short" | b"int16" => Scalar::I16,
            b"ushort" | b"uint16" => Scalar::U16,
            b"int" | b"int32" => Scalar::I32,
            b"uint" | b"uint32" => Scalar::U32,
            b"float" | b"float32" => Scalar::F32,
            b"double" | b"float64" => Scalar::F64,
            _ => return None,
        })
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Scalar::I8 => "char",
            Scalar::U8 => "uchar",
            Scalar::I16 => "short",
            Scalar::U16 => "ushort",
            Scalar::I32 => "int",
            Scalar::U32 => "uint",
            Scalar::F32 => "float",
            Scalar::F64 => "double",
        }
    }

    /// Bytes of a number in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    /// The lowest and highest number, of types of whole numbers.
    pub(super) fn whole_range(self) -> Option<[f64; 2]> {
        Some(match self {
            Scalar::I8 => [i8::MIN.into(), i8::MAX.into()],
            Scalar::U8 => [0.0, u8::MAX.into()],
            Scalar::I16 => [i16::MIN.into(), i16::MAX.into()],
            Scalar::U16 => [0.0, u16::MAX.into()],
            Scalar::I32 => [i32::MIN.into(), i32::MAX.into()],
            Scalar::U32 => [0.0, u32::MAX.into()],
            Scalar::F32 | Scalar::F64 => return None,
        })
    }

    /// Whether a number can be stored: whole and in range, or finite after rounding.
    pub(super) fn holds(self, x: f64) -> bool {
        match self.whole_range() {
            Some([low, high]) => x.fract() == 0.0 && (low..=high).contains(&x),
            None if self == Scalar::F32 => (x as f32).is_finite(),
            None => x.is_finite(),
        }
    }

    /// The number in the first bytes of a slice of at least [`Scalar::size`].
    pub(super) fn read(self, bytes: &[u8], big: bool) -> f64 {
        let mut raw = [0; 8];
        let size = self.size();
        raw[..size].copy_from_slice(&bytes[..size]);
        if big {
            raw[..size].reverse();
        }
        let [a, b, c, d, ..] = raw;
        match self {
            Scalar::I8 => f64::from(a as i8),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(raw),
        }
    }

    /// Appends a number as it stands in a binary file; one that is out of range becomes the nearest.
    pub(super) fn write(self, x: f64, big: bool, out: &mut Vec<u8>) {
        let start = out.len();
        match self {
            Scalar::I8 => out.extend((x as i8).to_le_bytes()),
            Scalar::U8 => out.extend((x as u8).to_le_bytes()),
            Scalar::I16 => out.extend((x as i16).to_le_bytes()),
            Scalar::U16 => out.extend((x as u16).to_le_bytes()),
            Scalar::I32 => out.extend((x as i32).to_le_bytes()),
            Scalar::U32 => out.extend((x as u32).to_le_bytes()),
            Scalar::F32 => out.extend((x as f32).to_le_bytes()),
            Scalar::F64 => out.extend(x.to_le_bytes()),
        }
        if big {
            out[start..].reverse();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Scalar; 8] =
        [Scalar::I8, Scalar::U8, Scalar::I16, Scalar::U16, Scalar::I32, Scalar::U32, Scalar::F32, Scalar::F64];

    #[test]
    fn every_type_reads_what_it_wrote_in_both_orders() {
        for scalar in ALL {
            let [low, high] = scalar.whole_range().unwrap_or([-0.5, 1048576.25]);
            for (x, big) in [(low, false), (high, false), (low, true), (high, true), (1.0, true)] {
                let mut bytes = Vec::new();
                scalar.write(x, big, &mut bytes);
                assert_eq!(bytes.len(), scalar.size(), "{scalar:?}");
                assert_eq!(scalar.read(&bytes, big), x, "{scalar:?}, big {big}");
                assert!(scalar.holds(x), "{scalar:?} {x}");
            }
            assert_eq!(Scalar::of(scalar.name().as_bytes()), Some(scalar));
        }
    }

    #[test]
    fn numbers_that_do_not_fit_are_told() {
        for (scalar, x) in [(Scalar::U8, 256.0), (Scalar::U8, -1.0), (Scalar::I32, 0.5), (Scalar::F32, 1e39)] {
            assert!(!scalar.holds(x), "{scalar:?} {x}");
        }
    }
}
