//! What a displacement sensor shows of a displacement: scale, direction, drift.

use super::load::{misalignment, pairs};
use super::places::measured_channels;
use super::{Context, Entry, RigEffect, UNBOUNDED, along_the_load, entry, of, parameter};
use crate::diagnosis::rig::action::Action;
use crate::diagnosis::rig::datum::Datum;
use crate::inference::{Effect, Finding, Kind, Location, Reported, Variable, WrittenTo};
use crate::spatial::Axis;
use crate::units::UM;

/// Scale error of a displacement sensor that was not calibrated in place.
const SCALE: f64 = 0.03;
/// Drift, m/K.
const PER_KELVIN: f64 = 5.0 * UM;
/// Drift in a room that warms by 2 K in an hour, m/s.
const PER_SECOND: f64 = 10.0 * UM / HOUR;
const HOUR: f64 = 3600.0;

/// A sensor that shows too much or too little.
pub static SENSOR_SCALE: RigEffect = RigEffect {
    effect: Effect {
        name: "sensor_scale",
        kind: Kind::Physics,
        summary: "a sensor shows too much or too little",
        formula: "y → s·y on one channel",
        prior: "3 %: a displacement sensor that was not calibrated in place",
        parameters: &[("factor", "shown over true displacement")],
        needs: "a rod file",
        cause: "the scale of the sensor",
        cause_at: |location| format!("the scale of sensor {location}"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    needs_rod: true,
    candidates: |context| {
        let of_channel = |channel: Axis| {
            let factor = parameter("factor", 1.0, 1.0, SCALE, (0.2, 5.0));
            let location = Location::Channel { channel, form: None };
            entry(&SENSOR_SCALE, location, factor, Action::SensorScale(channel))
        };
        measured_channels(context.data).into_iter().map(of_channel).collect()
    },
    missing: |_| "nothing was read",
    observed: |finding, _| {
        let excess = of(finding, "factor").map(|factor| 100.0 * (factor - 1.0));
        let word = if excess.value >= 0.0 { "much" } else { "little" };
        format!("Sensor {} shows {} too {word}", finding.location, excess.size().say("%"))
    },
};

/// A sensor that is not square to {T}.
pub static SENSOR_MISALIGNMENT: RigEffect = RigEffect {
    effect: Effect {
        name: "sensor_misalignment",
        kind: Kind::Physics,
        summary: "a sensor is not square",
        formula: "y = e·u, e turned by φ from the channel's axis",
        prior: "1°: what the eye allows when a sensor is set up",
        parameters: &[("angle_deg", "angle")],
        needs: "a rod file; loads across the channel",
        cause: "a sensor that is not square to the rod",
        cause_at: |location| format!("sensor {location} (not square to the rod)"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    needs_rod: true,
    candidates: |context| {
        let turned = |(from, towards): (Axis, Axis)| {
            let location = Location::SensorTurn { from, towards };
            let action = Action::TurnSensor(from, towards);
            entry(&SENSOR_MISALIGNMENT, location, misalignment(), action)
        };
        pairs(&measured_channels(context.data)).into_iter().map(turned).collect()
    },
    missing: |_| "the channels would show nothing of it",
    observed: |finding, _| {
        let angle = of(finding, "angle_deg");
        let word = if angle.value >= 0.0 { "towards" } else { "away from" };
        let (from, towards) = match &finding.location {
            Location::SensorTurn { from, towards } => (format!("d{from}"), format!("d{towards}")),
            other => (other.to_string(), "the others".into()),
        };
        format!("Sensor {from} is turned by {} {word} {towards}", angle.size().say("°"))
    },
};

/// Readings that follow temperature, or time where no temperature was read.
pub static THERMAL_DRIFT: RigEffect = RigEffect {
    effect: Effect {
        name: "thermal_drift",
        kind: Kind::Physics,
        summary: "readings follow temperature or time",
        formula: "y + d·(T − T₀), or y + d·(t − t₀); zero at the first reading of file or run",
        prior: "5 µm/K: steel of 0.5 m grows by 6 µm/K; 10 µm/h in a room that warms by 2 K in an hour",
        parameters: &[("um_per_k", "drift per kelvin"), ("um_per_h", "drift per hour")],
        needs: "temperatures or times (columns `temperature_c`, `time_s`)",
        cause: "thermal drift",
        cause_at: |location| format!("drift of {location}"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| vec![Variable::Temperature, Variable::Time],
        direct_check: None,
    },
    needs_rod: false,
    candidates: drifts,
    missing: |context| {
        let has = |value: fn(&Datum) -> Option<f64>| context.data.iter().any(|d| value(d).is_some());
        match has(|d| d.time) || has(|d| d.temperature) {
            true => "times or temperatures are missing in places, or do not differ",
            false => "there are neither times nor temperatures (columns `time_s`, `temperature_c`)",
        }
    },
    observed: |finding: &Finding, _| {
        let drift = match finding.quantity("um_per_k") {
            Some(drift) => drift.say("µm per kelvin"),
            None => of(finding, "um_per_h").say("µm per hour"),
        };
        let (channel, since) = match &finding.location {
            Location::Channel { channel, form } => (format!("d{channel}"), form.map(|f| format!(" {f}"))),
            other => (other.to_string(), None),
        };
        format!("Sensor {channel} drifts by {drift}{}", since.unwrap_or_default())
    },
};

/// Of each channel: since the first reading of the file, and since the first of each run, for a run
/// begins with a new zero.
fn drifts(context: &mut Context) -> Vec<Entry> {
    let data = context.data;
    let known = |value: &dyn Fn(&Datum) -> Option<f64>| data.iter().map(value).collect::<Option<Vec<f64>>>();
    let (values, name, unit, size) = match (known(&|d| d.temperature), known(&|d| d.time)) {
        (Some(temperature), _) => (temperature, "um_per_k", UM, PER_KELVIN),
        (None, Some(time)) => (time, "um_per_h", UM / HOUR, PER_SECOND),
        (None, None) => return Vec::new(),
    };
    let first_of_run = |run: usize| data.iter().position(|d| d.run == run).unwrap_or_default();
    let of_channel = |channel: Axis, form: Option<&'static str>, zero: &dyn Fn(&Datum) -> usize| {
        let own = data.iter().enumerate().filter(|(_, d)| d.channel == channel);
        let weights = own.map(|(i, d)| (i, values[i] - values[zero(d)])).collect();
        let drift = parameter(name, unit, 0.0, size, UNBOUNDED);
        entry(&THERMAL_DRIFT, Location::Channel { channel, form }, drift, Action::Shift(weights))
    };
    let mut entries = Vec::new();
    for channel in measured_channels(data) {
        entries.push(of_channel(channel, None, &|_| 0));
        if data.iter().any(|d| d.run != data[0].run) {
            let form = Some("since the zero of each run");
            entries.push(of_channel(channel, form, &|d| first_of_run(d.run)));
        }
    }
    entries
}
