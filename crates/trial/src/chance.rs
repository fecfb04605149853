//! What a trial leaves to chance.

use rodcal_base::statistics::Random;

/// Log-uniform from `low` to `high`, both > 0.
pub fn log_uniform(random: &mut Random, low: f64, high: f64) -> f64 {
    random.uniform(low.ln(), high.ln()).exp()
}

/// True with this probability.
pub fn happens(random: &mut Random, probability: f64) -> bool {
    random.uniform(0.0, 1.0) < probability
}

/// One of several; without any the other.
pub fn one_of<T: Copy>(random: &mut Random, choices: &[T], otherwise: T) -> T {
    choices.get(random.index(choices.len())).copied().unwrap_or(otherwise)
}
