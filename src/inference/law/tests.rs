//! Laws that are concealed in numbers without physics.

use nalgebra::{DMatrix, DVector};

mod kin;
mod loops;
mod waves;

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
        rare: &[],
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

/// A number of a shape.
fn of_shape(law: &Law) -> &Constant {
    let [number] = &law.of_shape[..] else { panic!("{:?}", law.of_shape) };
    number
}

/// Before, what is nearest to it among powers and waves.
#[test]
fn a_contact_that_begins_at_a_load_has_its_corner_and_exponent() {
    let law = law_of(11, |f| 60.0 * ((f - 3.6).max(0.0) / 8.4).powf(1.5));
    assert!(law.form.is(Form::CONTACT), "{:?} {:?}", law.form, law.rivals);
    let ((_, corner), exponent) = (law.constant.clone().unwrap(), of_shape(&law));
    assert!(corner.low < 3.6 && 3.6 < corner.high && corner.high - corner.low < 2.0, "{corner:?}");
    assert!(exponent.low < 1.5 && 1.5 < exponent.high && exponent.high < 2.2, "{exponent:?}");
    assert!((law.at(0, 18.0) / (60.0 * (14.4f64 / 8.4).powf(1.5)) - 1.0).abs() < 0.15, "{law:?}");
    // half again beyond the loads its exponent is open too
    assert!(law.further.unwrap().1 > 5.0 * law.noise, "{:?}", law.further);
}

#[test]
fn a_threshold_that_bends_little_by_little_has_its_width() {
    let soft = |x: f64| x.exp().ln_1p();
    let law = law_of(12, |f| 12.0 * 0.8 * soft((f - 6.4) / 0.8));
    assert!(law.form.is(Form::ROUGH), "{:?} {:?}", law.form, law.rivals);
    let ((_, corner), width) = (law.constant.clone().unwrap(), of_shape(&law));
    assert!(corner.low < 6.4 && 6.4 < corner.high && corner.high - corner.low < 1.0, "{corner:?}");
    assert!(width.unit == "N" && width.low < 0.8 && 0.8 < width.high && width.high < 1.6, "{width:?}");
}

/// What something else adds beyond the data no law says.
#[test]
fn beside_something_else_no_law_holds_beyond_its_data() {
    let law = law_of(1, |f| 6.0 * (f - 7.3).max(0.0));
    let more = (law.site.location.clone(), law.site.variable.clone());
    let law = Law { further: Some((18.0, 0.5 * law.noise)), more: None, ..law };
    assert_eq!(law.holds_beyond(), Some(true));
    assert_eq!(Law { more: Some(more), ..law.clone() }.holds_beyond(), Some(false));
    assert_eq!(Law { further: None, ..law }.holds_beyond(), None);
}

/// What touches mostly has a corner.
#[test]
fn what_has_no_corner_is_rarer_than_what_has() {
    let share = |form: Form| choice::Choice { site: 0, form, memory: Memory::None }.share();
    assert!(share(Form::CONTACT) < 0.5 && share(Form::ROUGH) < 0.5);
    assert_eq!(share(Form::Threshold), 1.0);
}

#[test]
fn what_is_rare_is_so_with_any_exponent() {
    let [site] = site(&DVector::zeros(0)).try_into().unwrap();
    let site = Site { rare: &[Form::CONTACT, Form::ROUGH], ..site };
    let share = |form: Form| site.share(form);
    assert!(share(Form::PowerBeyond(2.7)) < 1.0 && share(Form::Rough(0.07)) < 1.0);
    assert_eq!(share(Form::Threshold), 1.0);
}

