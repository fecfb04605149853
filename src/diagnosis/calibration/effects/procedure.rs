//! What the way of recording does: angles that are read too early, and what drifts meanwhile.

use nalgebra::Vector3;

use super::super::model::entry::{Column, linear};
use super::super::model::law::{Course, Frame, Law, Warmed};
use super::super::model::{CalibrationModel, Configuration};
use super::{
    CalibrationEffect, Context, Entry, Transfer, along, first, first_value, joint, joint_by, lack, law,
    no_event, out_of_the_points, own_parameters, single, size, three, unit,
};
use crate::calibration::campaign::{Campaign, Row};
use crate::inference::{
    Effect, Finding, JointVariable, Kind, Location, NotTestable, Part, Reported, Variable, WrittenTo,
};
use crate::robot::{self, Motion};
use crate::units::{HOUR, MM, UM};

/// Share of a move that is not made yet when an angle is read.
const LAG: f64 = 3e-4;
/// Drift, m/K.
const PER_KELVIN: f64 = 10.0 * UM;
/// Drift, m/h; the same over a whole recording without a clock.
const PER_HOUR: f64 = 20.0 * UM;
/// What a cold robot is off by, m.
const WARM_UP: f64 = 50.0 * UM;
/// Distance from one joint to the next below which there is no link to grow, m.
const LEAST_LINK: f64 = 20.0 * MM;
/// How far from the base a tracker stands, m.
const TRACKER: f64 = 3.0;
/// How often it is the scale of a tracker that grows, over how often a base drifts.
const SCALE_GROWS: f64 = 0.35;
/// How often a base turns too, over how often it drifts along fixed directions.
const TURNS: f64 = 0.35;
/// Time constants of a robot that warms up, as parts of the recording.
const WARMING: [f64; 4] = [0.03, 0.1, 0.2, 0.4];

/// Angles, or positions, that were read before the arm had settled.
pub static READBACK_LAG: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "readback_lag",
        kind: Kind::Physics,
        summary: "angles, or positions, were read before the arm had settled",
        formula: "Σ Jⱼ·f·(qⱼ − qⱼ before): f is the share of the last move that was still to come \
                  when q was read, negative where it was when the position was measured; of one joint, \
                  or of all with one share",
        prior: "3e-4: 100 to 1000 µrad of a move of 1 rad",
        parameters: &[(
            &["fraction"],
            "share of the last move that was still to come when the angles were read; \
             negative: when the position was measured",
        )],
        needs: "rows in the order of recording",
        cause: "readings before the arm had settled",
        cause_at: |location| format!("readings before the arm had settled ({location})"),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: |location| along(location, JointVariable::Move),
        direct_check: None,
    },
    candidates: lags,
    estimates: own_parameters,
    observed: lag_observed,
    write: write_lag,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn lags(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    let fraction = || linear("fraction", LAG);
    let joints: Vec<usize> = (0..context.joint_count()).collect();
    let of_all =
        context.column(|_, there| joints.iter().map(|&j| there.tip_jacobian[j] * there.step[j]).sum());
    let together = single(&READBACK_LAG, Location::AllJoints, fraction(), of_all);
    let alone = joints.iter().map(|&j| {
        let column = context.turn(j, |_, there| there.step[j]);
        single(&READBACK_LAG, joint(j), fraction(), column)
    });
    std::iter::once(together).chain(alone).collect()
}

/// The share of each move, wherever the order of the poses is known.
fn write_lag(finding: &Finding, _: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let (joint, fraction) = (finding.location.joint(), first_value(finding));
    extended.robot.effects.push(robot::Effect::Lag { joint, fraction });
    WrittenTo::Model
}

fn lag_observed(finding: &Finding, model: &CalibrationModel) -> String {
    let (whose, motion) = match finding.location.joint() {
        Some(joint) => (finding.location.to_string(), model.campaign.robot.joints[joint].motion),
        None => ("every joint".into(), Motion::Revolute),
    };
    let unit = if motion == Motion::Prismatic { "µm per metre" } else { "µrad per radian" };
    let share = first(finding);
    // the sensor that is read late shows what is still to come
    let read = if share.value < 0.0 { "positions were measured" } else { "angles were read" };
    let size = share.map(|share| 1e6 * share).size().with_unit(unit);
    format!("When the {read}, {size} of the last move of {whose} were still to come")
}

