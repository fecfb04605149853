//! Columns that are mostly zero: a slip or an outlier concerns a few data of hundreds.

use nalgebra::{DMatrix, DVector};

/// Share of a column that is not zero from which on it is stored whole.
const DENSE: f64 = 0.3;

/// Columns, those that are mostly zero as lists of what is not.
#[derive(Debug, Clone)]
pub(super) struct Sparse {
    columns: Vec<Column>,
}

#[derive(Debug, Clone)]
enum Column {
    Whole(Vec<f64>),
    Listed(Vec<(usize, f64)>),
}

impl Sparse {
    pub(super) fn new(dense: &DMatrix<f64>) -> Self {
        let of = |column: nalgebra::DVectorView<'_, f64>| {
            let count = column.iter().filter(|x| **x != 0.0).count();
            match count as f64 > DENSE * column.len() as f64 {
                true => Column::Whole(column.iter().copied().collect()),
                false => {
                    Column::Listed(column.iter().copied().enumerate().filter(|(_, x)| *x != 0.0).collect())
                }
            }
        };
        Sparse { columns: dense.column_iter().map(of).collect() }
    }

    pub(super) fn ncols(&self) -> usize {
        self.columns.len()
    }

    /// Cᵀv.
    pub(super) fn tr_mul(&self, v: &DVector<f64>) -> DVector<f64> {
        DVector::from_iterator(self.ncols(), self.columns.iter().map(|column| column.dot(v.as_slice())))
    }

    /// SᵀC.
    pub(super) fn tr_mul_into(&self, dense: &DMatrix<f64>) -> DMatrix<f64> {
        let (rows, all) = (dense.nrows(), dense.as_slice());
        DMatrix::from_fn(dense.ncols(), self.ncols(), |i, j| {
            self.columns[j].dot(&all[i * rows..(i + 1) * rows])
        })
    }
}

impl Column {
    fn dot(&self, v: &[f64]) -> f64 {
        match self {
            Column::Whole(own) => dot(own, v),
            Column::Listed(own) => own.iter().map(|&(i, x)| x * v[i]).sum(),
        }
    }
}

/// Four sums at a time, which a processor adds up at once.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a_whole, b_whole) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a_whole.remainder().iter().zip(b_whole.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a_whole.zip(b_whole) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    rest + sums.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_the_whole_columns() {
        let columns = DMatrix::from_fn(11, 3, |i, j| match j {
            0 => (i as f64).sin(),
            1 if i != 4 => 0.0,
            _ => 1.5 + i as f64,
        });
        let dense = DMatrix::from_fn(11, 2, |i, j| (i * 3 + j) as f64 % 5.0 - 2.0);
        let sparse = Sparse::new(&columns);
        assert!((sparse.tr_mul_into(&dense) - dense.tr_mul(&columns)).amax() < 1e-12);
        let v = dense.column(0).into_owned();
        assert!((sparse.tr_mul(&v) - columns.tr_mul(&v)).amax() < 1e-12);
    }
}
