//! What is odd about a campaign that can be read all the same.

use std::fmt;

use crate::delimited::{Dialect, quoted};
use crate::robot::Motion;
use crate::units::{DEG, MM, significant};

/// Advice about files that were read; its `Display` is one sentence or two for the user.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// Something is odd about the rod's file.
    Rod {
        /// The file.
        file: String,
        /// What is odd.
        warning: crate::rod::Warning,
    },
    /// The numbers of a file were read with decimal commas.
    DecimalCommas {
        /// The file.
        file: String,
        /// Separator and decimal mark.
        dialect: Dialect,
    },
    /// A column is not read.
    UnusedColumn {
        /// The file.
        file: String,
        /// The column's name as written.
        column: String,
        /// The column that it may be meant to be.
        nearest: Option<String>,
    },
    /// No angle of a file is larger than 2π, read as degrees.
    AnglesInRadians {
        /// The file.
        file: String,
        /// The largest angle in size, as written.
        largest: f64,
    },
    /// A joint is beyond its limits.
    OutsideLimits {
        /// The file.
        file: String,
        /// Index of the joint.
        joint: usize,
        /// What the joint does, which makes the unit.
        motion: Motion,
        /// Its limits, rad or m.
        limits: [f64; 2],
        /// In how many rows it is beyond them.
        count: usize,
        /// The first such pose.
        pose: String,
        /// Its line.
        line: usize,
        /// The joint's value there, rad or m.
        value: f64,
    },
    /// A joint hardly moves in all the measurements.
    StillJoint {
        /// The file.
        file: String,
        /// Index of the joint.
        joint: usize,
        /// What the joint does.
        motion: Motion,
        /// Between its smallest and its largest value, rad or m.
        range: f64,
    },
    /// The positions spread far less or far more than the nominal robot's.
    OtherSize {
        /// The file.
        file: String,
        /// Root mean square distance of the positions from their mean, m.
        measured: f64,
        /// The same of the nominal robot's tip, m.
        nominal: f64,
    },
    /// Poses that the robot is judged by are also those that it is calibrated with.
    NotIndependent {
        /// Validation rows that are calibrated with too.
        count: usize,
        /// All validation rows.
        rows: usize,
        /// Name of the first such pose.
        pose: String,
    },
    /// A clamp that no row names.
    UnusedClamp {
        /// Its id.
        id: String,
    },
    /// No placement of a recording has both a socket 0 and a socket 1.
    NoDistance {
        /// The file.
        file: String,
    },
    /// A rod and clamps, but no contact force: gravity alone bends the rod.
    NoContactForce,
    /// A contact force, but no rod that it could bend.
    ContactForceWithoutRod,
    /// A contact force, but no clamp in whose frame it could be given.
    ContactForceWithoutClamp,
    /// With sockets there is no base and tool to fit again.
    RefitWithSockets,
    /// Links are named, but the robot is not a URDF.
    LinksWithoutUrdf,
}

/// A joint's value for a message.
fn shown(value: f64, motion: Motion) -> String {
    let (unit, symbol) = match motion {
        Motion::Revolute => (DEG, "°"),
        Motion::Prismatic => (MM, " mm"),
    };
    format!("{}{symbol}", (value / unit * 1e3).round() / 1e3)
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::DecimalCommas { file, dialect } => write!(f, "{file}: {dialect}"),
            Warning::UnusedColumn { file, column, nearest } => {
                write!(f, "{file}: the column {} is not read", quoted(column))?;
                match nearest {
                    Some(nearest) => write!(f, "; did you mean {nearest}?"),
                    None => Ok(()),
                }
            }
            Warning::AnglesInRadians { file, largest } => write!(
                f,
                "{file}: no angle is larger than {}: the angles look like radians, and are read as degrees",
                significant(*largest, 3)
            ),
            Warning::OutsideLimits {
                file,
                joint,
                motion,
                limits: [least, most],
                count,
                pose,
                line,
                value,
            } => {
                let [value, least, most] = [value, least, most].map(|q| shown(*q, *motion));
                let rows = if *count == 1 { "row" } else { "rows" };
                write!(
                    f,
                    "{file}: joint {} is beyond its limits {least} to {most} in {count} {rows}, \
                     first in pose {pose} (line {line}, {value}): is it the same robot?",
                    joint + 1
                )
            }
            Warning::StillJoint { file, joint, motion, range } => {
                let (number, range) = (joint + 1, shown(*range, *motion));
                let suffering = match motion {
                    Motion::Revolute => format!("theta{number} and c{number}"),
                    Motion::Prismatic => format!("d{number}"),
                };
                write!(
                    f,
                    "{file}: joint {number} moves by {range} in all: {suffering} can hardly be \
                     distinguished from their neighbours; add poses in which it moves"
                )
            }
            Warning::OtherSize { file, measured, nominal } => write!(
                f,
                "{file}: the positions spread over {:.3} mm, those of the nominal robot over {:.3} mm: \
                 are they in millimetres?",
                measured / MM,
                nominal / MM
            ),
            Warning::NotIndependent { count, rows, pose } => write!(
                f,
                "{count} of {rows} validation poses are measurement poses too (pose {pose} first): \
                 the validation is not independent"
            ),
            Warning::Rod { file, warning } => write!(f, "{file}: {warning}"),
            Warning::UnusedClamp { id } => write!(f, "no row was measured in clamp {id}"),
            Warning::NoDistance { file } => write!(
                f,
                "{file}: no placement has a socket 0 and a socket 1, and so distance_mm is not used: \
                 nothing fixes the scale of the robot"
            ),
            Warning::NoContactForce => write!(
                f,
                "there is a rod and there are clamps, but no contact_force_n: the rod bends under gravity only"
            ),
            Warning::ContactForceWithoutRod => {
                write!(f, "there is a contact_force_n, but no rod for it to bend")
            }
            Warning::ContactForceWithoutClamp => {
                write!(f, "there is a contact_force_n, but no clamp: its components are read as along {{W}}")
            }
            Warning::RefitWithSockets => write!(
                f,
                "validation_refit = \"base-tool\" has no effect with sockets: only their points are fitted again"
            ),
            Warning::LinksWithoutUrdf => {
                write!(f, "base_link and tip_link are for a URDF: they have no effect with this robot's file")
            }
        }
    }
}
