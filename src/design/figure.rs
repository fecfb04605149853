//! The numbers that a rod is judged by.

use nalgebra::{Matrix3, Vector3};

use crate::beam::TipSolver;
use crate::compliance::{Compliance, paper_contact_force};
use crate::dual::{Dual, Number};
use crate::error::Result;
use crate::rod::{NominalNumber, Rod};
use crate::units::{GRAM, MM, STANDARD_GRAVITY, UM};

/// A number of a rod. Its value is in the unit of its key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Figure {
    /// Compliance index c_rod under the paper's contact force, µm ([`Compliance::index`]).
    CRod,
    /// Largest entry of |C^F|, µm/N.
    CfMax,
    /// Largest entry of |C^g|, µm/g: how far the tip sags under its own weight.
    CgMax,
    /// Mass of pipes, bend, tip and sleeves, g.
    Mass,
    /// Largest moment of the rod's weight about the flange's origin, N·m: m·g·|r|, r the centre of
    /// mass.
    Moment,
    /// First natural frequency, Hz ([`Rod::first_frequency`]).
    FirstFrequency,
    /// Distance of the tip from the flange's origin, mm.
    Reach,
    /// Price of the pipes' centrelines, in the catalogue's currency.
    Price,
}

impl Figure {
    /// All of them, in the order of [`Figures`].
    pub const ALL: [Figure; 8] = [
        Figure::CRod,
        Figure::CfMax,
        Figure::CgMax,
        Figure::Mass,
        Figure::Moment,
        Figure::FirstFrequency,
        Figure::Reach,
        Figure::Price,
    ];

    /// Its name in design files and in the JSON.
    pub fn key(self) -> &'static str {
        match self {
            Figure::CRod => "c_rod_um",
            Figure::CfMax => "cf_max_um_per_n",
            Figure::CgMax => "cg_max_um_per_g",
            Figure::Mass => "mass_g",
            Figure::Moment => "moment_nm",
            Figure::FirstFrequency => "first_frequency_hz",
            Figure::Reach => "reach_mm",
            Figure::Price => "price",
        }
    }

    /// What it is, and its unit.
    pub fn name_and_unit(self) -> (&'static str, &'static str) {
        match self {
            Figure::CRod => ("c_rod", "µm"),
            Figure::CfMax => ("largest C^F", "µm/N"),
            Figure::CgMax => ("largest C^g", "µm/g"),
            Figure::Mass => ("mass", "g"),
            Figure::Moment => ("flange moment", "N·m"),
            Figure::FirstFrequency => ("first frequency", "Hz"),
            Figure::Reach => ("reach", "mm"),
            Figure::Price => ("price", ""),
        }
    }
}

/// Figures of a rod in the order of [`Figure::ALL`]; NaN where one was not asked for.
#[derive(Debug, Clone, Copy)]
pub struct Figures(pub(super) [f64; 8]);

/// What was not asked for is equal to itself.
impl PartialEq for Figures {
    fn eq(&self, other: &Figures) -> bool {
        self.0.map(f64::to_bits) == other.0.map(f64::to_bits)
    }
}

impl Figures {
    /// The value in the unit of its key; `None` where it was not asked for.
    pub fn get(&self, figure: Figure) -> Option<f64> {
        let value = self.0[figure as usize];
        (!value.is_nan()).then_some(value)
    }

    /// The same but for one.
    pub(super) fn with(mut self, figure: Figure, value: f64) -> Figures {
        self.set(figure, value);
        self
    }

    pub(super) fn set(&mut self, figure: Figure, value: f64) {
        self.0[figure as usize] = value;
    }

    /// Everything of `rod` but its frequency and price: those cost more than all others, or need a
    /// catalogue.
    pub fn of(rod: &Rod, solver: &mut TipSolver) -> Figures {
        Figures(numbers(rod, solver))
    }

    /// Derivatives of all figures of `rod` but the price by every number of it, per SI unit of the
    /// number.
    ///
    /// # Errors
    /// As [`Rod::first_frequency_slopes`].
    pub fn slopes(rod: &Rod) -> Result<Vec<(NominalNumber, Figures)>> {
        Figures::slopes_by(rod, &rod.numbers(), true)
    }

