//! The compliance of a rod as a sum of parts that are exactly linear in what may be wrong with
//! them.
//!
//! A rod is an open chain: the flexibilities of its parts add up. With C the displacement at the
//! read station per force at the load station, in {T},
//!
//! ```text
//! C = C₀ + (P + B·(1/g − 1) + Σ P_i·(1/f_i − 1) + D·(k − k₀))/f − P + Σ β_j·J_j
//! P pipes and bend     f factor on E and G        B torsion and shear of the pipes     g factor on G
//! P_i pipe 1, pipe 2   f_i factor on its E and G, where G is as stated (g = 1)
//! D bending of the arc k, k₀ its flexibility factor, the file's factor        J_j a joint per rad/(N·m), β_j its change
//! ```
//!
//! (Where sleeves share shear with a pipe, κ of each follows its own E/G: g is off by 1e-8 there.)
//!
//! P, B and D come from the beam model itself, as differences of models in which one thing was
//! changed. A joint at x turns what is beyond it about its axes a, those across the tangent t or t
//! itself: with the force at p and the reading at q
//!
//! ```text
//! J = Σ (a × (q − x))·(a × (p − x))ᵀ = [q − x]×·A·[p − x]×ᵀ     A = 1 − t·tᵀ of bending, t·tᵀ of torsion
//! ```

mod point;
mod softening;
#[cfg(test)]
mod tests;
mod variation;

use nalgebra::{Matrix3, Vector3};

pub use self::point::{Parts, Point, between, tangent};
pub use self::softening::{Nodes, Softening, Variant};
pub use self::variation::{End, Varied};
use self::variation::{Variation, displaced, moved};
use crate::beam::{Physics, RodModel};
use crate::error::{Error, Result};
use crate::rig::readings::Readings;
use crate::rod::{BendFlexibility, Joint, Pipe, Rod};
use crate::spatial::skew;
use crate::units::{MM, UM};

/// The parts of a rod.
#[derive(Debug, Clone)]
pub struct Structure {
    whole: Parts,
    pipes: Parts,
    torsion_and_shear: Parts,
    /// Of pipe 1, and of pipe 2, with their sleeves.
    of_pipes: [Parts; 2],
    /// Per unit of the bend's flexibility factor; nothing without an arc.
    arc: Option<Parts>,
    /// The rod file's flexibility factor of the bend.
    pub bend_factor: f64,
    /// In the order in which they were added.
    joints: Vec<Hinge>,
    /// Load and reading.
    pairs: Vec<[Point; 2]>,
    /// What else it would be with other lengths, or other points of loads and sensors.
    variations: Vec<Variation<Structure>>,
    /// Without its joints.
    rod: Rod,
    joints_of_file: Vec<Joint>,
}

/// How a joint gives way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deformation {
    /// About the axes across the rod.
    Bending,
    /// About the rod's own axis.
    Torsion,
}

/// A joint that gives way in one of these ways.
#[derive(Debug, Clone)]
struct Hinge {
    deformation: Deformation,
    /// m from the flange.
    station: f64,
    /// Per rad/(N·m).
    parts: Parts,
}

impl Structure {
    /// The parts of `rod` between pairs of load and read stations, m.
    pub fn new(rod: &Rod, pairs: Vec<(f64, f64)>) -> Result<Structure> {
        let on_rod = |(load, read)| [load, read].map(|station| Point { station, arm: Vector3::zeros() });
        Structure::between(rod, pairs.into_iter().map(on_rod).collect())
    }

