//! Where a calibrated robot's tip is, at any joint values, and the file that they come from.

use nalgebra::{DMatrix, Matrix3xX, Vector3};

use super::{Effect, Kinematics, Loads, Parameter, Robot, RobotLaw, Setup, joint_value};
use crate::delimited::Table;
use crate::error::{Error, Place, Result};
use crate::rod::constants::covariance;
use crate::spatial::Pose;
use crate::units::STANDARD_GRAVITY;

/// Times that torques and the joints that they turn are computed from each other.
const ROUNDS: usize = 3;

/// A pose to predict.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PredictionQuery {
    /// Its name.
    pub pose: String,
    /// Joint values, rad or m.
    pub joints: Vec<f64>,
}

impl PredictionQuery {
    /// A pose by its name and its joint values, rad or m.
    pub fn new(pose: impl Into<String>, joints: Vec<f64>) -> PredictionQuery {
        PredictionQuery { pose: pose.into(), joints }
    }
}

/// A predicted tip.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct PredictedTip {
    /// In {0}, m.
    pub tip: Vector3<f64>,
    /// ∂tip/∂parameter of the parameters whose uncertainty the file states, SI.
    pub slopes: Option<Matrix3xX<f64>>,
    /// ∂tip/∂constant of the laws, in the order of [`Robot::law_covariance`].
    pub law_slopes: Matrix3xX<f64>,
    /// ∂tip/∂(base and tool), which a user may align anew.
    pub placement: Matrix3xX<f64>,
    /// ∂tip/∂q, m/rad or m/m.
    pub joints: Matrix3xX<f64>,
    /// Laws of the file beyond what was recorded: number, and its variable in its unit.
    pub laws_beyond: Vec<(usize, f64)>,
}

impl Robot {
    /// The tip at `tool` (m, in {T}), in {0}, m: joints deflect under the robot's own weight, the
    /// tool is rigid. With it the standard deviation of each coordinate, m, where the robot's file
    /// says what it takes: √(sd² + diag J·Σ·Jᵀ), sd the error of poses that were held out and Σ the
    /// covariance of the parameters and of the laws' constants.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// // 2 kg at 0.5 m on a joint of 10 µrad/(N·m) whose axis is horizontal: it sags by 98 µrad
    /// let link = Hayati { a: 0.5, ..Hayati::default() };
    /// let mut joint = Joint::new("shoulder", Motion::Revolute, link);
    /// joint.body = Some(rodcal::robot::Body { mass: 2.0, centre: [0.0; 3].into() });
    /// joint.compliance = 10e-6;
    /// let mut arm = Robot::new("arm", vec![joint]);
    /// arm.gravity = [0.0, -9.80665, 0.0].into();
    /// let (tip, sd) = arm.tip_at([0.0; 3].into(), &[0.0]);
    /// assert!((tip.y + 0.5 * 98.0665e-6).abs() < 1e-11 && sd.is_none());
    /// ```
    pub fn tip_at(&self, tool: Vector3<f64>, q: &[f64]) -> (Vector3<f64>, Option<Vector3<f64>>) {
        let predicted = self.predicted_at(tool, q);
        let sd = self.tip.and_then(|tip| tip.sd).map(|sd| {
            let own = predicted.slopes.as_ref().zip(self.uncertainty.as_ref());
            let variance = own.map_or_else(Vector3::zeros, |(slopes, known)| {
                (slopes * &known.covariance * slopes.transpose()).diagonal()
            });
            let of_laws = &predicted.law_slopes * self.law_covariance() * predicted.law_slopes.transpose();
            let variance = variance + of_laws.diagonal();
            variance.map(|own| (sd * sd + own).sqrt())
        });
        (predicted.tip, sd)
    }

