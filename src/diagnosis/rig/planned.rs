//! What to measure on a rig that has measured nothing yet, so that some effects can be
//! distinguished.
//!
//! An effect a of its usual size adds C_a·θ, θ ~ N(0, 1), to readings that scatter by Σ₀: noise,
//! the zero of each run, the rod's nominal numbers. Where a is what there is, the ln of the odds
//! against b that a plan is expected to give is
//!
//! ```text
//! ½·[tr(K_b⁻¹K_a) − n + ln|K_b| − ln|K_a|],   K = Σ₀ + C·Cᵀ
//! ```
//!
//! the Kullback–Leibler divergence of the two (D. V. Lindley, *Ann. Math. Statist.* 27 (1956)
//! 986–1005). Measurements are those that a diagnosis proposes from (`feasible.rs`), chosen one
//! after another as it does (`experiment_design.rs`): the least laborious one that leaves least of
//! the rivals; then whatever is not needed is given up again, and plans of less effort are ruled
//! out (`least.rs`).

#[cfg(test)]
mod tests;

mod information;
mod least;
mod ratio;

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use self::information::Information;
use self::least::least;
pub use self::ratio::plan_ratio;
use super::effects::registry;
use super::feasible::{Measurement, feasible};
use super::model::RigModel;
use super::wanted::Wanted;
use crate::beam::{Physics, RodModel};
use crate::error::{Error, Result};
use crate::inference::{Effect, ExperimentDesign, ForwardModel, LoadPlan, Location};
use crate::parallel::in_parallel;
use crate::rig::readings::{Axis, Direction, Reading, Readings};
use crate::rod::Rod;

/// Minutes that a new place of load or sensors takes, that a new zero takes, and that a reading
/// takes.
const SETUP: f64 = 10.0;
const ZEROING: f64 = 2.0;
const READING: f64 = 0.5;
/// Fewest repeats of a measurement, for the scatter has to be seen too; what is added at a time,
/// and most of all.
const FEWEST: usize = 3;
const ADDED: [usize; 3] = [1, 3, 6];
const MOST_REPEATS: usize = 12;
const MOST_ROUNDS: usize = 24;
/// What all measurements together would have to tell, in ln odds, times what is asked for: less
/// would take nearly all of them.
const REASONABLE: f64 = 2.0;
/// Plans of less effort that are tried at most.
const MOST_PLANS: usize = 1000;
/// Share of the rivals that a measurement has to take away.
const WORTH: f64 = 0.98;

/// What the rig can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bench {
    /// Largest load, N.
    pub largest_load: f64,
    /// Standard deviation of a reading's noise, m.
    pub noise: f64,
    /// True where loads hang and sensors stand at the tip only.
    pub is_at_tip: bool,
}

/// A plan, and what it will tell.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RigPlan {
    /// What to do, in its order.
    pub measurements: Vec<PlannedLoads>,
    /// How long that takes, minutes.
    pub minutes: f64,
    /// ln of the odds that were asked for.
    pub wanted: f64,
    /// Whether it is proven that no plan of less effort is enough; else it is known only that
    /// nothing of this one can be left out.
    pub is_least: bool,
    /// Each effect beside each other one, and beside nothing.
    pub distinguished: Vec<Distinguished>,
    /// The interval of r_rod, where that is what was asked for.
    pub ratio: Option<Ratio>,
}

/// Width of the 95 % interval of r_rod, a share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// At most so wide.
    pub asked: f64,
    /// As noise makes it.
    pub expected: f64,
}

/// One of its measurements.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedLoads {
    /// What to do; a full sentence.
    pub words: String,
    /// The same as numbers.
    pub loads: LoadPlan,
    /// How long that takes, minutes.
    pub minutes: f64,
}

