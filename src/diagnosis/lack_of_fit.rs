//! Do the averages of repeats leave what a story says by more than the repeats scatter?
//!
//! With whitened residuals w of a story of p parameters and a mean for every cell fitted to them,
//!
//! F = ((|w|² − S)/(c − p)) / (S/(n − c))        S what the c cell means leave
//!
//! (N. R. Draper, H. Smith, *Applied Regression Analysis*, 3rd ed., §2.2). A shape that no smooth curve describes is seen here.

use nalgebra::{DMatrix, DVector};

use crate::linalg;
use crate::statistics::f_survival;

/// The test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LackOfFit {
    /// F.
    pub f: f64,
    /// Probability of such an F if nothing were left out.
    pub p_value: f64,
    /// Degrees of freedom of the cells.
    pub dof_fit: usize,
    /// Degrees of freedom of the repeats.
    pub dof_repeats: usize,
}

/// Tests residuals, whitened by `whitened`, that a story of `parameters` leaves; `None` without repeats.
pub(super) fn lack_of_fit(
    whitened: impl Fn(&DVector<f64>) -> DVector<f64>,
    residual: &DVector<f64>,
    cell: &[usize],
    parameters: usize,
) -> Option<LackOfFit> {
    let cells = cell.iter().max()? + 1;
    let n = residual.len();
    let (dof_fit, dof_repeats) = (cells.checked_sub(parameters)?, n.checked_sub(cells)?);
    if dof_fit == 0 || dof_repeats == 0 {
        return None;
    }
    let of_cell = |k: usize| whitened(&DVector::from_fn(n, |i, _| f64::from(u8::from(cell[i] == k))));
    let columns = DMatrix::from_columns(&(0..cells).map(of_cell).collect::<Vec<_>>());
    let w = whitened(residual);
    let means = linalg::least_squares(&columns, &w).ok()?;
    let repeats = (&w - &columns * means).norm_squared();
    let fit = (w.norm_squared() - repeats).max(0.0);
    // repeats that never differ say nothing about noise
    if repeats <= f64::EPSILON * w.norm_squared() {
        return None;
    }
    let f = (fit / dof_fit as f64) / (repeats / dof_repeats as f64);
    let p_value = f_survival(f, dof_fit as f64, dof_repeats as f64).ok()?;
    Some(LackOfFit { f, p_value, dof_fit, dof_repeats })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    fn test(seed: u64, shift: f64) -> LackOfFit {
        let mut random = Random::seeded(seed, 0);
        let cell: Vec<usize> = (0..80).map(|i| i % 16).collect();
        let residual = DVector::from_fn(80, |i, _| random.normal() + if i % 16 == 3 { shift } else { 0.0 });
        lack_of_fit(Clone::clone, &residual, &cell, 0).unwrap()
    }

    #[test]
    fn one_cell_that_is_off_is_seen_and_chance_is_not() {
        assert!(test(1, 4.0).p_value < 1e-4);
        assert_eq!((test(1, 0.0).dof_fit, test(1, 0.0).dof_repeats), (16, 64));
        let by_chance = (0..200).filter(|&seed| test(seed, 0.0).p_value < 0.05).count();
        assert!((3..=20).contains(&by_chance), "{by_chance} of 200");
    }
}
