//! Measurements that could be made, and the products of their rows with matrices.

use nalgebra::{DMatrix, Matrix3, Matrix3xX, MatrixXx3};

/// Measurements of three readings each, in groups.
#[derive(Debug, Clone)]
pub struct Measurements {
    columns: usize,
    /// The first row of the first measurement, its second, its third, the first row of the second …
    rows: Vec<f64>,
    groups: Vec<usize>,
}

impl Measurements {
    /// None yet, of so many unknowns.
    pub fn new(columns: usize) -> Self {
        Measurements { columns, rows: Vec::new(), groups: Vec::new() }
    }

    /// One more: ∂reading/∂unknown, divided by the noise of the readings.
    pub fn push(&mut self, group: usize, rows: &Matrix3xX<f64>) {
        for row in rows.row_iter() {
            self.rows.extend(row.iter().take(self.columns));
        }
        self.groups.push(group);
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.groups.len()
    }

    /// True where there are none.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    /// Number of unknowns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The group of a measurement.
    pub fn group(&self, index: usize) -> usize {
        self.groups[index]
    }

    /// The measurements of a group.
    pub fn of_group(&self, group: usize) -> impl Iterator<Item = usize> {
        (0..self.len()).filter(move |&index| self.groups[index] == group)
    }

    /// Divides every column by its factor.
    pub fn scale(&mut self, factors: &[f64]) {
        for row in self.rows.chunks_mut(self.columns.max(1)) {
            row.iter_mut().zip(factors).for_each(|(entry, factor)| *entry /= factor);
        }
    }

    /// The same measurements of other unknowns: each of the old ones is a sum of these, a row of
    /// `basis`.
    pub fn in_basis(&self, basis: &DMatrix<f64>) -> Measurements {
        let columns = basis.ncols();
        let mut rows = Vec::with_capacity(3 * self.len() * columns);
        for row in self.rows.chunks(self.columns.max(1)) {
            let entry = |k: usize| row.iter().zip(basis.column(k).iter()).map(|(a, b)| a * b).sum::<f64>();
            rows.extend((0..columns).map(entry));
        }
        Measurements { columns, rows, groups: self.groups.clone() }
    }

    /// Norms of the columns over all measurements; 1 for a column of zeros.
    pub fn column_norms(&self) -> Vec<f64> {
        let mut squares = vec![0.0; self.columns];
        for row in self.rows.chunks(self.columns.max(1)) {
            squares.iter_mut().zip(row).for_each(|(square, entry)| *square += entry * entry);
        }
        squares.into_iter().map(|square: f64| if square > 0.0 { square.sqrt() } else { 1.0 }).collect()
    }

    fn row(&self, index: usize, row: usize) -> &[f64] {
        &self.rows[(3 * index + row) * self.columns..][..self.columns]
    }

    /// M = Λ + Σ JᵀJ of some of them.
    pub fn information(&self, chosen: &[usize], before: &DMatrix<f64>) -> DMatrix<f64> {
        let mut rows = DMatrix::zeros(3 * chosen.len(), self.columns);
        for (at, &index) in chosen.iter().enumerate() {
            for row in 0..3 {
                rows.row_mut(3 * at + row).iter_mut().zip(self.row(index, row)).for_each(|(a, b)| *a = *b);
            }
        }
        before + crate::linalg::transposed_product(&rows, &rows)
    }

    /// J·A for a matrix of three columns.
    pub(super) fn times(&self, index: usize, a: &MatrixXx3<f64>) -> Matrix3<f64> {
        let mut product = Matrix3::zeros();
        for (row, of_row) in (0..3).map(|row| (row, self.row(index, row))) {
            let (mut x, mut y, mut z) = (0.0, 0.0, 0.0);
            let columns = a.as_slice().split_at(self.columns);
            let (second, third) = columns.1.split_at(self.columns);
            for (((entry, a), b), c) in of_row.iter().zip(columns.0).zip(second).zip(third) {
                x += entry * a;
                y += entry * b;
                z += entry * c;
            }
            (product[(row, 0)], product[(row, 1)], product[(row, 2)]) = (x, y, z);
        }
        product
    }

    /// A·Jᵀ.
    pub(super) fn spread(&self, index: usize, a: &DMatrix<f64>) -> MatrixXx3<f64> {
        let count = a.nrows().max(1);
        let mut product = MatrixXx3::zeros(a.nrows());
        // slices, for the compiler makes vectors of them
        for (row, target) in product.as_mut_slice().chunks_exact_mut(count).enumerate() {
            for (entry, column) in self.row(index, row).iter().zip(a.as_slice().chunks_exact(count)) {
                target.iter_mut().zip(column).for_each(|(t, a)| *t += entry * a);
            }
        }
        product
    }

    /// J·A·Jᵀ.
    pub(super) fn quadratic(&self, index: usize, a: &DMatrix<f64>) -> Matrix3<f64> {
        self.times(index, &self.spread(index, a))
    }
}
