//! What pulls and what bends: rod, masses and contact force.
//!
//! ```text
//! yield(p, f) = Σ_j Jⱼ·cⱼ·zⱼ·((p − oⱼ) × f)             the calibrated joints give way
//! ```

use nalgebra::Vector3;

use super::super::model::entry::linear;
use super::super::model::law::{Hung, Law, RodLoad};
use super::super::model::{CalibrationModel, Configuration};
use super::{
    CalibrationEffect, Context, Entry, Transfer, first, lack, law, no_event, out_of_the_points,
    own_parameters, single, size,
};
use crate::calibration::SOFTEST;
use crate::inference::{
    Effect, Estimate, Finding, FindingPart, Kind, Location, NotTestable, Part, Reported, WrittenTo,
};
use crate::robot::Motion;
use crate::units::DEG;

/// Share by which a rod is softer than its model.
const SOFTNESS: f64 = 0.27;
/// Mass at the tip that was forgotten, kg.
pub(in crate::diagnosis::calibration) const FORGOTTEN_AT_TIP: f64 = 0.05;
/// Share by which a rod is heavier than its file says: a tube of another wall, another alloy.
const HEAVIER: f64 = 0.3;
/// How far from level a robot stands that nobody has levelled, rad.
const LEVEL: f64 = 0.5 * DEG;

/// So many times as soft as its model a rod may seem: a force in kilograms, stated as newtons,
/// makes it ten times softer.
const MOST_SOFTNESS: f64 = 12.0;

/// A rod that is softer or stiffer than its model.
pub static ROD_STIFFNESS: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "rod_stiffness",
        kind: Kind::Physics,
        summary: "the rod is softer or stiffer than its model",
        formula: "(1/s − 1/s₀)·R·Δx: s is the rod's stiffness over that of its model, s₀ what was \
                  compensated, Δx the model's deflection under all loads or under one of them",
        prior: "27 % of deflection: 1 − 1/r is 0.27 rms over the r_rod of the paper's six rods; all \
                of it where the rod was assumed rigid",
        parameters: &[(&["factor"], "s: stiffness over that of the model")],
        needs: "a rod in the campaign",
        cause: "a rod stiffness that differs from its model",
        cause_at: |_| "a rod of another stiffness".into(),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some(
            "Hang known weights on the rod and measure its stiffness with rodcal rig \
            fit.",
        ),
    },
    candidates: rods,
    estimates: stiffness,
    observed: rod_observed,
    write: out_of_the_points,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn rods(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    if context.deflection.is_empty() {
        lacks.push(lack(&ROD_STIFFNESS, "the campaign names no rod"));
        return Vec::new();
    }
    let under = |load: RodLoad| {
        let mut factor = linear("factor", SOFTNESS);
        factor.neutral = context.accounted;
        // a rod that was assumed rigid bends by all of its model
        factor.size = factor.size.max(1.0 - context.accounted);
        factor.bounds = (0.0, MOST_SOFTNESS);
        let column = context.column(|row, _| {
            let [by_contact, by_weight] = context.deflection[row];
            match load {
                RodLoad::All => by_contact + by_weight,
                RodLoad::Contact => by_contact,
            }
        });
        let location = match load.description() {
            None => Location::Part(Part::Rod),
            Some(load) => Location::Form { part: Part::Rod, form: load.into() },
        };
        single(&ROD_STIFFNESS, location, factor, column).by(Law::Rod(load))
    };
    [RodLoad::All, RodLoad::Contact].map(under).into()
}

/// The model counts by how much more a rod bends, which its columns are linear in; people count its
/// stiffness, as on a rig.
fn stiffness(_: &CalibrationModel, parts: &[FindingPart]) -> Vec<Estimate> {
    let softness = parts.iter().flat_map(|part| part.estimates.clone());
    let inverse = |soft: Estimate| Estimate {
        value: 1.0 / soft.value,
        low: 1.0 / soft.high,
        high: 1.0 / soft.low,
        ..soft
    };
    softness.map(inverse).collect()
}

