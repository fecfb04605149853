//! What the displacement sensors of a clamp's device show of the ball's displacement.
//!
//! The model counts the true displacement per shown one, which its columns are linear in and which
//! a correction multiplies by; people count what is shown of the true one, as on a rig.

use nalgebra::{Matrix3, Vector3};

use super::super::model::CalibrationModel;
use super::super::model::entry::linear;
use super::contact::{at_clamps, is_of_clamps};
use super::{CalibrationEffect, Context, Entry, Transfer, lack, no_event, out_of_the_points, single};
use crate::inference::{
    Effect, Estimate, Finding, FindingPart, Kind, Location, NotTestable, Parameter, Quantity, Reported,
    WrittenTo,
};
use crate::spatial::Axis;

/// Error of a sensor's scale, and what it shows of a displacement across it: an axis that is turned
/// by 1.7°.
const SCALE: f64 = 0.03;
/// True over shown displacement: what is off by more than a factor of two, on a rig too, is another
/// unit, or another axis.
const BOUNDS: (f64, f64) = (0.5, 2.0);
/// The same of what is shown along another axis, one that is turned by 30°.
const MOST_CROSS_TALK: (f64, f64) = (-0.5, 0.5);
/// Which axis shows something, of a displacement along which one.
const CROSS: [[&str; 3]; 3] =
    [["x_per_x", "x_per_y", "x_per_z"], ["y_per_x", "y_per_y", "y_per_z"], ["z_per_x", "z_per_y", "z_per_z"]];

/// A device that shows too much or too little along an axis, or some of it along another one.
pub static SENSOR_SCALE: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "sensor_scale",
        kind: Kind::Physics,
        summary: "a clamp's displacement sensors show too much, too little or cross-talk",
        formula: "R_c·(I − S⁻¹)·u: u the displacement in the device frame, R_c that frame in {W}; \
                  S one factor along an axis or one cross-talk between two, of one clamp or all, \
                  or 3×3 of all (rotation of the device included)",
        prior: "3 %: a displacement sensor that was not calibrated in place, or whose axis is off by 1.7°",
        parameters: &[
            (&["factor"], "shown over true displacement along the axis"),
            (&CROSS[0], "shown along x per true displacement along each axis"),
            (&CROSS[1], "shown along y per true displacement along each axis"),
            (&CROSS[2], "shown along z per true displacement along each axis"),
        ],
        needs: "clamps, and displacements that vary by three times the scatter",
        cause: "the scale of the device's displacement sensors",
        cause_at: |location| format!("the scale of the displacement sensors ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some(
            "Move the device by a known distance along each of its axes, as with gauge blocks.",
        ),
    },
    candidates: devices,
    estimates: shown_per_true,
    observed: scale_observed,
    write: out_of_the_points,
    transfer: Transfer::Nothing,
    event: no_event,
};

fn devices(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    if !is_of_clamps(context) {
        lacks.push(lack(&SENSOR_SCALE, "there are no clamps"));
        return Vec::new();
    }
    if !context.shows_displacements() {
        lacks.push(lack(&SENSOR_SCALE, "the displacements vary by less than some three times what is left"));
        return Vec::new();
    }
    let recording = context.recording;
    // what is shown along one axis and is none, per displacement that is shown along another
    let column = |shown: usize, along: usize, is_there: &dyn Fn(usize) -> bool| {
        context.column(|row, _| match is_there(recording.rows[row].group) {
            true => -recording.device(row).rotation.column(shown) * context.displacement(row)[along],
            false => Vector3::zeros(),
        })
    };
    let of_axis = |axis: usize| {
        at_clamps(context, |place, is_there| {
            let factor = Parameter { neutral: 1.0, bounds: BOUNDS, ..linear("factor", SCALE) };
            let location = Location::Named(format!("{place}, axis {}", Axis::ALL[axis]));
            single(&SENSOR_SCALE, location, factor, column(axis, axis, is_there))
        })
    };
    let mut entries: Vec<Entry> = (0..3).flat_map(of_axis).collect();
    let parameter = |(shown, along): (usize, usize)| {
        let (neutral, bounds) = if shown == along { (1.0, BOUNDS) } else { (0.0, MOST_CROSS_TALK) };
        Parameter { neutral, bounds, ..linear(CROSS[shown][along], SCALE) }
    };
    let of_pair = |(shown, along): (usize, usize)| {
        at_clamps(context, |place, is_there| {
            let cross_talk = format!("{place}, {} into {}", Axis::ALL[along], Axis::ALL[shown]);
            let column = column(shown, along, is_there);
            single(&SENSOR_SCALE, Location::Named(cross_talk), parameter((shown, along)), column)
        })
    };
    // one number of all clamps too: nine would pay for eight that are none
    entries.extend(pairs().filter(|(shown, along)| shown != along).flat_map(of_pair));
    // one device goes from clamp to clamp: of a single clamp nine numbers say what scatter does too
    let nine = pairs().map(|pair| (parameter(pair), column(pair.0, pair.1, &|_| true))).collect();
    entries.push(Entry::new(&SENSOR_SCALE.effect, Location::AllClamps, nine));
    entries
}

