//! Which of the effects that make a story most probable are worth a name.

use nalgebra::DVector;

use super::diagnose::rms;
use super::linear::Linearised;
use super::search::{Search, Story};
use super::selection::Remainder;
use super::{Chosen, Evidence, World};

/// What is left is little: as a share of what an effect explains, and of the noise.
const LITTLE: (f64, f64) = (0.1, 0.5);

/// The story that a recording tells, what it leaves unexplained, and the search that found them.
///
/// The scatter is that of what the first story leaves: what is found first changes how the rest scatters.
pub fn judged<'a>(
    world: &'a Linearised<'a>,
    evidence: &'a Evidence,
) -> (Search<'a>, Story, Option<Remainder>) {
    let mut search = Search::new(world, evidence, &[]);
    let (mut story, mut unknown) = search.best();
    // without shared errors there is no scatter to settle
    if !story.chosen.is_empty() && search.whitening.is_of_shared_errors() {
        search = Search::new(world, evidence, &story.chosen);
        (story, unknown) = search.best();
    }
    let story = beyond_the_tails(&search, story);
    let (story, unknown) = convincing(&search, story, unknown);
    (search, story, unknown)
}

/// A story without the effects that may as well be a part of what is left unexplained, and what is left then.
///
/// An effect stays if it explains more than is left even where the unexplained curve is there to take its place (an outlier,
/// which no smooth curve draws), or if what is left is little beside it or beside the noise (a law of creep that is not quite
/// the right one).
fn convincing(search: &Search, story: Story, unknown: Option<Remainder>) -> (Story, Option<Remainder>) {
    let Some(remainder) = &unknown else { return (story, unknown) };
    let own = |whole: &Story, position: usize| {
        let without = search.left_rms(&search.without(whole, position));
        (without.powi(2) - search.left_rms(whole).powi(2)).max(0.0).sqrt()
    };
    let left = match remainder {
        Remainder::Curve(longer) => own(longer, longer.chosen.len() - 1),
        Remainder::Cells => search.cells_rms(&story),
    };
    let is_kept = |position: usize| {
        let beside_curve = match remainder {
            Remainder::Curve(longer) => own(longer, position),
            Remainder::Cells => own(&story, position),
        };
        beside_curve > left || left < (LITTLE.0 * own(&story, position)).max(LITTLE.1 * story.sigma)
    };
    let kept: Vec<Chosen> =
        (0..story.chosen.len()).filter(|&k| is_kept(k)).map(|k| story.chosen[k].clone()).collect();
    if kept.len() == story.chosen.len() {
        return (story, unknown);
    }
    let story = search.fit(&kept);
    let remainder = search.remains(&story).or(unknown);
    (story, remainder)
}

/// A story without single data that are no farther out than the tails of this recording's noise reach.
///
/// Where the other residuals have more kurtosis than a normal distribution, by three standard errors √(24/n), a datum has to
/// be twice as far out as any of them.
fn beyond_the_tails(search: &Search, story: Story) -> Story {
    let events: Vec<bool> = story.chosen.iter().map(|chosen| search.is_event(chosen)).collect();
    if !events.contains(&true) {
        return story;
    }
    let rest = search.standardised(&story);
    let n = rest.len() as f64;
    let (second, fourth) = (rest.norm_squared() / n, rest.map(|t| t.powi(4)).sum() / n);
    if fourth / second.powi(2) - 3.0 < 3.0 * (24.0 / n).sqrt() {
        return story;
    }
    let farthest = rest.amax();
    let is_kept = |position: &usize| {
        !events[*position] || {
            let without = search.without(&story, *position);
            search.standardised(&without).amax() * without.sigma > 2.0 * farthest * story.sigma
        }
    };
    let kept: Vec<Chosen> =
        (0..story.chosen.len()).filter(is_kept).map(|k| story.chosen[k].clone()).collect();
    if kept.len() == story.chosen.len() { story } else { search.fit(&kept) }
}

impl Search<'_> {
    /// Root mean square of what a story leaves.
    pub fn left_rms(&self, story: &Story) -> f64 {
        let told = self.told(story, self.evidence, &self.world.change(&story.chosen));
        rms(&(&self.evidence.residual - told))
    }

    /// Can an effect say anything of the few data that it concerns?
    pub fn is_event(&self, chosen: &Chosen) -> bool {
        let columns = &self.world.neutral[chosen.candidate];
        columns.row_iter().filter(|row| row.amax() > 0.0).count() <= columns.ncols()
    }

    /// Standardised residuals, whitened, that a story leaves.
    pub fn standardised(&self, story: &Story) -> DVector<f64> {
        let told = self.told(story, self.evidence, &self.world.change(&story.chosen));
        self.whitening.whitened(&(&self.evidence.residual - told)) / story.sigma
    }

    /// Root mean square of what repeats agree on that a story leaves; 0 where they do not.
    pub fn cells_rms(&self, story: &Story) -> f64 {
        let told = self.told(story, self.evidence, &self.world.change(&story.chosen));
        let share = self.lack_of_fit(story, &told).map_or(0.0, |test| {
            // the squares of the cells beyond what their degrees of freedom have of the noise
            let (a, b) = (test.dof_fit as f64, test.dof_repeats as f64);
            (a * (test.f - 1.0) / (a * test.f + b)).max(0.0)
        });
        self.left_rms(story) * share.sqrt()
    }
}
