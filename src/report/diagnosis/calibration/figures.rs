//! A calibration's diagnosis as plain numbers for its pictures.

use nalgebra::Vector3;

use super::Distances;
use crate::calibration::Campaign;
use crate::diagnosis::calibration::{CalibrationDiagnosis, Curve, Gear, Mismatch};
use crate::diagnosis::{Covariate, World};
use crate::report::chart::Figure;
use crate::report::diagnosis::shared::covariates;
use crate::report::pictures::calibration::{
    MethodErrors, PoseVector, error_distribution, residual_vectors_of,
};
use crate::report::pictures::diagnosis::{
    AngleError, BeforeAfter, Residual, ResidualPoint, angle_errors, before_after,
};
use crate::units::{MM, UM, URAD};

/// Points of a curve for each of its cycles, and at least and at most.
const PER_CYCLE: f64 = 12.0;
const POINTS: (f64, f64) = (120.0, 1500.0);
/// Part of a joint's longest lever below which a pose shows too little of its angle.
const LEVER: f64 = 0.25;
const AXES: [&str; 3] = ["x", "y", "z"];

/// A covariate as it is said.
pub fn along(name: &str) -> &str {
    match name {
        "order" => "order of the poses",
        "group" => "clamp or socket",
        "x" => "x of the tip",
        "y" => "y of the tip",
        "z" => "z of the tip",
        other => other,
    }
}

/// What was found, each along the number that it is best seen along: gears over their angles, the strongest of the others over
/// what it depends on. What is unexplained is in the latter.
pub fn seen(campaign: &Campaign, found: &CalibrationDiagnosis) -> Vec<Figure> {
    let mut figures = Vec::new();
    let joints: Vec<AngleError> = found
        .mismatches
        .iter()
        .filter_map(|mismatch| gear_of(found, mismatch).map(|joint| (mismatch, joint)))
        .filter_map(|(mismatch, joint)| angle_error(campaign, found, mismatch, joint))
        .collect();
    if !joints.is_empty() {
        figures.push(angle_errors(&joints).captioned(
            "How far joints are from where they say they are, over their own angles: as the poses show it with all else that \
             was found taken out, and what is left. A pose's error is told along the way that the joint moves the tip.",
        ));
    }
    let other = found.mismatches.iter().find(|mismatch| gear_of(found, mismatch).is_none());
    if other.is_some() || found.diagnosis.unexplained.is_some() || joints.is_empty() {
        figures.extend(residuals(found, other));
    }
    figures
}

fn gear_of(found: &CalibrationDiagnosis, mismatch: &Mismatch) -> Option<usize> {
    let candidate = found.diagnosis.findings[mismatch.parts[0]].chosen.candidate;
    found.world.gear(candidate).map(Gear::joint)
}

fn angle_error(
    campaign: &Campaign,
    found: &CalibrationDiagnosis,
    mismatch: &Mismatch,
    joint: usize,
) -> Option<AngleError> {
    let curve = found.gear(campaign, joint)?;
    let reach = found.diagnosis.findings[mismatch.parts[0]].reach;
    let after = found.by_row(&found.diagnosis.after);
    let longest = found.levers.iter().map(|levers| levers[joint].norm()).fold(0.0, f64::max);
    let recording = &campaign.measurements;
    let angles: Vec<f64> = (0..recording.len()).map(|row| recording.joints(row)[joint]).collect();
    let poses = (0..recording.len()).filter_map(|row| {
        let lever = found.levers[row][joint];
        let left = lever.dot(&after[row]) / lever.norm_squared();
        let shown = left + curve.at(angles[row]);
        (lever.norm() > LEVER * longest).then_some([angles[row].to_degrees(), shown / URAD, left / URAD])
    });
    Some(AngleError {
        joint: mismatch.location.clone(),
        poses: poses.collect(),
        curve: sampled(&curve, &angles)
            .map(|q| [q.to_degrees(), curve.at(q) / URAD, reach * curve.sd(q) / URAD])
            .collect(),
    })
}

/// Angles over the recorded range, as finely as the curve needs, rad.
fn sampled(curve: &Curve, angles: &[f64]) -> impl Iterator<Item = f64> + use<> {
    let low = angles.iter().copied().fold(f64::INFINITY, f64::min);
    let high = angles.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let cycles = curve.highest() * (high - low) / std::f64::consts::TAU;
    let count = (PER_CYCLE * cycles).clamp(POINTS.0, POINTS.1).round();
    (0..=count as usize).map(move |k| low + (high - low) * k as f64 / count)
}

