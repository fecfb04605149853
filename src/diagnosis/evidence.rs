//! A recording as numbers: what is left of the base model, how it scatters, and what hangs together.

use nalgebra::{DMatrix, DVector};

/// A recording as the engine sees it, n data.
#[derive(Debug, Clone)]
pub struct Evidence {
    /// Recorded less predicted by the base model, n, in one unit for all (m).
    pub residual: DVector<f64>,
    /// What the base model can absorb by itself: n × k, any columns, none for a model that is not fitted.
    pub nuisance: DMatrix<f64>,
    /// What the base model is always a little wrong by: n × b, each column times the size of its unknown factor, whose prior
    /// is the standard normal. Part of every story.
    pub background: DMatrix<f64>,
    /// Repeats: data of the same number were recorded under the same conditions.
    pub cell: Vec<usize>,
    /// Data of the same number share an error, such as the zero that their readings are offsets from.
    pub shared: Vec<usize>,
    /// Data of the same number are held out together; those of [`Evidence::KEPT`] never are.
    pub fold: Vec<usize>,
    /// Data of the same number belong to one session, such as a clamp or a placement: what is found in the others must
    /// predict it. [`Evidence::KEPT`] for what belongs to none.
    pub session: Vec<usize>,
    /// Data of the same number have a level that nobody knows, such as the place of a socket; [`Evidence::KEPT`] for none.
    pub level: Vec<usize>,
    /// Smallest step of the recorded numbers: what is below it is rounding.
    pub resolution: f64,
    /// Numbers that a mismatch may follow.
    pub covariates: Vec<Covariate>,
}

impl Evidence {
    /// Number of no fold, session or level: of what is known besides the recording, or has none.
    pub const KEPT: usize = usize::MAX;
}

/// A number that every datum has, along which a mismatch may be structured.
#[derive(Debug, Clone, PartialEq)]
pub struct Covariate {
    /// For people, for example `load`.
    pub name: String,
    /// Unit for people, `` for none.
    pub unit: String,
    /// One per datum; NaN where it is not known.
    pub values: Vec<f64>,
}
