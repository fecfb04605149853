//! Lengths for people.

use crate::units::{MM, UM, significant};

/// In µm below a millimetre, else in mm.
pub(super) fn length(metres: f64) -> String {
    match metres < MM {
        true => format!("{} µm", significant(metres / UM, 3)),
        false => format!("{} mm", significant(metres / MM, 3)),
    }
}
