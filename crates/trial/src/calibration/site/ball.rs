//! Where the ball really is: gears, torques, arm, rod, base, fixture and who measures, with all
//! that is wrong with them.

use nalgebra::{Matrix3, Matrix4, Vector3};

use super::{Devices, Site};
use crate::calibration::arm::{self, Arm, Pull, turned};
use crate::calibration::effect::Effect;

/// Times that torques and the joints that they turn are computed from each other.
const ROUNDS: usize = 3;

impl Site {
    /// Where the ball is, as the fixture and its file would have it: position in the world, m.
    pub fn ball(&self, row: usize, q: &[f64], effects: &[Effect]) -> Vector3<f64> {
        let mut arm = self.real.clone();
        self.twist(&mut arm, row, q, effects);
        let joints = self.driven(row, q, effects);
        let (mut joints, torque) = self.deflected_joints(&arm, row, &joints, effects);
        for effect in effects {
            match *effect {
                Effect::Backlash { joint, play, by_approach: false } => {
                    joints[joint] += 0.5 * play * sign(torque[joint]);
                }
                Effect::Wear { joint, window: [middle, width], play } => {
                    let away = arm::within_a_turn(q[joint] - middle) / width;
                    joints[joint] += 0.5 * play * sign(torque[joint]) * (-away.powi(4)).exp();
                }
                Effect::Friction { joint, per } => {
                    joints[joint] += 0.5 * per * torque[joint].abs() * self.approach(row, joint);
                }
                _ => {}
            }
        }
        let frames = arm::frames(&arm, &self.base, &joints);
        let flange = frames[arm.len()];
        let tip = arm::point(&flange, &self.ball_in_tool(row, &flange, effects))
            + self.rod_deflection(&flange, row, effects);
        let tip = self.tilted(tip, &frames, row, effects);
        self.seen(row, tip, &flange, effects)
    }

    /// The ball in {T}, m.
    fn ball_in_tool(&self, row: usize, flange: &Matrix4<f64>, effects: &[Effect]) -> Vector3<f64> {
        let mut ball = self.tool;
        for effect in effects {
            match effect {
                Effect::ToolShift { from, by } if row >= *from => ball += by,
                Effect::LooseMount(by) => ball.x += by * sign(arm::column(flange, 0).dot(&self.gravity)),
                _ => {}
            }
        }
        ball
    }

    /// The ball on a base that gives way to the moment of all that hangs on it.
    fn tilted(
        &self,
        tip: Vector3<f64>,
        frames: &[Matrix4<f64>],
        row: usize,
        effects: &[Effect],
    ) -> Vector3<f64> {
        let per: f64 = effects.iter().map(|e| if let Effect::BaseTilt(per) = e { *per } else { 0.0 }).sum();
        if per == 0.0 {
            return tip;
        }
        let gravity = self.down(effects);
        let at = arm::column(&frames[0], 3);
        let moment =
            arm::moment(&self.real, frames, &gravity, &self.pulls(&frames[self.real.len()], row, effects));
        let upright = gravity.normalize();
        let level = moment - upright * upright.dot(&moment);
        tip + (level * per).cross(&(tip - at))
    }

    fn twist(&self, arm: &mut Arm, row: usize, q: &[f64], effects: &[Effect]) {
        for effect in effects {
            match *effect {
                Effect::LinkTorsion { link, joints: [a, b], per } => {
                    arm[link].numbers[3] += per * q[a] * q[b];
                }
                Effect::Growth { per, by_time } => {
                    let times = 1.0 + per * self.since(row, by_time);
                    arm.iter_mut().for_each(|link| (1..3).for_each(|k| link.numbers[k] *= times));
                }
                Effect::Runout { joint, by, phase } => {
                    arm[joint].numbers[2] += by * (2.0 * q[joint] + phase).cos();
                }
                _ => {}
            }
        }
    }

