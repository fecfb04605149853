//! What a mistake did to a file, as something that can be undone.

use crate::inference::{Effect, Estimate};
use crate::rig::readings::{Reading, Readings};
use crate::spatial::Axis;

/// What undoes mistakes; everything by the labels of the file.
///
/// Mistakes commute: factors belong to the columns as they are named, and the names are exchanged
/// after that.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Change {
    /// By axis of the load: true over recorded.
    pub load: [f64; 3],
    /// By axis of the load and channel: true over recorded.
    pub reading: [[f64; 3]; 3],
    /// By channel: which it really is.
    pub channel: [usize; 3],
    /// By axis of the load: which it really is.
    pub axis: [usize; 3],
    /// Which of the rods, 0 for the one that was given.
    pub body: usize,
}

impl Default for Change {
    fn default() -> Self {
        Change { load: [1.0; 3], reading: [[1.0; 3]; 3], channel: [0, 1, 2], axis: [0, 1, 2], body: 0 }
    }
}

impl Change {
    /// A factor on the loads along some axes.
    pub fn load(axes: [bool; 3], factor: f64) -> Change {
        Change { load: axes.map(|is_of| if is_of { factor } else { 1.0 }), ..Change::default() }
    }

    /// A factor on the readings of some channels under loads along some axes.
    pub fn reading(axes: [bool; 3], channels: [bool; 3], factor: f64) -> Change {
        let reading = axes.map(|of_axis| channels.map(|of| if of && of_axis { factor } else { 1.0 }));
        Change { reading, ..Change::default() }
    }

    /// Another rod.
    pub fn body(body: usize) -> Change {
        Change { body, ..Change::default() }
    }

    /// Both; `None` for two rods at once.
    pub fn and(&self, other: &Change) -> Option<Change> {
        if self.body != 0 && other.body != 0 {
            return None;
        }
        let mut both = self.clone();
        for axis in 0..3 {
            both.load[axis] *= other.load[axis];
            for channel in 0..3 {
                both.reading[axis][channel] *= other.reading[axis][channel];
            }
            both.channel[axis] = other.channel[self.channel[axis]];
            both.axis[axis] = other.axis[self.axis[axis]];
        }
        both.body = self.body.max(other.body);
        Some(both)
    }

    /// The readings without the mistakes.
    pub fn undo(&self, readings: &mut Readings) {
        readings.rows.iter_mut().for_each(|row| self.undo_in(row));
    }

    /// One row without them.
    pub fn undo_in(&self, row: &mut Reading) {
        let axis = row.direction.axis.index();
        let mut offset = [None; 3];
        for channel in 0..3 {
            offset[self.channel[channel]] =
                row.offset[channel].map(|offset| offset * self.reading[axis][channel]);
        }
        row.offset = offset;
        row.load *= self.load[axis].abs();
        if self.load[axis] < 0.0 {
            row.direction.sign = -row.direction.sign;
        }
        row.direction.axis = Axis::ALL[self.axis[axis]];
    }
}

/// A mistake that may have been made.
#[derive(Debug, Clone)]
pub(super) struct Move {
    pub effect: &'static Effect,
    /// Columns, keys and names as they stand in the file.
    pub location: String,
    pub change: Change,
    /// How usual it is: ln of odds against the most usual one.
    pub log_prior: f64,
    pub estimates: Vec<Estimate>,
    /// What is wrong, with the correction: a full sentence without its full stop.
    pub observed: String,
    /// What it looks like, for one line: `load_n looks like kilograms`.
    pub looks_like: String,
    /// How far the factor that all lines still have in common may be from 1, as a ratio: a unit's
    /// factor counts only near it.
    pub within: f64,
}

/// An estimate without a unit.
pub(super) fn exact(name: &str, value: f64) -> Estimate {
    Estimate { name: name.into(), unit: 1.0, value, low: value, high: value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_combine_and_undo_what_was_done() {
        let text = "axis,load_n,dx_um,dy_um,dz_um\ny,1,1,2,\nz,2,3,,5\nz,3,3,,6\n";
        let mut readings = Readings::from_text("f", text).unwrap();
        let swapped = Change { channel: [0, 2, 1], ..Change::default() };
        let flipped = Change::reading([true; 3], [false, true, false], -1.0);
        let axis = Change::load([false, false, true], -2.0);
        let all = swapped.and(&flipped).and_then(|both| both.and(&axis)).unwrap();
        all.undo(&mut readings);
        let row = &readings.rows[0];
        let um = |offset: Option<f64>| offset.map(|offset| (offset / 1e-6).round());
        assert_eq!(row.offset.map(um), [Some(1.0), None, Some(-2.0)]);
        assert_eq!((row.signed_load(), readings.rows[1].signed_load()), (1.0, -4.0));
        assert_eq!(Change::body(1).and(&Change::body(2)), None);
    }
}
