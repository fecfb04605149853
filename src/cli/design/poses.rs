//! `rodcal design poses CAMPAIGN --count K`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use rodcal::calibration::Campaign;
use rodcal::design::{Budget, PoseCriterion, PoseLimits, PoseStep, Source, TableHeight, Wanted, Where};
use rodcal::units::{DEG, MM, UM};
use rodcal::{Result, answer, files};

use crate::cli::calibrate::ModeName;
use crate::cli::output::Outcome;
use crate::cli::progress::Progress;

#[derive(Debug, Args)]
#[command(after_long_help = NOTES)]
pub struct DesignPoses {
    /// Campaign file (TOML): robot, rod, clamps. Recordings that it names need not exist yet.
    campaign: PathBuf,
    /// So many poses in all, spread evenly over the clamps.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=20_000))]
    count: u32,
    /// What the poses shall be good for.
    #[arg(long, ignore_case = true, value_enum, default_value_t = CriterionName::O1)]
    criterion: CriterionName,
    /// Poses to choose from: any table (CSV) with the robot's joint columns, such as a previous
    /// recording [default: generated].
    #[arg(long, value_name = "FILE")]
    candidates: Option<PathBuf>,
    /// Generate so many candidates.
    #[arg(long, value_name = "N", default_value_t = 3000, conflicts_with = "candidates", value_parser = clap::value_parser!(u32).range(1..=200_000))]
    generate: u32,
    /// Largest angle between the rod at its ball and the axis of the clamp, in degrees.
    #[arg(long, value_name = "ANGLE", default_value_t = 75.0, value_parser = angle, allow_negative_numbers = true)]
    cone_deg: f64,
    /// Arm and rod stay so far away from every clamp, in mm; the end of the rod may enter its own.
    #[arg(long, value_name = "RADIUS", default_value_t = 60.0, value_parser = size, allow_negative_numbers = true)]
    clear_mm: f64,
    /// Least change of at least one joint between two poses of a clamp, in degrees (mm of a
    /// prismatic joint: 17 times as many).
    #[arg(long, value_name = "ANGLE", default_value_t = 5.0, value_parser = angle, allow_negative_numbers = true)]
    change_deg: f64,
    /// Height of the table in {W} in mm, or `none`: the arm stays 50 mm above it [default: that of
    /// the base or of the lowest clamp].
    #[arg(long, value_name = "HEIGHT", value_parser = table, allow_hyphen_values = true)]
    table_mm: Option<TableHeight>,
    /// How the rod's deflection will be known [default: meas with rig readings, else fea with a
    /// rod, else none].
    #[arg(long, ignore_case = true, value_enum)]
    mode: Option<ModeName>,
    #[command(flatten)]
    expected: Expected,
    /// Every random number comes from this seed.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// What a forecast assumes.
#[derive(Debug, Args)]
pub struct Expected {
    /// Noise of one measured coordinate in µm [default: as the campaign states it, or as its
    /// recording shows it, else 17.6].
    #[arg(long, value_name = "SIZE", value_parser = positive, allow_negative_numbers = true)]
    noise_um: Option<f64>,
    /// Repeatability of the robot in µm, root mean square of the distance [default: as the
    /// recording shows it, else 30].
    #[arg(long, value_name = "SIZE", value_parser = size, allow_negative_numbers = true)]
    repeatability_um: Option<f64>,
    /// Root mean square of the distance by which the instrument of a validation is wrong, in µm; 0
    /// forecasts the robot itself.
    #[arg(long, value_name = "SIZE", default_value_t = 0.0, value_parser = size, allow_negative_numbers = true)]
    instrument_um: f64,
    /// Poses where the robot will be used: a table (CSV) with joint columns [default: the
    /// campaign's validation, else all over the workspace].
    #[arg(long, value_name = "FILE")]
    at: Option<PathBuf>,
    /// A box in the robot's base frame where the robot will be used, in mm.
    #[arg(long, value_name = "X0,X1,Y0,Y1,Z0,Z1", value_parser = six_numbers, allow_hyphen_values = true, conflicts_with = "at")]
    volume_mm: Option<[f64; 6]>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CriterionName {
    /// Observability index O1, as the paper: the product of all singular values.
    O1,
    /// O4: the least singular value squared over the largest.
    O4,
    /// Determinant of the information with what is known before.
    D,
    /// Mean remaining variance of the parameters.
    A,
    /// Forecast error of the calibrated robot where it will be used.
    Forecast,
}

impl CriterionName {
    fn criterion(self) -> PoseCriterion {
        match self {
            CriterionName::O1 => PoseCriterion::O1,
            CriterionName::O4 => PoseCriterion::O4,
            CriterionName::D => PoseCriterion::D,
            CriterionName::A => PoseCriterion::A,
            CriterionName::Forecast => PoseCriterion::Forecast,
        }
    }
}

const NOTES: &str = "\
The paper chooses thirty poses on each of five clamps by O1: --count 150.
With --out the poses are written as poses.csv, in the columns of the
campaign's measurements without positions.";

fn number(text: &str, is_right: impl Fn(f64) -> bool, expected: &str) -> std::result::Result<f64, String> {
    text.parse().ok().filter(|value: &f64| value.is_finite() && is_right(*value)).ok_or(expected.into())
}

fn angle(text: &str) -> std::result::Result<f64, String> {
    number(text, |value| (0.0..=180.0).contains(&value), "expected degrees from 0 to 180")
}

fn size(text: &str) -> std::result::Result<f64, String> {
    number(text, |value| (0.0..=1e6).contains(&value), "expected a number from 0 to 1000000")
}

fn positive(text: &str) -> std::result::Result<f64, String> {
    number(text, |value| value > 0.0 && value <= 1e6, "expected a number above 0 and up to 1000000")
}

fn table(text: &str) -> std::result::Result<TableHeight, String> {
    match text {
        "none" => Ok(TableHeight::Nowhere),
        _ => number(text, |_| true, "expected a height in mm, or none")
            .map(|height| TableHeight::At(height * MM)),
    }
}

fn six_numbers(text: &str) -> std::result::Result<[f64; 6], String> {
    let expected = "expected six numbers X0,X1,Y0,Y1,Z0,Z1 in mm, each first one below its second";
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|part| part.trim().parse().ok().filter(|x: &f64| x.is_finite())).collect();
    let six: Option<[f64; 6]> = numbers.and_then(|numbers| numbers.try_into().ok());
    six.filter(|six| six.chunks(2).all(|pair| pair[0] < pair[1])).ok_or(expected.into())
}

impl Expected {
    /// Where the robot will be used.
    pub fn place(&self) -> Result<Where> {
        Ok(match (&self.at, self.volume_mm) {
            (Some(path), _) => Where::File(path.display().to_string(), files::read_text(path)?),
            (None, Some([x0, x1, y0, y1, z0, z1])) => {
                Where::Volume([x0, y0, z0].map(|x| x * MM), [x1, y1, z1].map(|x| x * MM))
            }
            (None, None) => Where::Validation,
        })
    }

