//! Where a robot was calibrated: the ranges of its joints, and how sure its tip is there by its numbers alone.

/// The poses that a robot was calibrated with, as far as a prediction asks for them.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedRange {
    /// Least and greatest value of each joint, rad or m.
    pub joints: Vec<(f64, f64)>,
    /// √tr(J·Σ·Jᵀ), root mean square over these poses, m; base left out, as its user aligns it.
    pub sd: f64,
}
