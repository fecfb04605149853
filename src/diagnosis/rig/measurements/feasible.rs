//! Measurements that a rig can make: other axes, loads, stations, unloading, waiting.

use crate::inference::LoadPlan;
use crate::rig::readings::{Axis, Direction, Driven, Phase, Reading, Readings};
use crate::rod::Rod;
use crate::units::MM;

/// Repeats of a proposed measurement, each from a new zero.
const REPEATS: usize = 3;
/// Time between two readings, s.
const STEP: f64 = 30.0;
/// Times after which a load that is left hanging is read, s.
const WAITS: [f64; 4] = [0.0, 60.0, 600.0, 3600.0];

/// Something that could be measured next.
#[derive(Debug, Clone)]
pub struct Measurement {
    /// What to do once: `Load the tip along z with 5, 10 and 15 N`.
    pub task: String,
    /// The same as numbers.
    pub plan: LoadPlan,
    /// A few of the present readings, so that nothing that they show is forgotten, then those to
    /// come; these have offsets of a straight line.
    pub readings: Readings,
    /// How many rows are present ones.
    pub known_rows: usize,
    has_rod: bool,
}

impl Measurement {
    /// What to do, how often, and what to read; a full sentence.
    pub fn description(&self) -> String {
        let task = &self.task;
        // waiting takes long enough once
        let is_waiting = self.plan.waits.iter().any(|wait| *wait > 0.0);
        let repeats = if is_waiting { "" } else { ", three times, each from a new zero" };
        let channels = if self.has_rod { "dx, dy and dz" } else { "the offset" };
        format!("{task}{repeats}; read {channels}.")
    }
}

/// What is hung and read, one after the other.
#[derive(Debug, Clone, Copy)]
struct Step {
    load: f64,
    phase: Phase,
    /// Since the load was hung, s.
    waited: f64,
}

/// All that could be measured, the simplest first.
pub fn feasible(readings: &Readings, rod: Option<&Rod>) -> Vec<Measurement> {
    let rig = Rig::new(readings, rod);
    let mut all = Vec::new();
    for axis in rig.axes() {
        let levels = rig.levels(axis);
        let (list, largest) = (newtons(&levels), levels.last().copied().unwrap_or_default());
        let up = |loads: &[f64]| rig.at_tip(axis, loads);
        let tip = |axis: &str, list: &str| rig.loading("the tip", axis, list);
        let along = axis.to_string();
        all.push((tip(&along, &list), up(&levels)));
        all.push((
            format!("{}, and read again at the same loads while unloading", tip(&along, &list)),
            LoadPlan { unloading: true, ..up(&levels) },
        ));
        all.push((
            format!("{}, against the direction of the others", tip(&format!("-{axis}"), &list)),
            LoadPlan { direction: Direction { axis, sign: -1 }, ..up(&levels) },
        ));
        let small = [0.05, 0.1, 0.2].map(|share| share * largest);
        all.push((format!("{}, small loads", tip(&along, &newtons(&small))), up(&small)));
        let double = [largest, 1.5 * largest, 2.0 * largest];
        all.push((
            format!("{}, if the rod and the rig bear it", tip(&along, &newtons(&double))),
            up(&double),
        ));
        all.push((
            format!(
                "{} and read at once and after 1, 10 and 60 minutes, {}",
                tip(&along, &newton(largest)),
                rig.untouched()
            ),
            // waiting takes long enough once
            LoadPlan { waits: WAITS.to_vec(), repeats: 1, ..up(&[largest]) },
        ));
        for &station in &rig.stations {
            let mm = format!("{:.0}", station / MM);
            all.push((
                format!(
                    "{} instead of the tip",
                    rig.loading(&format!("the rod at station {mm} mm"), &along, &list)
                ),
                LoadPlan { load_station: Some(station), ..up(&levels) },
            ));
            all.push((
                format!("{}, with the sensors at station {mm} mm", tip(&along, &list)),
                LoadPlan { read_station: Some(station), ..up(&levels) },
            ));
        }
    }
    all.into_iter().map(|(task, plan)| rig.measurement(task, plan)).collect()
}

