//! Answers: one line of JSON for each case, in any order. A line is whole or it is not there; files
//! of answers from several machines are merged by concatenation.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::archive::{line, parsed};
use rodcal_base::error::{Error, Place, Result};
use rodcal_base::files;

/// One answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// `rig/case-0001`.
    pub case: String,
    /// What the diagnosis said, as its JSON; `{"error": …}` where it refused.
    pub answer: Value,
    /// SHA-256 of the files that it saw, by name.
    pub sha256: BTreeMap<String, String>,
    /// What would be read where `asked.csv` asks, in its order, µm; nothing where it does not, or
    /// where there is no answer.
    #[serde(default, rename = "asked_um", skip_serializing_if = "Option::is_none")]
    pub predicted_um: Option<Vec<f64>>,
}

/// The answers that are there, none where there is no file; half a line at the end, of a run that
/// was cut off, is dropped.
///
/// # Errors
/// [`Error::File`], [`Error::Syntax`], [`Error::Input`] for a case with two different answers.
pub fn read(path: &Path) -> Result<Vec<Answer>> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let name = path.display().to_string();
    let bytes = files::read_bytes(path)?;
    let whole = whole_lines(bytes.clone());
    // what is not the beginning of an answer is somebody else's, and would be taken away
    let rest = &bytes[whole.len()..];
    if !rest.starts_with(BEGINNING) && !BEGINNING.starts_with(rest) {
        return Err(Error::Input {
            at: Place {
                file: name,
                line: whole.iter().filter(|&&byte| byte == b'\n').count() + 1,
                column: 1,
            },
            found: "the last line has no end and is no answer".into(),
            expected: "a file of answers, or a name that is still free".into(),
            hint: None,
        });
    }
    let text = files::text_of_bytes(&name, whole)?;
    let mut answers: Vec<Answer> = Vec::new();
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for (index, text) in text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()) {
        let answer: Answer = parsed(path, index + 1, text)?;
        match seen.get(&answer.case).and_then(|&first| answers.get(first)) {
            Some(first) if *first == answer => {}
            Some(_) => {
                return Err(Error::Input {
                    at: Place { file: name, line: index + 1, column: 0 },
                    found: format!("another answer to {}", answer.case),
                    expected: "one answer to each case".into(),
                    hint: None,
                });
            }
            None => {
                seen.insert(answer.case.clone(), answers.len());
                answers.push(answer);
            }
        }
    }
    Ok(answers)
}

/// Adds answers to a file, after what half a line may stand at its end is taken away.
///
/// # Errors
/// [`Error::File`].
pub fn append(path: &Path, answers: &[Answer]) -> Result<()> {
    if path.exists() {
        let bytes = files::read_bytes(path)?;
        let length = bytes.len();
        let whole = whole_lines(bytes);
        if whole.len() < length {
            files::write_whole(path, &whole)?;
        }
    }
    let lines: String = answers.iter().map(line).collect::<Result<_>>()?;
    files::append(path, lines.as_bytes())
}

/// How the line of every answer begins.
const BEGINNING: &[u8] = b"{\"case\":";

/// Cases that have no answer yet.
pub fn missing(cases: &[String], answers: &[Answer]) -> Vec<String> {
    let answered: BTreeSet<&str> = answers.iter().map(|answer| answer.case.as_str()).collect();
    cases.iter().filter(|case| !answered.contains(case.as_str())).cloned().collect()
}

fn whole_lines(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn answer(case: &str) -> Answer {
        Answer {
            case: case.into(),
            answer: json!({"verdict": "consistent"}),
            sha256: BTreeMap::new(),
            predicted_um: None,
        }
    }

    #[test]
    fn half_a_line_is_dropped_and_answered_again() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("answers.jsonl");
        assert_eq!(read(&path).unwrap(), []);
        append(&path, &[answer("a"), answer("b")]).unwrap();
        files::append(&path, "{\"case\":\"µ".as_bytes().split_last().unwrap().1).unwrap();
        let there = read(&path).unwrap();
        assert_eq!(missing(&["a".into(), "b".into(), "c".into()], &there), ["c"]);
        append(&path, &[answer("c")]).unwrap();
        assert_eq!(read(&path).unwrap(), [answer("a"), answer("b"), answer("c")]);
    }

    #[test]
    fn a_file_of_somebody_else_is_refused_whole_or_in_its_last_line() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("notes.txt");
        for text in ["notes", "notes\n", "{\"case\"", "{}"] {
            files::write_whole(&path, text.as_bytes()).unwrap();
            assert_eq!(read(&path).is_ok(), text.starts_with("{\"case"), "{text}");
        }
    }

    #[test]
    fn the_same_answer_twice_is_one_and_two_answers_are_an_error() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("answers.jsonl");
        append(&path, &[answer("a"), answer("a")]).unwrap();
        assert_eq!(read(&path).unwrap().len(), 1);
        append(&path, &[Answer { answer: json!({"verdict": "mismatch"}), ..answer("a") }]).unwrap();
        assert!(read(&path).unwrap_err().to_string().contains(":3"));
    }
}
