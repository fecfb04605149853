//! Equilibrium from the tip to the root, deformation from the root to the tip.
//!
//! Loads come in blocks of three: the same load along x, along y and along z. A point force of 1 N
//! is then the weight of a point mass of 1 kg under unit acceleration, so that forces and
//! self-weight are one kind of load: a distribution of mass. What an element carries of it is its
//! mass φ and first moment s about the element, `F = φ·1`, `M = [s]ₓ`.

use nalgebra::{Matrix3, Vector3};

use super::chain::Chain;
use super::check;
use super::element::Shape;
use super::response::{Carried, Load, Motion, Response, Resultant};
use crate::error::{Error, Result};
use crate::parallel::checkpoint;
use crate::spatial::cross;

impl Chain {
    /// Solves for all `loads` at once and checks the solution (see `check.rs`).
    ///
    /// # Errors
    /// [`Error::Argument`] for a load at a node the chain does not have; [`Error::SelfCheck`] with
    /// node and freedom where equilibrium, reciprocity or finiteness fails.
    pub fn solve(&self, loads: &[Load]) -> Result<Response> {
        for load in loads {
            match *load {
                Load::Force { node } | Load::Couple { node } if node > self.end() => {
                    return Err(Error::Argument {
                        name: "node",
                        found: node.to_string(),
                        expected: format!("a node of the chain, 0 to {}", self.end()),
                    });
                }
                _ => {}
            }
        }
        let weight = self.weight_beyond();
        let response = self.deform(loads, &weight);
        check::check(self, loads, &weight, &response)?;
        Ok(response)
    }

    /// Force and moment that everything at and beyond `node` exerts on the part before it.
    ///
    /// # Panics
    /// For a node that the chain does not have.
    pub fn resultant(&self, load: Load, node: usize) -> Resultant {
        let carried = match load {
            Load::SelfWeight => self.weight_beyond()[node],
            _ => self.point_load_beyond(load, node, &self.nodes[node].position),
        };
        Resultant { force: Matrix3::from_diagonal_element(carried.mass), moment: carried.moment() }
    }

    /// From the tip to the root: mass of everything at and beyond each node and its first moment
    /// about that node.
    pub(super) fn weight_beyond(&self) -> Vec<Carried> {
        let mut carried = Carried::NOTHING;
        let mut all = vec![carried; self.nodes.len()];
        carried.mass = self.nodes[self.end()].mass;
        all[self.end()] = carried;
        for k in (0..self.elements.len()).rev() {
            checkpoint();
            let (near, far, element) = (&self.nodes[k], &self.nodes[k + 1], &self.elements[k]);
            let shape = self.shape(element);
            // φ_k = φ_{k+1} + m_element + m_node,  s_k = s_{k+1} + φ_{k+1}(p_{k+1} − p_k) +
            // m_element(c + c_m − p_k)
            carried.first_moment += (far.position - near.position) * carried.mass
                + (element.reference + shape.mass_centre - near.position) * shape.mass;
            carried.mass += shape.mass + near.mass;
            all[k] = carried;
        }
        all
    }

    /// From the root to the tip: each node moves with the one before it and by its element's
    /// deformation.
    pub(super) fn deform(&self, loads: &[Load], weight: &[Carried]) -> Response {
        let still = Motion { translation: Matrix3::zeros(), rotation: Matrix3::zeros() };
        let mut motions = Vec::with_capacity(self.nodes.len() * loads.len());
        motions.resize(loads.len(), still);
        for (k, element) in self.elements.iter().enumerate() {
            checkpoint();
            let shape = self.shape(element);
            let (near, far) = (self.nodes[k].position, self.nodes[k + 1].position);
            for &load in loads {
                let before = motions[motions.len() - loads.len()];
                let own = deformation(shape, &self.carried(load, k, weight), load == Load::SelfWeight);
                // u' = u + θ×(p' − p) + u_e + θ_e×(p' − c),  θ' = θ + θ_e
                motions.push(Motion {
                    translation: before.translation + own.translation
                        - cross(&(far - near), &before.rotation)
                        - cross(&(far - element.reference), &own.rotation),
                    rotation: before.rotation + own.rotation,
                });
            }
        }
        Response { loads: loads.len(), motions }
    }

    /// What element `k` carries of a load that acts beyond it, about its reference point.
    pub(super) fn carried(&self, load: Load, k: usize, weight: &[Carried]) -> Carried {
        let reference = &self.elements[k].reference;
        match load {
            Load::SelfWeight => {
                let (beyond, far) = (&weight[k + 1], &self.nodes[k + 1].position);
                Carried { first_moment: beyond.first_moment + (far - reference) * beyond.mass, ..*beyond }
            }
            _ => self.point_load_beyond(load, k + 1, reference),
        }
    }

    /// What a point load at or beyond `node` carries into a cut before it, about `point`; nothing
    /// if it acts before.
    fn point_load_beyond(&self, load: Load, node: usize, point: &Vector3<f64>) -> Carried {
        match load {
            Load::Force { node: at } if at >= node => {
                Carried { mass: 1.0, first_moment: self.nodes[at].position - point, couple: 0.0 }
            }
            Load::Couple { node: at } if at >= node => Carried { couple: 1.0, ..Carried::NOTHING },
            _ => Carried::NOTHING,
        }
    }
}

/// Motion of the element's far end at its reference point, its near end held.
// Inlined, its two matrices stay in registers: a quarter off the time of a solve.
#[inline]
fn deformation(shape: &Shape, carried: &Carried, weighs: bool) -> Motion {
    let moment = carried.moment();
    // u = A·F + C·M + U·a,  θ = Cᵀ·F + B·M + V·a
    let mut motion = Motion { translation: shape.force * carried.mass, rotation: shape.moment * moment };
    if let Some(coupling) = &shape.coupling {
        motion.translation += coupling * moment;
        motion.rotation += coupling.transpose() * carried.mass;
    }
    if weighs {
        motion.translation += shape.weight_translation;
        motion.rotation += shape.weight_rotation;
    }
    motion
}
