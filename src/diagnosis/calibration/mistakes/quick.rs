//! How well a draft fits its robot, quickly: base, tool and small corrections of the geometry.
//!
//! ```text
//! rᵢ = B·(tip(ρ, qᵢ) + R·Δxᵢ) − xᵢ       B the base, one for each station; with sockets less the mean
//!                                        of the socket's tips, of a clamp whose place is free of its rᵢ
//! ρ ~ N(nominal, twice what a robot file is known to)
//! density of |r|: Student's t with four degrees of freedom in space, its scale by maximum likelihood
//! ```
//!
//! Gauss–Newton with the weights (ν + 3)/(ν + (r/s)²) of that density: rows that a mistake touches
//! hardly count, as long as they are the fewer ones. Neither covariance nor uncertainty comes out.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::draft::Draft;
use crate::calibration::Compensation;
use crate::linalg::transposed_product;
use crate::robot::{Kinematics, Loads, Parameter, Robot, Setup, minimal_parameters};
use crate::spatial::{Pose, exponential, skew, times};
use crate::statistics::median;
use crate::units::{DEG, MM, STANDARD_GRAVITY};

/// Degrees of freedom of the residuals' distribution.
const NU: f64 = 4.0;
/// Standard deviations of a robot as built, twice the usual: lengths, twists, zeros of joints.
const LENGTH: f64 = 2.0 * MM;
const TWIST: f64 = 0.2 * DEG;
const ZERO: f64 = 0.6 * DEG;
/// How far a joint yields under its largest torque, rad.
const YIELDS: f64 = 1e-3;
/// A step of the tip is at most so uncertain, m: a ridge, no knowledge.
const TOOL: f64 = 0.5;
/// Scatter that no file goes below, as a share of the reach: 10 µm per metre.
const LEAST_SCALE: f64 = 1e-5;
const MOST_STEPS: usize = 12;
const MOST_TURNS: usize = 12;
/// Times that the middle of a socket is looked for roughly.
const ROUGH_MEANS: usize = 4;
/// After so many steps what one gains tells the rest, which is so many times as much at most.
const SETTLING: usize = 2;
const AHEAD: f64 = 10.0;
/// More rows than these add no evidence, for they share the same unknown physics; and what the
/// three coordinates of one row count.
const MOST_ROWS: f64 = 150.0;
const ROW: f64 = 1.0 / 3.0;
/// The median length of a normal vector in space.
const MEDIAN: f64 = 1.538;

/// A robot with what hangs on it.
pub(super) struct Body<'a> {
    pub robot: &'a Robot,
    pub compensation: Compensation,
    free: Vec<Parameter>,
    /// Largest distance of the tip from the first joint, m.
    pub reach: f64,
}

/// A draft fitted.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    /// Lengths of the residuals by row, m.
    pub residuals: Vec<f64>,
    /// s of a coordinate, m.
    pub scale: f64,
    /// {0} in {W}, by station; empty with sockets.
    pub bases: Vec<Pose>,
    /// The tip in {T}, m.
    pub tool: Vector3<f64>,
    /// Ln of the density of the residuals and the corrections.
    pub log_likelihood: f64,
    /// Median length of what the nominal robot leaves, m.
    pub rough: f64,
    links: Vec<(Parameter, f64)>,
}

