//! Axis ranges and tick labels a reader would have chosen by hand.

/// A range with its ticks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scale {
    /// Left or lower end.
    pub(super) from: f64,
    /// Right or upper end; always greater than `from`.
    pub(super) to: f64,
    /// Value and label of each tick, ascending, all within the range.
    pub(super) ticks: Vec<(f64, String)>,
    /// Whether equal ratios, not equal differences, are equally long; then `from` is above zero.
    pub(super) log: bool,
    /// Tick labels are values over this power of ten.
    pub(super) power: i32,
}

impl Scale {
    /// From `from` to `to` as they are, with about `count` ticks between them.
    pub(super) fn fixed(from: f64, to: f64, count: usize) -> Scale {
        let (from, to) = proper(from, to);
        Scale { from, to, ticks: linear_ticks(from, to, step(to - from, count)), log: false, power: 0 }
    }

    /// Rounded outwards to whole steps. A side whose data ends at zero ends at zero.
    pub(super) fn rounded(from: f64, to: f64, count: usize) -> Scale {
        let (from, to) = proper(from, to);
        let step = step(to - from, count);
        // Data on the very edge of the frame would be hard to see, data just inside a tick is not.
        let air = 0.02 * (to - from);
        let lower = if from == 0.0 { 0.0 } else { ((from - air) / step).floor() * step };
        let upper = if to == 0.0 { 0.0 } else { ((to + air) / step).ceil() * step };
        Scale { from: lower, to: upper, ticks: linear_ticks(lower, upper, step), log: false, power: 0 }
    }

    /// Logarithmic from `from` to `to` as they are, with at most about `count` ticks: at powers of
    /// ten, and at two and five times them where there are only few.
    pub(super) fn log(from: f64, to: f64, count: usize) -> Scale {
        let (from, to) = proper_ratio(from, to);
        Scale { from, to, ticks: log_ticks(from, to, count), log: true, power: 0 }
    }

    /// Logarithmic, rounded outwards to 1, 2 or 5 times a power of ten.
    pub(super) fn log_rounded(from: f64, to: f64, count: usize) -> Scale {
        let (from, to) = proper_ratio(from, to);
        // Air for what would stand on the very edge of the frame.
        let air = (to / from).powf(0.02);
        let (from, to) = (from / air, to * air);
        let lower = one_two_five_below(from);
        // 2.5 times a 1-2-5 number reaches the next one and no further.
        let below = one_two_five_below(to);
        let upper = if below >= to * (1.0 - 1e-9) { below } else { one_two_five_below(2.5 * below) };
        Scale::log(lower, upper, count)
    }

    /// Whether a value has a place on this axis, be it beyond its ends.
    pub(super) fn places(&self, value: f64) -> bool {
        drawable(value) && (!self.log || value > 0.0)
    }

    /// The same range with another distance between ticks, where that makes sense.
    pub(super) fn with_step(self, step: Option<f64>) -> Scale {
        match step.filter(|step| !self.log && (1.0..50.0).contains(&((self.to - self.from) / step))) {
            Some(step) => Scale { ticks: linear_ticks(self.from, self.to, step), ..self },
            None => self,
        }
    }

    /// Where `value` lies between the ends, 0 to 1 (outside of them: beyond).
    pub(super) fn fraction(&self, value: f64) -> f64 {
        match self.log {
            // Zero and less are infinitely far below.
            true => (value.max(0.0) / self.from).log10() / (self.to / self.from).log10(),
            false => (value - self.from) / (self.to - self.from),
        }
    }
}

/// Whether a number can be drawn at all. Beyond 1e200 differences and products overflow.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() < 1e200
}

/// The smallest and the largest of some values; `None` where there are none.
pub(super) type Extent = Option<(f64, f64)>;

/// The smallest and the largest drawable value.
pub(super) fn extent(values: impl IntoIterator<Item = f64>) -> Extent {
    values.into_iter().filter(|v| drawable(*v)).fold(None, |range, v| match range {
        None => Some((v, v)),
        Some((low, high)) => Some((f64::min(low, v), f64::max(high, v))),
    })
}

/// The largest of …, 0.1, 0.2, 0.5, 1, 2, 5, 10, … that is not above `value`; 1 where there is
/// none.
pub(super) fn one_two_five_below(value: f64) -> f64 {
    if !(drawable(value) && value > 1e-200) {
        return 1.0;
    }
    let exponent = value.log10().floor() as i32;
    // The tolerance keeps 0.3 / 0.1 = 2.999… and log10(1000) = 2.999… on the right side.
    let mantissa = value / power_of_ten(exponent) * (1.0 + 1e-9);
    let (digit, carry) = match mantissa {
        m if m >= 10.0 => (1.0, 1),
        m if m >= 5.0 => (5.0, 0),
        m if m >= 2.0 => (2.0, 0),
        _ => (1.0, 0),
    };
    digit * power_of_ten(exponent + carry)
}

