//! What a rod gives way by, as a sum of parts that are exactly linear in what may be wrong with
//! them.
//!
//! A rod is an open chain: the flexibilities of its parts add up. With C the displacement at the
//! read station per force at the load station, in {T},
//!
//! ```text
//! C = C₀ + (P + B·(1/g − 1) + D·(k − k₀))/f − P + Σ β_j·J_j
//! P pipes and bend     f factor on E and G        B torsion and shear of the pipes     g factor on G
//! D bending of the arc k, k₀ its flexibility factor, the file's factor        J_j a joint per rad/(N·m), β_j its change
//! ```
//!
//! P, B and D come from the beam model itself, as differences of models in which one thing was
//! changed. A joint at x turns what is beyond it about its axes a, those across the tangent t or t
//! itself: with the force at p and the reading at q
//!
//! ```text
//! J = Σ (a × (q − x))·(a × (p − x))ᵀ = [q − x]×·A·[p − x]×ᵀ     A = 1 − t·tᵀ of bending, t·tᵀ of torsion
//! ```

use nalgebra::{Matrix3, Vector3};

use crate::beam::{Physics, RodModel};
use crate::error::{Error, Result};
use crate::rig::readings::Readings;
use crate::rod::{BendFlexibility, Pipe, Rod};
use crate::spatial::skew;
use crate::units::{MM, UM};

/// m/N for each pair of load and read station.
pub(super) type Parts = Vec<Matrix3<f64>>;

/// The parts of a rod.
#[derive(Debug, Clone)]
pub(super) struct Structure {
    whole: Parts,
    pipes: Parts,
    torsion_and_shear: Parts,
    /// Per unit of the bend's flexibility factor; nothing without an arc.
    arc: Option<Parts>,
    /// The rod file's flexibility factor of the bend.
    pub bend_factor: f64,
    /// In the order in which they were added.
    joints: Vec<Hinge>,
    pairs: Vec<(f64, f64)>,
    rod: Rod,
}

/// How a joint gives way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Deformation {
    /// About the axes across the rod.
    Bending,
    /// About the rod's own axis.
    Torsion,
}

/// A joint that gives way in one of these ways.
#[derive(Debug, Clone)]
struct Hinge {
    deformation: Deformation,
    /// Per rad/(N·m).
    parts: Parts,
}

/// What is wrong with a structure.
#[derive(Debug, Clone)]
pub(super) struct Softening {
    /// Factor on the moduli E and G.
    pub stiffness: f64,
    /// Factor on G alone.
    pub shear: f64,
    /// Change of the bend's flexibility factor.
    pub bend: f64,
    /// Joints by number, with the change of their compliance, rad/(N·m).
    pub joints: Vec<(usize, f64)>,
}

impl Default for Softening {
    fn default() -> Self {
        Softening { stiffness: 1.0, shear: 1.0, bend: 0.0, joints: Vec::new() }
    }
}

/// A joint that may sit anywhere about its station.
///
/// On a straight piece of the rod the displacement per compliance of a joint is a polynomial of
/// second degree in its station, for the lever arms of the load and of the reading are of first
/// degree: the polynomial through three stations is exact. On an arc of a few degrees it is so to
/// 1e-4.
#[derive(Debug, Clone)]
pub(super) struct Nodes {
    /// Stations before, at and behind, m: the first and the last are as far as it may be.
    pub stations: [f64; 3],
    /// The joints there: bending, torsion.
    pub joints: [[usize; 2]; 3],
}

impl Nodes {
    /// Of the polynomial through the nodes, at `station`.
    fn weights(&self, station: f64) -> [f64; 3] {
        let [before, at, behind] = self.stations;
        // Lagrange's polynomials
        let lagrange = |own: f64, a: f64, b: f64| (station - a) * (station - b) / ((own - a) * (own - b));
        [lagrange(before, at, behind), lagrange(at, before, behind), lagrange(behind, before, at)]
    }

    /// Moves what `softening` has of the joint in the middle to `station`.
    pub(super) fn move_joint(&self, softening: &mut Softening, station: f64) {
        let weights = self.weights(station);
        let moved: Vec<(usize, f64)> = softening
            .joints
            .iter()
            .flat_map(|&(joint, change)| match self.joints[1].iter().position(|&own| own == joint) {
                Some(kind) => (0..3).map(|node| (self.joints[node][kind], change * weights[node])).collect(),
                None => vec![(joint, change)],
            })
            .collect();
        softening.joints = moved;
    }
}