/// What follows temperature, time or order.
pub static THERMAL_DRIFT: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "thermal_drift",
        kind: Kind::Physics,
        summary: "the arm drifts with temperature, time or order",
        formula: "d·(T − T̄), d·(t − t̄) or d·e^(−t/t₁), of the robot in {W} or of its tool in {T}; the same of \
                  a joint's zero, Jⱼ·d, or of the length of its link; d·(flange − base) where all links grow; \
                  d + φ × (ball − base) where the base turns; d + k·(ball − base) where the scale of a \
                  tracker grows, k of it and d = −k·(tracker − base)",
        prior: "10 µm/K (an arm of steel of 1 m grows by 12), but 50 µm at least over the recorded \
                temperatures; 20 µm/h, as in a room that warms by \
                2 K in an hour, or over a recording without a clock; 50 µm for a cold robot (a UR5 \
                starts a recording some 60 µm off); of a joint as many µrad, of a link as many µm, of \
                the arm as many µm/m, of a base that turns as many µrad, a third as often; of a tracker \
                the third of that (3 m away it is as much: air changes its scale by 1 µm/m per kelvin, \
                what a camera is made of by more)",
        parameters: &[
            (&["x_um_per_k", "y_um_per_k", "z_um_per_k"], "displacement per kelvin"),
            (&["x_um_per_h", "y_um_per_h", "z_um_per_h"], "displacement per hour"),
            (&["x_um", "y_um", "z_um"], "displacement over the recording, or of the cold robot"),
            (&["rx_urad_per_k", "ry_urad_per_k", "rz_urad_per_k"], "rotation of the base per kelvin"),
            (&["rx_urad_per_h", "ry_urad_per_h", "rz_urad_per_h"], "the same per hour"),
            (&["rx_urad", "ry_urad", "rz_urad"], "the same over the recording, or of the cold robot"),
            (&["zero_urad_per_k", "zero_urad_per_h", "zero_urad"], "the same of a joint's zero"),
            (&["length_um_per_k", "length_um_per_h", "length_um"], "the same of a link's length"),
            (&["growth_um_per_m_per_k", "growth_um_per_m_per_h", "growth_um_per_m"], "growth of all links"),
            (
                &["scale_um_per_m_per_k", "scale_um_per_m_per_h", "scale_um_per_m"],
                "growth of a tracker's scale",
            ),
        ],
        needs: "temperatures or times of the rows; without them only the order of the rows",
        cause: "thermal drift",
        cause_at: |location| format!("drift ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| vec![Variable::Temperature, Variable::Time],
        direct_check: None,
    },
    candidates: drifts,
    estimates: own_parameters,
    observed: drift_observed,
    write: out_of_the_points,
    transfer: Transfer::Candidate,
    event: no_event,
};

/// With temperature or time where they are known, and in any case with the order; steadily, or as a
/// robot warms up.
fn drifts(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let courses = courses(context);
    if !courses.iter().any(|(course, _)| course.is_clocked()) {
        let reason = "the rows have neither temperatures nor times: only drift with their order was \
            tested";
        lacks.push(lack(&THERMAL_DRIFT, reason));
    }
    let of_course = |(course, values): (Course, Vec<f64>)| {
        let (suffix, _) = course.unit();
        let names = ["x", "y", "z"].map(|axis| format!("{axis}_{suffix}"));
        let drifting = |frame: Frame, along: &dyn Fn(&Configuration, usize) -> Vector3<f64>| {
            let column = |axis: usize| context.column(|row, there| along(there, axis) * values[row]);
            let names = [0, 1, 2].map(|axis| names[axis].as_str());
            let parameters = three(&names, usual(course, &values), column);
            let location = Location::Form { part: frame.part(), form: format!("with {course}") };
            Entry::new(&THERMAL_DRIFT.effect, location, parameters).by(Law::Drift(course, frame))
        };
        let mut entries = vec![
            drifting(Frame::World, &|_, axis| unit(axis)),
            drifting(Frame::Tool, &|there, axis| there.flange.rotation.column(axis).into()),
            of_arm(context, course, &values),
        ];
        // where sockets are nobody has measured: what turns the base are plates that moved
        entries.extend((!context.has_sockets()).then(|| of_base(context, course, &values)));
        entries.extend(context.is_tracked().then(|| of_tracker(context, course, &values)));
        entries.extend(of_joints(context, course, &values));
        entries
    };
    courses.into_iter().flat_map(of_course).collect()
}

