//! What is odd about readings that can be read all the same.

use std::fmt;

use super::columns::{KNOWN_COLUMNS, OFFSET_COLUMNS, is_one_of};
use super::reading::{Axis, Reading, newtons, only_load};
use crate::delimited::{Dialect, Table, converted, nearest_name, quoted};
use crate::units::{UM, significant};

/// Offsets that are all smaller than this are hardly micrometres: no sensor of a rig resolves a
/// nanometre, m.
const SMALLEST_LIKELY: f64 = 1e-3 * UM;

/// Advice about a file that was read; its `Display` is one sentence or two for the user.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The numbers were read with decimal commas.
    DecimalCommas(Dialect),
    /// A column is not read.
    UnknownColumn {
        /// Its name as written.
        column: String,
        /// The column that it may be meant to be.
        nearest: Option<&'static str>,
    },
    /// There is one load only for an axis and a channel, and so no slope.
    OneLoad {
        /// Axis of the load.
        axis: Axis,
        /// Axis of the offsets.
        channel: Axis,
        /// The load along the positive axis, N.
        load: f64,
    },
    /// The offsets are so small that they are hardly in µm.
    TinyOffsets {
        /// The largest one in size, m.
        largest: f64,
    },
    /// Every offset is zero.
    OnlyZeros,
    /// A comment line above the header looks like a statement about the rig, but is none.
    UnknownKey {
        /// The key as written.
        key: String,
        /// The key that it may be meant to be.
        nearest: &'static str,
    },
}

/// All warnings about the `rows` that were read from `table`.
pub(super) fn all(table: &Table, rows: &[Reading]) -> Vec<Warning> {
    let dialect = table.dialect();
    let commas = (dialect.decimal_mark == ',').then_some(Warning::DecimalCommas(dialect));
    let unknown = table.columns().filter(|c| !is_one_of(c, &KNOWN_COLUMNS));
    let unknown = unknown.map(|column| Warning::UnknownColumn {
        column: column.to_owned(),
        nearest: nearest_name(column, &KNOWN_COLUMNS),
    });
    commas.into_iter().chain(unknown).chain(about_rows(rows)).collect()
}

/// Warnings about rows that may come from anywhere.
pub(super) fn about_rows(rows: &[Reading]) -> Vec<Warning> {
    let groups = Axis::ALL.into_iter().flat_map(|axis| Axis::ALL.map(|channel| (axis, channel)));
    let one_load = groups.filter_map(|(axis, channel)| {
        only_load(rows, axis, channel).map(|load| Warning::OneLoad { axis, channel, load })
    });
    one_load.chain(size(rows)).collect()
}

fn size(rows: &[Reading]) -> Option<Warning> {
    let offsets = rows.iter().flat_map(|row| row.offset).flatten();
    let largest = offsets.map(f64::abs).fold(0.0, f64::max);
    match largest {
        0.0 => Some(Warning::OnlyZeros),
        _ if largest < SMALLEST_LIKELY => Some(Warning::TinyOffsets { largest }),
        _ => None,
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::DecimalCommas(dialect) => write!(f, "{dialect}"),
            Warning::UnknownColumn { column, nearest } => {
                write!(f, "the column {} is not read; ", quoted(column))?;
                match nearest.map(|nearest| (nearest, converted(column, nearest))) {
                    Some((_, Some(converted))) => write!(f, "{converted}; ")?,
                    Some((nearest, None)) => write!(f, "did you mean {nearest}? ")?,
                    None => {}
                }
                write!(f, "known columns: {}", KNOWN_COLUMNS.join(", "))
            }
            Warning::OneLoad { axis, channel, load } => write!(
                f,
                "{} has only the load {} along {axis}: there is no slope without a second load",
                OFFSET_COLUMNS[channel.index()],
                newtons(*load)
            ),
            Warning::TinyOffsets { largest } => write!(
                f,
                "the largest offset is {} µm: the offsets look like metres or millimetres, and are read as micrometres",
                significant(largest / UM, 2)
            ),
            Warning::UnknownKey { key, nearest } => {
                write!(f, "the comment line with {} is not read; did you mean {nearest}?", quoted(key))
            }
            Warning::OnlyZeros => write!(f, "every offset is zero: was the sensor connected?"),
        }
    }
}
