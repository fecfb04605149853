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

use std::collections::HashMap;

use nalgebra::{Rotation3, Unit, Vector3};

use super::actual::Actual;
use super::cosserat::{Body, Hinge};
use super::drawing::{Deviation, Drawing};
use super::effect::Effect;
use super::memory::{Plays, creep_compliance, friction_after, slipped_after};
use super::protocol::{Loading, Protocol};

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
        let rod = self.actual.rod(&self.drawing);
        let forces = self.forces(effects);
        let mut solver = Solver { body: body(&rod, effects), known: HashMap::new() };
        let loadings: Vec<Loading> = self
            .protocol
            .loadings
            .iter()
            .map(|l| Loading { stations: l.stations.map(|s| self.station(&rod, s)), ..l.clone() })
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
            *u = self.carried(effects, index, loading, &forces[index], *u);
        }
        let cells = self.protocol.cells();
        let read = |(index, cell): (usize, &super::protocol::Cell)| {
            self.read(effects, index, cell.loading, cell.channel, &displaced[cell.loading])
        };
        cells.iter().enumerate().map(read).collect()
    }

    /// Where a station of the readings is on the real rod, m.
    fn station(&self, rod: &Drawing, station: f64) -> f64 {
        match station == self.protocol.tip {
            true => rod.length(),
            false => self.actual.station(station).clamp(0.0, rod.length()),
        }
    }

    /// The force that the rod carries at each loading, N.
    fn forces(&self, effects: &[Effect]) -> Vec<Vector3<f64>> {
        let mut felt = self.hanging(effects);
        for effect in effects {
            match *effect {
                Effect::Friction { axis, force, presliding, scatter } => {
                    self.rub(&mut felt, axis, force, presliding, scatter);
                }
                Effect::Hysteresis { fraction, is_exercised } => self.lag(&mut felt, fraction, is_exercised),
                Effect::Damping { share, time } => self.damp(&mut felt, share, time),
                Effect::LoadBefore(share) => self.remember(&mut felt, share),
                _ => {}
            }
        }
        for effect in effects {
            for load in &mut felt {
                match *effect {
                    Effect::Cubic(k) => *load *= 1.0 + k * *load * *load,
                    Effect::Quadratic(k) => *load *= 1.0 + k * load.abs(),
                    Effect::GapCloses { load: closed, share } if *load > closed => {
                        *load = closed + share * (*load - closed);
                    }
                    _ => {}
                }
            }
        }
        let loadings = self.protocol.loadings.iter().zip(felt);
        loadings.map(|(loading, load)| direction(effects, loading) * load).collect()
    }

    /// What hangs there: the nominal load and what is wrong with it, N.
    fn hanging(&self, effects: &[Effect]) -> Vec<f64> {
        let of_loading = |loading: &Loading| {
            let offsets = effects.iter().map(|effect| match *effect {
                Effect::LoadOffset { axis, force } if is_of(axis, loading) => force,
                _ => 0.0,
            });
            // nothing hangs on an unloaded rod, no hanger either
            let scale = self.actual.load_scale();
            if loading.load > 0.0 { scale * loading.load + offsets.sum::<f64>() } else { 0.0 }
        };
        self.protocol.loadings.iter().map(of_loading).collect()
    }

    /// Friction takes its share of the loads on the way up and holds them on the way down.
    fn rub(&self, felt: &mut [f64], axis: Option<usize>, force: f64, presliding: f64, scatter: f64) {
        let compliance = self.compliance();
        let (mut z, mut hung, mut held) = (0.0, 0.0, 0.0);
        let loadings = &self.protocol.loadings;
        for (index, loading) in loadings.iter().enumerate() {
            if self.is_first(index) {
                (z, hung, held) = (0.0, 0.0, 0.0);
            }
            if !is_of(axis, loading) {
                continue;
            }
            let hanging = felt[index];
            z = friction_after(z, force, (hanging - hung) * compliance[loading.axis], presliding);
            let mut carried = hanging - z * (1.0 + scatter * self.sticking[index]);
            if loading.is_unloading {
                // a slide that sticks holds the rod where it was
                carried = carried.min(held);
            } else if loading.load == 0.0 || carried * hanging < 0.0 {
                carried = 0.0;
            }
            (hung, held, felt[index]) = (hanging, carried, carried);
        }
    }

    /// True where a load hangs on an empty hanger: the first of a run, or each one in any order.
    fn is_first(&self, index: usize) -> bool {
        let loadings = &self.protocol.loadings;
        let of_index = |index: usize| loadings.get(index).map(|l| (l.run, l.sign));
        index == 0 || of_index(index - 1) != of_index(index) || self.protocol.is_shuffled
    }

    /// How far what slips little by little has come at a loading since its run began, N.
    fn slipped(&self, index: usize, numbers: (f64, f64, f64)) -> f64 {
        let first = (0..=index).rev().find(|&k| self.is_first(k)).unwrap_or(0);
        let (mut z, mut hung) = (0.0, 0.0);
        for loading in &self.protocol.loadings[first..=index] {
            z = slipped_after(z, loading.load - hung, numbers);
            hung = loading.load;
        }
        z
    }

    /// A part of each change of the load is still to come when the display is read.
    fn damp(&self, felt: &mut [f64], share: f64, time: f64) {
        let hanging = felt.to_vec();
        for (index, loading) in self.protocol.loadings.iter().enumerate() {
            let before = if self.is_first(index) { 0.0 } else { hanging[index - 1] };
            let waited = loading.time - loading.changed;
            felt[index] -= share * (hanging[index] - before) * (-waited / time).exp();
        }
    }

    /// What was loaded just before, of the same run, adds its share.
    fn remember(&self, felt: &mut [f64], share: f64) {
        let hanging = felt.to_vec();
        let loadings = &self.protocol.loadings;
        for index in 1..felt.len() {
            if loadings[index - 1].run == loadings[index].run {
                felt[index] *= 1.0 + share * hanging[index - 1] / self.full_scale;
            }
        }
    }

    fn lag(&self, felt: &mut [f64], fraction: f64, is_exercised: bool) {
        let new = || Plays::new(fraction, self.full_scale, is_exercised);
        let mut plays = [[new(), new()], [new(), new()], [new(), new()]];
        // what a run reads unloaded; of sensors that are zeroed once, what its axis read at first
        let mut zeros = [[None; 2]; 3];
        let mut last = usize::MAX;
        for (loading, load) in self.protocol.loadings.iter().zip(felt) {
            let way = usize::from(loading.sign < 0.0);
            let of_axis = &mut plays[loading.axis][way];
            let key = 2 * loading.run + way;
            if last != key && !self.protocol.zeroed_once {
                zeros[loading.axis][way] = None;
            }
            last = key;
            let zero: f64 = *zeros[loading.axis][way].get_or_insert_with(|| of_axis.load(0.0));
            *load = of_axis.load(*load) - zero;
        }
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
    fn carried(
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
                Effect::Backlash { axis, play } if is_of(axis, loading) && loading.load > 0.0 => {
                    u += along * play
                }
                Effect::SlippingClamp { per_newton, yields, sharpness, balance } => {
                    u += along * (per_newton * self.slipped(index, (yields, sharpness, balance)));
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
                Effect::SensorMisalignment { channel: of, towards: other, angle } if of == channel => {
                    towards = turn(of, other, angle) * towards;
                }
                Effect::SensorBlock(turn) => towards = rotation(turn) * towards,
                _ => {}
            }
        }
        let mut reading = towards.dot(displaced) * self.actual.sensor_scale(channel);
        let at = &self.protocol.loadings[loading];
        for effect in effects {
            match effect {
                Effect::SensorScale { channel: of, factor } if *of == channel => reading *= factor,
                Effect::Ripple { channel: of, amplitude, period, phase } if *of == channel => {
                    let angle = std::f64::consts::TAU / period * reading + phase;
                    reading += amplitude * (angle.sin() - phase.sin());
                }
                Effect::Saturation { channel: of, limit } if *of == channel => {
                    reading = reading.clamp(-limit, *limit);
                }
                Effect::Drift { channel: of, rate, by_time } if *of == channel => {
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
                Effect::Shift { loading: first, channel: of, by } if *of == channel => {
                    reading += if loading >= *first { *by } else { 0.0 };
                }
                Effect::Slip { loading: first, channel: of, by } => {
                    let run = self.protocol.loadings[*first].run;
                    if *of == channel && loading >= *first && at.run == run {
                        reading += by;
                    }
                }
                Effect::Outlier(cells) => {
                    reading += cells.iter().filter(|(of, _)| *of == index).map(|(_, by)| by).sum::<f64>();
                }
                _ => {}
            }
        }
        reading
    }
}

