//! How effects act together: load, structure, reading.
//!
//! ```text
//! load       F = m·d    m = nominal + offset, less friction on the way up (not below zero), more on the way down
//!                       (not more than was felt at the turn); friction f + μ·(nominal + offset)
//!                       d = nominal direction, turned
//! structure  u = C·d·(m·(1 + k₂m²)(1 + k₁|m|)Π(1 + v·w) + Σ v·W)     C by the structure; w, W by the history of loads
//! reading    y = s·e·(u + play·d) + shifts                            e = channel, turned; s its scale
//! ```
//!
//! A load of zero is an unloaded rod: nothing hangs there, so there is no offset, no play and, on
//! the way up, no friction. Where the direction of motion stands for a phase, friction and play
//! follow the course of the run (`slide.rs`).
//!
//! Under an imposed displacement the same chain is solved for the load that was measured:
//!
//! ```text
//! F = φ(x/C)·Π(1 − v·w) − Σ v·W·(c₀/C) + friction·z − offset     φ(1 + k₂φ²)(1 + k₁|φ|) = x/C
//! 1 − v·w of creep, which is relaxation here; 1/(1 + v·w) of all else
//! ```

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use nalgebra::{Rotation3, Unit, Vector3};

use super::action::{Action, Scope};
use super::load_history::{Clock, History, Memory};
use super::slide::{Course, Hung, Met, Slide};
use super::structure::{Softening, Variant};
use crate::diagnosis::rig::own_effect::law::OwnLaw;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::spatial::Axis;

/// A number that is added up of all that act on a datum.
#[derive(Default)]
struct Scoped(Vec<(Scope, f64)>);

impl Scoped {
    fn on(&self, datum: &Datum) -> f64 {
        self.0.iter().filter(|(scope, _)| scope.holds(datum)).map(|(_, value)| value).sum()
    }
}

