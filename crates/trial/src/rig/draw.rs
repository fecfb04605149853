//! Which effect of the library, where, and how large at most. How much of that a case holds is
//! drawn afterwards (`rig.rs`), on a logarithmic scale: three of ten single effects from a tenth of
//! what could just be detected up to that, the others from there on; of two effects in one case
//! from three times that.
//!
//! | effect | size | at most |
//! |---|---|---|
//! | `stiffness_scale` | departure of the factor from 1, three of four softer | 40 % |
//! | `shear_modulus` | the same | 60 % |
//! | `joint_compliance`, `root_compliance` | of the rod's own ∫ds/EI; torsion 0.3 to 3 times that share of ∫ds/GJ, or none | 100 % |
//! | `bend_flexibility` | of what the series for an oval section gives | 2 |
//! | `pipe_stiffness` | the same of one pipe, either sign | 50 % |
//! | `rod_dimension` | of l1 or l2, either sign; the angle | 10 %; 6° |
//! | `load_point`, `sensor_point` | of the rod's length, of one station, towards the flange | 12 % |
//! | `friction`, `load_offset` | force, N, and of the smallest load | 2, 0.7 |
//! | `backlash` | play, µm | 100 |
//! | `creep` | per decade | 10 % |
//! | `hysteresis` | loop width at half load | 10 % |
//! | `nonlinear_stiffness` | share at the largest load, either sign | 20 % |
//! | `sensor_scale` | departure of the factor from 1 | 20 % |
//! | `sensor_misalignment`, `load_misalignment` | degrees; one sensor or axis, or the whole frame | 10 |
//! | `thermal_drift` | µm/K, or µm/h without a thermometer; one channel, or all | 50 |
//! | `slip` | µm; within a run, or between runs that share a zero | 500 |
//!
//! The largest size is 0.5 to 1 times that.

use std::f64::consts::PI;

use super::bench::Bench;
use super::effect::{Dimension, Effect};
use super::protocol::End;
use super::setup::Needs;
use super::sizes::{ANGLE, LENGTH, PIPE, POINT};
use crate::chance::{happens, log_uniform, one_of};
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, UM};

/// Effects that a library may have, by number for [`library`].
pub const LIBRARY: usize = 19;
/// The number of what belongs to a single run.
const SLIP: usize = LIBRARY - 1;
/// What may be taken of a pipe at most, so that a point of it stays on it.
const OF_PIPE: f64 = 0.8;
/// Range of the largest size, of the end in the table.
const LARGEST: (f64, f64) = (0.5, 1.0);
/// Runs on either side of a slip between runs.
const RUNS_BESIDE: usize = 2;

/// What a protocol must have to carry the effect of the library of this number.
pub fn needs(effect: usize, random: &mut Random) -> Needs {
    let mut needs = Needs::default();
    match effect {
        SLIP if happens(random, 0.4) => {
            needs = Needs { zeroed_once: true, trials: true, two_channels: true, long_runs: true, ..needs };
        }
        4 => needs.arc = true,
        8 => needs.time = true,
        9 => needs.unloading = true,
        12 => needs.two_channels = true,
        14 => needs.clock = true,
        7 => needs.tip = true,
        // one axis shows a shape no better than moduli
        15..=17 => needs = Needs { two_axes: true, two_channels: true, ..needs },
        SLIP => needs.long_runs = true,
        _ => {}
    }
    needs
}

/// What a careful laboratory records so that an effect of this number can be distinguished from the
/// others: more axes and channels, other stations, the way down.
pub fn careful(effect: usize, random: &mut Random) -> Needs {
    let needs = Needs { two_axes: true, two_channels: true, ..needs(effect, random) };
    match effect {
        0..=4 | 15..=17 => Needs { stations: happens(random, 0.4), ..needs },
        5 | 6 | 8 => Needs { unloading: true, ..needs },
        _ => needs,
    }
}

