//! A calibrated campaign as the effects see it.

use nalgebra::{Matrix3, Vector3};

use super::configuration;
use super::configuration::Configuration;
use super::entry::Column;
use super::patterns::{Patterns, pattern};
use super::written_angles::written_steps;
use crate::calibration::campaign::{Campaign, Recording, Targets};
use crate::calibration::{
    Calibration, Carried, Compensation, Mode, Robust, SOFTEST, by_own_weight, plausible_compliances,
    without_tip,
};
use crate::error::Result;
use crate::inference::Pattern;
use crate::robot::{Body, Effect, Motion, Setup};

/// Largest ratio of the squares of what is left to those of the displacements: at this ratio a
/// scale error of 5 % is indistinguishable from scatter of the readings or of the joints.
const MOST_COMMON: f64 = 0.1;

/// A pose whose load is said to pull to the other side: its row and the joint, both from 0.
pub type Side = (usize, usize);

/// All that effects need to know of a campaign and its calibration.
pub struct Context<'a> {
    pub recording: &'a Recording,
    /// The recording whose clock and whose mean temperature count: this one, or the one that came
    /// before.
    pub since: &'a Recording,
    pub configurations: Vec<Configuration>,
    /// Directions that many columns are multiples of.
    pub patterns: Patterns,
    /// What each row counts, relative to the others: mean noise over the noise of its group.
    scale: Vec<f64>,
    /// What whitens each row, beside that: the identity where poses scatter alike along every axis.
    whitens: Vec<Matrix3<f64>>,
    /// The step that the angles of each joint are written in, rad; 0 where none is seen.
    pub written: Vec<f64>,
    /// Pooled noise of a coordinate, m.
    pub noise: f64,
    /// How far each row is off, in noises of its group.
    off: Vec<f64>,
    /// What a first look has left of each row, in {W}, m; before that, what the calibration leaves.
    left: Vec<Vector3<f64>>,
    /// True where a first look has left that.
    is_second_look: bool,
    /// Motion of every joint.
    pub motions: Vec<Motion>,
    /// Does the robot's file have masses? Without them the torques are those of rod and contact
    /// alone.
    pub has_masses: bool,
    /// What the robot's file has of effects already.
    pub effects: &'a [Effect],
    /// C^F of the rod in {T}, m/N; zero for a rigid one.
    pub force_compliance: Matrix3<f64>,
    /// Deflection of the rod by its own weight in {T} per acceleration of gravity, m/(m/s²).
    pub weight_compliance: Matrix3<f64>,
    /// Deflections in {W} by the rod's model, m, by contact force and by gravity; empty without a
    /// rod.
    pub deflection: Vec<[Vector3<f64>; 2]>,
    /// The rod's own weight, without what is at its tip; `None` without a rod.
    pub own_weight: Option<OwnWeight>,
    /// Masses that are modelled at the tip, and at the flange with what hangs on it, kg.
    pub modelled_mass: (f64, f64),
    /// Compliance beyond which the drive of each joint is not of its class, rad/(N·m).
    pub softest: Vec<f64>,
    /// Standard uncertainty of the compliance of each drive, rad/(N·m): see
    /// [`compliance_uncertainty`]; 0 without a calibration.
    pub compliance_uncertainty: Vec<f64>,
    /// Share of `deflection` that the calibration took into account: 1, or 0 where it assumed the
    /// rod rigid.
    pub accounted: f64,
    /// Rows, from 0, after which a first look has seen something move.
    pub moved_after: Vec<usize>,
    /// Rows, and joints, where the load pulls to the other side than the masses of the file say.
    pub turned: Vec<Side>,
    /// What hung on the flange as the robot was calibrated, beside what the campaign says.
    carried: Vec<Carried>,
}

/// What a rod's own weight does.
pub struct OwnWeight {
    /// Deflection by it in {T} per acceleration of gravity, m/(m/s²).
    pub compliance: Matrix3<f64>,
    /// As a body on the flange.
    pub body: Body,
}

impl<'a> Context<'a> {
    /// All rows count alike.
    pub fn new(campaign: &'a Campaign, calibration: &Calibration) -> Result<Self> {
        let recording = &campaign.measurements;
        let steps = steps(recording, &calibration.deviations);
        let determined = calibration.fit.covariance.rank;
        let noise = calibration.noise.estimate(recording, &steps, determined, Robust::Huber)?.pooled;
        let still = Context::still(campaign, calibration.mode, &calibration.setup, &calibration.deflections)?;
        Ok(Context {
            noise,
            compliance_uncertainty: compliance_uncertainty(calibration, &still.softest),
            off: calibration.deviations.iter().map(|deviation| deviation.norm() / noise).collect(),
            left: calibration.deviations.iter().map(|deviation| -deviation).collect(),
            ..still
        })
    }

