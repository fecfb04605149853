//! What every curve is made of.

use std::f64::consts::PI;

use super::super::model::Context;
use super::super::model::entry::{Column, Entry, linear};
use super::super::model::law::Frame;
use crate::inference::{JointVariable, Location, Parameter, UNKNOWN, Variable};
use crate::units::UM;

/// Size of a displacement, m: what calibrated arms of 1 m reach miss by.
pub(super) const SIZE: f64 = 100.0 * UM;
/// Cosines along one number, beside the constant.
pub(super) const MOST: usize = 6;
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];
/// Size of a turn, rad: as large at 1 m.
pub(super) const TURN: f64 = 100e-6;
/// Largest torque below which a joint is not loaded, N·m.
pub(super) const LEAST_TORQUE: f64 = 0.1;
/// Lines through the middle of a cube: of its faces, edges and corners. None is farther than 27°
/// from any other line.
pub(in super::super) const SIDES: [[f64; 3]; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [-1.0, 1.0, 1.0],
];
/// A curve: its name in tables, what is said of it, and the number that it is a function of.
pub(super) fn curve(
    label: impl Into<String>,
    follows: impl Into<String>,
    along: Option<Variable>,
    parameters: Vec<(Parameter, Column)>,
) -> Entry {
    let location = Location::Curve { label: label.into(), follows: follows.into(), along };
    let mut entry = Entry::new(&UNKNOWN, location, parameters);
    entry.candidate.is_nonparametric = true;
    entry
}

/// The angle of a joint.
pub(super) fn angle_of(joint: usize) -> Variable {
    Variable::Joint(joint, JointVariable::Angle)
}

/// From 0 to 1; `None` where the values do not differ.
pub(super) fn scaled(values: &[f64]) -> Option<Vec<f64>> {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)));
    (high > low).then(|| values.iter().map(|v| (v - low) / (high - low)).collect())
}

/// cos(π·k·x).
pub(super) fn cosine(k: usize, x: f64) -> f64 {
    (PI * k as f64 * x).cos()
}

/// A vector in {W} or in {T} times a weight for each row.
pub(super) fn vectors(
    context: &Context,
    name: &str,
    size: f64,
    frame: Frame,
    weight: &dyn Fn(usize) -> f64,
) -> Vec<(Parameter, Column)> {
    let along = |(axis, letter): (usize, &&str)| {
        let pattern = match frame {
            Frame::Tool => &context.patterns.tool[axis],
            Frame::World => &context.patterns.world[axis],
        };
        let column = context.along(pattern, |row, _| weight(row));
        (linear(format!("{letter}_{name}_um"), size), column)
    };
    AXES.iter().enumerate().map(along).collect()
}

/// A vector in {W} or in {T} along one number of each row.
///
/// Σ_k a_k·cos(π k x)        x from 0 to 1
pub(super) fn along(
    context: &Context,
    variable: Variable,
    label: &str,
    name: &str,
    values: &[f64],
    frame: Frame,
) -> Option<Entry> {
    let x = scaled(values)?;
    let parameters = (1..=MOST).flat_map(|k| {
        let size = SIZE / (1 + k) as f64;
        vectors(context, &format!("cosine_{k}"), size, frame, &|row| cosine(k, x[row]))
    });
    let (label, directions) = match frame {
        Frame::World => (format!("{label}, a curve in the world"), "fixed directions"),
        Frame::Tool => (format!("{label}, a curve in the tool"), "directions that turn with the tool"),
    };
    let follows = format!("follows {name}, along {directions}");
    Some(curve(label, follows, Some(variable), parameters.collect()))
}
