//! A rod on the flange: its drawing, and what gives way of it.

use nalgebra::{Matrix3, Vector3};

use crate::rig::actual::Actual;
use crate::rig::drawing::{Deviation, Drawing};
use crate::rig::tube::Tube;
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, MM};

/// Parts of its weight.
const SLICES: usize = 12;

/// As it is mounted.
#[derive(Debug, Clone, PartialEq)]
pub struct Rod {
    /// What its file states, and how far it is from that.
    pub drawing: Drawing,
    pub actual: Actual,
    /// Deflection of its tip per force on it, and per acceleration of gravity, in {T}.
    pub per_force: Matrix3<f64>,
    pub per_gravity: Matrix3<f64>,
    /// Its weight: mass kg and place in {T}, m.
    pub slices: Vec<(f64, Vector3<f64>)>,
}

impl Rod {
    /// Some steel tube, whose numbers are off by `times` what its file means.
    pub fn drawn(times: f64, random: &mut Random) -> Rod {
        let drawing = Rod::drawing(random);
        let actual = Actual::drawn(&drawing, &[], times, random);
        Rod::of(drawing, actual)
    }

    /// What the file of some rod states.
    pub fn drawing(random: &mut Random) -> Drawing {
        let outer = random.uniform(12.0, 20.0).round();
        let tube = Tube {
            material: "steel",
            youngs_modulus: 200e9,
            shear_modulus: 77e9,
            density: 7900.0,
            outer: outer / 2.0 * MM,
            inner: (outer - 4.0) / 2.0 * MM,
            coefficient: 1.0,
        };
        Drawing {
            legs: [random.uniform(100.0, 200.0).round() * MM, random.uniform(200.0, 500.0).round() * MM],
            gamma: (random.uniform(80.0, 130.0)).round() * DEG,
            bend_radius: 0.0,
            bend_factor: 1.0,
            tubes: [tube.clone(), tube],
            joints: Vec::new(),
            tip_mass: (random.uniform(20.0, 80.0)).round() * 1e-3,
            stated: None,
        }
    }

    /// By its drawing, with a sharp corner, and what it really is.
    pub fn of(drawing: Drawing, actual: Actual) -> Rod {
        let real = actual.rod(&drawing);
        let [l1, l2] = real.legs;
        let body = real.body(&Deviation::default());
        let length = real.length();
        // a small force, so that the rod is linear
        let per = |station: f64| {
            let column = |axis: usize| body.deflection(&Vector3::ith(axis, 1e-2), station, length) / 1e-2;
            Matrix3::from_columns(&[0, 1, 2].map(column))
        };
        let mut weights: Vec<(f64, f64)> = vec![(real.tip_mass, length)];
        for (tube, (from, leg)) in real.tubes.iter().zip([(0.0, l1), (l1, l2)]) {
            let mass = tube.density * tube.area() * leg / SLICES as f64;
            weights.extend((0..SLICES).map(|k| (mass, from + leg * (k as f64 + 0.5) / SLICES as f64)));
        }
        Rod {
            per_force: per(length),
            per_gravity: weights.iter().map(|(mass, station)| per(*station) * *mass).sum(),
            slices: weights.iter().map(|(mass, station)| (*mass, at(&real, *station))).collect(),
            drawing,
            actual,
        }
    }

    /// The ball by the drawing, in {T}, m.
    pub fn tip(&self) -> Vector3<f64> {
        at(&self.drawing, self.drawing.length())
    }
}

/// A station of the centreline in {T}, m.
fn at(drawing: &Drawing, station: f64) -> Vector3<f64> {
    let [l1, _] = drawing.legs;
    match station < l1 {
        true => Vector3::new(0.0, 0.0, station),
        false => {
            let along = Vector3::new(drawing.gamma.sin(), 0.0, -drawing.gamma.cos());
            Vector3::new(0.0, 0.0, l1) + along * (station - l1)
        }
    }
}
