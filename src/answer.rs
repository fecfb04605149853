//! What is answered to a question: its report, its JSON and its files, from inputs in memory.
//!
//! One function for each question. The command line reads its inputs from files and the Python
//! package takes them from memory too; both ask here, and so both get the same numbers, the same
//! words and the same JSON. Nothing here writes a file.

mod calibration;
mod design;
mod diagnosis;
mod forecast;
mod json;
mod neighbours;
mod rig;
mod robot;
mod rod;
mod simulation;

pub use calibration::{calibrate, calibrate_held_out, calibrated_robot, compare, compare_drawn, provenance};
pub use design::{DesignRod, design_poses, design_rig, design_rod};
pub use diagnosis::{diagnose_calibration, diagnose_rig, diagnose_rig_with};
pub use forecast::forecast;
pub use json::{LongList, write_json};
pub use neighbours::{neighbours, rods_beside};
pub use rig::rig_fit;
pub use robot::{predict, predicted};
pub use rod::{ComplianceOptions, compliance};
pub use simulation::{Simulated, named_robot, simulate};

use serde_json::Value;

use crate::report::Report;

/// The answer to a question.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer {
    /// For programs: the keys of `--json`, without the warnings and what is in `long`.
    pub json: Value,
    /// The list of the JSON that may be too long to be held.
    pub long: Option<LongList>,
    /// For people.
    pub report: Report,
    /// Names and contents of what belongs to the answer beside its report: rods, robots, poses.
    pub files: Vec<(String, Vec<u8>)>,
    /// Exit status of the command: 1 where a diagnosis found a mismatch, a fit is not plausible or
    /// no design keeps all limits.
    pub status: u8,
}

impl Answer {
    /// An answer without files, status 0.
    pub fn new(json: Value, report: Report) -> Answer {
        Answer { json, long: None, report, files: Vec::new(), status: 0 }
    }

    /// All of the JSON, with the warnings of the report: people and programs get the same words.
    ///
    /// ```
    /// use rodcal::answer::{ComplianceOptions, compliance};
    /// use rodcal::rod::Rod;
    ///
    /// let rod = Rod::read("rods/5.toml".as_ref())?;
    /// let answer = compliance(rod, &ComplianceOptions::default())?;
    /// let json = answer.whole_json();
    /// assert!((json["cf_um_per_n"][1][1].as_f64().unwrap_or(0.0) - 45.6).abs() < 0.1);
    /// assert!(json["warnings"].is_array());
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn whole_json(&self) -> Value {
        let mut json = self.json.clone();
        if let Some(long) = &self.long {
            json[long.key] = long.items().collect();
        }
        json["warnings"] = self.report.warnings.as_slice().into();
        json
    }
}
