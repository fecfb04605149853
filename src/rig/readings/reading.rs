//! One reading: a load along an axis of {T}, and the offsets that it caused.

pub use crate::spatial::{Axis, Direction};

/// One row: a load and the offsets that it caused.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Reading {
    /// Direction of the load in {T}.
    pub direction: Direction,
    /// Magnitude of the load, N, ≥ 0.
    pub load: f64,
    /// Offset of the tip (or of the read station) along X, Y, Z of {T}, m; `None`: not measured.
    /// One is there.
    pub offset: [Option<f64>; 3],
    /// Name or number of the repeat.
    pub trial: Option<String>,
    /// Whether the load was reached by loading or by unloading.
    pub phase: Option<Phase>,
    /// Time of the reading, s, from any zero.
    pub time: Option<f64>,
    /// Temperature, °C.
    pub temperature: Option<f64>,
    /// Arc length from the flange to the load, m; `None`: the tip.
    pub load_station: Option<f64>,
    /// Arc length from the flange to the sensor, m; `None`: the tip.
    pub read_station: Option<f64>,
    /// Name or number of the session: the rod was mounted anew in each.
    pub session: Option<String>,
    /// Time at which this load was hung, s, on the clock of `time`.
    pub loaded_at: Option<f64>,
    /// Line in the file, from 1.
    pub line: usize,
}

/// On the way up or down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Phase {
    /// The load was raised to this one.
    Load,
    /// The load was lowered to this one.
    Unload,
}

impl Reading {
    /// A load at the tip (N, a magnitude) without an offset so far.
    pub fn new(direction: Direction, load: f64) -> Reading {
        Reading {
            direction,
            load,
            offset: [None; 3],
            trial: None,
            phase: None,
            time: None,
            temperature: None,
            load_station: None,
            read_station: None,
            session: None,
            loaded_at: None,
            line: 0,
        }
    }

    /// With an offset (m) along an axis of {T}.
    pub fn with_offset(mut self, axis: Axis, offset: f64) -> Reading {
        self.offset[axis.index()] = Some(offset);
        self
    }

    /// As a repeat of that name.
    pub fn with_trial(self, trial: impl Into<String>) -> Reading {
        Reading { trial: Some(trial.into()), ..self }
    }

    /// Of that session.
    pub fn with_session(self, session: impl Into<String>) -> Reading {
        Reading { session: Some(session.into()), ..self }
    }

    /// The load along the positive axis, N: its magnitude with the sign of its direction.
    pub fn signed_load(&self) -> f64 {
        f64::from(self.direction.sign) * self.load
    }
}

/// A load for a message, to a millinewton: `5 N`, not `5.00000 N`.
pub(super) fn newtons(load: f64) -> String {
    format!("{} N", (load * 1e3).round() / 1e3)
}

/// The signed loads of the readings in which `channel` was read under a load along `axis`, N.
pub(super) fn loads_of(rows: &[Reading], axis: Axis, channel: Axis) -> impl Iterator<Item = f64> {
    rows.iter()
        .filter(move |r| r.direction.axis == axis && r.offset[channel.index()].is_some())
        .map(Reading::signed_load)
}

/// The one load of an (axis, channel), N; `None` where there are more, or none at all.
pub(super) fn only_load(rows: &[Reading], axis: Axis, channel: Axis) -> Option<f64> {
    let mut loads = loads_of(rows, axis, channel);
    let first = loads.next()?;
    loads.all(|load| load == first).then_some(first)
}
