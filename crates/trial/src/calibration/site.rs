//! A recording as it really happened: the arm, the rod, who measured, and every pose.

mod ball;

use nalgebra::{DVector, Matrix4, Rotation3, Vector3};

use super::arm::{self, Arm, Known};
use super::effect::Effect;
use super::noise::Scatter;
use super::rod::Rod;
use rodcal_base::statistics::Random;

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
    /// Where the ball was to be in its clamp, in that one's frame, m.
    pub aside: Vector3<f64>,
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
    /// How well the numbers of the robot's file are known, and how many times as far off they are.
    pub known: Known,
    pub times: f64,
    /// Gravity in the world, m/s².
    pub gravity: Vector3<f64>,
    /// How well the places of clamps are known, m, where the campaign states it, and by how much
    /// each is off.
    pub clamp_sd: Option<f64>,
    pub clamps_off: Vec<Vector3<f64>>,
    /// Errors of what is read.
    pub scatter: Scatter,
}

impl Site {
    /// Gravity with what is wrong with the base, m/s².
    pub fn down(&self, effects: &[Effect]) -> Vector3<f64> {
        let mut down = self.gravity;
        for effect in effects {
            if let Effect::Level([roll, pitch]) = effect {
                let about = arm::column(&self.base, 0) * *roll + arm::column(&self.base, 1) * *pitch;
                down = Rotation3::from_scaled_axis(about) * down;
            }
        }
        down
    }

    /// The clamp or socket of every row from `first` on.
    fn groups_from(&self, first: usize) -> Vec<usize> {
        self.rows[first..].iter().map(|row| row.group).collect()
    }

    /// Errors of the rows from `first` on, m.
    pub fn errors(&self, first: usize, random: &mut Random) -> Vec<Vector3<f64>> {
        self.scatter.drawn(&self.groups_from(first), random)
    }

    /// Coordinates in noises that know nothing of each other.
    pub fn whitened(&self, v: &DVector<f64>) -> DVector<f64> {
        self.scatter.whitened(&self.groups_from(0), v)
    }

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

    /// Torques on the joints at a row, N·m, frames, and the tip.
    pub fn loads(&self, row: usize) -> (Vec<f64>, Vec<Matrix4<f64>>) {
        let q = &self.rows[row].q;
        let (joints, torque) = self.deflected_joints(&self.real, row, q, &[]);
        (torque, arm::frames(&self.real, &self.base, &joints))
    }

    /// What effects add to every coordinate at the angles that were recorded, m.
    pub fn added(&self, effects: &[Effect], without: &[Effect]) -> DVector<f64> {
        self.each(|row, q| self.ball(row, q, effects) - self.ball(row, q, without))
    }

    /// A displacement for every row, one coordinate after the other.
    pub fn each(&self, displacement: impl Fn(usize, &[f64]) -> Vector3<f64>) -> DVector<f64> {
        let all =
            self.rows.iter().enumerate().flat_map(|(row, at)| <[f64; 3]>::from(displacement(row, &at.q)));
        DVector::from_vec(all.collect())
    }
}

/// How a point moves when the joint whose axis is that of `frame` turns, m/rad.
pub fn tip_jacobian(frame: &Matrix4<f64>, at: &Vector3<f64>) -> Vector3<f64> {
    arm::column(frame, 2).cross(&(at - arm::column(frame, 3)))
}
