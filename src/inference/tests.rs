//! The engine on a model without physics: a line of data, and candidates that are columns.

mod intervals;

use nalgebra::{DMatrix, DVector};

use super::*;
use crate::inference::columns::linearised::Linearised;
use crate::inference::search::Search;
use crate::inference::search::selection::{DiscrepancyModel, Pairs};
use crate::statistics::Random;

/// 5 trials of 16 data over x = 0 … 1.
const TRIALS: usize = 5;
const POINTS: usize = 16;
const COUNT: usize = TRIALS * POINTS;

/// Every candidate is one column or some.
pub(super) struct Columns {
    pub candidates: Vec<Candidate>,
    columns: Vec<DMatrix<f64>>,
    data: usize,
}

impl Columns {
    /// Of so many data, without candidates.
    pub fn new(data: usize) -> Self {
        Columns { candidates: Vec::new(), columns: Vec::new(), data }
    }

    /// One candidate more, with parameters of size 10.
    pub fn add(
        &mut self,
        effect: &'static str,
        location: &str,
        columns: DMatrix<f64>,
        is_nonparametric: bool,
    ) {
        let known = self.candidates.iter().find(|candidate| candidate.effect.name == effect);
        let effect = match known {
            Some(candidate) => candidate.effect,
            // a test ends soon
            None => Box::leak(Box::new(Effect { name: effect, ..UNKNOWN })),
        };
        let parameter = Parameter {
            name: "size".into(),
            unit: crate::units::Unit::NONE,
            neutral: 0.0,
            size: 10.0,
            bounds: (f64::NEG_INFINITY, f64::INFINITY),
        };
        let location = Location::Named(location.into());
        let candidate = Candidate::new(effect, location, vec![parameter; columns.ncols()]);
        self.candidates.push(Candidate { is_nonparametric, ..candidate });
        self.columns.push(columns);
    }

    /// A candidate with these values.
    pub fn term(&self, effect: &str, values: &[f64]) -> Term {
        let candidate = self.candidates.iter().position(|c| c.effect.name == effect).unwrap();
        Term { candidate, values: values.to_vec() }
    }
}

impl ForwardModel for Columns {
    fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    fn response(&self, hypothesis: &[Term]) -> DVector<f64> {
        let mut change = DVector::zeros(self.data);
        for term in hypothesis {
            change += &self.columns[term.candidate] * DVector::from_column_slice(&term.values);
        }
        change
    }
}

fn x(row: usize) -> f64 {
    (row % POINTS) as f64 / (POINTS - 1) as f64
}

fn column(f: impl Fn(f64) -> f64) -> DMatrix<f64> {
    DMatrix::from_fn(COUNT, 1, |row, _| f(x(row)))
}

/// A slope, its twin under another name, a curvature, steps at twelve places, and smooth unknown
/// curves.
fn model() -> Columns {
    let mut model = Columns::new(COUNT);
    model.add("slope", "here", column(|x| x), false);
    model.add("twin", "there", column(|x| 1.001 * x), false);
    model.add("curvature", "here", column(|x| x * x), false);
    for place in 1..13 {
        let at = (f64::from(place) + 0.5) / 15.0;
        model.add("step", &format!("{place}"), column(move |x| f64::from(u8::from(x > at))), false);
    }
    let waves = DMatrix::from_fn(COUNT, 6, |row, k| (std::f64::consts::PI * (k + 1) as f64 * x(row)).cos());
    model.add("curve", "x", waves, true);
    model
}

/// Data that have nothing to do with each other.
pub(super) fn independent(residual: Vec<f64>) -> Evidence {
    Evidence::new(DVector::from_vec(residual))
}

fn evidence(seed: u64, truth: impl Fn(f64) -> f64) -> Evidence {
    let mut random = Random::seeded(seed, 0);
    let mut residual = Vec::new();
    for _ in 0..TRIALS {
        let zero = random.normal();
        for point in 0..POINTS {
            residual.push(truth(x(point)) + zero + random.normal());
        }
    }
    Evidence {
        replicate_group: (0..COUNT).map(|row| row % POINTS).collect(),
        shared: (0..COUNT).map(|row| row / POINTS).collect(),
        fold: (0..COUNT).map(|row| row / POINTS).collect(),
        ..independent(residual)
    }
}

