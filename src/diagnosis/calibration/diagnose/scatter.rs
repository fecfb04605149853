//! By what do poses scatter: by the device alike along every axis, or by joints, by one axis of the
//! device, by its angles?
//!
//! ```text
//! ln L(s², v) = −½·Σ (ln det C + rᵀ·C⁻¹·r)        C = s²·1 + Σₖ vₖ·Bₖ of each pose, r what is left of it
//! v ← v·√(Σ rᵀC⁻¹BC⁻¹r / Σ tr(C⁻¹B))              until L grows no more
//! ```
//!
//! (H. Zhou, L. Hu, J. Zhou, K. Lange, *J. Comput. Graph. Stat.* 28 (2019) 350–361.) The likeliest
//! source is added, and then the next one, as long as each is worth its number. What follows
//! something is an effect and no scatter: so the best answer beside such a covariance has to make
//! the recording more probable than the best answer without it, and not only L; nothing structured
//! may be left beside it; and where it has taken the place of something, what the other poses say
//! of that must not foretell those that are held out.

use nalgebra::{DVector, Matrix3, Vector3};

use super::super::model::Context;
use super::super::model::covariance::{Covariance, Source};
use super::prepared::{FirstLook, Prepared};
use crate::calibration::campaign::Campaign;
use crate::error::Result;
use crate::inference::{Candidate, ForwardModel, Sketch, Term, held_out_square, sketch};
use crate::parallel::checkpoint;
use crate::statistics::median;

/// Most sources that are told apart.
const MOST_SOURCES: usize = 3;
/// Rows that are looked at, from all over the recording.
const MOST_ROWS: usize = 2000;
/// Fewest numbers that are left per axis and pose for a covariance.
const FEWEST: f64 = 60.0;
/// Poses so many times as far out as those in the middle are no scatter.
const FAR: f64 = 6.0;
/// Times that it is estimated; and ln of the ratio of two variances that are as good as the same.
const ROUNDS: usize = 3;
const ALIKE: f64 = 0.1;
/// Share of the squares of held-out poses that only something that is there foretells.
const FORETOLD: f64 = 0.05;
/// Least scatter that has sources, m: below it stand last digits.
const LEAST: f64 = 1e-6;
/// The largest scatter of an angle that is none, rad: arms repeat poses to a tenth of it. And how
/// many times as much a device may scatter along one axis as along the others.
const MOST_ANGLE: f64 = 500e-6;
const MOST_TIMES: f64 = 10.0;
/// Steps of an iteration, and the growth of ln L below which it ends.
const STEPS: usize = 100;
const GROWTH: f64 = 1e-4;

/// A campaign whose poses scatter by some source.
pub struct Scattered<'c> {
    pub prepared: Prepared<'c>,
    pub sketch: Sketch,
    pub covariance: Covariance,
    /// Ln of its probability, less what its sources cost.
    worth: f64,
}

/// The same campaign beside the covariance of what the best answer leaves, where that makes it more
/// probable.
pub fn scattered<'c>(
    campaign: &'c Campaign,
    prepared: &Prepared<'c>,
    plain: &Sketch,
    look: &FirstLook,
) -> Result<Option<Scattered<'c>>> {
    let rank = prepared.model.calibration.fit.covariance.rank as f64;
    let mut best: Option<Scattered> = None;
    // what was found beside equal scatter has taken up some of it
    for _ in 0..ROUNDS {
        let (sketched, model) =
            best.as_ref().map_or((plain, &prepared.model), |best| (&best.sketch, &best.prepared.model));
        let determined = rank + sketched.hypothesis.determined;
        let Some((covariance, price)) =
            likeliest(&prepared.context, &model.by_row(&sketched.left), determined)
        else {
            break;
        };
        if best.as_ref().is_some_and(|best| is_alike(&best.covariance, &covariance)) {
            break;
        }
        let look = FirstLook { covariance: Some(covariance.clone()), ..look.clone() };
        let calibration = prepared.model.calibration.clone();
        let mut beside = Prepared::about(campaign, calibration, prepared.about.clone(), &look)?;
        let own = sketch(&beside.model, &beside.evidence);
        beside.evidence.correlated_noise = own.correlated_noise;
        // what is structured beside it as well is no scatter, and nobody knows which part of it is
        if own.left_over.is_some() || own.correlated_noise.is_some() {
            return Ok(None);
        }
        let density: f64 = beside.context.weights().iter().map(|weight| weight.determinant().ln()).sum();
        let worth = own.log_probability + density - price;
        if worth <= best.as_ref().map_or(plain.log_probability, |best| best.worth) {
            break;
        }
        best = Some(Scattered { prepared: beside, sketch: own, covariance, worth });
    }
    Ok(best.filter(|best| !foretells(prepared, plain, best)))
}

