//! Rectangles, solid or with a wall of constant thickness (boxes).

use std::f64::consts::PI;

use super::contraction::contraction;
use crate::dual::Number;

/// A rectangle, `height` in the rod's plane and `width` across it.
///
/// ```
/// use rodcal::section::Rectangle;
///
/// // Timoshenko & Goodier, Theory of Elasticity, art. 109: a square has J = 0.1406 a⁴
/// let square = Rectangle::solid(0.010, 0.010);
/// assert!((square.torsion_constant() / 0.010f64.powi(4) - 0.1406).abs() < 5e-5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle<T = f64> {
    /// Extent along Y, normal to the rod's plane, b, m.
    pub width: T,
    /// Extent in the rod's plane, across the centreline, h, m.
    pub height: T,
    /// Wall thickness t, m; `None` for a solid rectangle.
    pub wall: Option<T>,
}

impl Rectangle {
    /// A solid rectangle; m.
    pub fn solid(width: f64, height: f64) -> Rectangle {
        Rectangle { width, height, wall: None }
    }

    /// A box of constant wall thickness; outer dimensions, m.
    pub fn hollow(width: f64, height: f64, wall: f64) -> Rectangle {
        Rectangle { width, height, wall: Some(wall) }
    }
}

impl<T: Number> Rectangle<T> {
    /// Area bh, less that of the hole, m².
    pub fn area(&self) -> T {
        let (b, h) = (self.width, self.height);
        match self.wall {
            None => b * h,
            // 2t(b + h − 2t), which does not cancel on thin walls
            Some(t) => t * 2.0 * (b + h - t * 2.0),
        }
    }

    /// I_y = bh³/12 and I_z = hb³/12, less those of the hole, m⁴.
    pub fn second_moments(&self) -> [T; 2] {
        let (b, h) = (self.width, self.height);
        let hole = self.wall.map_or([T::zero(); 2], |t| [b - t * 2.0, h - t * 2.0]);
        let about = |across: T, along: T| across * along.powi(3) / 12.0;
        [about(b, h) - about(hole[0], hole[1]), about(h, b) - about(hole[1], hole[0])]
    }

    /// Torsion constant J, m⁴.
    ///
    /// Solid, with long side a and short side c:
    /// J = ac³/3 · (1 − (192/π⁵)(c/a) Σ tanh(nπa/2c)/n⁵), n = 1, 3, 5 …
    /// (S. P. Timoshenko, J. N. Goodier, *Theory of Elasticity*, 3rd ed., art. 109).
    /// A box: J = 4A_m²t/s + st³/3, A_m the area and s the length of the wall's middle line
    /// (Bredt; the second term is what the wall resists by itself), 2 % too small with a wall of a
    /// twentieth of the side.
    pub fn torsion_constant(&self) -> T {
        if let Some(t) = self.wall {
            let (b, h) = (self.width - t, self.height - t);
            let middle_line = (b + h) * 2.0;
            return (b * h).powi(2) * 4.0 * t / middle_line + middle_line * t.powi(3) / 3.0;
        }
        let (long, short) = (self.width.larger(self.height), self.height.smaller(self.width));
        // the terms fall like n⁻⁵; beyond n = 401 their sum is below 1e-12
        let series: T = (0..200)
            .map(|k| f64::from(2 * k + 1))
            .map(|n| (long * (n * PI) / (short * 2.0)).tanh() / n.powi(5))
            .sum();
        let left = -((short / long) * (192.0 / PI.powi(5)) * series) + 1.0;
        long * short.powi(3) / 3.0 * left
    }

    /// Shear coefficients κ for forces in the rod's plane and out of it, dimensionless, of a
    /// material with `ratio` e = E/G and Poisson's ratio ν.
    ///
    /// - Solid, whatever its sides: κ = 5e/(6e − ν); isotropic 10(1+ν)/(12+11ν).
    /// - Box: 1/κ = (A − 2(ν/e)(A − B))/(10(1+3m)²), A = 12 + 72m + 150m² + 120m³ + 30m⁴,
    ///   B = 11 + 66m + 135m² + 100m³, m = b/h of the wall's middle line, b across the force and h
    ///   along it. It is the limit of thin walls: 3 % too small with a wall of a twentieth of the
    ///   side.
    ///
    /// Source: G. R. Cowper, J. Appl. Mech. 33 (1966) 335–340, rectangle and thin-walled box. They
    /// are linear in ν/(1+ν) there; ν/(1+ν) = 2ν/e carries them over to other e (docs/beam.md).
    pub fn shear_coefficients(&self, ratio: T, poisson_ratio: T) -> [T; 2] {
        let s = contraction(ratio, poisson_ratio);
        let Some(t) = self.wall else { return [T::from(5.0) / (-s + 6.0); 2] };
        let (b, h) = (self.width - t, self.height - t);
        [thin_box(b, h, s), thin_box(h, b, s)]
    }
}

/// κ of a thin-walled box with sides `across` and `along` the force, s = ν/e.
fn thin_box<T: Number>(across: T, along: T, s: T) -> T {
    let m = across / along;
    // Cowper's denominator is A + νB, here with walls of one thickness
    let a = m * (m * (m * (m * 30.0 + 120.0) + 150.0) + 72.0) + 12.0;
    let b = m * (m * (m * 100.0 + 135.0) + 66.0) + 11.0;
    (m * 3.0 + 1.0).powi(2) * 10.0 / (a - s * 2.0 * (a - b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn torsion_of_rectangles_is_that_of_the_textbooks() {
        // Timoshenko & Goodier, art. 109, table: k1 of J = k1·a·c³ by a/c
        for (ratio, k1) in [(1.0, 0.1406), (1.5, 0.196), (2.0, 0.229), (3.0, 0.263), (10.0, 0.312)] {
            for bar in [Rectangle::solid(0.01, 0.01 * ratio), Rectangle::solid(0.01 * ratio, 0.01)] {
                assert!((bar.torsion_constant() / (0.01f64.powi(4) * ratio) - k1).abs() < 6e-4, "{ratio}");
            }
        }
        let strip = Rectangle::solid(1.0, 1e-6);
        assert_relative_eq!(strip.torsion_constant(), 1e-18 / 3.0, max_relative = 1e-5);
    }

    #[test]
    fn a_box_is_its_outside_less_its_hole() {
        let (outer, hole) = (Rectangle::solid(0.02, 0.03), Rectangle::solid(0.016, 0.026));
        let hollow = Rectangle::hollow(0.02, 0.03, 0.002);
        assert_relative_eq!(hollow.area(), outer.area() - hole.area(), max_relative = 1e-12);
        for k in 0..2 {
            let expected = outer.second_moments()[k] - hole.second_moments()[k];
            assert_relative_eq!(hollow.second_moments()[k], expected, max_relative = 1e-12);
        }
    }
}
