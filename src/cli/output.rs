//! What a command hands back, and where it goes: the result to stdout, warnings to stderr, the
//! report to files.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::{Args, Command};
use rodcal::answer::{Answer, LongList, write_json};
use rodcal::delimited::{visible, visible_lines};
use rodcal::files::{self, Existing, Staged};
use rodcal::report::{Report, text};
use rodcal::{Error, Result};
use serde_json::Value;

use super::provenance::{OUTPUT, Provenance, RESULT};
use super::stamp;

/// Where the result goes: options of every command.
#[derive(Debug, Args)]
pub struct Options {
    /// Print the result as JSON on stdout and nothing else (warnings still go to stderr).
    #[arg(long, global = true, help_heading = OUTPUT)]
    pub json: bool,

    /// Write a report into this directory: index.html for a browser, pictures (SVG), tables (CSV,
    /// Markdown) and result.json. Made if missing. Files in it that rodcal did not write, or that
    /// were changed since, stay.
    #[arg(long, global = true, value_name = "DIR", help_heading = OUTPUT)]
    pub out: Option<PathBuf>,

    /// With --out: write the pictures as PNG too.
    #[arg(long, global = true, help_heading = OUTPUT)]
    pub png: bool,

    /// No progress and no warnings on stderr; errors are said. Warnings stay in --json and on the
    /// page.
    #[arg(short, long, global = true, conflicts_with = "verbose", help_heading = OUTPUT)]
    pub quiet: bool,

    /// Say on stderr what was read (with its SHA-256), how long it took and what was written.
    #[arg(short, long, global = true, help_heading = OUTPUT)]
    pub verbose: bool,

    /// With --out: write the time into the report. Without it the same input gives the same bytes.
    /// SOURCE_DATE_EPOCH (seconds since 1970), where it is set, is the time.
    #[arg(long, global = true, help_heading = OUTPUT)]
    pub stamp: bool,

    /// Replace files that rodcal did not write, or that were changed since.
    #[arg(long, global = true, help_heading = OUTPUT)]
    pub force: bool,
}

impl Options {
    /// What happens to files that stand where others are to be written.
    pub fn existing(&self) -> Existing {
        if self.force { Existing::Replace } else { Existing::Keep }
    }
}

/// What every report has, whatever it is of.
const PAGE: &str = "index.html";

/// Where what was found is applied without --out.
pub const APPLIED: &str = "reports/diagnosed";

/// The result of a command.
pub struct Outcome {
    /// For `--json`.
    pub json: Value,
    /// The list of it that may be too long to be held.
    pub long: Option<LongList>,
    /// For people; `None` prints `text` as it is and writes no report.
    pub report: Option<Report>,
    /// More pages of the report, beside its own.
    pub pages: Vec<Report>,
    /// Files inside the program that it was made from, with the SHA-256 of their content, and
    /// those that the command line does not name.
    pub inputs: Vec<(String, String)>,
    /// Instead of the report's own words on stdout.
    pub text: Option<String>,
    /// Where the report goes without `--out`.
    pub default_directory: Option<PathBuf>,
    /// Names and contents of more files for the report's directory.
    pub files: Vec<(String, Vec<u8>)>,
    /// Where there is no report: what a user should know.
    pub warnings: Vec<String>,
    /// Puts files that are complete where they belong, once the result has been said.
    pub commit: Option<Commit>,
    /// Exit status.
    pub status: u8,
    /// What all random numbers came from, where there were any.
    pub seed: Option<u64>,
}

/// What is left to be done after the result has been said; dropped, nothing has been written.
pub type Commit = Box<dyn FnOnce() -> Result<()>>;

impl From<Answer> for Outcome {
    fn from(Answer { json, long, report, files, status, .. }: Answer) -> Self {
        Outcome { long, files, status, ..Outcome::new(json, report) }
    }
}

impl Outcome {
    /// A result with its report, exit status 0.
    pub fn new(json: Value, report: Report) -> Self {
        Outcome {
            json,
            long: None,
            report: Some(report),
            pages: Vec::new(),
            inputs: Vec::new(),
            text: None,
            default_directory: None,
            files: Vec::new(),
            warnings: Vec::new(),
            commit: None,
            status: 0,
            seed: None,
        }
    }

