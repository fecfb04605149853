//! Columns that are mostly zero: a slip or an outlier concerns a few data of hundreds.

use nalgebra::{DMatrix, DVector};

/// Columns as lists of what is not zero.
#[derive(Debug, Clone)]
pub(super) struct Sparse {
    columns: Vec<Vec<(usize, f64)>>,
}

impl Sparse {
    pub(super) fn new(dense: &DMatrix<f64>) -> Self {
        let of = |column: nalgebra::DVectorView<'_, f64>| {
            column.iter().copied().enumerate().filter(|(_, x)| *x != 0.0).collect()
        };
        Sparse { columns: dense.column_iter().map(of).collect() }
    }

    pub(super) fn ncols(&self) -> usize {
        self.columns.len()
    }

    /// Cᵀv.
    pub(super) fn tr_mul(&self, v: &DVector<f64>) -> DVector<f64> {
        DVector::from_iterator(self.ncols(), self.columns.iter().map(|c| dot(c, v.as_slice())))
    }

    /// SᵀC.
    pub(super) fn tr_mul_into(&self, dense: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(dense.ncols(), self.ncols(), |i, j| {
            dot(&self.columns[j], &dense.as_slice()[i * dense.nrows()..])
        })
    }
}

fn dot(sparse: &[(usize, f64)], dense: &[f64]) -> f64 {
    sparse.iter().map(|&(i, x)| x * dense[i]).sum()
}