/// All links grow by one share, as of one material that is warm throughout: (flange − base)·d.
fn of_arm(context: &Context, course: Course, values: &[f64]) -> Entry {
    let (suffix, _) = course.share_unit();
    let column = context.column(|row, there| (there.flange.origin - there.origin[0]) * values[row]);
    let location = Location::Form { part: Part::Arm, form: Warmed::Arm.form(course) };
    let parameter = linear(format!("growth_{suffix}"), usual(course, values));
    single(&THERMAL_DRIFT, location, parameter, column).by(Law::Warms(course, Warmed::Arm))
}

/// A base that turns, as on a floor that gives way, or a tracker on a tripod that settles, which
/// are the same: φ × (ball − base) + d. Where about it turns is d's.
fn of_base(context: &Context, course: Course, values: &[f64]) -> Entry {
    let size = usual(course, values);
    let (angle, length) = (course.angle_unit().0, course.unit().0);
    let names = |prefix: &str, unit: &str| ["x", "y", "z"].map(|axis| format!("{prefix}{axis}_{unit}"));
    let about = |axis: usize| {
        context.column(|row, there| unit(axis).cross(&(there.tip - there.origin[0])) * values[row])
    };
    let along = |axis: usize| context.column(|row, _| unit(axis) * values[row]);
    let (turns, moves) = (names("r", angle), names("", length));
    let mut six = three(&turns.each_ref().map(String::as_str), size, about);
    six.extend(three(&moves.each_ref().map(String::as_str), size, along));
    let location = Location::Form { part: Part::Base, form: Warmed::Turn.form(course) };
    let mut entry = Entry::new(&THERMAL_DRIFT.effect, location, six).by(Law::Warms(course, Warmed::Turn));
    entry.candidate.weight = TURNS;
    entry
}

/// The scale of a tracker grows: k·(ball − tracker). Nobody knows where it stands, so −k·(tracker −
/// base) is three numbers of their own; from far away a base that drifts does nearly the same.
fn of_tracker(context: &Context, course: Course, values: &[f64]) -> Entry {
    let (share, suffix) = (course.share_unit().0, course.unit().0);
    let size = usual(course, values);
    let grown = context.column(|row, there| (there.tip - there.origin[0]) * values[row]);
    let mut parameters = vec![(linear(format!("scale_{share}"), size / TRACKER), grown)];
    let names = ["x", "y", "z"].map(|axis| format!("{axis}_{suffix}"));
    let moved = |axis: usize| context.column(|row, _| unit(axis) * values[row]);
    parameters.extend(three(&[0, 1, 2].map(|axis| names[axis].as_str()), size, moved));
    let location = Location::Form { part: Part::Tracker, form: Warmed::Tracker.form(course) };
    let mut entry =
        Entry::new(&THERMAL_DRIFT.effect, location, parameters).by(Law::Warms(course, Warmed::Tracker));
    // a base that drifts is a tracker whose scale does not grow, and the usual case
    entry.candidate.weight = SCALE_GROWS;
    entry
}

/// A joint's zero, or the length of its link, that follows what a drift follows.
fn of_joints(context: &Context, course: Course, values: &[f64]) -> Vec<Entry> {
    let joints = context.revolute();
    let weight = 1.0 / joints.len().max(1) as f64;
    let entry = |j: usize, warmed: Warmed, name: String, column: Column| {
        let location = joint_by(j, warmed.form(course));
        let parameter = linear(name, usual(course, values));
        let mut entry = single(&THERMAL_DRIFT, location, parameter, column).by(Law::Warms(course, warmed));
        // all joints together are as likely as the whole robot
        entry.candidate.weight = weight;
        entry
    };
    let zero = |j: usize| {
        let (suffix, _) = course.angle_unit();
        let column = context.turn(j, |row, _| values[row]);
        entry(j, Warmed::Zero, format!("zero_{suffix}"), column)
    };
    let length = |j: usize| {
        let (suffix, _) = course.unit();
        let next = |there: &Configuration| there.origin.get(j + 1).copied().unwrap_or(there.flange.origin);
        let is_long = context.largest(|there| (next(there) - there.origin[j]).norm()) > LEAST_LINK;
        let column = context.column(|row, there| {
            let along = (next(there) - there.origin[j]).try_normalize(0.0).unwrap_or_default();
            along * values[row]
        });
        is_long.then(|| entry(j, Warmed::Length, format!("length_{suffix}"), column))
    };
    joints.iter().flat_map(|&j| [Some(zero(j)), length(j)]).flatten().collect()
}

