//! Inference: which terms a recording needs beyond its base model, and how sure that is.
//!
//! The engine knows no physics. It sees a recording as numbers ([`Evidence`]) and the physics as
//! candidates, each an effect at a place with a few parameters ([`Candidate`]), and asks a
//! [`ForwardModel`] what would have been recorded if some of them were real. It copies the records
//! of effects and places into its findings, and never looks into them.
//!
//! ```text
//! evidence + forward model → search (score) → selection → pruning → held out, sessions → findings
//! ```
//!
//! | room | what it holds |
//! |---|---|
//! | `model` | what the engine is given: evidence, forward model, effects at their places |
//! | `columns` | what each candidate does to the data, linearised, projected and kept for many fits |
//! | `noise` | how the data scatter: weights, heavy tails, correlation, shared zeros, lack of fit |
//! | `score` | how probable a hypothesis is, and its best values |
//! | `search` | which terms, one after another and in pairs; what goes again; what is left |
//! | `held_out` | what data that were not looked at say |
//! | `diagnose`, `locate`, `sketch` | the whole way; where the residuals have a shape; the quick way |
//! | `experiment_design` | which measurement would decide |
//! | `result` | what is found, complete in itself |
//! | `law` | what no effect explains, as a formula |

mod columns;
mod diagnose;
mod experiment_design;
mod held_out;
pub mod law;
mod locate;
mod model;
mod noise;
mod result;
mod score;
mod search;
mod sketch;

#[cfg(test)]
mod tests;

#[cfg(test)]
pub(crate) use self::{
    columns::linearised::Linearised,
    search::pruning::infer,
    search::selection::{DiscrepancyModel, Pairs},
};
pub(crate) use columns::background::nominal_factors;
pub use columns::stored_column::{DataParts, Pattern, StoredColumn, products};
pub use diagnose::diagnose;
pub use experiment_design::{ExperimentDesign, separates};
pub use held_out::HeldOut;
pub use held_out::compared::Compared;
pub(crate) use held_out::held_out_square;
pub use held_out::sessions::LeftOutSession;
pub use locate::Structure;
pub use model::description::Description;
pub(crate) use model::effect::at;
pub use model::effect::{Effect, Kind, Reported, UNKNOWN, WrittenTo};
pub use model::evidence::{Covariate, Evidence, rms};
pub use model::forward_model::{Candidate, DERIVATIVE_STEP, ForwardModel, Parameter, Step};
pub use model::hypothesis::{Hypothesis, Term};
pub use model::location::{Key, Location, Part, Run, RunName};
pub use model::nominal::{NominalEstimate, NominalParameter};
pub use model::quantity::Quantity;
pub use model::variable::{JointVariable, Variable};
pub use noise::correlated_noise::CorrelatedNoise;
pub use noise::lack_of_fit::LackOfFit;
pub use noise::scatter::{NoiseTest, Suspect};
pub use noise::whitening::Whitening;
pub use result::diagnosis::{Diagnosis, Discrepancy, ShownBy};
pub use result::finding::{Estimate, Finding, FindingPart, Rival};
pub use result::proposal::{LoadPlan, Plan, PlannedPose, PosePlan, Proposal};
pub use result::ranking::{Rank, Ranked, ranking};
pub use result::untested::{Absorbed, NotTestable};
pub use score::priors::{APART, NAMED};
pub use sketch::{Sketch, sketch};
