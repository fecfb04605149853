//! What happened once: slips and misread values.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::entry::{
    Context, Entry, RigEffect, UNBOUNDED, Usual, entry, number, out_of_the_readings, parameter,
};
use super::places::runs_by_sensor;
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::recording::columns::column;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{
    Effect, Estimate, FindingPart, Kind, Location, Quantity, Reported, Run, Variable, WrittenTo,
};
use crate::spatial::Axis;

/// Slip of a bond or a clamp as a share of the largest reading.
const STEP: f64 = 0.05;

/// Most places in a run that are tried; of a longer run every second one, or fewer.
const MOST_SLIPS: usize = 200;

/// Of a longer recording a shift for good is looked for between runs only.
const MOST_ROWS_WITHIN: usize = 1000;

/// Everything after one row of a run is shifted.
pub static SLIP: RigEffect = RigEffect {
    effect: Effect {
        name: "slip",
        kind: Kind::Event,
        summary: "all readings after one of them are shifted",
        formula: "y + s for the rest of a run, or of the file",
        prior: "5 % of the largest reading: a bond or a clamp that slips; a knock may be more",
        parameters: &[
            (&["um"], "shift"),
            (&["dx_um"], "shift of dx, at the same row"),
            (&["dy_um"], "shift of dy, at the same row"),
            (&["dz_um"], "shift of dz, at the same row"),
        ],
        needs: "runs with two readings on either side",
        cause: "a slip of the clamp or of a sensor",
        cause_at: |location| format!("a slip ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::ByRow,
        seen_along: |_| vec![Variable::Order],
        direct_check: None,
    },
    usual: &[Usual::Share(STEP)],
    needs_rod: false,
    candidates: slips,
    missing: |_| "no run has two readings on either side of a slip",
    observed: |finding, _| {
        let others = finding.parts.iter().zip(&finding.estimates).skip(1);
        let mut others: Vec<(Axis, Quantity)> = others
            .filter_map(|(part, shift)| Some((shifted_channel(&part.location)?, shift.quantity())))
            .collect();
        others.sort_by_key(|(channel, _)| *channel);
        let one = |(channel, shift): &(Axis, Quantity)| format!(", d{channel} by {}", shift.with_unit("µm"));
        let besides: String = others.iter().map(one).collect();
        format!(
            "The readings jump by {} ({}){besides}",
            number(finding, "um").with_unit("µm"),
            finding.location
        )
    },
    write: out_of_the_readings,
};

/// The channel that a slip shifts.
fn shifted_channel(location: &Location) -> Option<Axis> {
    match location {
        Location::AfterRow { run, channel, .. } => Some(channel.unwrap_or(run.axis)),
        _ => None,
    }
}

/// Estimates of the slips that are one finding: all but the first are those of their channels.
pub(in crate::diagnosis::rig) fn by_channel(parts: &[FindingPart], estimates: &mut [Estimate]) {
    for (part, estimate) in parts.iter().zip(estimates).skip(1) {
        if let Some(channel) = shifted_channel(&part.location) {
            estimate.name = column(channel);
        }
    }
}

/// A slip between any two rows of a run, with two rows at least on either side (one row would be a
/// suspect), which the next zero takes out; and one between two runs, or within one, that no later
/// zero takes out.
fn slips(context: &mut Context) -> Vec<Entry> {
    let data = context.data;
    let size = STEP * context.largest_reading();
    let of_run = |(run, rows): (Run, Vec<usize>)| {
        let sequence: Arc<[usize]> = rows.as_slice().into();
        let step = rows.len().div_ceil(MOST_SLIPS).max(1);
        (2..rows.len().saturating_sub(1)).step_by(step).map(move |first| {
            let before = &data[rows[first - 1]];
            let is_other = before.channel != before.direction.axis;
            let channel = is_other.then_some(before.channel);
            let location = Location::AfterRow { run: run.clone(), row: before.row, channel, for_good: false };
            let um = parameter("um", 0.0, size, UNBOUNDED);
            entry(&SLIP, location, um, Action::Step(Arc::clone(&sequence), first))
        })
    };
    let within: Vec<Entry> = runs_by_sensor(data).into_iter().flat_map(of_run).collect();
    within.into_iter().chain(for_good(data, size)).collect()
}

/// Everything after a row is shifted for good: of each sensor, between any two runs with runs on
/// either side, and within a run, with two rows of it and a run on either side. A channel that is
/// read at one place in each run is one sensor, which is moved from place to place, and with it
/// goes what shifted it.
fn for_good(data: &[Datum], size: f64) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut place_in_run: BTreeMap<(Axis, usize), u64> = BTreeMap::new();
    let is_moved: Vec<Axis> = Axis::ALL
        .into_iter()
        .filter(|&channel| {
            data.iter().filter(|d| d.channel == channel).all(|d| {
                let place = d.sensor().1;
                *place_in_run.entry((channel, d.run)).or_insert(place) == place
            })
        })
        .collect();
    let sensor_of = |d: &Datum| (d.channel, (!is_moved.contains(&d.channel)).then(|| d.sensor().1));
    let mut sensors: Vec<_> = data.iter().map(sensor_of).collect();
    sensors.sort_unstable();
    sensors.dedup();
    for sensor in sensors {
        let channel = sensor.0;
        let mut sequence: Vec<usize> = (0..data.len()).filter(|&i| sensor_of(&data[i]) == sensor).collect();
        sequence.sort_by_key(|&i| data[i].order);
        let last_of_run: BTreeMap<usize, usize> = sequence.iter().map(|&i| (data[i].run, i)).collect();
        let mut last_of_run: Vec<usize> = last_of_run.into_values().collect();
        last_of_run.sort_by_key(|&last| data[last].order);
        let mut rows: Vec<usize> = last_of_run.iter().skip(1).rev().skip(2).copied().collect();
        if sequence.len() <= MOST_ROWS_WITHIN {
            let ends = [sequence.first(), sequence.last()].map(|end| end.map(|&i| data[i].run));
            let is_within = |rows: &&[usize]| {
                let run = data[rows[0]].run;
                rows.iter().all(|&i| data[i].run == run) && !ends.contains(&Some(run))
            };
            rows.extend(sequence.windows(4).filter(is_within).map(|rows| rows[1]));
        }
        let sequence: Arc<[usize]> = sequence.into();
        for row in rows {
            let before = &data[row];
            let from = sequence.partition_point(|&i| data[i].order <= before.order);
            let run = Run { axis: before.direction.axis, name: before.run_name() };
            let (row, channel) = (before.row, Some(channel));
            let location = Location::AfterRow { run, row, channel, for_good: true };
            let um = parameter("um", 0.0, size, UNBOUNDED);
            entries.push(entry(&SLIP, location, um, Action::Step(Arc::clone(&sequence), from)));
        }
    }
    entries
}
