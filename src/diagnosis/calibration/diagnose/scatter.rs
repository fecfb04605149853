//! By what do poses scatter: by the device alike along every axis, or by joints, by one axis of the
//! device, by its angles?
//!
//! ```text
//! ln L(s², v) = −½·Σ (ln det C + rᵀ·C⁻¹·r)        C = s²·1 + Σₖ vₖ·Bₖ of each pose, r what is left of it
//! v ← v + I⁻¹·∂ln L/∂v, I = ½·Σ tr(C⁻¹B·C⁻¹B′)    until L grows no more
//! ```
//!
//! (Fisher's scoring; S. R. Searle, G. Casella, C. E. McCulloch, *Variance Components*, Wiley 1992,
//! §8.3.) r are made alike by what each row counts in the fit (`leverage.rs`), which takes up most
//! of what scatters as joints do. The likeliest source is added, and then the next one, as long as
//! each is worth its number. What follows something is an effect and no scatter: so the best answer
//! beside such a covariance has to make the recording more probable than the best answer without
//! it, and not only L; nothing structured may be left beside it; and where it has taken the place
//! of something, what the other poses say of that must not predict those that are held out.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::super::model::Context;
use super::super::model::calibration_model::undone;
use super::super::model::covariance::{Covariance, Source};
use super::leverage::{alike, fitted_alike};
use super::prepared::{FirstLook, Prepared};
use crate::calibration::campaign::Campaign;
use crate::error::Result;
use crate::inference::{Candidate, Evidence, ForwardModel, Sketch, Term, held_out_square, sketch};
use crate::parallel::checkpoint;
use crate::statistics::median;

/// Most sources that are distinguished.
const MOST_SOURCES: usize = 3;
/// Rows that are looked at, from all over the recording.
const MOST_ROWS: usize = 2000;
/// Fewest numbers that are left per axis and pose for a covariance.
const FEWEST: f64 = 60.0;
/// Poses so many times as far out as those in the middle are no scatter.
const FAR: f64 = 6.0;
/// Searches beside it, and fits before each of them; and ln of the ratio of two variances that are
/// as good as the same.
const ROUNDS: usize = 3;
const REFITS: usize = 12;
const ALIKE: f64 = 0.05;
/// Share of the squares of held-out poses that only something that is there predicts.
const PREDICTED: f64 = 0.05;
/// Least scatter that has sources, m: below it stand last digits.
const LEAST: f64 = 1e-6;
/// The largest scatter of an angle, rad: 0.1 mm a metre away, and hardly an arm repeats its poses
/// less well. More of it is something that nobody looks for. And how many times as much a device
/// may scatter along one axis as along the others.
const MOST_ANGLE: f64 = 100e-6;
const MOST_TIMES: f64 = 10.0;
/// Steps to the likeliest variances, how often one is halved, and the growth of ln L below which
/// they end.
const STEPS: usize = 50;
const HALVES: i32 = 8;
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
        let (sketched, about) =
            best.as_ref().map_or((plain, prepared), |best| (&best.sketch, &best.prepared));
        let left = of_rows_alike(about, sketched)?;
        if 3.0 * left.len() as f64 - rank - sketched.hypothesis.determined < FEWEST {
            break;
        }
        let Some((mut covariance, mut price)) = likeliest(&prepared.context, &left) else { break };
        // a fit of rows that count alike takes up more of what scatters along few directions; it is
        // worth its time where there is such scatter at all
        for _ in 0..if best.is_some() { REFITS } else { 0 } {
            let left = of_rows_refitted(about, sketched, &covariance.weights(&prepared.context))?;
            let Some((again, own)) = likeliest(&prepared.context, &left) else { break };
            let is_settled = is_alike(&again, &covariance);
            (covariance, price) = (again, own);
            if is_settled {
                break;
            }
        }
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
    Ok(best.filter(|best| !predicts(prepared, plain, best)))
}

/// What an answer leaves of each row, m in {W}, as if nothing had been fitted to it.
fn of_rows_alike(about: &Prepared, sketched: &Sketch) -> Result<Vec<Vector3<f64>>> {
    let columns = columns(about, sketched);
    let alike = alike(&about.evidence, &columns, &sketched.left, sketched.hypothesis.sigma, &|_| false)?;
    Ok(about.model.by_row(&DVector::from_iterator(3 * alike.len(), alike.iter().flatten().copied())))
}

fn columns(about: &Prepared, sketched: &Sketch) -> Vec<DMatrix<f64>> {
    sketched.hypothesis.terms.iter().map(|term| about.model.terms.columns(term.candidate)).collect()
}

/// The same once that answer has been fitted to rows that count by these weights.
fn of_rows_refitted(
    about: &Prepared,
    sketched: &Sketch,
    weights: &[Matrix3<f64>],
) -> Result<Vec<Vector3<f64>>> {
    let turns: Vec<Matrix3<f64>> =
        weights.iter().enumerate().map(|(row, weight)| weight * undone(&about.model.weight(row))).collect();
    let turned = |mut all: DMatrix<f64>| {
        for (row, turn) in turns.iter().enumerate() {
            let own = turn * all.fixed_rows::<3>(3 * row);
            all.fixed_rows_mut::<3>(3 * row).copy_from(&own);
        }
        all
    };
    let own = &about.evidence;
    let residual = turned(DMatrix::from_columns(std::slice::from_ref(&own.residual))).column(0).into_owned();
    let [nuisance, background, nominal] =
        [&own.nuisance, &own.background, &own.nominal].map(|all| turned(all.clone()));
    let evidence = Evidence { residual, nuisance, background, nominal, ..own.clone() };
    let columns: Vec<DMatrix<f64>> = columns(about, sketched).into_iter().map(turned).collect();
    let alike = fitted_alike(&evidence, &columns, sketched.hypothesis.sigma)?;
    Ok(alike.iter().zip(weights).map(|(left, weight)| undone(weight) * left).collect())
}

