//! The calibrated robot's file, read again, puts the tip where the calibration has it.

use nalgebra::{Isometry3, Vector3};
use rodcal::calibration::{Calibration, Campaign, Mode, Options, calibrate, write_back};
use rodcal::robot::{Kinematics, Loads, Parameter, Robot, Setup};

use super::arms::{self, SEVEN};
use super::lab::{Dice, Lab, PHYSICS, millimetres, read};
use super::recovery::{Clamped, spoil};

/// Angles are written in degrees and lengths in metres to the last digit.
const SAME: f64 = 1e-9;

fn calibrated(campaign: &Campaign, mode: Mode) -> Calibration<'_> {
    let found = calibrate(campaign, mode, &Options::default()).unwrap();
    assert!(found.is_converged);
    found
}

/// A table with base and tool of the calibration: the tip at every pose, compliant joints and all.
#[test]
fn a_table_predicts_the_same_tips() {
    let mut made = Clamped::new(PHYSICS);
    made.noise = 20e-6;
    let campaign = made.campaign();
    let found = calibrated(&campaign, Mode::Calc);
    let (name, text) = write_back(&campaign, &found).unwrap();
    assert_eq!(name, "calibrated.toml");
    let robot = Robot::from_text(&name, &text, None, None).unwrap();
    let setup = Setup::new(&robot, found.setup.base(), found.setup.tool);
    let rod = campaign.rod.as_ref().unwrap();
    let mut kinematics = Kinematics::new(&setup);
    let mut torque = vec![0.0; 6];
    for row in 0..campaign.measurements.len() {
        let q = campaign.measurements.joints(row);
        let device = &campaign.measurements.groups[campaign.measurements.rows[row].group].device;
        let payload = rodcal::robot::Body { mass: rod.mass(), centre: rod.centre_of_mass() };
        let gravity = setup.base().rotation * robot.gravity;
        let loads = Loads::new(gravity, Some(payload), device.rotation * campaign.contact_force.unwrap());
        for _ in 0..6 {
            kinematics.update(q, &torque);
            kinematics.torques(&loads, &mut torque);
        }
        let apart = (kinematics.tip - found.tips[row]).norm();
        assert!(apart < SAME, "pose {row}: {apart:e} m");
    }
    // base and tip, which a table has no place for, stand on top for people
    let of_tool = (found.setup.tool * 1e3).map(|x| format!("{x:.4}"));
    assert!(text.contains(&format!("Tip in {{T}}: xyz_mm = [{}, {}, {}]", of_tool.x, of_tool.y, of_tool.z)));
    assert!(text.contains("Base {0} in {W}"));
}

/// A URDF's `tip_link` is the tip.
#[test]
fn a_urdf_ends_at_the_tip() {
    let text = arms::weightless(SEVEN);
    let mut dice = Dice(91);
    let base = Isometry3::new(Vector3::new(0.5, -0.2, 0.1), Vector3::new(0.1, 0.2, -0.9));
    let mut lab = Lab::new(arms::robot(&text), base, Vector3::new(0.02, -0.01, 0.05));
    let links: Vec<Parameter> =
        Parameter::all(7).into_iter().filter(|p| !matches!(p, Parameter::Compliance(_))).collect();
    spoil(&mut lab, &links, &mut dice);
    let mut csv = format!("pose{},x_mm,y_mm,z_mm\n", lab.header());
    for pose in 0..60 {
        let q = lab.anywhere(&mut dice);
        let noise = Vector3::from_fn(|_, _| 20e-6 * dice.normal());
        csv += &format!("{pose}{},{}\n", lab.cells(&q), millimetres(&(lab.rigid_tip(&q) + noise)));
    }
    let campaign = "robot = \"robot.urdf\"\nmeasurements = \"m.csv\"\n[tool]\nxyz_mm = [20, -10, 50]\n";
    let campaign = read(&[("campaign.toml", campaign), ("robot.urdf", &text), ("m.csv", &csv)]);
    let found = calibrated(&campaign, Mode::None);
    let (name, written) = write_back(&campaign, &found).unwrap();
    assert_eq!(name, "calibrated.urdf");
    assert_ne!(written, text);
    let robot = Robot::from_text(&name, &written, None, None).unwrap();
    for row in 0..60 {
        let flange = robot.flange_at(campaign.measurements.joints(row));
        let apart = (found.setup.base().point(&flange.origin) - found.tips[row]).norm();
        assert!(apart < SAME, "pose {row}: {apart:e} m");
    }
}
