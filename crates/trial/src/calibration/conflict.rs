//! Effects that imitate each other, pair by pair.

use super::draw::{clamp_pose, library, sensor, spring};
use super::effect::Effect;
use super::setup::Needs;
use super::site::Site;
use crate::chance::log_uniform;
use rodcal_base::statistics::Random;
use rodcal_base::units::URAD;

/// What is taken for what: either side is concealed in turn.
const PAIRS: [&str; 5] = [
    "read-back lag or play",
    "tip mass or soft wrist",
    "contact spring or clamp pose",
    "base not level or compliant",
    "contact spring or sensor scale",
];
/// How compliant a soft wrist is, rad/(N·m).
const WRIST: (f64, f64) = (30.0 * URAD, 100.0 * URAD);

/// One side of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Conflict {
    pair: usize,
    is_second: bool,
}

impl Conflict {
    /// Of case number `number`: all sides in turn.
    pub fn of(number: usize) -> Conflict {
        let side = number % (2 * PAIRS.len());
        Conflict { pair: side / 2, is_second: side % 2 == 1 }
    }

    /// For people.
    pub fn name(self) -> &'static str {
        PAIRS[self.pair]
    }

    /// What a recording must have so that both sides do something.
    pub fn needs(self) -> Needs {
        let none = Needs::default();
        match self.pair {
            0 => none,
            1 => Needs { masses: Some(true), rod: true, ..none },
            2 | 4 => Needs { device: Some(0), rod: true, ..none },
            _ => Needs { masses: Some(true), ..none },
        }
    }

    /// As large as it may be.
    pub fn effect(self, site: &Site, random: &mut Random) -> Effect {
        match (self.pair, self.is_second) {
            (0, false) => library(12, site, random),
            (0, true) => library(1, site, random),
            (1, false) => library(11, site, random),
            (1, true) => {
                let joint = site.nominal.len() - 3 + random.index(2);
                Effect::Compliance { joint, compliance: log_uniform(random, WRIST.0, WRIST.1) }
            }
            (2 | 4, false) => spring(site, 300.0, random),
            (2, true) => clamp_pose(site, random),
            (4, true) => sensor(site, 0.2, random),
            (_, false) => library(20, site, random),
            (_, true) => library(21, site, random),
        }
    }

    /// False for a soft wrist, which is as soft as it is: a calibration has drives that may be so.
    pub fn is_scaled(self) -> bool {
        (self.pair, self.is_second) != (1, true)
    }
}
