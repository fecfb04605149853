//! Which numbers a rod has, and what they are called: in words, as keys and tables of its file.

use std::fmt;

use crate::material::laminate::PlyNumber;
use crate::units::{DEG, GPA, GRAM, MM, URAD_PER_NM};

/// A number of the rod file.
///
/// ```
/// use rodcal::prelude::*;
/// use rodcal::rod::NominalNumber;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let number = NominalNumber::YoungsModulus("steel".into());
/// let compliance = |rod: &Rod| Compliance::of_model(rod, &Physics::default(), 10);
/// // the tip gives way by 1/E, but for torsion and shear
/// let softer = compliance(&rod.with(&number, 0.99 * 193e9))?;
/// let ratio = softer.force[(2, 2)] / compliance(&rod)?.force[(2, 2)];
/// assert!((ratio - 1.0 / 0.99).abs() < 1e-4);
/// assert_eq!((number.to_string(), number.key()), ("E of steel".into(), "youngs_modulus_percent"));
/// # Ok::<(), rodcal::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum NominalNumber {
    /// E of the material of this name, Pa, in every pipe made of it.
    YoungsModulus(String),
    /// G of the material of this name, Pa, in every pipe made of it.
    ShearModulus(String),
    /// ρ of the material of this name, kg/m³, in every pipe made of it.
    Density(String),
    /// What multiplies κ of every section of the material of this name, dimensionless, nominally 1.
    ShearCoefficient(String),
    /// Outer diameter of a tube or a round, m.
    OuterDiameter(Part),
    /// Inner diameter of a tube, m.
    InnerDiameter(Part),
    /// Width of a rectangle, m.
    Width(Part),
    /// Height of a rectangle, m.
    Height(Part),
    /// Wall thickness of a box, m.
    Wall(Part),
    /// A constant of a general section, m² or m⁴.
    Section(Part, SectionConstant),
    /// Flange to corner, L1, m.
    LengthL1,
    /// Corner to ball centre, L2, m.
    LengthL2,
    /// Radius of the bend, m.
    BendRadius,
    /// Where a ring, a holder, a joint or an end of a sleeve sits, m from the flange.
    Station(Feature),
    /// Ball and ball holder, kg.
    TipMass,
    /// Inside angle between the pipes γ, rad.
    Angle,
    /// ν of the material of this name, dimensionless, in every pipe made of it.
    PoissonRatio(String),
    /// A bend's flexibility factor that the file states, dimensionless.
    BendFactor,
    /// A ring or a holder, kg; masses of one name go together.
    Mass(String),
    /// Bending compliance of the joint of this name, rad/(N·m).
    JointBending(String),
    /// Torsional compliance of the joint of this name, rad/(N·m).
    JointTorsion(String),
    /// What E, G and ν of the laminate of this name are made of; the beam model knows those alone.
    Ply(String, PlyNumber),
}

/// A part that has a section of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Part {
    /// Flange to bend. The bend goes with it where it is the same tube.
    Pipe1,
    /// The bend, where it is another tube than pipe 1.
    Bend,
    /// Bend to tip.
    Pipe2,
    /// The sleeve of this number, in the order of the rod file, from 0.
    Sleeve(usize),
}

/// A constant of a [`crate::section::General`] section.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SectionConstant {
    /// Area A of the section.
    Area,
    /// Second moment I_y of the section.
    Iy,
    /// Second moment I_z of the section.
    Iz,
    /// Torsion constant J.
    TorsionConstant,
    /// Shear coefficient κ, dimensionless.
    ShearCoefficient,
}

/// Something that sits at a station.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Feature {
    /// The joint of this name.
    Joint(String),
    /// The mass of this name; masses of one name go together.
    Mass(String),
    /// The beginning of the sleeve of this number, in the order of the rod file, from 0.
    SleeveFrom(usize),
    /// The end of the sleeve of this number, likewise.
    SleeveTo(usize),
}

