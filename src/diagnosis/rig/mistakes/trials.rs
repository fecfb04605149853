//! Mistakes in some of the trials: the others show what is right.
//!
//! Trials whose lines have the same slopes within a quarter are one class. Where there are several,
//! one of them is right: the one that the rod file says, else the largest. Each of the others is
//! compared with that one under every change of units, signs and names
//!
//! ```text
//! χ² = Σ ((s·G − r)/σ)²,   σ² = (G·s_e)² + r_e² + (0.01·r_max)²
//! ```
//!
//! s the slope of a line in one trial, with its error; r that of the line which the change makes of
//! it, in the trials that are right; r_max the largest under the same load. The scatter about the
//! lines counts too: it is that of the others times the factor on the readings.
//!
//! Trials at different stations have no line in common: there the rod file stands between them.

use std::collections::BTreeSet;

use super::super::effects::mistakes::SIGN_MISTAKE;
use super::super::numbering::numbered;
use super::groups::group;
use super::lines::{Fit, Line, wrong_load};
use super::part::Part;
use super::possible::PossibleMistake;
use super::relabelling::Relabelling;
use super::search::{ALIKE as NO_WORSE, ODDS, RARE};
use crate::diagnosis::rig::recording::columns::{rows_of, trial_name};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::diagnosis::rig::recording::resolution::resolution;
use crate::statistics::median;

/// Slopes that differ by less than this share, or by so many standard errors, may be one.
const ALIKE: f64 = 0.25;
const ERRORS: f64 = 6.0;
/// Lines that show less than this share of the most that a trial shows say nothing.
const SHOWN: f64 = 0.1;
/// More classes than these are none.
const MOST_CLASSES: usize = 4;
/// Slopes of one rod on one rig are the same within this share of the largest.
const REPEATS: f64 = 0.01;
/// How far the scatter of one trial may be from that of others, ln.
const SCATTERS: f64 = 0.7;
/// Share of the squares of the deflections that a change must find, and that it may leave.
const OFF: f64 = 0.05;
const LEFT: f64 = 0.02;
/// What a rod file may leave of a class that it confirms.
const CONFIRMED: f64 = 0.1;
/// Lines of one sensor at two stations, each over that of the rod file, are alike within this
/// ratio: a soft clamp shows near the root first.
const ELSEWHERE: f64 = 3.0;
/// How well a rod file that is confirmed elsewhere knows a line.
const BY_FILE: f64 = 0.15;

/// A mistake in the rows of some trials.
pub(super) struct InTrials {
    pub part: Part,
    pub relabelling: Relabelling,
}

/// A line in one trial.
#[derive(Clone, Copy)]
struct Cell {
    fit: Fit,
    /// The largest load, N.
    load: f64,
}

impl Cell {
    /// What it shows at the largest load, m.
    fn size(&self) -> f64 {
        self.fit.slope.abs() * self.load
    }

    fn is_like(&self, other: &Cell) -> bool {
        let apart = (self.fit.slope - other.fit.slope).abs();
        let larger = self.fit.slope.abs().max(other.fit.slope.abs());
        apart < ALIKE * larger || apart < ERRORS * self.fit.error.hypot(other.fit.error)
    }
}

/// A line in the trials that are right: m/N, m/N and m.
#[derive(Clone)]
struct Right {
    slope: f64,
    error: f64,
    scatter: f64,
}

/// Trials by the lines of a recording.
pub(super) struct Table<'a> {
    data: &'a [Datum],
    lines: &'a [Line],
    /// For each datum its trial, in the order of recording.
    trial: Vec<usize>,
    /// By trial and line.
    cells: Vec<Vec<Option<Cell>>>,
    /// The slope of each line by the rod file, m/N.
    by_rod: Option<&'a [f64]>,
    /// Trials that agree in all lines which they have in common.
    classes: Vec<Vec<usize>>,
}

impl<'a> Table<'a> {
    /// What is written otherwise in some trials than in the others, by one of these `mistakes`.
    pub fn found(&self, mistakes: &[PossibleMistake]) -> Vec<InTrials> {
        let classes = &self.classes;
        if classes.len() < 2 || classes.len() > MOST_CLASSES {
            return Vec::new();
        }
        let count = |class: &[usize]| self.trial.iter().filter(|trial| class.contains(trial)).count();
        // of those that are as large, the first
        let largest = |some: &mut dyn Iterator<Item = usize>| {
            some.fold(None, |best: Option<usize>, class| match best {
                Some(best) if count(&classes[best]) >= count(&classes[class]) => Some(best),
                _ => Some(class),
            })
        };
        let is_confirmed =
            |class: &usize| self.by_rod.is_some_and(|rod| self.is_confirmed(&classes[*class], rod));
        let confirmed = largest(&mut (0..classes.len()).filter(is_confirmed));
        let Some(right) = confirmed.or_else(|| largest(&mut (0..classes.len()))) else { return Vec::new() };
        let shown = self.lines_of(&classes[right]);
        let reference = if confirmed.is_some() { self.completed(&shown) } else { shown.clone() };
        let others = classes.iter().enumerate().filter(|(class, _)| *class != right);
        others.filter_map(|(_, class)| self.explained(class, &reference, &shown, mistakes)).collect()
    }

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

