//! Readings of a stiffness rig: which load, along which axis of {T}, gave which offsets.
//!
//! A CSV file with one reading per row; its columns and their units are those of [`KNOWN_COLUMNS`].
//! Offsets are differences from the unloaded, zeroed rod.

mod columns;
mod header;
mod instant;
mod reading;
#[cfg(test)]
mod tests;
mod warning;
mod write;

use std::collections::HashSet;
use std::path::Path;

use crate::delimited::{Row, Table, meant_to_be, nearest_name, renamed};
use crate::error::{Error, Place, Result};
use crate::files;
use crate::limits;
use crate::units::{ABSOLUTE_ZERO_C, MM, STANDARD_GRAVITY, UM};
use columns::{LOAD_COLUMNS, OFFSET_COLUMNS, TEXT_COLUMNS, is_one_of};
use reading::{loads_of, newtons, only_load};

pub use columns::{KNOWN_COLUMNS, LoadColumn};
pub use header::{Driven, RigHeader};
pub use instant::Instant;
pub(crate) use instant::instants;
pub use reading::{Axis, Direction, Phase, Reading};
pub use warning::Warning;

/// The readings of one file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Readings {
    /// The file as the user named it.
    pub file: String,
    /// Where the readings come from: the comment lines above the header, joined, but for those
    /// that `header` was read from.
    pub source: Option<String>,
    /// What the comment lines above the header say of the rig.
    pub header: RigHeader,
    /// The column that the loads stand in.
    pub load_column: LoadColumn,
    /// The readings in the order of the file; at least one (axis, channel) has two different loads.
    pub rows: Vec<Reading>,
    /// What a user should know about the file although it can be read.
    pub warnings: Vec<Warning>,
}

impl Readings {
    /// Reads a file of readings: loads in N, offsets in m, whatever units its columns have.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let readings = Readings::read("stiffness_data/5.csv".as_ref())?;
    /// let largest = readings.rows.iter().map(|row| row.load).fold(0.0, f64::max);
    /// assert_eq!(readings.rows.len(), 40);
    /// assert!((largest - 2.0 * 9.80665).abs() < 1e-12, "{largest}"); // 2 kg
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`] where it cannot be read, else as [`Readings::from_text`].
    pub fn read(path: &Path) -> Result<Readings> {
        let file = path.display().to_string();
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let is_workbook = extension.is_some_and(|e| ["xlsx", "xlsm", "xls", "ods"].contains(&e.as_str()));
        match files::read_text(path) {
            // a workbook is not UTF-8, which is true but of no help
            Err(Error::Input { .. }) if is_workbook => Err(Error::Input {
                at: Place::whole_file(&file),
                found: "this is an Excel workbook".into(),
                expected: "CSV text".into(),
                hint: Some("export it as CSV (in Excel: \"CSV UTF-8\")".into()),
            }),
            text => Readings::from_text(&file, &text?),
        }
    }

    /// Readings that were taken, or computed, by the caller.
    ///
    /// A rod of 45 µm/N, with 1 N of friction:
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let row = |load: f64| {
    ///     Reading::new(Direction::along(Axis::Y), load).with_offset(Axis::Y, 45e-6 * (load - 1.0))
    /// };
    /// let readings = Readings::from_rows([5.0, 10.0, 15.0].map(row).to_vec())?;
    /// let fit = rig::fit(&readings, None, &rig::Options::default())?;
    /// assert!((fit.lines[0].slope.value - 45e-6).abs() < 1e-15);
    /// assert!((fit.lines[0].load_offset.map_or(0.0, |load| load.value) - 1.0).abs() < 1e-9);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] for a row without an offset, for a load or a station that is negative
    /// and for numbers that are not finite; [`Error::Input`] where no axis has two different loads,
    /// since a slope cannot be found from one.
    pub fn from_rows(mut rows: Vec<Reading>) -> Result<Readings> {
        const FILE: &str = "readings";
        for (row, number) in rows.iter_mut().zip(1..) {
            row.line = number;
            check_numbers(row)?;
        }
        check_loads(FILE, &rows)?;
        Ok(Readings {
            file: FILE.into(),
            source: None,
            header: RigHeader::default(),
            load_column: LoadColumn::Newtons,
            warnings: warning::about_rows(&rows),
            rows,
        })
    }

    /// With what is known of the rig.
    ///
    /// # Errors
    /// [`Error::Argument`] for a noise or a scale that is negative or not finite.
    pub fn with_header(self, header: RigHeader) -> Result<Readings> {
        header.check()?;
        Ok(Readings { header, ..self })
    }

    /// Reads `text`, the contents of `file`.
    ///
    /// ```
    /// use rodcal::rig::readings::Readings;
    ///
    /// let readings = Readings::from_text("rig.csv", "axis,load_kg,dz_um\n-z,1,-40\n-z,2,-80\n")?;
    /// assert_eq!(readings.rows[0].signed_load(), -9.80665); // a kilogram under standard gravity
    /// assert!(readings.rows[1].offset[2].is_some_and(|dz| (dz + 80e-6).abs() < 1e-18));
    ///
    /// let error = Readings::from_text("rig.csv", "axis,load_kg,dz_um\nz,1,4O\n").unwrap_err();
    /// assert!(error.to_string().starts_with("rig.csv:2:5"), "{error}");
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] with line and column: what [`Table::parse`] refuses; `load_n` and `load_kg`
    /// both or neither, no `axis`, no offset; a cell that is not what its column holds; a row
    /// without any offset; a line above the header whose value is none of its key's; and a file in
    /// which no axis has two different loads, since a slope cannot be found from one.
    pub fn from_text(file: &str, text: &str) -> Result<Readings> {
        let table = Table::parse(file, text, |column| {
            is_one_of(column, &KNOWN_COLUMNS) && !is_one_of(column, &TEXT_COLUMNS)
        })?;
        check_columns(&table)?;
        limits::check(file, table.rows().count(), limits::READINGS, "readings")?;
        let rows = table.rows().map(read_row).collect::<Result<Vec<_>>>()?;
        limits::check(
            file,
            line_count(&rows),
            limits::RIG_LINES,
            "lines of different channels and stations",
        )?;
        let sessions: HashSet<&str> = rows.iter().filter_map(|row| row.session.as_deref()).collect();
        limits::check(file, sessions.len(), limits::SESSIONS, "sessions")?;
        check_loads(file, &rows)?;
        let (header, source, misspelt) = header::read(file, text, table.dialect())?;
        let mut warnings = warning::all(&table, &rows);
        warnings.extend(misspelt);
        let load_column = if table.has("load_kg") { LoadColumn::Kilograms } else { LoadColumn::Newtons };
        Ok(Readings { file: file.to_owned(), source, header, load_column, warnings, rows })
    }
}

