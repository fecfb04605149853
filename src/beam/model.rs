//! A rod as a chain: nodes wherever something sits, acts or is read.

use nalgebra::{Rotation3, Vector3};

use super::chain::Chain;
use super::element::Profile;
use super::response::{Load, Motion};
use crate::dual::{Number, about_y};
use crate::error::{Error, Result};
use crate::rod::{BendFlexibility, Pipe, Rod};
use crate::units::MM;

/// Which physics the model contains; [`Physics::default`] is all of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Physics {
    /// Extension of the pipes, 1/EA.
    pub axial: bool,
    /// Shear of the pipes, 1/κGA: Timoshenko's theory with it, Euler–Bernoulli's without.
    pub shear: bool,
    /// The bend as an arc of its radius; without it the pipes meet in a sharp corner.
    pub bend: bool,
    /// The bend's flexibility factor (ovalisation), where the rod file has one.
    pub bend_flexibility: bool,
    /// Rotational compliance of the joints.
    pub joints: bool,
    /// Stiffness and weight of the sleeves that bear with a pipe.
    pub sleeves: bool,
    /// Weight of rings and holders along the rod.
    pub masses: bool,
    /// Weight of ball and ball holder at the tip.
    pub tip_mass: bool,
}

impl Physics {
    /// All of it.
    pub const WHOLE: Physics = Physics {
        axial: true,
        shear: true,
        bend: true,
        bend_flexibility: true,
        joints: true,
        sleeves: true,
        masses: true,
        tip_mass: true,
    };

    /// Bending and torsion only: what the paper's closed form contains.
    pub const BENDING_AND_TORSION: Physics = Physics {
        axial: false,
        shear: false,
        bend: false,
        bend_flexibility: false,
        joints: false,
        sleeves: false,
        masses: false,
        tip_mass: false,
    };

    /// With the shear of the pipes, as Timoshenko, or without it, as Euler and Bernoulli.
    ///
    /// ```
    /// use rodcal::beam::Physics;
    ///
    /// let euler_bernoulli = Physics::WHOLE.with_shear(false);
    /// assert!(!euler_bernoulli.shear && euler_bernoulli.joints);
    /// ```
    pub const fn with_shear(mut self, shear: bool) -> Physics {
        self.shear = shear;
        self
    }

    /// With the extension of the pipes or without it.
    pub const fn with_axial(mut self, axial: bool) -> Physics {
        self.axial = axial;
        self
    }

    /// With the stiffness and the weight of the sleeves or without them.
    pub const fn with_sleeves(mut self, sleeves: bool) -> Physics {
        self.sleeves = sleeves;
        self
    }
}

impl Default for Physics {
    fn default() -> Self {
        Physics::WHOLE
    }
}

/// A rod's chain in {T}, clamped at the flange.
///
/// ```
/// use rodcal::beam::{Physics, RodModel};
/// use rodcal::prelude::*;
///
/// let steel = Material::isotropic("steel", 193e9, 0.29, 7930.0);
/// let rod = Rod::new("5#", 0.150, 0.525, Pipe::new(Round::tube(0.032, 0.030), steel));
/// let ei = 193e9 * rod.pipe1.section.second_moment();
/// // on pipe I, 100 mm from the flange, the rod is a cantilever: a³/3EI, the corner beyond it no matter
/// let model = RodModel::new(&rod, &Physics::BENDING_AND_TORSION, 7, &[0.1])?;
/// let motion = model.force_response(0.1, 0.1)?;
/// assert!((motion.translation[(1, 1)] / (0.001 / (3.0 * ei)) - 1.0).abs() < 1e-12);
/// # Ok::<(), rodcal::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct RodModel<T = f64> {
    /// Nodes and elements.
    pub chain: Chain<T>,
    rod: Rod<T>,
}

impl<T: Number> RodModel<T> {
    /// Meshes `rod` with `elements` elements (at least one for each part between two stations of
    /// interest). The tip, the masses, the joints, the ends of sleeves and the given `stations` (m)
    /// get a node.
    ///
    /// The elements are shared out by length. Their number does not change the result: each element
    /// is exact.
    ///
    /// # Errors
    /// [`Error::Argument`] for no elements, or a station that is not on the rod;
    /// [`Error::Numerical`] for a rod whose pipes are too unequal in length, or too short, for
    /// double precision.
    pub fn new(rod: &Rod<T>, physics: &Physics, elements: usize, stations: &[T]) -> Result<Self> {
        if elements == 0 {
            return Err(Error::Argument {
                name: "elements",
                found: "0".into(),
                expected: "at least 1".into(),
            });
        }
        let rod = physics.applied_to(rod);
        check_resolution(&rod)?;
        let cuts = cuts(&rod, stations)?;
        let places: Vec<f64> = cuts.iter().map(|cut| cut.value()).collect();
        let counts = share_out(elements, &places);
        let mut chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
        chain.reserve(counts.iter().sum::<usize>() + rod.joints.len());

        let bend_factor = rod.bend_flexibility.factor(&rod.bend.section, rod.bend_radius);
        let bend = physics.profile(&rod.bend, bend_factor);
        let bend_length = rod.bend_end() - rod.bend_start();
        let mut corner_ahead = rod.bend_radius.value() == 0.0;
        place_features(&mut chain, &rod, cuts[0]);
        for (ends, count) in cuts.windows(2).zip(counts) {
            let (length, middle) = (ends[1] - ends[0], (ends[0] + ends[1]) / 2.0);
            if middle.value() < rod.bend_start().value() {
                chain.straight(&physics.profile_at(&rod, middle), length, count);
            } else if middle.value() < rod.bend_end().value() {
                // its share of the turn: the rounding of two stations over a tiny radius would turn
                // all beyond it
                chain.arc(&bend, rod.bend_radius, rod.turn() * (length / bend_length), count);
            } else {
                if std::mem::take(&mut corner_ahead) {
                    chain.turn(&about_y(rod.turn()));
                }
                chain.straight(&physics.profile_at(&rod, middle), length, count);
            }
            place_features(&mut chain, &rod, ends[1]);
        }
        chain.mass(rod.tip_mass);
        Ok(RodModel { chain, rod })
    }

