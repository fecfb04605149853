//! Which effect, how large, where. Sizes are log-uniform over the range in which a rig may meet them; of two effects in one
//! case over the upper half of it, for two that are too faint to be seen tell nothing about telling two apart:
//!
//! | effect | size | from | to |
//! |---|---|---|---|
//! | `stiffness_scale` | departure of the factor from 1, three of four softer | 0.5 % | 40 % |
//! | `shear_modulus` | the same | 2 % | 60 % |
//! | `joint_compliance`, `root_compliance` | of the rod's own ∫ds/EI; torsion 0.3 to 3 times that share of ∫ds/GJ, or none | 0.5 % | 100 % |
//! | `bend_flexibility` | of what the series for an oval section gives | 0.3 | 2 |
//! | `friction`, `load_offset` | force, N; friction at most 0.7 of the smallest load | 0.02 | 2 |
//! | `backlash` | play, µm | 1 | 100 |
//! | `creep` | per decade | 0.2 % | 10 % |
//! | `hysteresis` | loop width at half load | 0.2 % | 10 % |
//! | `nonlinear_stiffness` | share at the largest load, either sign | 0.2 % | 20 % |
//! | `sensor_scale` | departure of the factor from 1 | 0.2 % | 20 % |
//! | `sensor_misalignment`, `load_misalignment` | degrees | 0.1 | 10 |
//! | `thermal_drift` | µm/K, or µm/h without a thermometer | 0.5 | 50 |
//! | `slip` | µm | 2 | 500 |
//! | `outlier` | standard deviations of one or two readings | 5 | 50 |
//! | a gap that closes | stiffening beyond it | 2 % | 70 % |
//! | sensor ripple | amplitude µm; period 20 to 200 µm | 1 | 20 |
//! | Hertzian seat | µm at the largest load | 2 | 100 |
//! | running in | share of the first displacement; over 3 to 30 loadings | 0.5 % | 20 % |
//! | sensor saturation | of the channel's largest reading that is missing | 2 % | 50 % |
//! | clamp loose one way | more displacement one way | 2 % | 50 % |

use super::bench::Bench;
use super::effect::Effect;
use super::setup::Needs;
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, UM};

/// Effects that a library may have, by number for [`library`].
pub const LIBRARY: usize = 17;
/// Effects that none has, by number for [`beyond`].
pub const BEYOND: usize = 6;

/// What a protocol must have to carry the effect of the library of this number.
pub fn needs(effect: usize) -> Needs {
    let mut needs = Needs::default();
    match effect {
        4 => needs.arc = true,
        8 => needs.time = true,
        9 => needs.unloading = true,
        12 => needs.two_channels = true,
        14 => needs.clock = true,
        7 => needs.tip = true,
        15 => needs.long_runs = true,
        _ => {}
    }
    needs
}

/// The same for what is beyond the library.
pub fn needs_beyond(effect: usize) -> Needs {
    Needs { both_signs: effect == 5, tip: effect == 2, ..Needs::default() }
}

/// Log-uniform.
pub fn log_uniform(random: &mut Random, low: f64, high: f64) -> f64 {
    random.uniform(low.ln(), high.ln()).exp()
}

pub(crate) fn happens(random: &mut Random, probability: f64) -> bool {
    random.uniform(0.0, 1.0) < probability
}

pub(super) fn one_of<T: Copy>(random: &mut Random, of: &[T], otherwise: T) -> T {
    of.get(random.index(of.len())).copied().unwrap_or(otherwise)
}

