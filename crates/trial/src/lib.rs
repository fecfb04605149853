//! Concealed-effect trials: recordings in which an effect is hidden, sealed in an archive, and the
//! score of whoever answers what it was.
//!
//! The generator shares no physics with the models that answer: it knows file formats and nothing
//! else of the program (`tests/architecture.rs` keeps it so), and its mechanics are richer than
//! theirs. What an answer could have known at best is computed here too, by an oracle that knows
//! every recording without its noise.

pub mod answers;
pub mod archive;
mod calibration;
mod chance;
pub mod effect_name;
pub mod ground_truth;
mod place;
pub mod rig;
pub mod score;
mod seed;

pub use seed::Seed;

/// A case: what is handed out and what is kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Name and text of each file.
    pub files: Vec<(String, String)>,
    /// What is concealed.
    pub truth: ground_truth::GroundTruth,
}

/// A suite of cases: what is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Suite {
    /// Readings of rods at a stiffness rig.
    Rig,
    /// Recordings of arms.
    Calibration,
    /// Calibrations with effects that imitate each other, both sides of each pair in turn.
    Conflicts,
    /// Of three cases the third is a calibration.
    Both,
}

/// What the cases of a trial are drawn from.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// Every random number comes from it.
    pub seed: Seed,
    /// What is tried.
    pub suite: Suite,
    /// Residuals of a real recording that are the noise, in standard deviations; none: the noise is
    /// computed.
    pub residuals: Vec<f64>,
}

impl Source {
    /// Case number `number`.
    fn case(&self, number: usize) -> Case {
        let is_third = self.suite == Suite::Both && number.is_multiple_of(3);
        match matches!(self.suite, Suite::Calibration | Suite::Conflicts) || is_third {
            true => calibration::case(self, number),
            false => rig::case(self.seed, number, &self.residuals),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(seed: u128, suite: Suite, number: usize) -> Case {
        Source { seed: Seed(seed), suite, residuals: Vec::new() }.case(number)
    }

    #[test]
    fn a_seed_and_a_number_make_the_same_case() {
        for suite in [Suite::Rig, Suite::Calibration] {
            assert_eq!(case(7, suite, 3), case(7, suite, 3));
            let other = [case(7, suite, 4), case(8, suite, 3)];
            assert!(other.iter().all(|other| other.files != case(7, suite, 3).files));
        }
    }

    #[test]
    fn files_say_that_they_are_simulated_and_nothing_of_the_effect() {
        for (suite, cases) in [(Suite::Rig, 8), (Suite::Calibration, 6)] {
            for number in 0..cases {
                let case = case(1, suite, number);
                for (name, text) in &case.files {
                    assert!(text.starts_with("# SIMULATED"), "{name}");
                    assert!(case.truth.effects.iter().all(|e| !text.contains(e.effect.as_str())), "{name}");
                }
            }
        }
    }
}
