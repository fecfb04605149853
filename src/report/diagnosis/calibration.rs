//! What is a calibration's own in the report of its diagnosis.

mod distances;
mod doubts;
mod figures;
mod joints;
mod remains;
mod scatter;
mod validated;
mod written;

use serde_json::{Value, json};

use self::distances::{Distances, distances_json, mean};
use self::doubts::{doubtful, far_from_file};
use self::remains::remainder;
use self::written::destination;
pub use self::written::{announced, applied};
use super::subject::{Errors, LawNote, LawSubject, Subject};
use super::{json as whole_json, report as whole_report};
use crate::calibration::Warning;
use crate::diagnosis::calibration::{
    CalibrationDiagnosis, CalibrationModel, GearError, law_destination, remark,
};
use crate::inference::{Finding, ForwardModel, Plan, PosePlan};
use crate::report::{Block, Report};
use crate::robot::Motion;
use crate::units::{DEG, MM};

/// Coordinates of a pose.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The report of `rodcal diagnose calibration`.
pub fn report(found: &CalibrationDiagnosis) -> Report {
    whole_report(subject(found))
}

/// The JSON of `rodcal diagnose calibration --json`. Numbers in µm are root mean squares of a
/// coordinate, `distances` those of the tip.
pub fn json(found: &CalibrationDiagnosis) -> Value {
    whole_json(&subject(found))
}

/// What was found, and what it does to the errors.
pub fn headline(found: &CalibrationDiagnosis) -> String {
    super::headline::headline(&subject(found))
}

fn subject<'a>(found: &'a CalibrationDiagnosis<'_>) -> Subject<'a> {
    let (model, diagnosis) = (&found.model, &found.diagnosis);
    let campaign = model.campaign;
    let distances = Distances::of(found);
    let (before, after) = (mean(&distances.before), mean(&distances.after));
    let elsewhere = validated::elsewhere(found);
    let worse = distances.validated.as_ref().and_then(validated::warning);
    let held_out =
        vec![Block::Table(distances.table()), Block::Figure(figures::distribution(found, &distances))];
    Subject {
        evidence: &found.evidence,
        diagnosis,
        candidates: model.candidates(),
        not_testable: &found.not_testable,
        absorbed: &found.absorbed,
        limits: &found.limits,
        title: format!("Diagnosis of the calibration of {}", campaign.robot.name),
        noun: "poses",
        per: " per coordinate",
        agrees: "The calibrated robot explains the poses",
        errors: Errors {
            averaged: " on average",
            before: model.recorded.map_or(before, |recorded| recorded.mean),
            after,
            held_out: distances.held_out_means(),
        },
        before_correction: model.recorded.map(|recorded| recorded.rms / 3.0f64.sqrt()),
        doubtful: doubtful(found),
        nominal: far_from_file(found),
        uneven: model.scatter.as_ref().map(|own| scatter::uneven(own, diagnosis.lack_of_fit_after.is_some())),
        elsewhere,
        suspect: Box::new(|datum| {
            let row = &campaign.measurements.rows[datum / 3];
            json!({ "pose": row.pose, "channel": AXES[datum % 3] })
        }),
        law: found.law.as_ref().map(|proposed| LawSubject {
            proposed,
            noun: "poses",
            notes: proposed
                .laws()
                .map(|law| LawNote { written_to: law_destination(law, model), remark: remark(law) })
                .collect(),
            files: ["robot", "measurements"],
        }),
        remainder: remainder(found),
        warnings: warnings(found).chain(worse).collect(),
        head: vec![
            ("robot", json!(campaign.robot.name)),
            ("campaign", json!(campaign.file)),
            ("mode", json!(model.calibration.mode.name())),
        ],
        more: vec![
            ("distances", distances.json()),
            ("as_recorded", json!(model.recorded.map(|recorded| distances_json(&recorded)))),
        ],
        of_findings: diagnosis.findings.iter().map(more_of).collect(),
        details: diagnosis.findings.iter().map(details).collect(),
        sessions: (
            "Each clamp or placement predicted from the others, the search for effects included; rms of a coordinate, \
             about the socket's fitted position where that is unknown.",
            "calibration as it is",
        ),
        session_name: Box::new(|session| model.session(session)),
        plan: Box::new(|plan| match plan {
            Plan::Poses(plan) => pose_plan(found, plan),
            Plan::Loads(_) => Value::Null,
        }),
        source: None,
        places: figures::seen(found)
            .into_iter()
            .chain([figures::vectors(found)])
            .map(Block::Figure)
            .collect(),
        held_out,
        consequences: None,
        count: campaign.measurements.len(),
    }
}

/// Of the files and of the calibration, without what the first lines say themselves.
fn warnings(found: &CalibrationDiagnosis) -> impl Iterator<Item = String> {
    let CalibrationModel { campaign, calibration, validated, .. } = &found.model;
    let is_said = |own: &&Warning| validated.is_some() && matches!(own, Warning::ValidationFar { .. });
    let of_files = campaign.warnings.iter().map(ToString::to_string);
    of_files.chain(calibration.warnings.iter().filter(move |own| !is_said(own)).map(ToString::to_string))
}

/// A gear's shape takes several terms.
fn details(finding: &Finding) -> String {
    match GearError::of(finding).is_some() && finding.parts.len() > 1 {
        true => format!(" Its shape has {} terms.", finding.parts.len()),
        false => String::new(),
    }
}

