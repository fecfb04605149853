//! What a least-squares fit needs to know about a model: residuals and their derivatives.

use nalgebra::{DMatrix, DVector};

/// m residuals r(p) of n parameters p, to be made small.
pub trait Problem {
    /// n.
    fn parameter_count(&self) -> usize;

    /// m; fewer than n is allowed and leaves parameters not identified.
    fn residual_count(&self) -> usize;

    /// r(p), m values. NaN or ±∞ where the model does not exist.
    fn residuals(&self, parameters: &DVector<f64>) -> DVector<f64>;

    /// Jᵢⱼ = ∂rᵢ/∂pⱼ, m × n; [`central_differences`] for those who have no formula.
    fn jacobian(&self, parameters: &DVector<f64>) -> DMatrix<f64>;

    /// The same Jacobian in blocks of consecutive rows, from the first to the last: `visit` takes
    /// the index of a block's first row and the block, as many rows as there are × n.
    ///
    /// A fit asks for nothing else and forgets each block: a problem too tall to be held whole
    /// overrides this (and [`assembled`] is then its [`Problem::jacobian`]). The size of the blocks
    /// is free; the fit gathers small ones.
    fn jacobian_blocks(&self, parameters: &DVector<f64>, visit: &mut dyn FnMut(usize, &DMatrix<f64>)) {
        visit(0, &self.jacobian(parameters));
    }

    /// Absolute rounding error of one residual where it is more than that of the parameters, for
    /// example ε times the measured values of a model that reproduces them exactly; residuals below
    /// it are noise of the arithmetic.
    fn residual_rounding(&self) -> f64 {
        0.0
    }
}

/// The whole Jacobian, m × n, from [`Problem::jacobian_blocks`]: rows that belong to no block are
/// 0, and what of a block lies outside of the matrix is left out.
pub fn assembled(problem: &(impl Problem + ?Sized), parameters: &DVector<f64>) -> DMatrix<f64> {
    let mut j = DMatrix::zeros(problem.residual_count(), problem.parameter_count());
    problem.jacobian_blocks(parameters, &mut |first, block| {
        let rows = block.nrows().min(j.nrows().saturating_sub(first));
        let columns = block.ncols().min(j.ncols());
        if rows > 0 {
            j.view_mut((first, 0), (rows, columns)).copy_from(&block.view((0, 0), (rows, columns)));
        }
    });
    j
}

/// Jacobian of `residuals` by central differences, m × n:
///
/// ∂rᵢ/∂pⱼ ≈ (rᵢ(p + hⱼeⱼ) − rᵢ(p − hⱼeⱼ)) / 2hⱼ with hⱼ = ε^⅓ · max(|pⱼ|, sⱼ)
///
/// `sizes` are the sⱼ > 0: changes of the parameters that matter, in their units. About ten digits
/// are right.
pub fn central_differences(
    residuals: impl Fn(&DVector<f64>) -> DVector<f64>,
    parameters: &DVector<f64>,
    sizes: &DVector<f64>,
) -> DMatrix<f64> {
    let mut p = parameters.clone();
    let columns: Vec<DVector<f64>> = (0..p.len())
        .map(|j| {
            let h = f64::EPSILON.cbrt() * parameters[j].abs().max(sizes[j]);
            // the steps that were taken, after rounding
            let (above, below) = (parameters[j] + h, parameters[j] - h);
            p[j] = above;
            let mut column = residuals(&p);
            p[j] = below;
            column -= residuals(&p);
            p[j] = parameters[j];
            column / (above - below)
        })
        .collect();
    match columns.is_empty() {
        true => DMatrix::zeros(residuals(parameters).len(), 0),
        false => DMatrix::from_columns(&columns),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::dvector;

    #[test]
    fn central_differences_are_good_to_ten_digits() {
        let r = |p: &DVector<f64>| dvector![p[0].exp() * p[1], p[1].sin()];
        let j = central_differences(r, &dvector![0.7, 0.0], &dvector![1.0, 1.0]);
        let exact = nalgebra::dmatrix![0.0, 0.7f64.exp(); 0.0, 1.0];
        assert!((j - exact).norm() < 1e-10);
    }
}
