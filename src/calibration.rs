//! Kinematic calibration: joint values and ball positions in, a calibrated robot with honest uncertainties out.

mod calibrate;
pub mod campaign;
mod compensation;
mod identify;
mod noise;
mod observability;
mod problem;
pub mod simulate;
mod start;
mod validation;
mod warning;

pub use calibrate::{
    Calibration, Estimated, Options, PassRecord, calibrate, calibrate_from, free_parameters, start,
};
pub use campaign::Campaign;
pub use compensation::{Compensation, Mode, default_mode, modes};
pub use identify::{Held, plausible_range};
pub use noise::{Noise, Robust};
pub use observability::Observability;
pub use validation::{Summary, Validation, validate};
pub use warning::Warning;
