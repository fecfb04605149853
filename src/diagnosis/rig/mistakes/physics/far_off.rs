//! One thing far off, with the rest as files are.

use nalgebra::{Cholesky, DVector, Dyn};

use super::columns::Columns;
use crate::units::DEG;

/// One thing far off, each as likely: ln of how likely, and how far.
const SINGLE: f64 = -5.0;
/// Joints have many places.
const ONE_JOINT: f64 = -7.5;
const SINGLE_JOINT: f64 = 0.6;
const SINGLE_SHEAR: f64 = 1.0;
const SINGLE_AXIS: f64 = 0.3;
const SINGLE_CHANNEL: f64 = 0.3;
/// A sensor, or loads, of a smaller scale are in another unit.
const LEAST_SCALE: f64 = 0.5;
const SINGLE_TURN: f64 = 0.09;
/// A point of loads or sensors, as a share of the rod's length.
pub(super) const SINGLE_POINT: f64 = 0.05;
/// The angle between the pipes, rad.
pub(super) const SINGLE_ANGLE: f64 = 5.0 * DEG;
/// What is loose gives way by some times what the whole rod does.
const LOOSE: f64 = 6.0;

/// The Gaussian model of one mood, solved.
pub(super) struct Solved {
    pub log_density: f64,
    pub root: Cholesky<f64, Dyn>,
    pub solved: DVector<f64>,
}

impl Solved {
    /// Ln of the density with one column after another far off, weighted.
    pub fn with_one_far_off(&self, columns: &Columns) -> Vec<f64> {
        let softer = |column, size, weight: f64| Some(weight + self.softer(column, size)?);
        let joints = columns.joints.iter().filter_map(|joint| softer(joint, SINGLE_JOINT, ONE_JOINT));
        let both = columns.joints_both_ways();
        let both = both.iter().filter_map(|joint| softer(joint, SINGLE_JOINT, ONE_JOINT));
        let shear = softer(&columns.shear, SINGLE_SHEAR, SINGLE);
        let scales = [(&columns.axes, SINGLE_AXIS), (&columns.channels, SINGLE_CHANNEL)];
        let scales = scales.into_iter().flat_map(|(columns, size)| columns.iter().map(move |c| (c, size)));
        let scales = scales.filter(|(column, size)| self.size_of(column, *size) > LEAST_SCALE - 1.0);
        let either = [(&columns.turns, SINGLE_TURN), (&columns.points, 1.0)];
        let either = either.into_iter().flat_map(|(columns, size)| columns.iter().map(move |c| (c, size)));
        let either = scales.chain(either);
        let either = either.filter_map(|(column, size)| Some(SINGLE + self.with(column, size)?));
        joints.chain(both).chain(shear).chain(either).collect()
    }

    /// The same with one joint, or the shear, that gives way by nobody knows how much.
    pub fn with_one_loose(&self, columns: &Columns) -> Vec<f64> {
        let both = columns.joints_both_ways();
        let joints = columns.joints.iter().chain(&both);
        let joints = joints.filter_map(|joint| Some(ONE_JOINT + self.softer(joint, LOOSE)?));
        joints.chain(self.softer(&columns.shear, LOOSE).map(|term| SINGLE + term)).collect()
    }

    /// With a part that gives way; `None` where it would do so by less than nothing.
    fn softer(&self, column: &DVector<f64>, size: f64) -> Option<f64> {
        if column.dot(&self.solved) > 0.0 { self.with(column, size) } else { None }
    }

    /// How much of a column there is, where its size is normal about none.
    fn size_of(&self, column: &DVector<f64>, size: f64) -> f64 {
        let own = self.root.l_dirty().solve_lower_triangular(column).map_or(0.0, |c| c.norm_squared());
        size * size * column.dot(&self.solved) / (1.0 + size * size * own)
    }

    /// With a column of a size that is normal about none: by the Sherman–Morrison formula.
    fn with(&self, column: &DVector<f64>, size: f64) -> Option<f64> {
        let projection = column.dot(&self.solved);
        // cᵀΣ⁻¹c = |L⁻¹c|²
        let along = self.root.l_dirty().solve_lower_triangular(column)?.norm_squared();
        let grown = 1.0 + size * size * along;
        Some(self.log_density + 0.5 * (size * projection).powi(2) / grown - 0.5 * grown.ln())
    }
}
