//! A calibration's diagnosis as plain numbers for its pictures.

mod angle;
mod events;

use nalgebra::Vector3;

use super::distances::{Distances, mean};
use super::joints::joint_of;
use crate::diagnosis::calibration::{CalibrationDiagnosis, GearError};
use crate::inference::{Covariate, Finding, JointVariable, Location, Variable};
use crate::report::chart::Figure;
use crate::report::diagnosis::tables::covariates;
use crate::report::pictures::calibration::{
    MethodErrors, PoseVector, error_distribution, residual_vectors_of,
};
use crate::report::pictures::diagnosis::{BeforeAfter, Residual, ResidualPoint, before_after};
use crate::units::{MM, UM};

/// What was recorded.
const NOUN: &str = "poses";
const AXES: [&str; 3] = ["x", "y", "z"];
/// More poses are clouds, each axis by itself.
const DENSE: usize = 60;

/// What the calibration leaves, before and after: of each joint over its angle, the strongest of
/// what is not a gear's, or what is unexplained, over the number that it is best seen along, and
/// all of it in its order, with what happened.
pub fn seen(found: &CalibrationDiagnosis) -> Vec<Figure> {
    let mut figures = angle::errors(found);
    let other = found.diagnosis.findings.iter().find(|finding| GearError::of(finding).is_none());
    let is_told = other.is_some() || found.diagnosis.discrepancy.is_some() || figures.is_empty();
    let best = is_told.then(|| seen_along(found, other)).flatten();
    figures.extend(
        best.filter(|(covariate, _)| covariate.variable != Variable::Order)
            .map(|(covariate, joint)| residuals(found, covariate, joint)),
    );
    let order = found.evidence.covariate(Variable::Order);
    figures.extend(order.map(|order| residuals(found, order, None)));
    figures
}

/// Residuals before and after along a number, of a joint's motion or along the axes of the world.
fn residuals(found: &CalibrationDiagnosis, covariate: &Covariate, joint: Option<usize>) -> Figure {
    let diagnosis = &found.diagnosis;
    let [before, after] = [&diagnosis.before, &diagnosis.after].map(|data| found.model.by_row(data));
    let unexplained = diagnosis.discrepancy.as_ref().map(|left| found.model.by_row(&left.shape));
    let directions: Vec<(String, Option<usize>)> = match joint {
        Some(joint) => vec![(format!("along the motion of joint {}", joint + 1), None)],
        None => AXES.iter().enumerate().map(|(axis, name)| ((*name).to_owned(), Some(axis))).collect(),
    };
    let is_order = covariate.variable == Variable::Order;
    let series = directions.into_iter().map(|(label, axis)| {
        let part = |row: usize, error: &Vector3<f64>| match (axis, joint) {
            (Some(axis), _) => error[axis] / UM,
            (None, joint) => {
                let lever = joint.map_or_else(Vector3::zeros, |joint| found.model.tip_jacobians[row][joint]);
                lever.dot(error) / lever.norm().max(f64::MIN_POSITIVE) / UM
            }
        };
        let point = |row: usize| {
            let x = covariate.values[3 * row];
            (!x.is_nan()).then(|| ResidualPoint {
                x: if is_order { events::place(row) } else { x },
                before_um: part(row, &before[row]),
                after_um: part(row, &after[row]),
                unexplained_um: unexplained.as_ref().map_or(0.0, |rows| part(row, &rows[row])),
            })
        };
        Residual { label, points: (0..before.len()).filter_map(point).collect(), is_context: false }
    });
    let (title, unit) = (covariate.variable.title(NOUN), covariate.variable.unit());
    let unit = if unit.is_empty() { String::new() } else { format!(" / {unit}") };
    let events = if is_order { events::all(found) } else { Vec::new() };
    let marked = if events.is_empty() { "" } else { " Events are marked where they happened." };
    let figure = before_after(&BeforeAfter {
        along: format!("{title}{unit}"),
        names: Vec::new(),
        series: series.collect(),
        noise_um: diagnosis.noise / UM,
        is_apart: before.len() > DENSE,
        events,
    });
    let explained = match diagnosis.findings.is_empty() && diagnosis.discrepancy.is_none() {
        true => ". Nothing was found that explains a part of them.",
        false => {
            ", before and after the findings are included. Lines: what the findings explain, and the \
             unexplained remainder."
        }
    };
    figure.captioned(format!(
        "Residuals of the calibration along the {title}{explained} Pure noise would lie within the band.{marked}"
    ))
}

