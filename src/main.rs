//! `rodcal` on the command line: parse, run, exit status.

mod cli;

use std::process::ExitCode;
use std::time::Instant;

use clap::{CommandFactory, Parser};

fn main() -> ExitCode {
    let arguments = match cli::Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => cli::suggestions::exit_with(error),
    };
    let started = Instant::now();
    let command = cli::Arguments::command();
    let deliver = |outcome| cli::output::deliver(&arguments.output, &command, started, outcome);
    match cli::run(&arguments).and_then(deliver) {
        Ok(status) => status,
        Err(error) => {
            cli::output::print_message("error:", Some(cli::output::RED), &error.to_string());
            if let Some(hint) = error.hint() {
                cli::output::print_message("hint:", None, hint);
            }
            ExitCode::from(2)
        }
    }
}
