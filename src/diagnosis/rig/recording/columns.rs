//! Columns and rows of a file of readings, by the names that they have there.

use super::datum::Datum;
use crate::inference::Key;
use crate::rig::readings::LoadColumn;
use crate::spatial::Axis;
use crate::units::STANDARD_GRAVITY;

/// `dy_um`.
pub fn column(channel: Axis) -> String {
    format!("d{channel}_um")
}

/// `dx_um, dz_um`.
pub fn columns(channels: &[Axis]) -> String {
    let names: Vec<String> = channels.iter().map(|channel| column(*channel)).collect();
    names.join(", ")
}

/// `load_n` or `load_kg`.
pub fn load_column(column: LoadColumn) -> &'static str {
    match column {
        LoadColumn::Newtons => "load_n",
        LoadColumn::Kilograms => "load_kg",
    }
}

/// Newtons of one of what stands in that column, and its symbol.
pub fn unit_of_loads(column: LoadColumn) -> (f64, &'static str) {
    match column {
        LoadColumn::Newtons => (1.0, "N"),
        LoadColumn::Kilograms => (STANDARD_GRAVITY, "kg"),
    }
}

/// A number as it stands in a file: without what conversions leave in the last digits.
pub fn number_in_file(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
}

/// `axis y`.
pub fn axis_rows(axis: Axis) -> String {
    format!("axis {axis}")
}

/// `rows 7 to 12`.
pub fn rows_between(first: usize, last: usize) -> String {
    format!("rows {first} to {last}")
}

/// The rows that some data stand in: `rows 7 to 12`.
pub fn rows_of<'a>(data: impl Iterator<Item = &'a Datum>) -> String {
    let (first, last) =
        data.fold((usize::MAX, 0), |(low, high), datum| (low.min(datum.row), high.max(datum.row)));
    rows_between(first, last)
}

/// `3`, `3 of session monday`; `None` where trials have no names.
pub fn trial_name(datum: &Datum) -> Option<String> {
    let trial = datum.trial.as_ref()?;
    Some(match &datum.session {
        Some(session) => format!("{trial} of session {session}"),
        None => trial.clone(),
    })
}

/// The readings of one sensor in one run, from the first to the last datum: `dy_um, axis y, trial
/// 2`.
pub fn sensor_in_run(first: &Datum, last: &Datum) -> Key {
    let key = Key::new(column(first.channel)).rows(axis_rows(first.direction.axis));
    match &first.trial {
        Some(trial) if !first.has_other_direction => key.rows(format!("trial {trial}")),
        _ => key.rows(rows_between(first.row, last.row)),
    }
}
