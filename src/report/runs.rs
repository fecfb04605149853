//! What `rodcal compare-runs` says: two or more results of one command side by side.

mod compared;
mod difference;
mod json;
mod picture;
mod report;
mod run;
mod tables;
#[cfg(test)]
mod tests;

pub use self::compared::Runs;
pub use self::difference::{Change, Difference, Input, LEVEL, State};
pub use self::json::json;
pub use self::report::report;
pub use self::run::{Precedence, Quantity, Run, name_and_unit};
