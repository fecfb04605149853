//! What to measure on a rig that has measured nothing yet, so that some effects can be
//! distinguished.
//!
//! An effect a of its usual size adds C_a·θ, θ ~ N(0, 1), to readings that scatter by Σ₀: noise,
//! the zero of each run, the rod's nominal numbers. Where a is what there is, the ln of the odds
//! against b that a plan is expected to give is
//!
//! ```text
//! ½·[tr(K_b⁻¹K_a) − n + ln|K_b| − ln|K_a|],   K = Σ₀ + C·Cᵀ
//! ```
//!
//! the Kullback–Leibler divergence of the two (D. V. Lindley, *Ann. Math. Statist.* 27 (1956)
//! 986–1005). Measurements are those that a diagnosis proposes from (`feasible.rs`), chosen one
//! after another as it does (`experiment_design.rs`): the least laborious one that leaves least of
//! the rivals; then whatever is not needed is given up again, and plans of less effort are ruled
//! out (`least.rs`).

#[cfg(test)]
mod tests;

mod effort;
mod information;
mod least;
mod menu;
mod ratio;
mod rig_plan;

pub use self::effort::minutes;
use self::effort::{FEWEST, MOST_REPEATS};
use self::least::least;
use self::menu::Menu;
pub use self::ratio::plan_ratio;
pub use self::rig_plan::{Bench, Distinguished, PlannedLoads, Ratio, RigPlan};
use crate::diagnosis::rig::effects::registry;
use crate::error::Result;
use crate::inference::{Effect, ExperimentDesign};
use crate::parallel::in_parallel;
use crate::rod::Rod;

/// Repeats of a measurement that are added at a time.
const ADDED: [usize; 3] = [1, 3, 6];
const MOST_ROUNDS: usize = 24;
/// What all measurements together would have to tell, in ln odds, times what is asked for: less
/// would take nearly all of them.
const REASONABLE: f64 = 2.0;
/// Plans of less effort that are tried at most.
const MOST_PLANS: usize = 1000;
/// Share of the rivals that a measurement has to take away.
const WORTH: f64 = 0.98;

/// The effect of a rig that has this name.
///
/// ```
/// use rodcal::diagnosis::rig::planned::effect_named;
///
/// let friction = effect_named("friction").expect("the library knows it");
/// assert_eq!(friction.name, "friction");
/// assert!(effect_named("ghost").is_none());
/// ```
pub fn effect_named(name: &str) -> Option<&'static Effect> {
    registry::ALL.into_iter().map(|effect| &effect.effect).find(|effect| effect.name == name)
}

/// Names of all effects of a rig.
///
/// ```
/// use rodcal::diagnosis::rig::planned::effect_names;
///
/// assert!(effect_names().len() > 15 && effect_names().contains(&"root_compliance"));
/// ```
pub fn effect_names() -> Vec<&'static str> {
    registry::ALL.into_iter().map(|effect| effect.effect.name).collect()
}

