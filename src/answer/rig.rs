//! How much does a rod really bend?

use super::Answer;
use crate::diagnosis::Suspicion;
use crate::diagnosis::rig::suspected;
use crate::error::Result;
use crate::report;
use crate::rig::{self, Options, readings::Readings};
use crate::rod::Rod;

/// Lines through readings, r and the measured compliance of `rod`; without one, lines alone.
///
/// ```
/// use rodcal::answer::rig_fit;
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let readings = Readings::read("stiffness_data/5.csv".as_ref())?;
/// let answer = rig_fit(&readings, Some(&rod), &rig::Options::default())?;
/// let r_rod = answer.json["r_rod"].as_f64().unwrap_or(0.0);
/// assert!((r_rod - 1.013).abs() < 0.005, "{r_rod}"); // the paper's Table 2
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`rig::fit`].
pub fn rig_fit(readings: &Readings, rod: Option<&Rod>, options: &Options) -> Result<Answer> {
    let fit = rig::fit(readings, rod, options)?;
    let mut report = report::rig::report(&fit, readings, rod);
    let suspicions = suspected(readings, rod)?;
    // nothing that follows is worth more than what it is made of
    if let Some(worst) = suspicions.first() {
        report.headline = format!("Most likely a mistake: {worst}. {}", report.headline);
    }
    let line = |suspicion: &Suspicion| format!("{suspicion}; `rodcal diagnose rig` says more.");
    report.warnings.extend(suspicions.iter().map(line));
    Ok(Answer::new(report::rig::json(&fit, readings, rod), report))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is made of kilograms is not said before the kilograms are.
    #[test]
    fn a_likely_mistake_stands_before_the_numbers() {
        let file = |name: &str| std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        let rod = Rod::read(&file("rods/5.toml")).unwrap();
        let text = std::fs::read_to_string(file("stiffness_data/5.csv")).unwrap();
        let headline = |text: &str| {
            let readings = Readings::from_text("5.csv", text).unwrap();
            rig_fit(&readings, Some(&rod), &Options::default()).unwrap().report.headline
        };
        assert!(headline(&text).starts_with("Rod 5# is 1.5 % softer"), "{}", headline(&text));
        let wrong = headline(&text.replace("load_kg", "load_n"));
        assert!(wrong.starts_with("Most likely a mistake: load_n looks like kilograms"), "{wrong}");
        assert!(!wrong.contains('`') && !wrong.contains(".."), "{wrong}");
    }
}
