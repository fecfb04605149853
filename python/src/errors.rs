//! The library's errors as Python's exceptions (`rodcal/_errors.py`).

use pyo3::prelude::*;
use rodcal::Error;
use rodcal::delimited::visible_lines;

/// `text` with everything escaped that a terminal would obey.
#[pyfunction]
pub fn visible(text: &str) -> String {
    visible_lines(text).into_owned()
}

/// Inputs that were dicts: lines and columns of the text between would help nobody. Tables keep
/// their lines, for those are their rows.
const DICTS: [&str; 4] = ["<rod>", "<robot>", "<campaign>", "<design>"];

/// The Python exception for an error.
pub trait IntoPython<T> {
    /// The same result with Python's exception.
    fn or_raise(self, py: Python<'_>) -> PyResult<T>;
}

impl<T> IntoPython<T> for rodcal::Result<T> {
    fn or_raise(self, py: Python<'_>) -> PyResult<T> {
        self.map_err(|error| raised(py, error))
    }
}

/// The exception of an error.
pub fn raised(py: Python<'_>, mut error: Error) -> PyErr {
    if let Error::Input { at, .. } | Error::Syntax { at, .. } = &mut error
        && DICTS.contains(&at.file.as_str())
    {
        (at.line, at.column) = (0, 0);
    }
    let (mut file, mut line, mut column) = (None, 0, 0);
    let (mut found, mut expected, mut errno) = (None, None, None);
    let kind = match &error {
        Error::File { path, source, .. } => {
            errno = source.raw_os_error();
            file = Some(path.display().to_string());
            "file"
        }
        Error::InTheWay { files, .. } => {
            file = files.first().map(|path| path.display().to_string());
            "file"
        }
        Error::Syntax { at, .. } => {
            (file, line, column) = (Some(at.file.clone()), at.line, at.column);
            "input"
        }
        Error::Input { at, found: was, expected: right, .. } => {
            (file, line, column) = (Some(at.file.clone()), at.line, at.column);
            (found, expected) = (Some(was.clone()), Some(right.clone()));
            "input"
        }
        Error::Argument { found: was, expected: right, .. } => {
            (found, expected) = (Some(was.clone()), Some(right.clone()));
            "input"
        }
        Error::NotApplicable { .. } => "not_applicable",
        _ => "numerical",
    };
    let known = |number: usize| (number > 0).then_some(number);
    let words =
        (kind, error.to_string(), file, known(line), known(column), found, expected, error.hint(), errno);
    let exception = py.import("rodcal._errors").and_then(|module| module.getattr("raised")?.call1(words));
    exception.map_or_else(|failed| failed, PyErr::from_value)
}

/// The exception of an argument that is not what it should be.
pub fn wrong(py: Python<'_>, name: &'static str, found: String, expected: String) -> PyErr {
    raised(py, Error::Argument { name, found, expected })
}
