//! Which of several measurements to propose: the one that leaves least of a finding's rivals.
//!
//! A measurement separates a finding from a rival by the ln of the odds that are expected of it,
//! its separation. With so much left of rivals that are now 1 to o,
//!
//! Σ exp(−separation)/o,
//!
//! the measurement is proposed that leaves least (separations as of T-optimal designs: A. C.
//! Atkinson, V. V. Fedorov, Biometrika 62 (1975) 57–70). The closest rival counts most; but where
//! nothing separates one of them, the others are nevertheless.

/// A more laborious measurement has to leave so much less of the rivals,
const BETTER: f64 = 1.3;
/// unless the simpler one leaves no more than this.
const DECISIVE: f64 = 1e-3;
/// ln odds of 3 : 1: less separates nothing.
const TOLD: f64 = 1.0;

/// The best so far of measurements that are offered in the order of the labour they take.
pub struct ExperimentDesign<M> {
    left: f64,
    best: Option<(M, Vec<f64>)>,
}

impl<M> Default for ExperimentDesign<M> {
    fn default() -> Self {
        ExperimentDesign { left: f64::INFINITY, best: None }
    }
}

impl<M> ExperimentDesign<M> {
    /// A measurement with its separation from each rival; `odds` are those against the rivals by
    /// now.
    pub fn offer(&mut self, measurement: M, separations: Vec<f64>, odds: &[f64]) {
        let of_rivals = separations.iter().zip(odds);
        let left: f64 = of_rivals.map(|(apart, odds)| (-apart).exp() / odds.max(1.0)).sum();
        let is_new = separations.iter().any(|apart| separates(*apart));
        if is_new && (self.best.is_none() || BETTER * left.max(DECISIVE) < self.left) {
            (self.left, self.best) = (left, Some((measurement, separations)));
        }
    }

    /// The measurement to propose, with its separations; `None` where nothing separates any of the
    /// rivals.
    pub fn best(self) -> Option<(M, Vec<f64>)> {
        self.best
    }
}

/// True for a separation that counts.
///
/// ```
/// use rodcal::inference::separates;
///
/// assert!(separates(10.0) && !separates(0.1));
/// ```
pub fn separates(separation: f64) -> bool {
    separation > TOLD
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(offers: &[(&'static str, &[f64])], odds: &[f64]) -> Option<&'static str> {
        let mut choice = ExperimentDesign::default();
        offers.iter().for_each(|(name, apart)| choice.offer(*name, apart.to_vec(), odds));
        choice.best().map(|(name, _)| name)
    }

    #[test]
    fn the_closest_rival_counts_and_labour_has_to_pay() {
        let odds = [1.0, 15.0];
        assert_eq!(chosen(&[("one", &[3.0, 0.0]), ("other", &[0.0, 9.0])], &odds), Some("one"));
        assert_eq!(chosen(&[("easy", &[3.0, 3.0]), ("hard", &[3.1, 3.1])], &odds), Some("easy"));
        assert_eq!(chosen(&[("easy", &[9.0, 9.0]), ("hard", &[30.0, 30.0])], &odds), Some("easy"));
        assert_eq!(chosen(&[("easy", &[3.0, 3.0]), ("hard", &[6.0, 6.0])], &odds), Some("hard"));
    }

    #[test]
    fn what_separates_one_of_two_rivals_is_proposed_and_what_separates_none_is_not() {
        assert_eq!(chosen(&[("one", &[0.0, 4.0])], &[1.0, 1.0]), Some("one"));
        assert_eq!(chosen(&[("none", &[0.9, 0.9])], &[1.0, 1.0]), None);
    }
}
