//! The first natural frequency in passing, for very many rods.
//!
//! A rod is plane and its sections are symmetric, so that it swings in its plane or out of it, and
//! neither motion makes the other. In each the iteration x ← F M x of `natural.rs` is that of one
//! vector, and Rayleigh's quotient ω² = xᵀK x/xᵀM x has the square of its error (K.-J. Bathe,
//! *Finite Element Procedures*, 2nd ed., § 11.2). Two elements for each part are coarse, and enough
//! to say of most rods whether they swing as fast as they must.

use nalgebra::DMatrix;

use super::tip::TipSolver;
use crate::rod::Rod;

/// Elements of a part.
const ELEMENTS: usize = 2;
/// Share by which ω² may still change, and most iterations.
const SETTLED: f64 = 1e-3;
const MOST_ITERATIONS: usize = 20;

impl TipSolver {
    /// The first natural frequency of a rod, Hz, within [`TipSolver::FREQUENCY_SHARE`] of
    /// [`Rod::first_frequency`]; infinite where nothing has mass.
    ///
    /// ```
    /// use rodcal::beam::TipSolver;
    /// use rodcal::prelude::*;
    ///
    /// let rod = Rod::read("rods/5.toml".as_ref())?;
    /// let (rough, exact) = (TipSolver::default().frequency(&rod), rod.first_frequency()?.unwrap_or(0.0));
    /// assert!((rough / exact - 1.0).abs() < TipSolver::FREQUENCY_SHARE);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn frequency(&mut self, rod: &Rod) -> f64 {
        self.lay(rod, ELEMENTS);
        let (chain, nodes) = (&self.chain, self.chain.nodes.len());
        let inertia = chain.inertia();
        // turning about Y in the rod's plane, and about X and Z out of it
        let mut x = DMatrix::from_fn(6 * nodes, 2, |row, side| {
            let at = chain.nodes[row / 6].position;
            match (side, row % 6) {
                (0, 0) => at.z,
                (0, 2) => -at.x,
                (1, 1) => at.x + at.z,
                (0, 4) | (1, 3 | 5) => 1.0,
                _ => 0.0,
            }
        });
        let mut known = [f64::INFINITY; 2];
        for _ in 0..MOST_ITERATIONS {
            let forces = chain.inertia_forces(&inertia, &x);
            let moved = chain.moved_by(&forces);
            let against = chain.inertia_forces(&inertia, &moved);
            // of x = F p: xᵀK x = xᵀp
            let squares = [0, 1].map(|side| {
                let mass = moved.column(side).dot(&against.column(side));
                if mass > 0.0 { moved.column(side).dot(&forces.column(side)) / mass } else { f64::INFINITY }
            });
            let is_settled =
                squares.iter().zip(known).all(|(new, old)| *new == old || (old - new).abs() <= SETTLED * new);
            known = squares;
            if is_settled {
                break;
            }
            x = moved;
            for mut column in x.column_iter_mut() {
                let size = column.amax();
                if size > 0.0 {
                    column.scale_mut(1.0 / size);
                }
            }
        }
        known[0].min(known[1]).sqrt() / std::f64::consts::TAU
    }

    /// Share by which [`TipSolver::frequency`] may be off.
    pub const FREQUENCY_SHARE: f64 = 0.01;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::{BendFlexibility, Joint, Pipe};
    use crate::section::Round;
    use crate::statistics::Random;

    /// Rods of all kinds, drawn: hardly any is off by a third of what is allowed for.
    #[test]
    fn it_is_near_the_frequency_of_a_fine_mesh() {
        let mut random = Random::seeded(12, 15);
        let steel = crate::material::Material::isotropic("steel", 200e9, 0.3, 7900.0);
        let mut solver = TipSolver::default();
        let (mut most, mut sum): (f64, f64) = (0.0, 0.0);
        for _ in 0..300 {
            let mut tube = || {
                let outer = random.uniform(0.006, 0.06);
                Round::tube(outer, outer * random.uniform(0.0, 0.95))
            };
            let [first, second] = [tube(), tube()];
            let (l1, l2) = (random.uniform(0.05, 0.6), random.uniform(0.05, 0.9));
            let mut rod = Rod::new("drawn", l1, l2, Pipe::new(first, steel.clone()));
            rod = rod.with_pipe2(Pipe::new(second, steel.clone()));
            rod = rod.with_angle(random.uniform(0.5, std::f64::consts::PI));
            rod.tip_mass = random.uniform(0.0, 0.2) * random.index(2) as f64;
            if random.index(2) == 0 {
                let most = l1.min(l2) * (0.5 * rod.gamma).tan();
                rod = rod.with_bend(random.uniform(0.0, 0.9) * most, BendFlexibility::Beam);
            }
            let length = rod.length();
            if random.index(2) == 0 {
                let [bending, torsion] = [1e-3, 1e-3].map(|most| random.uniform(0.0, most));
                let station = random.uniform(0.0, length);
                rod = rod.with_joint(Joint { name: "glue".into(), station, bending, torsion });
                rod = rod.with_mass("ring", random.uniform(0.0, length), random.uniform(0.0, 0.3));
            }
            let exact = rod.first_frequency().unwrap().unwrap();
            let off = (solver.frequency(&rod) / exact - 1.0).abs();
            (most, sum) = (most.max(off), sum + off);
        }
        assert!(most < TipSolver::FREQUENCY_SHARE / 2.0 && sum / 300.0 < 1e-3, "{most} {}", sum / 300.0);
    }
}
