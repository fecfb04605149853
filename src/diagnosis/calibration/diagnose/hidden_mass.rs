//! A mass that a calibration hides, as the calibration itself sees it: by what it leaves beside it.
//!
//! ```text
//! m = argmin_m S(m),   S(m) = min_ρ |recorded − predicted(ρ; m)|²
//! ```
//!
//! Each S is a whole calibration. So a few masses are tried, and then where a parabola through the
//! best one and its neighbours is least. A mass that leaves as much as none, (S₀ − S)/2σ² < ln 20,
//! is not hidden, nor is one that explains less than half of what another one does: it is that
//! other one, imitated.

use nalgebra::Vector3;

use super::beside::{Beside, Loads, calibrated_with};
use super::prepared::Prepared;
use crate::calibration::Calibration;
use crate::diagnosis::calibration::model::CalibrationModel;
use crate::diagnosis::calibration::model::law::{Hung, Law};
use crate::error::Result;
use crate::inference::APART;

/// Masses at the tip that are tried first, kg, at the flange, and how many times its own mass a rod
/// has too much: aluminium is a third of steel.
const TRIED: [(Hung, &[f64]); 3] = [
    (Hung::Tip, &[0.1, 0.3, 0.6, 1.0]),
    (Hung::Flange, &[0.5, 1.5, 3.0, 6.0]),
    (Hung::Rod, &[-0.6, -0.3, 0.5, 1.0, 2.0]),
];
/// A rod that weighs a tenth: none is lighter.
const LIGHTEST_ROD: f64 = -0.9;
/// Share of what the best mass explains that another one must.
const COMPARABLE: f64 = 0.5;
/// Most steps to the least one.
const STEPS: usize = 4;
/// A step so much shorter than the neighbours are apart need not be made.
const ARRIVED: f64 = 1.0 / 32.0;

/// Robots that are calibrated beside a mass each, of the masses that explain most of what the
/// calibration of `prepared` leaves, in which data scatter by `sigma`.
pub fn beside_masses<'c>(prepared: &Prepared<'c>, sigma: f64) -> Result<Vec<Beside<'c>>> {
    let model = &prepared.model;
    let without = left(model, &model.calibration);
    let mut hidden = Vec::new();
    for (own, tried) in TRIED.into_iter().filter(|(own, _)| is_possible(model, *own)) {
        let left_with = |mass: f64| -> Result<f64> {
            let with = calibrated_with(model, &Loads::one(own, mass))?;
            Ok(with.map_or(f64::INFINITY, |beside| left(model, &beside.calibration)))
        };
        // nothing weighs less than nothing
        let lightest = match own {
            Hung::Tip => -prepared.context.modelled_mass.0,
            Hung::Flange | Hung::FlangeFrom(_) | Hung::FlangeUntil(_) => 0.0,
            Hung::Rod => LIGHTEST_ROD,
        };
        let has_its_own = own == Hung::Tip && lightest < 0.0;
        let lighter = if has_its_own { vec![lightest, lightest / 2.0] } else { Vec::new() };
        let (mass, least) = least(&[&lighter, tried].concat(), lightest, left_with)?;
        hidden.push((own, mass, (without - least) / (2.0 * sigma.powi(2))));
    }
    let least = least_gain(hidden.iter().map(|(_, _, gain)| *gain));
    let mut found = Vec::new();
    for (own, mass, _) in hidden.into_iter().filter(|(_, _, gain)| *gain > least) {
        found.extend(calibrated_with(model, &Loads::one(own, mass))?);
    }
    Ok(found)
}

/// What a mass has to explain to be hidden, beside all that may be, (S₀ − S)/2σ².
fn least_gain(all: impl Iterator<Item = f64>) -> f64 {
    all.fold(APART.ln(), |least, gain| least.max(COMPARABLE * gain))
}

/// True where a mass in some place may be hidden.
pub fn may_be_hidden(model: &CalibrationModel) -> bool {
    TRIED.iter().any(|(own, _)| is_possible(model, *own))
}

fn is_possible(model: &CalibrationModel, own: Hung) -> bool {
    let count = model.terms.candidates.len();
    (0..count).any(|candidate| *model.law(candidate) == Law::Hung(own))
}

/// Σ of the squares of what a calibration leaves, as its data count.
fn left(model: &CalibrationModel, calibration: &Calibration) -> f64 {
    let square = |(row, deviation): (usize, &Vector3<f64>)| (model.weight(row) * deviation).norm_squared();
    calibration.deviations.iter().enumerate().map(square).sum()
}

