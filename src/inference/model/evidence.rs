//! A recording as numbers: what is left of the base model, how it scatters, and what hangs
//! together.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::inference::noise::correlated_noise::CorrelatedNoise;
use crate::inference::{NominalParameter, Variable};

/// A recording as the engine sees it, n data.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Evidence {
    /// Recorded less predicted by the base model, n, in one unit for all (m).
    pub residual: DVector<f64>,
    /// How many of them, from the first, were recorded; the others are known besides.
    pub recorded: usize,
    /// What the base model can absorb by itself: n × k, any columns, none for a model that is not
    /// fitted.
    pub nuisance: DMatrix<f64>,
    /// What the base model is always a little wrong by: n × b, each column times the size of its
    /// unknown factor, whose prior is the standard normal. Part of every hypothesis.
    pub background: DMatrix<f64>,
    /// Columns of the background that stand for nominal numbers, once they stand there.
    pub folded: Range<usize>,
    /// The numbers of the model's file and of the set-up that are known to a standard uncertainty.
    pub nominal_numbers: Vec<NominalParameter>,
    /// For each of them a column of n: ∂predicted/∂number times its standard uncertainty.
    pub nominal: DMatrix<f64>,
    /// Offsets that data share for good, such as a zero that is taken once: a column of ones and
    /// zeros for each, and the least standard deviation of its size. A zero is as uncertain as
    /// readings are, whatever that is.
    pub offsets: DMatrix<f64>,
    /// See `offsets`.
    pub least_offset: Vec<f64>,
    /// Standard deviation of a datum's noise, where somebody stated it.
    pub stated_noise: Option<f64>,
    /// The largest root mean square that can be scatter; `None` where nothing is known of it.
    pub most_scatter: Option<f64>,
    /// True where single data may be far off: weights are found, and such data are remarks.
    pub is_robust: bool,
    /// Standard deviation of each datum's own noise over the usual one: 1 of all but those of a
    /// sensor that is known to be better or worse than the others.
    pub spread: Vec<f64>,
    /// True where somebody stated that too; else a stated noise is that of every datum.
    pub is_spread_stated: bool,
    /// Data of the same number are those of one sensor, whose noise may be its own.
    pub sensor: Vec<usize>,
    /// The least that the noise of each datum can be, by the step of its display, and the most, by
    /// what its sensor repeats; 0 and infinite where nothing says so.
    pub noise_range: Vec<(f64, f64)>,
    /// How much each datum counts: 1/spread², and less where tails are heavy.
    pub weight: Vec<f64>,
    /// Variance of the errors that data share, over that of their own; `None` where it is to be
    /// found out.
    pub shared_ratio: Option<f64>,
    /// Correlation of neighbours that share an error, beyond that; `None` where it is to be found
    /// out.
    pub correlation: Option<f64>,
    /// Course of each datum, along which neighbours may have errors in common, and its place there;
    /// nothing where none do.
    pub courses: Vec<Option<(usize, f64)>>,
    /// What they have in common; `None` where that is nothing.
    pub correlated_noise: Option<CorrelatedNoise>,
    /// What a datum says, over what it would say of a normal distribution: (ν + 1)/(ν + 3) of
    /// Student's t.
    pub information: f64,
    /// Repeats: data of the same number were recorded under the same conditions.
    pub replicate_group: Vec<usize>,
    /// Data of the same number share an error, such as the zero that their readings are offsets
    /// from.
    pub shared: Vec<usize>,
    /// Data of the same number are one series, such as those of one sensor under loads along one
    /// axis: where many of them are far off, they are no single ones.
    pub series: Vec<usize>,
    /// Data of the same number were read at one moment by sensors of their own, so that a single
    /// mistake concerns one of them.
    pub instant: Vec<usize>,
    /// Data of the same number are held out together; those of [`Evidence::NONE`] never are.
    pub fold: Vec<usize>,
    /// Data of the same number belong to one session, such as a clamp or a placement: what is found
    /// in the others must predict it. [`Evidence::NONE`] for what belongs to none.
    pub session: Vec<usize>,
    /// Data of the same number have a level that nobody knows, such as the place of a socket;
    /// [`Evidence::NONE`] for none.
    pub intercept: Vec<usize>,
    /// Smallest step of the recorded numbers: what is below it is rounding.
    pub resolution: f64,
    /// Numbers that a mismatch may follow.
    pub covariates: Vec<Covariate>,
}

impl Evidence {
    /// Standard deviation that rounding to the resolution q makes by itself: q/√12.
    pub fn rounding(&self) -> f64 {
        self.resolution / 12.0f64.sqrt()
    }

    /// Number of no fold, session or intercept: of what is known besides the recording, or has
    /// none.
    pub const NONE: usize = usize::MAX;

