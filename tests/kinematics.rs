//! The robot's kinematics and its analytic derivatives, against the same chain written a second
//! time with dual numbers.

#![allow(clippy::unwrap_used)]

use nalgebra::Vector3;
use rodcal::robot::{Body, Hayati, Joint, Kinematics, Loads, Motion, Parameter, Robot, Setup};
use rodcal::spatial::Pose;

use rodcal::dual::{Dual, Number};

/// Rounding of a chain of a dozen products of numbers of size 1.
const ROUNDING: f64 = 1e-13;

type Matrix = [[Dual; 3]; 3];
type Frame = (Matrix, [Dual; 3]);

fn constant(x: f64) -> Dual {
    Dual::from(x)
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j]))
}

fn applied(a: &Matrix, v: &[Dual; 3]) -> [Dual; 3] {
    [0, 1, 2].map(|i| a[i][0] * v[0] + a[i][1] * v[1] + a[i][2] * v[2])
}

/// Rotation about an axis (0, 1, 2) by an angle.
fn rotation(axis: usize, angle: Dual) -> Matrix {
    let (s, c, one, nil) = (angle.sin(), angle.cos(), constant(1.0), constant(0.0));
    match axis {
        0 => [[one, nil, nil], [nil, c, -s], [nil, s, c]],
        1 => [[c, nil, s], [nil, one, nil], [-s, nil, c]],
        _ => [[c, -s, nil], [s, c, nil], [nil, nil, one]],
    }
}

fn then(frame: &Frame, next: &Frame) -> Frame {
    let moved = applied(&frame.0, &next.1);
    (product(&frame.0, &next.0), [0, 1, 2].map(|i| frame.1[i] + moved[i]))
}

fn turn(axis: usize, angle: Dual) -> Frame {
    (rotation(axis, angle), [constant(0.0); 3])
}

fn shift(axis: usize, by: Dual) -> Frame {
    let mut origin = [constant(0.0); 3];
    origin[axis] = by;
    (rotation(0, constant(0.0)), origin)
}

fn of_pose(pose: &Pose) -> Frame {
    (
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| constant(pose.rotation[(i, j)]))),
        [0, 1, 2].map(|i| constant(pose.origin[i])),
    )
}

/// exp([v]×) by its power series.
fn exponential(v: [Dual; 3]) -> Matrix {
    let nil = constant(0.0);
    let k = [[nil, -v[2], v[1]], [v[2], nil, -v[0]], [-v[1], v[0], nil]];
    let mut sum = rotation(0, nil);
    let mut term = sum;
    for n in 1..40 {
        term = product(&term, &k).map(|row| row.map(|x| x / f64::from(n)));
        sum = [0, 1, 2].map(|i| [0, 1, 2].map(|j| sum[i][j] + term[i][j]));
    }
    sum
}

/// The tip in {W}, with the derivative by `by`.
fn tip(setup: &Setup, q: &[f64], torque: &[f64], by: Parameter) -> [Dual; 3] {
    let value = |p: Parameter| {
        let value = constant(setup.get(p));
        if p == by { value.derivative() } else { value }
    };
    let turned = exponential([0, 1, 2].map(|k| value(Parameter::BaseRotation(k))));
    let mut frame: Frame = (
        product(&turned, &of_pose(&setup.base_guess).0),
        [0, 1, 2].map(|k| value(Parameter::BasePosition(k))),
    );
    frame = then(&frame, &of_pose(&setup.robot.root));
    for (j, joint) in setup.robot.joints.iter().enumerate() {
        let yielding = value(Parameter::Compliance(j)) * torque[j];
        let (mut theta, mut d) = (value(Parameter::Theta(j)), value(Parameter::D(j)));
        match joint.motion {
            Motion::Revolute => theta += yielding + q[j],
            Motion::Prismatic => d += yielding + q[j],
            other => unreachable!("{other:?}"),
        }
        for next in [
            turn(2, theta),
            shift(2, d),
            shift(0, value(Parameter::A(j))),
            turn(0, value(Parameter::Alpha(j))),
            turn(1, value(Parameter::Beta(j))),
        ] {
            frame = then(&frame, &next);
        }
    }
    frame = then(&frame, &of_pose(&setup.robot.flange));
    let moved = applied(&frame.0, &[0, 1, 2].map(|k| value(Parameter::Tool(k))));
    [0, 1, 2].map(|i| frame.1[i] + moved[i])
}

