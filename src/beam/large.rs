//! What large deflections add: the second order of the displacements in the load.
//!
//! A beam that bends turns its sections and moves its lever arms. With the rotations θ of the
//! linear solution under a dead force, every element is turned by its θ and hung on the one before,
//! the chain is solved again in this shape, and its rotations are put together as finite ones,
//!
//! ```text
//! R₀ = 1,  R_(k+1) = exp(θ'_(k+1) − θ'_k)·R_k,  p'_(k+1) = p'_k + R_mid·(p_(k+1) − p_k)
//! ```
//!
//! which is exact to the second order in the force: rotations of one element after the other are
//! put together in the order of the chain. What remains is of the third order: small while the tip
//! moves by less than a tenth of the rod's length. The tests compare it with the closed form of a
//! straight cantilever, tests/diagnosis with the trials' Cosserat rod.

use nalgebra::{Rotation3, Vector3};

use super::RodModel;
use super::chain::Chain;
use super::response::Load;
use crate::error::Result;

impl RodModel {
    /// Second order of the displacements of all nodes, in {T}, m, one per node: what is to be added
    /// to the linear displacement. `size` (N) is a dead force at `node` along axis `direction` of
    /// {T} (0, 1, 2: x, y, z). It grows with the square of the force.
    ///
    /// # Errors
    /// As [`Chain::solve`].
    pub fn second_order(&self, node: usize, direction: usize, size: f64) -> Result<Vec<Vector3<f64>>> {
        let chain = &self.chain;
        let turned = |chain: &Chain| -> Result<Vec<Vector3<f64>>> {
            let response = chain.solve(&[Load::Force { node }])?;
            Ok((0..=chain.end()).map(|k| response.motion(k, 0).rotation.column(direction) * size).collect())
        };
        let linear = turned(chain)?;
        let (bent, _) = moved(chain, &linear);
        let bent_rotations = turned(&bent)?;
        let (_, positions) = moved(chain, &bent_rotations);
        // what the linear solution says of the same integral
        let mut straight = Vector3::zeros();
        let mut second = vec![Vector3::zeros()];
        for k in 0..chain.end() {
            let along = chain.position(k + 1) - chain.position(k);
            straight += (linear[k] + linear[k + 1]).cross(&along) / 2.0;
            second.push(positions[k + 1] - chain.position(k + 1) - straight);
        }
        Ok(second)
    }
}

/// The chain with every element turned, rotations of nodes adding up along it, and where its nodes
/// come to be.
fn moved(chain: &Chain, rotations: &[Vector3<f64>]) -> (Chain, Vec<Vector3<f64>>) {
    let mut bent = chain.clone();
    let mut frame = Rotation3::identity();
    let mut positions = vec![chain.position(0)];
    for k in 0..chain.end() {
        let half = Rotation3::new((rotations[k + 1] - rotations[k]) / 2.0);
        let middle = half * frame;
        frame = half * middle;
        let (old, new) = (chain.position(k), positions[k]);
        let element = &mut bent.elements[k];
        element.reference = new + middle * (element.reference - old);
        bent.shapes.push(chain.shape(&chain.elements[k]).turned(&middle));
        element.shape = bent.shapes.len() - 1;
        positions.push(new + middle * (chain.position(k + 1) - old));
        bent.nodes[k + 1].position = positions[k + 1];
    }
    (bent, positions)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::Physics;
    use crate::rod::Rod;
    use approx::assert_relative_eq;

    fn rod(gamma: f64) -> Rod {
        let text =
            include_str!("../../rods/5.toml").replace("gamma_deg = 90.0", &format!("gamma_deg = {gamma}"));
        Rod::from_toml("rod", &text).unwrap()
    }

    /// A straight cantilever under F across it is shortened by ½∫θ² ds = F²L⁵/(15·E²I²), and moves
    /// across to the second order not at all.
    #[test]
    fn a_straight_rod_is_shortened_by_its_bending() {
        let rod = rod(180.0);
        let model = RodModel::new(&rod, &Physics::BENDING_AND_TORSION, 200, &[]).unwrap();
        let second = model.second_order(model.tip(), 0, 10.0).unwrap()[model.tip()];
        let (e, i) = (rod.pipe1.material.youngs_modulus, rod.pipe1.section.second_moment());
        let expected = 100.0 * rod.length().powi(5) / (15.0 * (e * i).powi(2));
        assert_relative_eq!(second.z, -expected, max_relative = 1e-3);
        assert!(second.x.abs() < 0.01 * expected && second.y.abs() < 1e-12);
    }

    #[test]
    fn it_grows_with_the_square_of_the_force_and_not_with_its_sign() {
        let model = RodModel::new(&rod(90.0), &Physics::WHOLE, 100, &[]).unwrap();
        for axis in 0..3 {
            let at = |size: f64| model.second_order(model.tip(), axis, size).unwrap()[model.tip()];
            assert_relative_eq!(at(2.0), at(1.0) * 4.0, max_relative = 1e-3, epsilon = 1e-12);
            assert_relative_eq!(at(-1.0), at(1.0), max_relative = 1e-3, epsilon = 1e-12);
        }
    }

    /// The tip that is pushed across the plane of a bent rod sinks in its plane: pipe I bends and
    /// twists, pipe II swings on its end.
    #[test]
    fn mesh_does_not_matter() {
        let at = |elements: usize| {
            let model = RodModel::new(&rod(90.0), &Physics::WHOLE, elements, &[]).unwrap();
            model.second_order(model.tip(), 1, 20.0).unwrap()[model.tip()]
        };
        assert_relative_eq!(at(60), at(600), max_relative = 2e-3);
    }
}
