//! A rod as its drawing states it, and the body it really is.

use std::f64::consts::PI;
use std::fmt::Write;

use super::cosserat::{Body, Hinge, Piece};
use super::tube::Tube;
use super::uncertainty::Uncertainty;
use rodcal_base::units::{GPA, GRAM, MM};

/// Pieces to a wave along the rod.
const CUTS: f64 = 12.0;

/// A bent rod of two pipes as in the rod file, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Flange to corner and corner to ball centre, where the centrelines meet, m.
    pub legs: [f64; 2],
    /// Inside angle between the pipes, rad.
    pub gamma: f64,
    /// Radius of the bend, m; 0 is a sharp corner.
    pub bend_radius: f64,
    /// Flexibility factor of the bend that the file states.
    pub bend_factor: f64,
    /// The pipes; the bend is bent from the first.
    pub tubes: [Tube; 2],
    /// Joints that the file declares, without compliance: name, station m.
    pub joints: Vec<(String, f64)>,
    /// Mass at the tip, kg.
    pub tip_mass: f64,
    /// How well its numbers are known; `None`: the file leaves that to the defaults.
    pub stated: Option<Uncertainty>,
}

/// What is different from the drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// Factor on E and G.
    pub stiffness: f64,
    /// Factor on G besides.
    pub shear: f64,
    /// Factors on E and G of each pipe besides; the bend is of the first.
    pub pipes: [f64; 2],
    /// Flexibility factor of the bend; `None`: the drawing's.
    pub bend: Option<f64>,
    /// Joints that give way.
    pub hinges: Vec<Hinge>,
    /// Bending × (1 + a·sin(2πs/λ + φ)) along the rod: a, λ m, φ.
    pub wave: Option<[f64; 3]>,
}

impl Default for Deviation {
    fn default() -> Self {
        Deviation { stiffness: 1.0, shear: 1.0, pipes: [1.0; 2], bend: None, hinges: Vec::new(), wave: None }
    }
}

impl Drawing {
    /// Angle by which the second pipe leaves the first one's direction, rad.
    fn turn(&self) -> f64 {
        PI - self.gamma
    }

    /// Length of the arc, m.
    pub fn arc(&self) -> f64 {
        self.bend_radius * self.turn()
    }

    /// What the bend takes off each leg, R·tan(turn/2), m.
    pub fn tangent(&self) -> f64 {
        self.bend_radius * (self.turn() / 2.0).tan()
    }

    /// From the flange to the tip along the centreline, m.
    pub fn length(&self) -> f64 {
        self.legs[0] + self.legs[1] - 2.0 * self.tangent() + self.arc()
    }

    /// How far the rod bends and twists per moment at its tip, ∫ds/EI and ∫ds/GJ, rad/(N·m).
    pub fn rotation(&self) -> [f64; 2] {
        let pieces = self.body(&Deviation::default()).pieces;
        [
            pieces.iter().map(|piece| piece.length * piece.flexibility.bending).sum(),
            pieces.iter().map(|piece| piece.length * piece.flexibility.torsion).sum(),
        ]
    }

    /// The rod as it really is.
    pub fn body(&self, deviation: &Deviation) -> Body {
        let tangent = self.tangent();
        let [first, second] = [0, 1].map(|k| {
            let factor = deviation.stiffness * deviation.pipes[k];
            let flexibility = self.tubes[k].flexibility(factor, factor * deviation.shear);
            Piece { length: self.legs[k] - tangent, corner: 0.0, curvature: 0.0, flexibility }
        });
        let mut pieces = vec![first.clone()];
        match self.arc() > 0.0 {
            true => {
                let mut bend = Piece { length: self.arc(), curvature: 1.0 / self.bend_radius, ..first };
                bend.flexibility.bending *= deviation.bend.unwrap_or(self.bend_factor);
                pieces.extend([bend, second]);
            }
            false => pieces.push(Piece { corner: self.turn(), ..second }),
        }
        if let Some(wave) = deviation.wave {
            pieces = wavy(&pieces, wave);
        }
        Body { pieces, hinges: deviation.hinges.clone() }
    }

    /// True where the bend ends before its legs do and no tube is thicker than it is long.
    pub fn is_possible(&self) -> bool {
        let shortest = self.legs[0].min(self.legs[1]);
        let thickest = self.tubes[0].outer.max(self.tubes[1].outer);
        self.tangent() < 0.95 * shortest && 2.0 * thickest < self.length()
    }

    /// How well the numbers of one of its tubes are known.
    pub fn uncertainty_of(&self, tube: &Tube) -> Uncertainty {
        self.stated.unwrap_or_else(|| Uncertainty::default_of(tube))
    }

