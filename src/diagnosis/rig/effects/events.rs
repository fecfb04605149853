//! What happened once: slips and misread values.

use super::places::runs_by_channel;
use super::{Context, Entry, RigEffect, UNBOUNDED, entry, of, parameter};
use crate::diagnosis::rig::action::Action;
use crate::inference::{Effect, Kind, Location, Reported, Run, Variable, WrittenTo};
use crate::units::UM;

/// Slip of a bond or a clamp within a run, m: well above a sensor's noise of 3 µm. A knock may be
/// millimetres.
const STEP: f64 = 50.0 * UM;
/// A display that was read wrongly, m.
const MISREAD: f64 = 50.0 * UM;

/// Everything after one row of a run is shifted.
pub static SLIP: RigEffect = RigEffect {
    effect: Effect {
        name: "slip",
        kind: Kind::Event,
        summary: "everything after one reading is shifted",
        formula: "y + s for the rest of a run",
        prior: "50 µm: a bond or a clamp that slips; a knock may be millimetres",
        parameters: &[("um", "shift")],
        needs: "runs with two readings on either side",
        cause: "something slipped",
        cause_at: |location| format!("a slip ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| vec![Variable::Order],
        direct_check: None,
    },
    needs_rod: false,
    candidates: slips,
    missing: |_| "no run has two readings on either side of a slip",
    observed: |finding, _| format!("Readings jump by {} ({})", of(finding, "um").say("µm"), finding.location),
};

/// One reading is wrong.
pub static OUTLIER: RigEffect = RigEffect {
    effect: Effect {
        name: "outlier",
        kind: Kind::Event,
        summary: "one reading is wrong",
        formula: "y + s at one reading",
        prior: "50 µm: a display that was read wrongly",
        parameters: &[("um", "error")],
        needs: "readings",
        cause: "a misread or disturbed reading",
        cause_at: |location| format!("{location} misread"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| vec![Variable::Order],
        direct_check: None,
    },
    needs_rod: false,
    candidates: |context| {
        let of_datum = |(i, datum): (usize, &super::Datum)| {
            let um = parameter("um", UM, 0.0, MISREAD, UNBOUNDED);
            let location = Location::Reading { row: datum.row, channel: datum.channel };
            entry(&OUTLIER, location, um, Action::Shift(vec![(i, 1.0)]))
        };
        context.data.iter().enumerate().map(of_datum).collect()
    },
    missing: |_| "nothing was read",
    observed: |finding, _| {
        format!("The reading of {} is off by {}", finding.location, of(finding, "um").say("µm"))
    },
};

/// A slip between any two rows of a run, with two rows at least on either side: one row would be an
/// outlier.
fn slips(context: &mut Context) -> Vec<Entry> {
    let data = context.data;
    let of_run = |(run, rows): (Run, Vec<usize>)| {
        (2..rows.len().saturating_sub(1)).map(move |first| {
            let before = &data[rows[first - 1]];
            let is_other = before.channel != before.direction.axis;
            let channel = is_other.then_some(before.channel);
            let location = Location::AfterRow { run: run.clone(), row: before.row, channel };
            let weights = rows[first..].iter().map(|&i| (i, 1.0)).collect();
            let um = parameter("um", UM, 0.0, STEP, UNBOUNDED);
            entry(&SLIP, location, um, Action::Shift(weights))
        })
    };
    runs_by_channel(data).into_iter().flat_map(of_run).collect()
}
