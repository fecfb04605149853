//! An arm: a product of 4×4 transforms, and what its weight does to it.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix4, Vector3, Vector4};

use crate::chance::{happens, log_uniform};
use rodcal_base::statistics::Random;
use rodcal_base::units::DEG;

/// A joint and its link: Rz(θ + q)·Tz(d)·Tx(a)·Rx(α)·Ry(β).
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// θ rad, d m, a m, α rad, β rad.
    pub numbers: [f64; 5],
    /// Mass, kg, and its centre in the frame behind the link, m.
    pub mass: f64,
    pub centre: Vector3<f64>,
    /// Compliance of the drive, rad/(N·m).
    pub compliance: f64,
}

/// From the base to the flange.
pub type Arm = Vec<Link>;

/// Force at a point beyond all joints, N and m.
pub type Pull = (Vector3<f64>, Vector3<f64>);

fn rotation(axis: usize, angle: f64) -> Matrix4<f64> {
    let (s, c) = angle.sin_cos();
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut m = Matrix4::identity();
    (m[(i, i)], m[(j, j)]) = (c, c);
    (m[(i, j)], m[(j, i)]) = (-s, s);
    m
}

/// A frame from position and roll, pitch, yaw: Rz·Ry·Rx.
pub fn frame(xyz: &Vector3<f64>, rpy: &Vector3<f64>) -> Matrix4<f64> {
    let turned = rotation(2, rpy.z) * rotation(1, rpy.y) * rotation(0, rpy.x);
    Matrix4::new_translation(xyz) * turned
}

/// A point of a frame.
pub fn point(frame: &Matrix4<f64>, p: &Vector3<f64>) -> Vector3<f64> {
    turned(frame, p) + column(frame, 3)
}

/// A direction of a frame.
pub fn turned(frame: &Matrix4<f64>, v: &Vector3<f64>) -> Vector3<f64> {
    column(frame, 0) * v.x + column(frame, 1) * v.y + column(frame, 2) * v.z
}

/// An axis of a frame, or its origin.
pub fn column(frame: &Matrix4<f64>, k: usize) -> Vector3<f64> {
    Vector3::new(frame[(0, k)], frame[(1, k)], frame[(2, k)])
}

/// Two axes turned towards each other.
fn turn(from: &mut Vector3<f64>, to: &mut Vector3<f64>, angle: f64) {
    let (s, c) = angle.sin_cos();
    (*from, *to) = (*from * c + *to * s, *to * c - *from * s);
}

/// The frame behind a link, axis by axis: products of 4×4 matrices take most of a trial's time.
fn behind(frame: &Matrix4<f64>, numbers: &[f64; 5], q: f64) -> Matrix4<f64> {
    let [theta, d, a, alpha, beta] = *numbers;
    let [mut x, mut y, mut z, mut at] = [0, 1, 2, 3].map(|k| column(frame, k));
    turn(&mut x, &mut y, theta + q);
    at += x * a + z * d;
    if alpha != 0.0 {
        turn(&mut y, &mut z, alpha);
    }
    if beta != 0.0 {
        turn(&mut z, &mut x, beta);
    }
    let of_vector3 = |v: Vector3<f64>, last: f64| Vector4::new(v.x, v.y, v.z, last);
    Matrix4::from_columns(&[of_vector3(x, 0.0), of_vector3(y, 0.0), of_vector3(z, 0.0), of_vector3(at, 1.0)])
}

/// The base and the frame behind every link.
pub fn frames(arm: &[Link], base: &Matrix4<f64>, q: &[f64]) -> Vec<Matrix4<f64>> {
    let mut frames = Vec::with_capacity(arm.len() + 1);
    frames.push(*base);
    for (link, q) in arm.iter().zip(q) {
        frames.push(behind(&frames[frames.len() - 1], &link.numbers, *q));
    }
    frames
}

/// Torque of weight and pulls about every joint's axis, N·m; gravity is along −z of the world.
pub fn torques(arm: &[Link], frames: &[Matrix4<f64>], gravity: &Vector3<f64>, pulls: &[Pull]) -> Vec<f64> {
    let weights: Vec<Pull> = arm
        .iter()
        .zip(&frames[1..])
        .map(|(link, at)| (gravity * link.mass, point(at, &link.centre)))
        .collect();
    let about = |joint: usize| {
        let axis = frames[joint].column(2).xyz();
        let origin = frames[joint].column(3).xyz();
        let moment = |(force, at): &Pull| (at - origin).cross(force).dot(&axis);
        weights[joint..].iter().chain(pulls).map(moment).sum()
    };
    (0..arm.len()).map(about).collect()
}

/// Moment of weight and pulls about the base, N·m.
pub fn moment(arm: &[Link], frames: &[Matrix4<f64>], gravity: &Vector3<f64>, pulls: &[Pull]) -> Vector3<f64> {
    let from = column(&frames[0], 3);
    let weights =
        arm.iter().zip(&frames[1..]).map(|(link, at)| (gravity * link.mass, point(at, &link.centre)));
    weights.chain(pulls.iter().copied()).map(|(force, at)| (at - from).cross(&force)).sum()
}

