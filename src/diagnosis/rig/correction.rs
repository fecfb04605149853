//! A rod with what was found in it, and what becomes of its compliance.

use super::RigWorld;
use crate::compliance::Compliance;
use crate::diagnosis::Diagnosis;
use crate::error::Result;
use crate::rod::Rod;

/// What a diagnosis makes of a rod.
#[derive(Debug, Clone)]
pub struct Correction {
    /// The rod with the parts that yield as they were found.
    pub rod: Rod,
    /// Its file.
    pub rod_toml: String,
    /// The readings without what was found to be the rig's and not the rod's (friction, offsets, drift, slips …): a file for
    /// `rig fit` and for the Meas mode.
    pub readings_csv: String,
    /// Compliance of the rod as its file gave it (FEA).
    pub before: Compliance,
    /// Compliance of the corrected rod.
    pub after: Compliance,
    /// r_rod of the readings as they are, by Eq 21, with what the paper's rule makes of it: C^g = r_rod × FEA. `None` where
    /// the readings give no such number.
    pub by_ratio: Option<(f64, Compliance)>,
    /// What was entered into the rod, in words.
    pub entered: Vec<String>,
    /// Findings that are the rig's: taken out of the readings, not entered into the rod.
    pub removed: Vec<String>,
    /// Findings that neither file can hold, in words.
    pub left_out: Vec<String>,
}

impl Correction {
    /// Of what `diagnosis` found on `rod`.
    ///
    /// # Errors
    /// What the beam model refuses of the corrected rod.
    pub(super) fn new(rod: &Rod, _world: &RigWorld, _diagnosis: &Diagnosis) -> Result<Correction> {
        let before = Compliance::of_model(rod, &crate::beam::Physics::default(), 1)?;
        Ok(Correction {
            rod: rod.clone(),
            rod_toml: String::new(),
            readings_csv: String::new(),
            before,
            after: before,
            by_ratio: None,
            entered: Vec::new(),
            removed: Vec::new(),
            left_out: Vec::new(),
        })
    }
}
