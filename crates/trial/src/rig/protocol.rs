//! What was done at the rig: the loadings in their order, what was read, and how it is written
//! down.

use std::fmt::Write;

use super::drawing::rounded;
use crate::place::Place;
use rodcal_base::units::{MM, STANDARD_GRAVITY, UM};

/// Names of the axes of {T}, and of the channels along them.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// One loading.
#[derive(Debug, Clone, PartialEq)]
pub struct Loading {
    /// Axis of {T} along which the load pulls, 0 to 2.
    pub axis: usize,
    /// +1 along, −1 against it.
    pub sign: f64,
    /// Nominal load, N.
    pub load: f64,
    /// Number of the trial, from 0.
    pub trial: usize,
    /// Number of the run, one trial along one axis, from 0.
    pub run: usize,
    /// True on the way down.
    pub is_unloading: bool,
    /// When the load came to hang, s.
    pub changed: f64,
    /// When the display was read, s.
    pub time: f64,
    /// When the run was zeroed, s.
    pub zeroed: f64,
    /// Where the load hangs and the sensor stands, m from the flange.
    pub stations: [f64; 2],
}

impl Loading {
    /// True of a loading along this axis; `None` is any.
    pub fn is_along(&self, axis: Option<usize>) -> bool {
        axis.is_none_or(|axis| axis == self.axis)
    }
}

/// One load of a run, N, and whether it hangs on the way down.
pub type Step = (f64, bool);

/// Up, and down again where that is read too, but for the largest load: it hangs already.
pub fn steps(loads: &[f64], has_unloading: bool) -> Vec<Step> {
    let up = loads.iter().map(|load| (*load, false));
    let down = loads.iter().rev().skip(1).filter(|_| has_unloading).map(|load| (*load, true));
    up.chain(down).collect()
}

/// What the loadings of one run along one way of an axis have in common; as in [`Loading`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs, reason = "its fields are those of a loading")]
pub struct Run {
    pub axis: usize,
    pub sign: f64,
    pub trial: usize,
    pub run: usize,
    pub zeroed: f64,
    pub stations: [f64; 2],
}

impl Run {
    /// A step that was hung at `changed` and read at `time`, s.
    pub fn loading(&self, (load, is_unloading): Step, changed: f64, time: f64) -> Loading {
        let Run { axis, sign, trial, run, zeroed, stations } = *self;
        Loading { axis, sign, load, trial, run, is_unloading, changed, time, zeroed, stations }
    }
}

/// What is at a station: loads or sensors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Where loads act.
    Load,
    /// Where sensors read.
    Reading,
}

/// A recording before anything is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Protocol {
    /// In the order of the file.
    pub loadings: Vec<Loading>,
    /// By loading: which channels are read.
    pub channels: Vec<[bool; 3]>,
    /// The tip's station, m.
    pub tip: f64,
    /// The room: temperature at time 0 °C, rate K/s, amplitude K and period s of a swing.
    pub room: [f64; 4],
    /// Step of the display, m.
    pub quantum: f64,
    /// The sensors are zeroed once, before the first run, instead of before each.
    pub zeroed_once: bool,
    /// The loads of a run hang in any order, each on an empty hanger.
    pub is_shuffled: bool,
    /// Which optional columns the file has.
    pub columns: Columns,
}

/// The optional columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are those of the columns")]
pub struct Columns {
    pub trial: bool,
    pub phase: bool,
    pub time: bool,
    pub temperature: bool,
    /// `load_kg` instead of `load_n`.
    pub kilograms: bool,
}

/// One number in the file: its loading and its channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cell {
    /// Index of the loading.
    pub loading: usize,
    /// Channel, 0 to 2.
    pub channel: usize,
}

impl Protocol {
    /// Everything that is read, in the order of the file.
    pub fn cells(&self) -> Vec<Cell> {
        let of_loading = |(loading, read): (usize, &[bool; 3])| {
            let read = *read;
            (0..3).filter(move |&channel| read[channel]).map(move |channel| Cell { loading, channel })
        };
        self.channels.iter().enumerate().flat_map(of_loading).collect()
    }

    /// Temperature of the room, °C.
    pub fn temperature(&self, time: f64) -> f64 {
        let [start, rate, swing, period] = self.room;
        start + rate * time + swing * (std::f64::consts::TAU * time / period).sin()
    }

    /// The largest nominal load, N.
    pub fn largest_load(&self) -> f64 {
        self.loadings.iter().fold(0.0, |largest, l| largest.max(l.load))
    }