    /// The tip as for [`Robot::tip_at`], and how it moves with what is uncertain.
    pub fn predicted_at(&self, tool: Vector3<f64>, q: &[f64]) -> PredictedTip {
        let setup = Setup::new(self, Pose::IDENTITY, tool);
        let mut kinematics = Kinematics::new(&setup);
        let torque = self.settle(&mut kinematics, q);
        let column = |&parameter: &Parameter| kinematics.column(parameter, &torque);
        let slopes = self.uncertainty.as_ref().filter(|known| !known.parameters.is_empty());
        let slopes = slopes
            .map(|known| Matrix3xX::from_columns(&known.parameters.iter().map(column).collect::<Vec<_>>()));
        let placement: Vec<Parameter> =
            Parameter::all(self.joints.len()).into_iter().filter(|p| p.is_placement()).collect();
        let placement = Matrix3xX::from_columns(&placement.iter().map(column).collect::<Vec<_>>());
        let jacobian: Vec<_> = (0..self.joints.len()).map(|j| kinematics.joint_jacobian(j)).collect();
        let joints = Matrix3xX::from_columns(&jacobian);
        let weight = kinematics.flange.rotation.transpose() * (self.gravity / STANDARD_GRAVITY);
        let beyond = |(k, law): (usize, &RobotLaw)| {
            let x = law.variable.value(q, &torque, weight.as_slice())? / law.variable.unit().1;
            law.is_beyond(x).then_some((k, x))
        };
        let laws_beyond = self.laws.iter().enumerate().filter_map(beyond).collect();
        let law_slopes = self.law_slopes(tool, q);
        PredictedTip { tip: kinematics.tip, slopes, law_slopes, placement, joints, laws_beyond }
    }

    /// The tip alone.
    fn tip_of(&self, tool: Vector3<f64>, q: &[f64]) -> Vector3<f64> {
        let setup = Setup::new(self, Pose::IDENTITY, tool);
        let mut kinematics = Kinematics::new(&setup);
        self.settle(&mut kinematics, q);
        kinematics.tip
    }

    /// Joints and the torques that turn them; the torques.
    fn settle(&self, kinematics: &mut Kinematics, q: &[f64]) -> Vec<f64> {
        let mut torque = vec![0.0; self.joints.len()];
        let loads = Loads { gravity: self.gravity, payload: None, tip_force: Vector3::zeros() };
        for _ in 0..ROUNDS {
            kinematics.update(q, &torque);
            kinematics.torques(&loads, &mut torque);
        }
        kinematics.update(q, &torque);
        kinematics.tip += kinematics.structural_deflection(&loads);
        torque
    }

    /// Central differences over ±u of each constant that has one.
    fn law_slopes(&self, tool: Vector3<f64>, q: &[f64]) -> Matrix3xX<f64> {
        let constants = self.uncertain_constants();
        if constants.is_empty() {
            return Matrix3xX::zeros(0);
        }
        let mut robot = self.clone();
        let slope = |&(law, k): &(usize, usize)| {
            let own = &self.laws[law].constants[k];
            let mut at = |value: f64| {
                robot.laws[law].constants[k].value = value;
                robot.tip_of(tool, q)
            };
            let u = own.standard_uncertainty;
            let difference = at(own.value + u) - at(own.value - u);
            at(own.value);
            difference / (2.0 * u)
        };
        Matrix3xX::from_columns(&constants.iter().map(slope).collect::<Vec<Vector3<f64>>>())
    }

    /// Covariance of the constants of laws that have an uncertainty, law after law; laws are
    /// independent of each other. What follows the way that a joint came is in its values.
    pub fn law_covariance(&self) -> DMatrix<f64> {
        let constants = self.uncertain_constants();
        let by_law: Vec<DMatrix<f64>> = self.laws.iter().map(|law| covariance(&law.constants)).collect();
        let entry = |i: usize, j: usize| {
            let ((law, k), (other, l)) = (constants[i], constants[j]);
            if law == other { by_law[law][(k, l)] } else { 0.0 }
        };
        DMatrix::from_fn(constants.len(), constants.len(), entry)
    }

