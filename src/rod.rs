//! A bent measuring rod: what it is made of and where everything sits along its centreline.
//!
//! Tool frame {T}: origin at the flange, pipe I along +Z, both pipes in the X–Z plane.
//! A *station* is the arc length along the centreline from the flange; the tip is the largest one.

mod build;
pub(crate) mod constants;
pub(crate) mod file;
pub mod law;
mod nominal;
pub(crate) mod sleeve;
mod uncertainty;
mod warnings;
mod write;

pub use law::{LawConstant, LawMemory, LawVariable, MemoryConstant, RodLaw, RodLawPlace};
pub use nominal::{Feature, Nominal, NominalNumber, Part, SectionConstant};
pub use uncertainty::StandardUncertainty;
pub use warnings::Warning;

use std::f64::consts::PI;

use nalgebra::Vector3;

use crate::dual::Number;
use crate::material::Material;
use crate::section::Section;

/// A rod in SI units, as its file describes it or as it was built. [`Rod::read`],
/// [`Rod::from_toml`] and [`Rod::checked`] check it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Rod<T = f64> {
    /// Name, for people.
    pub name: String,
    /// Where its numbers come from, in the words of its file.
    pub source: Option<String>,
    /// Flange to the corner where the two centrelines meet, L1, m.
    pub l1: T,
    /// Corner to the ball centre, L2, m.
    pub l2: T,
    /// Inside angle between the pipes γ, rad: π/2 is the L-shape, π a straight rod.
    pub gamma: T,
    /// Radius of the bend's centreline R, m; 0 is a sharp corner. The arc is tangent to both pipes.
    pub bend_radius: T,
    /// How much more flexible the bend's cross-section is than beam theory says.
    pub bend_flexibility: BendFlexibility<T>,
    /// Flange to bend.
    pub pipe1: Pipe<T>,
    /// The bend; without effect while `bend_radius` is 0.
    pub bend: Pipe<T>,
    /// Bend to tip.
    pub pipe2: Pipe<T>,
    /// Ball and ball holder, lumped at the tip, kg.
    pub tip_mass: T,
    /// Rings and holders that carry no load.
    pub masses: Vec<LumpedMass<T>>,
    /// Bonded or threaded connections.
    pub joints: Vec<Joint<T>>,
    /// Pipes over or in a stretch of a straight pipe that bear with it.
    pub sleeves: Vec<Sleeve<T>>,
    /// What the beam model leaves out of it, as formulas.
    pub laws: Vec<RodLaw>,
    /// Largest load up to which the rod's maker or user calls it linear, N.
    pub linear_range: Option<f64>,
    /// How well the dimensions are known; each material carries its own.
    pub standard_uncertainty: StandardUncertainty,
    /// What the reader of the file wants its user to know.
    pub warnings: Vec<Warning>,
}

/// A pipe: its section and what it is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Pipe<T = f64> {
    /// Cross-section.
    pub section: Section<T>,
    /// Material.
    pub material: Material<T>,
}

/// A mass on the centreline that carries no load.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LumpedMass<T = f64> {
    /// Name, for people.
    pub name: String,
    /// Station, m.
    pub station: T,
    /// Mass, kg.
    pub mass: T,
}

/// A connection of no length that is compliant in rotation.
///
/// At a sharp corner its axis is that of the pipe on the flange's side.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Joint<T = f64> {
    /// Name, for people and for the diagnosis.
    pub name: String,
    /// Station, m.
    pub station: T,
    /// Rotation about each normal of the centreline per moment about it, rad/(N·m).
    pub bending: T,
    /// Rotation about the centreline per moment about it, rad/(N·m).
    pub torsion: T,
}

impl Joint {
    /// A joint at a station (m from the flange) with its compliances, rad/(N·m).
    pub fn new(name: impl Into<String>, station: f64, bending: f64, torsion: f64) -> Joint {
        Joint { name: name.into(), station, bending, torsion }
    }
}

impl LumpedMass {
    /// A mass (kg) at a station (m from the flange).
    pub fn new(name: impl Into<String>, station: f64, mass: f64) -> LumpedMass {
        LumpedMass { name: name.into(), station, mass }
    }
}

impl Sleeve {
    /// A sleeve between two stations (m from the flange).
    pub fn new(name: impl Into<String>, from: f64, to: f64, pipe: Pipe) -> Sleeve {
        Sleeve { name: name.into(), from, to, pipe }
    }
}

/// A pipe that bears together with the straight pipe that it sits on, or in.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Sleeve<T = f64> {
    /// Name, for people.
    pub name: String,
    /// Station where it begins, m.
    pub from: T,
    /// Station where it ends, m.
    pub to: T,
    /// Its own section and material.
    pub pipe: Pipe<T>,
}

