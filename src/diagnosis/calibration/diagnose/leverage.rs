//! What poses leave, made alike.
//!
//! A calibration follows each of its poses: what it leaves of a row has the covariance σ²·V,
//! V = 1 − H, H the row's block of the hat matrix X·(XᵀX + Λ)⁻¹·Xᵀ of all that is fitted. A row
//! that has a place of its own is predicted by the others; what it is off by has σ²·V⁻¹ (R. D.
//! Cook, S. Weisberg, *Residuals and Influence in Regression*, 1982, 2.2). With forty poses and as
//! many numbers the two are a factor of two apart in standard deviations, so that every row left
//! out looks far out. Alike are
//!
//! ```text
//! V^(−½)·left of a row that is fitted       V^½·left of one that is predicted
//! ```

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::error::Result;
use crate::inference::Evidence;
use crate::linalg::{thin_svd, with_unit_columns};

/// Singular value, relative to the largest, below which a direction fits nothing.
const NOTHING: f64 = 1e-9;
/// Least eigenvalue of V: what is fitted altogether leaves nothing but rounding.
const LEAST: f64 = 1e-6;

/// What is left of each row, all with the variance of the noise σ; `columns`, each times what is
/// usual, are fitted too.
pub fn alike(
    evidence: &Evidence,
    columns: &[DMatrix<f64>],
    left: &DVector<f64>,
    noise: f64,
    is_predicted: &dyn Fn(usize) -> bool,
) -> Result<Vec<Vector3<f64>>> {
    Ok(rows_alike(&basis(evidence, columns, noise)?, evidence.recorded / 3, left, is_predicted))
}

/// The same of what a fit of all that leaves, whatever was found before.
pub fn fitted_alike(evidence: &Evidence, columns: &[DMatrix<f64>], noise: f64) -> Result<Vec<Vector3<f64>>> {
    let basis = basis(evidence, columns, noise)?;
    let mut left = evidence.residual.clone().resize_vertically(basis.nrows(), 0.0);
    left -= &basis * basis.tr_mul(&left);
    Ok(rows_alike(&basis, evidence.recorded / 3, &left, &|_| false))
}

fn rows_alike(
    basis: &DMatrix<f64>,
    rows: usize,
    left: &DVector<f64>,
    is_predicted: &dyn Fn(usize) -> bool,
) -> Vec<Vector3<f64>> {
    let row = |row: usize| {
        let own = basis.rows(3 * row, 3);
        let hat = Matrix3::from_fn(|i, j| own.row(i).dot(&own.row(j)));
        let parts = (Matrix3::identity() - hat).symmetric_eigen();
        let power = if is_predicted(row) { 0.5 } else { -0.5 };
        let left = Vector3::from_fn(|k, _| left[3 * row + k]);
        let along = parts.eigenvectors.tr_mul(&left);
        parts.eigenvectors
            * along.zip_map(&parts.eigenvalues, |along, own| along * own.max(LEAST).powf(power))
    };
    (0..rows).map(row).collect()
}

/// Orthonormal basis of all that is fitted: first what nobody knows beforehand, then what is known,
/// whose factors are standard normal, as if each had been read to be 0 ± 1.
fn basis(evidence: &Evidence, columns: &[DMatrix<f64>], noise: f64) -> Result<DMatrix<f64>> {
    let blocks: Vec<&DMatrix<f64>> =
        [&evidence.nuisance, &evidence.background, &evidence.nominal].into_iter().chain(columns).collect();
    let (data, unknown) = (evidence.residual.len(), evidence.nuisance.ncols());
    let count: usize = blocks.iter().map(|block| block.ncols()).sum();
    let mut fitted = DMatrix::zeros(data + count - unknown, count);
    let mut first = 0;
    for block in blocks {
        fitted.view_mut((0, first), block.shape()).copy_from(block);
        first += block.ncols();
    }
    for known in unknown..count {
        fitted[(data + known - unknown, known)] = noise;
    }
    let svd = thin_svd(&with_unit_columns(&fitted).0)?;
    let rank = svd.rank(NOTHING);
    Ok(svd.u.columns(0, rank).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// Sums of squares of what is left of the first row and of all others, of many recordings, over
    /// how many numbers they are; the first row is fitted, or predicted.
    fn squares(is_predicted: bool) -> (f64, f64) {
        const ROWS: usize = 12;
        const NOISE: f64 = 0.4;
        let mut random = Random::seeded(7, 2);
        let mut matrix = |count: usize| DMatrix::from_fn(3 * ROWS, count, |_, _| random.normal());
        let (nuisance, background) = (matrix(14), matrix(6));
        let mut sums = (0.0, 0.0);
        let times = 400;
        for _ in 0..times {
            let known = DVector::from_fn(6, |_, _| random.normal());
            let noise = DVector::from_fn(3 * ROWS, |_, _| NOISE * random.normal());
            let residual = noise + &background * known;
            let mut evidence = Evidence::new(residual.clone());
            (evidence.nuisance, evidence.background) = (nuisance.clone(), background.clone());
            // generalised least squares of the rows that are fitted
            let from = if is_predicted { 3 } else { 0 };
            let rows = |all: &DMatrix<f64>| all.rows_range(from..).into_owned();
            let mut design = DMatrix::zeros(3 * ROWS - from + 6, 20);
            design.view_mut((0, 0), (3 * ROWS - from, 14)).copy_from(&rows(&nuisance));
            design.view_mut((0, 14), (3 * ROWS - from, 6)).copy_from(&rows(&background));
            (0..6).for_each(|k| design[(3 * ROWS - from + k, 14 + k)] = NOISE);
            let mut read = DVector::zeros(design.nrows());
            read.rows_mut(0, 3 * ROWS - from).copy_from(&residual.rows_range(from..));
            let found = crate::linalg::least_squares(&design, &read).unwrap();
            let left = residual - &nuisance * found.rows(0, 14) - &background * found.rows(14, 6);
            let alike = alike(&evidence, &[], &left, NOISE, &|row| is_predicted && row == 0).unwrap();
            let square = |rows: &[Vector3<f64>]| rows.iter().map(Vector3::norm_squared).sum::<f64>();
            sums.0 += square(&alike[..1]) / (3 * times) as f64 / NOISE.powi(2);
            sums.1 += square(&alike[1..]) / (3 * (ROWS - 1) * times) as f64 / NOISE.powi(2);
        }
        sums
    }

    /// Half of the numbers are fitted away; the row that is predicted is known by hardly more than
    /// there is to fit.
    #[test]
    fn rows_that_are_fitted_and_rows_that_are_predicted_scatter_alike() {
        let (first, others) = squares(false);
        assert!((first - 1.0).abs() < 0.15 && (others - 1.0).abs() < 0.05, "{first} {others}");
        let (first, others) = squares(true);
        // the others are fitted a little closer without it
        assert!((first - 1.0).abs() < 0.15 && (others - 0.9).abs() < 0.15, "{first} {others}");
    }
}
