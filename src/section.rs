//! Cross-sections of pipes: tubes and rounds, rectangles and boxes, and others by their constants.
//!
//! Axes: a rod's two pipes lie in the X–Z plane of {T}. A section has one axis Y, normal to that
//! plane, and one that lies in it, across the centreline. `I_y` is the second moment of area
//! *about Y*: it resists bending **in** the rod's plane. `I_z` is the one about the axis in the
//! plane (for pipe II of an L that is Z): it resists bending **out of** the plane. Both axes must
//! be principal axes of the section.

mod contraction;
mod rectangle;
mod round;

pub use rectangle::Rectangle;
pub use round::Round;

use crate::dual::Number;

/// The cross-section of a pipe.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Section<T = f64> {
    /// A tube or a solid round.
    Round(Round<T>),
    /// A solid rectangle or a box.
    Rectangle(Rectangle<T>),
    /// Any other section, by its constants.
    General(General<T>),
}

/// A section that is known by its constants, as a handbook or a profile's maker states them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct General<T = f64> {
    /// Area A, m².
    pub area: T,
    /// Second moment of area about Y, for bending in the rod's plane, I_y, m⁴.
    pub iy: T,
    /// Second moment of area about the axis in the rod's plane, for bending out of it, I_z, m⁴.
    pub iz: T,
    /// Torsion constant J, m⁴.
    pub torsion_constant: T,
    /// Shear coefficient κ for both directions, dimensionless.
    pub shear_coefficient: T,
}

impl<T: Number> Section<T> {
    /// Area A, m².
    pub fn area(&self) -> T {
        match self {
            Section::Round(round) => round.area(),
            Section::Rectangle(rectangle) => rectangle.area(),
            Section::General(general) => general.area,
        }
    }

    /// I_y and I_z, m⁴: for bending in the rod's plane and out of it.
    ///
    /// ```
    /// use rodcal::section::{Rectangle, Round, Section};
    ///
    /// // 20 mm high in the rod's plane, 10 mm wide across it
    /// let [iy, iz] = Section::from(Rectangle::solid(0.010, 0.020)).second_moments();
    /// assert_eq!(iy, 0.010 * 0.020f64.powi(3) / 12.0);
    /// assert_eq!(iz, 0.020 * 0.010f64.powi(3) / 12.0);
    /// let [iy, iz] = Section::from(Round::solid(0.01)).second_moments();
    /// assert_eq!(iy, iz);
    /// ```
    pub fn second_moments(&self) -> [T; 2] {
        match self {
            Section::Round(round) => [round.second_moment(); 2],
            Section::Rectangle(rectangle) => rectangle.second_moments(),
            Section::General(general) => [general.iy, general.iz],
        }
    }

    /// The section turned by 90° about the centreline.
    pub fn turned(self) -> Section<T> {
        match self {
            Section::Round(_) => self,
            Section::Rectangle(own) => {
                Section::Rectangle(Rectangle { width: own.height, height: own.width, wall: own.wall })
            }
            Section::General(own) => Section::General(General { iy: own.iz, iz: own.iy, ..own }),
        }
    }

    /// I_y, m⁴, for bending in the rod's plane: the first of [`Section::second_moments`].
    pub fn second_moment(&self) -> T {
        self.second_moments()[0]
    }

    /// Torsion constant J, m⁴.
    pub fn torsion_constant(&self) -> T {
        match self {
            Section::Round(round) => round.torsion_constant(),
            Section::Rectangle(rectangle) => rectangle.torsion_constant(),
            Section::General(general) => general.torsion_constant,
        }
    }

    /// Shear coefficients κ for forces in the rod's plane and out of it, dimensionless, of a
    /// material with `ratio` e = E/G and Poisson's ratio ν: [`Round::shear_coefficient`] or
    /// [`Rectangle::shear_coefficients`]; those of a general section are as stated.
    pub fn shear_coefficients(&self, ratio: T, poisson_ratio: T) -> [T; 2] {
        match self {
            Section::Round(round) => [round.shear_coefficient(ratio, poisson_ratio); 2],
            Section::Rectangle(rectangle) => rectangle.shear_coefficients(ratio, poisson_ratio),
            Section::General(general) => [general.shear_coefficient; 2],
        }
    }

    /// The round, if it is one.
    pub fn as_round(&self) -> Option<&Round<T>> {
        match self {
            Section::Round(round) => Some(round),
            _ => None,
        }
    }

    /// Wall thickness, m, where the section has one: of a tube or a box.
    pub fn wall(&self) -> Option<T> {
        match self {
            Section::Round(round) => Some(round.wall()),
            Section::Rectangle(rectangle) => rectangle.wall,
            Section::General(_) => None,
        }
    }

    /// Extent in the rod's plane, across the centreline, m; of a general section that of the
    /// rectangle of the same area and I_y.
    pub fn height(&self) -> T {
        match self {
            Section::Round(round) => round.outer_diameter,
            Section::Rectangle(rectangle) => rectangle.height,
            Section::General(general) => (general.iy * 12.0 / general.area).sqrt(),
        }
    }
}

impl From<Round> for Section {
    fn from(round: Round) -> Section {
        Section::Round(round)
    }
}

impl From<Rectangle> for Section {
    fn from(rectangle: Rectangle) -> Section {
        Section::Rectangle(rectangle)
    }
}

impl From<General> for Section {
    fn from(general: General) -> Section {
        Section::General(general)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_general_section_with_the_constants_of_a_rectangle_is_that_rectangle() {
        let bar = Section::from(Rectangle::solid(0.010, 0.020));
        let [iy, iz] = bar.second_moments();
        let general = Section::from(General {
            area: bar.area(),
            iy,
            iz,
            torsion_constant: bar.torsion_constant(),
            shear_coefficient: 5.0 / 6.0,
        });
        assert_eq!(general.second_moments(), bar.second_moments());
        assert_relative_eq!(general.height(), 0.020, max_relative = 1e-14);
        assert_eq!(general.shear_coefficients(2.6, 0.3), [5.0 / 6.0; 2]);
        assert_eq!(general.shear_coefficients(2.6, 0.3)[0], 5.0 / 6.0);
        assert_eq!((general.wall(), bar.wall(), bar.as_round()), (None, None, None));
    }

    #[test]
    fn absurd_moduli_leave_the_coefficients_positive() {
        for section in [
            Section::from(Round::tube(0.03, 0.029)),
            Section::from(Rectangle::solid(0.01, 0.02)),
            Section::from(Rectangle::hollow(0.01, 0.02, 0.001)),
        ] {
            for ratio in [1e-6, 0.1, 1.0, 1e9] {
                let [a, b] = section.shear_coefficients(ratio, 0.3);
                assert!(a > 0.0 && b > 0.0 && a < 2.0 && b < 2.0, "{section:?} {ratio} {a} {b}");
            }
        }
    }
}
