//! An answer of the library, for Python.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};
use rodcal::delimited;
use rodcal::files::{self, Existing};
use rodcal::report::{Report, html, text};
use serde_json::Value;

use crate::errors::IntoPython;

/// An answer: its report, its JSON, its files.
#[pyclass(frozen, module = "rodcal._rodcal")]
pub struct Answer(pub rodcal::answer::Answer);

#[pymethods]
impl Answer {
    /// An answer that was pickled.
    #[staticmethod]
    fn restored(report: &[u8], json: &[u8], files: Vec<(String, Vec<u8>)>, status: u8) -> PyResult<Answer> {
        let wrong = |error: &dyn std::fmt::Display| PyValueError::new_err(error.to_string());
        let report: Report = rmp_serde::from_slice(report).map_err(|error| wrong(&error))?;
        let json = rmp_serde::from_slice(json).map_err(|error| wrong(&error))?;
        let mut answer = rodcal::answer::Answer::new(json, report);
        (answer.files, answer.status) = (files, status);
        Ok(Answer(answer))
    }

    /// Pickled to the last bit: the text of a number may be read as its neighbour, and JSON has no
    /// words for numbers that are not finite.
    #[allow(clippy::type_complexity)]
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(
        Bound<'py, PyAny>,
        (Bound<'py, PyBytes>, Bound<'py, PyBytes>, Vec<(String, Bound<'py, PyBytes>)>, u8),
    )> {
        let own = &self.0;
        let wrong = |error: rmp_serde::encode::Error| PyValueError::new_err(error.to_string());
        let report = rmp_serde::to_vec(&own.report).map_err(wrong)?;
        let json = rmp_serde::to_vec(&own.whole_json()).map_err(wrong)?;
        let files = own.files.iter().map(|(name, content)| (name.clone(), PyBytes::new(py, content)));
        let parts = (PyBytes::new(py, &report), PyBytes::new(py, &json), files.collect(), own.status);
        Ok((py.get_type::<Answer>().getattr("restored")?, parts))
    }

    /// The JSON that the command prints with `--json`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, &self.0.whole_json())
    }

    /// The report as a piece of a page.
    fn html(&self) -> String {
        delimited::visible_lines(&html::fragment(&self.0.report)).into_owned()
    }

    /// The report as the command prints it, in so many columns.
    fn text(&self, columns: usize) -> String {
        delimited::visible_lines(&text::text_within(&self.0.report, columns)).into_owned()
    }

    /// What was done.
    #[getter]
    fn title(&self) -> String {
        delimited::visible(&self.0.report.title).into_owned()
    }

    /// The answer in a sentence or two.
    #[getter]
    fn headline(&self) -> String {
        delimited::visible(&self.0.report.headline).into_owned()
    }

    /// What has to be known before it is trusted.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.report.warnings.iter().map(|warning| delimited::visible(warning).into_owned()).collect()
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
        let mut json = self.0.json.clone();
        json["warnings"] = self.0.report.warnings.as_slice().into();
        let mut result = Vec::new();
        rodcal::answer::write_json(&json, self.0.long.as_ref(), &mut result)?;
        written.push(("result.json".into(), result));
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
