//! The linearised problem after its one QR decomposition: everything m rows say about n parameters,
//! in n rows.
//!
//! With J = Q·R and c = Qᵀr, for every step δ
//!
//! ‖r + J·δ‖² = ‖c + R·δ‖² + a constant.
//!
//! Nothing in the search needs J after that: its columns have the norms of R's, and Jᵀr = Rᵀc.

use nalgebra::{DMatrix, DVector};

use crate::error::Result;
use crate::linalg::{column_norms, triangular};

/// R and c.
#[derive(Debug, Clone)]
pub(super) struct Reduced {
    /// n × n, upper triangle.
    r: DMatrix<f64>,
    /// n.
    c: DVector<f64>,
}

impl Reduced {
    /// From the triangle of [J r], (n + 1) × (n + 1).
    pub fn new(both: &DMatrix<f64>) -> Self {
        let n = both.ncols() - 1;
        Reduced {
            r: both.view((0, 0), (n, n)).into_owned(),
            c: both.view((0, n), (n, 1)).column(0).into_owned(),
        }
    }

    /// Of a point nothing is known about: no parameter has an influence.
    pub fn unknown(n: usize) -> Self {
        Reduced { r: DMatrix::zeros(n, n), c: DVector::zeros(n) }
    }

    /// Jᵀr, half the gradient of the sum of squares.
    pub fn gradient(&self) -> DVector<f64> {
        self.r.tr_mul(&self.c)
    }

    /// Norms of J's columns, 0 for a column of zeros.
    pub fn influences(&self) -> DVector<f64> {
        DVector::from_iterator(self.r.ncols(), self.r.column_iter().map(|c| c.norm()))
    }

    /// Norms of J's columns, 1 for a column of zeros.
    pub fn column_norms(&self) -> DVector<f64> {
        column_norms(&self.r)
    }

    /// ‖r‖² − ‖r + J·δ‖², without the cancellation of the difference.
    pub fn predicted_reduction(&self, step: &DVector<f64>) -> f64 {
        let s = &self.r * step;
        // −2·(J·δ)ᵀr − ‖J·δ‖²
        -s.dot(&(&s + 2.0 * &self.c))
    }

    /// Triangle and c of the columns `free`, divided by their `scale`: R·D⁻¹ where all are free.
    pub fn columns(&self, free: &[usize], scale: &DVector<f64>) -> Result<(DMatrix<f64>, DVector<f64>)> {
        let n = self.r.nrows();
        let scaled = DMatrix::from_fn(n, free.len(), |i, k| self.r[(i, free[k])] / scale[k]);
        match free.len() == n {
            true => Ok((scaled, self.c.clone())),
            // with columns left out it is no triangle any more
            false => triangular(&scaled, &self.c),
        }
    }
}
