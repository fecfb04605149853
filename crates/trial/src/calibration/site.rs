//! A recording as it really happened: the arm, the rod, who measured, and every pose.

use nalgebra::{DVector, Matrix3, Matrix4, Vector3};

use super::arm::{self, Arm, Pull, turned};
use super::effect::Effect;
use super::rod::Rod;
use rodcal_base::units::STANDARD_GRAVITY;

/// Times that torques and the joints that they turn are computed from each other.
const ROUNDS: usize = 3;

/// How the ball was measured.
#[derive(Debug, Clone, PartialEq)]
pub enum Devices {
    /// Displacements in the frames of clamps.
    Clamps(Vec<Matrix4<f64>>),
    /// Positions in the world; where the tracker stands.
    Tracker(Vector3<f64>),
    /// Placement, socket, where it is; the distance of sockets 0 and 1, m.
    Sockets(Vec<(usize, usize, Vector3<f64>)>, f64),
}

/// One pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Joint angles as recorded, rad.
    pub q: Vec<f64>,
    /// Clamp or socket.
    pub group: usize,
    /// Time, s, and temperature, °C.
    pub time: f64,
    pub temperature: f64,
}

/// Everything.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// As its file says, and as it is.
    pub nominal: Arm,
    pub real: Arm,
    /// For people.
    pub arm_name: &'static str,
    /// {0} in the world.
    pub base: Matrix4<f64>,
    /// The ball in {T}, by the drawing and really, m.
    pub drawn_tool: Vector3<f64>,
    pub tool: Vector3<f64>,
    /// True where the robot's file has masses.
    pub has_masses: bool,
    pub rod: Option<Rod>,
    pub devices: Devices,
    /// On the ball, in the frame of the clamp, N.
    pub contact: Vector3<f64>,
    pub rows: Vec<Row>,
    /// Columns of the file.
    pub has_time: bool,
    pub has_temperature: bool,
    /// Standard deviation of a coordinate, m; degrees of freedom of Student's t.
    pub noise: f64,
    pub shape: Option<u32>,
}

impl Site {
    pub fn has_sockets(&self) -> bool {
        matches!(self.devices, Devices::Sockets(..))
    }

    /// Frame of a clamp; the world's where there is none.
    pub fn device(&self, group: usize) -> Matrix4<f64> {
        match &self.devices {
            Devices::Clamps(clamps) => clamps[group],
            _ => Matrix4::identity(),
        }
    }

    /// Name of a clamp or a socket.
    pub fn group_name(&self, group: usize) -> String {
        match &self.devices {
            Devices::Clamps(_) => format!("clamp {}", group + 1),
            Devices::Tracker(_) => String::new(),
            Devices::Sockets(sockets, _) => format!("p{}/{}", sockets[group].0 + 1, sockets[group].1),
        }
    }

    pub fn groups(&self) -> usize {
        match &self.devices {
            Devices::Clamps(clamps) => clamps.len(),
            Devices::Tracker(_) => 1,
            Devices::Sockets(sockets, _) => sockets.len(),
        }
    }

    /// Where the ball is, as the fixture and its file would have it: position in the world, m.
    pub fn ball(&self, row: usize, q: &[f64], effects: &[Effect]) -> Vector3<f64> {
        let mut arm = self.real.clone();
        self.twist(&mut arm, q, effects);
        let joints = self.driven(row, q, effects);
        let (yielded, torque) = self.yielded(&arm, row, &joints, effects);
        let mut joints = yielded;
        for effect in effects {
            match *effect {
                Effect::Backlash { joint, play, by_approach: false } => {
                    joints[joint] += 0.5 * play * sign(torque[joint]);
                }
                Effect::Wear { joint, window: [middle, width], play } => {
                    let away = arm::within_a_turn(q[joint] - middle) / width;
                    joints[joint] += 0.5 * play * sign(torque[joint]) * (-away.powi(4)).exp();
                }
                _ => {}
            }
        }
        let flange = self.flange(&arm, &joints);
        let tip = arm::point(&flange, &self.tool) + self.bent(&flange, row, effects);
        self.seen(row, tip, &flange, effects)
    }

    fn flange(&self, arm: &[arm::Link], joints: &[f64]) -> Matrix4<f64> {
        arm::frames(arm, &self.base, joints).pop().unwrap_or(self.base)
    }