impl Structure {
    /// The parts of `rod` between pairs of load and read stations, m.
    pub(super) fn new(rod: &Rod, pairs: Vec<(f64, f64)>) -> Result<Structure> {
        let without_joints = Rod { joints: Vec::new(), ..rod.clone() };
        let bend_factor = rod.bend_flexibility.factor(&rod.bend.section, rod.bend_radius);
        let pipes = responses(&without_joints, &pairs)?;
        // G twice as high halves what G is responsible for
        let stiffer = responses(&with_moduli(&without_joints, 1.0, 2.0), &pairs)?;
        let arc = match rod.arc_length() > 0.0 {
            true => {
                let flexible = BendFlexibility::Factor(bend_factor + 1.0);
                let softer = Rod { bend_flexibility: flexible, ..without_joints.clone() };
                Some(difference(&responses(&softer, &pairs)?, &pipes, 1.0))
            }
            false => None,
        };
        Ok(Structure {
            whole: responses(rod, &pairs)?,
            torsion_and_shear: difference(&pipes, &stiffer, 2.0),
            pipes,
            // of an arc so short that the beam model makes it a corner nothing is left
            arc: arc.filter(|parts| parts.iter().any(|part| part.amax() > 0.0)),
            bend_factor,
            joints: Vec::new(),
            pairs,
            rod: without_joints,
        })
    }

    /// Adds a joint of no compliance yet at a station (m); its numbers for bending and for torsion.
    pub(super) fn add_joint(&mut self, station: f64) -> [usize; 2] {
        let first = self.joints.len();
        let (at, tangent) = (self.rod.point(station), tangent(&self.rod, station));
        let along = tangent * tangent.transpose();
        let bending = (Deformation::Bending, Matrix3::identity() - along);
        for (deformation, axes) in [bending, (Deformation::Torsion, along)] {
            let of_pair = |&(load, read): &(f64, f64)| match station <= load.min(read) {
                true => {
                    let lever = |station| skew(&(self.rod.point(station) - at));
                    lever(read) * axes * lever(load).transpose()
                }
                false => Matrix3::zeros(),
            };
            let parts = self.pairs.iter().map(of_pair).collect();
            self.joints.push(Hinge { deformation, parts });
        }
        [first, first + 1]
    }

    /// Adds joints by which the one at `station`, added as `joint`, may be moved within `range`
    /// (m), no farther than where the rod bends or a load or a sensor stands; `None` where it
    /// stands at such a place.
    pub(super) fn add_nodes(&mut self, station: f64, joint: [usize; 2], range: (f64, f64)) -> Option<Nodes> {
        const LEAST: f64 = 0.01 * MM;
        let ends = [0.0, self.rod.bend_start(), self.rod.bend_end(), self.rod.length()];
        let kinks = self.pairs.iter().flat_map(|&(load, read)| [load, read]).chain(ends);
        let (before, behind) = kinks.fold(range, |(before, behind), kink| match kink <= station {
            true => (before.max(kink), behind),
            false => (before, behind.min(kink)),
        });
        if (station - before).min(behind - station) < LEAST {
            return None;
        }
        let joints = [self.add_joint(before), joint, self.add_joint(behind)];
        Some(Nodes { stations: [before, station, behind], joints })
    }

    /// What pipes add, m/N, whose flexibility in bending and torsion is larger by a share that
    /// differs from station to station:
    ///
    /// ```text
    /// Σ ∫ share(s)·[q − x]×·A(s)·[p − x]×ᵀ ds     A = (1 − t·tᵀ)/EI + t·tᵀ/GJ
    /// ```
    pub(super) fn varying(&self, share: &dyn Fn(f64) -> f64) -> Parts {
        /// Steps of the midpoint rule along a rod: what varies slowly is known to 0.1 %.
        const STEPS: usize = 96;
        let rod = &self.rod;
        let step = rod.length() / STEPS as f64;
        let mut parts = vec![Matrix3::zeros(); self.pairs.len()];
        for k in 0..STEPS {
            let station = (k as f64 + 0.5) * step;
            let pipe = match station {
                s if s < rod.bend_start() => &rod.pipe1,
                s if s < rod.bend_end() => &rod.bend,
                _ => &rod.pipe2,
            };
            let (at, tangent) = (rod.point(station), tangent(rod, station));
            let along = tangent * tangent.transpose();
            let bending = pipe.material.youngs_modulus * pipe.section.second_moment();
            let torsion = pipe.material.shear_modulus * pipe.section.torsion_constant();
            let yields =
                ((Matrix3::identity() - along) / bending + along / torsion) * (share(station) * step);
            for (part, &(load, read)) in parts.iter_mut().zip(&self.pairs) {
                if station <= load.min(read) {
                    let lever = |station| skew(&(rod.point(station) - at));
                    *part += lever(read) * yields * lever(load).transpose();
                }
            }
        }
        parts
    }

