//! Trials at a stiffness rig: rods, protocols and what may be wrong with them.
//!
//! The numbers of every rod file are off by what it states, or by twice that; noise, zeros and
//! display differ from case to case. What else there is: nothing (20 % of the cases), one effect of
//! the library (34 %), two of them (12 %), physics that no library has (13 %), a mistake in the
//! files (15 %), or single readings that were misread (6 %). Friction accompanies some of the
//! effects.

pub(crate) mod actual;
mod bench;
mod beyond;
pub(crate) mod cosserat;
mod covariance;
mod direction;
pub(crate) mod draw;
pub(crate) mod drawing;
mod effect;
mod follow_up;
mod load_history;
mod mistake;
pub(crate) mod noise;
mod oracle;
mod part;
mod prediction_query;
mod protocol;
pub mod residuals;
mod setup;
mod simulated_case;
mod sizes;
pub(crate) mod tube;
mod uncertainty;
mod written;

use self::bench::Bench;
use self::effect::Dimension;
pub use self::effect::Effect;
pub use self::follow_up::{FollowUp, Proposed, follow_up};
use self::mistake::Mistake;
use self::noise::Noise;
use self::oracle::Oracle;
pub use self::protocol::Columns;
pub use self::simulated_case::{CaseSpec, SimulatedCase};
use self::written::Written;
use super::Case;
use crate::Seed;
use crate::chance::{happens, log_uniform};
use crate::ground_truth::{Concealed, GroundTruth, Kind, Parameter};
use rodcal_base::statistics::Random;
use rodcal_base::units::{MM, UM};

/// Load, relative to the nominal one, at which a rod is linear.
const SMALL: f64 = 1e-3;

/// Streams of random numbers for what came later than the cases: what is asked for, and what is
/// measured once more. Those of the cases are their numbers, of a rig's and of a calibration's.
const QUERY: u64 = 2 << 32;
const FOLLOW_UP: u64 = 3 << 32;

/// Shares of clean, single, paired, unknown and mistaken cases; in the rest readings are misread.
const SHARES: [(Kind, f64); 5] = [
    (Kind::Clean, 0.2),
    (Kind::Single, 0.34),
    (Kind::Pair, 0.12),
    (Kind::Unknown, 0.13),
    (Kind::Mistake, 0.15),
];
/// How often friction accompanies an effect, and its force as a share of the largest load.
const COMPANION: (f64, [f64; 2]) = (0.2, [0.01, 0.05]);
/// How often a single effect is below its detection limit, and how far at most.
const BELOW: (f64, f64) = (0.3, 0.1);
/// Multiples of its detection limit from which an effect of a pair is drawn, and unknown physics.
const FAINTEST: [f64; 2] = [3.0, 2.0];
/// How often a single effect is recorded with care.
const CAREFUL: f64 = 0.75;
/// Noises by which a reading is misread.
const MISREAD: [f64; 2] = [10.0, 60.0];
/// How often files of other rods stand beside that of a case.
const BESIDE: f64 = 0.25;

/// A case as it was drawn.
struct Drawn {
    kind: Kind,
    bench: Bench,
    noise: Noise,
    /// How many times as far off as stated the numbers of the files are.
    times: f64,
    /// What is sought, then friction that accompanies it.
    effects: Vec<Effect>,
    /// How many of them are only companions.
    companions: usize,
    mistake: Option<Mistake>,
    oracle: Oracle,
    /// Without noise, m.
    readings: Vec<f64>,
    /// As it should have been written down.
    right: Written,
}

impl Drawn {
    fn written(&self) -> Written {
        self.mistake.as_ref().map_or_else(|| self.right.clone(), |mistake| mistake.applied_to(&self.right))
    }
}

