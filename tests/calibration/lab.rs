//! A laboratory that knows the truth: robot, rod and clamps written a second time, with isometries
//! and virtual work in place of the program's frames and Newton–Euler recursion. Signs are those of
//! the interfaces: gravity pulls down, the contact force acts on the ball in the device's frame,
//! measured = rigid tip + R·Δx.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, Matrix3, Point3, Translation3, UnitQuaternion, Vector3};
use rodcal::calibration::Campaign;
use rodcal::error::{Error, Place};
use rodcal::robot::{Hayati, Motion, Parameter, Robot};
use rodcal::spatial::Pose;

/// Numbers between −1 and 1 that are the same every time: a linear congruential generator (Knuth,
/// MMIX).
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Nearly normal, standard deviation 1: the sum of twelve.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.roll()).sum::<f64>() / 2.0
    }

    pub fn vector(&mut self, scale: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.roll() * scale)
    }

    pub fn motion(&mut self, length: f64, angle: f64) -> Isometry3<f64> {
        Isometry3::new(self.vector(length), self.vector(angle))
    }
}

/// A rod as what it does: weight on the flange, and deflection.
#[derive(Debug, Clone)]
pub struct TrueRod {
    /// kg.
    pub mass: f64,
    /// In {T}, m.
    pub centre: Vector3<f64>,
    /// C^F, m/N.
    pub force: Matrix3<f64>,
    /// C^g, m per g.
    pub gravity: Matrix3<f64>,
}

/// Factors on what the laws of the laboratory say; 1 is how the world is.
#[derive(Debug, Clone, Copy)]
pub struct Laws {
    pub sag: f64,
    pub push: f64,
    pub yielding: f64,
    pub links_weigh: f64,
    pub rod_weighs: f64,
    pub push_turns: f64,
    pub gravity_unit: f64,
    pub push_is_in_the_device: bool,
}

pub const PHYSICS: Laws = Laws {
    sag: 1.0,
    push: 1.0,
    yielding: 1.0,
    links_weigh: 1.0,
    rod_weighs: 1.0,
    push_turns: 1.0,
    gravity_unit: 9.80665,
    push_is_in_the_device: true,
};

/// The true robot where it truly stands, with what it truly carries.
#[derive(Debug, Clone)]
pub struct Lab {
    /// Its links and compliances are the true ones.
    pub robot: Robot,
    /// {0} in {W}.
    pub base: Isometry3<f64>,
    /// Undeflected tip in {T}, m.
    pub tool: Vector3<f64>,
    pub rod: Option<TrueRod>,
    /// On the ball, in the device's frame, N.
    pub push: Vector3<f64>,
    pub laws: Laws,
}

impl Lab {
    pub fn new(robot: Robot, base: Isometry3<f64>, tool: Vector3<f64>) -> Lab {
        Lab { robot, base, tool, rod: None, push: Vector3::zeros(), laws: PHYSICS }
    }

    /// Distal frames of all joints, then the flange, in {W}.
    fn chain(&self, q: &[f64]) -> Vec<Isometry3<f64>> {
        let mut frame = self.base * isometry(&self.robot.root);
        let mut frames = Vec::new();
        for (joint, &q) in self.robot.joints.iter().zip(q) {
            let Hayati { mut theta, mut d, a, alpha, beta } = joint.link;
            match joint.motion {
                Motion::Revolute => theta += q,
                Motion::Prismatic => d += q,
                other => unreachable!("{other:?}"),
            }
            frame = frame
                * turn(Vector3::z() * theta)
                * Translation3::new(0.0, 0.0, d)
                * Translation3::new(a, 0.0, 0.0)
                * turn(Vector3::x() * alpha)
                * turn(Vector3::y() * beta);
            frames.push(frame);
        }
        frames.push(frame * isometry(&self.robot.flange));
        frames
    }

    /// The tip without anything that bends or yields, in {W}.
    pub fn rigid_tip(&self, q: &[f64]) -> Vector3<f64> {
        point(self.chain(q).last().unwrap(), &self.tool)
    }

    /// Acceleration of gravity in {W}.
    fn gravity(&self) -> Vector3<f64> {
        self.base.rotation * self.robot.gravity
    }

