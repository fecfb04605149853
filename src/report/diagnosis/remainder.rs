//! What is structured and no effect explains: where, how much, its shape.

use serde_json::{Value, json};

use super::headline::um;
use super::{branch_name, line_name};
use crate::diagnosis::rig::{Datum, RigDiagnosis, unexplained_at};
use crate::diagnosis::{Unexplained, World};
use crate::units::UM;

/// Most samples of the shape along one line.
const SAMPLES: usize = 12;

/// The remainder as it is told.
pub struct Remainder {
    /// Where: the place of its curve, or the condition that is worst.
    pub location: String,
    /// Said as a sentence.
    pub sentence: String,
    /// Root mean square, m.
    pub rms: f64,
    /// What it follows, for example `load`, with its unit.
    pub along: (String, String),
    /// Samples of the shape: line of readings, value of the covariate, m.
    pub samples: Vec<(String, f64, f64)>,
}

impl Remainder {
    /// For JSON: words and samples.
    pub fn shape(&self) -> Value {
        let (name, unit) = &self.along;
        let sample = |(line, value, left): &(String, f64, f64)| json!({ "readings": line, "value": value, "um": left / UM });
        json!({
            "words": self.sentence,
            "along": name,
            "unit": unit,
            "samples": self.samples.iter().map(sample).collect::<Vec<_>>(),
        })
    }
}

/// What remains, if anything does.
pub fn remainder(found: &RigDiagnosis) -> Option<Remainder> {
    let left = found.diagnosis.unexplained.as_ref()?;
    Some(match left.candidate {
        Some(candidate) => of_curve(found, left, &found.world.candidates()[candidate].location),
        None => of_conditions(found, left),
    })
}

fn of_curve(found: &RigDiagnosis, left: &Unexplained, place: &str) -> Remainder {
    // a curve over the load is sampled along it; one over the position in a run along the order
    let name = place.split(", ").next().unwrap_or_default();
    let along = match name {
        "order" | "time" | "temperature" => name,
        "position in the run" => "order",
        _ => "load",
    };
    let covariate = found.evidence.covariates.iter().find(|covariate| covariate.name == along);
    let values: Vec<f64> = match covariate {
        Some(covariate) => covariate.values.clone(),
        None => found.world.data().iter().map(|datum| datum.load).collect(),
    };
    let samples = sampled(found.world.data(), &values, left);
    let largest = left.shape.amax();
    Remainder {
        location: place.to_owned(),
        sentence: format!(
            "Something that no effect of the library explains {}: {} µm rms, up to {} µm.",
            unexplained_at(place),
            um(left.rms),
            um(largest)
        ),
        rms: left.rms,
        along: (along.to_owned(), covariate.map_or_else(|| "N".into(), |c| c.unit.clone())),
        samples,
    }
}

/// Where no curve describes it, the averages of the repeats tell.
fn of_conditions(found: &RigDiagnosis, left: &Unexplained) -> Remainder {
    let data = found.world.data();
    let loads: Vec<f64> = data.iter().map(|datum| datum.load).collect();
    let samples = means(data, &loads, left);
    let worst = samples.iter().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
    let (location, average) = worst.map_or((String::new(), 0.0), |(line, load, average)| {
        (format!("{load:.4} N, {line}").replace(".0000 N", " N"), *average)
    });
    Remainder {
        sentence: format!(
            "Averages of repeated readings leave the model by more than noise, in no shape that a smooth curve or an \
             effect of the library describes: {} µm rms, most at {location} ({} µm).",
            um(left.rms),
            um(average)
        ),
        location,
        rms: left.rms,
        along: ("load".into(), "N".into()),
        samples,
    }
}

/// The shape by line, thinned to what can be read.
fn sampled(data: &[Datum], values: &[f64], left: &Unexplained) -> Vec<(String, f64, f64)> {
    let all = means(data, values, left);
    let is_flat = |line: &str| all.iter().filter(|(l, ..)| l == line).all(|(.., y)| *y == 0.0);
    let mut lines: Vec<&String> = all.iter().map(|(line, ..)| line).collect();
    lines.dedup();
    let mut samples = Vec::new();
    for line in lines.into_iter().filter(|line| !is_flat(line)) {
        let of_line: Vec<&(String, f64, f64)> = all.iter().filter(|(l, ..)| l == line).collect();
        let step = (of_line.len() as f64 - 1.0) / (SAMPLES as f64 - 1.0);
        let count = of_line.len().min(SAMPLES);
        let at = |k: usize| if of_line.len() <= SAMPLES { k } else { (k as f64 * step).round() as usize };
        samples.extend((0..count).filter_map(|k| of_line.get(at(k)).map(|sample| (*sample).clone())));
    }
    samples
}

/// Mean of the shape for each line and value, lines in order of appearance, values ascending.
fn means(data: &[Datum], values: &[f64], left: &Unexplained) -> Vec<(String, f64, f64)> {
    let has_down = data.iter().any(|datum| branch_name(datum) != line_name(datum));
    let name = |datum: &Datum| if has_down { branch_name(datum) } else { line_name(datum) };
    let mut lines: Vec<String> = Vec::new();
    data.iter().map(name).for_each(|line| {
        if !lines.contains(&line) {
            lines.push(line);
        }
    });
    let mut found = Vec::new();
    for line in lines {
        let known = |i: &usize| name(&data[*i]) == line && !values[*i].is_nan();
        let mut points: Vec<(f64, f64)> =
            (0..data.len()).filter(known).map(|i| (values[i], left.shape[i])).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.extend(points.chunk_by(|a, b| a.0 == b.0).map(|same| {
            let sum: f64 = same.iter().map(|(_, y)| y).sum();
            (line.clone(), same[0].0, sum / same.len() as f64)
        }));
    }
    found
}
