//! What the rod is: moduli, joints, root, bend.

use super::entry::{
    Context, Entry, NOT_NEGATIVE, RigEffect, SCALES, Usual, along_the_load, by_action, candidate, entry,
    number, parameter, preferring, size,
};
use super::places::{sessions, stations};
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mechanics::structure::{Deformation, Structure, with_moduli};
use crate::diagnosis::rig::model::{Body, RigModel};
use crate::inference::{
    Candidate, Effect, Finding, ForwardModel, Kind, Location, Part, Quantity, Reported, Term, WrittenTo,
};
use crate::rod::{self, BendFlexibility, Rod};
use crate::units::{MM, significant};

/// Share by which a rod is softer than its model: 1 − 1/r is 0.27 rms over the r_rod of the paper's
/// six rods (1.013 to 2.302).
const SOFTNESS: f64 = 0.27;
/// Compliance of a joint or a flange as a share of the rod's own, ∫ds/EI: 0.2 as at the corner of
/// the paper's rod 2#, with the reconstructed sections (6.5 of 30 µrad/(N·m)).
const JOINT: f64 = 0.2;
/// Least departure of a bend's flexibility factor; else von Kármán's for the section counts.
const BEND: f64 = 0.3;

const NOT_YIELDING: &str = "these loads do not deform it";

/// Moduli, or walls, of the whole rod.
pub static STIFFNESS_SCALE: RigEffect = RigEffect {
    effect: Effect {
        name: "stiffness_scale",
        kind: Kind::Physics,
        summary: "the whole rod is softer or stiffer than stated",
        formula: "E → f·E, G → f·G in all pipes",
        prior: "27 %: 1 − 1/r, rms over the r_rod of the paper's six rods",
        parameters: &[(&["factor"], "actual over nominal stiffness")],
        needs: "a rod file",
        cause: "moduli, walls or lengths that differ from the rod file",
        cause_at: |_| "moduli, walls or lengths that differ from the rod file".into(),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(SOFTNESS)],
    needs_rod: true,
    candidates: |context| {
        // a share of the stiffness that there is: a rod is softer or stiffer by a factor
        let size = SOFTNESS * context.stiffness.max(1.0);
        let far = context.stiffness;
        let bounds = (SCALES.0 * far.min(1.0), SCALES.1 * far.max(1.0));
        let factor = parameter("factor", 1.0, size, bounds);
        vec![entry(&STIFFNESS_SCALE, Location::Part(Part::Rod), factor, Action::Stiffness)]
    },
    missing: |_| NOT_YIELDING,
    observed: |finding, model| {
        // the rod as a whole is so by less, where a part of it bends in its joints
        let is_jointed = model.rod.as_ref().is_some_and(|rod| !rod.joints.is_empty());
        let joints = if is_jointed { ", its joints as stated" } else { "" };
        format!("All tubes of the rod are {} than in the model{joints}", softer(number(finding, "factor")))
    },
    write: |term, _, rod| {
        *rod = with_moduli(rod, term.values[0], term.values[0]);
        WrittenTo::Model
    },
};

/// The shear modulus of the whole rod.
pub static SHEAR_MODULUS: RigEffect = RigEffect {
    effect: Effect {
        name: "shear_modulus",
        kind: Kind::Physics,
        summary: "torsion and shear are softer or stiffer than stated",
        formula: "G → f·G in all pipes",
        prior: "27 %, as for the whole stiffness",
        parameters: &[(&["factor"], "actual over nominal stiffness")],
        needs: "a rod file; loads that twist or shear the rod",
        cause: "a shear modulus that differs from the rod file",
        cause_at: |_| "a shear modulus that differs from the rod file".into(),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(SOFTNESS)],
    needs_rod: true,
    candidates: |_| {
        let factor = parameter("factor", 1.0, SOFTNESS, SCALES);
        vec![entry(&SHEAR_MODULUS, Location::Part(Part::Rod), factor, Action::ShearModulus)]
    },
    missing: |_| "the loads neither twist nor shear the rod",
    observed: |finding, _| {
        format!("In torsion and shear the rod is {} than its model", softer(number(finding, "factor")))
    },
    write: |term, _, rod| {
        *rod = with_moduli(rod, 1.0, term.values[0]);
        WrittenTo::Model
    },
};