/// Less than a period comes back nowhere, and any curve is some of it.
#[test]
fn what_bends_once_is_no_wave() {
    let grid = Form::Harmonic.grid((0.0, 1.0), 12);
    assert!(grid.iter().all(|u| Form::Harmonic.at_coordinate(*u) > 1.0 - 1e-9), "{grid:?}");
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

/// What swings had begun before the zero was taken: it has a level besides.
#[test]
fn a_wave_about_a_level_has_its_period() {
    let law = law_of(2, |f| 8.0 * (std::f64::consts::TAU * f / 3.7 + 0.7).sin());
    let (what, period) = law.constant.clone().unwrap();
    assert_eq!((law.form, what), (Form::Oscillation, FormConstant::Period));
    assert!(period.low < 3.7 && 3.7 < period.high, "{period:?}");
    let [.., level] = &law.amplitudes[..] else { panic!("{:?}", law.amplitudes) };
    assert!(level.symbol == "c" && level.low < 0.0 && 0.0 < level.high, "{level:?}");
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

/// A wave that the diagnosis has found among a few periods is no rival of the wave itself, however
/// little a period costs there.
#[test]
fn a_curve_that_says_no_more_than_the_law_is_no_rival() {
    let mut model = Columns::new(COUNT);
    let turns = |row: usize, period: f64| std::f64::consts::TAU * load(row) / period;
    let wave = |row: usize, k: usize| if k == 0 { turns(row, 3.75).sin() } else { turns(row, 3.75).cos() };
    model.add("swing", "load", DMatrix::from_fn(COUNT, 2, wave), true);
    for seed in 0..8 {
        let mut random = Random::seeded(700 + seed, 0);
        let residual = (0..COUNT).map(|row| 2.0 * turns(row, 3.7).sin() + random.normal());
        let evidence = Evidence {
            replicate_group: (0..COUNT).map(|row| row % LEVELS).collect(),
            fold: (0..COUNT).map(|row| row / LEVELS).collect(),
            ..Evidence::new(DVector::from_iterator(COUNT, residual))
        };
        let proposed = propose(&model, &diagnose(&model, &evidence), &site).unwrap();
        let law = proposed.law.unwrap_or_else(|refusal| panic!("{seed}: {refusal:?}"));
        assert!(law.form.is_wave(), "{:?}", law.form);
    }
}

/// What is made of a body that warms through, read once a minute, with noise of 1: it follows the
/// temperature, each part of it (size, time constant) in its own time.
fn warmed(seed: u64, temperature: &dyn Fn(f64) -> f64, parts: &[(f64, f64)]) -> Law {
    let minute = |k: usize| 60.0 * k as f64;
    let mut lags = vec![0.0; COUNT];
    for (size, time) in parts {
        let start = temperature(0.0);
        let mut own = start;
        // by the differential equation, in steps of a second; what nobody read goes evenly
        for (k, lag) in lags.iter_mut().enumerate().skip(1) {
            let [before, now] = [k - 1, k].map(|k| temperature(minute(k)));
            let seconds = (0..60).map(|s| before + (now - before) * (f64::from(s) + 0.5) / 60.0);
            own = seconds.fold(own, |own, there| own + (there - own) / time);
            *lag += size * (own - start);
        }
    }
    let mut model = Columns::new(COUNT);
    let wave = |row: usize, k: usize| (std::f64::consts::PI * k as f64 * row as f64 / COUNT as f64).cos();
    model.add("curve", "time", DMatrix::from_fn(COUNT, 6, wave), true);
    let mut random = Random::seeded(seed, 0);
    let residual = lags.iter().map(|own| own + random.normal());
    let evidence = Evidence {
        replicate_group: (0..COUNT).collect(),
        fold: (0..COUNT).map(|row| row / LEVELS).collect(),
        ..Evidence::new(DVector::from_iterator(COUNT, residual))
    };
    let sites = |_: &DVector<f64>| {
        let instant =
            |k: usize| Instant { data: vec![k], elapsed: if k == 0 { 0.0 } else { 60.0 }, sense: 1.0 };
        let course = Course { instants: (0..COUNT).map(instant).collect(), start: temperature(0.0) };
        let values = (0..COUNT).map(|k| temperature(minute(k))).collect();
        let [own] = site(&DVector::zeros(0)).try_into().unwrap();
        vec![Site { values, moves: Vec::new(), courses: vec![course], forms: Form::FROM_ANYWHERE, ..own }]
    };
    propose(&model, &diagnose(&model, &evidence), &sites).unwrap().law.unwrap()
}

/// The time constant of what lags, s.
fn time_constant(law: &Law) -> Constant {
    let (what, tau) = law.constant.clone().unwrap();
    assert_eq!((law.memory, what), (Memory::Lagged, FormConstant::Lag));
    tau
}

/// With its time constant, however much longer than a minute that is.
#[test]
fn what_lags_behind_a_temperature_has_its_time() {
    let law =
        warmed(11, &|t| 3.0 + 2.0 * (t / 410.0).sin() + 1.2 * (t / 173.0 + 0.4).cos(), &[(12.0, 700.0)]);
    let tau = time_constant(&law);
    assert!(tau.low < 700.0 && 700.0 < tau.high && tau.high < 1.3 * tau.low, "{tau:?}");
    assert!((law.amplitudes[0].value / 12.0 - 1.0).abs() < 0.1, "{:?}", law.amplitudes);
}

/// Two parts that warm through against each other are two laws, which neither alone is.
#[test]
fn two_lags_are_two_laws() {
    let temperature = |t: f64| 3.0 + 2.0 * (t / 410.0).sin() + 1.2 * (t / 173.0 + 0.4).cos();
    let mut held = [0; 2];
    for seed in 11..17 {
        let law = warmed(seed, &temperature, &[(30.0, 120.0), (-40.0, 700.0)]);
        let second = &law.second.as_ref().unwrap().law;
        let mut both = [time_constant(&law), time_constant(second)];
        both.sort_by(|a, b| a.value.total_cmp(&b.value));
        for (k, (tau, truth)) in both.iter().zip([120.0, 700.0]).enumerate() {
            held[k] += usize::from(tau.low < truth && truth < tau.high);
            assert!(tau.high < 2.0 * tau.low, "{tau:?} for {truth}");
        }
    }
    assert!(held.iter().all(|held| *held >= 5), "{held:?} of 6");
}

/// A lag three times as long as the recording is known as a rate alone: its time has a lower end.
#[test]
fn a_lag_that_is_longer_than_its_recording_has_no_upper_end() {
    let law = warmed(11, &|t| 3.0 + 2.0 * (t / 410.0).sin() + t / 600.0, &[(30.0, 10800.0)]);
    let tau = time_constant(&law);
    assert_eq!(tau.open, Some(OpenEnd::High));
    assert!(tau.low < 10800.0 && 10800.0 < tau.high && tau.low > 1000.0, "{tau:?}");
}

/// Half again beyond the data the truth is as near as a law says of itself, by two standard
/// deviations: 40 recordings, 34 at least.
#[test]
fn a_law_without_a_rival_says_how_far_off_it_may_be() {
    let (mut held, mut known) = (0, 0);
    for seed in 0..40 {
        let truth = |f: f64| 15.0 * (f / 4.0).min(1.0);
        let (_, found) = proposed(500 + seed, truth);
        let Some(Ok(law)) = found.map(|found| found.law) else { continue };
        if !law.rivals.is_empty() || law.form != Form::Saturation {
            continue;
        }
        let (at, open) = law.further.unwrap();
        assert_eq!(at, 18.0);
        // zeros and stiffnesses take up a straight line
        let xs: Vec<f64> = (1..=12).map(f64::from).collect();
        let columns = DMatrix::from_fn(12, 2, |i, j| if j == 0 { 1.0 } else { xs[i] });
        let off = DVector::from_iterator(12, xs.iter().map(|&f| law.at(0, f) - truth(f)));
        let line = crate::linalg::least_squares(&columns, &off).unwrap();
        known += 1;
        held += usize::from((law.at(0, at) - truth(at) - line[0] - line[1] * at).abs() <= open);
    }
    assert!(known >= 30 && held * 20 >= 17 * known, "{held} of {known}");
}

/// A second law is the first one again where it does the same to the data at the same place.
#[test]
fn a_law_is_repeated_by_what_does_the_same_there() {
    let law = law_of(2, |f| 8.0 * (std::f64::consts::TAU * f / 3.7).sin());
    let mut twice = law.clone();
    twice.adds.iter_mut().for_each(|add| *add *= -0.3);
    assert!(law.repeats(&twice));
    // a wave of another period is another law
    let other = law_of(2, |f| 8.0 * (std::f64::consts::TAU * f / 5.9).sin());
    assert!(other.form == law.form && !law.repeats(&other));
    let mut elsewhere = law.clone();
    elsewhere.site.location = Location::Part(Part::Root);
    let mut form = law.clone();
    form.form = Form::Polynomial(1);
    assert!(!law.repeats(&elsewhere) && !law.repeats(&form));
}

/// What bends a little over one number and what bends a little over it again are one curve; a wave
/// beside it is a law of its own, and so is what acts elsewhere.
#[test]
fn two_that_bend_alike_are_one_curve() {
    let law = law_of(1, |f| 15.0 * (f / 12.0).powf(0.5));
    let bent = Law { form: Form::Power, memory: Memory::None, ..law };
    let again = Law { form: Form::Approach, ..bent.clone() };
    assert!(bent.is_of_curve_with(&again));
    assert!(!bent.is_of_curve_with(&Law { form: Form::Harmonic, ..again.clone() }));
    let mut elsewhere = again;
    elsewhere.site.directions[0].1[..30].iter_mut().for_each(|weight| *weight = 0.0);
    assert!(!bent.is_of_curve_with(&elsewhere));
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

/// Of places that do the same to the data the usual one comes first, and the rare one is said.
#[test]
fn what_is_rare_comes_after_what_is_usual() {
    let two = |rare: [&'static [Form]; 2]| {
        let [own] = site(&DVector::zeros(0)).try_into().unwrap();
        let [first, second] = [Part::Root, Part::Bend].map(Location::Part);
        vec![
            Site { location: first, rare: rare[0], ..own.clone() },
            Site { location: second, rare: rare[1], ..own },
        ]
    };
    let mut model = Columns::new(COUNT);
    let wave = |row: usize, k: usize| (std::f64::consts::PI * k as f64 * (load(row) - 1.0) / 11.0).cos();
    model.add("curve", "load", DMatrix::from_fn(COUNT, 6, wave), true);
    let mut random = Random::seeded(3, 0);
    let residual = (0..COUNT).map(|row| 6.0 * (load(row) - 7.3).max(0.0) + random.normal());
    let evidence = Evidence {
        replicate_group: (0..COUNT).map(|row| row % LEVELS).collect(),
        fold: (0..COUNT).map(|row| row / LEVELS).collect(),
        ..Evidence::new(DVector::from_iterator(COUNT, residual))
    };
    let diagnosis = diagnose(&model, &evidence);
    for (rare, usual) in [(0, Part::Bend), (1, Part::Root)] {
        let mut of_sites: [&'static [Form]; 2] = [&[], &[]];
        of_sites[rare] = &Form::ALL;
        let law = propose(&model, &diagnosis, &|_| two(of_sites)).unwrap().law.unwrap();
        assert_eq!(law.site.location, Location::Part(usual));
        assert!(
            law.rivals
                .iter()
                .any(|rival| rival.form == law.form && rival.site.location != Location::Part(usual))
        );
    }
}
