//! Whether an effect is a point of the grammar: for the tests of both libraries of effects.

use nalgebra::{DMatrix, DVector};

use super::{Form, Site};
use crate::linalg::thin_svd;

/// A place with a variable, by their names, and what the law is there; `sides` where it has the
/// sign of the last move.
#[derive(Debug, Clone, Copy)]
pub struct GrammarPoint {
    /// Of the law.
    pub place: &'static str,
    /// Name of its variable.
    pub variable: &'static str,
    /// Its form.
    pub form: Form,
    /// True where it has the sign of the last move.
    pub sides: bool,
}

/// cos of the least angle between what an effect may do to the data and what a law may do at this
/// point, a constant there besides (zeros of the recording and numbers of the files are that): 1
/// where one of the effect's columns is one of the law's. The number that is not linear is the
/// best one of `constants`, shares of the variable's largest value.
pub fn likeness(sites: &[Site], point: GrammarPoint, constants: &[f64], effect: &DMatrix<f64>) -> f64 {
    let is_it =
        |site: &&Site| site.location.to_string() == point.place && site.variable.name == point.variable;
    let effect = basis(effect);
    let mut best = 0.0;
    for site in sites.iter().filter(is_it) {
        for s in constants {
            let between = basis(&columns(site, point, *s)).transpose() * &effect;
            if !between.is_empty() {
                best = thin_svd(&between).unwrap().singular_values.max().max(best);
            }
        }
    }
    best
}

/// What the law does to the data, for each direction its constant and its functions.
fn columns(site: &Site, point: GrammarPoint, s: f64) -> DMatrix<f64> {
    let each = 1 + point.form.count();
    DMatrix::from_fn(site.values.len(), site.directions.len() * each, |i, k| {
        let weight = site.directions[k / each].1[i];
        if weight == 0.0 || site.values[i].is_nan() {
            return 0.0;
        }
        let side = if point.sides { site.moves[i] } else { 1.0 };
        match (k % each).checked_sub(1) {
            None => weight,
            Some(function) => {
                weight * side * point.form.functions(site.values[i] / site.largest(), s)[function]
            }
        }
    })
}

/// Orthonormal columns of the same span, by Gram and Schmidt; twice is enough.
fn basis(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let mut found: Vec<DVector<f64>> = Vec::new();
    for column in columns.column_iter() {
        let Some(mut left) = column.try_normalize(0.0) else { continue };
        for own in found.iter().chain(&found) {
            left -= own * own.dot(&left);
        }
        if left.norm() > 1e-9 {
            found.push(left.normalize());
        }
    }
    match found.is_empty() {
        true => DMatrix::zeros(columns.nrows(), 0),
        false => DMatrix::from_columns(&found),
    }
}