/// A plan of little effort that distinguishes effects of their usual sizes, `odds` to 1, and from
/// nothing; as far as the rig can do that with reasonable effort: where all measurements together
/// tell less than odds², nearly all of them would be needed. Where few plans take less effort, all
/// of them are looked at, and it is the least laborious one ([`RigPlan::is_least`]).
///
/// ```
/// use rodcal::diagnosis::rig::planned::{Bench, effect_named, plan};
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let bench = Bench { largest_load: 10.0, noise: 2e-6, is_at_tip: true };
/// let friction = effect_named("friction").expect("the library knows it");
/// let plan = plan(&rod, &[friction], 20.0, &bench)?;
/// assert!((plan.wanted - 20f64.ln()).abs() < 1e-12);
/// assert!(!plan.measurements.is_empty() && plan.minutes > 0.0);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::NotApplicable`] for an effect that no such measurement shows; what the beam
/// model refuses.
pub fn plan(rod: &Rod, between: &[&'static Effect], odds: f64, bench: &Bench) -> Result<RigPlan> {
    let menu = Menu::new(rod, between, bench)?;
    let wanted = odds.ln();
    let all = menu.log_odds(&vec![MOST_REPEATS; menu.measurements.len()]);
    // what cannot be distinguished with reasonable effort is not asked for
    let aims: Vec<f64> =
        all.iter().map(|best| if *best < REASONABLE * wanted { 0.0 } else { wanted }).collect();
    let mut counts = vec![0; menu.measurements.len()];
    let left = |log_odds: &[f64]| -> f64 {
        let short =
            |(log_odds, aim): (&f64, &f64)| if *aim > 0.0 { (-log_odds.min(*aim)).exp() } else { 0.0 };
        log_odds.iter().zip(&aims).map(short).sum()
    };
    let is_enough = |log_odds: &[f64]| log_odds.iter().zip(&aims).all(|(log_odds, aim)| log_odds >= aim);
    let mut now = vec![0.0; aims.len()];
    for _ in 0..MOST_ROUNDS {
        if is_enough(&now) {
            break;
        }
        let mut offers: Vec<Vec<usize>> = Vec::new();
        for k in 0..counts.len() {
            for more in ADDED {
                let mut offer = counts.clone();
                offer[k] = (counts[k] + more).max(FEWEST);
                if offer[k] <= MOST_REPEATS && !offers.contains(&offer) {
                    offers.push(offer);
                }
            }
        }
        offers.sort_by(|a, b| menu.minutes(a).total_cmp(&menu.minutes(b)));
        let log_odds = in_parallel(offers.len(), |k| menu.log_odds(&offers[k]));
        let mut design = ExperimentDesign::default();
        for (offer, log_odds) in offers.into_iter().zip(log_odds) {
            let useful: Vec<f64> =
                log_odds.iter().zip(&aims).map(|(log_odds, aim)| log_odds.min(*aim)).collect();
            design.offer((offer, log_odds), useful, &vec![1.0; aims.len()]);
        }
        let Some(((best, log_odds), _)) =
            design.best().filter(|((_, log_odds), _)| left(log_odds) < WORTH * left(&now))
        else {
            break;
        };
        (counts, now) = (best, log_odds);
    }
    if !is_enough(&now) {
        // some are distinguished by several measurements together only: from all of them, as many
        // as can be left out
        counts = vec![MOST_REPEATS; counts.len()];
        now.clone_from(&all);
        let mut order: Vec<usize> = (0..counts.len()).collect();
        order.sort_by(|&a, &b| menu.labour(b, 1).total_cmp(&menu.labour(a, 1)).then(b.cmp(&a)));
        for k in order {
            let mut fewer = counts.clone();
            fewer[k] = 0;
            let log_odds = menu.log_odds(&fewer);
            if is_enough(&log_odds) {
                (counts, now) = (fewer, log_odds);
            }
        }
    }
    // the most laborious first
    let reached: Vec<f64> = now.iter().zip(&aims).map(|(now, aim)| now.min(*aim)).collect();
    let is_kept =
        |log_odds: &[f64]| log_odds.iter().zip(&reached).all(|(log_odds, reached)| log_odds >= reached);
    let mut order: Vec<usize> = (0..counts.len()).filter(|&k| counts[k] > 0).collect();
    order.sort_by(|&a, &b| menu.labour(b, counts[b]).total_cmp(&menu.labour(a, counts[a])).then(a.cmp(&b)));
    for k in order {
        while counts[k] > 0 {
            let fewer = one_less(&counts, k);
            let log_odds = menu.log_odds(&fewer);
            if !is_kept(&log_odds) {
                break;
            }
            (counts, now) = (fewer, log_odds);
        }
    }
    let labour: Vec<Vec<f64>> = (0..counts.len()).map(|k| menu.labours(k)).collect();
    let found =
        least(&labour, menu.minutes(&counts), MOST_PLANS, &|counts| is_enough(&menu.log_odds(counts)));
    if let Some(better) = found.better {
        now = menu.log_odds(&better);
        counts = better;
    }
    Ok(menu.plan(&counts, wanted, [&now, &all], found.is_proven))
}

/// One repeat less of a measurement, or none.
fn one_less(counts: &[usize], k: usize) -> Vec<usize> {
    let mut fewer = counts.to_vec();
    fewer[k] = if counts[k] > FEWEST { counts[k] - 1 } else { 0 };
    fewer
}
