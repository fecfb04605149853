//! What hangs on the flange: a mass, and where its centre is.
//!
//! ```text
//! yield(flange, m·g) + Σ_j Jⱼ·cⱼ·zⱼ·(R·s × g)       s = m·c, c the centre in {T}
//! ```
//!
//! Linear in the mass m and in the first moment s, which is reported as the moment of weight s·g,
//! as data sheets of arms have it. A centre that is held at the flange makes another mass of a load
//! that hangs beside it, and nothing says so. One prior widens for all four (κ): the moment's size
//! is that of the mass times [`BESIDE`], so that the centre is within that of the flange whatever
//! the mass. Of what hangs there always the poses show little but the moment: that its centre is
//! the flange's is a form of its own, and the interval of its mass holds that of any centre too.

use std::ops::Range;

use nalgebra::{DVector, Vector3};

use super::super::model::entry::{Column, linear};
use super::super::model::law::{Hung, Law};
use super::super::model::vector::Length;
use super::super::model::{CalibrationModel, Configuration};
use super::loads::{heavier, joints_give_way};
use super::{CalibrationEffect, Context, Entry, Transfer, lack, no_event, nth, out_of_the_points};
use crate::calibration::Carried;
use crate::inference::{
    Candidate, Effect, Estimate, Finding, FindingPart, Kind, Location, NotTestable, Parameter, Part,
    Reported, Term, WrittenTo,
};
use crate::units::{STANDARD_GRAVITY, Unit};

/// Mass at the flange that was forgotten, kg.
const FORGOTTEN: f64 = 0.5;
/// How far from the flange's origin the centre of what hangs there usually is, m, along each axis:
/// a gripper is 0.1 to 0.2 m long, an angle bracket or a part in it is as far beside.
const BESIDE: f64 = 0.1;
/// Names of the parameters.
const MASS: &str = "mass_kg";
pub(super) const MOMENT: [&str; 3] = ["moment_x_nm", "moment_y_nm", "moment_z_nm"];
/// Names of what is reported instead of the moment where the mass is known apart from it.
pub(super) const CENTRE: [&str; 3] = ["centre_x_mm", "centre_y_mm", "centre_z_mm"];

/// A mass at the flange that was forgotten.
pub static PAYLOAD_MASS: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "payload_mass",
        kind: Kind::Physics,
        summary: "a mass at the flange that the files do not state",
        formula: "yield(flange, m·g) + Σ_j Jⱼ·cⱼ·zⱼ·(R·m·c × g): c is the centre of the mass in {T}",
        prior: "0.5 kg: an adapter, a cable; its centre within 0.1 m of the flange's along each axis: a gripper",
        parameters: &[
            (&[MASS], "mass beyond the stated one"),
            (&CENTRE, "its centre in {T}, where its mass is known apart from it"),
            (&MOMENT, "else the moment of its weight, m·c·g, along the axes of {T}"),
        ],
        needs: "joints of known compliance",
        cause: "a mass that the files do not state",
        cause_at: |_| "a mass on the flange".into(),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Weigh what is on the flange."),
    },
    candidates: payload_masses,
    estimates: mass_and_centre,
    observed: |finding, _| match is_apart(finding) {
        true => format!("The flange carries {} than stated{}", heavier(finding, "kg"), at_centre(finding)),
        false => format!("The flange carries another load than stated, {}", not_apart(finding)),
    },
    write: out_of_the_points,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn payload_masses(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    if !joints_give_way(context) {
        lacks.push(lack(&PAYLOAD_MASS, "no joint has a known compliance"));
        return Vec::new();
    }
    let mut parameters = on_flange(context, 0..context.configurations.len(), 1.0, FORGOTTEN);
    // no less can hang there than nothing
    parameters[0].0.bounds.0 = -context.modelled_mass.1;
    let mass_alone = parameters[..1].to_vec();
    let at_flange = Location::Form { part: Part::Flange, form: "its centre there".into() };
    let form = |location, parameters| {
        let mut entry = Entry::new(&PAYLOAD_MASS.effect, location, parameters).by(Law::Hung(Hung::Flange));
        (entry.candidate.is_alternative, entry.candidate.weight) = (true, 0.5);
        entry
    };
    vec![form(Location::Part(Part::Flange), parameters), form(at_flange, mass_alone)]
}

/// Mass and moment of what hangs on the flange at some rows, or of what is missing there (a `sign`
/// of −1), by its usual mass, kg.
pub(super) fn on_flange(
    context: &Context,
    rows: Range<usize>,
    sign: f64,
    usual: f64,
) -> Vec<(Parameter, Column)> {
    let pulled = |there: &Configuration| there.joint_deflection(&there.flange.origin, &there.gravity);
    let mass = context.part(rows.clone(), |_, there| pulled(there) * sign);
    let moment = |(axis, name): (usize, &&str)| {
        let column = context.part(rows.clone(), |_, there| turned(there, axis) * sign);
        (linear(*name, usual * BESIDE * STANDARD_GRAVITY), column)
    };
    let moments = MOMENT.iter().enumerate().map(moment);
    std::iter::once((linear(MASS, usual), mass)).chain(moments).collect()
}

