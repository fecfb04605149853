//! Dense decompositions for least squares: QR (of rows that arrive in pieces, too), thin SVD, rank
//! and condition number. All of them run on the calling thread, so that the same input gives the
//! same bytes.
//!
//! The only room that names faer. Matrices come in and go out as nalgebra's; both libraries store
//! columns one after the other, so faer reads them in place.

mod inverse_root;

use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::matmul::matmul;
use faer::linalg::qr::no_pivoting::factor;
use faer::linalg::solvers::SolveLstsqCore;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use nalgebra::{DMatrix, DVector};

pub use self::inverse_root::{InverseRoot, positive_definite_inverse};

use crate::error::{Error, Result};
use crate::parallel::checkpoint;

/// Singular value decomposition A = U·diag(σ)·Vᵀ of an m × n matrix, thin: k = min(m, n) columns in
/// U and V.
#[derive(Debug, Clone)]
pub struct Svd {
    /// Left singular vectors, m × k, orthonormal columns.
    pub u: DMatrix<f64>,
    /// Singular values, largest first, k of them.
    pub singular_values: DVector<f64>,
    /// Right singular vectors, n × k, orthonormal columns.
    pub v: DMatrix<f64>,
}

impl Svd {
    /// Number of singular values above `tolerance · σ₁`; 0 for a matrix of zeros.
    ///
    /// [`rounding_tolerance`] is the tolerance for a matrix known to the last digit; one that was
    /// measured or differenced deserves a larger one (Golub & Van Loan, *Matrix Computations*, 4th
    /// ed., §5.4.1).
    pub fn rank(&self, tolerance: f64) -> usize {
        let largest = self.singular_values.iter().fold(0.0, |a: f64, &b| a.max(b));
        self.singular_values.iter().filter(|&&s| s > tolerance * largest).count()
    }

    /// σ₁/σₖ; infinite for a singular matrix, 1 for an empty one.
    pub fn condition_number(&self) -> f64 {
        let sigma = self.singular_values.as_slice();
        match (sigma.first(), sigma.last()) {
            (Some(_), Some(0.0)) => f64::INFINITY,
            (Some(largest), Some(smallest)) => largest / smallest,
            _ => 1.0,
        }
    }
}

/// Rank tolerance for an m × n matrix that is exact to the last digit: max(m, n)·ε.
pub fn rounding_tolerance(a: &DMatrix<f64>) -> f64 {
    a.nrows().max(a.ncols()) as f64 * f64::EPSILON
}

/// Thin singular value decomposition; see [`Svd`].
///
/// # Errors
/// [`Error::Numerical`] where an entry is not finite or the iteration does not converge.
pub fn thin_svd(a: &DMatrix<f64>) -> Result<Svd> {
    checkpoint();
    require_finite("the singular value decomposition", a)?;
    let (m, n) = a.shape();
    let k = m.min(n);
    if k == 0 {
        return Ok(Svd {
            u: DMatrix::zeros(m, 0),
            singular_values: DVector::zeros(0),
            v: DMatrix::zeros(n, 0),
        });
    }
    let svd = view(a).thin_svd().map_err(|e| Error::Numerical {
        what: "the singular value decomposition",
        why: format!("it did not converge ({e:?})"),
    })?;
    let sigma = svd.S().column_vector();
    Ok(Svd { u: owned(svd.U()), singular_values: DVector::from_fn(k, |i, _| sigma[i]), v: owned(svd.V()) })
}

