//! Simulated campaigns: what the paper's procedure would record with a robot and a rod that are
//! known exactly.
//!
//! A robot with small errors of all its parameters brings the ball to five clamps under many
//! orientations; the poses are picked for their observability. The rod sags and the sensors push,
//! both with physical signs: gravity pulls down, the contact force pushes the ball up. Everything
//! is drawn from one seed.

mod files;
mod plan;
mod planned;
mod poses;

pub use files::campaign_files;
pub use plan::{Plan, RobotErrors};
pub use planned::planned_poses;

use plan::CLAMPS;

use nalgebra::{Matrix3, Vector3};

use super::campaign::{Group, GroupName, Recording, Row, Station, Targets};
use super::compensation::{Compensation, Mode};
use super::problem::Pass;
use crate::compliance::{Compliance, PAPER_CONTACT_FORCE, StaticLaws};
use crate::error::Result;
use crate::robot::configurations::{anywhere, is_above_table};
use crate::robot::{Body, Kinematics, Parameter, Robot, Setup, minimal_parameters};
use crate::rod::Rod;
use crate::spatial::Pose;
use crate::statistics::Random;
use crate::units::MM;

/// {0} in {W}, m: the fixture stands in front of the robot, on its table.
const BASE: [f64; 3] = [-0.62, 0.03, -0.16];

/// A campaign and the truth behind it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Simulation<'r> {
    /// What is simulated.
    pub plan: Plan,
    /// The true robot, base and tool.
    pub truth: Setup<'r>,
    /// The true rod.
    pub compliance: Compliance,
    /// The measurements.
    pub measurements: Recording,
    /// The validation.
    pub validation: Recording,
    /// First guess of {0} in {W} that a user would write down.
    pub base_guess: Pose,
}

/// Simulates the campaign of `plan` with a nominal robot and the model compliance of its rod.
///
/// ```
/// use rodcal::calibration::simulate::{Plan, campaign_files, simulate};
/// use rodcal::prelude::*;
///
/// let (file, text) = Robot::builtin("tx90").expect("the program carries it");
/// let robot = Robot::from_text(file, text, None, None)?;
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let model = Compliance::of_model(&rod, &Physics::default(), 20)?;
/// let plan = Plan::of_poses(8, 5);
/// let simulation = simulate(&robot, &rod, &model, &plan)?;
/// assert_eq!((simulation.measurements.len(), simulation.validation.len()), (40, 5));
/// // the ball rests within 0.2 mm of the clamps: what is seen is errors of the robot's calibration
/// let files = campaign_files(&simulation, "builtin:tx90", "rods/5.toml");
/// assert!(files.iter().all(|(_, text)| text.starts_with("# SIMULATED")));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::NotApplicable`] where the robot does not reach the clamps with this rod.
pub fn simulate<'r>(robot: &'r Robot, rod: &Rod, model: &Compliance, plan: &Plan) -> Result<Simulation<'r>> {
    simulate_telling(robot, rod, model, plan, &|| ())
}

