//! How to fit.

use super::robust::Robust;

/// How to fit. The defaults suit a well-posed problem with an exact Jacobian.
#[derive(Debug, Clone)]
pub struct Options {
    /// What is known beforehand about single parameters; at most one prior per parameter.
    /// Priors need [`Noise::Known`], for they are weighed against the data.
    pub priors: Vec<Prior>,
    /// Box each parameter must stay in; empty for none, else one `(lower, upper)` per parameter, ±∞
    /// allowed.
    pub bounds: Vec<(f64, f64)>,
    /// Standard deviation of the residuals: estimated from them, or known.
    pub noise: Noise,
    /// Weights that limit the influence of outliers.
    pub robust: Robust,
    /// Cosine between the residual vector and the tangent plane of the model below which the
    /// gradient is zero. It bounds the distance to the minimum: each parameter is within
    /// `gradient_tolerance · √dof` of its standard errors (Bates & Watts, *Technometrics* 23 (1981)
    /// 179–183).
    pub gradient_tolerance: f64,
    /// Whether the search goes on below the gradient tolerance, to the last digit that the
    /// arithmetic gives. Without it the search stops at the tolerance: for fits that are repeated,
    /// such as the passes of an outer loop.
    pub to_the_last_digit: bool,
    /// Relative length of the next Gauss–Newton step (scaled by the columns) below which the
    /// parameters no longer change.
    pub step_tolerance: f64,
    /// Singular value of the Jacobian (columns scaled to norm 1), relative to the largest, below
    /// which a direction counts as not identified. Raise it to ~1e-8 for a Jacobian by differences.
    pub rank_tolerance: f64,
    /// Most Jacobians evaluated in one minimisation.
    pub max_iterations: usize,
    /// Radius of the first trust region relative to the scaled length of the start; infinite tries
    /// a full Gauss–Newton step at once.
    pub first_radius: f64,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            priors: Vec::new(),
            bounds: Vec::new(),
            noise: Noise::Estimated,
            robust: Robust::None,
            gradient_tolerance: 1e-8,
            to_the_last_digit: true,
            step_tolerance: 1e-10,
            rank_tolerance: 1e-12,
            max_iterations: 1000,
            first_radius: 1.0,
        }
    }
}

/// What is known about one parameter before the data: normal with this mean and standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Index of the parameter.
    pub parameter: usize,
    /// Mean, in the parameter's unit.
    pub value: f64,
    /// Standard deviation > 0, in the parameter's unit.
    pub sd: f64,
}

/// Standard deviation σ of one residual, which scales the covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Noise {
    /// σ² = S/dof from the residuals themselves.
    Estimated,
    /// σ given, > 0, in the unit of the residuals (1 for residuals already divided by it).
    Known(f64),
}
