//! Residuals of a recording as a least-squares problem, with the deflections and torques of one
//! pass held fixed.
//!
//! ```text
//! rᵢ = (f(ρ, qᵢ, τᵢ) + R·Δxᵢ − xᵢ) · wᵢ    the ball was measured at xᵢ, or is in socket k: xᵢ = sₖ
//! r  = (|s_a − s_b| − D) / σ_D              a known distance between two sockets
//! r  = (vᵀ·(ρ − ρ₀)/range) / σ_v            an unidentified direction, held at its nominal value
//! ```
//!
//! At every station but the first xᵢ is exp([φ]×)·(xᵢ − b) + b + t, with b the first guess of the
//! base's position: what the frame of the station is still wrong by.
//!
//! f is the rigid tip in {W}, R·Δxᵢ the rod's deflection. Δxᵢ is held fixed in {T}: it turns with
//! the robot, so that how the rod bends does not seem to say which way the robot stands. wᵢ is one
//! over the standard deviation of a coordinate. The unknowns are the free parameters, then the
//! three coordinates of every socket, or t and φ of every station but the first.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix3x6, Vector3};

use super::campaign::{Recording, Targets};
use super::identifiability::UnidentifiedDirection;
use crate::least_squares::{Problem, assembled};
use crate::linalg::RowReduction;
use crate::robot::{Kinematics, Parameter, Setup};
use crate::spatial::{Pose, exponential, left_jacobian, skew, times};

/// Poses per block of the Jacobian.
const BLOCK: usize = 128;

/// What a pass of the calibration holds fixed.
#[derive(Debug, Clone)]
pub(super) struct Pass {
    /// Δx in {T} by row, m: deflected less undeflected tip.
    pub deflection: Vec<Vector3<f64>>,
    /// Torque on every joint by row, N·m, one row after the other.
    pub torque: Vec<f64>,
    /// wᵢ by row, 1/m.
    pub weight: Vec<f64>,
}

impl Pass {
    /// Nothing bends, no torque, all rows count the same.
    pub fn at_rest(recording: &Recording) -> Self {
        Pass {
            deflection: vec![Vector3::zeros(); recording.len()],
            torque: vec![0.0; recording.len() * recording.joint_count],
            weight: vec![1.0; recording.len()],
        }
    }

    /// Torque on every joint at a row, N·m.
    pub fn torque(&self, recording: &Recording, row: usize) -> &[f64] {
        &self.torque[row * recording.joint_count..][..recording.joint_count]
    }

    /// Moves to the joint values of a row, joints and rod deflected: the tip is where the ball is.
    pub fn deflect(&self, kinematics: &mut Kinematics, recording: &Recording, row: usize) {
        kinematics.update(recording.joints(row), self.torque(recording, row));
        kinematics.tip += times(&kinematics.flange.rotation, &self.deflection[row]);
    }
}

/// The residuals of `recording`; see the top of the file.
pub(super) struct Residuals<'a> {
    pub setup: Setup<'a>,
    pub free: &'a [Parameter],
    pub recording: &'a Recording,
    pub pass: &'a Pass,
    pub held: &'a [UnidentifiedDirection],
}

