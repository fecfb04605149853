//! A rig as the engine sees it: responses, derivatives, places, descriptions.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::RigModel;
use super::derivative::Derivative;
use crate::diagnosis::rig::effects::events::by_channel;
use crate::diagnosis::rig::effects::registry;
use crate::diagnosis::rig::mechanics::action::{Action, Addition};
use crate::diagnosis::rig::mechanics::state::State;
use crate::inference::{
    Candidate, Description, Estimate, Finding, FindingPart, ForwardModel, Hypothesis, Kind, Location, Step,
    Term,
};
use crate::parallel::checkpoint;

impl ForwardModel for RigModel {
    fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    fn response(&self, terms: &[Term]) -> DVector<f64> {
        checkpoint();
        self.changed(&self.state(terms))
    }

    fn cases(&self) -> &[usize] {
        &self.cases.of_datum
    }

    fn step(&self, candidate: usize) -> Option<Step> {
        let [action] = &self.actions[candidate][..] else { return None };
        match action.addition()? {
            Addition::Constant(data, from) => Some(Step { data: Arc::clone(data), from }),
            Addition::Weights(_) | Addition::Display(_) | Addition::Own(..) => None,
        }
    }

    fn is_linear_in(&self, terms: &[Term]) -> bool {
        terms.iter().all(|term| self.actions[term.candidate].iter().all(Action::only_adds))
    }

    fn columns(&self, terms: &[Term], position: usize) -> DMatrix<f64> {
        checkpoint();
        let derivative = Derivative::new(self, terms, position);
        let count = self.actions[terms[position].candidate].len();
        let mut columns = DMatrix::zeros(self.data.len(), count);
        for k in 0..count {
            columns.set_column(k, &derivative.by(k));
        }
        columns
    }

    fn location(&self, term: &Term) -> Location {
        let at_value = |(action, value): (&Action, &f64)| {
            matches!(action, Action::Station(_)).then_some(Location::Station(*value))
        };
        let moved = self.actions[term.candidate].iter().zip(&term.values).find_map(at_value);
        moved.unwrap_or_else(|| self.candidates[term.candidate].location.clone())
    }

    /// Of a joint that nobody declared the interval also holds what the joint would be at the other
    /// stations that the readings cannot separate from its own.
    fn estimates(&self, parts: &[FindingPart], _: &Hypothesis) -> Vec<Estimate> {
        let mut estimates: Vec<Estimate> = parts.iter().flat_map(|part| self.widened(part)).collect();
        by_channel(parts, &mut estimates);
        estimates
    }

    fn place_among_estimates(&self, parts: &[FindingPart]) -> Option<usize> {
        let actions = &self.actions[parts.first()?.term.candidate];
        actions.iter().position(|action| matches!(action, Action::Station(_)))
    }

    fn describe(&self, finding: &Finding) -> Description {
        if let Some(own) = self.own.iter().find(|own| own.effect == finding.effect) {
            return Description { observed: own.observed(finding), cause: finding.effect.cause.to_owned() };
        }
        let observed = registry::record(finding.effect).map_or_else(
            || format!("{} at {}", finding.effect.title(), finding.location),
            |effect| (effect.observed)(finding, self),
        );
        // the correction of a mistake says what it is
        let cause = if finding.kind() == Kind::Mistake { "" } else { finding.effect.cause };
        Description { observed, cause: cause.to_owned() }
    }
}

impl RigModel {
    /// The rig with all of these terms.
    pub(in crate::diagnosis::rig) fn state(&self, terms: &[Term]) -> State<'_> {
        self.state_of(terms, |_| true)
    }

    pub(in crate::diagnosis::rig) fn state_but_onsets(&self, terms: &[Term]) -> State<'_> {
        self.state_of(terms, |action| !matches!(action, Action::Onset(_)))
    }

    fn state_of(&self, terms: &[Term], is_wanted: impl Fn(&Action) -> bool) -> State<'_> {
        let mut state = State::default();
        for term in terms {
            let actions = self.actions.get(term.candidate).map_or(&[][..], Vec::as_slice);
            for (action, value) in actions.iter().zip(&term.values).filter(|(action, _)| is_wanted(action)) {
                state.act(action, *value);
            }
        }
        state
    }
}