/// A number with the true minus sign and thin spaces between thousands from 10 000 on; anything
/// that does not begin like a number stays as it is.
pub(super) fn typeset(number: &str) -> String {
    let (sign, digits) = match number.strip_prefix('-') {
        Some(rest) => ("\u{2212}", rest),
        None => ("", number),
    };
    if !digits.starts_with(|c: char| c.is_ascii_digit()) {
        return number.to_owned();
    }
    let (whole, fraction) = match digits.find(['.', 'e']) {
        Some(at) => digits.split_at(at),
        None => (digits, ""),
    };
    let group = whole.len() >= 5 && whole.bytes().all(|b| b.is_ascii_digit());
    let mut spaced = String::new();
    for (i, digit) in whole.char_indices() {
        if group && i > 0 && (whole.len() - i) % 3 == 0 {
            spaced.push('\u{2009}');
        }
        spaced.push(digit);
    }
    format!("{sign}{spaced}{}", exponent_minus(fraction))
}

/// "e-9" at the end of a number, with its minus sign; words with "e-" in them are left alone.
fn exponent_minus(fraction: &str) -> String {
    match fraction.rsplit_once("e-") {
        Some((digits, power)) if power.parse::<u32>().is_ok() => format!("{digits}e\u{2212}{power}"),
        _ => fraction.to_owned(),
    }
}

/// An ordered range of positive length around what was asked for.
fn proper(from: f64, to: f64) -> (f64, f64) {
    let (low, high) = extent([from, to]).unwrap_or((0.0, 1.0));
    let size = low.abs().max(high.abs());
    if size < 1e-200 {
        (-1.0, 1.0)
    } else if high - low > 1e-9 * size {
        (low, high)
    } else {
        (low - 0.1 * size, high + 0.1 * size)
    }
}

/// An ordered range of positive numbers around what was asked for.
fn proper_ratio(from: f64, to: f64) -> (f64, f64) {
    // Beyond these, ratios and powers of ten overflow.
    let (low, high) =
        extent([from, to].into_iter().filter(|v| *v > 1e-150 && *v < 1e150)).unwrap_or((1.0, 10.0));
    if high > low * (1.0 + 1e-9) { (low, high) } else { (0.5 * low, 2.0 * high) }
}

/// The 1-2-5 step that gives about `count` intervals, at most a quarter more.
fn step(span: f64, count: usize) -> f64 {
    let least = span / (1.25 * count.max(1) as f64) * (1.0 - 1e-9);
    let below = one_two_five_below(least);
    // 2.5 times a 1-2-5 number is enough to reach the next one and too little for the one after.
    if below >= least { below } else { one_two_five_below(2.5 * below) }
}

fn linear_ticks(from: f64, to: f64, step: f64) -> Vec<(f64, String)> {
    let first = (from / step - 1e-6).ceil();
    let last = (to / step + 1e-6).floor();
    let count = (last - first).clamp(0.0, 100.0) as usize;
    (0..=count)
        .map(|i| (first + i as f64) * step)
        .filter(|v| v.is_finite())
        .map(|v| (v, label(v, step)))
        .collect()
}

fn log_ticks(from: f64, to: f64, count: usize) -> Vec<(f64, String)> {
    let first = (from.log10() - 1e-9).ceil() as i32;
    let last = (to.log10() + 1e-9).floor() as i32;
    let within = |v: &f64| (from * (1.0 - 1e-9)..=to * (1.0 + 1e-9)).contains(v);
    let per_decade: &[f64] = if last - first < 2 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let every = ((last - first) as f64 / count.max(1) as f64).ceil().max(1.0) as i32;
    let ticks: Vec<(f64, String)> = (first - 1..=last)
        .filter(|exponent| exponent % every == 0)
        .flat_map(|exponent| per_decade.iter().map(move |digit| (*digit, exponent)))
        .map(|(digit, exponent)| (digit * power_of_ten(exponent), log_label(digit, exponent)))
        .filter(|(value, _)| within(value))
        .collect();
    if ticks.len() > 1 { ticks } else { linear_ticks(from, to, step(to - from, 4)) }
}

/// "1", "20", "0.05", then "10⁻³" and "5×10⁻³".
fn log_label(digit: f64, exponent: i32) -> String {
    match exponent {
        -2..0 => format!("{:.*}", -exponent as usize, digit * power_of_ten(exponent)),
        0..4 => format!("{:.0}", digit * power_of_ten(exponent)),
        _ if digit == 1.0 => format!("10{}", superscript(exponent)),
        _ => format!("{digit:.0}×10{}", superscript(exponent)),
    }
}

