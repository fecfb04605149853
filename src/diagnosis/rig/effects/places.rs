//! Where effects may sit: axes, channels, runs, and stations along the rod.

use crate::diagnosis::rig::mechanics::load_history::runs;
use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Run, RunName};
use crate::rod::Rod;
use crate::spatial::Axis;
use crate::units::MM;

/// Most stations of a scan for joints.
const MOST_STATIONS: f64 = 40.0;
/// Steps of a scan that read well, m.
const STEPS: [f64; 8] =
    [1.0 * MM, 2.0 * MM, 5.0 * MM, 10.0 * MM, 20.0 * MM, 25.0 * MM, 50.0 * MM, 100.0 * MM];
/// Stations closer than this are one place to a reader, m.
const SAME_PLACE: f64 = 6.0 * MM;

/// The axes along which loads pull.
pub(super) fn loaded_axes(data: &[Datum]) -> Vec<Axis> {
    let is_loaded = |axis: &Axis| data.iter().any(|d| d.direction.axis == *axis && d.load > 0.0);
    Axis::ALL.into_iter().filter(is_loaded).collect()
}

/// The channels that were read.
pub(in crate::diagnosis::rig) fn measured_channels(data: &[Datum]) -> Vec<Axis> {
    Axis::ALL.into_iter().filter(|channel| data.iter().any(|d| d.channel == *channel)).collect()
}

/// Stations of fewer sensors than these are not looked at one by one, nor of more.
const SEVERAL: std::ops::RangeInclusive<usize> = 3..=12;

/// Where the readings say that sensors stand, m, where these are several.
pub(super) fn read_stations(data: &[Datum]) -> Vec<f64> {
    let mut stations: Vec<f64> = data.iter().filter_map(|d| d.read_station).collect();
    stations.sort_by(f64::total_cmp);
    stations.dedup();
    if SEVERAL.contains(&stations.len()) { stations } else { Vec::new() }
}

/// Most sessions that are distinguished.
const MOST_SESSIONS: usize = 12;

/// Number and name of each session, where there are several.
pub(super) fn sessions(data: &[Datum]) -> Vec<(usize, String)> {
    let mut sessions: Vec<(usize, String)> = Vec::new();
    for datum in data {
        if sessions.iter().all(|(number, _)| *number != datum.session_number) {
            let name = datum.session.clone().unwrap_or_else(|| "without a name".into());
            sessions.push((datum.session_number, name));
        }
    }
    if (2..=MOST_SESSIONS).contains(&sessions.len()) { sessions } else { Vec::new() }
}

/// The data of each run and sensor: of each channel at each place where it was read.
pub(super) fn runs_by_sensor(data: &[Datum]) -> Vec<(Run, Vec<usize>)> {
    let mut groups = Vec::new();
    let runs = runs(data);
    let of_axis = |axis: Axis| runs.iter().filter(|run| data[run[0]].direction.axis == axis).count();
    let runs_of_axis = Axis::ALL.map(of_axis);
    for run in &runs {
        let first = &data[run[0]];
        let axis = first.direction.axis;
        let has_others = runs_of_axis[axis.index()] > 1;
        let name = first.run_name().or(has_others.then_some(RunName::Number(first.trial_number + 1)));
        let sensors = numbered(run.iter().map(|&i| data[i].sensor()));
        for sensor in 0..sensors.iter().max().map_or(0, |last| last + 1) {
            let of_sensor = run.iter().zip(&sensors).filter(|(_, own)| **own == sensor).map(|(&i, _)| i);
            groups.push((Run { axis, name: name.clone() }, of_sensor.collect()));
        }
    }
    groups
}

/// Where a joint that nobody declared may be, m: wherever a mass sits (sleeves are masses), at the
/// ends of the bend, and at equal steps along the rod. Not at the root, nor where a joint is
/// declared.
pub(super) fn stations(rod: &Rod) -> Vec<f64> {
    let length = rod.length();
    let step =
        STEPS.into_iter().find(|step| length / step <= MOST_STATIONS).unwrap_or(length / MOST_STATIONS);
    // a rod of a few millimetres has no place for as many
    let same = SAME_PLACE.min(step / 2.0);
    let masses = rod.masses.iter().map(|mass| mass.station);
    let steps = (1..=MOST_STATIONS as usize).map(|k| k as f64 * step);
    let mut taken: Vec<f64> = rod.joints.iter().map(|joint| joint.station).collect();
    taken.extend([0.0, length]);
    let declared = taken.len();
    for station in masses.chain([rod.bend_start(), rod.bend_end()]).chain(steps) {
        if station < length && taken.iter().all(|other| (other - station).abs() > same) {
            taken.push(station);
        }
    }
    let mut stations = taken.split_off(declared);
    stations.sort_by(f64::total_cmp);
    stations
}

#[cfg(test)]
mod tests {
    use super::*;

    fn millimetres(text: &str) -> Vec<f64> {
        let text = include_str!("../../../../rods/5.toml").to_owned() + text;
        let stations = stations(&Rod::from_toml("rod", &text).unwrap());
        stations.iter().map(|station| (station / MM * 10.0).round() / 10.0).collect()
    }

    #[test]
    fn a_scan_goes_along_the_rod_in_round_steps_and_meets_the_corner() {
        let stations = millimetres("");
        assert_eq!(stations[..9], [20.0, 40.0, 60.0, 80.0, 100.0, 120.0, 140.0, 150.0, 160.0]);
        assert_eq!(stations.last(), Some(&660.0));
    }

    #[test]
    fn a_scan_meets_sleeves_and_leaves_declared_joints_out() {
        let stations = millimetres(
            "[[mass]]\nname = \"ring\"\nstation_mm = 205\nmass_g = 30\n[[joint]]\nname = \"a\"\nstation_mm = 402\n",
        );
        assert!(stations.contains(&205.0));
        assert!(!stations.contains(&200.0) && !stations.contains(&400.0));
    }
}