    /// The parts as `softening` leaves them; unchanged ones to the last digit where it changes
    /// nothing.
    pub(super) fn softened(&self, softening: &Softening) -> Parts {
        let of_pair = |pair: usize| {
            let mut pipes = self.pipes[pair];
            pipes += self.torsion_and_shear[pair] * (1.0 / softening.shear - 1.0);
            if let Some(arc) = &self.arc {
                pipes += arc[pair] * softening.bend;
            }
            let mut whole = self.whole[pair] + (pipes / softening.stiffness - self.pipes[pair]);
            for &(joint, change) in &softening.joints {
                whole += self.joints[joint].parts[pair] * change;
            }
            whole
        };
        (0..self.whole.len()).map(of_pair).collect()
    }

    /// How the joint of this number gives way.
    pub(super) fn deformation(&self, joint: usize) -> Deformation {
        self.joints[joint].deformation
    }

    /// What large deflections of `rod`, this one or one that yields more, add to the displacement
    /// per square of the load along each axis, m/N² (columns: axes), for each pair of stations: to
    /// the second order, which is even in the load.
    pub(super) fn second_order(&self, rod: &Rod) -> Result<Parts> {
        /// Enough for three digits.
        const ELEMENTS: usize = 48;
        let stations: Vec<f64> = self.pairs.iter().flat_map(|&(load, read)| [load, read]).collect();
        let model = RodModel::new(rod, &Physics::WHOLE, ELEMENTS, &stations)?;
        let mut known: Vec<(f64, [Vec<nalgebra::Vector3<f64>>; 3])> = Vec::new();
        let mut parts = Vec::new();
        for &(load, read) in &self.pairs {
            if !known.iter().any(|(station, _)| *station == load) {
                let along = |axis: usize| model.second_order(model.node_at(load), axis, 1.0);
                known.push((load, [along(0)?, along(1)?, along(2)?]));
            }
            let node = model.node_at(read);
            let columns = known.iter().find(|(station, _)| *station == load).map(|(_, of)| of);
            parts.push(columns.map_or_else(Matrix3::zeros, |of| {
                Matrix3::from_columns(&[of[0][node], of[1][node], of[2][node]])
            }));
        }
        Ok(parts)
    }

    /// True where there is an arc that can ovalise.
    pub(super) fn has_arc(&self) -> bool {
        self.arc.is_some()
    }

    /// How far the whole rod bends and twists at the tip per moment there, ∫ds/EI and ∫ds/GJ,
    /// rad/(N·m).
    pub(super) fn rotation(&self) -> [f64; 2] {
        let rod = &self.rod;
        let (start, end, length) = (rod.bend_start(), rod.bend_end(), rod.length());
        let parts = [(&rod.pipe1, start), (&rod.bend, end - start), (&rod.pipe2, length - end)];
        let bending = |pipe: &Pipe| pipe.material.youngs_modulus * pipe.section.second_moment();
        let torsion = |pipe: &Pipe| pipe.material.shear_modulus * pipe.section.torsion_constant();
        [
            parts.iter().map(|(pipe, length)| length / bending(pipe)).sum(),
            parts.iter().map(|(pipe, length)| length / torsion(pipe)).sum(),
        ]
    }

    /// The rod, without its joints.
    pub(super) fn rod(&self) -> &Rod {
        &self.rod
    }
}

/// Refuses stations that are not on the rod. The tip may be named with its last digit rounded.
pub(super) fn check_stations(readings: &Readings, rod: &Rod) -> Result<()> {
    let tip = rod.length();
    for row in &readings.rows {
        let stations = [("load_station_mm", row.load_station), ("read_station_mm", row.read_station)];
        for (name, station) in stations {
            let Some(station) = station.filter(|s| *s > tip + UM) else { continue };
            return Err(Error::Input {
                at: crate::error::Place { file: readings.file.clone(), line: row.line, column: 0 },
                found: format!("{name} is {}", station / MM),
                expected: format!("a station on rod \"{}\", 0 to {:.3} mm (the tip)", rod.name, tip / MM),
                hint: None,
            });
        }
    }
    Ok(())
}

/// Displacement at the read station per force at the load station, m/N.
pub(super) fn responses(rod: &Rod, pairs: &[(f64, f64)]) -> Result<Parts> {
    let stations: Vec<f64> = pairs.iter().flat_map(|&(load, read)| [load, read]).collect();
    let model = RodModel::new(rod, &Physics::WHOLE, 1, &stations)?;
    pairs.iter().map(|&(load, read)| Ok(model.force_response(load, read)?.translation)).collect()
}

/// Direction of the undeformed centreline at a station, in {T}: that before a corner.
fn tangent(rod: &Rod, station: f64) -> Vector3<f64> {
    if station <= rod.bend_start() {
        return Vector3::z();
    }
    let turn = rod.turn().min((station - rod.bend_start()) / rod.bend_radius.max(f64::MIN_POSITIVE));
    Vector3::new(turn.sin(), 0.0, turn.cos())
}

