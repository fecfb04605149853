//! `rodcal completions SHELL`.

use clap::{Args, Command};
use clap_complete::Shell;

use super::output::Outcome;

#[derive(Debug, Args)]
#[command(after_help = INSTALL)]
pub struct Completions {
    /// Which shell.
    shell: Shell,
}

const INSTALL: &str = "\
bash: rodcal completions bash > ~/.local/share/bash-completion/completions/rodcal
zsh:  rodcal completions zsh > DIR/_rodcal, with DIR in $fpath
fish: rodcal completions fish > ~/.config/fish/completions/rodcal.fish";

impl Completions {
    /// `command`: the whole command line.
    pub fn run(&self, mut command: Command) -> Outcome {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut command, "rodcal", &mut script);
        let script = String::from_utf8_lossy(&script).into_owned();
        Outcome::plain(serde_json::json!({ "completions": script }), script)
    }
}
