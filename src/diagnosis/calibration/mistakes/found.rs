//! What the search found, as findings: what is said of each, its rivals, and what checks it.

mod fixtures;
mod undo;

use super::super::effects::fixture::CLAMP_POSE;
use super::super::effects::loads::TIP_MASS;
use super::super::effects::mistakes::FRAME_MISTAKE;
use super::super::effects::mounting::{BASE_SHIFT, TOOL_SHIFT};
use super::Mended;
use super::draft::DraftChange;
use super::motion::{motion_estimates, moved};
use super::names::{place, pose_name};
use super::search::{AdoptedStep, FittedDraft, MistakeSearch, SearchStep};
use super::slips::Slip;
use crate::diagnosis::Suspicion;
use crate::inference::{Description, Effect, Estimate, Finding, Location, Part, Rival, WrittenTo};
use crate::units::{DEG, MM, significant, uncapital};

impl Mended {
    /// Adds what was found: what undoes it, why that is, and ln of its odds against what is there
    /// without it.
    pub(super) fn add(
        &mut self,
        effect: &'static Effect,
        location: Location,
        estimates: Vec<Estimate>,
        (cure, why): (&str, &str),
        log_odds: f64,
    ) {
        let lower = uncapital(cure);
        self.suspicions.push(Suspicion::new(format!("likely mistake in {location}: {why}; {lower}")));
        let observed = Description { observed: cure.to_owned(), cause: why.to_owned() };
        let p_value = (-log_odds).exp();
        self.found.push(Finding { p_value, ..Finding::without_terms(effect, location, estimates, observed) });
    }

    pub(super) fn add_found(&mut self, search: &MistakeSearch, best: &FittedDraft, found: &AdoptedStep) {
        match &found.step {
            SearchStep::Move(number) => {
                let own = &search.moves[*number];
                let location = own.location.clone().into();
                self.add(own.effect, location, own.estimates.clone(), (&own.cure, &own.why), found.log_odds);
                if let Some(last) = self.suspicions.last_mut() {
                    last.spoils_fit = !own.change.is_guess();
                }
            }
            SearchStep::Elsewhere(change) if !change.adds_station() => {
                self.add_fixture(search, best, change, found.log_odds)
            }
            SearchStep::Elsewhere(change) => self.add_elsewhere(search, best, found, change),
            SearchStep::Part(number, DraftChange::Within(rows, change)) => {
                let mut own = search.of_rows[*number].clone();
                if let DraftChange::Zero { joint, by } = **change {
                    let error = search.error_of_zero(best, *rows, joint);
                    own.describe_zero(&self.campaign.robot, joint, by, error);
                }
                let there = place(&self.campaign.measurements, *rows);
                let cure = format!("{} {there}", own.cure);
                let location = own.location.rows(there).into();
                self.add(own.effect, location, own.estimates, (&cure, &own.why), found.log_odds);
            }
            SearchStep::Part(..) | SearchStep::Slip(_) => return,
        }
        let Some(finding) = self.found.last_mut() else { return };
        finding.explains = found.explains;
        let mut rivals: Vec<Rival> = Vec::new();
        for (effect, location, odds) in &found.rivals {
            let (location, odds) = (Location::Key(location.clone()), *odds);
            let is_it = |e: &Effect, at: &Location| e == *effect && *at == location;
            if !is_it(finding.effect, &finding.location)
                && !rivals.iter().any(|r| is_it(r.effect, &r.location))
            {
                rivals.push(Rival::without_term(effect, location, odds));
            }
        }
        // the base turned about joint 1 says the same, and the rod about the last joint
        if matches!(&found.step, SearchStep::Move(number) if search.moves[*number].change.is_zero_of_first())
        {
            rivals.push(Rival::without_term(&FRAME_MISTAKE, Location::key("base.rpy_deg"), 1.0));
        }
        if let SearchStep::Part(_, DraftChange::Within(_, change)) = &found.step {
            let last = self.campaign.robot.joints.len().saturating_sub(1);
            match change.joint_of_zero() {
                Some(0) => {
                    rivals.push(Rival::without_term(&BASE_SHIFT.effect, Location::Part(Part::Base), 1.0));
                }
                Some(joint) if joint == last => {
                    rivals.push(Rival::without_term(&TOOL_SHIFT.effect, Location::Part(Part::Tip), 1.0));
                }
                _ => {}
            }
        }
        if let Some(clamp) = found.may_be_clamp {
            let name = self.campaign.measurements.groups[clamp].name.to_string();
            rivals.push(Rival::without_term(&CLAMP_POSE.effect, Location::Named(name), 1.0));
        }
        if let Some(odds) = found.may_be_tip {
            rivals.push(Rival::without_term(&TIP_MASS.effect, Location::Part(Part::Tip), odds));
        }
        finding.rivals = rivals;
        finding.next = finding.direct_check(&finding.rivals.iter().collect::<Vec<_>>());
        // a force and gravity are no joints that could be moved
        if matches!(&found.step, SearchStep::Move(number) if search.moves[*number].is_load()) {
            finding.next = None;
        }
    }

