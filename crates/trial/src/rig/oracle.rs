//! What could have been known at best: the oracle sees every reading without its noise.
//!
//! With δ what an effect adds, Σ the covariance of the noise, p the number of its parameters and C what a rival can add, at
//! the upper end of its range,
//!
//! ```text
//! log BF = ½·d² − (p/2)·ln(1 + d²)        d² = min over β of (δ − Cβ)ᵀΣ⁻¹(δ − Cβ) + βᵀβ;   against nothing C is empty
//! ```
//!
//! Rivals that may not be below zero are not. A rival is all that goes by one name, wherever it sits: the best place counts.
//! Every run's zero is a reading like any other, taken off all of its channel: Σ = s²·(1 + J) in a run and channel.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::bench::Bench;
use super::draw;
use super::effect::Effect;
use super::noise::Noise;
use crate::truth::Detectability;
use rodcal_base::units::MM;

/// Effects of other names closer than this cannot be told apart; places of one effect closer than that.
const SAME_EFFECT: f64 = 5.0;
const SAME_PLACE: f64 = 3.0;
/// Share of the upper end of its range at which a rival is linearised.
const TYPICAL: f64 = 0.05;
/// Half the step of a derivative, of the upper end of the range.
const STEP: f64 = 1e-3;
/// Stations of a scan for joints.
const STATIONS: usize = 40;

/// An effect that might be in the place of another one.
struct Rival {
    name: &'static str,
    location: String,
    station: Option<f64>,
    /// Whitened.
    columns: Vec<DVector<f64>>,
    is_one_sided: bool,
}

/// Knows a bench and its noise.
pub struct Oracle<'a> {
    /// With a slide that always sticks the same: how it happens to stick nobody can know.
    bench: Bench,
    noise: &'a Noise,
    rivals: Vec<Rival>,
}

impl<'a> Oracle<'a> {
    /// With every effect of the library that has a meaning for the bench.
    pub fn new(bench: &Bench, noise: &'a Noise) -> Self {
        let bench = Bench { sticking: vec![0.0; bench.sticking.len()], ..bench.clone() };
        let mut oracle = Oracle { bench, noise, rivals: Vec::new() };
        oracle.rivals = oracle.all_rivals();
        oracle
    }

    /// What of `effects` can be known of number `which`, given all others.
    pub fn detectability(&self, effects: &[Effect], which: usize) -> Detectability {
        let without: Vec<Effect> =
            effects.iter().enumerate().filter(|(k, _)| *k != which).map(|(_, e)| e.clone()).collect();
        let delta = self.added(effects, &without);
        // the size of the others is not known either
        let given: Vec<DVector<f64>> =
            (0..without.len()).map(|k| self.added(&without, &others(&without, k))).collect();
        let effect = &effects[which];
        let parameters = effect.parameters().len() as f64;
        let separation = |columns: &[DVector<f64>], is_one_sided: bool| {
            let square = remainder(&delta, &given, columns, is_one_sided);
            0.5 * square - 0.5 * parameters * square.ln_1p()
        };
        let mut best: BTreeMap<&str, f64> = BTreeMap::new();
        let (mut places, mut stations) = (Vec::new(), Vec::new());
        for rival in &self.rivals {
            let apart = separation(&rival.columns, rival.is_one_sided);
            if rival.name != effect.name() {
                let least = best.entry(rival.name).or_insert(f64::INFINITY);
                *least = least.min(apart);
            } else if apart < SAME_PLACE {
                places.push(rival.location.clone());
                stations.extend(rival.station);
            }
        }
        places.push(
            effect.location(|loading| run_name(&self.bench, loading), |index| cell_name(&self.bench, index)),
        );
        if let Effect::Joint { station, .. } = effect {
            stations.push(*station);
        }
        let nearest = best.iter().min_by(|a, b| a.1.total_cmp(b.1));
        Detectability {
            against_none: separation(&[], false),
            against_rival: nearest.map_or(f64::MAX, |(_, apart)| *apart),
            best_rival: nearest.map_or_else(String::new, |(name, _)| (*name).to_owned()),
            class: best
                .iter()
                .filter(|(_, apart)| **apart < SAME_EFFECT)
                .map(|(n, _)| (*n).to_owned())
                .collect(),
            places,
            stations_mm: (!stations.is_empty()).then(|| {
                let low = stations.iter().copied().fold(f64::INFINITY, f64::min);
                [low / MM, stations.iter().copied().fold(0.0, f64::max) / MM]
            }),
        }
    }