    /// The rod file; `name` is its name.
    pub fn toml(&self, name: &str) -> String {
        let [l1, l2] = self.legs.map(|leg| rounded(leg / MM, 4));
        let mut text = format!(
            "# SIMULATED rod of a concealed-effect trial, not a real one.\nname = \"{name}\"\n[geometry]\nl1_mm = {l1}\nl2_mm = {l2}\ngamma_deg = {}\n",
            rounded(self.gamma.to_degrees(), 6)
        );
        if self.arc() > 0.0 {
            let _ = writeln!(text, "bend_radius_mm = {}", rounded(self.bend_radius / MM, 4));
            if self.bend_factor != 1.0 {
                let _ = writeln!(text, "bend_flexibility = {}", self.bend_factor);
            }
        }
        let [first, second] = &self.tubes;
        let mut materials = vec![first];
        if second.material != first.material {
            materials.push(second);
        }
        for tube in materials {
            let _ = write!(
                text,
                "[material.{}]\nyoungs_modulus_gpa = {}\nshear_modulus_gpa = {}\ndensity_kg_m3 = {}\n",
                tube.material,
                rounded(tube.youngs_modulus / GPA, 6),
                rounded(tube.shear_modulus / GPA, 6),
                tube.density
            );
        }
        for (pipe, tube) in ["pipe1", "pipe2"].iter().zip(&self.tubes) {
            let [outer, inner] = [tube.outer, tube.inner].map(|radius| rounded(2.0 * radius / MM, 4));
            let material = tube.material;
            let _ = write!(
                text,
                "[{pipe}]\nmaterial = \"{material}\"\nouter_diameter_mm = {outer}\ninner_diameter_mm = {inner}\n"
            );
        }
        let _ = write!(text, "[tip]\nmass_g = {}\n", rounded(self.tip_mass / GRAM, 3));
        for (name, station) in &self.joints {
            let _ = write!(
                text,
                "[[joint]]\nname = \"{name}\"\nstation_mm = {}\nbending_urad_per_nm = 0.0\ntorsion_urad_per_nm = 0.0\n",
                rounded(station / MM, 4)
            );
        }
        if let Some(known) = &self.stated {
            let percent = |share: f64| rounded(100.0 * share, 3);
            let _ = write!(
                text,
                "[standard_uncertainty]\nyoungs_modulus_percent = {}\nshear_modulus_percent = {}\nshear_coefficient_percent = {}\ndiameter_mm = {}\nlength_mm = {}\n",
                percent(known.youngs_modulus),
                percent(known.shear_modulus),
                percent(known.shear_coefficient),
                rounded(known.diameter / MM, 4),
                rounded(known.length / MM, 4)
            );
        }
        text
    }
}

/// Pieces cut into short ones, whose bending follows a wave along the rod.
fn wavy(pieces: &[Piece], [amplitude, period, phase]: [f64; 3]) -> Vec<Piece> {
    let mut cut = Vec::new();
    let mut start = 0.0;
    for piece in pieces {
        let count = (piece.length / (period / CUTS)).ceil().max(1.0);
        let length = piece.length / count;
        for k in 0..count as usize {
            let middle = start + (k as f64 + 0.5) * length;
            let mut short = Piece { length, ..piece.clone() };
            short.corner = if k == 0 { piece.corner } else { 0.0 };
            short.flexibility.bending *=
                1.0 + amplitude * (std::f64::consts::TAU * middle / period + phase).sin();
            cut.push(short);
        }
        start += piece.length;
    }
    cut
}

/// To so many decimals, without the rounding of a change of units.
pub fn rounded(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    (value * scale).round() / scale
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::rig) fn l_shape(bend_radius: f64) -> Drawing {
        let tube = Tube {
            material: "steel",
            youngs_modulus: 193e9,
            shear_modulus: 74.8e9,
            density: 7930.0,
            outer: 8e-3,
            inner: 6e-3,
            coefficient: 1.0,
        };
        Drawing {
            legs: [0.15, 0.525],
            gamma: PI / 2.0,
            bend_radius,
            bend_factor: 1.0,
            tubes: [tube.clone(), tube],
            joints: vec![("sleeve".into(), 0.205)],
            tip_mass: 0.055,
            stated: None,
        }
    }

    #[test]
    fn the_documented_bend_is_met() {
        // docs/rod-file.md: 16 × 12 mm, legs 300 and 450 mm, bend of 40 mm: 206.41 and 267.73 µm/N
        // along z and y, with von Kármán's factor 214.08 and 271.58
        let rod = Drawing { legs: [0.3, 0.45], ..l_shape(0.04) };
        let length = rod.length();
        assert!((length - (0.75 - 0.08 + 0.02 * PI)).abs() < 1e-12);
        let micrometres = |bend: Option<f64>, axis: usize| {
            let body = rod.body(&Deviation { bend, ..Deviation::default() });
            body.deflection(&nalgebra::Vector3::ith(axis, 1e-3), length, length)[axis] / 1e-9
        };
        let oval = Some(rod.tubes[0].ovalisation(0.04));
        for (bend, axis, expected) in
            [(None, 2, 206.41), (None, 1, 267.73), (oval, 2, 214.08), (oval, 1, 271.58)]
        {
            let found = micrometres(bend, axis);
            assert!((found / expected - 1.0).abs() < 3e-4, "{axis} {found} {expected}");
        }
    }

    #[test]
    fn a_wall_that_varies_is_as_flexible_on_average() {
        let rod = l_shape(0.0);
        let bends = |wave: Option<[f64; 3]>| -> f64 {
            let body = rod.body(&Deviation { wave, ..Deviation::default() });
            body.pieces.iter().map(|piece| piece.length * piece.flexibility.bending).sum()
        };
        // whole periods on either pipe
        let wavy = bends(Some([0.2, 0.075, 0.3]));
        assert!((wavy / bends(None) - 1.0).abs() < 1e-9, "{wavy}");
        assert!(bends(Some([0.2, 1.35, 0.0])) > 1.1 * bends(None));
    }

    #[test]
    fn a_drawing_is_a_rod_file() {
        let text = l_shape(0.04).toml("case");
        assert!(text.starts_with("# SIMULATED") && text.contains("l2_mm = 525\n"), "{text}");
        assert!(text.contains("outer_diameter_mm = 16\n") && text.contains("station_mm = 205\n"));
    }
}
