//! A rod and a protocol as a laboratory might have chosen them.

use std::f64::consts::{FRAC_PI_2, PI};

use super::actual::Actual;
use super::bench::Bench;
use super::drawing::{Drawing, rounded};
use super::noise::{Noise, Shape};
use super::protocol::{Columns, Protocol, Run, steps};
use super::tube::Tube;
use super::uncertainty::Uncertainty;
use crate::chance::{happens, log_uniform, one_of};
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, MM, STANDARD_GRAVITY, UM};

/// How often one sensor is worse than the others, and how many times as much it scatters at most.
const ONE_WORSE: f64 = 0.3;
const MOST_WORSE: f64 = 8.0;
const WORST_SHARE: f64 = 0.03;

/// What a protocol must have to carry an effect.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Needs {
    /// An arc whose flexibility the file leaves to the beam.
    pub arc: bool,
    /// Times in the file.
    pub time: bool,
    /// Times or temperatures.
    pub clock: bool,
    /// Readings on the way down.
    pub unloading: bool,
    /// Loads along and against an axis.
    pub both_signs: bool,
    /// Every channel at every loading.
    pub two_channels: bool,
    /// Loads along two axes at least.
    pub two_axes: bool,
    /// Everything read and loaded at the tip.
    pub tip: bool,
    /// Two readings before and two after something that happens within a run: next to a single one
    /// it is an outlier.
    pub long_runs: bool,
    /// Readings at another station than the tip.
    pub stations: bool,
    /// At least three trials.
    pub trials: bool,
    /// Loads in any order, each on an empty hanger.
    pub shuffled: bool,
    /// Waits that differ from load to load.
    pub varied_waits: bool,
    /// Sensors that are zeroed before the first run only.
    pub zeroed_once: bool,
}

impl Needs {
    /// What either needs.
    pub fn and(self, other: Needs) -> Needs {
        Needs {
            arc: self.arc || other.arc,
            time: self.time || other.time,
            clock: self.clock || other.clock,
            unloading: self.unloading || other.unloading,
            both_signs: self.both_signs || other.both_signs,
            two_channels: self.two_channels || other.two_channels,
            two_axes: self.two_axes || other.two_axes,
            tip: self.tip || other.tip,
            long_runs: self.long_runs || other.long_runs,
            stations: self.stations || other.stations,
            trials: self.trials || other.trials,
            shuffled: self.shuffled || other.shuffled,
            varied_waits: self.varied_waits || other.varied_waits,
            zeroed_once: self.zeroed_once || other.zeroed_once,
        }
    }
}

/// Deflection at the largest load, over the rod's length: enough to read, and little enough for a
/// linear rod.
const DEFLECTION: (f64, f64) = (5e-4, 2.5e-3);
/// Rods that are tried before one is taken as it is.
const TRIES: usize = 200;
/// Loadings beyond which a laboratory drops trials.
const MOST_LOADINGS: usize = 240;

/// How many times as far off as stated the numbers of some cases are, and how often.
const TWICE: (f64, f64) = (2.0, 0.15);

/// A bench that can carry an effect, and its noise; `residuals` of a real recording are its shape
/// where there are any.
pub fn draw(needs: Needs, residuals: &[f64], random: &mut Random) -> (Bench, Noise, f64) {
    let largest = random.uniform(5.0, 30.0);
    let mut bench = bench(needs, largest, random);
    for _ in 0..TRIES {
        let axes = bench.protocol.axes();
        let compliance = bench.compliance();
        let most = axes.iter().fold(0.0, |most: f64, &axis| most.max(compliance[axis]));
        let relative = most * bench.protocol.largest_load() / bench.drawing.length();
        if (DEFLECTION.0..DEFLECTION.1).contains(&relative) {
            break;
        }
        bench = self::bench(needs, largest, random);
    }
    let times = if happens(random, TWICE.1) { TWICE.0 } else { 1.0 };
    bench.actual = Actual::drawn(&bench.drawing, &bench.protocol.stations(), times, random);
    let noise = worse_at_most(noise(residuals, random), &bench);
    let steps: Vec<f64> = [0.1, 1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|step| step * UM)
        .filter(|step| *step < 3.0 * noise.sd)
        .collect();
    bench.protocol.quantum = one_of(random, &steps, 0.1 * UM);
    (bench, noise, times)
}

