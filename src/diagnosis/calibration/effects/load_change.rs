//! A load that was put on, or taken off, while the poses were recorded.
//!
//! ```text
//! at the flange   yield(flange, m·g)
//! at the tip      R·C^F·Rᵀ·(m·g) + yield(tip, m·g)
//! ```
//!
//! from some row on, m the mass after it less that before it; at the flange with a centre of its
//! own, as `payload.rs` has it. What was taken off there hung there before, where the files state
//! nothing of it:
//!
//! ```text
//! former load     −yield(flange, m·g) until that row
//! ```
//!
//! or else it would take two findings, each of which is hardly known beside the other.

use std::ops::Range;

use super::super::model::CalibrationModel;
use super::super::model::entry::linear;
use super::super::model::law::{Hung, Law};
use super::fixture::places_amid;
use super::loads::{FORGOTTEN_AT_TIP, gives_way, heavier, joints_give_way, pulled};
use super::payload::{CENTRE, MOMENT, at_centre, is_apart, mass_and_centre, not_apart, on_flange};
use super::{CalibrationEffect, Context, Entry, Transfer, lack, out_of_the_points};
use crate::inference::{Candidate, Effect, Finding, Kind, Location, NotTestable, Reported, WrittenTo};
use crate::units::Unit;

/// What an arm picks up or puts down, a gripper or a part, kg.
const PICKED_UP: f64 = 1.0;
/// How much rarer it is than other events: whoever records poses keeps the load. As rare as a
/// mistake, and named at odds as large, lest a few poses far out at the end of a recording are one.
const RARE: f64 = 0.05;
const AT_FLANGE: &str = "load of the flange";
const FORMER: &str = "former load of the flange";
const AT_TIP: &str = "load of the tip";

/// A load that changed.
pub static LOAD_CHANGE: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "load_change",
        kind: Kind::Event,
        summary: "a load was put on, or taken off, after one pose",
        formula: "from some row on, at the tip R·C^F·Rᵀ·(m·g) + yield(tip, m·g), at the flange, or with the other sign until then, yield(flange, m·g) + Σ_j Jⱼ·cⱼ·zⱼ·(R·m·c × g)",
        prior: "1 kg at the flange, its centre within 0.1 m of the flange's along each axis: a gripper, a part; \
                50 g at the tip: a ball and its holder; as rare as a mistake",
        parameters: &[
            (&["mass_kg", "mass_g"], "mass after that pose, less that before it"),
            (&CENTRE, "centre of that at the flange in {T}, where its mass is known apart from it"),
            (&MOMENT, "else the moment of its weight, m·c·g, along the axes of {T}"),
        ],
        needs: "joints of known compliance, or a rod; poses in the order of recording, a tenth of them before it and after it",
        cause: "a load that was put on or taken off",
        cause_at: |location| format!("another load ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Look up what was put on the arm, or taken off, then."),
    },
    candidates: changes,
    estimates: mass_and_centre,
    observed: changed,
    write: out_of_the_points,
    transfer: Transfer::Made(stays),
    event: |_| Some("the load changed".into()),
};

fn changes(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let places = places_amid(context);
    let Some(&first) = places.iter().min() else { return Vec::new() };
    let rows = context.configurations.len();
    let flange = joints_give_way(context).then(|| {
        let put_on = at_flange(context, first..rows, 1.0, at(context, AT_FLANGE, first));
        let taken_off = at_flange(context, 0..rows, -1.0, at(context, FORMER, first));
        (put_on, taken_off)
    });
    let tip = gives_way(context).then(|| at_tip(context, first..rows, at(context, AT_TIP, first)));
    if tip.is_none() {
        lacks.push(lack(&LOAD_CHANGE, "there is neither a rod nor a joint of known compliance"));
    }
    let mut changes = Vec::new();
    for before in places {
        if let Some((put_on, taken_off)) = &flange {
            let later = put_on.starting_at(before, at(context, AT_FLANGE, before));
            changes.push(later.by(Law::Hung(Hung::FlangeFrom(before))));
            let former = taken_off.ending_at(before, at(context, FORMER, before));
            changes.push(former.by(Law::Hung(Hung::FlangeUntil(before))));
        }
        changes.extend(tip.iter().map(|tip| tip.starting_at(before, at(context, AT_TIP, before))));
    }
    let share = RARE / changes.len().max(1) as f64;
    changes.iter_mut().for_each(|entry| entry.candidate.weight = share);
    changes
}

/// Of what the load changed before a row.
fn at(context: &Context, what: &str, before: usize) -> Location {
    let row = before - 1;
    Location::Shift { what: Some(what.into()), row, after: context.pose_name(row) }
}

fn is_of_tip(candidate: &Candidate) -> bool {
    candidate.parameters.first().is_some_and(|own| own.unit == Unit::of_key("mass_g"))
}

/// What hangs there at these rows, as the load after it less that before it: a `sign` of −1 before
/// it, where no less can hang than nothing.
fn at_flange(context: &Context, rows: Range<usize>, sign: f64, location: Location) -> Entry {
    let mut parameters = on_flange(context, rows, sign, PICKED_UP);
    let stated = context.modelled_mass.1;
    parameters[0].0.bounds = if sign > 0.0 { (-stated, f64::INFINITY) } else { (f64::NEG_INFINITY, stated) };
    Entry::new(&LOAD_CHANGE.effect, location, parameters)
}

fn at_tip(context: &Context, rows: Range<usize>, location: Location) -> Entry {
    let column = context.part(rows, |_, there| pulled(context, there, &there.gravity));
    Entry::new(&LOAD_CHANGE.effect, location, vec![(linear("mass_g", FORGOTTEN_AT_TIP), column)])
}

/// The load stays what it was changed to: of what hung there before nothing is left.
fn stays(context: &Context, candidate: &Candidate, law: &Law) -> Entry {
    let rows = 0..context.configurations.len();
    let location = candidate.location.clone();
    match law {
        Law::Hung(Hung::FlangeUntil(_)) => at_flange(context, 0..0, -1.0, location),
        _ if is_of_tip(candidate) => at_tip(context, rows, location),
        _ => at_flange(context, rows, 1.0, location),
    }
}

fn changed(finding: &Finding, model: &CalibrationModel) -> String {
    let candidate = finding.parts.first().map(|part| &model.terms.candidates[part.term.candidate]);
    let (place, unit) = if candidate.is_some_and(is_of_tip) { ("tip", "g") } else { ("flange", "kg") };
    let when = match &finding.location {
        Location::Shift { after, .. } => format!(" after {after}"),
        other => format!(", {other}"),
    };
    if place == "flange" && !is_apart(finding) {
        return format!("The flange carries another load{when}, {}", not_apart(finding));
    }
    format!("The {place} carries {}{when}{}", heavier(finding, unit), at_centre(finding))
}
