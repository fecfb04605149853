//! What the device pushes the ball with.

use nalgebra::Vector3;

use super::super::model::entry::linear;
use super::super::model::vector::component;
use super::super::model::{CalibrationModel, Configuration};
use super::loads::{gives_way, pulled};
use super::{
    CalibrationEffect, Context, Entry, Transfer, first, lack, no_event, out_of_the_points, own_parameters,
    single, size,
};
use crate::inference::{Effect, Finding, Kind, Location, NotTestable, Reported, WrittenTo};
use crate::units::{DEG, GRAM};

/// Error of a contact force, N.
const CONTACT: f64 = 0.3;
/// Frames whose verticals differ by less stand on the same edge, rad.
const SAME_EDGE: f64 = 5.0 * DEG;
/// Rate of a sensor's spring, N/m.
const RATE: f64 = 100.0;

/// A ball that is pushed harder or softer than stated.
pub static CONTACT_FORCE_VARIATION: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "contact_force_variation",
        kind: Kind::Physics,
        summary: "the contact force is not the stated one",
        formula: "R·C^F·Rᵀ·F + yield(tip, F): F in the device frame of the clamp",
        prior: "0.3 N: sensor springs are stated to 10 or 20 % of 2 N",
        parameters: &[
            (&["x_n"], "force beyond the stated one along x of the device frame"),
            (&["y_n"], "force beyond the stated one along y of the device frame"),
            (&["z_n"], "force beyond the stated one along z of the device frame"),
        ],
        needs: "clamps, and a rod or joints of known compliance",
        cause: "a contact force that differs from the stated one",
        cause_at: |location| format!("a contact force that differs from the stated one ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Measure the contact force with a spring balance."),
    },
    candidates: contacts,
    estimates: own_parameters,
    observed: contact_observed,
    write: out_of_the_points,
    transfer: Transfer::Nothing,
    event: no_event,
};

fn contacts(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let groups = &context.recording.groups;
    if !is_of_clamps(context) || !gives_way(context) {
        let reason = "there are no clamps, or neither a rod nor a joint of known compliance";
        lacks.push(lack(&CONTACT_FORCE_VARIATION, reason));
        return Vec::new();
    }
    let at = |location: Location, is_there: &dyn Fn(usize) -> bool| {
        let along = |(axis, name): (usize, &str)| {
            let push = |row: usize| {
                let group = context.recording.rows[row].group;
                is_there(group).then(|| groups[group].device.rotation.column(axis).into())
            };
            (linear(name, CONTACT), context.column(|row, there| pushed(context, there, push(row))))
        };
        let parameters = ["x_n", "y_n", "z_n"].into_iter().enumerate().map(along).collect();
        Entry::new(&CONTACT_FORCE_VARIATION.effect, location, parameters)
    };
    at_clamps(context, at)
}

/// What one more force on the ball, N in {W}, does to it.
fn pushed(context: &Context, there: &Configuration, force: Option<Vector3<f64>>) -> Vector3<f64> {
    force.map_or_else(Vector3::zeros, |force| pulled(context, there, &force))
}

/// The same at all clamps, and at each where there are several.
pub(super) fn at_clamps(
    context: &Context,
    at: impl Fn(Location, &dyn Fn(usize) -> bool) -> Entry,
) -> Vec<Entry> {
    let groups = &context.recording.groups;
    let mut entries = vec![at(Location::AllClamps, &|_| true)];
    if groups.len() > 1 {
        let named = |k: usize| at(Location::Named(groups[k].name.to_string()), &|group| group == k);
        entries.extend((0..groups.len()).map(named));
    }
    entries
}

fn contact_observed(finding: &Finding, model: &CalibrationModel) -> String {
    let at = match &finding.location {
        Location::AllClamps => "In all clamps".to_owned(),
        clamp => format!("At {clamp}"),
    };
    let by = size(finding, 1.0).with_unit("N");
    format!("{at} the contact force differs by {by} from the stated one{}", like_a_mass(finding, model))
}

