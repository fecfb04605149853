//! `rodcal fit` is `rodcal rig fit` with a word forgotten.

use std::io::Write;

use clap::CommandFactory;
use clap::error::{ContextKind, ContextValue, Error};

use rodcal::delimited::{is_obeyed, visible_lines};

use super::Arguments;

/// Says what is wrong with the arguments, and ends. What a terminal would obey in them is shown.
pub fn exit_with(error: Error) -> ! {
    let error = with_nested(error);
    let is_plain = std::env::args_os().all(|argument| !argument.to_string_lossy().contains(is_obeyed));
    if is_plain || !error.use_stderr() {
        error.exit();
    }
    let _ = std::io::stderr().write_all(visible_lines(&error.render().to_string()).as_bytes());
    std::process::exit(error.exit_code())
}

/// The same error, with the commands that are called so one step below.
fn with_nested(mut error: Error) -> Error {
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