/// The covariate, and the joint whose motion shows it, where it is one joint's.
fn seen_along<'a>(
    found: &'a CalibrationDiagnosis,
    finding: Option<&Finding>,
) -> Option<(&'a Covariate, Option<usize>)> {
    let evidence = &found.evidence;
    let of_variable = |variable: Variable| {
        let covariate = evidence.covariate(variable)?;
        // of a curve over a joint's angle the axes of the world show more
        let joint = joint_of(variable).map(|(joint, _)| joint).filter(|_| finding.is_some());
        Some((covariate, joint))
    };
    let left = found.diagnosis.discrepancy.as_ref().and_then(|left| left.location.as_ref());
    let best = match (finding, left) {
        (Some(finding), _) => {
            (finding.effect.seen_along)(&finding.location).into_iter().find_map(of_variable)
        }
        (None, Some(Location::Curve { along: Some(along), .. })) => {
            let is_angle = joint_of(*along).is_some_and(|(_, what)| what == JointVariable::Angle);
            is_angle.then(|| of_variable(*along)).flatten()
        }
        (None, Some(_)) => None,
        (None, None) => {
            let z = |k: &usize| found.diagnosis.structure_before[*k].z;
            let most = covariates(evidence).into_iter().max_by(|a, b| z(a).total_cmp(&z(b)));
            most.map(|k| (&evidence.covariates[k], None))
        }
    };
    best.or_else(|| evidence.covariate(Variable::Order).map(|order| (order, None)))
}

/// Residuals before and after over the workspace.
pub fn vectors(found: &CalibrationDiagnosis) -> Figure {
    let poses = |data| {
        let rows = found.model.by_row(data);
        let tips = found.model.calibration.tips.iter().zip(&found.model.calibration.deflections);
        let of_residual = |(residual, (tip, bent)): (&Vector3<f64>, (&Vector3<f64>, &Vector3<f64>))| {
            PoseVector { at_mm: ((tip + bent) / MM).into(), residual_um: (residual / UM).into() }
        };
        rows.iter().zip(tips).map(of_residual).collect::<Vec<_>>()
    };
    let before = poses(&found.diagnosis.before);
    match found.diagnosis.findings.is_empty() {
        true => residual_vectors_of(&[("", before)]),
        false => residual_vectors_of(&[("before", before), ("after", poses(&found.diagnosis.after))]),
    }
}

/// Errors of a validation that are so many times larger than the others are shown in no histogram.
const SHOWN: f64 = 10.0;

/// Histograms of the distances, those of held-out poses and of the validation included.
pub fn distribution(found: &CalibrationDiagnosis, distances: &Distances) -> Figure {
    let method = |label: &str, lengths: &[f64]| MethodErrors {
        label: label.into(),
        errors_mm: lengths.iter().map(|length| length / MM).collect(),
    };
    let mut methods = vec![method("calibration as it is", &distances.before)];
    if !found.diagnosis.findings.is_empty() {
        methods.push(method("with the findings", &distances.after));
    }
    if let Some((before, after)) = &distances.held_out {
        methods.push(method("held out, as it is", before));
        methods.push(method("held out, with the findings", after));
    }
    // what is off by more would leave nothing else to be seen
    let is_shown = |lengths: &&[f64]| mean(lengths) < SHOWN * mean(&distances.after);
    for (name, lengths) in distances.of_validation() {
        methods.extend(Some(lengths).filter(is_shown).map(|lengths| method(name, lengths)));
    }
    error_distribution(&methods)
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::calibration::Campaign;
    use crate::calibration::campaign::Targets;
    use crate::calibration::{Mode, Options};
    use crate::diagnosis::calibration::{diagnose_as_recorded, look_at_validation};

    /// The demonstration with a displacement of every row, diagnosed.
    pub fn with_diagnosed(
        by: &dyn Fn(usize) -> Vector3<f64>,
        judge: impl FnOnce(&Campaign, &CalibrationDiagnosis),
    ) {
        let find = |name: &str| {
            Ok(match name {
                "measurements.csv" => include_str!("../../../../campaigns/tx90-5/measurements.csv"),
                "validation.csv" => include_str!("../../../../campaigns/tx90-5/validation.csv"),
                "readings.csv" => include_str!("../../../../campaigns/tx90-5/readings.csv"),
                _ => include_str!("../../../../rods/5.toml"),
            }
            .to_owned())
        };
        let text = include_str!("../../../../campaigns/tx90-5/campaign.toml");
        let mut campaign = Campaign::from_texts("campaign.toml", text, &find).unwrap();
        let Targets::Points(points) = &mut campaign.measurements.targets else { panic!("no points") };
        points.iter_mut().enumerate().for_each(|(row, point)| *point += by(row));
        let mut found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
        look_at_validation(&mut found).unwrap();
        judge(&campaign, &found);
    }
}
