//! Where a load acts and where a sensor reads: on the rod, or beside its centreline.

use nalgebra::{Matrix3, Vector3};

use crate::beam::{Physics, RodModel};
use crate::error::Result;
use crate::rod::Rod;
use crate::spatial::skew;

/// m/N for each pair of load and read station.
pub type Parts = Vec<Matrix3<f64>>;

/// A point that moves with the rod's cross-section at a station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// m from the flange.
    pub station: f64,
    /// From the centreline there to the point, in {T}, m.
    pub arm: Vector3<f64>,
}

impl Point {
    /// Where it is on an unloaded rod, in {T}, m.
    pub fn on(&self, rod: &Rod) -> Vector3<f64> {
        rod.point(self.station) + self.arm
    }

    /// The point on another rod than `rod`: what was at the tip is at its tip, what was elsewhere
    /// is as far from the flange.
    pub fn moved(&self, rod: &Rod, other: &Rod) -> Point {
        let tip = other.length();
        let station = if self.station == rod.length() { tip } else { self.station.min(tip) };
        Point { station, ..*self }
    }
}

/// Displacement of the read point per force at the load point, m/N, for each pair of the two: with
/// T and Θ the displacement and the rotation at the read station per force at the load station, K
/// the displacement there per moment, and arms r
///
/// ```text
/// u = (T + K·[r_load]× − [r_read]×·(Θ + R·[r_load]×))·F     K = Θ(read → load)ᵀ by reciprocity
/// ```
///
/// R, the rotation per moment, matters where both are beside the centreline, which nothing here is.
///
/// # Errors
/// As [`RodModel::new`]: a rod that the beam model refuses, a station that is not on it.
pub fn between(rod: &Rod, pairs: &[[Point; 2]]) -> Result<Parts> {
    let stations: Vec<f64> = pairs.iter().flatten().map(|point| point.station).collect();
    let model = RodModel::new(rod, &Physics::WHOLE, 1, &stations)?;
    let of_pair = |[load, read]: &[Point; 2]| {
        let motion = model.force_response(load.station, read.station)?;
        let mut response: Matrix3<f64> = motion.translation;
        if load.arm != Vector3::zeros() {
            let turned = model.force_response(read.station, load.station)?.rotation;
            response += turned.transpose() * skew(&load.arm);
        }
        if read.arm != Vector3::zeros() {
            response -= skew(&read.arm) * motion.rotation;
        }
        Ok(response)
    };
    pairs.iter().map(of_pair).collect()
}

/// Direction of the undeformed centreline at a station, in {T}: that before a corner.
pub fn tangent(rod: &Rod, station: f64) -> Vector3<f64> {
    if station <= rod.bend_start() {
        return Vector3::z();
    }
    let turn = rod.turn().min((station - rod.bend_start()) / rod.bend_radius.max(f64::MIN_POSITIVE));
    Vector3::new(turn.sin(), 0.0, turn.cos())
}
