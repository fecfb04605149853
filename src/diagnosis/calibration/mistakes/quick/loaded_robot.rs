//! A robot with what hangs on it, as a quick fit changes it.

use nalgebra::Vector3;

use super::super::draft::Draft;
use crate::calibration::Compensation;
use crate::robot::{Parameter, Robot, minimal_parameters};

/// A robot with what hangs on it.
pub struct LoadedRobot<'a> {
    pub robot: &'a Robot,
    pub compensation: Compensation,
    pub(super) free: Vec<Parameter>,
    /// Largest distance of the tip from the first joint, m.
    pub reach: f64,
}

impl<'a> LoadedRobot<'a> {
    pub fn new(
        robot: &'a Robot,
        compensation: Compensation,
        tool: Vector3<f64>,
        draft: &Draft,
    ) -> LoadedRobot<'a> {
        let mut free = minimal_parameters(robot, tool, tool, compensation.payload);
        free.retain(|p| !p.is_placement());
        free.extend((0..3).map(Parameter::Tool));
        let from = robot.root.origin;
        let reach = |row: usize| (robot.flange_at(draft.joints(row)).point(&tool) - from).norm();
        let reach = (0..draft.len()).map(reach).fold(0.0, f64::max);
        LoadedRobot { robot, compensation, free, reach }
    }

    /// The same under a contact force that is `factor` times as large.
    pub fn with_contact_force_times(&self, factor: f64) -> LoadedRobot<'a> {
        let compensation = self.compensation.with_contact_force_times(factor);
        LoadedRobot { compensation, free: self.free.clone(), ..*self }
    }

    /// The same with so much more on the tip, kg: the rod bends under it, and the joints turn.
    pub fn with_tip_heavier_by(&self, mass: f64, tip: &Vector3<f64>) -> LoadedRobot<'a> {
        let compensation = self.compensation.with_tip_heavier_by(mass, tip);
        LoadedRobot { compensation, free: self.free.clone(), ..*self }
    }
}
