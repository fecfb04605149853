//! Natural frequencies and shapes: how fast a rod swings when nobody holds it.
//!
//! Inertia forces are loads like others. The chain's flexibilities F turn them into motions and the
//! mass matrix M turns motions into inertia forces, so that
//!
//! ```text
//! x = ω² F M x
//! ```
//!
//! is solved by iterating x ← F M x on several vectors at once, the smallest ω first (subspace
//! iteration: K.-J. Bathe, *Finite Element Procedures*, 2nd ed., § 11.6). F is exact. M is
//! consistent with the deflections of a Timoshenko beam between two nodes, rotary inertia included
//! (J. S. Przemieniecki, *Theory of Matrix Structural Analysis*, 1968, § 11.6), and lumped masses
//! sit at their nodes; the mass of an arc is that of its chords, moved to where its centre of mass
//! is. ω converges from above with the fourth power of the elements' length.

#[cfg(test)]
mod tests;

use nalgebra::{DMatrix, SMatrix, Vector3};

use super::chain::{Chain, Piece};
use super::model::{Physics, RodModel};
use crate::dual::Number;
use crate::error::{Error, Result};
use crate::rod::Rod;
use crate::spatial::skew;

/// Elements of [`Rod::natural_modes`]: the first frequencies are off by less than a millionth.
pub(super) const ELEMENTS: usize = 60;
/// Vectors beyond those that are asked for: the iteration's error shrinks by (ω_asked/ω_next)² each
/// time.
const GUARD: usize = 8;
/// Elements, vectors beyond the one that is asked for, and where ω² has converged, for
/// [`Rod::first_frequency`].
pub(super) const FEW: usize = 16;
const FEW_GUARD: usize = 5;
const ROUGHLY: f64 = 1e-8;
/// Where ω² has converged.
const SETTLED: f64 = 1e-12;
const MOST_ITERATIONS: usize = 200;

/// A natural mode of an undamped rod.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NaturalMode {
    /// Frequency ω/2π, Hz.
    pub frequency: f64,
    /// For each node its displacement (m) and rotation (rad), such that the largest displacement is
    /// 1 m.
    pub shape: Vec<[Vector3<f64>; 2]>,
}

/// Time in which a swing dies down to `share` of its size: t = ln(1/share)/(ζω), s, with ω =
/// 2π·`frequency` (Hz) and the damping ratio ζ > 0 (bare steel 0.001 to 0.005, bonded or threaded
/// joints 0.005 to 0.02).
///
/// ```
/// use rodcal::beam::settling_time;
///
/// // 10 Hz, 1 % of critical damping: to 2 % in 6.2 s
/// assert!((settling_time(10.0, 0.01, 0.02) - 6.226).abs() < 1e-3);
/// ```
pub fn settling_time(frequency: f64, damping_ratio: f64, share: f64) -> f64 {
    -share.ln() / (damping_ratio * std::f64::consts::TAU * frequency)
}

impl Rod {
    /// The first `count` natural modes of the rod as built, clamped at the flange, slowest first;
    /// fewer where it has fewer.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let rod = Rod::read("rods/5.toml".as_ref())?;
    /// let modes = rod.natural_modes(2)?;
    /// // out of its plane, then in it
    /// assert!((modes[0].frequency - 55.83).abs() < 0.01 && (modes[1].frequency - 60.09).abs() < 0.01);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`RodModel::new`]; [`Error::Numerical`] where the iteration does not settle.
    pub fn natural_modes(&self, count: usize) -> Result<Vec<NaturalMode>> {
        RodModel::new(self, &Physics::WHOLE, ELEMENTS, &[])?.chain.natural_modes(count)
    }

