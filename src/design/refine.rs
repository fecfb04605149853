//! From a design of the front to the best one between the grid's values, and back to tubes that can
//! be bought.
//!
//! The first goal is bettered while no other goal loses and all limits are kept. What the design
//! file gives as a range may take any value between its ends, what it gives as a list stays; outer
//! diameter and wall may take any value between those of the catalogue's tubes of that material.
//! Figures of rods are near products of powers of their numbers, so that their logarithms are near
//! linear in those of the numbers: each step solves the linear program
//!
//! ```text
//! min s₀·Δ + M·t,   ln f_i + s_i·Δ ≤ ln b_i + t,   |Δ_j| ≤ r,   s_ij = ∂ln f_i/∂ln x_j
//! ```
//!
//! with exact derivatives, and the region r shrinks where the step promises more than it keeps
//! (sequential linear programming with an exact penalty: R. Fletcher, E. Sainz de la Maza, *Math.
//! Program.* 43 (1989) 235–256). The optimum is a local one. Then the nearest tubes of the
//! catalogue are tried in turn, and everything else once more with each.

use nalgebra::DMatrix;

use super::figure::{Figure, Figures};
use super::front::Design;
use super::wish::Wish;
use crate::beam::TipSolver;
use crate::error::Result;
use crate::linear_program;
use crate::parallel::in_parallel;
use crate::rod::{NominalNumber, Part, Rod};
use crate::section::{Round, Section};

/// Tubes that are tried for a pipe: the nearest ones.
const TUBES: usize = 8;
const TUBES_OF_TWO: usize = 4;
/// What breaking a limit by a share weighs against bettering the goal by that share.
const PENALTY: f64 = 100.0;
/// Shares: first and last size of a step, by how much limits are kept at least, and a gain that is
/// none.
const FIRST_STEP: f64 = 0.1;
const LAST_STEP: f64 = 1e-6;
const MARGIN: f64 = 1e-7;
const NOTHING: f64 = 1e-5;
const MOST_STEPS: usize = 80;

/// A design between the values of the grid.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Better {
    /// The rod.
    pub rod: Rod,
    /// Names of its tubes, one where they are the same; none of tubes that the catalogue does not
    /// have.
    pub tubes: Vec<String>,
    /// Its figures.
    pub figures: Figures,
    /// By which share its first goal is better than that of the design it came from.
    pub gained: f64,
}

/// What became of a design of the front.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Refined {
    /// Place of the design on the front, from 0.
    pub place: usize,
    /// Its figures.
    pub from: Figures,
    /// The best with any tube; none where nothing is gained.
    pub continuous: Option<Better>,
    /// The best with tubes of the catalogue; none where nothing is gained.
    pub catalogue: Option<Better>,
}

/// What may vary.
#[derive(Debug, Clone, PartialEq)]
struct Variable {
    /// The numbers of the rod that it moves, each by how much.
    moves: Vec<(NominalNumber, f64)>,
    low: f64,
    high: f64,
}

/// Refines the design at `place` of a front.
///
/// # Errors
/// What the beam model refuses.
pub fn refine(wish: &Wish, place: usize, design: &Design) -> Result<Refined> {
    let mut refined = Refined { place, from: design.figures, continuous: None, catalogue: None };
    let Ok(rod) = wish.rod(design.index) else { return Ok(refined) };
    let tubes = wish.choice(design.index).tubes;
    let is_priced = wish.goals.iter().any(|goal| goal.figure == Figure::Price);
    let lengths = lengths(wish, &rod);
    let of_start = Search { wish, from: &design.figures, price: prices(wish, tubes) };
    // a tube that nobody sells has no price
    let all = match is_priced {
        true => lengths.clone(),
        false => [lengths.clone(), diameters(wish, &rod)].concat(),
    };
    let (best, figures) = of_start.best(&rod, &all)?;
    let is_kept = best.pipe1.section == rod.pipe1.section && best.pipe2.section == rod.pipe2.section;
    let names = |tubes: [usize; 2]| {
        let mut names = tubes.map(|tube| wish.tubes[tube].name.clone()).to_vec();
        names.dedup();
        names
    };
    let better = |rod: Rod, tubes: Vec<String>, figures: Figures| {
        let gained = of_start.gain(&figures);
        (gained > NOTHING && of_start.is_kept(&figures)).then_some(Better { rod, tubes, figures, gained })
    };
    let of_catalogue = nearest(wish, tubes, &best);
    let tried = in_parallel(of_catalogue.len(), |k| {
        let [first, second] = of_catalogue[k].map(|tube| wish.tubes[tube].pipe.clone());
        let with = Rod { pipe1: first.clone(), bend: first, pipe2: second, ..best.clone() };
        let search = Search { price: prices(wish, of_catalogue[k]), ..of_start };
        search.best(&with, &lengths)
    });
    for (tubes, found) in of_catalogue.iter().zip(tried) {
        let (rod, figures) = found?;
        let known = refined.catalogue.as_ref().map_or(0.0, |known| known.gained);
        let new = better(rod, names(*tubes), figures);
        if new.as_ref().is_some_and(|new| new.gained > known) {
            refined.catalogue = new;
        }
    }
    refined.continuous = better(best, if is_kept { names(tubes) } else { Vec::new() }, figures);
    // what can be bought is one of those that could be
    let known = refined.continuous.as_ref().map_or(0.0, |known| known.gained);
    if refined.catalogue.as_ref().is_some_and(|bought| bought.gained > known) {
        refined.continuous.clone_from(&refined.catalogue);
    }
    Ok(refined)
}

