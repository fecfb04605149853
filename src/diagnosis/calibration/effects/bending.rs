//! Links that bend.

use super::super::model::entry::{at_least, linear};
use super::super::model::law::Law;
use super::super::model::{CalibrationModel, Configuration};
use super::joints::{DEFLECTION, NO_MASSES, loaded};
use super::{
    CalibrationEffect, Context, Entry, Transfer, along, first, first_value, in_file, joint, joint_by, lack,
    law, no_event, on_top, own_parameters, single,
};
use crate::calibration::campaign::Campaign;
use crate::inference::{Effect, Finding, JointVariable, Kind, NotTestable, Reported, WrittenTo};
use crate::robot::{self, across};
use crate::units::{MM, significant};

/// Distance below which two points of an axis are one, m.
const ONE_POINT: f64 = 0.05;

/// A link that bends across its joint's axis.
pub static LINK_FLEXIBILITY: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "link_flexibility",
        kind: Kind::Physics,
        summary: "a link bends",
        formula: "(k·M⊥) × (tip − p): M⊥ is the moment about p of all beyond the joint, without what \
                  acts about its axis; p the point of that axis next to the joint before (its \
                  origin), or next to the one behind",
        prior: "200 µrad at the largest moment, as joint_compliance",
        parameters: &[(&["bending_urad_per_nm"], "angle per moment")],
        needs: "masses in the robot file, and a joint that they load",
        cause: "the flexibility of the link",
        cause_at: |location| format!("bending of the link before {location}"),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: |location| along(location, JointVariable::Torque),
        direct_check: None,
    },
    candidates: links,
    estimates: own_parameters,
    observed: |finding, model| {
        let at = at(law(finding, model));
        let known = |joint: usize| bending_in_file(&model.campaign.robot.effects, joint, at);
        let known = finding.location.joint().map_or(0.0, known);
        let (place, by, unit) = (&finding.location, first(finding), "µrad/(N·m)");
        let point = match at == 0.0 {
            true => String::new(),
            false => format!(", {} mm along its axis", significant(at / MM, 3)),
        };
        let plain = || {
            format!(
                "The link before {} bends by {} under the moment there{point}",
                place.place(),
                by.with_unit(unit)
            )
        };
        on_top(&format!("The bending of the link before {place}"), by, unit, known).unwrap_or_else(plain)
    },
    write: write_link,
    transfer: Transfer::Candidate,
    event: no_event,
};

/// Where on the axis, from the joint's origin, m.
fn at(law: &Law) -> f64 {
    match law {
        Law::Bends(at) => *at,
        Law::Only
        | Law::Gear(_)
        | Law::Play(_)
        | Law::Nonlinear(_)
        | Law::MassesUnknown(_)
        | Law::Rod(_)
        | Law::Hung(_)
        | Law::Drift(..)
        | Law::Warms(..)
        | Law::Moved(_)
        | Law::Axes(_) => 0.0,
    }
}

/// k, rad/(N·m).
fn bending_in_file(effects: &[robot::Effect], own: usize, point: f64) -> f64 {
    in_file(effects, |effect| match effect {
        robot::Effect::LinkFlexibility { joint, per_nm, at }
            if *joint == own && (at - point).abs() < ONE_POINT =>
        {
            Some(*per_nm)
        }
        _ => None,
    })
}

fn write_link(finding: &Finding, model: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let Some(joint) = finding.location.joint() else { return WrittenTo::Nowhere };
    let (per_nm, at) = (first_value(finding), at(law(finding, model)));
    extended.robot.effects.push(robot::Effect::LinkFlexibility { joint, per_nm, at });
    WrittenTo::Model
}

fn links(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let loaded = loaded(context);
    if loaded.is_empty() {
        lacks.push(lack(&LINK_FLEXIBILITY, NO_MASSES));
    }
    let of_joint = |(j, _): (usize, f64)| {
        let points = points(context, j);
        let share = 1.0 / points.len() as f64;
        points.into_iter().filter_map(move |at| {
            let mut entry = link(context, j, at)?;
            entry.candidate.weight = share;
            Some(entry)
        })
    };
    loaded.into_iter().flat_map(of_joint).collect()
}

/// Where a link may bend, along its joint's axis from the joint's origin, m: that is next to the
/// axis of the joint before, and the other point next to that of the joint behind. A URDF, or a
/// drawing, may have the joint at either, which lie as far apart as a forearm is long.
fn points(context: &Context, j: usize) -> Vec<f64> {
    let behind = |there: &Configuration| {
        let next = there.origin.get(j + 1).unwrap_or(&there.flange.origin);
        there.axis[j].dot(&(next - there.origin[j]))
    };
    let other = context.configurations.first().map(behind).filter(|at| at.abs() > ONE_POINT);
    [0.0].into_iter().chain(other).collect()
}

fn link(context: &Context, j: usize, at: f64) -> Option<Entry> {
    let point = |there: &Configuration| there.origin[j] + there.axis[j] * at;
    let bent = |there: &Configuration| {
        let moment = there.moment[j] - (there.axis[j] * at).cross(&there.force[j]);
        across(&moment, &there.axis[j])
    };
    let largest = context.largest(|there| bent(there).norm());
    let column = context.column(|_, there| bent(there).cross(&(there.tip - point(there))));
    let size = DEFLECTION / largest.max(f64::MIN_POSITIVE);
    let known = bending_in_file(context.effects, j, at);
    let bending = at_least(-known, linear("bending_urad_per_nm", size));
    let place = match at == 0.0 {
        true => joint(j),
        false => joint_by(j, format!("{} mm along its axis", significant(at / MM, 3))),
    };
    (largest > 0.0).then(|| single(&LINK_FLEXIBILITY, place, bending, column).by(Law::Bends(at)))
}
