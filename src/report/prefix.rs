//! The decimal prefix of an axis: ticks of at most four digits, 500 mm in place of 500 000 µm.

use super::scale::{Scale, label};

/// More digits than these nobody reads at a glance.
const MOST_DIGITS: usize = 4;

/// Units that differ by a factor of a thousand from one to the next.
const LADDERS: [&[&str]; 9] = [
    &["nm", "µm", "mm", "m", "km"],
    &["µN", "mN", "N", "kN", "MN", "GN"],
    &["nrad", "µrad", "mrad", "rad"],
    &["µg", "mg", "g", "kg", "t"],
    &["Pa", "kPa", "MPa", "GPa"],
    &["µs", "ms", "s"],
    &["Hz", "kHz", "MHz"],
    &["µW", "mW", "W", "kW"],
    &["µV", "mV", "V", "kV"],
];

/// The same scale, its ticks in the nearest unit in which they have at most four digits; as it was
/// where they do already, or where no unit helps.
pub(super) fn prefixed(scale: Scale, axis_label: &str) -> Scale {
    if scale.log || scale.ticks.iter().all(|(_, text)| is_short(text)) {
        return scale;
    }
    let short =
        |power| in_power(&scale, power).filter(|other| other.ticks.iter().all(|(_, text)| is_short(text)));
    // the nearest first; a prefix rather than a power of ten
    let powers = || [3, -3, 6, -6, 9, -9, 12, -12].into_iter();
    let found = powers()
        .filter(|power| with_prefix(axis_label, *power).is_some())
        .find_map(short)
        .or_else(|| powers().filter(|power| with_power(axis_label, *power).is_some()).find_map(short));
    found.unwrap_or(scale)
}

/// A scale of millimetres in micrometres, as all lengths below 1 mm are given; `None` where it goes
/// beyond that, or is none of lengths.
pub(super) fn micrometres(scale: &Scale, axis_label: &str) -> Option<Scale> {
    let largest = scale.from.abs().max(scale.to.abs());
    if scale.log || largest > 1.0 || with_prefix(axis_label, -3)?.rsplit_once(" / ")?.1 != "µm" {
        return None;
    }
    in_power(scale, -3).filter(|scale| scale.ticks.iter().all(|(_, text)| is_short(text)))
}

/// The same scale with the texts of values over a power of ten; `None` where ticks are none.
fn in_power(scale: &Scale, power: i32) -> Option<Scale> {
    let steps = scale.ticks.windows(2).map(|pair| pair[1].0 - pair[0].0);
    let step = steps.fold(f64::INFINITY, f64::min);
    let one = 10f64.powi(power);
    let ticks = scale.ticks.iter().map(|(v, _)| (*v, label(v / one, step / one))).collect();
    step.is_finite().then(|| Scale { ticks, power, ..scale.clone() })
}

/// The label of an axis whose ticks are divided by this power of ten.
pub(super) fn relabelled(axis_label: &str, power: i32) -> String {
    let other = match power {
        0 => None,
        _ => with_prefix(axis_label, power).or_else(|| with_power(axis_label, power)),
    };
    other.unwrap_or_else(|| axis_label.to_owned())
}

fn is_short(text: &str) -> bool {
    !text.contains('×') && text.chars().filter(char::is_ascii_digit).count() <= MOST_DIGITS
}

/// "load / N" as "load / " and "N".
fn parts(axis_label: &str) -> Option<(&str, &str)> {
    let at = axis_label.rfind(" / ")? + " / ".len();
    Some(axis_label.split_at(at))
}

/// "load / N" as "load / kN" for 3; `None` where the unit is none that takes prefixes.
fn with_prefix(axis_label: &str, power: i32) -> Option<String> {
    let (quantity, unit) = parts(axis_label)?;
    let (bracket, unit) = unit.strip_prefix('(').map_or(("", unit), |inner| ("(", inner));
    let end = unit.find(|c: char| !c.is_alphabetic()).unwrap_or(unit.len());
    let (symbol, rest) = unit.split_at(end);
    // a thousand µm² are no mm²
    if rest.starts_with(['²', '³', '⁻', '^']) || power % 3 != 0 {
        return None;
    }
    let at = |ladder: &&[&str]| ladder.iter().position(|known| *known == symbol);
    let (ladder, now) = LADDERS.iter().find_map(|ladder| Some((ladder, at(ladder)?)))?;
    let then = usize::try_from(now as i32 + power / 3).ok()?;
    Some(format!("{quantity}{bracket}{}{rest}", ladder.get(then)?))
}

/// "time / s" as "time / (10³ s)" for 3; `None` without a unit, or for shares.
fn with_power(axis_label: &str, power: i32) -> Option<String> {
    let (quantity, unit) = parts(axis_label)?;
    let inner = unit.strip_prefix('(').and_then(|inner| inner.strip_suffix(')')).unwrap_or(unit);
    if !inner.starts_with(|c: char| c.is_alphabetic() || c == '°') || inner.contains(", ") {
        return None;
    }
    let exponent = match power {
        3 => "³",
        -3 => "⁻³",
        6 => "⁶",
        -6 => "⁻⁶",
        _ => return None,
    };
    Some(format!("{quantity}(10{exponent} {inner})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(from: f64, to: f64, axis_label: &str) -> (Vec<String>, String) {
        let scale = prefixed(Scale::fixed(from, to, 4), axis_label);
        let texts = scale.ticks.iter().map(|(_, text)| text.clone()).collect();
        (texts, relabelled(axis_label, scale.power))
    }

    #[test]
    fn ticks_have_at_most_four_digits() {
        for (from, to, given, texts, expected) in [
            (0.0, 5e5, "deflection / µm", "0 100 200 300 400 500", "deflection / mm"),
            (0.0, 1.3e7, "load / N", "0 5 10", "load / MN"),
            (0.0, 4e-4, "positioning error / mm", "0 0.1 0.2 0.3 0.4", "positioning error / µm"),
            (0.0, 3e5, "compliance / (µm/N), not from 0", "0 100 200 300", "compliance / (mm/N), not from 0"),
            (0.0, 40e3, "time / s", "0 10 20 30 40", "time / (10³ s)"),
            (0.0, 2e5, "area / µm²", "0 50 100 150 200", "area / (10³ µm²)"),
            // what is short stays, and what nothing helps
            (0.0, 4000.0, "load / N", "0 1000 2000 3000 4000", "load / N"),
            (0.0, 2e4, "pose", "0 5000 10\u{2009}000 15\u{2009}000 20\u{2009}000", "pose"),
        ] {
            assert_eq!(
                shown(from, to, given),
                (texts.split(' ').map(str::to_owned).collect(), expected.into())
            );
        }
    }

    #[test]
    fn lengths_below_a_millimetre_are_in_micrometres() {
        let shown = |to: f64, label: &str| {
            let scale = Scale::fixed(0.0, to, 4);
            micrometres(&scale, label).map(|s| (s.ticks[1].1.clone(), relabelled(label, s.power)))
        };
        assert_eq!(shown(0.04, "error / mm"), Some(("10".into(), "error / µm".into())));
        assert_eq!(shown(4.0, "error / mm"), None);
        assert_eq!((shown(0.04, "error / mrad"), shown(0.04, "slope / (mm/N)")), (None, None));
    }

    #[test]
    fn a_narrow_range_far_from_zero_keeps_its_digits() {
        let (texts, label) = shown(100_000.0, 100_004.0, "x / µm");
        assert_eq!((texts[1].as_str(), label.as_str()), ("100\u{2009}001", "x / µm"));
    }
}