/// A thin bent pipe ovalises and is more flexible in bending than a beam, by a factor k ≥ 1.
///
/// With h = tR/r² (t wall, R radius of the bend, r mean radius of the section).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum BendFlexibility<T = f64> {
    /// k = 1: beam theory.
    #[default]
    Beam,
    /// k = (10 + 12h²)/(1 + 12h²). T. von Kármán, "Über die Formänderung dünnwandiger Rohre", Z.
    /// VDI 55 (1911) 1889–1895.
    VonKarman,
    /// k = 1.65/h, not below 1. ASME B31.3 (2018), Table D300, welding elbow or pipe bend.
    AsmeB313,
    /// A factor from elsewhere, for example from a solid finite-element model or from a diagnosis.
    Factor(T),
}

impl<T: Number> BendFlexibility<T> {
    /// The factor k on the bending flexibility of the bend (in and out of its plane),
    /// dimensionless; `bend_radius` in m. The two formulas are for round tubes: 1 for any other
    /// section.
    ///
    /// ```
    /// use rodcal::rod::BendFlexibility;
    /// use rodcal::section::Round;
    ///
    /// // t 1 mm, r 15.5 mm, R 60.0625 mm: h = tR/r² = 1/4, k = (10 + 12/16)/(1 + 12/16) = 43/7
    /// let tube = Round::tube(0.032, 0.030).into();
    /// assert!((BendFlexibility::VonKarman.factor(&tube, 0.0600625) - 43.0 / 7.0).abs() < 1e-9);
    /// assert!((BendFlexibility::AsmeB313.factor(&tube, 0.0600625) - 6.6).abs() < 1e-9); // 1.65/h
    /// ```
    pub fn factor(&self, section: &Section<T>, bend_radius: T) -> T {
        // h = tR/r²
        let h = section.as_round().map(|tube| tube.wall() * bend_radius / tube.mean_radius().powi(2));
        match (*self, h) {
            (BendFlexibility::Factor(k), _) => k,
            (BendFlexibility::VonKarman, Some(h)) => (h * 12.0 * h + 10.0) / (h * 12.0 * h + 1.0),
            (BendFlexibility::AsmeB313, Some(h)) => (T::from(1.65) / h).larger(T::one()),
            (BendFlexibility::Beam, _) | (_, None) => T::one(),
        }
    }

    /// True where k follows from the wall of a round tube.
    pub fn is_for_tubes(&self) -> bool {
        matches!(self, BendFlexibility::VonKarman | BendFlexibility::AsmeB313)
    }
}

impl Pipe {
    /// A pipe of this section and material.
    ///
    /// ```
    /// use rodcal::prelude::*;
    /// use rodcal::section::Rectangle;
    ///
    /// let steel = Material::isotropic("steel", 193e9, 0.29, 7930.0);
    /// let bar = Pipe::new(Rectangle::solid(0.010, 0.020), steel);
    /// assert!((bar.mass_per_length() - 7930.0 * 2e-4).abs() < 1e-12);
    /// ```
    pub fn new(section: impl Into<Section>, material: Material) -> Pipe {
        Pipe { section: section.into(), material }
    }
}

impl<T: Number> Pipe<T> {
    /// Shear coefficients κ for forces in the rod's plane and out of it, dimensionless.
    pub fn shear_coefficients(&self) -> [T; 2] {
        let (ratio, nu) = (self.material.modulus_ratio(), self.material.poisson_ratio);
        self.section.shear_coefficients(ratio, nu).map(|kappa| kappa * self.material.shear_coefficient_factor)
    }

    /// Mass per length ρA, kg/m.
    pub fn mass_per_length(&self) -> T {
        self.material.density * self.section.area()
    }
}

impl<T: Number> Sleeve<T> {
    /// Its length, m.
    pub fn length(&self) -> T {
        self.to - self.from
    }

    /// Its mass, kg.
    pub fn mass(&self) -> T {
        self.pipe.mass_per_length() * self.length()
    }
}

impl<T: Number> Rod<T> {
    /// Angle the centreline turns through in the bend, π − γ, rad.
    pub fn turn(&self) -> T {
        -self.gamma + PI
    }

    /// What the bend takes off each pipe's length, R tan((π − γ)/2), m.
    pub fn tangent_length(&self) -> T {
        tangent_length(self.bend_radius, self.gamma)
    }

    /// Length of the arc R (π − γ), m; 0 for a sharp corner.
    pub fn arc_length(&self) -> T {
        self.bend_radius * self.turn()
    }

    /// Station where the first straight pipe ends, m.
    pub fn bend_start(&self) -> T {
        self.l1 - self.tangent_length()
    }

    /// Station where the second straight pipe begins, m.
    pub fn bend_end(&self) -> T {
        self.bend_start() + self.arc_length()
    }

    /// Station of the middle of the bend, m.
    pub fn bend_middle(&self) -> T {
        (self.bend_start() + self.bend_end()) / 2.0
    }

    /// Length of the centreline and so the tip's station, m.
    pub fn length(&self) -> T {
        self.bend_end() + self.l2 - self.tangent_length()
    }

