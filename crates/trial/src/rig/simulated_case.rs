//! A simulated case to a specification: one rod, one protocol, the effects that are asked for.

use std::f64::consts::FRAC_PI_2;

use super::actual::Actual;
use super::bench::Bench;
use super::drawing::Drawing;
use super::effect::Effect;
use super::noise::Noise;
use super::protocol::{Columns, Protocol, Run, steps};
use super::tube::Tube;
use rodcal_base::statistics::Random;
use rodcal_base::units::{MM, UM};

/// A steel rod in the shape of an L, 16 × 12 mm, with a declared joint `sleeve`, and what is done
/// with it. SI.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseSpec {
    /// Radius of the bend, m; 0 is a sharp corner.
    pub bend_radius: f64,
    /// Axes of {T} along which it is loaded, 0 to 2.
    pub axes: Vec<usize>,
    /// Loads on the way up, N.
    pub loads: Vec<f64>,
    /// How often all of it is done.
    pub trials: usize,
    /// Also read on the way down.
    pub unloading: bool,
    /// Along and against each axis in one run.
    pub both_ways: bool,
    /// Every channel at every loading, not only the loaded one.
    pub all_channels: bool,
    /// Optional columns of the file.
    pub columns: Columns,
    /// Standard deviation of a reading, m.
    pub noise: f64,
    /// Step of the display, m.
    pub quantum: f64,
}

impl Default for CaseSpec {
    fn default() -> Self {
        CaseSpec {
            bend_radius: 0.0,
            axes: vec![0, 1, 2],
            loads: vec![2.5, 5.0, 7.5, 10.0],
            trials: 3,
            unloading: true,
            both_ways: false,
            all_channels: true,
            columns: Columns { trial: true, phase: true, time: true, temperature: true, kilograms: false },
            noise: 1.5 * UM,
            quantum: 0.1 * UM,
        }
    }
}

/// A recording as its files have it.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedCase {
    /// The rod file.
    pub rod: String,
    /// The readings.
    pub readings: String,
    /// Where each effect is, in the words of a diagnosis.
    pub places: Vec<String>,
}

/// Seconds from a load to its reading, and from a run to the next.
const TIMES: (f64, f64) = (40.0, 300.0);

impl CaseSpec {
    /// The recording with `effects`, and the noise of `seed`.
    pub fn simulated(&self, effects: &[Effect], seed: u64) -> SimulatedCase {
        let mut random = Random::seeded(seed, 0);
        let drawing = self.drawing();
        let protocol = self.protocol(drawing.length());
        let sticking = protocol.loadings.iter().map(|_| random.uniform(-1.0, 1.0)).collect();
        let full_scale = protocol.largest_load();
        let bench = Bench { drawing, actual: Actual::default(), protocol, sticking, full_scale };
        let noise = Noise::normal(self.noise);
        let shown = noise.shown(&bench, &bench.readings(effects), &mut random);
        SimulatedCase {
            rod: bench.drawing.toml("made"),
            readings: bench.protocol.csv(&shown),
            places: effects.iter().map(|effect| effect.place(&bench.protocol).to_string()).collect(),
        }
    }

    /// How far the rod bends and twists per moment at its tip, ∫ds/EI and ∫ds/GJ, rad/(N·m).
    pub fn rotation(&self) -> [f64; 2] {
        self.drawing().rotation()
    }

    fn drawing(&self) -> Drawing {
        let tube = Tube {
            material: "steel",
            youngs_modulus: 193e9,
            shear_modulus: 74.8e9,
            density: 7930.0,
            outer: 8.0 * MM,
            inner: 6.0 * MM,
            coefficient: 1.0,
        };
        Drawing {
            legs: [200.0 * MM, 300.0 * MM],
            gamma: FRAC_PI_2,
            bend_radius: self.bend_radius,
            bend_factor: 1.0,
            tubes: [tube.clone(), tube],
            joints: vec![("sleeve".into(), 120.0 * MM)],
            tip_mass: 0.055,
            stated: None,
        }
    }

    fn protocol(&self, tip: f64) -> Protocol {
        let (dwell, rest) = TIMES;
        let steps = steps(&self.loads, self.unloading);
        let signs: &[f64] = if self.both_ways { &[1.0, -1.0] } else { &[1.0] };
        let (mut loadings, mut time, mut run) = (Vec::new(), 0.0, 0);
        for trial in 0..self.trials {
            for &axis in &self.axes {
                let zeroed = time;
                for &sign in signs {
                    let run = Run { axis, sign, trial, run, zeroed, stations: [tip; 2] };
                    for &step in &steps {
                        let changed = time;
                        time += dwell;
                        loadings.push(run.loading(step, changed, time));
                    }
                }
                run += 1;
                time += rest;
            }
        }
        let read =
            |axis: usize| [0, 1, 2].map(|k| k == axis || (self.all_channels && self.axes.contains(&k)));
        Protocol {
            channels: loadings.iter().map(|loading| read(loading.axis)).collect(),
            loadings,
            tip,
            // warms by 2 K per hour, with a swing
            room: [20.0, 2.0 / 3600.0, 0.3, 2400.0],
            quantum: self.quantum,
            zeroed_once: false,
            is_shuffled: false,
            columns: self.columns,
        }
    }
}