/// A sensor is worse than others, where there are some, and nobody reads one that scatters more
/// than this share of what it shows.
fn worse_at_most(noise: Noise, bench: &Bench) -> Noise {
    let cells = bench.protocol.cells();
    let is_alone = cells.iter().all(|cell| cell.channel == cells[0].channel);
    let largest = bench.readings(&[]).iter().fold(0.0, |most: f64, reading| most.max(reading.abs()));
    let most = if is_alone { 1.0 } else { (WORST_SHARE * largest / noise.sd).max(1.0) };
    Noise { times: noise.times.map(|times| times.min(most)), ..noise }
}

/// Normal as often as heavy-tailed, some of it correlated along the run, now and then with a sensor
/// that is worse than the others.
fn noise(residuals: &[f64], random: &mut Random) -> Noise {
    let shape = match residuals {
        [] if happens(random, 0.5) => Shape::Normal,
        [] => Shape::StudentT(3 + random.index(6) as u32),
        residuals => Shape::Bootstrap(residuals.to_vec()),
    };
    let correlation = if happens(random, 0.25) { random.uniform(0.2, 0.6) } else { 0.0 };
    let mut times = [1.0; 3];
    if happens(random, ONE_WORSE) {
        times[random.index(3)] = log_uniform(random, 1.0, MOST_WORSE);
    }
    let (sd, zero) = (log_uniform(random, 0.5, 5.0) * UM, random.uniform(0.3, 2.0));
    Noise { sd, shape, correlation, zero, times }
}

fn bench(needs: Needs, largest: f64, random: &mut Random) -> Bench {
    let drawing = drawing(needs, random);
    let protocol = protocol(&drawing, needs, largest, random);
    let sticking = protocol.loadings.iter().map(|_| random.uniform(-1.0, 1.0)).collect();
    let full_scale = protocol.largest_load();
    Bench { drawing, actual: Actual::default(), protocol, sticking, full_scale }
}

/// What a careful file states of its numbers, which need not be the defaults.
fn stated(tubes: &[Tube; 2], random: &mut Random) -> Option<Uncertainty> {
    if happens(random, 0.6) {
        return None;
    }
    // one table for all materials: that of the less well known
    let vague = tubes.each_ref().map(Uncertainty::default_of);
    let most = |number: fn(&Uncertainty) -> f64| number(&vague[0]).max(number(&vague[1]));
    let share = random.uniform(0.3, 1.0);
    Some(Uncertainty {
        youngs_modulus: rounded(share * most(|u| u.youngs_modulus), 4),
        shear_modulus: rounded(share * most(|u| u.shear_modulus), 4),
        shear_coefficient: rounded(share * most(|u| u.shear_coefficient), 4),
        diameter: one_of(random, &[0.01, 0.02, 0.05], 0.03) * MM,
        length: one_of(random, &[0.1, 0.2, 0.5], 0.3) * MM,
    })
}

fn tube(random: &mut Random) -> Tube {
    let (material, e, g, density) = match random.index(3) {
        0 => ("steel", (190.0, 210.0), 2.0 * 1.29, 7930.0),
        1 => ("aluminium", (68.0, 73.0), 2.0 * 1.33, 2700.0),
        _ => ("carbon", (60.0, 140.0), 0.0, 1600.0),
    };
    let youngs = rounded(random.uniform(e.0, e.1), 1);
    // a laminate's G is a design choice within E/6 to E/2.6
    let ratio = if g > 0.0 { g } else { random.uniform(2.6, 6.0) };
    let outer = rounded(log_uniform(random, 8.0, 40.0), 1);
    let wall = rounded(log_uniform(random, 0.03, 0.2) * outer, 1).max(0.5);
    Tube {
        material,
        youngs_modulus: youngs * 1e9,
        shear_modulus: rounded(youngs / ratio, 2) * 1e9,
        density,
        outer: outer / 2.0 * MM,
        inner: (outer - 2.0 * wall) / 2.0 * MM,
        coefficient: 1.0,
    }
}