/// [`simulate`], which takes seconds for a thousand poses; `progress` is called for every candidate
/// that is found and for every pose that is taken.
///
/// ```
/// use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
///
/// use rodcal::calibration::simulate::{Plan, simulate_telling};
/// use rodcal::prelude::*;
///
/// let (file, text) = Robot::builtin("tx90").expect("the program carries it");
/// let robot = Robot::from_text(file, text, None, None)?;
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let model = Compliance::of_model(&rod, &Physics::default(), 20)?;
/// let calls = AtomicUsize::new(0);
/// let count = || _ = calls.fetch_add(1, Relaxed);
/// let simulation = simulate_telling(&robot, &rod, &model, &Plan::of_poses(8, 5), &count)?;
/// assert_eq!(simulation.measurements.len(), 40);
/// assert!(calls.into_inner() >= 80); // as many candidates as poses at least
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`simulate`].
pub fn simulate_telling<'r>(
    robot: &'r Robot,
    rod: &Rod,
    model: &Compliance,
    plan: &Plan,
    progress: &(dyn Fn() + Sync),
) -> Result<Simulation<'r>> {
    let payload = Body { mass: rod.mass(), centre: rod.centre_of_mass() };
    let compliance =
        Compliance { force: model.force * plan.rod_factor, gravity: model.gravity * plan.rod_factor };
    let base_guess = Pose { rotation: Matrix3::identity(), origin: Vector3::from(BASE) };
    let truth = true_setup(robot, base_guess, rod.tip(), payload, plan);
    let groups: Vec<Group> = (1..)
        .zip(CLAMPS)
        .map(|(id, (place, turn))| Group::new(GroupName::Clamp(id.to_string()), device_frame(place, turn)))
        .collect();
    let compensation = Compensation {
        mode: Mode::Fea,
        compliance: Some(compliance),
        laws: Some(StaticLaws::of_tip(rod)).filter(|laws| !laws.is_empty()),
        payload: Some(payload),
        contact_force: Vector3::from(PAPER_CONTACT_FORCE),
        displaced: Vec::new(),
        carried: Vec::new(),
    };
    let free = minimal_parameters(robot, truth.tool, rod.tip(), Some(payload));
    let poses = match plan.planned.is_empty() {
        true => poses::choose(&truth, &free, &groups, plan, progress)?,
        false => planned::taken(&truth, &groups, plan)?,
    };
    let measurements = measure(&truth, &compensation, groups, poses, plan);
    let validation = scan(&truth, plan);
    Ok(Simulation { plan: plan.clone(), truth, compliance, measurements, validation, base_guess })
}

/// The frame of a device: its three sensors look up at the same angle, so that (1, 1, 1) in it is
/// vertical.
fn device_frame(place: [f64; 3], turn: f64) -> Pose {
    let (z, x) = (Vector3::repeat(1.0).normalize(), Vector3::new(1.0, -1.0, 0.0).normalize());
    // rows: where x, y and z of {W} are in the device
    let upright = Matrix3::from_rows(&[x.transpose(), z.cross(&x).transpose(), z.transpose()]);
    Pose {
        rotation: crate::spatial::turned_about_z(&Matrix3::identity(), turn.sin_cos()) * upright,
        origin: Vector3::from(place),
    }
}

/// The nominal robot with errors on every parameter that positions can show.
fn true_setup<'r>(robot: &'r Robot, base: Pose, tool: Vector3<f64>, payload: Body, plan: &Plan) -> Setup<'r> {
    let mut random = Random::seeded(plan.seed, 0);
    let mut truth = Setup::new(robot, base, tool);
    let errors = &plan.errors;
    let torques = super::compensation::largest_torques(robot, &truth, payload);
    for parameter in minimal_parameters(robot, tool, tool, Some(payload)) {
        let sd = match parameter {
            Parameter::BasePosition(_) => 2.0 * MM,
            Parameter::BaseRotation(_) => 2e-3,
            Parameter::Tool(_) => 0.5 * MM,
            Parameter::D(_) | Parameter::A(_) => errors.length,
            Parameter::Theta(_) => errors.offset,
            Parameter::Alpha(_) | Parameter::Beta(_) => errors.tilt,
            Parameter::Compliance(j) => {
                // drives deflect with their torque, never against it
                let mean = errors.joint_turn / torques[j];
                truth.set(parameter, mean * random.uniform(0.5, 1.5));
                continue;
            }
        };
        truth.set(parameter, truth.get(parameter) + sd * random.normal());
    }
    truth
}

/// A vector of normal components whose length has this root mean square.
fn scatter(random: &mut Random, rms: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.normal()) * (rms / 3.0f64.sqrt())
}

