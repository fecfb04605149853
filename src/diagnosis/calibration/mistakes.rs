//! Mistakes before physics: signs, orders, units, zeros, rows, frames, files, and frames that
//! moved.
//!
//! They are discrete, few and of enormous evidence, so they are undone before the robot is
//! calibrated and its residuals are asked for physics. Three steps:
//!
//! 1. every mistake that the files could hold, as a list of what undoes it (`moves.rs`);
//! 2. each is tried on a draft of the campaign (`draft.rs`) with a quick robust fit (`quick.rs`);
//!    what turns poses that fit nothing into poses that fit is kept, one after another
//!    (`search.rs`). That tracker or base stood elsewhere from some row on competes with the
//!    mistakes;
//! 3. columns without information (`columns.rs`) cannot be undone: with them there is no physics to
//!    see.
//!
//! A mistake that these poses cannot tell from another one names it as a rival; one that they hide
//! altogether (the zero of the first joint without a stated base) is not named.

mod another_rod;
mod columns;
mod distance;
mod draft;
mod found;
mod frozen;
mod held;
mod may_be_meant;
mod motion;
mod moves;
mod names;
mod other_masses;
mod quick;
mod search;
mod slips;
#[cfg(test)]
mod tests;
mod typed;

use self::columns::Silent;
use self::draft::{Draft, DraftChange};
use self::held::{held, mostly_held, without_held};
use self::may_be_meant::{ComparedRods, OtherUnit, add_rivals};
use self::motion::{beside_found, has_moved, measure_moves};
use self::moves::Other;
use self::quick::{LoadedRobot, zeros};
use self::search::drifts::clocks;
use self::search::{AdoptedStep, FittedDraft, MistakeSearch, SearchStep};
use super::diagnose::{CalibrationDiagnosis, diagnose_calibrated};
use super::write_back::apply::{Applied, apply};
use crate::calibration::campaign::{Campaign, FileNames};
use crate::calibration::{Compensation, Mode, Options, Summary, calibrate};
use crate::diagnosis::Suspicion;
use crate::error::Result;
use crate::inference::Finding;
use crate::robot::Robot;
use crate::rod::Rod;

/// What a base or a tip that is not where it was said to be costs where it spoils the calibration,
/// times what a rough guess costs.
const NO_GUESS: f64 = 10.0;

/// A calibration that fails with what was undone as well must leave less, by this factor.
const CONFIRMED: f64 = 0.5;

/// Files of the same folders that may have been meant.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Neighbours {
    /// Rods, by their files.
    pub rods: Vec<(String, Rod)>,
    /// Robots, by their files, with the text of those.
    pub robots: Vec<(String, Robot, String)>,
}

/// A campaign without the mistakes that were found in it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Mended {
    /// The campaign that was meant.
    pub campaign: Campaign,
    /// How its rod's deflection is known.
    pub mode: Mode,
    /// What was wrong, the strongest first, complete in itself.
    pub found: Vec<Finding>,
    /// For each of them one line for those who did not ask for a diagnosis.
    pub suspicions: Vec<Suspicion>,
    /// True where `campaign` is not what was recorded.
    pub is_changed: bool,
    /// False where columns hold no information, so that physics cannot be seen.
    pub has_data: bool,
    /// True where the rod is not the one of its file.
    is_rod_rewritten: bool,
    /// Rods that may have been meant, by their files.
    rods: Vec<(String, Rod)>,
    /// How probable the poses are with those that are as long; `None` where nobody asked.
    compared: Option<ComparedRods>,
    /// Masses and centres in another unit that explain the poses about as well.
    other_units: Vec<OtherUnit>,
    /// How it is calibrated.
    options: Options,
    /// Errors of a calibration on what was recorded; `None` where nothing was found.
    recorded: Option<Summary>,
}

