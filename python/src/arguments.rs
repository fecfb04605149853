//! Values of arguments: the same that the command line takes.

use std::fmt::Display;

use pyo3::prelude::*;

use crate::errors::wrong;

/// One of several names.
pub fn choice<T: Copy>(py: Python<'_>, name: &'static str, value: &str, known: &[(&str, T)]) -> PyResult<T> {
    let found = known.iter().find(|(word, _)| *word == value);
    found.map(|(_, meant)| *meant).ok_or_else(|| {
        let words: Vec<String> = known.iter().map(|(word, _)| format!("\"{word}\"")).collect();
        wrong(py, name, format!("\"{value}\""), format!("one of {}", words.join(", ")))
    })
}

/// A number in a range, its ends included.
pub fn within<T: PartialOrd + Display + Copy>(
    py: Python<'_>,
    name: &'static str,
    value: T,
    low: T,
    high: T,
) -> PyResult<T> {
    match value >= low && value <= high {
        true => Ok(value),
        false => Err(wrong(py, name, value.to_string(), format!("a number from {low} to {high}"))),
    }
}

/// A number above zero.
pub fn positive(py: Python<'_>, name: &'static str, value: f64) -> PyResult<f64> {
    match value > 0.0 && value <= 1e6 {
        true => Ok(value),
        false => {
            let expected = "a number above 0 and up to 1000000";
            Err(wrong(py, name, value.to_string(), expected.into()))
        }
    }
}

/// A number that is one.
pub fn finite(py: Python<'_>, name: &'static str, value: f64) -> PyResult<f64> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(wrong(py, name, value.to_string(), "a finite number".into())),
    }
}