/// Residuals before and after along the number that a mismatch, or what is unexplained, is best seen along.
fn residuals(found: &CalibrationDiagnosis, mismatch: Option<&Mismatch>) -> Option<Figure> {
    let (covariate, joint) = seen_along(found, mismatch)?;
    let diagnosis = &found.diagnosis;
    let [before, after] = [&diagnosis.before, &diagnosis.after].map(|data| found.by_row(data));
    let unexplained = diagnosis.unexplained.as_ref().map(|left| found.by_row(&left.shape));
    // along the way that a joint moves the tip, or along the axes of the world
    let directions: Vec<(String, Option<usize>)> = match joint {
        Some(joint) => vec![(format!("along the motion of joint {}", joint + 1), None)],
        None => AXES.iter().enumerate().map(|(axis, name)| ((*name).to_owned(), Some(axis))).collect(),
    };
    let series = directions.into_iter().map(|(label, axis)| {
        let part = |row: usize, of: &Vector3<f64>| match (axis, joint) {
            (Some(axis), _) => of[axis] / UM,
            (None, joint) => {
                let lever = joint.map_or_else(Vector3::zeros, |joint| found.levers[row][joint]);
                lever.dot(of) / lever.norm().max(f64::MIN_POSITIVE) / UM
            }
        };
        let point = |row: usize| {
            let x = covariate.values[3 * row];
            (!x.is_nan()).then(|| ResidualPoint {
                x,
                before_um: part(row, &before[row]),
                after_um: part(row, &after[row]),
                unexplained_um: unexplained.as_ref().map_or(0.0, |rows| part(row, &rows[row])),
            })
        };
        Residual { label, points: (0..before.len()).filter_map(point).collect(), is_context: false }
    });
    let unit = if covariate.unit.is_empty() { String::new() } else { format!(" / {}", covariate.unit) };
    let figure = before_after(&BeforeAfter {
        along: format!("{}{unit}", along(&covariate.name)),
        names: Vec::new(),
        series: series.collect(),
        noise_um: diagnosis.noise / UM,
    });
    Some(figure.captioned(format!(
        "What the calibration leaves of the poses along the {}, before and after; lines show what the findings say, and what \
         remains. What is noise stays in the band.",
        along(&covariate.name)
    )))
}

/// The covariate, and the joint whose motion shows it, where it is one joint's.
fn seen_along<'a>(
    found: &'a CalibrationDiagnosis,
    mismatch: Option<&Mismatch>,
) -> Option<(&'a Covariate, Option<usize>)> {
    let all = &found.evidence.covariates;
    let named = |name: &str| all.iter().find(|covariate| covariate.name == name);
    let unexplained = found.diagnosis.unexplained.as_ref().and_then(|left| left.candidate);
    let (effect, place) = match (mismatch, unexplained) {
        (Some(mismatch), _) => (mismatch.effect.as_str(), mismatch.location.clone()),
        (None, Some(curve)) => ("unknown", found.world.candidates()[curve].location.clone()),
        (None, None) => ("", String::new()),
    };
    let joint_name = place.split(", ").next().unwrap_or_default();
    let joint: Option<usize> = joint_name.strip_prefix("joint ").and_then(|number| number.parse().ok());
    let along_joint = |what: &str| {
        let covariate = named(&format!("{joint_name} {what}"))?;
        Some((covariate, joint.and_then(|number| number.checked_sub(1))))
    };
    let own = match effect {
        "backlash" => along_joint("approach").or_else(|| along_joint("torque")),
        "joint_compliance" | "joint_nonlinear_stiffness" | "link_flexibility" => along_joint("torque"),
        "encoder_scale" => along_joint("angle"),
        "readback_lag" => along_joint("move"),
        "thermal_drift" => named("temperature").or_else(|| named("time")).map(|covariate| (covariate, None)),
        "unknown" => named(&format!("{joint_name} angle")).map(|covariate| (covariate, None)),
        "" => {
            let z = |k: &usize| found.diagnosis.structure_before[*k].z;
            let most = covariates(&found.evidence).into_iter().max_by(|a, b| z(a).total_cmp(&z(b)));
            most.map(|k| (&all[k], None))
        }
        _ => None,
    };
    own.or_else(|| named("order").map(|covariate| (covariate, None)))
}

/// Residuals before and after over the workspace.
pub fn vectors(found: &CalibrationDiagnosis) -> Figure {
    let poses = |data| {
        let rows = found.by_row(data);
        let tips = found.calibration.tips.iter().zip(&found.calibration.deflections);
        let of = |(residual, (tip, bent)): (&Vector3<f64>, (&Vector3<f64>, &Vector3<f64>))| PoseVector {
            at_mm: ((tip + bent) / MM).into(),
            residual_um: (residual / UM).into(),
        };
        rows.iter().zip(tips).map(of).collect::<Vec<_>>()
    };
    let before = poses(&found.diagnosis.before);
    match found.mismatches.is_empty() {
        true => residual_vectors_of(&[("", before)]),
        false => residual_vectors_of(&[("before", before), ("after", poses(&found.diagnosis.after))]),
    }
}

/// Histograms of the distances, held-out ones included.
pub fn distribution(found: &CalibrationDiagnosis) -> Figure {
    let distances = Distances::of(found);
    let method = |label: &str, lengths: &[f64]| MethodErrors {
        label: label.into(),
        errors_mm: lengths.iter().map(|length| length / MM).collect(),
    };
    let mut methods = vec![method("calibration as it is", &distances.before)];
    if !found.mismatches.is_empty() {
        methods.push(method("with what was found", &distances.after));
    }
    if let Some((before, after)) = &distances.held_out {
        methods.push(method("held out, as it is", before));
        methods.push(method("held out, with what was found", after));
    }
    error_distribution(&methods)
}
