//! The one error type of the library.
//!
//! An error says where (file, line, column), what stood there and what would be right;
//! [`Error::hint`] adds the advice, where there is any. Numbers in messages carry their units.

use std::path::PathBuf;

/// Result of everything in the library that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// What could not be done, and where.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read or written at all.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// The file or directory.
        path: PathBuf,
        /// The verb: `read`, `write`, `create`.
        action: &'static str,
        /// What the operating system said.
        source: std::io::Error,
    },

    /// What stands where files are to be written would be lost.
    #[error("{}", in_the_way(files, *whose))]
    InTheWay {
        /// The files, one or more.
        files: Vec<PathBuf>,
        /// Whose they are.
        whose: Whose,
    },

    /// An input file does not follow its format: no valid TOML, an unknown or a missing key.
    #[error("{at}: {message}")]
    Syntax {
        /// File, line and column.
        at: Place,
        /// What the parser found and what it expected.
        message: String,
    },

    /// Something in an input file is not what it should be.
    #[error("{at}: {found}, expected {expected}")]
    Input {
        /// File, line and column.
        at: Place,
        /// What stood there, with the name of the key or column, for example "`l1_mm` is -150".
        found: String,
        /// What would be right, for example "a length > 0".
        expected: String,
        /// How to get there, where that is not obvious.
        hint: Option<String>,
    },

    /// An argument of a command or of a library function is out of its domain.
    #[error("`{name}` is {found}, expected {expected}")]
    Argument {
        /// Name of the argument as the caller wrote it.
        name: &'static str,
        /// The value that was given.
        found: String,
        /// Its domain.
        expected: String,
    },

    /// A model cannot be used in the mode that was asked for.
    #[error("{what} is not possible: {why}")]
    NotApplicable {
        /// What was asked for.
        what: String,
        /// Why it cannot be done.
        why: String,
        /// What can be done instead.
        hint: String,
    },

    /// A beam solution failed its own equilibrium, reciprocity or finiteness check.
    #[error(
        "the beam solution fails its self-check at node {node} (station {station_mm:.3} mm), {freedom}: {check} is off by {relative:.1e} of the scale"
    )]
    SelfCheck {
        /// Index of the node, 0 at the clamped end.
        node: usize,
        /// Arc length of the node from the clamped end, mm.
        station_mm: f64,
        /// Freedom and load case, for example "force along z under self-weight along x".
        freedom: String,
        /// Which check failed.
        check: &'static str,
        /// Size of the violation relative to the scale of the quantity.
        relative: f64,
    },

    /// A numerical procedure has no answer (for example a matrix with no full rank where one is
    /// needed).
    #[error("{what}: {why}")]
    Numerical {
        /// The procedure.
        what: &'static str,
        /// Why it has no answer.
        why: String,
    },
}

/// Whose a file is that must not be replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whose {
    /// The program did not write it.
    Unknown,
    /// The program wrote it, and it has been changed since.
    Changed,
    /// Whoever wrote it: its like is written once.
    Kept,
    /// It is an input of what is to be written.
    Read,
}

impl Error {
    /// Advice on how to repair the cause, to be shown on a line of its own after the message.
    pub fn hint(&self) -> Option<&str> {
        match self {
            Error::Input { hint, .. } => hint.as_deref(),
            Error::NotApplicable { hint, .. } => Some(hint),
            Error::File { source, action: "read", .. }
                if source.kind() == std::io::ErrorKind::IsADirectory =>
            {
                Some("name the file that is meant in this directory")
            }
            Error::InTheWay { whose: Whose::Kept, .. } => {
                Some("take another name: what stands there is written once, and --force does not replace it")
            }
            Error::InTheWay { .. } => Some("write to another place, or replace what is there with --force"),
            Error::SelfCheck { .. } => Some(
                "check the stiffnesses near that station; numbers many orders of magnitude apart overflow double precision",
            ),
            _ => None,
        }
    }

    /// The same error with advice, where it is one about an input file.
    pub fn with_hint(mut self, advice: Option<String>) -> Self {
        if let Error::Input { hint, .. } = &mut self {
            *hint = advice;
        }
        self
    }
}

/// So many files in the way are named.
const NAMED: usize = 3;

fn in_the_way(files: &[PathBuf], whose: Whose) -> String {
    let names: Vec<String> = files.iter().take(NAMED).map(|path| path.display().to_string()).collect();
    let more = match files.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let (are, them, have) = if files.len() == 1 { ("is", "it", "has") } else { ("are", "them", "have") };
    let names = names.join(", ") + &more;
    match whose {
        Whose::Unknown => format!("{names} {are} there already, and rodcal did not write {them}"),
        Whose::Changed => format!("{names} {have} been changed since rodcal wrote {them}"),
        Whose::Read => format!("this command reads {names}, and its result would replace {them}"),
        Whose::Kept => format!("{names} {are} there already"),
    }
}

/// A place in an input file. Lines and columns count from 1; 0 means "the file as a whole".
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file as the user named it.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl Place {
    /// The place of byte `offset` in `text`, which was read from `file`.
    pub fn of_offset(file: &str, text: &str, offset: usize) -> Self {
        let before = &text.as_bytes()[..offset.min(text.len())];
        let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        Place {
            file: file.to_owned(),
            line: before.iter().filter(|&&b| b == b'\n').count() + 1,
            column: String::from_utf8_lossy(&before[line_start..]).chars().count() + 1,
        }
    }

    /// The file as a whole, where no single line is to blame.
    pub fn whole_file(file: &str) -> Self {
        Place { file: file.to_owned(), line: 0, column: 0 }
    }
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.line, self.column) {
            (0, _) => write!(f, "{}", self.file),
            (line, 0) => write!(f, "{}:{line}", self.file),
            (line, column) => write!(f, "{}:{line}:{column}", self.file),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_counts_lines_and_characters_from_one() {
        let text = "a = 1\nµ = 22\n";
        assert_eq!(Place::of_offset("f", text, 0).to_string(), "f:1:1");
        // byte 11 is the first "2": µ takes two bytes but one column
        assert_eq!(Place::of_offset("f", text, 11).to_string(), "f:2:5");
        assert_eq!(Place::of_offset("f", text, 999).to_string(), "f:3:1");
    }
}
