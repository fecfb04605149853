//! Readings and rods made from known numbers.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rodcal::Result;
use rodcal::beam::Physics;
use rodcal::least_squares::Robust;
use rodcal::rig::readings::Readings;
use rodcal::rig::{self, Fit, Options};
use rodcal::rod::Rod;
use rodcal::units::UM;

/// What the closed form of [`Tube`] contains.
pub const EULER_BERNOULLI: Physics = Physics::WHOLE.with_axial(false).with_shear(false);

/// Two pipes of one tube, sharp corner, γ = 90°.
#[derive(Clone, Copy)]
pub struct Tube {
    pub e_gpa: f64,
    pub g_gpa: f64,
    pub l1: f64,
    pub l2: f64,
}

pub const STEEL: Tube = Tube { e_gpa: 200.0, g_gpa: 80.0, l1: 0.3, l2: 0.45 };
const OUTER: f64 = 0.020;
const INNER: f64 = 0.016;

/// The paper's Eq 15, written out from the bending moments; µm/N.
impl Tube {
    pub fn ei(&self) -> f64 {
        self.e_gpa * 1e9 * std::f64::consts::PI / 64.0 * (OUTER.powi(4) - INNER.powi(4))
    }

    fn gj(&self) -> f64 {
        self.g_gpa * 1e9 * std::f64::consts::PI / 32.0 * (OUTER.powi(4) - INNER.powi(4))
    }

    pub fn c11(&self) -> f64 {
        self.l1.powi(3) / (3.0 * self.ei()) / UM
    }

    pub fn c13(&self) -> f64 {
        -self.l1.powi(2) * self.l2 / (2.0 * self.ei()) / UM
    }

    pub fn c22(&self) -> f64 {
        let bending = (self.l1.powi(3) + self.l2.powi(3)) / (3.0 * self.ei());
        (bending + self.l1 * self.l2.powi(2) / self.gj()) / UM
    }

    pub fn c33(&self) -> f64 {
        (self.l2.powi(3) / 3.0 + self.l1 * self.l2.powi(2)) / self.ei() / UM
    }

    /// The slope along the load.
    pub fn truth(&self, axis: &'static str) -> Truth {
        let slope = match axis.trim_start_matches('-') {
            "x" => self.c11(),
            "y" => self.c22(),
            _ => self.c33(),
        };
        Truth { axis, slope, offset: 0.0 }
    }
}

pub fn rod_text(tube: &Tube) -> String {
    let (l1, l2, od, id) = (tube.l1 * 1e3, tube.l2 * 1e3, OUTER * 1e3, INNER * 1e3);
    let pipe = format!("material = \"tube\"\nouter_diameter_mm = {od}\ninner_diameter_mm = {id}\n");
    format!(
        "name = \"made\"\n[geometry]\nl1_mm = {l1}\nl2_mm = {l2}\n\
         [material.tube]\nyoungs_modulus_gpa = {}\nshear_modulus_gpa = {}\ndensity_kg_m3 = 7900.0\n\
         [pipe1]\n{pipe}[pipe2]\n{pipe}[tip]\nmass_g = 50.0\n",
        tube.e_gpa, tube.g_gpa
    )
}

pub fn rod(tube: &Tube) -> Rod {
    Rod::from_toml("made.toml", &rod_text(tube)).unwrap()
}

/// One line: load direction, slope along it (µm/N) and error of the zero (µm, along the positive
/// axis).
#[derive(Clone, Copy)]
pub struct Truth {
    pub axis: &'static str,
    pub slope: f64,
    pub offset: f64,
}

/// How a recording is made. Lengths in µm, forces in N.
#[derive(Clone)]
pub struct Rig {
    pub loads: Vec<f64>,
    pub trials: usize,
    pub unload: bool,
    pub friction: f64,
    pub noise: f64,
    pub resolution: f64,
    /// Standard deviation of the offset that a trial's readings share.
    pub trial_offset: f64,
    /// Standard deviation of a trial's relative error of slope.
    pub trial_slope: f64,
    /// Curvature, µm/N².
    pub curvature: f64,
}

impl Default for Rig {
    fn default() -> Self {
        Rig {
            loads: vec![5.0, 10.0, 15.0, 20.0],
            trials: 5,
            unload: false,
            friction: 0.0,
            noise: 3.0,
            resolution: 1.0,
            trial_offset: 0.0,
            trial_slope: 0.0,
            curvature: 0.0,
        }
    }
}

impl Rig {
    /// Σ(F − F̄)² over the loads.
    pub fn spread(&self) -> f64 {
        let mean = self.loads.iter().sum::<f64>() / self.loads.len() as f64;
        self.loads.iter().map(|load| (load - mean) * (load - mean)).sum()
    }
}

/// A file of readings: every line of `truths` in every trial.
pub fn readings(rig: &Rig, truths: &[Truth], seed: u64) -> String {
    let mut random = random(seed);
    let mut text = "axis,load_n,trial,phase,dx_um,dy_um,dz_um\n".to_owned();
    for truth in truths {
        let (sign, axis) = match truth.axis.strip_prefix('-') {
            Some(axis) => (-1.0, axis),
            None => (1.0, truth.axis),
        };
        for trial in 1..=rig.trials {
            let shift = rig.trial_offset * normal(&mut random);
            let slope = truth.slope * (1.0 + rig.trial_slope * normal(&mut random));
            let up = rig.loads.iter().map(|&load| (load, "load", -rig.friction));
            let down = rig.loads.iter().rev().map(|&load| (load, "unload", rig.friction));
            for (load, phase, slide) in up.chain(down.filter(|_| rig.unload)) {
                let pure = sign * (slope * (load + slide) + rig.curvature * load * load);
                let read = pure + truth.offset + shift + rig.noise * normal(&mut random);
                let shown = if rig.resolution > 0.0 {
                    (read / rig.resolution).round() * rig.resolution
                } else {
                    read
                };
                let cells = match axis {
                    "x" => format!("{shown},,"),
                    "y" => format!(",{shown},"),
                    _ => format!(",,{shown}"),
                };
                text += &format!("{},{load},{trial},{phase},{cells}\n", truth.axis);
            }
        }
    }
    text
}

pub fn random(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// A standard normal number: Marsaglia's polar method.
pub fn normal(random: &mut ChaCha8Rng) -> f64 {
    loop {
        let (u, v) = (2.0 * random.random::<f64>() - 1.0, 2.0 * random.random::<f64>() - 1.0);
        let s = u * u + v * v;
        if s > 0.0 && s < 1.0 {
            return u * (-2.0 * s.ln() / s).sqrt();
        }
    }
}

/// The fit of a line alone.
pub fn fit(text: &str) -> Fit {
    fit_with(text, None, &Options::default())
}

/// The fit of a rod by the closed form's physics.
pub fn with_rod(text: &str, rod: &Rod, robust: Robust) -> Fit {
    fit_with(
        text,
        Some(rod),
        &Options::default().with_physics(EULER_BERNOULLI).with_elements(4).with_robust(robust),
    )
}

pub fn try_with_rod(text: &str, rod: &Rod) -> Result<Fit> {
    rig::fit(&Readings::from_text("rig.csv", text)?, Some(rod), &Options::default())
}

pub fn fit_with(text: &str, rod: Option<&Rod>, options: &Options) -> Fit {
    rig::fit(&Readings::from_text("rig.csv", text).unwrap(), rod, options).unwrap()
}
