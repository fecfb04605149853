//! What jumps at the same load in every run: a seat that tips over, a stand that is touched.
//!
//! ```text
//! y_c + a_c·sign(F), y_c + a_c      |F| > F₀, c the channels concerned
//! ```
//!
//! F₀ lies between any two loads with two on either side. Runs that all go through the same loads
//! would each have a slip there, and a curve of cosines draws no jump.

use std::sync::Arc;

use super::along::{LOAD, Way, by_channel, rival, size};
use crate::diagnosis::rig::effects::entry::{Entry, UNBOUNDED, parameter};
use crate::diagnosis::rig::mechanics::action::{Action, Weights};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::Location;
use crate::spatial::Axis;

/// Loads on either side of a jump: what is off at one of them is no jump.
const ON_EITHER_SIDE: usize = 2;
/// Places of a jump; of more loads some of them.
const MOST_PLACES: usize = 30;

/// On each line along its load, each channel whatever the load pulls at, and all of them under
/// loads along each axis and under all: one that jumps across a load is one of those. `lines` and
/// `channels`: the data of each with its name.
pub(super) fn all(
    data: &[Datum],
    lines: &[(String, Vec<usize>)],
    channels: &[(String, Vec<usize>)],
) -> Vec<Entry> {
    let axes = Axis::ALL.map(|axis| {
        let own = (0..data.len()).filter(|&i| data[i].direction.axis == axis).collect::<Vec<_>>();
        (format!("all sensors under loads along {axis}"), own)
    });
    let is_loaded = |own: &[usize]| own.iter().any(|&i| data[i].drive() != 0.0);
    let axes: Vec<_> = axes.into_iter().filter(|(_, own)| is_loaded(own)).collect();
    let is_along = |own: &[usize]| own.iter().all(|&i| data[i].channel == data[i].direction.axis);
    let mut groups: Vec<(String, Vec<usize>)> =
        lines.iter().filter(|(_, own)| is_along(own)).cloned().collect();
    if channels.len() > 1 {
        groups.extend(axes.iter().cloned());
    }
    // along a single axis a channel is a line, and that axis all of them
    if axes.len() > 1 {
        groups.extend(channels.iter().map(|(name, own)| (format!("{name} under all loads"), own.clone())));
        groups.push(("all sensors under all loads".to_owned(), (0..data.len()).collect()));
    }
    groups.iter().flat_map(|(place, group)| of_group(data, place, group)).collect()
}

/// Jumps of some of the data, also those that point one way whichever way loads do; together they
/// have the prior of one curve.
fn of_group(data: &[Datum], place: &str, group: &[usize]) -> Vec<Entry> {
    let places = places(group.iter().map(|&i| data[i].drive().abs()).collect());
    let jumps = |way: Way| places.iter().map(move |between| jump(data, (place, group), *between, way));
    let mut found: Vec<Entry> = Way::of(data, group).iter().flat_map(|way| jumps(*way)).collect();
    let share = 1.0 / found.len().max(1) as f64;
    found.iter_mut().for_each(|(candidate, _)| candidate.weight = share);
    found
}

fn jump(data: &[Datum], (place, group): (&str, &[usize]), [below, above]: [f64; 2], way: Way) -> Entry {
    let of_channel = |own: Arc<[usize]>| {
        let side = |&i: &usize| if data[i].drive().abs() > below { way.side(data[i].drive()) } else { 0.0 };
        let values = own.iter().map(side).collect();
        let name = format!("d{}_um", data[own[0]].channel);
        (parameter(&name, 0.0, size(&own, data), UNBOUNDED), Action::Shift(Weights { data: own, values }))
    };
    let (parameters, actions) = by_channel(group, data).into_iter().map(of_channel).unzip();
    let between = match group.iter().any(|&i| data[i].imposed.is_some()) {
        true => format!("{:.3} and {:.3} mm", below * 1e3, above * 1e3),
        false => format!("{below:.2} and {above:.2} N"),
    };
    let place = format!("{place}{}", way.in_sentences());
    let location = Location::Curve {
        label: format!("load, a jump between {between}, {place}"),
        follows: format!("jumps at the same load in every run, between {between} ({place})"),
        along: Some(LOAD.variable),
    };
    (rival(location, parameters), actions)
}