impl<'a> Body<'a> {
    pub fn new(robot: &'a Robot, compensation: Compensation, tool: Vector3<f64>, draft: &Draft) -> Body<'a> {
        let is_base = |p: &Parameter| matches!(p, Parameter::BasePosition(_) | Parameter::BaseRotation(_));
        let mut free = minimal_parameters(robot, tool, tool, compensation.payload);
        free.retain(|p| !is_base(p) && !matches!(p, Parameter::Tool(_)));
        free.extend((0..3).map(Parameter::Tool));
        let from = robot.root.origin;
        let reach = |row: usize| (robot.flange_at(draft.joints(row)).point(&tool) - from).norm();
        let reach = (0..draft.len()).map(reach).fold(0.0, f64::max);
        Body { robot, compensation, free, reach }
    }
}

/// Base and tool by the nominal robot, with the median length of what is left, m.
struct Rough {
    bases: Vec<Pose>,
    tool: Vector3<f64>,
    median: f64,
}

/// What a fit that is worth its time comes to.
#[derive(Clone, Copy)]
pub(super) struct Worthwhile {
    /// The nominal robot leaves no more, m (median).
    pub most_left: f64,
    /// Ln of the density is no less in the end.
    pub log_likelihood: f64,
}

impl Worthwhile {
    /// Any is.
    pub const ANY: Worthwhile = Worthwhile { most_left: f64::INFINITY, log_likelihood: f64::NEG_INFINITY };
}

/// Fits a draft; `None` where that is not worthwhile, or nothing can be computed.
pub(super) fn fit(draft: &Draft, body: &Body, worthwhile: Worthwhile) -> Option<Fit> {
    let rough = rough(draft, body)?;
    if rough.median > worthwhile.most_left {
        return None;
    }
    let setup = Setup::new(body.robot, Pose::IDENTITY, rough.tool);
    let state = State { setup, bases: rough.bases };
    refined(draft, body, state, rough.median, worthwhile.log_likelihood)
}

/// Fits a draft from where another one's fit ended: rows that hardly count there may be others than
/// from the rough start.
pub(super) fn fit_from(draft: &Draft, body: &Body, start: &Fit, rough: f64) -> Option<Fit> {
    let mut bases = start.bases.clone();
    bases.truncate(draft.stations);
    if !draft.has_sockets() && bases.len() < draft.stations {
        return None;
    }
    refined(draft, body, State { setup: start.setup(body), bases }, rough, f64::NEG_INFINITY)
}

fn rough(draft: &Draft, body: &Body) -> Option<Rough> {
    let flanges: Vec<Pose> = (0..draft.len()).map(|row| body.robot.flange_at(draft.joints(row))).collect();
    if draft.has_sockets() {
        let tool = draft.tool.unwrap_or_default();
        let tips: Vec<Vector3<f64>> = flanges.iter().map(|flange| flange.point(&tool)).collect();
        let mut weight = vec![1.0; tips.len()];
        let mut middle = f64::INFINITY;
        for _ in 0..ROUGH_MEANS {
            let left: Vec<f64> = minus_means(&tips, draft, &weight).iter().map(|r| r.norm()).collect();
            middle = median(&left)?;
            weight = left.iter().map(|left| weight_of(left / (middle / MEDIAN).max(1e-9))).collect();
        }
        return Some(Rough { bases: Vec::new(), tool, median: middle });
    }
    let points: Vec<Vector3<f64>> = (0..draft.len()).map(|row| draft.point(row)).collect();
    let mut best: Option<Rough> = None;
    let guess = draft.tool.unwrap_or_default();
    for start in [guess, Vector3::zeros(), Vector3::x() * 0.1, Vector3::z() * 0.1] {
        let mut tool = start;
        let mut weight = vec![1.0; points.len()];
        let mut before = f64::INFINITY;
        for _ in 0..MOST_TURNS {
            let tips: Vec<Vector3<f64>> = flanges.iter().map(|flange| flange.point(&tool)).collect();
            let bases: Vec<Pose> = (0..draft.stations)
                .map(|station| placed(&tips, &points, &weight, |row| draft.station[row] == station))
                .collect::<Option<_>>()?;
            let mut sum = (Vector3::zeros(), 0.0);
            let mut left = Vec::with_capacity(points.len());
            for (row, flange) in flanges.iter().enumerate() {
                let base = &bases[draft.station[row]];
                let off = points[row] - base.point(&tips[row]);
                sum.0 += flange.rotation.tr_mul(&base.rotation.tr_mul(&off)) * weight[row];
                sum.1 += weight[row];
                left.push(off.norm());
            }
            let median = median(&left)?;
            if !median.is_finite() {
                return None;
            }
            if best.as_ref().is_none_or(|best| median < best.median) {
                best = Some(Rough { bases, tool, median });
            }
            if median > 0.9 * before {
                break;
            }
            before = median;
            tool += sum.0 / f64::max(sum.1, f64::MIN_POSITIVE);
            weight = left.iter().map(|left| weight_of(left / (median / MEDIAN).max(1e-9))).collect();
        }
        if best.as_ref().is_some_and(|best| best.median < 3e-3 * body.reach) {
            break;
        }
    }
    best
}

/// (ν + 3)/(ν + u²).
fn weight_of(u: f64) -> f64 {
    (NU + 3.0) / (NU + u * u)
}

/// The motion of some tips that brings them closest to their points (Kabsch), weighted.
fn placed(
    tips: &[Vector3<f64>],
    points: &[Vector3<f64>],
    weight: &[f64],
    is_of: impl Fn(usize) -> bool,
) -> Option<Pose> {
    let rows: Vec<usize> = (0..tips.len()).filter(|&row| is_of(row)).collect();
    let total: f64 = rows.iter().map(|&row| weight[row]).sum::<f64>().max(f64::MIN_POSITIVE);
    let mean =
        |of: &[Vector3<f64>]| rows.iter().map(|&row| of[row] * weight[row]).sum::<Vector3<f64>>() / total;
    let (centre, goal) = (mean(tips), mean(points));
    let spread: Matrix3<f64> =
        rows.iter().map(|&row| (points[row] - goal) * (tips[row] - centre).transpose() * weight[row]).sum();
    if spread.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let svd = spread.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    let handed = (u.determinant() * v_t.determinant()).signum();
    // the smallest singular value is the last
    let rotation = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, handed)) * v_t;
    Some(Pose { rotation, origin: goal - rotation * centre })
}

