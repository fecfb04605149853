//! What a diagnosis of a calibration leaves unexplained.

use serde_json::json;

use super::super::headline::um;
use super::super::remainder::{Remainder, Sample};
use crate::calibration::MOST_SCATTER;
use crate::diagnosis::calibration::CalibrationDiagnosis;
use crate::inference::{Location, ShownBy, Variable};
use crate::units::significant;

/// Most samples of the shape.
const SAMPLES: usize = 12;

/// How much of what is left wanders, and over how many poses, or how long.
fn wandering(found: &CalibrationDiagnosis) -> String {
    let words = "An unexplained error wanders: poses that follow one another are off together";
    let Some(noise) = found.evidence.correlated_noise else { return words.to_owned() };
    let times = found.evidence.covariate(Variable::Time).map(|time| &time.values[..]).unwrap_or_default();
    let (first, last) = times.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &time| {
        // the smaller and the larger of two numbers are never NaN
        (a.min(time), b.max(time))
    });
    let minutes =
        (last - first) / (found.model.campaign.measurements.len().max(2) - 1) as f64 / 60.0 * noise.length;
    let or_minutes = match minutes > 0.0 && minutes.is_finite() {
        true => format!(" ({} min)", significant(minutes, 2)),
        false => String::new(),
    };
    format!(
        "{words}, over about {} poses{or_minutes}, with {} % of the variance of what is left",
        significant(noise.length, 2),
        significant(100.0 * noise.share, 2)
    )
}

/// What is structured and no effect explains, if anything is.
pub fn remainder(found: &CalibrationDiagnosis) -> Option<Remainder> {
    let left = found.diagnosis.discrepancy.as_ref()?;
    let (location, words, along) = match &left.location {
        Some(Location::Curve { label, follows, along }) => {
            (label.clone(), format!("An unexplained error {follows}"), *along)
        }
        _ => ("repeated poses".to_owned(), "Repeated poses share an unexplained error".to_owned(), None),
    };
    let test = &found.diagnosis.noise_test;
    let (location, words) = match (left.shown_by, test.stated) {
        (ShownBy::StatedNoise, Some(stated)) => {
            let (own, stated) = (um(test.estimated), um(stated));
            let words = format!(
                "The poses scatter by {own} µm, more than the stated noise of {stated} µm, and follow nothing that was \
                 recorded; does that noise hold for the robot's repeatability too"
            );
            ("all poses".to_owned(), words)
        }
        (ShownBy::Neighbours, _) => ("poses that follow one another".to_owned(), wandering(found)),
        _ => (location, words),
    };
    let rows = found.model.by_row(&left.shape);
    let is_no_scatter = found.is_implausible();
    let (location, words) = match left.location.is_none() && is_no_scatter {
        true => ("all poses".to_owned(), "The calibrated robot does not explain the poses".to_owned()),
        false => (location, words),
    };
    let largest = rows.iter().map(|row| row.norm()).fold(0.0, f64::max);
    let covariate = along
        .and_then(|along| found.evidence.covariate(along))
        .or_else(|| found.evidence.covariate(Variable::Order))?;
    let mut order: Vec<usize> = (0..rows.len()).filter(|&row| !covariate.values[3 * row].is_nan()).collect();
    order.sort_by(|&a, &b| covariate.values[3 * a].total_cmp(&covariate.values[3 * b]));
    let step = (order.len().saturating_sub(1) as f64 / (SAMPLES as f64 - 1.0)).max(1.0);
    let samples = (0..order.len().min(SAMPLES)).filter_map(|k| {
        let row = *order.get((k as f64 * step).round() as usize)?;
        Some(Sample {
            name: found.model.campaign.measurements.rows[row].pose.clone(),
            json: json!(row + 1),
            value: covariate.values[3 * row],
            left: rows[row].iter().copied().collect(),
        })
    });
    let rms = um(left.rms);
    Some(Remainder {
        location,
        sentence: match is_no_scatter {
            true => format!(
                "{words}: {rms} µm rms per coordinate, up to {} µm. No robot's error is more than {} % of \
                 its reach: check the signs, order and zeros of the joints, the units, the frames, and \
                 whether angles and positions of a row belong together.",
                um(largest),
                100.0 * MOST_SCATTER
            ),
            false if left.shown_by == ShownBy::StatedNoise => format!("{words}?"),
            false => format!("{words}: {rms} µm rms per coordinate, up to {} µm.", um(largest)),
        },
        rms: left.rms,
        along: covariate.variable,
        sample_of: "row",
        coordinates: &["x", "y", "z"],
        samples: samples.collect(),
    })
}
