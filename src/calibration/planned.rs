//! What poses that nobody has measured yet would say of a robot.

use nalgebra::{Matrix3xX, Vector3};

use super::calibrate::start;
use super::campaign::{Campaign, Group, Recording, Row, Station, Targets};
use super::compensation::{Compensation, TORQUE_ROUNDS, largest_torques};
use super::drives;
use super::identifiability::plausible_range;
use super::observability::Observability;
use super::problem::{Pass, Residuals};
use super::shrinkage::Drawing;
use super::start::first_guess;
use crate::error::Result;
use crate::least_squares::Problem as _;
use crate::robot::{Body, Kinematics, Parameter, Setup};
use crate::units::MM;

/// The nominal robot where the campaign's recording puts it, or, without one, where the file says.
///
/// ```
/// use rodcal::calibration::planned_setup;
/// use rodcal::prelude::*;
///
/// let mut campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// campaign.measurements = campaign.measurements.subset(&[]);
/// let setup = planned_setup(&campaign)?; // nothing was recorded: where the file says
/// assert_eq!(setup.base().origin.as_slice(), &campaign.base[..3]);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`start`].
pub fn planned_setup(campaign: &Campaign) -> Result<Setup<'_>> {
    if !campaign.measurements.is_empty() {
        return start(campaign);
    }
    let (base, tool) = first_guess(campaign);
    Ok(Setup::new(&campaign.robot, base, tool))
}

/// How well each free parameter is known before anybody measures, SI: what the drawing (its
/// standard uncertainties times `scale`), the class of the drives and the user say; of base and
/// tool how far a rough start may be off.
///
/// ```
/// use rodcal::calibration::{known_before, planned_setup};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let setup = planned_setup(&campaign)?;
/// let free = [Parameter::A(1), Parameter::Alpha(1)];
/// let known = known_before(&campaign, &setup, &free, None, 1.0);
/// // the robot file states nothing: 1 mm and 0.1°
/// assert!((known[0] - 1e-3).abs() < 1e-12 && (known[1] - 0.1f64.to_radians()).abs() < 1e-12);
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn known_before(
    campaign: &Campaign,
    setup: &Setup,
    free: &[Parameter],
    payload: Option<Body>,
    scale: f64,
) -> Vec<f64> {
    let stated = campaign.not_drawn();
    let mut drawing = Drawing::new(setup, free, &stated);
    drawing.scale = scale;
    let body = payload.unwrap_or(Body { mass: 0.0, centre: setup.tool });
    let torque = largest_torques(setup.robot, setup, body);
    let mut known: Vec<f64> = free.iter().map(|&p| plausible_range(p, &torque)).collect();
    for prior in drawing.priors().chain(drives::priors(setup, free, &stated, payload)) {
        known[prior.parameter] = prior.sd;
    }
    for &(parameter, _, sd) in &campaign.constraints.priors {
        if let Some(index) = free.iter().position(|&p| p == parameter) {
            known[index] = sd;
        }
    }
    known
}

/// Poses with the places where they would be measured.
#[derive(Debug, Clone)]
pub struct Planned<'c> {
    /// The robot.
    setup: Setup<'c>,
    /// The free parameters.
    free: Vec<Parameter>,
    /// As if it had been recorded, every ball where its place is.
    recording: Recording,
    /// Torques and deflections.
    pass: Pass,
}

impl<'c> Planned<'c> {
    /// Poses (the index of their place, joint values in rad or m) at these places, of a robot that
    /// stands as in `setup`, with the loads of `compensation`.
    pub fn new(
        setup: Setup<'c>,
        free: &[Parameter],
        compensation: &Compensation,
        places: &[Group],
        are_unknown: bool,
        poses: &[(usize, Vec<f64>)],
    ) -> Self {
        let row = |(index, (group, _)): (usize, &(usize, Vec<f64>))| Row {
            pose: (index + 1).to_string(),
            line: index + 2,
            group: *group,
            station: 0,
            time: None,
            temperature: None,
        };
        let recording = Recording {
            file: "planned".into(),
            source: None,
            joint_count: setup.robot.joints.len(),
            joint_values: poses.iter().flat_map(|(_, q)| q.iter().copied()).collect(),
            joints_read: None,
            rows: poses.iter().enumerate().map(row).collect(),
            groups: places.to_vec(),
            stations: vec![Station::first("")],
            targets: match are_unknown {
                true => Targets::Sockets(Vec::new()),
                false => {
                    Targets::Points(poses.iter().map(|(group, _)| places[*group].device.origin).collect())
                }
            },
        };
        let mut pass = Pass::at_rest(&recording);
        for _ in 0..TORQUE_ROUNDS {
            compensation.update(&setup, &recording, &mut pass);
        }
        Planned { setup, free: free.to_vec(), recording, pass }
    }