    /// The lines that are right, and of those that they do not show what the rod file says.
    fn completed(&self, shown: &[Option<Right>]) -> Vec<Option<Right>> {
        let by_file = |k: usize| {
            let slope = self.by_rod?[k];
            Some(Right { slope, error: BY_FILE * slope.abs(), scatter: 0.0 })
        };
        shown.iter().enumerate().map(|(k, right)| right.clone().or_else(|| by_file(k))).collect()
    }

    /// Each line in some trials.
    fn lines_of(&self, class: &[usize]) -> Vec<Option<Right>> {
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

    fn is_confirmed(&self, class: &[usize], by_rod: &[f64]) -> bool {
        let right = |&slope: &f64| Some(Right { slope, error: 0.0, scatter: 0.0 });
        let right: Vec<_> = by_rod.iter().map(right).collect();
        let compared = self.compared(class, &right, &Relabelling::default(), |_| true);
        compared.is_some_and(|compared| compared.left < CONFIRMED)
    }

    /// Some trials, relabelled, against the lines that are right, and what is left of the lines
    /// that `counts`; `None` where there is nothing to compare.
    fn compared(
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

    /// What some trials hold instead, where one change brings them back to the others: those that
    /// are `right`, of which the recording itself has `shown` some.
    fn explained<'m>(
        &self,
        class: &[usize],
        right: &[Option<Right>],
        shown: &[Option<Right>],
        mistakes: &'m [PossibleMistake],
    ) -> Option<InTrials> {
        let tried = |one: &'m PossibleMistake| {
            let of_trials = |some: &[usize], relabelling: &Relabelling| {
                self.compared(some, right, relabelling, |line| acts_on(&one.relabelling, line))
            };
            let both = |some: &[usize]| {
                of_trials(some, &Relabelling::default()).zip(of_trials(some, &one.relabelling))
            };
            // a trial that has no line in common with the others of its class may be right
            let is_better =
                |trial: &usize| both(&[*trial]).is_some_and(|(before, after)| after.left < before.left);
            let class: Vec<usize> = class.iter().copied().filter(is_better).collect();
            let (before, after) = both(&class)?;
            let odds = RARE + one.log_prior + 0.5 * (before.misfit - after.misfit);
            Some(Tried { mistake: one, class, odds, before: before.left, left: after.left })
        };
        let mut tried: Vec<Tried> = mistakes.iter().filter_map(tried).collect();
        tried.sort_by(|a, b| b.odds.total_cmp(&a.odds));
        let Tried { mistake: best, class, odds, before, left } = tried.first()?;
        // signs of single lines are looked at reading by reading where others show the line
        let is_shown = |k: usize| {
            let is_in_class = class.iter().any(|&trial| self.cells[trial][k].is_some());
            is_in_class && shown[k].is_some() && acts_on(&best.relabelling, &self.lines[k])
        };
        let is_of_a_line = best.effect == &SIGN_MISTAKE
            && best.relabelling.reading != [[-1.0; 3]; 3]
            && (0..self.lines.len()).any(is_shown);
        if *before < OFF || *left > LEFT || *odds < ODDS || is_of_a_line {
            return None;
        }
        let place = self.place(class);
        let near = tried.iter().skip(1).take_while(|other| other.odds > odds - NO_WORSE);
        let here = |mistake: &PossibleMistake| mistake.location.clone().rows(&place);
        let rivals = near.map(|other| (other.mistake.effect, here(other.mistake)));
        let data: Vec<usize> = (0..self.data.len()).filter(|&i| class.contains(&self.trial[i])).collect();
        let most = class.iter().flat_map(|&trial| self.cells[trial].iter().flatten());
        let location = here(best);
        let part = Part {
            effect: best.effect,
            estimates: best.estimates.clone(),
            observed: format!("In {place}, {}", best.observed_in_some_rows()),
            looks_like: format!("in {place}, {}", best.looks_like),
            explains: most.map(Cell::size).fold(0.0, f64::max),
            rivals: rivals.filter(|(_, at)| *at != location).collect(),
            location,
            data,
        };
        Some(InTrials { part, relabelling: best.relabelling.clone() })
    }

    /// `trial 3`, `trials 3 and 4`, `rows 7 to 12`.
    fn place(&self, class: &[usize]) -> String {
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

/// True where a relabelling makes something else of a line.
fn acts_on(relabelling: &Relabelling, line: &Line) -> bool {
    let (axis, channel) = (line.axis.index(), line.channel.index());
    let is_as_it_was = relabelling.load[axis] == 1.0 && relabelling.reading[axis][channel] == 1.0;
    !is_as_it_was || relabelling.axis[axis] != axis || relabelling.channel[channel] != channel
}

/// A mistake in those trials of a class that it brings nearer to what is right.
struct Tried<'a> {
    mistake: &'a PossibleMistake,
    class: Vec<usize>,
    /// Ln of its odds against none.
    odds: f64,
    /// Shares of the squares of the deflections that are left without it and with it.
    before: f64,
    left: f64,
}

struct Compared {
    misfit: f64,
    /// Share of the squares of the deflections that is left.
    left: f64,
}