/// One pass of a plan.
fn steps(plan: &LoadPlan) -> Vec<Step> {
    let at_each =
        |phase: Phase| move |&load: &f64| plan.waits.iter().map(move |&waited| Step { load, phase, waited });
    let mut steps: Vec<Step> = plan.loads.iter().flat_map(at_each(Phase::Load)).collect();
    if plan.unloading {
        steps.extend(plan.loads.iter().rev().skip(1).flat_map(at_each(Phase::Unload)));
    }
    steps
}

/// What the present readings allow.
struct Rig<'a> {
    readings: &'a Readings,
    has_rod: bool,
    stations: Vec<f64>,
    /// Some of the present rows, each a trial of its own.
    known: Vec<Reading>,
}

impl<'a> Rig<'a> {
    fn new(readings: &'a Readings, rod: Option<&Rod>) -> Self {
        let mut known: Vec<Reading> = Vec::new();
        for row in readings.rows.iter().filter(|row| row.load > 0.0) {
            let kind = |r: &Reading| {
                (r.direction, r.phase, r.load_station.map(f64::to_bits), r.read_station.map(f64::to_bits))
            };
            // two loads of each kind
            if known.iter().filter(|k| kind(k) == kind(row)).all(|k| k.load == row.load)
                && known.iter().filter(|k| kind(k) == kind(row)).count() < 2
                || known.iter().all(|k| kind(k) != kind(row))
            {
                known.push(Reading { trial: Some(format!("known {}", known.len())), ..row.clone() });
            }
        }
        Rig { readings, has_rod: rod.is_some(), stations: rod.map(stations).unwrap_or_default(), known }
    }

    /// `Load the tip along z with 5, 10 and 15 N`, or, where the displacement is what is set,
    /// `Move the tip along z until the load is 5, 10 and 15 N`.
    fn loading(&self, what: &str, axis: &str, loads: &str) -> String {
        match self.readings.header.driven {
            Driven::Load => format!("Load {what} along {axis} with {loads} N"),
            Driven::Displacement => format!("Move {what} along {axis} until the load is {loads} N"),
        }
    }