/// Looks for mistakes in a campaign and undoes them: the first step of every diagnosis, of which
/// [`Mended::diagnose`] is the second.
///
/// ```
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let clean = mend(&campaign, Mode::Fea, &Neighbours::default(), &Options::default())?;
/// assert!(clean.found.is_empty());
/// // a joint that counts the other way round
/// let mut wrong = campaign.clone();
/// wrong.measurements.joint_values.iter_mut().skip(3).step_by(6).for_each(|q| *q = -*q);
/// let mended = mend(&wrong, Mode::Fea, &Neighbours::default(), &Options::default())?;
/// assert_eq!(mended.found[0].effect.name, "sign_mistake");
/// assert_eq!(mended.found[0].location.to_string(), "q4_deg");
/// assert_eq!(mended.campaign.measurements.joint_values, campaign.measurements.joint_values);
/// // with it undone the robot is calibrated, and nothing else is wrong
/// let found = mended.diagnose()?;
/// assert_eq!(found.diagnosis.findings.len(), 1);
/// assert!((found.diagnosis.noise - 18e-6).abs() < 4e-6, "{}", found.diagnosis.noise);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// What [`Compensation::new`] refuses; what a calibration refuses.
pub fn mend(campaign: &Campaign, mode: Mode, others: &Neighbours, options: &Options) -> Result<Mended> {
    let mut mended = search(campaign, mode, others, options)?;
    if !mended.found.is_empty() {
        let recorded = calibrate(campaign, mode, options).ok();
        mended.recorded = recorded.map(|calibration| Summary::of(&calibration.residuals()));
    }
    let mut mended = mended.confirmed(campaign, mode);
    mended.compare_rods();
    mended.compare_masses()?;
    Ok(mended)
}

/// Each mistake that `campaign` seems to hold, for those who do not ask for a diagnosis: `likely
/// mistake in q4_deg: its sign is wrong; multiply q4_deg by −1`.
///
/// ```
/// use rodcal::diagnosis::calibration::suspected;
/// use rodcal::prelude::*;
///
/// let mut campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let none = Neighbours::default();
/// assert!(suspected(&campaign, Mode::Fea, &none)?.is_empty());
/// // a joint that counts the other way round
/// campaign.measurements.joint_values.iter_mut().skip(3).step_by(6).for_each(|q| *q = -*q);
/// let found = suspected(&campaign, Mode::Fea, &none)?;
/// assert!(found[0].spoils_fit && found[0].description.contains("q4_deg"), "{found:?}");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`mend`].
pub fn suspected(campaign: &Campaign, mode: Mode, others: &Neighbours) -> Result<Vec<Suspicion>> {
    let options = Options::default();
    let mut mended = search(campaign, mode, others, &options)?;
    if mended.is_changed {
        let recorded = calibrate(campaign, mode, &options).ok();
        mended.recorded = recorded.map(|calibration| Summary::of(&calibration.residuals()));
    }
    Ok(mended.confirmed(campaign, mode).suspicions)
}

impl Mended {
    /// A campaign as it was recorded.
    fn unchanged(campaign: &Campaign, mode: Mode, options: &Options) -> Mended {
        Mended {
            campaign: campaign.clone(),
            mode,
            found: Vec::new(),
            suspicions: Vec::new(),
            is_changed: false,
            has_data: true,
            is_rod_rewritten: false,
            rods: Vec::new(),
            compared: None,
            other_units: Vec::new(),
            options: *options,
            recorded: None,
        }
    }

    /// The same, or the campaign as recorded where a calibration shows that what was undone is not
    /// what was wrong: it still fails, and leaves about as much.
    fn confirmed(self, campaign: &Campaign, mode: Mode) -> Mended {
        let (true, Some(recorded)) = (self.is_changed, self.recorded) else { return self };
        let Ok(meant) = calibrate(&self.campaign, self.mode, &self.options) else { return self };
        let left = Summary::of(&meant.residuals());
        let is_better = left.rms < CONFIRMED * recorded.rms && left.mean < recorded.mean;
        let is_confirmed = meant.is_plausible() || is_better;
        match is_confirmed {
            true => self,
            false => Mended { rods: self.rods, ..Mended::unchanged(campaign, mode, &self.options) },
        }
    }

