//! The fit itself: minimised, weighted anew where outliers are to count less, and judged.

use nalgebra::DVector;

use super::covariance::Covariance;
use super::options::{Noise, Options};
use super::problem::Problem;
use super::robust::{Robust, RobustScale};
use super::stacked::Stacked;
use super::termination::TerminationReason;
use super::trust_region::{Minimum, minimise, tangent_plane};
use crate::error::{Error, Result};

/// What a fit found.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Estimates, n.
    pub parameters: DVector<f64>,
    /// Residuals rᵢ at the estimates, m, without weights and priors.
    pub residuals: DVector<f64>,
    /// Robust weights wᵢ in [0, 1], m; all 1 without a robust option.
    pub weights: DVector<f64>,
    /// S at the estimates: weighted residuals and priors.
    pub sum_of_squares: f64,
    /// Residuals and priors less the rank: what remains to judge the fit by.
    pub degrees_of_freedom: usize,
    /// √(S/dof), or for a robust fit the s of [`Robust`]; `None` without degrees of freedom.
    pub residual_sd: Option<f64>,
    /// Covariance, standard errors, correlations, rank and null space.
    pub covariance: Covariance,
    /// Cosine between the residual vector and the tangent plane at the end; 0 at an exact minimum.
    pub gradient_cosine: f64,
    /// Jacobians evaluated.
    pub iterations: usize,
    /// Residual vectors evaluated.
    pub evaluations: usize,
    /// Why the search stopped.
    pub reason: TerminationReason,
}

/// Fits the parameters of `problem`, starting from `start`.
///
/// A start far from the minimum is fine, a model that yields NaN or ±∞ on the way too: such steps
/// are taken back. A search without success is no error; look at [`Fit::reason`].
///
/// # Errors
/// [`Error::Argument`] for a start, prior, bound or option that makes no sense, or a problem whose
/// residuals or Jacobian have another shape than it says; [`Error::Numerical`] where the singular
/// value decomposition fails.
pub fn fit(problem: &dyn Problem, start: &DVector<f64>, options: &Options) -> Result<Fit> {
    let found = search(problem, start, options)?;
    if options.robust == Robust::None || !found.is_converged() {
        return found.judged();
    }
    let m = found.residual_count;
    let unweighted = Stacked::new(problem, DVector::from_element(m, 1.0), options);
    let (minimum, weights, scale) = reweighted(problem, found.minimum, options)?;
    // J without weights is finite, for J with weights was
    let stacked = unweighted.residuals(&minimum.parameters);
    let reduced = unweighted.linearise(&minimum.parameters, &stacked, &mut unweighted.store())?;
    let reduced = reduced.unwrap_or(minimum.reduced.clone());
    let tangent = tangent_plane(&reduced, &minimum.held, options)?;
    let residuals = problem.residuals(&minimum.parameters);
    let residual_sd = scale.and_then(|tau| options.robust.residual_sd(&residuals, tau, tangent.rank));
    let covariance = Covariance::new(&tangent, &minimum.held, residual_sd);
    Ok(Fit::new(residuals, minimum, weights, covariance, residual_sd))
}

/// Where a fit without robust weights ends, before anybody asks how well it knows it: for fits that
/// others follow, because the covariance takes as long as an iteration.
///
/// # Errors
/// As [`fit`].
pub fn search<'o>(problem: &dyn Problem, start: &DVector<f64>, options: &'o Options) -> Result<Found<'o>> {
    let at_start = check(problem, start, options)?;
    let residual_count = problem.residual_count();
    let unweighted = Stacked::new(problem, DVector::from_element(residual_count, 1.0), options);
    let minimum = minimise(&unweighted, start, &at_start, options)?;
    Ok(Found { options, residual_count, minimum })
}

/// What [`search`] found.
pub struct Found<'o> {
    options: &'o Options,
    residual_count: usize,
    minimum: Minimum,
}

impl Found<'_> {
    /// Estimates, n.
    pub fn parameters(&self) -> &DVector<f64> {
        &self.minimum.parameters
    }

    /// Number of combinations of the free parameters that the data determine.
    pub fn rank(&self) -> usize {
        self.minimum.rank
    }

    /// As [`Fit::is_converged`].
    pub fn is_converged(&self) -> bool {
        self.minimum.reason.is_converged()
    }

    /// The same with its covariance.
    ///
    /// # Errors
    /// [`Error::Numerical`] where the singular value decomposition fails.
    pub fn judged(self) -> Result<Fit> {
        let Found { options, residual_count: m, minimum } = self;
        let tangent = tangent_plane(&minimum.reduced, &minimum.held, options)?;
        let dof = (m + options.priors.len()).saturating_sub(tangent.rank);
        let residual_sd = (dof > 0).then(|| (minimum.residuals.norm_squared() / dof as f64).sqrt());
        let sigma = match options.noise {
            Noise::Known(sigma) => Some(sigma),
            Noise::Estimated => residual_sd,
        };
        let covariance = Covariance::new(&tangent, &minimum.held, sigma);
        // nothing is weighted, and priors follow
        let residuals = minimum.residuals.rows(0, m).into_owned();
        Ok(Fit::new(residuals, minimum, DVector::from_element(m, 1.0), covariance, residual_sd))
    }
}

impl Fit {
    /// True where the search ended at a stationary point within its tolerances; see
    /// [`TerminationReason`].
    pub fn is_converged(&self) -> bool {
        self.reason.is_converged()
    }

