//! `rodcal design rod DESIGN`, `rodcal design poses CAMPAIGN`, `rodcal design rig ROD`.

pub mod poses;
pub mod rig;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::{Args, Subcommand, ValueEnum};
use rodcal::calibration::Campaign;
use rodcal::design::{DesignSpace, Found, Search, Searched};
use rodcal::files::{self, Existing};
use rodcal::rod::Rod;
use rodcal::{Error, Result, answer};

use super::output::Outcome;
use super::progress::Progress;

#[derive(Debug, Subcommand)]
pub enum Design {
    /// The Pareto front of rods: lengths, angles, bends and tubes to choose from, limits to keep.
    Rod(DesignRod),
    /// The poses that a calibration should measure, and how accurate the robot will be.
    Poses(poses::DesignPoses),
    /// What to measure on a rig to distinguish effects, or to know r_rod well enough.
    Rig(rig::DesignRig),
}

#[derive(Debug, Args)]
#[command(after_long_help = NOTES)]
pub struct DesignRod {
    /// Design file (TOML): what may vary, what must hold, what counts.
    design: PathBuf,
    /// A rod that the designs are compared with.
    #[arg(long, value_name = "ROD")]
    base: Option<PathBuf>,
    /// Look at so many combinations only, spread evenly at random.
    #[arg(long, value_name = "N")]
    samples: Option<u64>,
    /// Keep the search in this file, and go on where it stopped if the file exists: for searches
    /// that take long. Stop it whenever you like; what it says in the end is the same.
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// Better design N of the front between the values of the ranges and of the tubes, then with
    /// tubes of the catalogue [without N: design 1].
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "1",
          value_parser = clap::value_parser!(u32).range(1..))]
    refine: Option<u32>,
    /// What --refine betters: one of the objectives, or several with their weights, as
    /// c_rod_um=2,mass_g=1; the others may not lose [default: the first objective].
    #[arg(long, value_name = "GOAL", requires = "refine")]
    refine_goal: Option<String>,
    /// Every random number comes from this seed.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// A campaign (TOML): rank the designs by the accuracy that its robot will have.
    #[arg(long, value_name = "CAMPAIGN", requires = "objective")]
    campaign: Option<PathBuf>,
    /// What they are ranked by, with --campaign.
    #[arg(long, ignore_case = true, value_enum, requires = "campaign")]
    objective: Option<Objective>,
    /// Poses in all for each rod, chosen by O1, with --campaign [default: as many as recorded, else
    /// 30 on each clamp].
    #[arg(long, value_name = "K", requires = "campaign", value_parser = clap::value_parser!(u32).range(1..=20_000))]
    count: Option<u32>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Objective {
    /// Forecast error of the calibrated robot.
    Forecast,
}

const NOTES: &str = "\
A design file holds at least this:

  [geometry]                     # a number, a list, or a range
  l1_mm = { from = 150, to = 450, step = 10 }
  l2_mm = [400, 525, 600]
  [catalogue]
  file = \"builtin\"               # or a table: name, material,
                                 # outer_diameter_mm, inner_diameter_mm
  [objectives]
  minimise = [\"c_rod_um\", \"mass_g\"]

and may hold gamma_deg, bend_radius_mm, [tip] mass_g, [[mass]], [[joint]],
[material.NAME], same_tube, and limits:

  [constraints]
  max_mass_g = 800
  max_flange_moment_nm = 6
  min_first_frequency_hz = 15
  max_tip_sag_um = 300           # largest entry of C^g times 1 g

also max_c_rod_um and min_reach_mm. Goals are c_rod_um, cf_max_um_per_n,
cg_max_um_per_g, mass_g, moment_nm, price, first_frequency_hz, reach_mm, in
minimise or in maximise. With --out the designs are written as rod files.";

impl Design {
    pub fn run(&self) -> Result<Outcome> {
        match self {
            Design::Rod(rod) => rod.run(),
            Design::Poses(poses) => poses.run(),
            Design::Rig(rig) => rig.run(),
        }
    }
}

/// A search is kept so often.
const KEPT_EVERY: Duration = Duration::from_secs(5);

impl DesignRod {
    /// Looks at all rods, from where the kept search stopped.
    fn search(&self, space: &DesignSpace, searched: Searched, progress: &Progress) -> Result<Found> {
        let kept = self.resume.as_deref();
        // a folder that is not there is most likely a slip in its name
        let folder = kept.and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            return Err(Error::Argument {
                name: "--resume",
                found: folder.display().to_string(),
                expected: "a file in a folder that exists".into(),
            });
        }
        let found = kept.filter(|path| path.exists());
        let mut is_own = found.is_some();
        let mut search = match found {
            Some(path) => {
                let text = files::read_text(path)?;
                Search::from_text(space, searched, &path.display().to_string(), &text)?
            }
            None => Search::new(space, searched)?,
        };
        progress.more(search.done());
        let mut last: Option<Instant> = None;
        while !search.is_done() {
            search.go_on(&|more| progress.more(more))?;
            let is_time = last.is_none_or(|last| last.elapsed() > KEPT_EVERY) || search.is_done();
            if let (Some(path), true) = (kept, is_time) {
                // what was read, or written before, is a search of the program's
                let existing = if is_own { Existing::Replace } else { Existing::Keep };
                files::write_new(path, search.to_text().as_bytes(), existing)?;
                is_own = true;
                last = Some(Instant::now());
            }
        }
        search.found()
    }

    fn run(&self) -> Result<Outcome> {
        let space = DesignSpace::read(&self.design)?;
        let base = self.base.as_deref().map(Rod::read).transpose()?;
        let all = space.combinations();
        let campaign = self.campaign.as_deref().map(Campaign::read_plan).transpose()?;
        let asked = answer::DesignRod::default()
            .with_base(base)
            .with_refined(self.refine.map(|number| number as usize), self.refine_goal.clone())
            .for_campaign(
                campaign.as_ref().map(|campaign| (campaign, self.count.map(|count| count as usize))),
            )
            .with_seed(self.seed);
        let searched = asked.searched(&space, self.samples)?;
        let count = self.samples.map_or(all, |samples| samples.min(all));
        let progress = Progress::new("looking at rods", usize::try_from(count).unwrap_or(usize::MAX));
        let found = self.search(&space, searched, &progress)?;
        progress.finish();
        let mut answer = answer::design_rod(space, found, &asked)?;
        let provenance = &mut answer.report.provenance;
        *provenance = vec![
            ("design file".into(), self.design.display().to_string()),
            ("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()),
        ];
        provenance.extend(campaign.map(|campaign| ("campaign".into(), campaign.file)));
        Ok(Outcome::from(answer).seeded(self.seed))
    }
}
