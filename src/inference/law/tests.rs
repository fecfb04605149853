//! Laws that are concealed in numbers without physics.

use nalgebra::{DMatrix, DVector};

use super::*;
use crate::inference::tests::Columns;
use crate::inference::{Diagnosis, Evidence, Location, Part, diagnose};
use crate::statistics::Random;

const TRIALS: usize = 5;
const LEVELS: usize = 12;
const COUNT: usize = TRIALS * LEVELS;

/// 1 to 12 N.
fn load(row: usize) -> f64 {
    1.0 + (row % LEVELS) as f64
}

fn site(_: &DVector<f64>) -> Vec<Site> {
    let measure = |symbol, unit| Measure { symbol, name: symbol.into(), unit, si: 1.0 };
    vec![Site {
        location: Location::Part(Part::Clamp),
        result: measure("u", "m"),
        variable: measure("F", "N"),
        directions: vec![(String::new(), vec![1.0; COUNT])],
        values: (0..COUNT).map(load).collect(),
        recorded: None,
        moves: vec![1.0; COUNT],
        courses: Vec::new(),
        forms: &Form::ALL,
    }]
}

/// What is made of a law with noise of 1.
fn proposed(seed: u64, law: impl Fn(f64) -> f64) -> (Diagnosis, Option<Proposed>) {
    let mut model = Columns::new(COUNT);
    model.add("slope", "here", DMatrix::from_fn(COUNT, 1, |row, _| load(row) / 12.0), false);
    let wave = |row: usize, k: usize| (std::f64::consts::PI * k as f64 * (load(row) - 1.0) / 11.0).cos();
    model.add("curve", "load", DMatrix::from_fn(COUNT, 6, wave), true);
    let mut random = Random::seeded(seed, 0);
    let residual = (0..COUNT).map(|row| law(load(row)) + random.normal());
    let evidence = Evidence {
        replicate_group: (0..COUNT).map(|row| row % LEVELS).collect(),
        fold: (0..COUNT).map(|row| row / LEVELS).collect(),
        ..Evidence::new(DVector::from_iterator(COUNT, residual))
    };
    let diagnosis = diagnose(&model, &evidence);
    let proposed = propose(&model, &diagnosis, &site);
    (diagnosis, proposed)
}

fn law_of(seed: u64, law: impl Fn(f64) -> f64) -> Law {
    let (diagnosis, proposed) = proposed(seed, law);
    assert!(diagnosis.discrepancy.is_some());
    proposed.unwrap().law.unwrap()
}

/// True for a form that is the law or that these data do not distinguish from it.
fn has(law: &Law, form: Form) -> bool {
    law.form == form || law.rivals.iter().any(|rival| rival.form == form)
}

#[test]
fn a_threshold_is_found_where_it_is() {
    let law = law_of(1, |f| 6.0 * (f - 7.3).max(0.0));
    assert!(has(&law, Form::Threshold), "{:?}", law.form);
    if law.form == Form::Threshold {
        let (_, corner) = law.constant.unwrap();
        assert!(corner.low < 7.3 && 7.3 < corner.high && corner.high - corner.low < 1.0, "{corner:?}");
        let slope = &law.amplitudes[0];
        assert!(slope.unit == "m/N" && slope.low < 6.0 && 6.0 < slope.high, "{slope:?}");
    }
}

#[test]
fn a_wave_has_its_period() {
    let law = law_of(2, |f| 8.0 * (std::f64::consts::TAU * f / 3.7).sin());
    let (what, period) = law.constant.clone().unwrap();
    assert_eq!((law.form, what), (Form::Harmonic, FormConstant::Period));
    // of the periods that whole newtons do not distinguish the longest
    assert!((period.value - 3.7).abs() < 0.1 && period.high > 3.7, "{period:?}");
    // 1/3.7 + 1/1.37 = 1 per newton
    assert!(period.also.iter().any(|also| (also - 3.7 / 2.7).abs() < 0.02), "{period:?}");
    // it explains all but the noise
    assert!((0.8..1.2).contains(&law.noise), "{}", law.noise);
    assert!(law.held_out.unwrap() < 1.3);
    assert!((law.explains - 8.0 / 2f64.sqrt()).abs() < 1.0, "{}", law.explains);
}

/// Intervals of an exponent hold the truth as often as they say: 40 recordings, 34 at least (the
/// first per cent of a binomial distribution with 0.95).
#[test]
fn the_interval_of_an_exponent_holds_the_truth() {
    let (mut held, mut known) = (0, 0);
    for seed in 0..40 {
        let (_, found) = proposed(100 + seed, |f| 60.0 * (f / 12.0f64).powf(2.0 / 3.0));
        let Some(Ok(law)) = found.map(|found| found.law) else { continue };
        let power = match law.form {
            Form::Power => law.constant,
            _ => law.rivals.into_iter().find(|rival| rival.form == Form::Power).and_then(|r| r.constant),
        };
        let Some((_, p)) = power else { continue };
        known += 1;
        held += usize::from(p.low <= 2.0 / 3.0 && 2.0 / 3.0 <= p.high);
    }
    assert!(known >= 30 && held * 20 >= 17 * known, "{held} of {known}");
}

#[test]
fn of_noise_and_of_what_is_explained_there_is_no_law() {
    for seed in 0..20 {
        assert!(proposed(200 + seed, |_| 0.0).1.is_none_or(|found| found.law.is_err()));
        assert!(proposed(300 + seed, |f| 2.0 * f).1.is_none_or(|found| found.law.is_err()));
    }
}

#[test]
fn what_parts_from_its_rivals_beyond_the_data_is_said_to() {
    let found = |size: f64| {
        let (_, found) = proposed(4, |f| size * (f / 12.0f64).powi(2));
        found.and_then(|found| found.law.ok()).filter(|law| law.next.is_some())
    };
    let law = [6.0, 9.0, 14.0, 20.0, 30.0, 45.0].into_iter().find_map(found).unwrap();
    let next = law.next.unwrap();
    let rival = &law.rivals[next.rival];
    assert!(next.apart > 4.0 * law.noise && next.is_beyond == (next.at > 12.0));
    // at the data they are one law, but for a straight line
    let difference = |f: f64| law.at(0, f) - rival.at(0, f);
    let bend = |f: f64| difference(f - 1.0) - 2.0 * difference(f) + difference(f + 1.0);
    assert!((2..=11).all(|f| bend(f64::from(f)).abs() < 2.0 * law.noise), "{next:?}");
}
