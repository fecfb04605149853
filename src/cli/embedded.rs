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
