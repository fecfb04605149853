//! The tip alone, for very many rods: no memory is asked for, one element for each part.
//!
//! Elements are exact and internal forces follow from equilibrium, so that the tip's motion is the
//! sum of what every element does to it: u = Σ u_e + θ_e×(p_tip − c), one sweep from the tip to the
//! root.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::chain::Chain;
use super::element::{Profile, Shape};
use super::model::{Physics, SAME_STATION, place_features};
use crate::dual::{Number, about_y};
use crate::rod::Rod;
use crate::spatial::{cross, product, skew};

/// Solves for the tips of rods one after another.
///
/// ```
/// use rodcal::beam::TipSolver;
/// use rodcal::prelude::*;
///
/// let mut rod = Rod::read("rods/5.toml".as_ref())?;
/// let mut solver = TipSolver::default();
/// for l2 in [0.400, 0.525, 0.650] {
///     rod.l2 = l2;
///     let [force, _] = solver.solve(&rod);
///     let whole = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS)?;
///     assert!((force - whole.force).norm() < 1e-11 * whole.force.norm());
/// }
/// # Ok::<(), rodcal::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct TipSolver<T: Number = f64> {
    pub(super) chain: Chain<T>,
    /// Where masses and joints sit, sleeves begin and end.
    cuts: Vec<T>,
    /// The last arc, its radius and angle: rods that are compared often have the same bend.
    arc: Option<(Profile<T>, [T; 2], Shape<T>)>,
}

impl<T: Number> Default for TipSolver<T> {
    fn default() -> Self {
        let chain = Chain::clamped_at(Vector3::zeros(), Rotation3::identity());
        TipSolver { chain, cuts: Vec::new(), arc: None }
    }
}

impl<T: Number> TipSolver<T> {
    /// Motion of the tip per newton at the tip (m/N) and per acceleration (m per m/s²), in {T}:
    /// `m[(i, j)]` is along axis i under a load along axis j. All physics is in it.
    ///
    /// The rod is taken as it is: [`Rod::checked`] checks it. The sums are not checked either, as
    /// those of [`RodModel`](super::RodModel) are: numbers beyond double precision make a result
    /// that is not finite.
    pub fn solve(&mut self, rod: &Rod<T>) -> [Matrix3<T>; 2] {
        self.lay(rod, 1);
        self.chain.tip_motion()
    }

    /// Lays the rod in `count` elements for each part between two places where something sits.
    pub(super) fn lay(&mut self, rod: &Rod<T>, count: usize) {
        let physics = Physics::WHOLE;
        let (tangent, start, end) = (rod.tangent_length(), rod.bend_start(), rod.bend_end());
        self.chain.restart();
        self.cuts.clear();
        self.cuts.extend(rod.masses.iter().map(|mass| mass.station));
        self.cuts.extend(rod.joints.iter().map(|joint| joint.station));
        self.cuts.extend(rod.sleeves.iter().flat_map(|sleeve| [sleeve.from, sleeve.to]));
        self.cuts.sort_unstable_by(|a, b| a.value().total_cmp(&b.value()));
        place_features(&mut self.chain, rod, T::zero());
        let straight = |solver: &mut TipSolver<T>, length: T, middle: T| {
            solver.chain.straight(&physics.profile_at(rod, middle), length, count);
        };
        self.part(rod, [T::zero(), start], rod.l1 - tangent, straight);
        let (radius, turn) = (rod.bend_radius, rod.turn());
        if radius.value() > 0.0 && turn.value() > 0.0 {
            let profile = physics.profile(&rod.bend, rod.bend_flexibility.factor(&rod.bend.section, radius));
            self.part(rod, [start, end], turn, |solver, angle, _| {
                let step = angle / count as f64;
                let shape = match &solver.arc {
                    Some((own, key, shape)) if *own == profile && *key == [radius, step] => *shape,
                    _ => Shape::arc(&profile, radius, step),
                };
                solver.arc = Some((profile, [radius, step], shape));
                solver.chain.bend(&shape, &profile, radius, angle, count);
            });
        } else {
            self.chain.turn(&about_y(turn));
        }
        self.part(rod, [end, rod.length()], rod.l2 - tangent, straight);
        self.chain.mass(rod.tip_mass);
    }

    /// One part of the rod between two stations, cut where something sits; `size` is its length, or
    /// its angle, which `lay` gets piece by piece, each with the station of its middle.
    fn part(
        &mut self,
        rod: &Rod<T>,
        [from, to]: [T; 2],
        size: T,
        mut lay: impl FnMut(&mut TipSolver<T>, T, T),
    ) {
        let is_inside =
            |at: T| at.value() > from.value() + SAME_STATION && at.value() < to.value() - SAME_STATION;
        let (mut last, mut left) = (from, size);
        for k in 0..self.cuts.len() {
            let at = self.cuts[k];
            if is_inside(at) && at.value() > last.value() + SAME_STATION {
                let piece = size * ((at - last) / (to - from));
                lay(self, piece, (last + at) / 2.0);
                place_features(&mut self.chain, rod, at);
                (last, left) = (at, left - piece);
            }
        }
        lay(self, left, (last + to) / 2.0);
        // a sharp corner has one station at its two ends
        if to.value() - from.value() > SAME_STATION {
            place_features(&mut self.chain, rod, to);
        }
    }
}

