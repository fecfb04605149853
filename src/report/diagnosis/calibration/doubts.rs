//! What makes files doubtful that a diagnosis of a calibration takes as stated.

use crate::calibration::Warning;
use crate::calibration::campaign;
use crate::diagnosis::calibration::CalibrationDiagnosis;
use crate::rod;
use crate::units::{MM, significant};

/// What makes the rod's file one that may not be meant: a number that no rod has, a tip elsewhere.
pub fn doubtful(found: &CalibrationDiagnosis) -> Option<String> {
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
    // where nothing fits, the tip is anywhere
    let elsewhere = || {
        if found.is_implausible() {
            return None;
        }
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
pub fn far_from_file(found: &CalibrationDiagnosis) -> Option<String> {
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
