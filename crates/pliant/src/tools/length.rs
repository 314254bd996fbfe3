//! Lengths as text.

/// Digits shown of a length as large as the model (by eye).
const DIGITS: i32 = 5;

/// A length with as many decimals as make sense for a model of this diagonal, so that it keeps its width while it
/// changes; powers of ten where the model is very small or very large.
pub fn length(value: f64, diagonal: f64) -> String {
    let size = diagonal.log10();
    if !(-3.0..7.0).contains(&size) {
        return format!("{value:.3e}");
    }
    let decimals = (DIGITS - 1 - size.floor() as i32).clamp(0, 8);
    fixed(value, decimals as usize)
}

/// A number with so many decimals; what rounds to zero has no sign.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if !digits.contains(|c| ('1'..='9').contains(&c)) => digits.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::length;

    #[test]
    fn lengths_have_the_digits_that_suit_the_model() {
        for (value, diagonal, expected) in [
            (0.25, 1.7, "0.2500"),
            (-3.0, 40.0, "-3.000"),
            (12.0, 3.0e4, "12"),
            (0.25, 0.02, "0.250000"),
            (2.5e-9, 1e-8, "2.500e-9"),
            (2.5e9, 1e10, "2.500e9"),
            (1.0, 0.0, "1.000e0"),
            (-1e-9, 1.7, "0.0000"),
        ] {
            assert_eq!(length(value, diagonal), expected);
        }
    }
}
