//! The search: steps within a trust region, then Gauss–Newton steps to the last digit.
//!
//! Moré's form of Levenberg–Marquardt (*Lecture Notes in Mathematics* 630 (1978) 105–116): the step
//! minimises the linearised residuals within an ellipsoid ‖D·δ‖ ≤ Δ, which grows where the
//! linearisation proved good and shrinks where it did not. The sum of squares tells parameters
//! apart only to half of the digits, because it is flat at its minimum; so the last steps are
//! judged by the gradient instead, which is not.

use nalgebra::DVector;

use super::gauss_newton::GaussNewton;
use super::options::Options;
use super::reduced::Reduced;
use super::stacked::Stacked;
use super::tangent::{CLOSE_ENOUGH, Tangent};
use super::termination::TerminationReason;
use crate::error::Result;
use crate::linalg::RowReduction;
use crate::parallel::checkpoint;

/// Cosine below which the linearisation is trusted altogether and full steps are judged by the
/// gradient: its square, what is left to gain, is still far above the rounding of the sum of
/// squares.
const NEAR: f64 = 1e-6;
/// What a full step near the minimum has to gain in the cosine to be worth another.
const WORTHWHILE: f64 = 0.9;
/// What remains per iteration of the largest norm a column has had. Without fading, a start among
/// huge derivatives keeps the steps short for ever; with quick fading, a parameter that loses its
/// influence runs away.
const FADING: f64 = 0.995;
/// Actual over predicted reduction below which a step is taken back (Moré's 1e-4).
const ACCEPTABLE: f64 = 1e-4;
/// Change of the sum of squares, relative to it, that no evaluation can resolve.
const UNRESOLVED: f64 = 0.01 * f64::EPSILON;
/// Roundings that may add up in a residual, in units of what one rounding of each parameter causes.
const ROUNDINGS: f64 = 4.0;

/// The side of its box a parameter rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Lower,
    Upper,
}

/// Where the search ended.
pub(super) struct Minimum {
    pub parameters: DVector<f64>,
    /// Stacked residuals: weighted, then priors.
    pub residuals: DVector<f64>,
    /// The linearisation there.
    pub reduced: Reduced,
    /// The bound each parameter rests on and is pushed against.
    pub held: Vec<Option<Side>>,
    /// Number of combinations of the parameters that are not held which the residuals notice.
    pub rank: usize,
    /// Cosine between residuals and plane.
    pub cosine: f64,
    /// True where the start was a stationary point already.
    pub stood_still: bool,
    pub iterations: usize,
    pub evaluations: usize,
    pub reason: TerminationReason,
}

/// Searches a minimum of the stacked sum of squares from `start`, which must lie within the bounds
/// and where the problem's residuals are `at_start`.
pub(super) fn minimise(
    system: &Stacked,
    start: &DVector<f64>,
    at_start: &DVector<f64>,
    options: &Options,
) -> Result<Minimum> {
    let mut search = Search {
        system,
        options,
        store: system.store(),
        scale: DVector::zeros(start.len()),
        first_norms: None,
        evaluations: 0,
        iterations: 0,
    };
    let Some(mut here) = search.point(start.clone(), system.stacked(start, at_start)) else {
        return Ok(search.nowhere(start, TerminationReason::NonFiniteStart));
    };
    let Some(mut view) = search.linearise(&here)? else {
        return Ok(search.nowhere(start, TerminationReason::NonFiniteJacobian));
    };
    let stood_still = search.verdict(&here, &view, TerminationReason::NoProgress).is_converged();
    let mut radius = options.first_radius * view.length(&view.region, &here.p);
    if radius.is_nan() || radius == 0.0 {
        radius = f64::INFINITY;
    }
    let reason = loop {
        checkpoint();
        if search.iterations >= options.max_iterations {
            break search.verdict(&here, &view, TerminationReason::MaxIterations);
        }
        if view.full.rank == 0 && here.square > 0.0 && !view.free.is_empty() {
            break TerminationReason::NoInfluence;
        }
        let is_enough = !options.to_the_last_digit && view.cosine <= options.gradient_tolerance;
        if is_enough {
            break search.verdict(&here, &view, TerminationReason::Gradient);
        }
        if view.cosine <= NEAR || view.is_unresolved(&here) {
            if let Some(better) = search.polish(&here, &view)? {
                (here, view) = better;
                continue;
            }
            let verdict = search.verdict(&here, &view, TerminationReason::NoProgress);
            if verdict != TerminationReason::NoProgress {
                break verdict;
            }
        }
        let Some(next) = search.descend(&here, &view, &mut radius)? else {
            break search.verdict(&here, &view, TerminationReason::NoProgress);
        };
        match search.linearise(&next)? {
            Some(next_view) => (here, view) = (next, next_view),
            None => break TerminationReason::NonFiniteJacobian,
        }
    };
    Ok(Minimum {
        parameters: here.p,
        residuals: here.r,
        reduced: view.reduced,
        held: view.held,
        rank: view.full.rank,
        cosine: view.cosine,
        stood_still,
        iterations: search.iterations,
        evaluations: search.evaluations,
        reason,
    })
}

