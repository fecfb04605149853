//! A calibration campaign: the robot, its rod, and what was recorded. One TOML file that names the
//! others.
//!
//! Every key and column is in `docs/campaign-file.md`.

mod build;
mod checks;
mod columns;
mod constraints;
mod file;
mod group;
mod layout;
mod recording;
mod regroup;
mod temperatures;
mod warning;
mod write;

pub use group::{Group, GroupName};
pub use warning::Warning;
pub use write::FileNames;

use nalgebra::Vector3;

use crate::rig::readings::Readings;
use crate::robot::{Body, Parameter, Robot};
use crate::rod::Rod;
use crate::spatial::Pose;

/// All that a calibration starts from, read and checked, in SI units.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Campaign {
    /// The campaign's file as the user named it.
    pub file: String,
    /// Nominal robot.
    pub robot: Robot,
    /// The robot's file as the campaign names it (`builtin:tx90` is one) and its text, for writing
    /// it back.
    pub robot_file: String,
    /// Its text.
    pub robot_text: String,
    /// What stands beside a URDF, as the campaign names the file.
    pub effects_file: Option<String>,
    /// Link of a URDF that is {0}, where the campaign names it.
    pub base_link: Option<String>,
    /// Link of a URDF that is {T}, where the campaign names it.
    pub tip_link: Option<String>,
    /// Measuring rod on the flange.
    pub rod: Option<Rod>,
    /// The rod's file as the campaign names it.
    pub rod_file: Option<String>,
    /// Rig readings of the rod; they make the Meas mode available.
    pub readings: Option<Readings>,
    /// Contact force **on the ball**, in the device frame of each clamp, N.
    pub contact_force: Option<Vector3<f64>>,
    /// First guess of the undeflected tip in {T}, m.
    pub tool: Vector3<f64>,
    /// False where the file says nothing about the tool; the guess is then the rod's tip or the
    /// flange.
    pub tool_is_given: bool,
    /// First guess of {0} in {W}: position (m) and roll, pitch, yaw (rad).
    pub base: [f64; 6],
    /// False where the file says nothing about the base; the guess is then the identity.
    pub base_is_given: bool,
    /// All clamps of the file, recorded in or not; none for a tracker and for sockets.
    pub clamps: Vec<Group>,
    /// What was recorded; nothing in a plan ([`Campaign::read_plan`]).
    pub measurements: Recording,
    /// What the calibrated robot is judged by.
    pub validation: Option<Recording>,
    /// What is fitted again on the validation poses.
    pub refit: Refit,
    /// Standard deviation of one measured coordinate, m, where the file states it.
    pub noise: Option<f64>,
    /// Standard uncertainty of a coordinate of each clamp's place, m, where the file states it.
    pub clamp_uncertainty: Option<f64>,
    /// Limits for the verdict, where the file states them.
    pub accuracy: Option<AccuracyLimits>,
    /// What the user states about single parameters.
    pub constraints: ParameterConstraints,
    /// What a user should know about the files although they can be read.
    pub warnings: Vec<Warning>,
}

/// How accurate the robot has to be: limits of the error at poses that the calibration has not
/// seen.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct AccuracyLimits {
    /// Of the mean, m.
    pub mean: Option<f64>,
    /// Of the largest, m.
    pub max: Option<f64>,
}

/// What is fitted again before the validation errors are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Refit {
    /// Base and tool, as in the paper.
    BaseTool,
    /// Nothing: the calibrated robot predicts.
    Nothing,
}

/// What the user states about single parameters: fixed, free, or known beforehand.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct ParameterConstraints {
    /// Held at their nominal values.
    pub fixed: Vec<Parameter>,
    /// Estimated although the default set leaves them out.
    pub freed: Vec<Parameter>,
    /// Known beforehand: parameter, mean and standard deviation, SI.
    pub priors: Vec<(Parameter, f64, f64)>,
}

/// Joint values with what was seen at them, in recording order.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Recording {
    /// The file as the user named it.
    pub file: String,
    /// Where it comes from: the comment lines above the header, joined.
    pub source: Option<String>,
    /// Number of joints n.
    pub joint_count: usize,
    /// Joint values, rad or m, n per row, one row after the other.
    pub joint_values: Vec<f64>,
    /// The same as they were read, where the robot's file says what the moves between the poses
    /// add.
    pub joints_read: Option<Vec<f64>>,
    /// One per row of the file.
    pub rows: Vec<Row>,
    /// Clamps or sockets that rows belong to; one for all rows that a tracker saw.
    pub groups: Vec<Group>,
    /// Where tracker or base stood, in order of appearance; one of name "" where that is not said.
    pub stations: Vec<Station>,
    /// What is known about the points.
    pub targets: Targets,
}

