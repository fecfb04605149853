//! What rows and columns are called in the user's files.

use super::draft::Rows;
use crate::calibration::campaign::Recording;
use crate::inference::Key;
use crate::robot::{Motion, Robot};

/// The columns of a measured point.
pub(super) const AXES: [&str; 3] = ["x_mm", "y_mm", "z_mm"];

/// The column of a joint, counted from 0.
pub(super) fn column(robot: &Robot, joint: usize) -> String {
    match robot.joints[joint].motion {
        Motion::Revolute => format!("q{}_deg", joint + 1),
        Motion::Prismatic => format!("q{}_mm", joint + 1),
    }
}

/// One number of a row, or several: `q4_deg of pose 7`.
pub(super) fn cell(columns: &str, pose: &str) -> Key {
    Key::new(format!("{columns} of {pose}"))
}

/// `pose 7`, with its clamp where several poses have that name.
pub(super) fn pose_name(recording: &Recording, row: usize) -> String {
    let own = &recording.rows[row].pose;
    match recording.rows.iter().filter(|other| &other.pose == own).count() {
        1 => format!("pose {own}"),
        _ => format!("pose {}", recording.pose_name(row)),
    }
}

/// `pose 7`, or `pose 7 to pose 12`.
pub(super) fn poses(recording: &Recording, first: usize, last: usize) -> String {
    match first == last {
        true => pose_name(recording, first),
        false => format!("{} to {}", pose_name(recording, first), pose_name(recording, last)),
    }
}

/// Where some rows are: `in pose 7`, `from pose 7 to pose 12`, `in the poses of clamp 2`.
pub(super) fn place(recording: &Recording, rows: Rows) -> String {
    match rows {
        Rows::Between(first, last) if first == last => format!("in {}", pose_name(recording, first)),
        Rows::Between(first, last) => format!("from {}", poses(recording, first, last)),
        Rows::OfClamp(clamp) => format!("in the poses of {}", recording.groups[clamp].name),
    }
}