    /// The same, its random numbers from this seed.
    pub fn seeded(self, seed: u64) -> Self {
        Outcome { seed: Some(seed), ..self }
    }

    /// A result without one.
    pub fn plain(json: Value, text: String) -> Self {
        Outcome { report: None, text: Some(text), ..Outcome::new(json, Report::default()) }
    }
}

/// Prints warnings and the result. Before that all files are complete, after it they go where they
/// belong: nothing is left where nothing could be said (a full disk behind stdout). The command was
/// `started` then.
///
/// # Errors
/// [`Error::File`] where a file cannot be written, [`Error::InTheWay`] where one would be lost.
pub fn deliver(options: &Options, command: &Command, started: Instant, outcome: Outcome) -> Result<ExitCode> {
    let Outcome {
        mut json,
        long,
        mut report,
        mut pages,
        inputs: not_named,
        text,
        default_directory,
        files: more,
        warnings,
        commit,
        status,
        seed,
    } = outcome;
    let directory = options.out.clone().or(default_directory);
    let note = |line: &dyn Fn() -> String| {
        if options.verbose {
            to_stderr("", &line());
        }
    };
    let mut written = Vec::new();
    if report.is_none() && options.out.is_some() && !options.quiet {
        warn("this command writes no report: --out has no effect");
    }
    let mut inputs = Vec::new();
    let mut staged = None;
    if let Some(report) = &mut report {
        if options.png && directory.is_none() {
            report.warnings.push("--png has no effect without --out".into());
        }
        if options.stamp && directory.is_none() {
            report.warnings.push("--stamp has no effect without --out".into());
        }
        // the same words on stderr, on the page and in the JSON
        json["warnings"] = report.warnings.as_slice().into();
        if directory.is_some() || options.verbose {
            let mut provenance = Provenance::of(std::env::args().skip(1)).with_options(command);
            provenance.seed = seed;
            provenance.time = options.stamp.then(stamp::time).transpose()?;
            for (file, hash) in &provenance.inputs {
                note(&|| format!("read {file}, SHA-256 {hash}"));
            }
            if directory.is_some() {
                inputs.extend(provenance.inputs.iter().cloned());
                provenance.inputs.extend(not_named);
                for page in std::iter::once(&mut *report).chain(&mut pages) {
                    page.provenance.extend(provenance.lines());
                    page.result_file = RESULT.into();
                }
                json["provenance"] = provenance.json();
            }
        }
    }
    if let (Some(report), Some(directory)) = (&report, &directory) {
        // everything is rendered before anything is written
        let mut files = report.files()?;
        for page in &pages {
            files.extend(page.files()?);
        }
        if options.png {
            files.extend(pngs(&files)?);
        }
        json["report"] = directory.join(PAGE).display().to_string().into();
        files.extend(more);
        let mut result = Vec::new();
        write_json(&json, long.as_ref(), &mut result).map_err(unwritable(RESULT))?;
        files.push((RESULT.into(), result));
        files::check_apart(&inputs, directory, &files, options.existing())?;
        staged = Some(Staged::new(directory, &files, options.existing())?);
        written.extend(files.iter().map(|(name, content)| (directory.join(name), content.len())));
    }
    note(&|| format!("calculated and rendered in {:.2} s", started.elapsed().as_secs_f64()));
    if report.is_none() && !warnings.is_empty() {
        json["warnings"] = warnings.as_slice().into();
    }
    let warnings = report.as_ref().map_or(&warnings, |report| &report.warnings);
    for warning in warnings.iter().filter(|_| !options.quiet) {
        warn(warning);
    }
    let mut words = match (text, &report) {
        (_, _) if options.json => String::new(),
        (Some(text), _) => text,
        (None, Some(report)) => text::text_within(report, width()),
        (None, None) => String::new(),
    };
    if let (false, Some(directory), Some(_)) = (options.json, &directory, &report) {
        words += &format!("\nreport: {}\n", directory.join(PAGE).display());
    }
    let mut stdout = std::io::BufWriter::new(std::io::stdout().lock());
    let said = match options.json {
        true => write_json(&json, long.as_ref(), &mut stdout),
        false => stdout.write_all(visible_lines(&words).as_bytes()),
    };
    match said.and_then(|()| stdout.flush()) {
        // `rodcal … | head` closes the pipe early and means no harm
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => return Err(unwritable("stdout")(e)),
        _ => {}
    }
    staged.map_or(Ok(()), Staged::commit)?;
    for (file, bytes) in &written {
        note(&|| format!("wrote {}, {bytes} bytes", file.display()));
    }
    commit.map_or(Ok(()), |commit| commit())?;
    Ok(ExitCode::from(status))
}

