//! Poses that somebody has planned, in place of chosen ones.

use nalgebra::Vector3;

use super::plan::{AIM, CLAMPS, Plan};
use crate::calibration::campaign::Group;
use crate::delimited::Table;
use crate::error::{Error, Result};
use crate::robot::configurations::{bring_to, has_arrived};
use crate::robot::{Kinematics, Robot, Setup};
use crate::statistics::Random;
use crate::units::{MM, significant};

/// Farthest from its clamp that the ball may be in a planned pose, m: what a nominal robot misses
/// by, and more.
const NEAR: f64 = 30.0 * MM;

/// The poses of a table (CSV) with the column `clamp` (1 to 5) and joint columns, as `design poses`
/// writes it: index of the clamp and joint values, rad or m.
///
/// ```
/// use rodcal::calibration::simulate::planned_poses;
/// use rodcal::prelude::*;
///
/// let joint = Joint::new("one", Motion::Revolute, Hayati::default());
/// let robot = Robot::new("arm", vec![joint]);
/// let poses = planned_poses(&robot, "poses.csv", "pose,clamp,q1_deg\n1,2,90\n")?;
/// assert_eq!(poses, [(1, vec![90f64.to_radians()])]);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::Input`] with line and column.
pub fn planned_poses(robot: &Robot, file: &str, text: &str) -> Result<Vec<(usize, Vec<f64>)>> {
    let queries = robot.poses_from_csv(file, text)?;
    let is_joint =
        |column: &str| robot.joints.iter().zip(1..).any(|(joint, number)| joint.column(number).0 == column);
    let table = Table::parse(file, text, is_joint)?;
    let clamp = |cells: crate::delimited::Row<'_>| {
        let number = cells.text("clamp").and_then(|id| id.parse::<usize>().ok());
        let index = number.and_then(|number| number.checked_sub(1)).filter(|index| *index < CLAMPS.len());
        let expected = format!("a clamp of the simulation, 1 to {}", CLAMPS.len());
        index.ok_or_else(|| cells.error("clamp", expected, None))
    };
    table.rows().zip(queries).map(|(cells, query)| Ok((clamp(cells)?, query.joints))).collect()
}

/// The poses as the true robot takes them: the ball is brought from where it would be to its clamp,
/// as somebody at the robot would do.
pub(super) fn taken(truth: &Setup, groups: &[Group], plan: &Plan) -> Result<Vec<(usize, Vec<f64>)>> {
    let mut kinematics = Kinematics::new(truth);
    let mut random = Random::seeded(plan.seed, 1);
    let mut taken = Vec::with_capacity(plan.planned.len());
    for (number, (clamp, q)) in (1..).zip(&plan.planned) {
        let mut q = q.clone();
        kinematics.update(&q, &[]);
        let place = groups[*clamp].device.origin;
        let off = (kinematics.tip - place).norm();
        let aim = place + Vector3::from_fn(|_, _| AIM * random.uniform(-1.0, 1.0));
        if off > NEAR || !has_arrived(bring_to(&mut kinematics, &mut q, &aim)) {
            return Err(Error::NotApplicable {
                what: "simulating these poses".into(),
                why: format!(
                    "in pose {number} the ball is {} mm away from {}",
                    significant(off / MM, 3),
                    groups[*clamp].name
                ),
                hint: "plan poses for a campaign of this simulation and this rod".into(),
            });
        }
        taken.push((*clamp, q));
    }
    taken.sort_by_key(|&(clamp, _)| clamp);
    Ok(taken)
}