/// A connection: one of the file, or one that nobody declared, anywhere along the rod.
pub static JOINT_COMPLIANCE: RigEffect = RigEffect {
    effect: Effect {
        name: "joint_compliance",
        kind: Kind::Physics,
        summary: "a joint of the file or on the rod gives way",
        formula: "θ = β·M at a station, in bending and in torsion",
        prior: "20 % of the rod's own ∫ds/EI and ∫ds/GJ, as at the corner of the paper's rod 2#",
        parameters: &[
            (&["bending_urad_per_nm"], "the joint's compliance in bending"),
            (&["torsion_urad_per_nm"], "the joint's compliance in torsion"),
            (&["station_mm"], "station of the joint"),
        ],
        needs: "a rod file",
        cause: "a compliant connection",
        cause_at: |location| match location {
            Location::Station(_) => format!("a compliant connection at {location}"),
            named => format!("the compliance of joint \"{named}\""),
        },
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(JOINT)],
    needs_rod: true,
    candidates: joints,
    missing: |_| NOT_YIELDING,
    observed: |finding, model| {
        let place = &finding.location;
        let what = match (stretch(finding, model), place) {
            (Some((low, high)), _) => {
                let declared: String = finding
                    .rivals
                    .iter()
                    .filter(|rival| {
                        rival.effect == finding.effect && matches!(rival.location, Location::Named(_))
                    })
                    .map(|rival| format!(", or the joint \"{}\"", rival.location))
                    .collect();
                let (low, high) = (low / MM, high / MM);
                let in_bend = if is_in_arc(place, model) { ", in the bend" } else { "" };
                format!("At {place}{in_bend} (between {low:.0} and {high:.0} mm{declared}) the rod")
            }
            (None, Location::Station(_)) => format!("At {place} the rod"),
            (None, named) => format!("The joint \"{named}\""),
        };
        format!("{what} gives way by {}", amount(finding, model))
    },
    write: write_joint,
};

/// Flange or adapter.
pub static ROOT_COMPLIANCE: RigEffect = RigEffect {
    effect: Effect {
        name: "root_compliance",
        kind: Kind::Physics,
        summary: "the flange or its adapter gives way",
        formula: "θ = β·M at the root",
        prior: "20 % of the rod's own ∫ds/EI and ∫ds/GJ",
        parameters: &[
            (&["bending_urad_per_nm"], "compliance in bending"),
            (&["torsion_urad_per_nm"], "compliance in torsion"),
        ],
        needs: "a rod file",
        cause: "a compliant flange or adapter",
        cause_at: |_| "a compliant flange or adapter".into(),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(JOINT)],
    needs_rod: true,
    candidates: roots,
    missing: |_| NOT_YIELDING,
    observed: |finding, model| match &finding.location {
        Location::InSession { session, .. } => {
            format!("In session {session} the rod's root gives way by {} more", amount(finding, model))
        }
        _ => format!("The rod's root gives way by {}", amount(finding, model)),
    },
    write: write_joint,
};