    /// Standard error of each parameter, n; `None` where it rests on a bound or is not identified.
    pub fn standard_errors(&self) -> Vec<Option<f64>> {
        self.covariance.standard_errors()
    }

    fn new(
        residuals: DVector<f64>,
        minimum: Minimum,
        weights: DVector<f64>,
        covariance: Covariance,
        residual_sd: Option<f64>,
    ) -> Self {
        Fit {
            residuals,
            weights,
            sum_of_squares: minimum.residuals.norm_squared(),
            degrees_of_freedom: minimum.residuals.len().saturating_sub(covariance.rank),
            residual_sd,
            covariance,
            gradient_cosine: minimum.cosine,
            iterations: minimum.iterations,
            evaluations: minimum.evaluations,
            reason: minimum.reason,
            parameters: minimum.parameters,
        }
    }
}

/// Alternates between weights and weighted fits until fresh weights leave the gradient at zero;
/// gives the fit, its weights and the scale they were made with.
///
/// The scale is re-estimated in the first passes and then held, so that what is being minimised no
/// longer moves.
fn reweighted(
    problem: &dyn Problem,
    mut minimum: Minimum,
    options: &Options,
) -> Result<(Minimum, DVector<f64>, Option<f64>)> {
    const PASSES: usize = 300;
    const PASSES_WITH_NEW_SCALE: usize = 10;
    let mut weights = DVector::from_element(problem.residual_count(), 1.0);
    let mut scale = None;
    for stage in options.robust.stages() {
        let mut settled = false;
        for pass in 0..PASSES {
            let residuals = problem.residuals(&minimum.parameters);
            if pass < PASSES_WITH_NEW_SCALE {
                scale = stage.scale_of(&residuals);
            }
            let Some(tau) = scale.filter(|&tau| tau > 0.0) else {
                // half of the residuals are exactly zero: there is nothing to measure outliers by
                return Ok((minimum, weights, None));
            };
            weights = stage.weights(&residuals, tau);
            let (iterations, evaluations) = (minimum.iterations, minimum.evaluations);
            let system = Stacked::new(problem, weights.clone(), options);
            minimum = minimise(&system, &minimum.parameters, &residuals, options)?;
            settled = minimum.stood_still && pass >= PASSES_WITH_NEW_SCALE;
            minimum.iterations += iterations;
            minimum.evaluations += evaluations + 1;
            if settled || !minimum.reason.is_converged() {
                break;
            }
        }
        if !minimum.reason.is_converged() {
            break;
        }
        if !settled {
            minimum.reason = TerminationReason::WeightsUnsettled;
            break;
        }
    }
    Ok((minimum, weights, scale))
}

/// Refuses what makes no sense; the residuals at the start otherwise.
fn check(problem: &dyn Problem, start: &DVector<f64>, options: &Options) -> Result<DVector<f64>> {
    let n = problem.parameter_count();
    let require = |holds: bool, name, found: &dyn std::fmt::Display, expected: String| match holds {
        true => Ok(()),
        false => Err(Error::Argument { name, found: found.to_string(), expected }),
    };
    let positive = |x: f64| x > 0.0 && x.is_finite();
    require(
        start.len() == n,
        "start",
        &format!("{} values", start.len()),
        format!("{n}, one per parameter"),
    )?;
    for p in start.iter() {
        require(p.is_finite(), "start", p, "finite numbers".into())?;
    }
    let count = options.bounds.len();
    require(count == 0 || count == n, "bounds", &count, format!("none or {n}, one pair per parameter"))?;
    for (&(lower, upper), p) in options.bounds.iter().zip(start.iter()) {
        let pair = format!("[{lower}, {upper}]");
        require(lower < upper, "bounds", &pair, "the lower bound below the upper one".into())?;
        require(lower <= *p && *p <= upper, "start", p, format!("a value within its bounds {pair}"))?;
    }
    for prior in &options.priors {
        let index = prior.parameter;
        require(index < n, "priors", &format!("parameter {index}"), format!("an index below {n}"))?;
        require(prior.value.is_finite(), "priors", &prior.value, "a finite mean".into())?;
        require(positive(prior.sd), "priors", &prior.sd, "a standard deviation > 0".into())?;
    }
    match options.noise {
        Noise::Known(sigma) => require(positive(sigma), "noise", &sigma, "a standard deviation > 0".into())?,
        Noise::Estimated => {
            let expected = "known where there are priors, to weigh them against the data".to_owned();
            require(options.priors.is_empty(), "noise", &"estimated", expected)?;
        }
    }
    let (tuning, scale) = match options.robust {
        Robust::None => (1.0, RobustScale::Mad),
        Robust::Huber { k, scale } => (k, scale),
        Robust::Tukey { c, scale } => (c, scale),
    };
    require(positive(tuning), "robust", &tuning, "a tuning constant > 0".into())?;
    if let RobustScale::Given(tau) = scale {
        require(positive(tau), "robust", &tau, "a scale > 0".into())?;
    }
    let (m, r) = (problem.residual_count(), problem.residuals(start));
    require(r.len() == m, "problem", &format!("{} residuals", r.len()), format!("{m}, as it says"))?;
    let radius = options.first_radius;
    require(radius > 0.0, "first_radius", &radius, "a number > 0".into())?;
    require(options.max_iterations > 0, "max_iterations", &0, "at least 1".into())?;
    Ok(r)
}
