//! What `--apply` writes of a diagnosed calibration, before and after it does.

use serde_json::{Value, json};

use super::super::headline::um;
use crate::calibration::campaign::Targets;
use crate::diagnosis::calibration::{Applied, CalibrationDiagnosis, law_destination};
use crate::inference::{Finding, Kind, WrittenTo};
use crate::report::{Block, Report, Section};
use crate::robot::is_urdf;
use crate::units::UM;

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

/// Where `--apply` writes a finding; `None` where no file has a place for it.
pub fn destination(finding: &Finding) -> Option<&'static str> {
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
