//! Dense Cholesky, as if nothing were known about the matrix: cubic in the number of elements.

use rodcal::compliance::Compliance;
use rodcal::rod::Rod;

use super::{CASES, Frame};

/// None where rounding has left the matrix without a positive pivot.
pub fn compliance(rod: &Rod, elements: usize) -> Option<Compliance> {
    let frame = Frame::of_rod(rod, elements);
    let size = frame.freedoms();
    let mut matrix = vec![0.0; size * size];
    let mut x = frame.assemble(|row, column, value| matrix[row * size + column] += value);
    factorise(&mut matrix, size)?;
    substitute(&matrix, size, &mut x);
    Some(frame.compliance(&x))
}

/// A = Uᵀ U, U in place of A's upper triangle, row by row.
fn factorise(a: &mut [f64], size: usize) -> Option<()> {
    for k in 0..size {
        let (upto_k, below) = a.split_at_mut((k + 1) * size);
        let row_k = &mut upto_k[k * size + k..];
        let pivot = row_k[0];
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        let root = pivot.sqrt();
        row_k.iter_mut().for_each(|value| *value /= root);
        for (step, row) in below.chunks_exact_mut(size).enumerate() {
            let right = &row_k[step + 1..];
            let factor = right[0];
            for (value, other) in row[k + step + 1..].iter_mut().zip(right) {
                *value -= factor * other;
            }
        }
    }
    Some(())
}

/// Uᵀ y = b, then U x = y, all load cases at once, x in place of b.
fn substitute(u: &[f64], size: usize, x: &mut [[f64; CASES]]) {
    for k in 0..size {
        let row = &u[k * size..][..size];
        x[k] = x[k].map(|value| value / row[k]);
        for (i, &factor) in row.iter().enumerate().skip(k + 1) {
            subtract(x, i, factor, k);
        }
    }
    for k in (0..size).rev() {
        let row = &u[k * size..][..size];
        for (i, &factor) in row.iter().enumerate().skip(k + 1) {
            subtract(x, k, factor, i);
        }
        x[k] = x[k].map(|value| value / row[k]);
    }
}

/// Row `i` less `factor` times row `j`.
fn subtract(x: &mut [[f64; CASES]], i: usize, factor: f64, j: usize) {
    let other = x[j];
    for (value, other) in x[i].iter_mut().zip(other) {
        *value -= factor * other;
    }
}