/// True where held-out poses are nearer to what was found beside equal scatter than to what is left
/// of it beside a covariance: then that took something for scatter.
fn predicts(prepared: &Prepared, plain: &Sketch, beside: &Scattered) -> bool {
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
    square(None).zip(square(Some(&kept))).is_some_and(|(own, other)| own < (1.0 - PREDICTED) * other)
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

/// The likeliest covariance of what is `left` of each row, m, and what its sources cost; `None`
/// where no source is worth it.
fn likeliest(context: &Context, left: &[Vector3<f64>]) -> Option<(Covariance, f64)> {
    let count = 3.0 * left.len() as f64;
    let mean_square = left.iter().map(|left| left.norm_squared()).sum::<f64>() / count;
    if mean_square < LEAST.powi(2) {
        return None;
    }
    let lengths: Vec<f64> = left.iter().map(|left| left.norm()).collect();
    let far = FAR * median(&lengths)?;
    let step = left.len().div_ceil(MOST_ROWS);
    let rows: Vec<usize> = (0..left.len()).step_by(step).filter(|&row| lengths[row] <= far).collect();
    let left: Vec<Vector3<f64>> = rows.iter().map(|&row| left[row]).collect();
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
        Source::Position(_) | Source::Device(_) | Source::Distance => v < MOST_TIMES.powi(2) * covariance.own,
        Source::Direction => v * distance.powi(2) < MOST_TIMES.powi(2) * covariance.own,
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
        let count = left.len().max(1) as f64;
        let mean_square = left.iter().map(|r| r.norm_squared()).sum::<f64>() / (3.0 * count);
        let share = mean_square.max(f64::MIN_POSITIVE) / (spreads.len() + 1) as f64;
        let start = |(spread, known): (&&[Matrix3<f64>], &bool)| {
            let mean = spread.iter().map(|b| b.trace()).sum::<f64>() / (3.0 * count);
            if *known { 1.0 } else { share / mean.max(f64::MIN_POSITIVE) }
        };
        let sources = spreads.iter().zip(known).map(start);
        let mut variances: DVector<f64> =
            DVector::from_iterator(spreads.len() + 1, std::iter::once(share).chain(sources));
        let mut here = Slopes::at(&variances, left, spreads);
        for _ in 0..STEPS {
            let step = here.step(&variances, known);
            // half of a step that leads down, and half of that
            let next = (0..HALVES).map(|halves| &variances + &step * 0.5f64.powi(halves)).find_map(|next| {
                let there = Slopes::at(&next, left, spreads);
                (there.log_likelihood > here.log_likelihood).then_some((next, there))
            });
            let Some((next, there)) = next else { break };
            let growth = there.log_likelihood - here.log_likelihood;
            (variances, here) = (next, there);
            if growth < GROWTH {
                break;
            }
        }
        let sources = variances.iter().skip(1).copied().collect();
        Fit { own: variances[0], sources, log_likelihood: here.log_likelihood }
    }
}

/// ln L of variances, s² first, and where it rises.
struct Slopes {
    log_likelihood: f64,
    /// ½·Σ (rᵀC⁻¹BC⁻¹r − tr(C⁻¹B)).
    slope: DVector<f64>,
    /// ½·Σ tr(C⁻¹B·C⁻¹B′).
    information: DMatrix<f64>,
}

impl Slopes {
    fn at(variances: &DVector<f64>, left: &[Vector3<f64>], spreads: &[&[Matrix3<f64>]]) -> Slopes {
        checkpoint();
        let count = variances.len();
        let mut all = Slopes {
            log_likelihood: 0.0,
            slope: DVector::zeros(count),
            information: DMatrix::zeros(count, count),
        };
        for (row, r) in left.iter().enumerate() {
            let spread = |k: usize| if k == 0 { Matrix3::identity() } else { spreads[k - 1][row] };
            let whole: Matrix3<f64> = (0..count).map(|k| spread(k) * variances[k]).sum();
            let Some(inverse) = whole.try_inverse() else { continue };
            let pull = inverse * r;
            all.log_likelihood -= 0.5 * (whole.determinant().ln() + r.dot(&pull));
            let taken: Vec<Matrix3<f64>> = (0..count).map(|k| inverse * spread(k)).collect();
            for k in 0..count {
                all.slope[k] += 0.5 * (pull.dot(&(spread(k) * pull)) - taken[k].trace());
                for l in 0..=k {
                    let both = 0.5 * (taken[k] * taken[l]).trace();
                    all.information[(k, l)] += both;
                    all.information[(l, k)] = all.information[(k, l)];
                }
            }
        }
        all
    }

    /// Fisher's step, of those that are not known; none makes a variance more than ten times larger
    /// or smaller.
    fn step(&self, variances: &DVector<f64>, known: &[bool]) -> DVector<f64> {
        let free: Vec<usize> = (0..variances.len()).filter(|&k| k == 0 || !known[k - 1]).collect();
        // in shares of the variances: these are of any unit
        let share = |k: usize| variances[free[k]];
        let count = free.len();
        let information =
            DMatrix::from_fn(count, count, |k, l| self.information[(free[k], free[l])] * share(k) * share(l));
        let slope = DVector::from_fn(count, |k, _| self.slope[free[k]] * share(k));
        let shares = information.cholesky().map_or_else(|| DVector::zeros(count), |own| own.solve(&slope));
        let mut step = DVector::zeros(variances.len());
        for (k, &at) in free.iter().enumerate() {
            step[at] = share(k) * shares[k].clamp(-0.9, 9.0);
        }
        step
    }
}