/// Vectors less the weighted means of their sockets, or of the clamps whose place is free.
fn minus_means(vectors: &[Vector3<f64>], draft: &Draft, weight: &[f64]) -> Vec<Vector3<f64>> {
    let mut sum = vec![(Vector3::zeros(), 0.0f64); draft.devices.len()];
    for (row, vector) in vectors.iter().enumerate() {
        let (total, weights) = &mut sum[draft.group[row]];
        *total += vector * weight[row];
        *weights += weight[row];
    }
    let mean = |group: usize| match draft.is_loose(group) {
        true => sum[group].0 / sum[group].1.max(f64::MIN_POSITIVE),
        false => Vector3::zeros(),
    };
    vectors.iter().zip(&draft.group).map(|(vector, &group)| vector - mean(group)).collect()
}

/// A state of the fit.
#[derive(Clone)]
struct State<'a> {
    setup: Setup<'a>,
    bases: Vec<Pose>,
}

fn refined<'a>(
    draft: &Draft,
    body: &Body<'a>,
    mut state: State<'a>,
    rough: f64,
    worthwhile: f64,
) -> Option<Fit> {
    let mut torque = vec![0.0; draft.joints.len()];
    let mut deflection = vec![Vector3::zeros(); draft.len()];
    load(draft, body, &state, &mut torque, &mut deflection);
    let sd = sizes(draft, body, &torque);
    let as_drawn = Setup::new(body.robot, Pose::IDENTITY, state.setup.tool);
    let nominal: Vec<f64> = body.free.iter().map(|&p| as_drawn.get(p)).collect();
    let least = LEAST_SCALE * body.reach;
    let mut best: Option<(f64, f64, State, Vec<Vector3<f64>>)> = None;
    // rows that a mistake touches hardly count in the middle of a socket either
    let mut weight = vec![1.0; draft.len()];
    for taken in 0..MOST_STEPS {
        let mut block = DMatrix::zeros(3 * draft.len(), body.free.len() + 6 * state.bases.len());
        let columns = Some((&body.free[..], &mut block));
        let off = residuals(draft, &state, &torque, &deflection, columns, &weight);
        let lengths: Vec<f64> = off.iter().map(|off| off.norm()).collect();
        let scale = t_scale(&lengths, least);
        let log_likelihood = density(&lengths, scale) - moved(body, &state, &nominal, &sd);
        if !log_likelihood.is_finite() {
            break;
        }
        let gained = best.as_ref().map_or(f64::INFINITY, |(known, ..)| log_likelihood - known);
        if gained > 0.0 {
            best = Some((log_likelihood, scale, state.clone(), off.clone()));
        }
        if gained < 0.02 {
            break;
        }
        // steps gain less and less
        if taken >= SETTLING && log_likelihood + AHEAD * gained < worthwhile {
            return None;
        }
        without_means(&mut block, draft, &weight);
        weight = lengths.iter().map(|length| weight_of(length / scale)).collect();
        state = step(draft, body, &state, (&off, &lengths, scale), (&nominal, &sd), block)?;
        load(draft, body, &state, &mut torque, &mut deflection);
    }
    let (log_likelihood, scale, state, off) = best?;
    Some(Fit {
        residuals: off.iter().map(|off| off.norm()).collect(),
        scale,
        tool: state.setup.tool,
        links: body.free.iter().map(|&p| (p, state.setup.get(p))).collect(),
        bases: state.bases,
        rough,
        log_likelihood,
    })
}

/// Torques and deflections where the robot stands now.
fn load(draft: &Draft, body: &Body, state: &State, torque: &mut [f64], deflection: &mut [Vector3<f64>]) {
    let with = &body.compensation;
    let count = draft.joint_count;
    let mut kinematics = Kinematics::new(&state.setup);
    for row in 0..draft.len() {
        let torque = &mut torque[row * count..][..count];
        kinematics.update(draft.joints(row), torque);
        let device = &draft.devices[draft.group[row]];
        let in_world = times(&device.rotation, &with.contact_force);
        let tip_force = match state.bases.get(draft.station[row]) {
            Some(base) => base.rotation.tr_mul(&in_world),
            None => in_world,
        };
        let loads = Loads { gravity: body.robot.gravity, payload: with.payload, tip_force };
        kinematics.torques(&loads, torque);
        if let Some(compliance) = &with.compliance {
            let r = &kinematics.flange.rotation;
            let down = r.tr_mul(&body.robot.gravity) / STANDARD_GRAVITY;
            deflection[row] =
                times(&compliance.gravity, &down) + times(&compliance.force, &r.tr_mul(&tip_force));
        }
    }
}