/// The n × x that minimises ‖A·x − b‖, for an m × n matrix A of full column rank.
///
/// Columns are first brought to norm 1, so that their units do not matter, then A·P = Q·R with
/// column pivoting.
///
/// # Errors
/// [`Error::Numerical`] where A has fewer rows than columns, lacks full rank (a pivot below
/// [`rounding_tolerance`] of the first) or holds an entry that is not finite.
pub fn least_squares(a: &DMatrix<f64>, b: &DVector<f64>) -> Result<DVector<f64>> {
    const WHAT: &str = "the least-squares solution";
    let (m, n) = a.shape();
    if m < n || b.len() != m {
        let why = format!("{m} equations with {} right-hand sides do not determine {n} unknowns", b.len());
        return Err(Error::Numerical { what: WHAT, why });
    }
    require_finite(WHAT, a)?;
    require_finite(WHAT, b)?;
    let (scaled, norms) = with_unit_columns(a);
    let qr = view(&scaled).col_piv_qr();
    let r = qr.thin_R();
    let rank = (0..n).filter(|&i| r[(i, i)].abs() > rounding_tolerance(a) * r[(0, 0)].abs()).count();
    if rank < n {
        return Err(Error::Numerical {
            what: WHAT,
            why: format!("the matrix has rank {rank}, {n} are needed"),
        });
    }
    let mut x = b.clone();
    let right = faer::MatMut::from_column_major_slice_mut(x.as_mut_slice(), m, 1);
    qr.solve_lstsq_in_place_with_conj(faer::Conj::No, right);
    Ok(DVector::from_fn(n, |j, _| x[j] / norms[j]))
}

/// Product AᵀB, n × k of an m × n and an m × k matrix.
pub fn transposed_product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    checkpoint();
    let mut product = DMatrix::zeros(a.ncols(), b.ncols());
    let target = MatMut::from_column_major_slice_mut(product.as_mut_slice(), a.ncols(), b.ncols());
    matmul(target, Accum::Replace, view(a).transpose(), view(b), 1.0, Par::Seq);
    product
}

/// Condition number σ₁/σₖ of a matrix as it stands, without scaling its columns.
///
/// # Errors
/// See [`thin_svd`].
pub fn condition_number(a: &DMatrix<f64>) -> Result<f64> {
    Ok(thin_svd(a)?.condition_number())
}

/// Number of singular values above `tolerance · σ₁`; see [`Svd::rank`].
///
/// # Errors
/// See [`thin_svd`].
pub fn rank(a: &DMatrix<f64>, tolerance: f64) -> Result<usize> {
    Ok(thin_svd(a)?.rank(tolerance))
}

/// The upper triangle R (n × n) and the vector Qᵀb (n) of the thin decomposition A = Q·R.
///
/// With them ‖A·x − b‖² = ‖R·x − Qᵀb‖² + a constant, for every x. An A with fewer rows than columns
/// is continued with rows of zeros.
///
/// # Errors
/// [`Error::Numerical`] where an entry is not finite.
pub fn triangular(a: &DMatrix<f64>, b: &DVector<f64>) -> Result<(DMatrix<f64>, DVector<f64>)> {
    const WHAT: &str = "the QR decomposition";
    require_finite(WHAT, a)?;
    require_finite(WHAT, b)?;
    let (m, n) = a.shape();
    let mut rows = RowReduction::new(n + 1, m);
    // Qᵀb is the last column of the triangle of [A b]: Q itself is never formed
    rows.push(m, |range, column, entries| {
        let source = if column == n { b.column(0) } else { a.column(column) };
        entries.copy_from_slice(&source.as_slice()[range]);
    });
    let both = rows.triangle();
    Ok((both.view((0, 0), (n, n)).into_owned(), both.view((0, n), (n, 1)).column(0).into_owned()))
}

/// Rows of a tall matrix A, reduced to the triangle R of A = Q·R while they arrive, in the memory
/// of a few hundred.
///
/// When the store is full, its rows give way to their triangle, on which the next ones are stacked:
/// [R; Aₖ] → R (Lawson & Hanson, *Solving Least Squares Problems*, 1974, ch. 27). A matrix that
/// fits the store takes one QR.
pub struct RowReduction {
    /// Column after column; rows from `filled` on are free.
    store: DMatrix<f64>,
    filled: usize,
    coefficients: Mat<f64>,
    scratch: MemBuffer,
}

impl RowReduction {
    /// Fewest rows to reduce at once: below, the triangle on top of them costs too much.
    const ROWS: usize = 512;