fn effects(diagnosis: &Diagnosis) -> Vec<&'static str> {
    diagnosis.findings.iter().map(|f| f.effect.name).collect()
}

#[test]
fn noise_is_not_named() {
    let model = model();
    let named = (0..200).filter(|&seed| diagnose(&model, &evidence(seed, |_| 0.0)).is_mismatch()).count();
    // METHOD's target is 2 %
    assert!(named <= 4, "{named} of 200");
}

#[test]
fn one_effect_is_named_with_its_size_and_predicts_what_it_has_not_seen() {
    let model = model();
    let (mut named, mut covered) = (0, 0);
    for seed in 0..50 {
        let found = diagnose(&model, &evidence(seed, |x| 6.0 * x * x));
        if effects(&found) == ["curvature"] {
            named += 1;
            let size = &found.findings[0].estimates[0];
            covered += usize::from(size.low < 6.0 && 6.0 < size.high);
            assert!(found.findings[0].p_value < 1e-6);
            let loss = found.findings[0].held_out_loss.expect("five folds");
            let proof = found.held_out.expect("five folds");
            // the one finding is all that the hypothesis gains
            let is_in_all = found.findings[0].found_in_folds == Some((5, 5));
            assert!(!is_in_all || (loss - proof.gain).abs() < 0.1, "{loss} {}", proof.gain);
            assert!(proof.after < proof.before, "{} {}", proof.before, proof.after);
            assert!(proof.gain > 0.3 && proof.gain_interval.expect("five folds").0 > 0.0, "{proof:?}");
        }
    }
    assert!(named >= 47, "{named} of 50");
    assert!(covered * 100 >= 88 * named, "{covered} of {named} intervals cover");
}

#[test]
fn twins_are_named_as_such() {
    let model = model();
    let mut alone = 0;
    for seed in 0..40 {
        let found = diagnose(&model, &evidence(seed, |x| 8.0 * x));
        let names = effects(&found);
        alone += usize::from(names.len() == 1);
        let rivals: Vec<&str> = found.findings[0].rivals.iter().map(|rival| rival.effect.name).collect();
        let (name, rival) = if names[0] == "slope" { ("slope", "twin") } else { ("twin", "slope") };
        assert_eq!(names[0], name);
        assert!(rivals.contains(&rival), "seed {seed}: {rivals:?}");
    }
    assert!(alone >= 38, "{alone} of 40");
}

#[test]
fn a_place_is_found_and_two_effects_are_two() {
    let model = model();
    let mut both = 0;
    for seed in 0..30 {
        let found =
            diagnose(&model, &evidence(seed, |x| 9.0 * x * x - 7.0 * f64::from(u8::from(x > 4.5 / 15.0))));
        let names = effects(&found);
        let place = found.findings.iter().find(|f| f.effect.name == "step");
        let is_there = place.is_some_and(|f| f.location == Location::Named("4".into()));
        both += usize::from(names.len() == 2 && names.contains(&"curvature") && is_there);
    }
    assert!(both >= 24, "{both} of 30");
}