/// Displacement of the tip by a moment of weight about an axis of {T}, m/(N·m).
fn turned(there: &Configuration, axis: usize) -> Vector3<f64> {
    let lever = there.flange.rotation.column(axis) / STANDARD_GRAVITY;
    // Σ_j Jⱼ·cⱼ·zⱼ·(R·s × g)
    there.joint_deflection_below(there.axis.len().saturating_sub(1), |_| lever, &there.gravity)
}

/// What hangs on the flange by a term of some law, among so many rows; `None` of anything else.
pub(in crate::diagnosis::calibration) fn carried(
    candidate: &Candidate,
    law: &Law,
    term: &Term,
    rows: usize,
) -> Option<Carried> {
    let own = law.hung()?;
    let rows = own.rows_on_flange(rows)?;
    // of a former load it says by how much less hangs there afterwards
    let sign = if matches!(own, Hung::FlangeUntil(_)) { -1.0 } else { 1.0 };
    let value = |name: &str| {
        let mut own = candidate.parameters.iter().zip(&term.values);
        own.find(|(parameter, _)| parameter.name == name).map_or(0.0, |(_, value)| sign * value)
    };
    let moment = Vector3::from(MOMENT.map(value)) / STANDARD_GRAVITY;
    Some(Carried { rows, mass: value(MASS), moment })
}

/// The mass, and its centre c = s/m; the moment as it is where the mass may be nothing.
pub(super) fn mass_and_centre(_: &CalibrationModel, parts: &[FindingPart]) -> Vec<Estimate> {
    let of_part = |part: &FindingPart| {
        let place = |name: &str| part.estimates.iter().position(|own| own.name == name);
        let Some((mass, estimate)) = place(MASS).map(|k| (k, &part.estimates[k])) else {
            return part.estimates.clone();
        };
        if !excludes_zero(estimate) {
            return part.estimates.clone();
        }
        let centre = |(moment, name): (&str, &str)| Some(centre(part, mass, place(moment)?, name));
        let centres = MOMENT.into_iter().zip(CENTRE).filter_map(centre);
        std::iter::once(outwards(estimate)).chain(centres).collect()
    };
    parts.iter().flat_map(of_part).collect()
}

/// The poses show mass times compliance, and a quotient is skewed: away from zero the interval is
/// as wide as that of ln m, m·exp(half/m).
fn outwards(mass: &Estimate) -> Estimate {
    let far = |end: f64| mass.value * (end / mass.value - 1.0).abs().exp();
    match mass.value > 0.0 {
        true => Estimate { high: far(mass.high), ..mass.clone() },
        false => Estimate { low: far(mass.low), ..mass.clone() },
    }
}

/// c = M/(m·g) along one axis, with ∂c/∂M = 1/(m·g) and ∂c/∂m = −c/m.
fn centre(part: &FindingPart, mass: usize, moment: usize, name: &str) -> Estimate {
    let values = &part.term.values;
    let per_moment = 1.0 / (values[mass] * STANDARD_GRAVITY);
    let value = values[moment] * per_moment;
    let mut gradient = DVector::zeros(values.len());
    gradient[moment] = per_moment;
    gradient[mass] = -value / values[mass];
    let half = Length { value, gradient }.half_interval(part);
    Estimate { name: name.into(), unit: Unit::of_key(name), value, low: value - half, high: value + half }
}

fn excludes_zero(estimate: &Estimate) -> bool {
    estimate.low > 0.0 || estimate.high < 0.0
}

/// True where the poses show the mass apart from where its centre is.
pub(super) fn is_apart(finding: &Finding) -> bool {
    finding.estimates.first().is_some_and(excludes_zero)
}

/// `, with its centre (120 ± 10, 3 ± 8, 50 ± 20) mm from that of the flange`; nothing where it may
/// be there.
pub(super) fn at_centre(finding: &Finding) -> String {
    let centres = || finding.estimates.iter().filter(|own| CENTRE.contains(&own.name.as_str()));
    if !centres().any(excludes_zero) {
        return String::new();
    }
    let along: Vec<String> = centres()
        .map(|own| format!("{} along {}", own.quantity().with_unit("mm"), axis(&own.name)))
        .collect();
    format!(", with its centre {} from the flange's", along.join(", "))
}

/// `x` of `centre_x_mm`.
fn axis(name: &str) -> &str {
    name.split('_').nth(1).unwrap_or_default()
}

/// What is said where mass and centre are one number together.
pub(super) fn not_apart(finding: &Finding) -> String {
    let mass = nth(finding, 0).with_unit("kg");
    format!("{mass}: these poses do not tell its mass from where its centre is")
}
