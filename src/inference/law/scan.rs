//! All laws at all sites, each by its evidence, and the smooth curves that they compete with.

use nalgebra::DMatrix;
use std::f64::consts::PI;

use super::choice::Choice;
use super::form::Form;
use super::posterior::Posterior;
use super::remainder::Remainder;
use super::site::Site;
use crate::inference::priors::PRIOR;
use crate::inference::selection::APART;
use crate::parallel::in_parallel;

/// So many times the noise a recorded variable ranges over at least.
const ABOVE_NOISE: f64 = 30.0;
/// Columns of a smooth curve.
const CURVE: usize = 6;
/// Laws whose evidence at the best point is so far (ln) behind the best need no closer look.
const BEHIND: f64 = 12.0;
/// Part of the evidence of a wave that a first look may miss: its peak is narrow.
const MISSED: f64 = 0.25;

/// A law with what data say of it.
#[derive(Debug, Clone)]
pub(super) struct Scanned {
    pub choice: Choice,
    pub posterior: Posterior,
    /// Coordinate of the number that is not linear where most of its posterior is.
    pub at: f64,
    /// Ln of its odds against nothing, prior included.
    pub log_odds: f64,
}

/// Everything that was tried, the likeliest first.
pub(super) struct Scan {
    pub laws: Vec<Scanned>,
    /// The likeliest smooth curve: number of its site, ln of its odds against nothing.
    pub curve: Option<(usize, f64)>,
}

/// Ln of the prior odds of a law, or of a curve, against nothing, before it is shared among `sites`
/// places and the `fellows` there.
pub(super) fn prior(sites: usize, fellows: usize) -> f64 {
    let unknown = 0.5 * PRIOR.2 / PRIOR.0;
    (unknown / (sites.max(1) * fellows.max(1)) as f64).ln()
}

/// Where a law is likeliest. Of waves that explain the same the slowest has the widest peak in
/// ln f, and so the most of the posterior.
fn middle(choice: Choice, posterior: &Posterior) -> f64 {
    let width = |u: f64| if choice.form == Form::Harmonic { -u } else { 0.0 };
    let peaks = posterior.peaks(APART).into_iter();
    let highest = peaks.max_by(|a, b| (a.1 + width(a.0)).total_cmp(&(b.1 + width(b.0))));
    highest.unwrap_or_else(|| posterior.best()).0
}

/// All laws on a remainder; `size` is how large, about, what is left is.
pub(super) fn scan(remainder: &Remainder, sites: &[Site], size: f64) -> Scan {
    scan_some(remainder, sites, size, |_| true)
}

/// The same where the likeliest law may be a function of what was recorded: that stands, without
/// the law, in the place of what was predicted then, unless noise would be as large as the
/// variable: it would explain itself.
pub(super) fn scan_as_recorded(remainder: &Remainder, sites: &mut [Site], (size, sigma): (f64, f64)) -> Scan {
    let found = scan(remainder, sites, size);
    let Some(best) = found.laws.first() else { return found };
    let site = &sites[best.choice.site];
    let (low, high) = site.range();
    let Some(recorded) = site.recorded.as_ref().filter(|_| high - low > ABOVE_NOISE * sigma) else {
        return found;
    };
    let own = remainder.fit(&best.choice.columns(site, best.at, size).columns).own;
    sites[best.choice.site].values =
        recorded.iter().zip(own.iter()).map(|(value, own)| value - own).collect();
    scan(remainder, sites, size)
}

/// The same of some laws, each with the prior that it has among all.
pub(super) fn scan_some(
    remainder: &Remainder,
    sites: &[Site],
    size: f64,
    is_tried: impl Fn(&Choice) -> bool + Sync,
) -> Scan {
    let all: Vec<Vec<Choice>> =
        sites.iter().enumerate().map(|(number, site)| Choice::all(number, site)).collect();
    let places = all.iter().filter(|choices| !choices.is_empty()).count();
    let evidence = |choice: Choice, us: &[f64]| {
        remainder.gains(us.len(), |k| choice.columns(&sites[choice.site], us[k], size).columns)
    };
    let by_site = in_parallel(sites.len(), |number| {
        let choices = &all[number];
        let of_choice = |&choice: &Choice| {
            let posterior = Posterior::new(&choice.grid(&sites[number]), &|us| evidence(choice, us));
            (choice, posterior)
        };
        let laws: Vec<(Choice, Posterior)> = choices.iter().filter(|c| is_tried(c)).map(of_choice).collect();
        let curve =
            (!laws.is_empty()).then(|| remainder.gain(&curve(&sites[number], size)) + prior(places, 1));
        (laws, curve)
    });
    let mut best_curve: Option<(usize, f64)> = None;
    let mut first = Vec::new();
    for (number, (laws, curve)) in by_site.into_iter().enumerate() {
        let prior = prior(places, all[number].len());
        first.extend(laws.into_iter().map(|(choice, posterior)| (choice, posterior, prior)));
        if let Some(curve) = curve.filter(|curve| best_curve.is_none_or(|(_, best)| *curve > best)) {
            best_curve = Some((number, curve));
        }
    }
    // at most so much its odds may be
    let peak = |(choice, posterior, prior): &(Choice, Posterior, f64)| {
        let most = posterior.best().1;
        let missed = if choice.form == Form::Harmonic { MISSED * most.max(0.0) } else { 0.0 };
        most + missed + prior
    };
    let sure = |law: &(Choice, Posterior, f64)| law.1.best().1 + law.2;
    let highest = first.iter().map(sure).fold(f64::NEG_INFINITY, f64::max);
    // what is less likely than nothing is neither proposed nor a rival of what is
    let closer: Vec<bool> = first.iter().map(|law| peak(law) > (highest - BEHIND).max(0.0)).collect();
    let mut laws = in_parallel(first.len(), |k| {
        let (choice, mut posterior, prior) = first[k].clone();
        if closer[k] {
            posterior.refine(&|us| evidence(choice, us));
        }
        let log_odds = posterior.log_evidence() + prior;
        let at = middle(choice, &posterior);
        Scanned { choice, posterior, at, log_odds }
    });
    laws.retain(|law| law.log_odds > f64::NEG_INFINITY);
    laws.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    Scan { laws, curve: best_curve }
}

/// A smooth curve over the variable of a site, Σ a_j·cos(πjx) with a_j ~ 1/(1 + j), for each of its
/// directions.
pub(super) fn curve(site: &Site, size: f64) -> DMatrix<f64> {
    let ((low, high), count) = (site.range(), site.levels().min(CURVE));
    let mut columns = DMatrix::zeros(site.values.len(), site.directions.len() * count);
    for (d, (_, weights)) in site.directions.iter().enumerate() {
        let largest = weights.iter().fold(0.0, |most: f64, w| most.max(w.abs())).max(f64::MIN_POSITIVE);
        for j in 0..count {
            for (i, x) in site.values.iter().enumerate().filter(|(_, x)| x.is_finite()) {
                let wave = (PI * j as f64 * (x - low) / (high - low)).cos();
                columns[(i, d * count + j)] = size / (1 + j) as f64 * weights[i] / largest * wave;
            }
        }
    }
    columns
}
