//! `rodcal` without arguments: the whole main job on embedded data.

use std::path::PathBuf;

use rodcal::beam::Physics;
use rodcal::calibration::{self, Campaign, CompareOptions};
use rodcal::compliance::{DEFAULT_ELEMENTS, Mode, Study, paper_contact_force};
use rodcal::report::text::wrapped;
use rodcal::report::{self, Report};
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal::{Error, Result, rig};
use serde_json::{Value, json};

use super::embedded::{CAMPAIGN, CAMPAIGN_FILE, LOAD_CELL, LOAD_CELL_FILE, RODS, named_by_the_campaign};
use super::output::Outcome;

/// What the numbers of the demo are worth.
const RECONSTRUCTED: &str = "Rods 2# and 5# and their readings are reconstructed from the figures of the Improved \
     MultiCal paper (Sensors 2023, 23(12), 5717); the load cell's readings are real; the TX90's campaign is simulated.";

/// Enough to show what a comparison looks like within a blink; `rodcal compare` takes more.
const DRAWS: usize = 20;

/// Where its report goes unless somebody says otherwise.
pub const DIRECTORY: &str = "reports/demo";

pub fn run() -> Result<Outcome> {
    let mut report = Report { title: "rodcal demo".into(), ..Report::default() };
    let (mut results, mut words, mut headlines) = (Vec::new(), String::new(), Vec::new());
    for example in &RODS {
        let rod = Rod::from_toml(example.rod_file, example.rod)?;
        let readings = Readings::from_text(example.readings_file, example.readings)?;
        let fit = rig::fit(&readings, Some(&rod), &rig::Options::default())?;
        let study =
            Study::new(rod.clone(), Mode::Fea, Physics::default(), DEFAULT_ELEMENTS, paper_contact_force())?;
        let rod_report = report::compliance::report(&study);
        let rig_report = report::rig::report(&fit, &readings, Some(&rod));
        words += &wrapped(&format!("{} {}", rod_report.headline, rig_report.headline));
        words.push('\n');
        headlines.push(rig_report.headline.clone());
        results.push(json!({
            "compliance": report::compliance::json(&study),
            "rig": report::rig::json(&fit, &readings, Some(&rod)),
        }));
        for part in [rod_report, rig_report] {
            let warnings = part.warnings.into_iter().map(|warning| format!("rod {}: {warning}", rod.name));
            report.warnings.extend(warnings);
            report.sections.extend(part.sections);
        }
        report.provenance.push(("rod file".into(), example.rod_file.into()));
        report.provenance.push(("readings".into(), format!("{} (reconstructed)", example.readings_file)));
    }

    let readings = Readings::from_text(LOAD_CELL_FILE, LOAD_CELL)?;
    let fit = rig::fit(&readings, None, &rig::Options::default())?;
    let cell_report = report::rig::report(&fit, &readings, None);
    words += &wrapped(&format!("Load cell (NIST): {}", cell_report.headline));
    report.warnings.insert(0, RECONSTRUCTED.into());
    report.warnings.extend(cell_report.warnings.into_iter().map(|warning| format!("load cell: {warning}")));
    report.sections.extend(cell_report.sections);
    report.provenance.push(("readings".into(), format!("{LOAD_CELL_FILE} (NIST StRD, Pontius)")));

    let (robot_report, calibrated, compared) = robot()?;
    words += &format!("\n{}", wrapped(&robot_report.headline));
    words += &format!("\n{}", wrapped(RECONSTRUCTED));
    headlines.push(robot_report.headline);
    report.warnings.extend(robot_report.warnings.into_iter().map(|warning| format!("TX90: {warning}")));
    report.sections.extend(robot_report.sections);
    report.provenance.push(("campaign".into(), format!("{CAMPAIGN_FILE} (simulated)")));
    report.provenance.push(("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()));

    report.headline = headlines.join(" ");
    Ok(Outcome {
        json: json!({
            "rods": results,
            "load_cell": report::rig::json(&fit, &readings, None),
            "calibration": calibrated,
            "comparison": compared,
        }),
        report: Some(report),
        text: Some(words),
        default_directory: Some(PathBuf::from(DIRECTORY)),
        files: Vec::new(),
        status: 0,
    })
}

/// The campaign inside the program, calibrated in its default mode, and all modes compared: report
/// and both JSONs.
fn robot() -> Result<(Report, Value, Value)> {
    let open = |name: &str| {
        named_by_the_campaign(name).map(str::to_owned).ok_or_else(|| Error::File {
            path: name.into(),
            action: "read",
            source: std::io::ErrorKind::NotFound.into(),
        })
    };
    let campaign = Campaign::from_texts(CAMPAIGN_FILE, CAMPAIGN, &open)?;
    let options = CompareOptions { draws: DRAWS, ..CompareOptions::default() };
    let calibrated =
        calibration::calibrate(&campaign, calibration::default_mode(&campaign), &options.calibration)?;
    let compared = calibration::compare(&campaign, &options, &|_| {})?;
    let mut report = report::calibration::report(&campaign, &calibrated, None);
    report.sections.extend(report::comparison::sections(&campaign, &compared));
    let json = report::calibration::json(&campaign, &calibrated, None);
    Ok((report, json, report::comparison::json(&campaign, &compared)))
}
