//! A proposed law as one of the robot's file.

use super::measures::{changes, location, variable};
use crate::diagnosis::law_formula::{constants, formula, range, source};
use crate::inference::law::{Law, Memory};
use crate::robot::{JointLawVariable, LawPlace, Motion, Robot, RobotLaw};

/// The law as the file of `robot` holds it; `None` for one that only this recording has (over its
/// time, its order, its temperatures, positions in the frame of the measurement), and for one of a
/// torque that follows the way the joint came.
pub fn written(law: &Law, robot: &Robot, from: &str) -> Option<RobotLaw> {
    let motions: Vec<Motion> = robot.joints.iter().map(|joint| joint.motion).collect();
    let is_prismatic: Vec<bool> = motions.iter().map(|motion| *motion == Motion::Prismatic).collect();
    let count = motions.len();
    let own =
        JointLawVariable::all(&is_prismatic).into_iter().find(|own| variable(*own) == law.site.variable)?;
    let is_there = |(place, per): &(LawPlace, Option<usize>)| {
        own.is_at(*place)
            && location(*place) == law.site.location
            && changes(*place, *per, &motions) == law.site.result
    };
    let of_place = |place| std::iter::once(None).chain((0..count).map(Some)).map(move |per| (place, per));
    let (place, per_joint) = LawPlace::all(count).flat_map(of_place).find(is_there)?;
    let is_known = match law.memory {
        Memory::None => true,
        Memory::Side => !matches!(own, JointLawVariable::Torque(_)),
        Memory::Stop
        | Memory::Play
        | Memory::Stops(_)
        | Memory::BoucWen(_)
        | Memory::Lag
        | Memory::Lagged => false,
    };
    if !is_known {
        return None;
    }
    let formulas = (0..place.formulas()).map(|k| formula(law, own.symbol(), true, k)).collect();
    let mut written = RobotLaw::new(place, per_joint, own, formulas, constants(law), range(law)).ok()?;
    written.source = Some(source(law, from));
    Some(written)
}