/// Standard deviations of the free parameters.
fn sizes(draft: &Draft, body: &Body, torque: &[f64]) -> Vec<f64> {
    let largest = |j: usize| {
        let of_joint = torque.iter().skip(j).step_by(draft.joint_count);
        of_joint.fold(1e-6, |most: f64, torque| most.max(torque.abs()))
    };
    let size = |parameter: &Parameter| match parameter {
        Parameter::D(_) | Parameter::A(_) => LENGTH,
        Parameter::Alpha(_) | Parameter::Beta(_) => TWIST,
        Parameter::Theta(_) => ZERO,
        Parameter::Compliance(j) => YIELDS / largest(*j),
        _ => TOOL,
    };
    body.free.iter().map(size).collect()
}

/// By row, in {W} of its station (with sockets in {0}); the columns of the free parameters and, by
/// station, of its base, are filled in where they are asked for.
fn residuals(
    draft: &Draft,
    state: &State,
    torque: &[f64],
    deflection: &[Vector3<f64>],
    columns: Option<(&[Parameter], &mut DMatrix<f64>)>,
    weight: &[f64],
) -> Vec<Vector3<f64>> {
    let off = offsets(draft, state, torque, deflection, columns);
    minus_means(&off, draft, weight)
}

/// The same before the means of sockets are taken off.
fn offsets(
    draft: &Draft,
    state: &State,
    torque: &[f64],
    deflection: &[Vector3<f64>],
    mut columns: Option<(&[Parameter], &mut DMatrix<f64>)>,
) -> Vec<Vector3<f64>> {
    let count = draft.joint_count;
    let mut kinematics = Kinematics::new(&state.setup);
    let mut off = Vec::with_capacity(draft.len());
    for row in 0..draft.len() {
        let torque = &torque[row * count..][..count];
        kinematics.update(draft.joints(row), torque);
        kinematics.tip += times(&kinematics.flange.rotation, &deflection[row]);
        let base = state.bases.get(draft.station[row]).copied().unwrap_or(Pose::IDENTITY);
        let tip = base.point(&kinematics.tip);
        off.push(if draft.has_sockets() { tip } else { tip - draft.point(row) });
        if let Some((free, block)) = &mut columns {
            for (k, &parameter) in free.iter().enumerate() {
                let column = times(&base.rotation, &kinematics.column(parameter, torque));
                block.fixed_view_mut::<3, 1>(3 * row, k).copy_from(&column);
            }
            if !state.bases.is_empty() {
                let first = free.len() + 6 * draft.station[row];
                let arm = -skew(&(tip - base.origin));
                (0..3).for_each(|axis| block[(3 * row + axis, first + axis)] = 1.0);
                block.fixed_view_mut::<3, 3>(3 * row, first + 3).copy_from(&arm);
            }
        }
    }
    off
}

/// One Gauss–Newton step, by the columns of the state.
fn step<'a>(
    draft: &Draft,
    body: &Body,
    state: &State<'a>,
    (off, lengths, scale): (&[Vector3<f64>], &[f64], f64),
    (nominal, sd): (&[f64], &[f64]),
    mut block: DMatrix<f64>,
) -> Option<State<'a>> {
    let (free, columns) = (body.free.len(), block.ncols());
    let mut right = DVector::zeros(3 * draft.len());
    for (row, (off, length)) in off.iter().zip(lengths).enumerate() {
        let root = weight_of(length / scale).sqrt() / scale;
        block.rows_mut(3 * row, 3).scale_mut(root);
        right.fixed_rows_mut::<3>(3 * row).copy_from(&(off * root));
    }
    let mut normal = transposed_product(&block, &block);
    let mut gradient = block.tr_mul(&right);
    for k in 0..free {
        let precision = sd[k].powi(-2);
        normal[(k, k)] += precision;
        // the tip has a ridge only: it is where it fits
        if !matches!(body.free[k], Parameter::Tool(_)) {
            gradient[k] += precision * (state.setup.get(body.free[k]) - nominal[k]);
        }
    }
    for k in free..columns {
        normal[(k, k)] += 1e-6;
    }
    let change = normal.cholesky()?.solve(&gradient);
    let mut next = state.clone();
    for (k, &parameter) in body.free.iter().enumerate() {
        next.setup.set(parameter, state.setup.get(parameter) - change[k]);
    }
    for (station, base) in next.bases.iter_mut().enumerate() {
        let six = change.fixed_rows::<6>(free + 6 * station);
        let turn: Vector3<f64> = -six.fixed_rows::<3>(3).into_owned();
        base.rotation = exponential(&turn) * base.rotation;
        base.origin -= six.fixed_rows::<3>(0).into_owned();
    }
    Some(next)
}

