//! How far the tip is from where it was measured, before and after the findings.

use serde_json::{Value, json};

use crate::calibration::Summary;
use crate::diagnosis::calibration::{CalibrationDiagnosis, Validated};
use crate::report::diagnosis::headline::um;
use crate::report::table::{Column, Table};
use crate::units::UM;

/// Distances of the poses from where they were measured, m.
pub struct Distances {
    pub before: Vec<f64>,
    pub after: Vec<f64>,
    /// Of poses while they were held out.
    pub held_out: Option<(Vec<f64>, Vec<f64>)>,
    /// Of the validation, where there is one.
    pub validated: Option<Validated>,
}

impl Distances {
    pub fn of(found: &CalibrationDiagnosis) -> Distances {
        let lengths = |data| found.model.by_row(data).iter().map(|row| row.norm()).collect();
        let known = |data| {
            let all: Vec<f64> = lengths(data);
            all.into_iter().filter(|length| length.is_finite()).collect()
        };
        let held_out = found.diagnosis.held_out.as_ref();
        Distances {
            before: lengths(&found.diagnosis.before),
            after: lengths(&found.diagnosis.after),
            held_out: held_out
                .map(|held_out| (known(&held_out.errors_before), known(&held_out.errors_after))),
            validated: found.model.validated.clone(),
        }
    }

    /// Means of held-out poses, before and after, m.
    pub fn held_out_means(&self) -> Option<(f64, f64)> {
        self.held_out.as_ref().map(|(before, after)| (mean(before), mean(after)))
    }

    /// Of the validation, with what they are of.
    pub fn of_validation(&self) -> Vec<(&'static str, &[f64])> {
        let Some(Validated { before, after, own, .. }) = &self.validated else { return Vec::new() };
        let own = own.as_ref().filter(|own| !own.events.is_empty());
        let all = [
            ("validation, calibration as it is", Some(before)),
            ("validation, calibrated with the findings", after.as_ref()),
            ("validation without its own events", own.map(|own| &own.errors)),
        ];
        all.into_iter().filter_map(|(name, lengths)| Some((name, &lengths?[..]))).collect()
    }

    pub fn json(&self) -> Value {
        let summary = |lengths: &[f64]| distances_json(&Summary::of(lengths));
        let own = self.validated.as_ref().and_then(|validated| validated.own.as_ref());
        json!({
            "before": summary(&self.before),
            "after": summary(&self.after),
            "heldout_before": self.held_out.as_ref().map(|(before, _)| summary(before)),
            "heldout_after": self.held_out.as_ref().map(|(_, after)| summary(after)),
            "validation_before": self.validated.as_ref().map(|own| summary(&own.before)),
            "validation_corrected": own.filter(|own| !own.events.is_empty()).map(|own| summary(&own.errors)),
            "validation_events": own.map_or_else(Vec::new, |own| own.events.clone()),
            "validation_after": self.validated.as_ref().and_then(|own| own.after.as_deref()).map(summary),
        })
    }

    pub fn table(&self) -> Table {
        let columns = ["mean", "max", "median", "rms"].map(|name| Column::number(name, "µm"));
        let columns = [vec![Column::text("of"), Column::number("poses", "")], columns.to_vec()].concat();
        let caption = "Distances of the tip from its measured position.";
        let mut table = Table::new("distances", caption, columns);
        let mut row = |name: &str, lengths: &[f64]| {
            let summary = Summary::of(lengths);
            let numbers = [summary.mean, summary.max, summary.median, summary.rms].map(um);
            table.row([vec![name.to_owned(), lengths.len().to_string()], numbers.to_vec()].concat());
        };
        row("calibration as it is", &self.before);
        row("with the findings", &self.after);
        if let Some((before, after)) = &self.held_out {
            row("held out, calibration as it is", before);
            row("held out, with the findings", after);
        }
        self.of_validation().into_iter().for_each(|(name, lengths)| row(name, lengths));
        table
    }
}

/// Mean length.
pub fn mean(lengths: &[f64]) -> f64 {
    Summary::of(lengths).mean
}

/// Mean, root mean square and maximum, µm.
pub fn distances_json(summary: &Summary) -> Value {
    json!({
        "mean_um": summary.mean / UM,
        "rms_um": summary.rms / UM,
        "max_um": summary.max / UM,
    })
}
