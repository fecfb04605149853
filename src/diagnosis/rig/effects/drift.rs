//! Readings that follow temperature or time: what a displacement sensor shows in the course of a
//! recording.

use std::collections::HashMap;

use super::entry::{
    Context, Entry, RigEffect, UNBOUNDED, Usual, alternative, by_action, candidate, entry,
    out_of_the_readings, parameter,
};
use super::places::{measured_channels, read_stations};
use crate::diagnosis::rig::mechanics::action::{Action, DriftPer};
use crate::diagnosis::rig::mechanics::load_history::dwell;
use crate::diagnosis::rig::model::RigModel;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{
    Candidate, Effect, Finding, Kind, Location, Part, Quantity, Reported, Variable, WrittenTo,
};
use crate::spatial::Axis;
use crate::units::{MM, UM};

/// Drift over the whole recording as a share of its largest reading.
const DRIFT: f64 = 0.02;
/// Within which share of a recording a drift settles, and what is said of it since the first
/// reading of the file and since that of each run.
const SETTLING: [(f64, [&str; 2]); 6] = [
    (0.1, ["within a tenth of the recording", "within a tenth of the recording, each run from its own zero"]),
    (
        0.18,
        ["within a fifth of the recording", "within a fifth of the recording, each run from its own zero"],
    ),
    (
        0.32,
        ["within a third of the recording", "within a third of the recording, each run from its own zero"],
    ),
    (0.56, ["within half of the recording", "within half of the recording, each run from its own zero"]),
    (
        1.0,
        [
            "over the recording until it settles",
            "over the recording until it settles, each run from its own zero",
        ],
    ),
    (
        1.8,
        [
            "over the recording, more slowly towards its end",
            "over the recording, more slowly towards its end, each run from its own zero",
        ],
    ),
];
/// So many time constants to the end of it: 5 % are left.
const SETTLED: f64 = 3.0;
/// How often a drift settles within a recording, in one of these forms, for one at one rate.
const RARELY_SETTLES: f64 = 0.15;
/// How often a drift goes with time where the temperature was read, for one that goes with that.
const NOT_THERMAL: f64 = 0.1;

/// Readings that follow temperature or time.
pub static THERMAL_DRIFT: RigEffect = RigEffect {
    effect: Effect {
        name: "thermal_drift",
        kind: Kind::Physics,
        summary: "the readings follow temperature or time",
        formula: "y + d·(T − T₀), y + d·(t − t₀), or y + d·(1 − e^(−(t − t₀)/τ))/(1 − e^(−D/τ)) over the \
            duration D; zero at the first reading of the file, or when each run was zeroed, a step before its first load",
        prior: "2 % of the largest reading over the recording: steel of 0.5 m grows by 6 µm/K",
        parameters: &[
            (&["um_per_k"], "drift per kelvin"),
            (&["um_per_h"], "drift per hour"),
            (&["um"], "drift over the recording"),
            (&["dx_um_per_k"], "drift of dx per kelvin"),
            (&["dy_um_per_k"], "drift of dy per kelvin"),
            (&["dz_um_per_k"], "drift of dz per kelvin"),
            (&["dx_um_per_h"], "drift of dx per hour"),
            (&["dy_um_per_h"], "drift of dy per hour"),
            (&["dz_um_per_h"], "drift of dz per hour"),
            (&["dx_um"], "drift of dx over the recording"),
            (&["dy_um"], "drift of dy over the recording"),
            (&["dz_um"], "drift of dz over the recording"),
        ],
        needs: "temperatures or times (columns `temperature_c`, `time_s`)",
        cause: "thermal drift",
        cause_at: |location| format!("drift of {location}"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| vec![Variable::Temperature, Variable::Time],
        direct_check: None,
    },
    usual: &[Usual::Share(DRIFT)],
    needs_rod: false,
    candidates: drifts,
    missing: |context| {
        let has = |value: fn(&Datum) -> Option<f64>| context.data.iter().any(|d| value(d).is_some());
        match has(|d| d.time) || has(|d| d.temperature) {
            true => "the times or temperatures are incomplete, or do not differ",
            false => "neither times nor temperatures were recorded (columns `time_s`, `temperature_c`)",
        }
    },
    observed: |finding: &Finding, model| {
        let is_of_one = matches!(finding.location, Location::Channel { .. });
        let each = by_action(finding, model).into_iter().filter_map(|(action, _, drift)| {
            let Action::Drift(channel, per, _) = action else { return None };
            let drift = drift.with_unit(per.unit_name());
            Some(if is_of_one { drift } else { format!("d{channel} {drift}") })
        });
        let drift = each.collect::<Vec<_>>().join(", ");
        match &finding.location {
            Location::Channel { channel, form } => {
                let since = form.map(|form| format!(" {form}")).unwrap_or_default();
                match load_drift(finding, model, *channel) {
                    Some(load) => format!(
                        "The load cell drifts by {load}{since} under loads along {channel}, or the zero of d{channel} \
                         the other way"
                    ),
                    None => format!("Sensor d{channel} drifts by {drift}{since}"),
                }
            }
            Location::Form { form, .. } => format!("The sensors drift by {drift} {form}"),
            _ => format!("The sensors drift by {drift}"),
        }
    },
    write: out_of_the_readings,
};

/// What a measured load drifts by, where each datum of the channel is one.
fn load_drift(finding: &Finding, model: &RigModel, channel: Axis) -> Option<String> {
    let per_newton = model.per_newton()?;
    let mut own = model.data().iter().filter(|datum| datum.channel == channel);
    own.all(|datum| datum.imposed.is_some()).then_some(())?;
    let own = |(action, _, drift): (&Action, _, Quantity)| match action {
        Action::Drift(other, per, _) if *other == channel => {
            let unit = per.unit_name().replacen("µm", "N", 1);
            Some(drift.map(|drift| drift * UM / per_newton).with_unit(&unit))
        }
        _ => None,
    };
    by_action(finding, model).into_iter().find_map(own)
}

impl DriftPer {
    /// At the end of a parameter's name.
    fn suffix(self) -> &'static str {
        match self {
            DriftPer::Kelvin => "um_per_k",
            DriftPer::Hour => "um_per_h",
            DriftPer::Recording => "um",
        }
    }

    /// For people.
    fn unit_name(self) -> &'static str {
        match self {
            DriftPer::Kelvin => "µm per kelvin",
            DriftPer::Hour => "µm per hour",
            DriftPer::Recording => "µm",
        }
    }
}

