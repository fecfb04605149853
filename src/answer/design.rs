//! Which rods, poses and loads?

use super::{Answer, LongList, provenance};
use crate::calibration::Campaign;
use crate::design::{
    Budget, DesignSpace, Found, PoseStep, PoseStudy, Searched, Source, Study, Wanted, Where, for_robot,
};
use crate::diagnosis::rig::planned::{Bench, effect_named, effect_names, plan, plan_ratio};
use crate::error::{Error, Result};
use crate::inference::Effect;
use crate::report;
use crate::rod::Rod;

/// What is asked about the rods of a search.
#[derive(Default)]
pub struct DesignRod<'c> {
    /// A rod that the designs are compared with.
    pub base: Option<Rod>,
    /// The design of the front, from 1, that is bettered between the grid's values.
    pub refine: Option<usize>,
    /// What is bettered then: an objective of the design file, or several with their weights, as
    /// "c_rod_um=2,mass_g=1"; without it the first one.
    pub refine_goal: Option<String>,
    /// The robot that they are ranked for, and how many poses are chosen for each rod.
    pub campaign: Option<(&'c Campaign, Option<usize>)>,
    /// Every random number comes from this seed.
    pub seed: u64,
}

impl DesignRod<'_> {
    /// Which rods of `space` are looked at; `samples` of them, or all.
    ///
    /// # Errors
    /// [`DesignSpace::too_much`] for all of more rods than a search takes.
    pub fn searched(&self, space: &DesignSpace, samples: Option<u64>) -> Result<Searched> {
        match (samples, space.too_much()) {
            (Some(samples), _) => Ok(Searched::Samples(samples, self.seed)),
            (None, None) => Ok(Searched::All),
            (None, Some(much)) => Err(much),
        }
    }
}

/// The Pareto front of rods, as rod files too; with status 1 where no rod keeps all limits.
///
/// # Errors
/// As [`Study::of_found`], [`Study::with_refined`] and [`for_robot`].
pub fn design_rod(space: DesignSpace, found: Found, asked: &DesignRod<'_>) -> Result<Answer> {
    let study = Study::of_found(space, found, asked.base.clone())?;
    let study = match asked.refine {
        Some(number) => study.with_refined(number.saturating_sub(1), asked.refine_goal.as_deref())?,
        None => study,
    };
    let mut answer = Answer::new(report::design::json(&study), report::design::report(&study));
    answer.files = report::design::files(&study)?;
    answer.status = u8::from(study.found.front.is_empty());
    let is_any = !study.shown.is_empty() || study.base.is_some();
    if let Some((campaign, count)) = asked.campaign.filter(|_| is_any) {
        let budget = Budget { seed: asked.seed, ..Budget::of(campaign, None, None, 0.0)? };
        let found = for_robot(&study, campaign, &budget, &Where::Validation, count)?;
        answer.json["for_robot"] = report::design::for_robot_json(&found);
        // before what was looked at
        let place = answer.report.sections.len().saturating_sub(1);
        answer.report.sections.insert(place, report::design::for_robot_section(&found));
        answer.report.headline += &format!(" {}", report::design::for_robot_headline(&found));
        answer.report.cards.extend(report::design::for_robot_card(&found));
    }
    let count = study.found.front.len();
    answer.long = Some(LongList::new("front", count, move |place| report::design::front_json(&study, place)));
    Ok(answer)
}

/// The poses that a calibration should measure, as a table too.
///
/// # Errors
/// [`Error::Argument`] for fewer candidates than poses; as [`PoseStudy::new`].
pub fn design_poses(
    campaign: &Campaign,
    wanted: Wanted,
    budget: Budget,
    progress: &(dyn Fn(PoseStep) + Sync),
) -> Result<Answer> {
    if let Source::Generated(count) = wanted.source
        && count < wanted.count
    {
        return Err(Error::Argument {
            name: "--generate",
            found: count.to_string(),
            expected: format!("at least {} candidates to choose {} poses from", wanted.count, wanted.count),
        });
    }
    let study = PoseStudy::new(campaign, wanted, budget, progress)?;
    let mut report = report::poses::report(&study);
    report.provenance = provenance(campaign);
    Ok(Answer { files: report::poses::files(&study), ..Answer::new(report::poses::json(&study), report) })
}

/// What to measure on a rig: to distinguish the effects of these names with such odds, or to know
/// r_rod within a 95 % interval of `r_rod_width` of it.
///
/// # Errors
/// [`Error::Argument`] for an effect that nobody knows; as [`plan`] and [`plan_ratio`].
pub fn design_rig(
    rod: &Rod,
    between: &[String],
    r_rod_width: Option<f64>,
    odds: f64,
    bench: &Bench,
) -> Result<Answer> {
    let plan = match r_rod_width {
        Some(width) => plan_ratio(rod, width, bench)?,
        None => plan(rod, &effects(between)?, odds, bench)?,
    };
    let report = report::rig_plan::report(&plan, rod, bench);
    let files = vec![("readings.csv".to_owned(), report::rig_plan::template(&plan, rod).into_bytes())];
    Ok(Answer { files, ..Answer::new(report::rig_plan::json(&plan, rod, bench), report) })
}

fn effects(names: &[String]) -> Result<Vec<&'static Effect>> {
    let mut effects: Vec<&'static Effect> = Vec::new();
    for name in names {
        let Some(effect) = effect_named(name.trim()) else {
            return Err(Error::Argument {
                name: "between",
                found: name.clone(),
                expected: format!("one of {}", effect_names().join(", ")),
            });
        };
        if effects.contains(&effect) {
            return Err(Error::Argument {
                name: "between",
                found: names.join(","),
                expected: format!("{name} once: each is distinguished from every other one and from nothing"),
            });
        }
        effects.push(effect);
    }
    Ok(effects)
}