    /// What weights and the force on the ball have gained at `q`, from some zero on.
    fn work(&self, q: &[f64], push: &Vector3<f64>) -> f64 {
        let frames = self.chain(q);
        let (flange, g) = (frames.last().unwrap(), self.gravity());
        let mut work = self.laws.push_turns * push.dot(&point(flange, &self.tool));
        for (joint, frame) in self.robot.joints.iter().zip(&frames) {
            let Some(body) = &joint.body else { continue };
            work += self.laws.links_weigh * body.mass * g.dot(&point(frame, &body.centre));
        }
        if let Some(rod) = &self.rod {
            work += self.laws.rod_weighs * rod.mass * g.dot(&point(flange, &rod.centre));
        }
        work
    }

    /// Torque on each joint. The work is a sine of a joint's angle, and half its difference over a
    /// quarter turn to either side is its derivative, exactly.
    pub fn torques(&self, q: &[f64], push: &Vector3<f64>) -> Vec<f64> {
        let at = |j: usize, by: f64| {
            let mut q = q.to_vec();
            q[j] += by;
            self.work(&q, push)
        };
        let entry = |j: usize| match self.robot.joints[j].motion {
            Motion::Revolute => (at(j, FRAC_PI_2) - at(j, -FRAC_PI_2)) / 2.0,
            Motion::Prismatic => at(j, 0.5) - at(j, -0.5),
            other => unreachable!("{other:?}"),
        };
        (0..q.len()).map(entry).collect()
    }

    /// Where the ball really is, in {W}, while the device whose axes are given pushes it.
    pub fn tip(&self, q: &[f64], device: &UnitQuaternion<f64>) -> Vector3<f64> {
        let push = match self.laws.push_is_in_the_device {
            true => device * self.push,
            false => self.push,
        };
        // the torque that turns a joint on is that of the turned joints
        let mut turned = q.to_vec();
        for _ in 0..6 {
            let torques = self.torques(&turned, &push);
            for (j, joint) in self.robot.joints.iter().enumerate() {
                turned[j] = q[j] + self.laws.yielding * joint.compliance * torques[j];
            }
        }
        let frames = self.chain(&turned);
        let flange = frames.last().unwrap();
        let rigid = point(flange, &self.tool);
        let Some(rod) = &self.rod else { return rigid };
        let back = flange.rotation.inverse();
        let sag = rod.gravity * (back * self.gravity() / self.laws.gravity_unit);
        let yielded = rod.force * (back * push);
        rigid + flange.rotation * (sag * self.laws.sag + yielded * self.laws.push)
    }

    /// Changes a parameter of the truth by so much.
    pub fn change(&mut self, parameter: Parameter, by: f64) {
        let joints = &mut self.robot.joints;
        *match parameter {
            Parameter::BasePosition(axis) => &mut self.base.translation.vector[axis],
            Parameter::BaseRotation(axis) => {
                let mut v = Vector3::zeros();
                v[axis] = by;
                self.base.rotation = UnitQuaternion::new(v) * self.base.rotation;
                return;
            }
            Parameter::Theta(j) => &mut joints[j].link.theta,
            Parameter::D(j) => &mut joints[j].link.d,
            Parameter::A(j) => &mut joints[j].link.a,
            Parameter::Alpha(j) => &mut joints[j].link.alpha,
            Parameter::Beta(j) => &mut joints[j].link.beta,
            Parameter::Compliance(j) => &mut joints[j].compliance,
            Parameter::Tool(axis) => &mut self.tool[axis],
        } += by;
    }

    /// Joint values anywhere within the limits.
    pub fn anywhere(&self, dice: &mut Dice) -> Vec<f64> {
        let joints = self.robot.joints.iter();
        joints
            .map(|joint| {
                let widest = if joint.motion == Motion::Revolute { PI } else { 1.0 };
                let [low, high] = joint.limits.unwrap_or([-widest, widest]);
                let (low, high) = (low.max(-widest), high.min(widest));
                low + (high - low) * (0.5 + 0.5 * dice.roll())
            })
            .collect()
    }

