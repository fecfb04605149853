//! The JSON of a diagnosis, of a rig or of a calibration.

use serde_json::{Map, Value, json};

use super::headline::{headline, sentence};
use super::hidden::hidden;
use super::law;
use super::place::place;
use super::subject::Subject;
use crate::inference::{
    Covariate, Estimate, Finding, FindingPart, LackOfFit, LoadPlan, NominalEstimate, Rank, Rival, Structure,
    ranking,
};
use crate::units::{MM, UM};

/// The JSON of `rodcal diagnose … --json`. Numbers that do not exist are null.
///
/// Numbers in µm are root mean squares of a datum. `heldout_gain` is the share of the squares of
/// held-out errors that vanishes with all findings together; `heldout_loss` of a finding is the
/// share that comes back without it. The intervals of a joint that nobody declared hold all
/// stations that these readings do not distinguish from its own, and what it would be there.
pub fn json(subject: &Subject) -> Value {
    let diagnosis = subject.diagnosis;
    let held_out = diagnosis.held_out.as_ref();
    let um = |length: f64| length / UM;
    let findings = diagnosis.findings.iter().enumerate();
    let findings: Vec<Value> = findings.map(|(k, finding)| of_finding(subject, k, finding)).collect();
    let not_testable =
        subject.not_testable.iter().map(|not| json!({ "effect": not.effect.name, "reason": not.reason }));
    let absorbed = subject.absorbed.iter().map(|absorbed| {
        json!({
            "effect": absorbed.effect.name,
            "location": absorbed.location.to_string(),
            "survival": absorbed.unabsorbed,
        })
    });
    let hidden = hidden(subject)
        .into_iter()
        .map(|(effect, places)| json!({ "effect": effect.name, "locations": places }));
    let replication = diagnosis.sessions.iter().map(|session| {
        json!({
            "session": (subject.session_name)(session.session),
            "before_um": um(session.before),
            "after_um": um(session.after),
        })
    });
    let suspects = diagnosis.suspects.iter().map(|suspect| {
        let mut json = (subject.suspect)(suspect.datum);
        json["sigma"] = suspect.sigma.into();
        json
    });
    let head = subject.head.iter().map(|(key, value)| ((*key).to_owned(), value.clone()));
    let mut all: Map<String, Value> = head.collect();
    let mut main = json!({
        "headline": headline(subject),
        "verdict": if subject.is_consistent() { "consistent" } else { "mismatch" },
        "noise_um": um(diagnosis.noise),
        "noise": {
            "stated_um": diagnosis.noise_test.stated.map(um),
            "estimated_um": um(diagnosis.noise_test.estimated),
            "p_value": diagnosis.noise_test.p_value,
        },
        "nominal": diagnosis.nominal.iter().map(nominal).collect::<Vec<_>>(),
        "suspects": suspects.collect::<Vec<_>>(),
        "noise_shared_ratio": diagnosis.shared_ratio,
        "residual_sd_um": um(diagnosis.hypothesis.sigma),
        "rms_before_um": um(subject.before_correction.unwrap_or_else(|| diagnosis.error_before())),
        "rms_after_um": um(diagnosis.error_after()),
        "heldout_before_um": held_out.map(|held_out| um(held_out.before)),
        "heldout_after_um": held_out.map(|held_out| um(held_out.after)),
        "heldout_gain": held_out.map(|held_out| held_out.gain),
        "heldout_gain_95":
            held_out.and_then(|held_out| held_out.gain_interval).map(|(low, high)| [low, high]),
        "findings": findings,
        "unexplained": subject.remainder.as_ref().map(|left| left.json()),
        "law": law::json(subject.law.as_ref()),
        "replication": replication.collect::<Vec<_>>(),
        "locate": locate(subject),
        "lack_of_fit_before": diagnosis.lack_of_fit_before.as_ref().map(test),
        "lack_of_fit_after": diagnosis.lack_of_fit_after.as_ref().map(test),
        "ranking": ranked(subject),
        "hidden": hidden.collect::<Vec<_>>(),
        "absorbed": absorbed.collect::<Vec<_>>(),
        "not_testable": not_testable.collect::<Vec<_>>(),
        "n": subject.count,
        "warnings": subject.all_warnings(),
    });
    if let Some(uneven) = &subject.uneven {
        main["noise"][uneven.key] = uneven.all.clone();
    }
    if let Some(noise) = subject.evidence.correlated_noise {
        main["noise"]["correlated"] = json!({ "share": noise.share, "length_poses": noise.length });
    }
    if let Value::Object(main) = main {
        all.extend(main);
    }
    all.extend(subject.more.iter().map(|(key, value)| ((*key).to_owned(), value.clone())));
    Value::Object(all)
}