    fn problem(&self) -> Residuals<'_> {
        let setup = self.setup.clone();
        Residuals { setup, free: &self.free, recording: &self.recording, pass: &self.pass, held: &[] }
    }

    /// The poses as a recording.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// ∂(tip − place)/∂unknown of every pose in {W}, m per unit (SI): the free parameters, then the
    /// coordinates of unknown places.
    pub fn rows(&self) -> Vec<Matrix3xX<f64>> {
        let problem = self.problem();
        let mut rows = Vec::with_capacity(self.recording.len());
        problem.jacobian_blocks(&problem.start(), &mut |_, block| {
            let poses = 0..block.nrows() / 3;
            rows.extend(poses.map(|pose| {
                Matrix3xX::from_fn(block.ncols(), |axis, column| block[(3 * pose + axis, column)])
            }));
        });
        rows
    }

    /// What a rod of this compliance (with the loads that belong to it) adds to each tip, in {W},
    /// m.
    pub fn deflections(&self, compensation: &Compensation) -> Vec<Vector3<f64>> {
        compensation.deflections(&self.setup, &self.recording)
    }

    /// How well the poses show the parameters.
    ///
    /// # Errors
    /// As [`crate::linalg::thin_svd`].
    pub fn observability(&self) -> Result<Observability> {
        let problem = self.problem();
        Observability::new(&problem, &problem.start())
    }

    /// The unit that a parameter has in the observability indices, SI.
    pub fn unit(parameter: Parameter) -> f64 {
        Observability::unit(parameter)
    }

    /// ∂tip/∂parameter of base and tool in each pose.
    pub fn placement(&self) -> Vec<Matrix3xX<f64>> {
        let joints = self.recording.joint_count;
        let placed: Vec<Parameter> =
            Parameter::all(joints).into_iter().filter(|p| p.is_placement()).collect();
        let mut kinematics = Kinematics::new(&self.setup);
        let of_row = |row: usize| {
            let torque = self.pass.torque(&self.recording, row);
            kinematics.update(self.recording.joints(row), torque);
            let columns: Vec<_> = placed.iter().map(|&p| kinematics.column(p, torque)).collect();
            Matrix3xX::from_columns(&columns)
        };
        (0..self.recording.len()).map(of_row).collect()
    }
}

/// Where the ball can be held: the campaign's clamps, its sockets where the nominal robot has them,
/// or one place without a name for a tracker, which sees the ball anywhere. With it whether the
/// places are unknown numbers.
///
/// ```
/// use rodcal::calibration::{places, planned_setup};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let (places, are_unknown) = places(&campaign, &planned_setup(&campaign)?);
/// assert_eq!((places.len(), are_unknown), (5, false)); // its clamps, whose frames it states
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`planned_setup`].
pub fn places(campaign: &Campaign, setup: &Setup) -> (Vec<Group>, bool) {
    let recording = &campaign.measurements;
    if !campaign.clamps.is_empty() {
        return (campaign.clamps.clone(), false);
    }
    if matches!(recording.targets, Targets::Points(_)) {
        return (vec![Group::tracked()], false);
    }
    let mut kinematics = Kinematics::new(setup);
    let mut sums = vec![(Vector3::zeros(), 0.0); recording.groups.len()];
    for (row, entry) in recording.rows.iter().enumerate() {
        kinematics.update(recording.joints(row), &[]);
        sums[entry.group].0 += kinematics.tip;
        sums[entry.group].1 += 1.0;
    }
    let place = |(group, (sum, count)): (&Group, (Vector3<f64>, f64))| {
        let mut group = group.clone();
        group.device.origin = sum / f64::max(count, 1.0);
        group
    };
    (recording.groups.iter().zip(sums).map(place).collect(), true)
}

/// How near a place a pose that was recorded there should be brought by the nominal robot, m.
pub const NEAR: f64 = 30.0 * MM;