    /// The smallest nominal load above zero, N.
    pub fn smallest_load(&self) -> f64 {
        let loads = self.loadings.iter().map(|l| l.load).filter(|load| *load > 0.0);
        loads.fold(f64::INFINITY, f64::min)
    }

    /// Axes along which loads pull.
    pub fn axes(&self) -> Vec<usize> {
        (0..3).filter(|&axis| self.loadings.iter().any(|l| l.axis == axis)).collect()
    }

    /// Channels that are read.
    pub fn read_channels(&self) -> Vec<usize> {
        (0..3).filter(|&channel| self.channels.iter().any(|read| read[channel])).collect()
    }

    /// Stations that the file states, m: all but the tip, each once.
    pub fn stations(&self) -> Vec<f64> {
        let mut stations: Vec<f64> = self.loadings.iter().flat_map(|l| l.stations).collect();
        stations.retain(|station| *station != self.tip);
        stations.sort_by(f64::total_cmp);
        stations.dedup();
        stations
    }

    /// Where loads act, or sensors read, m from the flange: each station once.
    pub fn stations_of(&self, end: End) -> Vec<f64> {
        let mut stations: Vec<f64> =
            self.loadings.iter().map(|loading| loading.stations[end as usize]).collect();
        stations.sort_by(f64::total_cmp);
        stations.dedup();
        stations
    }

    /// The run of a loading: its axis and its trial, its number where trials have no name, or
    /// nothing more where there is only one.
    pub fn run_place(&self, loading: usize) -> Place {
        let Some(own) = self.loadings.get(loading) else { return Place::default() };
        let is_only = self.loadings.iter().all(|l| l.axis != own.axis || l.run == own.run);
        let place = Place::default().loads_along(AXES[own.axis]);
        match (self.columns.trial, is_only) {
            (true, _) => Place { trial: Some((own.trial + 1).to_string()), ..place },
            (false, true) => place,
            (false, false) => Place { run: Some(own.trial + 1), ..place },
        }
    }

    /// One number of the file.
    pub fn cell_place(&self, index: usize) -> Place {
        self.cells().get(index).map_or_else(Place::default, |cell| Place {
            row: Some(cell.loading + 1),
            channel: Some(format!("d{}", AXES[cell.channel])),
            ..Place::default()
        })
    }

    /// As in the file: blank at the tip.
    fn station(&self, station: f64) -> String {
        if station == self.tip { String::new() } else { rounded(station / MM, 4).to_string() }
    }

    /// The file, with what the display showed in each cell, m.
    pub fn csv(&self, shown: &[f64]) -> String {
        self.table("# SIMULATED readings of a concealed-effect trial, not a recording.", shown)
    }

    /// The same below a line of its own.
    pub fn table(&self, above: &str, shown: &[f64]) -> String {
        let channels = self.read_channels();
        let has_station = [0, 1].map(|k| self.loadings.iter().any(|l| l.stations[k] != self.tip));
        let mut text = format!("{above}\n");
        let mut names = vec!["axis", if self.columns.kilograms { "load_kg" } else { "load_n" }];
        let optional = [
            (self.columns.trial, "trial"),
            (self.columns.phase, "phase"),
            (self.columns.time, "time_s"),
            (self.columns.temperature, "temperature_c"),
            (has_station[0], "load_station_mm"),
            (has_station[1], "read_station_mm"),
        ];
        names.extend(optional.iter().filter(|(is_there, _)| *is_there).map(|(_, name)| *name));
        names.extend(channels.iter().map(|&channel| ["dx_um", "dy_um", "dz_um"][channel]));
        text += &names.join(",");
        text.push('\n');
        let mut shown = shown.iter();
        for (loading, read) in self.loadings.iter().zip(&self.channels) {
            let sign = if loading.sign < 0.0 { "-" } else { "" };
            let load = if self.columns.kilograms { loading.load / STANDARD_GRAVITY } else { loading.load };
            let _ = write!(text, "{sign}{},{}", AXES[loading.axis], rounded(load, 6));
            let cells = [
                (loading.trial + 1).to_string(),
                if loading.is_unloading { "unload" } else { "load" }.to_owned(),
                rounded(loading.time, 1).to_string(),
                rounded(self.temperature(loading.time), 2).to_string(),
                self.station(loading.stations[0]),
                self.station(loading.stations[1]),
            ];
            for (cell, (is_there, _)) in cells.iter().zip(optional) {
                if is_there {
                    let _ = write!(text, ",{cell}");
                }
            }
            for &channel in &channels {
                text.push(',');
                if read[channel]
                    && let Some(value) = shown.next()
                {
                    let _ = write!(text, "{}", rounded(value / UM, 4));
                }
            }
            text.push('\n');
        }
        text
    }
}
