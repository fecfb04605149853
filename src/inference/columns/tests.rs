//! What columns come to by themselves and together.

use nalgebra::DVector;

use super::*;
use crate::inference::{DERIVATIVE_STEP, Location, Parameter, Step, Term, UNKNOWN};

/// `count` data of 5 cases in sequences of 8; a candidate of each sort of column, and a step
/// before every datum.
struct Recording {
    candidates: Vec<Candidate>,
    cases: Vec<usize>,
    steps: Vec<Step>,
}

const OTHERS: usize = 3;

fn recording(count: usize) -> Recording {
    let sequences = (0..count).step_by(8).map(|first| (first..(first + 8).min(count)).collect::<Vec<_>>());
    let sequences: Vec<Arc<[usize]>> = sequences.map(Arc::from).collect();
    let steps_of = |sequence: &Arc<[usize]>| {
        let data = Arc::clone(sequence);
        (0..sequence.len()).map(move |from| Step { data: Arc::clone(&data), from })
    };
    let steps: Vec<Step> = sequences.iter().flat_map(steps_of).collect();
    let parameter = Parameter {
        name: "size".into(),
        unit: crate::units::Unit::NONE,
        neutral: 0.0,
        size: 3.0,
        bounds: (f64::NEG_INFINITY, f64::INFINITY),
    };
    let candidate = |parameters: usize| {
        Candidate::new(&UNKNOWN, Location::Named(String::new()), vec![parameter.clone(); parameters])
    };
    let mut candidates = vec![candidate(2), candidate(1), candidate(1)];
    candidates.extend(steps.iter().map(|_| candidate(1)));
    Recording { candidates, cases: (0..count).map(|i| i % 5).collect(), steps }
}

impl ForwardModel for Recording {
    fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    fn response(&self, terms: &[Term]) -> DVector<f64> {
        let mut response = DVector::zeros(self.cases.len());
        for term in terms {
            for (i, value) in response.iter_mut().enumerate() {
                let x = i as f64;
                *value += match term.candidate {
                    // the same for a case; different everywhere
                    0 => term.values[0] * self.cases[i] as f64 + term.values[1] * (0.1 * x).sin(),
                    // a few of the data
                    1 if i % 11 == 4 => term.values[0] * x.cos(),
                    2 => term.values[0] * (1.0 + x),
                    k if k >= OTHERS => {
                        let step = &self.steps[k - OTHERS];
                        f64::from(u8::from(step.data[step.from..].contains(&i))) * term.values[0]
                    }
                    _ => 0.0,
                };
            }
        }
        response
    }

    fn cases(&self) -> &[usize] {
        &self.cases
    }

    fn step(&self, candidate: usize) -> Option<Step> {
        candidate.checked_sub(OTHERS).map(|k| self.steps[k].clone())
    }
}

/// A candidate's columns as its response gives them.
fn plain(model: &Recording, candidate: usize) -> DMatrix<f64> {
    model.columns(&[model.candidates[candidate].neutral(candidate)], 0)
}

#[test]
fn products_are_those_of_the_whole_columns() {
    let model = recording(43);
    let columns = Columns::new(&model);
    let vectors = DMatrix::from_fn(43, 3, |i, j| (i * 3 + j) as f64 % 5.0 - 2.0);
    let some: Vec<usize> = (0..43).filter(|i| i % 4 != 1).collect();
    let part = vectors.select_rows(&some);
    let (of_all, of_some) =
        (columns.products(vectors.clone(), None), columns.products(part.clone(), Some(&some)));
    for candidate in 0..model.candidates.len() {
        let plain = plain(&model, candidate);
        assert!((columns.dense(candidate, None) - &plain).amax() < 1e-9, "{candidate}");
        assert!((of_all.of(candidate) - vectors.tr_mul(&plain)).amax() < 1e-9, "{candidate}");
        let plain = plain.select_rows(&some);
        assert!((columns.dense(candidate, Some(&some)) - &plain).amax() < 1e-9, "{candidate}");
        assert!((of_some.of(candidate) - part.tr_mul(&plain)).amax() < 1e-9, "{candidate}");
    }
    let table = columns.table(&part, Some(&some));
    assert!((0..model.candidates.len()).all(|k| table.of(k) == of_some.of(k)));
}

#[test]
fn each_column_is_stored_as_small_as_it_is() {
    let columns = Columns::new(&recording(80));
    assert!(matches!(columns.own(0), [Column::ByCase(0), Column::Whole(0)]));
    assert!(matches!(columns.own(1), [Column::Listed(0)]));
    assert!(matches!(columns.own(2), [Column::Whole(1)]));
    assert!(matches!(columns.own(OTHERS + 9), [Column::Step { sequence: 1, from: 1, .. }]));
    assert!((columns.dense(2, None)[7] - 24.0).abs() < 1e-12 / DERIVATIVE_STEP);
}

#[test]
fn what_is_stored_grows_with_the_recording_and_no_faster() {
    let stored = |count: usize| {
        let columns = Columns::new(&recording(count));
        let listed: usize = columns.listed.iter().map(Vec::len).sum();
        let sequences: usize = columns.sequences.iter().map(|sequence| sequence.len()).sum();
        columns.whole.len() + columns.by_case.len() + 2 * listed + sequences + 4 * columns.columns.len()
    };
    let (small, large) = (stored(440), stored(880));
    assert!(large <= 2 * small, "{small} and {large}");
}