/// Four joints, one of them prismatic, none of them nice.
fn robot() -> Robot {
    let joint = |j: usize, motion| {
        let x = j as f64;
        let link = Hayati {
            theta: 0.3 - 0.2 * x,
            d: 0.1 + 0.05 * x,
            a: 0.2 - 0.07 * x,
            alpha: 1.1 - 0.6 * x,
            beta: 0.01 * (1.0 + x),
        };
        let mut joint = Joint::new(format!("{j}"), motion, link);
        joint.compliance = 1e-3 * (1.0 + x);
        joint.body = Some(Body { mass: 3.0 - 0.5 * x, centre: Vector3::new(0.02, 0.1 * x, -0.05) });
        joint
    };
    let joints = vec![
        joint(0, Motion::Revolute),
        joint(1, Motion::Revolute),
        joint(2, Motion::Prismatic),
        joint(3, Motion::Revolute),
    ];
    let mut robot = Robot::new("four", joints);
    robot.gravity = Vector3::new(0.3, -1.0, -9.7);
    robot.root = Pose::from_xyz_rpy([0.1, 0.2, 0.3], [0.1, -0.4, 0.7]);
    robot.flange = Pose::from_xyz_rpy([0.05, -0.02, 0.1], [0.3, 0.2, -0.5]);
    robot
}

fn setup(robot: &Robot) -> Setup<'_> {
    let base = Pose::from_xyz_rpy([1.0, -2.0, 0.5], [0.0, 1.57, 0.4]);
    let mut setup = Setup::new(robot, base, Vector3::new(0.3, 0.02, 0.15));
    setup.base_turn = Vector3::new(0.2, -0.1, 0.4);
    setup.base_position += Vector3::new(0.01, 0.02, 0.03);
    setup
}

const Q: [f64; 4] = [0.7, -1.2, 0.15, 2.1];
const TORQUE: [f64; 4] = [12.0, -40.0, 5.0, 1.5];

#[test]
fn tip_and_every_column_are_those_of_dual_numbers() {
    let robot = robot();
    let setup = setup(&robot);
    let mut kinematics = Kinematics::new(&setup);
    kinematics.update(&Q, &TORQUE);
    for parameter in Parameter::all(4) {
        // a prismatic joint's compliance moves it along its axis
        let expected = tip(&setup, &Q, &TORQUE, parameter);
        let column = kinematics.column(parameter, &TORQUE);
        for axis in 0..3 {
            assert!((kinematics.tip[axis] - expected[axis].re).abs() < ROUNDING, "{parameter}");
            assert!(
                (column[axis] - expected[axis].eps).abs() < 100.0 * ROUNDING,
                "{parameter}: {} instead of {}",
                column[axis],
                expected[axis].eps
            );
        }
    }
}

#[test]
fn the_flange_without_torque_is_the_robots_own() {
    let robot = robot();
    let mut setup = Setup::new(&robot, Pose::IDENTITY, Vector3::zeros());
    let mut kinematics = Kinematics::new(&setup);
    kinematics.update(&Q, &[0.0; 4]);
    assert_eq!(kinematics.flange, robot.flange_at(&Q));
    // a setup gives back the robot that it was given, and one that was changed
    assert_eq!(setup.calibrated(), robot);
    setup.set(Parameter::A(1), 0.5);
    assert_eq!(setup.calibrated().joints[1].link.a, 0.5);
}

/// Virtual work: a joint's torque is what gravity and the force on the tip gain per radian of its
/// turn.
#[test]
fn torques_are_the_work_of_gravity_and_tip_force() {
    let robot = robot();
    let setup = setup(&robot);
    let payload = Body { mass: 0.8, centre: Vector3::new(0.1, 0.0, 0.2) };
    let gravity = setup.base().rotation * robot.gravity;
    let loads = Loads::new(gravity, Some(payload), Vector3::new(1.1, -2.0, 3.0));
    let work = |q: &[f64]| {
        let mut kinematics = Kinematics::new(&setup);
        kinematics.update(q, &[0.0; 4]);
        let links = kinematics.joints.iter().zip(&robot.joints).map(|(frames, joint)| {
            let body = joint.body.unwrap();
            loads.gravity.dot(&frames.distal.point(&body.centre)) * body.mass
        });
        links.sum::<f64>()
            + loads.gravity.dot(&kinematics.flange.point(&payload.centre)) * payload.mass
            + loads.tip_force.dot(&kinematics.tip)
    };
    let mut kinematics = Kinematics::new(&setup);
    kinematics.update(&Q, &[0.0; 4]);
    let mut torque = [0.0; 4];
    kinematics.torques(&loads, &mut torque);
    for j in 0..4 {
        let h = 1e-5;
        let at = |dq: f64| {
            let mut q = Q;
            q[j] += dq;
            work(&q)
        };
        let expected = (at(h) - at(-h)) / (2.0 * h);
        assert!((torque[j] - expected).abs() < 1e-7, "joint {j}: {} instead of {expected}", torque[j]);
    }
}
