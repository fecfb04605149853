//! Do the averages of repeats leave what a hypothesis says by more than the repeats scatter?
//!
//! With whitened residuals w of a hypothesis of p parameters and a mean for every replicate group
//! fitted to them,
//!
//! F = ((|w|² − S)/(c − p)) / (S/(n − c))        S what the c replicate group means leave
//!
//! (N. R. Draper, H. Smith, *Applied Regression Analysis*, 3rd ed., ch. 2: lack of fit and pure
//! error). A shape that no smooth curve describes is seen here.

use nalgebra::DVector;

use crate::inference::model::evidence::Evidence;
use crate::inference::noise::whitening::Whitening;
use crate::statistics::f_survival;

/// F test of the averages of repeats against their scatter.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LackOfFit {
    /// Variance of the averages about the hypothesis over that of repeats about them.
    pub f: f64,
    /// Probability of such an F if nothing were left out.
    pub p_value: f64,
    /// Degrees of freedom of the replicates.
    pub dof_fit: usize,
    /// Degrees of freedom of the repeats.
    pub dof_repeats: usize,
}

impl LackOfFit {
    /// Ln of the odds that every replicate group is off by a normal number of its own, against
    /// nothing being left: the one-way model of random effects at its likeliest variances,
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

/// The space of what is the same in all repeats: A the indicators of the replicates, W what
/// whitens.
#[derive(Debug, Clone)]
pub struct Replicates {
    whitening: Whitening,
    /// Number of the replicate group of each datum.
    group: Vec<usize>,
    /// Diagonal of AᵀWᵀWA without the errors that data share: it preconditions.
    diagonal: DVector<f64>,
    /// Standard deviation of rounding alone.
    rounding: f64,
}

impl Replicates {
    /// `None` without repeats.
    pub fn new(whitening: &Whitening, evidence: &Evidence) -> Option<Replicates> {
        let replicate_group = &evidence.replicate_group;
        // a recording of some conditions may lack others
        let mut numbers: Vec<usize> = replicate_group.to_vec();
        numbers.sort_unstable();
        numbers.dedup();
        if numbers.len() >= replicate_group.len() {
            return None;
        }
        let number = |group: &usize| numbers.binary_search(group).unwrap_or_default();
        let group: Vec<usize> = replicate_group.iter().map(number).collect();
        let mut diagonal = DVector::zeros(numbers.len());
        group.iter().zip(whitening.weights()).for_each(|(&group, weight)| diagonal[group] += weight);
        let rounding = evidence.rounding();
        Some(Replicates { whitening: whitening.clone(), group, diagonal, rounding })
    }

    /// Aᵀv.
    fn gathered(&self, v: &DVector<f64>) -> DVector<f64> {
        let mut sums = DVector::zeros(self.diagonal.len());
        self.group.iter().zip(v.iter()).for_each(|(&group, v)| sums[group] += v);
        sums
    }

    /// |Q·w|², Q the projection on the columns of W·A: bᵀ(AᵀWᵀWA)⁻¹b with b = AᵀWᵀw, by conjugate gradients (M. R. Hestenes,
    /// E. Stiefel, J. Res. NBS 49 (1952) 409–436), which take one pass over the data for a step.
    fn along(&self, w: &DVector<f64>) -> f64 {
        const ENOUGH: f64 = 1e-11;
        const STEPS: usize = 500;
        let mut left = self.gathered(&self.whitening.transposed_vector(w));
        let mut preconditioned = left.component_div(&self.diagonal);
        let mut direction = preconditioned.clone();
        let mut square = left.dot(&preconditioned);
        let (all, mut found) = (square, 0.0);
        for _ in 0..STEPS {
            if square <= ENOUGH * ENOUGH * all {
                break;
            }
            let spread = DVector::from_iterator(self.group.len(), self.group.iter().map(|&g| direction[g]));
            let image = self.gathered(&self.whitening.transposed_vector(&self.whitening.whitened(&spread)));
            let step = square / direction.dot(&image);
            // every step is orthogonal to those before it
            found += step * square;
            left.axpy(-step, &image, 1.0);
            preconditioned = left.component_div(&self.diagonal);
            let next = left.dot(&preconditioned);
            direction = &preconditioned + direction * (next / square);
            square = next;
        }
        found
    }

    /// What repeats scatter by about their own averages, m: √(Σ w·(r − r̄)²/(n − c)) of what a
    /// hypothesis leaves, zeros of runs included, whatever the averages are off by.
    pub fn scatter(&self, evidence: &Evidence, left: &DVector<f64>) -> f64 {
        let mut weights: DVector<f64> = DVector::zeros(self.diagonal.len());
        let mut sums = weights.clone();
        for ((&group, w), r) in self.group.iter().zip(&evidence.weight).zip(left) {
            weights[group] += w;
            sums[group] += w * r;
        }
        let means = sums.component_div(&weights);
        let own = self.group.iter().zip(&evidence.weight).zip(left);
        let square: f64 = own.map(|((&group, w), r)| w * (r - means[group]).powi(2)).sum();
        (square / (left.len() - means.len()) as f64).sqrt()
    }