/// A rod that a workshop might have made.
pub fn drawing(needs: Needs, random: &mut Random) -> Drawing {
    let length = random.uniform(100.0, 700.0);
    let share = random.uniform(0.2, 0.8);
    let legs = [share, 1.0 - share].map(|share| rounded(length * share, 1) * MM);
    let is_l = happens(random, 0.5);
    let is_straight = !needs.arc && happens(random, 0.1);
    let oblique = rounded(random.uniform(60.0, 150.0), 1) * DEG;
    let gamma = if is_straight {
        PI
    } else if is_l {
        FRAC_PI_2
    } else {
        oblique
    };
    let first = tube(random);
    let second = if happens(random, 0.3) { tube(random) } else { first.clone() };
    let has_arc = !is_straight && (needs.arc || happens(random, 0.4));
    // the arc ends before its leg does
    let widest = 0.8 * legs[0].min(legs[1]) / ((PI - gamma) / 2.0).tan();
    let radius = (2.0 * first.outer * random.uniform(1.5, 4.0)).min(widest);
    let bend_radius = if has_arc { rounded(radius / MM, 1) * MM } else { 0.0 };
    let mut drawing = Drawing {
        legs,
        gamma,
        bend_radius,
        bend_factor: 1.0,
        // two materials of one name would be one in the file
        tubes: if second.material == first.material { [first.clone(), first] } else { [first, second] },
        joints: Vec::new(),
        tip_mass: rounded(random.uniform(20.0, 120.0), 0) * 1e-3,
        stated: None,
    };
    drawing.stated = stated(&drawing.tubes, random);
    if has_arc && !needs.arc {
        // a careful file states what the bend really is
        drawing.bend_factor = rounded(drawing.tubes[0].ovalisation(bend_radius), 4);
    }
    let count = random.index(4);
    for k in 0..count {
        let share = (k as f64 + random.uniform(0.2, 0.8)) / count as f64;
        let station = rounded(share * drawing.length() / MM, 1) * MM;
        drawing.joints.push((format!("joint-{}", ["a", "b", "c"][k % 3]), station));
    }
    drawing
}

