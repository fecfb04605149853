//! `rodcal completions SHELL`.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::Arguments;
use super::output::Outcome;

#[derive(Debug, Args)]
pub struct Completions {
    /// Which shell.
    shell: Shell,
}

impl Completions {
    pub fn run(&self) -> Outcome {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Arguments::command(), "rodcal", &mut script);
        let script = String::from_utf8_lossy(&script).into_owned();
        Outcome {
            json: serde_json::json!({ "completions": script }),
            report: None,
            text: Some(script),
            default_directory: None,
            status: 0,
        }
    }
}
