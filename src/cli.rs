//! Arguments, and which command runs; one file per subcommand.

mod calibrate;
mod compare;
mod compare_runs;
mod completions;
mod compliance;
mod demo;
mod design;
mod diagnose;
mod embedded;
mod man;
pub mod output;
mod predict;
mod progress;
mod provenance;
mod rig;
mod simulate;
mod stamp;
pub mod suggestions;
mod trial;
mod values;

use std::path::Path;

use clap::{CommandFactory, Parser, Subcommand};
use rodcal::Result;

use output::Outcome;

/// How much a measuring rod bends, how accurate a robot is once that is compensated, and which
/// physics a model left out.
#[derive(Debug, Parser)]
#[command(version, after_help = EXAMPLES, propagate_version = true)]
pub struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,

    #[command(flatten)]
    pub output: output::Options,
}

// Lines of at most 80 columns: a terminal that wraps them would break their indent.
const EXAMPLES: &str = "\
Examples:
  rodcal
      try everything on examples inside the program; prints the report's path
  rodcal compliance rods/5.toml
      how much a rod bends, from its drawing alone
  rodcal rig fit rods/5.toml stiffness_data/5.csv --out reports/5
      how much it really bends, from readings under known loads, with a report
  rodcal rig fit linear stiffness_data/nist-load-cell.csv
      any load-deflection recording: is it a straight line?
  rodcal diagnose rig rods/5.toml stiffness_data/5.csv --out reports/why
      readings and drawing disagree: which physics was left out?
  rodcal calibrate campaigns/tx90-5/campaign.toml --out reports/tx90
      how accurate a robot is once its rod's deflection is compensated
  rodcal compare campaigns/tx90-5/campaign.toml
      does it matter how the deflection is known?
  rodcal diagnose calibration campaigns/tx90-5/campaign.toml
      calibration residuals: noise, or which joint, clamp, time or pose?

Words:
  C^F     deflection of the tip in µm per newton of force on the ball; 3x3,
          row: axis of the deflection, column: axis of the force
  C^g     the same in µm under the rod's own weight, gravity along an axis
  c_rod   all of C^g plus all of C^F under the contact force, added up without
          signs, in µm: one number to compare rods by
  r       measured over modelled compliance (r22 along y, r33 along z), r_rod
          for the rod as a whole; 1.05 is a rod 5 % softer than its model
  Calc    the paper's closed form; FEA: the beam model; Meas: from readings
  axes    origin at the flange, pipe I along +z, pipe II towards +x

The paper is Improved MultiCal, Sensors 2023, 23(12), 5717. Units stand in the
names of keys and columns (l1_mm, load_n, dz_um).

Exit status: 0 done; 1 a diagnosis found a mismatch, a calibration's fit is not
plausible, or no design keeps all limits; 2 could not run (the error says what
and where), and nothing has been written but what a long run keeps to go on from
(answers, --resume).";

#[derive(Debug, Subcommand)]
enum Command {
    /// Try everything on examples inside the program, report in reports/demo (the default).
    Demo,
    /// How much a rod bends under its weight and the contact force, from its drawing.
    Compliance(compliance::Compliance),
    /// Which rod to build; which poses to measure, and how accurate the robot will be.
    #[command(subcommand)]
    Design(design::Design),
    /// How much a rod really bends, from readings of its tip under known loads.
    #[command(subcommand)]
    Rig(rig::Rig),
    /// How accurate a robot is once its rod's deflection is compensated: kinematic calibration.
    Calibrate(calibrate::Calibrate),
    /// Calibrate in every mode of compensation, and test which differences are significant.
    Compare(compare::Compare),
    /// Set results of one command side by side: what changed in inputs, parameters, errors,
    /// findings.
    CompareRuns(compare_runs::CompareRuns),
    /// Where recording and model disagree: which physics did the model leave out?
    #[command(subcommand)]
    Diagnose(diagnose::Diagnose),
    /// Where a calibrated robot's tip is at any joint values, with its uncertainty.
    Predict(predict::Predict),
    /// Make the files of a campaign of a robot and a rod that are known exactly.
    Simulate(simulate::Simulate),
    /// Conceal effects in recordings, have them diagnosed, and count how often that was right.
    #[command(subcommand)]
    Trial(trial::Trial),
    /// Print a completion script for your shell.
    Completions(completions::Completions),
    /// Print the man page of the program or of a command.
    Man(man::ManPage),
}

/// Runs the command that was asked for.
pub fn run(arguments: &Arguments) -> Result<Outcome> {
    let options = &arguments.output;
    if options.quiet {
        progress::be_quiet();
    }
    let is_demo = matches!(arguments.command, None | Some(Command::Demo));
    let directory = options.out.as_deref().or(is_demo.then(|| Path::new(demo::DIRECTORY)));
    output::check(options, directory)?;
    match &arguments.command {
        None | Some(Command::Demo) => demo::run(),
        Some(Command::Compliance(command)) => command.run(),
        Some(Command::Design(command)) => command.run(),
        Some(Command::Rig(command)) => command.run(),
        Some(Command::Calibrate(command)) => command.run(),
        Some(Command::Compare(command)) => command.run(),
        Some(Command::CompareRuns(command)) => command.run(),
        Some(Command::Diagnose(command)) => command.run(),
        Some(Command::Predict(command)) => command.run(),
        Some(Command::Simulate(command)) => command.run(options.existing()),
        Some(Command::Trial(command)) => command.run(),
        Some(Command::Completions(command)) => Ok(command.run(Arguments::command())),
        Some(Command::Man(command)) => command.run(Arguments::command()),
    }
}
