//! A zero that was not taken, as a term beside physics: what is as small as play, drift or a slip competes with them.
//!
//! What is larger than the rod's own deflection is undone before there is a model: `diagnosis/rig/mistakes`.

use super::mistakes::OFFSET_MISTAKE;
use super::places::measured_channels;
use super::{Context, Entry, RigEffect, UNBOUNDED, entry, of, parameter};
use crate::diagnosis::rig::action::{Action, Weights};
use crate::inference::Location;
use crate::units::UM;

/// Usual size as a share of the largest reading.
const ZERO: f64 = 0.1;

/// A constant on all readings of a channel.
pub static ZERO_NOT_TAKEN: RigEffect = RigEffect {
    effect: OFFSET_MISTAKE,
    needs_rod: true,
    candidates: offsets,
    missing: |_| "nothing was read",
    observed: |finding, _| {
        let zero = of(finding, "um").say("µm");
        format!("A zero was not taken ({}): subtract {zero} from these readings", finding.location)
    },
};

fn offsets(context: &mut Context) -> Vec<Entry> {
    let size = ZERO * context.largest_reading();
    let of_channel = |channel| {
        let data = context.data.iter().enumerate().filter(|(_, datum)| datum.channel == channel);
        let readings: Weights = data.map(|(i, _)| (i, 1.0)).collect();
        let um = parameter("um", UM, 0.0, size, UNBOUNDED);
        entry(&ZERO_NOT_TAKEN, Location::Key(format!("d{channel}_um")), um, Action::Shift(readings))
    };
    measured_channels(context.data).into_iter().map(of_channel).collect()
}
