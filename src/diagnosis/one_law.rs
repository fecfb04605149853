//! One law where names would be needed.
//!
//! A root that gives way by M^0.6 is a compliant root, an offset of the load and a stiffness that
//! depends on it, together: each is there for what the others do not draw. One that gives way by
//! M^1.4 is a stiffness that depends on the load, nearly, and numbers of the file that are far off.
//! So a law is looked for in the place of all names. It is the answer where it predicts readings
//! that were held out as well as they do, and is likelier by the odds of a name,
//!
//! ```text
//! ln B ≈ ½·ν·ln(S_names/S_law) + ½·Σ(z_names² − z_law²) − ½·(k_law − k_names)·ln n
//! ```
//!
//! S the squares that each leaves of n data about the means of those that share a zero, ν of them
//! free, z the numbers of the files that it needs (in standard uncertainties), k its own numbers
//! (G. Schwarz, Ann. Statist. 6, 1978). A curve that is needed beside the names is one of them. Of
//! three names or more it is enough that a law needs fewer numbers and leaves as little. A law that
//! is likelier by less is said beside the names. A law of as many numbers that explains the same of
//! the data as the names is no other one: their own formula.

use std::collections::BTreeMap;

use nalgebra::DVector;

use crate::diagnosis::Limitation;
use crate::inference::law::{Law, Memory, Proposed};
use crate::inference::{Diagnosis, Evidence, Finding, Kind, NAMED, ShownBy};
use crate::units::significant;

/// So many names, a curve counted as one, are many.
const MANY: usize = 3;
/// A curve has more numbers than these.
const OF_CURVE: usize = 2;
/// What a law and names explain is the same where the cosine between the two is larger: one differs
/// from the other by a tenth of itself.
const ALIKE: f64 = 0.995;
/// A law that leaves at most so much more, as a factor, leaves as little as many names: these may
/// have a curve beside them, which takes up a part of the scatter.
const AS_LITTLE: f64 = 1.15;
/// Ln of the odds by which a law may leave more than a few names at first sight: its constants are
/// yet to be fitted.
const BEHIND: f64 = 20.0;
/// Numbers of the files may be off by so much more beside the law, as a sum of the squares of their
/// standard uncertainties.
const FARTHER: f64 = 9.0;

/// What a law is in the place of names.
pub(super) enum Instead {
    /// The answer.
    Law(Limitation),
    /// As likely as the names, or likelier by less than the odds of a name.
    Rival(Limitation),
}

/// Names that a law may take the place of; nothing where something happened, or was mistaken.
pub(super) fn names(named: &Diagnosis) -> Vec<&Finding> {
    let is_physics = |finding: &&Finding| finding.kind() == Kind::Physics;
    match named.findings.iter().all(|finding| is_physics(&finding)) {
        true => named.findings.iter().collect(),
        false => Vec::new(),
    }
}

/// Can a law that leaves `left` of the data without names still take the place of those of `named`?
/// Of many names it needs only fewer numbers.
pub(super) fn may_do(left: &DVector<f64>, without: &Diagnosis, named: &Diagnosis) -> bool {
    let curve = named.discrepancy.as_ref().filter(|left| left.shown_by == ShownBy::Curve);
    let beside_names = curve.map_or_else(|| named.after.clone(), |curve| &named.after - &curve.shape);
    let are_many = names(named).len() + usize::from(curve.is_some()) >= MANY;
    are_many || likelier(&without.settled.0, &beside_names, left) > -BEHIND
}

/// A law that was `proposed` for the same data without names, compared with those of `named`.
pub(super) fn compared(proposed: &Proposed, without: &Diagnosis, named: &Diagnosis) -> Option<Instead> {
    let (law, names) = (proposed.law.as_ref().ok()?, names(named));
    let curve = named.discrepancy.as_ref().filter(|left| left.shown_by == ShownBy::Curve);
    let has_curve = curve.is_some();
    let of_names = names.iter().map(|finding| finding.estimates.len()).sum::<usize>();
    let numbers = of_names + if has_curve { OF_CURVE } else { 0 };
    // what numbers of the files are then, as Σ z²
    let square = |background: &[f64]| -> f64 {
        without.settled.0.folded.clone().filter_map(|k| background.get(k)).map(|z| z * z).sum()
    };
    let farther = square(&law.beside.background) - square(named.hypothesis.background.as_slice());
    let count = without.settled.0.residual.len() as f64;
    let more_numbers = numbers_of(law) as f64 - numbers as f64;
    let beside_names = curve.map_or_else(|| named.after.clone(), |curve| &named.after - &curve.shape);
    let left = DVector::from_column_slice(&law.left);
    // as many numbers, and none of them says how it bends: the names say the same
    let has_a_shape = law.constant.is_some() || !law.of_shape.is_empty() || law.second.is_some();
    if !has_a_shape && more_numbers >= 0.0 {
        let explained = [&named.before - &beside_names, &without.before - &left];
        if are_alike(&without.settled.0, &explained) {
            return None;
        }
    }
    let leaves_less = likelier(&without.settled.0, &beside_names, &left);
    let log_odds = odds(leaves_less, farther, more_numbers, count);
    // both searches are repeated without each fold
    let own = law.held_out.into_iter().chain(proposed.held_out.map(|(_, with)| with));
    let (own, after) = (own.reduce(f64::max)?, named.held_out.as_ref()?.after);
    if own > after || farther >= FARTHER || law.more.is_some() {
        return None;
    }
    let are_many = names.len() + usize::from(has_curve) >= MANY;
    let is_as_little = law.noise <= AS_LITTLE * named.noise;
    let is_simpler = are_many && more_numbers < 0.0 && is_as_little;
    let mut causes: Vec<&str> = names.iter().map(|finding| finding.effect.cause).collect();
    causes.dedup();
    // of two laws at once many are as likely as a name by chance
    let is_one = law.second.is_none();
    match is_simpler || (is_one && log_odds > NAMED.ln()) {
        true => Some(Instead::Law(Limitation::NamesForLaw(causes.join(", "), of_names))),
        false => (is_one && log_odds.min(leaves_less) > 0.0)
            .then(|| Instead::Rival(Limitation::LawForNames(description(law)))),
    }
}