impl NominalNumber {
    /// The key under which reports and JSON name it: the one of `[standard_uncertainty]` for what
    /// is stated in per cent, else that of the rod file, with its unit.
    pub fn key(&self) -> &'static str {
        match self {
            NominalNumber::YoungsModulus(_) => "youngs_modulus_percent",
            NominalNumber::ShearModulus(_) => "shear_modulus_percent",
            NominalNumber::Density(_) => "density_percent",
            NominalNumber::ShearCoefficient(_) => "shear_coefficient_percent",
            NominalNumber::OuterDiameter(_) => "outer_diameter_mm",
            NominalNumber::InnerDiameter(_) => "inner_diameter_mm",
            NominalNumber::Width(_) => "width_mm",
            NominalNumber::Height(_) => "height_mm",
            NominalNumber::Wall(_) => "wall_mm",
            NominalNumber::Section(_, SectionConstant::Area) => "area_percent",
            NominalNumber::Section(_, SectionConstant::Iy) => "iy_percent",
            NominalNumber::Section(_, SectionConstant::Iz) => "iz_percent",
            NominalNumber::Section(_, SectionConstant::TorsionConstant) => "j_percent",
            NominalNumber::LengthL1 => "l1_mm",
            NominalNumber::LengthL2 => "l2_mm",
            NominalNumber::BendRadius => "bend_radius_mm",
            NominalNumber::Station(Feature::SleeveFrom(_)) => "from_mm",
            NominalNumber::Station(Feature::SleeveTo(_)) => "to_mm",
            NominalNumber::Station(_) => "station_mm",
            NominalNumber::TipMass | NominalNumber::Mass(_) => "mass_g",
            NominalNumber::Section(_, SectionConstant::ShearCoefficient) => "kappa",
            NominalNumber::Angle => "gamma_deg",
            NominalNumber::PoissonRatio(_) => "poisson_ratio",
            NominalNumber::BendFactor => "bend_flexibility",
            NominalNumber::JointBending(_) => "bending_urad_per_nm",
            NominalNumber::JointTorsion(_) => "torsion_urad_per_nm",
            NominalNumber::Ply(_, PlyNumber::E1) => "ply_e1_gpa",
            NominalNumber::Ply(_, PlyNumber::E2) => "ply_e2_gpa",
            NominalNumber::Ply(_, PlyNumber::G12) => "ply_g12_gpa",
            NominalNumber::Ply(_, PlyNumber::Nu12) => "ply_nu12",
            NominalNumber::Ply(_, PlyNumber::Angle(_)) => "ply_angles_deg",
        }
    }

    /// Its key in the rod file, and one of its unit in SI.
    pub fn in_file(&self) -> (&'static str, f64) {
        match self {
            NominalNumber::YoungsModulus(_) => ("youngs_modulus_gpa", GPA),
            NominalNumber::ShearModulus(_) => ("shear_modulus_gpa", GPA),
            NominalNumber::Density(_) => ("density_kg_m3", 1.0),
            NominalNumber::ShearCoefficient(_) => ("shear_coefficient_factor", 1.0),
            NominalNumber::Section(_, SectionConstant::Area) => ("area_mm2", MM * MM),
            NominalNumber::Section(_, SectionConstant::Iy) => ("iy_mm4", MM * MM * MM * MM),
            NominalNumber::Section(_, SectionConstant::Iz) => ("iz_mm4", MM * MM * MM * MM),
            NominalNumber::Section(_, SectionConstant::TorsionConstant) => ("j_mm4", MM * MM * MM * MM),
            NominalNumber::OuterDiameter(_)
            | NominalNumber::InnerDiameter(_)
            | NominalNumber::Width(_)
            | NominalNumber::Height(_)
            | NominalNumber::Wall(_)
            | NominalNumber::LengthL1
            | NominalNumber::LengthL2
            | NominalNumber::BendRadius
            | NominalNumber::Station(_) => (self.key(), MM),
            NominalNumber::TipMass | NominalNumber::Mass(_) => (self.key(), GRAM),
            NominalNumber::Angle | NominalNumber::Ply(_, PlyNumber::Angle(_)) => (self.key(), DEG),
            NominalNumber::JointBending(_) | NominalNumber::JointTorsion(_) => (self.key(), URAD_PER_NM),
            NominalNumber::Ply(_, PlyNumber::E1 | PlyNumber::E2 | PlyNumber::G12) => (self.key(), GPA),
            NominalNumber::Section(_, SectionConstant::ShearCoefficient)
            | NominalNumber::PoissonRatio(_)
            | NominalNumber::BendFactor
            | NominalNumber::Ply(_, PlyNumber::Nu12) => (self.key(), 1.0),
        }
    }

    /// The table of the rod file it stands in, with the name where there is one: `material.steel`,
    /// `pipe1`, `geometry`, `joint.sleeve-a`, `tip`.
    pub fn place(&self) -> String {
        match self {
            NominalNumber::YoungsModulus(material)
            | NominalNumber::ShearModulus(material)
            | NominalNumber::Density(material)
            | NominalNumber::ShearCoefficient(material)
            | NominalNumber::PoissonRatio(material)
            | NominalNumber::Ply(material, _) => format!("material.{material}"),
            NominalNumber::OuterDiameter(part)
            | NominalNumber::InnerDiameter(part)
            | NominalNumber::Width(part)
            | NominalNumber::Height(part)
            | NominalNumber::Wall(part)
            | NominalNumber::Section(part, _) => part.key(),
            NominalNumber::LengthL1
            | NominalNumber::LengthL2
            | NominalNumber::BendRadius
            | NominalNumber::Angle
            | NominalNumber::BendFactor => "geometry".to_owned(),
            NominalNumber::Station(Feature::Joint(name))
            | NominalNumber::JointBending(name)
            | NominalNumber::JointTorsion(name) => format!("joint.{name}"),
            NominalNumber::Station(Feature::Mass(name)) | NominalNumber::Mass(name) => {
                format!("mass.{name}")
            }
            NominalNumber::Station(Feature::SleeveFrom(sleeve) | Feature::SleeveTo(sleeve)) => {
                Part::Sleeve(*sleeve).key()
            }
            NominalNumber::TipMass => "tip".to_owned(),
        }
    }

    /// A change (SI) of this number from its `nominal` value (SI) in the unit of
    /// [`NominalNumber::key`]: per cent, mm or g.
    pub fn in_unit(&self, change: f64, nominal: f64) -> f64 {
        match self.change_unit() {
            ChangeUnit::Gram => change / GRAM,
            ChangeUnit::Millimetre => change / MM,
            ChangeUnit::Percent => change / nominal * 100.0,
        }
    }

    /// What changes of it are counted in.
    pub(super) fn change_unit(&self) -> ChangeUnit {
        match self {
            NominalNumber::OuterDiameter(_)
            | NominalNumber::InnerDiameter(_)
            | NominalNumber::Width(_)
            | NominalNumber::Height(_)
            | NominalNumber::Wall(_)
            | NominalNumber::LengthL1
            | NominalNumber::LengthL2
            | NominalNumber::BendRadius
            | NominalNumber::Station(_) => ChangeUnit::Millimetre,
            NominalNumber::TipMass | NominalNumber::Mass(_) => ChangeUnit::Gram,
            NominalNumber::YoungsModulus(_)
            | NominalNumber::ShearModulus(_)
            | NominalNumber::Density(_)
            | NominalNumber::ShearCoefficient(_)
            | NominalNumber::Section(..)
            | NominalNumber::Angle
            | NominalNumber::PoissonRatio(_)
            | NominalNumber::BendFactor
            | NominalNumber::JointBending(_)
            | NominalNumber::JointTorsion(_)
            | NominalNumber::Ply(..) => ChangeUnit::Percent,
        }
    }
}

