//! Measured against modelled: the ratios r, and the Meas compliance (Eqs 20–22).

use nalgebra::Matrix3;

use super::line::{Line, LineKey};
use super::readings::{Axis, Readings};
use crate::beam::{Physics, RodModel};
use crate::compliance::{Compliance, closed_form};
use crate::error::{Error, Place, Result};
use crate::rod::Rod;
use crate::statistics::Estimate;
use crate::units::UM;

/// Measured compared with modelled, and the Meas compliance.
#[derive(Debug, Clone)]
#[non_exhaustive]
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
    /// Physics of the model.
    pub physics: Physics,
    /// Number of elements of the model.
    pub elements: usize,
    /// Entries of C^F that rest on readings of their own (by reciprocity also the transposed ones).
    pub is_measured: Matrix3<bool>,
}

impl Measured {
    /// The ratios that r_rod is made of: the paper's two directions y and z, as far as they were
    /// read, else x.
    pub fn ratios_of_rod(&self) -> Vec<&Ratio> {
        ratios_of_rod(&self.ratios)
    }
}

/// r_mn = c_mn / c'_mn.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
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

pub(super) fn compare(
    readings: &Readings,
    rod: &Rod,
    lines: &[Line],
    physics: &Physics,
    elements: usize,
) -> Result<Measured> {
    let model = Compliance::of_model(rod, physics, elements)?;
    let predicted = predictions(readings, rod, lines, physics, elements)?;
    let mut ratios: Vec<Ratio> = Vec::new();
    for load in Axis::ALL {
        for channel in Axis::ALL {
            // entries that the rod's symmetry makes zero carry no ratio
            let estimates: Vec<Estimate> = lines
                .iter()
                .zip(&predicted)
                .filter(|(line, _)| line.key.direction.axis == load && line.key.channel == channel)
                .filter(|(_, prediction)| !vanishes(**prediction, &model))
                .map(|(line, prediction)| line.slope.times(1.0 / prediction))
                .collect();
            ratios.extend(Estimate::pooled(&estimates).map(|value| Ratio { channel, load, value }));
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
    Ok(Measured { predicted, calc, physics: *physics, elements, ..measured(model, ratios, rod_ratio) })
}

/// What the model says each line's slope is, m/N.
fn predictions(
    readings: &Readings,
    rod: &Rod,
    lines: &[Line],
    physics: &Physics,
    elements: usize,
) -> Result<Vec<f64>> {
    check_stations(readings, rod)?;
    let tip = rod.length();
    let at = |station: Option<f64>| station.unwrap_or(tip).min(tip);
    lines
        .iter()
        .map(|line| {
            let key = &line.key;
            let (load, read) = (at(key.load_station), at(key.read_station));
            let model = RodModel::new(rod, physics, elements, &[load, read])?;
            let motion = model.force_response(load, read)?;
            Ok(motion.translation[(key.channel.index(), key.direction.axis.index())])
        })
        .collect()
}

/// Refuses stations that are not on the rod.
pub(super) fn check_stations(readings: &Readings, rod: &Rod) -> Result<()> {
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
    Ok(())
}

/// An entry this small beside the largest is zero by symmetry.
pub(super) fn vanishes(entry: f64, model: &Compliance) -> bool {
    entry.abs() < 1e-9 * model.force.amax()
}

/// A rod deflects along its load; anything else beyond noise is a sign error in the file.
fn check_signs(readings: &Readings, lines: &[Line], ratios: &[Ratio]) -> Result<()> {
    let is_against =
        |r: &&Ratio| r.channel == r.load && r.value.value < -r.value.half_width_95().unwrap_or_default();
    let Some(axis) = ratios.iter().find(is_against).map(|ratio| ratio.load) else { return Ok(()) };
    let is_culprit =
        |line: &&Line| (line.key.channel, line.key.direction.axis) == (axis, axis) && line.slope.value < 0.0;
    let culprit = lines.iter().find(is_culprit);
    let first_row =
        culprit.and_then(|line| readings.rows.iter().find(|row| LineKey::of_reading(row, axis) == line.key));
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
pub(super) fn ratios_of_rod(ratios: &[Ratio]) -> Vec<&Ratio> {
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
        let estimates: Vec<Estimate> = ratios
            .iter()
            .filter(|r| [(m, n), (n, m)].contains(&(r.channel.index(), r.load.index())))
            .map(|r| r.value)
            .collect();
        if let Some(value) = Estimate::pooled(&estimates) {
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
        physics: Physics::default(),
        elements: 0,
        is_measured,
    }
}
