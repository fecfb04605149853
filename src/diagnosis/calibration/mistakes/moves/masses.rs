//! Masses and centres that a robot's table, or the tip of a rod's file, may mean in another unit.
//!
//! A unit is worth a look only where the numbers are possible in it: the links of an arm of reach r
//! weigh m with m/r³ of 2 to 1000 kg/m³ (UR5 30, TX90 110, M-2000iA 110), and the centre of a link
//! is not farther from its frame than the longest link is long.

use super::super::super::effects::mistakes::UNIT_MISTAKE;
use super::robots::is_table;
use super::{Reading, UNUSUAL, exact};
use crate::calibration::campaign::Campaign;
use crate::robot::{Body, Robot};
use crate::rod::Rod;
use crate::units::{MM, POUND};

/// Mass of the links over the third power of the reach, kg/m³.
const USUAL_DENSITY: (f64, f64) = (2.0, 1000.0);
/// Centres are at most so many times as far from their frames as the longest link is long.
const FARTHEST: f64 = 1.5;
/// Masses of a file that are wrong are so by less than this factor.
const NEAR: f64 = 5.0;
/// No ball and holder weighs more, kg.
const MOST_AT_TIP: f64 = 20.0;
/// Ounce, kg.
const OUNCE: f64 = POUND / 16.0;

/// A rod as its file may be meant, with what is said of it.
pub struct TipReading {
    pub rod: Rod,
    pub factor: f64,
    pub cure: String,
    pub why: &'static str,
    pub log_prior: f64,
}

/// A robot in another unit, with what is to be less probable than it.
pub struct MassReading {
    pub reading: Reading,
    /// Robots with masses between it and the file, and as far beyond it.
    pub nearby: Vec<Robot>,
}

/// Robots whose masses, or centres of mass, are in another unit.
///
/// Masses of a file may be wrong by half and more. So where a unit is no more than that away, the
/// poses must show it rather than any other factor.
pub fn robots(campaign: &Campaign) -> Vec<MassReading> {
    if !is_table(campaign) || !campaign.robot.has_masses() {
        return Vec::new();
    }
    let masses = [
        (1e-3, "Divide mass_kg of all joints by 1000", "they are in grams, not in kilograms"),
        (POUND, "Multiply mass_kg of all joints by 0.4536", "they are in pounds, not in kilograms"),
    ];
    let centres = [
        (1e3, "Multiply com_mm of all joints by 1000", "they are in metres, not in millimetres"),
        (10.0, "Multiply com_mm of all joints by 10", "they are in centimetres, not in millimetres"),
        (25.4, "Multiply com_mm of all joints by 25.4", "they are in inches, not in millimetres"),
    ];
    let with = |change: &dyn Fn(&mut Body)| {
        let mut robot = campaign.robot.clone();
        robot.joints.iter_mut().filter_map(|joint| joint.body.as_mut()).for_each(change);
        robot
    };
    let reading = |key: &str, robot: Robot, factor: f64, (cure, why): (&str, &'static str)| Reading {
        robot,
        effect: &UNIT_MISTAKE,
        key: key.into(),
        log_prior: UNUSUAL,
        estimates: exact("factor", factor),
        cure: cure.into(),
        why,
    };
    let times = |factor: f64| with(&|body| body.mass *= factor);
    let of_masses = masses.into_iter().map(|(factor, cure, why)| {
        let is_near = factor > 1.0 / NEAR;
        let powers: &[f64] = if is_near { &[0.5, 1.5] } else { &[] };
        let nearby = powers.iter().map(|power| times(factor.powf(*power))).collect();
        MassReading { reading: reading("mass_kg", times(factor), factor, (cure, why)), nearby }
    });
    let of_centres = centres.into_iter().map(|(factor, cure, why)| {
        let centre = with(&|body| body.centre *= factor);
        MassReading { reading: reading("com_mm", centre, factor, (cure, why)), nearby: Vec::new() }
    });
    of_masses.chain(of_centres).filter(|own| is_possible(&own.reading.robot)).collect()
}

/// Rods with the mass at the tip in another unit.
pub fn tips(campaign: &Campaign) -> Vec<TipReading> {
    let Some(rod) = campaign.rod.as_ref().filter(|rod| rod.tip_mass > 0.0) else { return Vec::new() };
    let units = [
        (1e3, "Multiply tip.mass_g by 1000", "it is in kilograms, not in grams"),
        (1e3 * OUNCE, "Multiply tip.mass_g by 28.35", "it is in ounces, not in grams"),
        (1e3 * POUND, "Multiply tip.mass_g by 453.6", "it is in pounds, not in grams"),
    ];
    let with = |(factor, cure, why): (f64, &str, &'static str)| {
        let rod = Rod { tip_mass: factor * rod.tip_mass, ..rod.clone() };
        let is_possible = rod.tip_mass < MOST_AT_TIP;
        is_possible.then(|| TipReading { rod, factor, cure: cure.into(), why, log_prior: UNUSUAL })
    };
    units.into_iter().filter_map(with).collect()
}

/// True where links weigh what links weigh, about where links are.
fn is_possible(robot: &Robot) -> bool {
    let lengths = || robot.joints.iter().map(|joint| joint.link.a.hypot(joint.link.d));
    let (reach, longest) = (lengths().sum::<f64>(), lengths().fold(MM, f64::max));
    let bodies = || robot.joints.iter().filter_map(|joint| joint.body);
    let density = bodies().map(|body| body.mass).sum::<f64>() / reach.powi(3);
    let farthest = bodies().map(|body| body.centre.norm()).fold(0.0, f64::max);
    (USUAL_DENSITY.0..USUAL_DENSITY.1).contains(&density) && farthest < FARTHEST * longest
}
