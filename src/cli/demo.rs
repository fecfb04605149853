//! `rodcal` without arguments: the whole main job on embedded data.

use std::path::PathBuf;

use rodcal::answer;
use rodcal::beam::Physics;
use rodcal::calibration::{self, Campaign, CompareOptions};
use rodcal::compliance::{DEFAULT_ELEMENTS, Mode, Study, paper_contact_force};
use rodcal::diagnosis::calibration::Neighbours;
use rodcal::report::text::wrapped_within;
use rodcal::report::{self, Block, Card, PageLink, Report, Section};
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal::{Error, Result, files, rig};
use serde_json::{Value, json};

use super::embedded::{
    CAMPAIGN, CAMPAIGN_FILE, LOAD_CELL, LOAD_CELL_FILE, RECORDED, RODS, named_by_the_campaign,
};
use super::output::{Outcome, width};

/// What the numbers of the demo are worth.
const RECONSTRUCTED: &str = "Rods 2# and 5# and their readings are reconstructed from the figures of the Improved \
     MultiCal paper (Sensors 2023, 23(12), 5717); the load cell's readings are real; the TX90's campaign is simulated.";

/// Enough to show what a comparison looks like within a blink; `rodcal compare` takes more.
const DRAWS: usize = 20;

/// The pages, in the order of the story.
const PAGES: [(&str, &str, &str); 3] = [
    ("rod", "How much does my rod bend?", "Rod 5#: the beam model beside readings on a rig."),
    (
        "robot",
        "How accurate is my robot once that is compensated?",
        "A TX90 in five clamps, with and without the rod's deflection.",
    ),
    ("why", "My simulation and my recordings disagree: where, and why?", "Two sets of readings, diagnosed."),
];
/// Which card of each page the index shows: c_rod, the error at validation poses, the strongest
/// finding.
const IN_SHORT: [usize; 3] = [0, 2, 0];
/// The rod whose page the demo shows, and the one whose readings are diagnosed.
const SHOWN: &str = "5#";
const DIAGNOSED: &str = "2#";
/// Where its report goes unless somebody says otherwise.
pub const DIRECTORY: &str = "reports/demo";