/// `value`, a multiple of `step`, with just the digits that tell it from its neighbours.
pub(super) fn label(value: f64, step: f64) -> String {
    if value.abs() < 0.5 * step {
        return "0".into();
    }
    let exponent = (step * (1.0 + 1e-9)).log10().floor() as i32;
    match exponent {
        -5..0 => typeset(&format!("{value:.*}", -exponent as usize)),
        0..7 => typeset(&format!("{value:.0}")),
        _ => format!(
            "{}×10{}",
            typeset(&format!("{:.0}", value / power_of_ten(exponent))),
            superscript(exponent)
        ),
    }
}

/// `powi` of a negative exponent is one over the power, which is exact for as many of them as can
/// be.
fn power_of_ten(exponent: i32) -> f64 {
    if exponent < 0 { 1.0 / 10f64.powi(-exponent) } else { 10f64.powi(exponent) }
}

pub(super) fn superscript(number: i32) -> String {
    let digit = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        _ => '⁰',
    };
    number.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: &Scale) -> String {
        scale.ticks.iter().map(|(_, label)| label.as_str()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn ticks_are_the_numbers_one_would_write() {
        assert_eq!(labels(&Scale::rounded(0.0, 19.6, 6)), "0 5 10 15 20");
        assert_eq!(
            labels(&Scale::rounded(0.0, 0.3, 6)),
            "0.00 0.05 0.10 0.15 0.20 0.25 0.30 0.35".replace("0.00", "0")
        );
        assert_eq!(labels(&Scale::rounded(-1.2, 1.2, 6)), "−1.5 −1.0 −0.5 0 0.5 1.0 1.5");
        assert_eq!(
            labels(&Scale::fixed(0.0, 25000.0, 5)),
            "0 5000 10\u{2009}000 15\u{2009}000 20\u{2009}000 25\u{2009}000"
        );
        assert_eq!(labels(&Scale::fixed(0.0, 3e-7, 3)), "0 1×10⁻⁷ 2×10⁻⁷ 3×10⁻⁷");
    }

    #[test]
    fn a_logarithmic_axis_is_ticked_at_powers_of_ten() {
        assert_eq!(labels(&Scale::log_rounded(3e-4, 700.0, 8)), "10⁻³ 0.01 0.1 1 10 100 1000");
        assert_eq!(labels(&Scale::log_rounded(2e-9, 40.0, 6)), "10⁻⁸ 10⁻⁶ 10⁻⁴ 0.01 1 100");
        assert_eq!(labels(&Scale::log_rounded(0.013, 0.4, 8)), "0.01 0.02 0.05 0.1 0.2 0.5");
        assert_eq!(labels(&Scale::log_rounded(10.0, 1000.0, 8)), "10 100 1000");
        assert_eq!(labels(&Scale::log(2.2, 4.1, 8)), "2.5 3.0 3.5 4.0");
        let scale = Scale::log(0.1, 1000.0, 8);
        assert_eq!((scale.fraction(1.0), scale.fraction(1000.0)), (0.25, 1.0));
        assert!(scale.places(1e-9) && !scale.places(0.0) && scale.fraction(0.0) == f64::NEG_INFINITY);
    }

    #[test]
    fn a_range_of_nothing_is_still_a_range() {
        for (from, to) in [
            (0.0, 0.0),
            (f64::NAN, f64::NAN),
            (5.0, 5.0),
            (f64::INFINITY, 1.0),
            (1e300, -1e300),
            (1.0, 1.0 + 1e-15),
            (1e-250, 2e-250),
            (-1e199, 1e199),
        ] {
            let log = [Scale::log(from, to, 6), Scale::log_rounded(from, to, 6)];
            for scale in [Scale::rounded(from, to, 6), Scale::fixed(from, to, 6)].into_iter().chain(log) {
                assert!(
                    scale.to > scale.from && (scale.to - scale.from).is_finite(),
                    "{from} {to} {scale:?}"
                );
                assert!((2..=14).contains(&scale.ticks.len()), "{from} {to} {scale:?}");
            }
        }
    }

    #[test]
    fn the_exaggeration_is_a_one_two_five_number() {
        let got = [731.0, 500.0, 499.0, 1000.0, 0.3, 0.02, f64::NAN, 0.0].map(one_two_five_below);
        assert_eq!(got, [500.0, 500.0, 200.0, 1000.0, 0.2, 0.02, 1.0, 1.0]);
    }

    #[test]
    fn numbers_are_typeset_with_a_minus_and_thin_spaces() {
        assert_eq!(typeset("-1234567.5"), "−1\u{2009}234\u{2009}567.5");
        assert_eq!(typeset("123456"), "123\u{2009}456");
        assert_eq!(typeset("1234"), "1234");
        assert_eq!(typeset("1.5e-9"), "1.5e−9");
        assert_eq!(typeset("-1.2 ± 0.3"), "−1.2 ± 0.3");
        assert_eq!(["one-sided", "-", ""].map(typeset), ["one-sided", "-", ""]);
    }
}
