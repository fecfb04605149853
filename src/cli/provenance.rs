//! What a report was made from: the command line, and the content of every file that it names.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::builder::ValueParser;
use clap::parser::ValueSource;
use clap::{ArgAction, ArgMatches, Command};
use rodcal::files;
use serde_json::{Map, Value, json};

/// The result as JSON, in every directory of a report.
pub const RESULT: &str = "result.json";

/// The heading of options that every command has, none of which changes a result.
pub const OUTPUT: &str = "Output";

/// The option that says where to write: the same report elsewhere is the same report.
const WHERE: &str = "--out";
/// What changes no result.
const WITHOUT_EFFECT: [&str; 5] = ["--force", "-q", "--quiet", "-v", "--verbose"];
/// The option whose file keeps a search, on which what it finds does not depend.
const KEPT: &str = "resume";

/// What stands in a report besides its own sources: name and value.
pub struct Provenance {
    /// The command as it was typed, but for where its report goes.
    pub command: String,
    /// Every option of the command by its name, at its default too: what it was set to, whether
    /// that is its default; `Null` where it was left out and has none.
    pub options: Vec<(String, Value, bool)>,
    /// Input files with the SHA-256 of their content.
    pub inputs: Vec<(String, String)>,
    /// What all random numbers came from, where there were any.
    pub seed: Option<u64>,
    /// When; only where it was asked for.
    pub time: Option<String>,
}

impl Provenance {
    /// Of the arguments after the program's name.
    pub fn of(arguments: impl Iterator<Item = String>) -> Provenance {
        let mut kept = Vec::new();
        let mut arguments = arguments.peekable();
        while let Some(argument) = arguments.next() {
            if argument == WHERE {
                arguments.next();
            } else if !argument.starts_with(&format!("{WHERE}=")) && !WITHOUT_EFFECT.contains(&&*argument) {
                kept.push(argument);
            }
        }
        let words = kept.iter().map(|argument| match argument.contains([' ', '"', '\'']) {
            true => format!("'{}'", argument.replace('\'', "'\\''")),
            false => argument.clone(),
        });
        // what runs without a command is the demo
        let first = if kept.is_empty() { "rodcal demo" } else { "rodcal" };
        let command = std::iter::once(first.to_owned()).chain(words).collect::<Vec<_>>().join(" ");
        Provenance { command, options: Vec::new(), inputs: Vec::new(), seed: None, time: None }
    }

    /// The same with the options of `command` and the files that they name, as it was typed.
    pub fn with_options(self, command: &Command) -> Provenance {
        let Ok(matches) = command.clone().try_get_matches_from(std::env::args_os()) else { return self };
        Provenance { options: options(command, &matches), inputs: inputs(command, &matches), ..self }
    }

    /// As JSON.
    pub fn json(&self) -> Value {
        let input = |(file, sha256): &(String, String)| json!({ "file": file, "sha256": sha256 });
        let options = self.options.iter().map(|(name, value, _)| (name.clone(), value.clone()));
        let mut json = json!({
            "command": self.command,
            "options": options.collect::<Map<_, _>>(),
            "program": concat!("rodcal ", env!("CARGO_PKG_VERSION")),
            "inputs": self.inputs.iter().map(input).collect::<Vec<_>>(),
        });
        if let Some(seed) = self.seed {
            json["seed"] = seed.into();
        }
        if let Some(time) = &self.time {
            json["time"] = time.as_str().into();
        }
        json
    }

    /// As lines of a report.
    pub fn lines(&self) -> impl Iterator<Item = (String, String)> + '_ {
        let inputs = self.inputs.iter().map(|(file, hash)| (format!("SHA-256 of {file}"), hash.clone()));
        let seed = self.seed.iter().map(|seed| ("seed".to_owned(), seed.to_string()));
        let time = self.time.iter().map(|time| ("time".to_owned(), time.clone()));
        let said = |(name, value, is_default): &(String, Value, bool)| match value {
            Value::Null => format!("--{name} not given"),
            Value::Bool(is_set) => format!("--{name} {}", if *is_set { "on" } else { "off" }),
            value => {
                let by_default = if *is_default { " (default)" } else { "" };
                format!("--{name} {}{by_default}", value.as_str().unwrap_or_default())
            }
        };
        let options = self.options.iter().map(said).collect::<Vec<_>>().join(", ");
        let options = (!options.is_empty()).then(|| ("options".to_owned(), options));
        let command = ("command".to_owned(), self.command.clone());
        std::iter::once(command).chain(options).chain(seed).chain(time).chain(inputs)
    }
}

/// The options of the command that was asked for, without those that every command has.
fn options(command: &Command, matches: &ArgMatches) -> Vec<(String, Value, bool)> {
    if let Some((name, matches)) = matches.subcommand() {
        return command.find_subcommand(name).map_or_else(Vec::new, |command| options(command, matches));
    }
    let own = command.get_arguments().filter(|argument| argument.get_help_heading() != Some(OUTPUT));
    let option = |argument: &clap::Arg| {
        let (id, name) = (argument.get_id().as_str(), argument.get_long()?);
        let value = match argument.get_action() {
            ArgAction::Help | ArgAction::HelpShort | ArgAction::HelpLong | ArgAction::Version => return None,
            ArgAction::SetTrue => Value::Bool(matches.get_flag(id)),
            _ => matches.get_raw(id).map_or(Value::Null, |values| {
                let values: Vec<_> = values.map(|value| value.to_string_lossy()).collect();
                Value::String(values.join(" "))
            }),
        };
        let is_default = matches.value_source(id) == Some(ValueSource::DefaultValue);
        Some((name.to_owned(), value, is_default))
    };
    own.filter_map(option).collect()
}