/// Neighbouring loads between which something may jump.
fn places(mut levels: Vec<f64>) -> Vec<[f64; 2]> {
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let last = levels.len().saturating_sub(ON_EITHER_SIDE);
    let all: Vec<[f64; 2]> =
        (ON_EITHER_SIDE..=last).filter(|&k| k < levels.len()).map(|k| [levels[k - 1], levels[k]]).collect();
    match all.len() > MOST_PLACES {
        true => (0..MOST_PLACES).map(|k| all[(2 * k + 1) * all.len() / (2 * MOST_PLACES)]).collect(),
        false => all,
    }
}

#[cfg(test)]
mod tests {
    use super::super::groups;
    use super::*;
    use crate::diagnosis::rig::numbering::numbered;
    use crate::rig::readings::Readings;

    fn found(text: &str) -> Vec<Entry> {
        let data =
            crate::diagnosis::rig::recording::datum::all(&Readings::from_text("f", text).unwrap().rows);
        let lines = groups(&data, &numbered(data.iter().map(Datum::line_key)), &|d| {
            format!("d{} under loads along {}", d.channel, d.direction.axis)
        });
        let channels =
            groups(&data, &numbered(data.iter().map(|d| d.channel)), &|d| format!("d{}", d.channel));
        all(&data, &lines, &channels)
    }

    #[test]
    fn a_jump_lies_between_two_loads_of_either_side_and_points_as_they_do() {
        let along = |sign: &str| -> String {
            [2, 4, 6, 8].iter().map(|load| format!("{sign}y,{load},{sign}{load},0\n")).collect()
        };
        let rows = [along(""), along("-"), "z,2,0,1\nz,4,0,2\n".into()].concat();
        let found = found(&format!("axis,load_n,dy_um,dz_um\n{rows}"));
        let labels: Vec<String> = found.iter().map(|(c, _)| c.location.to_string()).collect();
        let jump = |place: &str| format!("load, a jump between 4.00 and 6.00 N, {place}");
        let places = [
            "dy under loads along y",
            "all sensors under loads along y",
            "dy under all loads",
            "dz under all loads",
            "all sensors under all loads",
        ];
        let both = places.iter().flat_map(|place| [jump(place), jump(place) + ", whichever way they point"]);
        assert_eq!(labels, both.collect::<Vec<_>>());
        let weights = |k: usize| match &found[k].1[0] {
            Action::Shift(weights) => weights.iter().map(|(_, weight)| weight).collect::<Vec<f64>>(),
            _ => panic!("a shift"),
        };
        // of the first sensor, as the load points and one way
        assert_eq!(weights(8), [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, -1.0, -1.0, 0.0, 0.0]);
        assert_eq!(weights(9), [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
        let names: Vec<&str> = found[8].0.parameters.iter().map(|own| &*own.name).collect();
        assert_eq!(names, ["dy_um", "dz_um"]);
        assert!(found.iter().all(|(candidate, _)| candidate.weight == 0.5));
    }

    #[test]
    fn of_many_loads_some_places_are_tried_and_together_they_are_one_curve() {
        let rows: String = (1..=100).map(|load| format!("y,{load},{load}\n")).collect();
        let found = found(&format!("axis,load_n,dy_um\n{rows}"));
        let weights: f64 = found.iter().map(|(candidate, _)| candidate.weight).sum();
        assert!(found.len() == MOST_PLACES && (weights - 1.0).abs() < 1e-12, "{} {weights}", found.len());
        // three loads have none
        assert!(self::found("axis,load_n,dy_um\ny,1,1\ny,2,2\ny,3,3\n").is_empty());
    }
}
