//! **rodcal**: how much a bent measuring rod bends, how accurate a robot is once that is
//! compensated, and which physics a model left out.
//!
//! Everything inside is in SI units and `f64`; units appear as suffixes of keys and columns in
//! files (`l1_mm`, `dy_um`) and nowhere else. Nothing prints or panics; warnings are data, and
//! every error says where it is and what would be right. [`prelude`] has what most programs need.
//!
//! Frames: {W} world, {0} robot base, {T} flange (tool frame, pipe I along z, both pipes in its
//! x–z plane). The paper is *Improved MultiCal*, Sensors 2023, 23(12), 5717.
//!
//! # From a rod to its compliance C^F
//!
//! ```
//! use rodcal::prelude::*;
//!
//! let steel = Material::isotropic("steel", 193e9, 0.29, 7930.0);
//! let rod = Rod::new("5#", 0.150, 0.525, Pipe::new(Round::tube(0.032, 0.030), steel))
//!     .with_tip_mass(0.060)
//!     .checked()?;
//! let compliance = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS)?;
//! let c22 = compliance.force[(1, 1)]; // along y per newton along y
//! assert!((c22 / 1e-6 - 45.6).abs() < 0.1, "{c22}");
//! // the paper's Table 2: c_rod = 403.7 µm; the tube is reconstructed
//! assert!((compliance.index(paper_contact_force()) / 403.7e-6 - 1.0).abs() < 0.015);
//! # Ok::<(), rodcal::Error>(())
//! ```
//!
//! # From readings on a rig to r_rod
//!
//! ```
//! use rodcal::prelude::*;
//!
//! const ROD: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/rods/5.toml"));
//! const CSV: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/stiffness_data/5.csv"));
//! let rod = Rod::from_toml("rods/5.toml", ROD)?;
//! let readings = Readings::from_text("stiffness_data/5.csv", CSV)?;
//! let fit = rig::fit(&readings, Some(&rod), &rig::Options::default())?;
//! let measured = fit.measured.expect("there is a rod to compare with");
//! // Table 2: r_rod = 1.013, measured over modelled compliance
//! assert!((measured.rod_ratio.value - 1.013).abs() < 0.005, "{:?}", measured.rod_ratio);
//! # Ok::<(), rodcal::Error>(())
//! ```
//!
//! # From a campaign to a calibrated robot
//!
//! ```
//! use rodcal::prelude::*;
//!
//! // simulated: the rod is 1.013 times as compliant as its model, the noise of a coordinate 18 µm
//! let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
//! let calibration = calibrate(&campaign, Mode::Meas, &Options::default())?;
//! assert!(calibration.is_converged);
//! assert_eq!(calibration.parameters.len(), 32); // the paper's Table 1
//! assert!((calibration.noise.pooled - 18e-6).abs() < 4e-6, "{}", calibration.noise.pooled);
//! let validation = calibration.validation.as_ref().expect("the campaign has validation poses");
//! assert!(validation.summary.mean < 150e-6, "{}", validation.summary.mean);
//! let (name, _text) = write_back(&campaign, &calibration)?;
//! assert_eq!(name, "calibrated.toml");
//! # Ok::<(), rodcal::Error>(())
//! ```
//!
//! # From a recording to what its model left out
//!
//! ```
//! use rodcal::diagnosis::rig::diagnose;
//! use rodcal::prelude::*;
//!
//! // reconstructed with 0.09 kg (0.88 N) of friction in the slide
//! let rod = Rod::read("rods/5.toml".as_ref())?;
//! let readings = Readings::read("stiffness_data/5.csv".as_ref())?;
//! let found = diagnose(&readings, Some(&rod))?;
//! let friction = &found.diagnosis.findings[0];
//! assert_eq!((friction.effect.name, friction.location.to_string().as_str()), ("friction", "slide"));
//! let force = friction.quantity("force_n").expect("friction is a force"); // with its 95 % interval
//! assert!((force.value - 0.91).abs() < 0.1 && force.low < 0.88 && force.high > 0.88, "{force:?}");
//! // nothing was read while unloading, so that an offset of the load explains the readings as well
//! assert_eq!(friction.rivals[0].effect.name, "load_offset");
//! # Ok::<(), rodcal::Error>(())
//! ```

pub mod answer;
pub mod beam;
pub mod calibration;
pub mod compliance;
pub mod design;
pub mod diagnosis;
pub mod inference;
pub mod material;
pub mod prelude;
pub mod report;
pub mod rig;
pub mod robot;
pub mod rod;
pub mod section;

// The ground floor has a crate of its own (`crates/base`); its rooms keep their names here.
pub use rodcal_base::units;
#[doc(hidden)]
pub use rodcal_base::{
    delimited, dual, error, expression, files, least_squares, limits, linalg, linear_program, optimal_design,
    parallel, spatial, statistics, toml_text,
};

pub use error::{Error, Result};