    /// What it says of other readings, m, after it has found the sizes of the effects out from what was `shown`: least squares
    /// about the truth, as Gauss and Newton's last step would be, with the upper end of its range as the standard deviation of
    /// every size. `None` where there is no size to be found.
    pub fn predicted(&self, effects: &[Effect], shown: &[f64], asked: &Bench) -> Option<Vec<f64>> {
        let here = self.bench.readings(effects);
        let error = self.whitened(shown.iter().zip(&here).map(|(a, b)| a - b).collect());
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
                columns.push(self.whitened(slope(&self.bench)));
                there.push(DVector::from_vec(slope(asked)));
                sizes.push(size / most);
            }
        }
        let n = columns.len();
        let normal = DMatrix::from_fn(n, n, |i, j| columns[i].dot(&columns[j]) + f64::from(u8::from(i == j)));
        let right = DVector::from_fn(n, |i, _| columns[i].dot(&error) - sizes[i]);
        let off = normal.cholesky().filter(|_| n > 0)?.solve(&right);
        let exact = DVector::from_vec(asked.readings(effects));
        let said = there.iter().zip(off.iter()).fold(exact, |said, (column, off)| said + column * *off);
        Some(said.iter().copied().collect())
    }

    /// Whitened difference of the readings with some effects and with others.
    fn added(&self, with: &[Effect], without: &[Effect]) -> DVector<f64> {
        let difference = self.bench.readings(with).into_iter().zip(self.bench.readings(without));
        self.whitened(difference.map(|(a, b)| a - b).collect())
    }

    /// Σ^(−1/2)·v: in a group of m with one shared error, (1 + J)^(−1/2) = 1 − (1 − 1/√(1 + m))/m·J.
    fn whitened(&self, mut v: Vec<f64>) -> DVector<f64> {
        let protocol = &self.bench.protocol;
        let sd = self.noise.variance(protocol.quantum).sqrt();
        let mut groups: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
        for (index, cell) in protocol.cells().iter().enumerate() {
            groups.entry((protocol.loadings[cell.loading].run, cell.channel)).or_default().push(index);
        }
        for rows in groups.values() {
            let m = rows.len() as f64;
            let sum: f64 = rows.iter().map(|&row| v[row]).sum();
            let off = (1.0 - 1.0 / (1.0 + m).sqrt()) / m * sum;
            rows.iter().for_each(|&row| v[row] -= off);
        }
        DVector::from_vec(v) / sd
    }

    fn all_rivals(&self) -> Vec<Rival> {
        let bench = &self.bench;
        let protocol = &bench.protocol;
        let clean = bench.readings(&[]);
        let sd = self.noise.variance(protocol.quantum).sqrt();
        let run_of = |loading: usize| run_name(bench, loading);
        let cells = protocol.cells();
        let cell_of = |index: usize| cell_name(bench, index);
        let rival = |parts: Vec<Effect>| -> Option<Rival> {
            let first = parts.first()?.clone();
            let columns: Vec<DVector<f64>> = parts
                .into_iter()
                .map(|part| {
                    bench.readings(&[part]).iter().zip(&clean).map(|(a, b)| (a - b) / TYPICAL).collect()
                })
                .map(|difference| self.whitened(difference))
                .filter(|column| column.norm() > 1e-6)
                .collect();
            let station = match &first {
                Effect::Joint { station, .. } => Some(*station),
                _ => None,
            };
            let location = first.location(run_of, cell_of);
            let (name, is_one_sided) = (first.name(), first.is_one_sided());
            (!columns.is_empty()).then_some(Rival { name, location, station, columns, is_one_sided })
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
        // slips and outliers need no mechanics: a step, and a single reading
        let unit = |rows: &dyn Fn(usize) -> bool, size: f64| {
            self.whitened((0..cells.len()).map(|row| if rows(row) { size } else { 0.0 }).collect())
        };
        for (index, cell) in cells.iter().enumerate() {
            let at = &protocol.loadings[cell.loading];
            if cell.channel == at.axis {
                let is_after = |row: usize| {
                    let other = cells[row];
                    let is_run = protocol.loadings[other.loading].run == at.run;
                    other.channel == cell.channel && is_run && other.loading >= cell.loading
                };
                rivals.push(Rival {
                    name: "slip",
                    location: format!("{}, after row {}", run_of(cell.loading), cell.loading),
                    station: None,
                    columns: vec![unit(&is_after, 500e-6)],
                    is_one_sided: false,
                });
            }
            rivals.push(Rival {
                name: "outlier",
                location: cell_of(index),
                station: None,
                columns: vec![unit(&|row| row == index, 50.0 * sd)],
                is_one_sided: false,
            });
        }
        rivals
    }
}

