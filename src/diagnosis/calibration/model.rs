//! A calibrated campaign as the effects see it, and what each of them does to it: data without any
//! inference.

pub mod calibration_model;
pub mod configuration;
pub mod context;
pub mod cosines;
pub mod covariance;
pub mod entry;
pub mod gear;
pub mod law;
pub mod linear_terms;
pub mod patterns;
pub mod torque_uncertainty;
pub mod validated;
pub mod vector;
pub mod written_angles;

pub use calibration_model::CalibrationModel;
pub use configuration::Configuration;
pub use context::Context;
pub use linear_terms::LinearTerms;