/// Factor on the radius after a step that reduced the squares by `ratio` < ¼ of what was predicted:
/// half for one that still was a gain, else to the minimum of the parabola through both ends of the
/// step (Moré, §5).
fn shrink(ratio: f64) -> f64 {
    match ratio {
        _ if ratio >= 0.0 => 0.5,
        // −∞ stands for no number at all
        _ if ratio.is_finite() => (0.5 / (1.0 - 0.5 * ratio)).clamp(0.1, 0.5),
        _ => 0.1,
    }
}

/// The tangent plane of a linearisation, columns scaled to norm 1, with the parameters held that
/// are held.
pub(super) fn tangent_plane(reduced: &Reduced, held: &[Option<Side>], options: &Options) -> Result<Tangent> {
    let free = free(held);
    let norms = of_free(&reduced.column_norms(), &free);
    Tangent::new(reduced, free, norms, options.rank_tolerance)
}

fn free(held: &[Option<Side>]) -> Vec<usize> {
    (0..held.len()).filter(|&j| held[j].is_none()).collect()
}

fn of_free(all: &DVector<f64>, free: &[usize]) -> DVector<f64> {
    DVector::from_iterator(free.len(), free.iter().map(|&j| all[j]))
}

/// Parameters, their residuals and the sum of squares.
struct Point {
    p: DVector<f64>,
    r: DVector<f64>,
    square: f64,
}

/// The linearisation at a point.
struct View {
    reduced: Reduced,
    held: Vec<Option<Side>>,
    /// Indices of the parameters that are not held.
    free: Vec<usize>,
    /// Norms of the columns, n: the scale of what judges rank and gradient, and makes full steps.
    norms: DVector<f64>,
    /// Largest norms of the columns so far, slowly forgotten, n: the scale of the trust region. A
    /// parameter that loses its influence is thereby not set free to run away.
    region: DVector<f64>,
    full: GaussNewton,
    /// The residual vector's projection on the tangent plane, relative to the vector.
    cosine: f64,
    /// What rounding alone can make of the residual vector.
    rounding: f64,
    /// A free parameter changed the residuals at the start and does so no longer.
    influence_lost: bool,
}

impl View {
    /// ‖D·v‖ over the free parameters, for scales and a vector of all n.
    fn length(&self, scale: &DVector<f64>, v: &DVector<f64>) -> f64 {
        self.free.iter().map(|&j| (scale[j] * v[j]).powi(2)).sum::<f64>().sqrt()
    }

    /// True where what is left to gain, the square of the projection, drowns in the rounding of the
    /// sum of squares: 2·‖r‖ times that of the residual vector. The gradient is then the better
    /// judge.
    fn is_unresolved(&self, here: &Point) -> bool {
        let projection = self.full.projection;
        projection <= self.rounding || projection.powi(2) <= 2.0 * self.rounding * here.square.sqrt()
    }

