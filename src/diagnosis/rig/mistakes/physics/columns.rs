//! What ordinary physics may add to the slopes, per unit of its size, m/N.

use nalgebra::{DMatrix, DVector};

pub(super) struct Columns {
    pub shear: DVector<f64>,
    pub joints: Vec<DVector<f64>>,
    pub points: Vec<DVector<f64>>,
    pub axes: Vec<DVector<f64>>,
    pub channels: Vec<DVector<f64>>,
    pub turns: Vec<DVector<f64>>,
    /// Σ c·cᵀ of the whole rod, shear, joints, axes, channels and turns: the same for all moods.
    pub squares: [DMatrix<f64>; 6],
    pub own: DVector<f64>,
}

impl Columns {
    /// What gives way in bending mostly does so in torsion.
    pub fn joints_both_ways(&self) -> Vec<DVector<f64>> {
        self.joints
            .chunks(2)
            .map(|both| both.iter().fold(DVector::zeros(both[0].len()), |a, b| a + b))
            .collect()
    }
}
