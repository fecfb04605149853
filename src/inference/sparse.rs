//! Columns that are mostly zero: a slip or an outlier concerns a few data of hundreds.

use nalgebra::{DMatrix, DVector};

use crate::linalg::transposed_product;

/// Share of a column that is not zero from which on it is stored whole.
const DENSE: f64 = 0.3;

/// Columns, those that are mostly zero as lists of what is not.
#[derive(Debug, Clone)]
pub(super) struct Sparse {
    /// One beside the other.
    whole: DMatrix<f64>,
    columns: Vec<Column>,
}

#[derive(Debug, Clone)]
enum Column {
    /// Which one of the whole columns.
    Whole(usize),
    Listed(Vec<(usize, f64)>),
}

impl Sparse {
    pub(super) fn new(dense: &DMatrix<f64>) -> Self {
        let mut whole = Vec::new();
        let mut of = |(index, column): (usize, nalgebra::DVectorView<'_, f64>)| {
            let count = column.iter().filter(|x| **x != 0.0).count();
            match count as f64 > DENSE * column.len() as f64 {
                true => {
                    whole.push(index);
                    Column::Whole(whole.len() - 1)
                }
                false => {
                    Column::Listed(column.iter().copied().enumerate().filter(|(_, x)| *x != 0.0).collect())
                }
            }
        };
        let columns = dense.column_iter().enumerate().map(&mut of).collect();
        Sparse { whole: dense.select_columns(&whole), columns }
    }

    pub(super) fn ncols(&self) -> usize {
        self.columns.len()
    }

    /// Cᵀv.
    pub(super) fn tr_mul(&self, v: &DVector<f64>) -> DVector<f64> {
        self.tr_mul_into(&DMatrix::from_column_slice(v.len(), 1, v.as_slice())).row(0).transpose()
    }

    /// SᵀC.
    pub(super) fn tr_mul_into(&self, dense: &DMatrix<f64>) -> DMatrix<f64> {
        let whole = transposed_product(dense, &self.whole);
        let mut products = DMatrix::zeros(dense.ncols(), self.ncols());
        for (column, mut product) in self.columns.iter().zip(products.column_iter_mut()) {
            match column {
                Column::Whole(index) => product.copy_from(&whole.column(*index)),
                Column::Listed(own) => {
                    for (p, other) in product.iter_mut().zip(dense.column_iter()) {
                        *p = own.iter().map(|&(row, x)| x * other[row]).sum();
                    }
                }
            }
        }
        products
    }
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
