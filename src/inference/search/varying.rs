//! Whether what was named is the same throughout.
//!
//! An effect has a size, one for all data. Where another law acts, what was named in its place is
//! larger here than there: play that a settling bond imitates grows from run to run. A hypothesis
//! is therefore compared with one in which the response u of an effect at its values is multiplied
//! by a curve along a number x of the recording, or by a factor for each of its groups,
//!
//! ```text
//! u·(1 + Σ_j a_j·cos(π j x)),     a_j ~ s/(1 + j)             u·(1 + a_k) in group k,     a_k ~ s
//! ```
//!
//! each as improbable beforehand as any physics that nobody has named.

use nalgebra::DMatrix;

use crate::inference::model::evidence::rms;
use crate::inference::score::priors::{NAMED, PRIOR};
use crate::inference::search::Search;
use crate::inference::{Covariate, Discrepancy, ForwardModel, Hypothesis, Kind, Location, ShownBy, Term};

/// Size of the curve, as a share of the effect.
const SHARE: f64 = 0.5;
/// Columns of a curve.
const COLUMNS: usize = 6;
/// More groups than these are a curve.
const MOST_GROUPS: usize = 12;
/// What changes an effect by less than this share of it is its law, not quite right.
const LITTLE: f64 = 0.2;

impl Search<'_> {
    /// What makes an effect of a hypothesis larger here than there, if that is likelier than
    /// chance; of several the likeliest.
    pub fn varying(&self, hypothesis: &Hypothesis) -> Option<Discrepancy> {
        let candidates = self.model.candidates();
        let is_law = |term: &Term| candidates[term.candidate].effect.kind == Kind::Physics;
        let positions: Vec<usize> =
            (0..hypothesis.terms.len()).filter(|&k| is_law(&hypothesis.terms[k])).collect();
        let factors: Vec<(&Covariate, DMatrix<f64>)> = self
            .evidence
            .covariates
            .iter()
            .filter_map(|covariate| Some((covariate, factors(&covariate.values)?)))
            .collect();
        let rivals = (positions.len() * factors.len()).max(1) as f64;
        let prior = (PRIOR.2 / PRIOR.0 / rivals).ln();
        let linear = self.linear_part(&hypothesis.terms);
        let whole = self.model.response(&hypothesis.terms);
        let mut best: Option<(f64, Discrepancy)> = None;
        for position in positions {
            let mut others = hypothesis.terms.clone();
            let term = others.remove(position);
            let own = &whole - self.model.response(&others);
            for (covariate, factors) in &factors {
                let mut columns = factors.clone();
                columns.column_iter_mut().for_each(|mut column| column.component_mul_assign(&own));
                let whitened = self.whitening.apply_columns(&columns);
                let (log_probability, amplitudes) = self.with_effect(hypothesis, &linear, &whitened);
                let odds = log_probability + prior - hypothesis.log_probability;
                // what all of it has in common is a part of its size
                let shape = columns * amplitudes;
                let in_common = shape.dot(&own) / own.norm_squared();
                let shape = shape - &own * in_common;
                if odds < NAMED.ln()
                    || best.as_ref().is_some_and(|(most, _)| odds <= *most)
                    || rms(&shape) < LITTLE * rms(&own)
                {
                    continue;
                }
                let location = self.location(&term, covariate);
                let rms = rms(&shape);
                let found = Discrepancy {
                    candidate: None,
                    location: Some(location),
                    shown_by: ShownBy::Varying,
                    rms,
                    shape,
                };
                best = Some((odds, found));
            }
        }
        best.map(|(_, found)| found)
    }

    fn location(&self, term: &Term, covariate: &Covariate) -> Location {
        let (effect, place) = (self.model.candidates()[term.candidate].effect, self.model.location(term));
        let cause = (effect.cause_at)(&place);
        let variable = covariate.variable;
        Location::Curve {
            label: format!("{variable}, {cause}"),
            follows: format!(
                "makes what was named ({cause}) larger here than there, following the {}",
                variable.title("recording")
            ),
            along: Some(variable),
        }
    }
}

/// What multiplies an effect along a number of the recording; nothing where it does not vary.
fn factors(values: &[f64]) -> Option<DMatrix<f64>> {
    let mut known: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    known.sort_by(f64::total_cmp);
    let (low, high) = (*known.first()?, *known.last()?);
    known.dedup();
    if known.len() < 2 {
        return None;
    }
    if known.len() <= MOST_GROUPS {
        let is_of = |row: usize, k: usize| SHARE * f64::from(u8::from(values[row] == known[k]));
        return Some(DMatrix::from_fn(values.len(), known.len(), is_of));
    }
    let cosine = |row: usize, k: usize| {
        let x = (values[row] - low) / (high - low);
        let j = (k + 1) as f64;
        if x.is_nan() { 0.0 } else { SHARE / (1.0 + j) * (std::f64::consts::PI * j * x).cos() }
    };
    Some(DMatrix::from_fn(values.len(), COLUMNS, cosine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::columns::linearised::Linearised;
    use crate::inference::tests::{Columns, independent};
    use crate::inference::{Evidence, Variable};
    use crate::statistics::Random;

    const COUNT: usize = 200;

    /// What is found of play that is `times` as large, by row, beside noise of 1: along what.
    fn found(times: impl Fn(usize) -> f64) -> Option<Variable> {
        let mut model = Columns::new(COUNT);
        let side = |row: usize| if row.is_multiple_of(2) { 8.0 } else { -8.0 };
        model.add("play", "", DMatrix::from_fn(COUNT, 1, |row, _| side(row)), false);
        let mut random = Random::seeded(3, 0);
        let residual = (0..COUNT).map(|row| side(row) * times(row) + random.normal()).collect();
        let covariate = |variable: Variable, value: &dyn Fn(usize) -> f64| Covariate {
            variable,
            values: (0..COUNT).map(value).collect(),
        };
        let covariates = vec![
            covariate(Variable::Order, &|row| row as f64),
            covariate(Variable::Channel, &|row| (row / 2 % 3) as f64),
        ];
        let evidence = Evidence { covariates, ..independent(residual) };
        let linear = Linearised::new(&model);
        let search = Search::new(&linear, &evidence, &[]);
        let varying = search.varying(&search.fit(&[model.term("play", &[0.0])]))?;
        match varying.location {
            Some(Location::Curve { along, .. }) => along,
            _ => panic!("a curve"),
        }
    }

    #[test]
    fn an_effect_has_one_size() {
        assert_eq!(found(|_| 1.0), None);
        // the law that is not quite right
        assert_eq!(found(|row| 1.0 + 0.1 * (row as f64 / COUNT as f64)), None);
    }

    #[test]
    fn what_grows_or_differs_between_sensors_is_another_law() {
        assert_eq!(found(|row| 1.0 - (-(row as f64) / 40.0).exp()), Some(Variable::Order));
        assert_eq!(found(|row| if row / 2 % 3 == 0 { 2.0 } else { 0.5 }), Some(Variable::Channel));
    }
}
