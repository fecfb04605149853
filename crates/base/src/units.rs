//! SI inside; the constants and conversions of the boundary.
//!
//! Every quantity inside the library is an SI `f64`. Keys of files, columns and JSON carry their
//! unit as a suffix, and these factors turn one into the other: `metres = value_mm * MM`,
//! `value_mm = metres / MM`.

/// One g along an axis, m/s²: the standard acceleration of gravity (3rd CGPM, 1901), exact.
pub const STANDARD_GRAVITY: f64 = 9.80665;
/// A pound-force, N: 0.45359237 kg under [`STANDARD_GRAVITY`] (NIST SP 811, App. B.9).
pub const POUND_FORCE: f64 = 4.448_221_615_260_5;
/// The pound, kg.
pub const POUND: f64 = 0.453_592_37;

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
/// Hour in seconds.
pub const HOUR: f64 = 3600.0;
/// Per cent as a share.
pub const PERCENT: f64 = 0.01;
/// Lowest temperature that there is, °C.
pub const ABSOLUTE_ZERO_C: f64 = -273.15;

/// A unit in which a number is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Unit {
    /// As people write it; empty for a number without one.
    pub symbol: &'static str,
    /// As keys end; empty for a number without one.
    pub suffix: &'static str,
    /// What one of it is in SI.
    pub si: f64,
}

impl Unit {
    /// Of a number without a unit.
    pub const NONE: Unit = Unit { symbol: "", suffix: "", si: 1.0 };
    /// All that keys end with; of several that fit the longest is meant.
    const ALL: [Unit; 33] = [
        Unit { symbol: "1/rev", suffix: "cycles_per_rev", si: 1.0 },
        Unit { symbol: "1/decade", suffix: "per_decade", si: 1.0 },
        Unit { symbol: "µrad/(N·m)³", suffix: "urad_per_nm3", si: URAD },
        Unit { symbol: "µrad/(N·m)²", suffix: "urad_per_nm2", si: URAD },
        Unit { symbol: "µrad/(N·m)", suffix: "urad_per_nm", si: URAD_PER_NM },
        Unit { symbol: "µm/(m·K)", suffix: "um_per_m_per_k", si: UM },
        Unit { symbol: "µm/(m·h)", suffix: "um_per_m_per_h", si: UM / HOUR },
        Unit { symbol: "µrad/m", suffix: "urad_per_m", si: URAD },
        Unit { symbol: "µm/m", suffix: "um_per_m", si: UM },
        Unit { symbol: "µrad/rad", suffix: "urad_per_rad", si: URAD },
        Unit { symbol: "N/mm", suffix: "n_per_mm", si: 1.0 / MM },
        Unit { symbol: "1/N²", suffix: "per_n2", si: 1.0 },
        Unit { symbol: "µm/N", suffix: "um_per_n", si: UM },
        Unit { symbol: "1/N", suffix: "per_n", si: 1.0 },
        Unit { symbol: "µm/K", suffix: "um_per_k", si: UM },
        Unit { symbol: "µm/h", suffix: "um_per_h", si: UM / HOUR },
        Unit { symbol: "µrad/K", suffix: "urad_per_k", si: URAD },
        Unit { symbol: "µrad/h", suffix: "urad_per_h", si: URAD / HOUR },
        Unit { symbol: "1/K", suffix: "per_k", si: 1.0 },
        Unit { symbol: "rad", suffix: "rad", si: 1.0 },
        Unit { symbol: "µrad", suffix: "urad", si: URAD },
        Unit { symbol: "°", suffix: "deg", si: DEG },
        Unit { symbol: "µm", suffix: "um", si: UM },
        Unit { symbol: "mm", suffix: "mm", si: MM },
        Unit { symbol: "m", suffix: "m", si: 1.0 },
        Unit { symbol: "%", suffix: "percent", si: 0.01 },
        Unit { symbol: "kg", suffix: "kg", si: 1.0 },
        Unit { symbol: "g", suffix: "g", si: GRAM },
        Unit { symbol: "N·m", suffix: "nm", si: 1.0 },
        Unit { symbol: "N", suffix: "n", si: 1.0 },
        Unit { symbol: "s", suffix: "s", si: 1.0 },
        Unit { symbol: "K", suffix: "k", si: 1.0 },
        Unit { symbol: "Hz", suffix: "hz", si: 1.0 },
    ];

