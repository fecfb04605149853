//! Another rod of the same folder, as long as the stated one and of another stiffness or weight.
//!
//! A rod of steel for one of carbon bends by a few hundredths of a millimetre otherwise, which the
//! drives of a calibration take up, or noise that is common to poses in a row: the search for
//! mistakes sees nothing there. So the whole explanation is compared, ln of the probability of the
//! poses with each rod and all that explains them best about it:
//!
//! ```text
//! ln odds = ln p(poses | other rod) − ln p(poses | stated rod)
//! ```
//!
//! From odds of 1000 on the other file is meant. Within that, and down to 1:20, these poses cannot
//! distinguish the two, and that is said.

use super::Mended;
use super::may_be_meant::{ComparedRods, in_other_units, log_probability};
use super::search::{ALIKE, ODDS};
use crate::calibration::campaign::Campaign;
use crate::calibration::{Mode, Options, Summary, calibrate};
use crate::diagnosis::calibration::effects::mistakes::ROD_MISTAKE;
use crate::inference::{Key, Location, Rival};
use crate::rod::Rod;

/// Tips that are farther apart, as a share of the rod's length, are seen as such.
const ANOTHER_TIP: f64 = 0.03;
/// So many rods are compared, of so many poses at most.
const MOST: usize = 4;
const MOST_ROWS: usize = 2000;

/// A campaign with another rod.
struct WithRod<'r> {
    rod: &'r (String, Rod),
    campaign: Campaign,
    mode: Mode,
    /// Ln of the probability of the poses.
    log_probability: f64,
    /// Root mean square of what a calibration leaves, m.
    left: f64,
}

impl<'r> WithRod<'r> {
    fn new(
        campaign: &Campaign,
        mode: Mode,
        rod: &'r (String, Rod),
        options: &Options,
    ) -> Option<WithRod<'r>> {
        let (campaign, mode) = with_rod(campaign, mode, rod);
        let calibration = calibrate(&campaign, mode, options).ok()?;
        let left = Summary::of(&calibration.residuals()).rms;
        let log_probability = log_probability(&campaign, calibration)?;
        Some(WithRod { rod, campaign, mode, log_probability, left })
    }
}

/// A campaign with another rod, and how its deflection is known then.
fn with_rod(campaign: &Campaign, mode: Mode, (file, rod): &(String, Rod)) -> (Campaign, Mode) {
    let mut with =
        Campaign { rod: Some(rod.clone()), rod_file: Some(file.clone()), readings: None, ..campaign.clone() };
    if !with.tool_is_given {
        with.tool = rod.tip();
    }
    // the readings of a rig are those of the rod that was on it
    (with, if mode == Mode::Meas { Mode::Fea } else { mode })
}

/// The rods whose tips are nearly that of the campaign's.
fn near<'r>(campaign: &Campaign, rods: &'r [(String, Rod)]) -> impl Iterator<Item = &'r (String, Rod)> {
    let tip = campaign.rod.as_ref().map(Rod::tip);
    let is_near = move |rod: &Rod| tip.is_some_and(|tip| (rod.tip() - tip).norm() < ANOTHER_TIP * tip.norm());
    rods.iter().filter(move |(_, rod)| is_near(rod)).take(MOST)
}

impl Mended {
    /// Has the campaign be one of another rod, where the poses are a thousand times more probable
    /// with it.
    pub(super) fn compare_rods(&mut self) {
        let is_named = self.found.iter().any(|finding| *finding.effect == ROD_MISTAKE);
        let is_asked = self.has_data && !is_named && !self.is_rod_rewritten;
        if !is_asked || self.campaign.measurements.len() > MOST_ROWS {
            return;
        }
        let rods: Vec<(String, Rod)> = near(&self.campaign, &self.rods).cloned().collect();
        if rods.is_empty() {
            return;
        }
        let Ok(stated) = calibrate(&self.campaign, self.mode, &self.options) else { return };
        if !stated.is_plausible() {
            return;
        }
        let before = Summary::of(&stated.residuals());
        let Some(known) = log_probability(&self.campaign, stated) else { return };
        let with = rods.iter().filter_map(|rod| WithRod::new(&self.campaign, self.mode, rod, &self.options));
        let with: Vec<WithRod> = with.collect();
        let others = with.iter().map(|with| (with.rod.0.clone(), with.log_probability)).collect();
        let mut compared = ComparedRods { known, others };
        let best = with.into_iter().max_by(|a, b| a.log_probability.total_cmp(&b.log_probability));
        // a force in another unit may bend the stated rod as much
        let is_alone = |best: &WithRod| {
            let units = in_other_units(&self.campaign, self.mode, &self.options);
            units.iter().all(|other| best.log_probability - other > ALIKE)
        };
        let best = best.filter(|best| best.log_probability - known > ODDS && is_alone(best));
        if let Some(best) = best {
            let (file, rod) = best.rod;
            let most = best.log_probability;
            let cure = format!("Write rod = \"{file}\"");
            let why = format!("the poses are those of rod {}", rod.name);
            self.add(&ROD_MISTAKE, Key::new(file).into(), Vec::new(), (&cure, &why), most - known);
            let is_alike = |other: &&(String, f64)| other.0 != *file && most - other.1 < ALIKE;
            let rival = |(file, other): &(String, f64)| {
                Rival::without_term(&ROD_MISTAKE, Location::key(file), (most - other).exp())
            };
            if let Some(finding) = self.found.last_mut() {
                finding.explains = (before.rms.powi(2) - best.left.powi(2)).max(0.0).sqrt();
                finding.rivals = compared.others.iter().filter(is_alike).map(rival).collect();
            }
            (self.campaign, self.mode, self.is_changed) = (best.campaign, best.mode, true);
            self.recorded.get_or_insert(before);
            // what is left is judged beside this rod
            compared = ComparedRods { known: most, others: Vec::new() };
        }
        self.compared = Some(compared);
    }
}
