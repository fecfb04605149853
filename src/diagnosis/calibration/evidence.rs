//! What the engine knows about a calibrated campaign: what is left, what the calibration can
//! absorb, what to hold out.
//!
//! ```text
//! datum      (recorded − predicted)·w     three per row, in {W}, m; w is the pooled noise over the
//!                                         noise of the group
//! nuisance   ∂predicted/∂ρ·w              over all that the calibration is free to change, −w for
//!                                         a socket's own place or a station's frame
//! ```
//!
//! so that one noise σ holds for all data. Directions of ρ that the calibration holds are no
//! columns. Socket distances are further data with no row, in units of σ; no fold holds them out.
//!
//! What the drawing or the user knows of ρ, ρ₀ ± s, is a background: the residual is that at ρ₀ and
//! the columns of those parameters, times s, have factors that are standard normal,
//!
//! ```text
//! residual      recorded − predicted(ρ̂) + J·(ρ̂ − ρ₀)
//! background    J·s
//! ```
//!
//! so that what is known counts the same whatever noise a hypothesis leaves.

mod nominal;

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector, Vector3};

use super::model::{Configuration, Context};
use crate::calibration::campaign::{Campaign, Recording, Targets};
use crate::calibration::{Calibration, MOST_SCATTER};
use crate::inference::{Covariate, Evidence, JointVariable, Variable};
use crate::robot::Kinematics;
use crate::spatial::{Axis, skew};
use crate::units::MM;

/// Most folds, and the rows that each should have at least.
const MOST_FOLDS: usize = 5;
const ROWS_PER_FOLD: usize = 10;
/// Blocks of a fold in the rows of a clamp or socket, where these are at least [`LEAST_BLOCK`]
/// long; else there is one.
const ROUNDS: usize = 4;
const LEAST_BLOCK: usize = 5;
/// Coarsest and finest last digit of a displacement that is looked for: mm to the power of ten.
const DIGITS: std::ops::RangeInclusive<i32> = -6..=-1;

/// A number that is known besides what was recorded: residual and ∂/∂ρ (free parameters, then
/// sockets), both over σ.
struct Known {
    residual: f64,
    slopes: Vec<(usize, f64)>,
}

/// The evidence of a calibration.
pub(super) fn evidence_of(campaign: &Campaign, calibration: &Calibration, context: &Context) -> Evidence {
    let recording = &campaign.measurements;
    let known = known(campaign, calibration);
    let (rows, data) = (recording.len(), 3 * recording.len() + known.len());
    let sigma = context.noise;
    let mut residual = DVector::zeros(data);
    for row in 0..rows {
        residual.fixed_rows_mut::<3>(3 * row).copy_from(&-context.counted(row, &calibration.deviations[row]));
    }
    let moved = if context.has_sockets() { 0 } else { recording.stations.len().saturating_sub(1) };
    let columns = calibration.parameters.len() + 3 * calibration.sockets.len() + 6 * moved;
    let mut jacobian = DMatrix::zeros(data, columns);
    fill(&mut jacobian, calibration, context);
    for (at, known) in known.iter().enumerate() {
        residual[3 * rows + at] = known.residual * sigma;
        for &(column, slope) in &known.slopes {
            jacobian[(3 * rows + at, column)] = slope * sigma;
        }
    }
    let per_row = |of_row: Vec<usize>, further: &dyn Fn(usize) -> usize| -> Vec<usize> {
        let of_rows = of_row.into_iter().flat_map(|number| [number; 3]);
        of_rows.chain((3 * rows..data).map(further)).collect()
    };
    let groups = replicate_groups(recording);
    let jacobian = without_held(jacobian, calibration);
    let priors = &calibration.priors;
    let mut background = DMatrix::zeros(data, priors.len());
    for (mut column, prior) in background.column_iter_mut().zip(priors) {
        let own = jacobian.column(prior.parameter);
        residual.axpy(calibration.parameters[prior.parameter].value - prior.value, &own, 1.0);
        column.axpy(prior.sd, &own, 0.0);
    }
    let is_known = |k: &usize| priors.iter().any(|prior| prior.parameter == *k);
    let unknown: Vec<usize> = (0..jacobian.ncols()).filter(|k| !is_known(k)).collect();
    let evidence = Evidence {
        nuisance: jacobian.select_columns(&unknown),
        background,
        stated_noise: campaign.noise,
        most_scatter: most_scatter(calibration),
        replicate_group: groups
            .iter()
            .flat_map(|group| [3 * group, 3 * group + 1, 3 * group + 2])
            .chain(3 * rows..data)
            .collect(),
        shared: (0..data).collect(),
        fold: per_row(folds(recording, &groups), &|_| Evidence::NONE),
        session: per_row(sessions(recording), &|_| Evidence::NONE),
        intercept: intercepts(recording, data),
        resolution: resolution(recording),
        covariates: covariates(context, data),
        courses: courses(rows, data),
        recorded: 3 * rows,
        ..Evidence::new(residual)
    };
    nominal::with_numbers(evidence, campaign, calibration.mode, context)
}

