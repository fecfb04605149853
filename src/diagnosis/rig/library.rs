//! The effects a rig may show, where, and how large they usually are.
//!
//! A prior size is what a rig of this kind is usually wrong by, not what these readings say. Where the size of an effect
//! follows from the rod or from the loads it is given relative to them. "The paper": Improved MultiCal, Sensors 2023,
//! 23(12), 5717.

mod places;

use self::places::{loaded_axes, measured_channels, runs_by_channel, stations};
use super::Body;
use super::action::{Action, Memory};
use super::datum::Datum;
use super::memory::{Clock, Loop, creep, hysteresis};
use super::structure::Structure;
use crate::diagnosis::{Candidate, EffectParameter};
use crate::rig::readings::Axis;
use crate::rod::{BendFlexibility, Rod};
use crate::units::{DEG, MM, UM, URAD_PER_NM};

/// A candidate with what its parameters do.
pub(super) type Entry = (Candidate, Vec<Action>);

/// Friction of a slide, N: the paper's lines cross the load axis at 0.09 to 0.11 kg.
const FRICTION: f64 = 1.0;
/// Weight of a hanger that was forgotten, or error of a tare, N: that of the paper's friction, from which its lines do not
/// tell it.
const TARE: f64 = 1.0;
/// Play of a clamp or of a threaded holder, m.
const PLAY: f64 = 20.0 * UM;
/// Share by which a rod is softer than its model: 1 − 1/r is 0.27 rms over the r_rod of the paper's six rods (1.013 to 2.302).
const SOFTNESS: f64 = 0.27;
/// Compliance of a joint or a flange as a share of the rod's own, ∫ds/EI: 0.2 as at the corner of the paper's rod 2#, with the
/// reconstructed sections (6.5 of 30 µrad/(N·m)).
const JOINT: f64 = 0.2;
/// Least departure of a bend's flexibility factor; else von Kármán's for the section counts.
const BEND: f64 = 0.3;
/// Share of the displacement at the largest load that is not linear.
const CURVATURE: f64 = 0.05;
/// Creep of bondlines and laminates: a few per cent per decade of time.
const CREEP: f64 = 0.03;
/// t₀ of creep, s: what a reading after so long is said to be without.
const CREEP_STARTS: [f64; 4] = [1.0, 10.0, 60.0, 600.0];
/// Width of a hysteresis loop as a share of full scale: 0.1 % of a load cell, some per cent of bonds and clamps.
const HYSTERESIS: f64 = 0.02;
/// Scale error of a displacement sensor that was not calibrated in place.
const SENSOR_SCALE: f64 = 0.03;
/// What the eye allows when a load or a sensor is set up, rad.
const ALIGNMENT: f64 = 1.0 * DEG;
/// Beyond this nobody would call it the same axis, rad.
const MOST_MISALIGNED: f64 = 30.0 * DEG;
/// Drift, m/K: steel of 0.5 m grows by 6 µm/K.
const PER_KELVIN: f64 = 5.0 * UM;
/// Drift in a room that warms by 2 K in an hour, m/s.
const PER_SECOND: f64 = 10.0 * UM / HOUR;
const HOUR: f64 = 3600.0;
/// Slip of a bond or a clamp within a run, m: well above a sensor's noise of 3 µm. A knock may be millimetres.
const SLIP: f64 = 50.0 * UM;
/// A display that was read wrongly, m.
const OUTLIER: f64 = 50.0 * UM;

const UNBOUNDED: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
const NOT_NEGATIVE: (f64, f64) = (0.0, f64::INFINITY);

/// Every effect that has a meaning for these readings; effects of the rod only where there is one.
pub(super) fn all(data: &[Datum], body: &mut Body, rod: Option<&Rod>) -> Vec<Entry> {
    let mut entries = of_loads(data);
    if let (Body::Rod(structure), Some(rod)) = (body, rod) {
        entries.extend(of_moduli());
        entries.extend(of_joints(structure, rod));
        entries.extend(of_bend(structure));
        entries.extend(of_alignment(data));
        entries.extend(measured_channels(data).into_iter().map(|channel| {
            let factor = parameter("factor", 1.0, 1.0, SENSOR_SCALE, (0.2, 5.0));
            entry("sensor_scale", format!("d{channel}"), factor, Action::SensorScale(channel))
        }));
    }
    entries.extend(of_shape(data));
    entries.extend(of_history(data));
    entries.extend(of_drift(data));
    entries.extend(of_slips(data));
    entries.extend(data.iter().enumerate().map(|(i, datum)| {
        let um = parameter("um", UM, 0.0, OUTLIER, UNBOUNDED);
        entry("outlier", datum.name(), um, Action::Shift(vec![(i, 1.0)]))
    }));
    entries
}

