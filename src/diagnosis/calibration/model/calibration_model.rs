//! A calibrated campaign with all the physics that might be left in its residuals.

use nalgebra::{DVector, Matrix3, Vector3};

use super::covariance::ScatterSources;
use super::gear::Gear;
use super::law::Law;
use super::linear_terms::LinearTerms;
use super::torque_uncertainty::TorqueUncertainty;
use super::validated::Validated;
use crate::calibration::campaign::Campaign;
use crate::calibration::{Calibration, Summary};
use crate::inference::{Finding, FindingPart, Term};

/// A campaign that was calibrated as well as it can be, and what that may have left out.
#[derive(Debug, Clone)]
pub struct CalibrationModel<'c> {
    /// What was recorded.
    pub campaign: &'c Campaign,
    /// The best calibration without any of the effects.
    pub calibration: Calibration<'c>,
    /// ∂tip/∂q of every joint at each row, m/rad (or m/m).
    pub tip_jacobians: Vec<Vec<Vector3<f64>>>,
    /// Errors of a calibration on what was recorded, where mistakes were undone.
    pub(crate) recorded: Option<Summary>,
    /// Errors of the validation, of which no search has seen anything: see
    /// [`look_at_validation`](crate::diagnosis::calibration::look_at_validation).
    pub validated: Option<Validated>,
    /// What the scatter of the poses is made of, where it is not as large along every axis.
    pub scatter: Option<ScatterSources>,
    /// What a displacement in {W} at each row is among the data.
    pub(in crate::diagnosis::calibration) weights: Vec<Matrix3<f64>>,
    /// How well torques are known.
    pub(in crate::diagnosis::calibration) torque_uncertainty: TorqueUncertainty,
    pub(in crate::diagnosis::calibration) terms: LinearTerms,
}

impl CalibrationModel<'_> {
    /// How a candidate acts in detail.
    pub fn law(&self, candidate: usize) -> &Law {
        self.terms.laws.get(candidate).unwrap_or(&Law::Only)
    }

    /// What a part of a finding is a function of, where it is an error of a gear.
    pub fn gear_of(&self, part: &FindingPart) -> Option<&Gear> {
        self.law(part.term.candidate).gear()
    }

    /// Residuals and responses are displacements of the rows times this: pooled noise over the
    /// noise of the row's group, less along what scatters more than the rest.
    pub fn weight(&self, row: usize) -> Matrix3<f64> {
        self.weights.get(row).copied().unwrap_or_else(Matrix3::identity)
    }

    /// Share of a candidate that the calibration cannot take up.
    pub fn unabsorbed(&self, candidate: usize) -> f64 {
        self.terms.unabsorbed.get(candidate).copied().unwrap_or(0.0)
    }

    /// Of numbers by datum the displacement of each row in {W}, m: for residuals and responses.
    pub fn by_row(&self, data: &DVector<f64>) -> Vec<Vector3<f64>> {
        let row = |row: usize| undone(&self.weight(row)) * data.fixed_rows::<3>(3 * row);
        (0..self.tip_jacobians.len()).map(row).collect()
    }

    /// What one finding does to the recording by itself, as data.
    pub fn response_of(&self, finding: &Finding) -> DVector<f64> {
        let terms: Vec<Term> = finding.parts.iter().map(|part| part.term.clone()).collect();
        self.terms.response(&terms)
    }

    /// The first row, from 0, that a term moves.
    pub fn first_row(&self, term: &Term) -> Option<usize> {
        let response = self.terms.response(std::slice::from_ref(term));
        response.iter().position(|moved| *moved != 0.0).map(|datum| datum / 3)
    }

    /// Name of a session: a clamp, or a placement of sockets.
    pub fn session(&self, number: usize) -> String {
        let sessions = self.campaign.measurements.sessions();
        sessions.get(number).map_or_else(String::new, |first| first.session())
    }

    /// The recorded angles of a joint, rad (or m), by row.
    pub fn angles(&self, joint: usize) -> Vec<f64> {
        let recording = &self.campaign.measurements;
        (0..recording.len()).map(|row| recording.joints(row)[joint]).collect()
    }
}

/// The inverse of what a row counts: one that counts nothing says nothing.
pub fn undone(weight: &Matrix3<f64>) -> Matrix3<f64> {
    weight.try_inverse().unwrap_or_else(Matrix3::zeros)
}