/// True where held-out poses are nearer to what was found beside equal scatter than to what is left
/// of it beside a covariance: then that took something for scatter.
fn foretells(prepared: &Prepared, plain: &Sketch, beside: &Scattered) -> bool {
    let whole = plain.left_over.as_ref().map_or(Some(&plain.hypothesis), Option::as_ref);
    let Some(whole) = whole else { return true };
    let all = prepared.model.candidates();
    let others = beside.prepared.model.candidates();
    let same = |term: &Term| {
        let own = &others[term.candidate];
        let is_it = |known: &Candidate| known.effect == own.effect && known.location == own.location;
        all.iter().position(is_it).map(|candidate| Term { candidate, ..term.clone() })
    };
    let kept: Vec<Term> = beside.sketch.hypothesis.terms.iter().filter_map(same).collect();
    let is_kept = |term: &Term| kept.iter().any(|own| own.candidate == term.candidate);
    if whole.terms.iter().all(is_kept) {
        return false;
    }
    let square = |terms: Option<&[Term]>| held_out_square(&prepared.model, &prepared.evidence, terms);
    square(None).zip(square(Some(&kept))).is_some_and(|(own, other)| own < (1.0 - FORETOLD) * other)
}

/// True of the same sources, each by about as much.
fn is_alike(a: &Covariance, b: &Covariance) -> bool {
    let is_alike = |a: f64, b: f64| (a / b.max(f64::MIN_POSITIVE)).ln().abs() < ALIKE;
    a.sources.len() == b.sources.len()
        && is_alike(a.own, b.own)
        && a.sources
            .iter()
            .all(|(source, v)| b.sources.iter().any(|(other, w)| source == other && is_alike(*v, *w)))
}

/// The likeliest covariance of what is `left` of each row, m, once so many numbers were
/// `determined`, and what its sources cost; `None` where no source is worth it.
fn likeliest(context: &Context, left: &[Vector3<f64>], determined: f64) -> Option<(Covariance, f64)> {
    let count = 3.0 * left.len() as f64;
    let mean_square = left.iter().map(|left| left.norm_squared()).sum::<f64>() / count;
    if count - determined < FEWEST || mean_square < LEAST.powi(2) {
        return None;
    }
    // what a fit has taken up is missing
    let missing = (1.0 - determined / count).sqrt();
    let lengths: Vec<f64> = left.iter().map(|left| left.norm()).collect();
    let far = FAR * median(&lengths)?;
    let step = left.len().div_ceil(MOST_ROWS);
    let rows: Vec<usize> = (0..left.len()).step_by(step).filter(|&row| lengths[row] <= far).collect();
    let left: Vec<Vector3<f64>> = rows.iter().map(|&row| left[row] / missing).collect();
    let sources = Source::all(context);
    let spreads: Vec<Vec<Matrix3<f64>>> =
        sources.iter().map(|source| rows.iter().map(|&row| source.spread(context, row)).collect()).collect();
    let price = |chosen: &[usize]| -> f64 {
        // of how many it is one, and of how much it may be
        let of_one = |&k: &usize| {
            (sources.len() as f64).ln() + if is_known(sources[k]) { 0.0 } else { 0.5 * count.ln() }
        };
        chosen.iter().map(of_one).sum()
    };
    let fit = |chosen: &[usize]| {
        let spreads: Vec<&[Matrix3<f64>]> = chosen.iter().map(|&k| &spreads[k][..]).collect();
        let known: Vec<bool> = chosen.iter().map(|&k| is_known(sources[k])).collect();
        Fit::new(&left, &spreads, &known)
    };
    let mut best = (Vec::new(), fit(&[]));
    for _ in 0..MOST_SOURCES.min(sources.len()) {
        let more = (0..sources.len()).filter(|k| !best.0.contains(k)).map(|k| {
            let chosen = [&best.0[..], &[k]].concat();
            let own = fit(&chosen);
            (chosen, own)
        });
        let worth = |(chosen, fit): &(Vec<usize>, Fit)| fit.log_likelihood - price(chosen);
        let Some(next) = more.max_by(|a, b| worth(a).total_cmp(&worth(b))) else { break };
        if worth(&next) <= worth(&best) {
            break;
        }
        best = next;
    }
    let (chosen, fit) = best;
    let price = price(&chosen);
    let sources = chosen.into_iter().map(|k| sources[k]).zip(fit.sources).collect();
    let covariance = Covariance { own: fit.own, sources };
    let is_scatter = !covariance.sources.is_empty() && is_plausible(context, &covariance);
    is_scatter.then_some((covariance, price))
}

