//! From rig readings to compliance: lines, correction factors r, and the Meas matrices C^F and C^g.
//!
//! With c_mn the measured slope (offset along m per load along n) and c'_mn the model's (FEA):
//!
//! ```text
//! r_mn  = c_mn / c'_mn                          (Eq 20)
//! r_rod = (c_22 + c_33) / (c'_22 + c'_33)       (Eq 21)
//! C^g   = r_rod C'^g                            (Eq 22), and so are the entries of C^F that were not measured
//! ```
//!
//! Source: Improved MultiCal, *Sensors* 23 (2023) 5717, § 4.2.

mod curve;
pub mod line;
pub mod readings;
mod repeats;
mod warning;

use nalgebra::Matrix3;

use crate::beam::{Physics, RodModel};
use crate::compliance::{Compliance, DEFAULT_ELEMENTS, closed_form};
use crate::error::{Error, Place, Result};
use crate::least_squares::Robust;
use crate::rod::Rod;
use crate::statistics::Estimate;
use crate::units::UM;
use line::{Line, LineKey, Sample};
use readings::{Axis, Phase, Reading, Readings};
pub use warning::Warning;

/// How to fit.
#[derive(Debug, Clone, Copy)]
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

/// What the readings say.
#[derive(Debug, Clone)]
pub struct Fit {
    /// One line for each direction, channel and place that has two different loads.
    pub lines: Vec<Line>,
    /// What follows for the rod; `None` without a rod.
    pub measured: Option<Measured>,
    /// What the user should know before believing it.
    pub warnings: Vec<Warning>,
}

/// Measured compared with modelled, and the Meas compliance.
#[derive(Debug, Clone)]
pub struct Measured {
    /// r_mn of every measured entry that the model says is not zero.
    pub ratios: Vec<Ratio>,
    /// r_rod.
    pub rod_ratio: Estimate,
    /// FEA compliance.
    pub model: Compliance,
    /// Slope of each of the fit's lines by the FEA model, m/N: at the line's stations.
    pub predicted: Vec<f64>,
    /// Calc compliance, where the closed form applies to the rod.
    pub calc: Option<Compliance>,
    /// Meas compliance.
    pub compliance: Compliance,
    /// Standard errors of the entries of the Meas compliance; NaN where the readings give none.
    pub std_error: Compliance,
    /// Entries of C^F that rest on readings of their own (by reciprocity also the transposed ones).
    pub is_measured: Matrix3<bool>,
}

/// r_mn = c_mn / c'_mn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// Axis of the offset m.
    pub channel: Axis,
    /// Axis of the load n.
    pub load: Axis,
    /// Its value.
    pub value: Estimate,
}

impl Ratio {
    /// "22", "33", …: the paper's indices, counted from 1.
    pub fn name(&self) -> String {
        format!("{}{}", self.channel.index() + 1, self.load.index() + 1)
    }
}

/// Fits lines to `readings` and, where there is a `rod`, compares them with its model.
///
/// # Errors
/// [`Error::Input`] for stations off the rod, offsets against the load, or readings that measure nothing the
/// rod's model has; what the beam model and the fits refuse.
pub fn fit(readings: &Readings, rod: Option<&Rod>, options: &Options) -> Result<Fit> {
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
    let mut warnings = warning::of_lines(&lines, readings, rod);
    let measured = match rod {
        Some(rod) => {
            let measured = compare(readings, rod, &lines, options)?;
            warnings.extend(warning::of_ratios(&measured, &lines));
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
            let key = key_of(row, channel);
            if !keys.contains(&key) {
                keys.push(key);
            }
        }
    }
    let order = |key: &LineKey| (key.direction.axis, -key.direction.sign, key.channel);
    keys.sort_by_key(order);
    keys
}

fn key_of(row: &Reading, channel: Axis) -> LineKey {
    LineKey {
        direction: row.direction,
        channel,
        load_station: row.load_station,
        read_station: row.read_station,
    }
}

fn samples(rows: &[Reading], key: &LineKey) -> Vec<Sample> {
    let is_of_line = |row: &&Reading| key_of(row, key.channel) == *key;
    rows.iter()
        .filter(is_of_line)
        .filter_map(|row| {
            Some(Sample {
                load: row.load,
                offset: row.offset[key.channel.index()]?,
                phase: row.phase.unwrap_or(Phase::Load),
                trial: rows.iter().position(|first| first.trial == row.trial)?,
                line: row.line,
            })
        })
        .collect()
}

fn compare(readings: &Readings, rod: &Rod, lines: &[Line], options: &Options) -> Result<Measured> {
    let model = Compliance::of_model(rod, &options.physics, options.elements)?;
    let predicted = predictions(readings, rod, lines, options)?;
    let mut ratios: Vec<Ratio> = Vec::new();
    for load in Axis::ALL {
        for channel in Axis::ALL {
            // entries that the rod's symmetry makes zero carry no ratio
            let of_entry: Vec<Estimate> = lines
                .iter()
                .zip(&predicted)
                .filter(|(line, _)| line.key.direction.axis == load && line.key.channel == channel)
                .filter(|(_, prediction)| !vanishes(**prediction, &model))
                .map(|(line, prediction)| line.slope.times(1.0 / prediction))
                .collect();
            ratios.extend(Estimate::pooled(&of_entry).map(|value| Ratio { channel, load, value }));
        }
    }
    check_signs(readings, lines, &ratios)?;
    let Some(rod_ratio) = rod_ratio(&ratios, &model) else {
        return Err(Error::Input {
            at: Place::whole_file(&readings.file),
            found: "no offset along a load was read".into(),
            expected: "for example dy_um under loads along y, or dz_um under loads along z".into(),
            hint: None,
        });
    };
    let calc = closed_form::compliance(rod).ok();
    Ok(Measured { predicted, calc, ..measured(model, ratios, rod_ratio) })
}

