//! Where the calibrated robot will be used: poses that the calibration does not see.

use nalgebra::{DMatrix, DVector, Vector3};

use crate::calibration::campaign::{Campaign, Group, Refit, Targets};
use crate::calibration::{Compensation, Planned, validate};
use crate::error::{Error, Result};
use crate::linalg::thin_svd;
use crate::robot::configurations::{anywhere, is_above_table};
use crate::robot::{Kinematics, Parameter, Setup};
use crate::statistics::Random;
use crate::units::{MM, significant};

/// Poses of a working volume, and random configurations before it counts as out of reach.
const POSES: usize = 100;
const MOST_TRIALS: usize = 200_000;
/// Fewer poses are fitted by base and tool alone.
const FEWEST: usize = 6;
/// The tool there: a short one on the flange's axis, m.
const TOOL: Vector3<f64> = Vector3::new(0.0, 0.0, 0.12);

/// Where the robot will be used.
#[derive(Debug, Clone, PartialEq)]
pub enum Where {
    /// At the poses of the campaign's validation; without one, anywhere.
    Validation,
    /// Poses of a table (CSV): name and text.
    File(String, String),
    /// Tips within a box in {0}, m: from and to.
    Volume([f64; 3], [f64; 3]),
}

/// Unseen poses.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Unseen {
    /// ∂tip/∂parameter, three rows a pose, without what base and tool can take up where they are
    /// aligned anew.
    pub slopes: DMatrix<f64>,
    /// Which poses, as the middle of a sentence.
    pub description: String,
    /// Whether base and tool are aligned anew.
    pub is_aligned: bool,
    /// What base and tool can take up: orthonormal columns.
    taken: Option<DMatrix<f64>>,
}

impl Unseen {
    /// Number of poses.
    pub fn len(&self) -> usize {
        self.slopes.nrows() / 3
    }

    /// True without poses.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Without what base and tool take up.
    pub(super) fn aligned(&self, errors: DVector<f64>) -> DVector<f64> {
        match &self.taken {
            Some(taken) => &errors - taken * taken.tr_mul(&errors),
            None => errors,
        }
    }

    pub(super) fn new(campaign: &Campaign, setup: &Setup, free: &[Parameter], at: &Where) -> Result<Unseen> {
        let robot = &campaign.robot;
        let is_aligned =
            campaign.refit == Refit::BaseTool || matches!(campaign.measurements.targets, Targets::Sockets(_));
        let mut there = setup.clone();
        if is_aligned {
            there.tool = TOOL;
        }
        let is_enough = |count: usize| !is_aligned || count >= FEWEST;
        let measured = campaign
            .validation
            .as_ref()
            .filter(|validation| *at == Where::Validation && is_enough(validation.len()));
        let poses: Vec<Vec<f64>> = match (at, measured) {
            (Where::Validation, Some(validation)) => {
                (0..validation.len()).map(|row| validation.joints(row).to_vec()).collect()
            }
            (Where::File(file, text), _) => {
                robot.poses_from_csv(file, text)?.into_iter().map(|query| query.joints).collect()
            }
            (Where::Volume(from, to), _) => within(&there, Some((from, to)), false)?,
            // an arm that lies on its table has no pose above it
            (Where::Validation, None) => {
                within(&there, None, true).or_else(|_| within(&there, None, false))?
            }
        };
        if !is_enough(poses.len()) {
            return Err(Error::NotApplicable {
                what: "a forecast after an alignment".into(),
                why: format!("there are {} poses for the nine numbers of base and tool", poses.len()),
                hint: format!("state {FEWEST} poses at least, or `validation_refit = \"none\"`"),
            });
        }
        let seen = measured.filter(|validation| matches!(validation.targets, Targets::Points(_)));
        if let (Some(validation), true) = (seen, is_aligned)
            && let Some((base, tool)) = validate(setup, validation, Refit::BaseTool)?.placement
        {
            there = Setup::new(robot, base, tool);
        }
        let description = match (at, measured) {
            (Where::Validation, Some(validation)) => {
                format!("the {} poses of {}", poses.len(), validation.file)
            }
            (Where::File(file, _), _) => format!("the {} poses of {file}", poses.len()),
            (Where::Volume(from, to), _) => {
                let side =
                    |k: usize| format!("{} to {}", significant(from[k] / MM, 4), significant(to[k] / MM, 4));
                format!(
                    "{} poses with the tip at x {}, y {}, z {} mm in {{0}}",
                    poses.len(),
                    side(0),
                    side(1),
                    side(2)
                )
            }
            (Where::Validation, None) => format!("{} poses all over the workspace", poses.len()),
        };
        let place = [Group::tracked()];
        let poses: Vec<(usize, Vec<f64>)> = poses.into_iter().map(|q| (0, q)).collect();
        let planned = Planned::new(there, free, &Compensation::bare(), &place, false, &poses);
        let stacked = |blocks: Vec<nalgebra::Matrix3xX<f64>>| {
            let columns = blocks.first().map_or(0, |block| block.ncols());
            DMatrix::from_fn(3 * blocks.len(), columns, |row, k| blocks[row / 3][(row % 3, k)])
        };
        let mut slopes = stacked(planned.rows());
        let mut taken = None;
        if is_aligned {
            let svd = thin_svd(&stacked(planned.placement()))?;
            let basis = svd.u.columns(0, svd.rank(1e-9)).into_owned();
            // another tool and another fit of the base: those of the calibration do not count
            for (k, _) in free.iter().enumerate().filter(|(_, parameter)| parameter.is_placement()) {
                slopes.column_mut(k).fill(0.0);
            }
            slopes -= &basis * basis.tr_mul(&slopes);
            taken = Some(basis);
        }
        Ok(Unseen { slopes, description, is_aligned, taken })
    }
}

/// Random configurations within the joint limits, and above the height of the base where it stands
/// upright on a table.
fn within(setup: &Setup, volume: Option<(&[f64; 3], &[f64; 3])>, has_table: bool) -> Result<Vec<Vec<f64>>> {
    let mut random = Random::seeded(1, 6);
    let mut kinematics = Kinematics::new(setup);
    let base = setup.base();
    let has_table = has_table && (base.rotation * setup.robot.gravity).normalize().z < -0.9;
    let mut poses = Vec::with_capacity(POSES);
    for _ in 0..MOST_TRIALS {
        let q = anywhere(setup.robot, &mut random);
        kinematics.update(&q, &[]);
        let tip = base.inverse().point(&kinematics.tip);
        let is_inside = volume.is_none_or(|(from, to)| (0..3).all(|k| (from[k]..=to[k]).contains(&tip[k])));
        if is_inside && (!has_table || is_above_table(&kinematics, setup.base_position.z)) {
            poses.push(q);
        }
        if poses.len() == POSES {
            return Ok(poses);
        }
    }
    Err(Error::NotApplicable {
        what: format!("a forecast for {} in this volume", setup.robot.name),
        why: format!("of {MOST_TRIALS} random configurations {} have their tip there", poses.len()),
        hint: "state a volume within the robot's reach, in {0}, or poses with --at".into(),
    })
}