    /// Joint values that bring the ball to a point of {W}, from a start nearby; `None` where it
    /// does not get there.
    pub fn reach(&self, target: &Vector3<f64>, start: &[f64]) -> Option<Vec<f64>> {
        const STEP: f64 = 1e-6;
        let upright = UnitQuaternion::identity();
        let mut q = start.to_vec();
        // where to turn is told well enough, and eighty times sooner, by a robot without torques
        let rigid = |q: &[f64]| point(self.chain(q).last().unwrap(), &self.tool);
        for _ in 0..30 {
            let miss = target - self.tip(&q, &upright);
            if miss.norm() < 1e-14 {
                break;
            }
            let column = |j: usize| {
                let mut ahead = q.clone();
                ahead[j] += STEP;
                let mut behind = q.clone();
                behind[j] -= STEP;
                (rigid(&ahead) - rigid(&behind)) / (2.0 * STEP)
            };
            let columns: Vec<Vector3<f64>> = (0..q.len()).map(column).collect();
            let square: Matrix3<f64> = columns.iter().map(|c| c * c.transpose()).sum();
            let pull = square.try_inverse()? * miss;
            for (q, column) in q.iter_mut().zip(&columns) {
                *q += column.dot(&pull).clamp(-0.3, 0.3);
            }
        }
        let arrived = (target - self.tip(&q, &upright)).norm() < 1e-13;
        let holds = |(q, joint): (&f64, &rodcal::robot::Joint)| {
            joint.limits.is_none_or(|[low, high]| (low..=high).contains(q))
        };
        (arrived && q.iter().zip(&self.robot.joints).all(holds)).then_some(q)
    }

    /// The cells of joint values, each after a comma, in the units of a file.
    pub fn cells(&self, q: &[f64]) -> String {
        let joints = self.robot.joints.iter().zip(q);
        joints
            .map(|(joint, q)| match joint.motion {
                Motion::Revolute => format!(",{:?}", q.to_degrees()),
                Motion::Prismatic => format!(",{:?}", q * 1e3),
                other => unreachable!("{other:?}"),
            })
            .collect()
    }

    /// `,q1_deg,…`.
    pub fn header(&self) -> String {
        let unit = |motion| if motion == Motion::Revolute { "deg" } else { "mm" };
        let joints = (1..).zip(&self.robot.joints);
        joints.map(|(j, joint)| format!(",q{j}_{}", unit(joint.motion))).collect()
    }
}

/// `x,y,z` in mm.
pub fn millimetres(v: &Vector3<f64>) -> String {
    let [x, y, z] = [v.x * 1e3, v.y * 1e3, v.z * 1e3];
    format!("{x:?}, {y:?}, {z:?}")
}

/// The keys of a frame in a campaign file.
pub fn placed(frame: &Isometry3<f64>) -> String {
    let (roll, pitch, yaw) = frame.rotation.euler_angles();
    let [r, p, y] = [roll, pitch, yaw].map(f64::to_degrees);
    format!("xyz_mm = [{}]\nrpy_deg = [{r:?}, {p:?}, {y:?}]\n", millimetres(&frame.translation.vector))
}

pub fn isometry(pose: &Pose) -> Isometry3<f64> {
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(pose.rotation);
    Isometry3::from_parts(pose.origin.into(), UnitQuaternion::from_rotation_matrix(&rotation))
}

fn turn(v: Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::new(v)
}

pub fn point(frame: &Isometry3<f64>, p: &Vector3<f64>) -> Vector3<f64> {
    (frame * Point3::from(*p)).coords
}

/// Reads the campaign whose files are these; the first is the campaign's own.
pub fn read(files: &[(&str, &str)]) -> Campaign {
    let open = |name: &str| match files.iter().find(|(known, _)| *known == name) {
        Some((_, text)) => Ok((*text).to_owned()),
        None => Err(Error::Input {
            at: Place::whole_file(name),
            found: "no such file".to_owned(),
            expected: "one that the test has made".to_owned(),
            hint: None,
        }),
    };
    Campaign::from_texts(files[0].0, files[0].1, &open).unwrap_or_else(|error| panic!("{error}"))
}
