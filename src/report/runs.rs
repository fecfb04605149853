//! What `rodcal compare-runs` says: two or more results of one command side by side.

mod compared;
mod difference;
mod json;
mod picture;
mod run;
mod tables;
#[cfg(test)]
mod tests;
mod words;

pub use self::compared::Runs;
pub use self::difference::{Change, Difference, Input, LEVEL, State};
pub use self::json::json;
pub use self::run::{Precedence, Quantity, Run, name_and_unit};
pub use self::words::report;
