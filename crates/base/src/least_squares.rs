//! Nonlinear least squares: a scaled trust region (Levenberg–Marquardt), priors, bounds, robust
//! weights, the covariance of what was found, and why the search stopped.
//!
//! Minimised over the n parameters p, within their bounds, is
//!
//! S(p) = Σᵢ wᵢ·rᵢ(p)² + σ² · Σⱼ ((pⱼ − mⱼ)/sⱼ)²
//!
//! with m residuals r, robust weights w (1 without [`Options::robust`]) and Gaussian priors (mⱼ,
//! sⱼ), where there are any.
//!
//! A stop is called converged only where the residual vector stands orthogonal on everything the
//! parameters can still do to it (see [`TerminationReason`]); a direction the data say nothing
//! about is reported, never regularised.

mod covariance;
mod fit;
mod gauss_newton;
mod linear;
mod options;
mod problem;
mod reduced;
mod robust;
mod stacked;
mod tangent;
mod termination;
mod trust_region;

pub use covariance::{Covariance, Standing};
pub use fit::{Fit, Found, fit, search};
pub use linear::linear;
pub use options::{Noise, Options, Prior};
pub use problem::{Problem, assembled, central_differences};
pub use robust::{Robust, RobustScale};
pub use termination::TerminationReason;

#[cfg(test)]
mod tests;