impl<T: Number> Chain<T> {
    /// Motion of the outermost node per newton there and per acceleration.
    pub(crate) fn tip_motion(&self) -> [Matrix3<T>; 2] {
        let tip = self.nodes[self.end()].position;
        let (mut mass, mut first_moment) = (self.nodes[self.end()].mass, Vector3::<T>::zeros());
        let [mut force, mut weight] = [Matrix3::zeros(); 2];
        for (k, element) in self.elements.iter().enumerate().rev() {
            let shape = self.shape(element);
            let (near, far) = (&self.nodes[k], &self.nodes[k + 1].position);
            let lever = tip - element.reference;
            // a newton at the tip: F = 1, M = [r]ₓ;  the weight beyond: F = φ, M = [s]ₓ, and its
            // own
            let [of_force, of_weight] =
                [(T::one(), skew(&lever)), (mass, skew(&(first_moment + (far - element.reference) * mass)))]
                    .map(|(mass, moment)| {
                        let mut motion = [shape.force * mass, product(&shape.moment, &moment)];
                        if let Some(coupling) = &shape.coupling {
                            motion[0] += coupling * moment;
                            motion[1] += coupling.transpose() * mass;
                        }
                        motion
                    });
            force += of_force[0] - cross(&lever, &of_force[1]);
            weight += of_weight[0] + shape.weight_translation
                - cross(&lever, &(of_weight[1] + shape.weight_rotation));
            first_moment += (far - near.position) * mass
                + (element.reference + shape.mass_centre - near.position) * shape.mass;
            mass += shape.mass + near.mass;
        }
        [force, weight]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::{Load, RodModel};
    use crate::rod::{BendFlexibility, Joint, Pipe};
    use crate::section::Round;
    use crate::units::DEG;

    /// Also with masses and joints, wherever they sit.
    #[test]
    fn the_tip_is_that_of_the_whole_model() {
        let plain = Rod::read("rods/2.toml".as_ref()).unwrap();
        let plain = Rod { masses: Vec::new(), joints: Vec::new(), ..plain };
        let bent = plain.clone().with_bend(0.06, BendFlexibility::VonKarman);
        let joint =
            |name: &str, station: f64| Joint { name: name.into(), station, bending: 1e-4, torsion: 2e-4 };
        let collar = |outer: f64| Pipe::new(Round::tube(outer, outer - 0.01), plain.pipe1.material.clone());
        let rods = [
            plain.clone(),
            plain.clone().with_angle(120.0 * DEG),
            plain.clone().with_angle(180.0 * DEG),
            bent.clone(),
            bent.clone().with_angle(60.0 * DEG),
            bent.clone().with_mass("ring", 0.3, 0.1).with_joint(joint("a", 0.2)),
            // at the flange, within the bend, at its ends, at the tip, and two at one place
            bent.clone().with_joint(joint("flange", 0.0)).with_joint(joint("tip", bent.length())),
            bent.clone()
                .with_joint(joint("before", bent.bend_start()))
                .with_joint(joint("within", 0.5 * (bent.bend_start() + bent.bend_end())))
                .with_mass("beyond", bent.bend_end(), 0.2),
            plain.clone().with_joint(joint("corner", plain.l1)).with_mass("ring", plain.l1, 0.1),
            // sleeves from the flange, up to the corner or the bend, at a joint, over one another
            plain.clone().with_sleeve("foot", 0.0, 0.05, collar(0.06)).with_joint(joint("a", 0.05)),
            plain.clone().with_sleeve("a", 0.1, plain.l1, collar(0.06)),
            bent.clone()
                .with_sleeve("a", 0.02, bent.bend_start(), collar(0.06))
                .with_sleeve("b", 0.3, bent.length(), collar(0.06))
                .with_sleeve("over", 0.35, 0.4, collar(0.07)),
        ];
        let mut solver = TipSolver::default();
        // in turn, so that what is kept of one rod would be seen in the next
        for rod in rods.iter().chain(rods.iter().rev()) {
            let model = RodModel::new(rod, &Physics::WHOLE, 200, &[]).unwrap();
            let tip = model.tip();
            let response = model.chain.solve(&[Load::Force { node: tip }, Load::SelfWeight]).unwrap();
            for (load, found) in solver.solve(rod).into_iter().enumerate() {
                let whole = response.motion(tip, load).translation;
                assert!((found - whole).norm() < 1e-11 * whole.norm(), "{found} {whole}");
            }
        }
    }
}
