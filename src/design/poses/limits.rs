//! What a pose has to keep: joint limits, the clamp's reach, how the rod may stand, where no arm
//! may be.

use nalgebra::Vector3;

use crate::calibration::Campaign;
use crate::calibration::campaign::Group;
use crate::robot::configurations::has_arrived;
use crate::robot::{Kinematics, Robot, Setup};
use crate::units::{DEG, MM};

/// How far the arm stays above a table, m.
const ABOVE: f64 = 50.0 * MM;
/// What is nearer to the ball than this is the hand that holds it, m.
const HAND: f64 = 100.0 * MM;
/// Points nearer than this are one, m.
const SAME: f64 = MM;

/// Limits of poses beside those of the joints.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PoseLimits {
    /// Largest angle between the rod at its ball and the axis of the clamp, rad. The axis is the
    /// direction of the contact force (it pushes the ball out of the device), else upwards.
    pub cone: f64,
    /// Radius of the block about every clamp that arm and rod stay out of, m; the ball's end of the
    /// rod may enter its own.
    pub clear: f64,
    /// Least change of at least one joint between two poses of a clamp, rad or m.
    pub change: f64,
    /// Where the table is that joints and flange stay 50 mm above.
    pub table: TableHeight,
}

/// A table below the arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TableHeight {
    /// As low as the base or the lowest clamp; none where z of {W} does not point upwards.
    Lowest,
    /// At this height in {W}, m.
    At(f64),
    /// There is none.
    Nowhere,
}

impl Default for PoseLimits {
    /// 75°, 60 mm, 5°.
    fn default() -> Self {
        PoseLimits { cone: 75.0 * DEG, clear: 60.0 * MM, change: 5.0 * DEG, table: TableHeight::Lowest }
    }
}

impl PoseLimits {
    /// With this largest angle between rod and clamp, rad.
    pub fn with_cone(self, cone: f64) -> Self {
        PoseLimits { cone, ..self }
    }

    /// With this radius about every clamp kept clear, m.
    pub fn with_clearance(self, clear: f64) -> Self {
        PoseLimits { clear, ..self }
    }

    /// With this least change between two poses of a clamp, rad or m.
    pub fn with_change(self, change: f64) -> Self {
        PoseLimits { change, ..self }
    }

    /// With the table there.
    pub fn with_table(self, table: TableHeight) -> Self {
        PoseLimits { table, ..self }
    }
}

/// Why a pose is no candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Obstacle {
    /// The ball does not get to the clamp.
    Far,
    /// A joint is beyond its limits.
    JointLimit,
    /// The rod stands outside the cone.
    Cone,
    /// Arm or rod is within the block about a clamp.
    Block,
    /// A joint or the flange is below the table.
    Table,
}

impl Obstacle {
    /// All obstacles, in the order of their discriminants.
    pub const ALL: [Obstacle; 5] =
        [Obstacle::Far, Obstacle::JointLimit, Obstacle::Cone, Obstacle::Block, Obstacle::Table];

    /// Its name in JSON.
    pub fn key(self) -> &'static str {
        ["clamp_out_of_reach", "joint_limits", "rod_cone", "clamp_block", "table"][self as usize]
    }

    /// Over a column.
    pub fn short(self) -> &'static str {
        ["out of reach", "joint limits", "cone", "block", "table"][self as usize]
    }

    /// In a sentence.
    pub fn description(self) -> &'static str {
        [
            "the ball does not reach the clamp",
            "a joint is beyond its limits",
            "the rod stands outside the cone",
            "arm or rod is within the block about a clamp",
            "the arm is near or below the table",
        ][self as usize]
    }
}

/// What a pose breaks first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Broken {
    pub obstacle: Obstacle,
    /// By how much: m, rad of the cone, rad or m of a joint.
    pub by: f64,
    /// The joint that is farthest beyond its limits.
    pub joint: usize,
}

/// The places of a campaign and what is around them.
#[derive(Debug)]
pub(super) struct Surroundings<'a> {
    pub setup: &'a Setup<'a>,
    pub limits: PoseLimits,
    pub places: &'a [Group],
    /// False where a tracker sees the ball anywhere.
    pub are_fixed: bool,
    /// Axis of each place in {W}.
    axes: Vec<Vector3<f64>>,
    /// The rod from the flange to the ball, in {T}, m.
    rod: Vec<Vector3<f64>>,
    /// Height of the table in {W}, m; `None` where z of {W} does not point upwards.
    table: Option<f64>,
}