    fn twist(&self, arm: &mut Arm, q: &[f64], effects: &[Effect]) {
        for effect in effects {
            if let Effect::LinkTorsion { link, joints: [a, b], per } = *effect {
                arm[link].numbers[3] += per * q[a] * q[b];
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
                Effect::EncoderScale { joint, factor } => joints[*joint] += (factor - 1.0) * q[*joint],
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

    /// Direction from which a joint came.
    pub fn approach(&self, row: usize, joint: usize) -> f64 {
        if row == 0 { 0.0 } else { sign(self.rows[row].q[joint] - self.rows[row - 1].q[joint]) }
    }

    /// Joints turned by the torques on them, and those torques.
    fn yielded(
        &self,
        arm: &[arm::Link],
        row: usize,
        joints: &[f64],
        effects: &[Effect],
    ) -> (Vec<f64>, Vec<f64>) {
        let (mut turned, mut torque) = (joints.to_vec(), Vec::new());
        let turns = |effect: &Effect| matches!(effect, Effect::Compliance { .. } | Effect::Nonlinear { .. });
        let rounds = if self.has_masses || effects.iter().any(turns) { ROUNDS } else { 1 };
        for _ in 0..rounds {
            let frames = arm::frames(arm, &self.base, &turned);
            torque = arm::torques(arm, &frames, &gravity(), &self.pulls(&frames[arm.len()], row, effects));
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
        let weight = |mass: f64, at: &Vector3<f64>| (gravity() * mass, arm::point(flange, at));
        let mut pulls = vec![(self.push(row), tip)];
        if let Some(rod) = &self.rod {
            pulls.extend(rod.slices.iter().map(|(mass, at)| weight(*mass, at)));
        }
        pulls.extend(effects.iter().filter_map(|effect| match *effect {
            Effect::Payload(mass) => Some(weight(mass, &Vector3::zeros())),
            Effect::TipMass(mass) => Some((gravity() * mass, tip)),
            _ => None,
        }));
        pulls
    }

    /// Contact force in the world, N.
    fn push(&self, row: usize) -> Vector3<f64> {
        turned(&self.device(self.rows[row].group), &self.contact)
    }

    /// What the rod gives way, in the world.
    pub fn bent(&self, flange: &Matrix4<f64>, row: usize, effects: &[Effect]) -> Vector3<f64> {
        let Some(rod) = &self.rod else { return Vector3::zeros() };
        let rotation: Matrix3<f64> = flange.fixed_view::<3, 3>(0, 0).into_owned();
        let (mut force, mut factor) = (self.push(row), 1.0);
        for effect in effects {
            match *effect {
                Effect::TipMass(mass) => force += gravity() * mass,
                Effect::Rod(by) => factor *= by,
                _ => {}
            }
        }
        let inside =
            rod.per_force * rotation.transpose() * force + rod.per_gravity * rotation.transpose() * gravity();
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
        for effect in effects {
            match effect {
                Effect::ClampPose { group, by, turn } if *group == at.group => {
                    let from = self.device(*group).column(3).xyz();
                    tip -= by + turn.cross(&(tip - from));
                }
                Effect::Shift { group, from, by } if *group == at.group && row >= *from => tip -= by,
                Effect::Drift { by, by_time: true } => tip += by * at.time,
                Effect::Drift { by, .. } => tip += by * (at.temperature - self.rows[0].temperature),
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
        tip
    }

    /// Torques on the joints at a row, N·m, frames, and the tip.
    pub fn loads(&self, row: usize) -> (Vec<f64>, Vec<Matrix4<f64>>) {
        let q = &self.rows[row].q;
        let (joints, torque) = self.yielded(&self.real, row, q, &[]);
        (torque, arm::frames(&self.real, &self.base, &joints))
    }

    /// What effects add to every coordinate at the angles that were recorded, m.
    pub fn added(&self, effects: &[Effect], without: &[Effect]) -> DVector<f64> {
        self.each(|row, q| self.ball(row, q, effects) - self.ball(row, q, without))
    }

    /// A displacement for every row, one coordinate after the other.
    pub fn each(&self, of: impl Fn(usize, &[f64]) -> Vector3<f64>) -> DVector<f64> {
        let all = self.rows.iter().enumerate().flat_map(|(row, at)| <[f64; 3]>::from(of(row, &at.q)));
        DVector::from_vec(all.collect())
    }

    /// Turns the joints of a row, as little as may be, until the ball is at a point; `None` where it does not get there.
    pub fn reach(
        &self,
        row: usize,
        q: &[f64],
        target: &Vector3<f64>,
        effects: &[Effect],
    ) -> Option<Vec<f64>> {
        let mut q = q.to_vec();
        for _ in 0..40 {
            let at = self.ball(row, &q, effects);
            let off = target - at;
            if off.norm() < 1e-10 {
                return Some(q);
            }
            // what joints do by their loads and gears is too little to lead astray
            let frames = arm::frames(&self.real, &self.base, &q);
            let levers: Vec<Vector3<f64>> = frames[..q.len()].iter().map(|joint| lever(joint, &at)).collect();
            let square: Matrix3<f64> = levers.iter().map(|lever| lever * lever.transpose()).sum();
            let stride = off * (0.4 / off.norm()).min(1.0);
            let solved = (square + Matrix3::identity() * 1e-9).cholesky()?.solve(&stride);
            for (q, lever) in q.iter_mut().zip(&levers) {
                *q += lever.dot(&solved).clamp(-0.5, 0.5);
            }
        }
        None
    }
}

/// How a point moves when the joint whose axis is that of `frame` turns, m/rad.
pub fn lever(frame: &Matrix4<f64>, at: &Vector3<f64>) -> Vector3<f64> {
    arm::column(frame, 2).cross(&(at - arm::column(frame, 3)))
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

/// In the world.
pub fn gravity() -> Vector3<f64> {
    Vector3::new(0.0, 0.0, -STANDARD_GRAVITY)
}
