//! What is a calibration's own in the report of its diagnosis.

mod figures;

use serde_json::{Value, json};

use super::headline::um;
use super::remainder::{Remainder, Sample};
use super::subject::{Errors, Subject};
use super::{json as whole_json, report as whole_report};
use crate::calibration::{MOST_SCATTER, Summary, Warning};
use crate::diagnosis::calibration::{Applied, CalibrationDiagnosis, Gear};
use crate::inference::{Finding, ForwardModel, JointVariable, Location, Plan, PosePlan, ShownBy, Variable};
use crate::report::calibration::warnings as of_calibration;
use crate::report::table::{Column, Table};
use crate::report::{Block, Report, Section};
use crate::robot::Motion;
use crate::units::{DEG, MM, UM, URAD, significant};

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
        ("Removed from the measured points", &applied.removed),
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
    report.sections.push(Section::new("The corrected robot", vec![Block::List(points)]));
    json["applied"] = json!({
        "files": applied.files.iter().map(|(name, _)| name).collect::<Vec<_>>(),
        "undone": applied.undone,
        "entered": applied.entered,
        "removed": applied.removed,
        "left_out": applied.left_out,
        "mean_um": applied.mean / UM,
    });
}

fn subject<'a>(found: &'a CalibrationDiagnosis<'_>) -> Subject<'a> {
    let (model, diagnosis) = (&found.model, &found.diagnosis);
    let campaign = model.campaign;
    let distances = Distances::of(found);
    let (before, after) = (mean(&distances.before), mean(&distances.after));
    let proof =
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
        nominal: far_from_file(found),
        suspect: Box::new(|datum| {
            let row = &campaign.measurements.rows[datum / 3];
            json!({ "pose": row.pose, "channel": AXES[datum % 3] })
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
        of_findings: diagnosis.findings.iter().map(|finding| more_of(found, finding)).collect(),
        details: diagnosis.findings.iter().map(|finding| details(found, finding)).collect(),
        sessions: (
            "Each clamp or placement predicted from the others, the search for effects included; rms of a coordinate, \
             about the socket's fitted position where that is unknown.",
            "calibration as it is",
        ),
        session_name: Box::new(|session| model.session(session).to_owned()),
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
        proof,
        consequences: None,
        count: campaign.measurements.len(),
    }
}

/// A number of the robot that the calibration has put far from its file: no error of the poses, but hardly what the
/// file means.
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

/// A gear's shape takes several terms.
fn details(found: &CalibrationDiagnosis, finding: &Finding) -> String {
    match gear_of(found, finding).is_some() && finding.parts.len() > 1 {
        true => format!(" Its shape has {} terms.", finding.parts.len()),
        false => String::new(),
    }
}

/// The joint, from 0, whose gear a finding is about.
fn gear_of(found: &CalibrationDiagnosis, finding: &Finding) -> Option<usize> {
    finding.parts.first().and_then(|part| found.model.gear_of(part)).map(Gear::joint)
}

/// Of a gear the size of its whole error.
fn more_of(found: &CalibrationDiagnosis, finding: &Finding) -> Vec<(&'static str, Value)> {
    let Some((joint, curve)) = gear_of(found, finding).and_then(|j| Some((j, found.gear(j)?))) else {
        return Vec::new();
    };
    let angles = found.model.angles(joint);
    let turns: Vec<f64> = angles.iter().map(|&q| curve.at(q) / URAD).collect();
    let (low, high) = turns.iter().fold((0.0f64, 0.0f64), |(a, b), &t| (a.min(t), b.max(t)));
    let square: f64 = turns.iter().map(|t| t * t).sum();
    let cycles: Vec<Value> = finding
        .parts
        .iter()
        .map(|part| match found.model.gear_of(part) {
            Some(gear @ (Gear::Harmonic { .. } | Gear::Wave { .. })) => {
                json!(gear.frequency(&part.term.values).0)
            }
            Some(Gear::Harmonics { cycles_per_rev, .. }) => json!(cycles_per_rev),
            _ => Value::Null,
        })
        .collect();
    vec![
        ("rms_urad", json!((square / turns.len().max(1) as f64).sqrt())),
        ("half_peak_to_peak_urad", json!(0.5 * (high - low))),
        ("cycles_per_rev_of_parts", json!(cycles)),
    ]
}

/// The poses to measure next, as numbers; a tracker's have no group.
fn pose_plan(found: &CalibrationDiagnosis, plan: &PosePlan) -> Value {
    let campaign = found.model.campaign;
    let mut names: Vec<&str> = campaign.measurements.groups.iter().map(|group| group.name.as_str()).collect();
    names.extend(plan.new_fixture.iter().map(|(name, _)| name.as_str()));
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
        _ => (location, words),
    };
    let rows = found.model.by_row(&left.shape);
    let is_no_scatter = found.evidence.most_scatter.is_some_and(|most| found.diagnosis.noise > most);
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
        of: "row",
        coordinates: &["x", "y", "z"],
        samples: samples.collect(),
    })
}

