//! A simulated campaign as the files that a user would have.

use super::Simulation;
use crate::calibration::campaign::Targets;
use crate::compliance::PAPER_CONTACT_FORCE;
use crate::robot::Robot;
use crate::statistics::Random;
use crate::units::{DEG, MM, STANDARD_GRAVITY, UM};

/// Names and contents of `campaign.toml`, `measurements.csv`, `validation.csv` and `readings.csv`.
///
/// `robot` and `rod` are what the campaign shall name. Joint angles are written to a
/// ten-millionth of a degree, displacements to a tenth of a micrometre.
///
/// ```
/// use rodcal::calibration::simulate::{Plan, campaign_files, simulate};
/// use rodcal::prelude::*;
///
/// let (file, text) = Robot::builtin("tx90").expect("the program carries it");
/// let robot = Robot::from_text(file, text, None, None)?;
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let model = Compliance::of_model(&rod, &Physics::default(), 20)?;
/// let simulation = simulate(&robot, &rod, &model, &Plan::of_poses(8, 5))?;
/// let files = campaign_files(&simulation, "builtin:tx90", "rod.toml");
/// let (name, measurements) = &files[1];
/// assert_eq!(name, "measurements.csv");
/// assert_eq!(measurements.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())).count(), 40);
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn campaign_files(simulation: &Simulation, robot: &str, rod: &str) -> Vec<(String, String)> {
    vec![
        ("campaign.toml".into(), campaign(simulation, robot, rod)),
        ("measurements.csv".into(), measurements(simulation)),
        ("validation.csv".into(), validation(simulation)),
        ("readings.csv".into(), readings(simulation)),
    ]
}

fn campaign(simulation: &Simulation, robot: &str, rod: &str) -> String {
    let [fx, fy, fz] = PAPER_CONTACT_FORCE;
    let base = simulation.base_guess.origin / MM;
    let mut text = format!(
        "# SIMULATED, not a recording: seed {}, true rod {} times as compliant as its model.\n\
         robot = \"{robot}\"\n\
         rod = \"{rod}\"\n\
         rig = \"readings.csv\"\n\
         contact_force_n = [{fx:?}, {fy:?}, {fz:?}]\n\
         measurements = \"measurements.csv\"\n\
         validation = \"validation.csv\"\n\n\
         [base]\nxyz_mm = [{:.3}, {:.3}, {:.3}]\nrpy_deg = [0.0, 0.0, 0.0]\n",
        simulation.plan.seed, simulation.plan.rod_factor, base.x, base.y, base.z
    );
    for (id, group) in (1..).zip(&simulation.measurements.groups) {
        let [roll, pitch, yaw] = group.device.roll_pitch_yaw();
        let place = group.device.origin / MM;
        text += &format!(
            "\n[[clamp]]\nid = \"{id}\"\nxyz_mm = [{:.4}, {:.4}, {:.4}]\nrpy_deg = [{:.9}, {:.9}, {:.9}]\n",
            place.x,
            place.y,
            place.z,
            roll / DEG,
            pitch / DEG,
            yaw / DEG
        );
    }
    text
}

fn joint_header(robot: &Robot) -> String {
    (1..).zip(&robot.joints).map(|(number, joint)| format!(",{}", joint.column(number).0)).collect()
}

fn joint_cells(robot: &Robot, values: &[f64]) -> String {
    values.iter().zip(&robot.joints).map(|(q, joint)| format!(",{:.7}", q / joint.column(1).1)).collect()
}

fn measurements(simulation: &Simulation) -> String {
    let recording = &simulation.measurements;
    let Targets::Points(points) = &recording.targets else { return String::new() };
    let mut text = format!(
        "# SIMULATED, seed {}\npose,clamp{},x_mm,y_mm,z_mm\n",
        simulation.plan.seed,
        joint_header(simulation.truth.robot)
    );
    for (row, entry) in recording.rows.iter().enumerate() {
        let device = &recording.groups[entry.group].device;
        let seen = device.inverse().point(&points[row]) / MM;
        let (q, clamp) = (joint_cells(simulation.truth.robot, recording.joints(row)), entry.group + 1);
        text += &format!("{},{clamp}{q},{:.4},{:.4},{:.4}\n", entry.pose, seen.x, seen.y, seen.z);
    }
    text
}

fn validation(simulation: &Simulation) -> String {
    let recording = &simulation.validation;
    let Targets::Points(points) = &recording.targets else { return String::new() };
    let mut text = format!(
        "# SIMULATED, seed {}\npose{},x_mm,y_mm,z_mm\n",
        simulation.plan.seed,
        joint_header(simulation.truth.robot)
    );
    for (row, entry) in recording.rows.iter().enumerate() {
        let x = points[row] / MM;
        text += &format!(
            "{}{},{:.4},{:.4},{:.4}\n",
            entry.pose,
            joint_cells(simulation.truth.robot, recording.joints(row)),
            x.x,
            x.y,
            x.z
        );
    }
    text
}

/// The paper's rig on the true rod: four loads, five repeats, along y and z, 1 N of friction, 3 µm
/// of noise.
fn readings(simulation: &Simulation) -> String {
    const FRICTION_N: f64 = 1.0;
    let mut random = Random::seeded(simulation.plan.seed, 4);
    let mut text = format!("# SIMULATED, seed {}\naxis,load_kg,trial,dy_um,dz_um\n", simulation.plan.seed);
    for (axis, index) in [("y", 1), ("z", 2)] {
        let slope = simulation.compliance.force[(index, index)];
        for trial in 1..=5 {
            for load_kg in [0.5, 1.0, 1.5, 2.0] {
                let force = load_kg * STANDARD_GRAVITY - FRICTION_N;
                let offset = slope * force / UM + 3.0 * random.normal();
                let cells = if axis == "y" { format!("{offset:.0},") } else { format!(",{offset:.0}") };
                text += &format!("{axis},{load_kg},{trial},{cells}\n");
            }
        }
    }
    text
}
