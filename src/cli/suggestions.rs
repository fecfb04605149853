//! `rodcal fit` is `rodcal rig fit` with a word forgotten.

use clap::CommandFactory;
use clap::error::{ContextKind, ContextValue, Error};

use super::Arguments;

/// The same error, with the commands that are called so one step below.
pub fn with_nested(mut error: Error) -> Error {
    let Some(ContextValue::String(typed)) = error.get(ContextKind::InvalidSubcommand) else { return error };
    let program = Arguments::command();
    let inside = |command: &clap::Command| -> Vec<String> {
        let nested = command.get_subcommands().filter(|nested| nested.get_name() == typed.as_str());
        nested.map(|nested| format!("{} {}", command.get_name(), nested.get_name())).collect()
    };
    let meant: Vec<String> = program.get_subcommands().flat_map(inside).collect();
    if !meant.is_empty() {
        error.insert(ContextKind::SuggestedSubcommand, ContextValue::Strings(meant));
    }
    error
}
