//! What could have been known at best of a calibration: every coordinate without its noise, less
//! what the calibration and the numbers of the files take up.
//!
//! The measure is the rig's (`rig/oracle.rs`): with Σ₀ the covariance of the noise, N what a
//! standard uncertainty of each number does (`nuisance.rs`), Σ = Σ₀ + N·Nᵀ, δ what an effect adds
//! and C what a rival can add,
//!
//! ```text
//! log BF = ½·d² − (p/2)·ln(1 + d²)        d² = min over β of (δ − Cβ)ᵀΣ⁻¹(δ − Cβ) + βᵀβ;   against nothing C is empty
//! ```
//!
//! Σ^(−1/2) is Σ₀'s, then I − U·(1 − 1/√(1 + S²))·Uᵀ with U·S·Vᵀ what it makes of N. A rival's
//! columns are first order, of a size at the upper end of its range. An effect within the library
//! is a rival wherever it may sit; physics that no library has must also differ from every two of
//! them.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::draw::place;
use super::effect::Effect;
use super::nuisance;
use super::rivals::{Rival, rivals};
use super::site::Site;
use crate::effect_name::EffectName;
use crate::ground_truth::Detectability;
use rodcal_base::linalg::{thin_svd, transposed_product};

/// Effects of other names closer than this cannot be distinguished; places of one effect closer
/// than that.
const SAME_EFFECT: f64 = 5.0;
const SAME_PLACE: f64 = 3.0;
/// Less than this of a column is nothing, noises.
const NOTHING: f64 = 1e-3;

/// So many of the best rivals are paired with so many of the best.
const PAIRED: [usize; 2] = [4, 60];

/// Knows a site.
pub struct Oracle<'a> {
    site: &'a Site,
    /// U, and 1 − 1/√(1 + S²).
    directions: (DMatrix<f64>, DVector<f64>),
    /// Rows behind the coordinates.
    more: usize,
    rivals: Vec<Rival>,
}

impl<'a> Oracle<'a> {
    /// One that compares with nothing being wrong only.
    pub fn new(site: &'a Site) -> Self {
        let (columns, _) = nuisance::columns(site);
        let more = columns.nrows() - 3 * site.rows.len();
        let directions = thin_svd(&columns).map_or_else(
            |_| (DMatrix::zeros(columns.nrows(), 0), DVector::zeros(0)),
            |svd| {
                let shrink = svd.singular_values.iter().map(|s| 1.0 - 1.0 / (1.0 + s * s).sqrt());
                let shrink = DVector::from_iterator(svd.singular_values.len(), shrink);
                (svd.u, shrink)
            },
        );
        Oracle { site, directions, more, rivals: Vec::new() }
    }

    /// Compares with every effect of the library too; moves are tried after every row where one of
    /// `effects` is such a move.
    pub fn compare(&mut self, effects: &[Effect]) {
        let mut rivals = rivals(self.site, effects);
        let all = self.all_left(rivals.iter().flat_map(|rival| &rival.columns));
        let mut columns = all.column_iter().map(|column| column.into_owned());
        for rival in &mut rivals {
            let own: Vec<DVector<f64>> = columns.by_ref().take(rival.columns.len()).collect();
            rival.columns = own.into_iter().filter(|column| column.norm() > NOTHING).collect();
        }
        rivals.retain(|rival| !rival.columns.is_empty());
        self.rivals = rivals;
    }

    /// Σ^(−1/2)·v.
    fn left(&self, coordinates: &DVector<f64>) -> DVector<f64> {
        let rows = coordinates.len() + self.more;
        let whole = self.site.whitened(coordinates).resize_vertically(rows, 0.0);
        let (u, shrink) = &self.directions;
        let taken = u.tr_mul(&whole).component_mul(shrink);
        whole - u * taken
    }