/// Two that nearly undo each other: neither is worth a step, and nothing but the pair leads to
/// them.
#[test]
fn two_effects_that_hide_each_other_are_found_as_a_pair() {
    let mut model = Columns::new(COUNT);
    let wave = |x: f64, k: u32| (f64::from(k) * std::f64::consts::PI * x).cos();
    // among many effects of many places each is unlikely at any of them
    let others = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "o", "p", "q", "r"];
    for (effect, hidden) in
        [("one", 0.02), ("other", -0.02)].into_iter().chain(others.map(|name| (name, 0.0)))
    {
        if hidden != 0.0 {
            model.add(effect, "here", column(|x| 1.0 + hidden * wave(x, 3)), false);
        }
        for k in 5..15 {
            model.add(effect, &format!("{k}"), column(move |x| wave(x, k) + hidden), false);
        }
    }
    let evidence = evidence(3, |x| 1.5 * wave(x, 3));
    let linear = Linearised::new(&model);
    let search = Search::new(&linear, &evidence, &[]);
    let names = |pairs: Pairs| -> Vec<&str> {
        let (hypothesis, _) = search.best(pairs);
        hypothesis.terms.iter().map(|term| model.candidates[term.candidate].effect.name).collect()
    };
    assert_eq!(names(Pairs::Screened), ["one", "other"]);
    assert_eq!(names(Pairs::LeftOut), [""; 0]);
}

#[test]
fn a_shape_from_outside_the_library_is_not_given_a_name() {
    let model = model();
    let (mut named, mut seen) = (0, 0);
    for seed in 0..40 {
        let found = diagnose(&model, &evidence(seed, |x| 4.0 * (9.0 * x).sin()));
        named += usize::from(!found.findings.is_empty());
        seen += usize::from(found.discrepancy.is_some());
    }
    assert!(named <= 2, "{named} of 40 are named");
    assert!(seen >= 38, "{seen} of 40 are seen");
}

#[test]
fn the_same_recording_gives_the_same_diagnosis() {
    let model = model();
    let said = || format!("{:?}", diagnose(&model, &evidence(7, |x| 5.0 * x * x)));
    assert_eq!(said(), said());
}

/// What the base model is wrong by anyhow, twice as large as the effect and the other way, says
/// nothing against the effect.
#[test]
fn chance_is_that_of_the_effect_beside_a_large_background() {
    let model = model();
    for seed in 0..10 {
        let plain = evidence(seed, |x| 30.0 * x * x - 60.0 * x);
        let found = diagnose(&model, &Evidence { background: column(|x| 60.0 * x), ..plain });
        assert_eq!(effects(&found), ["curvature"], "seed {seed}");
        assert!(found.findings[0].p_value < 1e-3, "seed {seed}: {}", found.findings[0].p_value);
    }
}

/// A number of the file draws what the effect does, and predicts data that it has not seen as well:
/// held-out data are the same without the effect, by chance better or worse. Where the number would
/// be off by eight of its uncertainties it is the effect all the same; where by one, the number.
#[test]
fn an_effect_is_confirmed_where_the_number_in_its_place_cannot_be_so_far_off() {
    let mut model = Columns::new(COUNT);
    model.add("slope", "here", column(|x| 10.0 * x), false);
    let number =
        NominalParameter { name: "E".into(), unit: "GPa", si: 1e9, value: 193e9, standard_uncertainty: 2e9 };
    let found = |seed: u64, times: f64| {
        let nominal_numbers = vec![number.clone()];
        let plain = evidence(seed, |x| 50.0 * times * x);
        diagnose(&model, &Evidence { nominal: column(|x| 50.0 * x), nominal_numbers, ..plain })
    };
    for seed in 0..10 {
        assert_eq!(effects(&found(seed, 8.0)), ["slope"], "seed {seed}");
        assert_eq!(effects(&found(seed, 1.0)), [""; 0], "seed {seed}");
    }
}

/// What fits the data no better than a number three of its uncertainties off is that number: a file
/// may state it twice too well.
#[test]
fn an_effect_that_fits_no_better_than_a_number_in_its_place_is_none() {
    let mut model = Columns::new(COUNT);
    model.add("slope", "here", column(|x| 10.0 * x), false);
    let number =
        NominalParameter { name: "E".into(), unit: "GPa", si: 1e9, value: 193e9, standard_uncertainty: 2e9 };
    for seed in 0..20 {
        let nominal_numbers = vec![number.clone()];
        let plain = evidence(seed, |x| 50.0 * 4.2 * x);
        let found = diagnose(&model, &Evidence { nominal: column(|x| 50.0 * x), nominal_numbers, ..plain });
        assert_eq!(effects(&found), [""; 0], "seed {seed}");
    }
}

