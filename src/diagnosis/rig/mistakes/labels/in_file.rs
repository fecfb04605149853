//! What of a file is measured, and what mistakes of its labels have in common.

use crate::diagnosis::rig::mistakes::lines::Line;
use crate::diagnosis::rig::mistakes::possible::PossibleMistake;
use crate::diagnosis::rig::mistakes::relabelling::Relabelling;
use crate::diagnosis::rig::recording::columns::columns;
use crate::inference::{Effect, Key};
use crate::rig::readings::LoadColumn;
use crate::spatial::Axis;

/// How usual it is that only the rows of one axis are wrong, and what labs seldom do: ln.
pub(super) const ONE_AXIS: f64 = -1.0;
pub(super) const UNUSUAL: f64 = -1.0;

/// Axes, or channels, of all kinds.
pub(super) const ALL: [bool; 3] = [true; 3];

/// What of the file is measured.
pub struct Labels {
    pub(super) load_column: LoadColumn,
    pub(super) axes: Vec<Axis>,
    pub(super) channels: Vec<Axis>,
    /// True where a channel was read under loads along another axis.
    pub(super) has_cross: bool,
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

    /// All channels as they stand in the file: `dx_um, dy_um, dz_um`.
    pub(super) fn all_channels(&self) -> String {
        columns(&self.channels)
    }
}

/// Which axes are among some.
pub(super) fn mask(some: &[Axis]) -> [bool; 3] {
    Axis::ALL.map(|axis| some.contains(&axis))
}

/// A sign or a name: there is no number in it, so that nothing has to come near to one.
pub(super) fn relabelled(
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
