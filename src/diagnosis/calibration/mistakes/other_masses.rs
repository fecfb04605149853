//! Masses and centres of links, or the mass at the tip, in another unit.
//!
//! Drives take up nearly all of it: links a thousand times as heavy on drives a thousand times as
//! stiff turn as much, but for rod and ball, whose weight is what it is. So nothing fails, and the
//! search for mistakes sees nothing. What is left is compared as with another rod, ln of the
//! probability of the poses with each unit and all that explains them best about it:
//!
//! ```text
//! ln odds = ln p(poses | other unit) − ln p(poses | file) + ln prior
//! ```
//!
//! From odds of 1000 on that unit is meant. Where a load is found instead, a unit within 1:20 is
//! its rival. Where a calibration leaves about as much with either, drives being stiff or links
//! alone being heavy, these poses say nothing of it, and nothing is said.

use super::Mended;
use super::may_be_meant::{Explained, OtherUnit, beside_masses, explained};
use super::moves::masses::{MassReading, robots, tips};
use super::search::{ALIKE, ODDS, RARE};
use crate::calibration::campaign::Campaign;
use crate::calibration::{Mode, Options, Summary, calibrate};
use crate::diagnosis::calibration::effects::mistakes::UNIT_MISTAKE;
use crate::error::Result;
use crate::inference::{Estimate, Key, Location, Rival};
use crate::robot::Robot;

/// Of more poses each comparison takes too long.
const MOST_ROWS: usize = 2000;

/// What a number may mean, and the campaign with it.
struct InUnit {
    key: String,
    estimates: Vec<Estimate>,
    cure: String,
    why: &'static str,
    campaign: Campaign,
    /// What must be less probable, for the file may be wrong by any factor.
    nearby: Vec<Robot>,
    is_of_rod: bool,
    log_prior: f64,
    /// Root mean square of what a calibration leaves, m.
    left: f64,
}

impl InUnit {
    /// Ln of how much less probable it is to be meant than the file is.
    fn price(&self) -> f64 {
        RARE + self.log_prior
    }
}

/// All units of masses and centres that may be meant.
fn units(campaign: &Campaign) -> Vec<InUnit> {
    let mut all = Vec::new();
    for MassReading { reading, nearby } in robots(campaign) {
        all.push(InUnit {
            key: reading.key.clone(),
            estimates: reading.estimates.clone(),
            cure: reading.cure.clone(),
            why: reading.why,
            campaign: Campaign { robot: reading.robot.clone(), ..campaign.clone() },
            nearby,
            is_of_rod: false,
            log_prior: reading.log_prior,
            left: 0.0,
        });
    }
    for tip in tips(campaign) {
        all.push(InUnit {
            key: "tip.mass_g".into(),
            estimates: super::moves::exact("factor", tip.factor),
            cure: tip.cure.clone(),
            why: tip.why,
            campaign: Campaign { rod: Some(tip.rod.clone()), ..campaign.clone() },
            nearby: Vec::new(),
            is_of_rod: true,
            log_prior: tip.log_prior,
            left: 0.0,
        });
    }
    all
}

/// Those with which a calibration leaves so much less that it is no accident.
fn promising(campaign: &Campaign, mode: Mode, before: Summary, options: &Options) -> Vec<InUnit> {
    let data = 3.0 * campaign.measurements.len() as f64;
    let mut promising = Vec::new();
    for mut unit in units(campaign) {
        let Ok(calibration) = calibrate(&unit.campaign, mode, options) else { continue };
        unit.left = Summary::of(&calibration.residuals()).rms;
        if calibration.is_plausible() && data * (before.rms / unit.left).ln() > ODDS {
            promising.push(unit);
        }
    }
    promising
}

impl Mended {
    /// True where the poses show a unit itself: no factor nearby is more probable, and no load is
    /// needed beside it that another factor might stand for.
    fn is_this_factor(&self, with: &Explained, unit: &InUnit) -> bool {
        let is_less = |robot: &Robot| {
            let nearby = Campaign { robot: robot.clone(), ..unit.campaign.clone() };
            let calibration = calibrate(&nearby, self.mode, &self.options).ok();
            let other = calibration.and_then(|calibration| explained(&nearby, calibration));
            other.is_none_or(|other| other.log_probability < with.log_probability)
        };
        unit.nearby.is_empty() || (!with.bears_load && unit.nearby.iter().all(is_less))
    }

    /// Has masses or centres be in another unit, where the poses are a thousand times more probable
    /// with it.
    pub(super) fn compare_masses(&mut self) -> Result<()> {
        if !self.has_data || self.campaign.measurements.len() > MOST_ROWS {
            return Ok(());
        }
        let Ok(stated) = calibrate(&self.campaign, self.mode, &self.options) else { return Ok(()) };
        let before = Summary::of(&stated.residuals());
        let units = promising(&self.campaign, self.mode, before, &self.options);
        if units.is_empty() {
            return Ok(());
        }
        let Some(known) = beside_masses(&self.campaign, stated) else { return Ok(()) };
        let mut compared = Vec::new();
        for unit in units {
            let Ok(calibration) = calibrate(&unit.campaign, self.mode, &self.options) else { continue };
            let Some(other) = explained(&unit.campaign, calibration) else { continue };
            compared.push((other, unit));
        }
        let most = |(other, unit): &(Explained, InUnit)| other.log_probability + unit.price();
        compared.sort_by(|a, b| most(b).total_cmp(&most(a)));
        let is_meant = match compared.first() {
            Some(best) => most(best) - known > ODDS && self.is_this_factor(&best.0, &best.1),
            None => false,
        };
        let mut compared: Vec<(f64, InUnit)> = compared.into_iter().map(|own| (most(&own), own.1)).collect();
        let other_units = |known: f64, compared: &[(f64, InUnit)]| -> Vec<OtherUnit> {
            let own = |(log_probability, unit): &(f64, InUnit)| OtherUnit {
                key: unit.key.clone(),
                against: known - log_probability,
            };
            compared.iter().map(own).collect()
        };
        if !is_meant {
            self.other_units = other_units(known, &compared);
            return Ok(());
        }
        let (most, unit) = compared.remove(0);
        self.add(
            &UNIT_MISTAKE,
            Key::new(&unit.key).into(),
            unit.estimates.clone(),
            (&unit.cure, unit.why),
            most - known,
        );
        let rivals = other_units(most, &compared);
        if let Some(finding) = self.found.last_mut() {
            finding.explains = (before.rms.powi(2) - unit.left.powi(2)).max(0.0).sqrt();
            finding.rivals = (rivals.iter())
                .filter(|rival| rival.against < ALIKE && rival.key != unit.key)
                .map(|rival| Rival::without_term(&UNIT_MISTAKE, Location::key(&rival.key), rival.odds()))
                .collect();
        }
        match unit.is_of_rod {
            true => (self.campaign.rod, self.is_rod_rewritten) = (unit.campaign.rod, true),
            false => self.means(&unit.campaign.robot)?,
        }
        self.is_changed = true;
        self.recorded.get_or_insert(before);
        Ok(())
    }
}