/// A slope that the base model has, and a column that is nearly the same: what it explains is what
/// the base model could not.
#[test]
fn nothing_explains_more_than_is_left() {
    let mut model = Columns::new(COUNT);
    model.add("bent", "here", column(|x| 30.0 * x + x * x), false);
    let evidence = evidence(3, |x| 20.0 * (30.0 * x + x * x));
    let evidence = Evidence { nuisance: column(|x| x), ..evidence };
    let diagnosis = diagnose(&model, &evidence);
    assert_eq!(effects(&diagnosis), ["bent"]);
    let finding = &diagnosis.findings[0];
    let before = rms(&diagnosis.before);
    assert!(finding.explains <= before && finding.explains > 0.5 * before, "{} {before}", finding.explains);
    // by itself it draws a hundred times as much
    assert!(rms(&model.response(&[finding.parts[0].term.clone()])) > 20.0 * before);
}

/// A large curve hides an effect that no curve draws, until it is in.
#[test]
fn an_effect_is_named_beside_what_nobody_has_named() {
    let parity = |row: usize| if row.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut model = model();
    model.add("parity", "here", DMatrix::from_fn(COUNT, 1, |row, _| parity(row)), false);
    let wave = |x: f64| (3.0 * std::f64::consts::PI * x).cos();
    let mut with = evidence(5, |x| 12.0 * wave(x));
    let alone = with.clone();
    (0..COUNT).for_each(|row| with.residual[row] += 7.0 * parity(row));
    let (both, curve) = (diagnose(&model, &with), diagnose(&model, &alone));
    assert_eq!((effects(&both), effects(&curve)), (vec!["parity"], vec![]));
    assert!(both.discrepancy.is_some() && curve.discrepancy.is_some());
}

/// Noise of more than twice the stated size is no shape.
#[test]
fn a_name_that_hides_something_unknown_is_given_up() {
    let wave = |x: f64| (3.0 * std::f64::consts::TAU * x).sin();
    let kink = |x: f64| 4.0 * (x - 0.5).max(0.0);
    let mut model = Columns::new(COUNT);
    model.add("wave", "here", column(wave), false);
    model.add("curvature", "here", column(|x| x * x), false);
    model.add("kink", "x", column(kink), true);
    let linear = Linearised::new(&model);
    // the curvature explains most, the wave is seen beside it, and both leave something
    let is_right = |&seed: &u64| {
        let evidence = evidence(seed, |x| 4.0 * wave(x) + 6.5 * kink(x));
        let (hypothesis, left) = Search::new(&linear, &evidence, &[]).best(Pairs::LeftOut);
        let names: Vec<&str> =
            hypothesis.terms.iter().map(|t| model.candidates[t.candidate].effect.name).collect();
        names == ["wave"] && matches!(left, Some(DiscrepancyModel::Curve(_)))
    };
    let right = (0..20).filter(is_right).count();
    assert!(right >= 19, "{right} of 20");
}

/// A law that is not quite the right one has its name, where a curve that is would be as likely.
#[test]
fn a_law_that_is_nearly_right_is_named_and_not_the_curve_that_is() {
    let mut model = Columns::new(COUNT);
    let right = |x: f64| x * x + 0.005 * (9.0 * x).sin();
    model.add("law", "", column(|x| x * x), false);
    model.add("curve", "x", column(right), true);
    let is_named = |&seed: &u64| effects(&diagnose(&model, &evidence(seed, |x| 60.0 * right(x)))) == ["law"];
    let named = (0..20).filter(is_named).count();
    assert!(named >= 19, "{named} of 20");
}

