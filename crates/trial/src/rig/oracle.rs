//! What could have been known at best: the oracle sees every reading without its noise, and knows
//! how well the numbers of the files are known.
//!
//! With δ what an effect adds, Σ the covariance of readings without one (`covariance.rs`), p the
//! number of its parameters and C what a rival can add, at the upper end of its range,
//!
//! ```text
//! log BF = ½·d² − (p/2)·ln(1 + d²)        d² = min over β of (δ − Cβ)ᵀΣ⁻¹(δ − Cβ) + βᵀβ;   against nothing C is empty
//! ```
//!
//! Rivals that may not be below zero are not. A rival is all that goes by one name, wherever it
//! sits: the best place counts. Physics that no library has must also differ from every two effects
//! of it.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::bench::Bench;
use super::covariance::{Covariance, nominal};
use super::draw;
use super::effect::Effect;
use super::noise::Noise;
use crate::effect_name::EffectName;
use crate::ground_truth::Detectability;
use crate::place::Place;
use rodcal_base::units::MM;

/// Effects of other names closer than this cannot be distinguished; places of one effect closer
/// than that.
const SAME_EFFECT: f64 = 5.0;
const SAME_PLACE: f64 = 3.0;
/// Share of the upper end of its range at which a rival is linearised.
const TYPICAL: f64 = 0.05;
/// Half the step of a derivative, of the upper end of the range.
const STEP: f64 = 1e-3;
/// Size of a slip, of the largest reading.
const SLIP: f64 = 0.5;
/// Stations of a scan for joints.
const STATIONS: usize = 40;
/// So many of the best rivals are paired with so many of the best.
const PAIRED: [usize; 2] = [4, 80];

/// An effect that might be in the place of another one.
struct Rival {
    name: EffectName,
    place: Place,
    station: Option<f64>,
    /// Whitened.
    columns: Vec<DVector<f64>>,
    is_one_sided: bool,
}

/// Knows a bench and its noise.
pub struct Oracle {
    /// With a slide that always sticks the same: how it happens to stick nobody can know.
    bench: Bench,
    covariance: Covariance,
    rivals: Vec<Rival>,
}

impl Oracle {
    /// One that compares with nothing being wrong only.
    pub fn new(bench: &Bench, noise: &Noise) -> Self {
        let bench = Bench { sticking: vec![0.0; bench.sticking.len()], ..bench.clone() };
        let covariance = Covariance::new(&bench, noise);
        Oracle { bench, covariance, rivals: Vec::new() }
    }

    /// Compares with every effect of the library that has a meaning for the bench too.
    pub fn compare(&mut self, noise: &Noise) {
        self.rivals = self.all_rivals(noise);
    }

    /// The share of an effect's size at which it would just be detectable: expected log Bayes
    /// factor against nothing of [`Detectability::IDENTIFIABLE`].
    pub fn limit(&self, effect: &Effect) -> f64 {
        let square = self.added(std::slice::from_ref(effect), &[]).norm_squared();
        let half = 0.5 * effect.parameters().len() as f64;
        let evidence = |share: f64| {
            let square = share * share * square;
            0.5 * square - half * square.ln_1p()
        };
        let (mut low, mut high) = (1e-6f64, 1e6f64);
        for _ in 0..60 {
            let middle = (low * high).sqrt();
            if evidence(middle) < Detectability::IDENTIFIABLE { low = middle } else { high = middle }
        }
        high
    }

    /// Mean square of what effects add and the numbers of the files do not take up, m².
    pub fn mean_square_left(&self, effects: &[Effect]) -> f64 {
        let (with, without) = (self.bench.readings(effects), self.bench.readings(&[]));
        let left = self.covariance.left(with.iter().zip(&without).map(|(a, b)| a - b).collect());
        left.iter().map(|x| x * x).sum::<f64>() / left.len().max(1) as f64
    }