    /// What is wrong while the robot is calibrated and used.
    pub fn budget(&self, campaign: &Campaign) -> Result<Budget> {
        let metres = |um: f64| um * UM;
        let [noise, repeatability] = [self.noise_um, self.repeatability_um].map(|um| um.map(metres));
        Budget::of(campaign, noise, repeatability, metres(self.instrument_um))
    }

    /// True where something is stated.
    pub fn is_stated(&self) -> bool {
        let Expected { noise_um, repeatability_um, instrument_um, at, volume_mm } = self;
        let stated = [noise_um.is_some(), repeatability_um.is_some(), at.is_some(), volume_mm.is_some()];
        stated.contains(&true) || *instrument_um != 0.0
    }
}

impl DesignPoses {
    pub fn run(&self) -> Result<Outcome> {
        let campaign = Campaign::read_plan(&self.campaign)?;
        let source = match &self.candidates {
            Some(path) => Source::File(path.display().to_string(), files::read_text(path)?),
            None => Source::Generated(self.generate as usize),
        };
        let wanted = Wanted::new(self.count as usize, self.criterion.criterion(), source)
            .with_limits(
                PoseLimits::default()
                    .with_cone(self.cone_deg * DEG)
                    .with_clearance(self.clear_mm * MM)
                    .with_change(self.change_deg * DEG)
                    .with_table(self.table_mm.unwrap_or(TableHeight::Lowest)),
            )
            .with_mode(self.mode.map(ModeName::mode))
            .used_at(self.expected.place()?)
            .with_seed(self.seed);
        let budget = self.expected.budget(&campaign)?;
        let progress = Progress::new("looking for poses", self.generate as usize);
        let choosing = Progress::open("choosing poses");
        let tell = |step| match step {
            PoseStep::Candidate => progress.one_more(),
            PoseStep::Choice => {
                progress.finish();
                choosing.one_more();
            }
        };
        let answer = answer::design_poses(&campaign, wanted, budget, &tell)?;
        progress.finish();
        choosing.finish();
        Ok(Outcome::from(answer).seeded(self.seed))
    }
}