/// The evidence of a calibration of which nothing is known beforehand: all that it is free to
/// change takes up what it can, however far from the drawing.
pub(super) fn unknown_beforehand(evidence: &Evidence) -> Evidence {
    let (nuisance, background) = (&evidence.nuisance, &evidence.background);
    let mut columns = DMatrix::zeros(nuisance.nrows(), nuisance.ncols() + background.ncols());
    columns.columns_mut(0, nuisance.ncols()).copy_from(nuisance);
    columns.columns_mut(nuisance.ncols(), background.ncols()).copy_from(background);
    let background = DMatrix::zeros(nuisance.nrows(), 0);
    Evidence { nuisance: columns, background, ..evidence.clone() }
}

/// Each coordinate in the order of the poses: neighbours may have errors in common.
fn courses(rows: usize, data: usize) -> Vec<Option<(usize, f64)>> {
    (0..data).map(|datum| (datum < 3 * rows).then_some((datum % 3, (datum / 3) as f64))).collect()
}

/// The largest scatter of a coordinate that an arm may have, m; `None` where it does not reach
/// anywhere.
fn most_scatter(calibration: &Calibration) -> Option<f64> {
    (calibration.reach > 0.0).then_some(MOST_SCATTER * calibration.reach / 3.0f64.sqrt())
}

fn known(campaign: &Campaign, calibration: &Calibration) -> Vec<Known> {
    let place = |group: usize| Vector3::from(calibration.sockets[group].map(|(value, _)| value));
    let distances = match &campaign.measurements.targets {
        Targets::Points(_) => &[][..],
        Targets::Sockets(distances) => distances,
    };
    let of_distances = distances.iter().map(|distance| {
        let apart = place(distance.between[0]) - place(distance.between[1]);
        let towards = apart / apart.norm().max(f64::MIN_POSITIVE) / distance.sd;
        let slopes = |group: usize, sign: f64| {
            (0..3).map(move |axis| (free_count(calibration) + 3 * group + axis, sign * towards[axis]))
        };
        Known {
            residual: (distance.value - apart.norm()) / distance.sd,
            slopes: slopes(distance.between[0], 1.0).chain(slopes(distance.between[1], -1.0)).collect(),
        }
    });
    of_distances.collect()
}

fn free_count(calibration: &Calibration) -> usize {
    calibration.parameters.len()
}

/// The rows of the Jacobian that belong to rows of the recording.
fn fill(jacobian: &mut DMatrix<f64>, calibration: &Calibration, context: &Context) {
    let mut kinematics = Kinematics::new(&calibration.setup);
    let weights = context.weights();
    for (row, configuration) in context.configurations.iter().enumerate() {
        kinematics.update(&configuration.joints, &configuration.torque);
        kinematics.tip = configuration.tip;
        let torque = context.torque_with_carried(row);
        for (k, estimated) in calibration.parameters.iter().enumerate() {
            let column = context.counted(row, &kinematics.column(estimated.parameter, &torque));
            jacobian.fixed_view_mut::<3, 1>(3 * row, k).copy_from(&column);
        }
        if context.has_sockets() {
            let first = free_count(calibration) + 3 * context.recording.rows[row].group;
            jacobian.fixed_view_mut::<3, 3>(3 * row, first).copy_from(&-weights[row]);
            continue;
        }
        let station = context.recording.rows[row].station;
        if station > 0 {
            // the frame of its station, to first order: t and φ about the base
            let first = free_count(calibration) + 6 * (station - 1);
            let arm = configuration.tip - calibration.setup.base_guess.origin;
            jacobian.fixed_view_mut::<3, 3>(3 * row, first).copy_from(&-weights[row]);
            jacobian.fixed_view_mut::<3, 3>(3 * row, first + 3).copy_from(&(weights[row] * skew(&arm)));
        }
    }
}

/// Columns of the free parameters without what they have of directions that are held (in plausible
/// ranges): J·D·(1 − V·Vᵀ)·D⁻¹.
fn without_held(mut jacobian: DMatrix<f64>, calibration: &Calibration) -> DMatrix<f64> {
    let Some(first) = calibration.held.first() else { return jacobian };
    let free = free_count(calibration);
    let ranges = DVector::from_column_slice(&first.ranges);
    let mut moves = DMatrix::identity(free, free);
    for held in &calibration.held {
        let direction = DVector::from_column_slice(&held.direction);
        moves -= &direction * direction.transpose();
    }
    let moves = DMatrix::from_fn(free, free, |i, k| moves[(i, k)] * ranges[i] / ranges[k]);
    let moved = jacobian.columns(0, free) * moves;
    jacobian.columns_mut(0, free).copy_from(&moved);
    jacobian
}

