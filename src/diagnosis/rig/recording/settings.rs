//! What was set, row by row: the load that hung, or the displacement that was imposed, as the
//! readings of each [place](super::place) say.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::estimate::Estimate;
use super::place::{Known, Place};
use crate::rig::readings::{Axis, Driven, Reading};

/// What was set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Along the positive axis: a load, N, or a displacement, m.
    pub value: f64,
    /// The same for all readings of one setting, their mean.
    pub set: f64,
    /// Where the value is known from.
    pub known: Known,
}

impl Setting {
    pub fn as_read(value: f64) -> Setting {
        Setting { value, set: value, known: Known::Read }
    }
}

/// Of all rows.
pub struct Settings {
    /// Of each row; of a displacement where it was read.
    pub rows: Vec<Option<Setting>>,
    /// What they are off by, rows × errors, m for one standard deviation of each error.
    pub errors: DMatrix<f64>,
}

/// What was set of each row.
pub fn settings(rows: &[Reading], driven: Driven) -> Settings {
    let read = |row: &Reading| match driven {
        Driven::Load => Some(row.signed_load()),
        Driven::Displacement => row.offset[row.direction.axis.index()],
    };
    let mut all = Settings {
        rows: rows.iter().map(|row| read(row).map(Setting::as_read)).collect(),
        errors: DMatrix::zeros(rows.len(), 0),
    };
    if driven == Driven::Load {
        return all;
    }
    // of each axis and the place where its displacement is read
    let mut places: BTreeMap<(Axis, Option<u64>), Vec<usize>> = BTreeMap::new();
    for (i, row) in rows.iter().enumerate().filter(|(_, row)| read(row).is_some()) {
        places.entry((row.direction.axis, row.read_station.map(f64::to_bits))).or_default().push(i);
    }
    for own in places.into_values() {
        let place = Place::of(rows, &own);
        if let Some((known, estimate)) = place.estimate() {
            all.know(&place.rows, known, &estimate);
        }
    }
    all
}

impl Settings {
    fn know(&mut self, rows: &[usize], known: Known, estimate: &Estimate) {
        let is_as_read = known == Known::Recurring;
        for (&i, &set) in rows.iter().zip(&estimate.values) {
            let read = self.rows[i].map_or(set, |own| own.value);
            self.rows[i] = Some(Setting { value: if is_as_read { read } else { set }, set, known });
        }
        if is_as_read {
            return;
        }
        let (first, own) = (self.errors.ncols(), estimate.errors.ncols());
        let errors = std::mem::replace(&mut self.errors, DMatrix::zeros(0, 0));
        self.errors = errors.resize_horizontally(first + own, 0.0);
        for (k, &i) in rows.iter().enumerate() {
            self.errors.view_mut((i, first), (1, own)).copy_from(&estimate.errors.row(k));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::readings::Readings;
    use crate::units::UM;

    #[test]
    fn loads_are_as_they_hang_and_each_axis_has_settings_of_its_own() {
        let text = "axis,load_n,dy_um,dz_um\ny,1,10,\n-y,2,-20,\nz,3,,10.5\n";
        let rows = Readings::from_text("f", text).unwrap().rows;
        let set = |driven, unit: f64| -> Vec<f64> {
            let set = settings(&rows, driven).rows.into_iter().flatten();
            set.map(|own| (own.value / unit * 10.0).round() / 10.0).collect()
        };
        assert_eq!(set(Driven::Load, 1.0), [1.0, -2.0, 3.0]);
        assert_eq!(set(Driven::Displacement, UM), [10.0, -20.0, 10.5]);
    }
}
