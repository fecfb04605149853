//! Student's t with four degrees of freedom in space: the density of the lengths of residuals, of
//! which some may be those of a mistake.

use crate::statistics::median;

/// Degrees of freedom of the residuals' distribution.
const NU: f64 = 4.0;
/// More rows than these add no evidence, for they share the same unknown physics; and what the
/// three coordinates of one row count.
const MOST_ROWS: f64 = 150.0;
const ROW: f64 = 1.0 / 3.0;
/// The median length of a normal vector in space.
pub(super) const MEDIAN: f64 = 1.538;

/// What a residual of u times the scale counts: (ν + 3)/(ν + u²).
pub fn weight_of(u: f64) -> f64 {
    (NU + 3.0) / (NU + u * u)
}

/// The scale that is likeliest, by the fixed point s² = Σ w·r²/3n.
pub fn t_scale(lengths: &[f64], least: f64) -> f64 {
    let start = median(lengths).unwrap_or(0.0) / MEDIAN;
    let mut scale = start.max(least);
    for _ in 0..30 {
        let sum: f64 = lengths.iter().map(|r| weight_of(r / scale) * r * r).sum();
        let next = (sum / (3.0 * lengths.len().max(1) as f64)).sqrt().max(least);
        let has_arrived = (next / scale - 1.0).abs() < 1e-4;
        scale = next;
        if has_arrived {
            break;
        }
    }
    scale
}

/// Ln of the density of all rows, as many as count.
pub fn density(lengths: &[f64], scale: f64) -> f64 {
    let ln_density = |r: &f64| -3.0 * scale.ln() - 0.5 * (NU + 3.0) * ((r / scale).powi(2) / NU).ln_1p();
    of_rows(lengths.iter().map(ln_density).collect())
}

/// Ln of the volume of what was recorded where each row's lengths are multiplied by a factor of its
/// own: the density of numbers in another unit is that of the lengths times this.
pub fn ln_volume(factors: &[f64]) -> f64 {
    of_rows(factors.iter().map(|factor| 3.0 * factor.ln()).collect())
}

/// What all rows say together, as many as count.
fn of_rows(said: Vec<f64>) -> f64 {
    let count = said.len().max(1) as f64;
    said.iter().sum::<f64>() / count * count.min(MOST_ROWS) * ROW
}
