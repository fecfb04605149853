//! Lengths as they are said.

use crate::units::{MM, UM, significant};

/// A length with its unit: µm below a millimetre, else mm.
pub fn size(length: f64) -> String {
    match length.abs() < MM {
        true => format!("{} µm", um(length)),
        false => format!("{} mm", significant(length / MM, 3)),
    }
}

/// A length in µm with as many digits as are read.
pub fn um(length: f64) -> String {
    significant(length / UM, if length.abs() < 0.995e-4 { 2 } else { 3 })
}