impl Residuals<'_> {
    /// Number of unknown sockets.
    pub fn socket_count(&self) -> usize {
        match self.recording.targets {
            Targets::Points(_) => 0,
            Targets::Sockets(_) => self.recording.groups.len(),
        }
    }

    /// Number of stations whose frames are unknown: all but the first.
    pub fn moved_count(&self) -> usize {
        match self.recording.targets {
            Targets::Points(_) => self.recording.stations.len().saturating_sub(1),
            Targets::Sockets(_) => 0,
        }
    }

    /// Unknowns that are no parameters of the robot.
    fn nuisance_count(&self) -> usize {
        3 * self.socket_count() + 6 * self.moved_count()
    }

    /// What brings the points of a station into {W}: the identity for the first.
    pub fn motion(&self, p: &DVector<f64>, station: usize) -> Pose {
        if station == 0 || self.moved_count() == 0 {
            return Pose::IDENTITY;
        }
        let six = &p.as_slice()[self.free.len() + 6 * (station - 1)..][..6];
        let rotation = exponential(&Vector3::from_column_slice(&six[3..]));
        let centre = self.setup.base_guess.origin;
        Pose { rotation, origin: Vector3::from_column_slice(&six[..3]) + centre - rotation * centre }
    }

    /// Free parameters as they are in the setup, then each socket where the tips of its rows are on
    /// average, or no correction of the stations' frames.
    pub fn start(&self) -> DVector<f64> {
        let mut start: Vec<f64> = self.free.iter().map(|&p| self.setup.get(p)).collect();
        let sockets = self.socket_count();
        if sockets > 0 {
            let mut sum = vec![(Vector3::zeros(), 0.0); sockets];
            self.for_each_tip(&self.setup, |row, kinematics| {
                let weight = self.pass.weight[row].powi(2);
                let (total, weights) = &mut sum[self.recording.rows[row].group];
                *total += kinematics.tip * weight;
                *weights += weight;
            });
            start.extend(sum.iter().flat_map(|(total, weights)| {
                let mean: [f64; 3] = (total / weights.max(f64::MIN_POSITIVE)).into();
                mean
            }));
        }
        start.resize(self.free.len() + self.nuisance_count(), 0.0);
        DVector::from_vec(start)
    }

    /// The setup with the free parameters of `p`.
    pub fn setup_at(&self, p: &DVector<f64>) -> Setup<'_> {
        let mut setup = self.setup.clone();
        for (&parameter, &value) in self.free.iter().zip(p.iter()) {
            setup.set(parameter, value);
        }
        setup
    }

    /// Deflected tip less where it was measured or its socket is, in {W}, m: one per row, without
    /// weights.
    pub fn deviations(&self, p: &DVector<f64>) -> Vec<Vector3<f64>> {
        let setup = self.setup_at(p);
        let motions = self.motions(p);
        let mut deviations = Vec::with_capacity(self.recording.len());
        self.for_each_tip(&setup, |row, kinematics| {
            deviations.push(kinematics.tip - self.target(p, row, &motions));
        });
        deviations
    }

    /// [`Residuals::motion`] of every station.
    pub fn motions(&self, p: &DVector<f64>) -> Vec<Pose> {
        (0..self.recording.stations.len()).map(|station| self.motion(p, station)).collect()
    }

    fn target(&self, p: &DVector<f64>, row: usize, motions: &[Pose]) -> Vector3<f64> {
        match &self.recording.targets {
            Targets::Points(points) => match self.recording.rows[row].station {
                0 => points[row],
                station => motions[station].point(&points[row]),
            },
            Targets::Sockets(_) => self.socket(p, self.recording.rows[row].group),
        }
    }

    fn socket(&self, p: &DVector<f64>, group: usize) -> Vector3<f64> {
        Vector3::from_column_slice(&p.as_slice()[self.free.len() + 3 * group..][..3])
    }

    fn for_each_tip(&self, setup: &Setup, mut visit: impl FnMut(usize, &Kinematics)) {
        let mut kinematics = Kinematics::new(setup);
        for row in 0..self.recording.len() {
            self.pass.deflect(&mut kinematics, self.recording, row);
            visit(row, &kinematics);
        }
    }

    fn torque(&self, row: usize) -> &[f64] {
        self.pass.torque(self.recording, row)
    }

    /// The square root of the information about the free parameters: the triangle that is left of
    /// their columns of the Jacobian once those of the sockets are projected out, without what is
    /// held. Blockwise, as the fit.
    pub fn information_root(&self, p: &DVector<f64>) -> DMatrix<f64> {
        let (count, sockets) = (self.free.len(), self.nuisance_count());
        let columns = count + sockets;
        let rows = 3 * self.recording.len() + self.distances().len();
        let mut reduction = RowReduction::new(columns, rows);
        let unheld = Residuals { setup: self.setup.clone(), held: &[], ..*self };
        unheld.jacobian_blocks(p, &mut |_, block| {
            reduction.push(block.nrows(), |range, column, entries| {
                // sockets and stations first
                let source = block.column((column + count) % columns);
                entries.copy_from_slice(&source.as_slice()[range]);
            });
        });
        reduction.triangle().view((sockets, sockets), (count, count)).into_owned()
    }

    /// Unit vector from one socket to another, and their distance, m.
    fn direction(&self, p: &DVector<f64>, between: [usize; 2]) -> (Vector3<f64>, f64) {
        let apart = self.socket(p, between[0]) - self.socket(p, between[1]);
        let distance = apart.norm();
        (apart / distance.max(f64::MIN_POSITIVE), distance)
    }

    /// Rows of the Jacobian for the poses `rows`.
    fn pose_block(&self, setup: &Setup, p: &DVector<f64>, rows: std::ops::Range<usize>) -> DMatrix<f64> {
        let motions = self.motions(p);
        let mut block = DMatrix::zeros(3 * rows.len(), self.parameter_count());
        let mut kinematics = Kinematics::new(setup);
        for (at, row) in rows.enumerate() {
            let (torque, weight) = (self.torque(row), self.pass.weight[row]);
            self.pass.deflect(&mut kinematics, self.recording, row);
            for (k, &parameter) in self.free.iter().enumerate() {
                let column = kinematics.column(parameter, torque) * weight;
                block.fixed_view_mut::<3, 1>(3 * at, k).copy_from(&column);
            }
            if self.socket_count() > 0 {
                let first = self.free.len() + 3 * self.recording.rows[row].group;
                for axis in 0..3 {
                    block[(3 * at + axis, first + axis)] = -weight;
                }
            }
            let station = self.recording.rows[row].station;
            if self.moved_count() > 0 && station > 0 {
                let first = self.free.len() + 6 * (station - 1);
                let columns = self.station_columns(p, station, &self.target(p, row, &motions)) * -weight;
                block.view_mut((3 * at, first), (3, 6)).copy_from(&columns);
            }
        }
        block
    }

    /// ∂target/∂(t, φ) of a station at a target of it, 3 × 6.
    fn station_columns(&self, p: &DVector<f64>, station: usize, target: &Vector3<f64>) -> Matrix3x6<f64> {
        let six = &p.as_slice()[self.free.len() + 6 * (station - 1)..][..6];
        let (t, turn) = (Vector3::from_column_slice(&six[..3]), Vector3::from_column_slice(&six[3..]));
        let arm = target - t - self.setup.base_guess.origin;
        let mut columns = Matrix3x6::zeros();
        columns.fixed_columns_mut::<3>(0).copy_from(&Matrix3::identity());
        columns.fixed_columns_mut::<3>(3).copy_from(&(-skew(&arm) * left_jacobian(&turn)));
        columns
    }

    /// The rows that no pose has: distances, then directions that are held.
    fn last_block(&self, p: &DVector<f64>) -> DMatrix<f64> {
        let distances = self.distances();
        let mut block = DMatrix::zeros(distances.len() + self.held.len(), self.parameter_count());
        for (row, distance) in distances.iter().enumerate() {
            let (direction, _) = self.direction(p, distance.between);
            for (group, sign) in distance.between.into_iter().zip([1.0, -1.0]) {
                let first = self.free.len() + 3 * group;
                for axis in 0..3 {
                    block[(row, first + axis)] = sign * direction[axis] / distance.sd;
                }
            }
        }
        for (at, held) in self.held.iter().enumerate() {
            for (k, slope) in held.slopes().enumerate() {
                block[(distances.len() + at, k)] = slope;
            }
        }
        block
    }

    fn distances(&self) -> &[super::campaign::Distance] {
        match &self.recording.targets {
            Targets::Points(_) => &[],
            Targets::Sockets(distances) => distances,
        }
    }
}

