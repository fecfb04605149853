//! What is a calibration's own in the report of its diagnosis.

mod distances;
mod figures;
mod joints;

use serde_json::{Value, json};

use self::distances::{Distances, distances_json, mean};
use super::headline::um;
use super::remainder::{Remainder, Sample};
use super::subject::{Errors, LawNote, LawSubject, Subject};
use super::{json as whole_json, report as whole_report};
use crate::calibration::campaign::{self, Targets};
use crate::calibration::{MOST_SCATTER, Warning};
use crate::diagnosis::calibration::{Applied, CalibrationDiagnosis, GearError, law_destination, remark};
use crate::inference::{Finding, ForwardModel, Kind, Location, Plan, PosePlan, ShownBy, Variable, WrittenTo};
use crate::report::calibration::warnings as of_calibration;
use crate::report::{Block, Report, Section};
use crate::robot::{Motion, is_urdf};
use crate::rod;
use crate::units::{DEG, MM, UM, significant};

/// Coordinates of a pose.
const AXES: [&str; 3] = ["x", "y", "z"];
/// Most samples of the shape.
const SAMPLES: usize = 12;

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

/// What was written into the robot, on the page and in the JSON.
pub fn applied(report: &mut Report, json: &mut Value, applied: &Applied) {
    let said = [
        ("Corrected in the campaign", &applied.undone),
        ("Written into the robot file", &applied.entered),
        ("Corrected in the measurements", &applied.removed),
        ("Not written, because the file has no key for it", &applied.left_out),
    ];
    let list = |(what, list): (&str, &Vec<String>)| {
        list.iter().map(|words| format!("{what}: {words}")).collect::<Vec<_>>()
    };
    let mut points: Vec<String> = said.into_iter().flat_map(list).collect();
    points.push(format!(
        "Calibrated again with that, the mean distance of the tip from its measured position is {} µm.",
        um(applied.mean)
    ));
    if let Some((without, with)) = applied.unseen {
        let (without, with) = (um(without), um(with));
        points
            .push(format!("At the validation poses it is {with} µm, and {without} µm without the findings."));
        if applied.is_worse() {
            report.warnings.push(format!(
                "the corrected robot is worse at the validation poses: {with} µm on average, {without} µm without the findings; do not use it"
            ));
        }
    }
    report.sections.push(Section::new("The corrected robot", vec![Block::List(points)]));
    json["applied"] = json!({
        "files": applied.files.iter().map(|(name, _)| name).collect::<Vec<_>>(),
        "undone": applied.undone,
        "entered": applied.entered,
        "removed": applied.removed,
        "left_out": applied.left_out,
        "mean_um": applied.mean / UM,
        "validation_mean_before_um": applied.unseen.map(|(without, _)| without / UM),
        "validation_mean_um": applied.unseen.map(|(_, with)| with / UM),
    });
}

fn subject<'a>(found: &'a CalibrationDiagnosis<'_>) -> Subject<'a> {
    let (model, diagnosis) = (&found.model, &found.diagnosis);
    let campaign = model.campaign;
    let distances = Distances::of(found);
    let (before, after) = (mean(&distances.before), mean(&distances.after));
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
        uneven: None,
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
        warnings: of_calibration(campaign, &model.calibration),
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

/// What makes the rod's file one that may not be meant: a number that no rod has, a tip elsewhere.
fn doubtful(found: &CalibrationDiagnosis) -> Option<String> {
    let unusual = found.model.campaign.warnings.iter().find_map(|warning| match warning {
        campaign::Warning::Rod { file, warning: rod::Warning::Unusual { key, value, unit, least, most } } => {
            let value = significant(*value, 4);
            Some(format!(
                "`{key}` of {file} is {value} {unit}, where {least} to {most} {unit} is usual: check that first, \
                 for what follows takes it as stated."
            ))
        }
        _ => None,
    });
    let elsewhere = || {
        found.model.calibration.warnings.iter().find_map(|warning| match warning {
            Warning::TipElsewhere { calibrated, of_rod } => Some(format!(
                "The tip is {} mm from where the rod's file has it: is that the file of this rod? What follows \
                 takes it as stated.",
                significant((calibrated - of_rod).norm() / MM, 3)
            )),
            _ => None,
        })
    };
    unusual.or_else(elsewhere)
}

/// A parameter that the calibration has put far from the robot's file: no error of the poses, but
/// hardly what the file means.
fn far_from_file(found: &CalibrationDiagnosis) -> Option<String> {
    let calibration = &found.model.calibration;
    let known = &calibration.setup.robot.standard_uncertainty;
    let far = calibration.warnings.iter().filter_map(|warning| match warning {
        Warning::FarFromDrawing { parameter, correction, .. }
        | Warning::Implausible { parameter, correction } => {
            let times = correction.abs() / known.of(*parameter)?;
            Some((times, *parameter, *correction))
        }
        _ => None,
    });
    let (times, parameter, correction) = far.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (unit, times) = (parameter.unit(), significant(times, 2));
    let space = if unit.symbol == "°" { "" } else { " " };
    let correction = format!("{}{space}{}", significant(correction / unit.si, 3), unit.symbol);
    Some(format!(
        "Parameter {parameter} is {correction} from the robot file, {times} of its standard uncertainties."
    ))
}

/// Where `--apply` writes a finding; `None` where no file has a place for it.
fn destination(finding: &Finding) -> Option<&'static str> {
    match finding.written_to {
        WrittenTo::Model | WrittenTo::Recording if !finding.is_of_model() => Some("campaign"),
        WrittenTo::Model => Some("robot"),
        WrittenTo::Recording => Some("measurements"),
        WrittenTo::Nowhere => None,
    }
}

