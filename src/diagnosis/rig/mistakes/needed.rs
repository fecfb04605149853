//! Which mistakes of a combination are needed, and cure what they act on.

use super::search::{ALIKE, Combination, IMPLAUSIBLE, MistakeSearch, ODDS};
use crate::diagnosis::rig::effects::mistakes::{SIGN_MISTAKE, SWAP_MISTAKE, UNIT_MISTAKE};
use crate::inference::Kind;

/// What a key in another unit must leave at least: 60 % rms.
const FAR_OFF: f64 = 0.36;
/// And that a corrected recording may leave: a unit's factor stands for itself, a sign is one
/// whatever the rod does.
const LEFT_BY_FACTOR: f64 = 0.06;
const LEFT_BY_NAME: f64 = 0.15;
/// At most this share of what was left before.
const CURED: f64 = 0.25;

/// A mistake that was found.
pub(super) struct NamedMistake {
    /// Its number among the possible ones.
    pub number: usize,
    /// Ln of the odds against what there is without it.
    pub log_odds: f64,
    /// Other possible ones that explain as much in its place, with the odds against them.
    pub rivals: Vec<(usize, f64)>,
    /// Ln of what the lines have in common, measured over expected, without it.
    pub log_scale_before: f64,
    /// Root mean square of what it changes of the expected deflections at the largest loads, m.
    pub explains: f64,
}

impl MistakeSearch<'_> {
    /// The mistakes, with what the readings and the rod become.
    pub(super) fn found(&self) -> Option<(Combination, Vec<NamedMistake>)> {
        self.likeliest().into_iter().find_map(|combination| self.needed(combination))
    }

    /// Those of a combination that are needed and cure what they act on: one that does not, does
    /// not speak against the others.
    fn needed(&self, mut best: Combination) -> Option<(Combination, Vec<NamedMistake>)> {
        while !best.mistakes.is_empty() {
            let judged: Vec<Option<NamedMistake>> =
                best.mistakes.iter().map(|&number| self.judged(&best, number)).collect();
            let Some(wrong) = judged.iter().position(Option::is_none) else {
                let mut found: Vec<NamedMistake> = judged.into_iter().flatten().collect();
                found.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
                return Some((best, found));
            };
            best.mistakes.remove(wrong);
            best = self.combination(best.mistakes)?;
        }
        None
    }

    /// One mistake of several; `None` where it is not needed or does not cure what it acts on.
    fn judged(&self, best: &Combination, number: usize) -> Option<NamedMistake> {
        let rest: Vec<usize> = best.mistakes.iter().copied().filter(|&other| other != number).collect();
        let is_wrong_body =
            rest.iter().all(|&other| self.possible[other].relabelling.body == 0) && !self.lines.is_possible;
        let before = match is_wrong_body {
            true => Combination { score: f64::NEG_INFINITY, ..best.clone() },
            // what is left without it may be beyond what a unit allows
            false => self.without(&rest)?,
        };
        let log_odds = (best.score - before.score).min(1e3);
        // readings that cannot be on the rod of the file are on any other one
        let cure = |own: &Combination, number| match is_wrong_body {
            true => Some(0.0),
            false => self.cure(own, &before, number),
        };
        let explains = cure(best, number).filter(|_| log_odds > ODDS)?;
        let instead = |other: usize| {
            let mut mistakes = rest.clone();
            mistakes.push(other);
            mistakes.sort_unstable();
            let own = self.combination(mistakes)?;
            let log_odds = best.score - own.score;
            (log_odds < ALIKE && cure(&own, other).is_some()).then_some((other, log_odds))
        };
        let is_other = |other: &usize| *other != number && !rest.contains(other);
        let mut rivals: Vec<(usize, f64)> =
            (0..self.possible.len()).filter(is_other).filter_map(instead).collect();
        rivals.sort_by(|a, b| a.1.total_cmp(&b.1));
        let rivals = rivals.into_iter().map(|(other, log_odds)| (other, log_odds.exp())).collect();
        debug_assert_eq!(self.possible[number].effect.kind, Kind::Mistake);
        Some(NamedMistake { number, log_odds, rivals, log_scale_before: before.log_scale, explains })
    }

    /// How much of the expected deflections this mistake of `own` changes, root mean square, m;
    /// `None` where it does not cure these.
    fn cure(&self, own: &Combination, before: &Combination, number: usize) -> Option<f64> {
        let seen_by = |combination: &Combination| {
            Some(
                self.lines.seen(self.physics(&combination.relabelling)?, &combination.relabelling).expected(),
            )
        };
        let (expected, old) = (seen_by(own)?, seen_by(before)?);
        let is_changed =
            |&k: &usize| (expected[k] - old[k]).abs() > 0.1 * expected[k].abs().max(old[k].abs());
        let part: Vec<usize> = (0..expected.len()).filter(is_changed).collect();
        let left = self.lines.left(&part, &old, 0.0);
        let off = self.lines.left(&part, &expected, own.log_scale);
        let leaves = off + self.lines.scattered(&part, &expected, own.log_scale);
        let effect = self.possible[number].effect;
        let is_name = [&SIGN_MISTAKE, &SWAP_MISTAKE].contains(&effect) && own.relabelling.body == 0;
        // a sign is the same one in readings that scatter
        let is_right = if is_name { off < LEFT_BY_NAME } else { leaves < LEFT_BY_FACTOR };
        // walls and lengths are off by a third in many a file: a unit is more than that
        let is_key = effect == &UNIT_MISTAKE && own.relabelling.body != before.relabelling.body;
        let least = if is_key { FAR_OFF } else { IMPLAUSIBLE };
        let change = |k: &usize| ((expected[*k] - old[*k]) * self.lines.lines[*k].largest_load).powi(2);
        let rms = (part.iter().map(change).sum::<f64>() / part.len().max(1) as f64).sqrt();
        (left > least && is_right && leaves < CURED * left).then_some(rms)
    }
}
