//! `rodcal diagnose rig ROD READINGS`, `rodcal diagnose calibration CAMPAIGN`.

mod calibration;
mod listed;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use rodcal::Result;
use rodcal::answer::{self, rods_beside};
use rodcal::diagnosis::rig::OwnEffect;
use rodcal::diagnosis::rig::effects::registry;
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;

use self::listed::listed;
use super::output::{self, Outcome};

#[derive(Debug, Subcommand)]
pub enum Diagnose {
    /// Which physics the model of a rod left out: located, named, measured, confirmed on held-out
    /// readings.
    Rig(Rig),
    /// Which physics of robot, rod, fixture or procedure a calibration left out: which joint,
    /// clamp, time or pose.
    Calibration(calibration::Calibration),
}

#[derive(Debug, Args)]
#[command(after_long_help = notes())]
pub struct Rig {
    /// Rod file (TOML), or the word `linear`: straight lines through the origin, of any slope.
    rod: PathBuf,
    /// Readings (CSV): how far the tip moved under each load. `rodcal rig fit --help` shows one.
    readings: PathBuf,
    /// Also write what was found into a rod file and into readings that `compliance`, `rig fit`,
    /// `calibrate` and `compare` read, `*-diagnosed.toml` and `*-diagnosed.csv` [without --out: in
    /// reports/diagnosed].
    #[arg(long)]
    apply: bool,
    /// Effects of your own (TOML), which compete with those of the library: docs/laws.md shows
    /// three.
    #[arg(long, value_name = "FILE")]
    effects: Option<PathBuf>,
}

fn notes() -> String {
    let mistakes = listed(registry::MISTAKES.into_iter());
    let effects = listed(registry::ALL.iter().map(|known| &known.effect));
    format!(
        "\
Mistakes come first, and what follows is said of the corrected readings and rod:

{mistakes}
The model is the rod as its file gives it; nothing is fitted. Readings that
differ from it are explained by as few of these effects as possible:

{effects}
Effects that these readings cannot distinguish are listed, with the measurement
that would distinguish them. What no effect explains is described, not named.
Optional columns make more effects testable: trial, phase (load, unload),
time_s, temperature_c, session, loaded_at_s.

Exit status: 0 the readings agree with the model; 1 they do not, and the first
line says why; 2 could not run."
    )
}

impl Diagnose {
    pub fn run(&self) -> Result<Outcome> {
        match self {
            Diagnose::Rig(rig) => rig.run(),
            Diagnose::Calibration(calibration) => calibration.run(),
        }
    }
}

impl Rig {
    fn run(&self) -> Result<Outcome> {
        let rod = if self.rod == Path::new("linear") { None } else { Some(Rod::read(&self.rod)?) };
        let readings = Readings::read(&self.readings)?;
        let others = if rod.is_some() { rods_beside(&self.rod) } else { Vec::new() };
        let named = |what: &str| self.named(what);
        let apply = self.apply.then_some(&named as &dyn Fn(&str) -> String);
        let own = self.effects.as_deref().map(OwnEffect::read).transpose()?.unwrap_or_default();
        let mut answer = answer::diagnose_rig_with(&readings, rod.as_ref(), &others, &own, apply)?;
        let model = rod.as_ref().map_or("none, straight lines".into(), |_| self.rod.display().to_string());
        answer.report.provenance = vec![
            ("rod file".into(), model),
            ("readings".into(), self.readings.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        let default_directory = (!answer.files.is_empty()).then(|| PathBuf::from(output::APPLIED));
        Ok(Outcome { default_directory, ..answer.into() })
    }

    /// What the file of the rod or of the readings is called with what was found.
    fn named(&self, what: &str) -> String {
        let stem = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        match what {
            "rod" => format!("{}-diagnosed.toml", stem(&self.rod)),
            _ => format!("{}-diagnosed.csv", stem(&self.readings)),
        }
    }
}