/// What `--apply` would do, before it does.
pub fn announced(report: &mut Report, found: &CalibrationDiagnosis) {
    let campaign = found.model.campaign;
    let (is_urdf, has_sockets) =
        (is_urdf(&campaign.robot_text), matches!(campaign.measurements.targets, Targets::Sockets(_)));
    let line = |finding: &Finding| {
        let what = (finding.effect.cause_at)(&finding.location);
        match destination(finding) {
            Some("robot") if is_urdf => {
                format!("Into a file beside the URDF, for calibrate and predict: {what}")
            }
            Some("robot") => format!("Into the robot file, for calibrate and predict: {what}"),
            Some("measurements") if finding.kind() == Kind::Physics => {
                format!("Out of the measurements, for these poses only; predict will not know it: {what}")
            }
            Some("measurements") if has_sockets => {
                format!("Into the measurements, where it is another socket from then on: {what}")
            }
            Some("measurements") => format!("Out of the measurements: {what}"),
            Some(_) => format!("Corrected in the campaign: {what}"),
            None => format!("Nowhere, because no file has a place for it: {what}"),
        }
    };
    let laws = found.law.iter().flat_map(|proposed| proposed.laws()).map(|law| {
        let what = format!("the law of the {} over the {}", law.site.result.name, law.site.variable.name);
        match law_destination(law, &found.model) {
            WrittenTo::Model if is_urdf => {
                format!("Into a file beside the URDF, for calibrate and predict: {what}")
            }
            WrittenTo::Model => format!("Into the robot file, for calibrate and predict: {what}"),
            WrittenTo::Recording => format!(
                "Out of the measurements, for these poses only, because this recording alone has the {}: {what}",
                law.site.variable.name
            ),
            WrittenTo::Nowhere => format!("Nowhere, because no file has a place for it: {what}"),
        }
    });
    let lines: Vec<String> = found.diagnosis.findings.iter().map(line).chain(laws).collect();
    if !lines.is_empty() {
        report.sections.push(Section::new("What --apply would write", vec![Block::List(lines)]));
    }
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

/// How much of what is left wanders, and over how many poses, or how long.
fn wandering(found: &CalibrationDiagnosis) -> String {
    let words = "An unexplained error wanders: poses that follow one another are off together";
    let Some(noise) = found.evidence.correlated_noise else { return words.to_owned() };
    let times = found.evidence.covariate(Variable::Time).map(|time| &time.values[..]).unwrap_or_default();
    let (first, last) = times.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &time| {
        // the smaller and the larger of two numbers are never NaN
        (a.min(time), b.max(time))
    });
    let minutes =
        (last - first) / (found.model.campaign.measurements.len().max(2) - 1) as f64 / 60.0 * noise.length;
    let or_minutes = match minutes > 0.0 && minutes.is_finite() {
        true => format!(" ({} min)", significant(minutes, 2)),
        false => String::new(),
    };
    format!(
        "{words}, over about {} poses{or_minutes}, with {} % of the variance of what is left",
        significant(noise.length, 2),
        significant(100.0 * noise.share, 2)
    )
}