/// An effect of the library at a bench that can carry it, as large as it may be.
pub fn library(effect: usize, bench: &Bench, random: &mut Random) -> Effect {
    let large = |random: &mut Random, most: f64| most * random.uniform(LARGEST.0, LARGEST.1);
    let protocol = &bench.protocol;
    let (axes, channels, largest) = (protocol.axes(), protocol.read_channels(), protocol.largest_load());
    let sign = |random: &mut Random, negative: f64| if happens(random, negative) { -1.0 } else { 1.0 };
    match effect {
        0 => Effect::StiffnessScale(1.0 + sign(random, 0.75) * large(random, 0.4)),
        1 => Effect::ShearModulus(1.0 + sign(random, 0.75) * large(random, 0.6)),
        2 => {
            let (name, station) = place(bench, random);
            let share = large(random, 1.0);
            let [bending, torsion] = compliance(bench, share, random);
            Effect::Joint { name, station, bending, torsion }
        }
        3 => {
            let share = large(random, 1.0);
            let [bending, torsion] = compliance(bench, share, random);
            Effect::Root { bending, torsion }
        }
        4 => {
            let oval = bench.drawing.tubes[0].ovalisation(bench.drawing.bend_radius);
            Effect::Bend(1.0 + (oval - 1.0) * large(random, 2.0))
        }
        5 => {
            let force = large(random, 2.0).min(0.7 * protocol.smallest_load());
            friction(some_axis(&axes, random), force, random)
        }
        6 => {
            let force = sign(random, 0.5) * large(random, 2.0);
            let force = force.max(-0.7 * protocol.smallest_load());
            Effect::LoadOffset { axis: some_axis(&axes, random), force }
        }
        7 => {
            let play = large(random, 100.0) * UM;
            Effect::Backlash { axis: some_axis(&axes, random), play }
        }
        8 => {
            let shortest = log_uniform(random, 1.0, 60.0);
            Effect::Creep { per_decade: large(random, 0.1), shortest }
        }
        9 => Effect::Hysteresis { fraction: large(random, 0.1), is_exercised: happens(random, 0.5) },
        10 => {
            let share = sign(random, 0.5) * large(random, 0.2);
            match happens(random, 0.5) {
                true => Effect::Cubic(share / (largest * largest)),
                false => Effect::Quadratic(share / largest),
            }
        }
        11 => {
            let factor = 1.0 + sign(random, 0.5) * large(random, 0.2);
            Effect::SensorScale { channel: one_of(random, &channels, 0), factor }
        }
        12 if channels.len() > 1 && happens(random, 0.4) => {
            Effect::SensorBlock(direction(random).map(|part| part * large(random, 10.0) * DEG))
        }
        12 => {
            let channel = one_of(random, &channels, 0);
            let towards = another(channel, random);
            let angle = sign(random, 0.5) * large(random, 10.0) * DEG;
            Effect::SensorMisalignment { channel, towards, angle }
        }
        13 if axes.len() > 1 && happens(random, 0.4) => {
            Effect::LoadFrame(direction(random).map(|part| part * large(random, 10.0) * DEG))
        }
        13 => {
            let axis = one_of(random, &axes, 0);
            let others: Vec<usize> = axes.iter().copied().filter(|other| *other != axis).collect();
            let frame = !others.is_empty() && happens(random, 0.3);
            let towards = if frame { one_of(random, &others, 0) } else { another(axis, random) };
            let (axis, towards) =
                if frame { (axis.min(towards), axis.max(towards)) } else { (axis, towards) };
            let angle = sign(random, 0.5) * large(random, 10.0) * DEG;
            Effect::LoadMisalignment { axis, towards, angle, frame }
        }
        14 => {
            let by_time = !protocol.columns.temperature;
            let rate = sign(random, 0.3) * large(random, 50.0) * UM / if by_time { 3600.0 } else { 1.0 };
            match channels.len() > 1 && happens(random, 0.4) {
                true => Effect::DriftOfAll { rates: direction(random).map(|part| part * rate), by_time },
                false => Effect::Drift { channel: one_of(random, &channels, 0), rate, by_time },
            }
        }
        15 => {
            let factor = 1.0 + sign(random, 0.5) * large(random, PIPE);
            Effect::PipeStiffness { pipe: random.index(2), factor }
        }
        16 => {
            let (legs, gamma) = (bench.drawing.legs, bench.drawing.gamma);
            match random.index(3) {
                2 => {
                    // a pipe that is straight has no other side
                    let by = sign(random, 0.5) * large(random, ANGLE);
                    let by = if gamma + by > PI { -by } else { by };
                    Effect::Dimension { which: Dimension::Angle, stated: gamma, by }
                }
                leg => {
                    let by = sign(random, 0.5) * large(random, LENGTH) * legs[leg];
                    Effect::Dimension { which: Dimension::Leg(leg), stated: legs[leg], by }
                }
            }
        }
        17 => {
            let end = if happens(random, 0.5) { End::Load } else { End::Reading };
            let stations = protocol.stations_of(end);
            let station = one_of(random, &stations, protocol.tip);
            let drawing = &bench.drawing;
            let corner = drawing.legs[0] - drawing.tangent();
            let pipe =
                if station > corner + drawing.arc() { station - corner - drawing.arc() } else { station };
            let by = -(large(random, POINT) * drawing.length()).min(OF_PIPE * pipe);
            Effect::Point { end, station, by }
        }
        _ => slip(bench, sign(random, 0.5) * large(random, 500.0) * UM, random),
    }
}

