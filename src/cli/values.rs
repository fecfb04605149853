//! Values of options that more than one command has.

use clap::ValueEnum;
use rodcal::beam::Physics;

/// Beam theory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Theory {
    /// Slender beams: no shear.
    EulerBernoulli,
    /// Shear too.
    Timoshenko,
}

impl Theory {
    /// The physics of a beam model by this theory.
    pub fn physics(self) -> Physics {
        Physics::default().with_shear(self == Theory::Timoshenko)
    }
}

/// A number of elements that a beam model can have and a machine can hold.
pub fn elements(text: &str) -> std::result::Result<usize, String> {
    match text.parse() {
        Ok(count) if (1..=1_000_000).contains(&count) => Ok(count),
        _ => Err("expected a whole number from 1 to 1000000".into()),
    }
}