/// Lengths, angle, bend and tip, where they are ranges.
fn lengths(wish: &Wish, rod: &Rod) -> Vec<Variable> {
    let all = [
        (NominalNumber::LengthL1, &wish.l1, rod.l1),
        (NominalNumber::LengthL2, &wish.l2, rod.l2),
        (NominalNumber::Angle, &wish.gamma, rod.gamma),
        (NominalNumber::BendRadius, &wish.bend_radius, rod.bend_radius),
        (NominalNumber::TipMass, &wish.tip_mass, rod.tip_mass),
    ];
    let varies = |(k, (number, values, now)): (usize, (NominalNumber, &Vec<f64>, f64))| {
        let positive = || values.iter().copied().filter(|value| *value > 0.0);
        let (low, high) = (positive().fold(f64::INFINITY, f64::min), positive().fold(0.0, f64::max));
        (wish.is_range[k] && low < high && now > 0.0).then(|| Variable {
            moves: vec![(number, 1.0)],
            low,
            high,
        })
    };
    all.into_iter().enumerate().filter_map(varies).collect()
}

/// Outer diameter (at its wall) and wall (at its outer diameter) of the tubes.
fn diameters(wish: &Wish, rod: &Rod) -> Vec<Variable> {
    let of = |parts: &[Part], material: &str| -> Vec<Variable> {
        let rounds: Vec<&Round> = (wish.tubes.iter())
            .filter(|tube| tube.pipe.material.name == material)
            .filter_map(|tube| tube.pipe.section.as_round())
            .filter(|round| round.inner_diameter > 0.0)
            .collect();
        let between = |value: fn(&Round) -> f64| {
            let all = || rounds.iter().map(|round| value(round));
            (all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max))
        };
        let outer = parts
            .iter()
            .flat_map(|part| {
                [(NominalNumber::OuterDiameter(*part), 1.0), (NominalNumber::InnerDiameter(*part), 1.0)]
            })
            .collect();
        let wall = parts.iter().map(|part| (NominalNumber::InnerDiameter(*part), -2.0)).collect();
        let all = [(outer, between(|round| round.outer_diameter)), (wall, between(Round::wall))];
        let varies = |(moves, (low, high))| (low < high).then_some(Variable { moves, low, high });
        all.into_iter().filter_map(varies).collect()
    };
    let is_tube = |section: &Section| section.as_round().is_some_and(|round| round.inner_diameter > 0.0);
    if !is_tube(&rod.pipe1.section) || !is_tube(&rod.pipe2.section) {
        return Vec::new();
    }
    match wish.is_one_tube {
        true => of(&[Part::Pipe1, Part::Pipe2], &rod.pipe1.material.name),
        false => [(Part::Pipe1, &rod.pipe1), (Part::Pipe2, &rod.pipe2)]
            .iter()
            .flat_map(|(part, pipe)| of(&[*part], &pipe.material.name))
            .collect(),
    }
}

fn prices(wish: &Wish, tubes: [usize; 2]) -> [f64; 2] {
    tubes.map(|tube| wish.tubes[tube].price_per_m.unwrap_or(f64::NAN))
}

/// Combinations of tubes near those of `rod`, and the ones that the design had.
fn nearest(wish: &Wish, had: [usize; 2], rod: &Rod) -> Vec<[usize; 2]> {
    let near = |pipe: &crate::rod::Pipe, count: usize| -> Vec<usize> {
        let ln = |section: &Section| {
            section.as_round().map_or([f64::NAN; 2], |round| [round.outer_diameter.ln(), round.wall().ln()])
        };
        let [outer, wall] = ln(&pipe.section);
        let far = |tube: usize| {
            let [o, w] = ln(&wish.tubes[tube].pipe.section);
            (o - outer).powi(2) + (w - wall).powi(2)
        };
        let same = |tube: &usize| wish.tubes[*tube].pipe.material.name == pipe.material.name;
        let mut tubes: Vec<usize> = (0..wish.tubes.len()).filter(same).collect();
        tubes.sort_by(|&a, &b| far(a).total_cmp(&far(b)));
        tubes.truncate(count);
        tubes
    };
    let mut all = vec![had];
    match wish.is_one_tube {
        true => all.extend(near(&rod.pipe1, TUBES).into_iter().map(|tube| [tube; 2])),
        false => {
            let second = near(&rod.pipe2, TUBES_OF_TWO);
            let pairs = |first: usize| second.iter().map(move |&second| [first, second]);
            all.extend(near(&rod.pipe1, TUBES_OF_TWO).into_iter().flat_map(pairs));
        }
    }
    all
}