/// An effect of the library at a bench that can carry it. `sd` is the noise, m; of its range in the table the part above
/// the share `faintest` (on the logarithm) is drawn from.
pub fn library(effect: usize, bench: &Bench, sd: f64, faintest: f64, random: &mut Random) -> Effect {
    let log_uniform = |random: &mut Random, low: f64, high: f64| {
        log_uniform(random, low * (high / low).powf(faintest), high)
    };
    let protocol = &bench.protocol;
    let (axes, channels, largest) = (protocol.axes(), protocol.read_channels(), protocol.largest_load());
    let sign = |random: &mut Random, negative: f64| if happens(random, negative) { -1.0 } else { 1.0 };
    match effect {
        0 => Effect::StiffnessScale(1.0 + sign(random, 0.75) * log_uniform(random, 0.005, 0.4)),
        1 => Effect::ShearModulus(1.0 + sign(random, 0.75) * log_uniform(random, 0.02, 0.6)),
        2 => {
            let (name, station) = place(bench, random);
            let share = log_uniform(random, 0.005, 1.0);
            let [bending, torsion] = compliance(bench, share, random);
            Effect::Joint { name, station, bending, torsion }
        }
        3 => {
            let share = log_uniform(random, 0.005, 1.0);
            let [bending, torsion] = compliance(bench, share, random);
            Effect::Root { bending, torsion }
        }
        4 => {
            let oval = bench.drawing.tubes[0].ovalisation(bench.drawing.bend_radius);
            Effect::Bend(1.0 + (oval - 1.0) * log_uniform(random, 0.3, 2.0))
        }
        5 => {
            let force = log_uniform(random, 0.02, 2.0).min(0.7 * protocol.smallest_load());
            let axis = some_axis(&axes, random);
            let presliding = self::log_uniform(random, 0.5, 20.0) * UM;
            Effect::Friction { axis, force, presliding, scatter: random.uniform(0.0, 0.15) }
        }
        6 => {
            let force = sign(random, 0.5) * log_uniform(random, 0.02, 2.0);
            let force = force.max(-0.7 * protocol.smallest_load());
            Effect::LoadOffset { axis: some_axis(&axes, random), force }
        }
        7 => {
            let play = log_uniform(random, 1.0, 100.0) * UM;
            Effect::Backlash { axis: some_axis(&axes, random), play }
        }
        8 => {
            let shortest = self::log_uniform(random, 1.0, 60.0);
            Effect::Creep { per_decade: log_uniform(random, 0.002, 0.1), shortest }
        }
        9 => {
            let fraction = log_uniform(random, 0.002, 0.1);
            Effect::Hysteresis { fraction, is_exercised: happens(random, 0.5) }
        }
        10 => {
            let share = sign(random, 0.5) * log_uniform(random, 0.002, 0.2);
            match happens(random, 0.5) {
                true => Effect::Cubic(share / (largest * largest)),
                false => Effect::Quadratic(share / largest),
            }
        }
        11 => {
            let factor = 1.0 + sign(random, 0.5) * log_uniform(random, 0.002, 0.2);
            Effect::SensorScale { channel: one_of(random, &channels, 0), factor }
        }
        12 => {
            let channel = one_of(random, &channels, 0);
            let towards = another(channel, random);
            Effect::SensorMisalignment { channel, towards, angle: angle(random, faintest) }
        }
        13 => {
            let axis = one_of(random, &axes, 0);
            let others: Vec<usize> = axes.iter().copied().filter(|other| *other != axis).collect();
            let frame = !others.is_empty() && happens(random, 0.3);
            let towards = if frame { one_of(random, &others, 0) } else { another(axis, random) };
            let (axis, towards) =
                if frame { (axis.min(towards), axis.max(towards)) } else { (axis, towards) };
            Effect::LoadMisalignment { axis, towards, angle: angle(random, faintest), frame }
        }
        14 => {
            let by_time = !protocol.columns.temperature;
            let rate = sign(random, 0.3) * log_uniform(random, 0.5, 50.0) * UM;
            let rate = if by_time { rate / 3600.0 } else { rate };
            Effect::Drift { channel: one_of(random, &channels, 0), rate, by_time }
        }
        15 => {
            let inner: Vec<usize> = (2..protocol.loadings.len())
                .filter(|&k| {
                    let run = |k: usize| protocol.loadings.get(k).map(|l| l.run);
                    run(k) == run(k - 2) && run(k) == run(k + 1)
                })
                .collect();
            let loading = one_of(random, &inner, 1);
            let channel = protocol.loadings.get(loading).map_or(0, |l| l.axis);
            Effect::Slip { loading, channel, by: sign(random, 0.5) * log_uniform(random, 2.0, 500.0) * UM }
        }
        _ => {
            let cells = protocol.cells().len();
            let count = if happens(random, 0.7) { 1 } else { 2 };
            let first = random.index(cells);
            let second = (first + 1 + random.index(cells.saturating_sub(1))) % cells.max(1);
            let mut size = || sign(random, 0.5) * log_uniform(random, 5.0, 50.0) * sd;
            let of = [(first, size()), (second, size())];
            Effect::Outlier(of[..count].to_vec())
        }
    }
}

/// Physics that no library has.
pub fn beyond(effect: usize, bench: &Bench, random: &mut Random) -> Effect {
    let protocol = &bench.protocol;
    let largest = protocol.largest_load();
    match effect {
        0 => {
            let load = random.uniform(0.3, 0.7) * largest;
            Effect::GapCloses { load, share: 1.0 - log_uniform(random, 0.02, 0.7) }
        }
        1 => Effect::Ripple {
            channel: one_of(random, &protocol.axes(), 0),
            amplitude: log_uniform(random, 1.0, 20.0) * UM,
            period: log_uniform(random, 20.0, 200.0) * UM,
            phase: random.uniform(0.0, std::f64::consts::TAU),
        },
        2 => Effect::Seat(log_uniform(random, 2.0, 100.0) * UM),
        3 => {
            let share = log_uniform(random, 0.005, 0.2);
            Effect::RunningIn { share, loadings: log_uniform(random, 3.0, 30.0) }
        }
        4 => {
            let channel = one_of(random, &protocol.axes(), 0);
            let readings = bench.readings(&[]);
            let of = protocol.cells().into_iter().zip(readings).filter(|(cell, _)| cell.channel == channel);
            let most = of.fold(0.0, |most: f64, (_, reading)| most.max(reading.abs()));
            Effect::Saturation { channel, limit: most * (1.0 - log_uniform(random, 0.02, 0.5)) }
        }
        _ => Effect::LooseClamp(log_uniform(random, 0.02, 0.5)),
    }
}

