//! The JSON of a calibration's diagnosis.

use serde_json::{Value, json};

use super::headline::{headline, other_effects, other_places, sentence};
use super::remainder::remainder;
use super::{Distances, warnings};
use crate::calibration::{Campaign, Summary};
use crate::diagnosis::calibration::{CalibrationDiagnosis, Gear, Mismatch, NextPoses, Number, Plan};
use crate::diagnosis::{World, rms};
use crate::report::diagnosis::shared::{locate_json, ranking_json, test_json};
use crate::robot::Motion;
use crate::units::{DEG, MM, UM, URAD};

/// The JSON of `rodcal diagnose calibration --json`. Numbers that do not exist are null.
///
/// Numbers in µm are root mean squares of a coordinate, `distances` those of the tip. `heldout_gain` is the share of the
/// squares of held-out errors that vanishes with the whole story: that of a finding among several is not known by itself.
pub fn json(campaign: &Campaign, found: &CalibrationDiagnosis) -> Value {
    let diagnosis = &found.diagnosis;
    let proof = diagnosis.proof.as_ref();
    let um = |length: f64| length / UM;
    let absorbed = found
        .world
        .absorbed
        .iter()
        .map(|a| json!({ "effect": a.effect, "location": a.location, "survival": a.survival }));
    let hidden =
        found.hidden().into_iter().map(|(effect, places)| json!({ "effect": effect, "locations": places }));
    let not_testable =
        found.world.not_testable.iter().map(|not| json!({ "effect": not.effect, "reason": not.reason }));
    let distances = Distances::of(found);
    let summary = |lengths: &[f64]| {
        let summary = Summary::of(lengths);
        json!({ "mean_um": um(summary.mean), "rms_um": um(summary.rms), "max_um": um(summary.max) })
    };
    json!({
        "robot": campaign.robot.name,
        "campaign": campaign.file,
        "mode": found.calibration.mode.name(),
        "headline": headline(found),
        "verdict": if diagnosis.is_mismatch() { "mismatch" } else { "consistent" },
        "noise_um": um(diagnosis.noise),
        "rms_before_um": um(rms(&diagnosis.before)),
        "rms_after_um": um(rms(&diagnosis.after)),
        "heldout_before_um": proof.map(|proof| um(proof.before)),
        "heldout_after_um": proof.map(|proof| um(proof.after)),
        "heldout_gain": proof.map(|proof| proof.gain),
        "heldout_gain_95": proof.and_then(|proof| proof.gain_interval).map(|(low, high)| [low, high]),
        "findings": found
            .mismatches
            .iter()
            .zip(&found.next)
            .map(|(mismatch, next)| finding(campaign, found, mismatch, next.as_ref()))
            .collect::<Vec<_>>(),
        "unexplained": remainder(found).map(|left| {
            json!({ "location": left.location, "rms_um": um(left.rms), "shape": left.shape() })
        }),
        "distances": {
            "before": summary(&distances.before),
            "after": summary(&distances.after),
            "heldout_before": distances.held_out.as_ref().map(|(before, _)| summary(before)),
            "heldout_after": distances.held_out.as_ref().map(|(_, after)| summary(after)),
        },
        "replication": diagnosis.replicas.iter().map(|replica| json!({
            "session": found.session(replica.session),
            "before_um": um(replica.before),
            "after_um": um(replica.after),
        })).collect::<Vec<_>>(),
        "locate": locate_json(&found.evidence, diagnosis),
        "lack_of_fit_before": diagnosis.lack_of_fit_before.as_ref().map(test_json),
        "lack_of_fit_after": diagnosis.lack_of_fit_after.as_ref().map(test_json),
        "ranking": ranking_json(&found.world, diagnosis),
        "hidden": hidden.collect::<Vec<_>>(),
        "absorbed": absorbed.collect::<Vec<_>>(),
        "not_testable": not_testable.collect::<Vec<_>>(),
        "n": campaign.measurements.len(),
        "warnings": warnings(campaign, found),
    })
}

