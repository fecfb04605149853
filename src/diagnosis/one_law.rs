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
/// Ln of the odds by which a law may be behind a few names at first sight: it may yet have a number
/// more.
const BEHIND: f64 = 10.0;
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

/// What a diagnosis needs to explain the data by names.
struct Needed {
    /// Names, a curve beside them counted as one.
    count: usize,
    /// Their numbers.
    numbers: usize,
    /// How far off the numbers of the files are beside them, as Σ z².
    square: f64,
    /// What they leave of the data, m.
    left: DVector<f64>,
}

impl Needed {
    fn by(named: &Diagnosis, evidence: &Evidence) -> Needed {
        let names = names(named);
        let numbers = names.iter().map(|finding| finding.estimates.len()).sum();
        let square = square(evidence, named.hypothesis.background.as_slice());
        let own = Needed { count: names.len(), numbers, square, left: named.after.clone() };
        match named.discrepancy.as_ref().filter(|left| left.shown_by == ShownBy::Curve) {
            Some(curve) => {
                let left = &named.after - &curve.shape;
                Needed { count: own.count + 1, numbers: numbers + OF_CURVE, left, ..own }
            }
            None => own,
        }
    }

    fn are_many(&self) -> bool {
        self.count >= MANY
    }

    /// Can a law that leaves `left` be as likely, were it of one number and the files' numbers as
    /// they say? In the place of many names it needs only fewer numbers.
    fn may_be_one(&self, evidence: &Evidence, left: &DVector<f64>) -> bool {
        let leaves_less = likelier(evidence, &self.left, left);
        let more_numbers = 1.0 - self.numbers as f64;
        let at_best = odds(leaves_less, -self.square, more_numbers, left.len() as f64);
        self.are_many() || at_best > -BEHIND
    }
}

/// How far off the numbers of the files are, as Σ z².
fn square(evidence: &Evidence, background: &[f64]) -> f64 {
    evidence.folded.clone().filter_map(|k| background.get(k)).map(|z| z * z).sum()
}

/// Can a law that leaves `left` of the data `without` names take the place of those of `named`?
pub(super) fn may_do(left: &DVector<f64>, without: &Diagnosis, named: &Diagnosis) -> bool {
    let evidence = &without.settled.0;
    Needed::by(named, evidence).may_be_one(evidence, left)
}

/// A law that was `proposed` for the same data without names, compared with those of `named`.
pub(super) fn compared(proposed: &Proposed, without: &Diagnosis, named: &Diagnosis) -> Option<Instead> {
    let (law, evidence) = (proposed.law.as_ref().ok()?, &without.settled.0);
    let needed = Needed::by(named, evidence);
    let farther = square(evidence, &law.beside.background) - needed.square;
    let more_numbers = numbers_of(law) as f64 - needed.numbers as f64;
    let left = DVector::from_column_slice(&law.left);
    // as many numbers, and none of them says how it bends: the names say the same
    let has_a_shape = law.constant.is_some() || !law.of_shape.is_empty() || law.second.is_some();
    if !has_a_shape && more_numbers >= 0.0 {
        let explained = [&named.before - &needed.left, &without.before - &left];
        if are_alike(evidence, &explained) {
            return None;
        }
    }
    let leaves_less = likelier(evidence, &needed.left, &left);
    let log_odds = odds(leaves_less, farther, more_numbers, left.len() as f64);
    // both searches are repeated without each fold
    let own = law.held_out.into_iter().chain(proposed.held_out.map(|(_, with)| with));
    let (own, after) = (own.reduce(f64::max)?, named.held_out.as_ref()?.after);
    if own > after || farther >= FARTHER || law.more.is_some() {
        return None;
    }
    let (squares, _) = squares(evidence, [&needed.left, &left]);
    let is_as_little = squares[1] <= AS_LITTLE.powi(2) * squares[0];
    let is_simpler = needed.are_many() && more_numbers < 0.0 && is_as_little;
    let names = names(named);
    let of_names = names.iter().map(|finding| finding.estimates.len()).sum::<usize>();
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
    let (squares, free) = squares(evidence, [one, other]);
    0.5 * free * (squares[0].max(f64::MIN_POSITIVE) / squares[1].max(f64::MIN_POSITIVE)).ln()
}

/// S of what is left of the data in two ways, and ν.
fn squares(evidence: &Evidence, left: [&DVector<f64>; 2]) -> ([f64; 2], f64) {
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (row, &group) in evidence.shared.iter().enumerate() {
        groups.entry(group).or_default().push(row);
    }
    let (mut squares, mut free) = ([0.0; 2], 0.0);
    for rows in groups.values() {
        let weight: f64 = rows.iter().map(|&row| evidence.weight[row]).sum();
        let has_zero = rows.len() > 1 && weight > 0.0;
        free += rows.len() as f64 - f64::from(u8::from(has_zero));
        for (square, left) in squares.iter_mut().zip(left) {
            let sum: f64 = rows.iter().map(|&row| evidence.weight[row] * left[row]).sum();
            let mean = if has_zero { sum / weight } else { 0.0 };
            *square += rows.iter().map(|&row| evidence.weight[row] * (left[row] - mean).powi(2)).sum::<f64>();
        }
    }
    (squares, free)
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

    /// By as much as its fewer numbers, and numbers of the files that are as they say, may be worth
    /// and by ten more.
    #[test]
    fn a_law_that_leaves_far_more_than_a_name_is_hopeless() {
        let left = DVector::from_fn(40, |k, _| if k % 2 == 0 { 1.0 } else { -1.0 });
        let evidence = Evidence::new(left.clone());
        let needed = |count, numbers, square| Needed { count, numbers, square, left: left.clone() };
        let may = |needed: Needed, times: f64| needed.may_be_one(&evidence, &(&left * times));
        // 20·ln 1.6² = 18.8 behind
        assert!(may(needed(1, 2, 0.0), 1.2) && !may(needed(1, 2, 0.0), 1.6));
        assert!(may(needed(1, 6, 0.0), 1.6) && may(needed(1, 2, 16.0), 1.6));
        // many names it may leave more than, if it is simpler
        assert!(may(needed(3, 2, 0.0), 1.6));
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