    /// Calibrates the campaign that was meant and diagnoses what is left, as
    /// `rodcal diagnose calibration` does; the mistakes stand before all else.
    ///
    /// # Errors
    /// As [`calibrate`] and [`diagnose_calibrated`].
    pub fn diagnose(&self) -> Result<CalibrationDiagnosis<'_>> {
        let calibration = calibrate(&self.campaign, self.mode, &self.options)?;
        let mut found = diagnose_calibrated(&self.campaign, calibration)?;
        add_rivals(&self.campaign, self.compared.as_ref(), &self.other_units, &self.options, &mut found);
        found.limits.extend(self.compared.iter().flat_map(|rods| rods.limits(&found.diagnosis)));
        let has_failed = found.is_implausible();
        let diagnosis = &mut found.diagnosis;
        if has_failed || !self.has_data {
            // whatever is fitted to what is no robot's error means nothing
            diagnosis.findings.clear();
        }
        if !self.has_data {
            diagnosis.discrepancy = None;
        }
        // of poses that a mistake has spoilt nobody knows what it has left
        if has_failed || !self.has_data || !self.found.is_empty() {
            found.law = None;
        }
        let mut mistakes = self.found.clone();
        if has_moved(&mistakes) {
            // laws that are not named are taken for none
            let nothing = diagnosis.findings.is_empty();
            let beside =
                if nothing { Vec::new() } else { beside_found(&found.model, &diagnosis.hypothesis)? };
            let calibrations: Vec<_> = match beside.is_empty() {
                true => vec![&found.model.calibration],
                false => beside.iter().collect(),
            };
            measure_moves(&self.campaign.measurements, &calibrations, &mut mistakes);
        }
        diagnosis.findings.splice(0..0, mistakes);
        found.model.recorded = self.recorded;
        Ok(found)
    }

    /// Robot and campaign as corrected: the robot with what `found` says, and the campaign
    /// without its mistakes. `names` are the files that the campaign shall name; `None` where
    /// nothing could be written.
    ///
    /// # Errors
    /// As [`apply`](fn@apply).
    pub fn apply(&self, found: &CalibrationDiagnosis, names: &FileNames) -> Result<Option<Applied>> {
        let mut applied = self.corrected(found, names)?;
        if let (true, Some(applied)) = (self.is_rod_rewritten, &mut applied)
            && let (Some(name), Some(rod)) = (&names.rod, &self.campaign.rod)
            && applied.files.iter().all(|(file, _)| file != name)
        {
            applied.files.push((name.clone(), rod.to_toml(&["CORRECTED: as it was meant.".into()])));
        }
        Ok(applied)
    }

    fn corrected(&self, found: &CalibrationDiagnosis, names: &FileNames) -> Result<Option<Applied>> {
        let undone: Vec<String> =
            self.found.iter().map(|finding| finding.description.observed.clone()).collect();
        if let Some(applied) = apply(found, names, &undone)? {
            return Ok(Some(Applied { undone, ..applied }));
        }
        if !self.is_changed {
            return Ok(None);
        }
        let mut applied = Applied {
            files: Vec::new(),
            undone,
            entered: Vec::new(),
            removed: Vec::new(),
            left_out: Vec::new(),
            mean: Summary::of(&found.model.calibration.residuals()).mean,
        };
        let mut above =
            vec![format!("CORRECTED, not as recorded: {} without mistakes. Done:", self.campaign.file)];
        above.extend(applied.undone.iter().cloned());
        let Campaign { robot, measurements, validation, .. } = &self.campaign;
        applied.files.push(("campaign.toml".into(), self.campaign.to_toml(names, &above)));
        applied.files.push((names.measurements.clone(), measurements.to_csv(robot, &above)));
        if let (Some(name), Some(validation)) = (&names.validation, validation) {
            let text = validation.to_csv(robot, &above[..1]);
            applied.files.push((name.clone(), text));
        }
        Ok(Some(applied))
    }
}