    /// The parts of `rod` between pairs of points, of a load and of a reading.
    fn between(rod: &Rod, pairs: Vec<[Point; 2]>) -> Result<Structure> {
        let without_joints = Rod { joints: Vec::new(), ..rod.clone() };
        let bend_factor = rod.bend_flexibility.factor(&rod.bend.section, rod.bend_radius);
        let pipes = between(&without_joints, &pairs)?;
        // G twice as high halves what G is responsible for
        let stiffer = between(&with_moduli(&without_joints, 1.0, 2.0), &pairs)?;
        // moduli twice as high halve what a pipe is responsible for
        let [first, second] =
            WhichPipe::BOTH.map(|pipe| between(&with_stiffer(&without_joints, pipe, 2.0), &pairs));
        let of_pipes = [first?, second?].map(|stiffer| difference(&pipes, &stiffer, 2.0));
        let arc = match rod.arc_length() > 0.0 {
            true => {
                let flexible = BendFlexibility::Factor(bend_factor + 1.0);
                let softer = Rod { bend_flexibility: flexible, ..without_joints.clone() };
                Some(difference(&between(&softer, &pairs)?, &pipes, 1.0))
            }
            false => None,
        };
        Ok(Structure {
            whole: between(rod, &pairs)?,
            torsion_and_shear: difference(&pipes, &stiffer, 2.0),
            of_pipes,
            pipes,
            // of an arc so short that the beam model makes it a corner nothing is left
            arc: arc.filter(|parts| parts.iter().any(|part| part.amax() > 0.0)),
            bend_factor,
            joints: Vec::new(),
            pairs,
            variations: Vec::new(),
            rod: without_joints,
            joints_of_file: rod.joints.clone(),
        })
    }

    /// Adds a joint of no compliance yet at a station (m); its numbers for bending and for torsion.
    pub fn add_joint(&mut self, station: f64) -> [usize; 2] {
        let first = self.joints.len();
        for deformation in [Deformation::Bending, Deformation::Torsion] {
            let parts = self.hinge(station, deformation);
            self.joints.push(Hinge { deformation, station, parts });
        }
        [first, first + 1]
    }

    /// What a joint at a station that gives way so adds per rad/(N·m), J.
    fn hinge(&self, station: f64, deformation: Deformation) -> Parts {
        let (at, tangent) = (self.rod.point(station), tangent(&self.rod, station));
        let along = tangent * tangent.transpose();
        let axes = match deformation {
            Deformation::Bending => Matrix3::identity() - along,
            Deformation::Torsion => along,
        };
        let of_pair = |[load, read]: &[Point; 2]| match station <= load.station.min(read.station) {
            true => {
                let lever = |point: &Point| skew(&(point.on(&self.rod) - at));
                lever(read) * axes * lever(load).transpose()
            }
            false => Matrix3::zeros(),
        };
        self.pairs.iter().map(of_pair).collect()
    }

