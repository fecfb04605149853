//! Which parameters tip positions can tell apart at all: a complete and minimal set, from the
//! geometry.
//!
//! Candidates come in an order of preference, and one is kept where its column of the Jacobian,
//! over many configurations within the joint limits, is not a combination of those kept before it.
//! For the paper's TX90 this gives exactly its ρ: θ₁, d₁ (dependent on the base), d₃ (on d₂ along
//! the parallel axes), d₆, y_tool (on θ₆), β₁ and β₃ drop out by themselves (Table 1).

use nalgebra::{DVector, Vector3};

use super::{Body, Kinematics, Loads, Motion, Parameter, Robot, Setup};
use crate::spatial::Pose;

/// β is a candidate where consecutive axes are closer to parallel than this, rad: |sin α| < sin
/// 10°.
const NEARLY_PARALLEL: f64 = 10.0 * crate::units::DEG;
/// What must remain of a column, in metres of tip per metre or per radian times the robot's reach.
/// Less is no direction of its own: what a robot may be off by, half a degree, then moves the tip
/// by a hundred thousandth of the reach. Which of the rest a recording shows its noise decides.
const OWN: f64 = 0.001;
/// A tip so near the last axis, as a share of the reach, is on it.
const ON_AXIS: f64 = 0.01;
/// Configurations that the columns are compared over.
const CONFIGURATIONS: usize = 80;
/// Torque, relative to the largest of the robot, below which a joint has none.
const NO_TORQUE: f64 = 1e-6;

/// The parameters that positions of the tip at `tool` (m, in {T}) can determine while the robot
/// carries `payload`; see [`crate::robot`] for what they are. Compliances are among them for joints
/// that gravity loads, where the robot's masses are known.
///
/// A turn about the last axis is the same as a shift of the tool around it. θₙ takes it, as in the
/// paper, where the tool as `drawn` (m, in {T}) lies beside that axis, so that there is a direction
/// to correct; else the tool does.
///
/// ```
/// use rodcal::prelude::*;
/// use rodcal::robot::{Body, minimal_parameters};
///
/// let (file, text) = Robot::builtin("tx90").expect("the program carries it");
/// let tx90 = Robot::from_text(file, text, None, None)?;
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let payload = Body { mass: rod.mass(), centre: rod.centre_of_mass() };
/// let parameters = minimal_parameters(&tx90, rod.tip(), rod.tip(), Some(payload));
/// assert_eq!(parameters.len(), 32); // the paper's Table 1
/// assert!(parameters.contains(&Parameter::Beta(1)) && !parameters.contains(&Parameter::Theta(0)));
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn minimal_parameters(
    robot: &Robot,
    tool: Vector3<f64>,
    drawn: Vector3<f64>,
    payload: Option<Body>,
) -> Vec<Parameter> {
    let setup = Setup::new(robot, Pose::IDENTITY, tool);
    let samples = Samples::new(&setup, payload);
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut kept = Vec::new();
    let around = around_last_axis(robot, drawn, samples.reach);
    for candidate in candidates(robot, around) {
        let Some(column) = samples.column(candidate) else { continue };
        let mut own = column;
        // twice is enough (Kahan, Parlett)
        for _ in 0..2 {
            for b in &basis {
                own.axpy(-b.dot(&own), b, 1.0);
            }
        }
        let rest = own.norm();
        if rest > OWN * (CONFIGURATIONS as f64).sqrt() {
            basis.push(own / rest);
            kept.push(candidate);
        }
    }
    kept
}

/// In order of preference. The last link's a, α and d do what the tool does; `around` is which way
/// θₙ moves it, where θₙ does.
fn candidates(robot: &Robot, around: Option<Vector3<f64>>) -> Vec<Parameter> {
    let n = robot.joints.len();
    let mut list: Vec<Parameter> = (0..3).map(Parameter::BasePosition).collect();
    list.extend((0..3).map(Parameter::BaseRotation));
    for (j, joint) in robot.joints.iter().enumerate() {
        let is_last = j + 1 == n;
        if !is_last {
            list.extend([Parameter::A(j), Parameter::Alpha(j)]);
        }
        if !is_last || around.is_some() {
            list.push(Parameter::Theta(j));
        }
        if !is_last {
            list.push(Parameter::D(j));
            if joint.link.alpha.sin().abs() < NEARLY_PARALLEL.sin() {
                list.push(Parameter::Beta(j));
            }
        }
    }
    // what θₙ does is the last of them
    let last = around.map_or(1, |around| around.iamax());
    list.extend([0, 2, 1].into_iter().filter(|&axis| axis != last).map(Parameter::Tool));
    list.push(Parameter::Tool(last));
    if robot.has_masses() {
        let turns = |&j: &usize| robot.joints[j].motion == Motion::Revolute;
        list.extend((0..n).filter(turns).map(Parameter::Compliance));
    }
    list
}

