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

/// A story without events (a reading, or the three coordinates of a pose) that are no farther out than the tails of this
/// recording's noise reach.
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

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::diagnosis::tests::{Columns, independent};
    use crate::statistics::Random;

    const COUNT: usize = 200;

    /// A slope; one datum, three of them, and three that are told two numbers.
    fn events() -> Columns {
        let mut world = Columns::new(COUNT);
        let at = |from: usize, columns: usize, rows: usize| {
            let is_one =
                move |row: usize, k: usize| row >= from && row < from + rows && (row - from) % columns == k;
            DMatrix::from_fn(COUNT, columns, move |row, k| f64::from(u8::from(is_one(row, k))))
        };
        world.add("slope", "", DMatrix::from_fn(COUNT, 1, |row, _| row as f64 / COUNT as f64), false);
        world.add("datum", "", at(100, 1, 1), false);
        world.add("point", "", at(120, 3, 3), false);
        world.add("shift", "", at(140, 2, 3), false);
        world
    }

    /// Noise, with these data besides.
    fn noise(besides: &[(usize, f64)]) -> Evidence {
        let mut random = Random::seeded(5, 0);
        let mut residual: Vec<f64> = (0..COUNT).map(|_| random.normal()).collect();
        besides.iter().for_each(|&(row, value)| residual[row] = value);
        independent(residual)
    }

    /// Which of `effects` stay, of a recording to which all of them are fitted.
    fn kept(evidence: &Evidence, effects: &[(&str, usize)]) -> Vec<String> {
        let world = events();
        let linear = Linearised::new(&world);
        let search = Search::new(&linear, evidence, &[]);
        let chosen: Vec<Chosen> =
            effects.iter().map(|(effect, count)| world.chosen(effect, &vec![0.0; *count])).collect();
        let story = beyond_the_tails(&search, search.fit(&chosen));
        story.chosen.iter().map(|chosen| world.candidates[chosen.candidate].effect.clone()).collect()
    }

    /// Data that make the tails heavy: the farthest is 7 noises out.
    const TAILS: [(usize, f64); 6] = [(10, 6.0), (30, -7.0), (50, 5.0), (70, -5.0), (90, 6.0), (160, 5.5)];

    #[test]
    fn where_tails_are_heavy_an_event_is_farther_out_than_twice_the_rest() {
        let with = |value: f64| noise(&[&TAILS[..], &[(100, value)]].concat());
        let effects = [("slope", 1), ("datum", 1)];
        // the sign does not matter, nor does any effect that is more than an event
        for near in [9.0, -13.0] {
            assert_eq!(kept(&with(near), &effects), ["slope"], "{near}");
        }
        for far in [16.0, -40.0] {
            assert_eq!(kept(&with(far), &effects), ["slope", "datum"], "{far}");
        }
        assert_eq!(kept(&with(0.0), &[("slope", 1)]), ["slope"]);
    }

    #[test]
    fn beside_normal_noise_an_event_may_be_near() {
        // the farthest of the others is 3 noises out
        assert_eq!(kept(&noise(&[(100, 4.5)]), &[("datum", 1)]), ["datum"]);
    }

    #[test]
    fn an_event_is_told_as_many_numbers_as_it_has_data() {
        let three = |row: usize, value: f64| [(row, value), (row + 1, value), (row + 2, -value)];
        let with = |row: usize, value: f64| noise(&[&TAILS[..], &three(row, value)].concat());
        assert!(kept(&with(120, 10.0), &[("point", 3)]).is_empty());
        assert_eq!(kept(&with(120, 20.0), &[("point", 3)]), ["point"]);
        // two numbers for three data say something of them
        assert_eq!(kept(&with(140, 10.0), &[("shift", 2)]), ["shift"]);
        let world = events();
        let linear = Linearised::new(&world);
        let evidence = noise(&[]);
        let search = Search::new(&linear, &evidence, &[]);
        let is_event = |effect: &str| search.is_event(&world.chosen(effect, &[]));
        assert_eq!(["slope", "datum", "point", "shift"].map(is_event), [false, true, true, false]);
    }

    /// 20 repeats of 10 conditions.
    const CONDITIONS: usize = 10;

    fn law(row: usize) -> f64 {
        2.0 * (row % CONDITIONS) as f64 / (CONDITIONS - 1) as f64 - 1.0
    }

    fn ripple(row: usize) -> f64 {
        if row.is_multiple_of(2) { 1.0 } else { -1.0 }
    }

    /// Does the law stay, beside what is left of a recording of it, of a ripple and of noise of these sizes? The ripple is seen by
    /// the repeats or is drawn by an unknown curve, which also has this function of the law.
    fn convinces(law_size: f64, ripple_size: f64, noise: f64, curve: Option<fn(f64) -> f64>) -> bool {
        let mut world = Columns::new(COUNT);
        world.add("law", "", DMatrix::from_fn(COUNT, 1, |row, _| law(row)), false);
        let other = curve.unwrap_or(UNLIKE);
        let of_curve = |row: usize, k: usize| if k == 0 { other(law(row)) } else { ripple(row) };
        world.add("curve", "", DMatrix::from_fn(COUNT, 2, of_curve), true);
        let mut random = Random::seeded(9, 0);
        let told = |row: usize| law_size * law(row) + ripple_size * ripple(row);
        let residual = (0..COUNT).map(|row| told(row) + noise * random.normal()).collect();
        let cell = (0..COUNT).map(|row| row % CONDITIONS).collect();
        let evidence = Evidence { cell, ..independent(residual) };
        let linear = Linearised::new(&world);
        let search = Search::new(&linear, &evidence, &[]);
        let story = search.fit(&[world.chosen("law", &[0.0])]);
        let remainder = match curve {
            Some(_) => Remainder::Curve(search.with(&story, 1)),
            None => Remainder::Cells,
        };
        let (story, left) = convincing(&search, story, Some(remainder));
        assert!(left.is_some(), "what is left stays unexplained");
        !story.chosen.is_empty()
    }

    const UNLIKE: fn(f64) -> f64 = |x| x * x;
    /// All but the law itself.
    const LIKE: fn(f64) -> f64 = |x| (0.8 * x).sin();

    #[test]
    fn an_effect_that_explains_less_than_is_left_has_no_name() {
        for curve in [Some(UNLIKE), None] {
            assert!(!convinces(1.0, 4.0, 0.3, curve), "{}", curve.is_some());
            assert!(convinces(4.0, 1.0, 0.3, curve), "{}", curve.is_some());
        }
        // nor has one whose place the curve can take
        assert!(!convinces(4.0, 1.0, 0.3, Some(LIKE)));
    }

    #[test]
    fn it_has_where_what_is_left_is_little_beside_it_or_beside_the_noise() {
        assert!(convinces(8.0, 0.35, 0.1, Some(LIKE)));
        assert!(!convinces(8.0, 1.6, 0.1, Some(LIKE)));
        assert!(convinces(0.5, 0.4, 1.2, Some(LIKE)));
        assert!(!convinces(0.5, 0.4, 0.3, Some(LIKE)));
    }

    #[test]
    fn without_a_remainder_nothing_is_doubted() {
        let world = events();
        let linear = Linearised::new(&world);
        let evidence = noise(&[]);
        let search = Search::new(&linear, &evidence, &[]);
        let story = search.fit(&[world.chosen("slope", &[0.0])]);
        let (story, left) = convincing(&search, story, None);
        assert!(story.chosen.len() == 1 && left.is_none());
    }
}
