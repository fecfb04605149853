//! The pictures of a calibration's report, from results to plain numbers.

use crate::calibration::campaign::{Campaign, Group, Recording, Row, Targets};
use crate::calibration::{Calibration, CrossValidation, Summary};
use crate::report::arms::{ArmPose, arms};
use crate::report::chart::Figure;
use crate::report::pictures::calibration::convergence as convergence_picture;
use crate::report::pictures::calibration::{
    Abscissa, Convergence, MethodErrors, ModeResiduals, ParameterCorrection, PoseError, PoseResidual,
    PoseVector, ResidualGroup, error_distribution, error_over_workspace, parameter_corrections,
    residual_vectors, residuals_against, residuals_by_group,
};
use crate::robot::{Parameter, ParameterGroup};
use crate::statistics::HALF_95;
use crate::units::{DEG, MM, UM, URAD};

fn errors_mm(errors: &[f64]) -> Vec<f64> {
    errors.iter().map(|error| error / MM).collect()
}

/// The paper's Figs 10 and 11 for one calibration, before and after on the same axes.
pub(super) fn distribution(calibration: &Calibration, cross_validation: Option<&CrossValidation>) -> Figure {
    let method =
        |label: &str, errors: &[f64]| MethodErrors { label: label.into(), errors_mm: errors_mm(errors) };
    let before = calibration.before.as_ref();
    let mut methods = Vec::new();
    methods
        .extend(before.map(|before| method("nominal robot at the calibration's poses", &before.residuals)));
    methods.push(method("residuals of the calibration", &calibration.residuals()));
    let validated = before.filter(|before| !before.validation_errors.is_empty());
    methods.extend(validated.map(|before| method("nominal robot, validation", &before.validation_errors)));
    methods.extend(calibration.validation.as_ref().map(|after| method("validation", &after.errors)));
    methods.extend(cross_validation.map(|cv| method("held-out poses", &cv.errors)));
    error_distribution(&methods)
}

/// The arm in some of the poses, as it was calibrated.
pub(super) fn arms_of(campaign: &Campaign, calibration: &Calibration) -> Figure {
    let recording = &campaign.measurements;
    let poses: Vec<ArmPose> = (recording.rows.iter().enumerate())
        .map(|(row, own)| ArmPose {
            place: own.group,
            joints: recording.joints(row),
            name: format!("pose {}", own.pose),
        })
        .collect();
    let place = |group: &Group| {
        let is_known = matches!(recording.targets, Targets::Points(_));
        (group.name.to_string(), is_known.then_some(group.device.origin))
    };
    let is_tracked = recording.groups.iter().all(|group| group.name.is_tracked());
    let places: Vec<_> = if is_tracked { Vec::new() } else { recording.groups.iter().map(place).collect() };
    arms(&calibration.setup, campaign.rod.as_ref(), &poses, &places).captioned(
        "The arm in some of the poses, as calibrated, as sticks from joint to joint with rod or tool, and the flange \
         of the others.",
    )
}

/// Residuals against reach, joint angles, order and, where they were recorded, time and
/// temperature.
pub(super) fn against(recording: &Recording, calibration: &Calibration) -> Figure {
    let base = calibration.setup.base().origin;
    let mut along = vec![Abscissa {
        label: "reach / mm".into(),
        values: calibration.tips.iter().map(|tip| (tip - base).norm() / MM).collect(),
    }];
    along.extend((0..recording.joint_count).map(|joint| Abscissa {
        label: format!("q{} / °", joint + 1),
        values: (0..recording.len()).map(|row| recording.joints(row)[joint] / DEG).collect(),
    }));
    let known = |label: &str, value: fn(&Row) -> Option<f64>| -> Option<Abscissa> {
        let values: Vec<f64> = recording.rows.iter().map(|row| value(row).unwrap_or(f64::NAN)).collect();
        let is_known = values.iter().any(|v| v.is_finite());
        is_known.then(|| Abscissa { label: label.into(), values })
    };
    let time = known("time / s", |row| row.time);
    let order = || Abscissa {
        label: "pose, in recording order".into(),
        values: (1..=recording.len()).map(|pose| pose as f64).collect(),
    };
    along.push(time.unwrap_or_else(order));
    along.extend(known("temperature / °C", |row| row.temperature));
    let residuals: Vec<[f64; 3]> =
        calibration.deviations.iter().map(|deviation| (deviation / UM).into()).collect();
    residuals_against(&residuals, &along)
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
        .map(|group| ResidualGroup { name: group.name.to_string(), poses: Vec::new() })
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
    let corrections = |kind: CorrectionKind, unit: f64| -> Vec<ParameterCorrection> {
        calibration
            .parameters
            .iter()
            .filter(|estimate| CorrectionKind::of(estimate.parameter) == Some(kind))
            .map(|estimate| {
                let correction = (estimate.value - estimate.nominal) / unit;
                let half = estimate.std_error.map(|error| HALF_95 * error / unit);
                ParameterCorrection {
                    name: estimate.parameter.description(),
                    correction,
                    interval: half.map(|half| [correction - half, correction + half]),
                    note: String::new(),
                }
            })
            .collect()
    };
    let (lengths, angles) = (CorrectionKind::Length, CorrectionKind::Angle);
    parameter_corrections(&corrections(lengths, MM), &corrections(angles, URAD))
}

/// Which axis a correction is drawn on.
#[derive(Clone, Copy, PartialEq)]
enum CorrectionKind {
    Length,
    Angle,
}

impl CorrectionKind {
    fn of(parameter: Parameter) -> Option<CorrectionKind> {
        match parameter.group() {
            ParameterGroup::LinkLength | ParameterGroup::Tool => Some(CorrectionKind::Length),
            ParameterGroup::LinkTwist | ParameterGroup::JointZero => Some(CorrectionKind::Angle),
            ParameterGroup::BasePosition | ParameterGroup::BaseRotation | ParameterGroup::Compliance => None,
        }
    }
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
