//! Banded Cholesky: a chain numbered from end to end couples a freedom with eleven others before
//! it.

use rodcal::compliance::Compliance;
use rodcal::rod::Rod;

use super::{CASES, Frame, NODE};

/// Freedoms of two neighbouring nodes: row i of the lower triangle holds columns i − 11 … i.
const BAND: usize = 2 * NODE;

/// None where rounding has left the matrix without a positive pivot.
pub fn compliance(rod: &Rod, elements: usize) -> Option<Compliance> {
    let frame = Frame::of_rod(rod, elements);
    let mut matrix = vec![[0.0; BAND]; frame.freedoms()];
    let mut x = frame.assemble(|row, column, value| {
        if column <= row {
            matrix[row][BAND - 1 + column - row] += value;
        }
    });
    factorise(&mut matrix)?;
    substitute(&matrix, &mut x);
    Some(frame.compliance(&x))
}

/// A = L Lᵀ, L in place of A.
fn factorise(a: &mut [[f64; BAND]]) -> Option<()> {
    for i in 0..a.len() {
        let (above, this) = a.split_at_mut(i);
        let row = &mut this[0];
        let first = i.saturating_sub(BAND - 1);
        for (j, other) in above.iter().enumerate().skip(first) {
            // L_ij = (A_ij − Σ_k L_ik L_jk)/L_jj; column k of row j lies i − j places further right
            // than in row i
            let (shift, at) = (i - j, BAND - 1 + j - i);
            let start = BAND - 1 + first - i;
            let products = row[start..at].iter().zip(&other[start + shift..]).map(|(a, b)| a * b);
            let sum: f64 = products.sum();
            row[at] = (row[at] - sum) / other[BAND - 1];
        }
        let pivot = row[BAND - 1] - row[..BAND - 1].iter().map(|l| l * l).sum::<f64>();
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        row[BAND - 1] = pivot.sqrt();
    }
    Some(())
}

/// L y = b, then Lᵀ x = y, all load cases at once, x in place of b.
fn substitute(l: &[[f64; BAND]], x: &mut [[f64; CASES]]) {
    for i in 0..l.len() {
        for j in i.saturating_sub(BAND - 1)..i {
            subtract(x, i, l[i][BAND - 1 + j - i], j);
        }
        x[i] = x[i].map(|value| value / l[i][BAND - 1]);
    }
    for i in (0..l.len()).rev() {
        x[i] = x[i].map(|value| value / l[i][BAND - 1]);
        for j in i.saturating_sub(BAND - 1)..i {
            subtract(x, j, l[i][BAND - 1 + j - i], i);
        }
    }
}

/// Row `i` less `factor` times row `j`.
fn subtract(x: &mut [[f64; CASES]], i: usize, factor: f64, j: usize) {
    let other = x[j];
    for (value, other) in x[i].iter_mut().zip(other) {
        *value -= factor * other;
    }
}