/// Case number `number` of the trial that belongs to `seed`, with noise from `residuals` where
/// there are any.
pub fn case(seed: Seed, number: usize, residuals: &[f64]) -> Case {
    let drawn = drawn(seed, number, residuals);
    let query = prediction_query::draw(&drawn.bench, &mut Random::of_seed(seed.0, QUERY + number as u64));
    let name = format!("case-{number:04}");
    let written = drawn.written();
    let mut files = vec![
        ("rod.toml".into(), written.drawing.toml(&name)),
        ("readings.csv".into(), written.protocol.csv(&written.shown)),
        ("asked.csv".into(), prediction_query::csv(&query)),
    ];
    let beside = |(k, (file, drawing)): (usize, &(String, drawing::Drawing))| {
        (file.clone(), drawing.toml(&format!("{name}, rod {}", k + 2)))
    };
    files.extend(written.others.iter().enumerate().map(beside));
    let truth = ground_truth(format!("rig/{name}"), drawn, &query);
    Case { files, truth: GroundTruth { seed: Some(seed), residuals: residuals.to_vec(), ..truth } }
}

fn drawn(seed: Seed, number: usize, residuals: &[f64]) -> Drawn {
    let mut random = Random::of_seed(seed.0, number as u64);
    let random = &mut random;
    let kind = kind(random);
    let library = |random: &mut Random| random.index(draw::LIBRARY);
    let (numbers, mut needs): (Vec<usize>, setup::Needs) = match kind {
        Kind::Clean | Kind::Suspect => (Vec::new(), setup::Needs::default()),
        Kind::Single => {
            let number = library(random);
            let needs = if happens(random, CAREFUL) { draw::careful } else { draw::needs };
            (vec![number], needs(number, random))
        }
        Kind::Pair => {
            let first = library(random);
            let second = (first + 1 + random.index(draw::LIBRARY - 1)) % draw::LIBRARY;
            (vec![first, second], draw::careful(first, random).and(draw::careful(second, random)))
        }
        Kind::Unknown => {
            let number = random.index(beyond::BEYOND);
            (vec![number], beyond::needs(number))
        }
        Kind::Mistake => {
            let number = random.index(part::MISTAKES);
            (vec![number], part::needs(number))
        }
    };
    // friction and what looks like it are sought by themselves
    let has_companion = match kind {
        Kind::Single => !(5..=7).contains(&numbers[0]) && numbers[0] != 9,
        Kind::Unknown => !needs.shuffled,
        _ => false,
    } && happens(random, COMPANION.0);
    needs.unloading |= has_companion;
    let (bench, noise, times) = setup::draw(needs, residuals, random);
    let oracle = Oracle::new(&bench, &noise);
    let mut effects: Vec<Effect> = match kind {
        Kind::Clean | Kind::Mistake => Vec::new(),
        Kind::Suspect => misread(&bench, &noise, random),
        Kind::Single | Kind::Pair | Kind::Unknown => {
            let of_number = |&number: &usize| {
                let largest = match kind {
                    Kind::Unknown => beyond::draw(number, &bench, random),
                    _ => draw::library(number, &bench, random),
                };
                let limit = oracle.limit(&largest).clamp(1e-4, 1.0);
                let (least, most) = match kind {
                    Kind::Single if happens(random, BELOW.0) => (BELOW.1 * limit, limit),
                    Kind::Single => (limit, 1.0),
                    Kind::Pair => ((FAINTEST[0] * limit).min(0.5), 1.0),
                    _ => ((FAINTEST[1] * limit).min(0.5), 1.0),
                };
                largest.scaled(log_uniform(random, least, most))
            };
            numbers.iter().map(of_number).collect()
        }
    };
    if has_companion {
        let share = random.uniform(COMPANION.1[0], COMPANION.1[1]);
        let force = (share * bench.full_scale).min(0.5 * bench.protocol.smallest_load());
        effects.push(draw::friction(None, force, random));
    }
    let readings = bench.readings(&effects);
    let shown = noise.shown(&bench, &readings, random);
    let (drawing, protocol) = (bench.drawing.clone(), bench.protocol.clone());
    let mut right = Written { drawing, others: Vec::new(), protocol, shown };
    if happens(random, BESIDE) || kind == Kind::Mistake {
        right.others = ["rod-2.toml", "rod-3.toml"]
            .map(|file| (file.to_owned(), setup::drawing(setup::Needs::default(), random)))
            .to_vec();
    }
    let other = |random: &mut Random| setup::drawing(setup::Needs::default(), random);
    let mistake = (kind == Kind::Mistake).then(|| part::draw(numbers[0], &right, other, random));
    let companions = usize::from(has_companion);
    Drawn { kind, bench, noise, times, effects, companions, mistake, oracle, readings, right }
}

