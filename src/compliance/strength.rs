//! Whether a rod springs back: the stress where it is largest, beside what its material and its
//! wall bear.
//!
//! The rod is an open chain, so that moments follow from statics alone. Under a weight of one g and
//! the contact force, each along its own worst axis, a fibre of the section bears
//! `σ = (|M_gᵀ v| g + |M_Fᵀ v| F)`, with v the fibre's distance from the axis over the second
//! moment of area, and a round one `τ = M_t r/J` besides. Where a sleeve bears too, each of the two
//! has the second moment of both in its own modulus, `Σ EI/E` (and `Σ GJ/G`). What is
//! compared is von Mises' stress `√(σ² + 3τ²)`.

use nalgebra::{Matrix3, Vector3};

use crate::beam::{Load, Physics, RodModel};
use crate::error::Result;
use crate::rod::{Pipe, Rod};
use crate::section::Section;
use crate::units::STANDARD_GRAVITY;

/// What a rod does not bear.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Overload {
    /// Stress where it exceeds its limit by the largest factor, Pa.
    pub stress: f64,
    /// Where that is, m from the flange along the centreline.
    pub station: f64,
    /// What it exceeds, Pa.
    pub limit: f64,
    /// Whose limit that is.
    pub kind: Strength,
}

/// What bears a stress.
#[derive(Debug, Clone, PartialEq)]
pub enum Strength {
    /// The material of this name, up to its stated yield strength.
    Material(String),
    /// The wall of a thin tube, until it buckles or the tube goes flat: outer diameter and wall, m.
    Wall(f64, f64),
}

/// Elements along the rod; moments are straight between masses.
const ELEMENTS: usize = 60;
/// Fibres round a section, over half of it.
const FIBRES: usize = 12;
/// A wall up to this share of the mean radius is thin.
const THIN: f64 = 0.1;

/// What the rod does not bear under one g and `contact_force` (N), if there is such a thing: where
/// the stress exceeds its limit by the largest factor. Materials without a stated yield strength
/// bear anything; sections that are known by their constants alone have no fibres and are left out.
///
/// ```
/// use rodcal::compliance::{Strength, overload};
/// use rodcal::prelude::*;
///
/// let mut rod = Rod::read("rods/5.toml".as_ref())?;
/// assert!(overload(&rod, 1.97)?.is_none());
/// rod.pipe1.material.yield_strength = Some(1e6); // Pa
/// let found = overload(&rod, 1.97)?.filter(|found| found.station == 0.0);
/// assert!(found.is_some_and(|found| found.kind == Strength::Material("steel".into())));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`RodModel::new`].
pub fn overload(rod: &Rod, contact_force: f64) -> Result<Option<Overload>> {
    let bears_all = |pipe: &&Pipe| pipe.material.yield_strength.is_none() && wall(pipe).is_none();
    let sleeves = rod.sleeves.iter().map(|sleeve| &sleeve.pipe);
    if [&rod.pipe1, &rod.bend, &rod.pipe2].into_iter().chain(sleeves).all(|pipe| bears_all(&pipe)) {
        return Ok(None);
    }
    let RodModel { chain, .. } = &RodModel::new(rod, &Physics::default(), ELEMENTS, &[])?;
    let force = Load::Force { node: chain.end() };
    let moments = |node: usize| -> [Matrix3<f64>; 2] {
        let weight = chain.resultant(Load::SelfWeight, node).moment * STANDARD_GRAVITY;
        [weight, chain.resultant(force, node).moment * contact_force]
    };
    let mut worst: Option<(f64, Overload)> = None;
    for k in 0..chain.end() {
        let ends = [k, k + 1].map(|node| (chain.station(node), chain.position(node)));
        let Some(along) = (ends[1].1 - ends[0].1).try_normalize(1e-9) else { continue };
        let middle = (ends[0].0 + ends[1].0) / 2.0;
        for pipe in rod.bearing_at(middle) {
            let whole = together(rod, middle, pipe);
            let name = || Strength::Material(pipe.material.name.clone());
            let yields = pipe.material.yield_strength.map(|limit| (limit, name()));
            for ((station, _), node) in ends.iter().zip([k, k + 1]) {
                let stress = stress(&pipe.section, &whole, &along, &moments(node));
                for (limit, kind) in [yields.clone(), wall(pipe)].into_iter().flatten() {
                    let share = stress / limit;
                    if share > 1.0 && worst.as_ref().is_none_or(|(known, _)| share > *known) {
                        worst = Some((share, Overload { stress, station: *station, limit, kind }));
                    }
                }
            }
        }
    }
    Ok(worst.map(|(_, overload)| overload))
}

