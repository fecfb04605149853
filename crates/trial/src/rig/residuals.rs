//! Residuals of a real recording, from which noise is drawn.

use std::path::Path;

use rodcal_base::delimited::Table;
use rodcal_base::error::{Error, Place, Result};
use rodcal_base::files;

/// The column.
const COLUMN: &str = "residual";
/// Fewer are no sample.
const FEWEST: usize = 10;

/// The column `residual` of a table, in any unit, less its mean and over its standard deviation.
///
/// # Errors
/// [`Error::File`]; [`Error::Input`] without such a column, with fewer than ten numbers, or where
/// all are equal.
pub fn read(path: &Path) -> Result<Vec<f64>> {
    let name = path.display().to_string();
    let table = Table::parse(&name, &files::read_text(path)?, |column| column == COLUMN)?;
    if !table.has(COLUMN) {
        let found = format!("there is no column `{COLUMN}`");
        let expected = "residuals of a recording, in any unit".to_owned();
        return Err(table.header_error(COLUMN, found, expected, Some(table.columns_found())));
    }
    let numbers: Vec<f64> = table.rows().map(|row| row.required_number(COLUMN)).collect::<Result<_>>()?;
    let n = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / n.max(1.0);
    let sd = (numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n.max(1.0)).sqrt();
    if numbers.len() < FEWEST || sd == 0.0 {
        return Err(Error::Input {
            at: Place::whole_file(&name),
            found: format!("{} residuals with a standard deviation of {sd}", numbers.len()),
            expected: format!("at least {FEWEST} residuals that scatter"),
            hint: None,
        });
    }
    Ok(numbers.into_iter().map(|x| (x - mean) / sd).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn residuals_are_read_without_unit_and_what_is_no_sample_is_refused() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("r.csv");
        let read_text = |text: &str| {
            files::write_whole(&path, text.as_bytes()).unwrap();
            read(&path)
        };
        let rows: String = (0..12).map(|k| format!("{k},{}\n", 3.0 + 0.5 * f64::from(k % 2))).collect();
        let found = read_text(&format!("load,residual\n{rows}")).unwrap();
        assert!(found.iter().all(|x| (x.abs() - 1.0).abs() < 1e-12) && found.len() == 12, "{found:?}");
        let refused = read_text("load,rest\n1,2\n").unwrap_err().to_string();
        assert!(refused.contains("residual") && refused.contains("r.csv"), "{refused}");
        assert!(read_text("residual\n1\n2\n").is_err());
        assert!(read_text(&format!("residual\n{}", "4\n".repeat(12))).is_err());
        assert!(read_text("residual\n1\nx\n").unwrap_err().to_string().contains(":3"));
    }
}