/// What changes of a number are counted in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ChangeUnit {
    Percent,
    Millimetre,
    Gram,
}

impl Part {
    /// Its table in the rod file; sleeves with their number from 1.
    pub fn key(&self) -> String {
        match self {
            Part::Pipe1 => "pipe1".into(),
            Part::Bend => "bend".into(),
            Part::Pipe2 => "pipe2".into(),
            Part::Sleeve(sleeve) => format!("sleeve.{}", sleeve + 1),
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Part::Pipe1 => f.write_str("pipe 1"),
            Part::Bend => f.write_str("the bend"),
            Part::Pipe2 => f.write_str("pipe 2"),
            Part::Sleeve(sleeve) => write!(f, "sleeve {}", sleeve + 1),
        }
    }
}

impl fmt::Display for NominalNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NominalNumber::YoungsModulus(material) => write!(f, "E of {material}"),
            NominalNumber::ShearModulus(material) => write!(f, "G of {material}"),
            NominalNumber::Density(material) => write!(f, "density of {material}"),
            NominalNumber::ShearCoefficient(material) => write!(f, "shear coefficient of {material}"),
            NominalNumber::OuterDiameter(part) => write!(f, "outer diameter of {part}"),
            NominalNumber::InnerDiameter(part) => write!(f, "inner diameter of {part}"),
            NominalNumber::Width(part) => write!(f, "width of {part}"),
            NominalNumber::Height(part) => write!(f, "height of {part}"),
            NominalNumber::Wall(part) => write!(f, "wall of {part}"),
            NominalNumber::Section(part, SectionConstant::Area) => write!(f, "area of {part}"),
            NominalNumber::Section(part, SectionConstant::Iy) => write!(f, "I_y of {part}"),
            NominalNumber::Section(part, SectionConstant::Iz) => write!(f, "I_z of {part}"),
            NominalNumber::Section(part, SectionConstant::TorsionConstant) => write!(f, "J of {part}"),
            NominalNumber::LengthL1 => f.write_str("l1"),
            NominalNumber::LengthL2 => f.write_str("l2"),
            NominalNumber::BendRadius => f.write_str("bend radius"),
            NominalNumber::Station(Feature::Joint(name)) => write!(f, "station of joint {name}"),
            NominalNumber::Station(Feature::Mass(name)) => write!(f, "station of mass {name}"),
            NominalNumber::Station(Feature::SleeveFrom(sleeve)) => {
                write!(f, "beginning of {}", Part::Sleeve(*sleeve))
            }
            NominalNumber::Station(Feature::SleeveTo(sleeve)) => {
                write!(f, "end of {}", Part::Sleeve(*sleeve))
            }
            NominalNumber::TipMass => f.write_str("tip mass"),
            NominalNumber::Section(part, SectionConstant::ShearCoefficient) => write!(f, "κ of {part}"),
            NominalNumber::Angle => f.write_str("γ"),
            NominalNumber::PoissonRatio(material) => write!(f, "ν of {material}"),
            NominalNumber::BendFactor => f.write_str("flexibility factor of the bend"),
            NominalNumber::Mass(name) => write!(f, "mass {name}"),
            NominalNumber::JointBending(name) => write!(f, "bending compliance of joint {name}"),
            NominalNumber::JointTorsion(name) => write!(f, "torsional compliance of joint {name}"),
            NominalNumber::Ply(material, PlyNumber::E1) => write!(f, "E₁ of the plies of {material}"),
            NominalNumber::Ply(material, PlyNumber::E2) => write!(f, "E₂ of the plies of {material}"),
            NominalNumber::Ply(material, PlyNumber::G12) => write!(f, "G₁₂ of the plies of {material}"),
            NominalNumber::Ply(material, PlyNumber::Nu12) => write!(f, "ν₁₂ of the plies of {material}"),
            NominalNumber::Ply(material, PlyNumber::Angle(ply)) => {
                write!(f, "angle of ply {} of {material}", ply + 1)
            }
        }
    }
}
