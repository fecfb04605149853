//! Do the averages of repeats leave what a hypothesis says by more than the repeats scatter?
//!
//! With whitened residuals w of a hypothesis of p parameters and a mean for every replicate group fitted to them,
//!
//! F = ((|w|² − S)/(c − p)) / (S/(n − c))        S what the c replicate group means leave
//!
//! (N. R. Draper, H. Smith, *Applied Regression Analysis*, 3rd ed., ch. 2: lack of fit and pure error). A shape that no
//! smooth curve describes is seen here.

use nalgebra::{DMatrix, DVector};

use crate::statistics::f_survival;

/// The test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LackOfFit {
    /// F.
    pub f: f64,
    /// Probability of such an F if nothing were left out.
    pub p_value: f64,
    /// Degrees of degrees of freedom of the replicates.
    pub dof_fit: usize,
    /// Degrees of degrees of freedom of the repeats.
    pub dof_repeats: usize,
}

impl LackOfFit {
    /// Ln of the odds that every replicate group is off by a normal number of its own, against nothing being left: the one-way model of
    /// random effects at its likeliest variances,
    ///
    /// ½(a + b)·ln((a·F + b)/(a + b)) − ½a·ln F − 1     a, b the degrees of freedom of replicates and repeats
    ///
    /// where 1 is the price of its one parameter more.
    pub fn log_odds(&self) -> f64 {
        let (a, b) = (self.dof_fit as f64, self.dof_repeats as f64);
        match self.f > 1.0 {
            true => 0.5 * (a + b) * ((a * self.f + b) / (a + b)).ln() - 0.5 * a * self.f.ln() - 1.0,
            false => -1.0,
        }
    }
}

/// The space of what is the same in all repeats.
#[derive(Debug, Clone)]
pub(super) struct Replicates {
    /// Orthonormal basis of the whitened indicators of the replicates.
    basis: DMatrix<f64>,
}

impl Replicates {
    /// `None` without repeats.
    pub(super) fn new(
        whitened: impl Fn(&DMatrix<f64>) -> DMatrix<f64>,
        replicate_group: &[usize],
    ) -> Option<Replicates> {
        // a recording of some conditions may lack others
        let mut numbers: Vec<usize> = replicate_group.to_vec();
        numbers.sort_unstable();
        numbers.dedup();
        if numbers.len() >= replicate_group.len() {
            return None;
        }
        let indicators = DMatrix::from_fn(replicate_group.len(), numbers.len(), |i, k| {
            f64::from(u8::from(replicate_group[i] == numbers[k]))
        });
        Some(Replicates { basis: whitened(&indicators).qr().q() })
    }

    /// Tests the whitened residual `w` that a hypothesis of `parameters` leaves.
    pub(super) fn test(&self, w: &DVector<f64>, parameters: usize) -> Option<LackOfFit> {
        let (n, replicates) = self.basis.shape();
        let (dof_fit, dof_repeats) = (replicates.checked_sub(parameters)?, n.checked_sub(replicates)?);
        if dof_fit == 0 || dof_repeats == 0 {
            return None;
        }
        let all = w.norm_squared();
        let means = self.basis.tr_mul(w).norm_squared();
        // repeats that never differ say nothing about noise
        let repeats = all - means;
        if repeats <= f64::EPSILON * all {
            return None;
        }
        let f = (means / dof_fit as f64) / (repeats / dof_repeats as f64);
        let p_value = f_survival(f, dof_fit as f64, dof_repeats as f64).ok()?;
        Some(LackOfFit { f, p_value, dof_fit, dof_repeats })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    fn test(seed: u64, shift: f64) -> LackOfFit {
        let mut random = Random::seeded(seed, 0);
        let replicate_group: Vec<usize> = (0..80).map(|i| i % 16).collect();
        let residual = DVector::from_fn(80, |i, _| random.normal() + if i % 16 == 3 { shift } else { 0.0 });
        Replicates::new(Clone::clone, &replicate_group).unwrap().test(&residual, 0).unwrap()
    }

    #[test]
    fn one_cell_that_is_off_is_seen_and_chance_is_not() {
        assert!(test(1, 4.0).p_value < 1e-4);
        assert_eq!((test(1, 0.0).dof_fit, test(1, 0.0).dof_repeats), (16, 64));
        let by_chance = (0..200).filter(|&seed| test(seed, 0.0).p_value < 0.05).count();
        assert!((3..=20).contains(&by_chance), "{by_chance} of 200");
        assert!(test(1, 4.0).log_odds() > 5.0 && test(1, 0.0).log_odds() < 1.0);
    }
}