/// True where two explain the same of the data, as these count.
fn are_alike(evidence: &Evidence, [one, other]: &[DVector<f64>; 2]) -> bool {
    let product = |a: &DVector<f64>, b: &DVector<f64>| -> f64 {
        evidence.weight.iter().zip(a.iter().zip(b)).map(|(weight, (a, b))| weight * a * b).sum()
    };
    product(one, other) > ALIKE * (product(one, one) * product(other, other)).sqrt()
}

/// ln B of the law against the names.
fn odds(leaves_less: f64, farther: f64, more_numbers: f64, count: f64) -> f64 {
    leaves_less - 0.5 * farther - 0.5 * more_numbers * count.ln()
}

/// ½·ν·ln(S_one/S_other): what data are likelier, at the best noise each, where `other` is left of
/// them than where `one` is.
fn likelier(evidence: &Evidence, one: &DVector<f64>, other: &DVector<f64>) -> f64 {
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (row, &group) in evidence.shared.iter().enumerate() {
        groups.entry(group).or_default().push(row);
    }
    let (mut squares, mut free) = ([0.0; 2], 0.0);
    for rows in groups.values() {
        let weight: f64 = rows.iter().map(|&row| evidence.weight[row]).sum();
        let has_zero = rows.len() > 1 && weight > 0.0;
        free += rows.len() as f64 - f64::from(u8::from(has_zero));
        for (square, left) in squares.iter_mut().zip([one, other]) {
            let sum: f64 = rows.iter().map(|&row| evidence.weight[row] * left[row]).sum();
            let mean = if has_zero { sum / weight } else { 0.0 };
            *square += rows.iter().map(|&row| evidence.weight[row] * (left[row] - mean).powi(2)).sum::<f64>();
        }
    }
    0.5 * free * (squares[0].max(f64::MIN_POSITIVE) / squares[1].max(f64::MIN_POSITIVE)).ln()
}

/// `power of the moment (root), exponent 1.38 (1.30 to 1.46)`.
fn description(law: &Law) -> String {
    let constant = law.constant.as_ref().map(|(_, constant)| {
        let [value, low, high] = [constant.value, constant.low, constant.high].map(|x| significant(x, 3));
        let unit = if constant.unit.is_empty() { String::new() } else { format!(" {}", constant.unit) };
        format!(", {} {value} ({low} to {high}){unit}", constant.name)
    });
    let memory = match law.memory {
        Memory::None => String::new(),
        _ => format!(", {}", law.memory.name()),
    };
    let (form, variable, place) = (law.form.name(), &law.site.variable.name, &law.site.location);
    format!("{form} of the {variable} ({place}){memory}{}", constant.unwrap_or_default())
}

fn numbers_of(law: &Law) -> usize {
    let own = law.amplitudes.len() + usize::from(law.constant.is_some()) + law.of_shape.len();
    own + law.second.as_ref().map_or(0, |second| numbers_of(&second.law))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A law that leaves as much with one number more is no better than a name, and one whose
    /// numbers of the files are three standard uncertainties nearer is.
    #[test]
    fn a_number_has_its_price() {
        assert!(odds(0.0, 0.0, 1.0, 60.0) < -2.0 && odds(0.0, -9.0, 0.0, 60.0) > NAMED.ln());
    }

    #[test]
    fn what_explains_the_same_is_alike_whatever_its_size() {
        let own = DVector::from_vec(vec![1.0, -1.0, 0.5, 0.2, -0.4, 0.1]);
        let evidence = Evidence::new(own.clone());
        let other = DVector::from_vec(vec![1.0, -1.0, 0.5, 0.2, -0.4, 0.4]);
        assert!(are_alike(&evidence, &[own.clone(), &own * 0.9]));
        assert!(!are_alike(&evidence, &[own.clone(), -&own]) && !are_alike(&evidence, &[own, other]));
    }

    /// Two runs of three readings, each with a zero of its own: what differs within is left.
    #[test]
    fn a_zero_of_a_run_makes_nothing_likelier() {
        let shared = vec![0, 0, 0, 1, 1, 1];
        let own = DVector::from_vec(vec![1.0, -1.0, 0.5, 0.2, -0.4, 0.1]);
        let evidence = Evidence { shared, ..Evidence::new(own.clone()) };
        let zeroed = DVector::from_vec(vec![8.0, 6.0, 7.5, -3.8, -4.4, -3.9]);
        assert!(likelier(&evidence, &own, &zeroed).abs() < 1e-12);
        // half as much is left, of 6 − 2 data
        assert!((likelier(&evidence, &own, &(&zeroed * 0.5)) - 4.0 * 2.0f64.ln()).abs() < 1e-12);
    }
}