    /// The same of many, in the columns of a matrix.
    fn all_left<'c>(&self, all: impl Iterator<Item = &'c DVector<f64>>) -> DMatrix<f64> {
        let (u, shrink) = &self.directions;
        let white: Vec<DVector<f64>> =
            all.map(|v| self.site.whitened(v).resize_vertically(u.nrows(), 0.0)).collect();
        let mut white = DMatrix::from_columns(&white);
        let mut taken = transposed_product(u, &white);
        taken.column_iter_mut().for_each(|mut column| column.component_mul_assign(shrink));
        white -= transposed_product(&u.transpose(), &taken);
        white
    }

    fn added(&self, effects: &[Effect], without: &[Effect]) -> DVector<f64> {
        self.left(&self.site.added(effects, without))
    }

    /// The share of an effect's size at which it would just be detectable: expected log Bayes
    /// factor against nothing of [`Detectability::IDENTIFIABLE`].
    pub fn limit(&self, effect: &Effect) -> f64 {
        let square = self.added(std::slice::from_ref(effect), &[]).norm_squared();
        let evidence = |share: f64| {
            let square = share * share * square;
            0.5 * square - 0.5 * effect.degrees_of_freedom() * square.ln_1p()
        };
        let (mut low, mut high) = (1e-6f64, 1e6f64);
        for _ in 0..60 {
            let middle = (low * high).sqrt();
            if evidence(middle) < Detectability::IDENTIFIABLE { low = middle } else { high = middle }
        }
        high
    }

    /// Squared noises that effects leave after the calibration, per coordinate.
    pub fn share_left(&self, effects: &[Effect]) -> f64 {
        self.added(effects, &[]).norm_squared() / (3 * self.site.rows.len()) as f64
    }

    /// What of `effects` can be known of number `which`, given all others.
    pub fn detectability(&self, effects: &[Effect], which: usize) -> Detectability {
        let (delta, given) = self.beside(effects, which);
        let effect = &effects[which];
        let separation = |columns: &[DVector<f64>]| evidence(effect, &delta, &given, columns);
        let own = effect.name(self.site.has_sockets());
        let mut best: BTreeMap<&EffectName, f64> = BTreeMap::new();
        let mut places = vec![place(effect, self.site)];
        let mut alone: Vec<(f64, &Rival)> = Vec::new();
        for rival in &self.rivals {
            let apart = separation(&rival.columns);
            alone.push((apart, rival));
            if rival.name != own {
                let least = best.entry(&rival.name).or_insert(f64::INFINITY);
                *least = least.min(apart);
            } else if apart < SAME_PLACE && !places.contains(&rival.place) {
                places.push(rival.place.clone());
            }
        }
        let nearest = best.iter().min_by(|a, b| a.1.total_cmp(b.1));
        alone.sort_by(|a, b| a.0.total_cmp(&b.0));
        let pairs = alone.iter().take(PAIRED[0]).flat_map(|(_, first)| {
            let both = |(_, second): &(f64, &Rival)| {
                separation(&first.columns.iter().chain(&second.columns).cloned().collect::<Vec<_>>())
            };
            alone.iter().take(PAIRED[1]).map(both).collect::<Vec<_>>()
        });
        Detectability {
            against_none: separation(&[]),
            against_rival: nearest.map_or(f64::MAX, |(_, apart)| *apart),
            against_pair: effect.is_beyond().then(|| pairs.fold(f64::MAX, f64::min)),
            best_rival: nearest.map_or_else(String::new, |(name, _)| name.to_string()),
            class: best.iter().filter(|(_, a)| **a < SAME_EFFECT).map(|(name, _)| (*name).clone()).collect(),
            places,
            stations_mm: None,
        }
    }

    /// What an effect adds to the others, and each of these, whose size is not known either.
    fn beside(&self, effects: &[Effect], which: usize) -> (DVector<f64>, Vec<DVector<f64>>) {
        let others: Vec<Effect> =
            effects.iter().enumerate().filter(|(k, _)| *k != which).map(|(_, e)| e.clone()).collect();
        let given = others.iter().map(|e| self.added(std::slice::from_ref(e), &[])).collect();
        (self.added(effects, &others), given)
    }
}

fn evidence(effect: &Effect, delta: &DVector<f64>, given: &[DVector<f64>], columns: &[DVector<f64>]) -> f64 {
    let square = squared_distance(delta, given, columns);
    0.5 * square - 0.5 * effect.degrees_of_freedom() * square.ln_1p()
}

/// min over α, β of |δ − Gα − Cβ|² + |α|² + |β|².
fn squared_distance(delta: &DVector<f64>, given: &[DVector<f64>], columns: &[DVector<f64>]) -> f64 {
    let all: Vec<&DVector<f64>> = given.iter().chain(columns).collect();
    let k = all.len();
    let mut normal = DMatrix::from_fn(k, k, |i, j| all[i].dot(all[j]));
    let right = DVector::from_fn(k, |i, _| all[i].dot(delta));
    (0..k).for_each(|i| normal[(i, i)] += 1.0);
    let explained = normal.cholesky().map_or(0.0, |cholesky| right.dot(&cholesky.solve(&right)));
    (delta.norm_squared() - explained).max(0.0)
}