fn distances_json(summary: &Summary) -> Value {
    json!({
        "mean_um": summary.mean / UM,
        "rms_um": summary.rms / UM,
        "max_um": summary.max / UM,
    })
}

/// Distances of the poses from where they were measured, m.
struct Distances {
    before: Vec<f64>,
    after: Vec<f64>,
    /// Of poses while they were held out.
    held_out: Option<(Vec<f64>, Vec<f64>)>,
}

fn mean(lengths: &[f64]) -> f64 {
    Summary::of(lengths).mean
}

impl Distances {
    fn of(found: &CalibrationDiagnosis) -> Distances {
        let lengths = |data| found.model.by_row(data).iter().map(|row| row.norm()).collect();
        let known = |data| {
            let all: Vec<f64> = lengths(data);
            all.into_iter().filter(|length| length.is_finite()).collect()
        };
        let held_out = found.diagnosis.held_out.as_ref();
        Distances {
            before: lengths(&found.diagnosis.before),
            after: lengths(&found.diagnosis.after),
            held_out: held_out
                .map(|held_out| (known(&held_out.errors_before), known(&held_out.errors_after))),
        }
    }

    /// Means of held-out poses, before and after, m.
    fn held_out_means(&self) -> Option<(f64, f64)> {
        self.held_out.as_ref().map(|(before, after)| (mean(before), mean(after)))
    }

    fn json(&self) -> Value {
        let summary = |lengths: &[f64]| distances_json(&Summary::of(lengths));
        json!({
            "before": summary(&self.before),
            "after": summary(&self.after),
            "heldout_before": self.held_out.as_ref().map(|(before, _)| summary(before)),
            "heldout_after": self.held_out.as_ref().map(|(_, after)| summary(after)),
        })
    }

    fn table(&self) -> Table {
        let columns = ["mean", "max", "median", "rms"].map(|name| Column::number(name, "µm"));
        let columns = [vec![Column::text("of"), Column::number("poses", "")], columns.to_vec()].concat();
        let caption = "Distances of the tip from its measured position.";
        let mut table = Table::new("distances", caption, columns);
        let mut row = |name: &str, lengths: &[f64]| {
            let summary = Summary::of(lengths);
            let numbers = [summary.mean, summary.max, summary.median, summary.rms].map(um);
            table.row([vec![name.to_owned(), lengths.len().to_string()], numbers.to_vec()].concat());
        };
        row("calibration as it is", &self.before);
        row("with the findings", &self.after);
        if let Some((before, after)) = &self.held_out {
            row("held out, calibration as it is", before);
            row("held out, with the findings", after);
        }
        table
    }
}

/// The joint, from 0, and its number that a covariate is.
fn joint_of(variable: Variable) -> Option<(usize, JointVariable)> {
    match variable {
        Variable::Joint(joint, what) => Some((joint, what)),
        _ => None,
    }
}
