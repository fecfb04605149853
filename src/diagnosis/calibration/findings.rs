//! Findings as they are told: what concerns one joint's gear is one thing, and so are all outliers.
//!
//! ```text
//! amplitude of a harmonic    √(a² + b²)
//! amplitude of a wave        √(a² + b² + (c² + d²)·mean(u²)), its frequency n + h·(a·d − b·c)/(a² + b²)
//! amplitude of a curve       √2 times its rms over the recorded angles: that of a wave of the same rms
//! frequency of a curve       that of the one wave that explains most of it
//! ```
//!
//! A constant and one cycle per revolution are taken out of a curve first: the calibration takes most of them up, and what is
//! said of them is little more than a guess.
//!
//! Their intervals, and those of a vector's length, are ± reach·√(gᵀ·Σ·g) with the gradient g and the posterior covariance Σ.

use nalgebra::{DMatrix, DVector};

use super::{CalibrationWorld, Gear};
use crate::calibration::campaign::Campaign;
use crate::diagnosis::{Diagnosis, Finding, World, rms};
use crate::units::URAD;

/// Step of the scan for a curve's strongest wave, cycles per revolution.
const WAVE_STEP: f64 = 0.25;

/// One or more findings that are told as one.
#[derive(Debug, Clone, PartialEq)]
pub struct Mismatch {
    /// Name of the effect.
    pub effect: String,
    /// Where, for example `joint 3` or `pose 7; pose 12`.
    pub location: String,
    /// Indices among the diagnosis' findings, strongest first.
    pub parts: Vec<usize>,
    /// What it amounts to.
    pub parameters: Vec<Number>,
    /// Least of the probabilities that noise alone fits as much better.
    pub p_value: f64,
    /// Root mean square of what all of it explains, m.
    pub rms: f64,
}

/// A number with its 95 % interval, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// Name with its unit.
    pub name: String,
    /// What one unit of the name is in SI.
    pub unit: f64,
    /// Value.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// All findings of a diagnosis, those of one kind together.
pub(super) fn mismatches(
    world: &CalibrationWorld,
    campaign: &Campaign,
    diagnosis: &Diagnosis,
) -> Vec<Mismatch> {
    let mut all: Vec<Mismatch> = Vec::new();
    for (index, finding) in diagnosis.findings.iter().enumerate() {
        let effect = world.candidates()[finding.chosen.candidate].effect.clone();
        let location = location(&effect, &finding.place);
        let is_same = |known: &&mut Mismatch| {
            known.effect == effect
                && match effect.as_str() {
                    "transmission_error" => known.location == location,
                    "outlier" => true,
                    _ => false,
                }
        };
        match all.iter_mut().find(is_same) {
            Some(known) => {
                if effect == "outlier" {
                    known.location = format!("{}; {location}", known.location);
                }
                known.p_value = known.p_value.min(finding.p_value);
                known.parts.push(index);
            }
            None => all.push(Mismatch {
                effect,
                location,
                parts: vec![index],
                parameters: Vec::new(),
                p_value: finding.p_value,
                rms: 0.0,
            }),
        }
    }
    for mismatch in &mut all {
        let parts: Vec<&Finding> = mismatch.parts.iter().map(|&part| &diagnosis.findings[part]).collect();
        let chosen: Vec<_> = parts.iter().map(|finding| finding.chosen.clone()).collect();
        mismatch.rms = rms(&world.change(&chosen));
        mismatch.parameters = match world.gear(chosen[0].candidate) {
            Some(gear) => of_gear(gear, campaign, diagnosis, parts[0]),
            None => parts.iter().flat_map(|finding| of_finding(world, finding)).collect(),
        };
    }
    all.sort_by(|a, b| b.rms.total_cmp(&a.rms));
    all
}

/// Of what is in a joint the joint alone; how it acts is not where it is.
pub(super) fn location(effect: &str, place: &str) -> String {
    let is_of_joint =
        ["transmission_error", "backlash", "joint_compliance", "joint_nonlinear_stiffness"].contains(&effect);
    match place.split_once(", ") {
        Some((joint, _)) if is_of_joint => joint.to_owned(),
        _ => place.to_owned(),
    }
}

fn of_finding(world: &CalibrationWorld, finding: &Finding) -> Vec<Number> {
    let parameters = &world.candidates()[finding.chosen.candidate].parameters;
    let number =
        |(parameter, &(value, low, high)): (&crate::diagnosis::EffectParameter, &(f64, f64, f64))| {
            let (name, unit) = (parameter.name.clone(), parameter.unit);
            Number { name, unit, value, low, high }
        };
    let numbers: Vec<Number> = parameters.iter().zip(&finding.parameters).map(number).collect();
    match world.candidates()[finding.chosen.candidate].effect.as_str() {
        "rod_stiffness" => numbers.into_iter().map(inverse).collect(),
        _ => numbers,
    }
}

/// The world counts by how much more a rod bends, which its columns are linear in; people count its stiffness, as on a rig.
fn inverse(number: Number) -> Number {
    Number { value: 1.0 / number.value, low: 1.0 / number.high, high: 1.0 / number.low, ..number }
}