fn parameter(name: &str, unit: f64, neutral: f64, size: f64, bounds: (f64, f64)) -> EffectParameter {
    EffectParameter { name: name.into(), unit, neutral, size, bounds }
}

fn entry(effect: &str, location: impl Into<String>, parameter: EffectParameter, action: Action) -> Entry {
    let (effect, location) = (effect.into(), location.into());
    (
        Candidate {
            effect,
            location,
            parameters: vec![parameter],
            weight: 1.0,
            is_alternative: false,
            is_unknown: false,
        },
        vec![action],
    )
}

/// Gives those entries of `effect` that are `main` as much weight together as all others together: the place that a rod's
/// file names, the rig as a whole.
fn preferred(entries: &mut [Entry], effect: &str, is_main: impl Fn(&Candidate) -> bool) {
    let of_effect = |entry: &&mut Entry| entry.0.effect == effect;
    let main = entries.iter().filter(|(c, _)| c.effect == effect && is_main(c)).count();
    let others = entries.iter().filter(|(c, _)| c.effect == effect).count() - main;
    for (candidate, _) in entries.iter_mut().filter(of_effect) {
        candidate.weight = 1.0 / if is_main(candidate) { main } else { others } as f64;
    }
}

/// Marks one of several forms of the same thing.
fn alternative((candidate, actions): Entry) -> Entry {
    (Candidate { is_alternative: true, ..candidate }, actions)
}

fn largest_load(data: &[Datum]) -> f64 {
    data.iter().fold(0.0, |max: f64, d| max.max(d.load))
}

/// Friction, offset and play; one for all axes, or of one axis: a rig is set up anew for each direction.
fn of_loads(data: &[Datum]) -> Vec<Entry> {
    let (largest, axes) = (largest_load(data), loaded_axes(data));
    let mut places = vec![(String::new(), [true; 3])];
    if axes.len() > 1 {
        let of_axis = |axis: &Axis| (format!(", loads along {axis}"), Axis::ALL.map(|a| a == *axis));
        places.extend(axes.iter().map(of_axis));
    }
    let of_places = |make: &dyn Fn(&str, [bool; 3]) -> Entry| -> Vec<Entry> {
        places.iter().map(|(place, axes)| make(place, *axes)).collect()
    };
    let friction = |place: &str, axes| {
        let force = parameter("force_n", 1.0, 0.0, FRICTION, (0.0, largest));
        entry("friction", format!("slide{place}"), force, Action::Friction(axes))
    };
    let offset = |place: &str, axes| {
        let force = parameter("force_n", 1.0, 0.0, TARE, (-largest, largest));
        entry("load_offset", format!("hanger{place}"), force, Action::LoadOffset(axes))
    };
    let play = |place: &str, axes| {
        let um = parameter("play_um", UM, 0.0, PLAY, NOT_NEGATIVE);
        entry("backlash", format!("clamp{place}"), um, Action::Play(axes))
    };
    let mut entries = [of_places(&friction), of_places(&offset), of_places(&play)].concat();
    for effect in ["friction", "load_offset", "backlash"] {
        preferred(&mut entries, effect, |candidate| !candidate.location.contains(','));
    }
    entries
}

fn of_moduli() -> [Entry; 2] {
    let factor = || parameter("factor", 1.0, 1.0, SOFTNESS, (0.1, 10.0));
    [
        entry("stiffness_scale", "rod", factor(), Action::Stiffness),
        entry("shear_modulus", "rod", factor(), Action::ShearModulus),
    ]
}