    /// What is left alone while something is waited for.
    fn untouched(&self) -> &'static str {
        match self.readings.header.driven {
            Driven::Load => "without touching anything",
            Driven::Displacement => "the displacement held",
        }
    }

    /// Axes that could be loaded: all of a rod, the present ones of a line.
    fn axes(&self) -> Vec<Axis> {
        let is_loaded = |axis: &Axis| self.readings.rows.iter().any(|row| row.direction.axis == *axis);
        Axis::ALL.into_iter().filter(|axis| self.has_rod || is_loaded(axis)).collect()
    }

    /// Loads that have been used along the axis, four of them at most; those of the other axes
    /// where there are none.
    fn levels(&self, axis: Axis) -> Vec<f64> {
        let loads_of = |is_wanted: &dyn Fn(&Reading) -> bool| {
            let mut loads: Vec<f64> = self
                .readings
                .rows
                .iter()
                .filter(|row| row.load > 0.0 && is_wanted(row))
                .map(|row| row.load)
                .collect();
            loads.sort_by(f64::total_cmp);
            loads.dedup();
            loads
        };
        let mut loads = loads_of(&|row| row.direction.axis == axis);
        if loads.is_empty() {
            loads = loads_of(&|_| true);
        }
        let last = loads.len().saturating_sub(1);
        let mut picked: Vec<f64> = (0..4).filter_map(|k| loads.get(k * last / 3).copied()).collect();
        picked.dedup();
        picked
    }

    /// Loads at the tip that are read there at once on the way up.
    fn at_tip(&self, axis: Axis, loads: &[f64]) -> LoadPlan {
        let is_read = |channel: &Axis| self.readings.rows.iter().any(|r| r.offset[channel.index()].is_some());
        LoadPlan {
            direction: Direction { axis, sign: 1 },
            loads: loads.to_vec(),
            unloading: false,
            load_station: None,
            read_station: None,
            waits: vec![0.0],
            repeats: REPEATS,
            channels: Axis::ALL.into_iter().filter(|channel| self.has_rod || is_read(channel)).collect(),
        }
    }

    fn measurement(&self, task: String, plan: LoadPlan) -> Measurement {
        let steps = steps(&plan);
        let has_time = self.readings.rows.iter().all(|row| row.time.is_some());
        let has_phase = steps.iter().any(|step| step.phase == Phase::Unload)
            || self.readings.rows.iter().any(|row| row.phase.is_some());
        let temperature = self.readings.rows.iter().map(|row| row.temperature).collect::<Option<Vec<f64>>>();
        let temperature = temperature.and_then(|t| t.first().copied());
        let is_waiting = steps.iter().any(|step| step.waited > 0.0);
        let mut rows = self.known.clone();
        let mut clock = rows.iter().filter_map(|row| row.time).fold(0.0, f64::max);
        let slopes = self.slopes(plan.direction);
        for repeat in 0..plan.repeats {
            for step in &steps {
                clock += STEP;
                let signed = f64::from(plan.direction.sign) * step.load;
                rows.push(Reading {
                    direction: plan.direction,
                    load: step.load,
                    offset: slopes.map(|slope| slope.map(|slope| slope * signed)),
                    trial: Some(format!("next {repeat}")),
                    phase: has_phase.then_some(step.phase),
                    time: (has_time || is_waiting).then_some(clock + step.waited),
                    temperature,
                    load_station: plan.load_station,
                    read_station: plan.read_station,
                    session: None,
                    loaded_at: None,
                    line: 0,
                });
            }
        }
        Measurement {
            task,
            plan,
            has_rod: self.has_rod,
            known_rows: self.known.len(),
            readings: Readings { rows, ..self.readings.clone() },
        }
    }

    /// Slope through the origin of each channel under loads along a direction, m/N: 0 for a rod's
    /// channel that was not read, and nothing for that of a line.
    fn slopes(&self, direction: Direction) -> [Option<f64>; 3] {
        Axis::ALL.map(|channel| {
            let rows = self.readings.rows.iter().filter(|row| row.direction.axis == direction.axis);
            let (mut xy, mut xx) = (0.0, 0.0);
            for row in rows {
                if let Some(offset) = row.offset[channel.index()] {
                    xy += row.signed_load() * offset;
                    xx += row.load * row.load;
                }
            }
            match xx > 0.0 {
                true => Some(xy / xx),
                false => self.has_rod.then_some(0.0),
            }
        })
    }
}

/// Where a load could hang or a sensor stand: at the declared joints, at the end of the bend, in
/// the middle of the pipes.
fn stations(rod: &Rod) -> Vec<f64> {
    const APART: f64 = 15.0 * MM;
    let (start, end, tip) = (rod.bend_start(), rod.bend_end(), rod.length());
    let joints = rod.joints.iter().map(|joint| joint.station);
    let mut stations: Vec<f64> = Vec::new();
    for station in joints.chain([end, 0.5 * (end + tip), 0.5 * start]) {
        if station > APART && station < tip - APART && stations.iter().all(|s| (s - station).abs() > APART) {
            stations.push(station);
        }
    }
    stations
}

fn newton(load: f64) -> String {
    crate::units::significant(load, 3)
}

/// `5, 10 and 20`.
fn newtons(loads: &[f64]) -> String {
    let loads: Vec<String> = loads.iter().map(|&load| newton(load)).collect();
    match loads.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => loads.join(""),
    }
}
