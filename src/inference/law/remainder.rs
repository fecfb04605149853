//! What the findings leave, and what columns explain of it.
//!
//! Findings, nominal numbers and zeros are columns B with priors K (their own sizes), linear about
//! the values that were found. With them out, at the noise σ,
//!
//! ```text
//! G' = CᵀC − CᵀB·(BᵀB + σ²K⁻²)⁻¹·BᵀC      b' = Cᵀr − CᵀB·(BᵀB + σ²K⁻²)⁻¹·Bᵀr
//! ```
//!
//! is the problem of a law's columns C alone: many laws are compared on it. What a law amounts to
//! is fitted together with B.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::inference::noise::whitening::Whitening;
use crate::inference::score::{ColumnBlock, Moments, Score};
use crate::inference::{Evidence, ForwardModel, Term};
use crate::linalg::{positive_definite_inverse, transposed_product};

/// Sets of columns that are looked at together.
const TOGETHER: usize = 64;
const UNBOUNDED: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// What findings leave of all data, learned from some of them.
pub(super) struct Remainder<'a> {
    whole: &'a Evidence,
    /// Data that are learned from; the others are only predicted.
    rows: Vec<usize>,
    learned: Evidence,
    whitening: Whitening,
    /// Recorded less what the findings do at their values, plus their columns' part of it; and the
    /// columns, background first. Of all data.
    left: DVector<f64>,
    base: DMatrix<f64>,
    /// Of what is learned from, whitened.
    own_left: DVector<f64>,
    own_base: DMatrix<f64>,
    moments: Moments,
    /// What takes nuisance and B out of whitened columns c: G' = cᵀc − (Zᵀc)ᵀ(Zᵀc), b' = cᵀr'.
    taken: DMatrix<f64>,
    rest_left: DVector<f64>,
    /// What is left without B.
    rest: (Moments, Score),
    /// Ln of the evidence without a law.
    log_evidence: f64,
}

/// A law's columns fitted together with all else.
pub(super) struct Fitted {
    /// Ln of what the data are likelier with them.
    pub gain: f64,
    /// Noise of a datum.
    pub sigma: f64,
    /// Factors of the columns.
    pub factors: DVector<f64>,
    /// All data as predicted, and what the columns are of that.
    pub predicted: DVector<f64>,
    pub own: DVector<f64>,
    /// What the zeros are of it, and the rest of the background: nominal numbers.
    pub zeros: DVector<f64>,
    pub background: DVector<f64>,
    /// Factors of the background, and of the findings' columns about their values.
    pub base: DVector<f64>,
    /// Data less the numbers that they determine.
    pub degrees_of_freedom: f64,
}

