//! The pictures of a calibration's report, from results to plain numbers.

use crate::calibration::campaign::Recording;
use crate::calibration::{Calibration, CrossValidation, Summary};
use crate::report::chart::Figure;
use crate::report::pictures::calibration::convergence as convergence_picture;
use crate::report::pictures::calibration::{
    Convergence, MethodErrors, ModeResiduals, ParameterCorrection, PoseError, PoseResidual, PoseVector,
    ResidualGroup, error_distribution, error_over_workspace, parameter_corrections, residual_vectors,
    residuals_by_group,
};
use crate::robot::Parameter;
use crate::units::{MM, UM};

/// Width of a 95 % interval in standard errors.
const INTERVAL: f64 = 1.96;
/// Milliradian in radians.
const MRAD: f64 = 1e-3;

fn errors_mm(errors: &[f64]) -> Vec<f64> {
    errors.iter().map(|error| error / MM).collect()
}

/// The paper's Figs 10 and 11 for one calibration.
pub(super) fn distribution(calibration: &Calibration, cross_validation: Option<&CrossValidation>) -> Figure {
    let mut methods = vec![MethodErrors {
        label: "residuals of the calibration".into(),
        errors_mm: errors_mm(&calibration.residuals()),
    }];
    methods.extend(calibration.validation.as_ref().map(|validation| MethodErrors {
        label: "validation".into(),
        errors_mm: errors_mm(&validation.errors),
    }));
    methods.extend(
        cross_validation
            .map(|cv| MethodErrors { label: "held-out poses".into(), errors_mm: errors_mm(&cv.errors) }),
    );
    error_distribution(&methods)
}

/// Of one mode, for panels above one another.
pub(in crate::report) fn mode_residuals(
    title: &str,
    recording: &Recording,
    calibration: &Calibration,
) -> ModeResiduals {
    let residuals = calibration.residuals();
    let mut groups: Vec<ResidualGroup> = recording
        .groups
        .iter()
        .map(|group| ResidualGroup { name: group.name.clone(), poses: Vec::new() })
        .collect();
    for (row, entry) in recording.rows.iter().enumerate() {
        groups[entry.group].poses.push(PoseResidual {
            name: entry.pose.clone(),
            length_um: residuals[row] / UM,
            outlier: calibration.outliers.contains(&row),
        });
    }
    ModeResiduals { title: title.into(), groups, rms_um: Summary::of(&residuals).rms / UM }
}

pub(super) fn residuals(recording: &Recording, calibration: &Calibration) -> Figure {
    let title = format!("mode {}", calibration.mode.name());
    residuals_by_group(&[mode_residuals(&title, recording, calibration)])
}

/// Errors of the validation where there is one, else of the calibration's own poses.
pub(super) fn workspace(_: &Recording, calibration: &Calibration) -> Figure {
    let (tips, errors) = match &calibration.validation {
        Some(validation) => (&validation.tips, validation.errors.clone()),
        None => (&calibration.tips, calibration.residuals()),
    };
    let poses: Vec<PoseError> = tips
        .iter()
        .zip(&errors)
        .map(|(tip, error)| PoseError { at_mm: (tip / MM).into(), error_mm: error / MM })
        .collect();
    error_over_workspace(&poses)
}

pub(super) fn vectors(calibration: &Calibration) -> Figure {
    let (tips, deviations) = match &calibration.validation {
        Some(validation) => (&validation.tips, &validation.deviations),
        None => (&calibration.tips, &calibration.deviations),
    };
    let poses: Vec<PoseVector> = tips
        .iter()
        .zip(deviations)
        .map(|(tip, deviation)| PoseVector { at_mm: (tip / MM).into(), residual_um: (deviation / UM).into() })
        .collect();
    residual_vectors(&poses)
}

/// Corrections of lengths and of angles; a compliance as the angle that it makes at the joint's
/// largest torque has no place here.
pub(super) fn corrections(calibration: &Calibration) -> Figure {
    let corrections = |unit: f64, wanted: &dyn Fn(Parameter) -> bool| -> Vec<ParameterCorrection> {
        calibration
            .parameters
            .iter()
            .filter(|estimate| wanted(estimate.parameter))
            .map(|estimate| {
                let correction = (estimate.value - estimate.nominal) / unit;
                let half = estimate.std_error.map(|error| INTERVAL * error / unit);
                ParameterCorrection {
                    name: estimate.parameter.to_string(),
                    correction,
                    interval: half.map(|half| [correction - half, correction + half]),
                    note: String::new(),
                }
            })
            .collect()
    };
    let is_length = |p: Parameter| matches!(p, Parameter::D(_) | Parameter::A(_) | Parameter::Tool(_));
    let is_angle = |p: Parameter| matches!(p, Parameter::Theta(_) | Parameter::Alpha(_) | Parameter::Beta(_));
    parameter_corrections(&corrections(MM, &is_length), &corrections(MRAD, &is_angle))
}

/// How the loops of one or more modes converged.
pub(in crate::report) fn convergence(calibrations: &[&Calibration]) -> Figure {
    let curves = |value: &dyn Fn(&crate::calibration::PassRecord) -> f64| -> Vec<(String, Vec<f64>)> {
        calibrations
            .iter()
            .map(|c| (format!("mode {}", c.mode.name()), c.passes.iter().map(value).collect()))
            .collect()
    };
    convergence_picture(&[
        Convergence {
            title: "largest change of a deflection".into(),
            quantity: "change".into(),
            unit: "µm".into(),
            tolerance: Some(1e-3),
            curves: curves(&|pass| pass.change / UM),
        },
        Convergence {
            title: "residuals".into(),
            quantity: "rms".into(),
            unit: "µm".into(),
            tolerance: None,
            curves: curves(&|pass| pass.rms / UM),
        },
    ])
}