    /// The joints behind their gears.
    fn driven(&self, row: usize, q: &[f64], effects: &[Effect]) -> Vec<f64> {
        let mut joints = q.to_vec();
        let before = |joint: usize| self.rows[row.saturating_sub(1)].q[joint];
        for effect in effects {
            match effect {
                Effect::Transmission { joint, waves, beat } => {
                    let angle = q[*joint];
                    let swell = beat.map_or(1.0, |[depth, cycles]| 1.0 + depth * (cycles * angle).cos());
                    let wave =
                        |[cycles, amplitude, phase]: &[f64; 3]| amplitude * (cycles * angle + phase).sin();
                    joints[*joint] += swell * waves.iter().map(wave).sum::<f64>();
                }
                Effect::Backlash { joint, play, by_approach: true } => {
                    joints[*joint] += 0.5 * play * self.approach(row, *joint);
                }
                Effect::EncoderScale { joint, more } => joints[*joint] += more * q[*joint],
                Effect::JointShift { joint, from, by } if row >= *from => joints[*joint] += by,
                Effect::ZeroDrift { joint, per, by_time } => {
                    joints[*joint] += per * self.since(row, *by_time);
                }
                Effect::MoveHistory(share) if row > 1 => {
                    let move_before = |j: usize| self.rows[row - 1].q[j] - self.rows[row - 2].q[j];
                    (0..q.len()).for_each(|j| joints[j] += share * move_before(j));
                }
                Effect::Coupling { from, to, share } => joints[*to] += share * q[*from],
                Effect::Lag { joint, share } => {
                    let lags = |j: usize| row > 0 && joint.is_none_or(|only| only == j);
                    (0..q.len()).filter(|&j| lags(j)).for_each(|j| joints[j] += share * (q[j] - before(j)));
                }
                _ => {}
            }
        }
        joints
    }

    /// Seconds, or kelvins since the first row.
    fn since(&self, row: usize, by_time: bool) -> f64 {
        let at = &self.rows[row];
        if by_time { at.time } else { at.temperature - self.rows[0].temperature }
    }

    /// Direction from which a joint came.
    pub fn approach(&self, row: usize, joint: usize) -> f64 {
        if row == 0 { 0.0 } else { sign(self.rows[row].q[joint] - self.rows[row - 1].q[joint]) }
    }

    /// Joints turned by the torques on them, and those torques.
    pub(super) fn deflected_joints(
        &self,
        arm: &[arm::Link],
        row: usize,
        joints: &[f64],
        effects: &[Effect],
    ) -> (Vec<f64>, Vec<f64>) {
        let (mut turned, mut torque) = (joints.to_vec(), Vec::new());
        let gravity = self.down(effects);
        let turns = |effect: &Effect| matches!(effect, Effect::Compliance { .. } | Effect::Nonlinear { .. });
        let rounds = if self.has_masses || effects.iter().any(turns) { ROUNDS } else { 1 };
        for _ in 0..rounds {
            let frames = arm::frames(arm, &self.base, &turned);
            torque = arm::torques(arm, &frames, &gravity, &self.pulls(&frames[arm.len()], row, effects));
            for (j, tau) in torque.iter().enumerate() {
                // a file without masses goes with an arm that is hardly compliant
                let own = if self.has_masses { arm[j].compliance } else { 0.0 };
                turned[j] =
                    joints[j] + own * tau + effects.iter().map(|effect| more(effect, j, *tau)).sum::<f64>();
            }
        }
        (turned, torque)
    }

    /// Forces beyond the last joint.
    fn pulls(&self, flange: &Matrix4<f64>, row: usize, effects: &[Effect]) -> Vec<Pull> {
        let tip = arm::point(flange, &self.tool);
        let gravity = self.down(effects);
        let weight = |mass: f64, at: &Vector3<f64>| (gravity * mass, arm::point(flange, at));
        let mut pulls = vec![(self.push(row, effects), tip)];
        if let Some(rod) = &self.rod {
            pulls.extend(rod.slices.iter().map(|(mass, at)| weight(*mass, at)));
        }
        pulls.extend(effects.iter().filter_map(|effect| match *effect {
            Effect::Payload(mass) => Some(weight(mass, &Vector3::zeros())),
            Effect::TipMass(mass) => Some((gravity * mass, tip)),
            _ => None,
        }));
        pulls
    }