impl<'a> Surroundings<'a> {
    pub fn new(campaign: &Campaign, setup: &'a Setup, places: &'a [Group], limits: PoseLimits) -> Self {
        let up = -(setup.base().rotation * setup.robot.gravity).try_normalize(0.0).unwrap_or_default();
        let axis = |place: &Group| {
            let force = campaign.contact_force.map(|force| place.device.rotation * force);
            force.and_then(|force| force.try_normalize(0.0)).unwrap_or(up)
        };
        let are_fixed = places.iter().any(|place| !place.name.is_tracked());
        let lowest = places.iter().map(|place| place.device.origin.z).fold(setup.base_position.z, f64::min);
        let rod = match &campaign.rod {
            Some(rod) => {
                let stations = [0.0, rod.bend_start(), rod.bend_end(), rod.length()];
                stations.map(|station| rod.point(station)).to_vec()
            }
            None => vec![Vector3::zeros(), setup.tool],
        };
        Surroundings {
            setup,
            limits,
            places,
            are_fixed,
            axes: places.iter().map(axis).collect(),
            rod,
            table: match limits.table {
                TableHeight::Lowest => {
                    (up.z > 0.9).then_some(if are_fixed { lowest } else { setup.base_position.z })
                }
                TableHeight::At(height) => Some(height),
                TableHeight::Nowhere => None,
            },
        }
    }

    /// Angle between the rod at its ball and the axis of a place, rad; 0 where nothing is on the
    /// flange.
    pub fn angle(&self, kinematics: &Kinematics, place: usize) -> f64 {
        let [.., before, end] = self.rod.as_slice() else { return 0.0 };
        let along = kinematics.flange.rotation * (before - end);
        if along.norm() > 0.0 { along.angle(&self.axes[place]) } else { 0.0 }
    }

    /// What a configuration with so much of its way left breaks first, and by how much.
    pub fn obstacle(
        &self,
        kinematics: &Kinematics,
        q: &[f64],
        place: usize,
        left: f64,
        near: Option<f64>,
    ) -> Option<Broken> {
        let broken = |obstacle, by| Some(Broken { obstacle, by, joint: 0 });
        let arrives = near.map_or_else(|| has_arrived(left), |near| left <= near);
        if self.are_fixed && !arrives {
            return broken(Obstacle::Far, left);
        }
        if let Some((joint, by)) = beyond_limits(self.setup.robot, q) {
            return Some(Broken { obstacle: Obstacle::JointLimit, by, joint });
        }
        if self.are_fixed {
            let beyond = self.angle(kinematics, place) - self.limits.cone;
            if beyond > 0.0 {
                return broken(Obstacle::Cone, beyond);
            }
        }
        let path = self.path(kinematics);
        let below = self.below_table(&path);
        if below > 0.0 {
            return broken(Obstacle::Table, below);
        }
        let within = if self.are_fixed { self.within_block(&path, place) } else { 0.0 };
        if within > 0.0 { broken(Obstacle::Block, within) } else { None }
    }

    /// Base to ball: joint by joint, then along the rod; places that coincide are one.
    fn path(&self, kinematics: &Kinematics) -> Vec<Vector3<f64>> {
        let mut path: Vec<Vector3<f64>> = kinematics.joints.iter().map(|joint| joint.distal.origin).collect();
        path.extend(self.rod.iter().map(|point| kinematics.flange.point(point)));
        path.dedup_by(|next, before| (*next - *before).norm() < SAME);
        path
    }

    /// How far the arm is too low, m; 0 where it is not. The first joint stands on the table, and
    /// what is at the ball is where the ball has to be.
    fn below_table(&self, path: &[Vector3<f64>]) -> f64 {
        let (Some(table), Some(ball)) = (self.table, path.last()) else { return 0.0 };
        let arm = path.iter().skip(1).filter(|point| (*point - ball).norm() > HAND);
        arm.map(|point| table + ABOVE - point.z).fold(0.0, f64::max)
    }

    /// How far arm or rod are within a block, m; 0 where they are not. Places nearer than two radii
    /// share a block: what enters one enters the other.
    fn within_block(&self, path: &[Vector3<f64>], own: usize) -> f64 {
        let last = path.len().saturating_sub(2);
        let own = self.places[own].device.origin;
        let blocks = self.places.iter().map(|place| place.device.origin);
        let within = blocks.flat_map(|block| {
            let is_entered = (block - own).norm() < 2.0 * self.limits.clear;
            let segments = path.windows(2).enumerate().filter(move |(k, _)| !(is_entered && *k == last));
            segments.map(move |(_, ends)| self.limits.clear - distance(&block, &ends[0], &ends[1]))
        });
        within.fold(0.0, f64::max)
    }
}

/// The joint that is farthest beyond its limits, and how far, rad or m.
fn beyond_limits(robot: &Robot, q: &[f64]) -> Option<(usize, f64)> {
    let beyond = q
        .iter()
        .zip(&robot.joints)
        .map(|(&q, joint)| joint.limits.map_or(0.0, |[low, high]| (low - q).max(q - high)));
    let farthest = beyond.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    farthest.filter(|(_, by)| *by > 0.0)
}

/// Distance of a point from a stretch, m.
fn distance(point: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    let along = to - from;
    let square = along.norm_squared();
    let share = if square > 0.0 { ((point - from).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (from + along * share - point).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretch_is_as_far_as_its_nearest_point() {
        let (from, to) = (Vector3::zeros(), Vector3::x());
        assert_eq!(distance(&Vector3::new(0.5, 0.3, 0.0), &from, &to), 0.3);
        assert_eq!(distance(&Vector3::new(-3.0, 0.0, 4.0), &from, &to), 5.0);
        assert_eq!(distance(&Vector3::new(0.0, 2.0, 0.0), &from, &from), 2.0);
    }
}
