//! How compliance, mass and first frequency follow every number of a rod.
//!
//! The rod's numbers carry a derivative through the formulas that compute the figures
//! ([`Rod::derivative`]): no steps, no second set of formulas, exact to rounding.

use nalgebra::Matrix3;

use super::Compliance;
use crate::beam::{Physics, RodModel};
use crate::dual::Dual;
use crate::error::Result;
use crate::material::Material;
use crate::material::laminate::{self, Ply, PlyNumber};
use crate::parallel::in_parallel;
use crate::rod::{NominalNumber, Rod};
use crate::units::STANDARD_GRAVITY;

/// Derivatives by one number of a rod, everything in SI units per SI unit of the number.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Sensitivity {
    /// By which number.
    pub number: NominalNumber,
    /// Its value.
    pub value: f64,
    /// Of C^F and C^g.
    pub compliance: Compliance,
    /// Of c_rod under the contact force that was asked for.
    pub index: f64,
    /// Of the mass.
    pub mass: f64,
    /// Of the first natural frequency (all physics), Hz; 0 where nothing has mass.
    pub frequency: f64,
}

impl Sensitivity {
    /// With so much of another one.
    fn add(&mut self, other: &Sensitivity, factor: f64) {
        self.compliance.force += other.compliance.force * factor;
        self.compliance.gravity += other.compliance.gravity * factor;
        self.index += other.index * factor;
        self.mass += other.mass * factor;
        self.frequency += other.frequency * factor;
    }
}

/// Derivatives of `rod` by every number of it ([`Rod::numbers`]) under `physics`, and with a
/// contact force of this size (N). Where G was stated by E and ν there is none by G, which changes
/// with them.
///
/// At entries of C^F or C^g that are 0 by symmetry, |C| of c_rod has a kink; there the derivative
/// is the one as the number grows.
///
/// ```
/// use rodcal::compliance::sensitivities;
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let all = sensitivities(&rod, &Physics::default(), paper_contact_force())?;
/// let number = |name: &str| all.iter().find(|one| one.number.to_string() == name).expect("5# has it");
/// let index = Compliance::of_model(&rod, &Physics::default(), 10)?.index(paper_contact_force());
/// // 1 % more of L2: c_rod grows by 2.8 %
/// let share = number("l2").index * rod.l2 / index;
/// assert!((share - 2.8).abs() < 0.1, "{share}");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`RodModel::new`] and [`Rod::natural_modes`].
pub fn sensitivities(rod: &Rod, physics: &Physics, contact_force: f64) -> Result<Vec<Sensitivity>> {
    let numbers = rod.numbers();
    let frequencies = rod.natural_frequency_slopes(&numbers)?.map(|(_, slopes)| slopes);
    let all = in_parallel(numbers.len(), |k| {
        let number = &numbers[k];
        let Some(varied) = rod.derivative(number) else { return Ok(None) };
        let [force, weight] = RodModel::new(&varied, physics, 1, &[])?.chain.tip_motion();
        let compliance = Compliance { force, gravity: weight.map(|entry| entry * STANDARD_GRAVITY) };
        Ok(Some(Sensitivity {
            number: number.clone(),
            value: rod.value_of(number).unwrap_or(f64::NAN),
            index: compliance.index(contact_force).eps,
            compliance: Compliance {
                force: compliance.force.map(|entry| entry.eps),
                gravity: compliance.gravity.map(|entry| entry.eps),
            },
            mass: varied.mass().eps,
            frequency: frequencies.as_ref().map_or(0.0, |slopes| slopes[k]),
        }))
    });
    let mut all: Vec<Sensitivity> = all.into_iter().filter_map(Result::transpose).collect::<Result<_>>()?;
    let pipes = [&rod.pipe1, &rod.bend, &rod.pipe2].into_iter();
    for material in pipes.chain(rod.sleeves.iter().map(|sleeve| &sleeve.pipe)).map(|pipe| &pipe.material) {
        if material.is_shear_modulus_derived {
            along_with_shear_modulus(&mut all, material);
        }
    }
    for (material, plies) in rod.plies() {
        let of_number = |number| by_ply(&all, material, plies, number);
        let own: Vec<Sensitivity> = PlyNumber::all(plies.len()).filter_map(of_number).collect();
        all.extend(own);
    }
    Ok(all)
}

