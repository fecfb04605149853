//! Effects that a lab describes itself, as its file has them.

pub(super) mod candidate;
mod file;
pub(super) mod law;

use super::laws::measures::SiteVariable;
use crate::error::Place;
use crate::expression::Expression;
use crate::inference::{Effect, Finding, Parameter};
use crate::rod::{LawMemory, RodLawPlace};

/// An effect that a lab describes itself.
#[derive(Debug, Clone)]
pub struct OwnEffect {
    pub(super) effect: &'static Effect,
    pub(super) place: RodLawPlace,
    pub(super) variable: SiteVariable,
    pub(super) law: Expression,
    /// What its variable is instead of the recorded one.
    pub(super) memory: Option<LawMemory>,
    pub(super) parameters: Vec<Parameter>,
    /// Where place and law stand in the file.
    pub(super) at: (Place, Place),
}

impl OwnEffect {
    /// `A rubber foot under the clamp: a_um = 12 ± 2, b_n = 4.0 ± 0.5`.
    pub(super) fn observed(&self, finding: &Finding) -> String {
        let stated = |parameter: &Parameter| {
            let quantity = finding.quantity(&parameter.name)?;
            Some(format!("{} = {}", parameter.name, quantity.with_unit("")))
        };
        let numbers: Vec<String> = self.parameters.iter().filter_map(stated).collect();
        let mut letters = self.effect.summary.chars();
        let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
        format!("{first}{} ({}): {}", letters.as_str(), self.place, numbers.join(", "))
    }
}
