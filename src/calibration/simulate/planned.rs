//! Poses that somebody has planned, in place of chosen ones.

use super::plan::CLAMPS;
use crate::delimited::Table;
use crate::error::{Error, Result};
use crate::robot::{Kinematics, Motion, Robot, Setup};
use crate::units::{MM, significant};

/// Farthest from its clamp that the ball may be in a planned pose, m: what a nominal robot misses by, and more.
const NEAR: f64 = 30.0 * MM;

/// The poses of a table (CSV) with the column `clamp` (1 to 5) and joint columns, as `design poses` writes it: index of the clamp
/// and joint values, rad or m.
///
/// # Errors
/// [`Error::Input`] with line and column.
pub fn planned_poses(robot: &Robot, file: &str, text: &str) -> Result<Vec<(usize, Vec<f64>)>> {
    let queries = robot.poses_from_csv(file, text)?;
    let is_joint = |column: &str| {
        robot.joints.iter().zip(1..).any(|(joint, number)| match joint.motion {
            Motion::Revolute => column == format!("q{number}_deg"),
            Motion::Prismatic => column == format!("q{number}_mm"),
        })
    };
    let table = Table::parse(file, text, is_joint)?;
    let clamp = |cells: crate::delimited::Row<'_>| {
        let number = cells.text("clamp").and_then(|id| id.parse::<usize>().ok());
        let index = number.and_then(|number| number.checked_sub(1)).filter(|index| *index < CLAMPS.len());
        let expected = format!("a clamp of the simulation, 1 to {}", CLAMPS.len());
        index.ok_or_else(|| cells.error("clamp", expected, None))
    };
    table.rows().zip(queries).map(|(cells, query)| Ok((clamp(cells)?, query.joints))).collect()
}

/// Refuses poses in which the ball is nowhere near its clamp.
pub(super) fn check(truth: &Setup, poses: &[(usize, Vec<f64>)]) -> Result<()> {
    let mut kinematics = Kinematics::new(truth);
    for (number, (clamp, q)) in (1..).zip(poses) {
        kinematics.update(q, &[]);
        let off = (kinematics.tip - nalgebra::Vector3::from(CLAMPS[*clamp].0)).norm();
        if off > NEAR {
            return Err(Error::NotApplicable {
                what: "simulating these poses".into(),
                why: format!(
                    "in pose {number} the ball is {} mm away from clamp {}",
                    significant(off / MM, 3),
                    clamp + 1
                ),
                hint: "plan poses for a campaign of this simulation and this rod".into(),
            });
        }
    }
    Ok(())
}