pub fn run() -> Result<Outcome> {
    let [mut rod_page, mut robot_page, mut why_page] = PAGES.map(|(page, title, _)| {
        let mut report = Report::new(title, "");
        report.page = page.into();
        report.pages = links();
        report
    });
    let wrapped = |words: &str| wrapped_within(words, width());
    let (mut results, mut words, mut fitted) = (Vec::new(), String::new(), String::new());
    let mut provenance: Vec<(String, String)> = Vec::new();
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
        results.push(json!({
            "compliance": report::compliance::json(&study),
            "rig": report::rig::json(&fit, &readings, Some(&rod)),
        }));
        provenance.push(("rod file".into(), example.rod_file.into()));
        provenance.push(("readings".into(), format!("{} (reconstructed)", example.readings_file)));
        let page = if rod.name == SHOWN { &mut rod_page } else { &mut why_page };
        for part in [&rod_report, &rig_report] {
            page.warnings.extend(part.warnings.iter().map(|warning| format!("rod {}: {warning}", rod.name)));
        }
        if rod.name == SHOWN {
            fitted.clone_from(&rig_report.headline);
            rod_page.headline = format!("{} {}", rod_report.headline, rig_report.headline);
            rod_page.cards = rod_report.cards.into_iter().chain(rig_report.cards).collect();
            let drawn = shown(rod_report.sections, &["shape-force"]);
            let measured = shown(rig_report.sections, &["load-deflection", "waterfall"]);
            // side by side where there is room
            let blocks = drawn.into_iter().chain(measured).flat_map(|section| section.blocks).collect();
            rod_page.sections = vec![Section::new(format!("Rod {SHOWN}, as drawn and as measured"), blocks)];
        } else if rod.name == DIAGNOSED {
            add(&mut why_page, &format!("Rod {DIAGNOSED}"), diagnosed(&readings, Some(&rod))?);
        }
    }

    let readings = Readings::from_text(LOAD_CELL_FILE, LOAD_CELL)?;
    let fit = rig::fit(&readings, None, &rig::Options::default())?;
    let cell_report = report::rig::report(&fit, &readings, None);
    words += &wrapped(&format!("Load cell (NIST): {}", cell_report.headline));
    why_page.warnings.extend(cell_report.warnings.into_iter().map(|warning| format!("load cell: {warning}")));
    provenance.push(("readings".into(), format!("{LOAD_CELL_FILE} (NIST StRD, Pontius)")));
    add(&mut why_page, "Load cell (NIST)", diagnosed(&readings, None)?);
    words += &format!("\n{}", wrapped(&why_page.headline));

    let Robot { report: robot_report, calibrated, compared, without, diagnosis } = robot()?;
    words +=
        &format!("\n{}", wrapped(&format!("{} {without} {}", robot_report.headline, diagnosis.headline)));
    robot_page.warnings.extend(robot_report.warnings.into_iter().map(|warning| format!("TX90: {warning}")));
    robot_page.headline = format!("{} {without}", robot_report.headline);
    robot_page.cards = robot_report.cards;
    robot_page.sections =
        shown(robot_report.sections, &["error-distribution", "error-over-workspace", "mode-comparison"]);
    add(&mut robot_page, "Diagnosis", diagnosis);
    provenance.push(("campaign".into(), format!("{CAMPAIGN_FILE} (simulated)")));
    provenance.push(("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()));

    let mut pages = vec![rod_page, robot_page, why_page];
    for page in &mut pages {
        page.provenance.clone_from(&provenance);
    }
    let cards: Vec<Card> =
        pages.iter().zip(IN_SHORT).filter_map(|(page, k)| page.cards.get(k).cloned()).collect();
    let short = |card: &Card| format!("{}: {}.", card.label, card.value);
    let mut said = vec![fitted];
    said.extend(cards.get(1).map(|card| format!("TX90: {} {without}", short(card).to_lowercase())));
    // the rest of it stands on its page
    said.extend(pages[2].headline.split_once(". ").map(|(first, _)| format!("{first}.")));
    let mut index = Report::new("rodcal demo", said.join(" "));
    index.pages = links();
    index.cards = cards;
    index.warnings = vec![RECONSTRUCTED.to_owned()];
    index.provenance = provenance;
    let json = json!({
        "rods": results,
        "load_cell": report::rig::json(&fit, &readings, None),
        "calibration": calibrated,
        "comparison": compared,
    });
    Ok(Outcome {
        text: Some(words),
        default_directory: Some(PathBuf::from(DIRECTORY)),
        pages,
        inputs: embedded(),
        ..Outcome::new(json, index)
    })
}

/// What the program carries inside, with its SHA-256.
fn embedded() -> Vec<(String, String)> {
    let of_rods = RODS.iter().flat_map(|e| [(e.rod_file, e.rod), (e.readings_file, e.readings)]);
    let others = [(LOAD_CELL_FILE, LOAD_CELL), (CAMPAIGN_FILE, CAMPAIGN)];
    let recorded = RECORDED.iter().map(|(name, text)| (CAMPAIGN_FILE.replace("campaign.toml", name), *text));
    let all = of_rods.chain(others).map(|(file, text)| (file.to_owned(), text)).chain(recorded);
    all.map(|(file, text)| (file, files::sha256(text.as_bytes()))).collect()
}

/// All pages, as each of them links them.
fn links() -> Vec<PageLink> {
    let of_page = |(page, title, answer): (&str, &str, &str)| PageLink {
        file: format!("{page}.html"),
        title: title.into(),
        answer: answer.into(),
    };
    PAGES.into_iter().map(of_page).collect()
}

/// The sections that have one of these pictures, with the first of each and their words, and the
/// first table of all, folded: a story, of which the commands have the rest.
fn shown(sections: Vec<Section>, pictures: &[&str]) -> Vec<Section> {
    let mut left: Vec<&str> = pictures.to_vec();
    let (mut kept, mut has_table) = (Vec::new(), false);
    for mut section in sections {
        section.blocks.retain_mut(|block| match block {
            Block::Figure(figure) => {
                let at = left.iter().position(|name| *name == figure.name);
                at.map(|at| left.remove(at)).is_some()
            }
            Block::Table(table) => {
                table.is_folded = true;
                !std::mem::replace(&mut has_table, true)
            }
            _ => true,
        });
        if section.blocks.iter().any(|block| matches!(block, Block::Figure(_))) {
            kept.push(section);
        }
    }
    kept
}

/// A diagnosis as a part of a page: its answer, its first cards, what it looks like before and
/// after.
fn add(page: &mut Report, heading: &str, part: Report) {
    let gap = if page.headline.is_empty() { "" } else { " " };
    page.headline += &format!("{gap}{heading}: {}", part.headline);
    let labelled = |card: Card| Card { label: format!("{heading}: {}", card.label.to_lowercase()), ..card };
    let is_new = |card: &Card| page.cards.iter().all(|own| !own.label.starts_with(&card.label));
    let new: Vec<Card> = part.cards.into_iter().take(3).filter(is_new).map(labelled).collect();
    page.cards.extend(new);
    let sections = shown(part.sections, &["before-after", "ranking"]);
    let blocks = sections.into_iter().flat_map(|section| section.blocks).collect();
    page.sections.push(Section::new(heading, blocks));
}

/// The report of a diagnosis.
fn diagnosed(readings: &Readings, rod: Option<&Rod>) -> Result<Report> {
    let found = rodcal::diagnosis::rig::diagnose(readings, rod)?;
    Ok(report::diagnosis::rig::report(&found, found.correction()?.as_ref()))
}

/// The campaign inside the program.
struct Robot {
    report: Report,
    calibrated: Value,
    compared: Value,
    /// What the error is where nothing is compensated, and whether that matters.
    without: String,
    diagnosis: Report,
}

/// It is calibrated in its default mode, all modes are compared, and its residuals diagnosed.
fn robot() -> Result<Robot> {
    let open = |name: &str| {
        named_by_the_campaign(name).map(str::to_owned).ok_or_else(|| Error::File {
            path: name.into(),
            action: "read",
            source: std::io::ErrorKind::NotFound.into(),
        })
    };
    let campaign = Campaign::from_texts(CAMPAIGN_FILE, CAMPAIGN, &open)?;
    let options = CompareOptions::default().with_draws(DRAWS);
    let mode = calibration::default_mode(&campaign);
    let calibrated = calibration::calibrate(&campaign, mode, &options.calibration)?;
    let compared = calibration::compare(&campaign, &options, &|_| {})?;
    let mut report = report::calibration::report(&campaign, &calibrated, None);
    report.sections.extend(report::comparison::sections(&campaign, &compared));
    Ok(Robot {
        report,
        calibrated: report::calibration::json(&campaign, &calibrated, None),
        compared: report::comparison::json(&campaign, &compared),
        without: report::comparison::without_compensation(&compared, mode).unwrap_or_default(),
        diagnosis: answer::diagnose_calibration(&campaign, mode, &Neighbours::default(), None)?.report,
    })
}
