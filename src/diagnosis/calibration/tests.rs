//! Columns against a robot that is moved for it, and effects that are put into simulated campaigns
//! by such robots.

mod another_rod;
mod beside;
mod changed;
mod changing;
mod coarse_angles;
mod columns;
mod descriptions;
mod device;
mod evidence;
mod finding;
mod happened;
mod in_order;
mod laws;
mod level;
mod load_change;
mod loose;
mod next;
mod recorded;
mod scatter;
mod sensors;
mod tails;
mod transfer;
mod turned;
mod unfollowed;
mod unnamed;
mod validated;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use nalgebra::{DVector, Vector3};

use super::diagnose::prepared::Prepared;
use super::effects::registry;
use super::model::entry::Entry;
use super::model::{Context, LinearTerms};
use super::*;
use crate::calibration::Calibration;
use crate::calibration::Campaign;
use crate::calibration::campaign::{Recording, Targets};
use crate::calibration::simulate::{Plan, campaign_files, simulate};
use crate::calibration::{Mode, Options, calibrate};
use crate::compliance::{Compliance, DEFAULT_ELEMENTS};
use crate::inference::{Candidate, Evidence, ForwardModel, Location, Term, Whitening};
use crate::robot::Robot;
use crate::rod::Rod;
use crate::statistics::Random;
use crate::units::UM;

const ROBOT: &str = include_str!("../../../robots/tx90.toml");
const ROD: &str = include_str!("../../../rods/5.toml");

/// A TX90 with rod 5# on five clamps, without any noise: of each size one, which is made once.
fn clamps(poses_per_clamp: usize) -> Campaign {
    static MADE: Mutex<BTreeMap<usize, Arc<OnceLock<Campaign>>>> = Mutex::new(BTreeMap::new());
    let own = MADE.lock().unwrap_or_else(PoisonError::into_inner).entry(poses_per_clamp).or_default().clone();
    own.get_or_init(|| simulated(poses_per_clamp)).clone()
}

fn simulated(poses_per_clamp: usize) -> Campaign {
    with_rods(ROD, ROD, Plan { poses_per_clamp, sensor_noise: 0.0, repeatability: 0.0, ..Plan::default() })
}

/// A campaign that was recorded with the rod `actual` and has the file `stated`.
fn with_rods(actual: &str, stated: &str, plan: Plan) -> Campaign {
    let robot = Robot::from_text("tx90.toml", ROBOT, None, None).unwrap();
    let rod = Rod::from_toml("rod", actual).unwrap();
    let model = Compliance::of_model(&rod, &crate::beam::Physics::default(), DEFAULT_ELEMENTS).unwrap();
    let simulation = simulate(&robot, &rod, &model, &plan).unwrap();
    let files = campaign_files(&simulation, "builtin:tx90", "rod.toml");
    let find = |wanted: &str| match wanted {
        "rod.toml" => stated.to_owned(),
        _ => files.iter().find(|(name, _)| name == wanted).unwrap().1.clone(),
    };
    Campaign::from_texts("campaign.toml", &find("campaign.toml"), &|name| Ok(find(name))).unwrap()
}

/// The campaign with a displacement of every row and with noise, m.
fn recorded(campaign: &Campaign, by: &dyn Fn(usize) -> Vector3<f64>, noise: f64, seed: u64) -> Campaign {
    let mut random = Random::seeded(seed, 0);
    let mut recorded = campaign.clone();
    let Targets::Points(points) = &mut recorded.measurements.targets else { panic!("no points") };
    for (row, point) in points.iter_mut().enumerate() {
        *point += by(row) + Vector3::from_fn(|_, _| noise * random.normal());
    }
    recorded
}

/// Places of `rows` poses that a tracker saw.
fn tracked(rows: usize, seen: &dyn Fn(usize, &Vector3<f64>) -> Vector3<f64>) -> Campaign {
    let robot = Robot::from_text("tx90.toml", ROBOT, None, None).unwrap();
    let tool = Vector3::new(0.06, 0.01, 0.12);
    let mut random = Random::seeded(12, 0);
    let mut recording = Recording::new(6);
    for row in 0..rows {
        let q: Vec<f64> = (0..6).map(|_| random.uniform(-1.7, 1.7)).collect();
        let tip = robot.flange_at(&q).point(&tool);
        let noise = Vector3::from_fn(|_, _| 15.0 * UM * random.normal());
        recording.add(&q, seen(row, &tip) + noise).unwrap();
    }
    Campaign::new(robot, recording).unwrap().with_tool(tool)
}

fn find(model: &CalibrationModel, effect: &str, location: &str) -> usize {
    let is_it = |c: &Candidate| c.effect.name == effect && c.location.to_string() == location;
    model.candidates().iter().position(is_it).unwrap_or_else(|| {
        let same = model.candidates().iter().filter(|c| c.effect.name == effect);
        let places: Vec<String> = same.map(|c| c.location.to_string()).take(9).collect();
        panic!("no {effect} at {location}: {places:?}")
    })
}

/// The model of a campaign, and what it leaves as numbers.
fn modelled(campaign: &Campaign, mode: Mode) -> (CalibrationModel<'_>, Evidence) {
    let calibration = calibrate(campaign, mode, &Options::default()).unwrap();
    CalibrationModel::new(campaign, calibration).unwrap()
}

/// All candidates of a campaign, whatever of them its calibration would absorb.
fn entries(context: &Context) -> Vec<Entry> {
    let mut entries = registry::candidates(context).0;
    entries.extend(nonparametric::all(context));
    entries
}