/// Declared joints, the root, then joints that nobody declared along the rod. A value is a joint's whole compliance, to be
/// written into the rod file. A joint that nobody declared may be anywhere up to half way to the next station of the scan.
fn of_joints(structure: &mut Structure, rod: &Rod) -> Vec<Entry> {
    let scan = stations(rod);
    let named = rod
        .joints
        .iter()
        .map(|j| ("joint_compliance", j.name.clone(), j.station, [j.bending, j.torsion], false));
    let root = [("root_compliance", "root".to_owned(), 0.0, [0.0; 2], false)];
    let reach = |station: f64| {
        let others = scan.iter().map(|other| (other - station).abs()).filter(|distance| *distance > 0.0);
        0.5 * others.fold(f64::INFINITY, f64::min)
    };
    let scanned =
        scan.iter().copied().map(|station| ("joint_compliance", place(station), station, [0.0; 2], true));
    let rotation = structure.rotation();
    let of_joint = |(effect, location, station, of_file, is_scanned): (&str, String, f64, [f64; 2], bool)| {
        // a joint that the beam model cannot compute is no candidate
        let [bending, torsion] = structure.add_joint(station).ok()?;
        let compliance =
            |name, k: usize| parameter(name, URAD_PER_NM, of_file[k], JOINT * rotation[k], NOT_NEGATIVE);
        let mut parameters = vec![compliance("bending_urad_per_nm", 0), compliance("torsion_urad_per_nm", 1)];
        let mut actions = vec![Action::Joint(bending, of_file[0]), Action::Joint(torsion, of_file[1])];
        if is_scanned
            && let Some(nodes) = structure.add_nodes(station, [bending, torsion], reach(station)).ok()?
        {
            let [before, _, behind] = nodes.stations;
            // as likely anywhere
            let size = (behind - station) / 3.0f64.sqrt();
            parameters.push(parameter("station_mm", MM, station, size, (before, behind)));
            actions.push(Action::Station(nodes));
        }
        Some((
            Candidate {
                effect: effect.into(),
                location,
                parameters,
                weight: 1.0,
                is_alternative: false,
                is_unknown: false,
            },
            actions,
        ))
    };
    let mut entries: Vec<Entry> = named.chain(root).chain(scanned).filter_map(of_joint).collect();
    let is_declared = |candidate: &Candidate| rod.joints.iter().any(|j| j.name == candidate.location);
    preferred(&mut entries, "joint_compliance", is_declared);
    entries
}

/// How a station that has no name is said.
pub(super) fn place(station: f64) -> String {
    format!("station {:.1} mm", station / MM)
}

/// The flexibility factor of the bend, to be written into the rod file.
fn of_bend(structure: &Structure) -> Option<Entry> {
    structure.has_arc().then_some(())?;
    let (rod, of_file) = (structure.rod(), structure.bend_factor);
    let karman = BendFlexibility::VonKarman.factor(&rod.bend.section, rod.bend_radius);
    let size = (karman - of_file).abs().max(BEND);
    // a bend may ovalise, but not grow stiffer than a beam
    let bounds = (of_file.min(1.0), 100.0);
    let factor = parameter("factor", 1.0, of_file, size, bounds);
    Some(entry("bend_flexibility", "bend", factor, Action::Bend(of_file)))
}

/// Loads and sensors that are not square to {T}. Each load is set up by itself; where two axes were loaded their frame may
/// be turned as a whole besides.
fn of_alignment(data: &[Datum]) -> Vec<Entry> {
    let angle = || parameter("angle_deg", DEG, 0.0, ALIGNMENT, (-MOST_MISALIGNED, MOST_MISALIGNED));
    let pairs = |from: &[Axis]| -> Vec<(Axis, Axis)> {
        let others = |&a: &Axis| Axis::ALL.into_iter().filter(move |b| *b != a).map(move |b| (a, b));
        from.iter().flat_map(others).collect()
    };
    let (axes, channels) = (loaded_axes(data), measured_channels(data));
    let sensors = pairs(&channels).into_iter().map(|(from, towards)| {
        let action = Action::TurnSensor(from, towards);
        entry("sensor_misalignment", format!("d{from} towards d{towards}"), angle(), action)
    });
    let loads = pairs(&axes).into_iter().map(|(from, towards)| {
        let action = Action::TurnLoad(Axis::ALL.map(|a| a == from), from, towards);
        entry("load_misalignment", format!("{from} towards {towards}"), angle(), action)
    });
    let both = pairs(&axes).into_iter().filter(|(from, towards)| from < towards && axes.contains(towards));
    let frames = both.map(|(from, towards)| {
        let action = Action::TurnLoad([true; 3], from, towards);
        let about = Axis::ALL.into_iter().find(|axis| *axis != from && *axis != towards).unwrap_or(from);
        entry("load_misalignment", format!("{from} and {towards} about {about}"), angle(), action)
    });
    sensors.chain(loads).chain(frames).collect()
}

