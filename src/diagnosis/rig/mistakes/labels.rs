//! Mistakes of units, signs and names that a file of readings may hold, as a list.

mod signs;
mod swaps;
mod units;

use self::signs::signs;
use self::swaps::swaps;
pub(super) use self::units::{BESIDE, HARDLY_BESIDE, like_physics};
use self::units::{decimals, load_units, reading_units};
use super::lines::Line;
use super::possible::PossibleMistake;
use super::relabelling::Relabelling;
use crate::diagnosis::rig::recording::columns::columns;
use crate::inference::{Effect, Key};
use crate::rig::readings::LoadColumn;
use crate::spatial::Axis;

/// How usual it is that only the rows of one axis are wrong, and what labs seldom do: ln.
const ONE_AXIS: f64 = -1.0;
const UNUSUAL: f64 = -1.0;

/// Axes, or channels, of all kinds.
const ALL: [bool; 3] = [true; 3];

/// What of the file is measured.
pub(super) struct Labels {
    load_column: LoadColumn,
    axes: Vec<Axis>,
    channels: Vec<Axis>,
    /// True where a channel was read under loads along another axis.
    has_cross: bool,
}

impl Labels {
    pub fn of(lines: &[Line], load_column: LoadColumn) -> Labels {
        let axes_where = |is_met: &dyn Fn(&Line, Axis) -> bool| -> Vec<Axis> {
            Axis::ALL.into_iter().filter(|&axis| lines.iter().any(|line| is_met(line, axis))).collect()
        };
        Labels {
            load_column,
            axes: axes_where(&|line, axis| line.axis == axis),
            channels: axes_where(&|line, axis| line.channel == axis),
            has_cross: lines.iter().any(|line| line.axis != line.channel),
        }
    }

    /// Every mistake that these lines could show.
    pub fn mistakes(&self) -> Vec<PossibleMistake> {
        let mut all = load_units(self, false);
        all.extend(reading_units(self));
        all.extend(signs(self));
        all.extend(swaps(self));
        all
    }

    /// Every one that some trials could show which others are compared with: what softer or stiffer
    /// rods look like too, and decimal places.
    pub fn mistakes_in_trials(&self) -> Vec<PossibleMistake> {
        let mut all = load_units(self, true);
        all.extend(reading_units(self));
        all.extend(decimals(self));
        all.extend(signs(self));
        all.extend(swaps(self));
        all
    }

    /// All channels as they stand in the file: `dx_um, dy_um, dz_um`.
    fn all_channels(&self) -> String {
        columns(&self.channels)
    }
}

/// Which axes are among some.
fn mask(some: &[Axis]) -> [bool; 3] {
    Axis::ALL.map(|axis| some.contains(&axis))
}

/// A sign or a name: there is no number in it, so that nothing has to come near to one.
fn relabelled(
    effect: &'static Effect,
    location: Key,
    observed: String,
    looks_like: String,
    relabelling: Relabelling,
    log_prior: f64,
) -> PossibleMistake {
    PossibleMistake {
        effect,
        location,
        relabelling,
        log_prior,
        estimates: Vec::new(),
        observed,
        or_else: None,
        looks_like,
        within: f64::INFINITY,
    }
}
