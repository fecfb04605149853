//! What `rodcal calibrate` says: JSON, tables and pictures of a [`Calibration`].

mod cards;
mod figures;
mod groups;
mod tables;

pub(super) use figures::{convergence, mode_residuals};

use serde_json::{Map, Value, json};

use super::length::length;
use super::method;
use super::{Block, Report, Section};
use crate::calibration::campaign::{Recording, Refit, Station, Targets};
use crate::calibration::{
    Accuracy, Calibration, Campaign, CrossValidation, Mode, Summary, Validation, accuracy,
};
use crate::spatial::Pose;
use crate::units::{DEG, MM, UM, significant};
use groups::group_summaries;

/// Correlation of two estimates from which on they are reported together.
const HIGH_CORRELATION: f64 = 0.9;

/// The JSON of `rodcal calibrate --json`.
pub fn json(
    campaign: &Campaign,
    calibration: &Calibration,
    cross_validation: Option<&CrossValidation>,
) -> Value {
    let recording = &campaign.measurements;
    let parameters: Vec<Value> = calibration
        .parameters
        .iter()
        .map(|estimate| {
            let unit = estimate.parameter.unit();
            json!({
                "name": estimate.parameter.to_string(),
                "value": estimate.value / unit.si,
                "unit": unit.suffix,
                "std_error": estimate.std_error.map(|e| e / unit.si),
                "identifiable": estimate.identifiable,
                "nominal": estimate.nominal / unit.si,
                "correction": (estimate.value - estimate.nominal) / unit.si,
                "supported": estimate.is_supported(),
            })
        })
        .collect();
    let base = calibration.setup.base();
    json!({
        "robot": campaign.robot.name,
        "robot_source": campaign.robot.source,
        "rod": campaign.rod.as_ref().map(|rod| &rod.name),
        "mode": calibration.mode.name(),
        "converged": calibration.is_converged,
        "reason": calibration.fit.reason.to_string(),
        "plausible": calibration.is_plausible(),
        "poses": recording.len(),
        "measurements_source": recording.source,
        "parameters": parameters,
        "base": match recording.targets {
            Targets::Points(_) => json!({
                "xyz_mm": (base.origin / MM).as_slice(),
                "rpy_deg": base.roll_pitch_yaw().map(|angle| angle / DEG),
            }),
            Targets::Sockets(_) => Value::Null,
        },
        "stations": stations_json(recording, calibration),
        "tool_mm": (calibration.setup.tool / MM).as_slice(),
        "before": calibration.before.as_ref().map(|before| json!({
            "residual": summary_json(&before.residual),
            "validation": before.validation.as_ref().map(summary_json),
        })),
        "residual": summary_json(&Summary::of(&calibration.residuals())),
        "drawing_scale": calibration.drawing_scale,
        "noise_um": calibration.noise.pooled / UM,
        "noise_is_stated": calibration.noise.is_stated,
        "groups": groups_json(recording, calibration),
        "validation": calibration.validation.as_ref().map(validation_json),
        "accuracy": accuracy_json(campaign, &accuracy(campaign.accuracy.as_ref(), calibration, cross_validation)),
        "extrapolation": calibration.extrapolation.as_ref().map(|there| json!({
            "sd_um": there.sd / UM,
            "sd_calibrated_um": there.sd_calibrated / UM,
            "ratio": finite(there.ratio()),
            "joints_beyond": there.joints_beyond().iter().map(|(joint, ..)| joint + 1).collect::<Vec<_>>(),
        })),
        "cross_validation": cross_validation.map(|cv| {
            let mut object = summary_json(&cv.summary);
            object["folds"] = cv.folds.into();
            object
        }),
        "not_identified": calibration.held.iter().map(|held| {
            let shares: Map<String, Value> = calibration
                .parameters
                .iter()
                .zip(&held.direction)
                .filter(|(_, share)| share.abs() > 0.1)
                .map(|(estimate, &share)| (estimate.parameter.to_string(), share.into()))
                .collect();
            json!({ "combination": shares, "error_over_plausible_range": finite(held.relative_error) })
        }).collect::<Vec<_>>(),
        "correlations": calibration.correlations_above(HIGH_CORRELATION).iter().map(|(a, b, value)| {
            json!({ "a": a.to_string(), "b": b.to_string(), "value": value })
        }).collect::<Vec<_>>(),
        "condition": finite(calibration.observability.condition),
        "observability": observability_json(calibration),
        "outliers": calibration.outliers.iter().map(|&row| json!({
            "pose": recording.rows[row].pose,
            "group": recording.groups[recording.rows[row].group].name.to_string(),
            "line": recording.rows[row].line,
            "residual_um": calibration.deviations[row].norm() / UM,
        })).collect::<Vec<_>>(),
        "passes": calibration.passes.iter().map(|pass| json!({
            "deflection_change_um": pass.change / UM, "rms_um": pass.rms / UM, "noise_um": pass.noise / UM,
        })).collect::<Vec<_>>(),
        "sockets": recording.groups.iter().zip(&calibration.sockets).map(|(group, socket)| json!({
            "name": group.name.to_string(),
            "xyz_mm": socket.map(|(value, _)| value / MM),
            "std_error_mm": socket.map(|(_, error)| error.map(|e| e / MM)),
        })).collect::<Vec<_>>(),
    })
}

