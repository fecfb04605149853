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
#[non_exhaustive]
pub struct DesignRod<'c> {
    /// A rod that the designs are compared with.
    pub base: Option<Rod>,
    /// The design of the front, from 1, that is refined between the grid's values.
    pub refine: Option<usize>,
    /// What is improved then: an objective of the design file, or several with their weights, as
    /// "c_rod_um=2,mass_g=1"; without it the first one.
    pub refine_goal: Option<String>,
    /// The robot that they are ranked for, and how many poses are chosen for each rod.
    pub campaign: Option<(&'c Campaign, Option<usize>)>,
    /// Every random number comes from this seed.
    pub seed: u64,
}

impl<'c> DesignRod<'c> {
    /// With every random number from this seed.
    pub fn with_seed(self, seed: u64) -> Self {
        DesignRod { seed, ..self }
    }

    /// Compared with this rod, where there is one.
    pub fn with_base(self, base: Option<Rod>) -> Self {
        DesignRod { base, ..self }
    }

    /// With the design of this number of the front, from 1, refined for a goal
    /// ([`DesignRod::refine_goal`]).
    pub fn with_refined(self, number: Option<usize>, goal: Option<String>) -> Self {
        DesignRod { refine: number, refine_goal: goal, ..self }
    }

    /// Ranked for the robot of a campaign, with so many poses chosen for each rod where that is
    /// said.
    pub fn for_campaign(self, campaign: Option<(&'c Campaign, Option<usize>)>) -> Self {
        DesignRod { campaign, ..self }
    }

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
/// ```
/// use rodcal::answer::{DesignRod, design_rod};
/// use rodcal::design::{DesignSpace, search};
///
/// let space = DesignSpace::from_toml("design.toml", "
///     [geometry]
///     l1_mm = [150, 300]
///     l2_mm = [400, 525]
///     [catalogue]
///     file = \"builtin\"
///     [objectives]
///     minimise = [\"c_rod_um\"]
/// ", &|_| unreachable!())?;
/// let asked = DesignRod::default();
/// let found = search(&space, asked.searched(&space, None)?, &|_| {})?;
/// let answer = design_rod(space, found, &asked)?;
/// let json = answer.whole_json();
/// assert_eq!(json["front"].as_array().map(Vec::len), Some(1)); // of one goal there is one best rod
/// assert_eq!(json["front"][0]["rod"]["geometry"]["l1_mm"], 150.0);
/// # Ok::<(), rodcal::Error>(())
/// ```
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
/// ```
/// use rodcal::answer::design_poses;
/// use rodcal::design::{Budget, PoseCriterion, Source, Wanted};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let budget = Budget::of(&campaign, Some(17.6e-6), Some(30e-6), 0.0)?;
/// let wanted = Wanted::new(20, PoseCriterion::O1, Source::Generated(60));
/// let answer = design_poses(&campaign, wanted, budget, &|_| {})?;
/// assert_eq!(answer.json["poses"].as_array().map(Vec::len), Some(20));
/// assert_eq!(answer.json["criterion"], "o1");
/// # Ok::<(), rodcal::Error>(())
/// ```
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
/// ```
/// use rodcal::answer::design_rig;
/// use rodcal::diagnosis::rig::planned::Bench;
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let bench = Bench { largest_load: 10.0, noise: 2e-6, is_at_tip: true };
/// // r_rod within 1 %
/// let answer = design_rig(&rod, &[], Some(0.01), 20.0, &bench)?;
/// assert_eq!(answer.files[0].0, "readings.csv");
/// assert!(design_rig(&rod, &["ghost".to_owned()], None, 20.0, &bench).is_err()); // no such effect
/// # Ok::<(), rodcal::Error>(())
/// ```
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
