//! What happened at single poses.

use super::{
    CalibrationEffect, Context, Entry, MOST_PLACES, SHIFT, Transfer, capital, out_of_the_points,
    own_parameters, three, unit,
};
use crate::diagnosis::calibration::model::CalibrationModel;
use crate::diagnosis::calibration::vector;
use crate::inference::{Effect, Finding, FindingPart, Kind, Location, NotTestable, Reported, WrittenTo};
use crate::units::{MM, UM};

/// A pose that was read wrongly, m.
pub(in crate::diagnosis::calibration) const MISREAD: f64 = 0.5 * MM;
/// Most outliers that are reported one by one.
const REPORTED: usize = 3;

/// A pose that is wrong.
pub static OUTLIER: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "outlier",
        kind: Kind::Event,
        summary: "a pose was misread or disturbed",
        formula: "t at one row",
        prior: "0.5 mm: a reading that is wrong by a tooth or by a digit",
        parameters: &[
            ("dx_um", "displacement along x of {W}"),
            ("dy_um", "displacement along y of {W}"),
            ("dz_um", "displacement along z of {W}"),
        ],
        needs: "poses",
        cause: "a misread or disturbed pose",
        cause_at: |location| format!("a misreading of {location}"),
        written_to: WrittenTo::Recording,
        reported: Reported::Together,
        seen_along: |_| Vec::new(),
        direct_check: None,
    },
    candidates: far_out,
    estimates: own_parameters,
    observed: misread,
    write: out_of_the_points,
    transfer: Transfer::Nothing,
    event: |location| Some(location.to_string()),
};

/// The rows that are farthest out, in their order: no other is an outlier.
fn far_out(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    let mut rows: Vec<usize> = (0..context.configurations.len()).collect();
    rows.sort_by(|&a, &b| context.deviation(b).total_cmp(&context.deviation(a)));
    rows.truncate(MOST_PLACES);
    rows.sort_unstable();
    let at = |row: usize| {
        let moved = |axis: usize| context.part(row..row + 1, |_, _| unit(axis));
        let location = Location::Pose { row, name: context.pose_name(row) };
        Entry::new(&OUTLIER.effect, location, three(&SHIFT, UM, MISREAD, moved))
    };
    rows.into_iter().map(at).collect()
}

/// The strongest of them one by one.
fn misread(finding: &Finding, _: &CalibrationModel) -> String {
    let one = |(k, part): (usize, &FindingPart)| {
        let pose = if k == 0 { capital(&part.location) } else { part.location.to_string() };
        format!("{pose} is off by {}", vector::size(part, UM).say("µm"))
    };
    let reported: Vec<String> = finding.parts.iter().take(REPORTED).enumerate().map(one).collect();
    let more = match finding.parts.len().saturating_sub(REPORTED) {
        0 => String::new(),
        more => format!(" and {more} more {} off", if more == 1 { "is" } else { "are" }),
    };
    reported.join(", ") + &more
}
