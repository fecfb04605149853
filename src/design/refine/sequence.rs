//! From one rod to the best one near it, by a sequence of linear programs.
//!
//! Figures of rods are near products of powers of their numbers, so that their logarithms are near
//! linear in those of the numbers: each step solves the linear program
//!
//! ```text
//! min s₀·Δ + M·t,   ln f_i + s_i·Δ ≤ ln b_i + t,   |Δ_j| ≤ r,   s_ij = ∂ln f_i/∂ln x_j
//! ```
//!
//! with exact derivatives, and the region r shrinks where the step promises more than it keeps
//! (sequential linear programming with an exact penalty: R. Fletcher, E. Sainz de la Maza, *Math.
//! Program.* 43 (1989) 235–256). The optimum is a local one.

use nalgebra::DMatrix;

use super::variable::{Variable, moved};
use crate::beam::TipSolver;
use crate::design::figure::{Figure, Figures};
use crate::design::space::DesignSpace;
use crate::error::Result;
use crate::linear_program;
use crate::rod::{NominalNumber, Rod};

/// What breaking a limit by a share weighs against bettering the goal by that share.
const PENALTY: f64 = 100.0;
/// Shares: first and last size of a step, by how much limits are kept at least.
const FIRST_STEP: f64 = 0.1;
const LAST_STEP: f64 = 1e-6;
const MARGIN: f64 = 1e-7;
const MOST_STEPS: usize = 80;

/// What must hold and what counts, beside a design.
#[derive(Clone, Copy)]
pub(super) struct Search<'a> {
    pub(super) space: &'a DesignSpace,
    /// Figures of the design that is bettered.
    pub(super) from: &'a Figures,
    /// What each goal weighs; one of no weight may not lose.
    pub(super) weights: &'a [f64],
    /// Per metre of each pipe.
    pub(super) price: [f64; 2],
}

impl Search<'_> {
    /// The rod from which no step betters the goal.
    pub(super) fn best(&self, from: &Rod, variables: &[Variable]) -> Result<(Rod, Figures)> {
        let mut solver = TipSolver::default();
        let mut figures = |rod: &Rod| -> Result<Option<Figures>> {
            if self.space.possible(rod).is_err() || !is_tube(rod) {
                return Ok(None);
            }
            let mut figures = Figures::of(rod, &mut solver).with_frequency(rod)?;
            figures.set(Figure::Price, self.price[0] * rod.l1 + self.price[1] * rod.l2);
            Ok(Some(figures))
        };
        let (mut rod, mut region) = (from.clone(), FIRST_STEP);
        let Some(mut here) = figures(&rod)? else { return Ok((rod, *self.from)) };
        for _ in 0..MOST_STEPS {
            if region < LAST_STEP || variables.is_empty() {
                break;
            }
            let terms = self.terms(&rod, &here, variables)?;
            // within this region until a step betters
            while region >= LAST_STEP {
                let Some((step, promised)) = terms.step(region, &rod, variables) else {
                    return Ok((rod, here));
                };
                if promised < 1e-3 * LAST_STEP {
                    return Ok((rod, here));
                }
                let moved = moved(&rod, variables, &step);
                let kept = match figures(&moved)? {
                    Some(there) => (self.merit(&here) - self.merit(&there), Some((moved, there))),
                    None => (f64::NEG_INFINITY, None),
                };
                match kept {
                    (gain, Some((moved, there))) if gain > 0.1 * promised => {
                        (rod, here) = (moved, there);
                        if gain > 0.75 * promised {
                            region = (2.0 * region).min(0.5);
                        }
                        break;
                    }
                    _ => region *= 0.4,
                }
            }
        }
        Ok((rod, here))
    }

    /// ln of what is bettered, such that less is better, and of every other figure over what it may
    /// be.
    fn logarithms(&self, figures: &Figures) -> (f64, Vec<f64>) {
        let ln = |figure: Figure| figures.get(figure).unwrap_or(f64::NAN).ln();
        let goals = || self.space.goals.iter().zip(self.weights);
        // Σ w·ln f: a weight of nothing has no say, whatever the figure
        let weighed = goals().filter(|(_, weight)| **weight > 0.0);
        let goal = weighed.map(|(goal, weight)| weight * sign(goal.is_maximised) * ln(goal.figure)).sum();
        let others = goals().filter(|(_, weight)| **weight <= 0.0).map(|(goal, _)| {
            let least = self.from.get(goal.figure).unwrap_or(f64::NAN).ln();
            sign(goal.is_maximised) * (ln(goal.figure) - least)
        });
        let limits = self.space.limits.iter();
        let limits = limits.map(|limit| sign(limit.is_least) * (ln(limit.figure) - limit.value.ln()));
        (goal, others.chain(limits).collect())
    }

    fn merit(&self, figures: &Figures) -> f64 {
        let (goal, others) = self.logarithms(figures);
        let worst = others.iter().map(|over| over + MARGIN).fold(0.0, f64::max);
        goal + PENALTY * worst
    }

    /// By which share a goal, or the weighted geometric mean of several, is better.
    pub(super) fn gain(&self, figures: &Figures) -> f64 {
        let (goal, from) = (self.logarithms(figures).0, self.logarithms(self.from).0);
        1.0 - (goal - from).exp()
    }

    /// Whether no other goal loses and all limits are kept.
    pub(super) fn is_kept(&self, figures: &Figures) -> bool {
        self.logarithms(figures).1.iter().all(|over| *over <= 1e-12)
    }

    /// The linear program about `rod`.
    fn terms(&self, rod: &Rod, figures: &Figures, variables: &[Variable]) -> Result<Terms> {
        let mut numbers: Vec<NominalNumber> = Vec::new();
        for (number, _) in variables.iter().flat_map(|variable| &variable.moves) {
            if !numbers.contains(number) {
                numbers.push(number.clone());
            }
        }
        let is_frequency = |figure: Figure| figure == Figure::FirstFrequency;
        let swings = self.space.goals.iter().any(|goal| is_frequency(goal.figure))
            || self.space.limits.iter().any(|limit| is_frequency(limit.figure));
        let slopes = Figures::slopes_by(rod, &numbers, swings)?;
        // ∂ln f/∂ln x
        let slope = |figure: Figure, variable: &Variable| {
            let of_number = |(number, by): &(NominalNumber, f64)| {
                let known = slopes.iter().find(|(known, _)| known == number);
                let slope = match (figure, number) {
                    (Figure::Price, NominalNumber::LengthL1) => self.price[0],
                    (Figure::Price, NominalNumber::LengthL2) => self.price[1],
                    (Figure::Price, _) => 0.0,
                    _ => known.map_or(0.0, |(_, slopes)| slopes.get(figure).unwrap_or(0.0)),
                };
                by * slope
            };
            let value = figures.get(figure).unwrap_or(f64::NAN);
            let slope = variable.moves.iter().map(of_number).sum::<f64>() * variable.value(rod) / value;
            if slope.is_finite() { slope } else { 0.0 }
        };
        let row = |figure: Figure, is_large: bool| -> Vec<f64> {
            variables.iter().map(|variable| sign(is_large) * slope(figure, variable)).collect()
        };
        let (mut goal, mut rows) = (vec![0.0; variables.len()], Vec::new());
        for (one, weight) in self.space.goals.iter().zip(self.weights) {
            let row = row(one.figure, one.is_maximised);
            match *weight > 0.0 {
                true => goal.iter_mut().zip(&row).for_each(|(sum, slope)| *sum += weight * slope),
                false => rows.push(row),
            }
        }
        rows.extend(self.space.limits.iter().map(|limit| row(limit.figure, limit.is_least)));
        let over: Vec<f64> = self.logarithms(figures).1.iter().map(|over| over + MARGIN).collect();
        Ok(Terms { goal, rows, over })
    }
}