/// The pipe of the bend becomes oval.
pub static BEND_FLEXIBILITY: RigEffect = RigEffect {
    effect: Effect {
        name: "bend_flexibility",
        kind: Kind::Physics,
        summary: "the bend's cross-section becomes oval under load",
        formula: "bending of the arc × k",
        prior: "von Kármán's factor for the section, less the file's; 0.3 at least",
        parameters: &[(&["factor"], "k: the arc's flexibility over that of a beam")],
        needs: "a rod file with a bend radius",
        cause: "its cross-section becomes oval",
        cause_at: |_| "a bend whose cross-section becomes oval".into(),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Number(BEND)],
    needs_rod: true,
    candidates: |context| {
        let Body::Rod(structure) = &*context.body else { return Vec::new() };
        if !structure.has_arc() {
            return Vec::new();
        }
        let (rod, of_file) = (structure.rod(), structure.bend_factor);
        let karman = BendFlexibility::VonKarman.factor(&rod.bend.section, rod.bend_radius);
        let size = (karman - of_file).abs().max(BEND);
        // a bend may ovalise, but not grow stiffer than a beam
        let bounds = (of_file.min(1.0), 100.0);
        let factor = parameter("factor", of_file, size, bounds);
        let action = Action::Bend(of_file);
        vec![entry(&BEND_FLEXIBILITY, Location::Part(Part::Bend), factor, action)]
    },
    missing: |context| match context.rod.is_some_and(|rod| rod.arc_length() > 0.0) {
        true => NOT_YIELDING,
        false => "the rod's corner is sharp: no arc could become oval",
    },
    observed: |finding, _| format!("The bend is {} times as flexible as a beam", size(finding, "factor", "")),
    write: |term, _, rod| {
        rod.bend_flexibility = BendFlexibility::Factor(term.values[0]);
        WrittenTo::Model
    },
};

/// The root, and that of each session, in which the rod was mounted anew.
fn roots(context: &mut Context) -> Vec<Entry> {
    let sessions = sessions(context.data);
    let Body::Rod(structure) = &mut *context.body else { return Vec::new() };
    let root = Location::Part(Part::Root);
    let (everywhere, actions) = joint(structure, &ROOT_COMPLIANCE, root, 0.0, [0.0; 2], None);
    let of_session = |(number, session): (usize, String)| {
        let location = Location::InSession { part: Part::Root, session };
        let in_session = |action: &Action| match action {
            Action::Joint(joint, _) => Action::JointIn(number, *joint),
            other => other.clone(),
        };
        (Candidate { location, ..everywhere.clone() }, actions.iter().map(in_session).collect())
    };
    let mut entries: Vec<Entry> = sessions.into_iter().map(of_session).collect();
    entries.insert(0, (everywhere, actions));
    preferring(entries, |candidate| candidate.location == Location::Part(Part::Root))
}

/// Declared joints, then joints that nobody declared along the rod. A value is a joint's whole
/// compliance, to be written into the rod file. A joint that nobody declared may be anywhere up to
/// half way to the next stations of the scan, or up to the bend; within an arc too, which gives way
/// in one place otherwise than all along (`BEND_FLEXIBILITY`): where the readings tell which.
fn joints(context: &mut Context) -> Vec<Entry> {
    let (Body::Rod(structure), Some(rod)) = (&mut *context.body, context.rod) else {
        return Vec::new();
    };
    let scan = stations(rod);
    // half way to its neighbours; up to those that stay where the rod bends
    let kinks = [rod.bend_start(), rod.bend_end()];
    let between =
        |station: f64, other: f64| if kinks.contains(&other) { other } else { 0.5 * (station + other) };
    let range = |station: f64| {
        let before = scan.iter().rev().find(|other| **other < station);
        let behind = scan.iter().find(|other| **other > station);
        (
            before.map_or(0.0, |other| between(station, *other)),
            behind.map_or(rod.length(), |other| between(station, *other)),
        )
    };
    let mut entries = Vec::new();
    for declared in &rod.joints {
        let location = Location::Named(declared.name.clone());
        let of_file = [declared.bending, declared.torsion];
        entries.push(joint(structure, &JOINT_COMPLIANCE, location, declared.station, of_file, None));
    }
    for &station in &scan {
        let location = Location::Station(station);
        let range = Some(range(station));
        entries.push(joint(structure, &JOINT_COMPLIANCE, location, station, [0.0; 2], range));
    }
    preferring(entries, |candidate| matches!(candidate.location, Location::Named(_)))
}

