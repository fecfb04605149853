//! From rig readings to compliance: lines, correction factors r, and the Meas matrices C^F and C^g.
//!
//! With c_mn the measured slope (offset along m per load along n) and c'_mn the model's (FEA):
//!
//! ```text
//! r_mn  = c_mn / c'_mn                       (Eq 20)
//! r_rod = (c_22 + c_33) / (c'_22 + c'_33)    (Eq 21)
//! C^g   = r_rod C'^g                         (Eq 22); likewise entries of C^F that were not measured
//! ```
//!
//! Source: Improved MultiCal, *Sensors* 23 (2023) 5717, § 4.2.

mod comparison;
mod curve;
mod fit;
mod laws;
pub mod line;
pub mod readings;
mod repeats;
mod sample;
mod warning;

pub use comparison::{Measured, Ratio};
pub use fit::{Fit, Options, fit};
pub use warning::Warning;