    /// Contact force in the world, N.
    fn push(&self, row: usize, effects: &[Effect]) -> Vector3<f64> {
        let group = self.rows[row].group;
        let device = self.device(group);
        let is_here = |named: &Option<usize>| named.is_none_or(|only| only == group);
        let mut force = self.contact;
        for effect in effects {
            match effect {
                Effect::Force { group, by } if is_here(group) => force += by,
                Effect::Spring { group, rate } if is_here(group) => force += self.rows[row].aside * *rate,
                _ => {}
            }
        }
        turned(&device, &force)
    }

    /// What the rod gives way, in the world.
    pub fn rod_deflection(&self, flange: &Matrix4<f64>, row: usize, effects: &[Effect]) -> Vector3<f64> {
        let Some(rod) = &self.rod else { return Vector3::zeros() };
        let rotation: Matrix3<f64> = flange.fixed_view::<3, 3>(0, 0).into_owned();
        let (mut force, mut factor) = (self.push(row, effects), 1.0);
        let gravity = self.down(effects);
        for effect in effects {
            match *effect {
                Effect::TipMass(mass) => force += gravity * mass,
                Effect::Rod(more) => factor *= 1.0 + more,
                _ => {}
            }
        }
        let inside =
            rod.per_force * rotation.transpose() * force + rod.per_gravity * rotation.transpose() * gravity;
        rotation * inside * factor
    }

    /// What the fixture and the one who measures make of it.
    fn seen(
        &self,
        row: usize,
        mut tip: Vector3<f64>,
        flange: &Matrix4<f64>,
        effects: &[Effect],
    ) -> Vector3<f64> {
        let at = &self.rows[row];
        tip -= self.clamps_off.get(at.group).copied().unwrap_or_default();
        for effect in effects {
            match effect {
                Effect::ClampPose { group, by, turn } if *group == at.group => {
                    let from = self.device(*group).column(3).xyz();
                    tip -= by + turn.cross(&(tip - from));
                }
                Effect::Shift { group, from, by } if *group == at.group && row >= *from => tip -= by,
                Effect::Drift { by, by_time } => tip += by * self.since(row, *by_time),
                Effect::BaseShift { from, by, turn } if row >= *from => {
                    tip += by + turn.cross(&(tip - arm::column(&self.base, 3)));
                }
                Effect::Outlier(rows) => {
                    tip += rows.iter().filter(|(r, _)| *r == row).map(|(_, by)| by).sum::<Vector3<f64>>();
                }
                Effect::Ball(amplitude) => {
                    let along = turned(&self.device(at.group), &Vector3::new(0.6, 0.0, 0.8));
                    let own = flange.fixed_view::<3, 3>(0, 0).transpose() * along;
                    tip += along * (amplitude * (own.x * own.x - own.y * own.y + 1.5 * own.y * own.z));
                }
                Effect::Disturbance { by, period, phase } => {
                    tip += by * (std::f64::consts::TAU * at.time / period + phase).sin();
                }
                Effect::Refraction(per) => {
                    if let Devices::Tracker(from) = self.devices {
                        tip.z += per * (tip - from).norm_squared();
                    }
                }
                _ => {}
            }
        }
        self.shown(at.group, tip, effects)
    }

    /// What the sensors of a device make of where the ball is.
    fn shown(&self, group: usize, tip: Vector3<f64>, effects: &[Effect]) -> Vector3<f64> {
        let device = self.device(group);
        let rotation: Matrix3<f64> = device.fixed_view::<3, 3>(0, 0).into_owned();
        let displacement = rotation.tr_mul(&(tip - arm::column(&device, 3)));
        let mut shown = tip;
        for effect in effects {
            match effect {
                Effect::Sensor { group: only, shown: axis, along, more }
                    if only.is_none_or(|only| only == group) =>
                {
                    shown += rotation.column(*axis) * (more * displacement[*along]);
                }
                _ => {}
            }
        }
        shown
    }
}

/// How much further a joint turns under load.
fn more(effect: &Effect, at: usize, tau: f64) -> f64 {
    match *effect {
        Effect::Compliance { joint, compliance } if joint == at => compliance * tau,
        Effect::Nonlinear { joint, cubic: true, per } if joint == at => per * tau.powi(3),
        Effect::Nonlinear { joint, per, .. } if joint == at => per * tau * tau.abs(),
        _ => 0.0,
    }
}

fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}
