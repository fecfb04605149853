//! The compensation loop (Eqs 11–14): fit, recompute deflections, torques and how much it
//! scatters, fit again.

use std::cmp::Ordering;

use super::campaign::{Campaign, Recording, Targets};
use super::compensation::Compensation;
use super::drives;
use super::growth::growth;
use super::identifiability::{self, UnidentifiedDirection};
use super::noise::{Noise, Robust};
use super::options::Options;
use super::problem::{Pass, Residuals};
use super::shrinkage::Drawing;
use crate::error::Result;
use crate::least_squares::{self, Fit, Found, Prior, Problem as _};
use crate::robot::{Parameter, Setup};

/// Noise of a coordinate that is assumed until there are residuals, m.
const ASSUMED_NOISE: f64 = 1e-4;
/// Change of a deflection from one pass to the next below which the loop has converged, m.
const SETTLED: f64 = 1e-9;
/// Relative change of noise and weights below which the loop has converged: far below their own
/// uncertainty.
const SETTLED_RELATIVE: f64 = 1e-3;
/// Change of the logarithm of the drawing's scale below which the loop has converged: far below how
/// well it is known.
const RESCALED: f64 = 0.06;
/// So many passes choose the drawing's scale.
const RESCALING_PASSES: usize = 6;
/// So many passes weigh the rows.
const WEIGHING_PASSES: usize = 40;
/// Most passes of the compensation loop.
const MOST_PASSES: usize = 60;

/// One pass of the compensation loop.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct PassRecord {
    /// Largest change of a rod deflection against the pass before, m.
    pub change: f64,
    /// Root mean square of the deviations' lengths after the fit, m.
    pub rms: f64,
    /// Noise of a coordinate, m.
    pub noise: f64,
}

/// A calibration under way.
pub(super) struct Run<'a, 'c> {
    campaign: &'c Campaign,
    recording: &'a Recording,
    free: &'a [Parameter],
    compensation: &'a Compensation,
    /// Where it began.
    start: Setup<'c>,
    pub setup: Setup<'c>,
    pub pass: Pass,
    pub noise: Noise,
    pub held: Vec<UnidentifiedDirection>,
    pub drawing: Drawing,
    /// What is known of the drives' compliances.
    drives: Vec<Prior>,
    pub passes: Vec<PassRecord>,
    pub is_converged: bool,
}

impl<'a, 'c> Run<'a, 'c> {
    pub fn new(
        campaign: &'c Campaign,
        recording: &'a Recording,
        setup: Setup<'c>,
        free: &'a [Parameter],
        compensation: &'a Compensation,
    ) -> Self {
        let noise = match campaign.noise {
            Some(sd) => Noise::assumed(sd, recording, true),
            None => Noise::assumed(ASSUMED_NOISE, recording, false),
        };
        let pass = Pass { weight: noise.row_weights(recording), ..Pass::at_rest(recording) };
        let stated = campaign.not_drawn();
        let mut drawing = Drawing::new(&setup, free, &stated);
        if matches!(recording.targets, Targets::Sockets(_)) {
            drawing =
                drawing.with_slopes(growth(&setup, free, &recording.joint_values, recording.joint_count));
        }
        let drives = drives::priors(&setup, free, &stated, compensation.payload);
        Run {
            campaign,
            recording,
            free,
            compensation,
            start: setup.clone(),
            setup,
            pass,
            noise,
            held: Vec::new(),
            drawing,
            drives,
            passes: Vec::new(),
            is_converged: false,
        }
    }

    /// The rough calibration: only where the robot stands and where the tip is.
    pub fn fit_base_and_tool(&mut self) -> Result<()> {
        let placed: Vec<Parameter> = self.free.iter().copied().filter(|p| p.is_placement()).collect();
        if placed.is_empty() || matches!(self.recording.targets, Targets::Sockets(_)) {
            return Ok(());
        }
        let problem = Residuals {
            setup: self.setup.clone(),
            free: &placed,
            recording: self.recording,
            pass: &self.pass,
            held: &[],
        };
        let options = known_noise();
        let fit = least_squares::search(&problem, &problem.start(), &options)?;
        if fit.is_converged() {
            let found = problem.setup_at(fit.parameters());
            for &parameter in &placed {
                self.setup.set(parameter, found.get(parameter));
            }
        }
        Ok(())
    }

