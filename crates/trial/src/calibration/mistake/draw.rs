//! Which mistake a case holds.
//!
//! A mistake is drawn only where it shows: where the robot as its file has it then misses a third
//! of the points by a thirtieth of its reach, by a tenth where only a first guess is wrong.

use std::ops::Range;

use nalgebra::Vector3;

use super::Mistake;
use crate::calibration::arm::{self, frame, point};
use crate::calibration::rod::Rod;
use crate::calibration::site::{Devices, Site};
use crate::calibration::text::Written;
use crate::chance::happens;
use rodcal_base::statistics::Random;
use rodcal_base::units::DEG;

/// Kinds of mistakes that are drawn alike often.
const KINDS: usize = 17;
/// Share of the mistakes of rows that only some rows hold, and how large a share of the rows.
const OF_SOME: f64 = 0.4;
const STRETCH: (f64, f64) = (0.15, 0.5);
/// Tries until one shows.
const TRIES: usize = 200;
/// Share of the points that are missed, and by how much of the reach; and by how much where only a
/// first guess is wrong.
const SHOWS: (f64, f64) = (0.33, 1.0 / 30.0);
const GUESS: f64 = 0.1;

/// One that shows in what was written rightly.
pub fn draw(right: &Written, random: &mut Random) -> Mistake {
    let n = right.site.nominal.len();
    let two = |count: usize, random: &mut Random| {
        let first = random.index(count);
        let second = (first + 1 + random.index(count.max(2) - 1)) % count.max(1);
        [first.min(second), first.max(second)]
    };
    let rows = right.site.rows.len();
    for _ in 0..TRIES {
        let kind = random.index(KINDS);
        let mistake = match kind {
            0 => Mistake::JointSign(happens(random, 0.8).then(|| random.index(n))),
            1 => Mistake::JointOrder(happens(random, 0.8).then(|| two(n, random))),
            2 => {
                let quarters = [1, -1, 2][random.index(3)];
                Mistake::Zero { joint: random.index(n), quarters }
            }
            3 => Mistake::Radians,
            4 => Mistake::AxisSign(random.index(3)),
            5 => Mistake::AxisOrder(two(3, random)),
            6 => Mistake::Positions([1000.0, 25.4][random.index(2)]),
            7 => {
                let by = [1, -1, 1, 2, -3][random.index(5)];
                Mistake::Rows { by, with_clamps: happens(random, 0.5) }
            }
            8 => Mistake::Groups(two(right.site.groups(), random)),
            9 => Mistake::ClampsInMetres,
            10 => Mistake::BaseInverse,
            11 => Mistake::BaseOrder,
            12 => Mistake::BaseInMetres,
            13 => Mistake::ToolOrder(two(3, random)),
            14 => Mistake::Distance([10.0, 1000.0, 25.4, 1.1, 0.9][random.index(5)]),
            15 => {
                let by = [10.0, -10.0, 20.0, -20.0][random.index(4)] * DEG;
                Mistake::Typed { row: random.index(rows), joint: random.index(n), by }
            }
            16 if right.site.rod.is_some() => Mistake::Rod(Box::new(Rod::drawing(random))),
            _ => Mistake::Stuck(random.index(3)),
        };
        let mistake = match mistake.is_of_rows() && happens(random, OF_SOME) {
            true => {
                let count = ((rows as f64 * random.uniform(STRETCH.0, STRETCH.1)) as usize).max(3);
                let first = random.index(rows.saturating_sub(count).max(1));
                Mistake::Part(Box::new(mistake), [first, (first + count).min(rows)])
            }
            false => mistake,
        };
        let least = if mistake.is_guess() { GUESS } else { SHOWS.1 };
        let is_shown = || match mistake {
            // what no pose shows by itself
            Mistake::Distance(_) => true,
            _ => shows(&mistake.applied_to(right), right, mistake.rows(rows), least),
        };
        if mistake.is_possible(&right.site) && is_shown() {
            return mistake;
        }
    }
    Mistake::JointSign(Some(1))
}

