//! A serial robot: which joints move about which axes, and what hangs on them.
//!
//! Every robot is one chain, whatever file it came from:
//!
//! ```text
//! T_0^T(q) = root · H₁(q₁) · H₂(q₂) · … · Hₙ(qₙ) · flange
//! Hⱼ = Rz(θⱼ)·Tz(dⱼ)·Tx(aⱼ)·Rx(αⱼ)·Ry(βⱼ)        (the paper's Table 1)
//! ```
//!
//! with θⱼ = offset + qⱼ + cⱼ·τⱼ (and what [`Effect`]s add) for a revolute joint and dⱼ = d + qⱼ
//! for a prismatic one. {0} is the robot's base frame, {T} the flange's. β is zero but where
//! consecutive axes are nearly parallel: there Denavit and Hartenberg's common normal jumps with
//! the smallest tilt, and Hayati's β does not (S. Hayati, *IEEE CDC* 22 (1983) 1477–1483).

mod beside;
mod calibrated;
pub mod configurations;
mod defaults;
mod effect;
mod effects_file;
mod file;
mod hayati;
mod kinematics;
mod law;
mod law_file;
mod laws;
mod minimal;
mod moves;
mod parameter;
mod predict;
mod setup;
mod standard_uncertainty;
mod statics;
mod structure;
mod uncertainty;
mod urdf;
mod write;

pub use crate::units::Unit;
pub use calibrated::CalibratedRange;
pub use effect::{Effect, TorquePower};
pub use effects_file::{corrections_csv, corrections_from_csv};
pub use file::is_urdf;
pub use kinematics::{JointFrames, Kinematics};
pub use law::{JointLawVariable, LawPlace, RobotLaw};
pub use minimal::minimal_parameters;
pub use parameter::{Parameter, ParameterGroup};
pub use predict::{PredictedTip, PredictionQuery};
pub use setup::Setup;
pub use standard_uncertainty::StandardUncertainty;
pub use statics::Loads;
pub use structure::{Pull, across};
pub use uncertainty::Uncertainty;
pub use urdf::Written;

use nalgebra::Vector3;

use crate::delimited::Row;
use crate::error::Result;
use crate::limits;
use crate::spatial::Pose;
use crate::units::{DEG, MM};

/// A robot as its file describes it, in SI units.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Robot {
    /// Name, for people.
    pub name: String,
    /// Where its numbers come from, in the words of its file.
    pub source: Option<String>,
    /// Acceleration of gravity in {0}, m/s².
    pub gravity: Vector3<f64>,
    /// Frame of the first joint in {0}: its z axis is the joint's axis. The identity for a robot
    /// given as a table.
    pub root: Pose,
    /// Joints that move, base to flange; at least one.
    pub joints: Vec<Joint>,
    /// {T} in the last joint's distal frame. The identity for a robot given as a table.
    pub flange: Pose,
    /// Errors and deflections that geometry does not describe.
    pub effects: Vec<Effect>,
    /// What else geometry does not describe, as formulas.
    pub laws: Vec<RobotLaw>,
    /// The tip that it was calibrated with, where its file states it.
    pub tip: Option<Tip>,
    /// How well its numbers are known before anybody measures it.
    pub standard_uncertainty: StandardUncertainty,
    /// How sure its numbers are after a calibration, where its file states it.
    pub uncertainty: Option<Uncertainty>,
    /// Where it was calibrated, where its file states it.
    pub calibrated: Option<CalibratedRange>,
}

/// Where the tip is, and how well the robot is known there.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Tip {
    /// In {T}, m.
    pub at: Vector3<f64>,
    /// Standard deviation of a coordinate of predicted tips, m.
    pub sd: Option<f64>,
}

/// A joint with the link that it moves.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Joint {
    /// Name, for people.
    pub name: String,
    /// What it does.
    pub motion: Motion,
    /// From the joint's frame, whose z axis is its axis, to its distal frame.
    pub link: Hayati,
    /// Compliance c: how far gravity's torque turns the joint, rad/(N·m). 0 is rigid.
    pub compliance: f64,
    /// Mass of the link that moves with the joint, where it is known.
    pub body: Option<Body>,
    /// Range of the joint, rad or m.
    pub limits: Option<[f64; 2]>,
}

impl Joint {
    /// A rigid joint without mass or limits; `link` leads from its axis to its distal frame.
    pub fn new(name: impl Into<String>, motion: Motion, link: Hayati) -> Joint {
        Joint { name: name.into(), motion, link, compliance: 0.0, body: None, limits: None }
    }

    /// Name of the column that holds the values of the joint of this number, from 1, in tables, and
    /// its unit in SI: `q1_deg` in degrees, or `q3_mm` in millimetres.
    pub fn column(&self, number: usize) -> (String, f64) {
        match self.motion {
            Motion::Revolute => (format!("q{number}_deg"), DEG),
            Motion::Prismatic => (format!("q{number}_mm"), MM),
        }
    }
}

/// A joint's value in its column of a table, degrees or mm.
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) where it is no number, or larger than
/// [`limits::JOINT_VALUE`].
pub(crate) fn joint_value(row: Row<'_>, column: &str) -> Result<f64> {
    let value = row.required_number(column)?;
    match value.abs() <= limits::JOINT_VALUE as f64 {
        true => Ok(value),
        false => Err(row.error(column, format!("a value of at most {} in size", limits::JOINT_VALUE), None)),
    }
}

/// What a joint does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Motion {
    /// Turns about its z axis.
    Revolute,
    /// Moves along its z axis.
    Prismatic,
}

/// The five parameters of Hⱼ at qⱼ = 0; see [`crate::robot`]. A sixth would be another convention,
/// and another type.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Hayati {
    /// About z, rad.
    pub theta: f64,
    /// Along z, m.
    pub d: f64,
    /// Along the turned x, m.
    pub a: f64,
    /// About that x, rad.
    pub alpha: f64,
    /// About the y that results, rad.
    pub beta: f64,
}

/// A rigid body that hangs on a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the joint's distal frame, m.
    pub centre: Vector3<f64>,
}

impl Robot {
    /// A robot of these joints, base to flange, on a base frame whose z points up: without effects,
    /// its first joint's frame {0} and its flange the last distal frame.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let link = |a| Hayati { a, ..Hayati::default() };
    /// let arm = Robot::new("arm", vec![
    ///     Joint::new("shoulder", Motion::Revolute, link(0.4)),
    ///     Joint::new("elbow", Motion::Revolute, link(0.3)),
    /// ]);
    /// let flange = arm.flange_at(&[0.0, std::f64::consts::FRAC_PI_2]);
    /// assert!((flange.origin.x - 0.4).abs() < 1e-15 && (flange.origin.y - 0.3).abs() < 1e-15);
    /// ```
    pub fn new(name: impl Into<String>, joints: Vec<Joint>) -> Robot {
        Robot {
            name: name.into(),
            source: None,
            gravity: defaults::DOWN,
            root: Pose::IDENTITY,
            joints,
            flange: Pose::IDENTITY,
            effects: Vec::new(),
            laws: Vec::new(),
            tip: None,
            standard_uncertainty: StandardUncertainty::default(),
            uncertainty: None,
            calibrated: None,
        }
    }

    /// True where at least one link has a mass, so that gravity's torques can be computed.
    pub fn has_masses(&self) -> bool {
        self.joints.iter().any(|joint| joint.body.is_some_and(|body| body.mass > 0.0))
    }
}
