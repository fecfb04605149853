//! What a rig would read: the forward model of the generator.
//!
//! ```text
//! hanging weight → friction → hysteresis → damping → stiffness that follows loads   carried load
//! carried load, its direction → Cosserat rod → creep, running in, one-way clamp     displacement
//! displacement + play + seat → sensor: direction, scale, ripple, limit              reading
//! reading + drift + oscillation + slip + outlier
//! ```
//!
//! Rod, loads, sensors and stations are those that really are there (`actual.rs`), not those of the
//! files.

mod loads;

use std::collections::HashMap;

use nalgebra::Vector3;

use super::actual::Actual;
use super::cosserat::{Body, Hinge};
use super::direction::{direction, rotation, turn};
use super::drawing::{Deviation, Drawing};
use super::effect::{Dimension, Effect};
use super::load_history::creep_compliance;
use super::protocol::{End, Loading, Protocol};

/// A rod at a rig with what was done there.
#[derive(Debug, Clone)]
pub struct Bench {
    /// The rod as its file states it.
    pub drawing: Drawing,
    /// How far it and the rig are from that.
    pub actual: Actual,
    /// What was done.
    pub protocol: Protocol,
    /// By loading, −1 to 1: how the slide happens to stick.
    pub sticking: Vec<f64>,
    /// The largest load of the recording, N: what effects that are shares of full scale refer to,
    /// whatever else is done.
    pub full_scale: f64,
}

/// Deflections of a body, each computed once.
struct Solver {
    body: Body,
    known: HashMap<[u64; 5], Vector3<f64>>,
}

impl Solver {
    fn deflection(&mut self, force: &Vector3<f64>, stations: [f64; 2]) -> Vector3<f64> {
        let [load, read] = stations;
        let key = [force.x, force.y, force.z, load, read].map(f64::to_bits);
        let body = &self.body;
        *self.known.entry(key).or_insert_with(|| body.deflection(force, load, read))
    }
}

impl Bench {
    /// The reading of every cell without noise, m.
    pub fn readings(&self, effects: &[Effect]) -> Vec<f64> {
        let rod = shaped(self.actual.rod(&self.drawing), effects);
        let forces = self.forces(effects);
        let mut solver = Solver { body: body(&rod, effects), known: HashMap::new() };
        let loadings: Vec<Loading> = self
            .protocol
            .loadings
            .iter()
            .map(|l| {
                let at = |end: End| self.station(&rod, effects, end, l.stations[end as usize]);
                Loading { stations: [End::Load, End::Reading].map(at), ..l.clone() }
            })
            .collect();
        let mut displaced: Vec<Vector3<f64>> =
            loadings.iter().zip(&forces).map(|(l, force)| solver.deflection(force, l.stations)).collect();
        let creep = effects.iter().filter_map(|effect| match effect {
            Effect::Creep { per_decade, shortest } => Some((*per_decade, *shortest)),
            _ => None,
        });
        for (per_decade, shortest) in creep.collect::<Vec<_>>() {
            let law = creep_compliance(per_decade, shortest);
            let more = crept(&loadings, &mut solver, &forces, law);
            displaced.iter_mut().zip(more).for_each(|(u, more)| *u += more);
        }
        for (index, (loading, u)) in loadings.iter().zip(&mut displaced).enumerate() {
            *u = self.ball_displacement(effects, index, loading, &forces[index], *u);
        }
        let cells = self.protocol.cells();
        let read = |(index, cell): (usize, &super::protocol::Cell)| {
            self.read(effects, index, cell.loading, cell.channel, &displaced[cell.loading])
        };
        cells.iter().enumerate().map(read).collect()
    }

    /// Where what stands at a station of the readings is on the real rod, m.
    fn station(&self, rod: &Drawing, effects: &[Effect], end: End, station: f64) -> f64 {
        let own = match station == self.protocol.tip {
            true => rod.length(),
            false => self.actual.station(station),
        };
        let displaced = effects.iter().map(|effect| match effect {
            Effect::Point { end: own, station: at, by } if *own == end && *at == station => *by,
            _ => 0.0,
        });
        (own + displaced.sum::<f64>()).clamp(0.0, rod.length())
    }

    /// Displacement along each axis per newton along it at the tip, m/N, of the real rod.
    pub fn compliance(&self) -> [f64; 3] {
        let rod = self.actual.rod(&self.drawing);
        let (body, tip) = (rod.body(&Deviation::default()), rod.length());
        [0, 1, 2].map(|axis| {
            let force = 1e-3;
            body.deflection(&(Vector3::ith(axis, force)), tip, tip)[axis] / force
        })
    }

    /// The displacement with what changes it as a whole, and with what the ball does by itself.
    fn ball_displacement(
        &self,
        effects: &[Effect],
        index: usize,
        loading: &Loading,
        force: &Vector3<f64>,
        displaced: Vector3<f64>,
    ) -> Vector3<f64> {
        let mut u = displaced;
        let along = direction(effects, loading);
        for effect in effects {
            match *effect {
                Effect::RunningIn { share, loadings } => {
                    u *= 1.0 + share * (-(index as f64) / loadings).exp();
                }
                Effect::LooseClamp(share) if loading.sign < 0.0 => u *= 1.0 + share,
                Effect::Backlash { axis, play } if loading.is_along(axis) && loading.load > 0.0 => {
                    u += along * play
                }
                Effect::SlippingClamp { per_newton, yield_load, sharpness, balance } => {
                    u += along * (per_newton * self.slipped(index, (yield_load, sharpness, balance)));
                }
                Effect::Seat(depth) => {
                    let relative = force.norm() / self.full_scale;
                    u += along * (depth * relative.powf(2.0 / 3.0));
                }
                _ => {}
            }
        }
        u
    }

