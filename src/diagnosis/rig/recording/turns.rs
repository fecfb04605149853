//! Where a slide turns round sharply, so that no curve goes on there.

use std::ops::Range;

use crate::statistics::median;

/// A slide that turns round goes back by more than as many standard deviations of the noise.
const TURNED: f64 = 4.0;
/// Steps differ from the next ones by √6 of the noise of a reading; and standard deviations per
/// median of the size of a normal number.
const OF_DIFFERENCES: f64 = 2.449_489_742_783_178;
const PER_MEDIAN: f64 = 1.482_602_218_505_602;
/// Steps of a slide that moves on evenly, and turns smoothly, differ from the next ones by less
/// than this share of the usual one.
const EVEN: f64 = 0.5;
/// The first turn has a step before it.
const FEW: usize = 2;

/// The ways of a slide from one sharp turn to the next, each reading in one.
pub struct Ways {
    /// One after the other.
    pub ways: Vec<Range<usize>>,
    /// Do steps differ little from the next ones?
    pub is_even: bool,
}

impl Ways {
    /// Of displacements that were read one after the other; nothing of fewer than three.
    pub fn of(u: &[f64]) -> Option<Ways> {
        let steps: Vec<f64> = u.windows(2).map(|own| own[1] - own[0]).collect();
        let size = |values: &mut dyn Iterator<Item = f64>| median(&values.map(f64::abs).collect::<Vec<_>>());
        let (step, differ) =
            (size(&mut steps.iter().copied())?, size(&mut steps.windows(2).map(|own| own[1] - own[0]))?);
        let mut ways = between_turns(u, TURNED * differ * PER_MEDIAN / OF_DIFFERENCES);
        let is_smooth =
            |turn: usize| (steps[turn] - steps[turn - 1]).abs() <= (EVEN * step).max(TURNED * differ);
        ways.dedup_by(|next, way| {
            let goes_on = way.end >= FEW && is_smooth(way.end - 1);
            if goes_on {
                way.end = next.end;
            }
            goes_on
        });
        Some(Ways { ways, is_even: differ <= EVEN * step })
    }
}

/// From one turn to the next, each reading in one way; it turns where it goes back by more than
/// `least`.
fn between_turns(u: &[f64], least: f64) -> Vec<Range<usize>> {
    let mut ways = Vec::new();
    let (mut begins, mut farthest, mut direction) = (0, 0, 0.0f64);
    for (k, value) in u.iter().enumerate() {
        let since = value - u[begins];
        let on = (value - u[farthest]) * if direction == 0.0 { since.signum() } else { direction };
        if on > 0.0 {
            farthest = k;
            if direction == 0.0 && since.abs() > least {
                direction = since.signum();
            }
        } else if direction != 0.0 && -on > least {
            ways.push(begins..farthest + 1);
            (begins, farthest, direction) = (farthest + 1, k, -direction);
        }
    }
    ways.push(begins..u.len());
    ways
}
