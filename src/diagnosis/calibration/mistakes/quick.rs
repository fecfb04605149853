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

mod density;
mod distance;
mod loaded_robot;
mod means;
mod priors;
mod residuals;
mod rough;
mod tether;
mod zeros;

use nalgebra::{DMatrix, DVector, Vector3};

pub(super) use self::density::{density, ln_volume, t_scale, weight_of};
pub(super) use self::loaded_robot::LoadedRobot;
use self::means::{minus_means, without_means};
use self::priors::{moved, prior_precision, sizes};
pub(super) use self::residuals::from_points;
use self::residuals::{FitState, load, residuals, tips};
use self::rough::rough;
pub(super) use self::rough::{FAILED, has_failed, left_by, placed};
use self::tether::{pull, pulled};
pub(super) use self::zeros::zeros;
use super::draft::{Draft, DraftChange};
use crate::calibration::growth::log_volume;
use crate::calibration::least_value;
use crate::linalg::transposed_product;
use crate::robot::{Parameter, ParameterGroup, Setup};
use crate::spatial::{Pose, exponential};

/// Scatter that no file goes below, as a share of the reach: 10 µm per metre.
const LEAST_SCALE: f64 = 1e-5;
const MOST_STEPS: usize = 12;
/// After so many steps what one gains tells the rest, which is so many times as much at most.
const SETTLING: usize = 2;
const AHEAD: f64 = 10.0;

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

/// What a fit that is worth its time comes to.
#[derive(Clone, Copy)]
pub(super) struct Worthwhile {
    /// The nominal robot leaves no more, m (median).
    pub most_left: f64,
    /// Ln of the density is no less in the end.
    pub log_likelihood: f64,
}

impl Worthwhile {
    /// Every draft is worthwhile, whatever it leaves.
    pub const ANY: Worthwhile = Worthwhile { most_left: f64::INFINITY, log_likelihood: f64::NEG_INFINITY };
}

/// Fits a draft; `None` where that is not worthwhile, or nothing can be computed.
pub(super) fn fit(draft: &Draft, body: &LoadedRobot, worthwhile: Worthwhile) -> Option<Fit> {
    let rough = rough(draft, body.robot, body.reach)?;
    if rough.median > worthwhile.most_left {
        return None;
    }
    let setup = Setup::new(body.robot, Pose::IDENTITY, rough.tool);
    let state = FitState { setup, bases: rough.bases };
    refined(draft, body, state, rough.median, worthwhile.log_likelihood)
}

/// Fits a draft from where another one's fit ended: rows that hardly count there may be others than
/// from the rough start.
pub(super) fn fit_from(draft: &Draft, body: &LoadedRobot, start: &Fit, rough: f64) -> Option<Fit> {
    let mut bases = start.bases.clone();
    bases.truncate(draft.stations);
    if !draft.has_sockets() && bases.len() < draft.stations {
        return None;
    }
    refined(draft, body, FitState { setup: start.setup(body), bases }, rough, f64::NEG_INFINITY)
}

fn refined<'a>(
    draft: &Draft,
    body: &LoadedRobot<'a>,
    mut state: FitState<'a>,
    rough: f64,
    worthwhile: f64,
) -> Option<Fit> {
    let mut torque = vec![0.0; draft.joints.len()];
    let mut deflection = vec![Vector3::zeros(); draft.len()];
    load(draft, body, &state, &mut torque, &mut deflection);
    let sd = sizes(draft, body, &torque);
    let as_drawn = Setup::new(body.robot, Pose::IDENTITY, state.setup.tool);
    let nominal: Vec<f64> = body.free.iter().map(|&p| as_drawn.get(p)).collect();
    let lowest: Vec<f64> = body.free.iter().map(|&p| least_value(&as_drawn, p)).collect();
    let known = KnownNumbers { nominal: &nominal, lowest: &lowest, sd: &sd };
    let least = LEAST_SCALE * body.reach;
    let mut best: Option<(f64, f64, FitState, Vec<Vector3<f64>>)> = None;
    // rows that a mistake touches hardly count in the middle of a socket either
    let mut weight = vec![1.0; draft.len()];
    for taken in 0..MOST_STEPS {
        let mut block = DMatrix::zeros(3 * draft.len(), body.free.len() + 6 * state.bases.len());
        let columns = Some((&body.free[..], &mut block));
        let off = residuals(draft, &state, &torque, &deflection, columns, &weight);
        let lengths: Vec<f64> = off.iter().map(|off| off.norm()).collect();
        let scale = t_scale(&lengths, least);
        let log_likelihood =
            density(&lengths, scale) - moved(body, &state, &nominal, &sd) - pulled(draft, &state);
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
        state = step(draft, body, &state, (&off, &lengths, scale), &known, block)?;
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

/// What is known of the free parameters beforehand.
struct KnownNumbers<'a> {
    nominal: &'a [f64],
    /// No parameter is less. Drives that turned against their loads would explain gravity of the
    /// other sign as well as it does itself.
    lowest: &'a [f64],
    /// Standard deviations about the nominal values.
    sd: &'a [f64],
}

/// One Gauss–Newton step, by the columns of the state.
fn step<'a>(
    draft: &Draft,
    body: &LoadedRobot,
    state: &FitState<'a>,
    (off, lengths, scale): (&[Vector3<f64>], &[f64], f64),
    known: &KnownNumbers,
    mut block: DMatrix<f64>,
) -> Option<FitState<'a>> {
    let (free, columns) = (body.free.len(), block.ncols());
    let mut right = DVector::zeros(3 * draft.len());
    for (row, (off, length)) in off.iter().zip(lengths).enumerate() {
        let root = weight_of(length / scale).sqrt() / scale;
        block.rows_mut(3 * row, 3).scale_mut(root);
        right.fixed_rows_mut::<3>(3 * row).copy_from(&(off * root));
    }
    let mut normal = transposed_product(&block, &block);
    let mut gradient = block.tr_mul(&right);
    let precision = prior_precision(known.sd, columns);
    for (k, precision) in precision.iter().enumerate() {
        normal[(k, k)] += precision;
        // the tip has a ridge only: it is where it fits
        if k < free && body.free[k].group() != ParameterGroup::Tool {
            gradient[k] += precision * (state.setup.get(body.free[k]) - known.nominal[k]);
        }
    }
    pull(draft, state, free, &mut normal, &mut gradient);
    let room: Vec<f64> = (0..free).map(|k| state.setup.get(body.free[k]) - known.lowest[k]).collect();
    let change = within_room(&normal, &gradient, &room)?;
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