/// Less is better of what shall be large, too.
fn sign(is_large: bool) -> f64 {
    if is_large { -1.0 } else { 1.0 }
}

/// s₀, s_i and ln f_i − ln b_i.
struct Terms {
    goal: Vec<f64>,
    rows: Vec<Vec<f64>>,
    over: Vec<f64>,
}

impl Terms {
    /// The step Δ within `region`, and how much it betters the merit if everything is as linear as
    /// assumed.
    fn step(&self, region: f64, rod: &Rod, variables: &[Variable]) -> Option<(Vec<f64>, f64)> {
        let n = variables.len();
        // the last one is t
        let mut goal = self.goal.clone();
        goal.push(PENALTY);
        let a = DMatrix::from_fn(self.rows.len(), n + 1, |i, j| if j < n { self.rows[i][j] } else { -1.0 });
        let b: Vec<f64> = self.over.iter().map(|over| -over).collect();
        let (mut low, mut high) = (Vec::new(), Vec::new());
        for variable in variables {
            let now = variable.value(rod);
            low.push((variable.low / now).ln().max(-region).min(0.0));
            high.push((variable.high / now).ln().min(region).max(0.0));
        }
        low.push(0.0);
        high.push(self.over.iter().copied().fold(0.0, f64::max) + 10.0);
        let mut best = linear_program::minimise(&goal, &a, &b, &low, &high)?;
        let worst = best.pop()?;
        let before = PENALTY * self.over.iter().copied().fold(0.0, f64::max);
        let gain = -self.goal.iter().zip(&best).map(|(s, step)| s * step).sum::<f64>();
        Some((best, gain + before - PENALTY * worst))
    }
}

/// Walls that are no more than the tube.
fn is_tube(rod: &Rod) -> bool {
    [&rod.pipe1, &rod.pipe2].iter().all(|pipe| {
        let round = pipe.section.as_round();
        round.is_none_or(|round| round.inner_diameter >= 0.0 && round.inner_diameter < round.outer_diameter)
    })
}