    /// The rod that is modelled: without what the physics leaves out.
    pub fn rod(&self) -> &Rod<T> {
        &self.rod
    }

    /// Node at the tip.
    pub fn tip(&self) -> usize {
        self.chain.end()
    }
}

impl RodModel {
    /// The node at a `station` (m) that was given to [`RodModel::new`]: the outermost one there,
    /// beyond any joint.
    pub fn node_at(&self, station: f64) -> usize {
        let distance = |node: usize| (self.chain.station(node) - station).abs();
        (0..=self.chain.end()).fold(0, |best, node| match distance(node) <= distance(best) + SAME_STATION {
            true => node,
            false => best,
        })
    }

    /// Displacement (m) and rotation (rad) at one station per unit force (N) at another, both in
    /// {T}.
    ///
    /// # Errors
    /// As [`Chain::solve`].
    pub fn force_response(&self, load_station: f64, read_station: f64) -> Result<Motion> {
        let load = Load::Force { node: self.node_at(load_station) };
        let response = self.chain.solve(&[load])?;
        Ok(*response.motion(self.node_at(read_station), 0))
    }
}

/// An arc shorter than this is a sharp corner, m: its angle would be lost in the rounding of
/// stations.
const SHARPEST_BEND: f64 = 1e-6;

/// Stations closer than this are one node, m.
pub(super) const SAME_STATION: f64 = 1e-9;

impl Physics {
    /// The rod without what is left out. Stations beyond a bend shift by what the corner is longer.
    fn applied_to<T: Number>(&self, rod: &Rod<T>) -> Rod<T> {
        let mut rod = rod.clone();
        if !self.bend || rod.arc_length().value() < SHARPEST_BEND {
            let (start, end, tangent) = (rod.bend_start(), rod.bend_end(), rod.tangent_length());
            let shift = |station: &mut T| {
                if station.value() >= end.value() {
                    *station += tangent * 2.0 - (end - start);
                } else if station.value() > start.value() {
                    // within the bend: keep the proportion of the way round
                    *station = start + (*station - start) * 2.0 * tangent / (end - start);
                }
            };
            rod.stations_mut().for_each(shift);
            rod.bend_radius = T::zero();
        }
        if !self.bend_flexibility {
            rod.bend_flexibility = BendFlexibility::Beam;
        }
        if !self.joints {
            rod.joints.clear();
        }
        if !self.sleeves {
            rod.sleeves.clear();
        }
        if !self.masses {
            rod.masses.clear();
        }
        if !self.tip_mass {
            rod.tip_mass = T::zero();
        }
        rod
    }

    /// Flexibilities at a station (m) of a straight pipe under this physics, with its sleeves.
    pub(super) fn profile_at<T: Number>(&self, rod: &Rod<T>, station: T) -> Profile<T> {
        let mut bearing = rod.bearing_at(station).map(|pipe| self.profile(pipe, T::one()));
        let pipe = bearing.next().unwrap_or_else(|| self.profile(&rod.pipe2, T::one()));
        bearing.fold(pipe, |whole, sleeve| whole.beside(&sleeve))
    }

    /// Flexibilities of a pipe under this physics, its bending flexibility times `bend_factor`.
    pub(super) fn profile<T: Number>(&self, pipe: &Pipe<T>, bend_factor: T) -> Profile<T> {
        let (section, material) = (&pipe.section, &pipe.material);
        let (e, g, area) = (material.youngs_modulus, material.shear_modulus, section.area());
        // local axes: x in the rod's plane, y = Y of {T} normal to it; a force in the plane shears
        // along x and bends about y
        let [iy, iz] = section.second_moments();
        let shear = match self.shear {
            true => pipe.shear_coefficients().map(|kappa| T::one() / (kappa * g * area)),
            false => [T::zero(); 2],
        };
        Profile {
            axial: if self.axial { T::one() / (e * area) } else { T::zero() },
            shear,
            bending: [iz, iy].map(|about| bend_factor / (e * about)),
            torsion: T::one() / (g * section.torsion_constant()),
            mass_per_length: pipe.mass_per_length(),
            rotary_inertia: [iz, iy].map(|about| material.density * about),
        }
    }
}