fn rod_observed(finding: &Finding, model: &CalibrationModel) -> String {
    let under = match law(finding, model) {
        Law::Rod(load) => load.description(),
        Law::Only
        | Law::Gear(_)
        | Law::Play(_)
        | Law::Nonlinear(_)
        | Law::MassesUnknown(_)
        | Law::Hung(_)
        | Law::Drift(..)
        | Law::Warms(..)
        | Law::Bends(_)
        | Law::Moved(_)
        | Law::Axes(_) => None,
    };
    let under = under.map_or_else(String::new, |under| format!(" {under}"));
    let softer = first(finding).map(|stiffness| 1.0 / stiffness).compared("softer", "stiffer");
    format!("The rod is {softer} than its model{under}")
}

/// `12 ± 2 g more`.
pub(super) fn heavier(finding: &Finding, unit: &str) -> String {
    let mass = first(finding);
    format!("{} {}", mass.size().with_unit(unit), if mass.value < 0.0 { "less" } else { "more" })
}

/// Displacement of the tip by one more force on it, m: the rod bends and the joints give way.
pub(super) fn pulled(context: &Context, there: &Configuration, force: &Vector3<f64>) -> Vector3<f64> {
    there.in_world(&context.force_compliance) * force + there.joint_deflection(&there.tip, force)
}

/// True where something is known to give way to a force on the tip.
pub(super) fn gives_way(context: &Context) -> bool {
    context.force_compliance.amax() > 0.0 || joints_give_way(context)
}

pub(super) fn joints_give_way(context: &Context) -> bool {
    context.configurations.first().is_some_and(|there| there.compliance.iter().any(|&c| c != 0.0))
}

/// A rod that is heavier than its file says.
pub static ROD_MASS: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "rod_mass",
        kind: Kind::Physics,
        summary: "the rod is heavier or lighter than its file says",
        formula: "(x − 1)·(R·C^g_r·Rᵀ·g + yield(centre, m_r·g)): x is the rod's mass over that of its file; C^g_r, \
                  m_r and centre are the rod's without what is at its tip",
        prior: "30 %: a tube of another wall, another alloy; its density alone is known to 1 %",
        parameters: &[(&["factor"], "x: mass over that of the rod file, without what is at the tip")],
        needs: "a rod in the campaign",
        cause: "a wall, a density or a part that is not in the file",
        cause_at: |_| "a rod of another mass".into(),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Weigh the rod."),
    },
    candidates: rod_masses,
    estimates: own_parameters,
    observed: |finding, _| {
        format!("The rod weighs {} times what its file says", first(finding).with_unit(""))
    },
    write: out_of_the_points,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn rod_masses(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let Some(rod) = &context.own_weight else {
        lacks.push(lack(&ROD_MASS, "the campaign names no rod"));
        return Vec::new();
    };
    let column = context.column(|_, there| {
        let centre = there.flange.point(&rod.body.centre);
        let weight = there.gravity * rod.body.mass;
        there.in_world(&rod.compliance) * there.gravity + there.joint_deflection(&centre, &weight)
    });
    let mut factor = linear("factor", HEAVIER);
    factor.neutral = 1.0;
    factor.bounds = (0.0, 10.0);
    vec![single(&ROD_MASS, Location::Part(Part::Rod), factor, column).by(Law::Hung(Hung::Rod))]
}

/// A mass at the tip that was forgotten.
pub static TIP_MASS: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "tip_mass",
        kind: Kind::Physics,
        summary: "a mass at the tip that the files do not state",
        formula: "R·C^F·Rᵀ·(m·g) + yield(tip, m·g)",
        prior: "50 g: the paper's ball and holder have 55 g",
        parameters: &[(&["mass_g"], "mass beyond the stated one")],
        needs: "a rod or joints of known compliance",
        cause: "a mass that the files do not state",
        cause_at: |_| "a mass at the tip".into(),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Weigh the ball with its holder."),
    },
    candidates: tip_masses,
    estimates: own_parameters,
    observed: |finding, _| format!("The tip carries {} than stated", heavier(finding, "g")),
    write: out_of_the_points,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn tip_masses(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    if !gives_way(context) {
        lacks.push(lack(&TIP_MASS, "there is neither a rod nor a joint of known compliance"));
        return Vec::new();
    }
    let column = context.column(|_, there| pulled(context, there, &there.gravity));
    let mut mass = linear("mass_g", FORGOTTEN_AT_TIP);
    // no less can hang there than nothing
    mass.bounds.0 = -context.modelled_mass.0;
    vec![single(&TIP_MASS, Location::Part(Part::Tip), mass, column).by(Law::Hung(Hung::Tip))]
}