fn protocol(drawing: &Drawing, needs: Needs, largest: f64, random: &mut Random) -> Protocol {
    let axes: &[usize] = match random.index(if needs.two_axes { 8 } else { 10 }) {
        0..5 => &[1, 2],
        5..8 => &[0, 1, 2],
        8 => &[1],
        _ => &[2],
    };
    let kilograms = happens(random, 0.4);
    let loads = loads(largest, kilograms, if needs.long_runs { 4 } else { 3 }, random);
    let trials = if needs.trials { 3 + random.index(4) } else { 1 + random.index(6) };
    let trials = if needs.stations { trials.max(2) } else { trials };
    let is_shuffled = needs.shuffled || (!needs.unloading && !needs.both_signs && happens(random, 0.06));
    let has_unloading = !is_shuffled && (needs.unloading || happens(random, 0.5));
    let varies = needs.varied_waits || happens(random, 0.2);
    let ends_at_zero = has_unloading && happens(random, 0.3);
    // against the axis by accident of the setup, or both ways in one run
    let both_ways = needs.both_signs || (!is_shuffled && happens(random, 0.15));
    let signs: Vec<f64> = axes.iter().map(|_| if happens(random, 0.2) { -1.0 } else { 1.0 }).collect();
    let per_run = loads.len() * if has_unloading { 2 } else { 1 } * if both_ways { 2 } else { 1 };
    let fewest = if needs.stations {
        2
    } else if needs.trials {
        3
    } else {
        1
    };
    let trials = trials.min(MOST_LOADINGS / (per_run * axes.len())).max(fewest);
    let zeroed_once = needs.zeroed_once || happens(random, 0.08);
    let dwell = log_uniform(random, 10.0, 120.0);
    let rest = log_uniform(random, 60.0, 1200.0);
    let tip = drawing.length();
    let elsewhere = rounded(random.uniform(0.3, 0.8) * tip / MM, 0) * MM;
    let has_station = needs.stations || (!needs.tip && happens(random, 0.15));
    let moves_load = has_station && !needs.stations && happens(random, 0.5);
    let moves_sensor = has_station;
    let (mut loadings, mut time, mut run) = (Vec::new(), 0.0, 0);
    for trial in 0..trials {
        for (&axis, &first_sign) in axes.iter().zip(&signs) {
            let zeroed = if zeroed_once { 0.0 } else { time };
            // every second trial at the other station, so that the file distinguishes them
            let stations = match (has_station && trial % 2 == 1, moves_load) {
                (true, true) => [elsewhere, tip],
                (true, false) if moves_sensor => [tip, elsewhere],
                _ => [tip; 2],
            };
            let ways = if both_ways { vec![first_sign, -first_sign] } else { vec![first_sign] };
            for sign in ways {
                let run = Run { axis, sign, trial, run, zeroed, stations };
                let to_zero = ends_at_zero.then_some((0.0, true));
                let mut steps = steps(&loads, has_unloading);
                if is_shuffled {
                    shuffle(&mut steps, random);
                }
                for step in steps.into_iter().chain(to_zero) {
                    let changed = time;
                    let wait = if varies { log_uniform(random, 0.3, 4.0) } else { random.uniform(0.8, 1.2) };
                    time = rounded(changed + dwell * wait, 1);
                    loadings.push(run.loading(step, changed, time));
                }
            }
            run += 1;
            time += rest * random.uniform(0.5, 1.5);
        }
    }
    let all = needs.two_channels || happens(random, 0.3);
    let read = |axis: usize| [0, 1, 2].map(|channel| channel == axis || (all && axes.contains(&channel)));
    let has_time = needs.time || happens(random, 0.5);
    let has_temperature = happens(random, 0.25) || (needs.clock && !has_time);
    let columns = Columns {
        trial: if trials > 1 { happens(random, 0.85) } else { happens(random, 0.3) },
        phase: has_unloading || happens(random, 0.2),
        time: has_time,
        temperature: has_temperature,
        kilograms,
    };
    let drift = random.uniform(-2.0, 2.0) / 3600.0;
    let room = [20.0, drift, random.uniform(0.0, 0.5), random.uniform(1800.0, 7200.0)];
    let channels = loadings.iter().map(|l| read(l.axis)).collect();
    Protocol { loadings, channels, tip, room, quantum: 0.0, zeroed_once, is_shuffled, columns }
}

/// By R. A. Fisher and F. Yates.
fn shuffle<T>(all: &mut [T], random: &mut Random) {
    for k in (1..all.len()).rev() {
        all.swap(k, random.index(k + 1));
    }
}

/// So many to ten loads up to the largest, at even steps or as the weights happen to be.
fn loads(largest: f64, kilograms: bool, fewest: usize, random: &mut Random) -> Vec<f64> {
    let count = fewest + random.index(11 - fewest);
    let is_even = happens(random, 0.7);
    let (unit, decimals) = if kilograms { (STANDARD_GRAVITY, 2) } else { (1.0, 1) };
    let mut loads: Vec<f64> = (1..=count)
        .map(|k| {
            let jitter = if is_even { 0.0 } else { random.uniform(-0.35, 0.35) };
            let share = (k as f64 + jitter) / count as f64;
            rounded(share * largest / unit, decimals).max(10f64.powi(-decimals)) * unit
        })
        .collect();
    loads.dedup();
    loads
}