/// False for what is too much for scatter: then it follows something that nobody looks for.
fn is_plausible(context: &Context, covariance: &Covariance) -> bool {
    let distance = context.largest(|there| there.tip.norm());
    covariance.sources.iter().all(|&(source, v)| match source {
        Source::Written => true,
        Source::Joints | Source::Angle(_) => v < MOST_ANGLE.powi(2),
        Source::Way(_) | Source::Device(_) | Source::Range => v < MOST_TIMES.powi(2) * covariance.own,
        Source::Sight => v * distance.powi(2) < MOST_TIMES.powi(2) * covariance.own,
    })
}

/// How much rounding scatters is known.
fn is_known(source: Source) -> bool {
    source == Source::Written
}

/// Variances that make what is left likeliest.
struct Fit {
    own: f64,
    sources: Vec<f64>,
    log_likelihood: f64,
}

impl Fit {
    fn new(left: &[Vector3<f64>], spreads: &[&[Matrix3<f64>]], known: &[bool]) -> Fit {
        checkpoint();
        let count = left.len().max(1) as f64;
        let share =
            left.iter().map(|r| r.norm_squared()).sum::<f64>() / (3.0 * count) / (spreads.len() + 1) as f64;
        let start = |(spread, known): (&&[Matrix3<f64>], &bool)| {
            let mean = spread.iter().map(|b| b.trace()).sum::<f64>() / (3.0 * count);
            if *known { 1.0 } else { share / mean.max(f64::MIN_POSITIVE) }
        };
        let mut fit = Fit {
            own: share.max(f64::MIN_POSITIVE),
            sources: spreads.iter().zip(known).map(start).collect(),
            log_likelihood: f64::NEG_INFINITY,
        };
        for _ in 0..STEPS {
            let before = fit.log_likelihood;
            let mut sums = DVector::zeros(2 * (spreads.len() + 1));
            fit.log_likelihood = 0.0;
            for (row, r) in left.iter().enumerate() {
                let spread = spreads.iter().zip(&fit.sources).map(|(spread, v)| spread[row] * *v);
                let whole = spread.fold(Matrix3::identity() * fit.own, |sum, own| sum + own);
                let Some(inverse) = whole.try_inverse() else { continue };
                let pull = inverse * r;
                fit.log_likelihood -= 0.5 * (whole.determinant().ln() + r.dot(&pull));
                sums[0] += pull.norm_squared();
                sums[1] += inverse.trace();
                for (k, spread) in spreads.iter().enumerate() {
                    sums[2 * k + 2] += pull.dot(&(spread[row] * pull));
                    sums[2 * k + 3] += inverse.component_mul(&spread[row]).sum();
                }
            }
            if fit.log_likelihood - before < GROWTH {
                break;
            }
            let grown = |k: usize| (sums[2 * k] / f64::max(sums[2 * k + 1], f64::MIN_POSITIVE)).sqrt();
            fit.own *= grown(0);
            for (k, v) in fit.sources.iter_mut().enumerate().filter(|(k, _)| !known[*k]) {
                *v *= grown(k + 1);
            }
        }
        fit
    }
}