/// How the last joint moves a tip at `tool`, m/rad in {T}; `None` where the tip is as good as on
/// its axis.
fn around_last_axis(robot: &Robot, tool: Vector3<f64>, reach: f64) -> Option<Vector3<f64>> {
    let setup = Setup::new(robot, Pose::IDENTITY, tool);
    let mut kinematics = Kinematics::new(&setup);
    kinematics.update(&vec![0.0; robot.joints.len()], &[]);
    let last = kinematics.joints.last()?;
    let lever = last.axis.cross(&(kinematics.tip - last.origin));
    (lever.norm() > ON_AXIS * reach).then(|| kinematics.flange.rotation.tr_mul(&lever))
}

/// Configurations over the workspace.
struct Samples<'s> {
    kinematics: Vec<Kinematics<'s>>,
    torques: Vec<Vec<f64>>,
    /// Largest torque of each joint, N·m.
    largest: Vec<f64>,
    /// Largest distance of the tip from the base, m.
    reach: f64,
}

impl<'s> Samples<'s> {
    fn new(setup: &'s Setup, payload: Option<Body>) -> Self {
        let robot = setup.robot;
        let n = robot.joints.len();
        let mut kinematics = Kinematics::new(setup);
        let loads = Loads { gravity: robot.gravity, payload, tip_force: Vector3::zeros() };
        let mut samples =
            Samples { kinematics: Vec::new(), torques: Vec::new(), largest: vec![0.0; n], reach: 0.0 };
        for sample in 1..=CONFIGURATIONS {
            let q: Vec<f64> = robot
                .joints
                .iter()
                .enumerate()
                .map(|(j, joint)| {
                    let widest = match joint.motion {
                        Motion::Revolute => std::f64::consts::PI,
                        Motion::Prismatic => 1.0,
                    };
                    let [low, high] = joint.limits.unwrap_or([-widest, widest]);
                    let (low, high) = (low.max(-widest), high.min(widest));
                    low + (high - low) * spread(sample, j)
                })
                .collect();
            kinematics.update(&q, &[]);
            let mut torque = vec![0.0; n];
            kinematics.torques(&loads, &mut torque);
            for (largest, torque) in samples.largest.iter_mut().zip(&torque) {
                *largest = largest.max(torque.abs());
            }
            samples.reach = samples.reach.max((kinematics.tip - kinematics.joints[0].origin).norm());
            samples.kinematics.push(kinematics.clone());
            samples.torques.push(torque);
        }
        samples
    }

    /// The column of a parameter over all samples, in the unit of [`OWN`]; `None` for a joint
    /// without torque.
    fn column(&self, parameter: Parameter) -> Option<DVector<f64>> {
        let unit = match parameter {
            Parameter::BasePosition(_) | Parameter::D(_) | Parameter::A(_) | Parameter::Tool(_) => 1.0,
            Parameter::Compliance(j) => {
                let most = self.largest.iter().fold(0.0, |a: f64, &b| a.max(b));
                if self.largest[j] <= NO_TORQUE * most {
                    return None;
                }
                self.reach * self.largest[j]
            }
            Parameter::BaseRotation(_) | Parameter::Theta(_) | Parameter::Alpha(_) | Parameter::Beta(_) => {
                self.reach
            }
        };
        let tips = self.kinematics.iter().zip(&self.torques);
        let entries: Vec<f64> = tips
            .flat_map(|(kinematics, torque)| {
                let column: [f64; 3] = (kinematics.column(parameter, torque) / unit).into();
                column
            })
            .collect();
        Some(DVector::from_vec(entries))
    }
}

/// The `sample`th of points that fill (0, 1) evenly, on the `joint`th axis: Kronecker's sequence of
/// √p, p prime.
fn spread(sample: usize, joint: usize) -> f64 {
    const PRIMES: [f64; 12] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0, 31.0, 37.0];
    // beyond twelve joints other multiples of the same roots do
    let root = PRIMES[joint % PRIMES.len()].sqrt() * (1 + joint / PRIMES.len()) as f64;
    (sample as f64 * root).fract()
}