/// A rig with all that is wrong with it.
pub struct State<'a> {
    friction: Scoped,
    /// Share of each load.
    pulley_friction: Scoped,
    presliding: f64,
    slider_play: f64,
    load_offset: Scoped,
    /// By axis: what a load along its positive direction is directed to.
    load_direction: [Vector3<f64>; 3],
    pub softening: Softening,
    per_load_squared: f64,
    per_load: f64,
    /// With which law they follow.
    memories: Vec<(&'a Memory, History, f64)>,
    /// What the onsets of creep add to w: for each datum up to the last that one of them changes.
    earlier: Cow<'a, [f64]>,
    /// By channel.
    sensor: [Vector3<f64>; 3],
    scale: [f64; 3],
    play: Scoped,
    /// Joints that are compliant in one session: session, number of the joint, rad/(N·m).
    pub of_sessions: Vec<(usize, usize, f64)>,
    /// Parameters of a lab's own effects, those of one effect together.
    own: Vec<(&'a Arc<OwnLaw>, usize, f64)>,
    /// What only adds to readings, with its values.
    pub additions: Vec<(&'a Action, f64)>,
    /// False while nothing else is there.
    pub is_changed: bool,
}

/// What a datum feels.
pub struct Pull {
    /// Where the load and the play point to.
    pub direction: Vector3<f64>,
    /// The load that explains the displacement, N.
    pub load: f64,
    /// Displacement along the direction that has nothing to do with the structure, m.
    pub play: f64,
}

impl Default for State<'_> {
    fn default() -> Self {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        State {
            friction: Scoped::default(),
            pulley_friction: Scoped::default(),
            presliding: 0.0,
            slider_play: 0.0,
            load_offset: Scoped::default(),
            load_direction: axes,
            softening: Softening::default(),
            per_load_squared: 0.0,
            per_load: 0.0,
            memories: Vec::new(),
            earlier: Cow::default(),
            sensor: axes,
            scale: [1.0; 3],
            play: Scoped::default(),
            of_sessions: Vec::new(),
            own: Vec::new(),
            additions: Vec::new(),
            is_changed: false,
        }
    }
}

impl<'a> State<'a> {
    /// What onsets of creep add to w, to be borrowed by states that differ in something else.
    pub fn earlier(&self) -> &[f64] {
        &self.earlier
    }

    /// The same state with what onsets add to w.
    pub fn with_earlier(self, earlier: Cow<'a, [f64]>) -> Self {
        State { earlier, ..self }
    }

    /// Adds what `action` does at `value`. Turns are done in the order in which they are added.
    pub fn act(&mut self, action: &'a Action, value: f64) {
        self.is_changed |= !action.only_adds() && !matches!(action, Action::Own(..) | Action::Display(_));
        match action {
            Action::Friction(scope) => self.friction.0.push((*scope, value)),
            Action::PulleyFriction(scope) => self.pulley_friction.0.push((*scope, value)),
            Action::Presliding => self.presliding += value,
            Action::SliderPlay => self.slider_play += value,
            Action::LoadOffset(scope) => self.load_offset.0.push((*scope, value)),
            Action::TurnLoad(axes, from, towards) => {
                let turn = turn(*from, *towards, value);
                for (direction, _) in
                    self.load_direction.iter_mut().zip(axes).filter(|(_, is_turned)| **is_turned)
                {
                    *direction = turn * *direction;
                }
            }
            Action::Stiffness => self.softening.stiffness *= value,
            Action::StiffnessOf(pipe) => self.softening.pipes[*pipe as usize] *= value,
            Action::ShearModulus => self.softening.shear *= value,
            Action::Bend(of_file) => self.softening.bend += value - of_file,
            Action::Joint(joint, of_file) => self.softening.joints.push((*joint, value - of_file)),
            Action::JointIn(session, joint) => self.of_sessions.push((*session, *joint, value)),
            Action::Varied(variation, axes) => {
                self.softening.variants.push(Variant { variation: *variation, value, axes: *axes });
            }
            Action::Station(nodes) => nodes.move_joint(&mut self.softening, value),
            Action::PerLoadSquared => self.per_load_squared += value,
            Action::PerLoad => self.per_load += value,
            Action::Memory(memory, history) => self.memories.push((memory, *history, value)),
            Action::Onset(onset) => onset.add_to(self.earlier.to_mut(), value),
            Action::SensorScale(channel) => self.scale[channel.index()] *= value,
            Action::TurnSensor(channel, towards) => {
                let sensor = &mut self.sensor[channel.index()];
                *sensor = turn(*channel, *towards, value) * *sensor;
            }
            Action::TurnSensors(from, towards) => {
                let turn = turn(*from, *towards, value);
                self.sensor.iter_mut().for_each(|sensor| *sensor = turn * *sensor);
            }
            Action::Play(scope) => self.play.0.push((*scope, value)),
            Action::Own(law, k) => self.own.push((law, *k, value)),
            Action::Shift(_) | Action::Drift(..) | Action::Step(..) | Action::Display(_) => {
                self.additions.push((action, value));
            }
        }
    }

    /// What the load of each datum does, as far as it is the same for every structure.
    pub fn pulls(&self, data: &[Datum], course: &Course) -> Vec<Pull> {
        let mut pulls: Vec<Pull> =
            data.iter().enumerate().map(|(i, datum)| self.pull(i, datum, None)).collect();
        for run in &course.hung {
            let mut hung = Hung::default();
            for instant in run {
                let first = &data[instant[0]];
                let sign = f64::from(first.direction.sign);
                let hanging = self.hanging(first);
                hung = hung.next(sign * hanging, self.friction_under(first, hanging));
                for &i in instant {
                    pulls[i] = self.pull(i, &data[i], Some(hung));
                }
            }
        }
        pulls
    }

    /// What a load along the positive axis of a datum's load is directed to.
    pub fn along(&self, datum: &Datum) -> Vector3<f64> {
        self.load_direction[datum.direction.axis.index()]
    }

    /// Beside an imposed displacement the rod is bent by what its friction leaves of the measured
    /// load, F + f₀ − f·z.
    pub fn pull_beside(&self, pulls: &mut [Pull], data: &[Datum], course: &Course, met: &[(usize, Met)]) {
        let met: HashMap<usize, Met> = met.iter().copied().collect();
        for &(i, imposed) in &course.beside {
            let (datum, Some(met)) = (&data[i], met.get(&imposed)) else { continue };
            let friction = self.friction.on(datum) * met.contact * met.friction;
            let force = datum.signed_load() + self.load_offset.on(datum) - friction;
            pulls[i] = self.pull(i, datum, Some(Hung { force, side: 0.0 }));
        }
    }

    /// Adds what a lab's own effects do to readings, m.
    pub fn add_own(&self, readings: &mut [f64]) {
        for of_one in self.own.chunk_by(|a, b| Arc::ptr_eq(a.0, b.0)) {
            of_one[0].0.add_to(readings, of_one.iter().map(|(_, k, value)| (*k, *value)), 1.0);
        }
    }

    /// Adds what is left of the loads of other runs, Σ v·D/(1 + v·w̄), m.
    pub fn add_recovery(&self, readings: &mut [f64]) {
        for (memory, _, value) in &self.memories {
            let share = memory.recovered(*value);
            readings.iter_mut().zip(&memory.recovery).for_each(|(reading, left)| *reading += share * left);
        }
    }

    fn hanging(&self, datum: &Datum) -> f64 {
        if datum.load > 0.0 { datum.load + self.load_offset.on(datum) } else { 0.0 }
    }

    /// What resists where so much hangs, N: f + μ·m.
    fn friction_under(&self, datum: &Datum, hanging: f64) -> f64 {
        self.friction.on(datum) + self.pulley_friction.on(datum) * hanging.abs()
    }

    /// Of one datum; `hung` where its course is known.
    fn pull(&self, index: usize, datum: &Datum, hung: Option<Hung>) -> Pull {
        let bare = self.bare(datum, hung);
        Pull { load: self.with_history(bare.load, index), ..bare }
    }

    /// True where the history of loads matters.
    pub fn remembers(&self) -> bool {
        !self.memories.is_empty()
    }

    /// The load that explains the displacement of datum number `index`, N, history included; `load`
    /// is that without.
    pub fn with_history(&self, load: f64, index: usize) -> f64 {
        load * self.remembered(index) + self.lingering(index)
    }

    /// Of one datum, without history.
    pub fn bare(&self, datum: &Datum, hung: Option<Hung>) -> Pull {
        let (axis, sign) = (datum.direction.axis.index(), f64::from(datum.direction.sign));
        let hanging = self.hanging(datum);
        let friction = self.friction_under(datum, hanging);
        let acting = match hung {
            Some(hung) => sign * hung.force,
            // a slide that turns round holds no more than was felt before
            None if datum.is_unloading() => {
                let peak = datum.peak + self.load_offset.on(datum);
                let felt = (peak - self.friction_under(datum, peak)).max(0.0);
                (hanging + friction).min(felt)
            }
            // a slide that holds the whole load leaves nothing, and turns nothing round
            None => hanging.signum() * (hanging.abs() - friction).max(0.0),
        };
        let mut load = acting * (1.0 + self.per_load_squared * acting * acting);
        load *= 1.0 + self.per_load * acting.abs();
        let side = hung.map_or(if datum.load > 0.0 { 1.0 } else { 0.0 }, |hung| sign * hung.side);
        Pull { direction: self.load_direction[axis] * sign, load, play: side * self.play.on(datum) }
    }

    /// Π(1 + v·w).
    fn remembered(&self, index: usize) -> f64 {
        self.memories.iter().map(|memory| 1.0 + self.growth(index, memory)).product()
    }

    /// The share of the load that is left under a held displacement: 1 − v·w of what relaxes,
    /// 1/(1 + v·w) of all else.
    fn relaxed(&self, index: usize) -> f64 {
        let factor = |memory: &(&Memory, History, f64)| match memory.1 {
            History::Creep(..) => 1.0 - self.growth(index, memory),
            _ => 1.0 / (1.0 + self.growth(index, memory)),
        };
        self.memories.iter().map(factor).product()
    }

    /// v·w.
    fn growth(&self, index: usize, (memory, history, value): &(&Memory, History, f64)) -> f64 {
        let earlier: f64 = match history {
            History::Creep(Clock::UnknownOnset, _) => self.earlier.get(index).copied().unwrap_or(0.0),
            _ => 0.0,
        };
        value * (memory.relative[index] + earlier)
    }

    /// Σ v·W, N.
    fn lingering(&self, index: usize) -> f64 {
        self.memories.iter().map(|(memory, _, value)| value * memory.lingering[index]).sum()
    }

    /// What each imposed displacement meets, by its datum; `compliance` of a datum (m/N) is that
    /// along its load.
    pub fn met(
        &self,
        data: &[Datum],
        course: &Course,
        step: f64,
        compliance: &dyn Fn(usize) -> f64,
    ) -> Vec<(usize, Met)> {
        let mut all = Vec::new();
        for line in &course.imposed {
            let mut met = Met::default();
            for &i in line {
                let datum = &data[i];
                let play = self.play.on(datum).max(0.0);
                let held = (self.friction.on(datum) * compliance(i)).abs();
                let (slider_play, presliding) = (self.slider_play.max(0.0), self.presliding.max(0.0));
                let slide = Slide { play, slider_play, presliding, held, step };
                let direction = datum.motion.map_or(0.0, |motion| motion.direction);
                met = slide.next(met, datum.drive_as_read(), direction);
                all.push((i, met));
            }
        }
        all
    }

    /// The load (N, along the positive axis) that is measured where the rod is bent by `x` (m) of
    /// this compliance (m/N).
    pub fn measured_load(&self, index: usize, datum: &Datum, met: &Met, compliance: f64) -> f64 {
        let per_newton = datum.imposed.map_or(compliance, |imposed| imposed.per_newton);
        let linear = met.rod / compliance;
        let lingering = self.lingering(index) * f64::from(datum.direction.sign) * per_newton / compliance;
        let elastic = self.without_curvature(linear) * self.relaxed(index) - lingering;
        // a load cell's zero does not know which way the load pulls
        let tare = self.load_offset.on(datum);
        met.contact * (elastic + self.friction.on(datum) * met.friction) - tare
    }

    /// The load φ with φ(1 + k₂φ²)(1 + k₁|φ|) = F, by Newton's method from F.
    fn without_curvature(&self, load: f64) -> f64 {
        let (k1, k2) = (self.per_load, self.per_load_squared);
        if k1 == 0.0 && k2 == 0.0 {
            return load;
        }
        let mut size = load.abs();
        for _ in 0..8 {
            let value = size * (1.0 + k2 * size * size) * (1.0 + k1 * size) - load.abs();
            let slope =
                (1.0 + 3.0 * k2 * size * size) * (1.0 + k1 * size) + size * (1.0 + k2 * size * size) * k1;
            if slope <= 0.1 {
                break;
            }
            size = (size - value / slope).max(0.0);
        }
        size * load.signum()
    }

    /// What the channel shows when its point is displaced, m.
    pub fn read(&self, channel: Axis, displacement: &Vector3<f64>) -> f64 {
        self.scale[channel.index()] * self.sensor[channel.index()].dot(displacement)
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
