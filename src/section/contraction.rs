//! What Poisson's ratio does to a shear coefficient.

/// ν/e for a shear coefficient. Of an isotropic material it is at most ⅙; beyond ½, which no known
/// wall reaches, the formulas lose their meaning.
pub(super) fn contraction(ratio: f64, poisson_ratio: f64) -> f64 {
    (poisson_ratio / ratio).min(0.5)
}