    /// Mass of pipes, bend, sleeves, lumped masses and tip, kg.
    pub fn mass(&self) -> T {
        self.pipe1.mass_per_length() * self.bend_start()
            + self.bend.mass_per_length() * self.arc_length()
            + self.pipe2.mass_per_length() * (self.length() - self.bend_end())
            + self.sleeves.iter().map(Sleeve::mass).sum::<T>()
            + self.masses.iter().map(|m| m.mass).sum::<T>()
            + self.tip_mass
    }

    /// The undeflected ball centre in {T}, `[L2 sin γ, 0, L1 − L2 cos γ]`, m (the paper's Eq 1).
    pub fn tip(&self) -> Vector3<T> {
        let (sin, cos) = sin_cos_exact(self.gamma);
        Vector3::new(self.l2 * sin, T::zero(), self.l1 - self.l2 * cos)
    }

    /// Point of the undeformed centreline at a station (m; kept on the rod), in {T}, m.
    ///
    /// ```
    /// use rodcal::prelude::*;
    /// use rodcal::rod::BendFlexibility;
    ///
    /// let steel = Material::isotropic("steel", 193e9, 0.29, 7930.0);
    /// let rod = Rod::new("bent", 0.3, 0.3, Pipe::new(Round::solid(0.01), steel))
    ///     .with_bend(0.1, BendFlexibility::Beam);
    /// // the middle of the arc is R(1 − 1/√2) off both tangents
    /// let middle = rod.point((rod.bend_start() + rod.bend_end()) / 2.0);
    /// assert!((middle.x - 0.1 * (1.0 - 0.5f64.sqrt())).abs() < 1e-12);
    /// assert!((middle.z - (0.2 + 0.1 * 0.5f64.sqrt())).abs() < 1e-12);
    /// ```
    pub fn point(&self, station: T) -> Vector3<T> {
        let zero = T::zero();
        let station = station.larger(zero).smaller(self.length());
        if station.value() <= self.bend_start().value() {
            return Vector3::new(zero, zero, station);
        }
        let (sin, cos) = sin_cos_exact(self.gamma);
        if station.value() >= self.bend_end().value() {
            // back from the tip along pipe II, whose direction is (sin γ, 0, −cos γ)
            return self.tip() - Vector3::new(sin, zero, -cos) * (self.length() - station);
        }
        let turned = (station - self.bend_start()) / self.bend_radius;
        Vector3::new(-turned.cos() + 1.0, zero, turned.sin()) * self.bend_radius
            + Vector3::new(zero, zero, self.bend_start())
    }

    /// Centre of mass in {T}, m; the flange for a rod without mass.
    pub fn centre_of_mass(&self) -> Vector3<T> {
        let (start, end, length) = (self.bend_start(), self.bend_end(), self.length());
        let mut moment = self.point(start / 2.0) * (self.pipe1.mass_per_length() * start);
        moment += self.point((end + length) / 2.0) * (self.pipe2.mass_per_length() * (length - end));
        if self.arc_length().value() > 0.0 {
            // the centroid of an arc lies on its bisector, R·sin(φ/2)/(φ/2) from its centre
            let half = self.turn() / 2.0;
            let across = Vector3::new(half.cos(), T::zero(), -half.sin());
            let sagitta = self.bend_radius * (half.sin() / half - half.cos());
            let centroid = (self.point(start) + self.point(end)) * T::from(0.5) - across * sagitta;
            moment += centroid * (self.bend.mass_per_length() * self.arc_length());
        }
        let middle = |sleeve: &Sleeve<T>| self.point((sleeve.from + sleeve.to) / 2.0);
        moment += self.sleeves.iter().map(|s| middle(s) * s.mass()).sum::<Vector3<T>>();
        moment += self.masses.iter().map(|m| self.point(m.station) * m.mass).sum::<Vector3<T>>();
        moment += self.tip() * self.tip_mass;
        let mass = self.mass();
        if mass.value() > 0.0 { moment / mass } else { Vector3::zeros() }
    }
}

impl Rod {
    /// The two pipes are one tube of one material, as the paper's closed form (Calc) assumes.
    pub fn is_uniform(&self) -> bool {
        let same = |a: &Material, b: &Material| {
            (a.youngs_modulus, a.shear_modulus, a.density) == (b.youngs_modulus, b.shear_modulus, b.density)
        };
        self.pipe1.section == self.pipe2.section && same(&self.pipe1.material, &self.pipe2.material)
    }
}

/// What an arc of radius R takes off each pipe at the inside angle γ, m. A straight rod (γ = π) has
/// no bend.
fn tangent_length<T: Number>(bend_radius: T, gamma: T) -> T {
    // a sharp corner takes nothing; a search asks for this a hundred times a rod
    if bend_radius.value() == 0.0 {
        return T::zero();
    }
    bend_radius * ((-gamma + PI) / 2.0).tan()
}

/// Sine and cosine that are exact at the right and the straight angle, where `sin π` would leave
/// 1e-16.
pub(crate) fn sin_cos_exact<T: Number>(angle: T) -> (T, T) {
    // whose derivative stays
    let clean = |x: T| if x.value().abs() < 1e-15 { x - T::from(x.value()) } else { x };
    (clean(angle.sin()), clean(angle.cos()))
}
