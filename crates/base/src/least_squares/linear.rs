//! Linear least squares y ≈ X·β, as the special case of the nonlinear fit that it is.

use nalgebra::{DMatrix, DVector};

use super::fit::{Fit, fit};
use super::options::Options;
use super::problem::Problem;
use crate::error::{Error, Result};

/// Fits y ≈ X·β, minimising Σ wᵢ·(yᵢ − (X·β)ᵢ)².
///
/// `design` is X, m × n; `y` has m values; `weights` are wᵢ > 0 (1/σᵢ² up to a factor), m values,
/// or `None` for equal ones. Priors, bounds and robust weights come with `options` as in [`fit`].
/// The residuals of the result are √wᵢ·((X·β)ᵢ − yᵢ), and its `residual_sd` is that of an
/// observation with weight 1.
///
/// # Errors
/// [`Error::Argument`] where shapes or numbers make no sense; see also [`fit`].
pub fn linear(
    design: &DMatrix<f64>,
    y: &DVector<f64>,
    weights: Option<&DVector<f64>>,
    options: &Options,
) -> Result<Fit> {
    let (m, n) = design.shape();
    let argument = |name, found: String, expected: String| Err(Error::Argument { name, found, expected });
    if y.len() != m {
        return argument(
            "y",
            format!("{} values", y.len()),
            format!("{m}, one per row of the design matrix"),
        );
    }
    if let Some(w) = weights {
        if w.len() != m {
            return argument("weights", format!("{} values", w.len()), format!("{m}, one per observation"));
        }
        if let Some(w) = w.iter().find(|w| !(w.is_finite() && **w > 0.0)) {
            return argument("weights", w.to_string(), "finite numbers > 0".into());
        }
    }
    let root = weights.map_or_else(|| DVector::from_element(m, 1.0), |w| w.map(f64::sqrt));
    let line =
        Line { design: DMatrix::from_fn(m, n, |i, j| root[i] * design[(i, j)]), y: root.component_mul(y) };
    let start = DVector::from_fn(n, |j, _| match options.bounds.get(j) {
        Some(&(lower, upper)) if lower <= upper => 0.0f64.clamp(lower, upper),
        _ => 0.0,
    });
    // the first full step is the answer
    fit(&line, &start, &Options { first_radius: f64::INFINITY, ..options.clone() })
}

/// √W·(X·β − y).
struct Line {
    design: DMatrix<f64>,
    y: DVector<f64>,
}

impl Problem for Line {
    fn parameter_count(&self) -> usize {
        self.design.ncols()
    }

    fn residual_count(&self) -> usize {
        self.design.nrows()
    }

    fn residuals(&self, beta: &DVector<f64>) -> DVector<f64> {
        &self.design * beta - &self.y
    }

    fn jacobian(&self, _: &DVector<f64>) -> DMatrix<f64> {
        self.design.clone()
    }

    fn residual_rounding(&self) -> f64 {
        f64::EPSILON * self.y.amax()
    }
}
