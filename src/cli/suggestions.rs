//! `rodcal fit` is `rodcal rig fit` with a word forgotten.

use std::io::Write;

use clap::CommandFactory;
use clap::error::{ContextKind, ContextValue, Error};

use rodcal::delimited::{is_obeyed, visible, visible_lines};

use super::Arguments;

/// Says what is wrong with the arguments, and ends. What a terminal would obey in them is shown.
pub fn exit_with(error: Error) -> ! {
    let error = shown(with_nested(error));
    // what was asked for and could not be delivered is no success
    let is_lost = |said: std::io::Result<()>| {
        said.is_err_and(|error| error.kind() != std::io::ErrorKind::BrokenPipe) && !error.use_stderr()
    };
    let is_plain = std::env::args_os().all(|argument| !argument.to_string_lossy().contains(is_obeyed));
    let said = match is_plain || !error.use_stderr() {
        true => error.print().and_then(|()| std::io::stdout().flush()),
        false => std::io::stderr().write_all(visible_lines(&error.render().to_string()).as_bytes()),
    };
    std::process::exit(if is_lost(said) { 2 } else { error.exit_code() })
}

/// The same error with what was typed as it is shown: its writer leaves out what a terminal obeys.
fn shown(mut error: Error) -> Error {
    let text = |text: &String| visible(text).into_owned();
    let shown_value = |value: &ContextValue| match value {
        ContextValue::String(one) => Some(ContextValue::String(text(one))),
        ContextValue::Strings(many) => Some(ContextValue::Strings(many.iter().map(text).collect())),
        _ => None,
    };
    let all: Vec<_> = error.context().filter_map(|(kind, value)| Some((kind, shown_value(value)?))).collect();
    for (kind, value) in all {
        error.insert(kind, value);
    }
    error
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