    /// [`Figures::slopes`] by some numbers, and only if asked for those of the frequency, which
    /// cost more than all others.
    pub(super) fn slopes_by(
        rod: &Rod,
        all: &[NominalNumber],
        swings: bool,
    ) -> Result<Vec<(NominalNumber, Figures)>> {
        let mut solver = TipSolver::default();
        let frequencies = match swings {
            true => rod.first_frequency_slopes(all)?.map(|(_, slopes)| slopes),
            false => None,
        };
        let mut slopes = Vec::new();
        for (k, number) in all.iter().enumerate() {
            let Some(varied) = rod.derivative(number) else { continue };
            let mut figures = Figures(numbers(&varied, &mut solver).map(|figure: Dual| figure.eps));
            let frequency = frequencies.as_ref().map_or(0.0, |slopes| slopes[k]);
            figures.set(Figure::FirstFrequency, frequency);
            figures.set(Figure::Price, f64::NAN);
            slopes.push((number.clone(), figures));
        }
        Ok(slopes)
    }

    /// [`Figures::of`] and the first natural frequency.
    ///
    /// # Errors
    /// As [`Rod::first_frequency`].
    pub fn with_frequency(mut self, rod: &Rod) -> Result<Figures> {
        // nothing that has mass: nothing that swings
        self.set(Figure::FirstFrequency, rod.first_frequency()?.unwrap_or(f64::INFINITY));
        Ok(self)
    }
}

/// A combination and its figures.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Design {
    /// Its number among all combinations.
    pub index: u64,
    /// Its figures.
    pub figures: Figures,
}

/// What [`Figures::of`] has, with whatever the numbers of the rod carry.
fn numbers<T: Number>(rod: &Rod<T>, solver: &mut TipSolver<T>) -> [T; 8] {
    let [force, weight] = solver.solve(rod);
    let compliance = Compliance { force, gravity: weight * T::from(STANDARD_GRAVITY) };
    let largest = |matrix: &Matrix3<T>| matrix.iter().fold(T::zero(), |most, x| most.larger(x.size()));
    let length = |v: &Vector3<T>| (v.x * v.x + v.y * v.y + v.z * v.z).sqrt();
    let (mass, centre) = (rod.mass(), rod.centre_of_mass());
    let mut figures = [T::from(f64::NAN); 8];
    let mut set = |figure: Figure, value: T| figures[figure as usize] = value;
    set(Figure::CRod, compliance.index(paper_contact_force()) / UM);
    set(Figure::CfMax, largest(&compliance.force) / UM);
    set(Figure::CgMax, largest(&compliance.gravity) / UM);
    set(Figure::Mass, mass / GRAM);
    set(Figure::Moment, mass * STANDARD_GRAVITY * length(&centre));
    set(Figure::Reach, length(&rod.tip()) / MM);
    figures
}

/// A figure that is to be small, or large.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Goal {
    /// The figure that counts.
    pub figure: Figure,
    /// True where more is better.
    pub is_maximised: bool,
}

impl Goal {
    /// The figure such that less is better.
    pub(super) fn cost(&self, figures: &Figures) -> f64 {
        let value = figures.0[self.figure as usize];
        if self.is_maximised { -value } else { value }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::{Load, Physics, RodModel};
    use crate::rod::BendFlexibility;

    #[test]
    fn the_moment_is_what_the_model_carries_at_the_flange() {
        let plain = Rod::read("rods/2.toml".as_ref()).unwrap();
        let bent = plain.clone().with_bend(0.08, BendFlexibility::Beam).with_angle(2.0);
        for rod in [plain, bent] {
            let model = RodModel::new(&rod, &Physics::WHOLE, 4, &[]).unwrap();
            let root = model.chain.resultant(Load::SelfWeight, 0);
            let (mass, centre) = (rod.mass(), rod.centre_of_mass());
            assert!((root.force[(0, 0)] / mass - 1.0).abs() < 1e-12);
            // M = [m r]ₓ
            let moment = crate::spatial::skew(&(centre * mass));
            assert!((root.moment - moment).norm() < 1e-12 * moment.norm(), "{} {moment}", root.moment);
        }
    }

    #[test]
    fn keys_are_told_apart_and_stand_at_their_places() {
        for (place, figure) in Figure::ALL.into_iter().enumerate() {
            assert_eq!(figure as usize, place);
            assert_eq!(Figure::ALL.iter().filter(|other| other.key() == figure.key()).count(), 1);
        }
    }
}
