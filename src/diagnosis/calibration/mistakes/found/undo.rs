//! The campaign that was meant.

use nalgebra::{Matrix3, Vector3};

use super::super::draft::{Draft, DraftChange, change_joints};
use super::super::moves::Other;
use super::super::quick;
use super::super::quick::{FAILED, Fit, LoadedRobot, Worthwhile};
use super::super::search::{FittedDraft, MistakeSearch, SearchStep};
use super::super::{Mended, Neighbours};
use crate::calibration::campaign::{Campaign, Recording, Targets};
use crate::calibration::{Compensation, Mode};
use crate::error::Result;
use crate::robot::Robot;
use crate::rod::Rod;
use crate::spatial::Pose;
use crate::statistics::median;
use crate::units::UM;

/// Positions of a validation that a change brings so much nearer to the tips held the mistake too.
const CURED: f64 = 0.5;

impl Mended {
    /// The robot that its file means, which is written anew.
    pub(in super::super) fn means(&mut self, robot: &Robot) -> Result<()> {
        self.campaign.robot = robot.clone();
        self.campaign.robot_text = robot.to_toml(&["CORRECTED: as it was meant.".into()])?;
        Ok(())
    }

    /// The campaign that was meant.
    pub(in super::super) fn undo(
        &mut self,
        recorded: &Campaign,
        others: &Neighbours,
        search: &MistakeSearch,
        best: &FittedDraft,
        meant: &[Other],
    ) -> Result<()> {
        let mut draft = search.changed(&best.steps);
        if let Some(other) = meant.iter().find(|other| other.body == draft.body && draft.body > 0) {
            if other.is_rod {
                let rod = others.rods.iter().find(|(file, _)| *file == other.file);
                self.campaign.rod = rod.map(|(_, rod)| rod.clone());
                self.campaign.rod_file = Some(other.file.clone());
                self.campaign.readings = None;
                self.mode = if self.mode == Mode::Meas { Mode::Fea } else { self.mode };
            } else if let Some((file, robot, text)) =
                others.robots.iter().find(|(file, ..)| *file == other.file)
            {
                self.campaign.robot = robot.clone();
                (self.campaign.robot_file, self.campaign.robot_text) = (file.clone(), text.clone());
            }
        }
        // a clamp that stands elsewhere has another frame, not a station
        let mut station = search.draft.stations;
        for step in &best.steps {
            let SearchStep::Elsewhere(change) = step else { continue };
            if let Some((clamp, frame)) = search.frame_meant(best, change) {
                draft.devices[clamp] = frame;
                continue;
            }
            if let (DraftChange::Apart(clamp), Some(to)) = (change, best.fit.bases.get(station)) {
                draft.devices[*clamp] = best.fit.bases[0].then(&to.inverse()).then(&draft.devices[*clamp]);
                draft.station.iter_mut().for_each(|own| *own = if *own == station { 0 } else { *own });
            }
            station += 1;
        }
        drop_unused(&mut draft);
        self.campaign.measurements = draft.recording(&recorded.measurements);
        if let Some(base) = draft.base {
            let [roll, pitch, yaw] = base.roll_pitch_yaw();
            self.campaign.base = [base.origin.x, base.origin.y, base.origin.z, roll, pitch, yaw];
        }
        if let Some(tool) = draft.tool {
            self.campaign.tool_is_given |=
                (tool - self.campaign.rod.as_ref().map_or(tool, Rod::tip)).norm() > UM;
            self.campaign.tool = tool;
        }
        let [x, y, z, roll, pitch, yaw] = self.campaign.base;
        let base = Pose::from_xyz_rpy([x, y, z], [roll, pitch, yaw]);
        let (robot, tool) = (self.campaign.robot.clone(), self.campaign.tool);
        self.campaign.measurements.align_stations(&robot, base, tool)?;
        if let Some(validation) = &mut self.campaign.validation {
            turn_joints(validation, &robot, tool, &draft.joint_changes);
            // what a tracker saw of the one it saw of the other; what a clamp reads it never sees
            if recorded.measurements.groups.iter().all(|group| group.name.is_tracked()) {
                let at = best.fit.bases.first().map(|base| (base, &best.fit.tool));
                let most = FAILED * search.bodies[best.thin.body].reach;
                change_positions(validation, &robot, tool, at, (&draft.positions_changed, most));
            }
        }
        Ok(())
    }
}

/// Stations in the order of their rows, without those that have none.
fn drop_unused(draft: &mut Draft) {
    let mut known: Vec<usize> = Vec::new();
    for station in &mut draft.station {
        let at = known.iter().position(|old| old == station).unwrap_or_else(|| {
            known.push(*station);
            known.len() - 1
        });
        *station = at;
    }
    draft.stations = known.len();
}

/// The joints of a validation as they are meant, where it holds the mistake too: where the robot
/// fits it better so.
fn turn_joints(validation: &mut Recording, robot: &Robot, tool: Vector3<f64>, changes: &[DraftChange]) {
    if changes.is_empty() {
        return;
    }
    let count = validation.joint_count;
    let mut turned = validation.clone();
    for row in turned.joint_values.chunks_mut(count.max(1)) {
        changes.iter().for_each(|change| change_joints(change, row));
    }
    let left = |recording| fitted(recording, robot, tool).map(|fit| fit.log_likelihood);
    if left(&turned) > left(validation) {
        *validation = turned;
    }
}

/// A recording by itself, with the robot of the file.
fn fitted(recording: &Recording, robot: &Robot, tool: Vector3<f64>) -> Option<Fit> {
    let alone = Campaign::new(robot.clone(), recording.clone()).ok()?.with_tool(tool);
    let draft = Draft::of(&alone).thinned(100);
    let body = LoadedRobot::new(robot, Compensation::bare(), tool, &draft);
    quick::fit(&draft, &body, Worthwhile::ANY)
}

/// The positions of a validation as they are meant, where it holds the mistake too: where they are
/// far nearer to the tips so, and no farther than `most` (m), from the place of the tracker (the
/// base and the tip `at` it) or, should it have stood elsewhere, from any.
fn change_positions(
    validation: &mut Recording,
    robot: &Robot,
    tool: Vector3<f64>,
    at: Option<(&Pose, &Vector3<f64>)>,
    (change, most): (&Matrix3<f64>, f64),
) {
    if *change == Matrix3::identity() {
        return;
    }
    let mut meant = validation.clone();
    let Targets::Points(points) = &mut meant.targets else { return };
    points.iter_mut().for_each(|point| *point = change * *point);
    let from_there = |recording: &Recording| {
        let (base, tip) = at?;
        let Targets::Points(points) = &recording.targets else { return None };
        let joints = recording.joint_values.chunks(recording.joint_count.max(1));
        let off =
            joints.zip(points).map(|(q, point)| (base.point(&robot.flange_at(q).point(tip)) - point).norm());
        median(&off.collect::<Vec<_>>())
    };
    let from_anywhere =
        |recording: &Recording| fitted(recording, robot, tool).and_then(|fit| median(&fit.residuals));
    let is_cured = |before: Option<f64>, after: Option<f64>| {
        before.zip(after).is_some_and(|(before, after)| after < (CURED * before).min(most))
    };
    if is_cured(from_there(validation), from_there(&meant))
        || is_cured(from_anywhere(validation), from_anywhere(&meant))
    {
        *validation = meant;
    }
}
