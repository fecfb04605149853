//! Robot files of every kind become the chain that they describe, and are written back without
//! loss.

mod product;
mod tables;
mod tx90;
mod urdfs;
mod written;

use nalgebra::Vector3;
use rodcal::robot::Robot;
use rodcal::spatial::Pose;

/// The embedded TX90.
fn tx90() -> Robot {
    let (file, text) = Robot::builtin("tx90").expect("the program carries it");
    Robot::from_text(file, text, None, None).expect(file)
}

/// Largest difference of any entry, rotations and metres alike.
fn difference(a: &Pose, b: &Pose) -> f64 {
    let turned = (a.rotation - b.rotation).abs().max();
    turned.max((a.origin - b.origin).abs().max())
}

/// Numbers between −1 and 1 that are the same every time: a linear congruential generator (Knuth,
/// MMIX).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn angles(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.roll() * std::f64::consts::PI).collect()
    }

    fn vector(&mut self, scale: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.roll() * scale)
    }
}

/// A file that nobody here made, where the folder with them is present.
#[allow(clippy::print_stderr)]
fn real(name: &str) -> Option<String> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/real").join(name);
    let text = std::fs::read_to_string(&path).ok();
    if text.is_none() {
        eprintln!("skipped: there is no ../shared/real/{name}");
    }
    text
}
