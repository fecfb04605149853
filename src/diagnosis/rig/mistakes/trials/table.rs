//! Trials by the lines of a recording, and which of them agree.

use std::collections::BTreeSet;

use crate::diagnosis::rig::mistakes::groups::group;
use crate::diagnosis::rig::mistakes::lines::{Fit, Line, wrong_load};
use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::columns::{rows_of, trial_name};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::diagnosis::rig::recording::resolution::resolution;

/// Slopes that differ by less than this share, or by so many standard errors, may be one.
const ALIKE: f64 = 0.25;
const ERRORS: f64 = 6.0;
/// Lines that show less than this share of the most that a trial shows say nothing.
pub(super) const SHOWN: f64 = 0.1;
/// More classes than these are none.
pub(super) const MOST_CLASSES: usize = 4;
/// Lines of one sensor at two stations, each over that of the rod file, are alike within this
/// ratio: a soft clamp shows near the root first.
const ELSEWHERE: f64 = 3.0;

/// A line in one trial.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub fit: Fit,
    /// The largest load, N.
    pub load: f64,
}

impl Cell {
    /// What it shows at the largest load, m.
    pub fn size(&self) -> f64 {
        self.fit.slope.abs() * self.load
    }

    fn is_like(&self, other: &Cell) -> bool {
        let apart = (self.fit.slope - other.fit.slope).abs();
        let larger = self.fit.slope.abs().max(other.fit.slope.abs());
        apart < ALIKE * larger || apart < ERRORS * self.fit.error.hypot(other.fit.error)
    }
}

/// Trials by the lines of a recording.
pub(in crate::diagnosis::rig::mistakes) struct Table<'a> {
    pub(super) data: &'a [Datum],
    pub(super) lines: &'a [Line],
    /// For each datum its trial, in the order of recording.
    pub(super) trial: Vec<usize>,
    /// By trial and line.
    pub(super) cells: Vec<Vec<Option<Cell>>>,
    /// The slope of each line by the rod file, m/N.
    pub(super) by_rod: Option<&'a [f64]>,
    /// Trials that agree in all lines which they have in common.
    pub(super) classes: Vec<Vec<usize>>,
}

impl<'a> Table<'a> {
    /// True where all trials agree with each other.
    pub fn is_alike(&self) -> bool {
        self.classes.len() < 2
    }