    /// For a matrix of `columns` columns and about `rows` rows (more are welcome).
    pub fn new(columns: usize, rows: usize) -> Self {
        let capacity = rows.min(columns + Self::ROWS.max(8 * columns)).max(columns + 1);
        let block = block_size(columns);
        let scratch =
            factor::qr_in_place_scratch::<f64>(capacity, columns, block, Par::Seq, Default::default());
        RowReduction {
            store: DMatrix::zeros(capacity, columns),
            filled: 0,
            coefficients: Mat::zeros(block, columns),
            scratch: MemBuffer::new(scratch),
        }
    }

    /// Forgets all rows and keeps the memory.
    pub fn clear(&mut self) {
        self.filled = 0;
    }

    /// Adds `count` finite rows. `fill(range, column, entries)` writes the entries of one column in
    /// the rows `range`, counted from the first of these.
    pub fn push(&mut self, count: usize, mut fill: impl FnMut(Range<usize>, usize, &mut [f64])) {
        let capacity = self.store.nrows();
        let mut done = 0;
        while done < count {
            checkpoint();
            if self.filled == capacity {
                self.reduce();
            }
            let taken = (count - done).min(capacity - self.filled);
            for (column, entries) in self.store.as_mut_slice().chunks_exact_mut(capacity).enumerate() {
                fill(done..done + taken, column, &mut entries[self.filled..self.filled + taken]);
            }
            done += taken;
            self.filled += taken;
        }
    }

    /// R of all rows so far, square, with zeros where there were fewer rows than columns.
    pub fn triangle(&mut self) -> DMatrix<f64> {
        self.reduce();
        let n = self.store.ncols();
        DMatrix::from_fn(n, n, |i, j| if i < self.filled { self.store[(i, j)] } else { 0.0 })
    }

    /// Replaces the rows by their triangle.
    fn reduce(&mut self) {
        let (capacity, n) = self.store.shape();
        let size = self.filled.min(n);
        if size == 0 {
            return;
        }
        let rows = MatMut::from_column_major_slice_mut(self.store.as_mut_slice(), capacity, n);
        factor::qr_in_place(
            rows.subrows_mut(0, self.filled),
            self.coefficients.as_mut().submatrix_mut(0, 0, block_size(size), size),
            Par::Seq,
            MemStack::new(&mut self.scratch),
            Default::default(),
        );
        // below the diagonal stand the reflections
        for j in 0..n {
            for i in j + 1..size {
                self.store[(i, j)] = 0.0;
            }
        }
        self.filled = size;
    }
}

/// Reflections applied at once: faer's recommendation for the triangle. That for the tall matrix,
/// which goes by its area, is slower.
fn block_size(columns: usize) -> usize {
    factor::recommended_block_size::<f64>(columns, columns)
}

/// Euclidean norm of every column; 1 for a column of zeros, so that one can divide by it.
pub fn column_norms(a: &DMatrix<f64>) -> DVector<f64> {
    let norm_or_one = |norm: f64| if norm > 0.0 { norm } else { 1.0 };
    DVector::from_iterator(a.ncols(), a.column_iter().map(|c| norm_or_one(c.norm())))
}

/// A with every column divided by its Euclidean norm, and the norms. A column of zeros stays, with
/// norm 1.
pub fn with_unit_columns(a: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let norms = column_norms(a);
    (DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] / norms[j]), norms)
}

fn view(a: &DMatrix<f64>) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(a.as_slice(), a.nrows(), a.ncols())
}

fn owned(a: MatRef<'_, f64>) -> DMatrix<f64> {
    DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
}

