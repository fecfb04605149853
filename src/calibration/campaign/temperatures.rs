//! What was read of the temperature, as it was.

use super::Recording;
use crate::statistics::{one_clock, unrounded};

impl Recording {
    /// The temperature of each row, °C, between the steps of the display that it was read from
    /// ([`unrounded`]); `None` where a row has none.
    pub fn temperatures(&self) -> Option<Vec<f64>> {
        let shown = self.rows.iter().map(|row| row.temperature).collect::<Option<Vec<f64>>>()?;
        let times: Vec<Option<f64>> = self.rows.iter().map(|row| row.time).collect();
        let places: Vec<f64> = (0..self.rows.len()).map(|row| row as f64).collect();
        Some(unrounded(&shown, &one_clock(&times, &places)))
    }
}