fn search(campaign: &Campaign, mode: Mode, others: &Neighbours, options: &Options) -> Result<Mended> {
    let mut mended = Mended { rods: others.rods.clone(), ..Mended::unchanged(campaign, mode, options) };
    let draft = Draft::of(campaign);
    let compensation = Compensation::new(campaign, mode)?;
    let as_filed = LoadedRobot::new(&campaign.robot, compensation.clone(), campaign.tool, &draft);
    let mut readings = moves::robots::readings(campaign);
    readings.extend(moves::links::links(campaign, &draft, &as_filed));
    let mut bodies = vec![as_filed];
    let mut meant = Vec::new();
    for (file, rod) in &others.rods {
        let with = Campaign { rod: Some(rod.clone()), readings: None, ..campaign.clone() };
        let mode = if mode == Mode::Meas { Mode::Fea } else { mode };
        let Ok(compensation) = Compensation::new(&with, mode) else { continue };
        let tip = (!campaign.tool_is_given).then(|| rod.tip());
        let body = bodies.len();
        meant.push(Other { file: file.clone(), name: rod.name.clone(), is_rod: true, tip, body });
        bodies.push(LoadedRobot::new(&campaign.robot, compensation, tip.unwrap_or(campaign.tool), &draft));
    }
    let is_alike = |robot: &&(String, Robot, String)| robot.1.joints.len() == campaign.robot.joints.len();
    for (file, robot, _) in others.robots.iter().filter(is_alike) {
        let (name, body) = (robot.name.clone(), bodies.len());
        meant.push(Other { file: file.clone(), name, is_rod: false, tip: None, body });
        bodies.push(LoadedRobot::new(robot, compensation.clone(), campaign.tool, &draft));
    }
    let mut forces = Vec::new();
    for factor in moves::bodies::forces(campaign) {
        forces.push((bodies.len(), factor));
        bodies.push(bodies[0].with_contact_force_times(factor));
    }
    let mut robots = Vec::new();
    for reading in &readings {
        robots.push((bodies.len(), reading));
        bodies.push(LoadedRobot::new(&reading.robot, compensation.clone(), campaign.tool, &draft));
    }
    let mut exchanged = None;
    if let Some(rod) = moves::rods::exchanged(campaign) {
        let with = Campaign { rod: Some(rod.clone()), ..campaign.clone() };
        if let Ok(compensation) = Compensation::new(&with, mode) {
            let tip = if campaign.tool_is_given { campaign.tool } else { rod.tip() };
            exchanged = Some((bodies.len(), rod));
            bodies.push(LoadedRobot::new(&campaign.robot, compensation, tip, &draft));
        }
    }
    let exchanged = exchanged.as_ref().map(|(body, rod)| (*body, rod));
    let mut silent = columns::silent(campaign, &draft);
    let held = held(&draft);
    silent.extend(mostly_held(&draft, &held));
    let is_sure = silent.iter().any(|silent| !silent.only_if_failed);
    let zeros = zeros(&draft, &bodies[0]);
    let moves = moves::all(campaign, &draft, &meant, &forces, &robots, exchanged, &zeros);
    let of_rows = moves::of_rows::of_rows(campaign, &draft);
    let clocks = clocks(&campaign.measurements);
    let tip_mass = campaign.rod.as_ref().map_or(0.0, |rod| rod.tip_mass);
    let whole = draft.clone();
    let draft = if is_sure { draft } else { without_held(draft, &held) };
    let mut search = MistakeSearch { draft, bodies, moves, of_rows, clocks, tip_mass, guess_weight: 1.0 };
    let mut result = if is_sure { None } else { search.found() };
    let is_rough = |(_, best, _): &(FittedDraft, FittedDraft, Vec<AdoptedStep>)| {
        best.steps.is_empty() && !search.has_failed(best) && search.is_rough_guess(best)
    };
    if result.as_ref().is_some_and(is_rough)
        && !calibrate(campaign, mode, &Options::default()).is_ok_and(|fit| fit.is_plausible())
    {
        search.guess_weight = NO_GUESS;
        result = search.found();
    }
    let frozen = match is_sure {
        true => Vec::new(),
        false => search.frozen(&search.draft, result.as_ref().map(|(_, best, _)| best)),
    };
    if !frozen.is_empty() {
        let rows = frozen.iter().flat_map(|frozen| frozen.rows.iter().copied()).collect();
        search.draft.apply(&DraftChange::Without(rows));
        result = search.found();
    }
    let has_failed = result.as_ref().is_none_or(|(_, best, _)| search.has_failed(best));
    for silent in silent.into_iter().filter(|silent| has_failed || !silent.only_if_failed) {
        mended.has_data = false;
        let Silent { effect, location, estimates, cure, why, log_odds, .. } = silent;
        mended.add(effect, location.into(), estimates, (&cure, &why), log_odds);
    }
    let Some((_, mut best, found)) = result.filter(|_| mended.has_data) else { return Ok(mended) };
    for found in &found {
        mended.add_found(&search, &best, found);
    }
    let mut slips = search.held_slips(&campaign.measurements, (&best, &whole), &held);
    slips.extend(search.slips(&best, &campaign.measurements));
    slips.extend(frozen.iter().map(|frozen| frozen.slip(&search, &campaign.measurements)));
    for slip in slips {
        best.steps.push(SearchStep::Slip(slip.change.clone()));
        mended.add_slip(slip);
    }
    if !best.steps.is_empty() {
        mended.is_changed = true;
        let body = search.changed(&best.steps).body;
        if let Some((_, reading)) = robots.iter().find(|(own, _)| *own == body) {
            mended.means(&reading.robot)?;
        }
        if let Some((_, rod)) = exchanged.filter(|(own, _)| *own == body) {
            mended.campaign.rod = Some(rod.clone());
            mended.is_rod_rewritten = true;
        }
        mended.undo(campaign, others, &search, &best, &meant)?;
        if let Some((_, factor)) = forces.iter().find(|(own, _)| *own == body) {
            mended.campaign.contact_force = campaign.contact_force.map(|force| force * *factor);
        }
    }
    mended.add_distance(&search, &best);
    let mut order: Vec<usize> = (0..mended.found.len()).collect();
    order.sort_by(|&a, &b| mended.found[b].explains.total_cmp(&mended.found[a].explains));
    mended.found = order.iter().map(|&k| mended.found[k].clone()).collect();
    mended.suspicions = order.iter().map(|&k| mended.suspicions[k].clone()).collect();
    Ok(mended)
}
