//! The JSON of a diagnosis.

use serde_json::{Value, json};

use super::remainder::remainder;
use super::shared::{locate_json, ranking_json, test_json};
use super::{correction, headline, warnings};
use crate::diagnosis::rig::{Plan, Proposal, RigDiagnosis};
use crate::diagnosis::{Finding, World, rms};
use crate::rig::readings::Readings;
use crate::rod::Rod;
use crate::units::{MM, UM};

/// The JSON of `rodcal diagnose rig --json`. Numbers that do not exist are null.
///
/// `heldout_gain` is the share of the squares of held-out errors that vanishes with the whole story; that of a finding
/// among several is not known by itself, so that each has the story's. The intervals of a joint that nobody declared
/// hold all stations that these readings do not tell from its own, and what it would be there.
pub fn json(found: &RigDiagnosis, readings: &Readings, rod: Option<&Rod>) -> Value {
    let diagnosis = &found.diagnosis;
    let proof = diagnosis.proof.as_ref();
    let um = |length: f64| length / UM;
    let findings = diagnosis.findings.iter().zip(&found.next);
    let findings: Vec<Value> =
        findings.map(|(finding, next)| of_finding(found, finding, next.as_ref())).collect();
    let not_testable =
        found.not_testable.iter().map(|not| json!({ "effect": not.effect, "reason": not.reason }));
    json!({
        "rod": rod.map(|rod| &rod.name),
        "readings": readings.file,
        "headline": headline(found),
        "verdict": if diagnosis.is_mismatch() { "mismatch" } else { "consistent" },
        "noise_um": um(diagnosis.noise),
        "noise_shared_ratio": diagnosis.shared_ratio,
        "residual_sd_um": um(diagnosis.story.sigma),
        "rms_before_um": um(rms(&diagnosis.before)),
        "rms_after_um": um(rms(&diagnosis.after)),
        "heldout_before_um": proof.map(|proof| um(proof.before)),
        "heldout_after_um": proof.map(|proof| um(proof.after)),
        "heldout_gain": proof.map(|proof| proof.gain),
        "heldout_gain_95": proof.and_then(|proof| proof.gain_interval).map(|(low, high)| [low, high]),
        "findings": findings,
        "unexplained": remainder(found).map(|left| {
            json!({ "location": left.location, "rms_um": um(left.rms), "shape": left.shape() })
        }),
        "locate": locate_json(&found.evidence, diagnosis),
        "lack_of_fit_before": diagnosis.lack_of_fit_before.as_ref().map(test_json),
        "lack_of_fit_after": diagnosis.lack_of_fit_after.as_ref().map(test_json),
        "ranking": ranking_json(&found.world, diagnosis),
        "not_testable": not_testable.collect::<Vec<_>>(),
        "correction": found.correction.as_ref().map(correction::json),
        "n": found.world.data().len(),
        "warnings": warnings(found, readings, rod),
    })
}

fn of_finding(found: &RigDiagnosis, finding: &Finding, next: Option<&Proposal>) -> Value {
    let candidate = &found.world.candidates()[finding.chosen.candidate];
    let parameters = candidate.parameters.iter().enumerate().filter_map(|(k, parameter)| {
        let (value, low, high) = found.world.interval(finding, k)?;
        let unit = parameter.unit;
        Some(json!({ "name": parameter.name, "value": value / unit, "lo": low / unit, "hi": high / unit }))
    });
    let rivals = finding.rivals.iter().map(|rival| {
        json!({
            "effect": found.effect_of(rival.chosen.candidate),
            "location": rival.place,
            "odds": rival.odds,
        })
    });
    let others: Vec<&str> = found.other_effects(finding).into_iter().map(|(effect, _)| effect).collect();
    json!({
        "effect": candidate.effect,
        "location": finding.place,
        "words": found.world.words(finding).to_string(),
        "p_value": finding.p_value,
        "parameters": parameters.collect::<Vec<_>>(),
        "indistinguishable_from": others,
        "places": found.other_places(finding),
        "rivals": rivals.collect::<Vec<_>>(),
        "next_measurement": next.map(|next| &next.words),
        "next_measurement_plan": next.map(|next| of_plan(&next.plan)),
        "heldout_gain": found.diagnosis.proof.as_ref().map(|proof| proof.gain),
        "explains_rms_um": finding.rms / UM,
        "found_in_folds": found.found_in_folds(finding).map(|(some, all)| format!("{some} of {all}")),
    })
}

/// What to measure next, as numbers. A station that is null is the tip.
fn of_plan(plan: &Plan) -> Value {
    let mm = |station: Option<f64>| station.map(|station| station / MM);
    json!({
        "direction": plan.direction.to_string(),
        "loads_n": plan.loads,
        "unloading": plan.unloading,
        "load_station_mm": mm(plan.load_station),
        "read_station_mm": mm(plan.read_station),
        "waits_s": plan.waits,
        "repeats": plan.repeats,
        "channels": plan.channels.iter().map(|channel| format!("d{channel}")).collect::<Vec<_>>(),
    })
}