/// What is structured and no effect explains, if anything is.
fn remainder(found: &CalibrationDiagnosis) -> Option<Remainder> {
    let left = found.diagnosis.discrepancy.as_ref()?;
    let (location, words, along) = match &left.location {
        Some(Location::Curve { label, follows, along }) => {
            (label.clone(), format!("An unexplained error {follows}"), *along)
        }
        _ => ("repeated poses".to_owned(), "Repeated poses share an unexplained error".to_owned(), None),
    };
    let test = &found.diagnosis.noise_test;
    let (location, words) = match (left.shown_by, test.stated) {
        (ShownBy::StatedNoise, Some(stated)) => {
            let (own, stated) = (um(test.estimated), um(stated));
            let words = format!(
                "The poses scatter by {own} µm, more than the stated noise of {stated} µm, and follow nothing that was \
                 recorded; does that noise hold for the robot's repeatability too"
            );
            ("all poses".to_owned(), words)
        }
        (ShownBy::Neighbours, _) => ("poses that follow one another".to_owned(), wandering(found)),
        _ => (location, words),
    };
    let rows = found.model.by_row(&left.shape);
    let is_no_scatter = found.is_implausible();
    let (location, words) = match left.location.is_none() && is_no_scatter {
        true => ("all poses".to_owned(), "The calibrated robot does not explain the poses".to_owned()),
        false => (location, words),
    };
    let largest = rows.iter().map(|row| row.norm()).fold(0.0, f64::max);
    let covariate = along
        .and_then(|along| found.evidence.covariate(along))
        .or_else(|| found.evidence.covariate(Variable::Order))?;
    let mut order: Vec<usize> = (0..rows.len()).filter(|&row| !covariate.values[3 * row].is_nan()).collect();
    order.sort_by(|&a, &b| covariate.values[3 * a].total_cmp(&covariate.values[3 * b]));
    let step = (order.len().saturating_sub(1) as f64 / (SAMPLES as f64 - 1.0)).max(1.0);
    let samples = (0..order.len().min(SAMPLES)).filter_map(|k| {
        let row = *order.get((k as f64 * step).round() as usize)?;
        Some(Sample {
            name: found.model.campaign.measurements.rows[row].pose.clone(),
            json: json!(row + 1),
            value: covariate.values[3 * row],
            left: rows[row].iter().copied().collect(),
        })
    });
    let rms = um(left.rms);
    Some(Remainder {
        location,
        sentence: match is_no_scatter {
            true => format!(
                "{words}: {rms} µm rms per coordinate, up to {} µm. No robot's error is more than {} % of \
                 its reach: check the signs, order and zeros of the joints, the units, the frames, and \
                 whether angles and positions of a row belong together.",
                um(largest),
                100.0 * MOST_SCATTER
            ),
            false if left.shown_by == ShownBy::StatedNoise => format!("{words}?"),
            false => format!("{words}: {rms} µm rms per coordinate, up to {} µm.", um(largest)),
        },
        rms: left.rms,
        along: covariate.variable,
        sample_of: "row",
        coordinates: &["x", "y", "z"],
        samples: samples.collect(),
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::calibration::campaign::FileNames;
    use crate::diagnosis::Limitation;
    use crate::diagnosis::calibration::apply;
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
            assert!(said.starts_with("Possible, but held-out poses do not confirm this ("), "{said}");
            assert!(said.contains("): The base drifts") && !said.contains("falls"), "{said}");
        });
    }

    #[test]
    fn a_corrected_robot_that_is_worse_at_unseen_poses_is_warned_of() {
        figures::tests::with_diagnosed(&drift, |campaign, found| {
            let names = FileNames::new("robot.toml", "measurements.csv");
            let mut written = apply(found, &names, &[]).unwrap().unwrap();
            assert!(campaign.validation.is_some() && !written.is_worse());
            let warnings = |written: &Applied| {
                let (mut report, mut json) = (Report::default(), json!({}));
                applied(&mut report, &mut json, written);
                (report.warnings, json["applied"]["validation_mean_um"].as_f64())
            };
            assert_eq!(warnings(&written).0, Vec::<String>::new());
            written.unseen = Some((78.0 * UM, 606.0 * UM));
            let (warned, mean) = warnings(&written);
            assert!(
                warned[0].contains("606 µm on average, 78 µm without the findings; do not use it"),
                "{warned:?}"
            );
            assert!((mean.unwrap() - 606.0).abs() < 1e-9);
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
