//! What elements of mode ATTRIBUTES may stand for: each is replaced in place, number by number.
//!
//! Elements that no writer may write (a one of zero) give some number or other, never a panic: conversions saturate.

/// Unit vectors as points of an octahedron laid flat: x and y over the third number, which stands for one.
pub(super) fn octahedral(bytes: &mut [u8], stride: usize) {
    each_signed(bytes, stride, |[x, y, one, rest], most| {
        let [x, y] = [x, y].map(|v| v as f32 / one as f32);
        let z = 1.0 - x.abs() - y.abs();
        // The lower half is folded out.
        let beyond = (-z).max(0.0);
        let [x, y] = [x, y].map(|v| v - beyond.copysign(v));
        let length = (x * x + y * y + z * z).sqrt();
        let number = |v: f32| (v / length * most).round() as i32;
        [number(x), number(y), number(z), rest]
    });
}

/// Unit quaternions without their largest component, which is positive; the last number names it and stands for one.
pub(super) fn quaternion(bytes: &mut [u8]) {
    each_signed(bytes, 8, |[x, y, z, last], most| {
        let one = (last | 3) as f32;
        let [x, y, z] = [x, y, z].map(|v| v as f32 / one * std::f32::consts::FRAC_1_SQRT_2);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        let mut turned = [w, x, y, z].map(|v| (v * most).round() as i32);
        turned.rotate_right((last & 3) as usize);
        turned
    });
}

/// Floating-point numbers of 24 bits and an exponent of 8.
pub(super) fn exponential(bytes: &mut [u8]) {
    for number in bytes.chunks_exact_mut(4) {
        let bits = i32::from_le_bytes([number[0], number[1], number[2], number[3]]);
        // Writers keep to ±100; within ±126 the power is a normal number and the product exact.
        let exponent = (bits >> 24).clamp(-126, 126);
        let power = f32::from_bits(((exponent + 127) as u32) << 23);
        number.copy_from_slice(&((bits << 8 >> 8) as f32 * power).to_le_bytes());
    }
}

/// Colors as lightness, two differences and an opacity, whose highest bit tells how many bits all have.
pub(super) fn color(bytes: &mut [u8], stride: usize) {
    let unmix = |[y, orange, green, opacity]: [i32; 4], most: f32| {
        let scale = ((1i64 << (32 - (opacity as u32).leading_zeros())) - 1) as i32;
        let opacity = opacity & scale >> 1;
        let opacity = opacity << 1 | opacity & 1;
        let [red, blue] = [y + orange - green, y - orange - green];
        [red, y + green, blue, opacity].map(|v| (v as f32 * (most / scale as f32)).round() as i32)
    };
    for element in bytes.chunks_exact_mut(stride) {
        if let [y, orange, green, opacity] = *element {
            let signed = |byte: u8| i32::from(byte as i8);
            let new = unmix([y.into(), signed(orange), signed(green), opacity.into()], 255.0);
            element.copy_from_slice(&new.map(|v| v.clamp(0, 255) as u8));
        } else {
            let [y, orange, green, opacity] = halves(element);
            let unsigned = |v: i32| i32::from(v as u16);
            let new = unmix([unsigned(y), orange, green, unsigned(opacity)], 65535.0);
            put(element, new.map(|v| v.clamp(0, 65535) as u16));
        }
    }
}

/// Replaces elements of four signed numbers, of 8 bits for a stride of four and of 16 for one of eight; the function
/// also gets the number that stands for 1.
fn each_signed(bytes: &mut [u8], stride: usize, new: impl Fn([i32; 4], f32) -> [i32; 4]) {
    for element in bytes.chunks_exact_mut(stride) {
        if let [a, b, c, d] = *element {
            let new = new([a, b, c, d].map(|byte| i32::from(byte as i8)), 127.0);
            element.copy_from_slice(&new.map(|v| v.clamp(-128, 127) as u8));
        } else {
            put(element, new(halves(element), 32767.0).map(|v| v.clamp(-32768, 32767) as u16));
        }
    }
}

/// The four signed numbers of 16 bits in an element of eight bytes.
fn halves(element: &[u8]) -> [i32; 4] {
    [0, 2, 4, 6].map(|k| i32::from(i16::from_le_bytes([element[k], element[k + 1]])))
}

fn put(element: &mut [u8], numbers: [u16; 4]) {
    for (slot, number) in element.chunks_exact_mut(2).zip(numbers) {
        slot.copy_from_slice(&number.to_le_bytes());
    }
}
