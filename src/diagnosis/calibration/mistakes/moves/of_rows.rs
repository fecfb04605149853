//! What may have gone wrong with some rows alone.

use super::super::super::effects::mistakes::{OFFSET_MISTAKE, ROW_MISTAKE};
use super::super::draft::{Cell, Draft, DraftChange};
use super::super::names::AXES;
use super::{List, PossibleMistake, UNUSUAL, exact};
use crate::calibration::campaign::Campaign;
use crate::inference::{Estimate, Key};
use crate::robot::{Motion, Robot};
use crate::statistics::HALF_95;
use crate::units::{DEG, MM, significant};

/// Ln of the share of all angles that a step of a joint's zero agrees with.
const ANY_ANGLE: f64 = -6.0;

/// All that may have gone wrong with some rows alone: what the others show decides, not how large
/// the numbers are.
pub fn of_rows(campaign: &Campaign, draft: &Draft) -> Vec<PossibleMistake> {
    let mut list = List { campaign, draft, moves: Vec::new(), is_of_rows: true };
    list.joints();
    list.positions();
    list.rows();
    list.exchanged();
    list.displaced_columns();
    list.steps();
    list.moves
}

impl List<'_> {
    /// A number that was left out of a column, or stands twice there.
    pub fn displaced_columns(&mut self) {
        let joints = (0..self.draft.joint_count).map(|joint| (Cell::Joint(joint), self.column(joint)));
        let mut cells: Vec<(Cell, String)> = joints.collect();
        if !self.draft.has_sockets() {
            cells.extend(AXES.into_iter().enumerate().map(|(axis, name)| (Cell::Axis(axis), name.into())));
        }
        for (cell, name) in cells {
            for (by, way, there) in [(1, "up", "above"), (-1, "down", "below")] {
                let cure = format!("Move {name} 1 row {way}");
                let why = format!("each number belongs to the row {there}");
                let change = DraftChange::Column { cell, by };
                let shift = self.add(&ROW_MISTAKE, Key::new(&name), change, &cure, &why);
                (shift.estimates, shift.log_prior) = (exact("rows", by as f64), UNUSUAL);
            }
        }
    }

    /// The zero of a joint by any angle, which the poses must say; of the last joint it is rather
    /// the rod that turned in its mount.
    pub fn steps(&mut self) {
        let count = self.draft.joint_count;
        for joint in 0..count.saturating_sub(1) {
            let name = self.column(joint);
            let change = DraftChange::Zero { joint, by: 0.0 };
            self.add(&OFFSET_MISTAKE, Key::new(&name), change, "", "the joint's zero is another one there")
                .log_prior = ANY_ANGLE;
        }
    }
}

impl PossibleMistake {
    /// What to do where a joint's zero was found to be another one.
    pub fn describe_zero(&mut self, robot: &Robot, joint: usize, by: f64, error: f64) {
        let (unit, symbol, name) = match robot.joints[joint].motion {
            Motion::Revolute => (DEG, "°", "deg"),
            Motion::Prismatic => (MM, " mm", "mm"),
        };
        let (value, half) = (by / unit, HALF_95 * error / unit);
        let digits = (value.abs() / half.max(1e-9)).log10().ceil().clamp(1.0, 4.0) as usize + 1;
        let size = significant(value.abs(), digits);
        self.cure = match value > 0.0 {
            true => format!("Add {size}{symbol} to {}", self.location),
            false => format!("Subtract {size}{symbol} from {}", self.location),
        };
        self.estimates = vec![Estimate::as_written(name, value, value - half, value + half)];
    }
}