fn require_finite<'a>(what: &'static str, entries: impl IntoIterator<Item = &'a f64>) -> Result<()> {
    match entries.into_iter().find(|x| !x.is_finite()) {
        Some(x) => Err(Error::Numerical { what, why: format!("an entry is {x}") }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{dmatrix, dvector};

    /// The Hilbert matrix 1/(i + j + 1), a standard of bad condition.
    fn hilbert(n: usize) -> DMatrix<f64> {
        DMatrix::from_fn(n, n, |i, j| 1.0 / (i + j + 1) as f64)
    }

    #[test]
    fn a_straight_line_through_four_points() {
        // y = 3.5 + 1.4·x is the textbook answer for these four points
        let a = dmatrix![1.0, 1.0; 1.0, 2.0; 1.0, 3.0; 1.0, 4.0];
        let x = least_squares(&a, &dvector![6.0, 5.0, 7.0, 10.0]).unwrap();
        assert!((x - dvector![3.5, 1.4]).norm() < 1e-13);
    }

    #[test]
    fn units_of_columns_do_not_decide_the_rank() {
        let a = dmatrix![1.0, 1e-20; 1.0, 2e-20; 1.0, 3e-20];
        let x = least_squares(&a, &dvector![1.0, 2.0, 3.0]).unwrap();
        assert!((x[1] - 1e20).abs() < 1e7 && x[0].abs() < 1e-12);
    }

    #[test]
    fn a_dependent_column_is_refused() {
        let a = dmatrix![1.0, 2.0; 2.0, 4.0; 3.0, 6.0];
        let error = least_squares(&a, &dvector![1.0, 2.0, 3.0]).unwrap_err();
        assert_eq!(error.to_string(), "the least-squares solution: the matrix has rank 1, 2 are needed");
        assert_eq!(rank(&a, rounding_tolerance(&a)).unwrap(), 1);
    }

    #[test]
    fn the_svd_reproduces_the_matrix_wide_and_tall() {
        for a in [dmatrix![3.0, 1.0, 2.0; -1.0, 4.0, 0.5], dmatrix![3.0, -1.0; 1.0, 4.0; 2.0, 0.5]] {
            let svd = thin_svd(&a).unwrap();
            let product = &svd.u * DMatrix::from_diagonal(&svd.singular_values) * svd.v.transpose();
            assert!((product - &a).norm() < 1e-14);
        }
    }

    #[test]
    fn the_condition_of_the_hilbert_matrix_is_the_published_one() {
        // cond₂(H₅) = 4.76607e5: Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed.,
        // ch. 28
        assert!((condition_number(&hilbert(5)).unwrap() / 4.76607e5 - 1.0).abs() < 1e-5);
        assert_eq!(condition_number(&DMatrix::zeros(2, 2)).unwrap(), f64::INFINITY);
    }

    #[test]
    fn the_triangle_keeps_the_length_of_every_combination() {
        let a = dmatrix![1.0, 2.0; 3.0, -4.0; 5.0, 6.0];
        let b = dvector![1.0, 0.5, -2.0];
        let (r, c) = triangular(&a, &b).unwrap();
        assert!((r.transpose() * &r - a.transpose() * &a).norm() < 1e-13);
        assert!((r.transpose() * c - a.transpose() * b).norm() < 1e-13);
    }

    #[test]
    fn a_wide_matrix_has_a_triangle_too() {
        let a = dmatrix![1.0, 2.0, 3.0];
        let (r, c) = triangular(&a, &dvector![2.0]).unwrap();
        assert!((r.transpose() * &r - a.transpose() * &a).norm() < 1e-13);
        assert!((r.transpose() * c - a.transpose() * 2.0).norm() < 1e-13);
    }

    #[test]
    fn rows_in_pieces_have_the_triangle_of_the_whole() {
        let a = DMatrix::from_fn(1500, 3, |i, j| ((7 * i + 3 * j) % 11) as f64 + (i * j) as f64 / 100.0);
        let mut rows = RowReduction::new(3, a.nrows());
        assert!(rows.store.nrows() < 600);
        for (first, count) in [(0, 1), (1, 1200), (1201, 299)] {
            rows.push(count, |range, column, entries| {
                entries.copy_from_slice(&a.column(column).as_slice()[first + range.start..first + range.end]);
            });
        }
        let r = rows.triangle();
        assert!((r.transpose() * &r - a.transpose() * &a).norm() < 1e-13 * (a.transpose() * &a).norm());
        assert!(r.lower_triangle().norm() == r.diagonal().norm());
        rows.clear();
        assert_eq!(rows.triangle(), DMatrix::zeros(3, 3));
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        let error = thin_svd(&dmatrix![1.0, f64::NAN]).unwrap_err();
        assert_eq!(error.to_string(), "the singular value decomposition: an entry is NaN");
    }
}
