//! What happened at single poses, and to a joint after one of them.

use super::super::model::CalibrationModel;
use super::super::model::entry::linear;
use super::super::model::law::Law;
use super::super::model::vector;
use super::fixture::places_of_all;
use super::{
    CalibrationEffect, Context, Entry, KNOCK, MOST_PLACES, SHIFT, Transfer, first, first_value,
    out_of_the_points, own_parameters, single, three, unit,
};
use crate::calibration::Campaign;
use crate::inference::{
    Candidate, Effect, Finding, FindingPart, Kind, Location, NotTestable, Reported, WrittenTo,
};
use crate::units::{DEG, MM, UM, capital};

/// A pose that was read wrongly, m.
pub(in crate::diagnosis::calibration) const MISREAD: f64 = 0.5 * MM;
/// A joint that slips by more is a mistake in some rows, or something else, rad.
const FARTHEST_SLIP: f64 = DEG;
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
            (&["dx_um"], "displacement along x of {W}"),
            (&["dy_um"], "displacement along y of {W}"),
            (&["dz_um"], "displacement along z of {W}"),
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
        Entry::new(&OUTLIER.effect, location, three(&SHIFT, MISREAD, moved))
    };
    rows.into_iter().map(at).collect()
}

/// The strongest of them one by one.
fn misread(finding: &Finding, _: &CalibrationModel) -> String {
    let one = |(k, part): (usize, &FindingPart)| {
        let pose = if k == 0 { capital(&part.location) } else { part.location.to_string() };
        format!("{pose} is off by {}", vector::size(part, UM).with_unit("µm"))
    };
    let reported: Vec<String> = finding.parts.iter().take(REPORTED).enumerate().map(one).collect();
    let more = match finding.parts.len().saturating_sub(REPORTED) {
        0 => String::new(),
        more => format!(" and {more} more {} off", if more == 1 { "is" } else { "are" }),
    };
    reported.join(", ") + &more
}

/// A joint whose zero is another one from some pose on.
pub static JOINT_SHIFT: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "joint_shift",
        kind: Kind::Event,
        summary: "the zero of a joint moved after one pose",
        formula: "Jⱼ·δ from some row on: δ is by how much more the joint turns than it shows",
        prior: "0.5 mrad: a slip of an encoder's coupling that nobody sees; from 0.05° on it is a mistake in some rows",
        parameters: &[(&["zero_urad"], "shift of the joint's zero")],
        needs: "poses in the order of recording",
        cause: "a slip of the joint or of its encoder",
        cause_at: |location| format!("a shift of a joint's zero ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Drive the joint to its mark, or calibrate once more."),
    },
    candidates: slipped_joints,
    estimates: own_parameters,
    observed: |finding, _| match &finding.location {
        Location::JointAfter { joint, after, .. } => {
            format!(
                "The zero of joint {} moved by {} after {after}",
                joint + 1,
                first(finding).with_unit("µrad")
            )
        }
        other => format!("The zero of a joint moved by {}, {other}", first(finding).with_unit("µrad")),
    },
    write: into_the_angles,
    transfer: Transfer::Made(stays_slipped),
    event: |location| location.joint().map(|joint| format!("joint {} slipped", joint + 1)),
};

fn slipped_joints(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    let places = places_of_all(context);
    let Some(&first) = places.iter().min() else { return Vec::new() };
    let of_joint = |joint: usize| {
        let at = |row: usize| Location::JointAfter { joint, row, after: context.pose_name(row) };
        let always = slipped(context, joint, first, at(first - 1));
        places.iter().map(|&before| always.starting_at(before, at(before - 1))).collect::<Vec<_>>()
    };
    context.revolute().into_iter().flat_map(of_joint).collect()
}

/// The recorded angles of that joint as they were meant: also in sockets, which have no points.
fn into_the_angles(finding: &Finding, _: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let Location::JointAfter { joint, row, .. } = finding.location else { return WrittenTo::Nowhere };
    let recording = &mut extended.measurements;
    let count = recording.joint_count.max(1);
    for angles in std::iter::once(&mut recording.joint_values).chain(&mut recording.joints_read) {
        let later = angles.chunks_exact_mut(count).skip(row + 1);
        later.for_each(|angles| angles[joint] += first_value(finding));
    }
    WrittenTo::Recording
}

/// A joint with another zero from some row on.
fn slipped(context: &Context, joint: usize, from: usize, location: Location) -> Entry {
    let column = context.turn_from(joint, from, |_, _| 1.0);
    let mut zero = linear("zero_urad", KNOCK.1);
    zero.bounds = (-FARTHEST_SLIP, FARTHEST_SLIP);
    single(&JOINT_SHIFT, location, zero, column)
}

/// The joint keeps the zero that it slipped to.
fn stays_slipped(context: &Context, candidate: &Candidate, _: &Law) -> Entry {
    let joint = candidate.location.joint().unwrap_or_default();
    slipped(context, joint, 0, candidate.location.clone())
}