    /// What happened to a single row, or to a few.
    pub(super) fn add_slip(&mut self, slip: Slip) {
        let Slip { effect, location, estimates, cure, why, log_odds, explains, rivals, .. } = slip;
        self.add(effect, location.into(), estimates, (&cure, &why), log_odds);
        let Some(finding) = self.found.last_mut() else { return };
        finding.explains = explains;
        finding.written_to = WrittenTo::Recording;
        let rival = |(effect, place)| Rival::without_term(effect, Location::Key(place), 1.0);
        finding.rivals = rivals.into_iter().map(rival).collect();
    }

    /// A frame that moved, with how far.
    fn add_elsewhere(
        &mut self,
        search: &MistakeSearch,
        best: &FittedDraft,
        found: &AdoptedStep,
        change: &DraftChange,
    ) {
        // its number among the stations: those of the file, then one for each such step
        let earlier = best.steps.iter().take_while(|step| **step != found.step);
        let has_own =
            |step: &&SearchStep| matches!(step, SearchStep::Elsewhere(change) if change.adds_station());
        let number = search.draft.stations + earlier.filter(has_own).count();
        let bases = &best.fit.bases;
        let recording = &self.campaign.measurements;
        let old = match change {
            DraftChange::Moved(first) => {
                let before = search.changed(&best.steps);
                let at = before.rows.iter().position(|&row| row >= *first).unwrap_or(0);
                before.station[at.saturating_sub(1)]
            }
            _ => 0,
        };
        let (Some(from), Some(to)) = (bases.get(old), bases.get(number)) else { return };
        let (way, angle) = moved(from, to);
        let distance = format!("{} mm and {}°", significant(way / MM, 4), significant(angle / DEG, 3));
        match change {
            DraftChange::Moved(first) => {
                let row = first.saturating_sub(1);
                let after = pose_name(recording, row);
                let cure = format!(
                    "Tracker or base moved by {distance} after {after}: give the later rows another name in a column station"
                );
                let location = Location::Shift { what: None, row, after };
                let estimates = motion_estimates(from, to);
                let why = "it stood in two places";
                self.add(&BASE_SHIFT.effect, location, estimates, (&cure, why), found.log_odds);
            }
            DraftChange::Apart(clamp) => {
                let name = recording.groups[*clamp].name.to_string();
                let device = recording.groups[*clamp].device;
                let there = from.then(&to.inverse()).then(&device);
                let origin = there.origin / MM;
                let [roll, pitch, yaw] = there.roll_pitch_yaw().map(|angle| significant(angle / DEG, 5));
                let cure = format!(
                    "Give {name} xyz_mm = [{:.2}, {:.2}, {:.2}] and rpy_deg = [{roll}, {pitch}, {yaw}]",
                    origin.x, origin.y, origin.z
                );
                let (way, _) = moved(&device, &there);
                let why = format!("it stands {} mm from where the campaign says", significant(way / MM, 3));
                let estimates = motion_estimates(&device, &there);
                self.add(&FRAME_MISTAKE, Location::key(name), estimates, (&cure, &why), found.log_odds);
            }
            _ => {}
        }
    }
}