/// `y, trial 2`.
pub fn run_name(bench: &Bench, loading: usize) -> String {
    let protocol = &bench.protocol;
    protocol.loadings.get(loading).map_or_else(String::new, |l| protocol.run_name(l.run))
}

/// `row 17 dy`.
pub fn cell_name(bench: &Bench, index: usize) -> String {
    bench.protocol.cells().get(index).map_or_else(String::new, |cell| {
        format!("row {} d{}", cell.loading + 1, super::protocol::AXES[cell.channel])
    })
}

fn others(effects: &[Effect], which: usize) -> Vec<Effect> {
    effects.iter().enumerate().filter(|(k, _)| *k != which).map(|(_, effect)| effect.clone()).collect()
}

/// min over α, β of |δ − Gα − Cβ|² + |α|² + |β|², with β ≥ 0 where it is one-sided: all subsets of its few columns are
/// tried. α counts a change of the other effects' size by themselves.
fn remainder(
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
    use crate::rig::noise::Shape;

    #[test]
    fn a_remainder_is_a_ridge_regression_that_may_be_one_sided() {
        let delta = DVector::from_vec(vec![3.0, 4.0]);
        let column = vec![DVector::from_vec(vec![1.0, 0.0])];
        // β = 3/2: 1.5² + 16 + 1.5²
        assert!((remainder(&delta, &[], &column, true) - 20.5).abs() < 1e-12);
        let against = vec![DVector::from_vec(vec![-1.0, 0.0])];
        assert_eq!(remainder(&delta, &[], &against, true), 25.0);
        assert!((remainder(&delta, &[], &against, false) - 20.5).abs() < 1e-12);
    }

    #[test]
    fn friction_up_and_down_is_told_from_a_tare_and_a_scale_from_its_size() {
        let (bench, noise) = (bench(), Noise { sd: 1e-6, shape: Shape::Normal });
        let oracle = Oracle::new(&bench, &noise);
        let friction = Effect::Friction { axis: None, force: 0.5, presliding: 1e-6, scatter: 0.0 };
        let seen = oracle.detectability(&[friction], 0);
        assert!(seen.is_identifiable() && !seen.class.contains(&"load_offset".into()), "{seen:?}");
        assert!(seen.places.contains(&"slide".into()), "{seen:?}");
        let faint = Effect::StiffnessScale(0.9999);
        let unseen = oracle.detectability(&[faint], 0);
        assert!(!unseen.is_identifiable() && unseen.class.len() > 5, "{unseen:?}");
    }
}