fn kind(random: &mut Random) -> Kind {
    let mut drawn = random.uniform(0.0, 1.0);
    for (kind, share) in SHARES {
        if drawn < share {
            return kind;
        }
        drawn -= share;
    }
    Kind::Suspect
}

/// One to three readings of different rows that are far off.
fn misread(bench: &Bench, noise: &Noise, random: &mut Random) -> Vec<Effect> {
    let cells = bench.protocol.cells();
    let sd = |cell: usize| noise.channel_variance(cells[cell].channel, bench.protocol.quantum).sqrt();
    let mut chosen: Vec<usize> = Vec::new();
    for _ in 0..1 + random.index(3) {
        let cell = random.index(cells.len());
        if chosen.iter().all(|&other| cells[other].loading != cells[cell].loading) {
            chosen.push(cell);
        }
    }
    let of_cell = |cell: usize| {
        let sign = if happens(random, 0.5) { -1.0 } else { 1.0 };
        Effect::Outlier(vec![(cell, sign * log_uniform(random, MISREAD[0], MISREAD[1]) * sd(cell))])
    };
    chosen.into_iter().map(of_cell).collect()
}

fn ground_truth(case: String, mut drawn: Drawn, query: &Bench) -> GroundTruth {
    if !drawn.effects.is_empty() {
        drawn.oracle.compare(&drawn.noise);
    }
    let Drawn { kind, bench, noise, effects, oracle, .. } = &drawn;
    let protocol = &bench.protocol;
    let variance = noise.variance(protocol.quantum);
    let clean = bench.readings(&[]);
    let concealed_effect = |(which, effect): (usize, &Effect)| {
        let alone = bench.readings(std::slice::from_ref(effect));
        let mut detectability = oracle.detectability(effects, which);
        if *kind == Kind::Unknown {
            detectability.against_pair = Some(oracle.against_pairs(effects, which));
        }
        let place = effect.place(protocol);
        Concealed {
            effect: effect.name(),
            location: place.to_string(),
            place,
            parameters: parameters(bench, effect, &alone),
            size_over_noise: (mean_square(&alone, &clean) / variance).sqrt(),
            detectability,
        }
    };
    let mut concealed: Vec<Concealed> = effects.iter().enumerate().map(concealed_effect).collect();
    let companions = concealed.split_off(concealed.len() - drawn.companions);
    concealed.sort_by(|a, b| b.size_over_noise.total_cmp(&a.size_over_noise));
    concealed.extend(drawn.mistake.as_ref().map(|mistake| mistaken(&drawn, mistake)));
    let of_channel = |channel: usize| {
        noise.channel_variance(channel, protocol.quantum) + noise.zero_variance(channel, protocol.quantum)
    };
    let cells = protocol.cells();
    let held_out = cells.iter().map(|cell| of_channel(cell.channel)).sum::<f64>() / cells.len().max(1) as f64;
    let has_gain = !effects.is_empty() && !effects.iter().any(Effect::is_of_one_run);
    let left = has_gain.then(|| oracle.mean_square_left(effects));
    GroundTruth {
        case,
        kind: *kind,
        conflict: None,
        effects: concealed,
        companions,
        numbers_off: drawn.times,
        noise_um: variance.sqrt() / UM,
        noise_shape: noise.description(),
        quantum_um: protocol.quantum / UM,
        readings: drawn.readings.len(),
        protocol: description(bench),
        joints: bench.drawing.joints.iter().map(|(name, station)| (name.clone(), station / MM)).collect(),
        geometric_um: geometric(bench, &clean) / UM,
        oracle_gain: left.map(|left| left / (left + held_out)),
        seed: None,
        residuals: Vec::new(),
        query: Some(prediction_query::truth(query, effects, oracle, &drawn.right.shown)),
    }
}

