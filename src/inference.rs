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

pub(crate) mod background;
mod columns;
mod compared;
mod correlated_noise;
mod correlation;
mod description;
mod diagnose;
mod diagnosis;
mod effect;
mod evidence;
mod experiment_design;
mod finding;
mod fit;
mod forward_model;
mod gram_cache;
mod held_out;
mod hidden_in_correlation;
mod hidden_in_groups;
mod hypothesis;
mod lack_of_fit;
pub mod law;
mod limit;
mod linearised;
mod locate;
mod location;
mod memory;
mod misread;
mod moments;

mod nominal;
mod pairs;
mod part_products;
mod parts;
mod priors;
mod proposal;
mod pruning;
mod quantity;
mod ranking;
mod scatter;
mod score;
mod search;
mod selection;
mod sessions;
mod shared_ratio;
mod sketch;
mod stored_column;
mod table;
mod untested;
mod variable;
mod whitening;

#[cfg(test)]
mod tests;

#[cfg(test)]
pub(crate) use self::{
    linearised::Linearised,
    pruning::infer,
    selection::{DiscrepancyModel, Pairs},
};
pub use compared::Compared;
pub use correlated_noise::CorrelatedNoise;
pub use description::Description;
pub use diagnose::diagnose;
pub use diagnosis::{Diagnosed, Diagnosis, Discrepancy, ShownBy};
pub(crate) use effect::at;
pub use effect::{Effect, Kind, Reported, UNKNOWN, WrittenTo};
pub use evidence::{Covariate, Evidence, rms};
pub use experiment_design::{ExperimentDesign, separates};
pub use finding::{Estimate, Finding, FindingPart, Rival};
pub use forward_model::{Candidate, DERIVATIVE_STEP, ForwardModel, Parameter, Step};
pub use held_out::HeldOut;
pub use hypothesis::{Hypothesis, Term};
pub use lack_of_fit::LackOfFit;
pub use limit::Limit;
pub use locate::Structure;
pub use location::{Key, Location, Part, Run, RunName};
pub use nominal::{NominalEstimate, NominalParameter};
pub use proposal::{LoadPlan, Plan, PlannedPose, PosePlan, Proposal};
pub use quantity::Quantity;
pub use ranking::{Rank, Ranked, ranking};
pub use scatter::{NoiseTest, Suspect};
pub use selection::NAMED;
pub use sessions::LeftOutSession;
pub use sketch::{Sketch, sketch};
pub use stored_column::{DataParts, Pattern, StoredColumn, products};
pub use untested::{Absorbed, NotTestable};
pub use variable::{JointVariable, Variable};
pub use whitening::Whitening;
