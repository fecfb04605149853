//! Where a finding or a law is written: into the robot, out of the measured points, nowhere.

use nalgebra::DVector;

use super::super::effects::{move_points, registry};
use super::super::laws::written::written;
use super::super::model::CalibrationModel;
use crate::calibration::campaign::Campaign;
use crate::inference::law::Law;
use crate::inference::{Finding, WrittenTo};

/// Where a finding would be written, without doing so.
pub fn destination(finding: &Finding, model: &CalibrationModel) -> WrittenTo {
    write(finding, model, &mut model.campaign.clone())
}

/// Writes a finding into a campaign; the answer is where it went.
pub fn write(finding: &Finding, model: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    registry::record(finding.effect)
        .map_or(WrittenTo::Nowhere, |effect| (effect.write)(finding, model, extended))
}

/// Where a law would be written: into the robot's file where that knows its variable, or out of
/// the measured points.
pub fn law_destination(law: &Law, model: &CalibrationModel) -> WrittenTo {
    write_law(law, model, &mut model.campaign.clone()).0
}

/// The same, done; and a description of it.
pub fn write_law(law: &Law, model: &CalibrationModel, extended: &mut Campaign) -> (WrittenTo, String) {
    let source = format!("diagnose calibration, {}", model.campaign.file);
    if let Some(law) = written(law, &extended.robot, &source) {
        let description = format!("law, {}", law.description());
        extended.robot.laws.push(law);
        return (WrittenTo::Model, description);
    }
    let description = format!(
        "law of the {} over the {}, which this recording alone has",
        law.site.result.name, law.site.variable.name
    );
    let moved = model.by_row(&DVector::from_column_slice(&law.adds));
    (move_points(extended, &moved), description)
}
