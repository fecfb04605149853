//! `rodcal calibrate CAMPAIGN`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use rodcal::calibration::campaign::Recording;
use rodcal::calibration::{self, Calibration, Campaign, Compensation, Mode, Options, Robust};
use rodcal::diagnosis::calibration::suspected;
use rodcal::{Result, report};

use super::neighbours::neighbours;
use super::output::Outcome;

#[derive(Debug, Args)]
pub struct Calibrate {
    /// Campaign file (TOML): robot, rod, measurements, validation.
    campaign: PathBuf,
    /// How the rod's deflection is known [default: meas with rig readings, else fea with a rod,
    /// else none].
    #[arg(long, ignore_case = true, value_enum)]
    mode: Option<ModeName>,
    /// What an outlier counts.
    #[arg(long, ignore_case = true, value_enum, default_value_t = Weights::None)]
    robust: Weights,
    /// Hold numbers of the robot whose correction is smaller than its standard error at their
    /// nominal values, and calibrate again.
    #[arg(long)]
    prune: bool,
    /// Also predict every pose from a calibration without it, in so many folds of consecutive
    /// poses.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(2..=1000))]
    folds: Option<u16>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum ModeName {
    /// The rod is assumed rigid.
    None,
    /// The paper's closed form.
    Calc,
    /// The beam finite-element model.
    Fea,
    /// Measured on a rig.
    Meas,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Weights {
    /// Least squares: every pose counts the same.
    None,
    /// Outliers count less (Huber's weights on distances).
    Huber,
    /// Gross outliers do not count at all (Tukey's biweight on distances).
    Tukey,
}

impl ModeName {
    pub fn mode(self) -> Mode {
        match self {
            ModeName::None => Mode::None,
            ModeName::Calc => Mode::Calc,
            ModeName::Fea => Mode::Fea,
            ModeName::Meas => Mode::Meas,
        }
    }
}

impl Weights {
    pub fn robust(self) -> Robust {
        match self {
            Weights::None => Robust::None,
            Weights::Huber => Robust::Huber,
            Weights::Tukey => Robust::Tukey,
        }
    }
}

impl Calibrate {
    pub fn run(&self) -> Result<Outcome> {
        let campaign = Campaign::read(&self.campaign)?;
        let mode = self.mode.map_or_else(|| calibration::default_mode(&campaign), ModeName::mode);
        let options = Options { robust: self.robust.robust(), prune: self.prune };
        let calibrated = calibration::calibrate(&campaign, mode, &options)?;
        let cross_validation = match self.folds {
            Some(folds) => {
                let compensation = Compensation::new(&campaign, mode)?;
                Some(calibration::cross_validate(
                    &campaign,
                    &calibrated,
                    &compensation,
                    folds.into(),
                    &options,
                )?)
            }
            None => None,
        };
        let cross_validation = cross_validation.as_ref();
        let mut report = report::calibration::report(&campaign, &calibrated, cross_validation);
        report.provenance = provenance(&campaign);
        let other = cross_validation.filter(|held_out| self.folds != u16::try_from(held_out.folds).ok());
        if let (Some(asked), Some(held_out)) = (self.folds, other) {
            report.warnings.push(format!(
                "{} folds in place of {asked}: with sockets whole placements are held out, for poses of one \
                 placement share its unknown points",
                held_out.folds
            ));
        }
        let suspicions = suspected(&campaign, mode, &neighbours(&campaign))?;
        let is_plausible =
            calibrated.is_plausible() && suspicions.iter().all(|suspicion| !suspicion.spoils_fit);
        let lines: Vec<String> = suspicions.into_iter().map(|suspicion| suspicion.words).collect();
        let mut json = report::calibration::json(&campaign, &calibrated, cross_validation);
        json["plausible"] = is_plausible.into();
        json["suspected_mistakes"] = lines.clone().into();
        // before all else: it explains the rest
        report.warnings.splice(0..0, lines);
        let mut outcome = Outcome::new(json, report);
        outcome.status = u8::from(!is_plausible);
        outcome.files = calibrated_robot(&campaign, &calibrated)?;
        Ok(outcome)
    }
}

/// Where it all comes from.
pub fn provenance(campaign: &Campaign) -> Vec<(String, String)> {
    let mut list = vec![
        ("campaign".to_owned(), campaign.file.clone()),
        ("robot".to_owned(), campaign.robot_file.clone()),
    ];
    if let Some(rod) = &campaign.rod {
        list.push(("rod".into(), rod.name.clone()));
        list.extend(
            rod.source.iter().map(|source| ("source of the rod's numbers".to_owned(), source.clone())),
        );
    }
    list.extend(campaign.readings.iter().map(|readings| ("rig readings".to_owned(), readings.file.clone())));
    let described = |recording: &Recording| match &recording.source {
        Some(source) => format!("{} ({source})", recording.file),
        None => recording.file.clone(),
    };
    list.push(("measurements".into(), described(&campaign.measurements)));
    list.extend(campaign.validation.iter().map(|recording| ("validation".to_owned(), described(recording))));
    list.push(("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()));
    list
}

/// The calibrated robot in the format of its file.
pub fn calibrated_robot(campaign: &Campaign, calibrated: &Calibration) -> Result<Vec<(String, Vec<u8>)>> {
    let (name, text) = calibration::write_back(campaign, calibrated)?;
    let beside = calibration::write_beside(campaign, calibrated, None);
    let files = std::iter::once((name, text)).chain(beside);
    Ok(files.map(|(name, text)| (name, text.into_bytes())).collect())
}