fn finding(
    campaign: &Campaign,
    found: &CalibrationDiagnosis,
    mismatch: &Mismatch,
    next: Option<&NextPoses>,
) -> Value {
    let number = |number: &Number| {
        let unit = number.unit;
        json!({ "name": number.name, "value": number.value / unit, "lo": number.low / unit, "hi": number.high / unit })
    };
    let parts = mismatch.parts.iter().map(|&part| of_part(found, part));
    let rivals =
        mismatch.parts.iter().flat_map(|&part| &found.diagnosis.findings[part].rivals).map(|rival| {
            let effect = &found.world.candidates()[rival.chosen.candidate].effect;
            json!({ "effect": effect, "location": rival.place, "odds": rival.odds })
        });
    let others: Vec<String> = other_effects(found, mismatch).into_iter().map(|(effect, _)| effect).collect();
    let mut json = json!({
        "effect": mismatch.effect,
        "location": mismatch.location,
        "words": sentence(found, mismatch),
        "p_value": mismatch.p_value,
        "parameters": mismatch.parameters.iter().map(number).collect::<Vec<_>>(),
        "indistinguishable_from": others,
        "places": other_places(found, mismatch),
        "rivals": rivals.collect::<Vec<_>>(),
        "next_measurement": next.map(|next| &next.words),
        "next_measurement_plan": next.and_then(|next| next.plan.as_ref()).map(|plan| of_plan(campaign, plan)),
        "heldout_gain": found.diagnosis.proof.as_ref().map(|proof| proof.gain),
        "explains_rms_um": mismatch.rms / UM,
        "found_in_folds": found.found_in_folds(mismatch).map(|(some, all)| format!("{some} of {all}")),
        "parts": parts.collect::<Vec<_>>(),
    });
    let joint =
        found.world.gear(found.diagnosis.findings[mismatch.parts[0]].chosen.candidate).map(Gear::joint);
    if let Some(curve) = joint.and_then(|joint| found.gear(campaign, joint)) {
        let recording = &campaign.measurements;
        let angles = (0..recording.len()).map(|row| recording.joints(row)[curve.joint]);
        let turns: Vec<f64> = angles.map(|q| curve.at(q) / URAD).collect();
        let (low, high) = turns.iter().fold((0.0f64, 0.0f64), |(a, b), &t| (a.min(t), b.max(t)));
        let square: f64 = turns.iter().map(|t| t * t).sum();
        json["rms_urad"] = (square / turns.len().max(1) as f64).sqrt().into();
        json["half_peak_to_peak_urad"] = (0.5 * (high - low)).into();
    }
    json
}

/// The poses to measure next, as numbers; a tracker's have no group.
fn of_plan(campaign: &Campaign, plan: &Plan) -> Value {
    let groups = campaign.measurements.groups.iter().chain(&plan.group);
    let names: Vec<&str> = groups.map(|group| group.name.as_str()).collect();
    let poses = plan.poses.iter().map(|pose| {
        let joints = pose.joints.iter().zip(&campaign.robot.joints);
        let joints = joints.map(|(value, joint)| match joint.motion {
            Motion::Revolute => value / DEG,
            Motion::Prismatic => value / MM,
        });
        let group = names.get(pose.group).filter(|name| !name.is_empty());
        json!({ "joints": joints.collect::<Vec<_>>(), "group": group })
    });
    json!({
        "poses": poses.collect::<Vec<_>>(),
        "new_clamp": plan.group.as_ref().map(|clamp| json!({
            "name": clamp.name,
            "xyz_mm": <[f64; 3]>::from(clamp.device.origin / MM),
            "rpy_deg": clamp.device.roll_pitch_yaw().map(|angle| angle / DEG),
        })),
    })
}

/// One of the findings that are told together.
fn of_part(found: &CalibrationDiagnosis, part: usize) -> Value {
    let finding = &found.diagnosis.findings[part];
    let candidate = &found.world.candidates()[finding.chosen.candidate];
    let parameters = candidate.parameters.iter().zip(&finding.parameters);
    let parameters = parameters.map(|(parameter, (value, low, high))| {
        let unit = parameter.unit;
        json!({ "name": parameter.name, "value": value / unit, "lo": low / unit, "hi": high / unit })
    });
    let cycles = match found.world.gear(finding.chosen.candidate) {
        Some(gear @ (Gear::Harmonic { .. } | Gear::Wave { .. })) => {
            Some(gear.frequency(&finding.chosen.values).0)
        }
        _ => None,
    };
    json!({
        "place": finding.place,
        "cycles_per_rev": cycles,
        "p_value": finding.p_value,
        "explains_rms_um": finding.rms / UM,
        "survival": found.world.survival(finding.chosen.candidate),
        "parameters": parameters.collect::<Vec<_>>(),
    })
}
