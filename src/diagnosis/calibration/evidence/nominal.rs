//! The numbers of the files that a calibration does not fit, each known to its standard
//! uncertainty: what they explain within that is no mismatch.
//!
//! ```text
//! mass of link k      Σ_{j≤k} Jⱼ·cⱼ·zⱼ·((p_k − oⱼ) × g)·u       u a share of its mass
//! its centre          Σ_{j≤k} Jⱼ·cⱼ·zⱼ·(e × g)·m_k·u            e an axis of the link, u a share of its distance
//! … with a drive      Jⱼ·s(cⱼ)·zⱼ·(e × g)·m_k·u                 s(cⱼ) how well its compliance is known
//! a number of the rod (R·(∂C^F·F + ∂C^g·g) + ∂yield(weight))·u   by the rod file's standard uncertainties
//! place of a clamp    −e·u                                      where the campaign states u
//! readings' share     R·e·eᵀ·Rᵀ·u·σ²/ū²·(λ − ½)                 λ of the scatter σ² along e is theirs, not the arm's
//! ```
//!
//! A drive that no torque of the robot's file loads has any compliance, or none: what the centres
//! load it with all the same is in proportion to both, (cⱼ + s·x)·u·y, and has the variance of
//! both, cⱼ²u² + s²u².
//!
//! The last is what the displacement u of a clamp's ball has in common with the residual: where the
//! readings scatter it is larger by their error ε, which the residual holds too, and where the
//! joints do the residual is the less. How much is whose nobody knows: 0 to 1, evenly.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::super::model::entry::Column;
use super::super::model::{Configuration, Context};
use crate::beam::Physics;
use crate::calibration::Mode;
use crate::calibration::campaign::Campaign;
use crate::compliance::{Compliance, DEFAULT_ELEMENTS, closed_form};
use crate::inference::{Evidence, NominalParameter, Whitening};
use crate::robot::Body;
use crate::rod::{Nominal, Rod};
use crate::spatial::Axis;
use crate::units::{MM, STANDARD_GRAVITY};

/// Part of a noise below which the length of a column says nothing: such a number is left out.
const UNFELT: f64 = 0.5;
/// Standard deviation of a number that is anywhere between 0 and 1: 1/√12.
const EVENLY: f64 = 0.288_675;
/// Least distance from its joint's frame that the share of a centre's uncertainty is of, m.
const LEAST_DISTANCE: f64 = 20.0 * MM;

/// Adds the numbers that the recording feels to an evidence.
pub fn with_numbers(evidence: Evidence, campaign: &Campaign, mode: Mode, context: &Context) -> Evidence {
    let mut numbers = of_links(campaign, context);
    numbers.extend(of_rod(campaign, mode, context));
    numbers.extend(of_clamps(campaign, context));
    // all that is in proportion to the readings is felt together
    let of_readings = of_readings(&evidence, context);
    let others = numbers.len();
    numbers.extend(of_readings);
    if numbers.is_empty() {
        return evidence;
    }
    let mut columns = DMatrix::zeros(evidence.residual.len(), numbers.len());
    for (k, (number, column)) in numbers.iter().enumerate() {
        column.add_to_slice(columns.column_mut(k).as_mut_slice(), number.standard_uncertainty);
    }
    let left = Whitening::new(&evidence, &evidence.residual).apply_columns(&columns);
    let is_felt = |k: &usize| *k >= others || left.column(*k).norm() > UNFELT * context.noise;
    let felt: Vec<usize> = (0..numbers.len()).filter(is_felt).collect();
    Evidence {
        nominal_numbers: felt.iter().map(|&k| numbers[k].0.clone()).collect(),
        nominal: columns.select_columns(&felt),
        ..evidence
    }
}

fn of_links(campaign: &Campaign, context: &Context) -> Vec<(NominalParameter, Column)> {
    let robot = &campaign.robot;
    let share = robot.standard_uncertainty.mass;
    let bodies = robot.joints.iter().enumerate().filter_map(|(k, joint)| Some((k, joint.body?)));
    let of_link = |(k, body): (usize, Body)| {
        let pulled = |there: &Configuration| {
            let centre = there.link[k].point(&body.centre);
            there.joint_deflection_below(k, |j| centre - there.origin[j], &there.gravity)
        };
        let mass = NominalParameter {
            name: format!("mass of link {}", k + 1),
            unit: "kg",
            si: 1.0,
            value: body.mass,
            standard_uncertainty: share * body.mass,
        };
        let distance = body.centre.norm().max(LEAST_DISTANCE);
        let mut numbers = vec![(mass, context.column(|_, there| pulled(there)))];
        let mut centre =
            |axis: Axis, by: &str, moved: &dyn Fn(&Configuration, &Vector3<f64>) -> Vector3<f64>| {
                let centre = NominalParameter {
                    name: format!("centre of link {} along {axis}{by}", k + 1),
                    unit: "mm",
                    si: MM,
                    value: body.centre[axis.index()],
                    standard_uncertainty: share * distance,
                };
                let column = context.column(|_, there| {
                    moved(there, &there.link[k].rotation.column(axis.index()).into_owned())
                });
                numbers.push((centre, column));
            };
        for axis in Axis::ALL {
            centre(axis, "", &|there, along| {
                there.joint_deflection_below(k, |_| *along, &(there.gravity * body.mass))
            });
        }
        for j in (0..=k).filter(|j| context.compliance_uncertainty[*j] > 0.0) {
            for axis in Axis::ALL {
                centre(axis, &format!(", by the drive of joint {}", j + 1), &|there, along| {
                    let torque = there.axis[j].dot(&along.cross(&(there.gravity * body.mass)));
                    there.tip_jacobian[j] * (context.compliance_uncertainty[j] * torque)
                });
            }
        }
        numbers
    };
    let known = bodies.filter(|(_, body)| share > 0.0 && body.mass > 0.0);
    known.flat_map(of_link).collect()
}

