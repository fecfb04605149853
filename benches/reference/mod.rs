//! The same rod by the stiffness method, as most programs do it: to compare with, not to use.
//!
//! Two-node Timoshenko elements of 12 freedoms, assembled into one matrix and factorised:
//! [`banded`] and [`dense`] differ in that only. Sharp-cornered rods of round tubes, without joints
//! or masses but the tip's.

pub mod banded;
pub mod dense;

use nalgebra::{Matrix3, SMatrix, Vector3};
use rodcal::compliance::Compliance;
use rodcal::rod::{Pipe, Rod};
use rodcal::spatial::skew;
use rodcal::units::STANDARD_GRAVITY;

/// Freedoms of a node: displacement, then rotation.
pub const NODE: usize = 6;
/// Load cases: tip force along x, y, z (1 N), self-weight along x, y, z (1 m/s²).
pub const CASES: usize = 6;

type Stiffness = SMatrix<f64, { 2 * NODE }, { 2 * NODE }>;
type Loads = SMatrix<f64, { 2 * NODE }, CASES>;

/// Nodes from the clamped one to the tip, and the pipe between each and the next.
pub struct Frame<'a> {
    nodes: Vec<Vector3<f64>>,
    pipes: Vec<&'a Pipe>,
    tip_mass: f64,
}

impl<'a> Frame<'a> {
    /// Nothing of the rod is left out.
    pub fn describes(rod: &Rod) -> bool {
        rod.bend_radius == 0.0 && rod.joints.is_empty() && rod.masses.is_empty()
    }

    /// `count` elements, at least two, shared out by length over the two pipes.
    pub fn of_rod(rod: &'a Rod, count: usize) -> Self {
        assert!(Self::describes(rod), "a bend, a joint or a mass is left out");
        let (corner, tip) = (Vector3::new(0.0, 0.0, rod.l1), rod.tip());
        let share = count as f64 * rod.l1 / (rod.l1 + rod.l2);
        let first = share.round().clamp(1.0, count as f64 - 1.0) as usize;
        let second = count - first;
        let node = |k: usize| match k <= first {
            true => corner * (k as f64 / first as f64),
            false => corner + (tip - corner) * ((k - first) as f64 / second as f64),
        };
        Frame {
            nodes: (0..=count).map(node).collect(),
            pipes: (0..count).map(|k| if k < first { &rod.pipe1 } else { &rod.pipe2 }).collect(),
            tip_mass: rod.tip_mass,
        }
    }

    /// Freedoms that are not clamped.
    pub fn freedoms(&self) -> usize {
        NODE * self.pipes.len()
    }

    /// Hands each number of the elements' matrices to `add(row, column, value)` where both freedoms
    /// are free, and returns the right-hand sides, one row a freedom.
    pub fn assemble(&self, mut add: impl FnMut(usize, usize, f64)) -> Vec<[f64; CASES]> {
        let mut right = vec![[0.0; CASES]; self.freedoms()];
        for (k, pipe) in self.pipes.iter().enumerate() {
            let (stiffness, loads) = element(pipe, self.nodes[k + 1] - self.nodes[k]);
            // node k's freedoms start at 6 k, less the six of the clamped node 0
            let clamped = if k == 0 { NODE } else { 0 };
            let at = |freedom: usize| NODE * k + freedom - NODE;
            for row in clamped..2 * NODE {
                for column in clamped..2 * NODE {
                    add(at(row), at(column), stiffness[(row, column)]);
                }
                for case in 0..CASES {
                    right[at(row)][case] += loads[(row, case)];
                }
            }
        }
        let tip = self.freedoms() - NODE;
        for axis in 0..3 {
            right[tip + axis][axis] += 1.0;
            right[tip + axis][3 + axis] += self.tip_mass;
        }
        right
    }

    /// The tip's compliance from the displacements that belong to the right-hand sides.
    pub fn compliance(&self, displacements: &[[f64; CASES]]) -> Compliance {
        let tip = &displacements[self.freedoms() - NODE..];
        Compliance {
            force: Matrix3::from_fn(|m, n| tip[m][n]),
            gravity: Matrix3::from_fn(|m, n| tip[m][3 + n]) * STANDARD_GRAVITY,
        }
    }
}

/// Stiffness and consistent nodal loads of one element, in the axes of {T}.
///
/// J. S. Przemieniecki, *Theory of Matrix Structural Analysis* (1968), § 5.6; for a round section
/// the twelve freedoms need no local axes but the unit vector t along the element.
fn element(pipe: &Pipe, along: Vector3<f64>) -> (Stiffness, Loads) {
    let (section, material) = (&pipe.section, &pipe.material);
    let length = along.norm();
    let t = along / length;
    let (lengthwise, across) = (t * t.transpose(), Matrix3::identity() - t * t.transpose());

    let [kappa, _] = pipe.shear_coefficients();
    let ei = material.youngs_modulus * section.second_moment();
    let ea = material.youngs_modulus * section.area();
    let gj = material.shear_modulus * section.torsion_constant();
    // Φ = 12 EI/(κGA L²): how much shear adds to bending
    let phi = 12.0 * ei / (kappa * material.shear_modulus * section.area() * length.powi(2));
    let bending = ei / (1.0 + phi);

    // with S = [t]ₓ:   u_a    θ_a    u_b    θ_b
    //            u_a    K    −B S    −K    −B S
    //            θ_a   B S    N     −B S    O
    //            u_b   −K     B S    K     B S
    //            θ_b   B S    O     −B S    N
    let k = lengthwise * (ea / length) + across * (12.0 * bending / length.powi(3));
    let b = skew(&t) * (6.0 * bending / length.powi(2));
    let n = lengthwise * (gj / length) + across * ((4.0 + phi) * bending / length);
    let o = lengthwise * (-gj / length) + across * ((2.0 - phi) * bending / length);
    let mut stiffness = Stiffness::zeros();
    for (row, blocks) in [[k, -b, -k, -b], [b, n, -b, o], [-k, b, k, b], [b, o, -b, n]].iter().enumerate() {
        for (column, block) in blocks.iter().enumerate() {
            stiffness.fixed_view_mut::<3, 3>(3 * row, 3 * column).copy_from(block);
        }
    }

    // half of the weight at either end, and the moments of a clamped beam, ± q L²/12
    let mass = pipe.mass_per_length() * length;
    let (force, moment) = (Matrix3::identity() * (mass / 2.0), skew(&t) * (mass * length / 12.0));
    let mut loads = Loads::zeros();
    for (row, block) in [force, moment, force, -moment].iter().enumerate() {
        loads.fixed_view_mut::<3, 3>(3 * row, 3).copy_from(block);
    }
    (stiffness, loads)
}
