//! Writes readings as a file, such that reading it gives the same readings.

use super::{Axis, Phase, Reading, Readings};
use crate::delimited::cell;
use crate::toml_text::{comments, in_unit};
use crate::units::{MM, UM};

/// A column: its name, and what a row has of it.
type Column<'a> = (&'a str, &'a dyn Fn(&Reading) -> Option<String>);

impl Readings {
    /// These readings as a table, the format of [`Readings::from_text`], below `above`, lines of
    /// comments, and what the header says of the rig where it is not the default. Loads are in N;
    /// columns that no row fills are left out, and so are rows without an offset.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let row = |load| Reading::new(Direction::along(Axis::Z), load).with_offset(Axis::Z, 4e-6 * load);
    /// let readings = Readings::from_rows(vec![row(1.0), row(2.0)])?;
    /// let text = readings.to_csv(&["made by hand".to_owned()]);
    /// assert_eq!(text, "# made by hand\naxis,load_n,dz_um\nz,1,4\nz,2,8\n");
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn to_csv(&self, above: &[String]) -> String {
        let offset =
            |axis: Axis| move |row: &Reading| row.offset[axis.index()].map(|o| format!("{}", in_unit(o, UM)));
        let (dx, dy, dz) = (offset(Axis::X), offset(Axis::Y), offset(Axis::Z));
        let columns: [Column<'_>; 13] = [
            ("axis", &|row| Some(row.direction.to_string())),
            ("load_n", &|row| Some(row.load.to_string())),
            ("trial", &|row| row.trial.as_deref().map(cell)),
            ("phase", &|row| {
                row.phase.map(|phase| if phase == Phase::Load { "load" } else { "unload" }.to_owned())
            }),
            ("time_s", &|row| row.time.map(|t| t.to_string())),
            ("temperature_c", &|row| row.temperature.map(|t| t.to_string())),
            ("session", &|row| row.session.as_deref().map(cell)),
            ("loaded_at_s", &|row| row.loaded_at.map(|t| t.to_string())),
            ("load_station_mm", &|row| row.load_station.map(|s| in_unit(s, MM).to_string())),
            ("read_station_mm", &|row| row.read_station.map(|s| in_unit(s, MM).to_string())),
            ("dx_um", &dx),
            ("dy_um", &dy),
            ("dz_um", &dz),
        ];
        let is_filled = |(_, cell_of): &Column<'_>| self.rows.iter().any(|row| cell_of(row).is_some());
        let filled: Vec<Column<'_>> = columns.into_iter().filter(is_filled).collect();
        let mut text = comments(above) + &comments(&self.header.lines());
        let line = |cells: Vec<String>| cells.join(",") + "\n";
        text += &line(filled.iter().map(|(name, _)| (*name).to_owned()).collect());
        for row in self.rows.iter().filter(|row| row.offset.iter().any(Option::is_some)) {
            text += &line(filled.iter().map(|(_, cell_of)| cell_of(row).unwrap_or_default()).collect());
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_that_are_written_are_read_as_the_same() {
        let text = "axis,load_kg,trial,phase,time_s,load_station_mm,dx_um,dz_um,session,loaded_at_s\n\
                    y,0.5,\"a, b\",load,0,,1.25,,\"1, am\",-2.5\n-z,1,2,,60,205.3,,-3,2,\n\
                    y,2,2,unload,61.5,,7,8,2,0\n";
        let mut readings = Readings::from_text("f", text).unwrap();
        let written = readings.to_csv(&["made by hand".into()]);
        assert!(written.starts_with("# made by hand\naxis,load_n,"), "{written}");
        assert!(!written.contains("dy_um") && !written.contains("temperature"));
        let mut again = Readings::from_text("f", &written).unwrap();
        for rows in [&mut readings.rows, &mut again.rows] {
            rows.iter_mut().for_each(|row| row.line = 0);
        }
        assert_eq!(again.rows, readings.rows);
    }
}
