//! The program as its users meet it: what they type, what they read, which files they get.

#![allow(clippy::unwrap_used)]

mod calibrate;
mod compare_runs;
mod convert;
mod design;
mod design_poses;
mod design_rig;
mod diagnose;
mod diagnose_calibration;
mod faults;
mod files;
mod hostile;
mod json;
mod kept;
mod mistakes;
mod page;
mod readme;
mod refused;
mod streams;
mod trial;
mod words;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{LazyLock, Mutex, OnceLock};

use serde_json::Value;
use tempfile::TempDir;

/// Asks for PNGs where this build can write them.
const PNG: &str = if cfg!(feature = "png") { " --png" } else { "" };

/// A directory of its own for each test, with copies of the project's data: what a test writes
/// harms nobody.
struct Sandbox(TempDir);

impl Sandbox {
    fn new() -> Self {
        let sandbox = Sandbox::empty();
        let project = Path::new(env!("CARGO_MANIFEST_DIR"));
        // campaigns and robots as soon as there are some
        for directory in ["rods", "stiffness_data", "robots", "campaigns"] {
            copy(&project.join(directory), &sandbox.path().join(directory));
        }
        std::fs::create_dir(sandbox.path().join("examples")).unwrap();
        for design in ["examples/design.toml", "examples/small-arm.toml"] {
            std::fs::copy(project.join(design), sandbox.path().join(design)).unwrap();
        }
        sandbox
    }

    fn empty() -> Self {
        Sandbox(tempfile::tempdir().unwrap())
    }

    /// Another one with the same files.
    fn copied(&self) -> Self {
        let sandbox = Sandbox::empty();
        copy(self.path(), sandbox.path());
        sandbox
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path().join(name), text).unwrap();
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// The program in this directory, at a terminal of a fixed width, without colours.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rodcal"));
        command.args(arguments).current_dir(self.path()).stdin(Stdio::null());
        command.env("COLUMNS", "100").env("NO_COLOR", "1").env_remove("CLICOLOR_FORCE");
        command
    }

    /// Runs `rodcal` with the words of `line`.
    fn run(&self, line: &str) -> Answer {
        let words: Vec<&str> = line.split_whitespace().collect();
        let output = self.command(&words).output().unwrap();
        Answer {
            line: line.to_owned(),
            status: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Every file below the directory with its bytes, every directory with a "/" and none.
    fn listing(&self) -> BTreeMap<String, Vec<u8>> {
        let mut found = BTreeMap::new();
        list(self.path(), "", &mut found);
        found
    }
}

fn copy(from: &Path, to: &Path) {
    let Ok(entries) = std::fs::read_dir(from) else { return };
    std::fs::create_dir_all(to).unwrap();
    for entry in entries.map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}

fn list(directory: &Path, prefix: &str, found: &mut BTreeMap<String, Vec<u8>>) {
    for entry in std::fs::read_dir(directory).unwrap().map(Result::unwrap) {
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            list(&entry.path(), &format!("{name}/"), found);
            found.insert(format!("{name}/"), Vec::new());
        } else {
            found.insert(name, std::fs::read(entry.path()).unwrap());
        }
    }
}

/// What the program answered.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Answer {
    line: String,
    status: Option<i32>,
    pub(crate) stdout: String,
    stderr: String,
}

impl Answer {
    /// 0, or the 1 of a diagnosis that found a mismatch or a search that found no rod.
    fn succeeded(self) -> Self {
        let may_find = self.status == Some(1)
            && ["diagnose", "design rod"].iter().any(|finds| self.line.trim_start().starts_with(finds));
        assert!(self.status == Some(0) || may_find, "rodcal {}\n{}", self.line, self.stderr);
        self
    }

    /// All of stdout as JSON; anything else on it is a failure.
    fn json(self) -> Value {
        let answer = self.succeeded();
        let whole = serde_json::from_str(&answer.stdout);
        whole.unwrap_or_else(|e| panic!("rodcal {}: {e}\n{}", answer.line, answer.stdout))
    }

    /// The warnings on stderr, on which nothing else stands.
    fn warnings(&self) -> Vec<String> {
        let warning = |line: &str| match line.strip_prefix("warning: ") {
            Some(words) => words.to_owned(),
            None => panic!("rodcal {}: {line:?} is no warning", self.line),
        };
        self.stderr.lines().map(warning).collect()
    }
}

/// A command on the project's data whose answer several tests read: it runs once.
pub(crate) struct Ran {
    pub(crate) answer: Answer,
    /// The files before and after.
    before: BTreeMap<String, Vec<u8>>,
    after: BTreeMap<String, Vec<u8>>,
}

pub(crate) fn ran(line: &str) -> &'static Ran {
    static RUNS: LazyLock<Mutex<BTreeMap<String, &'static OnceLock<Ran>>>> = LazyLock::new(Mutex::default);
    let run: &'static OnceLock<Ran> = RUNS
        .lock()
        .unwrap_or_else(|poisoned| poisoned.into_inner())
        .entry(line.to_owned())
        .or_insert_with(|| Box::leak(Box::default()));
    run.get_or_init(|| {
        let sandbox = Sandbox::new();
        let before = sandbox.listing();
        let answer = sandbox.run(line);
        Ran { answer, before, after: sandbox.listing() }
    })
}

/// What is said by commands that rest on one another, in one directory: `lines` in their order,
/// each of those that begin with a `+` as text and then as JSON.
pub(crate) fn said_in_turn(lines: &[&str]) -> Vec<[String; 2]> {
    let sandbox = Sandbox::new();
    sandbox.write("poses.csv", "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg\n1,0,10,80,5,6,7\n");
    let mut said = Vec::new();
    for line in lines {
        match line.strip_prefix('+') {
            Some(asked) => said.push(["", " --json"].map(|json| {
                let answer = sandbox.run(&format!("{asked}{json}"));
                assert!(answer.status < Some(2), "{line}: {}", answer.stderr);
                answer.stdout
            })),
            None => drop(sandbox.run(line).succeeded()),
        }
    }
    said
}

/// Steel rod and readings, carbon rod and readings, real readings: every command that makes a
/// report.
const REPORTS: [&str; 10] = [
    "compliance rods/5.toml",
    "compliance rods/5.toml --mode calc --theory timoshenko",
    "compliance rods/2.toml --theory euler-bernoulli",
    "rig fit rods/5.toml stiffness_data/5.csv",
    "rig fit rods/2.toml stiffness_data/2.csv",
    "rig fit rods/2.toml stiffness_data/2.csv --robust huber",
    "rig fit linear stiffness_data/nist-load-cell.csv",
    "diagnose rig rods/5.toml stiffness_data/5.csv",
    "diagnose rig linear stiffness_data/nist-load-cell.csv",
    "demo",
];
