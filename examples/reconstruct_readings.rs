//! Makes `stiffness_data/2.csv` and `5.csv`: rig readings as the paper's figures imply them.
//!
//! `cargo run --example regenerate -- readings` writes both files; a test makes sure that they are
//! what this makes.
//!
//! Published (Improved MultiCal, *Sensors* 23 (2023) 5717, § 5.1, Table 2): loads of 0.5, 1, 1.5
//! and 2 kg with five repeats each; c22(5#)/c22(2#) = 5.9 measured; the lines cross the load axis
//! at 0.09 to 0.11 kg; r_rod = 1.364 (2#) and 1.013 (5#); sensors good to 3 µm with a resolution of
//! 1 µm. Reconstructed: everything else. r22 and r33 of 5# are taken equal; c22 of 2# follows from
//! the ratio 5.9 and its c33 from r_rod; which rod crosses at 0.09 and which at 0.11 kg is a guess;
//! noise is normal with a standard deviation of 3 µm; no creep, no curvature.

#![allow(clippy::unwrap_used)]

use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rodcal::beam::Physics;
use rodcal::compliance::{Compliance, DEFAULT_ELEMENTS};
use rodcal::rod::Rod;
use rodcal::units::STANDARD_GRAVITY;

const LOADS_KG: [f64; 4] = [0.5, 1.0, 1.5, 2.0];
const REPEATS: usize = 5;
const NOISE_UM: f64 = 3.0;
const MEASURED_RATIO_OF_C22: f64 = 5.9;

/// Number of the rod, r_rod, where its lines cross the load axis (kg), seed.
const RODS: [(u32, f64, f64, u64); 2] = [(2, 1.364, 0.11, 2), (5, 1.013, 0.09, 5)];

/// Names and contents of the two files. `project` is the project's directory.
pub fn files(project: &Path) -> Vec<(String, String)> {
    let model = |number: u32| {
        let rod = Rod::read(&project.join(format!("rods/{number}.toml"))).unwrap();
        let c = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS).unwrap().force * 1e6;
        (c[(1, 1)], c[(2, 2)])
    };
    let (steel_22, _) = model(5);
    let measured_22_of_steel = RODS[1].1 * steel_22;
    RODS.iter()
        .map(|&(number, r_rod, crossing_kg, seed)| {
            let (model_22, model_33) = model(number);
            let c22 =
                if number == 5 { measured_22_of_steel } else { measured_22_of_steel / MEASURED_RATIO_OF_C22 };
            let c33 = r_rod * (model_22 + model_33) - c22;
            (format!("stiffness_data/{number}.csv"), readings(number, c22, c33, crossing_kg, seed))
        })
        .collect()
}

fn readings(number: u32, c22: f64, c33: f64, crossing_kg: f64, seed: u64) -> String {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut text = format!(
        "# RECONSTRUCTED readings of rod {number}#, not a recording: made by examples/reconstruct_readings.rs from the figures\n\
         # published in Improved MultiCal, Sensors 2023, 23(12), 5717 (c22 ratio 5.9, friction {crossing_kg} kg, r_rod); seed {seed}.\n\
         # c22 = {c22:.4} um/N, c33 = {c33:.4} um/N, noise {NOISE_UM} um, resolution 1 um.\n\
         axis,load_kg,trial,dy_um,dz_um\n"
    );
    for (axis, compliance) in [("y", c22), ("z", c33)] {
        for trial in 1..=REPEATS {
            for load in LOADS_KG {
                // friction takes the same off every load
                let force = (load - crossing_kg) * STANDARD_GRAVITY;
                let offset = (compliance * force + NOISE_UM * normal(&mut random)).round();
                let cells = if axis == "y" { format!("{offset},") } else { format!(",{offset}") };
                text += &format!("{axis},{load},{trial},{cells}\n");
            }
        }
    }
    text
}

/// A standard normal number (Box and Muller, 1958).
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (1.0 - random.random::<f64>(), random.random());
    (-2.0 * u.ln()).sqrt() * (2.0 * std::f64::consts::PI * v).cos()
}

#[allow(dead_code)]
pub fn main() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, text) in files(project) {
        rodcal::files::write_whole(&project.join(name), text.as_bytes()).unwrap();
    }
}