    /// Of residuals that have nothing to do with each other, each in a fold of none.
    pub fn new(residual: DVector<f64>) -> Evidence {
        let count = residual.len();
        Evidence {
            recorded: count,
            residual,
            nuisance: DMatrix::zeros(count, 0),
            background: DMatrix::zeros(count, 0),
            folded: 0..0,
            nominal_numbers: Vec::new(),
            nominal: DMatrix::zeros(count, 0),
            offsets: DMatrix::zeros(count, 0),
            least_offset: Vec::new(),
            stated_noise: None,
            most_scatter: None,
            is_robust: false,
            spread: vec![1.0; count],
            is_spread_stated: false,
            sensor: vec![0; count],
            noise_range: vec![(0.0, f64::INFINITY); count],
            weight: vec![1.0; count],
            shared_ratio: None,
            correlation: None,
            courses: Vec::new(),
            correlated_noise: None,
            information: 1.0,
            replicate_group: (0..count).collect(),
            shared: (0..count).collect(),
            series: vec![0; count],
            instant: (0..count).collect(),
            fold: vec![Evidence::NONE; count],
            session: vec![Evidence::NONE; count],
            intercept: vec![Evidence::NONE; count],
            resolution: 0.0,
            covariates: Vec::new(),
        }
    }

    /// How much each datum counts where no tails are heavy: 1/spread².
    pub fn even_weight(&self) -> Vec<f64> {
        self.spread.iter().map(|own| own.powi(-2)).collect()
    }

    /// False of a datum that was found far off, and hardly counts for that.
    pub fn counts(&self, row: usize) -> bool {
        const HARDLY: f64 = 1e-3;
        self.weight[row] * self.spread[row].powi(2) > HARDLY
    }

    /// Numbers of the folds, ascending.
    pub fn folds(&self) -> Vec<usize> {
        let mut folds: Vec<usize> =
            self.fold.iter().copied().filter(|&fold| fold != Evidence::NONE).collect();
        folds.sort_unstable();
        folds.dedup();
        folds
    }

    /// The data of these rows.
    pub fn part(&self, rows: &[usize]) -> Evidence {
        let pick = |numbers: &[usize]| rows.iter().map(|&row| numbers[row]).collect();
        Evidence {
            recorded: rows.iter().filter(|&&row| row < self.recorded).count(),
            residual: self.residual.select_rows(rows),
            nuisance: self.nuisance.select_rows(rows),
            background: self.background.select_rows(rows),
            folded: self.folded.clone(),
            nominal_numbers: self.nominal_numbers.clone(),
            nominal: self.nominal.select_rows(rows),
            offsets: self.offsets.select_rows(rows),
            least_offset: self.least_offset.clone(),
            stated_noise: self.stated_noise,
            most_scatter: self.most_scatter,
            is_robust: self.is_robust,
            spread: rows.iter().map(|&row| self.spread[row]).collect(),
            is_spread_stated: self.is_spread_stated,
            sensor: pick(&self.sensor),
            noise_range: rows.iter().map(|&row| self.noise_range[row]).collect(),
            weight: rows.iter().map(|&row| self.weight[row]).collect(),
            shared_ratio: self.shared_ratio,
            correlation: self.correlation,
            courses: match self.courses.is_empty() {
                true => Vec::new(),
                false => rows.iter().map(|&row| self.courses[row]).collect(),
            },
            correlated_noise: self.correlated_noise,
            information: self.information,
            replicate_group: pick(&self.replicate_group),
            shared: pick(&self.shared),
            series: pick(&self.series),
            instant: pick(&self.instant),
            fold: pick(&self.fold),
            session: pick(&self.session),
            intercept: pick(&self.intercept),
            resolution: self.resolution,
            covariates: Vec::new(),
        }
    }

    /// True where all data count alike and none share an offset.
    pub fn is_even(&self) -> bool {
        let mut shared = self.shared.clone();
        shared.sort_unstable();
        shared.dedup();
        shared.len() == self.residual.len() && self.weight.iter().all(|weight| *weight == 1.0)
    }

    /// The covariate of a variable, where the recording has it.
    pub fn covariate(&self, variable: Variable) -> Option<&Covariate> {
        self.covariates.iter().find(|covariate| covariate.variable == variable)
    }
}

/// A number that every datum has, along which a mismatch may be structured.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Covariate {
    /// The number that the values are of.
    pub variable: Variable,
    /// One per datum; NaN where it is not known.
    pub values: Vec<f64>,
}

impl Covariate {
    /// False where all known values are the same: nothing can follow what does not vary.
    pub fn varies(&self) -> bool {
        let mut known = self.values.iter().filter(|value| !value.is_nan());
        let first = known.next();
        known.any(|value| Some(value) != first)
    }
}

/// Root mean square.
///
/// ```
/// use rodcal::inference::rms;
///
/// assert!((rms(&vec![3.0, 4.0].into()) - 12.5f64.sqrt()).abs() < 1e-12);
/// ```
pub fn rms(v: &DVector<f64>) -> f64 {
    v.norm() / (v.len().max(1) as f64).sqrt()
}
