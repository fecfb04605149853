//! A rig as the engine sees it: responses, derivatives, places, words.

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::action::Action;
use super::effects::events::by_channel;
use super::effects::registry;
use super::model::{Body, RigModel, STATION, is_dependent};
use super::state::State;
use crate::inference::{
    Candidate, DERIVATIVE_STEP, Description, Estimate, Finding, FindingPart, ForwardModel, Hypothesis, Kind,
    Location, Step, Term,
};

impl ForwardModel for RigModel {
    fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    fn response(&self, terms: &[Term]) -> DVector<f64> {
        self.changed(&self.state(terms))
    }

    fn cases(&self) -> &[usize] {
        &self.cases.of_datum
    }

    fn step(&self, candidate: usize) -> Option<Step> {
        match &self.actions[candidate][..] {
            [Action::Step(data, from)] => Some(Step { data: Arc::clone(data), from: *from }),
            _ => None,
        }
    }

    fn is_linear_in(&self, terms: &[Term]) -> bool {
        terms.iter().all(|term| self.actions[term.candidate].iter().all(Action::only_adds))
    }

    /// By what the cases show, and what only adds to the readings itself: both are sooner done than
    /// whole responses.
    ///
    /// Play that an imposed displacement crosses acts in steps: it is moved by half its usual size.
    /// What does nothing without its effect's first parameter is seen beside the usual size of
    /// that.
    fn columns(&self, terms: &[Term], position: usize) -> DMatrix<f64> {
        let term = &terms[position];
        let parameters = &self.candidates[term.candidate].parameters;
        let mut columns = DMatrix::zeros(self.data.len(), parameters.len());
        // without a rod an addition changes the slope of its line if anything but additions stands
        // beside it
        let is_sum = matches!(self.body, Body::Rod(_)) || self.is_linear_in(terms);
        let is_imposed = !self.course.imposed.is_empty();
        let as_it_is = self.state(terms);
        for ((k, parameter), action) in parameters.iter().enumerate().zip(&self.actions[term.candidate]) {
            let mut column = columns.column_mut(k);
            if is_sum && action.only_adds() {
                action.add_to(column.as_mut_slice(), parameter.size);
                continue;
            }
            if let Action::Own(law, own) = action
                && is_sum
            {
                let mut values = term.values.clone();
                if *own > 0 && values[0] == parameters[0].neutral {
                    values[0] += parameters[0].size;
                }
                let h = DERIVATIVE_STEP * parameter.size;
                for sign in [1.0, -1.0] {
                    let numbers = own_numbers(&self.actions[term.candidate]);
                    let moved = |j: usize| values[j] + if j == k { sign * h } else { 0.0 };
                    let given = numbers.into_iter().enumerate().map(|(j, number)| (number, moved(j)));
                    law.add_to(column.as_mut_slice(), given, 0.5 * sign / DERIVATIVE_STEP);
                }
                continue;
            }
            if let Action::Display(display) = action
                && is_sum
            {
                // at nothing it can only go one way, and what stays within its play is seen once
                // that has a size
                let (value, h) = (term.values[k], DERIVATIVE_STEP * parameter.size);
                let (less, more) = match value > h {
                    true => (value - h, value + h),
                    false => (0.0, value.max(0.0) + 0.5 * parameter.size),
                };
                let mut shown = DVector::zeros(self.data.len());
                display.add_to(shown.as_mut_slice(), more);
                let mut before = DVector::zeros(self.data.len());
                display.add_to(before.as_mut_slice(), less);
                column.copy_from(&((shown - before) * (parameter.size / (more - less))));
                continue;
            }
            let mut moved = terms.to_vec();
            if is_dependent(action) && term.values[0] == parameters[0].neutral {
                moved[position].values[0] += parameters[0].size;
            }
            let (step, (low, high)) = match action {
                Action::Play(_) | Action::SliderPlay | Action::Presliding if is_imposed => {
                    (0.5, parameter.bounds)
                }
                _ => (DERIVATIVE_STEP, (f64::NEG_INFINITY, f64::INFINITY)),
            };
            let h = step * parameter.size;
            let values = [(term.values[k] + h).min(high), (term.values[k] - h).max(low)];
            // onsets are many, and one of them changes its own run only
            let [more, less] = values.map(|value| {
                moved[position].values[k] = value;
                let mut earlier = Cow::Borrowed(as_it_is.earlier());
                if let Action::Onset(onset) = action {
                    onset.move_in(earlier.to_mut(), term.values[k], value);
                }
                self.state_but_onsets(&moved).with_earlier(earlier)
            });
            let scale = parameter.size / (values[0] - values[1]);
            let structure = match &self.body {
                Body::Rod(structure) if self.is_by_case(&more) && self.is_by_case(&less) => structure,
                _ => {
                    column.copy_from(&((self.changed(&more) - self.changed(&less)) * scale));
                    continue;
                }
            };
            let shown = [&more, &less].map(|state| self.shown(structure, state));
            let of_case = |case: usize, loads: [f64; 2]| {
                scale * (shown[0][case].reading(loads[0]) - shown[1][case].reading(loads[1]))
            };
            let plain = |case: usize| [shown[0][case].load, shown[1][case].load];
            let cases = column.iter_mut().zip(&self.cases.of_datum);
            if more.remembers() {
                for (i, (value, &case)) in cases.enumerate() {
                    let [with_more, with_less] = plain(case);
                    *value =
                        of_case(case, [more.with_history(with_more, i), less.with_history(with_less, i)]);
                }
            } else {
                let changes: Vec<f64> = (0..shown[0].len()).map(|case| of_case(case, plain(case))).collect();
                cases.for_each(|(value, &case)| *value = changes[case]);
            }
            if let Action::Memory(memory, _) = action {
                let of_others = column.iter_mut().zip(&memory.recovery);
                of_others.for_each(|(value, left)| *value += parameter.size * left);
            }
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

    fn describe(&self, finding: &Finding) -> Description {
        if let Some(own) = self.own.iter().find(|own| own.effect == finding.effect) {
            return Description { observed: own.observed(finding), cause: finding.effect.cause.to_owned() };
        }
        let observed = registry::record(finding.effect).map_or_else(
            || format!("{} at {}", finding.effect.spoken(), finding.location),
            |effect| (effect.observed)(finding, self),
        );
        // the correction of a mistake says what it is
        let cause = if finding.kind() == Kind::Mistake { "" } else { finding.effect.cause };
        Description { observed, cause: cause.to_owned() }
    }
}

/// Which parameters of its file the actions of a lab's own effect are.
fn own_numbers(actions: &[Action]) -> Vec<usize> {
    let number = |action: &Action| match action {
        Action::Own(_, k) => *k,
        _ => 0,
    };
    actions.iter().map(number).collect()
}

impl RigModel {
    /// The rig with all of these terms.
    pub(super) fn state(&self, terms: &[Term]) -> State<'_> {
        self.state_of(terms, |_| true)
    }

    fn state_but_onsets(&self, terms: &[Term]) -> State<'_> {
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

    pub(super) fn widened(&self, part: &FindingPart) -> Vec<Estimate> {
        let parameters = |candidate: usize| &self.candidates[candidate].parameters;
        let is_scanned = |candidate: usize| parameters(candidate).iter().any(|p| p.name == STATION);
        let mut estimates = part.estimates.clone();
        // where between two readings a slider meets the end of its play nobody sees
        for (own, action) in estimates.iter_mut().zip(&self.actions[part.term.candidate]) {
            if matches!(action, Action::SliderPlay) {
                own.low = own.low.min(own.value - 0.5 * self.step).max(0.0);
                own.high = own.high.max(own.value + 0.5 * self.step);
            }
        }
        if !is_scanned(part.term.candidate) {
            return estimates;
        }
        for (k, own) in estimates.iter_mut().enumerate() {
            let is_station = own.name == STATION;
            let half = if is_station { 0.0 } else { (own.high - own.low) / 2.0 };
            let least = parameters(part.term.candidate)[k].bounds.0;
            let least = if is_station { f64::NEG_INFINITY } else { least };
            let others = part.rivals.iter().filter(|rival| is_scanned(rival.term.candidate));
            for rival in others {
                let own_name = parameters(rival.term.candidate).iter().position(|p| p.name == own.name);
                let Some(other) = own_name.and_then(|k| rival.term.values.get(k)) else { continue };
                own.low = own.low.min(other - half).max(least);
                own.high = own.high.max(other + half);
            }
        }
        estimates
    }
}
