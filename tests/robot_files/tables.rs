//! Robots given as tables of Hayati parameters.

use approx::assert_relative_eq;
use nalgebra::Vector3;
use rodcal::robot::{Body, Hayati, Motion, Robot};
use rodcal::spatial::Pose;

use super::tx90;

const EXAMPLE: &str = r#"
name = "gantry"
source = "drawing 12"
convention = "hayati"
gravity_m_s2 = [0.0, 9.81, 0]
[[joint]]
name = "rail"
type = "prismatic"
theta_offset_deg = 30
d_mm = 150
a_mm = 50
alpha_deg = 90
beta_deg = 0.5
limits_mm = [-100, 500]
mass_kg = 2
[[joint]]
type = "revolute"
d_mm = -20.5
a_mm = 0
alpha_deg = -45.0
compliance_urad_per_nm = 2.5
mass_kg = 28.0
com_mm = [1, 2.0, -3]
limits_deg = [-180, 170.5]
"#;

#[test]
fn a_table_is_read_into_si_units() {
    let robot = Robot::from_text("robots/g.toml", EXAMPLE, None, None).expect("a good table");
    assert_eq!((robot.name.as_str(), robot.source.as_deref()), ("gantry", Some("drawing 12")));
    assert_eq!(robot.gravity, Vector3::new(0.0, 9.81, 0.0));
    assert_eq!((robot.root, robot.flange), (Pose::IDENTITY, Pose::IDENTITY));
    let [rail, wrist] = robot.joints.as_slice() else { panic!("two joints") };
    assert_eq!((rail.name.as_str(), rail.motion), ("rail", Motion::Prismatic));
    assert_eq!((wrist.name.as_str(), wrist.motion), ("joint 2", Motion::Revolute));
    let deg = std::f64::consts::PI / 180.0;
    let link = [rail.link.theta, rail.link.d, rail.link.a, rail.link.alpha, rail.link.beta];
    for (found, expected) in link.iter().zip([30.0 * deg, 0.15, 0.05, 90.0 * deg, 0.5 * deg]) {
        assert_relative_eq!(*found, expected, max_relative = 1e-15);
    }
    let expected = Hayati { theta: 0.0, d: -0.0205, a: 0.0, alpha: -45.0 * deg, beta: 0.0 };
    assert_eq!(wrist.link, expected);
    assert_eq!(rail.limits, Some([-0.1, 0.5]));
    assert_eq!(wrist.limits, Some([-180.0 * deg, 170.5 * deg]));
    assert_relative_eq!(wrist.compliance, 2.5e-6, max_relative = 1e-15);
    assert_eq!(rail.body, Some(Body { mass: 2.0, centre: Vector3::zeros() }));
    let body = wrist.body.expect("a body");
    assert_relative_eq!(body.centre, Vector3::new(0.001, 0.002, -0.003), max_relative = 1e-15);
}

#[test]
fn what_is_not_stated_has_its_default() {
    let text = "[[joint]]\nd_mm = 1\na_mm = 2\nalpha_deg = 3\n";
    let robot = Robot::from_text("robots/plain.toml", text, Some("ignored"), None).expect("a good table");
    assert_eq!((robot.name.as_str(), robot.source.clone()), ("plain", None));
    assert_eq!(robot.gravity, Vector3::new(0.0, 0.0, -9.80665));
    let joint = &robot.joints[0];
    assert_eq!((joint.name.as_str(), joint.motion, joint.compliance), ("joint 1", Motion::Revolute, 0.0));
    assert_eq!((joint.link.theta, joint.link.beta), (0.0, 0.0));
    assert_eq!((joint.body, joint.limits), (None, None));
    assert!(!robot.has_masses());
}

/// Every key that the file of a user may have, in a file that a user does have.
#[test]
fn the_real_table_is_read() {
    let Some(text) = super::real("ur5/robot.toml") else { return };
    let robot = Robot::from_text("robot.toml", &text, None, None).expect("a good table");
    assert_eq!((robot.name.as_str(), robot.joints.len()), ("UR5", 6));
    // straight up and stretched out: the sum of the lengths in Universal Robots' own table
    let flange = robot.flange_at(&[0.0; 6]);
    assert_relative_eq!(flange.origin, Vector3::new(-0.81725, -0.19145, -0.005491), epsilon = 1e-12);
}

#[test]
fn the_builtin_robot_is_the_paper_s_table() {
    let robot = tx90();
    assert_eq!((robot.name.as_str(), robot.joints.len()), ("TX90", 6));
    assert!(robot.has_masses() && Robot::builtin("tx200").is_none());
}

#[test]
fn the_example_of_the_documentation_is_read() {
    let text = include_str!("../../docs/robot-file.md");
    let example =
        text.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let robot = Robot::from_text("example.toml", example, None, None).expect(example);
    assert_eq!((robot.joints[0].name.as_str(), robot.has_masses()), ("shoulder", true));
}

/// What `--apply` writes is what is read again: bit by bit, or but for the last bit where units
/// change.
#[test]
fn effects_of_joints_are_read_and_written() {
    let text = EXAMPLE.to_owned()
        + "\n[tip]\nxyz_mm = [1.5, -2, 300]\nsd_mm = 0.04\n"
        + "\n[[effect]]\nname = \"transmission_error\"\njoint = 2\ncycles_per_rev = 18.5\nsin_urad = 80\ncos_urad = -20.5\n"
        + "\n[[effect]]\nname = \"transmission_error\"\njoint = 2\nangle_deg = [-10, 0, 25.5]\ncorrection_urad = [1, -2, 3.5]\n"
        + "\n[[effect]]\nname = \"encoder_scale\"\njoint = 2\nfactor = 1.0002\n"
        + "\n[[effect]]\nname = \"backlash\"\njoint = 2\nplay_urad = 42\n";
    let read =
        |text: &str| Robot::from_text("g.toml", text, None, None).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let robot = read(&text);
    assert_eq!(robot.effects.len(), 4);
    let again = read(&robot.to_toml(&[]).unwrap());
    assert_eq!(again, robot);
    let q = [0.1, 0.2];
    let wave = 80e-6 * (18.5f64 * 0.2).sin() - 20.5e-6 * (18.5f64 * 0.2).cos();
    let table = (-2.0 + 5.5 * 0.2f64.to_degrees() / 25.5) * 1e-6;
    let expected = wave + table + 0.0002 * 0.2 - 21e-6;
    assert_relative_eq!(robot.correction(1, &q, &[0.0, -3.0]), expected, max_relative = 1e-9);
    for wrong in [
        "name = \"wobble\"\njoint = 1",
        "name = \"encoder_scale\"\njoint = 3\nfactor = 1",
        "name = \"encoder_scale\"\njoint = 1",
        "name = \"transmission_error\"\njoint = 2\nangle_deg = [1, 0]\ncorrection_urad = [1, 2]",
        "name = \"transmission_error\"\njoint = 2\nangle_deg = [1, 2]\ncorrection_urad = [1]",
    ] {
        let text = format!("{EXAMPLE}\n[[effect]]\n{wrong}\n");
        assert!(Robot::from_text("g.toml", &text, None, None).is_err(), "{wrong}");
    }
}
