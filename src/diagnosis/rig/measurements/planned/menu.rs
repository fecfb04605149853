//! All measurements that a bench can make, and what so many repeats of each would tell.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::effort::{FEWEST, MOST_REPEATS, minutes};
use super::information::Information;
use super::rig_plan::{Bench, Distinguished, PlannedLoads, RigPlan};
use crate::beam::{Physics, RodModel};
use crate::diagnosis::rig::measurements::feasible::{Measurement, feasible};
use crate::diagnosis::rig::model::RigModel;
use crate::diagnosis::rig::model::wanted::Wanted;
use crate::error::{Error, Result};
use crate::inference::{Effect, ForwardModel, LoadPlan, Location};
use crate::rig::readings::{Axis, Direction, Phase, Reading, Readings};
use crate::rod::Rod;

/// Readings that might be made, once each, as one model.
pub(super) struct Menu {
    /// Each of them, from which the numbers of repeats are chosen.
    pub measurements: Vec<Measurement>,
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
    /// All that the bench can do to distinguish some effects.
    ///
    /// # Errors
    /// See [`super::plan`].
    pub fn new(rod: &Rod, between: &[&'static Effect], bench: &Bench) -> Result<Menu> {
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
                    phase: row.phase.or(Some(Phase::Load)),
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
        let groups = [&owner[..], &evidence.shared[..]];
        let information = Information::new(&unknown, &columns, bench.noise, groups, measurements.len());
        Ok(Menu { measurements, between: between.to_vec(), candidates, information })
    }

    /// For each candidate, beside each other effect and beside nothing, the least ln of the odds.
    pub fn log_odds(&self, counts: &[usize]) -> Vec<f64> {
        let others = self.between.len();
        let gram = self.information.of_repeats(counts);
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
    pub fn labour(&self, k: usize, repeats: usize) -> f64 {
        match repeats {
            0 => 0.0,
            _ => minutes(&LoadPlan { repeats, ..self.measurements[k].plan.clone() }),
        }
    }

    /// Minutes of each number of repeats, as far as they make a measurement.
    pub fn labours(&self, k: usize) -> Vec<f64> {
        let minutes = |repeats: usize| match repeats {
            1..FEWEST => f64::INFINITY,
            _ => self.labour(k, repeats),
        };
        (0..=MOST_REPEATS).map(minutes).collect()
    }

    /// Minutes of so many repeats of each.
    pub fn minutes(&self, counts: &[usize]) -> f64 {
        counts.iter().enumerate().map(|(k, repeats)| self.labour(k, *repeats)).sum()
    }

    /// The plan of so many repeats of each, with ln of the odds `now` and by `all` measurements.
    pub fn plan(&self, counts: &[usize], wanted: f64, [now, all]: [&[f64]; 2], is_least: bool) -> RigPlan {
        let chosen = counts.iter().enumerate().filter(|(_, repeats)| **repeats > 0);
        let measurements = chosen.map(|(k, &repeats)| {
            let plan = LoadPlan { repeats, ..self.measurements[k].plan.clone() };
            let task = &self.measurements[k].task;
            PlannedLoads {
                description: format!(
                    "{task}, {repeats} times, each time from a new zero; read dx, dy and dz."
                ),
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
