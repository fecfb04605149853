//! What each parameter of an effect does, and how effects act together: load, structure, reading.
//!
//! ```text
//! load       F = m·d    m = nominal + offset, less friction on the way up (not below zero), more on the way down
//!                       d = nominal direction, turned
//! structure  u = C·d·(m·(1 + k₂m²)(1 + k₁|m|)Π(1 + v·w) + Σ v·W)     C by the structure; w, W by the history of loads
//! reading    y = s·e·(u + play·d) + shifts                            e = channel, turned; s its scale
//! ```
//!
//! A load of zero is an unloaded rod: nothing hangs there, so there is no offset, no play and, on the way up, no friction.

use std::sync::Arc;

use nalgebra::{Rotation3, Unit, Vector3};

use super::datum::Datum;
use super::load_history::{History, Memory};
use super::structure::{Nodes, Softening};
use crate::spatial::Axis;

/// What one parameter does. The number in brackets is its value where nothing happens.
#[derive(Debug, Clone)]
pub(super) enum Action {
    /// Friction of the slide under loads along these axes, N \[0\].
    Friction([bool; 3]),
    /// Added to every load along these axes, N \[0\].
    LoadOffset([bool; 3]),
    /// Loads along the axes of the mask turn from the first axis towards the second, rad \[0\].
    TurnLoad([bool; 3], Axis, Axis),
    /// Factor on E and G \[1\].
    Stiffness,
    /// Factor on G \[1\].
    ShearModulus,
    /// Flexibility factor of the bend \[that of the rod file\].
    Bend(f64),
    /// Compliance of the joint of this number, rad/(N·m) \[that of the rod file\].
    Joint(usize, f64),
    /// Where the joint of these numbers is, m \[its station\]; see [`Nodes`].
    Station(Nodes),
    /// k₂, 1/N² \[0\].
    PerLoadSquared,
    /// k₁, 1/N \[0\].
    PerLoad,
    /// Displacement grows with the history of loads \[0\].
    Memory(Memory, History),
    /// Factor on a channel \[1\].
    SensorScale(Axis),
    /// The channel turns from its own axis towards another one, rad \[0\].
    TurnSensor(Axis, Axis),
    /// All channels turn, as one block, from the first axis towards the second, rad \[0\].
    TurnSensors(Axis, Axis),
    /// Play of the clamp under loads along these axes, m \[0\].
    Play([bool; 3]),
    /// Adds to readings \[0\].
    Shift(Weights),
    /// Adds to the readings of this sequence of data, from one of them on \[0\].
    Step(Arc<[usize]>, usize),
}

/// What is added to readings per unit of a parameter.
#[derive(Debug, Clone)]
pub(super) struct Weights {
    /// Indices of the data, which several of them may share: recordings are long, and curves many.
    pub data: Arc<[usize]>,
    /// For each of these its weight.
    pub values: Vec<f64>,
}

impl Weights {
    /// Index and weight of each datum.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.data.iter().copied().zip(self.values.iter().copied())
    }
}

impl FromIterator<(usize, f64)> for Weights {
    fn from_iter<T: IntoIterator<Item = (usize, f64)>>(weights: T) -> Self {
        let (data, values): (Vec<usize>, Vec<f64>) = weights.into_iter().unzip();
        Weights { data: data.into(), values }
    }
}

impl Action {
    /// True for what adds to the readings whatever else there is.
    pub(super) fn only_adds(&self) -> bool {
        matches!(self, Action::Shift(_) | Action::Step(..))
    }

    /// Adds what it does at `value` to readings, m.
    pub(super) fn add_to(&self, readings: &mut [f64], value: f64) {
        match self {
            Action::Shift(weights) => weights.iter().for_each(|(i, weight)| readings[i] += weight * value),
            Action::Step(data, from) => data[*from..].iter().for_each(|&i| readings[i] += value),
            _ => {}
        }
    }

    /// The largest that it adds to a reading per unit of its parameter.
    pub(super) fn largest_addition(&self) -> Option<f64> {
        match self {
            Action::Shift(weights) => {
                Some(weights.values.iter().fold(0.0, |most: f64, weight| most.max(weight.abs())))
            }
            Action::Step(data, from) => Some(if *from < data.len() { 1.0 } else { 0.0 }),
            _ => None,
        }
    }
}

/// A rig with all that is wrong with it.
pub(super) struct State<'a> {
    friction: [f64; 3],
    load_offset: [f64; 3],
    /// By axis: what a load along its positive direction is directed to.
    load_direction: [Vector3<f64>; 3],
    pub softening: Softening,
    per_load_squared: f64,
    per_load: f64,
    memories: Vec<(&'a Memory, f64)>,
    /// By channel.
    sensor: [Vector3<f64>; 3],
    scale: [f64; 3],
    play: [f64; 3],
    /// What only adds to readings, with its values.
    pub additions: Vec<(&'a Action, f64)>,
    /// False while nothing else is there.
    pub is_changed: bool,
}

/// What a datum feels.
pub(super) struct Pull {
    /// The load that explains the displacement, but for what is remembered, N.
    pub load: f64,
    /// Displacement along the direction that has nothing to do with the structure, m.
    pub play: f64,
}

impl Default for State<'_> {
    fn default() -> Self {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        State {
            friction: [0.0; 3],
            load_offset: [0.0; 3],
            load_direction: axes,
            softening: Softening::default(),
            per_load_squared: 0.0,
            per_load: 0.0,
            memories: Vec::new(),
            sensor: axes,
            scale: [1.0; 3],
            play: [0.0; 3],
            additions: Vec::new(),
            is_changed: false,
        }
    }
}