/// Frequency and amplitude of the strongest part of a gear's error.
fn of_gear(gear: &Gear, campaign: &Campaign, diagnosis: &Diagnosis, finding: &Finding) -> Vec<Number> {
    let values = &finding.chosen.values;
    let recording = &campaign.measurements;
    let angles: Vec<f64> = (0..recording.len()).map(|row| recording.joints(row)[gear.joint()]).collect();
    let resolved = |cycles: f64| (cycles, 0.5 / turns(&angles));
    let ((cycles, half_cycles), (value, gradient)) = match gear {
        Gear::Harmonic { cycles_per_rev, .. } => (resolved(*cycles_per_rev), length(values)),
        Gear::Wave { middle, half_step, .. } => {
            let (cycles, gradient) = gear.frequency(values);
            let square = |q: &f64| ((q - middle) * half_step).powi(2);
            let mean = angles.iter().map(square).sum::<f64>() / angles.len().max(1) as f64;
            let half = finding.reach * spread(diagnosis, finding, &gradient);
            ((cycles, half), weighted_length(values, &[1.0, 1.0, mean, mean]))
        }
        Gear::Curve { .. } => {
            let (cycles, value, gradient) = of_curve(gear, values, &angles);
            (resolved(cycles), (value, gradient))
        }
    };
    let number = |name: &str, unit: f64, value: f64, half: f64| {
        let (low, high) = ((value - half).max(0.0), value + half);
        Number { name: name.into(), unit, value, low, high }
    };
    let half = finding.reach * spread(diagnosis, finding, &gradient);
    vec![number("cycles_per_rev", 1.0, cycles, half_cycles), number("amplitude_urad", URAD, value, half)]
}

/// Range of angles in revolutions: frequencies closer than its inverse are hard to tell apart.
fn turns(angles: &[f64]) -> f64 {
    let (low, high) =
        angles.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &q| (a.min(q), b.max(q)));
    ((high - low) / std::f64::consts::TAU).max(f64::MIN_POSITIVE)
}

/// Frequency, amplitude and its gradient of a curve over the recorded angles.
fn of_curve(gear: &Gear, values: &[f64], angles: &[f64]) -> (f64, f64, DVector<f64>) {
    let slow = DMatrix::from_fn(angles.len(), 3, |row, k| match k {
        0 => 1.0,
        1 => angles[row].sin(),
        _ => angles[row].cos(),
    });
    let slow = slow.qr().q();
    let terms = DMatrix::from_fn(angles.len(), values.len(), |row, k| gear.term(k, angles[row]));
    let terms = &terms - &slow * slow.tr_mul(&terms);
    let curve = &terms * DVector::from_column_slice(values);
    let rms = rms(&curve).max(f64::MIN_POSITIVE);
    let gradient = terms.tr_mul(&curve) * (2.0f64.sqrt() / (angles.len().max(1) as f64 * rms));
    (strongest_wave(&curve, angles, gear.highest(values.len())), 2.0f64.sqrt() * rms, gradient)
}

/// Cycles per revolution of the one wave that explains most of a curve.
fn strongest_wave(curve: &DVector<f64>, angles: &[f64], highest: f64) -> f64 {
    let power = |cycles: f64| {
        let wave = DMatrix::from_fn(angles.len(), 2, |row, k| {
            let (sine, cosine) = (cycles * angles[row]).sin_cos();
            if k == 0 { sine } else { cosine }
        });
        wave.qr().q().tr_mul(curve).norm_squared()
    };
    let steps = (1..).map(|step| f64::from(step) * WAVE_STEP).take_while(|cycles| *cycles <= highest);
    let powers = steps.map(|cycles| (cycles, power(cycles)));
    powers.fold((0.0, 0.0), |most: (f64, f64), next| if next.1 > most.1 { next } else { most }).0
}

/// A vector's length and its gradient.
fn length(values: &[f64]) -> (f64, DVector<f64>) {
    weighted_length(values, &vec![1.0; values.len()])
}

/// √(Σ wₖ·xₖ²) and its gradient.
fn weighted_length(values: &[f64], weights: &[f64]) -> (f64, DVector<f64>) {
    let weighted = DVector::from_iterator(values.len(), values.iter().zip(weights).map(|(x, w)| x * w));
    let length = weighted.dot(&DVector::from_column_slice(values)).sqrt();
    (length, weighted / length.max(f64::MIN_POSITIVE))
}

/// √(gᵀ·Σ·g) over the first parameters of a finding.
fn spread(diagnosis: &Diagnosis, finding: &Finding, gradient: &DVector<f64>) -> f64 {
    let (first, count) = (finding.first, gradient.len());
    let covariance = diagnosis.story.covariance.view((first, first), (count, count));
    gradient.dot(&(covariance * gradient)).max(0.0).sqrt()
}

/// Length of the vector of the first three parameters of a finding, with its 95 % interval, SI.
pub(super) fn size(diagnosis: &Diagnosis, finding: &Finding) -> (f64, f64, f64) {
    let count = finding.chosen.values.len().min(3);
    let (value, gradient) = length(&finding.chosen.values[..count]);
    let half = finding.reach * spread(diagnosis, finding, &gradient);
    (value, (value - half).max(0.0), value + half)
}