impl Mistake {
    /// False where the files have no such thing, or where sockets hide it altogether.
    fn is_possible(&self, site: &Site) -> bool {
        let n = site.nominal.len();
        let has_clamps = matches!(site.devices, Devices::Clamps(_));
        match self {
            Mistake::Zero { joint, .. } if site.has_sockets() => (1..n - 1).contains(joint),
            Mistake::AxisSign(_)
            | Mistake::AxisOrder(_)
            | Mistake::Positions(_)
            | Mistake::Stuck(_)
            | Mistake::BaseInverse
            | Mistake::BaseOrder
            | Mistake::BaseInMetres => !site.has_sockets(),
            Mistake::Rows { with_clamps, .. } => !site.has_sockets() && (has_clamps || !with_clamps),
            Mistake::Groups(_) | Mistake::ClampsInMetres => has_clamps,
            Mistake::ToolOrder(_) => site.rod.is_none() && !site.has_sockets(),
            Mistake::Distance(_) => site.has_sockets(),
            // a last joint that turns the tip about itself, or a first one, may be anywhere
            Mistake::Typed { joint, .. } => (1..n - 1).contains(joint),
            Mistake::Part(whole, _) => whole.is_possible(site),
            _ => true,
        }
    }

    /// True for what acts on rows one by one.
    fn is_of_rows(&self) -> bool {
        matches!(
            self,
            Mistake::JointSign(_)
                | Mistake::JointOrder(_)
                | Mistake::Zero { .. }
                | Mistake::Radians
                | Mistake::AxisSign(_)
                | Mistake::AxisOrder(_)
                | Mistake::Positions(_)
        )
    }

    /// The rows that hold it, of so many.
    fn rows(&self, count: usize) -> Range<usize> {
        match self {
            Mistake::Typed { row, .. } => *row..row + 1,
            Mistake::Part(_, [first, end]) => *first..*end,
            _ => 0..count,
        }
    }

    /// True where nothing is wrong but a first guess, which a calibration corrects.
    fn is_guess(&self) -> bool {
        matches!(
            self,
            Mistake::BaseInverse | Mistake::BaseOrder | Mistake::BaseInMetres | Mistake::ToolOrder(_)
        )
    }
}

/// True where the robot of the files misses many of the points that these rows state: with sockets,
/// of those that it reached when nothing was written wrongly.
fn shows(wrong: &Written, right: &Written, rows: Range<usize>, least: f64) -> bool {
    let reach: f64 = right.site.nominal.iter().map(|l| l.numbers[1].abs() + l.numbers[2].abs()).sum();
    let stated = |written: &Written, row: usize| {
        let own = &written.site;
        let [xyz, rpy] = &written.guess;
        let frames = arm::frames(&own.nominal, &frame(xyz, rpy), &own.rows[row].q);
        let tip = point(&frames[own.nominal.len()], &own.drawn_tool);
        let seen = match own.has_sockets() {
            true => None,
            false => Some(point(&own.device(own.rows[row].group), &written.read[row])),
        };
        (tip, seen)
    };
    // where rows were displaced some are gone
    let rows = rows.start..rows.end.min(wrong.site.rows.len());
    let count = rows.len();
    let misses = |row: usize| {
        let (tip, seen) = stated(wrong, row);
        let goal: Vector3<f64> = seen.unwrap_or_else(|| stated(right, row).0);
        (tip - goal).norm() > least * reach
    };
    rows.filter(|&row| misses(row)).count() as f64 > SHOWS.0 * count as f64
}

#[cfg(test)]
mod tests {
    use super::super::tests::right;
    use super::*;

    #[test]
    fn what_is_right_shows_nothing_and_what_is_drawn_shows() {
        let mut names = std::collections::BTreeSet::new();
        for device in 0..3 {
            let right = right(device, 4);
            let rows = right.site.rows.len();
            assert!(!shows(&right, &right, 0..rows, SHOWS.1));
            let files = crate::calibration::text::files(&right);
            for seed in 0..30 {
                let mistake = draw(&right, &mut Random::seeded(seed, 1));
                let wrong = mistake.applied_to(&right);
                let is_shown = shows(&wrong, &right, mistake.rows(rows), SHOWS.1);
                assert!(is_shown || matches!(mistake, Mistake::Distance(_)), "{mistake:?}");
                assert!(crate::calibration::text::files(&wrong) != files);
                names.insert(mistake.name());
            }
        }
        assert!(names.len() >= 6, "{names:?}");
    }
}