/// I_y, I_z and J of all that bears at a station (m), in the moduli of one of its pipes, m⁴.
fn together(rod: &Rod, station: f64, pipe: &Pipe) -> [f64; 3] {
    let mut whole = [0.0; 3];
    for Pipe { section, material } in rod.bearing_at(station) {
        let e = material.youngs_modulus / pipe.material.youngs_modulus;
        let g = material.shear_modulus / pipe.material.shear_modulus;
        let [iy, iz] = section.second_moments();
        whole = [whole[0] + e * iy, whole[1] + e * iz, whole[2] + g * section.torsion_constant()];
    }
    whole
}

/// The largest stress of a section, Pa, under moments (N·m; column: axis of the load) that act
/// along any axis each, where I_y, I_z and J are those of all that bears there, m⁴.
fn stress(
    section: &Section,
    [iy, iz, torsion_constant]: &[f64; 3],
    along: &Vector3<f64>,
    moments: &[Matrix3<f64>; 2],
) -> f64 {
    let out_of_plane = Vector3::y();
    let in_plane = along.cross(&out_of_plane);
    // largest over all directions of each load: |M_gᵀ v| + |M_Fᵀ v|
    let largest = |v: &Vector3<f64>| moments.iter().map(|moment| moment.tr_mul(v).norm()).sum::<f64>();
    match section {
        Section::Round(round) => {
            let radius = round.outer_diameter / 2.0;
            let fibre = |k: usize| {
                let angle = std::f64::consts::PI * k as f64 / FIBRES as f64;
                largest(&((out_of_plane * angle.cos() + in_plane * angle.sin()) * (radius / iy)))
            };
            let bending = (0..FIBRES).map(fibre).fold(0.0, f64::max);
            let torsion = largest(&(along * (radius / torsion_constant)));
            (bending * bending + 3.0 * torsion * torsion).sqrt()
        }
        // at its corners, by bending alone
        Section::Rectangle(rectangle) => [1.0, -1.0]
            .map(|side| {
                let corner = out_of_plane * (rectangle.height / 2.0 / iy);
                largest(&(corner + in_plane * (side * rectangle.width / 2.0 / iz)))
            })
            .into_iter()
            .fold(0.0, f64::max),
        Section::General(_) => 0.0,
    }
}