    /// The same of poses that this whitens, row by row: see `covariance.rs`.
    pub fn whitened(self, whitens: Vec<Matrix3<f64>>) -> Self {
        let off = self.left.iter().zip(&whitens).map(|(left, w)| (w * left).norm() / self.noise).collect();
        Context { patterns: Patterns::new(&self.configurations, &whitens), off, whitens, ..self }
    }

    /// The same where groups scatter by so much, m. Rows are scaled to the geometric mean over all,
    /// so that the probability of a recording is the same density about every robot.
    pub fn scattered(mut self, of_group: &[f64]) -> Self {
        let own: Vec<f64> = self.recording.rows.iter().map(|row| of_group[row.group]).collect();
        let mean = (own.iter().map(|sd| sd.ln()).sum::<f64>() / own.len().max(1) as f64).exp();
        self.scale = own.iter().map(|own| mean / own).collect();
        self.off.iter_mut().zip(&own).for_each(|(off, own)| *off *= self.noise / own);
        self
    }

    /// The same where rows count by weights.
    pub fn weighted(mut self, weights: &[f64]) -> Self {
        for (row, weight) in weights.iter().enumerate() {
            self.scale[row] *= weight.sqrt();
            self.off[row] *= weight.sqrt();
        }
        self
    }

    /// The same where a first look has left so much of each row, m in {W}.
    pub fn left(self, left: &[Vector3<f64>]) -> Self {
        Context { left: left.to_vec(), is_second_look: true, ..self }
    }

    /// The same where a first look has seen something move after these rows.
    pub fn moved_after(self, rows: &[usize]) -> Self {
        Context { moved_after: rows.to_vec(), ..self }
    }

    /// The same where the loads of these rows pull these joints to the other side.
    pub fn turned(mut self, sides: &[Side]) -> Self {
        for &(row, joint) in sides {
            self.configurations[row].torque[joint] *= -1.0;
        }
        Context { turned: sides.to_vec(), ..self }
    }

    /// The same of a robot that was calibrated with these loads on its flange.
    pub fn carrying(self, carried: &[Carried]) -> Self {
        Context { carried: carried.to_vec(), ..self }
    }

    /// Torques on the joints at a row, N·m, what hung on the flange included: by how much the tip
    /// moves as a drive gives way more. Where a wrist carries little else, the load itself tells
    /// how far its drives give way, and so its mass is no better known than that.
    pub fn torque_with_carried(&self, row: usize) -> Vec<f64> {
        let there = &self.configurations[row];
        let mut torque = there.torque.clone();
        for carried in self.carried.iter().filter(|carried| carried.rows.contains(&row)) {
            let moment = (there.flange.rotation * carried.moment).cross(&there.gravity);
            let weight = there.gravity * carried.mass;
            for (j, torque) in torque.iter_mut().enumerate() {
                // zⱼ·((flange − oⱼ) × m·g + R·s × g)
                *torque += there.torque_of(j, &there.flange.origin, &weight) + there.axis[j].dot(&moment);
            }
        }
        torque
    }

    /// Of poses that nobody measured, in a recording that came after that of `campaign`.
    pub fn later(asked: &'a Campaign, mode: Mode, setup: &Setup, campaign: &'a Campaign) -> Result<Self> {
        let deflections = Compensation::new(asked, mode)?.deflections(setup, &asked.measurements);
        Ok(Context { since: &campaign.measurements, ..Context::still(asked, mode, setup, &deflections)? })
    }

    /// Without what only measured points show.
    fn still(
        campaign: &'a Campaign,
        mode: Mode,
        setup: &Setup,
        deflections: &[Vector3<f64>],
    ) -> Result<Self> {
        let used = Compensation::new(campaign, mode)?;
        let recording = &campaign.measurements;
        let softest = plausible_compliances(setup, used.payload);
        let compliance = plausible(setup, &softest);
        let configurations = configuration::all(recording, setup, &compliance, deflections, &used);
        // a rod that was assumed rigid bends as its beam model says
        let (rod, accounted) = match (mode, &campaign.rod) {
            (Mode::None, Some(_)) => (Compensation::new(campaign, Mode::Fea)?.compliance, 0.0),
            _ => (used.compliance, 1.0),
        };
        let deflection = |(row, configuration): (usize, &Configuration)| {
            let force = recording.device(row).rotation * used.contact_force;
            rod.as_ref().map(|rod| {
                let per_g = configuration.gravity / crate::units::STANDARD_GRAVITY;
                [configuration.in_world(&rod.force) * force, configuration.in_world(&rod.gravity) * per_g]
            })
        };
        let own_weight = campaign.rod.as_ref().zip(rod.as_ref()).map(|(file, rod)| OwnWeight {
            compliance: by_own_weight(rod, file) / crate::units::STANDARD_GRAVITY,
            body: without_tip(file),
        });
        let motions: Vec<Motion> = campaign.robot.joints.iter().map(|joint| joint.motion).collect();
        let whitens = vec![Matrix3::identity(); recording.len()];
        Ok(Context {
            recording,
            since: recording,
            scale: vec![1.0; recording.len()],
            written: written_steps(recording, &motions),
            noise: 0.0,
            off: vec![0.0; recording.len()],
            left: vec![Vector3::zeros(); recording.len()],
            is_second_look: false,
            has_masses: campaign.robot.has_masses(),
            effects: &campaign.robot.effects,
            motions,
            force_compliance: rod.as_ref().map_or_else(Matrix3::zeros, |rod| rod.force),
            weight_compliance: rod
                .as_ref()
                .map_or_else(Matrix3::zeros, |rod| rod.gravity / crate::units::STANDARD_GRAVITY),
            deflection: configurations.iter().enumerate().filter_map(deflection).collect(),
            accounted,
            own_weight,
            moved_after: Vec::new(),
            turned: Vec::new(),
            carried: Vec::new(),
            compliance_uncertainty: vec![0.0; softest.len()],
            softest,
            modelled_mass: modelled_mass(campaign),
            patterns: Patterns::new(&configurations, &whitens),
            whitens,
            configurations,
        })
    }

