//! The files the demo runs on, carried inside the program.

/// A rod with its rig readings.
pub struct Example {
    pub rod_file: &'static str,
    pub rod: &'static str,
    pub readings_file: &'static str,
    pub readings: &'static str,
}

/// The paper's carbon rod 2# and steel rod 5#.
pub const RODS: [Example; 2] = [
    Example {
        rod_file: "rods/2.toml",
        rod: include_str!("../../rods/2.toml"),
        readings_file: "stiffness_data/2.csv",
        readings: include_str!("../../stiffness_data/2.csv"),
    },
    Example {
        rod_file: "rods/5.toml",
        rod: include_str!("../../rods/5.toml"),
        readings_file: "stiffness_data/5.csv",
        readings: include_str!("../../stiffness_data/5.csv"),
    },
];

/// A real load–deflection recording: NIST's load cell.
pub const LOAD_CELL_FILE: &str = "stiffness_data/nist-load-cell.csv";
/// Its text.
pub const LOAD_CELL: &str = include_str!("../../stiffness_data/nist-load-cell.csv");

/// A small simulated campaign of a TX90 with rod 5#.
pub const CAMPAIGN_FILE: &str = "campaigns/tx90-5/campaign.toml";
/// Its text.
pub const CAMPAIGN: &str = include_str!("../../campaigns/tx90-5/campaign.toml");

/// What was recorded for it: names beside the campaign's file, and texts.
pub const RECORDED: [(&str, &str); 3] = [
    ("readings.csv", include_str!("../../campaigns/tx90-5/readings.csv")),
    ("measurements.csv", include_str!("../../campaigns/tx90-5/measurements.csv")),
    ("validation.csv", include_str!("../../campaigns/tx90-5/validation.csv")),
];

/// The files that the campaign names, by these names.
pub fn named_by_the_campaign(name: &str) -> Option<&'static str> {
    if name == "../../rods/5.toml" {
        return Some(RODS[1].rod);
    }
    RECORDED.iter().find(|(recorded, _)| *recorded == name).map(|(_, text)| *text)
}