/// Friction of a slide that needs some way to turn round and does not stick the same each time.
pub fn friction(axis: Option<usize>, force: f64, random: &mut Random) -> Effect {
    let presliding = log_uniform(random, 0.5, 20.0) * UM;
    Effect::Friction { axis, force, presliding, scatter: random.uniform(0.0, 0.15) }
}

/// A slip between two runs where their sensors are not zeroed in between, with two runs on either
/// side; else within a run, with two readings on either side.
fn slip(bench: &Bench, by: f64, random: &mut Random) -> Effect {
    let protocol = &bench.protocol;
    let loadings = &protocol.loadings;
    let run = |k: usize| loadings.get(k).map(|l| l.run);
    let last = loadings.last().map_or(0, |l| l.run);
    if protocol.zeroed_once {
        let is_between = |k: &usize| {
            run(*k) != run(k.wrapping_sub(1))
                && run(*k).is_some_and(|run| run >= RUNS_BESIDE && run + RUNS_BESIDE <= last + 1)
        };
        let first: Vec<usize> = (1..loadings.len()).filter(is_between).collect();
        if let Some(&loading) = first.get(random.index(first.len())) {
            let channels = protocol.read_channels();
            return Effect::Shift { loading, channel: one_of(random, &channels, 0), by };
        }
    }
    let is_inner = |k: &usize| run(*k) == run(k - 2) && run(*k) == run(k + 1);
    let inner: Vec<usize> = (2..loadings.len()).filter(is_inner).collect();
    let loading = one_of(random, &inner, 1);
    let channel = loadings.get(loading).map_or(0, |l| l.axis);
    Effect::Slip { loading, channel, by }
}

/// A direction in space.
pub(super) fn direction(random: &mut Random) -> [f64; 3] {
    let drawn = [0; 3].map(|_| random.normal());
    let norm = drawn.iter().map(|part| part * part).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    drawn.map(|part| part / norm)
}

/// Every effect of the library that has a meaning at a bench, wherever it may sit, at `share` of
/// the upper end of its range; those with two numbers in two parts. Joints along the rod and slips
/// are the oracle's own business.
pub(super) fn all(bench: &Bench, share: f64) -> Vec<Vec<Effect>> {
    let protocol = &bench.protocol;
    let (axes, channels, largest) = (protocol.axes(), protocol.read_channels(), protocol.largest_load());
    let [bending, torsion] = bench.drawing.rotation().map(|rotation| share * rotation);
    let mut all = vec![
        vec![Effect::StiffnessScale(1.0 - 0.4 * share)],
        vec![Effect::ShearModulus(1.0 - 0.6 * share)],
        vec![Effect::Root { bending, torsion: 0.0 }, Effect::Root { bending: 0.0, torsion }],
        vec![Effect::PipeStiffness { pipe: 0, factor: 1.0 - PIPE * share }],
        vec![Effect::PipeStiffness { pipe: 1, factor: 1.0 - PIPE * share }],
        vec![Effect::Dimension { which: Dimension::Angle, stated: bench.drawing.gamma, by: -ANGLE * share }],
        vec![Effect::Cubic(0.2 * share / (largest * largest))],
        vec![Effect::Quadratic(0.2 * share / largest)],
    ];
    for (leg, stated) in bench.drawing.legs.into_iter().enumerate() {
        let by = LENGTH * share * stated;
        all.push(vec![Effect::Dimension { which: Dimension::Leg(leg), stated, by }]);
    }
    for end in [End::Load, End::Reading] {
        let by = -POINT * share * bench.drawing.length();
        let of_station = |station| vec![Effect::Point { end, station, by }];
        all.extend(protocol.stations_of(end).into_iter().map(of_station));
    }
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
    let turns = [0, 1, 2].map(|about| {
        let mut turn = [0.0; 3];
        turn[about] = 10.0 * share * DEG;
        turn
    });
    if channels.len() > 1 {
        all.push(turns.map(Effect::SensorBlock).to_vec());
        let (by_time, unit) =
            (!protocol.columns.temperature, if protocol.columns.temperature { 1.0 } else { 3600.0 });
        if protocol.columns.temperature || protocol.columns.time {
            let rate = |&channel: &usize| {
                let mut rates = [0.0; 3];
                rates[channel] = 50.0 * share * UM / unit;
                Effect::DriftOfAll { rates, by_time }
            };
            all.push(channels.iter().map(rate).collect());
        }
    }
    if axes.len() > 1 {
        all.push(turns.map(Effect::LoadFrame).to_vec());
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
        Some((name, _)) => {
            // where it really is
            let rod = bench.actual.rod(&bench.drawing);
            let is_it = |(known, _): &&(String, f64)| known == name;
            let station = rod.joints.iter().find(is_it).map_or(0.0, |(_, station)| *station);
            (Some(name.clone()), station)
        }
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