/// What of it a mass at the tip would do as well. Where all clamps stand on the same edge, no pose
/// can tell them apart:
///
/// ```text
/// F·ĝ = m·g,    ĝ gravity's direction in the frame of every device
/// ```
fn like_a_mass(finding: &Finding, model: &CalibrationModel) -> String {
    let (true, [part]) = (finding.location == Location::AllClamps, &finding.parts[..]) else {
        return String::new();
    };
    let setup = &model.calibration.setup;
    let gravity = setup.base().rotation * setup.robot.gravity;
    let down = gravity.try_normalize(0.0).unwrap_or_default();
    let mut verticals =
        (model.campaign.measurements.groups.iter()).map(|group| group.device.rotation.tr_mul(&down));
    let Some(first) = verticals.next() else { return String::new() };
    let along = component(part, &first);
    let is_alike = first.norm() > 0.5 && verticals.all(|other| other.dot(&first) > SAME_EDGE.cos());
    let is_seen = along.low > 0.0 || along.high < 0.0;
    if !is_alike || !is_seen {
        return String::new();
    }
    let way = if along.value < 0.0 { ("up", "less") } else { ("down", "more") };
    let mass = along.map(|force| force / gravity.norm() / GRAM).size().with_unit("g");
    let force = along.size().with_unit("N");
    format!("; {force} of that, {}wards, {mass} {} at the tip would do as well", way.0, way.1)
}

/// A device whose springs push harder the farther they are pressed.
pub static CONTACT_SPRING: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "contact_spring",
        kind: Kind::Physics,
        summary: "the contact force changes with the ball's displacement",
        formula: "R·C^F·Rᵀ·k·u + yield(tip, k·u): u the displacement in the device frame, so that \
                  the force is F₀ + k·u; k < 0 pushes back",
        prior: "0.1 N/mm: springs of plunger gauges have 0.05 to 0.3",
        parameters: &[(&["n_per_mm"], "k: change of the force per displacement")],
        needs: "clamps, displacements that differ by more than a tenth of a millimetre, and a rod or joints \
                of known compliance",
        cause: "springs of the device, whose force changes with the displacement",
        cause_at: |location| format!("springs of the device ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Measure the contact force at two displacements with a spring balance."),
    },
    candidates: springs,
    estimates: own_parameters,
    observed: spring_observed,
    write: out_of_the_points,
    transfer: Transfer::Nothing,
    event: no_event,
};

fn springs(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    if context.has_sockets() {
        return Vec::new();
    }
    if !is_of_clamps(context) || !gives_way(context) {
        let reason = "there are no clamps, or neither a rod nor a joint of known compliance";
        lacks.push(lack(&CONTACT_SPRING, reason));
        return Vec::new();
    }
    if !context.shows_displacements() {
        lacks
            .push(lack(&CONTACT_SPRING, "the displacements vary by less than some three times what is left"));
        return Vec::new();
    }
    let displacement = |row: usize| context.recording.device(row).rotation * context.displacement(row);
    at_clamps(context, |location, is_there| {
        let push = |row: usize| is_there(context.recording.rows[row].group).then(|| displacement(row));
        let column = context.column(|row, there| pushed(context, there, push(row)));
        single(&CONTACT_SPRING, location, linear("n_per_mm", RATE), column)
    })
}

pub(in crate::diagnosis::calibration) fn is_of_clamps(context: &Context) -> bool {
    !context.has_sockets() && context.recording.groups.iter().any(|group| !group.name.is_tracked())
}

fn spring_observed(finding: &Finding, _: &CalibrationModel) -> String {
    let rate = first(finding);
    let (size, way) = (rate.size().with_unit("N per mm"), if rate.value < 0.0 { "against" } else { "along" });
    format!("The contact force of {} changes by {size} of displacement, {way} it", finding.location)
}
