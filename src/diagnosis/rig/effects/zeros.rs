//! A zero that was not taken, as a term beside physics: what is as small as play, drift or a slip
//! competes with them.
//!
//! What is larger than the rod's own deflection is undone before there is a model:
//! `diagnosis/rig/mistakes`.

use super::entry::{
    Context, Entry, RigEffect, UNBOUNDED, entry, number, out_of_the_readings, parameter, size,
};
use super::mistakes::OFFSET_MISTAKE;
use super::of_trial::of_trials;
use super::places::{measured_channels, runs_by_sensor};
use crate::diagnosis::rig::mechanics::action::{Action, Weights};
use crate::diagnosis::rig::recording::columns::{column, sensor_in_run};
use crate::inference::{Key, Location};

/// Usual size as a share of the largest reading.
const ZERO: f64 = 0.1;
/// Usual weight of a hanger as a share of the largest load.
const HANGER: f64 = 0.1;
/// Of so many runs each may have a zero of its own that was not taken; of more nobody looks.
const MOST_RUNS: usize = 200;
/// Of fewer runs along an axis nobody knows which of them is off.
const FEWEST_RUNS: usize = 3;

/// A constant on all readings of a channel, or of a channel in a run, or on the loads of a trial.
pub static ZERO_NOT_TAKEN: RigEffect = RigEffect {
    effect: OFFSET_MISTAKE,
    usual: &[],
    needs_rod: true,
    candidates: offsets,
    missing: |_| "nothing was read",
    observed: |finding, _| {
        if finding.quantity("n").is_some() {
            let (more, force) = (number(finding, "n").value > 0.0, size(finding, "n", "N"));
            let [differ, as_with, cure] = match more {
                true => ["larger", "a hanger that was not counted", "add"],
                false => ["smaller", "zeros that were taken while a load hung", "subtract"],
            };
            return format!(
                "The loads are {force} {differ} than written ({}), as with {as_with}: {cure} that",
                finding.location
            );
        }
        let zero = number(finding, "um").with_unit("µm");
        format!("A zero was not taken ({}): subtract {zero} from these readings", finding.location)
    },
    write: out_of_the_readings,
};

fn offsets(context: &mut Context) -> Vec<Entry> {
    let size = ZERO * context.largest_reading();
    let data = context.data;
    let zero = |place: Key, own: Vec<usize>| {
        let readings: Weights = own.into_iter().map(|i| (i, 1.0)).collect();
        let um = parameter("um", 0.0, size, UNBOUNDED);
        entry(&ZERO_NOT_TAKEN, Location::from(place), um, Action::Shift(readings))
    };
    let of_channel = |channel| {
        let own = (0..data.len()).filter(|&i| data[i].channel == channel).collect();
        zero(Key::new(column(channel)), own)
    };
    let mut entries: Vec<Entry> = measured_channels(data).into_iter().map(of_channel).collect();
    let runs = runs_by_sensor(data);
    let largest = context.largest_load();
    entries.extend(of_trials(data, context.load_column, |place, per_newton| {
        let n = parameter("n", 0.0, HANGER * largest, (-largest, largest));
        entry(&ZERO_NOT_TAKEN, Location::from(place), n, Action::Shift(per_newton))
    }));
    if runs.len() > MOST_RUNS {
        return entries;
    }
    for (run, rows) in &runs {
        let channel = data[rows[0]].channel;
        let is_alike = |rows: &[usize]| data[rows[0]].channel == channel;
        let alike = runs.iter().filter(|(other, rows)| other.axis == run.axis && is_alike(rows)).count();
        if alike < FEWEST_RUNS || rows.len() < 2 {
            continue;
        }
        let place = sensor_in_run(&data[rows[0]], &data[rows[rows.len() - 1]]);
        entries.push(zero(place, rows.clone()));
    }
    entries
}