/// The stress at which a thin isotropic tube fails by its wall, Pa: the smaller of
///
/// - local buckling in bending, `γ E t / (r √(3(1−ν²)))` with `γ = 1 − 0.731 (1 − exp(−√(r/t)/16))`
///   (NASA SP-8007, *Buckling of thin-walled circular cylinders*, 1968, § 4.1.2)
/// - flattening, `(2√2/9) E t / (r √(1−ν²))` (L. G. Brazier, *Proc. R. Soc. A* 116 (1927) 104–114:
///   its largest moment over π r² t)
fn wall(pipe: &Pipe) -> Option<(f64, Strength)> {
    let (round, material) = (pipe.section.as_round()?, &pipe.material);
    let wall = round.wall();
    let radius = (round.outer_diameter - wall) / 2.0;
    if material.is_anisotropic() || wall > THIN * radius {
        return None;
    }
    let (slender, nu) = (radius / wall, material.poisson_ratio);
    let plate = (1.0 - nu * nu).sqrt();
    let known_down = 1.0 - 0.731 * (1.0 - (-slender.sqrt() / 16.0).exp());
    let local = known_down / (3.0f64.sqrt() * plate);
    let flat = 2.0 * 2.0f64.sqrt() / 9.0 / plate;
    Some((material.youngs_modulus / slender * local.min(flat), Strength::Wall(round.outer_diameter, wall)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use crate::section::{Rectangle, Round};
    use approx::assert_relative_eq;

    fn straight(section: impl Into<Section>) -> Rod {
        let text = include_str!("../../rods/5.toml").replace("gamma_deg = 90.0", "gamma_deg = 180.0");
        let mut rod = Rod::from_toml("rod", &text).unwrap();
        let section = section.into();
        for pipe in [&mut rod.pipe1, &mut rod.bend, &mut rod.pipe2] {
            pipe.section = section;
            pipe.material.density = 0.0;
            pipe.material.yield_strength = Some(1.0);
        }
        rod.tip_mass = 0.0;
        rod.masses.clear();
        rod
    }

    /// σ = F L / W at the root of a cantilever: W = π r³/4 of a round, b h²/6 of a rectangle; the
    /// weight of a tip adds m g L / W.
    #[test]
    fn a_cantilever_is_that_of_the_handbook() {
        let mut rod = straight(Round::solid(0.016));
        let length = rod.length();
        let modulus = std::f64::consts::PI * 0.008f64.powi(3) / 4.0;
        let at_root = |rod: &Rod| overload(rod, 3.0).unwrap().filter(|found| found.station == 0.0).unwrap();
        assert_relative_eq!(at_root(&rod).stress, 3.0 * length / modulus, max_relative = 1e-9);
        rod.tip_mass = 0.2;
        let both = (3.0 + 0.2 * STANDARD_GRAVITY) * length / modulus;
        assert_relative_eq!(at_root(&rod).stress, both, max_relative = 1e-9);
        // along a diagonal: M h/2/I_y and M w/2/I_z of the parts of one moment
        let rod = straight(Rectangle::solid(0.010, 0.020));
        let (along_height, along_width) = (0.010 * 0.020f64.powi(2) / 6.0, 0.020 * 0.010f64.powi(2) / 6.0);
        let corner = 3.0 * length * (1.0 / along_height).hypot(1.0 / along_width);
        assert_relative_eq!(at_root(&rod).stress, corner, max_relative = 1e-9);
    }

    /// At the flange of an L a force along Y bends by L1 and twists by L2; along the others it
    /// bends by as much at most.
    #[test]
    fn an_l_is_bent_and_twisted() {
        let mut rod = Rod::from_toml("rod", include_str!("../../rods/5.toml")).unwrap();
        rod.pipe1.material.yield_strength = Some(1.0);
        for pipe in [&mut rod.pipe1, &mut rod.bend, &mut rod.pipe2] {
            pipe.material.density = 0.0;
        }
        rod.tip_mass = 0.0;
        rod.masses.clear();
        let found = overload(&rod, 2.0).unwrap().unwrap();
        let round = rod.pipe1.section.as_round().unwrap();
        let per_moment = round.outer_diameter / 2.0 / round.second_moment();
        let bending = 2.0 * rod.l1.hypot(rod.l2) * per_moment;
        let torsion = 2.0 * rod.l2 * per_moment / 2.0;
        assert_relative_eq!(found.stress, bending.hypot(3f64.sqrt() * torsion), max_relative = 1e-3);
    }

    /// Rods of the paper are far from it; a foil is not.
    #[test]
    fn a_wall_of_foil_buckles() {
        for text in [include_str!("../../rods/2.toml"), include_str!("../../rods/5.toml")] {
            let rod = Rod::from_toml("rod", text).unwrap();
            assert_eq!(overload(&rod, 20.0).unwrap(), None);
        }
        let mut rod = straight(Round::tube(0.040, 0.03998));
        rod.pipe1.material.yield_strength = None;
        rod.bend = rod.pipe1.clone();
        rod.pipe2 = rod.pipe1.clone();
        assert_eq!(overload(&rod, 0.1).unwrap(), None);
        let found = overload(&rod, 2.0).unwrap().unwrap();
        assert_eq!(found.kind, Strength::Wall(0.040, (0.040 - 0.03998) / 2.0));
        // r/t = 2000: γ = 0.31, so that local buckling comes first
        let nu: f64 = rod.pipe1.material.poisson_ratio;
        let knocked = 1.0 - 0.731 * (1.0 - (-(1999.5f64).sqrt() / 16.0).exp());
        let expected = knocked * 193e9 / 1999.5 / (3.0 * (1.0 - nu * nu)).sqrt();
        assert_relative_eq!(found.limit, expected, max_relative = 1e-6);
    }

    /// What shares a load bears of it by its stiffness: the stress at the outside is that of the
    /// one tube which both are, and a sleeve of half the modulus bears half of that strain.
    #[test]
    fn a_sleeve_bears_its_share() {
        let steel = |strength: f64| {
            let mut steel = Material::isotropic("steel", 193e9, 0.29, 0.0);
            steel.yield_strength = Some(strength);
            steel
        };
        let tube =
            |outer: f64, inner: f64, strength: f64| Pipe::new(Round::tube(outer, inner), steel(strength));
        let straight = |pipe: Pipe| Rod::new("rod", 0.1, 0.4, pipe).with_angle(std::f64::consts::PI);
        let one = straight(tube(0.020, 0.012, 1.0));
        let bears = |rod: &Rod| overload(rod, 2.0).unwrap().unwrap();
        // the pipe inside bears anything
        let sleeve = tube(0.020, 0.016, 1.0);
        let both = straight(tube(0.016, 0.012, 1e12)).with_sleeve("all", 0.0, 0.1, sleeve.clone());
        assert_relative_eq!(bears(&both).stress, bears(&one).stress, max_relative = 1e-9);
        assert_eq!(bears(&both).station, 0.0);
        let mut soft = both;
        soft.sleeves[0].pipe.material.youngs_modulus *= 0.5;
        let second = |outer: f64, inner: f64| Round::tube(outer, inner).second_moment();
        let (inside, outside) = (second(0.016, 0.012), second(0.020, 0.016));
        let expected = bears(&one).stress * 0.5 * (inside + outside) / (inside + 0.5 * outside);
        assert_relative_eq!(bears(&soft).stress, expected, max_relative = 1e-9);
    }
}