/// The error of what cannot be written to `path`.
fn unwritable(path: &str) -> impl Fn(std::io::Error) -> Error {
    move |source| Error::File { path: path.into(), action: "write", source }
}

/// Refuses what cannot be delivered, before anything is calculated; the report goes to `directory`.
///
/// # Errors
/// [`Error::NotApplicable`] for `--png` in a build without it, [`Error::Argument`] for a file in
/// the place of the directory, [`Error::InTheWay`] for a page or a result in it that would be lost.
pub fn check(options: &Options, directory: Option<&Path>) -> Result<()> {
    if options.png && !cfg!(feature = "png") {
        return Err(Error::NotApplicable {
            what: "--png".into(),
            why: "this build of rodcal writes SVG only".into(),
            hint: "build one that can: cargo install --path . --features png".into(),
        });
    }
    if options.stamp {
        stamp::time()?;
    }
    match directory {
        Some(directory) if options.out.is_some() && directory.exists() && !directory.is_dir() => {
            Err(Error::Argument {
                name: "--out",
                found: format!("{}, which is a file", directory.display()),
                expected: "a directory, or a name that is still free".into(),
            })
        }
        Some(directory) => files::check_free(directory, &[PAGE, RESULT], options.existing()),
        None => Ok(()),
    }
}

#[cfg(feature = "png")]
fn pngs(files: &[(String, Vec<u8>)]) -> Result<Vec<(String, Vec<u8>)>> {
    rodcal_png::beside(files)
}

/// [`check`] has refused it.
#[cfg(not(feature = "png"))]
fn pngs(_: &[(String, Vec<u8>)]) -> Result<Vec<(String, Vec<u8>)>> {
    Ok(Vec::new())
}

/// ANSI colours of what asks for attention, and of what went wrong.
const YELLOW: u8 = 33;
pub const RED: u8 = 31;

/// A word for stderr: in colour on a terminal, unless NO_COLOR says otherwise.
fn coloured(word: &str, colour: u8) -> String {
    let is_plain = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    match std::io::stderr().is_terminal() && !is_plain {
        true => format!("\u{1b}[1;{colour}m{word}\u{1b}[0m"),
        false => word.to_owned(),
    }
}

/// A line on stderr after a word of the program's own. Nobody may be listening (`2>&1 | head`), and
/// `eprintln!` would panic. Names of files and what stands in them may hold anything: it is shown,
/// not obeyed.
fn to_stderr(word: &str, line: &str) {
    let space = if word.is_empty() { "" } else { " " };
    let _ = writeln!(std::io::stderr(), "{word}{space}{}", visible(line));
}

fn warn(warning: &str) {
    print_message("warning:", Some(YELLOW), warning);
}

/// Prints a sentence to stderr after a word of the program's own: on a terminal in lines that fit,
/// in a file or a pipe one line.
pub fn print_message(word: &str, colour: Option<u8>, sentence: &str) {
    match std::io::stderr().is_terminal() {
        true => {
            let lines = text::hanging(&format!("{word} "), &visible(sentence), columns());
            let rest = lines.strip_prefix(word).unwrap_or(&lines);
            let word = colour.map_or_else(|| word.to_owned(), |colour| coloured(word, colour));
            let _ = write!(std::io::stderr(), "{word}{rest}");
        }
        false => to_stderr(word, sentence),
    }
}

/// Columns of the terminal that stdout is; in a file or a pipe tables take what they need.
pub fn width() -> usize {
    if std::io::stdout().is_terminal() { columns() } else { usize::MAX }
}

/// Columns of the terminal, or as COLUMNS says.
fn columns() -> usize {
    let stated = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let seen = || terminal_size::terminal_size().map(|(width, _)| usize::from(width.0));
    // what is narrower is not a terminal that anybody reads
    stated.or_else(seen).unwrap_or(100).max(20)
}
