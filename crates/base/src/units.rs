//! SI inside; the constants and conversions of the boundary.
//!
//! Every quantity inside the library is an SI `f64`. Keys of files, columns and JSON carry their
//! unit as a suffix, and these factors turn one into the other: `metres = value_mm * MM`,
//! `value_mm = metres / MM`.

/// One g along an axis, m/s²: the standard acceleration of gravity (3rd CGPM, 1901), exact.
pub const STANDARD_GRAVITY: f64 = 9.80665;

/// Millimetre in metres.
pub const MM: f64 = 1e-3;
/// Micrometre in metres.
pub const UM: f64 = 1e-6;
/// Gram in kilograms.
pub const GRAM: f64 = 1e-3;
/// Gigapascal in pascals.
pub const GPA: f64 = 1e9;
/// Pascals in a megapascal.
pub const MPA: f64 = 1e6;
/// Degree in radians.
pub const DEG: f64 = std::f64::consts::PI / 180.0;
/// Microradian in radians.
pub const URAD: f64 = 1e-6;
/// µrad/(N·m) in rad/(N·m).
pub const URAD_PER_NM: f64 = 1e-6;

/// Shows a number with `digits` significant digits, without an exponent where a reader would not
/// expect one.
///
/// `significant(0.0123456, 3)` is "0.0123"; `significant(1234.6, 3)` is "1235" (digits before the
/// point are kept).
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..9).contains(&exponent) {
        return format!("{value:.*e}", digits.saturating_sub(1));
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_are_those_a_reader_expects() {
        assert_eq!(significant(0.0123456, 3), "0.0123");
        assert_eq!(significant(1234.6, 3), "1235");
        assert_eq!(significant(-47.711141, 5), "-47.711");
        assert_eq!(significant(1.5e-9, 2), "1.5e-9");
        assert_eq!(significant(0.0, 3), "0");
    }
}
