//! What each parameter of an effect does; how they act together is in `state.rs`.

use std::sync::Arc;

use super::display::Display;
use super::load_history::{History, Memory, Onset};
use super::structure::{Nodes, WhichPipe};
use crate::diagnosis::rig::own_effect::law::OwnLaw;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::spatial::Axis;

/// What one parameter does. The number in brackets is its value where nothing happens.
#[derive(Debug, Clone)]
pub enum Action {
    /// Friction of the slide under these loads, N \[0\].
    Friction(Scope),
    /// Friction of the pulleys of these loads, as a share of each \[0\].
    PulleyFriction(Scope),
    /// Travel over which friction turns round, m \[0\].
    Presliding,
    /// Play of the slider that rubs, on either side, m \[that of the form\].
    SliderPlay,
    /// Added to each of these loads, N \[0\].
    LoadOffset(Scope),
    /// Loads along the axes of the mask turn from the first axis towards the second, rad \[0\].
    TurnLoad([bool; 3], Axis, Axis),
    /// Factor on E and G \[1\].
    Stiffness,
    /// The same of one pipe \[1\].
    StiffnessOf(WhichPipe),
    /// Factor on G \[1\].
    ShearModulus,
    /// Flexibility factor of the bend \[that of the rod file\].
    Bend(f64),
    /// Compliance of the joint of this number, rad/(N·m) \[that of the rod file\].
    Joint(usize, f64),
    /// The same in one session only \[0\].
    JointIn(usize, usize),
    /// Where the joint of these numbers is, m \[its station\]; see [`Nodes`].
    Station(Nodes),
    /// The number of the geometry that is the structure's variation of this number, m or rad \[that
    /// of the file\]; of loads or sensors those along the axes of the mask.
    Varied(usize, [bool; 3]),
    /// k₂, 1/N² \[0\].
    PerLoadSquared,
    /// k₁, 1/N \[0\].
    PerLoad,
    /// Displacement grows with the history of loads \[0\].
    Memory(Memory, History),
    /// How long before the first reading of a run its load was hung, s \[that of the form\]; of
    /// creep alone.
    Onset(Onset),
    /// Factor on a channel \[1\].
    SensorScale(Axis),
    /// The channel turns from its own axis towards another one, rad \[0\].
    TurnSensor(Axis, Axis),
    /// All channels turn, as one block, from the first axis towards the second, rad \[0\].
    TurnSensors(Axis, Axis),
    /// Play of the clamp under these loads, m \[0\].
    Play(Scope),
    /// Play of a display, m, or the share of a change that it does not show yet \[0\].
    Display(Arc<Display>),
    /// Adds to readings \[0\].
    Shift(Weights),
    /// The same of a channel, in the course of a recording \[0\].
    Drift(Axis, DriftPer, Weights),
    /// Adds to the readings of this sequence of data, from one of them on \[0\].
    Step(Arc<[usize]>, usize),
    /// The parameter of this number of a lab's own effect, which adds to readings \[its own\].
    Own(Arc<OwnLaw>, usize),
}

/// What a drift is counted by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriftPer {
    Kelvin,
    Hour,
    /// From the first reading to the last.
    Recording,
}

/// What is added to readings per unit of a parameter.
#[derive(Debug, Clone)]
pub struct Weights {
    /// Indices of the data, which several of them may share: recordings are long, and curves many.
    pub data: Arc<[usize]>,
    /// For each of these its weight.
    pub values: Vec<f64>,
}

impl Weights {
    /// Index and weight of each datum.
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.data.iter().copied().zip(self.values.iter().copied())
    }
}

impl FromIterator<(usize, f64)> for Weights {
    fn from_iter<T: IntoIterator<Item = (usize, f64)>>(weights: T) -> Self {
        let (data, values): (Vec<usize>, Vec<f64>) = weights.into_iter().unzip();
        Weights { data: data.into(), values }
    }
}

