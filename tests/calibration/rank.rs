//! The set of parameters: complete, so that any robot nearby can be described, and minimal, so that
//! each one can be found. Judged by the rank of a Jacobian that shares nothing with the program's:
//! differences of the laboratory's tip.

use nalgebra::{DMatrix, Isometry3, Vector3};
use rodcal::robot::{Body, Parameter, Robot, minimal_parameters};

use super::arms::{self, SCARA, SEVEN, UR5};
use super::lab::{Dice, Lab, TrueRod};
use super::rods;

/// Singular values of columns of size 1 from differences over ±1e-5 that are wrong by 1e-10: below
/// this there is nothing.
pub const NOTHING: f64 = 1e-8;
/// The program leaves out what is less than 1 % of a direction of its own; what it keeps is known
/// that well, or to the few tenths of that which remain where two dozen such columns come together.
const SOMETHING: f64 = 1e-4;

/// Columns of the tip's Jacobian over poses, lengths per metre, angles per radian, compliances per
/// radian at their largest torque.
pub fn jacobian(lab: &Lab, parameters: &[Parameter], poses: &[Vec<f64>]) -> DMatrix<f64> {
    const STEP: f64 = 1e-5;
    let torques: Vec<Vec<f64>> = poses.iter().map(|q| lab.torques(q, &Vector3::zeros())).collect();
    let mut matrix = DMatrix::zeros(3 * poses.len(), parameters.len());
    for (k, &parameter) in parameters.iter().enumerate() {
        let largest = match parameter {
            Parameter::Compliance(j) => torques.iter().map(|t| t[j].abs()).fold(1e-6, f64::max),
            _ => 1.0,
        };
        for (row, (q, torque)) in poses.iter().zip(&torques).enumerate() {
            let at = |by: f64| match parameter {
                // a joint that yields is a joint that stands elsewhere
                Parameter::Compliance(j) => {
                    let mut q = q.clone();
                    q[j] += by * torque[j] / largest;
                    lab.rigid_tip(&q)
                }
                _ => {
                    let mut changed = lab.clone();
                    changed.change(parameter, by);
                    changed.rigid_tip(q)
                }
            };
            let column = (at(STEP) - at(-STEP)) / (2.0 * STEP * (poses.len() as f64).sqrt());
            matrix.view_mut((3 * row, k), (3, 1)).copy_from(&column);
        }
    }
    matrix
}