/// What the model says each line's slope is, m/N.
fn predictions(readings: &Readings, rod: &Rod, lines: &[Line], options: &Options) -> Result<Vec<f64>> {
    let tip = rod.length();
    for row in &readings.rows {
        for (name, station) in [("load_station_mm", row.load_station), ("read_station_mm", row.read_station)]
        {
            if let Some(station) = station.filter(|&s| s > tip + UM) {
                return Err(Error::Input {
                    at: Place { file: readings.file.clone(), line: row.line, column: 0 },
                    found: format!("{name} is {}", station * 1e3),
                    expected: format!(
                        "a station on rod \"{}\", 0 to {:.3} mm (the tip)",
                        rod.name,
                        tip * 1e3
                    ),
                    hint: None,
                });
            }
        }
    }
    let at = |station: Option<f64>| station.unwrap_or(tip).min(tip);
    lines
        .iter()
        .map(|line| {
            let key = &line.key;
            let (load, read) = (at(key.load_station), at(key.read_station));
            let model = RodModel::new(rod, &options.physics, options.elements, &[load, read])?;
            let motion = model.force_response(load, read)?;
            Ok(motion.translation[(key.channel.index(), key.direction.axis.index())])
        })
        .collect()
}

/// An entry this small beside the largest is zero by symmetry.
fn vanishes(entry: f64, model: &Compliance) -> bool {
    entry.abs() < 1e-9 * model.force.amax()
}

/// A rod yields along its load; anything else that is more than noise is a sign error in the file.
fn check_signs(readings: &Readings, lines: &[Line], ratios: &[Ratio]) -> Result<()> {
    let is_against =
        |r: &&Ratio| r.channel == r.load && r.value.value < -r.value.half_width_95().unwrap_or_default();
    let Some(axis) = ratios.iter().find(is_against).map(|ratio| ratio.load) else { return Ok(()) };
    let is_culprit =
        |line: &&Line| (line.key.channel, line.key.direction.axis) == (axis, axis) && line.slope.value < 0.0;
    let culprit = lines.iter().find(is_culprit);
    let first_row = culprit.and_then(|line| readings.rows.iter().find(|row| key_of(row, axis) == line.key));
    Err(Error::Input {
        at: Place { file: readings.file.clone(), line: first_row.map_or(0, |row| row.line), column: 0 },
        found: format!(
            "d{axis}_um falls as the load along {axis} grows: the rod would move against its load"
        ),
        expected: "offsets in the direction of the load, both in the tool frame".into(),
        hint: Some(format!(
            "turn the sign of d{axis}_um, or write the axis of these loads the other way round (-{axis})"
        )),
    })
}

/// What r_rod is made of: the paper's two directions y and z, as far as they were read, else x.
fn ratios_of_rod(ratios: &[Ratio]) -> Vec<&Ratio> {
    let along = |axis: Axis| ratios.iter().find(move |r| (r.channel, r.load) == (axis, axis));
    let yz: Vec<&Ratio> = [Axis::Y, Axis::Z].into_iter().filter_map(along).collect();
    if yz.is_empty() { along(Axis::X).into_iter().collect() } else { yz }
}

/// Eq 21.
fn rod_ratio(ratios: &[Ratio], model: &Compliance) -> Option<Estimate> {
    let used = ratios_of_rod(ratios);
    // r_rod = Σ r_ii c'_ii / Σ c'_ii
    let weight = |ratio: &Ratio| model.force[(ratio.load.index(), ratio.load.index())];
    let total: f64 = used.iter().map(|ratio| weight(ratio)).sum();
    let terms: Vec<Estimate> = used.iter().map(|ratio| ratio.value.times(weight(ratio) / total)).collect();
    (!terms.is_empty()).then(|| Estimate::sum(&terms))
}

fn measured(model: Compliance, ratios: Vec<Ratio>, rod_ratio: Estimate) -> Measured {
    let error = |estimate: &Estimate| estimate.std_error.unwrap_or(f64::NAN);
    let (mut factor, mut factor_error) =
        (Matrix3::repeat(rod_ratio.value), Matrix3::repeat(error(&rod_ratio)));
    let mut is_measured = Matrix3::repeat(false);
    for (m, n) in (0..3).flat_map(|m| (0..3).map(move |n| (m, n))) {
        // C^F is symmetric (reciprocity): c_mn and c_nm are two measurements of one number
        let of_pair: Vec<Estimate> = ratios
            .iter()
            .filter(|r| [(m, n), (n, m)].contains(&(r.channel.index(), r.load.index())))
            .map(|r| r.value)
            .collect();
        if let Some(value) = Estimate::pooled(&of_pair) {
            factor[(m, n)] = value.value;
            factor_error[(m, n)] = error(&value);
            is_measured[(m, n)] = true;
        }
    }
    Measured {
        compliance: Compliance {
            force: model.force.component_mul(&factor),
            gravity: model.gravity * rod_ratio.value,
        },
        std_error: Compliance {
            force: model.force.component_mul(&factor_error).abs(),
            gravity: model.gravity.abs() * error(&rod_ratio),
        },
        ratios,
        rod_ratio,
        model,
        predicted: Vec::new(),
        calc: None,
        is_measured,
    }
}
