//! What the trials that are right show, and how far others are from it.

use super::table::Table;
use crate::diagnosis::rig::mistakes::lines::{Fit, Line};
use crate::diagnosis::rig::mistakes::relabelling::Relabelling;
use crate::statistics::median;

/// Slopes of one rod on one rig are the same within this share of the largest.
pub(super) const REPEATS: f64 = 0.01;
/// How far the scatter of one trial may be from that of others, ln.
const SCATTERS: f64 = 0.7;
/// What a rod file may leave of a class that it confirms.
const CONFIRMED: f64 = 0.1;
/// How well a rod file that is confirmed elsewhere knows a line.
const BY_FILE: f64 = 0.15;

/// A line in the trials that are right: m/N, m/N and m.
#[derive(Clone)]
pub(super) struct Right {
    pub slope: f64,
    pub error: f64,
    pub scatter: f64,
}

/// What is left of some trials against those that are right.
pub(super) struct Compared {
    pub misfit: f64,
    /// Share of the squares of the deflections that is left.
    pub left: f64,
}

impl Table<'_> {
    /// The lines that are right, and of those that they do not show what the rod file says.
    pub(super) fn completed(&self, shown: &[Option<Right>]) -> Vec<Option<Right>> {
        let by_file = |k: usize| {
            let slope = self.by_rod?[k];
            Some(Right { slope, error: BY_FILE * slope.abs(), scatter: 0.0 })
        };
        shown.iter().enumerate().map(|(k, right)| right.clone().or_else(|| by_file(k))).collect()
    }

    /// Each line in some trials.
    pub(super) fn lines_of(&self, class: &[usize]) -> Vec<Option<Right>> {
        let of_line = |k: usize| {
            let median_of = |value: &dyn Fn(&Fit) -> f64| {
                let cells = class.iter().filter_map(|&trial| self.cells[trial][k]);
                median(&cells.map(|cell| value(&cell.fit)).collect::<Vec<_>>())
            };
            Some(Right {
                slope: median_of(&|fit| fit.slope)?,
                error: median_of(&|fit| fit.error)?,
                scatter: median_of(&|fit| fit.scatter)?,
            })
        };
        (0..self.lines.len()).map(of_line).collect()
    }

    pub(super) fn is_confirmed(&self, class: &[usize], by_rod: &[f64]) -> bool {
        let right = |&slope: &f64| Some(Right { slope, error: 0.0, scatter: 0.0 });
        let right: Vec<_> = by_rod.iter().map(right).collect();
        let compared = self.compared(class, &right, &Relabelling::default(), |_| true);
        compared.is_some_and(|compared| compared.left < CONFIRMED)
    }

    /// Some trials, relabelled, against the lines that are right, and what is left of the lines
    /// that `counts`; `None` where there is nothing to compare.
    pub(super) fn compared(
        &self,
        class: &[usize],
        right: &[Option<Right>],
        relabelling: &Relabelling,
        counts: impl Fn(&Line) -> bool,
    ) -> Option<Compared> {
        let (mut misfit, mut off, mut all) = (0.0, 0.0, 0.0);
        for &trial in class {
            let mut scatters = Vec::new();
            for (k, line) in self.lines.iter().enumerate() {
                let Some(cell) = self.cells[trial][k] else { continue };
                let (axis, channel) = (line.axis.index(), line.channel.index());
                let (load, reading) = (relabelling.load[axis], relabelling.reading[axis][channel]);
                let (meant_axis, meant_channel) = (relabelling.axis[axis], relabelling.channel[channel]);
                let has_load =
                    |other: &Line| other.stations == line.stations && other.axis.index() == meant_axis;
                let is_it = |other: &Line| has_load(other) && other.channel.index() == meant_channel;
                let of_load = self.lines.iter().zip(right).filter(|(other, _)| has_load(other));
                let largest =
                    of_load.filter_map(|(_, is)| Some(is.as_ref()?.slope.abs())).fold(0.0, f64::max);
                let factor = reading / load;
                let (own, error, load) =
                    (factor * cell.fit.slope, factor * cell.fit.error, load.abs() * cell.load);
                let meant = self.lines.iter().zip(right).find(|(other, _)| is_it(other));
                let Some(right) = meant.and_then(|(_, right)| right.as_ref()) else {
                    // a line that nothing else shows confirms nothing
                    let shows = own / error.hypot(REPEATS * own).max(f64::MIN_POSITIVE);
                    misfit += shows.powi(2);
                    if counts(line) {
                        off += (own * load).powi(2);
                        all += (own * load).powi(2);
                    }
                    continue;
                };
                let sigma = error.hypot(right.error).hypot(REPEATS * largest);
                misfit += ((own - right.slope) / sigma.max(f64::MIN_POSITIVE)).powi(2);
                if counts(line) {
                    off += ((own - right.slope) * load).powi(2);
                    all += (own.abs().max(right.slope.abs()) * load).powi(2);
                }
                let scatter = reading.abs() * cell.fit.scatter;
                if scatter > 0.0 && right.scatter > 0.0 {
                    scatters.push((scatter / right.scatter).ln());
                }
            }
            misfit += (median(&scatters).unwrap_or(0.0) / SCATTERS).powi(2);
        }
        (all > 0.0).then(|| Compared { misfit, left: off / all })
    }
}

/// True where a relabelling makes something else of a line.
pub(super) fn acts_on(relabelling: &Relabelling, line: &Line) -> bool {
    let (axis, channel) = (line.axis.index(), line.channel.index());
    let is_as_it_was = relabelling.load[axis] == 1.0 && relabelling.reading[axis][channel] == 1.0;
    !is_as_it_was || relabelling.axis[axis] != axis || relabelling.channel[channel] != channel
}
