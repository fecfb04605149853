//! A number with its 95 % interval, as people write it.

use crate::units::significant;

/// Decimals that nobody reads beyond.
const MOST_DECIMALS: i32 = 6;

/// A value with its interval, in one unit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Quantity {
    /// Estimate, in the unit of the quantity.
    pub value: f64,
    /// Lower end of its 95 % interval, in the same unit.
    pub low: f64,
    /// Upper end of its 95 % interval, in the same unit.
    pub high: f64,
}

impl Quantity {
    /// A value with the ends of its 95 % interval, in one unit.
    pub fn new(value: f64, low: f64, high: f64) -> Quantity {
        Quantity { value, low, high }
    }

    /// The quantity as another one that grows or falls with it.
    pub fn map(self, change: impl Fn(f64) -> f64) -> Quantity {
        let (a, b) = (change(self.low), change(self.high));
        Quantity { value: change(self.value), low: a.min(b), high: a.max(b) }
    }

    /// The quantity without its sign: ends change places where the value is negative.
    pub fn size(self) -> Quantity {
        if self.value < 0.0 { self.map(|value| -value) } else { self }
    }

    /// A ratio in words: `12 ± 2 % softer` up to a factor of 2, `9.8 ± 0.1 times softer` beyond it;
    /// of a ratio below 1 its inverse, with the other word.
    pub fn compared(self, above: &str, below: &str) -> String {
        let is_above = self.value >= 1.0;
        let (ratio, word) = if is_above { (self, above) } else { (self.map(|ratio| 1.0 / ratio), below) };
        // as good as rigid, or as nothing: no number says more
        if ratio.value.is_nan() || ratio.value > 1e3 {
            return format!("over 1000 times {word}");
        }
        match ratio.value <= 2.0 {
            true => format!("{} {word}", ratio.map(|ratio| 100.0 * (ratio - 1.0)).with_unit("%")),
            false => format!("{} times {word}", ratio.with_unit("")),
        }
    }

    /// What is read over what should be in words: `12 ± 2 % too high`, `12 ± 2 % too low`, of less
    /// than half or more than twice as [`Quantity::compared`].
    pub fn misread(self) -> String {
        match self.value < 1.0 && self.value >= 0.5 {
            true => self.map(|ratio| 100.0 * (1.0 - ratio)).with_unit("%") + " too low",
            false => self.compared("too high", "too low"),
        }
    }

    /// `1.02 ± 0.04 N`; where a bound cuts the interval off, `0.3 (0 to 0.9) N`.
    pub fn with_unit(&self, unit: &str) -> String {
        let half = (self.high - self.low) / 2.0;
        let unit = if unit.is_empty() || unit == "°" { unit.to_owned() } else { format!(" {unit}") };
        if !(half.is_finite() && half > 0.0) {
            return significant(self.value, 3) + &unit;
        }
        // two digits of what is uncertain where one would be coarse
        let exponent = half.log10().floor() as i32;
        let digits = if half / 10f64.powi(exponent) < 2.0 { 2 } else { 1 };
        let decimals = digits - 1 - exponent;
        if decimals > MOST_DECIMALS {
            return format!("{} ± {}{unit}", significant(self.value, 3), significant(half, 1));
        }
        let decimals = decimals.max(0) as usize;
        // no minus before a zero
        let show = |x: f64| {
            format!("{:.decimals$}", if x.abs() < 0.5 * 10f64.powi(-(decimals as i32)) { 0.0 } else { x })
        };
        let is_even = (self.high + self.low - 2.0 * self.value).abs() <= 0.2 * half;
        match is_even {
            true => format!("{} ± {}{unit}", show(self.value), show(half)),
            false => format!("{} ({} to {}){unit}", show(self.value), show(self.low), show(self.high)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_is_in_percent_up_to_two_and_a_factor_beyond() {
        let words = |value: f64| {
            Quantity { value, low: 0.98 * value, high: 1.02 * value }.compared("softer", "stiffer")
        };
        assert_eq!(words(1.12), "12 ± 2 % softer");
        assert_eq!(words(9.8), "9.80 ± 0.20 times softer");
        assert_eq!(words(0.0), "over 1000 times stiffer");
        assert_eq!(words(0.5), "100 ± 4 % stiffer");
        assert_eq!(words(1.0 / 7.0), "7.00 ± 0.14 times stiffer");
    }

    #[test]
    fn a_reading_that_is_too_low_is_so_by_a_share_of_the_true_one() {
        let words = |value: f64| Quantity { value, low: 0.98 * value, high: 1.02 * value }.misread();
        assert_eq!(words(1.12), "12 ± 2 % too high");
        assert_eq!(words(0.88), "12.0 ± 1.8 % too low");
        assert_eq!(words(0.5), "50.0 ± 1.0 % too low");
        assert_eq!(words(0.25), "4.00 ± 0.08 times too low");
    }

    #[test]
    fn a_value_has_the_digits_of_its_uncertainty() {
        let say = |value, low, high| Quantity { value, low, high }.with_unit("N");
        assert_eq!(say(1.0234, 0.98, 1.06), "1.02 ± 0.04 N");
        assert_eq!(say(1.0234, 0.91, 1.136), "1.02 ± 0.11 N");
        assert_eq!(say(0.31, 0.0, 0.92), "0.3 (0.0 to 0.9) N");
        assert_eq!(say(1234.5, 1200.0, 1269.0), "1234 ± 34 N");
        assert_eq!(say(1e-9, 0.9e-9, 1.1e-9), "1.00e-9 ± 1e-10 N");
        assert_eq!(say(2.0, 2.0, 2.0), "2.00 N");
    }
}
