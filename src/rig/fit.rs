//! From readings to lines, and from lines to what they say about the rod.

use std::collections::HashMap;

use super::comparison::{Measured, check_stations, compare};
use super::laws::without_laws;
use super::line::{Line, LineKey, Sample};
use super::readings::{Axis, Phase, Reading, Readings};
use super::warning::{self, Warning};
use crate::beam::Physics;
use crate::compliance::DEFAULT_ELEMENTS;
use crate::error::{Error, Place, Result};
use crate::least_squares::Robust;
use crate::rod::{Rod, RodLaw};

/// How to fit.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Options {
    /// Physics of the model the readings are compared with.
    pub physics: Physics,
    /// Elements of that model.
    pub elements: usize,
    /// Weights against outliers.
    pub robust: Robust,
}

impl Default for Options {
    fn default() -> Self {
        Options { physics: Physics::default(), elements: DEFAULT_ELEMENTS, robust: Robust::None }
    }
}

impl Options {
    /// With this physics of the model.
    pub fn with_physics(self, physics: Physics) -> Options {
        Options { physics, ..self }
    }

    /// With a model of so many elements.
    pub fn with_elements(self, elements: usize) -> Options {
        Options { elements, ..self }
    }

    /// With these weights against outliers.
    pub fn with_robust(self, robust: Robust) -> Options {
        Options { robust, ..self }
    }
}

/// What the readings say.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Fit {
    /// One line for each direction, channel and place that has two different loads.
    pub lines: Vec<Line>,
    /// What follows for the rod; `None` without a rod.
    pub measured: Option<Measured>,
    /// What the user should know before believing it.
    pub warnings: Vec<Warning>,
}

/// Fits lines to `readings` and, where there is a `rod`, compares them with its model.
///
/// ```
/// use rodcal::prelude::*;
///
/// // NIST StRD "Pontius" (certified in lbf and inches): a load cell, no rod to compare with
/// const CSV: &str =
///     include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/stiffness_data/nist-load-cell.csv"));
/// let readings = Readings::from_text("nist-load-cell.csv", CSV)?;
/// let fit = rig::fit(&readings, None, &rig::Options::default())?;
/// let curve = fit.lines[0].quadratic.expect("20 different loads");
/// let b1 = curve.coefficients[1].value * 4.4482216152605 / 0.0254;
/// assert!((b1 / 7.32059160401003e-7 - 1.0).abs() < 1e-9);
/// // its straight line is none: F = 214.747
/// assert!((fit.lines[0].lack_of_fit.map_or(0.0, |test| test.f) - 214.747).abs() < 5e-4);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// Shapes: one [`Line`](crate::rig::line::Line) for each direction, channel and pair of stations;
/// C^F and C^g are 3 × 3 in {T}, m/N and m per g. Laws of the rod's file are taken out of the
/// readings: lines and compliance are those of the linear rest.
///
/// # Errors
/// [`Error::Input`] for stations off the rod, offsets against the load, or readings that measure
/// nothing the rod's model has; what the beam model and the fits refuse.
pub fn fit(readings: &Readings, rod: Option<&Rod>, options: &Options) -> Result<Fit> {
    if let Some(rod) = rod.filter(|rod| !rod.laws.is_empty()) {
        check_stations(readings, rod)?;
        let linear = without_laws(readings, rod, &options.physics, options.elements)?;
        let mut fit = fit(&linear, Some(&Rod { laws: Vec::new(), ..rod.clone() }), options)?;
        let laws = rod.laws.iter().filter(|law| law.is_static()).map(RodLaw::to_string);
        fit.warnings.splice(0..0, laws.map(|law| Warning::WithoutLaw { law }));
        return Ok(fit);
    }
    let mut lines = Vec::new();
    for key in keys(&readings.rows) {
        lines.extend(Line::fit(key, &samples(&readings.rows, &key), options.robust)?);
    }
    if lines.is_empty() {
        return Err(Error::Input {
            at: Place::whole_file(&readings.file),
            found: "no line has two different loads".into(),
            expected: "two loads or more along one direction, read and loaded at the same stations".into(),
            hint: Some("loads along z and along -z are different lines".into()),
        });
    }
    let mut warnings = warning::about_lines(&lines, readings, rod);
    let measured = match rod {
        Some(rod) => {
            let measured = compare(readings, rod, &lines, &options.physics, options.elements)?;
            warnings.extend(warning::about_ratios(&measured, &lines));
            Some(measured)
        }
        None => None,
    };
    Ok(Fit { lines, measured, warnings })
}

/// The lines the readings can be sorted into: by axis, direction, channel, places.
fn keys(rows: &[Reading]) -> Vec<LineKey> {
    let mut keys: Vec<LineKey> = Vec::new();
    for row in rows {
        for channel in Axis::ALL.into_iter().filter(|channel| row.offset[channel.index()].is_some()) {
            let key = LineKey::of_reading(row, channel);
            // rows of one line mostly follow each other
            if !keys.iter().rev().any(|known| *known == key) {
                keys.push(key);
            }
        }
    }
    let order = |key: &LineKey| (key.direction.axis, -key.direction.sign, key.channel);
    keys.sort_by_key(order);
    keys
}

fn samples(rows: &[Reading], key: &LineKey) -> Vec<Sample> {
    let is_of_line = |row: &&Reading| LineKey::of_reading(row, key.channel) == *key;
    let mut trials: HashMap<Option<&str>, usize> = HashMap::new();
    rows.iter()
        .filter(is_of_line)
        .filter_map(|row| {
            Some(Sample {
                load: row.load,
                offset: row.offset[key.channel.index()]?,
                phase: row.phase.unwrap_or(Phase::Load),
                trial: {
                    let next = trials.len();
                    *trials.entry(row.trial.as_deref()).or_insert(next)
                },
                line: row.line,
            })
        })
        .collect()
}