    /// What a displacement in {W} is among the data: whitened, and times what its row counts.
    pub fn counted(&self, row: usize, displacement: &Vector3<f64>) -> Vector3<f64> {
        self.whitens[row] * displacement * self.scale[row]
    }

    /// What a row counts, whitened.
    pub fn scale(&self, row: usize) -> f64 {
        self.scale[row]
    }

    /// What each row counts, as a matrix of what a displacement in {W} is among the data.
    pub fn weights(&self) -> Vec<Matrix3<f64>> {
        self.whitens.iter().zip(&self.scale).map(|(whitens, scale)| whitens * *scale).collect()
    }

    /// A direction at every row, whitened.
    pub fn pattern(&self, direction: impl Fn(usize, &Configuration) -> Vector3<f64>) -> Pattern {
        pattern(&self.configurations, &self.whitens, direction)
    }

    /// A column of a displacement of the tip, m per unit of the parameter, by row.
    pub fn column(&self, displacement: impl Fn(usize, &Configuration) -> Vector3<f64>) -> Column {
        self.part(0..self.configurations.len(), displacement)
    }

    /// One that is zero but for a range of rows.
    pub fn part(
        &self,
        rows: std::ops::Range<usize>,
        displacement: impl Fn(usize, &Configuration) -> Vector3<f64>,
    ) -> Column {
        let first = 3 * rows.start;
        let at = |row: usize| {
            let counted: [f64; 3] = self.counted(row, &displacement(row, &self.configurations[row])).into();
            counted
        };
        Column::new(first, rows.flat_map(at).collect(), None)
    }

    /// A column of a displacement along one of the patterns, by row.
    pub fn along(&self, pattern: &Pattern, weight: impl Fn(usize, &Configuration) -> f64) -> Column {
        self.along_from(pattern, 0, weight)
    }

    /// One that is zero before a row.
    fn along_from(
        &self,
        pattern: &Pattern,
        first: usize,
        weight: impl Fn(usize, &Configuration) -> f64,
    ) -> Column {
        let at = |row: usize| weight(row, &self.configurations[row]) * self.scale[row];
        let values = (first..self.configurations.len()).map(at).collect();
        Column::new(first, values, Some(pattern.clone()))
    }

    /// A turn of a joint by so much at each row, rad per unit of the parameter.
    pub fn turn(&self, joint: usize, angle: impl Fn(usize, &Configuration) -> f64) -> Column {
        self.turn_from(joint, 0, angle)
    }

    /// The same from a row on.
    pub fn turn_from(
        &self,
        joint: usize,
        first: usize,
        angle: impl Fn(usize, &Configuration) -> f64,
    ) -> Column {
        self.along_from(&self.patterns.joint[joint], first, angle)
    }

    /// The displacement of the ball in the frame of its device, m; none of poses that nobody
    /// measured.
    ///
    /// Half way from the recorded one to the predicted one. A column of the recorded one would have
    /// the error of the reading in common with the residual, ε²/(u² + ε²), 2 % of 0.15 mm, shows as
    /// a scale; one of the predicted one has the joints' in common with it, the other way round.
    pub fn displacement(&self, row: usize) -> Vector3<f64> {
        match &self.recording.targets {
            Targets::Points(points) => points
                .get(row)
                .map(|point| self.recording.device(row).inverse().point(&(point - 0.5 * self.left[row])))
                .unwrap_or_default(),
            Targets::Sockets(_) => Vector3::zeros(),
        }
    }

