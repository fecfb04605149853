//! What a rod's file states of its numbers.

use super::tube::Tube;
use rodcal_base::units::MM;

/// E/G over 2(1 + ν) beyond which a wall is anisotropic: ν = E/2G − 1 may be 0 to 0.5.
const POISSON: (f64, f64) = (0.0, 0.5);

/// How well the numbers of a rod file are known, 1 σ: relative, or m.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs, reason = "the names are those of the keys; units stand above")]
pub struct Uncertainty {
    pub youngs_modulus: f64,
    pub shear_modulus: f64,
    pub shear_coefficient: f64,
    pub diameter: f64,
    pub length: f64,
}

impl Uncertainty {
    /// What a file without `[standard_uncertainty]` means for a tube.
    pub fn default_of(tube: &Tube) -> Uncertainty {
        let poisson = tube.youngs_modulus / (2.0 * tube.shear_modulus) - 1.0;
        let lengths = Uncertainty {
            youngs_modulus: 0.01,
            shear_modulus: 0.02,
            shear_coefficient: 0.03,
            diameter: 0.03 * MM,
            length: 0.3 * MM,
        };
        match (POISSON.0..=POISSON.1).contains(&poisson) {
            true => lengths,
            false => {
                Uncertainty { youngs_modulus: 0.05, shear_modulus: 0.1, shear_coefficient: 0.15, ..lengths }
            }
        }
    }
}
