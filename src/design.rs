//! Rods that do not exist yet: every combination of lengths, angles, bends and tubes that a
//! designer asks for, and those of them that nobody can better in one respect without losing in
//! another.
//!
//! - [`DesignSpace`]: what may vary, what must hold, what counts; read from a design file
//! - [`Figure`]: the numbers that rods are judged by
//! - [`search`]: all combinations, or a sample of them, to a Pareto [`Front`]
//! - [`Intervals`]: how well a design's numbers are known, and which designs cannot be
//!   distinguished
//! - [`refine()`]: between the grid's values, and back to tubes that can be bought
//! - [`Study`]: a search with all of this
//!
//! And poses that do not exist yet: which ones a calibration should measure ([`PoseStudy`]), how
//! accurate the robot will be ([`Forecaster`]), and which rod with which mode is worth it
//! ([`rods_and_modes`]).
//!
//! A combination has a number, from 0; lengths vary fastest. Nothing is kept of a rod but its
//! number and its figures, and nothing of one that is bettered: memory is that of the front.

mod catalogue;
mod figure;
mod for_robot;
mod forecast;
mod front;
mod intervals;
mod limits;
mod nearest;
mod poses;
mod proxy;
mod refine;
mod resume;
mod rods_and_modes;
mod search;
mod space;
mod study;
mod values;

pub use catalogue::{BUILT_IN, Tube, built_in, built_in_materials};
pub use figure::{Design, Figure, Figures, Goal};
pub use for_robot::{ForRobot, Ranked, for_robot};
pub use forecast::{Budget, Forecast, Forecaster, Part, Unseen, Where};
pub use front::Front;
pub use intervals::{Intervals, indistinguishable};
pub use limits::{Impossible, Limit};
pub use nearest::{Nearest, Relaxed};
pub use poses::{
    Beside, Candidates, Known, Obstacle, PoseCriterion, PoseLimits, PoseStep, PoseStudy, Source, TableHeight,
    Wanted,
};
pub use proxy::{Proxy, proxies};
pub use refine::{Better, Refined, refine, weights};
pub use rods_and_modes::{RodForecast, rods_and_modes};
pub use search::{Found, PART, Search, Searched, search};
pub use space::{DesignSpace, MOST_RODS};
pub use study::{Base, KnownDesign, Shown, Study};
pub use values::MOST_VALUES;
