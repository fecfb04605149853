//! How probable a state is: what its fit explains, less what its changes cost.
//!
//! ```text
//! score = ln density of the residuals + ln agreement with the stated base and tip
//!         + ln prior of the changes + ln volume of the angles + ln volume of the positions
//! ```
//!
//! The volumes are those of what was recorded: numbers of another unit scatter less by their factor
//! and are no better for it.

use super::super::draft::{Draft, DraftChange, Rows};
use super::super::motion::moved;
use super::super::quick::{FAILED, Fit, ln_volume};
use super::{FittedDraft, MistakeSearch, SearchStep};
use crate::statistics::median;
use crate::units::{DEG, MM};

/// How rare any one of some hundred mistakes is: ln.
pub(in super::super) const RARE: f64 = -4.0;
/// The price of a frame that moved: half of ln 150 for each of its six numbers, and which row.
const MOVED: f64 = -20.0;
/// That of a clamp that stands elsewhere, or is turned: its three numbers, and which.
const FIXTURE: f64 = -12.0;
/// How sure a stated base is: share of the reach, rad; and a stated tip: m and share of its length.
/// Then what it costs at most that it was a rough guess, ln.
const BASE: (f64, f64, f64) = (0.03, 2.0 * DEG, 24.0);
const TOOL: (f64, f64, f64) = (5.0 * MM, 0.03, 12.0);

impl MistakeSearch<'_> {
    pub(in super::super) fn scored(&self, steps: Vec<SearchStep>, thin: Draft, fit: Fit) -> FittedDraft {
        let prior = self.log_prior(&steps);
        let reach = self.bodies[thin.body].reach;
        // where nothing fits, base and tip are anywhere
        let most = [BASE.2, TOOL.2].map(|most| most * self.guess_weight);
        let guess = match is_failed(&fit, reach) {
            true => -most[0] - most[1],
            false => guess(&thin, &fit, reach, most),
        };
        let volume = fit.log_volume(&thin, &self.bodies[thin.body]);
        let shrunk = self.shrunk(&steps, &thin);
        let score = fit.log_likelihood + guess + prior + volume + ln_volume(&shrunk);
        FittedDraft { score, steps, thin, fit, guess, volume, shrunk }
    }

    /// By what the steps make lengths of each row smaller. Larger numbers are no better either, but
    /// no file is known to less than some scatter, below which nothing is compared.
    fn shrunk(&self, steps: &[SearchStep], thin: &Draft) -> Vec<f64> {
        let mut shrunk = vec![1.0; thin.len()];
        for step in steps {
            let (rows, change) = match self.change(step) {
                DraftChange::Within(rows, change) => (Some(rows), &**change),
                change => (None, change),
            };
            let DraftChange::Seen(matrix) = change else { continue };
            let factor = matrix.determinant().abs().cbrt().min(1.0);
            let is_within =
                |at: usize| rows.is_none_or(|rows: &Rows| rows.contain(thin.rows[at], thin.group[at]));
            (0..thin.len()).filter(|&at| is_within(at)).for_each(|at| shrunk[at] *= factor);
        }
        shrunk
    }

    /// Ln of how rare these changes are.
    pub(super) fn log_prior(&self, steps: &[SearchStep]) -> f64 {
        let price = |step: &SearchStep| match step {
            SearchStep::Move(number) => RARE + self.moves[*number].log_prior,
            SearchStep::Elsewhere(DraftChange::Placed(_) | DraftChange::Devices(_)) => FIXTURE,
            SearchStep::Elsewhere(_) => MOVED,
            SearchStep::Part(number, change) => {
                RARE + self.of_rows[*number].log_prior - self.log_stretches(change)
            }
            SearchStep::Slip(_) => 0.0,
        };
        steps.iter().map(price).sum()
    }

    /// True where base or tip are not where they were said to be.
    pub fn is_rough_guess(&self, state: &FittedDraft) -> bool {
        state.guess < -0.5 * TOOL.2 * self.guess_weight
    }

    /// True where even the best fit leaves what no robot leaves.
    pub fn has_failed(&self, state: &FittedDraft) -> bool {
        is_failed(&state.fit, self.bodies[state.thin.body].reach)
    }
}

fn is_failed(fit: &Fit, reach: f64) -> bool {
    median(&fit.residuals).is_some_and(|left| left > FAILED * reach)
}

/// Ln of how well the stated base and tip agree with those found; `most` is what each may cost.
fn guess(draft: &Draft, fit: &Fit, reach: f64, most: [f64; 2]) -> f64 {
    let saturated = |square: f64, most: f64| -most * -(-square / (2.0 * most)).exp_m1();
    let mut sum = 0.0;
    if let (Some(stated), Some(found)) = (&draft.base, fit.bases.first()) {
        let (way, angle) = moved(stated, found);
        let square = (way / (BASE.0 * reach)).powi(2) + (angle / BASE.1).powi(2);
        sum += saturated(square, most[0]);
    }
    if let Some(stated) = draft.tool.filter(|_| !draft.has_sockets()) {
        let square = ((stated - fit.tool).norm() / (TOOL.0 + TOOL.1 * stated.norm())).powi(2);
        sum += saturated(square, most[1]);
    }
    sum
}
