//! How the error of a pose scatters: as much along every axis, and besides along what a source of
//! scatter moves.
//!
//! ```text
//! C = s²·1 + Σₖ vₖ·Bₖ       B = Σ d·dᵀ over the directions d that source k moves the tip along
//! W = σ·C^(−½), σ² = mean of tr C/3 over the poses
//! ```
//!
//! s² stands for a device that reads all three axes equally well. An angle that scatters, or that
//! was rounded, moves the tip along ∂tip/∂q and along nothing else, the more the longer its lever;
//! a camera sees depth less well than what is across. W whitens the poses: a row that counts by
//! it has errors of one variance σ² along every axis. (S. R. Searle, G. Casella, C. E. McCulloch,
//! *Variance Components*, Wiley 1992.)

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use super::Context;
use super::configuration::sight;
use crate::robot::Motion;
use crate::spatial::Axis;

/// What makes poses scatter, beside what is as large along every axis.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Source {
    /// Angles that are written in steps: known, nothing is estimated.
    Written,
    /// The angles of all joints that turn, all alike, rad.
    Joints,
    /// The angle of one joint from 0, rad.
    Angle(usize),
    /// The position of one that slides, from 0, m.
    Position(usize),
    /// What the device shows along an axis of its own, m.
    Device(Axis),
    /// The distance at which a device in the origin of {W} sees the ball, m.
    Distance,
    /// The direction in which it sees it, rad.
    Direction,
}

/// s², m², and v of each source: of [`Source::Written`] 1.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Covariance {
    /// As large along every axis, m².
    pub own: f64,
    /// What else, and its variance in the source's unit.
    pub sources: Vec<(Source, f64)>,
}

/// What the scatter of the poses is made of.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ScatterSources {
    /// Standard deviation of what is as large along every axis, m.
    pub own: f64,
    /// What else, the largest share first.
    pub sources: Vec<ScatterSource>,
}

/// One source of it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ScatterSource {
    /// What scatters.
    pub source: Source,
    /// Its standard deviation, rad or m; of angles that are written in steps the coarsest step.
    pub size: f64,
    /// Share of the mean square of a coordinate that it has.
    pub share: f64,
}

impl Covariance {
    /// C of a row, m².
    fn of_row(&self, context: &Context, row: usize) -> Matrix3<f64> {
        let all = self.sources.iter().map(|(source, v)| source.spread(context, row) * *v);
        all.fold(Matrix3::identity() * self.own, |sum, own| sum + own)
    }

    /// W of every row.
    pub fn weights(&self, context: &Context) -> Vec<Matrix3<f64>> {
        let all: Vec<Matrix3<f64>> =
            (0..context.configurations.len()).map(|row| self.of_row(context, row)).collect();
        let mean = mean_variance(&all);
        all.iter().map(|own| root_of_inverse(own) * mean.sqrt()).collect()
    }

    /// How large each source is, and which share it has.
    pub fn sources(&self, context: &Context) -> ScatterSources {
        let rows = 0..context.configurations.len();
        let mean = |spread: &dyn Fn(usize) -> Matrix3<f64>| {
            mean_variance(&rows.clone().map(spread).collect::<Vec<_>>())
        };
        let whole = mean(&|row| self.of_row(context, row)).max(f64::MIN_POSITIVE);
        let of_source = |&(source, v): &(Source, f64)| ScatterSource {
            source,
            size: match source {
                Source::Written => context.written.iter().copied().fold(0.0, f64::max),
                _ => v.sqrt(),
            },
            share: mean(&|row| source.spread(context, row) * v) / whole,
        };
        let mut sources: Vec<ScatterSource> = self.sources.iter().map(of_source).collect();
        sources.sort_by(|a, b| b.share.total_cmp(&a.share));
        ScatterSources { own: self.own.sqrt(), sources }
    }
}

impl Source {
    /// All that a campaign may have.
    pub(in crate::diagnosis::calibration) fn all(context: &Context) -> Vec<Source> {
        let mut all = Vec::new();
        if context.written.iter().any(|step| *step > 0.0) {
            all.push(Source::Written);
        }
        if context.revolute().len() > 1 {
            all.push(Source::Joints);
        }
        all.extend(context.motions.iter().enumerate().map(|(joint, motion)| match motion {
            Motion::Revolute => Source::Angle(joint),
            Motion::Prismatic => Source::Position(joint),
        }));
        if !context.has_sockets() {
            all.extend(Axis::ALL.map(Source::Device));
        }
        if context.is_tracked() {
            all.extend([Source::Distance, Source::Direction]);
        }
        all
    }

    /// B of a row.
    pub(in crate::diagnosis::calibration) fn spread(self, context: &Context, row: usize) -> Matrix3<f64> {
        let there = &context.configurations[row];
        let along = |d: Vector3<f64>| d * d.transpose();
        let turned = |joint: usize, times: f64| along(there.tip_jacobian[joint]) * times;
        match self {
            // rounding errors are uniform: step²/12
            Source::Written => context
                .written
                .iter()
                .enumerate()
                .map(|(joint, step)| turned(joint, step * step / 12.0))
                .sum(),
            Source::Joints => context.revolute().into_iter().map(|joint| turned(joint, 1.0)).sum(),
            Source::Angle(joint) | Source::Position(joint) => turned(joint, 1.0),
            Source::Device(axis) => {
                along(context.recording.device(row).rotation.column(axis.index()).into_owned())
            }
            Source::Distance => along(sight(&there.tip)),
            Source::Direction => {
                let p = there.tip;
                Matrix3::identity() * p.norm_squared() - along(p)
            }
        }
    }
}

/// Mean of tr C/3.
fn mean_variance(all: &[Matrix3<f64>]) -> f64 {
    all.iter().map(|own| own.trace() / 3.0).sum::<f64>() / all.len().max(1) as f64
}

/// C^(−½), symmetric.
fn root_of_inverse(covariance: &Matrix3<f64>) -> Matrix3<f64> {
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(*covariance);
    let roots = eigenvalues.map(|value| value.max(f64::MIN_POSITIVE).sqrt().recip());
    eigenvectors * Matrix3::from_diagonal(&roots) * eigenvectors.transpose()
}