    /// A step of the free parameters as one of all n.
    fn of_all(&self, step: &DVector<f64>) -> DVector<f64> {
        let mut all = DVector::zeros(self.held.len());
        for (&j, &s) in self.free.iter().zip(step.iter()) {
            all[j] = s;
        }
        all
    }

    /// The tangent plane in the scale of the trust region, for steps that end within it.
    fn bounded(&self) -> Result<Tangent> {
        Tangent::new(&self.reduced, self.free.clone(), of_free(&self.region, &self.free), f64::EPSILON)
    }

    /// The Gauss–Newton step, n.
    fn full_step(&self) -> DVector<f64> {
        self.of_all(&self.full.step)
    }
}

struct Search<'a> {
    system: &'a Stacked<'a>,
    options: &'a Options,
    store: RowReduction,
    /// Largest norm each column of the Jacobian has had on the way, slowly forgotten: the D of the
    /// trust region.
    scale: DVector<f64>,
    /// Norms of the columns at the start, 0 for a column of zeros.
    first_norms: Option<DVector<f64>>,
    evaluations: usize,
    iterations: usize,
}

impl Search<'_> {
    /// The residuals at `p`, if they are finite.
    fn evaluate(&mut self, p: DVector<f64>) -> Option<Point> {
        let r = self.system.residuals(&p);
        self.point(p, r)
    }

    /// A point by its stacked residuals, if they are finite.
    fn point(&mut self, p: DVector<f64>, r: DVector<f64>) -> Option<Point> {
        self.evaluations += 1;
        let square = r.norm_squared();
        square.is_finite().then_some(Point { p, r, square })
    }

    /// The tangent plane at a point, if the Jacobian is finite.
    fn linearise(&mut self, here: &Point) -> Result<Option<View>> {
        self.iterations += 1;
        let Some(reduced) = self.system.linearise(&here.p, &here.r, &mut self.store)? else {
            return Ok(None);
        };
        let held = self.held(&here.p, &reduced.gradient());
        let free = free(&held);
        let norms = reduced.column_norms();
        self.scale = (&self.scale * FADING).sup(&norms);
        let influences = reduced.influences();
        let first = self.first_norms.get_or_insert_with(|| influences.clone());
        // a column of zeros from the start is a matter of rank, not of loss
        let influence_lost =
            free.iter().any(|&k| first[k] != 0.0 && influences[k] <= self.options.rank_tolerance * first[k]);
        let full = GaussNewton::new(&reduced, &free, &of_free(&norms, &free), self.options.rank_tolerance)?;
        let cosine = if here.square > 0.0 { full.projection / here.square.sqrt() } else { 0.0 };
        // one rounding of every parameter: ε·√Σ(‖Jⱼ‖·pⱼ)²
        let of_parameters = f64::EPSILON * norms.component_mul(&here.p).norm();
        let rounding = ROUNDINGS * of_parameters + self.system.rounding();
        let region = self.scale.clone();
        Ok(Some(View { reduced, held, free, norms, region, full, cosine, rounding, influence_lost }))
    }

    /// The bounds that parameters rest on while the gradient would carry them across.
    fn held(&self, p: &DVector<f64>, gradient: &DVector<f64>) -> Vec<Option<Side>> {
        let mut held = vec![None; p.len()];
        for (j, &(lower, upper)) in self.options.bounds.iter().enumerate() {
            if p[j] <= lower && gradient[j] > 0.0 {
                held[j] = Some(Side::Lower);
            } else if p[j] >= upper && gradient[j] < 0.0 {
                held[j] = Some(Side::Upper);
            }
        }
        held
    }

    /// `p` + `step`, brought back into the box.
    fn within_bounds(&self, p: &DVector<f64>, step: &DVector<f64>) -> DVector<f64> {
        let mut moved = p + step;
        for (j, &(lower, upper)) in self.options.bounds.iter().enumerate() {
            moved[j] = moved[j].clamp(lower, upper);
        }
        moved
    }

    /// A point with a smaller sum of squares, by shrinking the trust region until there is one.
    fn descend(&mut self, here: &Point, view: &View, radius: &mut f64) -> Result<Option<Point>> {
        let full_step = view.full_step();
        let full_length = view.length(&view.region, &full_step);
        // where the minimum of the linearisation is one point, it does not depend on the scale
        let unique = view.full.rank == view.free.len();
        let mut bounded = None;
        loop {
            let wanted = if unique && full_length <= (1.0 + CLOSE_ENOUGH) * *radius {
                full_step.clone()
            } else {
                let tangent = match bounded {
                    Some(tangent) => tangent,
                    None => view.bounded()?,
                };
                let step = view.of_all(&tangent.step_within(*radius));
                bounded = Some(tangent);
                step
            };
            let p = self.within_bounds(&here.p, &wanted);
            let step = &p - &here.p;
            let length = view.length(&view.region, &step);
            let predicted = view.reduced.predicted_reduction(&step);
            // below either limit rounding decides, not the step
            let moves = length > f64::EPSILON * view.length(&view.region, &here.p);
            if p == here.p || !moves || predicted.abs() <= UNRESOLVED * here.square {
                return Ok(None);
            }
            let next = self.evaluate(p);
            let ratio = match &next {
                // ‖r‖² − ‖r₊‖² as a product, which does not cancel
                Some(next) if predicted > 0.0 => (&here.r - &next.r).dot(&(&here.r + &next.r)) / predicted,
                _ => f64::NEG_INFINITY,
            };
            if ratio < 0.25 {
                *radius = shrink(ratio) * length.min(*radius);
            } else if ratio > 0.75 {
                *radius = radius.max(2.0 * length);
            }
            if ratio > ACCEPTABLE {
                return Ok(next);
            }
        }
    }

    /// A point with a smaller projection on the tangent plane, by a full Gauss–Newton step, if it
    /// is worth the while.
    fn polish(&mut self, here: &Point, view: &View) -> Result<Option<(Point, View)>> {
        let p = self.within_bounds(&here.p, &view.full_step());
        if p == here.p {
            return Ok(None);
        }
        let Some(next) = self.evaluate(p) else { return Ok(None) };
        if next.square.sqrt() > here.square.sqrt() * (1.0 + NEAR) + view.rounding {
            return Ok(None);
        }
        let Some(next_view) = self.linearise(&next)? else { return Ok(None) };
        let better = next_view.full.projection < WORTHWHILE * view.full.projection;
        Ok(better.then_some((next, next_view)))
    }

    /// Converged where it is; `otherwise` where the gradient is not zero.
    fn verdict(&self, here: &Point, view: &View, otherwise: TerminationReason) -> TerminationReason {
        let next_step = view.length(&view.norms, &view.full_step());
        let stands_still = next_step <= self.options.step_tolerance * view.length(&view.norms, &here.p);
        if view.influence_lost {
            TerminationReason::InfluenceLost
        } else if view.cosine <= self.options.gradient_tolerance {
            if stands_still { TerminationReason::GradientAndStep } else { TerminationReason::Gradient }
        } else if self.gradient_is_zero(view) {
            TerminationReason::Rounding
        } else {
            otherwise
        }
    }

    /// True where what is left of the gradient is below the tolerance, or rounding.
    fn gradient_is_zero(&self, view: &View) -> bool {
        view.cosine <= self.options.gradient_tolerance || view.full.projection <= view.rounding
    }

    /// The result of a search that could not begin.
    fn nowhere(&self, start: &DVector<f64>, reason: TerminationReason) -> Minimum {
        Minimum {
            parameters: start.clone(),
            residuals: self.system.residuals(start),
            reduced: Reduced::unknown(start.len()),
            held: vec![None; start.len()],
            rank: 0,
            cosine: f64::NAN,
            stood_still: false,
            iterations: self.iterations,
            evaluations: self.evaluations,
            reason,
        }
    }
}
