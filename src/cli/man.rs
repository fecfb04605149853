//! `rodcal man [COMMAND…]`.

use clap::{Args, Command};
use clap_mangen::Man;
use rodcal::{Error, Result};

use super::output::Outcome;

#[derive(Debug, Args)]
#[command(after_help = INSTALL)]
pub struct ManPage {
    /// Of which command, as it is typed: `rig fit` [default: the program].
    command: Vec<String>,
}

const INSTALL: &str = "\
rodcal man > ~/.local/share/man/man1/rodcal.1
rodcal man rig fit > ~/.local/share/man/man1/rodcal-rig-fit.1
read without installing: rodcal man rig fit | man -l -";

impl ManPage {
    /// `command`: the whole command line.
    pub fn run(&self, mut command: Command) -> Result<Outcome> {
        // gives each command the name that its page has
        command.build();
        let mut found = &command;
        for word in &self.command {
            found = found.find_subcommand(word).ok_or_else(|| {
                let known: Vec<&str> = found.get_subcommands().map(Command::get_name).collect();
                Error::Argument {
                    name: "COMMAND",
                    found: word.clone(),
                    expected: match known.is_empty() {
                        true => format!("nothing after {}", found.get_name()),
                        false => format!("one of {}", known.join(", ")),
                    },
                }
            })?;
        }
        let mut page = Vec::new();
        let program = concat!("rodcal ", env!("CARGO_PKG_VERSION"));
        Man::new(found.clone()).source(program).render(&mut page).map_err(|source| Error::File {
            path: "stdout".into(),
            action: "write",
            source,
        })?;
        let page = String::from_utf8_lossy(&page).into_owned();
        Ok(Outcome::plain(serde_json::json!({ "man": page }), page))
    }
}
