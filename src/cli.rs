//! Arguments, and which command runs; one file per subcommand.

mod completions;
mod compliance;
mod demo;
mod embedded;
pub mod output;
mod rig;

use std::path::PathBuf;

use clap::{Parser, Subcommand, ValueEnum};
use rodcal::Result;
use rodcal::beam::Physics;

use output::Outcome;

/// How much a measuring rod bends, how accurate a robot is once that is compensated, and which physics a model left out.
#[derive(Debug, Parser)]
#[command(version, after_help = EXAMPLES, propagate_version = true)]
pub struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,

    /// Print the result as JSON on stdout and nothing else.
    #[arg(long, global = true)]
    pub json: bool,

    /// Write the report (index.html), its pictures (SVG) and tables (CSV, Markdown) into this directory.
    #[arg(long, global = true, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// With --out: write the pictures as PNG too.
    #[arg(long, global = true)]
    pub png: bool,
}

const EXAMPLES: &str = "\
Examples:
  rodcal                                             run everything on embedded data; says where the report is
  rodcal compliance rods/5.toml                      C^F and C^g of a rod from its file
  rodcal compliance rods/5.toml --mode calc --json   the paper's closed form, as JSON
  rodcal rig fit rods/5.toml stiffness_data/5.csv --out reports/5
                                                     from rig readings to measured compliance, with a report
  rodcal rig fit linear stiffness_data/nist-load-cell.csv
                                                     any load–deflection recording against a straight line

Units stand in the names of keys and columns (l1_mm, load_n, dz_um). C^F is in µm/N, C^g in µm per g, both in the
tool frame: origin at the flange, pipe I along +z, pipe II along +x.

Exit status: 0 done; 1 a diagnosis found a mismatch; 2 could not run (the error says what and where).";

#[derive(Debug, Subcommand)]
enum Command {
    /// Run the whole main job on embedded data and write its report (the default).
    Demo,
    /// How much a rod bends: C^F and C^g from its file.
    Compliance(compliance::Compliance),
    /// Readings of a stiffness rig.
    #[command(subcommand)]
    Rig(rig::Rig),
    /// Print a completion script for your shell.
    Completions(completions::Completions),
}

/// Beam theory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Theory {
    /// Bending without shear.
    EulerBernoulli,
    /// Bending with shear.
    Timoshenko,
}

impl Theory {
    fn physics(self) -> Physics {
        Physics { shear: self == Theory::Timoshenko, ..Physics::default() }
    }
}

/// A number of elements that a beam model can have and a machine can hold.
fn elements(text: &str) -> std::result::Result<usize, String> {
    match text.parse() {
        Ok(count) if (1..=1_000_000).contains(&count) => Ok(count),
        _ => Err("expected a whole number from 1 to 1000000".into()),
    }
}

/// Runs the command that was asked for.
pub fn run(arguments: &Arguments) -> Result<Outcome> {
    match &arguments.command {
        None | Some(Command::Demo) => demo::run(),
        Some(Command::Compliance(command)) => command.run(),
        Some(Command::Rig(command)) => command.run(),
        Some(Command::Completions(command)) => Ok(command.run()),
    }
}
