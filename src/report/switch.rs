//! The units that a reader of a page may switch between, and the axes of a picture in each of them.

use super::prefix::{prefixed, relabelled};
use super::scale::Scale;

/// A unit, and the same and others with what one of it is in them. The page's script reads them
/// too.
pub(super) const UNITS: [(&str, &[(&str, f64)]); 4] = [
    ("µm", &[("µm", 1.0), ("mm", 1e-3), ("mil", 1.0 / 25.4)]),
    ("µrad", &[("µrad", 1.0), ("mrad", 1e-3), ("°", 1.8e-4 / std::f64::consts::PI)]),
    ("mm", &[("mm", 1.0), ("in", 1.0 / 25.4)]),
    ("N", &[("N", 1.0), ("lbf", 1.0 / 4.448_221_615_260_5)]),
];

/// Labels and ticks of an axis in one unit; the ticks stand where the axis' own numbers are.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    /// The unit that a reader asked for; empty where there is only this one.
    pub(super) unit: String,
    pub(super) label: String,
    pub(super) ticks: Vec<(f64, String)>,
}

/// An axis as it is, then in every other unit that a reader may ask for. `counts` are the numbers
/// of ticks to try, the first whose ticks have `room` is taken.
pub(super) fn all_units(
    scale: &Scale,
    axis_label: &str,
    counts: impl Iterator<Item = usize> + Clone,
    room: impl Fn(&[(f64, String)]) -> bool,
) -> Vec<Ticks> {
    let label = relabelled(axis_label, scale.power);
    let own = |unit: &str| Ticks { unit: unit.into(), label: label.clone(), ticks: scale.ticks.clone() };
    let Some((quantity, unit, rest)) = parts(&label) else { return vec![own("")] };
    let others = others(unit);
    if others.is_empty() {
        return vec![own("")];
    }
    let one = 10f64.powi(scale.power);
    let (from, to) = (scale.from / one, scale.to / one);
    let other = |(name, factor): (String, f64)| {
        let bracketed = if name.contains('/') { format!("({name})") } else { name.clone() };
        let label = format!("{quantity}{bracketed}{rest}");
        let with = |count: usize| {
            let (from, to) = (factor * from, factor * to);
            let scale = if scale.log { Scale::log(from, to, count) } else { Scale::fixed(from, to, count) };
            let scale = prefixed(scale, &label);
            let ticks = scale.ticks.into_iter().map(|(at, text)| (at / factor * one, text)).collect();
            Ticks { unit: name.clone(), label: relabelled(&label, scale.power), ticks }
        };
        let found = counts.clone().map(with).find(|set| room(&set.ticks));
        found.unwrap_or_else(|| with(1))
    };
    std::iter::once(own(unit)).chain(others.into_iter().map(other)).collect()
}

/// "compliance / (µm/N), not from 0" as "compliance / ", "µm/N" and ", not from 0".
fn parts(axis_label: &str) -> Option<(&str, &str, &str)> {
    let at = axis_label.rfind(" / ")? + " / ".len();
    let (quantity, unit) = axis_label.split_at(at);
    let inside = unit.strip_prefix('(').and_then(|inner| inner.split_once(')'));
    let (unit, rest) = inside.unwrap_or_else(|| unit.split_at(unit.find([',', ' ']).unwrap_or(unit.len())));
    Some((quantity, unit, rest))
}

/// What else "µm/N" can be given in: every choice for what stands above and below the stroke but
/// the first, with what one µm/N is in it.
fn others(unit: &str) -> Vec<(String, f64)> {
    let choices = |part: &str| -> Vec<(String, f64)> {
        let known = UNITS.iter().find(|(name, _)| *name == part);
        match known {
            Some((_, all)) => all.iter().map(|(name, factor)| ((*name).to_owned(), *factor)).collect(),
            None => vec![(part.to_owned(), 1.0)],
        }
    };
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    if below.contains('/') {
        return Vec::new();
    }
    let all = choices(above).into_iter().flat_map(|(above, by)| {
        choices(below).into_iter().map(move |(below, over)| match below.is_empty() {
            true => (above.clone(), by),
            false => (format!("{above}/{below}"), by / over),
        })
    });
    all.skip(1).collect()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn a_unit_has_every_other_above_and_below_the_stroke() {
        let names = |unit| others(unit).into_iter().map(|(name, _)| name).collect::<Vec<_>>().join(" ");
        assert_eq!(names("µm"), "mm mil");
        assert_eq!(names("µm/N"), "µm/lbf mm/N mm/lbf mil/N mil/lbf");
        assert_eq!((names("kg"), names("µm²"), names("%")), Default::default());
        // 1 µm/N is 4.448 µm/lbf and 0.1751 mil/lbf
        let factor = |name: &str| others("µm/N").into_iter().find(|(n, _)| n == name).map_or(0.0, |(_, f)| f);
        assert_relative_eq!(factor("µm/lbf"), 4.448_221_6, max_relative = 1e-7);
        assert_relative_eq!(factor("mil/lbf"), 4.448_221_6 / 25.4, max_relative = 1e-7);
    }

    #[test]
    fn ticks_stand_where_their_numbers_are() {
        let scale = prefixed(Scale::fixed(0.0, 5e5, 5), "deflection / µm");
        let sets = all_units(&scale, "deflection / µm", 4..5, |_| true);
        let [mm, inch] = &sets[..] else { panic!("{sets:?}") };
        // shown in mm, so that mm is what can be switched
        assert_eq!((mm.unit.as_str(), mm.label.as_str()), ("mm", "deflection / mm"));
        assert_eq!((inch.unit.as_str(), inch.label.as_str()), ("in", "deflection / in"));
        for (at, text) in &inch.ticks {
            let inches: f64 = text.parse().expect("is a number");
            assert_relative_eq!(*at, 25_400.0 * inches, max_relative = 1e-12);
        }
        assert!(inch.ticks.len() > 3);
    }

    #[test]
    fn what_stands_behind_a_unit_stays() {
        let label = "compliance / (µm/N), not from 0";
        let sets = all_units(&Scale::fixed(40.0, 50.0, 5), label, 5..6, |_| true);
        assert_eq!(sets[2].label, "compliance / (mm/N), not from 0");
        assert_eq!(sets[0].label, label);
        assert_eq!(all_units(&Scale::fixed(0.0, 1.0, 5), "share / %", 5..6, |_| true).len(), 1);
    }
}
