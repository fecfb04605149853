//! What `diagnose rig` says: JSON, words, tables and pictures of a [`RigDiagnosis`]; `diagnose calibration`: [`calibration`].

pub mod calibration;
mod correction;
mod figures;
mod headline;
mod json;
mod ranking;
mod remainder;
mod sections;
mod shared;

use super::Report;
use crate::diagnosis::Finding;
use crate::diagnosis::rig::{Datum, RigDiagnosis};
use crate::rig::readings::{Phase, Readings};
use crate::rod::Rod;
pub use headline::headline;
pub use json::json;

/// The report of `rodcal diagnose rig`.
pub fn report(found: &RigDiagnosis, readings: &Readings, rod: Option<&Rod>) -> Report {
    let name = rod.map_or("a straight line".to_owned(), |rod| format!("rod {}", rod.name));
    Report {
        title: format!("Diagnosis of the readings of {name}"),
        headline: headline(found),
        warnings: warnings(found, readings, rod),
        sections: sections::all(found, readings, rod),
        provenance: Vec::new(),
    }
}

fn warnings(found: &RigDiagnosis, readings: &Readings, rod: Option<&Rod>) -> Vec<String> {
    let of_rod = rod.map_or(&[][..], |rod| &rod.warnings).iter().map(ToString::to_string);
    let of_readings = readings.warnings.iter().map(|warning| format!("{}: {warning}", readings.file));
    of_rod.chain(of_readings).chain(found.limits.iter().map(ToString::to_string)).collect()
}

impl RigDiagnosis {
    /// Name of a finding's effect.
    fn effect(&self, finding: &Finding) -> &str {
        self.effect_of(finding.chosen.candidate)
    }

    fn effect_of(&self, candidate: usize) -> &str {
        use crate::diagnosis::World;
        &self.world.candidates()[candidate].effect
    }

    /// Other effects that stand for a finding as well, each with its likeliest place, likeliest first.
    fn other_effects<'a>(&'a self, finding: &'a Finding) -> Vec<(&'a str, &'a str)> {
        let mut others: Vec<(&str, &str)> = Vec::new();
        for rival in &finding.rivals {
            let effect = self.effect_of(rival.chosen.candidate);
            if effect != self.effect(finding) && others.iter().all(|(known, _)| *known != effect) {
                others.push((effect, &rival.place));
            }
        }
        others
    }

    /// Other places where the effect of a finding may be as well, likeliest first.
    fn other_places<'a>(&'a self, finding: &'a Finding) -> Vec<&'a str> {
        let same =
            finding.rivals.iter().filter(|r| self.effect_of(r.chosen.candidate) == self.effect(finding));
        same.map(|rival| rival.place.as_str()).filter(|place| *place != finding.place).collect()
    }

    /// How many stories of the folds hold the effect of a finding, of how many.
    fn found_in_folds(&self, finding: &Finding) -> Option<(usize, usize)> {
        let stories = &self.diagnosis.proof.as_ref()?.stories;
        let effect = self.effect(finding);
        let holds = |story: &&Vec<crate::diagnosis::Chosen>| {
            story.iter().any(|chosen| self.effect_of(chosen.candidate) == effect)
        };
        Some((stories.iter().filter(holds).count(), stories.len()))
    }
}

/// An effect's name as words.
fn spoken(effect: &str) -> String {
    effect.replace('_', " ")
}

/// What is one line of readings, for example `dy under loads along y`.
fn line_name(datum: &Datum) -> String {
    let at = |what: &str, station: Option<f64>| {
        station.map_or_else(String::new, |s| format!(", {what} at {:.1} mm", s / crate::units::MM))
    };
    format!(
        "d{} under loads along {}{}{}",
        datum.channel,
        datum.direction.axis,
        at("loaded", datum.load_station),
        at("read", datum.read_station)
    )
}

/// A line, and its way down by itself.
fn branch_name(datum: &Datum) -> String {
    let down = if datum.phase == Some(Phase::Unload) { ", unloading" } else { "" };
    line_name(datum) + down
}