/// The rod with what is wrong with its stiffness.
fn body(rod: &Drawing, effects: &[Effect]) -> Body {
    let mut deviation = Deviation::default();
    for effect in effects {
        match *effect {
            Effect::StiffnessScale(factor) => deviation.stiffness *= factor,
            Effect::ShearModulus(factor) => deviation.shear *= factor,
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

fn is_of(axis: Option<usize>, loading: &Loading) -> bool {
    axis.is_none_or(|axis| axis == loading.axis)
}

/// Where a load pulls to.
fn direction(effects: &[Effect], loading: &Loading) -> Vector3<f64> {
    let mut direction = Vector3::ith(loading.axis, loading.sign);
    for effect in effects {
        match *effect {
            Effect::LoadMisalignment { axis, towards, angle, frame } if frame || axis == loading.axis => {
                direction = turn(axis, towards, angle) * direction;
            }
            Effect::LoadFrame(turn) => direction = rotation(turn) * direction,
            _ => {}
        }
    }
    direction
}

/// About a vector by its length, rad.
fn rotation(turn: [f64; 3]) -> Rotation3<f64> {
    Rotation3::from_scaled_axis(Vector3::from(turn))
}

/// By `angle` from one axis towards another one.
fn turn(from: usize, towards: usize, angle: f64) -> Rotation3<f64> {
    let about = Vector3::ith(from, 1.0).cross(&Vector3::ith(towards, 1.0));
    Rotation3::from_axis_angle(&Unit::new_normalize(about), angle)
}

#[cfg(test)]
pub(super) mod tests;
