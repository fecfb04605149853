//! Trials at a stiffness rig: rods, protocols and what may be wrong with them.
//!
//! A quarter of the cases is clean, 45 % hold one effect of the library, 15 % two of them, 15 % one that no library has.

mod again;
mod asked;
mod bench;
pub(crate) mod cosserat;
pub(crate) mod draw;
pub(crate) mod drawing;
mod effect;
mod made;
mod memory;
mod noise;
mod oracle;
mod protocol;
mod setup;
mod sizes;
pub(crate) mod tube;

pub use self::again::{Again, Proposed, again};
use self::bench::Bench;
pub use self::effect::Effect;
pub use self::made::{Made, Order};
use self::noise::{Noise, Shape};
use self::oracle::Oracle;
pub use self::protocol::Columns;
use super::Case;
use crate::truth::{Concealed, Kind, Parameter, Truth};
use rodcal_base::statistics::Random;
use rodcal_base::units::{MM, UM};

/// Load, relative to the nominal one, at which a rod is linear.
const SMALL: f64 = 1e-3;

/// Streams of random numbers for what came later than the cases: what is asked for, and what is measured once more. Those
/// of the cases are their numbers, of a rig's and of a calibration's.
const ASKED: u64 = 2 << 32;
const AGAIN: u64 = 3 << 32;

/// A case as it was drawn.
struct Drawn {
    kind: Kind,
    bench: Bench,
    noise: Noise,
    effects: Vec<Effect>,
    /// Without noise, m.
    readings: Vec<f64>,
    /// What the display showed, m.
    shown: Vec<f64>,
}

/// Case number `number` of the trial that belongs to `seed`.
pub fn case(seed: u64, number: usize) -> Case {
    let drawn = drawn(seed, number);
    let asked = asked::draw(&drawn.bench, &mut Random::seeded(seed, ASKED + number as u64));
    let name = format!("case-{number:04}");
    Case {
        files: vec![
            ("rod.toml".into(), drawn.bench.drawing.toml(&name)),
            ("readings.csv".into(), drawn.bench.protocol.csv(&drawn.shown)),
            ("asked.csv".into(), asked::csv(&asked)),
        ],
        truth: Truth { seed: Some(seed), ..truth(format!("rig/{name}"), &drawn, &asked) },
    }
}

fn drawn(seed: u64, number: usize) -> Drawn {
    let mut random = Random::seeded(seed, number as u64);
    let kind = Kind::drawn(&mut random);
    let numbers: Vec<usize> = match kind {
        Kind::Clean => Vec::new(),
        Kind::Single => vec![random.index(draw::LIBRARY)],
        Kind::Pair => {
            let first = random.index(draw::LIBRARY);
            vec![first, (first + 1 + random.index(draw::LIBRARY - 1)) % draw::LIBRARY]
        }
        Kind::Unknown => vec![random.index(draw::BEYOND)],
    };
    let needs_of = |number: &usize| match kind {
        Kind::Unknown => draw::needs_beyond(*number),
        _ => draw::needs(*number),
    };
    let needs = numbers.iter().map(needs_of).fold(setup::Needs::default(), setup::Needs::and);
    let (bench, noise) = setup::draw(needs, &mut random);
    let sd = noise.variance(bench.protocol.quantum).sqrt();
    let faintest = if kind == Kind::Pair { 0.5 } else { 0.0 };
    let effects: Vec<Effect> = numbers
        .iter()
        .map(|&number| match kind {
            Kind::Unknown => draw::beyond(number, &bench, &mut random),
            _ => draw::library(number, &bench, sd, faintest, &mut random),
        })
        .collect();
    let readings = bench.readings(&effects);
    let shown = noise.shown(&bench, &readings, &mut random);
    Drawn { kind, bench, noise, effects, readings, shown }
}