/// The derivative by a number of a laminate's plies, of which E, G and ν are made:
///
/// ```text
/// d/dp = ∂E/∂p·∂/∂E + ∂G/∂p·∂/∂G + ∂ν/∂p·∂/∂ν
/// ```
fn by_ply(all: &[Sensitivity], material: &str, plies: &[Ply], number: PlyNumber) -> Option<Sensitivity> {
    let name = || material.to_owned();
    let slopes = laminate::slopes(plies, number)?;
    let made = [
        NominalNumber::YoungsModulus(name()),
        NominalNumber::ShearModulus(name()),
        NominalNumber::PoissonRatio(name()),
    ];
    let mut sum = Sensitivity {
        number: NominalNumber::Ply(name(), number),
        value: number.value_in(plies)?,
        compliance: Compliance { force: Matrix3::zeros(), gravity: Matrix3::zeros() },
        index: 0.0,
        mass: 0.0,
        frequency: 0.0,
    };
    for (made, slope) in made.iter().zip(slopes) {
        let one = all.iter().find(|one| one.number == *made)?;
        sum.add(one, slope);
    }
    Some(sum)
}

/// Derivatives by E and ν where G follows them, instead of one by G:
///
/// ```text
/// G = E/2(1+ν),   d/dE = ∂/∂E + (G/E)·∂/∂G,   d/dν = ∂/∂ν − (G/(1+ν))·∂/∂G
/// ```
fn along_with_shear_modulus(all: &mut Vec<Sensitivity>, material: &Material) {
    let name = &material.name;
    let is_by_it = |one: &Sensitivity| one.number == NominalNumber::ShearModulus(name.clone());
    let Some(place) = all.iter().position(is_by_it) else { return };
    let by_it = all.remove(place);
    let g = material.shear_modulus;
    for (number, factor) in [
        (NominalNumber::YoungsModulus(name.clone()), g / material.youngs_modulus),
        (NominalNumber::PoissonRatio(name.clone()), -g / (1.0 + material.poisson_ratio)),
    ] {
        if let Some(one) = all.iter_mut().find(|one| one.number == number) {
            one.add(&by_it, factor);
        }
    }
}