fn singular_values(matrix: DMatrix<f64>) -> Vec<f64> {
    let mut values: Vec<f64> = matrix.svd(false, false).singular_values.iter().copied().collect();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// The minimal set for a tip at `tool`, after it has been found complete and minimal.
fn checked(name: &str, robot: &Robot, tool: Vector3<f64>, rod: Option<TrueRod>) -> Vec<Parameter> {
    let payload = rod.as_ref().map(|rod| Body { mass: rod.mass, centre: rod.centre });
    let minimal = minimal_parameters(robot, tool, tool, payload);
    let mut lab = Lab::new(robot.clone(), Isometry3::identity(), tool);
    lab.rod = rod;
    let weighs = robot.has_masses();
    let mut all = Parameter::all(robot.joints.len());
    // without masses of its own the program knows no torques
    all.retain(|p| weighs || !matches!(p, Parameter::Compliance(_)));
    // a prismatic joint's force moves it, and no file can say by how much
    all.retain(|p| match *p {
        Parameter::Compliance(j) => robot.joints[j].motion == rodcal::robot::Motion::Revolute,
        _ => true,
    });
    let mut dice = Dice(3);
    let poses: Vec<Vec<f64>> = (0..120).map(|_| lab.anywhere(&mut dice)).collect();
    let whole = singular_values(jacobian(&lab, &all, &poses));
    let rank = whole.iter().filter(|&&s| s > NOTHING * whole[0]).count();
    let kept = singular_values(jacobian(&lab, &minimal, &poses));
    let names: Vec<String> = minimal.iter().map(ToString::to_string).collect();
    let names = names.join(" ");
    assert_eq!(rank, minimal.len(), "{name}: the rank of all parameters is {rank}: {names}\n{whole:?}");
    let worst = kept.last().unwrap() / kept[0];
    assert!(worst > SOMETHING, "{name}: {names} depend on each other: {worst:e}");
    minimal
}

/// Table 1 of the paper with its six base parameters: 32 numbers.
#[test]
fn the_tx90_with_rod_5_has_the_parameters_of_the_paper() {
    let names = [
        "base_x base_y base_z base_rx base_ry base_rz",
        "a1 alpha1",
        "theta2 d2 a2 alpha2 beta2 c2",
        "theta3 a3 alpha3 c3",
        "theta4 d4 a4 alpha4 c4",
        "theta5 d5 a5 alpha5 c5",
        "theta6 c6",
        "tool_x tool_z",
    ];
    let mut expected: Vec<&str> = names.iter().flat_map(|line| line.split(' ')).collect();
    expected.sort_unstable();
    assert_eq!(expected.len(), 32);
    let (_, robot) = arms::tx90();
    // rod 5# has the soft rod's lengths
    let minimal = checked("TX90", &robot, rods::tip(), Some(rods::closed_form()));
    let mut found: Vec<String> = minimal.iter().map(ToString::to_string).collect();
    found.sort_unstable();
    assert_eq!(found, expected);
}

#[test]
fn every_kind_of_arm_has_a_complete_and_minimal_set() {
    let aside = Vector3::new(0.15, 0.08, 0.2);
    let ahead = Vector3::new(0.0, 0.0, 0.15);
    let (_, tx90) = arms::tx90();
    let (ur5, scara) = (arms::robot(UR5), arms::robot(SCARA));
    let (seven, weightless) = (arms::robot(SEVEN), arms::robot(&arms::weightless(SEVEN)));
    // 4 for every turning joint, 2 for a sliding one, 6 for the base, of the tool only the point:
    // 4R + 2P + 3
    for (name, robot, tool, rod, count) in [
        ("UR5", &ur5, aside, None, Some(27)),
        ("seven joints without masses", &weightless, aside, None, Some(31)),
        // two numbers of the turn of a tip that is nowhere beside the last axis are none
        ("UR5, tool on the last axis", &ur5, ahead, None, None),
        ("TX90, tool on the last axis", &tx90, ahead, None, None),
        ("TX90 without rod", &tx90, aside, None, None),
        ("seven joints", &seven, aside, None, None),
        ("seven joints with a rod", &seven, aside, Some(rods::closed_form()), None),
        ("SCARA", &scara, aside, None, None),
        ("SCARA, tool on the last axis", &scara, ahead, None, None),
    ] {
        let minimal = checked(name, robot, tool, rod);
        if let Some(count) = count {
            assert_eq!(minimal.len(), count, "{name}");
        }
    }
}

/// A turn of a tool on the last axis moves nothing.
#[test]
fn the_last_offset_goes_where_the_tool_lies_on_the_axis() {
    let (_, robot) = arms::tx90();
    let ahead = minimal_parameters(&robot, Vector3::new(0.0, 0.0, 0.15), Vector3::new(0.0, 0.0, 0.15), None);
    assert!(!ahead.contains(&Parameter::Theta(5)), "{ahead:?}");
    assert!(ahead.contains(&Parameter::Tool(0)) && ahead.contains(&Parameter::Tool(1)), "{ahead:?}");
}

/// What θ₆ does is left out of the tool's three coordinates, and no other: a tip along y is moved
/// along x.
#[test]
fn the_last_offset_takes_what_it_moves() {
    let (_, robot) = arms::tx90();
    for (tool, expected) in
        [([0.005, -0.15, 0.1], [false, true, true]), ([0.15, 0.005, 0.1], [true, false, true])]
    {
        let minimal = minimal_parameters(&robot, tool.into(), tool.into(), None);
        assert!(minimal.contains(&Parameter::Theta(5)), "{minimal:?}");
        let own: Vec<bool> = (0..3).map(|axis| minimal.contains(&Parameter::Tool(axis))).collect();
        assert_eq!(own, expected);
    }
}

/// A tip 14 mm beside the last axis shows how that axis is tilted, both ways.
#[test]
fn a_tip_near_the_last_axis_shows_its_tilt() {
    let robot = arms::robot(UR5);
    let tool = Vector3::new(0.011, 0.009, 0.1);
    let minimal = minimal_parameters(&robot, tool, tool, None);
    for parameter in [Parameter::Theta(4), Parameter::Alpha(4)] {
        assert!(minimal.contains(&parameter), "{minimal:?}");
    }
}
