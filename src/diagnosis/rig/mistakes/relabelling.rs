//! What mistakes of units, signs and names did to a file, as something that can be undone.

use crate::rig::readings::{Reading, Readings};
use crate::spatial::Axis;

/// What undoes mistakes: factors, and what axes and channels really are, by the labels of the file.
///
/// Mistakes commute: factors belong to the columns as they are named, and the names are exchanged
/// after that.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Relabelling {
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

impl Default for Relabelling {
    fn default() -> Self {
        Relabelling { load: [1.0; 3], reading: [[1.0; 3]; 3], channel: [0, 1, 2], axis: [0, 1, 2], body: 0 }
    }
}

impl Relabelling {
    /// A factor on the loads along some axes.
    pub fn load(axes: [bool; 3], factor: f64) -> Relabelling {
        let load = axes.map(|is_its| if is_its { factor } else { 1.0 });
        Relabelling { load, ..Relabelling::default() }
    }

    /// A factor on the readings of some channels under loads along some axes.
    pub fn reading(axes: [bool; 3], channels: [bool; 3], factor: f64) -> Relabelling {
        let by_channel = |is_axis: bool| channels.map(|is_its| if is_its && is_axis { factor } else { 1.0 });
        let reading = axes.map(by_channel);
        Relabelling { reading, ..Relabelling::default() }
    }

    /// Another rod.
    pub fn body(body: usize) -> Relabelling {
        Relabelling { body, ..Relabelling::default() }
    }

    /// Both; `None` for two rods at once.
    pub fn and(&self, other: &Relabelling) -> Option<Relabelling> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relabellings_combine_and_undo_what_was_done() {
        let text = "axis,load_n,dx_um,dy_um,dz_um\ny,1,1,2,\nz,2,3,,5\nz,3,3,,6\n";
        let mut readings = Readings::from_text("f", text).unwrap();
        let swapped = Relabelling { channel: [0, 2, 1], ..Relabelling::default() };
        let flipped = Relabelling::reading([true; 3], [false, true, false], -1.0);
        let axis = Relabelling::load([false, false, true], -2.0);
        let all = swapped.and(&flipped).and_then(|both| both.and(&axis)).unwrap();
        all.undo(&mut readings);
        let row = &readings.rows[0];
        let um = |offset: Option<f64>| offset.map(|offset| (offset / 1e-6).round());
        assert_eq!(row.offset.map(um), [Some(1.0), None, Some(-2.0)]);
        assert_eq!((row.signed_load(), readings.rows[1].signed_load()), (1.0, -4.0));
        assert_eq!(Relabelling::body(1).and(&Relabelling::body(2)), None);
    }
}