    /// Of `data` and the `lines` that they are on; `by_rod` are the slopes of the rod file, m/N.
    pub fn of(data: &'a [Datum], lines: &'a [Line], by_rod: Option<&'a [f64]>) -> Table<'a> {
        let visit = visits(data);
        let trial = numbered(data.iter().zip(&visit).map(|(datum, visit)| {
            let is_named = datum.trial.is_some();
            (datum.session_number, datum.trial_number, if is_named { 0 } else { *visit })
        }));
        let trials = trial.iter().max().map_or(0, |last| last + 1);
        // readings that round to the same number scatter all the same
        let rounding = |own: usize| {
            let own = data.iter().zip(&trial).filter(|(_, trial)| **trial == own);
            resolution(own.map(|(datum, _)| datum)) / 12f64.sqrt()
        };
        let rounding: Vec<f64> = (0..trials).map(rounding).collect();
        // by line and trial
        let mut parts: Vec<Vec<Vec<usize>>> = vec![vec![Vec::new(); trials]; lines.len()];
        for (parts, line) in parts.iter_mut().zip(lines) {
            line.data.iter().for_each(|&i| parts[trial[i]].push(i));
        }
        // a load that one channel shows to be wrong is wrong for all that were read under it
        let point = |&i: &usize| (data[i].signed_load(), data[i].measured);
        let wrong_order = |part: &Vec<usize>| {
            let points: Vec<(f64, f64)> = part.iter().map(point).collect();
            wrong_load(&points).map(|far| data[part[far]].order)
        };
        let wrong: BTreeSet<usize> = parts.iter().flatten().filter_map(wrong_order).collect();
        let mut cells = vec![vec![None; lines.len()]; trials];
        for (k, parts) in parts.into_iter().enumerate() {
            for ((cells, mut own), rounding) in cells.iter_mut().zip(parts).zip(&rounding) {
                own.retain(|&i| !wrong.contains(&data[i].order));
                let load = own.iter().fold(0.0, |most: f64, &i| most.max(data[i].load));
                let group = group(data, own);
                let fit = Fit { scatter: group.fit.scatter.max(*rounding), ..group.fit };
                cells[k] = group.has_slope.then_some(Cell { fit, load });
            }
        }
        let mut table = Table { data, lines, trial, cells, by_rod, classes: Vec::new() };
        table.classes = table.classes();
        table
    }

    fn classes(&self) -> Vec<Vec<usize>> {
        let mut classes: Vec<Vec<usize>> = Vec::new();
        for trial in 0..self.cells.len() {
            if self.cells[trial].iter().all(Option::is_none) {
                continue;
            }
            match classes.iter().position(|class| self.belongs_to(trial, class)) {
                Some(class) => classes[class].push(trial),
                None if classes.len() > MOST_CLASSES => break,
                None => classes.push(vec![trial]),
            }
        }
        classes
    }

    fn belongs_to(&self, trial: usize, class: &[usize]) -> bool {
        let most = |trial: usize| self.cells[trial].iter().flatten().map(Cell::size).fold(0.0, f64::max);
        let is_in_class = |k: usize| class.iter().any(|&other| self.cells[other][k].is_some());
        let own = |k: &usize| self.cells[trial][*k].is_some();
        // the same loads, and other channels only
        let is_read_elsewhere = |k: usize| {
            let has_its_loads = |other: &usize| {
                let (line, other) = (&self.lines[k], &self.lines[*other]);
                line.axis == other.axis && line.stations == other.stations
            };
            let of_loads = || (0..self.lines.len()).filter(has_its_loads);
            of_loads().any(is_in_class) && !of_loads().filter(own).any(is_in_class)
        };
        if (0..self.lines.len()).filter(own).any(is_read_elsewhere) {
            return false;
        }
        (0..self.lines.len()).all(|k| {
            let Some(own) = self.cells[trial][k] else { return true };
            let first = class.iter().find_map(|&other| Some((other, self.cells[other][k]?)));
            let Some((other, cell)) = first else { return !self.is_unlike_elsewhere(trial, k, class) };
            let shown = (own.size() / most(trial)).max(cell.size() / most(other));
            shown < SHOWN || own.is_like(&cell)
        })
    }

    /// True where a line that only `trial` has is to the rod file what the lines of the same sensor
    /// under the same loads are not, at other stations in the trials of `class`.
    fn is_unlike_elsewhere(&self, trial: usize, k: usize, class: &[usize]) -> bool {
        let line = &self.lines[k];
        let is_of_sensor = |other: &usize| {
            let other = &self.lines[*other];
            (other.axis, other.channel) == (line.axis, line.channel)
        };
        let own = self.over_the_file(trial, k);
        let others = class.iter().flat_map(|&other| {
            (0..self.lines.len()).filter(is_of_sensor).filter_map(move |k| self.over_the_file(other, k))
        });
        let near = |ratio: f64| (1.0 / ELSEWHERE..ELSEWHERE).contains(&ratio);
        own.is_some_and(|own| others.map(|other| own / other).any(|ratio| !near(ratio)))
    }

    /// The slope of a line in one trial over that of the rod file; `None` where either shows
    /// little.
    fn over_the_file(&self, trial: usize, k: usize) -> Option<f64> {
        let (by_rod, cells) = (self.by_rod?, &self.cells[trial]);
        let cell = cells[k]?;
        let file = |k: usize, cell: &Cell| by_rod[k].abs() * cell.load;
        let most_read = cells.iter().flatten().map(Cell::size).fold(0.0, f64::max);
        let all = cells.iter().enumerate().filter_map(|(k, cell)| Some(file(k, cell.as_ref()?)));
        let is_shown = file(k, &cell) > SHOWN * all.fold(0.0, f64::max)
            && cell.size() > SHOWN * most_read
            && cell.fit.slope.abs() > ERRORS * cell.fit.error;
        is_shown.then(|| cell.fit.slope / by_rod[k])
    }

    /// `trial 3`, `trials 3 and 4`, `rows 7 to 12`.
    pub(super) fn place(&self, class: &[usize]) -> String {
        let own: Vec<&Datum> = class
            .iter()
            .filter_map(|trial| Some(&self.data[self.trial.iter().position(|own| own == trial)?]))
            .collect();
        let names: Option<Vec<String>> = own.iter().map(|datum| trial_name(datum)).collect();
        match names {
            Some(names) if names.len() == 1 => format!("trial {}", names[0]),
            Some(names) => {
                let (last, first) = names.split_last().map_or(("", &[][..]), |(l, f)| (l.as_str(), f));
                format!("trials {} and {last}", first.join(", "))
            }
            None => {
                let is_own = |(datum, trial): (&'a Datum, &usize)| class.contains(trial).then_some(datum);
                rows_of(self.data.iter().zip(&self.trial).filter_map(is_own))
            }
        }
    }
}

/// For each datum how often its axis was loaded before, with another one since: where trials have
/// no names, other loads are no reason to begin a new one, but coming back to an axis is.
fn visits(data: &[Datum]) -> Vec<usize> {
    let mut visits = [0usize; 3];
    let mut last = None;
    let visit = |datum: &Datum| {
        let axis = datum.direction.axis;
        if last != Some(axis) {
            visits[axis.index()] += 1;
            last = Some(axis);
        }
        visits[axis.index()]
    };
    data.iter().map(visit).collect()
}
