//! What a displacement sensor shows of a displacement: scale, direction.

use super::entry::{
    RigEffect, Usual, along_the_load, candidate, entry, number, out_of_the_readings, parameter, preferring,
};
use super::load::{ALIGNMENT, TURNS, WIDEST, misalignment, pairs, whole_turn};
use super::places::{measured_channels, read_stations};
use crate::diagnosis::rig::mechanics::action::Action;
use crate::inference::{Effect, Kind, Location, Part, Reported, WrittenTo};
use crate::spatial::Axis;
use crate::units::MM;

/// Scale error of a displacement sensor that was not calibrated in place.
const SCALE: f64 = 0.03;
/// Beyond that a channel is in another unit, or it shows something else.
const NO_UNIT: (f64, f64) = (0.5, 2.0);
const EXCESS: (f64, f64) = (-0.5, 1.0);
/// A sensor that shows too much or too little.
pub static SENSOR_SCALE: RigEffect = RigEffect {
    effect: Effect {
        name: "sensor_scale",
        kind: Kind::Physics,
        summary: "a sensor shows too much or too little",
        formula: "y → s·y on one channel, or at one station",
        prior: "3 %: a displacement sensor that was not calibrated in place",
        parameters: &[
            (&["factor"], "shown over true displacement"),
            (&["excess_percent"], "what is shown too much of it, of sensors at one station"),
        ],
        needs: "a rod file",
        cause: "the scale of the sensor",
        cause_at: |location| match location {
            Location::Station(station) => format!("the scale of the sensors at {:.1} mm", station / MM),
            channel => format!("the scale of sensor {channel}"),
        },
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(SCALE)],
    needs_rod: true,
    candidates: |context| {
        let of_channel = |channel: Axis| {
            let factor = parameter("factor", 1.0, SCALE, NO_UNIT);
            let location = Location::Channel { channel, form: None };
            entry(&SENSOR_SCALE, location, factor, Action::SensorScale(channel))
        };
        let channels = measured_channels(context.data);
        let stations = read_stations(context.data);
        let of_station = |&station: &f64| {
            let own = context.data.iter().enumerate().filter(|(_, d)| d.read_station == Some(station));
            let shown = Action::Shift(own.map(|(i, d)| (i, d.predicted)).collect());
            let excess = parameter("excess_percent", 0.0, SCALE, EXCESS);
            entry(&SENSOR_SCALE, Location::Station(station), excess, shown)
        };
        let entries = channels.into_iter().map(of_channel).chain(stations.iter().map(of_station)).collect();
        preferring(entries, |candidate| !matches!(candidate.location, Location::Station(_)))
    },
    missing: |_| "no readings were taken",
    observed: |finding, _| match &finding.location {
        Location::Station(station) => {
            let how = number(finding, "excess_percent").map(|excess| 1.0 + 0.01 * excess).misread();
            format!("The sensors at {:.1} mm read {how}", station / MM)
        }
        channel => format!("Sensor {channel} reads {}", number(finding, "factor").misread()),
    },
    write: out_of_the_readings,
};

/// A sensor that is not square to {T}.
pub static SENSOR_MISALIGNMENT: RigEffect = RigEffect {
    effect: Effect {
        name: "sensor_misalignment",
        kind: Kind::Physics,
        summary: "a sensor is not aligned with its channel's axis",
        formula: "y = e·u, e turned by φ from the channel's axis",
        prior: "1°: what the eye allows when a sensor is set up",
        parameters: &[
            (&["angle_deg"], "angle"),
            (&["about_x_deg"], "rotation of all sensors about x"),
            (&["about_y_deg"], "rotation of all sensors about y"),
            (&["about_z_deg"], "rotation of all sensors about z"),
        ],
        needs: "a rod file; loads across the channel",
        cause: "a misaligned sensor",
        cause_at: |location| format!("a misaligned sensor ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Angle(ALIGNMENT)],
    needs_rod: true,
    candidates: |context| {
        let turned = |(from, towards): (Axis, Axis)| {
            let location = Location::SensorTurn { from, towards };
            let action = Action::TurnSensor(from, towards);
            entry(&SENSOR_MISALIGNMENT, location, misalignment(), action)
        };
        let channels = measured_channels(context.data);
        let single = pairs(&channels).into_iter().map(turned);
        let whole = (channels.len() > 1).then(|| {
            let about = TURNS.map(|(name, from, towards)| {
                (parameter(name, 0.0, ALIGNMENT, WIDEST), Action::TurnSensors(from, towards))
            });
            let (parameters, actions) = about.into_iter().unzip();
            let location = Location::Part(Part::Sensors);
            (candidate(&SENSOR_MISALIGNMENT.effect, location, parameters), actions)
        });
        single.chain(whole).collect()
    },
    missing: |_| "no measured channel would show it",
    observed: |finding, _| {
        if finding.location == Location::Part(Part::Sensors) {
            return format!("All sensors are rotated together by {}", whole_turn(finding));
        }
        let angle = number(finding, "angle_deg");
        let word = if angle.value >= 0.0 { "towards" } else { "away from" };
        let (from, towards) = match &finding.location {
            Location::SensorTurn { from, towards } => (format!("d{from}"), format!("d{towards}")),
            other => (other.to_string(), "the others".into()),
        };
        format!("Sensor {from} is rotated by {} {word} {towards}", angle.size().with_unit("°"))
    },
    write: out_of_the_readings,
};