/// The numbers of an effect. A factor of a stiffness may refer to the numbers of the file or to
/// those of the real rod: both are right.
fn parameters(bench: &Bench, effect: &Effect, with: &[f64]) -> Vec<Parameter> {
    let nominal = || Bench { actual: actual::Actual::default(), ..bench.clone() }.readings(&[]);
    let of_all = match effect {
        Effect::StiffnessScale(_) => {
            let nominal = nominal();
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            Some(dot(&nominal, &nominal) / dot(&nominal, with))
        }
        Effect::ShearModulus(factor) => {
            let shear = |drawing: &drawing::Drawing| drawing.tubes[0].shear_modulus;
            Some(factor * shear(&bench.actual.rod(&bench.drawing)) / shear(&bench.drawing))
        }
        Effect::Bend(factor) => {
            let bends = |drawing: &drawing::Drawing| drawing.tubes[0].flexibility(1.0, 1.0).bending;
            Some(factor * bends(&bench.actual.rod(&bench.drawing)) / bends(&bench.drawing))
        }
        Effect::PipeStiffness { pipe, factor } => {
            let bends = |drawing: &drawing::Drawing| drawing.tubes[*pipe].flexibility(1.0, 1.0).bending;
            Some(factor * bends(&bench.drawing) / bends(&bench.actual.rod(&bench.drawing)))
        }
        Effect::Dimension { which: Dimension::Leg(leg), by, .. } => {
            Some((bench.actual.rod(&bench.drawing).legs[*leg] + by) / MM)
        }
        _ => None,
    };
    let of_name = |(name, value): (&str, f64)| Parameter { name: name.into(), value, with_numbers: of_all };
    effect.parameters().into_iter().map(of_name).collect()
}

/// A mistake as it is concealed.
fn mistaken(drawn: &Drawn, mistake: &Mistake) -> Concealed {
    let parameter = |(name, value): (&str, f64)| Parameter { name: name.into(), value, with_numbers: None };
    let parameters = mistake.parameters().into_iter().map(parameter).collect();
    Concealed::mistake(mistake.name(), mistake.place(&drawn.right), parameters)
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
    use crate::effect_name::EffectName;

    #[test]
    fn a_case_is_what_its_kind_says() {
        let mut kinds = std::collections::BTreeSet::new();
        let mut seen = Vec::new();
        for number in 0..24 {
            let case = case(Seed(1), number, &[]);
            let (rod, truth) = (&case.files[0].1, &case.truth);
            let is_stiff = |line: &str| !line.contains("urad_per_nm") || line.ends_with(" = 0.0");
            assert!(rod.lines().all(is_stiff));
            assert!(truth.geometric_um < 20.0, "{truth:?}");
            let expected = match truth.kind {
                Kind::Clean => 0..=0,
                Kind::Single | Kind::Unknown | Kind::Mistake => 1..=1,
                Kind::Pair => 2..=2,
                Kind::Suspect => 1..=3,
            };
            assert!(expected.contains(&truth.effects.len()), "{truth:?}");
            assert!([1.0, 2.0].contains(&truth.numbers_off));
            assert!(truth.companions.iter().all(|companion| companion.effect == EffectName::Friction));
            kinds.insert(format!("{:?}", truth.kind));
            if truth.kind == Kind::Single {
                seen.push(truth.effects[0].detectability.is_detectable());
            }
        }
        assert_eq!(kinds.len(), 6);
        // single effects begin below what can be detected
        assert!(seen.contains(&true) && seen.contains(&false), "{seen:?}");
    }

    #[test]
    fn residuals_of_a_recording_are_its_noise_and_the_key_has_them() {
        let residuals: Vec<f64> = (0..20).map(|k| f64::from(k % 4) - 1.5).collect();
        let with = case(Seed(1), 3, &residuals);
        assert!(with.files != case(Seed(1), 3, &[]).files);
        assert_eq!(with, case(Seed(1), 3, &residuals));
        assert_eq!(with.truth.residuals, residuals);
        assert!(with.truth.noise_shape.starts_with("20 residuals of a recording"));
    }
}
