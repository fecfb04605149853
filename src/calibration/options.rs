//! How to calibrate.

use super::noise::Robust;

/// How to calibrate.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// What an outlier counts.
    pub robust: Robust,
}