/// What readings drift with, and how far they drift by it.
struct Course {
    /// Of each datum.
    values: Vec<f64>,
    per: DriftPer,
    size: f64,
    /// Since the first reading of the file, and since that of each run.
    forms: [Option<&'static str>; 2],
    /// True for one of several forms with the same parameters.
    is_settling: bool,
    /// How often it is so, of drifts in sensors whose temperature was read, or was not.
    weight: f64,
}

/// With temperature and with time: at one rate, and with time ever more slowly until it has
/// settled.
fn courses(context: &Context) -> Vec<Course> {
    let data = context.data;
    let known = |value: &dyn Fn(&Datum) -> Option<f64>| {
        let values = data.iter().map(value).collect::<Option<Vec<f64>>>()?;
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (most > least).then_some((values, least, most))
    };
    let drift = DRIFT * context.largest_reading();
    let at_one_rate = |(values, least, most): &(Vec<f64>, f64, f64), per, forms, weight| Course {
        values: values.clone(),
        per,
        size: drift / (most - least),
        forms,
        is_settling: false,
        weight,
    };
    let (temperature, time) = (known(&|d| d.temperature), known(&|d| d.time));
    let since_zero = [None, Some("since the zero of each run")];
    // what drifts while its temperature is read follows that, as a rule
    let (of_time, weight) = match &temperature {
        Some(_) => ([Some("with time"), Some("with time since the zero of each run")], NOT_THERMAL),
        None => (since_zero, 1.0),
    };
    let mut courses = Vec::new();
    courses.extend(temperature.as_ref().map(|values| at_one_rate(values, DriftPer::Kelvin, since_zero, 1.0)));
    let Some(time) = time else { return courses };
    courses.push(at_one_rate(&time, DriftPer::Hour, of_time, weight));
    let (values, least, most) = time;
    courses.extend(SETTLING.into_iter().map(|(share, forms)| {
        // e^(−(t − t₀)/τ)
        let left = |t: f64| (-SETTLED * (t - least) / (share * (most - least))).exp();
        let whole = 1.0 - left(most);
        Course {
            values: values.iter().map(|&t| -left(t) / whole).collect(),
            per: DriftPer::Recording,
            size: drift,
            forms: forms.map(Some),
            is_settling: true,
            weight: weight * RARELY_SETTLES,
        }
    }));
    courses
}

/// Of each channel, and of all of them: since the first reading of the file, and since the zero of
/// each run, for a run begins with a new zero.
fn drifts(context: &mut Context) -> Vec<Entry> {
    let data = context.data;
    // a sensor that is read elsewhere has a zero of its own
    let place = |d: &Datum| (d.run, d.stations()[1]);
    let mut runs: HashMap<(usize, u64), Vec<usize>> = HashMap::new();
    for (i, datum) in data.iter().enumerate() {
        runs.entry(place(datum)).or_default().push(i);
    }
    let has_runs = data.iter().any(|d| d.run != data[0].run);
    let channels = measured_channels(data);
    let mut entries = Vec::new();
    for course in courses(context) {
        let zeros: HashMap<(usize, u64), f64> =
            runs.iter().map(|(key, run)| (*key, at_zero(data, run, &course.values))).collect();
        let of_file = |_: &Datum| course.values[0];
        let of_run = |d: &Datum| zeros[&place(d)];
        let ways: [&dyn Fn(&Datum) -> f64; 2] = [&of_file, &of_run];
        for (form, zero) in course.forms.into_iter().zip(ways).take(1 + usize::from(has_runs)) {
            entries.extend(drifts_since(data, &channels, &course, form, zero));
            // one of several sensors along the rod, at one rate
            if !course.is_settling {
                let stations = read_stations(data);
                let share = 1.0 / stations.len().max(1) as f64;
                let of_station = |station: f64| drift_at(data, &channels, &course, form, zero, station);
                let own = stations.into_iter().map(of_station);
                entries.extend(
                    own.map(|(own, actions)| (Candidate { weight: share * own.weight, ..own }, actions)),
                );
            }
        }
    }
    entries
}

/// What the `values` were when a run was zeroed: a usual step of time before its first load was
/// read, or when that was hung, along the line of the run; at its first reading where that is of no
/// load.
fn at_zero(data: &[Datum], run: &[usize], values: &[f64]) -> f64 {
    let [first, last] = [run[0], run[run.len() - 1]];
    if data[first].load == 0.0 {
        return values[first];
    }
    let before = || {
        let times: Vec<f64> = data.iter().map(|d| d.time).collect::<Option<_>>()?;
        let hung = data[first].loaded_at.map(|hung| times[first] - hung);
        Some((hung.unwrap_or_else(|| dwell(data, &times)), times[last] - times[first]))
    };
    // without a clock every instant is a step
    let (before, lasted) = before().unwrap_or((1.0, (data[last].order - data[first].order) as f64));
    let rate = if lasted > 0.0 { (values[last] - values[first]) / lasted } else { 0.0 };
    values[first] - rate * before
}

/// The drift of all channels of the sensors at one station, in some direction.
fn drift_at(
    data: &[Datum],
    channels: &[Axis],
    course: &Course,
    form: Option<&'static str>,
    zero: &dyn Fn(&Datum) -> f64,
    station: f64,
) -> Entry {
    let Course { values, per, size, weight, .. } = course;
    let is_there = |d: &Datum| d.read_station == Some(station);
    let read = channels.iter().filter(|channel| data.iter().any(|d| is_there(d) && d.channel == **channel));
    let of_channel = |&channel: &Axis| {
        let own = data.iter().enumerate().filter(|(_, d)| is_there(d) && d.channel == channel);
        let shift = Action::Drift(channel, *per, own.map(|(i, d)| (i, values[i] - zero(d))).collect());
        (parameter(&format!("d{channel}_{}", per.suffix()), 0.0, *size, UNBOUNDED), shift)
    };
    let (parameters, actions) = read.map(of_channel).unzip();
    let form = form.map(|form| format!(" {form}")).unwrap_or_default();
    let location = Location::Form { part: Part::Sensors, form: format!("at {:.1} mm{form}", station / MM) };
    let candidate = candidate(&THERMAL_DRIFT.effect, location, parameters);
    (Candidate { weight: *weight, ..candidate }, actions)
}

/// Drifts of one course since some zero, where it had that value.
fn drifts_since(
    data: &[Datum],
    channels: &[Axis],
    course: &Course,
    form: Option<&'static str>,
    zero: &dyn Fn(&Datum) -> f64,
) -> Vec<Entry> {
    let Course { values, per, size, .. } = course;
    let shift = |channel: Axis| {
        let own = data.iter().enumerate().filter(|(_, d)| d.channel == channel);
        Action::Drift(channel, *per, own.map(|(i, d)| (i, values[i] - zero(d))).collect())
    };
    let of_channel = |&channel: &Axis| {
        let drift = parameter(per.suffix(), 0.0, *size, UNBOUNDED);
        entry(&THERMAL_DRIFT, Location::Channel { channel, form }, drift, shift(channel))
    };
    let mut entries: Vec<Entry> = channels.iter().map(of_channel).collect();
    if channels.len() > 1 {
        // what warms up moves the tip in some direction
        let vector = channels.iter().map(|&channel| {
            let name = format!("d{channel}_{}", per.suffix());
            (parameter(&name, 0.0, *size, UNBOUNDED), shift(channel))
        });
        let (parameters, actions) = vector.unzip();
        let location = match form {
            None => Location::Part(Part::Sensors),
            Some(form) => Location::Form { part: Part::Sensors, form: form.into() },
        };
        entries.push((candidate(&THERMAL_DRIFT.effect, location, parameters), actions));
    }
    let own = |(candidate, actions)| {
        let entry = (Candidate { weight: course.weight, ..candidate }, actions);
        if course.is_settling { alternative(entry) } else { entry }
    };
    entries.into_iter().map(own).collect()
}