/// The displacements that the sensors would show at these joint values.
fn measure(
    truth: &Setup,
    compensation: &Compensation,
    groups: Vec<Group>,
    poses: Vec<(usize, Vec<f64>)>,
    plan: &Plan,
) -> Recording {
    let mut random = Random::seeded(plan.seed, 2);
    let joint_count = truth.robot.joints.len();
    let rows: Vec<Row> = (1..)
        .zip(&poses)
        .map(|(pose, &(group, _))| Row {
            pose: format!("{pose}"),
            line: pose + 1,
            group,
            station: 0,
            time: None,
            temperature: None,
        })
        .collect();
    let joint_values: Vec<f64> = poses.iter().flat_map(|(_, q)| q.iter().copied()).collect();
    let mut recording = Recording {
        source: Some(format!("SIMULATED, seed {}", plan.seed)),
        file: "measurements.csv".into(),
        joint_count,
        joint_values,
        joints_read: None,
        rows,
        groups,
        stations: vec![Station::first("")],
        targets: Targets::Sockets(Vec::new()),
    };
    let tips = deflected_tips(truth, compensation, &recording);
    let clamp_errors: Vec<Vector3<f64>> =
        recording.groups.iter().map(|_| scatter(&mut random, plan.clamp_error)).collect();
    let points = tips
        .iter()
        .zip(&recording.rows)
        .map(|(tip, row)| {
            let seen = tip + scatter(&mut random, plan.repeatability);
            // a wrong place of a clamp moves all that is measured in it
            seen + scatter(&mut random, plan.sensor_noise * 3.0f64.sqrt()) - clamp_errors[row.group]
        })
        .collect();
    recording.targets = Targets::Points(points);
    recording
}

/// The deflected tip of every row, in {W}, m.
fn deflected_tips(truth: &Setup, compensation: &Compensation, recording: &Recording) -> Vec<Vector3<f64>> {
    let mut pass = Pass::at_rest(recording);
    // the torque that turns a joint on is that of the turned joints
    for _ in 0..5 {
        compensation.update(truth, recording, &mut pass);
    }
    let mut kinematics = Kinematics::new(truth);
    (0..recording.len())
        .map(|row| {
            pass.deflect(&mut kinematics, recording, row);
            kinematics.tip
        })
        .collect()
}

/// The validation: poses all over the workspace with a short rigid rod, scanned in {W}.
fn scan(truth: &Setup, plan: &Plan) -> Recording {
    let mut random = Random::seeded(plan.seed, 3);
    let mut short = truth.clone();
    short.tool = Vector3::new(0.0004, -0.0003, 0.1202);
    let joint_count = truth.robot.joints.len();
    let mut recording = Recording {
        source: Some(format!("SIMULATED, seed {}", plan.seed)),
        file: "validation.csv".into(),
        joint_count,
        joint_values: Vec::new(),
        joints_read: None,
        rows: Vec::new(),
        groups: vec![Group::tracked()],
        stations: vec![Station::first("")],
        targets: Targets::Points(Vec::new()),
    };
    let mut kinematics = Kinematics::new(&short);
    while recording.len() < plan.validation_poses {
        let q = anywhere(truth.robot, &mut random);
        kinematics.update(&q, &[]);
        // in front of the robot, above its table
        let tip = kinematics.tip - truth.base_position;
        if tip.x > 0.2 && tip.z > 0.1 && is_above_table(&kinematics, truth.base_position.z) {
            let pose = recording.len() + 1;
            recording.joint_values.extend(&q);
            recording.rows.push(Row {
                pose: format!("{pose}"),
                line: pose + 1,
                group: 0,
                station: 0,
                time: None,
                temperature: None,
            });
        }
    }
    let tips = deflected_tips(&short, &Compensation::bare(), &recording);
    let seen = |tip: Vector3<f64>| {
        tip + scatter(&mut random, plan.repeatability) + scatter(&mut random, plan.scanner_noise)
    };
    recording.targets = Targets::Points(tips.into_iter().map(seen).collect());
    recording
}