impl Problem for Residuals<'_> {
    fn parameter_count(&self) -> usize {
        self.free.len() + self.nuisance_count()
    }

    fn residual_count(&self) -> usize {
        3 * self.recording.len() + self.distances().len() + self.held.len()
    }

    fn residuals(&self, p: &DVector<f64>) -> DVector<f64> {
        let mut residuals = Vec::with_capacity(self.residual_count());
        for (row, deviation) in self.deviations(p).into_iter().enumerate() {
            residuals.extend_from_slice((deviation * self.pass.weight[row]).as_slice());
        }
        for distance in self.distances() {
            let (_, now) = self.direction(p, distance.between);
            residuals.push((now - distance.value) / distance.sd);
        }
        residuals.extend(self.held.iter().map(|held| held.residual(p.as_slice())));
        DVector::from_vec(residuals)
    }

    fn jacobian(&self, p: &DVector<f64>) -> DMatrix<f64> {
        assembled(self, p)
    }

    fn jacobian_blocks(&self, p: &DVector<f64>, visit: &mut dyn FnMut(usize, &DMatrix<f64>)) {
        let setup = self.setup_at(p);
        let rows = self.recording.len();
        for first in (0..rows).step_by(BLOCK) {
            visit(3 * first, &self.pose_block(&setup, p, first..(first + BLOCK).min(rows)));
        }
        let last = self.last_block(p);
        if last.nrows() > 0 {
            visit(3 * rows, &last);
        }
    }
}
