//! The derivative of the readings by a parameter of one term: by itself where what it does only
//! adds to readings, else by differences of responses.

use std::borrow::Cow;

use nalgebra::DVector;

use super::{Body, RigModel};
use crate::diagnosis::rig::mechanics::action::{Action, Addition};
use crate::diagnosis::rig::mechanics::state::State;
use crate::inference::{DERIVATIVE_STEP, ForwardModel, Parameter, Term};

/// Where derivatives are taken: a term beside others.
pub struct Derivative<'a> {
    model: &'a RigModel,
    terms: &'a [Term],
    position: usize,
    as_it_is: State<'a>,
    /// True where what adds to readings changes nothing else. Without a rod an addition changes the
    /// slope of its line if anything but additions stands beside it.
    is_sum: bool,
}

impl<'a> Derivative<'a> {
    pub fn new(model: &'a RigModel, terms: &'a [Term], position: usize) -> Derivative<'a> {
        let is_sum = matches!(model.body, Body::Rod(_)) || model.is_linear_in(terms);
        Derivative { model, terms, position, as_it_is: model.state(terms), is_sum }
    }

    /// What the usual size of the k-th parameter adds to each reading, to first order, m.
    pub fn by(&self, k: usize) -> DVector<f64> {
        let alone = if self.is_sum { self.of_addition(k) } else { None };
        alone.unwrap_or_else(|| self.of_response(k))
    }

    fn term(&self) -> &'a Term {
        &self.terms[self.position]
    }

    fn actions(&self) -> &'a [Action] {
        &self.model.actions[self.term().candidate]
    }

    fn parameters(&self) -> &'a [Parameter] {
        &self.model.candidates[self.term().candidate].parameters
    }

    /// The term's values; what does nothing without its effect's first parameter is seen beside the
    /// usual size of that.
    fn values(&self, k: usize) -> Vec<f64> {
        let (mut values, first) = (self.term().values.clone(), &self.parameters()[0]);
        if self.actions()[k].is_dependent() && values[0] == first.neutral {
            values[0] += first.size;
        }
        values
    }

    /// Of what adds to readings; `None` for all else.
    fn of_addition(&self, k: usize) -> Option<DVector<f64>> {
        let (action, size) = (&self.actions()[k], self.parameters()[k].size);
        let count = self.model.data.len();
        match action.addition()? {
            Addition::Own(law, _) => {
                let numbers = self.actions().iter().filter_map(Action::number_of_own);
                let given: Vec<(usize, f64)> = numbers.zip(self.values(k)).collect();
                Some(law.derivative(count, &given, k, size))
            }
            Addition::Display(display) => Some(display.derivative(count, self.term().values[k], size)),
            Addition::Weights(_) | Addition::Constant(..) => {
                let mut column = DVector::zeros(count);
                action.add_to(column.as_mut_slice(), size);
                Some(column)
            }
        }
    }

    /// Of what changes how a load becomes a reading. Play that an imposed displacement crosses acts
    /// in steps: it is moved by half its usual size.
    fn of_response(&self, k: usize) -> DVector<f64> {
        let (action, parameter) = (&self.actions()[k], &self.parameters()[k]);
        let value = self.term().values[k];
        let is_imposed = !self.model.course.imposed.is_empty();
        let (step, (low, high)) = match is_imposed && action.is_play() {
            true => (0.5, parameter.bounds),
            false => (DERIVATIVE_STEP, (f64::NEG_INFINITY, f64::INFINITY)),
        };
        let h = step * parameter.size;
        let (above, below) = ((value + h).min(high), (value - h).max(low));
        let [more, less] = [above, below].map(|moved| self.state_at(k, moved));
        let scale = parameter.size / (above - below);
        match &self.model.body {
            Body::Rod(structure) if self.model.is_by_case(&more) && self.model.is_by_case(&less) => {
                let mut column = self.model.difference_by_case(structure, &more, &less) * scale;
                // cases do not hold what is left of the loads of other runs
                if let Action::Memory(memory, _) = action {
                    let share = parameter.size * memory.recovered_derivative(value);
                    let left = column.iter_mut().zip(&memory.recovery);
                    left.for_each(|(own, left)| *own += share * left);
                }
                column
            }
            _ => (self.model.changed(&more) - self.model.changed(&less)) * scale,
        }
    }

    /// The rig with another value of the k-th parameter.
    fn state_at(&self, k: usize, value: f64) -> State<'_> {
        let mut moved = self.terms.to_vec();
        moved[self.position].values = self.values(k);
        moved[self.position].values[k] = value;
        // onsets are many, and one of them changes its own run only
        let mut earlier = Cow::Borrowed(self.as_it_is.earlier());
        if let Action::Onset(onset) = &self.actions()[k] {
            onset.move_in(earlier.to_mut(), self.term().values[k], value);
        }
        self.model.state_but_onsets(&moved).with_earlier(earlier)
    }
}