/// A robot that does not stand level.
///
/// A level robot's weight puts no torque on a joint about a vertical axis, so that nobody knows how
/// its drive gives way; on one that is not level it does: J·(c·φ)·z·(S × g) with an unknown c.
pub static GRAVITY_DIRECTION: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "gravity_direction",
        kind: Kind::Physics,
        summary: "the robot does not stand level: gravity acts along another direction",
        formula: "R·C^g·Rᵀ·δg + Σ_j Jⱼ·cⱼ·zⱼ·(Sⱼ × δg): δg = φ × g, φ about x and y of {0}; Sⱼ the first \
                  moment of all that hangs beyond joint j; of a joint about a vertical axis, which no \
                  level robot loads, c is not known",
        prior: "0.5°: a foot that was set up without a level",
        parameters: &[
            (&["roll_deg"], "rotation of gravity about x of the base"),
            (&["pitch_deg"], "rotation of gravity about y of the base"),
        ],
        needs: "a rod, or masses in the robot file and joints of known compliance",
        cause: "a base that does not stand level",
        cause_at: |_| "a base that does not stand level".into(),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Put a level on the robot's foot."),
    },
    candidates: levels,
    estimates: level,
    observed: |finding, _| {
        let angle = size(finding, DEG).with_unit("°");
        format!("Gravity is inclined by {angle} to where the base says it acts")
    },
    write: out_of_the_points,
    transfer: Transfer::Candidate,
    event: no_event,
};

/// Roll and pitch; what an upright joint adds is no angle.
fn level(model: &CalibrationModel, parts: &[FindingPart]) -> Vec<Estimate> {
    let mut estimates = own_parameters(model, parts);
    estimates.truncate(2);
    estimates
}

/// True for a joint about whose axis the masses of the file have no torque worth mentioning.
fn is_upright(context: &Context, joint: usize) -> bool {
    let moment = |there: &Configuration| there.first_moment[joint].cross(&there.gravity);
    let about = context.largest(|there| there.axis[joint].dot(&moment(there)));
    let whole = context.largest(|there| there.first_moment[joint].norm() * there.gravity.norm());
    context.motions[joint] == Motion::Revolute && whole > 0.0 && about < LEVEL * whole
}

fn levels(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let pulls = |there: &Configuration| there.first_moment.iter().any(|moment| moment.amax() > 0.0);
    let has_arm = joints_give_way(context) && context.configurations.iter().any(pulls);
    if context.weight_compliance.amax() == 0.0 && !has_arm {
        let reason = "there is neither a rod nor a joint of known compliance that carries a known mass";
        lacks.push(lack(&GRAVITY_DIRECTION, reason));
        return Vec::new();
    }
    let turned = |there: &Configuration, axis: usize| there.base.rotation.column(axis).cross(&there.gravity);
    let of_axes = || ["roll_deg", "pitch_deg"].into_iter().enumerate();
    let about = |(axis, name): (usize, &str)| {
        let column = context.column(|_, there| {
            let turned = turned(there, axis);
            there.in_world(&context.weight_compliance) * turned + there.joint_deflection_by_weight(&turned)
        });
        (linear(name, LEVEL), column)
    };
    let mut parameters: Vec<_> = of_axes().map(about).collect();
    for joint in (0..context.joint_count()).filter(|joint| has_arm && is_upright(context, *joint)) {
        let gives_way = |(axis, name): (usize, &str)| {
            let column = context.turn(joint, |_, there| {
                there.axis[joint].dot(&there.first_moment[joint].cross(&turned(there, axis)))
            });
            let usual = context.softest[joint] / SOFTEST;
            (linear(format!("joint_{}_{name}_urad_per_nm", joint + 1), LEVEL * usual), column)
        };
        parameters.extend(of_axes().map(gives_way));
    }
    vec![Entry::new(&GRAVITY_DIRECTION.effect, Location::Part(Part::Base), parameters)]
}