/// The frames of stations in {W}, that of the first; empty without a column for them.
fn stations_json(recording: &Recording, calibration: &Calibration) -> Vec<Value> {
    let frames =
        recording.stations.iter().zip(&calibration.stations).filter(|(known, _)| !known.name.is_empty());
    let of_station = |(station, motion): (&Station, &Pose)| {
        let frame = motion.then(&station.frame);
        json!({
            "name": station.name,
            "xyz_mm": (frame.origin / MM).as_slice(),
            "rpy_deg": frame.roll_pitch_yaw().map(|angle| angle / DEG),
        })
    };
    frames.map(of_station).collect()
}

fn accuracy_json(campaign: &Campaign, judged: &Accuracy) -> Value {
    let limits = campaign.accuracy.as_ref();
    json!({
        "verdict": judged.verdict.name(),
        "judged_by": judged.judged_by,
        "mean_um": judged.errors.map(|errors| errors.mean / UM),
        "max_um": judged.errors.map(|errors| errors.max / UM),
        "limit_mean_um": limits.and_then(|limits| limits.mean).map(|mean| mean / UM),
        "limit_max_um": limits.and_then(|limits| limits.max).map(|max| max / UM),
    })
}

/// JSON has no infinity.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn summary_json(summary: &Summary) -> Value {
    json!({
        "rms_um": summary.rms / UM,
        "mean_um": summary.mean / UM,
        "max_um": summary.max / UM,
        "median_um": summary.median / UM,
        "sd_um": summary.sd / UM,
    })
}

fn validation_json(validation: &Validation) -> Value {
    let mut object = summary_json(&validation.summary);
    object["poses"] = validation.errors.len().into();
    object["refit"] = match validation.refit {
        Refit::BaseTool => "base-tool",
        Refit::Nothing => "none",
    }
    .into();
    object
}

fn groups_json(recording: &Recording, calibration: &Calibration) -> Vec<Value> {
    group_summaries(recording, calibration)
        .into_iter()
        .zip(&calibration.noise.of_group)
        .map(|((name, count, summary), noise)| {
            let mut object = summary_json(&summary);
            object["name"] = name.into();
            object["poses"] = count.into();
            object["noise_um"] = (noise / UM).into();
            object
        })
        .collect()
}

fn observability_json(calibration: &Calibration) -> Value {
    let names = ["o1", "o2", "o3", "o4", "o5"];
    let mut object: Map<String, Value> = names
        .into_iter()
        .zip(calibration.observability.indices)
        .map(|(name, value)| (name.to_owned(), finite(value).into()))
        .collect();
    object.insert("units".into(), "residuals in mm; parameters in mm, mrad and urad/(N*m)".into());
    object.into()
}

/// The report of `rodcal calibrate`.
pub fn report(
    campaign: &Campaign,
    calibration: &Calibration,
    cross_validation: Option<&CrossValidation>,
) -> Report {
    Report {
        title: format!("Calibration of {}", campaign.robot.name),
        headline: headline(campaign, calibration, cross_validation),
        warnings: warnings(campaign, calibration),
        sections: sections(campaign, calibration, cross_validation),
        cards: cards::cards(campaign, calibration, cross_validation),
        method: method::paragraphs(method::CALIBRATION),
        ..Report::default()
    }
}