/// A six-axis arm as makers build them: with a spherical wrist, or with three parallel axes and an
/// offset wrist.
pub fn draw(random: &mut Random) -> (Arm, &'static str) {
    let spherical = happens(random, 0.5);
    let h = FRAC_PI_2;
    // θ, d, a, α; mass kg, centre m
    type Row = ([f64; 4], f64, [f64; 3]);
    let rows: [Row; 6] = if spherical {
        [
            ([0.0, 0.15, 0.05, h], 17.0, [-0.03, -0.06, -0.02]),
            ([h, -0.05, 0.425, 0.0], 25.0, [-0.25, 0.0, -0.17]),
            ([h, 0.0, 0.0, h], 24.0, [0.0, 0.03, 0.06]),
            ([0.0, 0.425, 0.0, -h], 9.0, [0.0, 0.14, 0.0]),
            ([0.0, 0.0, 0.0, h], 2.0, [0.0, 0.01, 0.02]),
            ([0.0, 0.1, 0.0, 0.0], 0.3, [0.005, 0.0, -0.02]),
        ]
    } else {
        [
            ([0.0, 0.128, 0.0, h], 7.5, [0.0, -0.02, 0.02]),
            ([0.0, 0.0, -0.612, 0.0], 12.5, [0.3, 0.0, 0.16]),
            ([0.0, 0.0, -0.572, 0.0], 4.5, [0.27, 0.0, 0.05]),
            ([0.0, 0.164, 0.0, h], 2.1, [0.0, -0.01, 0.02]),
            ([0.0, 0.116, 0.0, -h], 2.1, [0.0, 0.01, 0.02]),
            ([0.0, 0.092, 0.0, 0.0], 0.4, [0.0, 0.005, -0.03]),
        ]
    };
    let links = rows.into_iter().enumerate().map(|(joint, ([theta, d, a, alpha], mass, centre))| {
        let scale = random.uniform(0.9, 1.1);
        let [from, to] = if joint < 3 { [0.5e-6, 3e-6] } else { [3e-6, 15e-6] };
        Link {
            numbers: [theta, rounded(d * scale), rounded(a * scale), alpha, 0.0],
            mass: rounded(mass * random.uniform(0.8, 1.2)),
            centre: Vector3::from(centre) * scale,
            compliance: log_uniform(random, from, to),
        }
    });
    (links.collect(), if spherical { "spherical wrist" } else { "offset wrist" })
}

fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// How well the numbers of a robot file are known, 1 σ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Lengths, m; twists and joint zeros, rad; share of masses and centres.
    pub length: f64,
    pub angle: f64,
    pub zero: f64,
    pub mass: f64,
    /// False: the file says nothing and means these, the defaults.
    pub is_stated: bool,
}

/// Least distance from its frame that the share of a centre's uncertainty is of, m.
const LEAST_DISTANCE: f64 = 0.02;
/// No link is lighter than this share of what its file says.
const LIGHTEST: f64 = 0.1;

impl Known {
    /// What half of the files state; the others mean the defaults.
    pub fn draw(random: &mut Random) -> Known {
        let stated = Known {
            length: (log_uniform(random, 0.1, 1.0) * 100.0).round() * 1e-5,
            angle: (log_uniform(random, 0.02, 0.1) * 1e3).round() * 1e-3 * DEG,
            zero: (log_uniform(random, 0.05, 0.3) * 1e3).round() * 1e-3 * DEG,
            mass: random.uniform(5.0, 30.0).round() * 1e-2,
            is_stated: true,
        };
        let default = Known { length: 1e-3, angle: 0.1 * DEG, zero: 0.3 * DEG, mass: 0.2, is_stated: false };
        if happens(random, 0.5) { stated } else { default }
    }

    /// Of a coordinate of a link's centre, m.
    pub fn centre(&self, link: &Link) -> f64 {
        self.mass * link.centre.norm().max(LEAST_DISTANCE)
    }

    /// Of the five numbers of a link. An axis that is parallel to the next is not moved along
    /// itself, and one that is not has no β.
    pub fn numbers(&self, link: &Link) -> [f64; 5] {
        let is_parallel = link.numbers[3].abs() < 1e-9;
        let d = if is_parallel { 0.0 } else { self.length };
        [self.zero, d, self.length, self.angle, if is_parallel { self.angle } else { 0.0 }]
    }
}

/// The arm as it was really built: off by `times` what is known.
pub fn built(nominal: &[Link], known: &Known, times: f64, random: &mut Random) -> Arm {
    let one = |link: &Link, random: &mut Random| {
        let mut real = link.clone();
        for (number, u) in real.numbers.iter_mut().zip(known.numbers(link)) {
            *number += times * u * random.normal();
        }
        real.mass *= (1.0 + times * known.mass * random.normal()).max(LIGHTEST);
        real.centre += Vector3::from_fn(|_, _| times * known.centre(link) * random.normal());
        real
    };
    nominal.iter().map(|link| one(link, random)).collect()
}

/// An angle within a turn.
pub fn within_a_turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(2.0 * PI) - PI
}