fn difference(a: &[Matrix3<f64>], b: &[Matrix3<f64>], factor: f64) -> Parts {
    a.iter().zip(b).map(|(a, b)| (a - b) * factor).collect()
}

/// A rod with other moduli: factors on E and G of all pipes.
pub(super) fn with_moduli(rod: &Rod, e: f64, g: f64) -> Rod {
    let mut rod = rod.clone();
    for pipe in [&mut rod.pipe1, &mut rod.bend, &mut rod.pipe2] {
        pipe.material.youngs_modulus *= e;
        pipe.material.shear_modulus *= g;
    }
    rod
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::Joint;
    use approx::assert_relative_eq;

    fn rod(bend: &str) -> Rod {
        let joint = "[[joint]]\nname = \"sleeve\"\nstation_mm = 205.0\nbending_urad_per_nm = 20\n";
        let text = include_str!("../../../rods/5.toml").replace("bend_radius_mm = 0.0 ", bend) + joint;
        Rod::from_toml("rod", &text).unwrap()
    }

    fn pairs(rod: &Rod) -> Vec<(f64, f64)> {
        vec![(rod.length(), rod.length()), (0.3, rod.length()), (0.4, 0.1)]
    }

    fn assert_same(a: &Parts, b: &Parts) {
        for (a, b) in a.iter().zip(b) {
            assert_relative_eq!(*a, *b, epsilon = 1e-11 * a.amax());
        }
    }

    #[test]
    fn nothing_wrong_is_the_rod_itself_to_the_last_digit() {
        let rod = rod("bend_radius_mm = 40\nbend_flexibility = 1.3");
        let structure = Structure::new(&rod, pairs(&rod)).unwrap();
        assert_eq!(structure.softened(&Softening::default()), responses(&rod, &pairs(&rod)).unwrap());
    }

    #[test]
    fn everything_wrong_at_once_is_the_beam_model_of_that_rod() {
        let rod = rod("bend_radius_mm = 40\nbend_flexibility = 1.3");
        let mut structure = Structure::new(&rod, pairs(&rod)).unwrap();
        let mut wrong = with_moduli(&rod, 0.7, 0.7 * 1.2);
        wrong.bend_flexibility = BendFlexibility::Factor(2.1);
        // on pipe I, within the bend and at its end
        let middle = (rod.bend_start() + rod.bend_end()) / 2.0;
        let mut joints = Vec::new();
        for station in [0.06, middle, rod.bend_end()] {
            let [bending, torsion] = structure.add_joint(station);
            joints.extend([(bending, 3e-5), (torsion, 5e-5)]);
            wrong.joints.push(Joint { name: "new".into(), station, bending: 3e-5, torsion: 5e-5 });
        }
        wrong.joints[0].bending = 5e-5;
        let [declared, _] = structure.add_joint(0.205);
        joints.push((declared, 3e-5));
        let softening = Softening { stiffness: 0.7, shear: 1.2, bend: 2.1 - 1.3, joints };
        assert_same(&structure.softened(&softening), &responses(&wrong, &pairs(&rod)).unwrap());
    }

    #[test]
    fn pipes_that_are_softer_everywhere_are_a_softer_rod_and_a_soft_end_is_not_seen_before_it() {
        let rod = Rod { joints: Vec::new(), ..rod("bend_radius_mm = 0.0 ") };
        let structure = Structure::new(&rod, pairs(&rod)).unwrap();
        let softer = structure.softened(&Softening { stiffness: 1.0 / 1.1, ..Softening::default() });
        // but for shear and extension, which matter near the root
        for (k, more) in structure.varying(&|_| 0.1).into_iter().take(2).enumerate() {
            let expected = softer[k] - structure.whole[k];
            assert!((more - expected).amax() < 0.02 * expected.amax(), "{more} {expected}");
        }
        let soft_end = structure.varying(&|station| if station > 0.35 { 0.1 } else { 0.0 });
        assert!(soft_end[0].amax() > 0.0 && soft_end[1].amax() == 0.0 && soft_end[2].amax() == 0.0);
    }

    #[test]
    fn a_corner_has_no_arc_and_the_rotation_is_that_of_a_moment() {
        let rod = rod("bend_radius_mm = 0.0 ");
        let structure = Structure::new(&rod, pairs(&rod)).unwrap();
        assert!(!structure.has_arc());
        let section = rod.pipe1.section.second_moment();
        assert_relative_eq!(structure.rotation()[0], 0.675 / (193e9 * section), max_relative = 1e-12);
    }
}