/// Lines of channel, direction and stations.
fn line_count(rows: &[Reading]) -> usize {
    let bits = |station: Option<f64>| station.map(f64::to_bits);
    let lines = rows.iter().flat_map(|row| {
        let channels = Axis::ALL.into_iter().filter(|channel| row.offset[channel.index()].is_some());
        channels.map(|channel| (row.direction, channel, bits(row.load_station), bits(row.read_station)))
    });
    lines.collect::<HashSet<_>>().len()
}

/// What a cell of a file cannot be, a row of a program cannot either.
fn check_numbers(row: &Reading) -> Result<()> {
    let wrong = |name, found: String, expected: &str| {
        let found = format!("{found} in row {}", row.line);
        Err(Error::Argument { name, found, expected: expected.to_owned() })
    };
    for (name, value) in
        [("load", Some(row.load)), ("load_station", row.load_station), ("read_station", row.read_station)]
    {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value >= 0.0)) {
            return wrong(name, value.to_string(), "a number >= 0, in SI units");
        }
    }
    if let (Some(time), Some(loaded_at)) = (row.time, row.loaded_at)
        && loaded_at > time
    {
        return wrong("loaded_at", loaded_at.to_string(), "at most the time of the reading");
    }
    let others = [row.time, row.temperature, row.loaded_at].into_iter().chain(row.offset).flatten();
    if let Some(value) = others.into_iter().find(|value| !value.is_finite()) {
        return wrong("row", value.to_string(), "finite numbers");
    }
    match row.offset.iter().all(Option::is_none) {
        true => wrong("offset", "missing".into(), "an offset along x, y or z"),
        false => Ok(()),
    }
}

fn check_columns(table: &Table) -> Result<()> {
    let missing = |what: &str, expected: &str, wanted: &[&str]| {
        let meant = table.columns().find_map(|column| Some((column, nearest_name(column, wanted)?)));
        let hint = meant.map(|(column, known)| meant_to_be(column, known));
        let hint = renamed(table.columns(), &KNOWN_COLUMNS, wanted).or(hint);
        let hint = hint.or_else(|| Some(table.columns_found()));
        Err(table.header_error("", format!("there is no {what}"), expected.into(), hint))
    };
    if !table.has("axis") {
        return missing("column axis", "the direction of each load, such as x or -z", &["axis"]);
    }
    match LOAD_COLUMNS.map(|column| table.has(column)) {
        [true, true] => {
            return Err(table.header_error(
                "load_kg",
                "the load is given twice, in load_n and in load_kg".into(),
                "one of the two".into(),
                Some("delete the column that was computed from the other".into()),
            ));
        }
        [false, false] => {
            return missing("load", "a column load_n (newtons) or load_kg (kilograms)", &LOAD_COLUMNS);
        }
        _ => {}
    }
    if !OFFSET_COLUMNS.iter().any(|column| table.has(column)) {
        return missing("offset", "a column dx_um, dy_um or dz_um (micrometres)", &OFFSET_COLUMNS);
    }
    Ok(())
}

