//! A tool that is loose in its mount, which another gravity, another contact force or other axes of
//! a device explain too where displacements are small.
//!
//! It rests on the side to which gravity presses it, or rocks there, so it is off one way or the
//! other by how it is held.
//!
//! ```text
//! off = R·a·sign(d·Rᵀg)      a a vector in {T}, d one of the lines through the middle of a cube
//! ```

use nalgebra::Vector3;

use super::super::super::nonparametric::SIDES;
use super::super::draft::Draft;
use super::super::quick::{Fit, density, fit_from, t_scale};
use super::{FittedDraft, MistakeSearch};
use crate::statistics::median;

/// The price of a loose tool: three numbers, and the line.
const LOOSE: f64 = -10.0;
/// Lines that are fitted, the likeliest as the fit stands.
const FITTED: usize = 3;
/// Base, tip and links take up a part of it, and less of the rest each time.
const ROUNDS: usize = 5;

/// Of each row, in {W}.
struct Resting {
    /// From its point to its tip, m.
    off: Vec<Vector3<f64>>,
    /// How much of that is where the tool rests, m.
    displaced: Vec<Vector3<f64>>,
}

impl MistakeSearch<'_> {
    /// The best score of a tool that is loose, in place of a mistake.
    pub fn loose_tool(&self, from: &FittedDraft) -> Option<f64> {
        if from.thin.has_sockets() {
            return None;
        }
        let body = &self.bodies[from.thin.body];
        let lines = SIDES.iter().filter_map(|line| {
            let line = Vector3::from(*line);
            let Resting { off, displaced } = self.resting(&from.thin, &from.fit, &line)?;
            let left: Vec<f64> = off.iter().zip(&displaced).map(|(off, by)| (off - by).norm()).collect();
            Some((density(&left, t_scale(&left, f64::EPSILON * body.reach)), line))
        });
        let mut lines: Vec<(f64, Vector3<f64>)> = lines.collect();
        lines.sort_by(|a, b| b.0.total_cmp(&a.0));
        let scores = lines.iter().take(FITTED).filter_map(|(_, line)| self.loose_along(from, line));
        scores.max_by(f64::total_cmp)
    }

    /// The score where a looseness by one line is fitted with all else, in turns.
    fn loose_along(&self, from: &FittedDraft, line: &Vector3<f64>) -> Option<f64> {
        let body = &self.bodies[from.thin.body];
        let (mut thin, mut fit) = (from.thin.clone(), from.fit.clone());
        for _ in 0..ROUNDS {
            let resting = self.resting(&thin, &fit, line)?;
            for (at, by) in resting.displaced.iter().enumerate() {
                thin.seen[at] += thin.devices[thin.group[at]].rotation.tr_mul(by);
            }
            fit = fit_from(&thin, body, &fit, from.fit.rough)?;
        }
        Some(self.scored(from.steps.clone(), thin, fit).score + LOOSE)
    }

    /// Where a tool that is pressed along a line of {T} rests, as the rows say in the middle.
    fn resting(&self, thin: &Draft, fit: &Fit, line: &Vector3<f64>) -> Option<Resting> {
        let body = &self.bodies[thin.body];
        let off = fit.offsets(thin, body);
        let held = (0..thin.len()).map(|at| {
            let flange = body.robot.flange_at(thin.joints(at)).rotation;
            let side = (flange * line).dot(&body.robot.gravity).signum();
            Some(fit.bases.get(thin.station[at])?.rotation * flange * side)
        });
        let held: Vec<_> = held.collect::<Option<_>>()?;
        let in_tool: Vec<Vector3<f64>> = held.iter().zip(&off).map(|(held, off)| held.tr_mul(off)).collect();
        let middle = |axis: usize| median(&in_tool.iter().map(|off| off[axis]).collect::<Vec<_>>());
        let a = Vector3::new(middle(0)?, middle(1)?, middle(2)?);
        Some(Resting { off, displaced: held.iter().map(|held| held * a).collect() })
    }
}
