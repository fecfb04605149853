//! The search: steps within a trust region, then Gauss–Newton steps to the last digit.
//!
//! Moré's form of Levenberg–Marquardt (*Lecture Notes in Mathematics* 630 (1978) 105–116): the step minimises the
//! linearised residuals within an ellipsoid ‖D·δ‖ ≤ Δ, which grows where the linearisation proved good and shrinks
//! where it did not. The sum of squares tells parameters apart only to half of the digits, because it is flat at its
//! minimum; so the last steps are judged by the gradient instead, which is not.

use nalgebra::{DMatrix, DVector};

use super::stacked::Stacked;
use super::tangent::Tangent;
use super::{Options, TerminationReason};
use crate::error::Result;
use crate::linalg::with_unit_columns;

/// Cosine below which the linearisation is trusted altogether and full steps are judged by the gradient:
/// its square, what is left to gain, is still far above the rounding of the sum of squares.
const NEAR: f64 = 1e-6;
/// What a full step near the minimum has to gain in the cosine to be worth another.
const WORTHWHILE: f64 = 0.9;
/// What remains per iteration of the largest norm a column has had. Without fading, a start among huge derivatives
/// keeps the steps short for ever; with quick fading, a parameter that loses its influence runs away.
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
    /// Tangent plane with columns scaled to norm 1.
    pub tangent: Tangent,
    /// The bound each parameter rests on and is pushed against.
    pub held: Vec<Option<Side>>,
    /// Cosine between residuals and plane.
    pub cosine: f64,
    /// True where the start was a stationary point already.
    pub stood_still: bool,
    pub iterations: usize,
    pub evaluations: usize,
    pub reason: TerminationReason,
}

/// Searches a minimum of the stacked sum of squares from `start`, which must lie within the bounds.
pub(super) fn minimise(system: &Stacked, start: &DVector<f64>, options: &Options) -> Result<Minimum> {
    let mut search = Search {
        system,
        options,
        scale: DVector::zeros(start.len()),
        first_norms: None,
        evaluations: 0,
        iterations: 0,
    };
    let Some(mut here) = search.evaluate(start.clone()) else {
        return Ok(search.nowhere(start, TerminationReason::NonFiniteStart));
    };
    let Some(mut view) = search.linearise(&here)? else {
        return Ok(search.nowhere(start, TerminationReason::NonFiniteJacobian));
    };
    let stood_still = search.verdict(&here, &view, TerminationReason::NoProgress).is_converged();
    let mut radius = options.first_radius * view.bounded.scaled_length(&here.p);
    if radius.is_nan() || radius == 0.0 {
        radius = f64::INFINITY;
    }
    let reason = loop {
        if search.iterations >= options.max_iterations {
            break search.verdict(&here, &view, TerminationReason::MaxIterations);
        }
        if view.tangent.rank == 0 && here.square > 0.0 && !view.tangent.free.is_empty() {
            break TerminationReason::NoInfluence;
        }
        if view.cosine <= NEAR || view.projection <= view.rounding {
            if let Some(better) = search.polish(&here, &view)? {
                (here, view) = better;
                continue;
            }
            let verdict = search.verdict(&here, &view, TerminationReason::NoProgress);
            if verdict != TerminationReason::NoProgress {
                break verdict;
            }
        }
        let Some(next) = search.descend(&here, &view, &mut radius) else {
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
        tangent: view.tangent,
        held: view.held,
        cosine: view.cosine,
        stood_still,
        iterations: search.iterations,
        evaluations: search.evaluations,
        reason,
    })
}

/// Factor on the radius after a step that reduced the squares by `ratio` < ¼ of what was predicted: half for one
/// that still was a gain, else to the minimum of the parabola through both ends of the step (Moré, §5).
fn shrink(ratio: f64) -> f64 {
    match ratio {
        _ if ratio >= 0.0 => 0.5,
        // −∞ stands for no number at all
        _ if ratio.is_finite() => (0.5 / (1.0 - 0.5 * ratio)).clamp(0.1, 0.5),
        _ => 0.1,
    }
}

/// The tangent plane at `p`, columns scaled to norm 1, with the parameters held that are held.
pub(super) fn tangent_at(
    system: &Stacked,
    p: &DVector<f64>,
    held: &[Option<Side>],
    options: &Options,
) -> Result<Tangent> {
    let j = system.jacobian(p);
    Tangent::new(&j, &system.residuals(p), free(held), &column_norms(&j), options.rank_tolerance)
}

fn free(held: &[Option<Side>]) -> Vec<usize> {
    (0..held.len()).filter(|&j| held[j].is_none()).collect()
}

/// Norm of every column, 1 for a column of zeros.
fn column_norms(j: &DMatrix<f64>) -> DVector<f64> {
    with_unit_columns(j).1
}

/// Parameters, their residuals and the sum of squares.
struct Point {
    p: DVector<f64>,
    r: DVector<f64>,
    square: f64,
}

