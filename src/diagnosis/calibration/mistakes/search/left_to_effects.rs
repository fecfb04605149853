//! Physics that acts on what a mistake acts on too: a mistake must be far more probable.

use nalgebra::Vector3;

use super::super::super::effects::loads::FORGOTTEN_AT_TIP;
use super::super::draft::{DraftChange, Rows};
use super::super::quick::{Worthwhile, density, fit, t_scale};
use super::{FittedDraft, MistakeSearch, ODDS, SearchStep};
use crate::statistics::median;

/// The price of a clamp that is not quite in its place: the same for its three numbers.
pub(super) const DISPLACED: f64 = -7.5;
/// The price of a tip that is elsewhere from some row on: three numbers and the row.
const SLIPPED: f64 = -12.0;
/// A mass at the tip that nobody stated, kg: how large it may be, and how finely it is sought.
/// Nothing is lighter than without what the file says.
const TIP: (f64, f64) = (1.0, 1e-3);
/// The price of a contact force of another size, and the sizes that are tried beside one that a
/// unit says.
const FORCE: (f64, [f64; 2]) = (-3.0, [0.5, 2.0]);

impl MistakeSearch<'_> {
    /// The best score of physics that acts on what the last change of `changed` acts on: small
    /// moves, places of clamps where their frames are changed, fixtures that moved and a tip that
    /// slipped where some rows are changed, another contact force, a loose tool.
    pub fn of_effects(&self, changed: &FittedDraft, from: &FittedDraft, tried: &[FittedDraft]) -> f64 {
        let small = tried.iter().filter(|state| !self.is_far(state)).map(|state| state.score);
        let others = [
            self.slipped(changed, from),
            self.another_force(changed, from),
            self.loose_tool(from),
            // that explains alike, not less: the heavier tip has a number of its own to choose
            changed.steps.last().and_then(|step| self.heavier_tip(step, from)).map(|score| score - ODDS),
        ];
        let displaced = self.displaced(changed, from).into_iter();
        let displaced = displaced.chain(self.moved_fixtures(changed, from)).chain(self.drifts(changed, from));
        let displaced = displaced.chain(self.knocked_clamps(changed, from));
        small.chain(displaced).chain(others.into_iter().flatten()).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Clamps that are not quite in their places: any one, or all whose frames are changed. Of
    /// three clamps one that stands aside pulls at all that they show.
    fn displaced(&self, changed: &FittedDraft, from: &FittedDraft) -> Vec<f64> {
        if self.draft.has_sockets() || self.draft.devices.len() < 2 {
            return Vec::new();
        }
        let mut turned: Vec<Vec<usize>> = (0..self.draft.devices.len()).map(|clamp| vec![clamp]).collect();
        match changed.steps.last().map(|step| self.change(step)) {
            Some(DraftChange::Devices(frames)) => turned.push(
                (frames.iter())
                    .filter(|(clamp, frame)| frame.origin == from.thin.devices[*clamp].origin)
                    .map(|(clamp, _)| *clamp)
                    .collect(),
            ),
            Some(DraftChange::Moved(_) | DraftChange::Seen(_) | DraftChange::Body(..)) => {}
            _ => return Vec::new(),
        }
        let displaced = turned.into_iter().filter(|turned| !turned.is_empty()).filter_map(|turned| {
            let mut thin = from.thin.clone();
            thin.loose = turned;
            let price = DISPLACED * thin.loose.len() as f64;
            self.with_loose(thin, price, changed, from)
        });
        displaced.collect()
    }

    /// A tip that is elsewhere in {T} in the rows whose positions are changed.
    fn slipped(&self, changed: &FittedDraft, from: &FittedDraft) -> Option<f64> {
        let Some(SearchStep::Part(_, DraftChange::Within(rows @ Rows::Between(..), change))) =
            changed.steps.last()
        else {
            return None;
        };
        if !matches!(**change, DraftChange::Seen(_) | DraftChange::Rows { .. } | DraftChange::Column { .. }) {
            return None;
        }
        let (thin, body) = (&from.thin, &self.bodies[from.thin.body]);
        let off = from.fit.offsets(thin, body);
        let in_tool = |at: usize| -> Option<Vector3<f64>> {
            let base = from.fit.bases.get(thin.station[at])?;
            let flange = body.robot.flange_at(thin.joints(at));
            Some(flange.rotation.tr_mul(&base.rotation.tr_mul(&off[at])))
        };
        let own: Vec<usize> =
            (0..thin.len()).filter(|&at| rows.contain(thin.rows[at], thin.group[at])).collect();
        let off: Vec<Vector3<f64>> = own.iter().map(|&at| in_tool(at)).collect::<Option<_>>()?;
        let middle = |axis: usize| median(&off.iter().map(|off| off[axis]).collect::<Vec<_>>());
        let step = Vector3::new(middle(0)?, middle(1)?, middle(2)?);
        let mut left = from.fit.residuals.clone();
        own.iter().zip(&off).for_each(|(&at, off)| left[at] = (off - step).norm());
        let least = f64::EPSILON * body.reach;
        let gain = density(&left, t_scale(&left, least)) - density(&from.fit.residuals, from.fit.scale);
        Some(from.score + gain + SLIPPED)
    }

    /// A contact force of another size than the one that a unit says.
    fn another_force(&self, changed: &FittedDraft, from: &FittedDraft) -> Option<f64> {
        let Some(SearchStep::Move(number)) = changed.steps.last() else { return None };
        let factor = self.moves[*number].force?;
        let scores = FORCE.1.iter().filter_map(|by| {
            let body = self.bodies[0].with_contact_force_times(factor * by);
            let fit = fit(&changed.thin, &body, Worthwhile::ANY)?;
            Some(self.scored(from.steps.clone(), changed.thin.clone(), fit).score + FORCE.0)
        });
        scores.max_by(f64::total_cmp)
    }

    /// The score of another mass at the tip than the stated one, where `step` changes the contact
    /// force: clamps that all stand on the same edge feel both along the vertical. It is as rare as
    /// the mistake, and rarer the more it is.
    pub(super) fn heavier_tip(&self, step: &SearchStep, from: &FittedDraft) -> Option<f64> {
        let SearchStep::Move(number) = step else { return None };
        self.moves[*number].force?;
        let with = |mass: f64| {
            let body = self.bodies[from.thin.body].with_tip_heavier_by(mass, &from.fit.tool);
            let fit = fit(&from.thin, &body, Worthwhile::ANY)?;
            Some(self.scored(from.steps.clone(), from.thin.clone(), fit).score)
        };
        let best = largest(|mass| with(mass).unwrap_or(f64::NEG_INFINITY), -self.tip_mass, TIP.0, TIP.1);
        // Cauchy's tail beyond what is usual
        let unusual = -(best / FORGOTTEN_AT_TIP).powi(2).ln_1p();
        Some(with(best)? + FORCE.0 + unusual + self.log_prior(std::slice::from_ref(step)))
    }
}

/// Where a function with one peak is largest, by halving the steps about the best of a grid.
fn largest(f: impl Fn(f64) -> f64, low: f64, high: f64, within: f64) -> f64 {
    const GRID: usize = 8;
    let mut step = (high - low) / GRID as f64;
    let grid = (0..=GRID).map(|k| low + k as f64 * step).map(|x| (x, f(x)));
    let better = |a: (f64, f64), b: (f64, f64)| if b.1 > a.1 { b } else { a };
    let mut best = grid.fold((low, f64::NEG_INFINITY), better);
    while step > within {
        step /= 2.0;
        best = [best.0 - step, best.0 + step]
            .map(|x| x.clamp(low, high))
            .into_iter()
            .map(|x| (x, f(x)))
            .fold(best, better);
    }
    best.0
}
