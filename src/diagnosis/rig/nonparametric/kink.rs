//! What sets in at a load, acts one way only, or comes before the rod itself: shapes of a single
//! number, which curves of many columns pay too much for.
//!
//! ```text
//! C·F·a·(1 − F₀/|F|)      |F| > F₀: another slope beyond F₀, for loads one way or for both; a gap that closes
//! C·F·a                   one way only: a clamp that is loose one way
//! a·sign(F)·|F|^p         along the load, p < 1: a seat that gives way at once
//! ```
//!
//! F₀ is each load that was hung, or some of them.

use std::sync::Arc;

use super::along::{ALL_DEFLECTIONS, LOAD, SHARE, rival, size};
use crate::diagnosis::rig::effects::entry::{Entry, UNBOUNDED, parameter};
use crate::diagnosis::rig::mechanics::action::{Action, Weights};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Location, Variable};
use crate::spatial::Axis;

/// Loads at which a slope may change.
const MOST_KNOTS: usize = 12;
/// Exponents of a seat: of a line in contact, of Hertz's point, of a rough surface.
const EXPONENTS: [f64; 3] = [0.9, 2.0 / 3.0, 0.5];

/// All of them. `deflections`: how far the rod deflects at each datum by the base model, m.
pub(super) fn all(data: &[Datum], deflections: &[f64]) -> Vec<Entry> {
    let along = |axis: Axis| (0..data.len()).filter(|&i| data[i].direction.axis == axis).collect::<Vec<_>>();
    let axes: Vec<(String, Vec<usize>)> = Axis::ALL
        .into_iter()
        .map(|axis| (format!("all loads along {axis}"), along(axis)))
        .filter(|(_, own)| own.iter().any(|&i| data[i].drive() != 0.0))
        .collect();
    let everything = (ALL_DEFLECTIONS.to_owned(), (0..data.len()).collect());
    let groups = if axes.len() > 1 { [vec![everything], axes].concat() } else { vec![everything] };
    let mut entries = Vec::new();
    for (place, group) in &groups {
        entries.extend(kinks(data, deflections, place, group));
    }
    entries.extend(seats(data));
    entries
}

/// Which way loads pull that something acts on.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Both,
    Along,
    Against,
}

impl Way {
    fn includes(self, drive: f64) -> bool {
        match self {
            Way::Both => drive != 0.0,
            Way::Along => drive > 0.0,
            Way::Against => drive < 0.0,
        }
    }

    fn in_sentences(self) -> &'static str {
        match self {
            Way::Both => "",
            Way::Along => " along the axis",
            Way::Against => " against the axis",
        }
    }
}

/// Other slopes of some of the data; together they have the prior of one curve.
fn kinks(data: &[Datum], deflections: &[f64], place: &str, group: &[usize]) -> Vec<Entry> {
    let loaded = |way: Way| group.iter().copied().filter(move |&i| way.includes(data[i].drive()));
    let is_two_sided = loaded(Way::Along).next().is_some() && loaded(Way::Against).next().is_some();
    let ways = if is_two_sided { vec![Way::Both, Way::Along, Way::Against] } else { vec![Way::Both] };
    let mut found = Vec::new();
    for way in ways {
        // the slope of all loads is the stiffness; two of three slopes are as good as all
        let first = if way == Way::Against { vec![0.0] } else { Vec::new() };
        let knots = knots(loaded(way).map(|i| data[i].drive().abs()).collect());
        for knot in first.into_iter().chain(knots) {
            let beyond = loaded(way).filter(|&i| data[i].drive().abs() > knot);
            let weight = |i: usize| (i, deflections[i] * (1.0 - knot / data[i].drive().abs()));
            let weights: Weights = beyond.map(weight).filter(|(_, weight)| *weight != 0.0).collect();
            if weights.data.is_empty() {
                continue;
            }
            let at = with_unit(data, group, knot);
            let what = if data[group[0]].imposed.is_some() { "displacement" } else { "load" };
            let readings = if place == ALL_DEFLECTIONS { "all readings alike" } else { place };
            let location = Location::Curve {
                label: format!("{what}{} beyond {at}, {place}", way.in_sentences()),
                follows: match knot {
                    0.0 => format!("is other for loads against the axis ({readings})"),
                    _ => format!("changes its slope at a {what} of {at}{} ({readings})", way.in_sentences()),
                },
                along: Some(if way == Way::Both { Variable::Load } else { Variable::SignedLoad }),
            };
            let parameter = parameter("percent", 0.0, SHARE, UNBOUNDED);
            found.push((rival(location, vec![parameter]), vec![Action::Shift(weights)]));
        }
    }
    let share = 1.0 / found.len().max(1) as f64;
    found.iter_mut().for_each(|(candidate, _)| candidate.weight = share);
    found
}

