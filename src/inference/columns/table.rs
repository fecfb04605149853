//! Inner products of some vectors with the columns of all candidates.

use std::sync::Arc;

use nalgebra::{DMatrix, DMatrixView};

/// Vectors × the columns of all candidates, in one piece.
pub struct Table {
    /// The first column of each candidate, and the number of all.
    first: Arc<[usize]>,
    all: DMatrix<f64>,
}

impl Table {
    /// Of all products, and the first column of each candidate with the number of all.
    pub fn new(first: Arc<[usize]>, all: DMatrix<f64>) -> Table {
        Table { first, all }
    }

    /// Vectors × columns of a candidate.
    pub fn of(&self, candidate: usize) -> DMatrixView<'_, f64> {
        let (first, next) = (self.first[candidate], self.first[candidate + 1]);
        self.all.columns(first, next - first)
    }

    /// How many numbers it holds.
    pub fn len(&self) -> usize {
        self.all.len()
    }
}

/// Vectors of several tables, one below the other, × the columns of some candidates, beside each
/// other.
pub fn stacked(tables: &[&Table], candidates: &[usize]) -> DMatrix<f64> {
    let rows = tables.iter().map(|table| table.all.nrows()).sum();
    let count = |table: &&Table| candidates.iter().map(|&candidate| table.of(candidate).ncols()).sum();
    let mut stacked = DMatrix::zeros(rows, tables.first().map_or(0, count));
    let mut top = 0;
    for table in tables {
        let own = table.all.nrows();
        let mut next = 0;
        for block in candidates.iter().map(|&candidate| table.of(candidate)) {
            stacked.view_mut((top, next), (own, block.ncols())).copy_from(&block);
            next += block.ncols();
        }
        top += own;
    }
    stacked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_stand_below_and_beside_each_other() {
        let table = |rows: usize, from: f64| {
            let all = DMatrix::from_fn(rows, 4, |i, j| from + (10 * i + j) as f64);
            Table::new([0, 1, 3, 4].as_slice().into(), all)
        };
        let (one, two) = (table(1, 0.0), table(2, 100.0));
        assert_eq!(one.of(1), DMatrix::from_row_slice(1, 2, &[1.0, 2.0]));
        let both = stacked(&[&one, &two], &[2, 1]);
        let expected = [3.0, 1.0, 2.0, 103.0, 101.0, 102.0, 113.0, 111.0, 112.0];
        assert_eq!(both, DMatrix::from_row_slice(3, 3, &expected));
        assert_eq!(stacked(&[], &[0]).shape(), (0, 0));
    }
}