/// Of the files and of the calibration.
pub fn warnings(campaign: &Campaign, calibration: &Calibration) -> Vec<String> {
    let about_files = campaign.warnings.iter().map(ToString::to_string);
    about_files.chain(calibration.warnings.iter().map(ToString::to_string)).collect()
}

/// One sentence: how well the robot is known now.
pub fn headline(
    campaign: &Campaign,
    calibration: &Calibration,
    cross_validation: Option<&CrossValidation>,
) -> String {
    if !calibration.is_converged {
        return format!("{}: the calibration did not converge.", campaign.robot.name);
    }
    if !calibration.is_plausible() {
        return format!(
            "{}: THE FIT IS NOT PLAUSIBLE, {} rms are left, {} % of the arm's reach. Do not use its numbers.",
            campaign.robot.name,
            length(calibration.rms()),
            significant(100.0 * calibration.rms() / calibration.reach, 2)
        );
    }
    let residual = Summary::of(&calibration.residuals());
    let (count, poses) = (calibration.parameters.len(), campaign.measurements.len());
    let rod = match (&campaign.rod, calibration.mode) {
        (Some(rod), Mode::None) => format!(", rod {} assumed rigid", rod.name),
        (Some(rod), mode) => format!(", rod {} compensated ({})", rod.name, mode.name()),
        (None, _) => String::new(),
    };
    let before = calibration.before.as_ref();
    let was =
        before.map_or_else(String::new, |before| format!("{} rms before, ", length(before.residual.rms)));
    let now = if before.is_some() { " after" } else { "" };
    let mut words = format!(
        "{}{rod}: {count} parameters fitted to {poses} poses, residual {was}{} rms{now}",
        campaign.robot.name,
        length(residual.rms)
    );
    let described =
        |summary: &Summary| format!("{} on average, {} at most", length(summary.mean), length(summary.max));
    if let Some(validation) = &calibration.validation {
        let count = validation.errors.len();
        let summary = &validation.summary;
        let errors = match before.and_then(|before| before.validation.as_ref()) {
            Some(was) => format!(
                "{} on average before, {} after ({} at most)",
                length(was.mean),
                length(summary.mean),
                length(summary.max)
            ),
            None => described(summary),
        };
        words += &match (&campaign.measurements.targets, validation.refit) {
            (Targets::Sockets(_), _) => {
                format!("; the scatter of {count} validation poses in their sockets is {errors}")
            }
            (_, Refit::BaseTool) => {
                format!("; error at {count} validation poses {errors}, base and tool fitted again")
            }
            (_, Refit::Nothing) => format!("; error at {count} validation poses {errors}"),
        };
    }
    if let Some(cv) = cross_validation {
        words += &format!("; error at held-out poses ({} folds) {}", cv.folds, described(&cv.summary));
    }
    let judged = accuracy(campaign.accuracy.as_ref(), calibration, cross_validation);
    let verdict = cards::verdict_sentence(campaign, &judged);
    words + "." + &verdict.map_or_else(String::new, |verdict| format!(" {verdict}"))
}

/// The body of [`report`].
pub fn sections(
    campaign: &Campaign,
    calibration: &Calibration,
    cross_validation: Option<&CrossValidation>,
) -> Vec<Section> {
    let recording = &campaign.measurements;
    vec![
        Section::new(
            "How well the robot is known",
            vec![
                Block::Table(tables::errors(calibration, cross_validation)),
                Block::Figure(figures::distribution(calibration, cross_validation)),
                Block::Figure(figures::residuals(recording, calibration)),
                Block::Table(tables::groups(recording, calibration)),
                Block::Figure(figures::workspace(recording, calibration)),
                Block::Figure(figures::vectors(calibration)),
                Block::Figure(figures::arms_of(campaign, calibration)),
                Block::Figure(figures::against(recording, calibration)),
            ],
        ),
        Section::new(
            "Parameters",
            vec![
                Block::Paragraph(tables::PARAMETERS_NOTE.into()),
                Block::Table(tables::parameters(calibration)),
                Block::Figure(figures::corrections(calibration)),
                Block::Table(tables::placement(campaign, calibration)),
                tables::correlations(calibration, HIGH_CORRELATION),
                Block::Table(tables::observability(calibration)),
            ],
        ),
        Section::new(
            "How the fit went",
            vec![
                Block::Table(tables::passes(calibration)),
                Block::Figure(figures::convergence(&[calibration])),
            ],
        ),
    ]
}