/// Loads at which a slope may change: all but the largest, or some of them.
fn knots(mut levels: Vec<f64>) -> Vec<f64> {
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels.pop();
    let count = levels.len();
    match count > MOST_KNOTS {
        true => (0..MOST_KNOTS).map(|k| levels[(2 * k + 1) * count / (2 * MOST_KNOTS)]).collect(),
        false => levels,
    }
}

/// A load, or a displacement that is imposed, with its unit.
fn with_unit(data: &[Datum], group: &[usize], knot: f64) -> String {
    match group.iter().any(|&i| data[i].imposed.is_some()) {
        true => format!("{:.3} mm", knot * 1e3),
        false => format!("{knot:.2} N"),
    }
}

/// What gives way along the load, wherever that pulls to, at small loads more than at large ones.
fn seats(data: &[Datum]) -> Vec<Entry> {
    let along: Arc<[usize]> = (0..data.len())
        .filter(|&i| data[i].channel == data[i].direction.axis && data[i].drive() != 0.0)
        .collect();
    let most = along.iter().fold(0.0, |most: f64, &i| most.max(data[i].drive().abs()));
    if along.is_empty() || most == 0.0 {
        return Vec::new();
    }
    let size = size(&along, data);
    let of_exponent = |exponent: f64| {
        let weight = |&i: &usize| {
            let drive = data[i].drive();
            drive.signum() * (drive.abs() / most).powf(exponent)
        };
        let weights = Weights { data: Arc::clone(&along), values: along.iter().map(weight).collect() };
        let power = format!("the power {exponent:.2} of the load");
        let location = Location::Curve {
            label: format!("load, {power}, readings along the load"),
            follows: format!("follows about {power} (readings along the load)"),
            along: Some(LOAD.variable),
        };
        let mut candidate = rival(location, vec![parameter("um", 0.0, size, UNBOUNDED)]);
        candidate.weight = 1.0 / EXPONENTS.len() as f64;
        (candidate, vec![Action::Shift(weights)])
    };
    EXPONENTS.into_iter().map(of_exponent).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    fn found(text: &str, deflection: impl Fn(&Datum) -> f64) -> Vec<Entry> {
        let data = datum::all(&Readings::from_text("f", text).unwrap().rows);
        let deflections: Vec<f64> = data.iter().map(deflection).collect();
        all(&data, &deflections)
    }

    fn weights(action: &Action) -> Vec<(usize, f64)> {
        match action {
            Action::Shift(weights) => weights.iter().collect(),
            _ => panic!("a shift"),
        }
    }

    #[test]
    fn a_slope_changes_at_each_load_but_the_largest() {
        let found = found("axis,load_n,dy_um\ny,0,0\ny,5,9\ny,10,18\ny,20,36\n", |d| 2e-6 * d.drive());
        let labels: Vec<String> = found.iter().map(|(c, _)| c.location.to_string()).collect();
        assert_eq!(
            labels[..2],
            ["load beyond 5.00 N, all deflections", "load beyond 10.00 N, all deflections"]
        );
        assert_eq!(labels.len(), 2 + EXPONENTS.len());
        // 2 µm/N beyond 5 N: 10 and 30 µm
        let beyond = weights(&found[0].1[0]);
        assert!(beyond.len() == 2 && beyond[0].0 == 2 && beyond[1].0 == 3, "{beyond:?}");
        assert!((beyond[0].1 - 10e-6).abs() < 1e-18 && (beyond[1].1 - 30e-6).abs() < 1e-18, "{beyond:?}");
        assert!((found[0].0.weight - 0.5).abs() < 1e-12);
    }

    #[test]
    fn what_is_loose_one_way_is_so_at_every_load() {
        let found = found("axis,load_n,dy_um\n-y,5,-9\n-y,10,-18\ny,5,9\ny,10,18\n", |d| 2e-6 * d.drive());
        let one_way = found.iter().find(|(c, _)| match &c.location {
            Location::Curve { follows, .. } => {
                follows == "is other for loads against the axis (all readings alike)"
            }
            _ => false,
        });
        let own: Vec<f64> = weights(&one_way.unwrap().1[0]).iter().map(|(_, weight)| *weight).collect();
        assert!(
            (own[0] + 10e-6).abs() < 1e-18 && (own[1] + 20e-6).abs() < 1e-18 && own.len() == 2,
            "{own:?}"
        );
    }
}