/// Columns of displacements less the means of their sockets, or of the clamps whose place is free.
fn without_means(block: &mut DMatrix<f64>, draft: &Draft, weight: &[f64]) {
    if !draft.has_sockets() && draft.loose.is_empty() {
        return;
    }
    let mut size = vec![0.0f64; draft.devices.len()];
    draft.group.iter().zip(weight).for_each(|(&group, weight)| size[group] += weight);
    for mut column in block.column_iter_mut() {
        let mut sum = vec![Vector3::zeros(); size.len()];
        for (row, &group) in draft.group.iter().enumerate() {
            sum[group] += column.fixed_rows::<3>(3 * row) * weight[row];
        }
        for (row, &group) in draft.group.iter().enumerate().filter(|(_, group)| draft.is_loose(**group)) {
            let mut own = column.fixed_rows_mut::<3>(3 * row);
            own -= sum[group] / size[group].max(f64::MIN_POSITIVE);
        }
    }
}

/// ½·Σ((ρ − nominal)/sd)², the tip excepted.
fn moved(body: &Body, state: &State, nominal: &[f64], sd: &[f64]) -> f64 {
    let of = |k: usize| match body.free[k] {
        Parameter::Tool(_) => 0.0,
        parameter => ((state.setup.get(parameter) - nominal[k]) / sd[k]).powi(2),
    };
    0.5 * (0..body.free.len()).map(of).sum::<f64>()
}

/// The scale that is likeliest, by the fixed point s² = Σ w·r²/3n.
fn t_scale(lengths: &[f64], least: f64) -> f64 {
    let start = median(lengths).unwrap_or(0.0) / MEDIAN;
    let mut scale = start.max(least);
    for _ in 0..30 {
        let sum: f64 = lengths.iter().map(|r| weight_of(r / scale) * r * r).sum();
        let next = (sum / (3.0 * lengths.len().max(1) as f64)).sqrt().max(least);
        let has_arrived = (next / scale - 1.0).abs() < 1e-4;
        scale = next;
        if has_arrived {
            break;
        }
    }
    scale
}

/// Ln of the density of all rows, as many as count.
fn density(lengths: &[f64], scale: f64) -> f64 {
    let of = |r: &f64| -3.0 * scale.ln() - 0.5 * (NU + 3.0) * ((r / scale).powi(2) / NU).ln_1p();
    let sum: f64 = lengths.iter().map(of).sum();
    let count = lengths.len().max(1) as f64;
    sum / count * count.min(MOST_ROWS) * ROW
}

impl Fit {
    fn setup<'a>(&self, body: &Body<'a>) -> Setup<'a> {
        let mut setup = Setup::new(body.robot, Pose::IDENTITY, self.tool);
        self.links.iter().for_each(|&(parameter, value)| setup.set(parameter, value));
        setup
    }

    /// Distances of the tip of every row of `draft` from its point, m, if its station were
    /// `station`.
    pub fn lengths_at(&self, draft: &Draft, body: &Body, station: usize) -> Vec<f64> {
        let mut there = draft.clone();
        there.station.iter_mut().for_each(|own| *own = station);
        self.lengths(&there, body)
    }

    /// Distances of the tip of every row of `draft` from its point, m.
    pub fn lengths(&self, draft: &Draft, body: &Body) -> Vec<f64> {
        let off = self.offsets(draft, body);
        minus_means(&off, draft, &vec![1.0; off.len()]).iter().map(|off| off.norm()).collect()
    }

    /// From the point of every row of `draft` to its tip, in {W}, m; with sockets the tip in {0}.
    pub fn offsets(&self, draft: &Draft, body: &Body) -> Vec<Vector3<f64>> {
        let state = State { setup: self.setup(body), bases: self.bases.clone() };
        let mut torque = vec![0.0; draft.joints.len()];
        let mut deflection = vec![Vector3::zeros(); draft.len()];
        load(draft, body, &state, &mut torque, &mut deflection);
        load(draft, body, &state, &mut torque, &mut deflection);
        offsets(draft, &state, &torque, &deflection, None)
    }
}