/// Numbers of a finding that have keys of their own: where it is written, and of a gear the size of
/// its whole error.
fn more_of(finding: &Finding) -> Vec<(&'static str, Value)> {
    let mut more = vec![("written_to", destination(finding).map_or(Value::Null, Value::from))];
    let Some(gear) = GearError::of(finding) else { return more };
    let sizes = [("rms_urad", gear.rms), ("half_peak_to_peak_urad", gear.half_peak_to_peak)];
    more.extend(sizes.into_iter().filter_map(|(key, size)| Some((key, json!(size?.value)))));
    let cycles = |waves: &Vec<f64>| match waves[..] {
        [] => Value::Null,
        [cycles] => json!(cycles),
        ref several => json!(several),
    };
    let of_parts: Vec<Value> = gear.cycles_per_rev_of_parts.iter().map(cycles).collect();
    more.push(("cycles_per_rev_of_parts", json!(of_parts)));
    more
}

/// The poses to measure next, as numbers; a tracker's have no group.
fn pose_plan(found: &CalibrationDiagnosis, plan: &PosePlan) -> Value {
    let campaign = found.model.campaign;
    let groups = campaign.measurements.groups.iter();
    let mut names: Vec<String> = groups.map(|group| group.name.to_string()).collect();
    names.extend(plan.new_fixture.iter().map(|(name, _)| name.clone()));
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
        "new_fixture": plan.new_fixture.as_ref().map(|(name, frame)| json!({
            "name": name,
            "xyz_mm": <[f64; 3]>::from(frame.origin / MM),
            "rpy_deg": frame.roll_pitch_yaw().map(|angle| angle / DEG),
        })),
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::diagnosis::Limitation;
    use crate::inference::{Discrepancy, ShownBy};
    use crate::units::UM;

    /// Along the order of the poses, m.
    fn drift(row: usize) -> Vector3<f64> {
        Vector3::z() * (5.0 * UM * row as f64)
    }

    #[test]
    fn what_held_out_poses_do_not_confirm_is_called_possible_first() {
        figures::tests::with_diagnosed(&drift, |_, found| {
            let said = headline(found);
            assert!(
                said.starts_with("The base drifts") && said.contains("the held-out error falls"),
                "{said}"
            );
            let mut doubtful = found.clone();
            doubtful.diagnosis.held_out.as_mut().unwrap().errors_after *= 100.0;
            let said = headline(&doubtful);
            // validation poses are neither
            let said = said.split(" At the 30 validation poses").next().unwrap();
            assert!(said.starts_with("Possible, but held-out poses do not confirm this ("), "{said}");
            assert!(said.contains("): The base drifts") && !said.contains("falls"), "{said}");
            // numbers as far off as they cannot be would predict them as well
            for finding in &mut doubtful.diagnosis.findings {
                finding.parts.iter_mut().for_each(|part| part.takes_numbers_place = true);
            }
            let said = headline(&doubtful);
            assert!(said.starts_with("The base drifts"), "{said}");
            assert!(said.contains("Held-out poses do not distinguish it from numbers of the file"), "{said}");
        });
    }

    /// A name that most searches do not find again, or with which held-out poses are predicted
    /// hardly better, is said behind what nothing explains; one that they confirm, before it.
    #[test]
    fn what_is_hardly_confirmed_is_said_behind_what_remains() {
        figures::tests::with_diagnosed(&drift, |_, found| {
            let mut left = found.clone();
            left.diagnosis.discrepancy = Some(Discrepancy {
                candidate: None,
                location: None,
                shown_by: ShownBy::Repeats,
                rms: 20.0 * UM,
                shape: found.diagnosis.after.clone(),
            });
            let (first, behind) = ("The base drifts", "Repeated poses share an unexplained error");
            let said = headline(&left);
            assert!(said.starts_with(first) && said.contains(behind), "{said}");
            let mut lost = left.clone();
            lost.diagnosis.findings.iter_mut().for_each(|finding| finding.found_in_folds = Some((1, 5)));
            let said = headline(&lost);
            assert!(said.starts_with(behind), "{said}");
            assert!(said.contains("Beside it, and perhaps a part of it: the base drifts"), "{said}");
            // nothing else is left to be said first
            let mut alone = lost;
            alone.diagnosis.discrepancy = None;
            assert!(headline(&alone).starts_with(first), "{}", headline(&alone));
            let held_out = left.diagnosis.held_out.as_mut().unwrap();
            held_out.errors_after = held_out.errors_before.clone() * 0.97;
            assert!(headline(&left).starts_with(behind), "{}", headline(&left));
        });
    }

    /// What residuals of a fit that stopped anywhere seem to say is no agreement.
    #[test]
    fn a_calibration_that_did_not_converge_is_said_first_and_agrees_with_nothing() {
        figures::tests::with_diagnosed(&|_| Vector3::zeros(), |_, found| {
            assert_eq!(json(found)["verdict"], "consistent");
            let mut stopped = found.clone();
            stopped.limits.push(Limitation::NotConverged);
            let said = json(&stopped);
            assert_eq!(said["verdict"], "mismatch");
            assert_eq!(said["headline"], Limitation::NotConverged.to_string());
        });
    }
}