    /// What the sensor of a channel shows.
    fn read(
        &self,
        effects: &[Effect],
        index: usize,
        loading: usize,
        channel: usize,
        displaced: &Vector3<f64>,
    ) -> f64 {
        let mut towards = Vector3::ith(channel, 1.0);
        for effect in effects {
            match *effect {
                Effect::SensorMisalignment { channel: turned, towards: other, angle }
                    if turned == channel =>
                {
                    towards = turn(turned, other, angle) * towards;
                }
                Effect::SensorBlock(turn) => towards = rotation(turn) * towards,
                _ => {}
            }
        }
        let mut reading = towards.dot(displaced) * self.actual.sensor_scale(channel);
        let at = &self.protocol.loadings[loading];
        for effect in effects {
            match effect {
                Effect::SensorScale { channel: own, factor } if *own == channel => reading *= factor,
                Effect::Ripple { channel: own, amplitude, period, phase } if *own == channel => {
                    let angle = std::f64::consts::TAU / period * reading + phase;
                    reading += amplitude * (angle.sin() - phase.sin());
                }
                Effect::Saturation { channel: own, limit } if *own == channel => {
                    reading = reading.clamp(-limit, *limit);
                }
                Effect::Drift { channel: own, rate, by_time } if *own == channel => {
                    let since = |t: f64| if *by_time { t } else { self.protocol.temperature(t) };
                    reading += rate * (since(at.time) - since(at.zeroed));
                }
                Effect::DriftOfAll { rates, by_time } => {
                    let since = |t: f64| if *by_time { t } else { self.protocol.temperature(t) };
                    reading += rates[channel] * (since(at.time) - since(at.zeroed));
                }
                Effect::Oscillation { amplitude, period, phase } => {
                    let swing = |t: f64| (std::f64::consts::TAU / period * t + phase).sin();
                    reading += amplitude[channel] * (swing(at.time) - swing(at.zeroed));
                }
                Effect::Shift { loading: first, channel: own, by } if *own == channel => {
                    reading += if loading >= *first { *by } else { 0.0 };
                }
                Effect::Slip { loading: first, channel: own, by } => {
                    let run = self.protocol.loadings[*first].run;
                    if *own == channel && loading >= *first && at.run == run {
                        reading += by;
                    }
                }
                Effect::Outlier(cells) => {
                    reading += cells.iter().filter(|(cell, _)| *cell == index).map(|(_, by)| by).sum::<f64>();
                }
                _ => {}
            }
        }
        reading
    }
}

/// The rod with what is wrong with its shape.
fn shaped(mut rod: Drawing, effects: &[Effect]) -> Drawing {
    for effect in effects {
        match *effect {
            Effect::Dimension { which: Dimension::Leg(leg), by, .. } => rod.legs[leg] += by,
            Effect::Dimension { which: Dimension::Angle, by, .. } => rod.gamma += by,
            _ => {}
        }
    }
    rod
}

/// The rod with what is wrong with its stiffness.
fn body(rod: &Drawing, effects: &[Effect]) -> Body {
    let mut deviation = Deviation::default();
    for effect in effects {
        match *effect {
            Effect::StiffnessScale(factor) => deviation.stiffness *= factor,
            Effect::ShearModulus(factor) => deviation.shear *= factor,
            Effect::PipeStiffness { pipe, factor } => deviation.pipes[pipe] *= factor,
            Effect::Bend(factor) => deviation.bend = Some(factor),
            Effect::Joint { station, bending, torsion, .. } => {
                deviation.hinges.push(Hinge { station, bending, torsion });
            }
            Effect::Root { bending, torsion } => {
                deviation.hinges.push(Hinge { station: 0.0, bending, torsion });
            }
            Effect::Waviness { amplitude, period, phase } => {
                deviation.wave = Some([amplitude, period, phase]);
            }
            _ => {}
        }
    }
    rod.body(&deviation)
}

/// What creep adds at each reading, by Boltzmann's superposition over everything that ever hung
/// there since the first zero, less what had crept already when the run was zeroed.
fn crept(
    loadings: &[Loading],
    solver: &mut Solver,
    forces: &[Vector3<f64>],
    compliance: impl Fn(f64) -> f64,
) -> Vec<Vector3<f64>> {
    // time of a change, force before and after it, where it hangs
    let mut changes: Vec<(f64, Vector3<f64>, Vector3<f64>, f64)> = Vec::new();
    for (index, loading) in loadings.iter().enumerate() {
        let goes_on = index > 0 && loadings[index - 1].run == loading.run;
        let before = if goes_on { forces[index - 1] } else { Vector3::zeros() };
        changes.push((loading.changed, before, forces[index], loading.stations[0]));
        let is_last = loadings.get(index + 1).is_none_or(|next| next.run != loading.run);
        if is_last {
            changes.push((loading.time, forces[index], Vector3::zeros(), loading.stations[0]));
        }
    }
    let mut add = |loading: &Loading| {
        let mut sum = Vector3::zeros();
        for (time, before, after, station) in &changes {
            if *time >= loading.time || before == after {
                continue;
            }
            let grown = compliance(loading.time - time) - compliance(loading.zeroed - time);
            if grown != 0.0 {
                let stations = [*station, loading.stations[1]];
                sum += (solver.deflection(after, stations) - solver.deflection(before, stations)) * grown;
            }
        }
        sum
    };
    loadings.iter().map(&mut add).collect()
}

#[cfg(test)]
pub(super) mod tests;
