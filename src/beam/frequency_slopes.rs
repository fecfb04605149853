//! How the first natural frequency follows the numbers of a rod.
//!
//! A mode x of x = ω² F M x carries the inertia forces p = M x; λ = 1/ω². F and M are symmetric, so
//! that
//!
//! ```text
//! dλ = (pᵀ dF p + λ xᵀ dM x)/(xᵀ M x),    df/f = −dλ/2λ
//! ```
//!
//! (R. L. Fox, M. P. Kapoor, *AIAA J.* 6 (1968) 2426–2429, with flexibilities in the place of
//! stiffnesses). Where two modes have one frequency, as those of a straight round rod, dλ is a
//! matrix of 2 by 2, and the lower frequency follows its larger eigenvalue as the number grows. dF
//! and dM are those of the chain whose numbers carry a derivative.

use nalgebra::{DMatrix, Matrix2};

use super::chain::Chain;
use super::model::{Physics, RodModel};
use super::natural::{ELEMENTS, FEW, NaturalMode};
use crate::dual::Dual;
use crate::error::Result;
use crate::rod::{NominalNumber, Rod};

/// Share by which two frequencies differ that are one.
const SAME: f64 = 1e-7;

impl Rod {
    /// First natural frequency as [`Rod::natural_modes`] has it, Hz, and its derivative by each of
    /// `numbers`, Hz per SI unit of the number; `None` where nothing has mass.
    ///
    /// ```
    /// use rodcal::prelude::*;
    /// use rodcal::rod::NominalNumber;
    ///
    /// let rod = Rod::read("rods/5.toml".as_ref())?;
    /// let moduli = [NominalNumber::YoungsModulus("steel".into()), NominalNumber::ShearModulus("steel".into())];
    /// let (frequency, slopes) = rod.natural_frequency_slopes(&moduli)?.expect("steel has mass");
    /// // f ∝ √stiffness: 1 % of E and G together are 0.5 % of f
    /// let both = slopes[0] * rod.pipe1.material.youngs_modulus + slopes[1] * rod.pipe1.material.shear_modulus;
    /// assert!((both / frequency - 0.5).abs() < 1e-9);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Rod::natural_modes`].
    pub fn natural_frequency_slopes(&self, numbers: &[NominalNumber]) -> Result<Option<(f64, Vec<f64>)>> {
        self.frequency_slopes(numbers, ELEMENTS)
    }

    /// The same of [`Rod::first_frequency`], whose mesh is coarser.
    ///
    /// # Errors
    /// As [`Rod::natural_modes`].
    pub fn first_frequency_slopes(&self, numbers: &[NominalNumber]) -> Result<Option<(f64, Vec<f64>)>> {
        self.frequency_slopes(numbers, FEW)
    }

    fn frequency_slopes(
        &self,
        numbers: &[NominalNumber],
        elements: usize,
    ) -> Result<Option<(f64, Vec<f64>)>> {
        let chain = RodModel::new(self, &Physics::WHOLE, elements, &[])?.chain;
        let modes = chain.natural_modes(2)?;
        let Some(first) = modes.first() else { return Ok(None) };
        let frequency = first.frequency;
        let one = |mode: &&NaturalMode| mode.frequency <= frequency * (1.0 + SAME);
        let shapes: Vec<DMatrix<f64>> = modes.iter().take_while(one).map(freedoms).collect();
        let lambda = (std::f64::consts::TAU * frequency).powi(-2);
        let slope = |number: &NominalNumber| {
            let Some(rod) = self.derivative(number) else { return Ok(0.0) };
            let changed = RodModel::new(&rod, &Physics::WHOLE, elements, &[])?.chain;
            let by = lambda_slope(&chain, &changed, &shapes, lambda);
            Ok(-0.5 * frequency * by / lambda)
        };
        Ok(Some((frequency, numbers.iter().map(slope).collect::<Result<_>>()?)))
    }
}

