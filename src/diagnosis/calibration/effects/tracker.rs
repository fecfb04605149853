//! What a tracker does to the points that it shows.

use nalgebra::Vector3;

use super::super::model::CalibrationModel;
use super::super::model::entry::linear;
use super::{
    CalibrationEffect, Context, Entry, Transfer, first, no_event, out_of_the_points, own_parameters, single,
};
use crate::inference::{Effect, Finding, Kind, Location, NotTestable, Part, Reported, WrittenTo};

/// Share of the way to a point that is still to come when it is taken.
const SHARE: f64 = 3e-4;

/// Points that are taken before a tracker's filter has settled.
pub static TRACKER_LAG: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "tracker_lag",
        kind: Kind::Physics,
        summary: "a tracker's points lag behind the ball",
        formula: "−f·(p − p before): f ≥ 0 is the share of the straight way from the ball's last place that \
                  was still to come when the point was taken",
        prior: "3e-4: a filter of first order has that left after eight of its time constants",
        parameters: &[(&["fraction"], "share of the way from the last point that was still to come")],
        needs: "points of a tracker in the order of recording",
        cause: "a tracker's filter had not settled",
        cause_at: |location| format!("points taken before the filter had settled ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Record a pose twice: at once, and after ten times the filter's length."),
    },
    candidates: lags,
    estimates: own_parameters,
    observed: lag_observed,
    write: out_of_the_points,
    transfer: Transfer::Nothing,
    event: no_event,
};

fn lags(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    if !context.is_tracked() {
        return Vec::new();
    }
    let rows = &context.recording.rows;
    // at a new station nothing is left of the points before
    let before = |row: usize| row.checked_sub(1).filter(|&before| rows[before].station == rows[row].station);
    let column = context.column(|row, there| match before(row) {
        Some(before) => context.configurations[before].tip - there.tip,
        None => Vector3::zeros(),
    });
    let mut fraction = linear("fraction", SHARE);
    fraction.bounds.0 = 0.0;
    vec![single(&TRACKER_LAG, Location::Part(Part::Tracker), fraction, column)]
}

fn lag_observed(finding: &Finding, _: &CalibrationModel) -> String {
    let share = first(finding).map(|share| 100.0 * share).with_unit("%");
    format!("When the tracker took a point, {share} of the way from the one before was still to come")
}