/// All pairs of axes, row by row of their matrix.
fn pairs() -> impl Iterator<Item = (usize, usize)> {
    (0..9).map(|k| (k / 3, k % 3))
}

/// The inverse of what the model counts; of a matrix with intervals as wide as they are there.
fn shown_per_true(_: &CalibrationModel, parts: &[FindingPart]) -> Vec<Estimate> {
    let of_part = |part: &FindingPart| match &part.estimates[..] {
        [true_per_shown] if entry_of(&true_per_shown.name).is_none() => {
            let (value, low) = (1.0 / true_per_shown.value, 1.0 / true_per_shown.high);
            vec![Estimate { value, low, high: 1.0 / true_per_shown.low, ..true_per_shown.clone() }]
        }
        several => {
            let shown = shown_of(several);
            let turned_round = |estimate: &Estimate| {
                let value = entry_of(&estimate.name).map_or(f64::NAN, |at| shown[at]);
                let half = 0.5 * (estimate.high - estimate.low);
                Estimate { value, low: value - half, high: value + half, ..estimate.clone() }
            };
            several.iter().map(turned_round).collect()
        }
    };
    parts.iter().flat_map(of_part).collect()
}

fn entry_of(name: &str) -> Option<(usize, usize)> {
    pairs().find(|&(shown, along)| CROSS[shown][along] == name)
}

/// What is shown of a true displacement; without an inverse nothing is known of it.
fn shown_of(true_per_shown: &[Estimate]) -> Matrix3<f64> {
    let mut matrix = Matrix3::identity();
    for estimate in true_per_shown {
        if let Some(at) = entry_of(&estimate.name) {
            matrix[at] = estimate.value;
        }
    }
    matrix.try_inverse().unwrap_or(Matrix3::repeat(f64::NAN))
}

fn scale_observed(finding: &Finding, _: &CalibrationModel) -> String {
    let place = &finding.location;
    if let [only] = &finding.estimates[..] {
        let Some((shown, along)) = entry_of(&only.name) else {
            let how = only.quantity().misread();
            return format!("The displacement sensor ({place}) reads {how}");
        };
        let percent = only.quantity().map(|value| 100.0 * value).size().with_unit("%");
        let (shown, along) = (Axis::ALL[shown], Axis::ALL[along]);
        return format!(
            "The displacement sensor along {shown} also shows {percent} of a displacement along {along} ({place})"
        );
    }
    let off = |estimate: &Estimate| -> Option<((usize, usize), Quantity)> {
        let at = entry_of(&estimate.name)?;
        let right = if at.0 == at.1 { 1.0 } else { 0.0 };
        Some((at, estimate.quantity().map(|value| 100.0 * (value - right))))
    };
    let all = finding.estimates.iter().filter_map(off);
    let Some(((shown, along), percent)) =
        all.max_by(|(_, one), (_, other)| one.value.abs().total_cmp(&other.value.abs()))
    else {
        return format!("The displacement sensors of {place} read wrongly");
    };
    let (by, shown, along) = (percent.size().with_unit("%"), Axis::ALL[shown], Axis::ALL[along]);
    let largest = match (shown == along, percent.value < 0.0) {
        (true, true) => format!("by {by} too little along {shown}"),
        (true, false) => format!("by {by} too much along {shown}"),
        (false, _) => format!("{by} of a displacement along {along} along {shown}"),
    };
    format!("The displacement sensors of {place} show {largest}; this is the largest of their nine errors")
}