/// What to take from the parameters so that none goes below its lowest value, `room` away: those
/// that would do so stop there, and the others are where they fit best then.
fn within_room(normal: &DMatrix<f64>, gradient: &DVector<f64>, room: &[f64]) -> Option<DVector<f64>> {
    let (mut normal, mut gradient) = (normal.clone(), gradient.clone());
    let mut is_stopped = vec![false; room.len()];
    loop {
        let change = normal.clone().cholesky()?.solve(&gradient);
        let beyond: Vec<usize> = (0..room.len()).filter(|&k| !is_stopped[k] && change[k] > room[k]).collect();
        if beyond.is_empty() {
            return Some(change);
        }
        for k in beyond {
            is_stopped[k] = true;
            let column = normal.column(k).into_owned();
            gradient.axpy(-room[k], &column, 1.0);
            normal.column_mut(k).fill(0.0);
            normal.row_mut(k).fill(0.0);
            normal[(k, k)] = 1.0;
            gradient[k] = room[k];
        }
    }
}

impl Fit {
    fn setup<'a>(&self, body: &LoadedRobot<'a>) -> Setup<'a> {
        let mut setup = Setup::new(body.robot, Pose::IDENTITY, self.tool);
        self.links.iter().for_each(|&(parameter, value)| setup.set(parameter, value));
        setup
    }

    /// Ln of the volume that the recorded angles span ([`log_volume`]), in which a change of them
    /// all counts; nothing where points were measured.
    pub fn log_volume(&self, draft: &Draft, body: &LoadedRobot) -> f64 {
        if !draft.has_sockets() {
            return 0.0;
        }
        let mut factor = vec![1.0; draft.joint_count];
        for change in &draft.joint_changes {
            if let DraftChange::Joints { factor: by, .. } = change {
                factor.iter_mut().zip(by).for_each(|(factor, by)| *factor *= by);
            }
        }
        log_volume(&self.setup(body), &draft.joints, &factor)
    }

    /// Distances of the tip of every row of `draft` from its point, m, if its station were
    /// `station`.
    pub fn lengths_at(&self, draft: &Draft, body: &LoadedRobot, station: usize) -> Vec<f64> {
        let mut there = draft.clone();
        there.station.iter_mut().for_each(|own| *own = station);
        self.lengths(&there, body)
    }

    /// Distances of the tip of every row of `draft` from its point, m.
    pub fn lengths(&self, draft: &Draft, body: &LoadedRobot) -> Vec<f64> {
        let off = self.offsets(draft, body);
        minus_means(&off, draft, &vec![1.0; off.len()]).iter().map(|off| off.norm()).collect()
    }

    /// From the point of every row of `draft` to its tip, in {W}, m; with sockets the tip in {0}.
    pub fn offsets(&self, draft: &Draft, body: &LoadedRobot) -> Vec<Vector3<f64>> {
        from_points(draft, self.tips(draft, body))
    }

    /// The tip of every row of `draft`, in {W} (with sockets in {0}), m: a row's depends on its
    /// joints, its station and its device.
    pub fn tips(&self, draft: &Draft, body: &LoadedRobot) -> Vec<Vector3<f64>> {
        let state = FitState { setup: self.setup(body), bases: self.bases.clone() };
        let mut torque = vec![0.0; draft.joints.len()];
        let mut deflection = vec![Vector3::zeros(); draft.len()];
        load(draft, body, &state, &mut torque, &mut deflection);
        load(draft, body, &state, &mut torque, &mut deflection);
        tips(draft, &state, &torque, &deflection, None)
    }
}
