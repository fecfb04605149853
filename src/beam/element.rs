//! The elements: straight and circular Timoshenko beams and rotational springs, as flexibilities.
//!
//! An element is described by how its far end moves while its near end is held. Force `F` and
//! moment `M` of everything beyond it are taken at the element's reference point c (its midpoint),
//! and so are the far end's displacement and rotation, as if c were rigidly attached to it:
//!
//! ```text
//! u = A·F + C·M + U·a        A  m/N        C  1/N = rad/N       U  m per m/s²
//! θ = Cᵀ·F + B·M + V·a       B  rad/(N·m)                       V  rad per m/s²
//! ```
//!
//! with the element's own weight under the acceleration field a. Every term is the exact integral
//! along the centreline of the section's flexibilities (principle of virtual forces; S. Timoshenko,
//! *Strength of Materials* I, 3rd ed., §§ 73–79), so that the number of elements does not change
//! the result. In a straight element C = 0: force and moment at the midpoint do not interact.

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::dual::{Number, about_y};
use crate::spatial::{product, rotated, skew};

/// Flexibilities of a cross-section per unit length, and its mass.
///
/// Local axes: z along the centreline, x and y principal axes of the section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile<T = f64> {
    /// 1/EA, 1/N.
    pub axial: T,
    /// 1/κGA for shear along x and y, 1/N; 0 in Euler–Bernoulli theory.
    pub shear: [T; 2],
    /// 1/EI for bending about x and y, 1/(N·m²).
    pub bending: [T; 2],
    /// 1/GJ, 1/(N·m²).
    pub torsion: T,
    /// Mass per length, kg/m.
    pub mass_per_length: T,
    /// Moments of inertia per length about x and y, ρI, kg·m: what turns with the section resists.
    pub rotary_inertia: [T; 2],
}

impl<T: Number> Profile<T> {
    /// Two sections that share every strain: their stiffnesses add up.
    pub fn beside(&self, other: &Profile<T>) -> Profile<T> {
        // 1/(1/a + 1/b); what the physics leaves out is 0 in both
        let both = |a: T, b: T| if (a + b).value() > 0.0 { a * b / (a + b) } else { T::zero() };
        let pair = |a: [T; 2], b: [T; 2]| [both(a[0], b[0]), both(a[1], b[1])];
        let sum = |a: [T; 2], b: [T; 2]| [a[0] + b[0], a[1] + b[1]];
        Profile {
            axial: both(self.axial, other.axial),
            shear: pair(self.shear, other.shear),
            bending: pair(self.bending, other.bending),
            torsion: both(self.torsion, other.torsion),
            mass_per_length: self.mass_per_length + other.mass_per_length,
            rotary_inertia: sum(self.rotary_inertia, other.rotary_inertia),
        }
    }

    /// Flexibility per length to a force in local axes, 1/N.
    fn force(&self) -> Matrix3<T> {
        Matrix3::from_diagonal(&Vector3::new(self.shear[0], self.shear[1], self.axial))
    }

    /// Flexibility per length to a moment in local axes, 1/(N·m²).
    fn moment(&self) -> Matrix3<T> {
        Matrix3::from_diagonal(&Vector3::new(self.bending[0], self.bending[1], self.torsion))
    }
}

/// The matrices of the module's equation, in the frame in which they are needed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shape<T = f64> {
    /// A, m/N.
    pub force: Matrix3<T>,
    /// C, rad/N; none where force and moment do not interact.
    pub coupling: Option<Matrix3<T>>,
    /// B, rad/(N·m).
    pub moment: Matrix3<T>,
    /// U, m per m/s².
    pub weight_translation: Matrix3<T>,
    /// V, rad per m/s².
    pub weight_rotation: Matrix3<T>,
    /// Mass, kg.
    pub mass: T,
    /// Centre of mass seen from the reference point, m.
    pub mass_centre: Vector3<T>,
}

