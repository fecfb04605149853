//! Waves that change, and waves that beat.

use super::*;

const FINE: usize = 36;
const ALL: usize = 3 * FINE;

/// 36 loads up to 12 N at uneven distances.
fn fine(row: usize) -> f64 {
    let k = (row % FINE) as f64;
    (k + 1.0 + 0.3 * (2.4 * k).sin()) / 3.0
}

fn finely(seed: u64, law: impl Fn(f64) -> f64) -> Law {
    at_loads(fine, seed, law)
}

/// What is made of a law with noise of 1 at so many loads, read three times.
fn at_loads(load: impl Fn(usize) -> f64, seed: u64, law: impl Fn(f64) -> f64) -> Law {
    let mut model = Columns::new(ALL);
    model.add("slope", "here", DMatrix::from_fn(ALL, 1, |row, _| load(row) / 12.0), false);
    let wave = |row: usize, k: usize| (std::f64::consts::PI * k as f64 * load(row) / 12.0).cos();
    model.add("curve", "load", DMatrix::from_fn(ALL, 12, wave), true);
    let mut random = Random::seeded(seed, 0);
    let residual = (0..ALL).map(|row| law(load(row)) + random.normal());
    let evidence = Evidence {
        replicate_group: (0..ALL).map(|row| row % FINE).collect(),
        fold: (0..ALL).map(|row| row / FINE).collect(),
        ..Evidence::new(DVector::from_iterator(ALL, residual))
    };
    let sites = |_: &DVector<f64>| {
        let [own] = site(&DVector::zeros(0)).try_into().unwrap();
        let values = (0..ALL).map(&load).collect();
        let directions = vec![(String::new(), vec![1.0; ALL])];
        vec![Site { directions, values, moves: vec![1.0; ALL], forms: Form::FROM_ZERO, ..own }]
    };
    propose(&model, &diagnose(&model, &evidence), &sites).unwrap().law.unwrap()
}

/// A wave whose period changes is one law with its change, and no two waves; so is one that grows.
#[test]
fn a_wave_that_changes_is_one_law() {
    let turns = |f: f64| std::f64::consts::TAU * f / 3.1 * (1.0 + 0.2 * (f / 12.0 - 1.0));
    let sizes = [|_: f64| 1.0, |f: f64| 1.0 + 1.5 * f / 12.0];
    for (form, size) in [Form::CHIRP, Form::SWELL].into_iter().zip(sizes) {
        let of_form = |f: f64| match form {
            Form::Chirp(_) => turns(f),
            _ => std::f64::consts::TAU * f / 3.1,
        };
        let law = finely(6, |f| 8.0 * size(f) * of_form(f).sin());
        assert!(law.form.is(form) && law.second.is_none(), "{:?} {:?}", law.form, law.second);
        let truths = [("P", 3.1), if form.is(Form::CHIRP) { ("q", 0.2) } else { ("g", 1.5) }];
        for (symbol, truth) in truths {
            let own = law.constants().find(|own| own.symbol == symbol).unwrap();
            assert!(own.low < truth && truth < own.high && own.high - own.low < 0.9 * truth, "{own:?}");
        }
    }
}

/// Two waves that beat are two waves, though one that grows or whose period changes is nearer to
/// them than either.
#[test]
fn two_waves_that_beat_are_two() {
    let turns = |f: f64, period: f64| std::f64::consts::TAU * f / period;
    for seed in 0..3 {
        let law = finely(10 + seed, |f| {
            8.0 * turns(f, 2.3).sin() + 6.0 * ((turns(f, 2.9) + 1.0).sin() - 1.0f64.sin())
        });
        let second = &law.second.as_ref().unwrap().law;
        for own in [&law, second] {
            let (_, period) = own.constant.clone().unwrap();
            let is_near = |truth: f64| (period.value / truth - 1.0).abs() < 0.01;
            assert!(own.form.is_wave() && (is_near(2.3) || is_near(2.9)), "{:?} {period:?}", own.form);
            // how much one of them changes may be nothing
            let mut changes = own.constants().filter(|own| ["g", "q"].contains(&own.symbol.as_str()));
            let is_none = changes.all(|change| change.low < 0.0 && 0.0 < change.high);
            assert!(is_none, "{:?} {:?}", own.form, own.constants().collect::<Vec<_>>());
        }
    }
}

/// Even loads show a wave that changes at several frequencies, as they show any other: all of them
/// are said.
#[test]
fn even_loads_show_a_wave_that_changes_at_several_periods() {
    // 18 loads up to 12 N: 1/1.6 + 1/1.143 = 1.5 per newton
    let even = |row: usize| (row % 18 + 1) as f64 / 1.5;
    for seed in 0..3 {
        let turns = |f: f64| std::f64::consts::TAU * f / 1.6 * (1.0 + 0.15 * (f / 12.0 - 1.0));
        let law = at_loads(even, 20 + seed, |f| 8.0 * turns(f).sin());
        let (_, period) = law.constant.clone().unwrap();
        assert!(law.form.is(Form::CHIRP), "{:?}", law.form);
        let is_said = |truth: f64| {
            std::iter::once(&period.value).chain(&period.also).any(|own| (own / truth - 1.0).abs() < 0.03)
        };
        assert!(is_said(1.6) && is_said(1.143), "{period:?}");
    }
}

/// Up to half again beyond the data a wave that changes is as near as it says of itself: 40
/// recordings, 34 at least.
#[test]
fn a_wave_that_changes_says_how_far_off_it_may_be_beyond() {
    let turns = |f: f64, q: f64| std::f64::consts::TAU * f / 3.1 * (1.0 + q * (f / 12.0 - 1.0));
    // g and q
    let truths = [(Form::CHIRP, 0.0, 0.2), (Form::SWELL, 1.5, 0.0)];
    let (mut held, mut known) = (0, 0);
    for (form, g, q) in truths {
        let truth = |f: f64| 6.0 * (1.0 + g * f / 12.0) * turns(f, q).sin();
        for seed in 0..20 {
            let law = finely(60 + seed, truth);
            if !law.form.is(form) || !law.rivals.is_empty() {
                continue;
            }
            // zeros and stiffnesses take up a straight line
            let line = DMatrix::from_fn(ALL, 2, |i, j| if j == 0 { 1.0 } else { fine(i) });
            let off = |f: f64| law.at(0, f) - truth(f);
            let taken = DVector::from_iterator(ALL, (0..ALL).map(|row| off(fine(row))));
            let taken = crate::linalg::least_squares(&line, &taken).unwrap();
            let beyond = (0..=12).map(|k| 12.0 + 0.5 * f64::from(k));
            let most = beyond.map(|f| (off(f) - taken[0] - taken[1] * f).abs()).fold(0.0, f64::max);
            known += 1;
            held += usize::from(most <= law.further.unwrap().1);
        }
    }
    assert!(known >= 30 && held * 20 >= 17 * known, "{held} of {known}");
}
