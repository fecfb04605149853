//! What is structured and no effect explains: where, how much, its shape.

use nalgebra::Vector3;
use serde_json::{Value, json};

use crate::diagnosis::World;
use crate::diagnosis::calibration::{CalibrationDiagnosis, unexplained_at};
use crate::report::diagnosis::headline::um;
use crate::units::UM;

/// Most samples of the shape.
const SAMPLES: usize = 12;

/// The remainder as it is told.
pub struct Remainder {
    /// The place of its curve.
    pub location: String,
    /// Said as a sentence.
    pub sentence: String,
    /// Root mean square of a coordinate, m.
    pub rms: f64,
    /// Name and unit of the number it is sampled along.
    pub along: (String, String),
    /// Row, value, displacement of the tip (m).
    pub samples: Vec<(usize, f64, Vector3<f64>)>,
}

impl Remainder {
    /// For JSON: words and samples.
    pub fn shape(&self) -> Value {
        let sample = |(row, value, by): &(usize, f64, Vector3<f64>)| json!({ "row": row + 1, "value": value, "um": (by / UM).as_slice() });
        json!({
            "words": self.sentence,
            "along": self.along.0,
            "unit": self.along.1,
            "samples": self.samples.iter().map(sample).collect::<Vec<_>>(),
        })
    }
}

/// What remains, if anything does.
pub fn remainder(found: &CalibrationDiagnosis) -> Option<Remainder> {
    let left = found.diagnosis.unexplained.as_ref()?;
    let place = left.candidate.map(|candidate| found.world.candidates()[candidate].location.clone());
    let words = match &place {
        Some(place) => format!("Something that no effect of the library explains {}", unexplained_at(place)),
        None => "Repeated poses agree on something that no effect of the library explains".to_owned(),
    };
    let rows = found.by_row(&left.shape);
    let largest = rows.iter().map(|row| row.norm()).fold(0.0, f64::max);
    let name = place.as_deref().and_then(|place| place.split(", ").next()).unwrap_or_default();
    let covariates = &found.evidence.covariates;
    let named = |wanted: &str| covariates.iter().find(|covariate| covariate.name == wanted);
    let covariate = named(name).or_else(|| named(&format!("{name} angle"))).or_else(|| named("order"))?;
    let mut order: Vec<usize> = (0..rows.len()).filter(|&row| !covariate.values[3 * row].is_nan()).collect();
    order.sort_by(|&a, &b| covariate.values[3 * a].total_cmp(&covariate.values[3 * b]));
    let step = (order.len().saturating_sub(1) as f64 / (SAMPLES as f64 - 1.0)).max(1.0);
    let samples = (0..order.len().min(SAMPLES)).filter_map(|k| {
        let row = *order.get((k as f64 * step).round() as usize)?;
        Some((row, covariate.values[3 * row], rows[row]))
    });
    Some(Remainder {
        sentence: format!("{words}: {} µm rms per coordinate, up to {} µm.", um(left.rms), um(largest)),
        location: place.unwrap_or_else(|| "repeated poses".into()),
        rms: left.rms,
        along: (covariate.name.clone(), covariate.unit.clone()),
        samples: samples.collect(),
    })
}
