//! Poses that do not exist yet: which ones a calibration should measure.
//!
//! - [`PoseLimits`]: what a pose has to keep
//! - [`Candidates`]: poses that keep it, from a file or generated
//! - [`PoseCriterion`]: what the chosen poses shall be good for
//! - [`PoseStudy`]: the choice, beside random ones and with the forecast of what it leads to

mod candidates;
mod criterion;
mod limits;
mod order;
mod random;
mod seen;
mod study;

pub use candidates::{Candidates, Source};
pub use criterion::PoseCriterion;
pub use limits::{Obstacle, PoseLimits, TableHeight};
pub use random::Beside;
pub use study::{Known, PoseStep, PoseStudy, Wanted};