/// What must hold and what counts, beside a design.
#[derive(Clone, Copy)]
struct Search<'a> {
    wish: &'a Wish,
    from: &'a Figures,
    /// Per metre of each pipe.
    price: [f64; 2],
}

impl Search<'_> {
    /// The rod from which no step betters the first goal.
    fn best(&self, from: &Rod, variables: &[Variable]) -> Result<(Rod, Figures)> {
        let mut solver = TipSolver::default();
        let mut figures = |rod: &Rod| -> Result<Option<Figures>> {
            if self.wish.possible(rod).is_err() || !is_tube(rod) {
                return Ok(None);
            }
            let mut figures = Figures::of(rod, &mut solver)?.with_frequency(rod)?;
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

    /// ln of the first goal, such that less is better, and of every other figure over what it may
    /// be.
    fn logarithms(&self, figures: &Figures) -> (f64, Vec<f64>) {
        let ln = |figure: Figure| figures.get(figure).unwrap_or(f64::NAN).ln();
        let sign = |is_large: bool| if is_large { -1.0 } else { 1.0 };
        let goal = self.wish.goals[0];
        let others = self.wish.goals[1..].iter().map(|goal| {
            let least = self.from.get(goal.figure).unwrap_or(f64::NAN).ln();
            sign(goal.is_maximised) * (ln(goal.figure) - least)
        });
        let limits = self.wish.limits.iter();
        let limits = limits.map(|limit| sign(limit.is_least) * (ln(limit.figure) - limit.value.ln()));
        (sign(goal.is_maximised) * ln(goal.figure), others.chain(limits).collect())
    }

    fn merit(&self, figures: &Figures) -> f64 {
        let (goal, others) = self.logarithms(figures);
        let worst = others.iter().map(|over| over + MARGIN).fold(0.0, f64::max);
        goal + PENALTY * worst
    }

    fn gain(&self, figures: &Figures) -> f64 {
        let (goal, from) = (self.logarithms(figures).0, self.logarithms(self.from).0);
        1.0 - (goal - from).exp()
    }

    fn is_kept(&self, figures: &Figures) -> bool {
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
        let swings = self.wish.goals.iter().any(|goal| is_frequency(goal.figure))
            || self.wish.limits.iter().any(|limit| is_frequency(limit.figure));
        let slopes = Figures::slopes_by(rod, &numbers, swings)?;
        // ∂ln f/∂ln x
        let slope = |figure: Figure, variable: &Variable| {
            let of = |(number, by): &(NominalNumber, f64)| {
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
            let slope = variable.moves.iter().map(of).sum::<f64>() * variable.value(rod) / value;
            if slope.is_finite() { slope } else { 0.0 }
        };
        let row = |figure: Figure, is_large: bool| -> Vec<f64> {
            let sign = if is_large { -1.0 } else { 1.0 };
            variables.iter().map(|variable| sign * slope(figure, variable)).collect()
        };
        let goals = self.wish.goals.iter().map(|goal| row(goal.figure, goal.is_maximised));
        let mut rows: Vec<Vec<f64>> = goals.collect();
        let goal = rows.remove(0);
        rows.extend(self.wish.limits.iter().map(|limit| row(limit.figure, limit.is_least)));
        let over: Vec<f64> = self.logarithms(figures).1.iter().map(|over| over + MARGIN).collect();
        Ok(Terms { goal, rows, over })
    }
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

impl Variable {
    /// Its value on `rod`: that of its first number, or of the wall.
    fn value(&self, rod: &Rod) -> f64 {
        let number = match &self.moves[0] {
            (NominalNumber::InnerDiameter(part), by) if *by < 0.0 => NominalNumber::Wall(*part),
            (number, _) => number.clone(),
        };
        rod.value_of(&number).unwrap_or(f64::NAN)
    }
}

/// `rod` after a step in the logarithms of the variables.
fn moved(rod: &Rod, variables: &[Variable], step: &[f64]) -> Rod {
    let mut moved = rod.clone();
    for (variable, step) in variables.iter().zip(step) {
        let now = variable.value(rod);
        let change = (now * step.exp()).clamp(variable.low, variable.high) - now;
        for (number, by) in &variable.moves {
            let value = moved.value_of(number).unwrap_or(f64::NAN) + by * change;
            moved = moved.with(number, value);
        }
    }
    // what sits along the rod stays where the design file has it
    moved.masses.clone_from(&rod.masses);
    moved.joints.clone_from(&rod.joints);
    moved
}

/// Walls that are no more than the tube.
fn is_tube(rod: &Rod) -> bool {
    [&rod.pipe1, &rod.pipe2].iter().all(|pipe| {
        let round = pipe.section.as_round();
        round.is_none_or(|round| round.inner_diameter >= 0.0 && round.inner_diameter < round.outer_diameter)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{Searched, search};

    const TUBES: &str = "name,material,outer_diameter_mm,inner_diameter_mm\nthin,steel,30,28\nmiddle,steel,32,29\n\
                         wide,steel,36,34\n";

    fn wish(l1: &str, limits: &str) -> Wish {
        let text = format!(
            "[geometry]\nl1_mm = {l1}\nl2_mm = {{ from = 300, to = 600, step = 100 }}\n[catalogue]\nfile = \"t.csv\"\n\
             [tip]\nmass_g = 60\n[constraints]\n{limits}\n[objectives]\nminimise = [\"c_rod_um\"]\n\
             maximise = [\"reach_mm\"]\n"
        );
        Wish::from_toml("d.toml", &text, &|name| Ok((name.to_owned(), TUBES.to_owned()))).unwrap()
    }

    /// Beside all rods of a grid of 1 mm and 0.05 mm.
    #[test]
    fn no_rod_of_a_fine_grid_is_better() {
        let wish =
            wish("{ from = 100, to = 250, step = 50 }", "max_mass_g = 700\nmin_first_frequency_hz = 40");
        let front = search(&wish, Searched::All, &|_| {}).unwrap().front;
        let place = 7;
        let start = front[place];
        let refined = refine(&wish, place, &start).unwrap();
        let (any, bought) = (refined.continuous.unwrap(), refined.catalogue.unwrap());
        assert!(any.gained >= bought.gained && bought.gained > 0.002, "{} {}", any.gained, bought.gained);
        for better in [&any, &bought] {
            let of = |figure: Figure| better.figures.get(figure).unwrap();
            assert!(of(Figure::Reach) >= start.figures.get(Figure::Reach).unwrap() * (1.0 - 1e-9));
            assert!(wish.limits.iter().all(|limit| limit.is_kept(&better.figures)));
            let again = Figures::of(&better.rod, &mut TipSolver::default()).unwrap();
            assert_eq!(again.get(Figure::CRod), better.figures.get(Figure::CRod));
        }
        assert!(any.tubes.is_empty() && bought.tubes.len() == 1);
        let (reach, best) =
            (start.figures.get(Figure::Reach).unwrap(), any.figures.get(Figure::CRod).unwrap());
        let mut solver = TipSolver::default();
        let mut checked = 0;
        for l1 in (100..=250).step_by(2) {
            let l1 = f64::from(l1) * 1e-3;
            let Some(l2) = (1e-6 * reach * reach - l1 * l1).max(0.0).sqrt().into() else { continue };
            if !(0.3..=0.6).contains(&l2) {
                continue;
            }
            for (outer, wall) in (0..=24).flat_map(|k| (0..=10).map(move |j| (k, j))) {
                let (outer, wall) = (0.030 + 0.00025 * f64::from(outer), 0.001 + 0.00005 * f64::from(wall));
                let mut rod = any.rod.clone();
                (rod.l1, rod.l2) = (l1, l2);
                let section = Round::tube(outer, outer - 2.0 * wall).into();
                for pipe in [&mut rod.pipe1, &mut rod.bend, &mut rod.pipe2] {
                    pipe.section = section;
                }
                let figures = Figures::of(&rod, &mut solver).unwrap();
                if figures.get(Figure::Mass).unwrap() <= 700.0 {
                    checked += 1;
                    let c_rod = figures.get(Figure::CRod).unwrap();
                    assert!(c_rod > best * (1.0 - 1e-6), "{l1} {l2} {outer} {wall}: {c_rod} {best}");
                }
            }
        }
        assert!(checked > 500, "{checked}");
    }

    #[test]
    fn where_nothing_may_vary_nothing_is_gained() {
        let text = "[geometry]\nl1_mm = 150\nl2_mm = 500\n[catalogue]\nfile = \"t.csv\"\n[objectives]\n\
                    minimise = [\"c_rod_um\"]\n";
        let one = &TUBES[..TUBES.find("middle").unwrap()];
        let wish = Wish::from_toml("d.toml", text, &|name| Ok((name.to_owned(), one.to_owned()))).unwrap();
        let front = search(&wish, Searched::All, &|_| {}).unwrap().front;
        let refined = refine(&wish, 0, &front[0]).unwrap();
        assert!(refined.continuous.is_none() && refined.catalogue.is_none());
    }
}