impl<'a> Remainder<'a> {
    /// What `terms` leave of a settled evidence with its background in place, learned from `rows`;
    /// `sigma` is the noise of a datum, about.
    pub fn new(
        model: &dyn ForwardModel,
        whole: &'a Evidence,
        terms: &[Term],
        rows: Vec<usize>,
        sigma: f64,
    ) -> Remainder<'a> {
        let learned = whole.part(&rows);
        let candidates = model.candidates();
        let first = whole.background.ncols();
        let (mut base, mut offsets) = (whole.background.clone(), Vec::new());
        let (mut bounds, mut effects) = (vec![UNBOUNDED; first], Vec::new());
        for (position, term) in terms.iter().enumerate() {
            let own = model.columns(terms, position);
            let next = base.ncols();
            base = base.resize_horizontally(next + own.ncols(), 0.0);
            base.columns_mut(next, own.ncols()).copy_from(&own);
            let candidate = &candidates[term.candidate];
            let parameters = candidate.parameters.iter().zip(&term.values);
            offsets.extend(parameters.map(|(p, value)| (value - p.neutral) / p.size));
            bounds.extend(candidate.scaled_bounds());
            effects.push(own.ncols());
        }
        let findings = base.columns(first, base.ncols() - first);
        let left = &whole.residual - model.response(terms) + findings * DVector::from_vec(offsets);
        let whitening = Whitening::new(&learned, &left.select_rows(&rows));
        let own_left = whitening.apply(&left.select_rows(&rows));
        let own_base = whitening.apply_columns(&base.select_rows(&rows));
        let information = whitening.degrees_of_freedom as f64 * whole.information;
        let moments = Moments {
            square: own_left.norm_squared(),
            gram: transposed_product(&own_base, &own_base),
            product: own_base.tr_mul(&own_left),
            bounds,
            effects,
            degrees_of_freedom: information.round() as usize,
            floor: whole.rounding(),
            stated: whole.stated_noise,
        };
        let (inverse, rest) = without_base(&moments, first, sigma);
        let rest_left = &own_left - &own_base * (&inverse * &moments.product);
        let taken = taken(&whitening, &own_base, inverse);
        let log_evidence = moments.score().log_evidence;
        Remainder {
            whole,
            rows,
            learned,
            whitening,
            left,
            base,
            own_left,
            own_base,
            moments,
            taken,
            rest_left,
            rest,
            log_evidence,
        }
    }

    /// A residual of all data, where these are learned from, without the errors that data share.
    pub fn without_shared(&self, residual: &DVector<f64>) -> DVector<f64> {
        self.whitening.without_shared(residual)
    }

    /// What of each residual is none of the displacement where a law is fitted with all else: what
    /// that leaves, the zeros, and the law unless it displaces.
    pub fn no_displacement(&self, columns: &DMatrix<f64>, law_displaces: bool) -> DVector<f64> {
        let fitted = self.fit(columns);
        let other = &self.whole.residual - fitted.predicted + fitted.zeros;
        if law_displaces { other } else { other + fitted.own }
    }

    /// Columns of the background that are zeros.
    fn zeros(&self) -> std::ops::Range<usize> {
        let (first, known) = (self.whole.folded.end, self.whole.background.ncols());
        first.min(known)..(first + self.whole.offsets.ncols()).min(known)
    }

    fn own(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        self.whitening.apply_columns(&columns.select_rows(&self.rows))
    }

    /// Ln of what the data are likelier with these columns of all data, about; each times a factor
    /// of the standard normal, all of one unknown size.
    pub fn gain(&self, columns: &DMatrix<f64>) -> f64 {
        self.gains(1, |_| columns.clone())[0]
    }

    /// The same of many sets of columns, of as many each.
    pub fn gains(&self, count: usize, columns: impl Fn(usize) -> DMatrix<f64>) -> Vec<f64> {
        let mut gains = Vec::with_capacity(count);
        for first in (0..count).step_by(TOGETHER) {
            let sets: Vec<DMatrix<f64>> = (first..count.min(first + TOGETHER)).map(&columns).collect();
            gains.extend(self.alone(&sets).into_iter().map(|(gram, product)| self.gain_of(&gram, product)));
        }
        gains
    }

    fn gain_of(&self, gram: &DMatrix<f64>, product: DVector<f64>) -> f64 {
        let count = gram.ncols();
        let bounds = vec![UNBOUNDED; count];
        // nothing is beside them any more
        let nothing = DMatrix::zeros(0, count);
        let (cross, solved) = (nothing.as_view(), nothing.as_view());
        let block = ColumnBlock { gram, cross, solved, product: product.as_view(), bounds };
        let (rest, score) = &self.rest;
        let gain = rest.about(score, &block);
        if gain.is_finite() { gain } else { f64::NEG_INFINITY }
    }

    /// Factors of the columns and their covariance, with all else out of them.
    pub fn factors(&self, columns: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let (gram, product) = self.alone(std::slice::from_ref(columns)).swap_remove(0);
        let (bounds, effects) = (vec![UNBOUNDED; gram.ncols()], vec![gram.ncols()]);
        let scored = Moments { gram, product, bounds, effects, ..self.rest.0.clone() }.score();
        (scored.estimate, scored.covariance)
    }

    /// G' and b' of each set of columns.
    fn alone(&self, sets: &[DMatrix<f64>]) -> Vec<(DMatrix<f64>, DVector<f64>)> {
        let count: usize = sets.iter().map(DMatrix::ncols).sum();
        let mut all = DMatrix::zeros(self.rows.len(), count);
        let all_columns = sets.iter().flat_map(|set| set.column_iter());
        for (mut column, own) in all.column_iter_mut().zip(all_columns) {
            column.iter_mut().zip(&self.rows).for_each(|(value, &row)| *value = own[row]);
        }
        let whitened = self.whitening.whitened_columns(&all);
        let taken = transposed_product(&self.taken, &whitened);
        let mut first = 0;
        let of_set = |set: &DMatrix<f64>| {
            let (own, taken) = (whitened.columns(first, set.ncols()), taken.columns(first, set.ncols()));
            first += set.ncols();
            let mut gram = own.tr_mul(&own) - taken.tr_mul(&taken);
            // what the base holds already leaves rounding
            for k in 0..gram.ncols() {
                gram[(k, k)] = gram[(k, k)].max(0.0);
            }
            (gram, own.tr_mul(&self.rest_left))
        };
        sets.iter().map(of_set).collect()
    }

    /// The columns fitted together with findings and background; none for what is there without.
    pub fn fit(&self, columns: &DMatrix<f64>) -> Fitted {
        let own = self.own(columns);
        let (first, count) = (self.own_base.ncols(), own.ncols());
        let cross = transposed_product(&self.own_base, &own);
        let mut moments = self.moments.clone();
        let mut gram = moments.gram.resize(first + count, first + count, 0.0);
        gram.view_mut((0, first), (first, count)).copy_from(&cross);
        gram.view_mut((first, 0), (count, first)).copy_from(&cross.transpose());
        gram.view_mut((first, first), (count, count)).copy_from(&transposed_product(&own, &own));
        moments.gram = gram;
        moments.product = moments.product.resize_vertically(first + count, 0.0);
        moments.product.rows_mut(first, count).copy_from(&own.tr_mul(&self.own_left));
        moments.bounds.resize(first + count, UNBOUNDED);
        if count > 0 {
            moments.effects.push(count);
        }
        let scored = moments.score();
        let own_factors = scored.estimate.rows(first, count).into_owned();
        let own = columns * &own_factors;
        let known = self.whole.background.ncols();
        let (known, zeros) = (scored.estimate.rows(0, known), self.zeros());
        let zeros = self.whole.background.columns_range(zeros.clone()) * known.rows_range(zeros);
        let background = &self.whole.background * known - &zeros;
        let explained = &self.base * scored.estimate.rows(0, first) + &own;
        let predicted = &self.whole.residual - &self.left + self.with_nuisance(explained);
        Fitted {
            gain: scored.log_evidence - self.log_evidence,
            sigma: scored.sigma,
            factors: own_factors,
            predicted,
            own,
            zeros,
            background,
            base: scored.estimate.rows(0, first).into_owned(),
            degrees_of_freedom: (moments.degrees_of_freedom as f64 - scored.determined).max(1.0),
        }
    }

    /// With what the base model takes up by itself.
    fn with_nuisance(&self, explained: DVector<f64>) -> DVector<f64> {
        if self.whole.nuisance.ncols() == 0 {
            return explained;
        }
        let rest = (&self.left - &explained).select_rows(&self.rows);
        explained + &self.whole.nuisance * self.whitening.nuisance(&self.learned.nuisance, &rest)
    }
}