/// Stiffness that follows the load: quadratic as a symmetric body's is, and linear as a load cell's (its curvature has a
/// direction).
fn of_shape(data: &[Datum]) -> [Entry; 2] {
    let largest = largest_load(data);
    // at most nothing is left of the displacement, or ten times as much is there
    let share =
        |name: &str, scale: f64| parameter(name, 1.0, 0.0, CURVATURE / scale, (-1.0 / scale, 10.0 / scale));
    let forms = [
        entry("nonlinear_stiffness", "rod", share("per_n2", largest * largest), Action::PerLoadSquared),
        entry("nonlinear_stiffness", "rod", share("per_n", largest), Action::PerLoad),
    ];
    forms.map(alternative)
}

/// Creep by each clock that may be meant, and all loops of hysteresis.
fn of_history(data: &[Datum]) -> Vec<Entry> {
    let starts = CREEP_STARTS.into_iter().flat_map(|t0| Clock::ALL.map(|clock| (clock, t0)));
    let creeping = starts.filter_map(|(clock, t0)| {
        let memory = creep(data, clock, t0)?;
        let per_decade = parameter("per_decade", 1.0, 0.0, CREEP, (0.0, 1.0));
        let location = format!("rod, {}, t0 {t0} s", clock.name());
        Some((memory.clone(), entry("creep", location, per_decade, Action::Memory(memory))))
    });
    let mut entries: Vec<(Memory, Entry)> = Vec::new();
    for (memory, entry) in creeping {
        // two clocks that show the same time are one
        if !entries.iter().any(|(known, _)| known == &memory) {
            entries.push((memory, entry));
        }
    }
    let loops = [
        (Loop::Closed, "rod"),
        (Loop::Symmetric, "rod, loaded before"),
        (Loop::Remanent, "rod, open at zero"),
        (Loop::Virgin, "rod, loaded for the first time"),
        (Loop::NewByRayleigh, "rod, new before these readings"),
        (Loop::NewByPlays, "rod, new before these readings, by plays"),
    ];
    let lagging = loops.into_iter().filter_map(|(shape, location)| {
        let fraction = parameter("fraction", 1.0, 0.0, HYSTERESIS, (0.0, 1.0));
        Some(entry("hysteresis", location, fraction, Action::Memory(hysteresis(data, shape)?)))
    });
    entries.into_iter().map(|(_, entry)| entry).chain(lagging).map(alternative).collect()
}

/// Drift of each channel with temperature, or with time where no temperature was read: since the first reading of the file,
/// and since the first of each run, for a run begins with a new zero.
fn of_drift(data: &[Datum]) -> Vec<Entry> {
    let known = |of: &dyn Fn(&Datum) -> Option<f64>| data.iter().map(of).collect::<Option<Vec<f64>>>();
    let (values, name, unit, size) = match (known(&|d| d.temperature), known(&|d| d.time)) {
        (Some(temperature), _) => (temperature, "um_per_k", UM, PER_KELVIN),
        (None, Some(time)) => (time, "um_per_h", UM / HOUR, PER_SECOND),
        (None, None) => return Vec::new(),
    };
    let first_of_run = |run: usize| data.iter().position(|d| d.run == run).unwrap_or_default();
    let of_channel = |channel: Axis, location: String, zero: &dyn Fn(&Datum) -> usize| {
        let of = data.iter().enumerate().filter(|(_, d)| d.channel == channel);
        let weights = of.map(|(i, d)| (i, values[i] - values[zero(d)])).collect();
        let drift = parameter(name, unit, 0.0, size, UNBOUNDED);
        entry("thermal_drift", location, drift, Action::Shift(weights))
    };
    let mut entries = Vec::new();
    for channel in measured_channels(data) {
        entries.push(of_channel(channel, format!("d{channel}"), &|_| 0));
        if data.iter().any(|d| d.run != data[0].run) {
            let location = format!("d{channel}, since the zero of each run");
            entries.push(of_channel(channel, location, &|d| first_of_run(d.run)));
        }
    }
    entries
}

/// A slip between any two rows of a run, with two rows at least on either side: one row would be an outlier.
fn of_slips(data: &[Datum]) -> Vec<Entry> {
    let of_run = |(place, run): (String, Vec<usize>)| {
        (2..run.len().saturating_sub(1)).map(move |first| {
            let before = &data[run[first - 1]];
            let is_other_channel = before.channel != before.direction.axis;
            let channel = if is_other_channel { format!(", d{}", before.channel) } else { String::new() };
            let weights = run[first..].iter().map(|&i| (i, 1.0)).collect();
            let um = parameter("um", UM, 0.0, SLIP, UNBOUNDED);
            let location = format!("{place}, after row {}{channel}", before.row);
            entry("slip", location, um, Action::Shift(weights))
        })
    };
    runs_by_channel(data).into_iter().flat_map(of_run).collect()
}
