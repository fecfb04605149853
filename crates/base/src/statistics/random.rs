//! Random numbers that are the same in every run and for every number of threads.
//!
//! The generator is ChaCha with 8 rounds, seeded by a number and split into streams that never
//! overlap: give every job of a parallel run the stream of its index, and no result depends on
//! which thread did what.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::error::{Error, Result};

/// A sequence of random numbers, determined by its seed and stream.
#[derive(Debug, Clone)]
pub struct Random(ChaCha8Rng);

impl Random {
    /// Sequence number `stream` of those that belong to `seed`.
    pub fn seeded(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Random(generator)
    }

    /// The same for a seed of up to 128 bits; one of at most 64 is that of [`Random::seeded`].
    pub fn of_seed(seed: u128, stream: u64) -> Self {
        if let Ok(short) = u64::try_from(seed) {
            return Random::seeded(short, stream);
        }
        let mut bytes = [0; 32];
        bytes[..16].copy_from_slice(&seed.to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(bytes);
        generator.set_stream(stream);
        Random(generator)
    }

    /// A seed that nobody guesses: 128 random bits of the operating system.
    ///
    /// # Errors
    /// [`Error::Numerical`] where it has none.
    pub fn secret_seed() -> Result<u128> {
        let mut bytes = [0; 16];
        let why =
            |error: getrandom::Error| Error::Numerical { what: "a random seed", why: error.to_string() };
        getrandom::fill(&mut bytes).map_err(why)?;
        Ok(u128::from_le_bytes(bytes))
    }

    /// Uniform between `low` and `high`, in steps of 2⁻⁵³ of their distance.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        // low + (high − low)·u, u in [0, 1)
        low + (high - low) * self.0.random::<f64>()
    }

    /// Normal with mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        self.0.sample(StandardNormal)
    }

    /// An index below `n`, each equally likely; 0 where `n` is 0 and there is none.
    pub fn index(&mut self, n: usize) -> usize {
        self.0.random_range(0..n.max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{mean, standard_deviation};

    #[test]
    fn the_first_values_are_pinned() {
        let mut random = Random::seeded(42, 0);
        let values = [random.uniform(0.0, 1.0), random.uniform(-1.0, 1.0), random.normal(), random.normal()];
        assert_eq!(values, [0.6818961923066714, 0.900550815344968, -0.21086668327103028, 0.4763469238088213]);
        let other = Random::seeded(42, 1).uniform(0.0, 1.0);
        assert_eq!(
            ([random.index(6), random.index(6), random.index(1000)], other),
            ([4, 1, 642], 0.7167916525047883)
        );
    }

    #[test]
    fn seed_and_stream_decide_and_nothing_else() {
        let first = |seed, stream| Random::seeded(seed, stream).uniform(0.0, 1.0);
        assert_eq!(first(7, 3), first(7, 3));
        assert!(first(7, 3) != first(7, 4) && first(7, 3) != first(8, 3));
    }

    #[test]
    fn a_long_seed_is_another_sequence_and_a_short_one_is_not() {
        let first = |seed| Random::of_seed(seed, 3).uniform(0.0, 1.0);
        assert_eq!(first(7), Random::seeded(7, 3).uniform(0.0, 1.0));
        assert!(first(7) != first(7 + (1 << 64)) && first(1 << 64) != first(1 << 65));
        assert!(Random::secret_seed().unwrap() != Random::secret_seed().unwrap());
    }

    #[test]
    fn moments_are_those_of_the_distributions() {
        let mut random = Random::seeded(3, 0);
        let normal: Vec<f64> = (0..20_000).map(|_| random.normal()).collect();
        let uniform: Vec<f64> = (0..20_000).map(|_| random.uniform(2.0, 5.0)).collect();
        // standard errors 0.007, 0.005; 0.006, 0.003
        assert!(mean(&normal).unwrap().abs() < 0.03);
        assert!((standard_deviation(&normal).unwrap() - 1.0).abs() < 0.02);
        assert!((mean(&uniform).unwrap() - 3.5).abs() < 0.03);
        assert!((standard_deviation(&uniform).unwrap() - 3.0 / 12f64.sqrt()).abs() < 0.02);
        assert!(uniform.iter().all(|x| (2.0..5.0).contains(x)));
    }

    #[test]
    fn every_index_comes_up_and_none_beyond() {
        let mut random = Random::seeded(5, 0);
        let mut counts = [0; 5];
        (0..5000).for_each(|_| counts[random.index(5)] += 1);
        // 1000 ± 28
        assert!(counts.iter().all(|&count| (850..1150).contains(&count)), "{counts:?}");
        assert_eq!(random.index(0), 0);
    }
}
