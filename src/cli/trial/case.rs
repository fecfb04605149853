//! A case of a trial as whoever answers sees it.

use std::path::PathBuf;

use rodcal::answer::{neighbours, rods_beside};
use rodcal::calibration::campaign::Campaign;
use rodcal::calibration::{Options, default_mode};
use rodcal::diagnosis::{calibration, rig};
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal::units::UM;
use rodcal::{Result, files, report};
use rodcal_trial::score;
use serde_json::Value;

/// The files of a case, some of them in another form than in its directory.
pub struct CaseFiles {
    /// Where they are.
    pub directory: PathBuf,
    /// Name and text of those that are not as they stand there.
    pub changed: score::Files,
}

impl CaseFiles {
    fn text(&self, name: &str) -> Result<String> {
        match self.changed.iter().find(|(changed, _)| changed == name) {
            Some((_, text)) => Ok(text.clone()),
            // a case names nothing outside of its folder
            None => {
                let bytes = files::read_inside(&self.directory, name)?;
                files::text_of_bytes(&self.directory.join(name).display().to_string(), bytes)
            }
        }
    }

    fn has(&self, name: &str) -> bool {
        self.directory.join(name).exists()
    }

    fn campaign(&self, name: &str) -> Result<Campaign> {
        let file = self.directory.join(name).display().to_string();
        Campaign::from_texts(&file, &self.text(name)?, &|name| self.text(name))
    }

    fn readings(&self, name: &str) -> Result<Readings> {
        Readings::from_text(&self.directory.join(name).display().to_string(), &self.text(name)?)
    }

    /// The diagnosis of a case as its JSON, and what it says of the readings or of the poses that
    /// are asked for, µm. What cannot be predicted is no reason to keep back what was found: the
    /// score counts it.
    pub fn diagnosed(&self) -> Result<(Value, Option<Vec<f64>>)> {
        if self.has("campaign.toml") {
            let campaign = self.campaign("campaign.toml")?;
            let options = Options::default();
            let mut others = neighbours(&campaign);
            // what asks is no rod of the laboratory's
            others.rods.retain(|(file, _)| !file.starts_with("asked"));
            let mended = calibration::mend(&campaign, default_mode(&campaign), &others, &options)?;
            let found = mended.diagnose()?;
            let asked = self.has("asked.toml").then(|| self.campaign("asked.toml")).transpose()?;
            let predicted = asked.and_then(|asked| found.predicted(&asked).ok());
            let coordinates =
                predicted.map(|tips| tips.iter().flat_map(|tip| micrometres(tip.as_slice())).collect());
            return Ok((report::diagnosis::calibration::json(&found), coordinates));
        }
        let file = self.directory.join("rod.toml");
        let rod = Rod::read(&file)?;
        let readings = self.readings("readings.csv")?;
        let found = rig::diagnose_among(&readings, Some(&rod), &rods_beside(&file))?;
        let asked = self.has("asked.csv").then(|| self.readings("asked.csv")).transpose()?;
        let predicted = asked.and_then(|asked| found.predicted(&asked).ok());
        let readings_um = predicted.map(|readings| micrometres(&readings));
        Ok((report::diagnosis::rig::json(&found, found.correction()?.as_ref()), readings_um))
    }
}

/// To a hundredth of a nanometre: more digits say nothing.
fn micrometres(lengths: &[f64]) -> Vec<f64> {
    lengths.iter().map(|length| (length / UM * 1e5).round() / 1e5).collect()
}