fn truth(case: String, drawn: &Drawn, asked: &Bench) -> Truth {
    let Drawn { kind, bench, noise, effects, readings, shown } = drawn;
    let protocol = &bench.protocol;
    let variance = noise.variance(protocol.quantum);
    let clean = bench.readings(&[]);
    let added = mean_square(readings, &clean);
    let oracle = (!effects.is_empty()).then(|| Oracle::new(bench, noise));
    let mut concealed: Vec<Concealed> = effects
        .iter()
        .enumerate()
        .filter_map(|(which, effect)| {
            let run = |loading: usize| oracle::run_name(bench, loading);
            let alone = bench.readings(std::slice::from_ref(effect));
            let parameter = |(name, value): (&str, f64)| Parameter { name: name.into(), value };
            Some(Concealed {
                effect: effect.name().into(),
                location: effect.location(run, |index| oracle::cell_name(bench, index)),
                parameters: effect.parameters().into_iter().map(parameter).collect(),
                size_over_noise: (mean_square(&alone, &clean) / variance).sqrt(),
                detectability: oracle.as_ref()?.detectability(effects, which),
            })
        })
        .collect();
    concealed.sort_by(|a, b| b.size_over_noise.total_cmp(&a.size_over_noise));
    // each reading has its own error and that of its zero
    let held_out = 2.0 * variance;
    Truth {
        case,
        kind: *kind,
        effects: concealed,
        noise_um: variance.sqrt() / UM,
        noise_shape: match noise.shape {
            Shape::Normal => "normal".into(),
            Shape::StudentT(dof) => format!("student-t ({dof})"),
            Shape::Contaminated => "contaminated".into(),
        },
        quantum_um: protocol.quantum / UM,
        readings: readings.len(),
        protocol: description(bench),
        joints: bench.drawing.joints.iter().map(|(name, station)| (name.clone(), station / MM)).collect(),
        geometric_um: geometric(bench, &clean) / UM,
        oracle_gain: (!effects.is_empty() && !effects.iter().any(is_of_one_run))
            .then(|| added / (added + held_out)),
        seed: None,
        asked: Some(asked::truth(asked, effects, oracle.as_ref(), shown)),
    }
}

/// What no other run tells of: it cannot be predicted.
fn is_of_one_run(effect: &Effect) -> bool {
    matches!(effect, Effect::Slip { .. } | Effect::Outlier(_))
}

/// Root mean square of what the clean rod departs from a linear one, m.
fn geometric(bench: &Bench, clean: &[f64]) -> f64 {
    let mut small = bench.clone();
    small.protocol.loadings.iter_mut().for_each(|loading| loading.load *= SMALL);
    let linear: Vec<f64> = small.readings(&[]).iter().map(|reading| reading / SMALL).collect();
    mean_square(clean, &linear).sqrt()
}

fn mean_square(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len().max(1) as f64
}

fn description(bench: &Bench) -> String {
    let protocol = &bench.protocol;
    let trials = protocol.loadings.iter().map(|l| l.trial + 1).max().unwrap_or(0);
    let axes: Vec<&str> = protocol.axes().into_iter().map(|axis| protocol::AXES[axis]).collect();
    let ways = if protocol.loadings.iter().any(|l| l.is_unloading) { "up and down" } else { "up" };
    format!("{trials} trials {ways} to {:.1} N along {}", protocol.largest_load(), axes.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_and_a_number_make_the_same_case() {
        let (a, b) = (case(7, 3), case(7, 3));
        assert_eq!(a, b);
        assert!(a.files != case(7, 4).files && a.files != case(8, 3).files);
    }

    #[test]
    fn files_say_that_they_are_simulated_and_nothing_of_the_effect() {
        for number in 0..40 {
            let case = case(1, number);
            let [rod, readings, asked] = [0, 1, 2].map(|k| &case.files[k].1);
            assert!([rod, readings, asked].iter().all(|text| text.starts_with("# SIMULATED")));
            for concealed in &case.truth.effects {
                assert!(!readings.contains(&concealed.effect), "{}", case.truth.case);
            }
            let is_stiff = |line: &str| !line.contains("urad_per_nm") || line.ends_with(" = 0.0");
            assert!(rod.lines().all(is_stiff));
            assert!(case.truth.geometric_um < 20.0, "{:?}", case.truth);
            let is_clean = case.truth.kind == Kind::Clean;
            assert_eq!(is_clean, case.truth.effects.is_empty());
        }
    }
}