/// dλ of the slowest of the modes `shapes`, which have one λ.
fn lambda_slope(chain: &Chain, changed: &Chain<Dual>, shapes: &[DMatrix<f64>], lambda: f64) -> f64 {
    let lifted = |x: &DMatrix<f64>| x.map(Dual::from);
    let inertia = chain.inertia();
    let forces: Vec<DMatrix<f64>> = shapes.iter().map(|x| chain.inertia_forces(&inertia, x)).collect();
    let changed_inertia = changed.inertia();
    let eps = |m: DMatrix<Dual>| m.map(|x| x.eps);
    let [of_flexibility, of_mass] = [
        forces.iter().map(|p| eps(changed.moved_by(&lifted(p)))).collect::<Vec<_>>(),
        shapes.iter().map(|x| eps(changed.inertia_forces(&changed_inertia, &lifted(x)))).collect(),
    ];
    let weight = |k: usize| shapes[k].dot(&forces[k]).sqrt();
    let entry = |i: usize, j: usize| {
        (forces[i].dot(&of_flexibility[j]) + lambda * shapes[i].dot(&of_mass[j])) / (weight(i) * weight(j))
    };
    match shapes.len() {
        2 => Matrix2::from_fn(entry).symmetric_eigenvalues().max(),
        _ => entry(0, 0),
    }
}

/// Displacements and rotations of the nodes, one below the other.
fn freedoms(mode: &NaturalMode) -> DMatrix<f64> {
    let all = mode.shape.iter().flat_map(|both| both.iter().flat_map(|v| v.iter().copied()));
    DMatrix::from_iterator(6 * mode.shape.len(), 1, all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::{BendFlexibility, Joint, Pipe};
    use crate::section::Round;

    /// Central difference of fourth order of the frequency of the same mesh.
    fn difference(rod: &Rod, number: &NominalNumber, elements: usize) -> f64 {
        let value = rod.value_of(number).unwrap();
        let step = if value == 0.0 { 1e-7 } else { 2e-4 * value };
        let frequency = |k: f64| {
            let rod = rod.with(number, value + k * step);
            let model = RodModel::new(&rod, &Physics::WHOLE, elements, &[]).unwrap();
            model.chain.natural_modes(1).unwrap()[0].frequency
        };
        (8.0 * (frequency(1.0) - frequency(-1.0)) - (frequency(2.0) - frequency(-2.0))) / (12.0 * step)
    }

    #[test]
    fn slopes_are_those_of_differences() {
        let plain = Rod::read("rods/2.toml".as_ref()).unwrap();
        let joint = Joint { name: "glue".into(), station: 0.11, bending: 1e-4, torsion: 2e-4 };
        let steel = crate::material::Material::isotropic("steel", 200e9, 0.3, 7900.0);
        let collar = Pipe::new(Round::tube(0.06, 0.05), steel);
        let mut bent = plain.clone().with_bend(0.06, BendFlexibility::VonKarman).with_angle(1.9);
        bent.masses[0].station += 0.004;
        for rod in [
            plain,
            bent.with_mass("ring", 0.31, 0.1).with_joint(joint).with_sleeve("collar", 0.4, 0.47, collar),
        ] {
            let numbers = rod.numbers();
            let coarse = (FEW, rod.first_frequency_slopes(&numbers));
            let fine = (ELEMENTS, rod.natural_frequency_slopes(&numbers));
            for (elements, found) in [coarse, fine] {
                let (frequency, slopes) = found.unwrap().unwrap();
                for (number, slope) in numbers.iter().zip(slopes) {
                    let expected = difference(&rod, number, elements);
                    // of 1 % of the number, to 1e-6 of what that does, and to 1e-10 of the
                    // frequency
                    let size = 0.01 * rod.value_of(number).unwrap().abs().max(1e-6);
                    let off = (slope - expected).abs() * size;
                    assert!(
                        off < 1e-6 * expected.abs() * size + 1e-10 * frequency,
                        "{number}: {slope} {expected}"
                    );
                }
            }
        }
    }

    /// Both modes of a straight tube slow down alike: f ∝ D at a bore that grows with it.
    #[test]
    fn two_modes_of_one_frequency_have_a_slope() {
        let rod = Rod::read("rods/5.toml".as_ref()).unwrap().with_angle(std::f64::consts::PI);
        let numbers = [NominalNumber::LengthL1, NominalNumber::LengthL2];
        let (_, slopes) = rod.first_frequency_slopes(&numbers).unwrap().unwrap();
        assert!((slopes[0] / slopes[1] - 1.0).abs() < 1e-4, "{slopes:?}");
        let expected = difference(&rod, &numbers[0], FEW);
        assert!((slopes[0] / expected - 1.0).abs() < 1e-6, "{slopes:?} {expected}");
    }
}