    /// What of `effects` can be known of number `which`, given all others.
    pub fn detectability(&self, effects: &[Effect], which: usize) -> Detectability {
        let without = others(effects, which);
        let delta = self.added(effects, &without);
        // the size of the others is not known either
        let given: Vec<DVector<f64>> =
            (0..without.len()).map(|k| self.added(&without, &others(&without, k))).collect();
        let effect = &effects[which];
        let parameters = effect.parameters().len() as f64;
        let separation = |columns: &[DVector<f64>], is_one_sided: bool| {
            let square = squared_distance(&delta, &given, columns, is_one_sided);
            0.5 * square - 0.5 * parameters * square.ln_1p()
        };
        let mut best: BTreeMap<&EffectName, f64> = BTreeMap::new();
        let (mut places, mut stations) = (vec![effect.place(&self.bench.protocol)], Vec::new());
        for rival in &self.rivals {
            let apart = separation(&rival.columns, rival.is_one_sided);
            if rival.name != effect.name() {
                let least = best.entry(&rival.name).or_insert(f64::INFINITY);
                *least = least.min(apart);
            } else if apart < SAME_PLACE {
                places.push(rival.place.clone());
                stations.extend(rival.station);
            }
        }
        if let Effect::Joint { station, .. } = effect {
            stations.push(*station);
        }
        let nearest = best.iter().min_by(|a, b| a.1.total_cmp(b.1));
        Detectability {
            against_none: separation(&[], false),
            against_rival: nearest.map_or(f64::MAX, |(_, apart)| *apart),
            against_pair: None,
            best_rival: nearest.map_or_else(String::new, |(name, _)| name.to_string()),
            class: best
                .iter()
                .filter(|(_, apart)| **apart < SAME_EFFECT)
                .map(|(name, _)| (*name).clone())
                .collect(),
            places,
            stations_mm: (!stations.is_empty()).then(|| {
                let low = stations.iter().copied().fold(f64::INFINITY, f64::min);
                [low / MM, stations.iter().copied().fold(0.0, f64::max) / MM]
            }),
        }
    }

    /// Expected log Bayes factor of an effect against every two effects of the library together.
    pub fn against_pairs(&self, effects: &[Effect], which: usize) -> f64 {
        let without = others(effects, which);
        let delta = self.added(effects, &without);
        let given: Vec<DVector<f64>> =
            (0..without.len()).map(|k| self.added(&without, &others(&without, k))).collect();
        let half = 0.5 * effects[which].parameters().len() as f64;
        let separation = |columns: &[DVector<f64>], is_one_sided: bool| {
            let square = squared_distance(&delta, &given, columns, is_one_sided);
            0.5 * square - half * square.ln_1p()
        };
        let mut alone: Vec<(f64, &Rival)> =
            self.rivals.iter().map(|rival| (separation(&rival.columns, rival.is_one_sided), rival)).collect();
        alone.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = f64::MAX;
        for (_, first) in alone.iter().take(PAIRED[0]) {
            for (_, second) in alone.iter().take(PAIRED[1]) {
                let both = [first.columns.as_slice(), second.columns.as_slice()].concat();
                if both.len() <= 4 {
                    best = best.min(separation(&both, first.is_one_sided && second.is_one_sided));
                }
            }
        }
        best
    }