#[test]
fn a_law_that_leaves_a_curve_needs_its_odds_against_curves_alone() {
    let mut model = Columns::new(COUNT);
    // the law draws one of two shapes of what nobody has named, and no better than a curve does
    model.add("law", "", column(|x| x), false);
    model.add("curve", "straight", column(|x| x), true);
    model.add("curve", "bent", column(|x| (7.0 * x).sin()), true);
    let evidence = evidence(11, |x| 30.0 * x + 12.0 * (7.0 * x).sin());
    let best = |model: &Columns| {
        let linear = Linearised::new(model);
        let (hypothesis, left) = Search::new(&linear, &evidence, &[]).best(Pairs::Screened);
        (hypothesis.terms.len(), left.is_some())
    };
    assert_eq!(best(&model), (0, true));
    // without a curve in its place the law has a name beside the other
    model.candidates[1].is_nonparametric = false;
    model.candidates[1].weight = 1e-9;
    assert_eq!(best(&model), (1, true));
}

#[test]
fn a_stated_noise_that_is_too_small_is_said_and_draws_nothing() {
    let model = model();
    for seed in 0..5 {
        let mut random = Random::seeded(seed, 7);
        let noise: Vec<f64> = (0..COUNT).map(|_| random.normal()).collect();
        let stated = |sd: f64| Evidence { stated_noise: Some(sd), ..independent(noise.clone()) };
        let diagnosis = diagnose(&model, &stated(0.4));
        let left = diagnosis.discrepancy.as_ref().map(|left| left.shown_by);
        assert_eq!((effects(&diagnosis), left), (vec![], Some(ShownBy::StatedNoise)), "seed {seed}");
        assert_eq!(diagnosis.noise_test.stated, Some(0.4));
        assert!(diagnose(&model, &stated(1.0)).discrepancy.is_none(), "seed {seed}");
    }
}

/// What only a number far from that of its file explains is said; within what the file says of it,
/// or somewhat more, it is an agreement.
#[test]
fn numbers_far_from_those_of_the_file_are_no_agreement() {
    let mut model = Columns::new(COUNT);
    model.add("dent", "here", column(|x| (x - 0.5).powi(2)), false);
    let (name, value, standard_uncertainty) = ("E of steel".into(), 1.0, 0.05);
    let number = NominalParameter { name, unit: "%", si: 0.01, value, standard_uncertainty };
    for (off, is_far) in [(1.0, false), (3.0, false), (8.0, true)] {
        let evidence = Evidence {
            nominal: column(|x| 10.0 * x),
            nominal_numbers: vec![number.clone()],
            ..evidence(3, |x| off * 10.0 * x)
        };
        let found = diagnose(&model, &evidence);
        let left = found.discrepancy.as_ref().map(|left| left.shown_by);
        assert_eq!((effects(&found), left), (vec![], is_far.then_some(ShownBy::Numbers)), "{off}");
        assert!((found.nominal[0].moved() - off).abs() < 0.5, "{}", found.nominal[0].moved());
    }
}

/// The noise that is stated draws σ to it, and νσ² is half of what is left: two effects that
/// explain more than that would be as good as the two that explain all.
#[test]
fn no_pair_explains_more_than_there_is() {
    let wave = |k: usize| move |x: f64| (std::f64::consts::PI * k as f64 * x).cos();
    let mut model = Columns::new(COUNT);
    model.add("main", "here", column(wave(1)), false);
    model.add("beside", "here", column(wave(2)), false);
    for (k, name) in (3..).zip(["a", "b", "c", "d", "e", "f"]) {
        // half as like what is left beside the main one
        model.add(name, "there", column(move |x| 0.1 * wave(2)(x) + 0.17 * wave(k)(x)), false);
    }
    let mut random = Random::seeded(3, 0);
    let recorded = |row: usize| 8.0 * wave(1)(x(row)) + 8.0 * wave(2)(x(row)) + 0.2 * random.normal();
    let mut evidence = independent((0..COUNT).map(recorded).collect());
    evidence.stated_noise = Some(0.2);
    let linear = Linearised::new(&model);
    let search = Search::new(&linear, &evidence, &[]);
    let none = search.fit(&[]);
    let (first, second) = search.pairs(&none, &search.additions(&none))[0];
    assert_eq!((first.min(second), first.max(second)), (0, 1));
}