    /// The unit that a key ends with: of `play_um` the micrometre, of `um` too.
    ///
    /// ```
    /// use rodcal_base::units::Unit;
    ///
    /// assert_eq!(Unit::of_key("bending_urad_per_nm").symbol, "µrad/(N·m)");
    /// assert_eq!(Unit::of_key("play_um").si, 1e-6);
    /// assert_eq!(Unit::of_key("factor"), Unit::NONE);
    /// ```
    pub fn of_key(key: &str) -> Unit {
        let ends = |unit: &&Unit| {
            key.strip_suffix(unit.suffix).is_some_and(|rest| rest.is_empty() || rest.ends_with('_'))
        };
        Unit::ALL.iter().filter(ends).max_by_key(|unit| unit.suffix.len()).copied().unwrap_or(Unit::NONE)
    }

    /// The same unit for numbers that are kept as they stand in a file, not in SI.
    pub fn as_written(self) -> Unit {
        Unit { si: 1.0, ..self }
    }
}

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

/// Less is written with a power of ten.
const LEAST_UNCERTAINTY: f64 = 1e-9;

/// Decimals that two significant digits of an uncertainty take (GUM, JCGM 100:2008, 7.2.6); `None`
/// of what is no uncertainty, or too small to be written without a power of ten.
pub fn decimals_of(uncertainty: f64) -> Option<usize> {
    let is_one = uncertainty >= LEAST_UNCERTAINTY && uncertainty.is_finite();
    is_one.then(|| (1 - uncertainty.log10().floor() as i32).max(0) as usize)
}

/// With so many decimals; no minus before a zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    let number = format!("{value:.decimals$}");
    let is_zero = !number.chars().any(|c| ('1'..='9').contains(&c));
    if is_zero { number.trim_start_matches('-').to_owned() } else { number }
}

/// Words at the beginning of a sentence.
pub fn capital(words: impl ToString) -> String {
    let words = words.to_string();
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The words of a sentence in the midst of another one.
pub fn uncapital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// `33.02 ± 0.18`: the uncertainty to two significant digits, the value to the same place; without
/// an uncertainty the value to so many digits.
///
/// ```
/// use rodcal_base::units::with_uncertainty;
///
/// assert_eq!(with_uncertainty(33.0213, 0.183, 5), "33.02 ± 0.18");
/// assert_eq!(with_uncertainty(33.0213, 0.0, 5), "33.021");
/// ```
pub fn with_uncertainty(value: f64, uncertainty: f64, digits: usize) -> String {
    match decimals_of(uncertainty) {
        Some(decimals) => format!("{} ± {}", fixed(value, decimals), fixed(uncertainty, decimals)),
        None => significant(value, digits),
    }
}

/// A value and the ends of its interval, to the place of the second digit of half its width; of an
/// interval without a width to so many digits.
///
/// ```
/// use rodcal_base::units::with_ends;
///
/// assert_eq!(with_ends([-1.068, -5.18, 7.83], 3), ["-1.1", "-5.2", "7.8"]);
/// assert_eq!(with_ends([1.5, 1.5, 1.5], 3), ["1.50", "1.50", "1.50"]);
/// ```
pub fn with_ends([value, low, high]: [f64; 3], digits: usize) -> [String; 3] {
    let decimals = decimals_of((high - low) / 2.0);
    [value, low, high].map(|x| decimals.map_or_else(|| significant(x, digits), |decimals| fixed(x, decimals)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_ends_where_its_uncertainty_ends() {
        assert_eq!(with_uncertainty(0.0041233, 6.6e-6, 4), "0.0041233 ± 0.0000066");
        assert_eq!(with_uncertainty(1234.5, 183.0, 4), "1234 ± 183");
        assert_eq!(with_uncertainty(-0.004, 0.13, 4), "0.00 ± 0.13");
        assert_eq!(with_uncertainty(1.651e-14, 3e-15, 4), "1.651e-14");
        for none in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(with_uncertainty(33.0213, none, 3), "33.0");
        }
    }

    #[test]
    fn significant_digits_are_those_a_reader_expects() {
        assert_eq!(significant(0.0123456, 3), "0.0123");
        assert_eq!(significant(1234.6, 3), "1235");
        assert_eq!(significant(-47.711141, 5), "-47.711");
        assert_eq!(significant(1.5e-9, 2), "1.5e-9");
        assert_eq!(significant(0.0, 3), "0");
    }
}