    /// True where clamps show displacements that vary by more than the scatter: otherwise the true
    /// displacement is unknown, and so is every effect in proportion to it.
    pub fn shows_displacements(&self) -> bool {
        if self.has_sockets() || self.is_tracked() {
            return false;
        }
        let rows = 0..self.configurations.len();
        let shown: Vec<Vector3<f64>> = rows.map(|row| self.displacement(row)).collect();
        let mean = shown.iter().sum::<Vector3<f64>>() / shown.len().max(1) as f64;
        let square: f64 = shown.iter().map(|shown| (shown - mean).norm_squared()).sum();
        let scatter: f64 = self.left.iter().map(|left| left.norm_squared()).sum();
        !self.is_second_look || scatter < MOST_COMMON * square
    }

    /// What a first look has left of each row, m in {W}; `None` before that.
    pub fn left_of_rows(&self) -> Option<&[Vector3<f64>]> {
        self.is_second_look.then_some(&self.left[..])
    }

    /// How far a row is off, in noises of its group.
    pub fn deviation(&self, row: usize) -> f64 {
        self.off[row]
    }

    pub fn joint_count(&self) -> usize {
        self.motions.len()
    }

    /// Joints that turn.
    pub fn revolute(&self) -> Vec<usize> {
        (0..self.joint_count()).filter(|&j| self.motions[j] == Motion::Revolute).collect()
    }

    /// Least and greatest value of a joint, rad or m.
    pub fn range(&self, joint: usize) -> (f64, f64) {
        let values = self.configurations.iter().map(|configuration| configuration.joints[joint]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
    }

    /// Largest size of a number over all rows.
    pub fn largest(&self, number: impl Fn(&Configuration) -> f64) -> f64 {
        let sizes = self.configurations.iter().map(|configuration| number(configuration).abs());
        sizes.fold(0.0, f64::max)
    }

    pub fn has_sockets(&self) -> bool {
        matches!(self.recording.targets, Targets::Sockets(_))
    }

    /// True where one device, such as a laser tracker, has seen the ball wherever it was.
    pub fn is_tracked(&self) -> bool {
        !self.has_sockets() && self.recording.groups.iter().all(|group| group.name.is_tracked())
    }

    /// `pose 7`, with its clamp or socket where several poses have that name.
    pub fn pose_name(&self, row: usize) -> String {
        let own = &self.recording.rows[row].pose;
        let is_unique = self.recording.rows.iter().filter(|other| &other.pose == own).count() == 1;
        match is_unique {
            true => format!("pose {own}"),
            false => format!("pose {}", self.recording.pose_name(row)),
        }
    }
}

fn modelled_mass(campaign: &Campaign) -> (f64, f64) {
    let last = campaign.robot.joints.last().and_then(|joint| joint.body).map_or(0.0, |body| body.mass);
    let rod = campaign.rod.as_ref();
    (rod.map_or(0.0, |rod| rod.tip_mass), last + rod.map_or(0.0, |rod| rod.mass()))
}

/// Compliances as effects use them: a drive that a calibration has made softer than drives of its
/// class are, in place of something else, would spoil them.
pub fn plausible(setup: &Setup, softest: &[f64]) -> Vec<f64> {
    setup.compliance.iter().zip(softest).map(|(own, softest)| own.clamp(0.0, softest.max(0.0))).collect()
}

/// How well the compliance of each drive is known, rad/(N·m): as a calibration has found it, or,
/// where nothing loads it in the robot's file, as a drive of its class usually is. One that the
/// file states and nobody calibrated is known.
fn compliance_uncertainty(calibration: &Calibration, softest: &[f64]) -> Vec<f64> {
    let of_joint = |(joint, softest): (usize, &f64)| {
        let usual = softest.max(0.0) / SOFTEST;
        let own = calibration.parameters.iter().find(|own| own.parameter.compliant_joint() == Some(joint));
        match own {
            Some(own) => own.std_error.map_or(usual, |error| error.min(usual)),
            None if calibration.setup.compliance[joint] == 0.0 => usual,
            None => 0.0,
        }
    };
    softest.iter().enumerate().map(of_joint).collect()
}

/// Differences of neighbours in each clamp or socket, over √2: as large as noise alone, whatever
/// else a clamp is off by. With the median of their lengths neither a pose that was misread nor a
/// clamp that moved makes all its poses count less.
fn steps(recording: &Recording, deviations: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let mut steps = deviations.to_vec();
    for group in 0..recording.groups.len() {
        let rows: Vec<usize> =
            (0..recording.len()).filter(|&row| recording.rows[row].group == group).collect();
        for pair in rows.windows(2) {
            steps[pair[1]] = (deviations[pair[1]] - deviations[pair[0]]) / 2.0f64.sqrt();
        }
        if let [first, second, ..] = rows[..] {
            steps[first] = steps[second];
        }
    }
    steps
}