/// Where `left` is least, and how much it is there: of the numbers `tried`, and of those that
/// parabolas propose, none below `lowest`. Infinite where a calibration has not converged.
fn least(tried: &[f64], lowest: f64, left: impl Fn(f64) -> Result<f64>) -> Result<(f64, f64)> {
    let mut known = Vec::new();
    for &own in tried {
        known.push((own, left(own)?));
    }
    for _ in 0..STEPS {
        known.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some(next) = proposed(&known, lowest) else { break };
        known.push((next, left(next)?));
    }
    let of_none = (0.0, f64::INFINITY);
    Ok(known.into_iter().reduce(|best, own| if own.1 < best.1 { own } else { best }).unwrap_or(of_none))
}

/// Where to look next, of what is `known` in order; `None` where that would bring nothing.
///
/// Through (a, S_a), (b, S_b) and (c, S_c) a parabola is least at
///
/// ```text
/// b − ½·[(b − a)·P − (b − c)·Q]/(P − Q),   P = (b − a)·(S_b − S_c),   Q = (b − c)·(S_b − S_a)
/// ```
fn proposed(known: &[(f64, f64)], lowest: f64) -> Option<f64> {
    let best = (0..known.len()).min_by(|&a, &b| known[a].1.total_cmp(&known[b].1))?;
    let at = |k: usize| known.get(k).copied();
    let (b, of_b) = at(best)?;
    match (best.checked_sub(1).and_then(at), at(best + 1)) {
        (Some((a, of_a)), Some((c, of_c))) if of_a.is_finite() && of_c.is_finite() => {
            let (p, q) = ((b - a) * (of_b - of_c), (b - c) * (of_b - of_a));
            let step = 0.5 * ((b - a) * p - (b - c) * q) / (p - q);
            (step.abs() > ARRIVED * (c - a)).then_some(b - step)
        }
        // away from a side where none has converged
        (Some((a, of_a)), Some((c, _))) => Some(0.5 * (b + if of_a.is_finite() { a } else { c })),
        (None, Some((c, _))) if b > lowest => Some((2.0 * b - c).max(lowest)),
        (None, Some((c, _))) => Some(0.5 * (b + c)),
        (Some((a, _)), None) => Some(2.0 * b - a),
        (None, None) => None,
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// Where it is found, and after how many looks.
    fn found(tried: &[f64], lowest: f64, left: impl Fn(f64) -> f64) -> (f64, usize) {
        let looks = Cell::new(0);
        let counted = |x: f64| {
            looks.set(looks.get() + 1);
            assert!(x >= lowest, "{x}");
            Ok(left(x))
        };
        let (at, _) = least(tried, lowest, counted).unwrap();
        (at, looks.get())
    }

    /// As much as chance does, or half of what the best one does.
    #[test]
    fn a_mass_that_another_one_imitates_is_not_hidden() {
        let hidden = |gains: &[f64]| {
            let least = least_gain(gains.iter().copied());
            gains.iter().map(|gain| *gain > least).collect::<Vec<_>>()
        };
        assert_eq!(hidden(&[-5.0, 2.9, 3.1]), [false, false, true]);
        assert_eq!(hidden(&[944.0, 300.0, 870.0]), [true, false, true]);
        assert_eq!(hidden(&[f64::NEG_INFINITY, f64::NAN]), [false, false]);
    }

    #[test]
    fn a_parabola_is_arrived_at_in_one_step() {
        let (at, looks) = found(&[0.1, 0.3, 0.6, 1.0], -0.2, |x| 3.0 + (x - 0.45).powi(2));
        assert!((at - 0.45).abs() < 1e-12 && looks == 5, "{at} {looks}");
    }

    /// Beyond what was tried, at the lowest there is, and about what is steeper on one side.
    #[test]
    fn what_is_least_elsewhere_is_come_near_to() {
        let far = |at: f64| move |x: f64| (x - at).powi(2);
        let (at, _) = found(&[0.5, 1.5, 3.0, 6.0], 0.0, far(11.0));
        assert!((at - 11.0).abs() < 0.5, "{at}");
        assert!(found(&[0.5, 1.5], 0.0, far(-4.0)).0 < 0.1);
        let (at, _) = found(&[-0.6, -0.3, 0.5, 1.0, 2.0], -0.9, |x| (x + 1.0).ln() + 0.4 / (x + 1.0));
        assert!((at + 0.6).abs() < 0.06, "{at}");
    }

    #[test]
    fn where_none_converges_is_no_place_and_of_nothing_nothing_is_least() {
        let left = |x: f64| if x > 0.7 { f64::INFINITY } else { (x - 0.6).powi(2) };
        assert!((found(&[0.1, 0.3, 0.5, 1.0], 0.0, left).0 - 0.6).abs() < 0.11);
        assert_eq!(least(&[0.5, 1.0], 0.0, |_| Ok(f64::INFINITY)).unwrap().1, f64::INFINITY);
        assert_eq!(least(&[], 0.0, |_| Ok(1.0)).unwrap(), (0.0, f64::INFINITY));
    }
}
