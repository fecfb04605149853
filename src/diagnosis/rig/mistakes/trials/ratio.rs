//! Trials whose lines are all the same multiple of the others', by a ratio that no usual unit has:
//! a display in another range, weights on a lever or a block, another rod.
//!
//! ```text
//! g = Σ w·y·x/Σ w·x²      y a line of these trials, x the same in the others, w = 1/σ²
//! σ² = y_e² + (g·x_e)² + (0.01·g·x_max)²
//! ```

use std::collections::BTreeSet;

use super::explained::{InTrials, OFF};
use super::right::{REPEATS, Right};
use super::table::{SHOWN, Table};
use crate::diagnosis::rig::effects::mistakes::{ROD_MISTAKE, UNIT_MISTAKE};
use crate::diagnosis::rig::mistakes::part::Part;
use crate::diagnosis::rig::recording::columns::{columns, load_column};
use crate::inference::{Estimate, Key};
use crate::rig::readings::LoadColumn;
use crate::spatial::Axis;
use crate::statistics::{HALF_95, chi_squared_survival, median};
use crate::units::with_uncertainty;

/// So many lines have the ratio: a single one may be of a part that has come loose in these trials.
const LINES: usize = 2;
/// And that they are as far from one ratio has at least this chance.
const CHANCE: f64 = 0.05;

/// A line of some trials, and the same in those that are right: at the largest load, m.
struct Both {
    line: usize,
    channel: Axis,
    own: f64,
    own_error: f64,
    right: f64,
    right_error: f64,
}

impl Both {
    /// σ at the ratio `g`, where the largest deflection is `most`.
    fn sigma(&self, g: f64, most: f64) -> f64 {
        self.own_error.hypot(g * self.right_error).hypot(REPEATS * g * most)
    }
}

impl Table<'_> {
    /// The ratio of some trials to those that are right, where they have just one.
    pub(super) fn ratio(
        &self,
        class: &[usize],
        right: &[Option<Right>],
        unit: LoadColumn,
    ) -> Option<InTrials> {
        let lines = self.both(class, right);
        let most = |size: &dyn Fn(&Both) -> f64| lines.iter().map(size).fold(0.0, f64::max);
        let (most_own, most_right) = (most(&|line| line.own.abs()), most(&|line| line.right.abs()));
        let is_shown =
            |line: &&Both| line.right.abs() > SHOWN * most_right || line.own.abs() > SHOWN * most_own;
        let ratios: Vec<f64> = lines.iter().filter(is_shown).map(|line| line.own / line.right).collect();
        let different: BTreeSet<usize> = lines.iter().filter(is_shown).map(|line| line.line).collect();
        let about = median(&ratios).filter(|about| different.len() >= LINES && *about > 0.0)?;
        let weight = |line: &Both| line.sigma(about, most_right).powi(-2);
        let square: f64 = lines.iter().map(|line| weight(line) * line.right.powi(2)).sum();
        let g = lines.iter().map(|line| weight(line) * line.own * line.right).sum::<f64>() / square;
        let apart = |line: &Both| (line.own - g * line.right) / line.sigma(g, most_right);
        let misfit: f64 = lines.iter().filter(is_shown).map(|line| apart(line).powi(2)).sum();
        let by_chance = chi_squared_survival(misfit, (ratios.len() - 1) as f64).ok()?;
        let off: f64 = lines.iter().map(|line| (line.own - line.right).powi(2)).sum();
        let all: f64 = lines.iter().map(|line| line.own.abs().max(line.right.abs()).powi(2)).sum();
        let half = HALF_95 * square.powf(-0.5);
        if by_chance < CHANCE || off < OFF * all || half >= g {
            return None;
        }
        let place = self.place(class);
        let mut channels: Vec<Axis> = lines.iter().map(|line| line.channel).collect();
        channels.sort_unstable();
        channels.dedup();
        let names = columns(&channels);
        let times = with_uncertainty(g, half, 2);
        let part = Part {
            effect: &UNIT_MISTAKE,
            location: Key::new(&names).rows(&place),
            estimates: vec![Estimate::as_written("factor", 1.0 / g, 1.0 / (g + half), 1.0 / (g - half))],
            observed: format!(
                "In {place}, {names} are {times} times what the other trials show under these loads, which no \
                 usual unit is: look up the range of the display, what hung there and on which rod; until then \
                 leave these rows out",
            ),
            looks_like: format!("in {place}, {names} are {times} times those of the other trials"),
            explains: (g - 1.0).abs() * most_own / g,
            data: (0..self.data.len()).filter(|&i| class.contains(&self.trial[i])).collect(),
            rivals: vec![
                (&UNIT_MISTAKE, Key::new(load_column(unit)).rows(&place)),
                (&ROD_MISTAKE, Key::new("rod").rows(&place)),
            ],
        };
        Some(InTrials { part, relabelling: None })
    }

    /// The lines of some trials that the right ones have as well.
    fn both(&self, class: &[usize], right: &[Option<Right>]) -> Vec<Both> {
        let of_line = |&trial: &usize| {
            let line = move |(k, right): (usize, &Option<Right>)| {
                let (cell, right) = (self.cells[trial][k]?, right.as_ref()?);
                Some(Both {
                    line: k,
                    channel: self.lines[k].channel,
                    own: cell.fit.slope * cell.load,
                    own_error: cell.fit.error * cell.load,
                    right: right.slope * cell.load,
                    right_error: right.error * cell.load,
                })
            };
            right.iter().enumerate().filter_map(line)
        };
        class.iter().flat_map(of_line).collect()
    }
}