/// One row without its numbers.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Row {
    /// The pose's name as written.
    pub pose: String,
    /// Line in the file.
    pub line: usize,
    /// Index of its group.
    pub group: usize,
    /// Index of its station.
    pub station: usize,
    /// Time, s, from any zero.
    pub time: Option<f64>,
    /// Temperature, °C.
    pub temperature: Option<f64>,
}

/// Where the tracker, or the robot's base, stood for some of the rows.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Station {
    /// As in the column `station`.
    pub name: String,
    /// {W} of this station in that of the first one, as the nominal robot shows it: points are
    /// given in the first station's {W} by it, and a calibration corrects the rest.
    pub frame: Pose,
}

impl Campaign {
    /// θₙ where it takes the turn of a tool whose place is a guess.
    pub(crate) fn guessed(&self) -> Option<Parameter> {
        let is_guess = self.tool_is_given && self.rod.is_none();
        self.robot.joints.len().checked_sub(1).filter(|_| is_guess).map(Parameter::Theta)
    }

    /// Adds to the joint values as they were read what the moves between the poses add, by the
    /// robot's file. The rod hangs on the flange; poses for validation have none.
    pub(crate) fn take_up_moves(&mut self) {
        let rod = self.rod.as_ref();
        let payload = rod.map(|rod| Body { mass: rod.mass(), centre: rod.centre_of_mass() });
        self.measurements.take_up_moves(&self.robot, payload);
        if let Some(validation) = &mut self.validation {
            validation.take_up_moves(&self.robot, None);
        }
    }

    /// Parameters of which the robot's drawing says nothing: those that the user knows, and the
    /// guessed one.
    pub(crate) fn not_drawn(&self) -> Vec<Parameter> {
        self.constraints.priors.iter().map(|&(parameter, ..)| parameter).chain(self.guessed()).collect()
    }
}

impl Station {
    /// The only one, or the first.
    pub fn first(name: &str) -> Station {
        Station { name: name.to_owned(), frame: Pose::IDENTITY }
    }
}

/// What is known about the points that the tip touched.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Targets {
    /// Each measured in {W}, m: one per row.
    Points(Vec<Vector3<f64>>),
    /// Unknown, one per group; but some distances between them are known.
    Sockets(Vec<Distance>),
}

/// A known distance between the sockets of a placement.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Distance {
    /// Groups of the two sockets.
    pub between: [usize; 2],
    /// Distance, m.
    pub value: f64,
    /// Its standard deviation, m.
    pub sd: f64,
}

impl Distance {
    /// Between the sockets of two groups of a recording: distance and standard deviation, m.
    pub fn new(between: [usize; 2], value: f64, sd: f64) -> Distance {
        Distance { between, value, sd }
    }
}

impl Recording {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// True without rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Device frame of a row's clamp in {W}, that of the first station.
    pub fn device(&self, row: usize) -> Pose {
        let Row { group, station, .. } = self.rows[row];
        match station {
            0 => self.groups[group].device,
            station => self.stations[station].frame.then(&self.groups[group].device),
        }
    }

    /// Adds to the joint values as they were read what the moves between the poses add, by the
    /// robot's file, with this payload on its flange.
    pub fn take_up_moves(&mut self, robot: &Robot, payload: Option<Body>) {
        let read = self.joints_read.take().unwrap_or_else(|| self.joint_values.clone());
        self.joint_values = robot.after_moves_with(payload, &read);
        self.joints_read = robot.has_moves().then_some(read);
    }

    /// Joint values of a row as they were read, rad or m.
    pub fn read_joints(&self, row: usize) -> &[f64] {
        let read = self.joints_read.as_ref().unwrap_or(&self.joint_values);
        &read[row * self.joint_count..][..self.joint_count]
    }

    /// Joint values of a row, rad or m.
    pub fn joints(&self, row: usize) -> &[f64] {
        &self.joint_values[row * self.joint_count..][..self.joint_count]
    }
}
