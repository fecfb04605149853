//! What a user should know before believing a fit; `Display` gives the advice.

use std::fmt;

use super::comparison::{Measured, Ratio, ratios_of_rod, vanishes};
use super::line::Line;
use super::readings::{Axis, Readings};
use crate::rod::Rod;
use crate::statistics::Estimate;
use crate::units::{UM, significant};

/// Below this probability a difference is called real.
const SIGNIFICANCE: f64 = 0.01;

/// Something about a rig fit that its user should know.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The averages leave a straight line by more than the repeats allow.
    NotStraight {
        /// Which line.
        line: String,
        /// F of the lack of fit.
        f: f64,
        /// Its p value.
        p_value: f64,
        /// Largest distance of an average from the line, m.
        largest: f64,
    },
    /// There is nothing to test the straightness or the noise of a line with.
    Untested {
        /// Which line.
        line: String,
    },
    /// Loads beyond what the rod's file calls linear.
    BeyondLinearRange {
        /// Largest load, N.
        load: f64,
        /// The rod's range, N.
        range: f64,
    },
    /// Offsets fall as the load grows.
    AgainstTheLoad {
        /// Which line.
        line: String,
    },
    /// The line does not pass near the origin: friction, or a load that is not what it is said to
    /// be.
    LoadOffset {
        /// Which line.
        line: String,
        /// Where it crosses the load axis, N.
        offset: Estimate,
    },
    /// The rod moves across its plane of symmetry.
    CrossTalk {
        /// Which line.
        line: String,
        /// Its slope, m/N.
        slope: Estimate,
    },
    /// r differs between directions: one factor does not describe this rod.
    UnequalRatios {
        /// The two ratios that are furthest apart.
        pair: Box<(Ratio, Ratio)>,
    },
    /// r_rod rests on one direction only.
    OneDirection {
        /// The direction.
        axis: Axis,
    },
    /// What a law of the rod's file adds was taken out of the readings.
    WithoutLaw {
        /// The law in words.
        law: String,
    },
    /// A robust fit set readings aside.
    Downweighted {
        /// Which line.
        line: String,
        /// Lines of the file.
        rows: Vec<usize>,
    },
}

/// Warnings about single lines.
pub(super) fn about_lines(lines: &[Line], readings: &Readings, rod: Option<&Rod>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for line in lines {
        let label = line.key.label();
        match line.lack_of_fit {
            Some(test) if test.is_significant() => warnings.push(Warning::NotStraight {
                line: label.clone(),
                f: test.f,
                p_value: test.p_value,
                largest: line.points.iter().fold(0.0, |max, p| p.residual.abs().max(max)),
            }),
            None if line.slope.std_error.is_none() => {
                warnings.push(Warning::Untested { line: label.clone() });
            }
            _ => {}
        }
        let is_along = line.key.channel == line.key.direction.axis;
        if is_along && line.slope.value < 0.0 {
            warnings.push(Warning::AgainstTheLoad { line: label.clone() });
        }
        // where a curved line crosses the axis says nothing about friction
        let is_straight = line.lack_of_fit.is_none_or(|test| !test.is_significant());
        let offset = line.load_offset.filter(|offset| is_straight && offset.is_significant(SIGNIFICANCE));
        if let Some(offset) = offset.filter(|_| is_along) {
            warnings.push(Warning::LoadOffset { line: label.clone(), offset });
        }
        if !line.downweighted.is_empty() {
            warnings.push(Warning::Downweighted { line: label, rows: line.downweighted.clone() });
        }
    }
    let largest = readings.rows.iter().fold(0.0, |max: f64, row| row.load.max(max));
    if let Some(range) = rod.and_then(|rod| rod.linear_range).filter(|&range| largest > range) {
        warnings.push(Warning::BeyondLinearRange { load: largest, range });
    }
    warnings
}

/// Warnings about the comparison with the model.
pub(super) fn about_ratios(measured: &Measured, lines: &[Line]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (line, &prediction) in lines.iter().zip(&measured.predicted) {
        if vanishes(prediction, &measured.model) && line.slope.is_significant(SIGNIFICANCE) {
            warnings.push(Warning::CrossTalk { line: line.key.label(), slope: line.slope });
        }
    }
    let diagonal: Vec<Ratio> = measured.ratios.iter().copied().filter(|r| r.channel == r.load).collect();
    if let [only] = ratios_of_rod(&measured.ratios)[..] {
        warnings.push(Warning::OneDirection { axis: only.load });
    }
    let order = |a: &&Ratio, b: &&Ratio| a.value.value.total_cmp(&b.value.value);
    if let (Some(&low), Some(&high)) = (diagonal.iter().min_by(order), diagonal.iter().max_by(order)) {
        let difference = Estimate::sum(&[high.value, low.value.times(-1.0)]);
        if low != high && difference.is_significant(SIGNIFICANCE) {
            warnings.push(Warning::UnequalRatios { pair: Box::new((low, high)) });
        }
    }
    warnings
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::WithoutLaw { law } => write!(
                f,
                "the rod file has a law, {law}: what it adds was taken out of the readings, and these slopes are \
                 those of what is left"
            ),
            Warning::NotStraight { line, f: value, p_value, largest } => write!(
                f,
                "{line} is not a straight line: lack of fit F = {} (p = {}), up to {} µm beside it; a slope alone does not describe these readings",
                significant(*value, 3),
                significant(*p_value, 2),
                significant(largest / UM, 2)
            ),
            Warning::Untested { line } => write!(
                f,
                "{line} has two loads and no repeats: its slope has no standard error, and its \
                 straightness cannot be tested; read at three loads or more, twice or more each"
            ),
            Warning::BeyondLinearRange { load, range } => write!(
                f,
                "the largest load, {} N, is beyond the {} N up to which the rod file calls this rod linear",
                significant(*load, 3),
                significant(*range, 3)
            ),
            Warning::AgainstTheLoad { line } => {
                write!(f, "{line} falls as the load grows: check the signs of axis and channel")
            }
            Warning::LoadOffset { line, offset } => write!(
                f,
                "{line} crosses the load axis at {} N, not at zero: friction in the slide or a tare of \
                 the loads would explain it",
                offset.show(1.0)
            ),
            Warning::CrossTalk { line, slope } => write!(
                f,
                "{line} is {} µm/N where the rod's symmetry allows none: the load or the sensor is not aligned with the tool frame",
                slope.show(UM)
            ),
            Warning::UnequalRatios { pair } => write!(
                f,
                "r{} = {} and r{} = {} differ by more than their errors: one factor r_rod does not describe this rod, and C^g derived from it is uncertain by as much",
                pair.0.name(),
                pair.0.value.show(1.0),
                pair.1.name(),
                pair.1.value.show(1.0)
            ),
            Warning::OneDirection { axis } => write!(
                f,
                "r_rod rests on loads along {axis} alone; the paper's definition takes y and z together"
            ),
            Warning::Downweighted { line, rows } => {
                let rows = rows.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
                write!(f, "{line}: the robust fit sets aside the readings in line {rows} of the file")
            }
        }
    }
}
