//! Whether a plan is the least laborious one: all plans of less effort, by branch and bound.
//!
//! More readings, or more repeats of them, never tell less: what they add can be left out of
//! account, and the divergence of two models never grows by that (data processing inequality: S.
//! Kullback, R. A. Leibler, *Ann. Math. Statist.* 22 (1951) 79–86). So where some measurements,
//! each with as many repeats as the effort allows, are not enough, no plan of these measurements
//! is.

/// Repeats of each measurement.
pub(super) type Counts = Vec<usize>;

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Least {
    /// A plan of less effort; `None` where none was found.
    pub(super) better: Option<Counts>,
    /// Whether all plans of less effort were ruled out.
    pub(super) is_proven: bool,
}

/// The least laborious plan that is enough, of those that take less than `effort` minutes;
/// `labour[k][r]` are the minutes of r repeats of measurement k, infinite where that is no plan. At
/// most `most` plans are tried.
pub(super) fn least(
    labour: &[Vec<f64>],
    effort: f64,
    most: usize,
    is_enough: &dyn Fn(&[usize]) -> bool,
) -> Least {
    let mut search = Search { labour, effort, left: most, is_enough, better: None };
    let all = (0..labour.len()).collect();
    let is_proven = search.branch(&mut vec![0; labour.len()], all).is_some();
    Least { better: search.better, is_proven }
}

struct Search<'a> {
    labour: &'a [Vec<f64>],
    /// Of the best plan so far.
    effort: f64,
    /// Plans that may still be tried.
    left: usize,
    is_enough: &'a dyn Fn(&[usize]) -> bool,
    better: Option<Counts>,
}

impl Search<'_> {
    /// All plans that hold the measurements of `chosen`, with so many repeats at least, and any of
    /// `open`; `None` where that took too many trials.
    fn branch(&mut self, chosen: &mut Counts, open: Vec<usize>) -> Option<()> {
        let spent = self.minutes(chosen);
        let room = self.effort - spent;
        let fits = |k: &usize| self.fewest(*k).is_some_and(|fewest| self.labour[*k][fewest] < room);
        let mut open: Vec<usize> = open.into_iter().filter(fits).collect();
        // as many repeats of each as there is room for by itself
        let mut bound = chosen.clone();
        for k in 0..bound.len() {
            if chosen[k] > 0 || open.contains(&k) {
                let known = self.labour[k][chosen[k]];
                let last = self.labour[k].iter().rposition(|minutes| minutes - known < room);
                bound[k] = last.unwrap_or(chosen[k]).max(chosen[k]);
            }
        }
        if !self.tries(&bound)? {
            return Some(());
        }
        // the cheapest first, so that the effort falls early
        open.sort_by(|&a, &b| self.least_minutes(a).total_cmp(&self.least_minutes(b)).then(a.cmp(&b)));
        let Some((&first, others)) = open.split_first() else { return self.repeats(chosen, 0) };
        chosen[first] = self.fewest(first).unwrap_or_default();
        self.branch(chosen, others.to_vec())?;
        chosen[first] = 0;
        self.branch(chosen, others.to_vec())
    }

    /// All numbers of repeats of the measurements of `counts`, from the `k`th on.
    fn repeats(&mut self, counts: &mut Counts, k: usize) -> Option<()> {
        let Some(k) = (k..counts.len()).find(|&k| counts[k] > 0) else {
            let minutes = self.minutes(counts);
            if minutes < self.effort && self.tries(counts)? {
                (self.effort, self.better) = (minutes, Some(counts.clone()));
            }
            return Some(());
        };
        let fewest = counts[k];
        for more in fewest..self.labour[k].len() {
            counts[k] = more;
            if self.minutes(counts) < self.effort {
                self.repeats(counts, k + 1)?;
            }
        }
        counts[k] = fewest;
        Some(())
    }

    fn tries(&mut self, counts: &[usize]) -> Option<bool> {
        self.left = self.left.checked_sub(1)?;
        Some((self.is_enough)(counts))
    }

    fn minutes(&self, counts: &[usize]) -> f64 {
        counts.iter().enumerate().filter(|(_, r)| **r > 0).map(|(k, r)| self.labour[k][*r]).sum()
    }

    /// Fewest repeats of a measurement; `None` where it cannot be made.
    fn fewest(&self, k: usize) -> Option<usize> {
        (1..self.labour[k].len()).find(|&repeats| self.labour[k][repeats].is_finite())
    }

    fn least_minutes(&self, k: usize) -> f64 {
        self.fewest(k).map_or(f64::INFINITY, |repeats| self.labour[k][repeats])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    const REPEATS: usize = 5;

    /// Beside every plan there is, of four measurements that tell by chance.
    #[test]
    fn no_plan_of_less_effort_is_enough() {
        let mut random = Random::seeded(9, 1);
        let (mut found, mut none) = (0, 0);
        for _ in 0..40 {
            let labour: Vec<Vec<f64>> = (0..4)
                .map(|_| {
                    let (setup, each) = (10.0 * random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
                    let minutes = |r: usize| match r {
                        0 => 0.0,
                        1 => f64::INFINITY,
                        _ => setup + each * r as f64,
                    };
                    (0..=REPEATS).map(minutes).collect()
                })
                .collect();
            let gains: Vec<[f64; 2]> =
                (0..4).map(|_| [random.uniform(0.0, 1.0), random.uniform(0.0, 1.0)]).collect();
            // two aims, each of which every measurement comes nearer by the root of its repeats
            let is_enough = |counts: &[usize]| {
                let sum = |aim: usize| -> f64 {
                    counts.iter().zip(&gains).map(|(r, gain)| gain[aim] * (*r as f64).sqrt()).sum()
                };
                sum(0) >= 3.0 && sum(1) >= 3.0
            };
            let mut best: Option<(f64, Counts)> = None;
            for code in 0..(REPEATS + 1).pow(4) {
                let counts: Counts = (0..4u32).map(|k| code / (REPEATS + 1).pow(k) % (REPEATS + 1)).collect();
                let minutes: f64 = counts.iter().enumerate().map(|(k, r)| labour[k][*r]).sum();
                if minutes.is_finite() && is_enough(&counts) && best.as_ref().is_none_or(|b| minutes < b.0) {
                    best = Some((minutes, counts));
                }
            }
            let searched = least(&labour, 1e9, 100_000, &is_enough);
            assert_eq!(searched, Least { better: best.clone().map(|b| b.1), is_proven: true });
            let Some((minutes, _)) = best else {
                none += 1;
                continue;
            };
            found += 1;
            // from the best one there is nothing better
            let searched = least(&labour, minutes, 100_000, &is_enough);
            assert_eq!(searched, Least { better: None, is_proven: true });
            assert!(!least(&labour, minutes + 1.0, 1, &is_enough).is_proven);
        }
        assert!(found > 10 && none > 0, "{found} {none}");
    }
}