impl<T: Number> Shape<T> {
    /// A straight element of `length` (m) along the local z axis, reference at its midpoint.
    pub fn straight(profile: &Profile<T>, length: T) -> Self {
        let (l, mass) = (length, profile.mass_per_length * length);
        // A = L·(shear, axial) + L³/12·bending: a force at the midpoint bends both halves like
        // cantilevers; a force along x bends about y and the other way round
        let bending = Vector3::new(profile.bending[1], profile.bending[0], T::zero());
        let force = profile.force() * l + Matrix3::from_diagonal(&(bending * (l.powi(3) / 12.0)));
        // B = L·(bending, torsion)
        let moment = profile.moment() * l;
        Shape {
            force,
            coupling: None,
            moment,
            // the mean force of its own weight is half of it: U = A·m/2
            weight_translation: force * (mass / 2.0),
            // the mean moment of its own weight is (L²/6)(t × q) with q = m a/L: V = B·[t]ₓ·mL/6
            weight_rotation: product(&moment, &skew(&ahead())) * (mass * l / 6.0),
            mass,
            mass_centre: Vector3::zeros(),
        }
    }

    /// A circular arc of `radius` (m) and `angle` (rad, > 0), reference at its midpoint, where the
    /// local z axis is its tangent; it bends from z towards x.
    pub fn arc(profile: &Profile<T>, radius: T, angle: T) -> Self {
        let half = angle / 2.0;
        let mass_per_angle = profile.mass_per_length * radius;
        // r(α) = R (1 − cos α, 0, sin α), the tangent there is (sin α, 0, cos α)
        let point = |a: T| Vector3::new((a / 2.0).sin().powi(2) * 2.0, T::zero(), a.sin()) * radius;
        // ∫ r dβ from a to b = R (d − sin b + sin a, 0, cos a − cos b) with d = b − a and m = (a +
        // b)/2, written without differences of nearly equal numbers, for a flat arc has a large R
        // and small angles
        let point_integral = |a: T, b: T| {
            let (d, m) = (b - a, (a + b) / 2.0);
            let x = d * ((m / 2.0).sin().powi(2) * 2.0 + m.cos() * one_minus_sinc(d / 2.0));
            Vector3::new(x, T::zero(), m.sin() * 2.0 * (d / 2.0).sin()) * radius
        };

        let mut coupling = Matrix3::zeros();
        let mut shape = Shape {
            force: Matrix3::zeros(),
            coupling: None,
            moment: Matrix3::zeros(),
            weight_translation: Matrix3::zeros(),
            weight_rotation: Matrix3::zeros(),
            mass: mass_per_angle * angle,
            mass_centre: point_integral(-half, half) / angle,
        };
        for (a, da) in gauss_points(-half, half) {
            let ds = radius * da;
            let local = about_y(a);
            let (section_force, section_moment) =
                (rotated(&profile.force(), &local) * ds, rotated(&profile.moment(), &local) * ds);
            // A load at the reference point has the moment M − r×F here, and a rotation here moves
            // the reference point by θ×(−r) = r×θ.
            let lever = skew(&point(a));
            let lever_moment = lever * section_moment;
            shape.force += section_force - lever_moment * lever;
            coupling += lever_moment;
            shape.moment += section_moment;
            // the weight of the part beyond: μ·a, with the first moment h = ∫ (r(β) − r(α)) μ dβ
            // about this point
            let beyond = mass_per_angle * (half - a);
            let first_moment = point_integral(a, half) * mass_per_angle - point(a) * beyond;
            let weight_moment = skew(&first_moment);
            shape.weight_translation += section_force * beyond + lever_moment * weight_moment;
            shape.weight_rotation += section_moment * weight_moment;
        }
        shape.coupling = Some(coupling);
        shape
    }

    /// A spring of no length with the local z axis as its axis; `bending` and `torsion` in
    /// rad/(N·m).
    pub fn spring(bending: T, torsion: T) -> Self {
        Shape {
            force: Matrix3::zeros(),
            coupling: None,
            moment: Matrix3::from_diagonal(&Vector3::new(bending, bending, torsion)),
            weight_translation: Matrix3::zeros(),
            weight_rotation: Matrix3::zeros(),
            mass: T::zero(),
            mass_centre: Vector3::zeros(),
        }
    }

