//! The physics of a calibration: what could be left in the residuals of a robot that was calibrated as well as it can be.
//!
//! The engine judges every effect after all that the calibration can absorb: its Jacobian is the evidence's nuisance
//! (`evidence.rs`). An effect is a displacement of the tip, to first order through the calibrated kinematics, so that a
//! story's change is a sum of columns that are made once (`scene.rs`). Which effects there are and how large they usually are:
//! `library.rs` and its folder, with the formulae. The rivals that stand for physics nobody has named: `unknown.rs`.
//!
//! What a calibration absorbs cannot be seen: an eccentricity of the last joint is nothing where the target lies on that
//! joint's axis. Such effects are no candidates, but [`CalibrationWorld::absorbed`] says which they are.

mod apply;
mod carried;
mod cosines;
mod evidence;
mod feasible;
mod findings;
mod gear;
mod library;
mod limits;
mod next;
mod posture;
mod result;
mod scene;
#[cfg(test)]
mod tests;
mod unknown;
mod words;

use nalgebra::{DMatrix, DVector};

use self::scene::{Column, Entry, Scene};
use super::whitening::Whitening;
use super::{Candidate, Chosen, Evidence, World};
use crate::calibration::Calibration;
use crate::calibration::campaign::Campaign;
use crate::error::Result;
pub use apply::{Applied, apply};
pub use feasible::{NewPose, Plan};
pub use findings::{Mismatch, Number};
pub use gear::{Curve, Gear};
pub use library::NotTestable;
pub use limits::Limit;
pub use next::NextPoses;
pub use result::{CalibrationDiagnosis, diagnose};
pub use words::{cause, cause_at, unexplained_at};

/// Share of an effect that must be left once the calibration has absorbed what it can.
const LEAST_SURVIVAL: f64 = 0.02;

/// A calibrated campaign with all the physics that might be left in its residuals.
#[derive(Debug, Clone)]
pub struct CalibrationWorld {
    candidates: Vec<Candidate>,
    /// For each candidate ∂change/∂parameter.
    columns: Vec<Vec<Column>>,
    gears: Vec<Option<Gear>>,
    /// What survives of each candidate.
    survival: Vec<f64>,
    data: usize,
    /// What each row counts.
    scale: Vec<f64>,
    /// Effects that the calibration hides.
    pub absorbed: Vec<Absorbed>,
    /// Effects that the campaign's files have no data for.
    pub not_testable: Vec<NotTestable>,
}

/// An effect that a calibration hides: had the robot it, the parameters would take it up.
#[derive(Debug, Clone, PartialEq)]
pub struct Absorbed {
    /// Name of the effect.
    pub effect: String,
    /// Where.
    pub location: String,
    /// ‖M·C‖/‖C‖: share of its columns that the calibration cannot take up.
    pub survival: f64,
}

impl CalibrationWorld {
    /// The world of a finished calibration. Data are rows × (x, y, z), in {W}, then what is known besides; see
    /// `evidence.rs`.
    ///
    /// # Errors
    /// As [`crate::calibration::Compensation::new`].
    pub fn new(campaign: &Campaign, calibration: &Calibration) -> Result<(CalibrationWorld, Evidence)> {
        let scene = Scene::new(campaign, calibration)?;
        let evidence = evidence::of(campaign, calibration, &scene);
        let (mut entries, not_testable) = library::all(&scene);
        entries.extend(unknown::all(&scene));
        let world = CalibrationWorld {
            not_testable,
            scale: scene.scale.clone(),
            ..CalibrationWorld::of(entries, &evidence)
        };
        Ok((world, evidence))
    }

    /// Of entries, without what does nothing or is absorbed.
    fn of(entries: Vec<Entry>, evidence: &Evidence) -> Self {
        let data = evidence.residual.len();
        let mut world = CalibrationWorld {
            candidates: Vec::new(),
            columns: Vec::new(),
            gears: Vec::new(),
            survival: Vec::new(),
            data,
            scale: Vec::new(),
            absorbed: Vec::new(),
            not_testable: Vec::new(),
        };
        let whitening = Whitening::new(evidence, &evidence.residual);
        let entries: Vec<Entry> = entries.into_iter().filter_map(Entry::felt).collect();
        let survival =
            crate::parallel::in_parallel(entries.len(), |k| survival(&entries[k], &whitening, data));
        for (entry, survival) in entries.into_iter().zip(survival) {
            if survival < LEAST_SURVIVAL {
                let Candidate { effect, location, .. } = entry.candidate;
                world.absorbed.push(Absorbed { effect, location, survival });
                continue;
            }
            world.candidates.push(entry.candidate);
            world.columns.push(entry.columns);
            world.gears.push(entry.gear);
            world.survival.push(survival);
        }
        world
    }

    /// What a transmission error is a function of; `None` for any other candidate.
    pub fn gear(&self, candidate: usize) -> Option<&Gear> {
        self.gears.get(candidate)?.as_ref()
    }

    /// Residuals and changes are rows of the recording times this: pooled noise over the noise of the row's group.
    pub fn scale(&self, row: usize) -> f64 {
        self.scale.get(row).copied().unwrap_or(1.0)
    }

    /// Share of a candidate that the calibration cannot take up.
    pub fn survival(&self, candidate: usize) -> f64 {
        self.survival.get(candidate).copied().unwrap_or(0.0)
    }
}

impl World for CalibrationWorld {
    fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    fn change(&self, story: &[Chosen]) -> DVector<f64> {
        let mut change = DVector::zeros(self.data);
        for chosen in story {
            let Some(candidate) = self.candidates.get(chosen.candidate) else { continue };
            let parameters = candidate.parameters.iter().zip(&self.columns[chosen.candidate]);
            for ((parameter, column), value) in parameters.zip(&chosen.values) {
                if *value != parameter.neutral {
                    column.add_to(&mut change, value - parameter.neutral);
                }
            }
        }
        change
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn columns(&self, story: &[Chosen], position: usize) -> DMatrix<f64> {
        let candidate = story[position].candidate;
        let columns = &self.columns[candidate];
        let mut matrix = DMatrix::zeros(self.data, columns.len());
        for ((k, column), parameter) in columns.iter().enumerate().zip(&self.candidates[candidate].parameters)
        {
            let mut slots = matrix.view_mut((column.first, k), (column.values.len(), 1));
            slots.copy_from_slice(&column.values);
            slots *= parameter.size;
        }
        matrix
    }
}

impl Entry {
    /// Without parameters that do nothing; `None` where none is left.
    fn felt(self) -> Option<Entry> {
        // the terms of a gear's error are told by their number
        let keeps_all = self.gear.is_some() && self.columns.iter().any(|column| !column.is_zero());
        let parameters = self.candidate.parameters.into_iter().zip(self.columns);
        let (parameters, columns): (Vec<_>, Vec<_>) =
            parameters.filter(|(_, column)| keeps_all || !column.is_zero()).unzip();
        let candidate = Candidate { parameters, ..self.candidate };
        (!columns.is_empty()).then_some(Entry { candidate, columns, ..self })
    }
}

/// √(Σ‖M·C‖²/Σ‖C‖²) over the parameters at their sizes.
fn survival(entry: &Entry, whitening: &Whitening, data: usize) -> f64 {
    let (mut left, mut all) = (0.0, 0.0);
    for (parameter, column) in entry.candidate.parameters.iter().zip(&entry.columns) {
        let mut own = DVector::zeros(data);
        column.add_to(&mut own, parameter.size);
        all += own.norm_squared();
        left += whitening.apply(&own).norm_squared();
    }
    (left / all.max(f64::MIN_POSITIVE)).sqrt()
}