/// Every effect of the library that has a meaning at a bench, wherever it may sit, at `share` of the upper end of its range;
/// those with two numbers in two parts. Joints along the rod, slips and outliers are the oracle's own business.
pub(super) fn all(bench: &Bench, share: f64) -> Vec<Vec<Effect>> {
    let protocol = &bench.protocol;
    let (axes, channels, largest) = (protocol.axes(), protocol.read_channels(), protocol.largest_load());
    let [bending, torsion] = bench.drawing.rotation().map(|rotation| share * rotation);
    let mut all = vec![
        vec![Effect::StiffnessScale(1.0 - 0.4 * share)],
        vec![Effect::ShearModulus(1.0 - 0.6 * share)],
        vec![Effect::Root { bending, torsion: 0.0 }, Effect::Root { bending: 0.0, torsion }],
        vec![Effect::Cubic(0.2 * share / (largest * largest))],
        vec![Effect::Quadratic(0.2 * share / largest)],
    ];
    if bench.drawing.arc() > 0.0 {
        let oval = bench.drawing.tubes[0].ovalisation(bench.drawing.bend_radius);
        all.push(vec![Effect::Bend(bench.drawing.bend_factor + 2.0 * share * (oval - 1.0))]);
    }
    let of_axes = axes.iter().copied().map(Some).filter(|_| axes.len() > 1);
    for axis in [None].into_iter().chain(of_axes) {
        let force = share * 2f64.min(0.7 * protocol.smallest_load());
        all.push(vec![Effect::Friction { axis, force, presliding: UM, scatter: 0.0 }]);
        all.push(vec![Effect::LoadOffset { axis, force: 2.0 * share }]);
        all.push(vec![Effect::Backlash { axis, play: 100.0 * share * UM }]);
    }
    if protocol.columns.time {
        all.extend([1.0, 60.0].map(|shortest| vec![Effect::Creep { per_decade: 0.1 * share, shortest }]));
    }
    if protocol.loadings.iter().any(|l| l.is_unloading) {
        all.extend(
            [true, false]
                .map(|is_exercised| vec![Effect::Hysteresis { fraction: 0.1 * share, is_exercised }]),
        );
    }
    for &channel in &channels {
        all.push(vec![Effect::SensorScale { channel, factor: 1.0 + 0.2 * share }]);
        let turned =
            |towards| vec![Effect::SensorMisalignment { channel, towards, angle: 10.0 * share * DEG }];
        all.extend((0..3).filter(|towards| *towards != channel).map(turned));
        if protocol.columns.temperature {
            all.push(vec![Effect::Drift { channel, rate: 50.0 * share * UM, by_time: false }]);
        } else if protocol.columns.time {
            all.push(vec![Effect::Drift { channel, rate: 50.0 * share * UM / 3600.0, by_time: true }]);
        }
    }
    for &axis in &axes {
        for towards in (0..3).filter(|towards| *towards != axis) {
            let angle = 10.0 * share * DEG;
            all.push(vec![Effect::LoadMisalignment { axis, towards, angle, frame: false }]);
            if axis < towards && axes.contains(&towards) {
                all.push(vec![Effect::LoadMisalignment { axis, towards, angle, frame: true }]);
            }
        }
    }
    all
}

/// A declared joint as often as not where there is one, else anywhere.
fn place(bench: &Bench, random: &mut Random) -> (Option<String>, f64) {
    let joints = &bench.drawing.joints;
    let declared = joints.get(random.index(joints.len())).filter(|_| happens(random, 0.7));
    match declared {
        Some((name, station)) => (Some(name.clone()), *station),
        None => (None, random.uniform(0.1, 0.9) * bench.drawing.length()),
    }
}

fn compliance(bench: &Bench, share: f64, random: &mut Random) -> [f64; 2] {
    let [bending, torsion] = bench.drawing.rotation();
    let twist = if happens(random, 0.25) { 0.0 } else { log_uniform(random, 0.3, 3.0) };
    [share * bending, share * twist * torsion]
}

fn some_axis(axes: &[usize], random: &mut Random) -> Option<usize> {
    (axes.len() > 1 && happens(random, 0.4)).then(|| one_of(random, axes, 0))
}

fn another(axis: usize, random: &mut Random) -> usize {
    (axis + 1 + random.index(2)) % 3
}

fn angle(random: &mut Random, faintest: f64) -> f64 {
    let angle = log_uniform(random, 0.1 * 100f64.powf(faintest), 10.0) * DEG;
    if happens(random, 0.5) { -angle } else { angle }
}