    /// Fits and recomputes deflections, torques, noise and weights until they converge.
    pub fn compensate(&mut self, options: &Options) -> Result<Fit> {
        loop {
            let change = self.compensation.update(&self.setup, self.recording, &mut self.pass);
            // at the start, where the noise is a guess, and then where it is known
            if self.passes.len() < 2 {
                self.hold_unidentified()?;
            }
            let fit_options = self.fit_options();
            let fit = self.fit(&fit_options)?;
            for (k, &parameter) in self.free.iter().enumerate() {
                self.setup.set(parameter, fit.parameters()[k]);
            }
            let problem = self.problem();
            let deviations = problem.deviations(fit.parameters());
            let parameters = fit.rank().saturating_sub(self.held.len());
            let rank = parameters.saturating_sub(self.drawing.undetermined() as usize);
            // one weighting as least squares first, so that the robust ones start from a fit
            let robust = if self.passes.is_empty() { Robust::None } else { options.robust };
            let noise = self.noise.estimate(self.recording, &deviations, rank, robust)?;
            let squares: f64 = deviations.iter().map(|d| d.norm_squared()).sum();
            let rms = (squares / self.recording.len() as f64).sqrt();
            self.passes.push(PassRecord { change, rms, noise: noise.pooled });
            // then the weights stay, half way between those of two passes that made each other
            let weight = match self.passes.len().cmp(&WEIGHING_PASSES) {
                Ordering::Less => noise.row_weights(self.recording),
                Ordering::Equal => middle(&noise.row_weights(self.recording), &self.pass.weight),
                Ordering::Greater => self.pass.weight.clone(),
            };
            // then the scale stays, lest it and the weights go on chasing each other
            let rescaled = match self.passes.len() < RESCALING_PASSES {
                true => {
                    let root = self.problem().information_root(fit.parameters());
                    self.drawing.rescale(&root, fit.parameters())?
                }
                false => 0.0,
            };
            let scale = largest(weight.iter().copied());
            let weight_change = largest(weight.iter().zip(&self.pass.weight).map(|(a, b)| a - b));
            self.noise = noise;
            let has_settled = change < SETTLED
                && weight_change <= SETTLED_RELATIVE * scale
                && rescaled < RESCALED
                && self.passes.len() > 1;
            self.is_converged = has_settled && fit.is_converged();
            if has_settled || self.passes.len() >= MOST_PASSES || !fit.is_converged() {
                return fit.judged();
            }
            self.pass.weight = weight;
        }
    }

    fn problem(&self) -> Residuals<'_> {
        Residuals {
            setup: self.setup.clone(),
            free: self.free,
            recording: self.recording,
            pass: &self.pass,
            held: &self.held,
        }
    }

    /// What the drawing, the class of the drives and the user know of the free parameters.
    pub fn priors(&self) -> Vec<Prior> {
        let mut priors: Vec<Prior> = self.drawing.priors().chain(self.drives.iter().copied()).collect();
        for &(parameter, value, sd) in &self.campaign.constraints.priors {
            if let Some(index) = self.free.iter().position(|&p| p == parameter) {
                priors.push(Prior { parameter: index, value, sd });
            }
        }
        priors
    }

    fn fit<'o>(&self, options: &'o least_squares::Options) -> Result<Found<'o>> {
        let problem = self.problem();
        least_squares::search(&problem, &problem.start(), options)
    }

    fn fit_options(&self) -> least_squares::Options {
        let mut bounds = vec![(f64::NEG_INFINITY, f64::INFINITY); self.problem().parameter_count()];
        for (bound, &parameter) in bounds.iter_mut().zip(self.free) {
            bound.0 = drives::least_value(&self.start, parameter);
        }
        least_squares::Options { priors: self.priors(), bounds, ..known_noise() }
    }

    /// Finds the directions that the data do not identify where the robot stands now.
    fn hold_unidentified(&mut self) -> Result<()> {
        self.held.clear();
        let problem = self.problem();
        let p = problem.start();
        let mut corner = problem.information_root(&p);
        // before the first fit it is the nominal robot's misfit that parameters have to be judged
        // by from, not the noise
        if self.passes.is_empty() {
            let squares = problem.residuals(&p).norm_squared();
            corner /= (squares / problem.residual_count() as f64).sqrt().max(1.0);
        }
        // what the user knows beforehand identifies too
        for &(parameter, _, sd) in &self.campaign.constraints.priors {
            if let Some(k) = self.free.iter().position(|&p| p == parameter) {
                let last = corner.nrows();
                corner = corner.insert_row(last, 0.0);
                corner[(last, k)] = 1.0 / sd;
            }
        }
        let torque = self.largest_torques();
        let ranges: Vec<f64> =
            self.free.iter().map(|&p| identifiability::plausible_range(p, &torque)).collect();
        self.held = identifiability::unidentified(&corner, &ranges, &self.start, self.free)?;
        Ok(())
    }

    /// Largest torque on each joint over the recording, N·m.
    fn largest_torques(&self) -> Vec<f64> {
        let n = self.recording.joint_count;
        let largest_at = |j: usize| largest(self.pass.torque.iter().skip(j).step_by(n).copied());
        (0..n).map(largest_at).collect()
    }
}

/// Residuals come divided by their noise. A cosine of 1e-6 leaves every parameter within 1e-6·√dof
/// of its standard errors, which is no error at all: the loop around the fit needs no more.
fn known_noise() -> least_squares::Options {
    least_squares::Options {
        noise: least_squares::Noise::Known(1.0),
        gradient_tolerance: 1e-6,
        to_the_last_digit: false,
        ..least_squares::Options::default()
    }
}

fn middle(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter().zip(other).map(|(one, other)| 0.5 * (one + other)).collect()
}

/// Largest size; zero for no values.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a: f64, b| a.max(b.abs()))
}