/// The files that arguments of the command name, and those that these name, with the SHA-256 of
/// their content.
fn inputs(command: &Command, matches: &ArgMatches) -> Vec<(String, String)> {
    if let Some((name, matches)) = matches.subcommand() {
        return command.find_subcommand(name).map_or_else(Vec::new, |command| inputs(command, matches));
    }
    let is_path = |argument: &&clap::Arg| {
        argument.get_value_parser().type_id() == ValueParser::path_buf().type_id()
            && argument.get_help_heading() != Some(OUTPUT)
            && argument.get_id() != KEPT
    };
    let paths = command.get_arguments().filter(is_path);
    let paths = paths.filter_map(|argument| matches.get_many::<PathBuf>(argument.get_id().as_str()));
    // of a run that is compared, its result
    let file = |path: &PathBuf| if path.is_dir() { path.join(RESULT) } else { path.clone() };
    let mut found: BTreeSet<PathBuf> = BTreeSet::new();
    for path in paths.flatten().map(file).filter(|path| path.is_file()) {
        found.extend(named_in(&path));
        found.insert(path);
    }
    let hash = |path: PathBuf| {
        let content = files::read_bytes(&path).ok()?;
        Some((path.display().to_string(), files::sha256(&content)))
    };
    found.into_iter().filter_map(hash).collect()
}

/// The files that a campaign names in its first lines, or a design as its catalogue, relative to
/// its own directory.
fn named_in(path: &Path) -> Vec<PathBuf> {
    if path.extension().is_none_or(|extension| extension != "toml") {
        return Vec::new();
    }
    let Some(table) = files::read_text(path).ok().and_then(|text| text.parse::<toml::Table>().ok()) else {
        return Vec::new();
    };
    let directory = path.parent().unwrap_or(Path::new(""));
    let name = |value: &toml::Value| Some(value.as_str().or_else(|| value.get("file")?.as_str())?.to_owned());
    let names = table.values().filter_map(name);
    names.map(|name| directory.join(name)).filter(|path| path.is_file()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn provenance(arguments: &[&str]) -> Provenance {
        Provenance::of(arguments.iter().map(|argument| (*argument).to_owned()))
    }

    #[test]
    fn options_at_their_defaults_are_said_too() {
        let argument = |name: &'static str| clap::Arg::new(name).long(name);
        let own = [
            argument("count").default_value("3"),
            argument("seed"),
            argument("mode"),
            argument("refine").action(ArgAction::SetTrue),
            argument("json").help_heading(OUTPUT),
        ];
        let command = Command::new("rodcal").subcommand(Command::new("fit").args(own));
        let matches = command.clone().get_matches_from(["rodcal", "fit", "--mode", "fea"]);
        let options = options(&command, &matches);
        let made = Provenance { options, ..provenance(&["fit"]) };
        let lines: Vec<_> = made.lines().collect();
        assert_eq!(lines[1].1, "--count 3 (default), --seed not given, --mode fea, --refine off");
        assert_eq!(
            made.json()["options"],
            json!({ "count": "3", "seed": null, "mode": "fea", "refine": false })
        );
    }

    /// A word that is no path is none, whatever lies in the folder; a design names its catalogue.
    #[test]
    fn the_inputs_are_the_files_that_arguments_and_files_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(at("design.toml"), "[catalogue]\nfile = \"tubes.csv\"\n").unwrap();
        std::fs::write(at("tubes.csv"), "name\n").unwrap();
        std::fs::write(at("kept"), "kept\n").unwrap();
        let path = |name: &'static str| clap::Arg::new(name).value_parser(ValueParser::path_buf());
        let own = [path("design"), path(KEPT).long(KEPT), clap::Arg::new("word").long("word")];
        let command = Command::new("rodcal").subcommand(Command::new("design").args(own));
        let typed =
            ["rodcal", "design", &at("design.toml"), "--word", &at("tubes.csv"), "--resume", &at("kept")];
        let matches = command.clone().get_matches_from(typed);
        let inputs = inputs(&command, &matches);
        let names: Vec<&String> = inputs.iter().map(|(name, _)| name).collect();
        assert_eq!(names, [&at("design.toml"), &at("tubes.csv")]);
        assert_eq!(inputs[1].1, files::sha256(b"name\n"));
        std::fs::remove_file(at("tubes.csv")).unwrap();
        assert_eq!(super::inputs(&command, &matches).len(), 1);
    }

    #[test]
    fn where_a_report_goes_is_no_part_of_the_command() {
        let made = provenance(&["fit", "a b.csv", "--out", "x", "--mode=fea", "--out=y"]);
        assert_eq!(
            provenance(&["fit", "-q", "a.csv"]).command,
            provenance(&["fit", "a.csv", "--verbose", "--force"]).command
        );
        assert_eq!(made.command, "rodcal fit 'a b.csv' --mode=fea");
        assert_eq!(provenance(&["--out", "x"]).command, provenance(&["--out=y"]).command);
    }
}