/// A joint; with a range its station is a parameter.
fn joint(
    structure: &mut Structure,
    effect: &'static RigEffect,
    location: Location,
    station: f64,
    of_file: [f64; 2],
    range: Option<(f64, f64)>,
) -> Entry {
    let rotation = structure.rotation();
    let [bending, torsion] = structure.add_joint(station);
    let compliance = |name, k: usize| parameter(name, of_file[k], JOINT * rotation[k], NOT_NEGATIVE);
    let mut parameters = vec![compliance("bending_urad_per_nm", 0), compliance("torsion_urad_per_nm", 1)];
    let mut actions = vec![Action::Joint(bending, of_file[0]), Action::Joint(torsion, of_file[1])];
    if let Some(range) = range
        && let Some(nodes) = structure.add_nodes(station, [bending, torsion], range)
    {
        let [before, _, behind] = nodes.stations;
        // as likely anywhere
        let size = (behind - before) / 12.0f64.sqrt();
        parameters.push(parameter("station_mm", station, size, (before, behind)));
        actions.push(Action::Station(nodes));
    }
    (candidate(&effect.effect, location, parameters), actions)
}

/// Writes a connection as the joint of its name, or as one that the rod's file did not have.
fn write_joint(term: &Term, model: &RigModel, rod: &mut Rod) -> WrittenTo {
    let Body::Rod(structure) = &model.body else { return WrittenTo::Nowhere };
    let place = &model.candidates[term.candidate].location;
    // a rod file has no sessions
    if matches!(place, Location::InSession { .. }) {
        return WrittenTo::Recording;
    }
    let declared = rod.joints.iter().position(|joint| *place == Location::Named(joint.name.clone()));
    let index = declared.unwrap_or_else(|| {
        let place = model.location(term);
        let station = if let Location::Station(station) = place { station } else { 0.0 };
        rod.joints.push(rod::Joint { name: place.to_string(), station, bending: 0.0, torsion: 0.0 });
        rod.joints.len() - 1
    });
    // what these loads cannot show of a declared joint stays as it is
    for (action, &value) in model.actions[term.candidate].iter().zip(&term.values) {
        if let Action::Joint(number, _) = action {
            match structure.deformation(*number) {
                Deformation::Bending => rod.joints[index].bending = value,
                Deformation::Torsion => rod.joints[index].torsion = value,
            }
        }
    }
    WrittenTo::Model
}

/// Where along the rod a joint that nobody declared may be, m; `None` for everything else.
fn stretch(finding: &Finding, model: &RigModel) -> Option<(f64, f64)> {
    let actions = &model.actions[finding.parts.first()?.term.candidate];
    let mut numbers = actions.iter().zip(&finding.estimates);
    let (_, station) = numbers.find(|(action, _)| matches!(action, Action::Station(_)))?;
    Some((station.low, station.high))
}

/// True of a station within the arc of a bend that has one.
fn is_in_arc(place: &Location, model: &RigModel) -> bool {
    let (Location::Station(station), Body::Rod(structure)) = (place, &model.body) else { return false };
    let rod = structure.rod();
    structure.has_arc() && (rod.bend_start()..rod.bend_end()).contains(station)
}

/// By how much a joint gives way; only what differs from the rod file, unless nothing does for
/// sure.
fn amount(finding: &Finding, model: &RigModel) -> String {
    let Body::Rod(structure) = &model.body else { return String::new() };
    let (mut sure, mut all) = (Vec::new(), Vec::new());
    for (action, parameter, compliance) in by_action(finding, model) {
        let (Action::Joint(number, _) | Action::JointIn(_, number)) = action else { continue };
        let how = match structure.deformation(*number) {
            Deformation::Bending => "in bending",
            Deformation::Torsion => "in torsion",
        };
        let of_file = parameter.neutral / parameter.unit.si;
        let instead = match of_file > 0.0 {
            true => format!(" instead of {}", significant(of_file, 3)),
            false => String::new(),
        };
        let one = format!("{} {how}{instead}", compliance.with_unit("µrad/(N·m)"));
        if compliance.low > of_file || compliance.high < of_file {
            sure.push(one.clone());
        }
        all.push(one);
    }
    if sure.is_empty() { all } else { sure }.join(" and ")
}

/// `12 ± 2 % softer`, of a factor on a modulus.
fn softer(factor: Quantity) -> String {
    factor.map(|factor| 1.0 / factor).compared("softer", "stiffer")
}