/// Usual size of a drift's parameters, SI. Where a thermometer hardly moves, which may hang far
/// from the robot, what a cold robot is off by went with what it moved.
fn usual(course: Course, values: &[f64]) -> f64 {
    let range = values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - values.iter().copied().fold(f64::INFINITY, f64::min);
    match course {
        Course::Order => PER_HOUR,
        Course::WarmUp(_) => WARM_UP,
        Course::Temperature => PER_KELVIN.max(WARM_UP / range.max(f64::MIN_POSITIVE)),
        Course::Time => PER_HOUR / HOUR,
    }
}

/// How a drift may go: its value by row less the mean of the recording that it was found in.
fn courses(context: &Context) -> Vec<(Course, Vec<f64>)> {
    let (rows, since) = (&context.recording.rows, &context.since.rows);
    let is_later = !std::ptr::eq(context.recording, context.since);
    let known = |number: fn(&Row) -> Option<f64>| -> Option<[Vec<f64>; 2]> {
        let of_rows = |rows: &[Row]| rows.iter().map(number).collect::<Option<Vec<f64>>>();
        Some([of_rows(since)?, of_rows(rows)?])
    };
    let time = known(|row| row.time);
    // what is asked for later is set, not read from a display
    let asked = || rows.iter().map(|row| row.temperature).collect();
    let own = if is_later { asked() } else { context.recording.temperatures() };
    let temperature: Option<[Vec<f64>; 2]> = context.since.temperatures().zip(own).map(<[_; 2]>::from);
    // a recording without a clock drifts from its first to its last row; what comes later goes on
    let count = |from: usize, rows: usize| (from..from + rows).map(|row| row as f64).collect();
    let order = || [count(0, since.len()), count(if is_later { since.len() } else { 0 }, rows.len())];
    let clock = time.clone().unwrap_or_else(order);
    let start = clock[0].iter().copied().fold(f64::INFINITY, f64::min);
    let end = clock[0].iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let share = |t: f64| (t - start) / (end - start).max(f64::MIN_POSITIVE);
    let less_mean = |[since, own]: [Vec<f64>; 2]| -> Vec<f64> {
        let mean = since.iter().sum::<f64>() / since.len().max(1) as f64;
        own.into_iter().map(|value| value - mean).collect()
    };
    let by_clock = |course: &dyn Fn(f64) -> f64| {
        let values = |times: Vec<f64>| times.into_iter().map(|t| course(share(t))).collect();
        less_mean(clock.clone().map(values))
    };
    let mut courses = vec![(Course::Order, by_clock(&|share| share))];
    courses.extend(WARMING.map(|part| (Course::WarmUp(part), by_clock(&|share| (-share / part).exp()))));
    courses.extend(temperature.map(|values| (Course::Temperature, less_mean(values))));
    courses.extend(time.map(|values| (Course::Time, less_mean(values))));
    courses
}

fn drift_observed(finding: &Finding, model: &CalibrationModel) -> String {
    let si = finding.estimates.first().map_or(1.0, |estimate| estimate.unit.si);
    let size = size(finding, si);
    match law(finding, model) {
        Law::Drift(course, frame) => {
            let (_, unit) = course.unit();
            format!("The {} drifts by {} with {course}", frame.part(), size.with_unit(unit))
        }
        Law::Warms(course, Warmed::Zero) => {
            let by = first(finding).with_unit(course.angle_unit().1);
            format!("The zero of {} drifts by {by} with {course}", finding.location)
        }
        Law::Warms(course, Warmed::Length) => {
            let by = first(finding).with_unit(course.unit().1);
            format!("The link of {} grows by {by} with {course}", finding.location)
        }
        Law::Warms(course, Warmed::Arm) => {
            let by = first(finding).with_unit(course.share_unit().1);
            format!("The arm grows by {by} with {course}, all its links alike")
        }
        Law::Warms(course, Warmed::Tracker) => {
            let by = first(finding).with_unit(course.share_unit().1);
            format!("The scale of the tracker grows by {by} with {course}")
        }
        Law::Warms(course, Warmed::Turn) => {
            let by = size.with_unit(course.angle_unit().1);
            format!("The base turns against what measures it by {by} with {course}")
        }
        Law::Only
        | Law::Gear(_)
        | Law::Play(_)
        | Law::Nonlinear(_)
        | Law::MassesUnknown(_)
        | Law::Rod(_)
        | Law::Hung(_)
        | Law::Bends(_)
        | Law::Moved(_)
        | Law::Axes(_) => {
            format!("Drift by {} at {}", size.with_unit("µm"), finding.location)
        }
    }
}