    /// The same element, its local frame turned by `rotation`.
    pub fn turned(&self, rotation: &Rotation3<T>) -> Self {
        Shape {
            force: rotated(&self.force, rotation),
            coupling: self.coupling.map(|coupling| rotated(&coupling, rotation)),
            moment: rotated(&self.moment, rotation),
            weight_translation: rotated(&self.weight_translation, rotation),
            weight_rotation: rotated(&self.weight_rotation, rotation),
            mass: self.mass,
            mass_centre: rotation * self.mass_centre,
        }
    }
}

/// The local z axis.
pub(super) fn ahead<T: Number>() -> Vector3<T> {
    Vector3::new(T::zero(), T::zero(), T::one())
}

/// 1 − sin(x)/x, by its series where the difference would cancel.
fn one_minus_sinc<T: Number>(x: T) -> T {
    let x2 = x * x;
    if x2.value() < 0.01 {
        // x²/6 − x⁴/120 + x⁶/5040 − x⁸/362880 + …; the next term is below 1e-16 of the first
        let mut sum = T::one();
        for denominator in [110.0, 72.0, 42.0, 20.0] {
            sum = -(x2 / denominator * sum) + 1.0;
        }
        x2 / 6.0 * sum
    } else {
        -(x.sin() / x) + 1.0
    }
}

/// Gauss–Legendre points and weights on [from, to]: eight for every 45°, where an arc's integrands
/// (products of at most four sines) are integrated to rounding.
fn gauss_points<T: Number>(from: T, to: T) -> impl Iterator<Item = (T, T)> {
    // Abramowitz & Stegun, Table 25.4, n = 8
    const ABSCISSAE: [f64; 4] =
        [0.1834346424956498, 0.525532409916329, 0.7966664774136267, 0.9602898564975363];
    const WEIGHTS: [f64; 4] = [0.362683783378362, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763];
    let panels = ((to - from).value() / std::f64::consts::FRAC_PI_4 - 1e-9).ceil().max(1.0);
    let half = (to - from) / panels / 2.0;
    (0..panels as u32).flat_map(move |panel| {
        let middle = from + half * f64::from(2 * panel + 1);
        ABSCISSAE
            .into_iter()
            .zip(WEIGHTS)
            .flat_map(move |(x, w)| [(middle - half * x, half * w), (middle + half * x, half * w)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROFILE: Profile = Profile {
        axial: 1e-7,
        shear: [4e-7, 4e-7],
        bending: [2e-3, 3e-3],
        torsion: 5e-3,
        mass_per_length: 0.7,
        rotary_inertia: [0.0; 2],
    };

    #[test]
    fn gauss_points_integrate_a_fourth_harmonic_over_half_a_turn() {
        let integral: f64 = gauss_points(0.0, 3.0).map(|(a, w)| w * (4.0 * a).cos()).sum();
        assert!((integral - 12f64.sin() / 4.0).abs() < 1e-13);
    }

    #[test]
    fn one_minus_sinc_is_smooth_where_its_two_forms_meet() {
        let direct = |x: f64| 1.0 - x.sin() / x;
        assert!((one_minus_sinc(0.0999999) / direct(0.0999999) - 1.0).abs() < 1e-12);
        assert_eq!(one_minus_sinc(0.5), direct(0.5));
        assert!((one_minus_sinc(1e-5) / (1e-10 / 6.0) - 1.0).abs() < 1e-10);
    }

    /// An arc of radius L/φ tends to the straight element of length L as φ → 0; the difference is
    /// O(φ).
    #[test]
    fn a_flat_arc_is_a_straight_element() {
        let (length, angle) = (0.3, 1e-6);
        let (arc, straight) =
            (Shape::arc(&PROFILE, length / angle, angle), Shape::straight(&PROFILE, length));
        let pairs = [
            (arc.force, straight.force),
            (arc.coupling.unwrap_or_default(), straight.coupling.unwrap_or_default()),
            (arc.moment, straight.moment),
            (arc.weight_translation, straight.weight_translation),
            (arc.weight_rotation, straight.weight_rotation),
        ];
        for (a, s) in pairs {
            assert!((a - s).norm() <= 1e-5 * s.norm().max(straight.moment.norm() * length), "{a} {s}");
        }
        assert!((arc.mass - straight.mass).abs() < 1e-15);
    }
}
