//! Kinematic calibration: joint values and ball positions in, a calibrated robot with honest
//! uncertainties out.

mod before;
mod calibrate;
mod calibrate_from;
pub mod campaign;
mod checks;
mod compare;
mod compensation;
mod cross_validation;
mod drives;
mod extrapolation;
mod identifiability;
mod noise;
mod observability;
mod options;
mod passes;
mod planned;
mod problem;
mod prune;
mod resample;
mod result;
mod shrinkage;
pub mod simulate;
mod start;
mod stations;
mod validation;
mod warning;
mod write_back;

pub use calibrate::{calibrate, free_parameters, start};
pub use calibrate_from::calibrate_from;
pub use campaign::Campaign;
pub use compare::{CompareOptions, Comparison, Difference, compare};
pub use compensation::{Compensation, Mode, TORQUE_ROUNDS, default_mode, modes};
pub use cross_validation::{CrossValidation, cross_validate};
pub(crate) use drives::plausible_compliances;
pub use extrapolation::Extrapolation;
pub use identifiability::{MOST_SCATTER, UnidentifiedDirection, plausible_range};
pub use noise::{Noise, Robust};
pub use observability::Observability;
pub use options::Options;
pub use passes::PassRecord;
pub use planned::{NEAR, Planned, known_before, places, planned_setup};
pub use result::{Calibration, Estimated};
pub use validation::{Before, Summary, Validation, validate};
pub use warning::Warning;
pub use write_back::{write_back, write_back_with, write_beside};
