//! What `diagnose calibration` says: JSON, words, tables and pictures of a [`CalibrationDiagnosis`].

mod figures;
mod headline;
mod json;
mod remainder;
mod sections;

use crate::calibration::{Campaign, Summary};
use crate::diagnosis::calibration::CalibrationDiagnosis;
use crate::report::Report;
use crate::report::calibration::warnings as of_calibration;
pub use headline::headline;
pub use json::json;

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