impl<'a> State<'a> {
    /// Adds what `action` does at `value`. Turns are done in the order in which they are added.
    pub(super) fn act(&mut self, action: &'a Action, value: f64) {
        self.is_changed |= !action.only_adds();
        match action {
            Action::Friction(axes) => add(&mut self.friction, axes, value),
            Action::LoadOffset(axes) => add(&mut self.load_offset, axes, value),
            Action::TurnLoad(axes, from, towards) => {
                let turn = turn(*from, *towards, value);
                for (direction, _) in self.load_direction.iter_mut().zip(axes).filter(|(_, is_of)| **is_of) {
                    *direction = turn * *direction;
                }
            }
            Action::Stiffness => self.softening.stiffness *= value,
            Action::ShearModulus => self.softening.shear *= value,
            Action::Bend(of_file) => self.softening.bend += value - of_file,
            Action::Joint(joint, of_file) => self.softening.joints.push((*joint, value - of_file)),
            Action::Station(nodes) => nodes.move_joint(&mut self.softening, value),
            Action::PerLoadSquared => self.per_load_squared += value,
            Action::PerLoad => self.per_load += value,
            Action::Memory(memory, _) => self.memories.push((memory, value)),
            Action::SensorScale(channel) => self.scale[channel.index()] *= value,
            Action::TurnSensor(channel, towards) => {
                let sensor = &mut self.sensor[channel.index()];
                *sensor = turn(*channel, *towards, value) * *sensor;
            }
            Action::TurnSensors(from, towards) => {
                let turn = turn(*from, *towards, value);
                self.sensor.iter_mut().for_each(|sensor| *sensor = turn * *sensor);
            }
            Action::Play(axes) => add(&mut self.play, axes, value),
            Action::Shift(_) | Action::Step(..) => self.additions.push((action, value)),
        }
    }

    /// What the load of a datum does, as far as it is the same for every structure, and but for what is remembered.
    pub(super) fn pull(&self, datum: &Datum) -> Pull {
        let (axis, is_unloading) = (datum.direction.axis.index(), datum.is_unloading());
        let is_loaded = datum.load > 0.0;
        let hanging = if is_loaded { datum.load + self.load_offset[axis] } else { 0.0 };
        let friction = self.friction[axis];
        let acting = match is_unloading {
            true => hanging + friction,
            // a slide that holds the whole load leaves nothing, and turns nothing round
            false => hanging.signum() * (hanging.abs() - friction).max(0.0),
        };
        let mut load = acting * (1.0 + self.per_load_squared * acting * acting);
        load *= 1.0 + self.per_load * acting.abs();
        Pull { load, play: if is_loaded { self.play[axis] } else { 0.0 } }
    }

    /// Where a datum's load and its play point to.
    pub(super) fn direction(&self, datum: &Datum) -> Vector3<f64> {
        self.load_direction[datum.direction.axis.index()] * f64::from(datum.direction.sign)
    }

    /// True where the history of loads matters: then data of one case differ.
    pub(super) fn remembers(&self) -> bool {
        !self.memories.is_empty()
    }

    /// The load that explains the displacement of datum number `index`, N, history included; `load` is that without.
    pub(super) fn remembered(&self, load: f64, index: usize) -> f64 {
        let relative =
            |load: f64, (memory, value): &(&Memory, f64)| load * (1.0 + value * memory.relative[index]);
        let lingering = |(memory, value): &(&Memory, f64)| value * memory.lingering[index];
        self.memories.iter().fold(load, relative) + self.memories.iter().map(lingering).sum::<f64>()
    }

    /// What the channel shows when its point is displaced, m.
    pub(super) fn read(&self, channel: Axis, displacement: &Vector3<f64>) -> f64 {
        self.scale[channel.index()] * self.sensor[channel.index()].dot(displacement)
    }
}

fn add(numbers: &mut [f64; 3], axes: &[bool; 3], value: f64) {
    for (number, _) in numbers.iter_mut().zip(axes).filter(|(_, is_of)| **is_of) {
        *number += value;
    }
}

/// By `angle` from one axis towards another one.
fn turn(from: Axis, towards: Axis, angle: f64) -> Rotation3<f64> {
    let unit = |axis: Axis| Vector3::ith(axis.index(), 1.0);
    Rotation3::from_axis_angle(&Unit::new_unchecked(unit(from).cross(&unit(towards))), angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_goes_from_the_first_axis_towards_the_second() {
        for (from, towards) in [(Axis::Y, Axis::Z), (Axis::Z, Axis::Y), (Axis::X, Axis::Z)] {
            let turned = turn(from, towards, 0.1) * Vector3::<f64>::ith(from.index(), 1.0);
            assert!((turned[towards.index()] - 0.1f64.sin()).abs() < 1e-15);
            assert!((turned[from.index()] - 0.1f64.cos()).abs() < 1e-15);
        }
        assert_eq!(turn(Axis::X, Axis::Y, 0.0) * Vector3::x(), Vector3::x());
    }
}
