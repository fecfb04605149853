//! Seeded random numbers: the same seed and stream give the same numbers, on every machine and in every order.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;

/// A stream of random numbers.
#[derive(Debug, Clone)]
pub struct Random(ChaCha12Rng);

impl Random {
    /// The stream `stream` of `seed`. Streams are independent: one for each task makes results independent of the
    /// order in which tasks run.
    pub fn seeded(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha12Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Random(generator)
    }

    /// Uniform in [low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// Normal with mean 0 and standard deviation 1 (Box & Muller, *Ann. Math. Stat.* 29 (1958) 610–611).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.0.random::<f64>()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.0.random::<f64>()).cos()
    }

    /// One of 0 … n − 1; 0 for n = 0.
    pub fn index(&mut self, n: usize) -> usize {
        // the bias of the remainder is n/2⁶⁴
        (self.0.next_u64() % (n.max(1) as u64)) as usize
    }
}