    /// Tests the whitened residual `w` that a hypothesis of `parameters` leaves.
    pub fn test(&self, w: &DVector<f64>, parameters: usize) -> Option<LackOfFit> {
        let (n, replicates) = (self.group.len(), self.diagonal.len());
        let (dof_fit, dof_repeats) = (replicates.checked_sub(parameters)?, n.checked_sub(replicates)?);
        if dof_fit == 0 || dof_repeats == 0 {
            return None;
        }
        let all = w.norm_squared();
        let means = self.along(w);
        // repeats that never differ say nothing about noise
        let repeats = all - means;
        if repeats <= f64::EPSILON * all {
            return None;
        }
        // rounding moves a mean by as much however often it is repeated: n/c readings share one
        // error, which their scatter does not show
        let weight = self.diagonal.sum() / replicates as f64;
        let scatter = (repeats / dof_repeats as f64).max(weight * self.rounding.powi(2));
        let f = (means / dof_fit as f64) / scatter;
        let p_value = f_survival(f, dof_fit as f64, dof_repeats as f64).ok()?;
        Some(LackOfFit { f, p_value, dof_fit, dof_repeats })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::statistics::Random;

    fn replicates(evidence: &Evidence) -> Replicates {
        Replicates::new(&Whitening::new(evidence, &evidence.residual), evidence).unwrap()
    }

    /// The same by an orthonormal basis of the whitened indicators.
    #[test]
    fn the_share_of_repeats_is_the_projection_on_their_whitened_indicators() {
        const COUNT: usize = 240;
        let mut random = Random::seeded(4, 0);
        let residual = DVector::from_fn(COUNT, |_, _| random.normal());
        let evidence = Evidence {
            replicate_group: (0..COUNT).map(|i| (7 * i + i / 40) % 24).collect(),
            shared: (0..COUNT).map(|i| i / 15).collect(),
            weight: (0..COUNT).map(|i| 1.0 - 0.6 * (i as f64).sin().powi(2)).collect(),
            ..Evidence::new(residual.clone())
        };
        for ratio in [0.0, 1.0, 900.0] {
            let evidence = Evidence { shared_ratio: Some(ratio), correlation: Some(0.0), ..evidence.clone() };
            let whitening = Whitening::new(&evidence, &residual);
            let indicators =
                DMatrix::from_fn(COUNT, 24, |i, k| f64::from(u8::from(evidence.replicate_group[i] == k)));
            let expected = whitening.whitened_columns(&indicators).qr().q().tr_mul(&residual).norm_squared();
            let found = replicates(&evidence).along(&residual);
            assert!((found - expected).abs() < 1e-9 * expected, "{ratio}: {found} instead of {expected}");
        }
    }

    #[test]
    fn repeats_scatter_about_their_own_averages() {
        // of three and of two, of which one counts a quarter
        let evidence = Evidence {
            replicate_group: vec![4, 4, 4, 7, 7],
            weight: vec![1.0, 1.0, 1.0, 1.0, 0.25],
            ..Evidence::new(DVector::zeros(5))
        };
        let left = DVector::from_column_slice(&[11.0, 12.0, 13.0, -5.0, 0.0]);
        // 2 and 1·1² + ¼·4² beside −4, of three degrees of freedom
        assert!((replicates(&evidence).scatter(&evidence, &left) - (7.0_f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    fn test(seed: u64, shift: f64) -> LackOfFit {
        let mut random = Random::seeded(seed, 0);
        let replicate_group: Vec<usize> = (0..80).map(|i| i % 16).collect();
        let residual = DVector::from_fn(80, |i, _| random.normal() + if i % 16 == 3 { shift } else { 0.0 });
        let evidence = Evidence { replicate_group, ..Evidence::new(residual.clone()) };
        replicates(&evidence).test(&residual, 0).unwrap()
    }

    /// Values of noise 0.1 on a display of steps of 1: most repeats agree to the digit, their
    /// averages are off by what is rounded away.
    #[test]
    fn what_a_display_rounds_is_no_lack_of_fit() {
        let mut random = Random::seeded(6, 0);
        let exact: Vec<f64> = (0..16).map(|_| 10.0 * random.normal()).collect();
        let residual =
            DVector::from_fn(80, |i, _| (exact[i % 16] + 0.1 * random.normal()).round() - exact[i % 16]);
        let replicate_group: Vec<usize> = (0..80).map(|i| i % 16).collect();
        let p_value = |resolution: f64| {
            let evidence = Evidence {
                replicate_group: replicate_group.clone(),
                resolution,
                ..Evidence::new(residual.clone())
            };
            replicates(&evidence).test(&residual, 0).unwrap().p_value
        };
        assert!(p_value(0.0) < 1e-4 && p_value(1.0) > 0.05, "{} {}", p_value(0.0), p_value(1.0));
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
