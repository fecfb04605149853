//! Inverses of symmetric positive definite matrices, by Cholesky's decomposition A = L·Lᵀ.
//!
//! A fit that is repeated with another ridge each time needs the solution, the determinant and the
//! diagonal of the inverse, all of which X = L⁻¹ gives: the product XᵀX, as costly as the
//! decomposition itself, is needed once at the end.

use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_inverse::invert_lower_triangular;
use faer::{Accum, MatMut, Par, Side};
use nalgebra::{DMatrix, DVector};

use super::view;

/// From so many unknowns on faer's blocks are faster than going column by column.
const LARGE: usize = 24;

/// X = L⁻¹ of a matrix A = L·Lᵀ, so that A⁻¹ = XᵀX.
#[derive(Debug, Clone)]
pub struct InverseRoot {
    /// Lower triangle; zeros above.
    x: DMatrix<f64>,
    /// ln|A|.
    pub ln_determinant: f64,
}

/// A⁻¹ and ln|A| of a symmetric matrix, of which the lower triangle counts; `None` where it is not
/// positive definite.
pub fn positive_definite_inverse(a: &DMatrix<f64>) -> Option<(DMatrix<f64>, f64)> {
    let root = InverseRoot::new(a)?;
    Some((root.inverse(), root.ln_determinant))
}

impl InverseRoot {
    /// Of a symmetric matrix, of which the lower triangle counts; `None` where it is not positive
    /// definite.
    pub fn new(a: &DMatrix<f64>) -> Option<InverseRoot> {
        let n = a.ncols();
        if n < LARGE {
            return small(a);
        }
        let cholesky = view(a).llt(Side::Lower).ok()?;
        let diagonal = cholesky.L().diagonal().column_vector();
        let ln_determinant = (0..n).map(|k| 2.0 * diagonal[k].ln()).sum();
        let mut x = DMatrix::zeros(n, n);
        let target = MatMut::from_column_major_slice_mut(x.as_mut_slice(), n, n);
        invert_lower_triangular(target, cholesky.L(), Par::Seq);
        Some(InverseRoot { x, ln_determinant })
    }

    /// A⁻¹b = Xᵀ(X·b).
    pub fn solve(&self, b: &DVector<f64>) -> DVector<f64> {
        let n = b.len();
        let mut product = DVector::zeros(n);
        for (j, column) in self.x.column_iter().enumerate() {
            product.rows_mut(j, n - j).axpy(b[j], &column.rows(j, n - j), 1.0);
        }
        DVector::from_fn(n, |j, _| self.x.column(j).rows(j, n - j).dot(&product.rows(j, n - j)))
    }

    /// The diagonal of A⁻¹: (A⁻¹)ₖₖ = Σᵢ Xᵢₖ².
    pub fn diagonal_of_inverse(&self) -> DVector<f64> {
        let n = self.x.ncols();
        DVector::from_fn(n, |k, _| self.x.column(k).rows(k, n - k).norm_squared())
    }

    /// Inverse A⁻¹, n × n.
    pub fn inverse(&self) -> DMatrix<f64> {
        let n = self.x.ncols();
        let mut inverse = DMatrix::zeros(n, n);
        if n < LARGE {
            let x = self.x.as_slice();
            for j in 0..n {
                for i in 0..=j {
                    let (a, b) = (&x[i * n + j..][..n - j], &x[j * n + j..][..n - j]);
                    let product: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                    (inverse[(i, j)], inverse[(j, i)]) = (product, product);
                }
            }
            return inverse;
        }
        matmul(
            MatMut::from_column_major_slice_mut(inverse.as_mut_slice(), n, n),
            BlockStructure::TriangularLower,
            Accum::Replace,
            view(&self.x).transpose(),
            BlockStructure::TriangularUpper,
            view(&self.x),
            BlockStructure::TriangularLower,
            1.0,
            Par::Seq,
        );
        inverse.fill_upper_triangle_with_lower_triangle();
        inverse
    }
}

/// Column by column: of a few unknowns most of the time goes into anything else.
fn small(a: &DMatrix<f64>) -> Option<InverseRoot> {
    let n = a.ncols();
    let mut root = a.as_slice().to_vec();
    let mut ln_determinant = 0.0;
    for j in 0..n {
        let (before, behind) = root.split_at_mut((j + 1) * n);
        let own = &mut before[j * n..];
        // true for numbers only
        if !(own[j] > 0.0 && own[j].is_finite()) {
            return None;
        }
        ln_determinant += own[j].ln();
        let pivot = own[j].sqrt();
        own[j..].iter_mut().for_each(|value| *value /= pivot);
        for k in j + 1..n {
            let factor = own[k];
            let column = &mut behind[(k - j - 1) * n..][k..n];
            column.iter_mut().zip(&own[k..]).for_each(|(value, l)| *value -= factor * l);
        }
    }
    let mut x = vec![0.0; n * n];
    for (j, column) in x.chunks_exact_mut(n.max(1)).enumerate() {
        column[j] = 1.0;
        for i in j..n {
            let l = &root[i * n..][..n];
            column[i] /= l[i];
            let factor = column[i];
            column[i + 1..].iter_mut().zip(&l[i + 1..]).for_each(|(value, l)| *value -= factor * l);
        }
    }
    Some(InverseRoot { x: DMatrix::from_vec(n, n, x), ln_determinant })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::transposed_product;

    /// The Hilbert matrix 1/(i + j + 1) and 1 on the diagonal.
    fn positive_definite(n: usize) -> DMatrix<f64> {
        DMatrix::from_fn(n, n, |i, j| 1.0 / (i + j + 1) as f64) + DMatrix::identity(n, n)
    }

    #[test]
    fn an_inverse_small_or_large_is_one_and_a_matrix_without_is_refused() {
        for n in [1, 5, 23, 24, 40] {
            let a = positive_definite(n);
            let (inverse, ln_determinant) = positive_definite_inverse(&a).unwrap();
            assert!((transposed_product(&a, &inverse) - DMatrix::identity(n, n)).amax() < 1e-13, "{n}");
            assert!((ln_determinant - a.clone().lu().determinant().ln()).abs() < 1e-12, "{n}");
            assert!(positive_definite_inverse(&-a).is_none(), "{n}");
        }
    }

    #[test]
    fn the_root_solves_and_knows_the_diagonal() {
        for n in [0, 1, 5, 40] {
            let a = positive_definite(n);
            let b = DVector::from_fn(n, |k, _| (k as f64).cos());
            let root = InverseRoot::new(&a).unwrap();
            assert!((&a * root.solve(&b) - b).norm() < 1e-13, "{n}");
            assert!((root.diagonal_of_inverse() - root.inverse().diagonal()).norm() < 1e-13, "{n}");
        }
    }
}