/// How well one effect is distinguished from another.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Distinguished {
    /// What there is.
    pub effect: &'static Effect,
    /// What it may be taken for; `None` is nothing at all.
    pub against: Option<&'static Effect>,
    /// For each place where it may be the ln of the odds against the other one, wherever that is:
    /// that this plan is expected to give, and that all measurements together, repeated twelve
    /// times, would.
    pub places: Vec<(Location, f64, f64)>,
}

/// The effect of a rig that has this name.
pub fn effect_named(name: &str) -> Option<&'static Effect> {
    registry::ALL.into_iter().map(|effect| &effect.effect).find(|effect| effect.name == name)
}

/// Names of all effects of a rig.
pub fn effect_names() -> Vec<&'static str> {
    registry::ALL.into_iter().map(|effect| effect.effect.name).collect()
}

/// A plan of little effort that distinguishes effects of their usual sizes, `odds` to 1, and from
/// nothing; as far as the rig can do that with reasonable effort: where all measurements together
/// tell less than odds², nearly all of them would be needed. Where few plans take less effort, all
/// of them are looked at, and it is the least laborious one ([`RigPlan::is_least`]).
///
/// # Errors
/// [`Error::NotApplicable`] for an effect that no such measurement shows; what the beam model
/// refuses.
pub fn plan(rod: &Rod, between: &[&'static Effect], odds: f64, bench: &Bench) -> Result<RigPlan> {
    let menu = Menu::new(rod, between, bench)?;
    let wanted = odds.ln();
    let all = menu.log_odds(&vec![MOST_REPEATS; menu.measurements.len()]);
    // what cannot be distinguished with reasonable effort is not asked for
    let aims: Vec<f64> =
        all.iter().map(|best| if *best < REASONABLE * wanted { 0.0 } else { wanted }).collect();
    let mut counts = vec![0; menu.measurements.len()];
    let left = |log_odds: &[f64]| -> f64 {
        let short =
            |(log_odds, aim): (&f64, &f64)| if *aim > 0.0 { (-log_odds.min(*aim)).exp() } else { 0.0 };
        log_odds.iter().zip(&aims).map(short).sum()
    };
    let is_enough = |log_odds: &[f64]| log_odds.iter().zip(&aims).all(|(log_odds, aim)| log_odds >= aim);
    let mut now = vec![0.0; aims.len()];
    for _ in 0..MOST_ROUNDS {
        if is_enough(&now) {
            break;
        }
        let mut offers: Vec<Vec<usize>> = Vec::new();
        for k in 0..counts.len() {
            for more in ADDED {
                let mut offer = counts.clone();
                offer[k] = (counts[k] + more).max(FEWEST);
                if offer[k] <= MOST_REPEATS && !offers.contains(&offer) {
                    offers.push(offer);
                }
            }
        }
        offers.sort_by(|a, b| menu.minutes(a).total_cmp(&menu.minutes(b)));
        let log_odds = in_parallel(offers.len(), |k| menu.log_odds(&offers[k]));
        let mut design = ExperimentDesign::default();
        for (offer, log_odds) in offers.into_iter().zip(log_odds) {
            let useful: Vec<f64> =
                log_odds.iter().zip(&aims).map(|(log_odds, aim)| log_odds.min(*aim)).collect();
            design.offer((offer, log_odds), useful, &vec![1.0; aims.len()]);
        }
        let Some(((best, log_odds), _)) =
            design.best().filter(|((_, log_odds), _)| left(log_odds) < WORTH * left(&now))
        else {
            break;
        };
        (counts, now) = (best, log_odds);
    }
    if !is_enough(&now) {
        // some are distinguished by several measurements together only: from all of them, as many
        // as can be left out
        counts = vec![MOST_REPEATS; counts.len()];
        now.clone_from(&all);
        let mut order: Vec<usize> = (0..counts.len()).collect();
        order.sort_by(|&a, &b| menu.labour(b, 1).total_cmp(&menu.labour(a, 1)).then(b.cmp(&a)));
        for k in order {
            let mut fewer = counts.clone();
            fewer[k] = 0;
            let log_odds = menu.log_odds(&fewer);
            if is_enough(&log_odds) {
                (counts, now) = (fewer, log_odds);
            }
        }
    }
    // the most laborious first
    let reached: Vec<f64> = now.iter().zip(&aims).map(|(now, aim)| now.min(*aim)).collect();
    let is_kept =
        |log_odds: &[f64]| log_odds.iter().zip(&reached).all(|(log_odds, reached)| log_odds >= reached);
    let mut order: Vec<usize> = (0..counts.len()).filter(|&k| counts[k] > 0).collect();
    order.sort_by(|&a, &b| menu.labour(b, counts[b]).total_cmp(&menu.labour(a, counts[a])).then(a.cmp(&b)));
    for k in order {
        while counts[k] > 0 {
            let fewer = one_less(&counts, k);
            let log_odds = menu.log_odds(&fewer);
            if !is_kept(&log_odds) {
                break;
            }
            (counts, now) = (fewer, log_odds);
        }
    }
    let labour: Vec<Vec<f64>> = (0..counts.len()).map(|k| menu.labours(k)).collect();
    let found =
        least(&labour, menu.minutes(&counts), MOST_PLANS, &|counts| is_enough(&menu.log_odds(counts)));
    if let Some(better) = found.better {
        now = menu.log_odds(&better);
        counts = better;
    }
    Ok(menu.plan(&counts, wanted, [&now, &all], found.is_proven))
}

/// One repeat less of a measurement, or none.
fn one_less(counts: &[usize], k: usize) -> Vec<usize> {
    let mut fewer = counts.to_vec();
    fewer[k] = if counts[k] > FEWEST { counts[k] - 1 } else { 0 };
    fewer
}

/// The effort of a plan of loads, minutes.
pub fn minutes(loads: &LoadPlan) -> f64 {
    let up = loads.loads.len();
    let steps = if loads.unloading { 2 * up - 1 } else { up };
    let waiting = loads.waits.last().copied().unwrap_or_default() / 60.0;
    let readings = (steps * loads.waits.len()) as f64 * READING;
    SETUP + loads.repeats as f64 * (ZEROING + readings + waiting)
}

/// Readings that might be made, once each, as one model.
struct Menu {
    measurements: Vec<Measurement>,
    between: Vec<&'static Effect>,
    candidates: Vec<Placed>,
    information: Information,
}

/// A candidate.
struct Placed {
    effect: &'static Effect,
    place: Location,
    /// Which columns of all candidates' are its own.
    columns: Range<usize>,
}

impl Menu {
    fn new(rod: &Rod, between: &[&'static Effect], bench: &Bench) -> Result<Menu> {
        let seed = at_tip(rod, bench.largest_load)?;
        let is_possible = |measurement: &Measurement| {
            let plan = &measurement.plan;
            let is_bearable = plan.loads.iter().all(|load| *load <= bench.largest_load * (1.0 + 1e-9));
            is_bearable && (!bench.is_at_tip || (plan.load_station, plan.read_station) == (None, None))
        };
        let measurements: Vec<Measurement> =
            feasible(&seed, Some(rod)).into_iter().filter(is_possible).collect();
        let (mut rows, mut of_row) = (Vec::new(), Vec::new());
        let mut clock = 0.0;
        for (k, measurement) in measurements.iter().enumerate() {
            let new = &measurement.readings.rows[measurement.known_rows..];
            let first = new.first().and_then(|row| row.trial.clone());
            let mut since = None;
            for row in new.iter().filter(|row| row.trial == first) {
                // all on one clock
                let time = row.time.unwrap_or_default();
                let start = *since.get_or_insert(time - 30.0);
                rows.push(Reading {
                    trial: Some(k.to_string()),
                    phase: row.phase.or(Some(crate::rig::readings::Phase::Load)),
                    time: Some(clock + time - start),
                    ..row.clone()
                });
                of_row.push(k);
            }
            clock = rows.last().and_then(|row: &Reading| row.time).unwrap_or(clock) + 600.0;
        }
        // sizes are shares of the readings: those that the rod's model predicts
        let mut readings = Readings::from_rows(rows)?;
        let (model, _, _) = RigModel::with_effects(&readings, Some(rod), &Wanted::Like(&[]))?;
        for datum in model.data() {
            readings.rows[datum.row - 1].offset[datum.channel.index()] = Some(datum.predicted);
        }
        let (model, evidence, not_testable) = RigModel::with_effects(&readings, Some(rod), &Wanted::All)?;
        let (mut candidates, mut columns): (Vec<Placed>, Vec<DVector<f64>>) = Default::default();
        for (k, candidate) in model.candidates().iter().enumerate() {
            if between.contains(&candidate.effect) && !candidate.is_nonparametric {
                let first = columns.len();
                columns.extend(
                    model.columns(&[candidate.neutral(k)], 0).column_iter().map(|one| one.into_owned()),
                );
                candidates.push(Placed {
                    effect: candidate.effect,
                    place: candidate.location.clone(),
                    columns: first..columns.len(),
                });
            }
        }
        for effect in between {
            if candidates.iter().all(|known| known.effect != *effect) {
                let reason = not_testable.iter().find(|one| one.effect == *effect);
                return Err(Error::NotApplicable {
                    what: format!("a plan that shows {}", effect.name),
                    why: reason.map_or_else(|| "no load shows it".to_owned(), |one| one.reason.to_string()),
                    hint: "leave it out of --between".into(),
                });
            }
        }
        let owner: Vec<usize> = model.data().iter().map(|datum| of_row[datum.row - 1]).collect();
        let zeros = evidence.least_offset.iter().zip(evidence.offsets.column_iter());
        let zeros = zeros.map(|(least, column)| column * least.max(bench.noise));
        let all = evidence.nominal.column_iter().chain(evidence.background.column_iter());
        let unknown: Vec<DVector<f64>> = all.map(|column| column.into_owned()).chain(zeros).collect();
        let [unknown, columns] = [unknown, columns].map(|columns| match columns.is_empty() {
            true => DMatrix::zeros(owner.len(), 0),
            false => DMatrix::from_columns(&columns),
        });
        let of = [&owner[..], &evidence.shared[..]];
        let information = Information::new(&unknown, &columns, bench.noise, of, measurements.len());
        Ok(Menu { measurements, between: between.to_vec(), candidates, information })
    }

    /// For each candidate, beside each other effect and beside nothing, the least ln of the odds.
    fn log_odds(&self, counts: &[usize]) -> Vec<f64> {
        let others = self.between.len();
        let gram = self.information.of(counts);
        let columns_of = |i: usize| self.candidates[i].columns.clone();
        let shared = |j: usize, i: usize| {
            gram.view((columns_of(j).start, columns_of(i).start), (columns_of(j).len(), columns_of(i).len()))
        };
        let alone: Vec<Alone> =
            (0..self.candidates.len()).map(|i| Alone::new(shared(i, i).into_owned())).collect();
        let mut log_odds = Vec::with_capacity(self.candidates.len() * others);
        for (i, Placed { effect, .. }) in self.candidates.iter().enumerate() {
            log_odds.push(0.5 * (alone[i].gram.trace() - alone[i].ln));
            for other in self.between.iter().filter(|other| other != &effect) {
                let rivals = (0..self.candidates.len()).filter(|&j| self.candidates[j].effect == *other);
                let apart = |j: usize| {
                    let shared = shared(j, i);
                    let taken = &alone[j].inverse * (&alone[j].gram + shared * shared.transpose());
                    0.5 * (alone[i].gram.trace() - taken.trace() + alone[j].ln - alone[i].ln)
                };
                log_odds.push(rivals.map(apart).fold(f64::INFINITY, f64::min).max(0.0));
            }
        }
        log_odds
    }

    /// Minutes of one measurement.
    fn labour(&self, k: usize, repeats: usize) -> f64 {
        match repeats {
            0 => 0.0,
            _ => minutes(&LoadPlan { repeats, ..self.measurements[k].plan.clone() }),
        }
    }

    /// Minutes of each number of repeats, as far as they make a measurement.
    fn labours(&self, k: usize) -> Vec<f64> {
        let minutes = |repeats: usize| match repeats {
            1..FEWEST => f64::INFINITY,
            _ => self.labour(k, repeats),
        };
        (0..=MOST_REPEATS).map(minutes).collect()
    }

    fn minutes(&self, counts: &[usize]) -> f64 {
        counts.iter().enumerate().map(|(k, repeats)| self.labour(k, *repeats)).sum()
    }

    fn plan(&self, counts: &[usize], wanted: f64, [now, all]: [&[f64]; 2], is_least: bool) -> RigPlan {
        let chosen = counts.iter().enumerate().filter(|(_, repeats)| **repeats > 0);
        let measurements = chosen.map(|(k, &repeats)| {
            let plan = LoadPlan { repeats, ..self.measurements[k].plan.clone() };
            let words = &self.measurements[k].words;
            let what = words.split(", three times").next().unwrap_or(words).trim_end_matches('.');
            let what = what.split("; read").next().unwrap_or(what);
            PlannedLoads {
                words: format!("{what}, {repeats} times, each time from a new zero; read dx, dy and dz."),
                minutes: minutes(&plan),
                loads: plan,
            }
        });
        let others = self.between.len();
        let mut distinguished: Vec<Distinguished> = Vec::new();
        for (i, Placed { effect, place, .. }) in self.candidates.iter().enumerate() {
            let rivals = self.between.iter().filter(|other| *other != effect).map(|other| Some(*other));
            for (k, against) in [None].into_iter().chain(rivals).enumerate() {
                let entry = (place.clone(), now[i * others + k], all[i * others + k]);
                let is_known =
                    |known: &&mut Distinguished| (known.effect, known.against) == (*effect, against);
                match distinguished.iter_mut().find(is_known) {
                    Some(known) => known.places.push(entry),
                    None => distinguished.push(Distinguished { effect, against, places: vec![entry] }),
                }
            }
        }
        RigPlan {
            measurements: measurements.collect(),
            minutes: self.minutes(counts),
            is_least,
            wanted,
            distinguished,
            ratio: None,
        }
    }
}

/// G = CᵀΣ₀⁻¹C of one candidate, (1 + G)⁻¹ and ln|1 + G|.
struct Alone {
    gram: DMatrix<f64>,
    inverse: DMatrix<f64>,
    ln: f64,
}

impl Alone {
    fn new(gram: DMatrix<f64>) -> Alone {
        let whole = &gram + DMatrix::identity(gram.nrows(), gram.ncols());
        match whole.clone().cholesky() {
            Some(root) => Alone {
                ln: 2.0 * root.l_dirty().diagonal().map(f64::ln).sum(),
                inverse: root.inverse(),
                gram,
            },
            None => Alone { gram: &gram * 0.0, inverse: whole * 0.0, ln: 0.0 },
        }
    }
}

/// Loads at the tip along every axis in four steps, as the rod's model has them: what the menu is
/// written from.
fn at_tip(rod: &Rod, largest: f64) -> Result<Readings> {
    let model = RodModel::new(rod, &Physics::WHOLE, 1, &[])?;
    let [force, _] = model.chain.tip_motion();
    let mut rows = Vec::new();
    for axis in Axis::ALL {
        for step in 1..=4 {
            let load = largest * f64::from(step) / 4.0;
            let mut row = Reading::new(Direction::along(axis), load);
            for channel in Axis::ALL {
                row = row.with_offset(channel, force[(channel.index(), axis.index())] * load);
            }
            rows.push(row);
        }
    }
    Readings::from_rows(rows)
}
