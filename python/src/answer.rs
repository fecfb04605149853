//! An answer of the library, for Python.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};
use rodcal::files::{self, Existing};
use rodcal::report::{html, text};
use serde_json::Value;

use crate::errors::IntoPython;

/// An answer: its report, its JSON, its files.
#[pyclass(frozen, module = "rodcal._rodcal")]
pub struct Answer(pub rodcal::answer::Answer);

#[pymethods]
impl Answer {
    /// The JSON that the command prints with `--json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, &self.0.whole_json())
    }

    /// The report as a piece of a page.
    fn html(&self) -> String {
        html::fragment(&self.0.report)
    }

    /// The report as the command prints it, in so many columns.
    fn text(&self, columns: usize) -> String {
        text::text_within(&self.0.report, columns)
    }

    /// What was done.
    #[getter]
    fn title(&self) -> &str {
        &self.0.report.title
    }

    /// The answer in a sentence or two.
    #[getter]
    fn headline(&self) -> &str {
        &self.0.report.headline
    }

    /// What has to be known before it is trusted.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.report.warnings.clone()
    }

    /// Exit status of the command.
    #[getter]
    fn status(&self) -> u8 {
        self.0.status
    }

    /// Names and contents of what belongs to the answer beside its report.
    #[getter]
    fn files<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        by_name(py, &self.0.files)
    }

    /// Writes page, pictures, tables, `result.json` and the answer's files into a folder.
    fn write(&self, py: Python<'_>, directory: std::path::PathBuf, is_forced: bool) -> PyResult<()> {
        let mut written = self.0.report.files().or_raise(py)?;
        written.extend(self.0.files.iter().cloned());
        written.push(("result.json".into(), format!("{:#}\n", self.0.whole_json()).into_bytes()));
        let existing = if is_forced { Existing::Replace } else { Existing::Keep };
        py.detach(|| files::write_together(&directory, &written, existing)).or_raise(py)
    }
}

/// Files as a dict of bytes.
pub fn by_name<'py>(py: Python<'py>, files: &[(String, Vec<u8>)]) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, content) in files {
        dict.set_item(name, PyBytes::new(py, content))?;
    }
    Ok(dict)
}

/// JSON as Python's own objects.
pub fn python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Null => py.None().into_bound(py),
        Value::Bool(value) => value.into_pyobject(py)?.to_owned().into_any(),
        Value::String(value) => value.into_pyobject(py)?.into_any(),
        Value::Number(value) => match (value.as_u64(), value.as_i64()) {
            (Some(value), _) => value.into_pyobject(py)?.into_any(),
            (None, Some(value)) => value.into_pyobject(py)?.into_any(),
            _ => value.as_f64().into_pyobject(py)?.into_any(),
        },
        Value::Array(values) => {
            let list = PyList::empty(py);
            for value in values {
                list.append(python(py, value)?)?;
            }
            list.into_any()
        }
        Value::Object(entries) => {
            let dict = PyDict::new(py);
            for (key, value) in entries {
                dict.set_item(key, python(py, value)?)?;
            }
            dict.into_any()
        }
    })
}