    /// Adds joints by which the one at `station`, added as `joint`, may be moved within `range`
    /// (m), no farther than where the rod bends or a load or a sensor stands; `None` where it
    /// stands at such a place.
    pub fn add_nodes(&mut self, station: f64, joint: [usize; 2], range: (f64, f64)) -> Option<Nodes> {
        const LEAST: f64 = 0.01 * MM;
        let ends = [0.0, self.rod.bend_start(), self.rod.bend_end(), self.rod.length()];
        let kinks = self.pairs.iter().flatten().map(|point| point.station).chain(ends);
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
    pub fn varying(&self, share: &dyn Fn(f64) -> f64) -> Parts {
        /// Steps of the midpoint rule along a rod: what varies slowly is known to 0.1 %.
        const STEPS: usize = 96;
        let rod = &self.rod;
        let step = rod.length() / STEPS as f64;
        let mut parts = vec![Matrix3::zeros(); self.pairs.len()];
        for k in 0..STEPS {
            let station = (k as f64 + 0.5) * step;
            let (at, tangent) = (rod.point(station), tangent(rod, station));
            let along = tangent * tangent.transpose();
            let [bending, torsion] = stiffness(rod, station);
            let flexibility =
                ((Matrix3::identity() - along) / bending + along / torsion) * (share(station) * step);
            for (part, [load, read]) in parts.iter_mut().zip(&self.pairs) {
                if station <= load.station.min(read.station) {
                    let lever = |point: &Point| skew(&(point.on(rod) - at));
                    *part += lever(read) * flexibility * lever(load).transpose();
                }
            }
        }
        parts
    }

    /// The parts as `softening` leaves them; unchanged ones to the last digit where it changes
    /// nothing.
    pub fn softened(&self, softening: &Softening) -> Parts {
        let of_pair = |pair: usize| {
            let mut pipes = self.pipes[pair];
            pipes += self.torsion_and_shear[pair] * (1.0 / softening.shear - 1.0);
            for (own, factor) in self.of_pipes.iter().zip(softening.pipes) {
                pipes += own[pair] * (1.0 / factor - 1.0);
            }
            if let Some(arc) = &self.arc {
                pipes += arc[pair] * softening.bend;
            }
            let mut whole = self.whole[pair] + (pipes / softening.stiffness - self.pipes[pair]);
            for &(joint, change) in &softening.joints {
                whole += self.joints[joint].parts[pair] * change;
            }
            whole
        };
        let parts: Parts = (0..self.whole.len()).map(of_pair).collect();
        if softening.variants.is_empty() {
            return parts;
        }
        let mut varied = parts.clone();
        for variant in &softening.variants {
            let changes = self.changes(&parts, softening, variant);
            varied.iter_mut().zip(changes).for_each(|(own, change)| *own += change);
        }
        varied
    }

    /// By how much the parts change, m/N, where a number of the geometry is another one; `parts`
    /// are those of the file.
    fn changes(&self, parts: &[Matrix3<f64>], softening: &Softening, variant: &Variant) -> Parts {
        let variation = &self.variations[variant.variation];
        let pipes = Softening { variants: Vec::new(), joints: Vec::new(), ..softening.clone() };
        let mut changes = vec![Matrix3::zeros(); parts.len()];
        for (share, node) in variation.shares(variant.value) {
            let mut softened = node.softened(&pipes);
            // few of many joints give way: those of a node are computed when they are needed
            for &(joint, change) in &softening.joints {
                let own = &self.joints[joint];
                let hinge = node.hinge(moved(&self.rod, &node.rod, own.station), own.deformation);
                softened.iter_mut().zip(hinge).for_each(|(sum, hinge)| *sum += hinge * change);
            }
            for ((change, softened), part) in changes.iter_mut().zip(softened).zip(parts) {
                *change += (softened - part) * share;
            }
        }
        for (change, pair) in changes.iter_mut().zip(&self.pairs) {
            variation.mask(change, pair, &variant.axes);
        }
        changes
    }

    /// Adds what else the structure would be at values up to `most` from that of its file; the
    /// number of the variation, or `None` where the beam model refuses a rod. What is there already
    /// is not added again.
    pub fn add_variation(&mut self, varied: Varied, most: f64) -> Option<usize> {
        if let Some(known) = self.variations.iter().position(|known| known.varied == varied) {
            return Some(known);
        }
        let of_file = Rod { joints: self.joints_of_file.clone(), ..self.rod.clone() };
        let structure = |rod: &Rod, pairs| Structure::between(rod, pairs).ok();
        self.variations.push(Variation::new(&of_file, &self.pairs, varied, most, structure)?);
        Some(self.variations.len() - 1)
    }

    /// Its pairs of points on another rod.
    pub fn pairs_on(&self, other: &Rod) -> Vec<[Point; 2]> {
        let on_other = |pair: &[Point; 2]| pair.each_ref().map(|point| point.moved(&self.rod, other));
        self.pairs.iter().map(on_other).collect()
    }

    /// Its pairs of points, where loads or sensors of a station are at another point.
    pub fn with_point(&self, end: End, station: f64, at: Point) -> Vec<[Point; 2]> {
        displaced(&self.pairs, end, station, |point| *point = at)
    }

    /// Where loads act, or sensors read, m from the flange: each station once, from there on.
    pub fn stations_of(&self, end: End) -> Vec<f64> {
        let mut stations: Vec<f64> = self.pairs.iter().map(|pair| pair[end as usize].station).collect();
        stations.sort_by(f64::total_cmp);
        stations.dedup();
        stations
    }

    /// How the joint of this number gives way.
    pub fn deformation(&self, joint: usize) -> Deformation {
        self.joints[joint].deformation
    }

    /// What large deflections of `rod`, this one or a softer one, add to the displacement
    /// per square of the load along each axis, m/N² (columns: axes), for each pair of stations: to
    /// the second order, which is even in the load.
    pub fn second_order(&self, rod: &Rod) -> Result<Parts> {
        /// Enough for three digits.
        const ELEMENTS: usize = 48;
        let pairs: Vec<[f64; 2]> =
            self.pairs_on(rod).iter().map(|pair| pair.each_ref().map(|point| point.station)).collect();
        let model = RodModel::new(rod, &Physics::WHOLE, ELEMENTS, pairs.as_flattened())?;
        let mut known: Vec<(f64, [Vec<nalgebra::Vector3<f64>>; 3])> = Vec::new();
        let mut parts = Vec::new();
        for [load, read] in pairs {
            if !known.iter().any(|(station, _)| *station == load) {
                let along = |axis: usize| model.second_order(model.node_at(load), axis, 1.0);
                known.push((load, [along(0)?, along(1)?, along(2)?]));
            }
            let node = model.node_at(read);
            let columns = known.iter().find(|(station, _)| *station == load).map(|(_, along)| along);
            parts.push(columns.map_or_else(Matrix3::zeros, |along| {
                Matrix3::from_columns(&[along[0][node], along[1][node], along[2][node]])
            }));
        }
        Ok(parts)
    }

    /// True where there is an arc that can ovalise.
    pub fn has_arc(&self) -> bool {
        self.arc.is_some()
    }

    /// How far the whole rod bends and twists at the tip per moment there, ∫ds/EI and ∫ds/GJ,
    /// rad/(N·m).
    pub fn rotation(&self) -> [f64; 2] {
        let stretches = self.rod.stretches().into_iter();
        let turns =
            stretches.map(|[from, to]| stiffness(&self.rod, 0.5 * (from + to)).map(|k| (to - from) / k));
        turns.fold([0.0; 2], |sum, turn| [sum[0] + turn[0], sum[1] + turn[1]])
    }

    /// The rod, without its joints.
    pub fn rod(&self) -> &Rod {
        &self.rod
    }
}

/// Refuses stations that are not on the rod. The tip may be named with its last digit rounded.
pub fn check_stations(readings: &Readings, rod: &Rod) -> Result<()> {
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
pub fn responses(rod: &Rod, pairs: &[(f64, f64)]) -> Result<Parts> {
    let stations: Vec<f64> = pairs.iter().flat_map(|&(load, read)| [load, read]).collect();
    let model = RodModel::new(rod, &Physics::WHOLE, 1, &stations)?;
    pairs.iter().map(|&(load, read)| Ok(model.force_response(load, read)?.translation)).collect()
}

/// EI in the rod's plane and GJ of all that bears at a station (m), N·m².
fn stiffness(rod: &Rod, station: f64) -> [f64; 2] {
    let of_pipe = |pipe: &Pipe| {
        let Pipe { section, material } = pipe;
        [
            material.youngs_modulus * section.second_moment(),
            material.shear_modulus * section.torsion_constant(),
        ]
    };
    rod.bearing_at(station).map(of_pipe).fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]])
}