/// What is added to readings.
pub enum Addition<'a> {
    /// The parameter times these.
    Weights(&'a Weights),
    /// The parameter, to each of this sequence of data, from one of them on.
    Constant(&'a Arc<[usize]>, usize),
    /// By which a display is late.
    Display(&'a Display),
    /// What the parameter of this number of a lab's own effect adds, together with all others of
    /// that effect.
    Own(&'a OwnLaw, usize),
}

impl Action {
    /// True for what makes the rod another one.
    pub fn changes_the_rod(&self) -> bool {
        matches!(
            self,
            Action::Stiffness
                | Action::StiffnessOf(_)
                | Action::ShearModulus
                | Action::Bend(_)
                | Action::Joint(..)
                | Action::JointIn(..)
                | Action::Station(_)
                | Action::Varied(..)
                | Action::PerLoad
                | Action::PerLoadSquared
        )
    }

    /// True for what turns loads or readings against the rod.
    pub fn turns(&self) -> bool {
        matches!(self, Action::TurnLoad(..) | Action::TurnSensor(..) | Action::TurnSensors(..))
    }

    /// What it adds to readings; `None` for what changes how a load becomes a reading.
    pub fn addition(&self) -> Option<Addition<'_>> {
        match self {
            Action::Shift(weights) | Action::Drift(_, _, weights) => Some(Addition::Weights(weights)),
            Action::Step(data, from) => Some(Addition::Constant(data, *from)),
            Action::Display(display) => Some(Addition::Display(display)),
            Action::Own(law, number) => Some(Addition::Own(law, *number)),
            Action::Friction(_)
            | Action::PulleyFriction(_)
            | Action::Presliding
            | Action::SliderPlay
            | Action::LoadOffset(_)
            | Action::TurnLoad(..)
            | Action::Stiffness
            | Action::StiffnessOf(_)
            | Action::ShearModulus
            | Action::Bend(_)
            | Action::Joint(..)
            | Action::JointIn(..)
            | Action::Station(_)
            | Action::Varied(..)
            | Action::PerLoadSquared
            | Action::PerLoad
            | Action::Memory(..)
            | Action::Onset(_)
            | Action::SensorScale(_)
            | Action::TurnSensor(..)
            | Action::TurnSensors(..)
            | Action::Play(_) => None,
        }
    }

    /// True for a parameter that does nothing where the first of its effect does nothing.
    pub fn is_dependent(&self) -> bool {
        match self {
            Action::Onset(_) | Action::Presliding | Action::SliderPlay => true,
            Action::Own(_, number) => *number > 0,
            Action::Friction(_)
            | Action::PulleyFriction(_)
            | Action::LoadOffset(_)
            | Action::TurnLoad(..)
            | Action::Stiffness
            | Action::StiffnessOf(_)
            | Action::ShearModulus
            | Action::Bend(_)
            | Action::Joint(..)
            | Action::JointIn(..)
            | Action::Station(_)
            | Action::Varied(..)
            | Action::PerLoadSquared
            | Action::PerLoad
            | Action::Memory(..)
            | Action::SensorScale(_)
            | Action::TurnSensor(..)
            | Action::TurnSensors(..)
            | Action::Play(_)
            | Action::Display(_)
            | Action::Shift(_)
            | Action::Drift(..)
            | Action::Step(..) => false,
        }
    }

    /// True for what adds to the readings whatever else there is.
    pub fn only_adds(&self) -> bool {
        matches!(self.addition(), Some(Addition::Weights(_) | Addition::Constant(..)))
    }

    /// True for a gap that an imposed displacement crosses.
    pub fn is_play(&self) -> bool {
        matches!(self, Action::Play(_) | Action::SliderPlay | Action::Presliding)
    }

    /// Which parameter of a lab's own effect it is.
    pub fn number_of_own(&self) -> Option<usize> {
        match self.addition()? {
            Addition::Own(_, number) => Some(number),
            Addition::Weights(_) | Addition::Constant(..) | Addition::Display(_) => None,
        }
    }

    /// Adds what it does at `value` to readings, m; nothing of a lab's own effect, whose parameters
    /// act together.
    pub fn add_to(&self, readings: &mut [f64], value: f64) {
        match self.addition() {
            Some(Addition::Weights(weights)) => {
                weights.iter().for_each(|(i, weight)| readings[i] += weight * value);
            }
            Some(Addition::Constant(data, from)) => {
                data.iter().skip(from).for_each(|&i| readings[i] += value);
            }
            Some(Addition::Display(display)) => display.add_to(readings, value),
            Some(Addition::Own(..)) | None => {}
        }
    }

    /// The largest that it adds to a reading per unit of its parameter.
    pub fn largest_addition(&self) -> Option<f64> {
        match self.addition()? {
            Addition::Weights(weights) => {
                Some(weights.values.iter().fold(0.0, |most: f64, weight| most.max(weight.abs())))
            }
            Addition::Constant(data, from) => Some(if from < data.len() { 1.0 } else { 0.0 }),
            Addition::Display(_) | Addition::Own(..) => None,
        }
    }
}

/// Which loads something acts under: those along some axes, in one session or in all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scope {
    pub axes: [bool; 3],
    pub session: Option<usize>,
}

impl Scope {
    pub fn holds(&self, datum: &Datum) -> bool {
        self.axes[datum.direction.axis.index()]
            && self.session.is_none_or(|session| session == datum.session_number)
    }
}