/// Standard uncertainty of every entry of C^F and C^g that the rod's numbers bring with them
/// ([`Rod::nominal_numbers`], taken as independent), under `physics`:
///
/// ```text
/// u²(C) = Σ (∂C/∂p)² u²(p)                   (GUM, JCGM 100:2008, 5.1.2)
/// ```
///
/// ```
/// use rodcal::compliance::standard_uncertainty;
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let physics = Physics::default();
/// let (value, u) = (Compliance::of_model(&rod, &physics, 10)?, standard_uncertainty(&rod, &physics)?);
/// // E to 1 % and G to 2 %, and the wall of 1 mm from two diameters of 0.03 mm each: some 2 %
/// let relative = u.force[(2, 2)] / value.force[(2, 2)];
/// assert!((0.01..0.04).contains(&relative), "{relative}");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`RodModel::new`].
pub fn standard_uncertainty(rod: &Rod, physics: &Physics) -> Result<Compliance> {
    let (mut force, mut gravity) = (Matrix3::zeros(), Matrix3::zeros());
    for nominal in rod.nominal_numbers() {
        let Some(varied) = rod.derivative(&nominal.number) else { continue };
        let [by_force, by_weight] = RodModel::new(&varied, physics, 1, &[])?.chain.tip_motion();
        let square = |entry: Dual| (entry.eps * nominal.standard_uncertainty).powi(2);
        force += by_force.map(square);
        gravity += by_weight.map(|entry| square(entry * STANDARD_GRAVITY));
    }
    Ok(Compliance { force: force.map(f64::sqrt), gravity: gravity.map(f64::sqrt) })
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::compliance::paper_contact_force;
    use crate::rod::{BendFlexibility, Joint, Pipe};
    use crate::section::{General, Rectangle, Round};

    /// Every kind of section, of bend, of feature: against central differences, to 1e-6.
    #[test]
    fn derivatives_are_those_of_differences() {
        let mut plain = Rod::read("rods/2.toml".as_ref()).unwrap();
        for pipe in [&mut plain.pipe1, &mut plain.bend, &mut plain.pipe2] {
            // each modulus by itself
            pipe.material.is_shear_modulus_derived = false;
        }
        let joint = Joint { name: "glue".into(), station: 0.11, bending: 1e-4, torsion: 2e-4 };
        let mut steel = Material::isotropic("steel", 200e9, 0.3, 7900.0);
        steel.is_shear_modulus_derived = false;
        let collar = Pipe::new(Round::tube(0.06, 0.05), steel);
        let mut bent = plain.clone().with_bend(0.06, BendFlexibility::VonKarman).with_angle(1.9);
        // a mass at a joint has a kink there
        bent.masses[0].station += 0.004;
        let mut boxes = bent.clone().with_bend(0.05, BendFlexibility::Factor(3.0));
        boxes.pipe1.section = Rectangle::hollow(0.02, 0.03, 0.002).into();
        boxes.bend.section = Rectangle::solid(0.011, 0.02).into();
        let mut general = plain.clone();
        general.pipe2.section =
            General { area: 1e-4, iy: 3e-9, iz: 2e-9, torsion_constant: 4e-9, shear_coefficient: 0.5 }.into();
        let mut asme = plain.clone().with_bend(0.04, BendFlexibility::AsmeB313);
        asme.masses.clear();
        for rod in [
            plain,
            bent.with_mass("ring", 0.31, 0.1).with_joint(joint).with_sleeve("collar", 0.4, 0.47, collar),
            boxes,
            general,
            asme,
        ] {
            let at = |rod: &Rod| {
                let [force, weight] = RodModel::new(rod, &Physics::WHOLE, 1, &[]).unwrap().chain.tip_motion();
                (Compliance { force, gravity: weight * STANDARD_GRAVITY }, rod.mass())
            };
            let here = at(&rod);
            let all = sensitivities(&rod, &Physics::WHOLE, paper_contact_force()).unwrap();
            assert_eq!(all.len(), rod.numbers().len());
            for one in all {
                // of fourth order: 1e-4 of a diameter is much of a wall
                let step = if one.value == 0.0 { 1e-6 } else { 1e-4 * one.value };
                let [a, b, c, d] =
                    [-2.0, -1.0, 1.0, 2.0].map(|k| at(&rod.with(&one.number, one.value + k * step)));
                let difference = |entry: &dyn Fn(&(Compliance, f64)) -> Matrix3<f64>| {
                    ((entry(&c) - entry(&b)) * 8.0 - (entry(&d) - entry(&a))) / (12.0 * step)
                };
                // to 1e-6 of the derivative, and to 1e-10 of what 1 % of the number would do to the
                // figure
                let size = 0.01 * one.value.abs().max(1e-3);
                let force = paper_contact_force();
                let index = |both: &(Compliance, f64)| Matrix3::repeat(both.0.index(force));
                let mass = |both: &(Compliance, f64)| Matrix3::repeat(both.1);
                for (slope, entry) in [
                    (one.compliance.force, &(|both: &(Compliance, f64)| both.0.force) as &dyn Fn(&_) -> _),
                    (one.compliance.gravity, &|both: &(Compliance, f64)| both.0.gravity),
                    (Matrix3::repeat(one.index), &index),
                    (Matrix3::repeat(one.mass), &mass),
                ] {
                    let off = (slope - difference(entry)).amax();
                    let whole = 1e-6 * slope.amax() + 1e-10 * entry(&here).amax() / size;
                    assert!(off < whole, "{}: {off} of {whole}", one.number);
                }
            }
        }
    }

    /// As a rod file has it: E and ν, of which the reader makes G.
    #[test]
    fn the_shear_modulus_follows_what_it_was_stated_by() {
        let text = std::fs::read_to_string("rods/2.toml").unwrap();
        let with = |e: f64, nu: f64| {
            let mut rod = Rod::from_toml("rods/2.toml", &text).unwrap();
            for pipe in [&mut rod.pipe1, &mut rod.bend, &mut rod.pipe2] {
                pipe.material = Material::isotropic("steel", e, nu, 7900.0);
            }
            rod
        };
        let index = |rod: Rod| Compliance::of_model(&rod, &Physics::WHOLE, 1).unwrap().index(2.0);
        let (e, nu) = (200e9, 0.29);
        let all = sensitivities(&with(e, nu), &Physics::WHOLE, 2.0).unwrap();
        let found_by = |number: NominalNumber| all.iter().find(|one| one.number == number);
        let by_e = (index(with(e * 1.0001, nu)) - index(with(e * 0.9999, nu))) / (2e-4 * e);
        let by_nu = (index(with(e, nu + 1e-4)) - index(with(e, nu - 1e-4))) / 2e-4;
        let name = || "steel".to_owned();
        for (number, expected) in
            [(NominalNumber::YoungsModulus(name()), by_e), (NominalNumber::PoissonRatio(name()), by_nu)]
        {
            let found = found_by(number.clone()).unwrap().index;
            assert!((found / expected - 1.0).abs() < 1e-6, "{number}: {found} {expected}");
        }
        assert!(found_by(NominalNumber::ShearModulus(name())).is_none());
    }

    /// A sleeve and its mass are one thing: they move together, and are named once.
    #[test]
    fn what_sits_at_one_station_moves_together() {
        let steel = Rod::read("rods/5.toml".as_ref()).unwrap();
        let rod = |station: f64| {
            let joint = Joint { name: "glue".into(), station, bending: 1e-4, torsion: 2e-4 };
            steel.clone().with_mass("sleeve", station, 0.1).with_joint(joint)
        };
        let all = sensitivities(&rod(0.3), &Physics::WHOLE, 2.0).unwrap();
        let stations: Vec<&Sensitivity> =
            all.iter().filter(|one| matches!(one.number, NominalNumber::Station(_))).collect();
        assert_eq!(stations.len(), 1);
        let at = |station: f64| Compliance::of_model(&rod(station), &Physics::WHOLE, 5).unwrap().index(2.0);
        let expected = (at(0.3001) - at(0.2999)) / 2e-4;
        assert!((stations[0].index / expected - 1.0).abs() < 1e-6, "{} {expected}", stations[0].index);
    }

    /// A laminate's plies, against rods whose files have other ones.
    #[test]
    fn a_laminate_is_followed_into_its_plies() {
        let text = std::fs::read_to_string("rods/2.toml").unwrap();
        let from = text.find("[material.").unwrap();
        let to = from + text[from..].find("[pipe1]").unwrap();
        let name = text[from + "[material.".len()..].split(']').next().unwrap().to_owned();
        let file = |e1: f64, angle: f64| {
            let material = format!(
                "[material.{name}]\nply_e1_gpa = {e1:?}\nply_e2_gpa = 9.0\nply_g12_gpa = 5.0\nply_nu12 = 0.3\n\
                 ply_thickness_mm = 0.25\nply_angles_deg = [0.0, 0.0, {angle:?}, -45.0]\ndensity_kg_m3 = 1600.0\n"
            );
            Rod::from_toml("rod.toml", &format!("{}{material}{}", &text[..from], &text[to..])).unwrap()
        };
        let index = |rod: &Rod| {
            Compliance::of_model(rod, &Physics::default(), 4).unwrap().index(paper_contact_force())
        };
        let all = sensitivities(&file(130.0, 45.0), &Physics::default(), paper_contact_force()).unwrap();
        let by = |number: PlyNumber| {
            let wanted = NominalNumber::Ply(name.clone(), number);
            all.iter().find(|one| one.number == wanted).unwrap().index
        };
        let of_e1 = (index(&file(130.1, 45.0)) - index(&file(129.9, 45.0))) / 0.2e9;
        assert!((by(PlyNumber::E1) / of_e1 - 1.0).abs() < 1e-5, "{} {of_e1}", by(PlyNumber::E1));
        let of_angle = (index(&file(130.0, 45.1)) - index(&file(130.0, 44.9))) / 0.2f64.to_radians();
        assert!((by(PlyNumber::Angle(2)) / of_angle - 1.0).abs() < 1e-5, "{of_angle}");
        // fibres along the pipe: at 0° nothing changes to first order but by coupling
        assert_eq!(all.iter().filter(|one| matches!(one.number, NominalNumber::Ply(..))).count(), 8);
    }
}
