//! How far apart two sockets are by the angles and the robot's drawing alone.

use nalgebra::{DMatrix, DVector, Vector3};

use super::super::draft::Draft;
use super::Fit;
use super::density::weight_of;
use super::loaded_robot::LoadedRobot;
use super::means::without_means;
use super::priors::{prior_precision, sizes};
use super::residuals::{FitState, load, tips};
use crate::calibration::growth::growth;
use crate::linalg::transposed_product;

impl Fit {
    /// The distance of the means of two groups' tips and its standard deviation, m, with what the
    /// poses and the drawing leave of the robot's numbers: with N the normal matrix of the fit and
    /// g = ∂d/∂ρ,
    ///
    /// var d = gᵀN⁻¹g + s²·(1/Σw₁ + 1/Σw₂)
    ///
    /// A smaller arm with the same angles scatters less: the likeliest one is
    /// N⁻¹·∂(Σ ½·ln|JᵢJᵢᵀ|)/∂ρ from that of the fit ([`growth`]).
    ///
    /// `None` where a group has no rows, or nothing can be computed.
    pub fn distance(&self, draft: &Draft, body: &LoadedRobot, between: [usize; 2]) -> Option<(f64, f64)> {
        let state = FitState { setup: self.setup(body), bases: self.bases.clone() };
        let mut torque = vec![0.0; draft.joints.len()];
        let mut deflection = vec![Vector3::zeros(); draft.len()];
        load(draft, body, &state, &mut torque, &mut deflection);
        let mut block = DMatrix::zeros(3 * draft.len(), body.free.len() + 6 * state.bases.len());
        let tips = tips(draft, &state, &torque, &deflection, Some((&body.free, &mut block)));
        let lengths = self.lengths(draft, body);
        let weight: Vec<f64> = lengths.iter().map(|length| weight_of(length / self.scale)).collect();
        // the mean tip of a group, that of its columns, and what its rows count
        let mean = |group: usize| {
            let rows = || (0..draft.len()).filter(|&row| draft.group[row] == group);
            let counts: f64 = rows().map(|row| weight[row]).sum();
            let tip = rows().map(|row| tips[row] * weight[row]).sum::<Vector3<f64>>() / counts;
            let columns = rows().map(|row| block.rows(3 * row, 3) * weight[row]);
            let columns = columns.fold(DMatrix::zeros(3, block.ncols()), |sum, own| sum + own) / counts;
            (counts > 0.0).then_some((tip, columns, counts))
        };
        let (first, of_first, first_counts) = mean(between[0])?;
        let (second, of_second, second_counts) = mean(between[1])?;
        let apart = second - first;
        let along: DVector<f64> = (of_second - of_first).tr_mul(&apart.normalize());
        without_means(&mut block, draft, &weight);
        for (row, weight) in weight.iter().enumerate() {
            block.rows_mut(3 * row, 3).scale_mut(weight.sqrt() / self.scale);
        }
        let mut normal = transposed_product(&block, &block);
        let precision = prior_precision(&sizes(draft, body, &torque), block.ncols());
        precision.iter().enumerate().for_each(|(k, own)| normal[(k, k)] += own);
        let by_known = normal.cholesky()?.solve(&along);
        let scatter = self.scale.powi(2) * (first_counts.recip() + second_counts.recip());
        let sd = (along.dot(&by_known) + scatter).sqrt();
        let growth = growth(&state.setup, &body.free, &draft.joints, draft.joint_count);
        let larger: f64 = by_known.iter().zip(&growth).map(|(known, slope)| known * slope).sum();
        sd.is_finite().then_some((apart.norm() + larger, sd))
    }
}
