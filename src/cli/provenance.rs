//! What a report was made from: the command line, and the content of every file that it names.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use rodcal::files;

/// The result as JSON, in every directory of a report.
pub const RESULT: &str = "result.json";

/// The option that says where to write: the same report elsewhere is the same report.
const WHERE: &str = "--out";
/// What changes no result.
const WITHOUT_EFFECT: [&str; 5] = ["--force", "-q", "--quiet", "-v", "--verbose"];

/// What stands in a report besides its own sources: name and value.
pub struct Provenance {
    /// The command as it was typed, but for where its report goes.
    pub command: String,
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
        let named =
            kept.iter().map(|argument| argument.split_once('=').map_or(&argument[..], |(_, value)| value));
        let mut found: BTreeSet<PathBuf> = BTreeSet::new();
        // of a run that is compared, its result
        let file = |path: PathBuf| if path.is_dir() { path.join(RESULT) } else { path };
        for path in named.map(PathBuf::from).map(file).filter(|path| path.is_file()) {
            found.extend(named_in(&path));
            found.insert(path);
        }
        let hash = |path: PathBuf| {
            let content = files::read_bytes(&path).ok()?;
            Some((path.display().to_string(), files::sha256(&content)))
        };
        Provenance { command, inputs: found.into_iter().filter_map(hash).collect(), seed: None, time: None }
    }

    /// As JSON.
    pub fn json(&self) -> serde_json::Value {
        let input = |(file, sha256): &(String, String)| serde_json::json!({ "file": file, "sha256": sha256 });
        let mut json = serde_json::json!({
            "command": self.command,
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
        std::iter::once(("command".to_owned(), self.command.clone())).chain(seed).chain(time).chain(inputs)
    }
}

/// The files that a campaign or a design names in its first lines, relative to its own directory.
fn named_in(path: &Path) -> Vec<PathBuf> {
    if path.extension().is_none_or(|extension| extension != "toml") {
        return Vec::new();
    }
    let Some(table) = files::read_text(path).ok().and_then(|text| text.parse::<toml::Table>().ok()) else {
        return Vec::new();
    };
    let directory = path.parent().unwrap_or(Path::new(""));
    let names = table.values().filter_map(toml::Value::as_str);
    names.map(|name| directory.join(name)).filter(|path| path.is_file()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn provenance(arguments: &[&str]) -> Provenance {
        Provenance::of(arguments.iter().map(|argument| (*argument).to_owned()))
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
