//! The tip alone, for very many rods: no memory is asked for, one element for each part.
//!
//! Elements are exact and internal forces follow from equilibrium, so that the tip's motion is the
//! sum of what every element does to it: u = Σ u_e + θ_e×(p_tip − c), one sweep from the tip to the
//! root.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::chain::Chain;
use super::element::{Profile, Shape};
use super::model::{Physics, RodModel};
use crate::dual::{Number, about_y};
use crate::error::Result;
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
///     let [force, _] = solver.solve(&rod)?;
///     let whole = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS)?;
///     assert!((force - whole.force).norm() < 1e-11 * whole.force.norm());
/// }
/// # Ok::<(), rodcal::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct TipSolver<T: Number = f64> {
    chain: Chain<T>,
    /// The last arc, its radius and angle: rods that are compared often have the same bend.
    arc: Option<(Profile<T>, [T; 2], Shape<T>)>,
}

impl<T: Number> Default for TipSolver<T> {
    fn default() -> Self {
        TipSolver { chain: Chain::clamped_at(Vector3::zeros(), Rotation3::identity()), arc: None }
    }
}

impl<T: Number> TipSolver<T> {
    /// Motion of the tip per newton at the tip (m/N) and per acceleration (m per m/s²), in {T}:
    /// `m[(i, j)]` is along axis i under a load along axis j. All physics is in it.
    ///
    /// The rod is taken as it is: [`Rod::checked`] checks it. The sums are not checked either, as
    /// those of [`RodModel`] are: numbers beyond double precision make a result that is not finite.
    ///
    /// # Errors
    /// As [`RodModel::new`], for a rod with masses or joints on it only.
    pub fn solve(&mut self, rod: &Rod<T>) -> Result<[Matrix3<T>; 2]> {
        if !rod.masses.is_empty() || !rod.joints.is_empty() {
            return Ok(RodModel::new(rod, &Physics::WHOLE, 1, &[])?.chain.tip_motion());
        }
        let physics = Physics::WHOLE;
        let tangent = rod.tangent_length();
        self.chain.restart();
        self.chain.straight(&physics.profile(&rod.pipe1, T::one()), rod.l1 - tangent, 1);
        if rod.bend_radius.value() > 0.0 && rod.turn().value() > 0.0 {
            let factor = rod.bend_flexibility.factor(&rod.bend.section, rod.bend_radius);
            let (profile, key) = (physics.profile(&rod.bend, factor), [rod.bend_radius, rod.turn()]);
            let shape = match &self.arc {
                Some((own, known, shape)) if *own == profile && *known == key => *shape,
                _ => Shape::arc(&profile, key[0], key[1]),
            };
            self.arc = Some((profile, key, shape));
            self.chain.bend(&shape, &profile, key[0], key[1], 1);
        } else {
            self.chain.turn(&about_y(rod.turn()));
        }
        self.chain.straight(&physics.profile(&rod.pipe2, T::one()), rod.l2 - tangent, 1);
        self.chain.mass(rod.tip_mass);
        Ok(self.chain.tip_motion())
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
    use crate::beam::Load;
    use crate::rod::{BendFlexibility, Joint};
    use crate::units::DEG;

    #[test]
    fn the_tip_is_that_of_the_whole_model() {
        let plain = Rod::read("rods/2.toml".as_ref()).unwrap();
        let plain = Rod { masses: Vec::new(), joints: Vec::new(), ..plain };
        let bent = plain.clone().with_bend(0.06, BendFlexibility::VonKarman);
        let joint = Joint { name: "j".into(), station: 0.2, bending: 1e-4, torsion: 2e-4 };
        let rods = [
            plain.clone(),
            plain.clone().with_angle(120.0 * DEG),
            plain.clone().with_angle(180.0 * DEG),
            bent.clone(),
            bent.clone().with_angle(60.0 * DEG),
            bent.with_mass("ring", 0.3, 0.1).with_joint(joint),
        ];
        let mut solver = TipSolver::default();
        // in turn, so that what is kept of one rod would be seen in the next
        for rod in rods.iter().chain(rods.iter().rev()) {
            let model = RodModel::new(rod, &Physics::WHOLE, 200, &[]).unwrap();
            let tip = model.tip();
            let response = model.chain.solve(&[Load::Force { node: tip }, Load::SelfWeight]).unwrap();
            for (load, found) in solver.solve(rod).unwrap().into_iter().enumerate() {
                let whole = response.motion(tip, load).translation;
                assert!((found - whole).norm() < 1e-11 * whole.norm(), "{found} {whole}");
            }
        }
    }
}