fn read_row(row: Row<'_>) -> Result<Reading> {
    let direction = read_direction(row)?;
    let time = row.number("time_s")?;
    Ok(Reading {
        direction,
        load: read_load(row, direction)?,
        offset: read_offset(row)?,
        trial: row.text("trial").map(str::to_owned),
        phase: read_phase(row)?,
        time,
        temperature: at_least(row, "temperature_c", ABSOLUTE_ZERO_C)?,
        load_station: at_least(row, "load_station_mm", 0.0)?.map(|mm| mm * MM),
        read_station: at_least(row, "read_station_mm", 0.0)?.map(|mm| mm * MM),
        session: row.text("session").map(str::to_owned),
        loaded_at: read_loaded_at(row, time)?,
        line: row.line(),
    })
}

fn read_loaded_at(row: Row<'_>, time: Option<f64>) -> Result<Option<f64>> {
    let loaded_at = row.number("loaded_at_s")?;
    if let (Some(loaded_at), Some(time)) = (loaded_at, time)
        && loaded_at > time
    {
        let expected = format!("at most time_s, {time}: the load hangs when it is read");
        return Err(row.error("loaded_at_s", expected, None));
    }
    Ok(loaded_at)
}

fn read_direction(row: Row<'_>) -> Result<Direction> {
    row.text("axis").and_then(Direction::from_name).ok_or_else(|| {
        row.error(
            "axis",
            "x, y, z, -x, -y or -z".into(),
            Some("it is the direction of the load in {T}".into()),
        )
    })
}

fn read_load(row: Row<'_>, direction: Direction) -> Result<f64> {
    let is_mass = row.table().has("load_kg");
    let (column, newtons) = if is_mass { ("load_kg", STANDARD_GRAVITY) } else { ("load_n", 1.0) };
    let load = row.required_number(column)?;
    if load < 0.0 {
        let opposite = Direction { sign: -direction.sign, ..direction };
        return Err(row.error(
            column,
            "a magnitude ≥ 0".into(),
            Some(format!("write the direction into the column axis: {opposite} and {}", -load)),
        ));
    }
    Ok(load * newtons)
}

fn read_offset(row: Row<'_>) -> Result<[Option<f64>; 3]> {
    let mut offset = [None; 3];
    for (column, value) in OFFSET_COLUMNS.into_iter().zip(&mut offset) {
        *value = row.number(column)?.map(|um| um * UM);
    }
    if offset.iter().all(Option::is_none) {
        return Err(row.row_error(
            "the row has a load but no offset".into(),
            "a number in dx_um, dy_um or dz_um".into(),
            Some("delete the row, or put a # before it".into()),
        ));
    }
    Ok(offset)
}

fn read_phase(row: Row<'_>) -> Result<Option<Phase>> {
    match row.text("phase").map(str::to_ascii_lowercase).as_deref() {
        None => Ok(None),
        Some("load") => Ok(Some(Phase::Load)),
        Some("unload") => Ok(Some(Phase::Unload)),
        Some(_) => Err(row.error("phase", "load, unload or a blank".into(), None)),
    }
}

fn at_least(row: Row<'_>, column: &str, least: f64) -> Result<Option<f64>> {
    match row.number(column)? {
        Some(value) if value < least => Err(row.error(column, format!("a number ≥ {least}"), None)),
        value => Ok(value),
    }
}

fn check_loads(file: &str, rows: &[Reading]) -> Result<()> {
    let has_slope = |axis, channel| {
        loads_of(rows, axis, channel).next().is_some() && only_load(rows, axis, channel).is_none()
    };
    if Axis::ALL.into_iter().any(|axis| Axis::ALL.into_iter().any(|channel| has_slope(axis, channel))) {
        return Ok(());
    }
    let found = match rows {
        [] => "there are no readings under the header".into(),
        [_] => "there is one reading only".into(),
        [first, ..] => {
            let load = |r: &Reading| format!("{} along {}", newtons(r.load), r.direction);
            let mut loads: Vec<String> = rows.iter().map(load).collect();
            loads.dedup();
            match loads.as_slice() {
                [_] => format!("every load is {}", load(first)),
                _ => "no offset was read under two different loads along one axis".into(),
            }
        }
    };
    Err(Error::Input {
        at: Place { line: rows.first().map_or(0, |r| r.line), ..Place::whole_file(file) },
        found,
        expected: "at least two different loads along an axis: a line needs two points".into(),
        hint: None,
    })
}
