//! How fast a slide passes where it is read on its way.
//!
//! What is read with noise says nothing of its own speed: it follows from the readings about it, so
//! that no error of a reading is taken for what the speed does. Of one way, from one sharp turn to
//! the next,
//!
//! ```text
//! v₀ = Σ (tᵢ − t̄)·(uᵢ − ū)/Σ (tᵢ − t̄)²,   i = −2 … 2 without 0
//! ```

use super::turns::Ways;

/// Readings before and after the one whose speed it is.
const HALF: usize = 2;
/// Readings of a sweep from which on it is one.
const FEWEST: usize = 30;

/// Of displacements u that were read one after the other at these times, m/s; nothing where the
/// slide stood still at each, as it does where there are few, or settings whose steps are uneven.
pub fn speeds(u: &[f64], times: &[f64], are_settings: bool) -> Option<Vec<f64>> {
    if u.len() < FEWEST {
        return None;
    }
    let Ways { ways, is_even } = Ways::of(u)?;
    if are_settings && !is_even {
        return None;
    }
    let mut speeds = vec![0.0; u.len()];
    for way in ways {
        for k in way.clone() {
            let about = k.saturating_sub(HALF).max(way.start)..(k + HALF + 1).min(way.end);
            speeds[k] = slope(about.filter(|i| *i != k).map(|i| (times[i], u[i])));
        }
    }
    Some(speeds)
}

/// That of the straight line through points (t, u); 0 where there is none.
fn slope(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let count = points.clone().count() as f64;
    let (t, u) = points.clone().fold((0.0, 0.0), |(t, u), own| (t + own.0 / count, u + own.1 / count));
    let product: f64 = points.clone().map(|own| (own.0 - t) * (own.1 - u)).sum();
    let square: f64 = points.map(|own| (own.0 - t).powi(2)).sum();
    if square > 0.0 { product / square } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{Random, median};

    /// To and fro by 400 in 250 s, read each second.
    fn sweep(noise: f64) -> Vec<f64> {
        let mut random = Random::seeded(5, 0);
        let there = |k: u32| 400.0 * (1.0 - (f64::from(k) / 62.5 - 2.0).rem_euclid(4.0) - 1.0).abs();
        (0..1000).map(|k| there(k) + noise * random.normal()).collect()
    }

    #[test]
    fn no_error_of_a_reading_is_in_its_speed() {
        let times: Vec<f64> = (0..1000).map(f64::from).collect();
        let (exact, read) = (sweep(0.0), sweep(1.0));
        let found = speeds(&read, &times, false).unwrap();
        let errors: Vec<f64> = read.iter().zip(&exact).map(|(a, b)| a - b).collect();
        let sizes: Vec<f64> = found.iter().map(|v| v.abs()).collect();
        assert!((median(&sizes).unwrap() - 6.4).abs() < 0.1);
        let together: f64 = errors.iter().zip(&found).map(|(e, v)| e * (v.abs() - 6.4)).sum();
        let size: f64 = found.iter().map(|v| (v.abs() - 6.4).powi(2)).sum();
        assert!(together.abs() < 4.0 * size.sqrt(), "{together} {size}");
    }

    #[test]
    fn a_slide_that_stands_still_has_none() {
        let times: Vec<f64> = (0..40).map(f64::from).collect();
        // 1, 2, 4 … and back
        let uneven: Vec<f64> = (0..40).map(|k: i32| 2.0f64.powi((k % 8 - 4).abs())).collect();
        assert_eq!(speeds(&uneven, &times, true), None);
        assert_eq!(speeds(&uneven[..20], &times[..20], true), None);
        let even: Vec<f64> = (0..40).map(|k: i32| f64::from((k % 20 - 10).abs())).collect();
        let found = speeds(&even, &times, true).unwrap();
        assert!(found.iter().all(|v| (v.abs() - 1.0).abs() < 1e-9), "{found:?}");
    }
}