    /// The first natural frequency, Hz, within some millionths of [`Rod::natural_modes`] and in a
    /// tenth of the time; `None` where nothing has mass.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let rod = Rod::read("rods/5.toml".as_ref())?;
    /// let whole = rod.natural_modes(1)?[0].frequency;
    /// let first = rod.first_frequency()?.expect("steel has mass");
    /// assert!((first / whole - 1.0).abs() < 1e-4 && first > 10.0, "{first} {whole}");
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Rod::natural_modes`].
    pub fn first_frequency(&self) -> Result<Option<f64>> {
        let modes = RodModel::new(self, &Physics::WHOLE, FEW, &[])?.chain.modes(1, FEW_GUARD, ROUGHLY)?;
        Ok(modes.first().map(|mode| mode.frequency))
    }
}

impl Chain {
    /// The first `count` natural modes of the clamped chain, slowest first; fewer where it has
    /// fewer.
    ///
    /// # Errors
    /// [`Error::Numerical`] where the iteration does not settle.
    pub fn natural_modes(&self, count: usize) -> Result<Vec<NaturalMode>> {
        self.modes(count, GUARD, SETTLED)
    }

    fn modes(&self, count: usize, guard: usize, settled: f64) -> Result<Vec<NaturalMode>> {
        let inertia = self.inertia();
        let (length, nodes) = (self.station(self.end()).max(f64::MIN_POSITIVE), self.nodes.len());
        // bodies that sway along and turn about each axis: uniformly, in proportion to the station
        // …
        let mut x = DMatrix::from_fn(6 * nodes, count + guard, |row, k| {
            let is_own = row % 6 == k % 6;
            if is_own { (self.station(row / 6) / length).powi((k / 6) as i32) } else { 0.0 }
        });
        let mut known: Vec<f64> = Vec::new();
        for _ in 0..MOST_ITERATIONS {
            let forces = self.inertia_forces(&inertia, &x);
            let moved = self.moved_by(&forces);
            // K and M seen by these shapes
            let stiffness = moved.tr_mul(&forces);
            let mass = moved.tr_mul(&self.inertia_forces(&inertia, &moved));
            let Some((squares, turned)) = ritz(stiffness, mass) else { break };
            x = moved * turned;
            let asked = count.min(squares.len());
            let is_settled = known.len() == squares.len()
                && squares[..asked].iter().zip(&known).all(|(new, old)| (new - old).abs() <= settled * new);
            if is_settled {
                let mode = |k: usize| self.mode(squares[k], &x, k);
                return Ok((0..asked).map(mode).collect());
            }
            known = squares;
        }
        if known.is_empty() && count > 0 {
            // nothing has mass
            return Ok(Vec::new());
        }
        match count {
            0 => Ok(Vec::new()),
            _ => Err(Error::Numerical {
                what: "natural frequencies",
                why: format!("they do not settle within {MOST_ITERATIONS} iterations"),
            }),
        }
    }

    fn mode(&self, square: f64, x: &DMatrix<f64>, k: usize) -> NaturalMode {
        let at = |row: usize| Vector3::new(x[(row, k)], x[(row + 1, k)], x[(row + 2, k)]);
        let shape: Vec<[Vector3<f64>; 2]> =
            (0..self.nodes.len()).map(|node| [at(6 * node), at(6 * node + 3)]).collect();
        let most = shape.iter().map(|[u, _]| u.norm()).fold(0.0, f64::max);
        // of the two signs the one whose tip moves towards the positive side
        let tip = shape.last().map_or(0.0, |[u, _]| u[u.iamax()]);
        let scale = if most > 0.0 { tip.signum() / most } else { 1.0 };
        NaturalMode {
            frequency: square.sqrt() / std::f64::consts::TAU,
            shape: shape.into_iter().map(|both| both.map(|v| v * scale)).collect(),
        }
    }
}

impl<T: Number> Chain<T> {
    /// Mass matrix of each shape in the axes of space.
    pub(super) fn inertia(&self) -> Vec<Option<SMatrix<T, 12, 12>>> {
        self.pieces.iter().map(|piece| piece.as_ref().map(consistent_mass)).collect()
    }

    /// M x: forces and moments at the nodes.
    pub(super) fn inertia_forces(
        &self,
        inertia: &[Option<SMatrix<T, 12, 12>>],
        x: &DMatrix<T>,
    ) -> DMatrix<T> {
        let mut forces = DMatrix::zeros(x.nrows(), x.ncols());
        for (k, element) in self.elements.iter().enumerate() {
            if let Some(mass) = &inertia[element.shape] {
                let mut own = forces.rows_mut(6 * k, 12);
                own += mass * x.rows(6 * k, 12);
            }
        }
        for (k, node) in self.nodes.iter().enumerate().filter(|(_, node)| node.mass.value() > 0.0) {
            let mut own = forces.rows_mut(6 * k, 3);
            own += x.rows(6 * k, 3) * node.mass;
        }
        forces
    }

    /// F p: motions of the nodes under forces and moments at the nodes.
    pub(super) fn moved_by(&self, forces: &DMatrix<T>) -> DMatrix<T> {
        let mut moved = DMatrix::zeros(forces.nrows(), forces.ncols());
        let mut carried = vec![[Vector3::zeros(); 2]; self.elements.len()];
        for column in 0..forces.ncols() {
            let of_matrix = |matrix: &DMatrix<T>, row: usize| {
                Vector3::new(matrix[(row, column)], matrix[(row + 1, column)], matrix[(row + 2, column)])
            };
            // from the tip: force, and moment about the element's reference point
            let [mut force, mut moment] = [Vector3::zeros(); 2];
            for (k, element) in self.elements.iter().enumerate().rev() {
                let far = self.nodes[k + 1].position;
                force += of_matrix(forces, 6 * (k + 1));
                moment += of_matrix(forces, 6 * (k + 1) + 3);
                let at_reference = moment + (far - element.reference).cross(&force);
                carried[k] = [force, at_reference];
                moment += (far - self.nodes[k].position).cross(&force);
            }
            // from the root
            let [mut u, mut turn] = [Vector3::zeros(); 2];
            for (k, element) in self.elements.iter().enumerate() {
                let (shape, [force, moment]) = (self.shape(element), carried[k]);
                let (near, far) = (self.nodes[k].position, self.nodes[k + 1].position);
                let mut own = [shape.force * force, shape.moment * moment];
                if let Some(coupling) = &shape.coupling {
                    own[0] += coupling * moment;
                    own[1] += coupling.tr_mul(&force);
                }
                u += turn.cross(&(far - near)) + own[0] + own[1].cross(&(far - element.reference));
                turn += own[1];
                moved.fixed_view_mut::<3, 1>(6 * (k + 1), column).copy_from(&u);
                moved.fixed_view_mut::<3, 1>(6 * (k + 1) + 3, column).copy_from(&turn);
            }
        }
        moved
    }
}

/// M φ = λ K φ, λ = 1/ω²: ω² ascending, and φ with φᵀ K φ = 1. The largest λ is found to the last
/// digits, however much faster the other modes are; directions without mass are left out.
fn ritz(stiffness: DMatrix<f64>, mass: DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    /// Share of the largest below which there is nothing.
    const NOTHING: f64 = 1e-14;
    let scale: Vec<f64> = (0..stiffness.nrows()).map(|k| stiffness[(k, k)].max(0.0).sqrt()).collect();
    let of_unit = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            let by = scale[i] * scale[j];
            if by > 0.0 { 0.5 * (matrix[(i, j)] + matrix[(j, i)]) / by } else { 0.0 }
        })
    };
    let energies = of_unit(&stiffness).symmetric_eigen();
    let most = energies.eigenvalues.max();
    let kept: Vec<usize> =
        (0..energies.eigenvalues.len()).filter(|&k| energies.eigenvalues[k] > NOTHING * most).collect();
    if kept.is_empty() || most <= 0.0 {
        return None;
    }
    let mut basis = energies.eigenvectors.select_columns(&kept);
    for (column, &k) in kept.iter().enumerate() {
        basis.column_mut(column).scale_mut(1.0 / energies.eigenvalues[k].sqrt());
    }
    let reduced = basis.tr_mul(&of_unit(&mass)) * &basis;
    let found = (0.5 * (&reduced + reduced.transpose())).symmetric_eigen();
    let largest = found.eigenvalues.max();
    let mut order: Vec<usize> =
        (0..kept.len()).filter(|&k| found.eigenvalues[k] > NOTHING * largest).collect();
    order.sort_by(|&a, &b| found.eigenvalues[b].total_cmp(&found.eigenvalues[a]));
    if order.is_empty() || largest <= 0.0 {
        return None;
    }
    let mut turned = basis * found.eigenvectors.select_columns(&order);
    for (row, scale) in scale.iter().enumerate() {
        turned.row_mut(row).scale_mut(if *scale > 0.0 { 1.0 / scale } else { 0.0 });
    }
    Some((order.iter().map(|&k| 1.0 / found.eigenvalues[k]).collect(), turned))
}

/// Consistent mass of a straight Timoshenko beam (Przemieniecki, Eqs 11.88 and 11.89), in the axes
/// of space; freedoms: displacement and rotation of the near node, then of the far one.
fn consistent_mass<T: Number>(piece: &Piece<T>) -> SMatrix<T, 12, 12> {
    let Piece { profile, length: l, frame, bulge } = *piece;
    let (mass, mut local) = (profile.mass_per_length * l, SMatrix::<T, 12, 12>::zeros());
    // displacement along x turns about y, along y about −x
    for (axis, turn, sign) in [(0, 4, 1.0), (1, 3, -1.0)] {
        // Φ = 12 EI/(κGA L²)
        let (bending, shear) = (profile.bending[1 - axis], profile.shear[axis]);
        let phi = if bending.value() > 0.0 { shear * 12.0 / (bending * l * l) } else { T::zero() };
        let of_mass = mass / (phi + 1.0).powi(2);
        let of_inertia = profile.rotary_inertia[1 - axis] / ((phi + 1.0).powi(2) * l);
        let (m1, m2) =
            (phi * 0.7 + 13.0 / 35.0 + phi * phi / 3.0, phi * 11.0 / 120.0 + 11.0 / 210.0 + phi * phi / 24.0);
        let (m3, m4) =
            (phi * 0.3 + 9.0 / 70.0 + phi * phi / 6.0, phi * 3.0 / 40.0 + 13.0 / 420.0 + phi * phi / 24.0);
        let (m5, m6) =
            (phi / 60.0 + 1.0 / 105.0 + phi * phi / 120.0, phi / 60.0 + 1.0 / 140.0 + phi * phi / 120.0);
        let (r1, r2) = (T::from(1.2), -phi * 0.5 + 0.1);
        let (r3, r4) = (phi / 6.0 + 2.0 / 15.0 + phi * phi / 3.0, phi / 6.0 + 1.0 / 30.0 - phi * phi / 6.0);
        let at = [axis, turn, axis + 6, turn + 6];
        let signs = [T::one(), l * sign, T::one(), l * sign];
        let moving = [[m1, m2, m3, -m4], [m2, m5, m4, -m6], [m3, m4, m1, -m2], [-m4, -m6, -m2, m5]];
        let turning = [[r1, r2, -r1, r2], [r2, r3, -r2, -r4], [-r1, -r2, r1, -r2], [r2, -r4, -r2, r3]];
        for i in 0..4 {
            for j in 0..4 {
                local[(at[i], at[j])] +=
                    (of_mass * moving[i][j] + of_inertia * turning[i][j]) * signs[i] * signs[j];
            }
        }
    }
    let polar = profile.rotary_inertia.into_iter().sum::<T>() * l;
    for (at, amount) in [(2, mass), (5, polar)] {
        for (i, j, share) in [(at, at, 2.0), (at + 6, at + 6, 2.0), (at, at + 6, 1.0), (at + 6, at, 1.0)] {
            local[(i, j)] += amount * share / 6.0;
        }
    }
    // R·B·Rᵀ of each block of three
    let turn = frame.matrix();
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (3 * i, 3 * j))) {
        let block = turn * local.fixed_view::<3, 3>(i, j) * turn.transpose();
        local.fixed_view_mut::<3, 3>(i, j).copy_from(&block);
    }
    bulge.map_or(local, |bulge| moved_aside(&local, &bulge))
}

/// The mass of an arc lies beside its chord by `d`, and moves by u + θ×d: M' = TᵀM T with T = [1
/// −[d]ₓ; 0 1] at both nodes.
fn moved_aside<T: Number>(mass: &SMatrix<T, 12, 12>, d: &Vector3<T>) -> SMatrix<T, 12, 12> {
    let cross = skew(d);
    let mut moved = *mass;
    for node in [0, 6] {
        let shift = moved.fixed_view::<12, 3>(0, node) * cross;
        let mut turns = moved.fixed_view_mut::<12, 3>(0, node + 3);
        turns -= shift;
    }
    for node in [0, 6] {
        let shift = cross.transpose() * moved.fixed_view::<3, 12>(node, 0);
        let mut turns = moved.fixed_view_mut::<3, 12>(node + 3, 0);
        turns -= shift;
    }
    moved
}