/// Of a rod whose deflection is computed; one that was measured is known by its readings.
fn of_rod(campaign: &Campaign, mode: Mode, context: &Context) -> Vec<(NominalParameter, Column)> {
    let model = |rod: &Rod| match mode {
        Mode::Calc => closed_form::compliance(rod).ok(),
        Mode::Fea => Compliance::of_model(rod, &Physics::default(), DEFAULT_ELEMENTS).ok(),
        Mode::None | Mode::Meas => None,
    };
    let Some((rod, nominal)) = campaign.rod.as_ref().and_then(|rod| Some((rod, model(rod)?))) else {
        return Vec::new();
    };
    let force = campaign.contact_force.unwrap_or_default();
    let of_number = |known: Nominal| {
        let other_rod = rod.with(&known.number, known.value + known.standard_uncertainty);
        let other = model(&other_rod)?;
        let by_force = (other.force - nominal.force) / known.standard_uncertainty;
        let by_weight = (other.gravity - nominal.gravity) / known.standard_uncertainty / STANDARD_GRAVITY;
        let column = context.column(|row, there| {
            let force = context.recording.device(row).rotation * force;
            let [weight, other_weight] = [rod, &other_rod].map(|rod| {
                let centre = there.flange.point(&rod.centre_of_mass());
                there.joint_deflection(&centre, &(there.gravity * rod.mass()))
            });
            let by_drives = (other_weight - weight) / known.standard_uncertainty;
            there.in_world(&by_force) * force + there.in_world(&by_weight) * there.gravity + by_drives
        });
        let (unit, si, value) = known.for_people();
        let number = NominalParameter {
            name: known.number.to_string(),
            unit,
            si,
            value,
            standard_uncertainty: known.standard_uncertainty,
        };
        Some((number, column))
    };
    rod.nominal_numbers().into_iter().filter_map(of_number).collect()
}

/// Whose the scatter is, altogether and along each axis e of {T}, by what a displacement has in
/// common with its residual: with E_ab the displacement along b shown along a, without what is
/// fitted,
///
/// ```text
/// E[r | û] = (λ − ½)·Σ_ab (G⁻¹·h)_ab·E_ab      G = Eᵀ·E, h_ab = σ²·Σ_rows (R_c·a)ᵀ·R·e·eᵀ·Rᵀ·(R_c·b)
/// ```
///
/// û = u − ½·r, σ² of a coordinate along e; altogether with I in place of e·eᵀ.
fn of_readings(evidence: &Evidence, context: &Context) -> Vec<(NominalParameter, Column)> {
    // what a calibration leaves is no scatter yet
    let Some(left_of_rows) = context.left_of_rows().filter(|_| context.shows_displacements()) else {
        return Vec::new();
    };
    let device = |row: usize| context.recording.device(row).rotation;
    let mut shown = DMatrix::zeros(evidence.residual.len(), 9);
    for (k, mut column) in shown.column_iter_mut().enumerate() {
        let of_row = |row: usize| device(row).column(k / 3) * context.displacement(row)[k % 3];
        context.column(|row, _| of_row(row)).add_to_slice(column.as_mut_slice(), 1.0);
    }
    let left = Whitening::new(evidence, &evidence.residual).apply_columns(&shown);
    let Some(gram) = left.tr_mul(&left).cholesky() else { return Vec::new() };
    let of_part = |(along, of_what): (Matrix3<f64>, String)| {
        let rows = || context.configurations.iter().enumerate();
        let scatter: f64 =
            rows().map(|(row, there)| (there.in_world(&along) * left_of_rows[row]).norm_squared()).sum();
        let common: Matrix3<f64> =
            rows().map(|(row, there)| device(row).tr_mul(&there.in_world(&along)) * device(row)).sum();
        let per_share = scatter / (rows().len() as f64 * along.trace());
        let share = gram.solve(&DVector::from_fn(9, |k, _| per_share * common[(k / 3, k % 3)]));
        let share = Matrix3::from_fn(|a, b| share[3 * a + b]);
        let column = context.column(|row, _| device(row) * (share * context.displacement(row)));
        let number = NominalParameter {
            name: format!("share of the scatter{of_what} that is the readings'"),
            unit: "",
            si: 1.0,
            value: 0.5,
            standard_uncertainty: EVENLY,
        };
        (number, column)
    };
    let of_axis = |axis: Axis| {
        let along = Matrix3::from_fn(|i, j| f64::from(u8::from(i == j && i == axis.index())));
        (along, format!(" along {axis} of the tool"))
    };
    let whole = std::iter::once((Matrix3::identity(), String::new()));
    whole.chain(Axis::ALL.map(of_axis)).map(of_part).collect()
}

fn of_clamps(campaign: &Campaign, context: &Context) -> Vec<(NominalParameter, Column)> {
    let Some(sd) = campaign.clamp_uncertainty.filter(|sd| *sd > 0.0 && !context.has_sockets()) else {
        return Vec::new();
    };
    let groups = &context.recording.groups;
    let places = (0..groups.len()).flat_map(|group| Axis::ALL.map(|axis| (group, axis)));
    let of_place = |(group, axis): (usize, Axis)| {
        let number = NominalParameter {
            name: format!("{axis} of {}", groups[group].name),
            unit: "mm",
            si: MM,
            value: groups[group].device.origin[axis.index()],
            standard_uncertainty: sd,
        };
        let column = context.column(|row, _| match context.recording.rows[row].group == group {
            true => -Vector3::ith(axis.index(), 1.0),
            false => Vector3::zeros(),
        });
        (number, column)
    };
    places.map(of_place).collect()
}