fn of_finding(subject: &Subject, index: usize, finding: &Finding) -> Value {
    let others = finding.other_effects();
    let others: Vec<&str> = others.iter().map(|(effect, _)| effect.name).collect();
    let places: Vec<String> = finding.other_places().iter().map(ToString::to_string).collect();
    let next = finding.next.as_ref();
    let plan = next.and_then(|next| next.plan.as_ref()).map(|plan| (subject.plan)(plan));
    let found = finding.found_in_folds.map(|(some, all)| format!("{some} of {all}"));
    let mut json = json!({
        "effect": finding.effect.name,
        "location": finding.location.to_string(),
        "place": place(&finding.location),
        "kind": finding.kind().name(),
        "words": sentence(subject, finding),
        "p_value": finding.p_value,
        "parameters": finding.estimates.iter().map(estimate).collect::<Vec<_>>(),
        "indistinguishable_from": others,
        "unnamed_rival": finding.unnamed.as_ref().map(|rival| rival.location.to_string()),
        "places": places,
        "rivals": finding.rivals.iter().map(rival).collect::<Vec<_>>(),
        "next_measurement": next.map(|next| &next.description),
        "next_measurement_plan": plan,
        "heldout_gain": subject.diagnosis.held_out.as_ref().map(|held_out| held_out.gain),
        "heldout_loss": finding.held_out_loss,
        "explains_rms_um": finding.explains / UM,
        "found_in_folds": found,
        "parts": finding.parts.iter().map(part).collect::<Vec<_>>(),
    });
    for (key, value) in subject.of_findings.get(index).into_iter().flatten() {
        json[*key] = value.clone();
    }
    json
}

fn estimate(estimate: &Estimate) -> Value {
    let unit = estimate.unit.si;
    json!({
        "name": estimate.name,
        "value": estimate.value / unit,
        "lo": estimate.low / unit,
        "hi": estimate.high / unit,
    })
}

/// A nominal number that moved, in its own unit.
fn nominal(moved: &NominalEstimate) -> Value {
    let number = &moved.number;
    json!({
        "parameter": number.name,
        "unit": number.unit,
        "nominal": number.value / number.si,
        "estimate": moved.estimate / number.si,
        "lo": moved.low / number.si,
        "hi": moved.high / number.si,
        "standard_uncertainty": number.standard_uncertainty / number.si,
    })
}

fn rival(rival: &Rival) -> Value {
    json!({
        "effect": rival.effect.name,
        "location": rival.location.to_string(),
        "place": place(&rival.location),
        "odds": rival.odds,
    })
}

/// One of the terms that are reported together.
fn part(part: &FindingPart) -> Value {
    json!({
        "place": part.location.to_string(),
        "p_value": part.p_value,
        "explains_rms_um": part.explains / UM,
        "parameters": part.estimates.iter().map(estimate).collect::<Vec<_>>(),
    })
}

/// What to measure next on a rig, as numbers. A station that is null is the tip.
pub fn load_plan(plan: &LoadPlan) -> Value {
    let mm = |station: Option<f64>| station.map(|station| station / MM);
    let channels: Vec<String> = plan.channels.iter().map(|channel| format!("d{channel}")).collect();
    json!({
        "direction": plan.direction.to_string(),
        "loads_n": plan.loads,
        "unloading": plan.unloading,
        "load_station_mm": mm(plan.load_station),
        "read_station_mm": mm(plan.read_station),
        "waits_s": plan.waits,
        "repeats": plan.repeats,
        "channels": channels,
    })
}

/// What is left along each covariate.
fn locate(subject: &Subject) -> Vec<Value> {
    let structure = |structure: &Structure| json!({ "strength": structure.strength, "z": structure.z });
    let diagnosis = subject.diagnosis;
    let structures = diagnosis.structure_before.iter().zip(&diagnosis.structure_after);
    let structures = structures.zip(&diagnosis.structure_given_others);
    type Known<'a> = ((&'a Structure, &'a Structure), &'a Option<Structure>);
    let of_covariate = |(covariate, ((before, after), given_others)): (&Covariate, Known)| {
        json!({
            "covariate": covariate.variable.to_string(),
            "unit": covariate.variable.unit(),
            "before": structure(before),
            "after": structure(after),
            "given_others": given_others.as_ref().map(structure),
        })
    };
    subject.evidence.covariates.iter().zip(structures).map(of_covariate).collect()
}

/// Every effect by itself, the likeliest first.
fn ranked(subject: &Subject) -> Vec<Value> {
    let ranked = ranking(subject.candidates, subject.diagnosis).into_iter();
    let of_effect = |ranked: crate::inference::Ranked| {
        json!({
            "effect": ranked.effect.name,
            "location": ranked.location.to_string(),
            "log_odds": ranked.log_odds,
            "class": match ranked.rank {
                Rank::Adopted => "adopted",
                Rank::Rival => "indistinguishable",
                Rank::Rejected => "rejected",
            },
        })
    };
    ranked.map(of_effect).collect()
}

/// A test of the averages of repeats.
fn test(test: &LackOfFit) -> Value {
    json!({
        "f": test.f,
        "p_value": test.p_value,
        "dof_fit": test.dof_fit,
        "dof_repeats": test.dof_repeats,
    })
}