    /// What it says of other readings, m, after it has found the sizes of the effects out from what
    /// was `shown`: least squares about the truth, as Gauss and Newton's last step would be, with
    /// the upper end of its range as the standard deviation of every size, and the numbers of the
    /// files beside them. `None` where there is no size to be found.
    pub fn predicted(&self, effects: &[Effect], shown: &[f64], asked: &Bench) -> Option<Vec<f64>> {
        let here = self.bench.readings(effects);
        let whitened = |v: Vec<f64>| self.covariance.over_noise(DVector::from_vec(v));
        let error = whitened(shown.iter().zip(&here).map(|(a, b)| a - b).collect());
        let (mut columns, mut there, mut sizes) = (Vec::new(), Vec::new(), Vec::new());
        for (which, effect) in effects.iter().enumerate() {
            for (k, (size, most)) in effect.sizes(&self.bench).into_iter().enumerate() {
                let slope = |bench: &Bench| -> Vec<f64> {
                    let moved = |by: f64| {
                        let mut moved = effects.to_vec();
                        moved[which] = effect.resized(k, by * most);
                        bench.readings(&moved)
                    };
                    let (more, less) = (moved(STEP), moved(-STEP));
                    more.iter().zip(less).map(|(a, b)| (a - b) / (2.0 * STEP)).collect()
                };
                columns.push(whitened(slope(&self.bench)));
                there.push(DVector::from_vec(slope(asked)));
                sizes.push(size / most);
            }
        }
        if columns.is_empty() {
            return None;
        }
        for (which, (column, other)) in
            self.covariance.nominal.column_iter().zip(nominal(asked).column_iter()).enumerate()
        {
            columns.push(self.covariance.over_noise(column.into_owned()));
            there.push(other.into_owned());
            sizes.push(self.bench.actual.error(which));
        }
        let n = columns.len();
        let normal = DMatrix::from_fn(n, n, |i, j| columns[i].dot(&columns[j]) + f64::from(u8::from(i == j)));
        let right = DVector::from_fn(n, |i, _| columns[i].dot(&error) - sizes[i]);
        let off = normal.cholesky()?.solve(&right);
        let exact = DVector::from_vec(asked.readings(effects));
        let predicted =
            there.iter().zip(off.iter()).fold(exact, |predicted, (column, off)| predicted + column * *off);
        Some(predicted.iter().copied().collect())
    }

    /// Whitened difference of the readings with some effects and with others.
    fn added(&self, with: &[Effect], without: &[Effect]) -> DVector<f64> {
        let difference = self.bench.readings(with).into_iter().zip(self.bench.readings(without));
        self.covariance.whitened(difference.map(|(a, b)| a - b).collect())
    }

    fn all_rivals(&self, noise: &Noise) -> Vec<Rival> {
        let bench = &self.bench;
        let protocol = &bench.protocol;
        let clean = bench.readings(&[]);
        let largest = clean.iter().fold(0.0, |most: f64, reading| most.max(reading.abs()));
        let least = noise.variance(protocol.quantum).sqrt();
        let cells = protocol.cells();
        let rival = |parts: Vec<Effect>| -> Option<Rival> {
            let first = parts.first()?.clone();
            let columns: Vec<DVector<f64>> = parts
                .into_iter()
                .map(|part| {
                    bench.readings(&[part]).iter().zip(&clean).map(|(a, b)| (a - b) / TYPICAL).collect()
                })
                .map(|difference| self.covariance.whitened(difference))
                .filter(|column| column.norm() > 1e-6)
                .collect();
            let station = match &first {
                Effect::Joint { station, .. } => Some(*station),
                _ => None,
            };
            let place = first.place(protocol);
            let (name, is_one_sided) = (first.name(), first.is_one_sided());
            (!columns.is_empty()).then_some(Rival { name, place, station, columns, is_one_sided })
        };
        let mut rivals: Vec<Rival> = draw::all(bench, TYPICAL).into_iter().filter_map(rival).collect();
        let rotation = bench.drawing.rotation();
        let length = bench.drawing.length();
        let declared = bench.drawing.joints.iter().map(|(name, station)| (Some(name.clone()), *station));
        let scanned = (1..STATIONS).map(|k| (None, length * k as f64 / STATIONS as f64));
        rivals.extend(declared.chain(scanned).filter_map(|(name, station)| {
            let [bending, torsion] = rotation.map(|rotation| TYPICAL * rotation);
            rival(vec![
                Effect::Joint { name: name.clone(), station, bending, torsion: 0.0 },
                Effect::Joint { name, station, bending: 0.0, torsion },
            ])
        }));
        // slips need no mechanics: a step to the end of the run, or of the file where no zero
        // follows
        let size = (SLIP * largest).max(10.0 * least);
        let mut add = |effect: Effect, of_cell: &dyn Fn(usize) -> bool| {
            let step = (0..cells.len()).map(|row| if of_cell(row) { size } else { 0.0 }).collect();
            rivals.push(Rival {
                name: effect.name(),
                place: effect.place(protocol),
                station: None,
                columns: vec![self.covariance.whitened(step)],
                is_one_sided: false,
            });
        };
        for cell in &cells {
            let (loading, channel) = (cell.loading, cell.channel);
            let at = &protocol.loadings[loading];
            let is_later = |row: usize| cells[row].channel == channel && cells[row].loading >= loading;
            if channel == at.axis {
                add(Effect::Slip { loading, channel, by: size }, &|row| {
                    is_later(row) && protocol.loadings[cells[row].loading].run == at.run
                });
            }
            let is_first = loading > 0 && protocol.loadings[loading - 1].run != at.run;
            if protocol.zeroed_once && is_first {
                add(Effect::Shift { loading, channel, by: size }, &is_later);
            }
        }
        rivals
    }
}