    /// Law and number of each.
    fn uncertain_constants(&self) -> Vec<(usize, usize)> {
        let of_law = |(law, own): (usize, &RobotLaw)| {
            let is_uncertain = |k: &usize| own.constants[*k].standard_uncertainty > 0.0 && !own.is_sided();
            (0..own.constants.len()).filter(is_uncertain).map(|k| (law, k)).collect::<Vec<_>>()
        };
        self.laws.iter().enumerate().flat_map(of_law).collect()
    }

    /// Root mean square of what the effects of each joint's own angle add over its calibrated
    /// range, rad: what they add beyond it nobody has seen. Zeros where no range is known.
    pub fn effect_sizes(&self) -> Vec<f64> {
        const STEPS: usize = 400;
        let Some(calibrated) = &self.calibrated else { return vec![0.0; self.joints.len()] };
        let size = |(joint, &(low, high)): (usize, &(f64, f64))| {
            let own: Vec<&Effect> = self
                .effects
                .iter()
                .filter(|effect| effect.joint() == Some(joint) && effect.is_of_own_angle())
                .collect();
            let mut q = vec![0.0; self.joints.len()];
            let mut square = |k: usize| {
                q[joint] = low + (high - low) * k as f64 / STEPS as f64;
                own.iter().map(|effect| effect.turn(&q, &[])).sum::<f64>().powi(2)
            };
            ((0..=STEPS).map(&mut square).sum::<f64>() / (STEPS + 1) as f64).sqrt()
        };
        calibrated.joints.iter().enumerate().map(size).collect()
    }

    /// Poses of a table (CSV) with the columns `pose`, `q1_deg` … (`q1_mm` of a prismatic joint).
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let slide = Joint::new("slide", Motion::Prismatic, Hayati::default());
    /// let robot = Robot::new("gantry", vec![slide]);
    /// let poses = robot.poses_from_csv("poses.csv", "pose,q1_mm\nhome,250\n")?;
    /// assert_eq!((poses[0].pose.as_str(), poses[0].joints[0]), ("home", 0.25));
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::Input`] with line and column.
    pub fn poses_from_csv(&self, file: &str, text: &str) -> Result<Vec<PredictionQuery>> {
        let columns: Vec<(String, f64)> =
            self.joints.iter().zip(1..).map(|(joint, number)| joint.column(number)).collect();
        let table = Table::parse(file, text, |name| columns.iter().any(|(column, _)| column == name))?;
        let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
        if let Some(name) = names.iter().copied().find(|name| !table.has(name)) {
            let (first, last) = (names.first().unwrap_or(&""), names.last().unwrap_or(&""));
            let columns = if names.len() > 12 { format!("{first} … {last}") } else { names.join(", ") };
            let expected = format!("pose, {columns}: one column for each joint of {}", self.name);
            let (found, hint) = (format!("there is no column {name}"), table.columns_found());
            return Err(table.header_error(name, found, expected, Some(hint)));
        }
        let pose = |(at, row): (usize, crate::delimited::Row<'_>)| {
            let joints = columns.iter().map(|(name, unit)| Ok(joint_value(row, name)? * unit));
            let name = row.text("pose").map_or_else(|| (at + 1).to_string(), str::to_owned);
            Ok(PredictionQuery { pose: name, joints: joints.collect::<Result<_>>()? })
        };
        let mut poses: Vec<PredictionQuery> = table.rows().enumerate().map(pose).collect::<Result<_>>()?;
        let values: Vec<f64> = poses.iter().flat_map(|pose| pose.joints.iter().copied()).collect();
        let moved = self.after_moves(&values);
        for (pose, moved) in poses.iter_mut().zip(moved.chunks(self.joints.len())) {
            pose.joints = moved.to_vec();
        }
        match poses.is_empty() {
            false => Ok(poses),
            true => Err(Error::Input {
                at: Place::whole_file(file),
                found: "there are no rows under the header".into(),
                expected: "at least one pose".into(),
                hint: None,
            }),
        }
    }
}