/// The linearisation at a point.
struct View {
    /// With columns scaled to norm 1: judges rank and gradient, and makes full steps.
    tangent: Tangent,
    /// With columns scaled to their largest norm so far, slowly forgotten: makes steps within the trust region. A parameter that
    /// loses its influence is thereby not set free to run away.
    bounded: Tangent,
    held: Vec<Option<Side>>,
    /// Length of the residual vector's projection on the tangent plane, and relative to the vector.
    projection: f64,
    cosine: f64,
    /// What rounding alone can make of the residual vector.
    rounding: f64,
    /// A free parameter changed the residuals at the start and does so no longer.
    influence_lost: bool,
}

struct Search<'a> {
    system: &'a Stacked<'a>,
    options: &'a Options,
    /// Largest norm each column of the Jacobian has had on the way, slowly forgotten: the D of the trust region.
    scale: DVector<f64>,
    /// Norms of the columns at the start.
    first_norms: Option<Vec<f64>>,
    evaluations: usize,
    iterations: usize,
}

impl Search<'_> {
    /// The residuals at `p`, if they are finite.
    fn evaluate(&mut self, p: DVector<f64>) -> Option<Point> {
        self.evaluations += 1;
        let r = self.system.residuals(&p);
        let square = r.norm_squared();
        square.is_finite().then_some(Point { p, r, square })
    }

    /// The tangent plane at a point, if the Jacobian is finite.
    fn linearise(&mut self, here: &Point) -> Result<Option<View>> {
        self.iterations += 1;
        let j = self.system.jacobian(&here.p);
        if j.iter().any(|x| !x.is_finite()) {
            return Ok(None);
        }
        let held = self.held(&here.p, &j.tr_mul(&here.r));
        let norms = column_norms(&j);
        self.scale = (&self.scale * FADING).sup(&norms);
        let first = self.first_norms.get_or_insert_with(|| j.column_iter().map(|c| c.norm()).collect());
        // a column of zeros from the start is a matter of rank, not of loss
        let influence_lost = (0..held.len()).any(|k| {
            held[k].is_none()
                && first[k] != 0.0
                && j.column(k).norm() <= self.options.rank_tolerance * first[k]
        });
        let tangent = Tangent::new(&j, &here.r, free(&held), &norms, self.options.rank_tolerance)?;
        let bounded = Tangent::new(&j, &here.r, free(&held), &self.scale, f64::EPSILON)?;
        let projection = tangent.projection();
        let cosine = if here.square > 0.0 { projection / here.square.sqrt() } else { 0.0 };
        // one rounding of every parameter: ε·√Σ(‖Jⱼ‖·pⱼ)²
        let of_parameters = f64::EPSILON * norms.component_mul(&here.p).norm();
        let rounding = ROUNDINGS * of_parameters + self.system.rounding();
        Ok(Some(View { tangent, bounded, held, projection, cosine, rounding, influence_lost }))
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
    fn descend(&mut self, here: &Point, view: &View, radius: &mut f64) -> Option<Point> {
        loop {
            let wanted = view.bounded.step_within(*radius);
            let p = self.within_bounds(&here.p, &wanted);
            let step = &p - &here.p;
            let length = view.bounded.scaled_length(&step);
            let predicted = view.bounded.predicted_reduction(&step);
            // below either limit rounding decides, not the step
            let moves = length > f64::EPSILON * view.bounded.scaled_length(&here.p);
            if p == here.p || !moves || predicted.abs() <= UNRESOLVED * here.square {
                return None;
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
                return next;
            }
        }
    }

    /// A point with a smaller projection on the tangent plane, by a full Gauss–Newton step, if it is worth the while.
    fn polish(&mut self, here: &Point, view: &View) -> Result<Option<(Point, View)>> {
        let p = self.within_bounds(&here.p, &view.tangent.full_step());
        if p == here.p {
            return Ok(None);
        }
        let Some(next) = self.evaluate(p) else { return Ok(None) };
        if next.square.sqrt() > here.square.sqrt() * (1.0 + NEAR) + view.rounding {
            return Ok(None);
        }
        let Some(next_view) = self.linearise(&next)? else { return Ok(None) };
        let better = next_view.projection < WORTHWHILE * view.projection;
        Ok(better.then_some((next, next_view)))
    }

    /// Converged where it is; `otherwise` where the gradient is not zero.
    fn verdict(&self, here: &Point, view: &View, otherwise: TerminationReason) -> TerminationReason {
        let next_step = view.tangent.scaled_length(&view.tangent.full_step());
        let stands_still = next_step <= self.options.step_tolerance * view.tangent.scaled_length(&here.p);
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
        view.cosine <= self.options.gradient_tolerance || view.projection <= view.rounding
    }

    /// The result of a search that could not begin.
    fn nowhere(&self, start: &DVector<f64>, reason: TerminationReason) -> Minimum {
        Minimum {
            parameters: start.clone(),
            residuals: self.system.residuals(start),
            tangent: Tangent::unknown(start.len()),
            held: vec![None; start.len()],
            cosine: f64::NAN,
            stood_still: false,
            iterations: self.iterations,
            evaluations: self.evaluations,
            reason,
        }
    }
}