fn others(effects: &[Effect], which: usize) -> Vec<Effect> {
    effects.iter().enumerate().filter(|(k, _)| *k != which).map(|(_, effect)| effect.clone()).collect()
}

/// min over α, β of |δ − Gα − Cβ|² + |α|² + |β|², with β ≥ 0 where it is one-sided: all subsets of
/// its few columns are tried. α counts a change of the other effects' size by themselves.
fn squared_distance(
    delta: &DVector<f64>,
    given: &[DVector<f64>],
    columns: &[DVector<f64>],
    is_one_sided: bool,
) -> f64 {
    let fitted = |chosen: &[&DVector<f64>]| -> Option<f64> {
        let k = chosen.len();
        let mut normal = DMatrix::from_fn(k, k, |i, j| chosen[i].dot(chosen[j]));
        let right = DVector::from_fn(k, |i, _| chosen[i].dot(delta));
        (0..k).for_each(|i| normal[(i, i)] += 1.0);
        let solved = normal.cholesky()?.solve(&right);
        let is_allowed = !is_one_sided || solved.iter().skip(given.len()).all(|value| *value >= 0.0);
        is_allowed.then(|| (delta.norm_squared() - right.dot(&solved)).max(0.0))
    };
    let subsets = (0..1u32 << columns.len()).filter_map(|mask| {
        let of_rival = columns.iter().enumerate().filter(|(k, _)| mask >> k & 1 == 1).map(|(_, c)| c);
        fitted(&given.iter().chain(of_rival).collect::<Vec<_>>())
    });
    subsets.fold(delta.norm_squared(), f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::bench::tests::bench;

    #[test]
    fn a_distance_is_a_ridge_regression_that_may_be_one_sided() {
        let delta = DVector::from_vec(vec![3.0, 4.0]);
        let column = vec![DVector::from_vec(vec![1.0, 0.0])];
        // β = 3/2: 1.5² + 16 + 1.5²
        assert!((squared_distance(&delta, &[], &column, true) - 20.5).abs() < 1e-12);
        let against = vec![DVector::from_vec(vec![-1.0, 0.0])];
        assert_eq!(squared_distance(&delta, &[], &against, true), 25.0);
        assert!((squared_distance(&delta, &[], &against, false) - 20.5).abs() < 1e-12);
    }

    #[test]
    fn friction_up_and_down_differs_from_a_tare_and_a_faint_scale_from_nothing() {
        let (bench, noise) = (bench(), Noise::normal(1e-6));
        let mut oracle = Oracle::new(&bench, &noise);
        oracle.compare(&noise);
        let friction = Effect::Friction { axis: None, force: 0.5, presliding: 1e-6, scatter: 0.0 };
        let seen = oracle.detectability(&[friction], 0);
        assert!(seen.is_identifiable() && !seen.class.contains(&"load_offset".into()), "{seen:?}");
        assert!(seen.places.contains(&Place::part("slide")), "{seen:?}");
        let faint = Effect::StiffnessScale(0.9999);
        let unseen = oracle.detectability(&[faint], 0);
        assert!(!unseen.is_identifiable() && unseen.class.len() > 5, "{unseen:?}");
    }
}