/// Rows of the same joint values in the same clamp or socket have one number.
fn replicate_groups(recording: &Recording) -> Vec<usize> {
    let mut known: BTreeMap<(usize, Vec<u64>), usize> = BTreeMap::new();
    (0..recording.len())
        .map(|row| {
            let bits = recording.joints(row).iter().map(|q| q.to_bits()).collect();
            let count = known.len();
            *known.entry((recording.rows[row].group, bits)).or_insert(count)
        })
        .collect()
}

/// Blocks of consecutive rows of each clamp or socket, dealt to the folds in turn: neighbours,
/// which often share an error, are held out together, and no fold is a corner of the workspace.
/// Repeats stay together.
fn folds(recording: &Recording, replicate_groups: &[usize]) -> Vec<usize> {
    let folds = (recording.len() / ROWS_PER_FOLD).clamp(2, MOST_FOLDS);
    let mut size = vec![0usize; recording.groups.len()];
    recording.rows.iter().for_each(|row| size[row.group] += 1);
    let mut seen = vec![0usize; recording.groups.len()];
    let mut fold_of = BTreeMap::new();
    recording
        .rows
        .iter()
        .zip(replicate_groups)
        .map(|(row, &replicates)| {
            let (at, size) = (seen[row.group], size[row.group]);
            seen[row.group] += 1;
            let rounds = if size >= ROUNDS * folds * LEAST_BLOCK { ROUNDS } else { 1 };
            *fold_of.entry(replicates).or_insert((at * folds * rounds / size + row.group) % folds)
        })
        .collect()
}

/// For each row the number of its clamp, or of its sockets' placement.
fn sessions(recording: &Recording) -> Vec<usize> {
    let session = recording.session_by_group();
    recording.rows.iter().map(|row| session[row.group]).collect()
}

/// Coordinates of a socket have an intercept of their own: nobody knows where it is.
fn intercepts(recording: &Recording, data: usize) -> Vec<usize> {
    let of_row = |row: usize, axis: usize| match recording.targets {
        Targets::Points(_) => Evidence::NONE,
        Targets::Sockets(_) => 3 * recording.rows[row].group + axis,
    };
    let of_datum = |datum: usize| match datum / 3 < recording.len() {
        true => of_row(datum / 3, datum % 3),
        false => Evidence::NONE,
    };
    (0..data).map(of_datum).collect()
}

/// The step that all displacements are multiples of, m; 0 where they show none and where nothing is
/// measured.
fn resolution(recording: &Recording) -> f64 {
    /// The file's decimals are not exact in binary, and clamps are turned.
    const INEXACT: f64 = 1e-4;
    let Targets::Points(points) = &recording.targets else { return 0.0 };
    let read: Vec<f64> = points
        .iter()
        .enumerate()
        .flat_map(|(row, point)| {
            let read: [f64; 3] = (recording.device(row).inverse().point(point) / MM).into();
            read
        })
        .collect();
    let is_step = |step: &f64| {
        read.iter().all(|value| {
            let steps = value / step;
            (steps - steps.round()).abs() <= INEXACT
        })
    };
    let steps = DIGITS.rev().flat_map(|digit| [5.0, 2.0, 1.0].map(|m| m * 10f64.powi(digit)));
    steps.into_iter().find(is_step).map_or(0.0, |step| step * MM)
}

/// What a row has of a variable.
type Value<'a> = Box<dyn Fn(usize, &Configuration) -> Option<f64> + 'a>;

fn covariates(context: &Context, data: usize) -> Vec<Covariate> {
    let rows = &context.recording.rows;
    let temperatures = context.recording.temperatures();
    let mut all: Vec<(Variable, Value)> = vec![
        (Variable::Order, Box::new(|row, _| Some(row as f64))),
        (Variable::Time, Box::new(|row, _| rows[row].time)),
        (Variable::Temperature, Box::new(|row, _| temperatures.as_ref().map(|own| own[row]))),
        (Variable::Fixture, Box::new(|row, _| Some(rows[row].group as f64))),
    ];
    for axis in Axis::ALL {
        all.push((Variable::Tip(axis), Box::new(move |_, there| Some(there.tip[axis.index()]))));
    }
    for j in 0..context.joint_count() {
        let of_joint = |what: JointVariable| Variable::Joint(j, what);
        all.push((of_joint(JointVariable::Angle), Box::new(move |_, there| Some(there.joints[j]))));
        all.push((of_joint(JointVariable::Torque), Box::new(move |_, there| Some(there.torque[j]))));
        all.push((of_joint(JointVariable::Approach), Box::new(move |_, there| Some(there.approach[j]))));
        all.push((of_joint(JointVariable::Move), Box::new(move |_, there| Some(there.step[j]))));
    }
    let covariates = all.into_iter().map(|(variable, value)| {
        let of_rows = context
            .configurations
            .iter()
            .enumerate()
            .flat_map(|(row, there)| [value(row, there).unwrap_or(f64::NAN); 3]);
        let further = data - 3 * context.configurations.len();
        let values = of_rows.chain(std::iter::repeat_n(f64::NAN, further)).collect();
        Covariate { variable, values }
    });
    // nothing can follow what does not vary
    covariates.filter(Covariate::varies).collect()
}
