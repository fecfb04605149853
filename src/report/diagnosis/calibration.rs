//! What `diagnose calibration` says: JSON, words, tables and pictures of a [`CalibrationDiagnosis`].

mod figures;
mod headline;
mod json;
mod remainder;
mod sections;

use crate::calibration::{Campaign, Summary};
use crate::diagnosis::calibration::{Applied, CalibrationDiagnosis};
use crate::report::calibration::warnings as of_calibration;
use crate::report::diagnosis::headline::um;
use crate::report::{Block, Report, Section};
use crate::units::UM;
pub use headline::headline;
pub use json::json;
use serde_json::{Value, json};

/// The report of `rodcal diagnose calibration`.
pub fn report(campaign: &Campaign, found: &CalibrationDiagnosis) -> Report {
    Report {
        title: format!("Diagnosis of the calibration of {}", campaign.robot.name),
        headline: headline(found),
        warnings: warnings(campaign, found),
        sections: sections::all(campaign, found),
        provenance: Vec::new(),
    }
}

/// What was written into the robot, on the page and in the JSON.
pub fn applied(report: &mut Report, json: &mut Value, applied: &Applied) {
    let said = [
        ("Entered into the robot", &applied.entered),
        ("Taken out of the measured points", &applied.removed),
        ("Left out, for the model cannot hold it", &applied.left_out),
    ];
    let of_list = |(what, list): (&str, &Vec<String>)| {
        list.iter().map(|words| format!("{what}: {words}")).collect::<Vec<_>>()
    };
    let mut points: Vec<String> = said.into_iter().flat_map(of_list).collect();
    points.push(format!(
        "Calibrated again with that, the tip is {} µm on average from where it was measured.",
        um(applied.mean)
    ));
    report.sections.push(Section::new("What becomes of the robot", vec![Block::List(points)]));
    json["applied"] = json!({
        "files": applied.files.iter().map(|(name, _)| name).collect::<Vec<_>>(),
        "entered": applied.entered,
        "removed": applied.removed,
        "left_out": applied.left_out,
        "mean_um": applied.mean / UM,
    });
}

fn warnings(campaign: &Campaign, found: &CalibrationDiagnosis) -> Vec<String> {
    let of_calibration = of_calibration(campaign, &found.calibration).into_iter();
    of_calibration.chain(found.limits.iter().map(ToString::to_string)).collect()
}

/// Distances of the poses from where they were measured, m.
struct Distances {
    before: Vec<f64>,
    after: Vec<f64>,
    /// Of poses while they were held out.
    held_out: Option<(Vec<f64>, Vec<f64>)>,
}

impl Distances {
    fn of(found: &CalibrationDiagnosis) -> Distances {
        let lengths = |data| found.by_row(data).iter().map(|row| row.norm()).collect();
        let known = |data| {
            let all: Vec<f64> = lengths(data);
            all.into_iter().filter(|length| length.is_finite()).collect()
        };
        let proof = found.diagnosis.proof.as_ref();
        Distances {
            before: lengths(&found.diagnosis.before),
            after: lengths(&found.diagnosis.after),
            held_out: proof.map(|proof| (known(&proof.errors_before), known(&proof.errors_after))),
        }
    }

    /// Means of held-out poses, before and after, m.
    fn held_out_means(&self) -> Option<(f64, f64)> {
        let mean = |lengths: &[f64]| Summary::of(lengths).mean;
        self.held_out.as_ref().map(|(before, after)| (mean(before), mean(after)))
    }
}