/// Z = [Q, B·L], Q the basis of the nuisance and L·Lᵀ the inverse.
fn taken(whitening: &Whitening, base: &DMatrix<f64>, inverse: DMatrix<f64>) -> DMatrix<f64> {
    let nuisance = whitening.basis();
    // of nothing there are no eigenvalues, and of no numbers none that are found
    if inverse.is_empty() || inverse.iter().any(|value| !value.is_finite()) {
        return nuisance;
    }
    let eigen = SymmetricEigen::new(inverse);
    let mut root = eigen.eigenvectors;
    for (mut column, value) in root.column_iter_mut().zip(eigen.eigenvalues.iter()) {
        column *= value.max(0.0).sqrt();
    }
    let mut taken = DMatrix::zeros(base.nrows(), nuisance.ncols() + base.ncols());
    taken.columns_mut(0, nuisance.ncols()).copy_from(&nuisance);
    taken.columns_mut(nuisance.ncols(), base.ncols()).copy_from(&(base * root));
    taken
}

/// (BᵀB + σ²K⁻²)⁻¹, and the problem of what is left.
fn without_base(moments: &Moments, first: usize, sigma: f64) -> (DMatrix<f64>, (Moments, Score)) {
    let scales = moments.score().scales;
    let square = sigma.powi(2).max(f64::MIN_POSITIVE.sqrt());
    let mut sum = moments.gram.clone();
    let of_effects = scales.iter().zip(&moments.effects);
    let of_effects = of_effects.flat_map(|(scale, &count)| std::iter::repeat_n(*scale, count));
    for (k, size) in std::iter::repeat_n(1.0, first).chain(of_effects).enumerate() {
        sum[(k, k)] += square / size.powi(2);
    }
    let count = sum.ncols();
    let inverse = positive_definite_inverse(&sum).map_or_else(|| DMatrix::zeros(count, count), |(i, _)| i);
    let determined = count as f64
        - (0..count).map(|k| (sum[(k, k)] - moments.gram[(k, k)]) * inverse[(k, k)]).sum::<f64>();
    let explained = moments.product.dot(&(&inverse * &moments.product));
    let rest = Moments {
        square: (moments.square - explained).max(0.0),
        gram: DMatrix::zeros(0, 0),
        product: DVector::zeros(0),
        bounds: Vec::new(),
        effects: Vec::new(),
        degrees_of_freedom: moments.degrees_of_freedom.saturating_sub(determined.round() as usize),
        floor: moments.floor,
        stated: moments.stated,
    };
    let score = rest.score();
    (inverse, (rest, score))
}