/// Refuses a rod one of whose pipes would be lost in rounding: stations of 1e27 m cannot tell the
/// ends of one of 0.5 m apart.
fn check_resolution<T: Number>(rod: &Rod<T>) -> Result<()> {
    let (length, tangent) = (rod.length(), rod.tangent_length());
    let pipes = [(rod.l1 - tangent, rod.bend_start()), (rod.l2 - tangent, length - rod.bend_end())];
    let (l1, l2) = (rod.l1.value(), rod.l2.value());
    let is_lost =
        |(pipe, between_stations): (T, T)| (pipe - between_stations).value().abs() > 1e-6 * l1.min(l2);
    if pipes.into_iter().any(is_lost) || length.value() < 1e3 * SAME_STATION {
        return Err(Error::Numerical {
            what: "the beam model",
            why: format!(
                "pipes of {:.3e} and {:.3e} mm are beyond double precision; is a length in another unit?",
                l1 / MM,
                l2 / MM
            ),
        });
    }
    Ok(())
}

/// Where the centreline is cut into parts: its ends, the bend's, and wherever something sits or is
/// read.
fn cuts<T: Number>(rod: &Rod<T>, stations: &[T]) -> Result<Vec<T>> {
    let length = rod.length();
    let mut cuts = vec![T::zero(), rod.bend_start(), rod.bend_end(), length];
    cuts.extend(rod.masses.iter().map(|mass| mass.station));
    cuts.extend(rod.joints.iter().map(|joint| joint.station));
    cuts.extend(rod.sleeves.iter().flat_map(|sleeve| [sleeve.from, sleeve.to]));
    for &station in stations {
        let (at, end) = (station.value(), length.value());
        if !(at >= 0.0 && at <= end + SAME_STATION) {
            return Err(Error::Argument {
                name: "station",
                found: format!("{:.3} mm", at / MM),
                expected: format!("a station on the rod, 0 to {:.3} mm (the tip)", end / MM),
            });
        }
        cuts.push(station);
    }
    cuts.sort_by(|a, b| a.value().total_cmp(&b.value()));
    cuts.dedup_by(|later, earlier| (*later - *earlier).value() <= SAME_STATION);
    Ok(cuts)
}

/// Puts on the chain's end whatever the rod has at this station.
pub(super) fn place_features<T: Number>(chain: &mut Chain<T>, rod: &Rod<T>, station: T) {
    let is_here = |at: T| (at - station).value().abs() <= SAME_STATION;
    for mass in rod.masses.iter().filter(|mass| is_here(mass.station)) {
        chain.mass(mass.mass);
    }
    for joint in rod.joints.iter().filter(|joint| is_here(joint.station)) {
        chain.spring(joint.bending, joint.torsion);
    }
}

/// Shares `total` elements out among the parts between `cuts` by length: at least one each, and
/// exactly `total` in all where there are that many parts or fewer (largest remainders).
fn share_out(total: usize, cuts: &[f64]) -> Vec<usize> {
    let parts = cuts.len() - 1;
    let spare = total.saturating_sub(parts) as f64;
    let scale = spare / (cuts[parts] - cuts[0]);
    let ideal: Vec<f64> = cuts.windows(2).map(|ends| (ends[1] - ends[0]) * scale).collect();
    let mut counts: Vec<usize> = ideal.iter().map(|share| 1 + *share as usize).collect();
    let mut by_remainder: Vec<usize> = (0..parts).collect();
    by_remainder.sort_by(|&a, &b| ideal[b].fract().total_cmp(&ideal[a].fract()));
    let missing = total.saturating_sub(counts.iter().sum());
    for &part in by_remainder.iter().take(missing) {
        counts[part] += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tiny_bend_turns_by_the_whole_angle() {
        let text =
            include_str!("../../rods/5.toml").replace("bend_radius_mm = 0.0 ", "bend_radius_mm = 0.0001 ");
        let rod = Rod::from_toml("tiny bend", &text).unwrap();
        assert!(rod.bend_radius > 0.0);
        let model = RodModel::new(&rod, &Physics::default(), 3, &[]).unwrap();
        assert!((model.chain.position(model.tip()) - rod.tip()).norm() < 1e-15);
    }

    #[test]
    fn elements_are_shared_out_by_length_and_none_is_lost() {
        assert_eq!(share_out(10, &[0.0, 1.0, 4.0]), [3, 7]);
        assert_eq!(share_out(1, &[0.0, 1.0, 4.0]), [1, 1]);
        for total in 3..200 {
            assert_eq!(share_out(total, &[0.0, 0.1, 0.7, 1.9]).iter().sum::<usize>(), total);
        }
    }
}
