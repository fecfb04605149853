//! Kinematic calibration: joint values and ball positions in, a calibrated robot with honest uncertainties out.

pub mod campaign;

pub use campaign::Campaign;