fn difference(a: &[Matrix3<f64>], b: &[Matrix3<f64>], factor: f64) -> Parts {
    a.iter().zip(b).map(|(a, b)| (a - b) * factor).collect()
}

/// One of the two pipes of a rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhichPipe {
    /// From the flange to the bend.
    First,
    /// From the bend to the tip.
    Second,
}

impl WhichPipe {
    /// From the flange on.
    pub const BOTH: [WhichPipe; 2] = [WhichPipe::First, WhichPipe::Second];
}

/// A rod with other moduli of one pipe, of its sleeves, and of the bend where that is pipe 1's: a
/// factor on E and G.
pub fn with_stiffer(rod: &Rod, pipe: WhichPipe, factor: f64) -> Rod {
    let (mut stiffer, corner) = (rod.clone(), rod.bend_start());
    let is_of_first = |station: f64| station < corner;
    let of_pipe = |own: &mut Pipe| {
        own.material.youngs_modulus *= factor;
        own.material.shear_modulus *= factor;
    };
    match pipe {
        WhichPipe::First => {
            of_pipe(&mut stiffer.pipe1);
            if rod.bend == rod.pipe1 {
                of_pipe(&mut stiffer.bend);
            }
        }
        WhichPipe::Second => of_pipe(&mut stiffer.pipe2),
    }
    let sleeves = stiffer.sleeves.iter_mut();
    let own = sleeves.filter(|sleeve| is_of_first(sleeve.from) == (pipe == WhichPipe::First));
    own.for_each(|sleeve| of_pipe(&mut sleeve.pipe));
    stiffer
}

/// A rod with other moduli: factors on E and G of all pipes.
pub fn with_moduli(rod: &Rod, e: f64, g: f64) -> Rod {
    let mut rod = rod.clone();
    for pipe in rod.pipes_mut() {
        pipe.material.youngs_modulus *= e;
        pipe.material.shear_modulus *= g;
    }
    rod
}
