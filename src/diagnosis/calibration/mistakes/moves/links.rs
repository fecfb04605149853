//! Robots that the robot file means where the numbers of links are in another convention, or one
//! of them was typed wrongly.
//!
//! ```text
//! of each link, Rz(θ)·Tz(d)·Tx(a)·Rx(α):  −α, α ± 90°;  −a, −d;  a and d exchanged;
//!                                         10·a, a/10, 10·d, d/10
//! of all links:  Rx(α)·Tx(a)·Rz(θ)·Tz(d)  (J. J. Craig, Introduction to Robotics, 1986)
//! ```

use std::f64::consts::FRAC_PI_2;

use super::super::super::effects::mistakes::{FRAME_MISTAKE, SIGN_MISTAKE, SWAP_MISTAKE, TYPING_MISTAKE};
use super::super::draft::Draft;
use super::super::quick::{LoadedRobot, has_failed, left_by};
use super::robots::is_table;
use super::{RARE, Reading, UNUSUAL, exact};
use crate::calibration::campaign::Campaign;
use crate::inference::{Effect, Estimate};
use crate::parallel::in_parallel;
use crate::robot::{Hayati, Robot};
use crate::units::{DEG, MM};

/// Lengths and sines of twists below which a sign or a decimal point says nothing, m.
const LEAST: f64 = 5.0 * MM;
const LEAST_SINE: f64 = 0.05;
/// What the nominal robot leaves must become so much less.
const LESS: f64 = 0.5;

/// A link with another length.
type WithLength = fn(Hayati, f64) -> Hayati;

/// One number, or two, of a link that may be meant in another way.
struct Slip {
    effect: &'static Effect,
    key: &'static str,
    log_prior: f64,
    estimates: Vec<Estimate>,
    /// With `{}` for the joint.
    cure: String,
    why: &'static str,
    link: Hayati,
}

/// What may be meant where the nominal robot is far from fitting, and then comes nearer.
pub fn links(campaign: &Campaign, draft: &Draft, body: &LoadedRobot) -> Vec<Reading> {
    if !is_table(campaign) || !has_failed(draft, body) {
        return Vec::new();
    }
    let robot = &campaign.robot;
    let of_joint = |(j, joint): (usize, &crate::robot::Joint)| {
        slips(&joint.link).into_iter().map(move |slip| {
            let mut robot = robot.clone();
            robot.joints[j].link = slip.link;
            Reading {
                robot,
                effect: slip.effect,
                key: format!("{} of joint {}", slip.key, j + 1),
                log_prior: slip.log_prior,
                estimates: slip.estimates,
                cure: slip.cure.replace("{}", &(j + 1).to_string()),
                why: slip.why,
            }
        })
    };
    let mut all: Vec<Reading> = robot.joints.iter().enumerate().flat_map(of_joint).collect();
    all.push(as_craig(robot));
    let before = left_by(draft, robot, body.reach);
    let left = in_parallel(all.len(), |k| left_by(draft, &all[k].robot, body.reach));
    all.into_iter().zip(left).filter(|(_, left)| *left < LESS * before).map(|(reading, _)| reading).collect()
}

/// All that may have happened to a link.
fn slips(link: &Hayati) -> Vec<Slip> {
    let mut all = Vec::new();
    if link.alpha.sin().abs() > LEAST_SINE {
        all.push(Slip {
            effect: &SIGN_MISTAKE,
            key: "alpha_deg",
            log_prior: 0.0,
            estimates: Vec::new(),
            cure: "Multiply alpha_deg of joint {} by −1".into(),
            why: "its sign is wrong",
            link: Hayati { alpha: -link.alpha, ..*link },
        });
    }
    for quarter in [FRAC_PI_2, -FRAC_PI_2] {
        let alpha = link.alpha + quarter;
        all.push(Slip {
            effect: &TYPING_MISTAKE,
            key: "alpha_deg",
            log_prior: RARE,
            estimates: exact("value", alpha / DEG),
            cure: format!("Write alpha_deg = {:.1} of joint {{}}", alpha / DEG),
            why: "it is off by 90°",
            link: Hayati { alpha, ..*link },
        });
    }
    let with_a: WithLength = |link, a| Hayati { a, ..link };
    let with_d: WithLength = |link, d| Hayati { d, ..link };
    let lengths = [("a_mm", link.a, with_a), ("d_mm", link.d, with_d)];
    for (key, length, with) in lengths.into_iter().filter(|(_, length, _)| length.abs() > LEAST) {
        all.push(Slip {
            effect: &SIGN_MISTAKE,
            key,
            log_prior: 0.0,
            estimates: Vec::new(),
            cure: format!("Multiply {key} of joint {{}} by −1"),
            why: "its sign is wrong",
            link: with(*link, -length),
        });
        for (factor, why) in [(10.0, "a digit is missing"), (0.1, "it has a digit too many")] {
            all.push(Slip {
                effect: &TYPING_MISTAKE,
                key,
                log_prior: UNUSUAL,
                estimates: exact("value", factor * length / MM),
                cure: format!("Multiply {key} of joint {{}} by {factor}"),
                why,
                link: with(*link, factor * length),
            });
        }
    }
    if (link.a - link.d).abs() > LEAST {
        all.push(Slip {
            effect: &SWAP_MISTAKE,
            key: "a_mm and d_mm",
            log_prior: UNUSUAL,
            estimates: Vec::new(),
            cure: "Exchange a_mm and d_mm of joint {}".into(),
            why: "each holds the other",
            link: Hayati { a: link.d, d: link.a, ..*link },
        });
    }
    all
}

/// The robot of a table that turns and moves along x before z: a and α of a joint are those of the
/// joint after it here, and the first ones lie before the first joint.
fn as_craig(given: &Robot) -> Reading {
    let mut robot = given.clone();
    let count = robot.joints.len();
    for j in 0..count {
        let after = given.joints.get(j + 1).map(|joint| joint.link);
        let link = &mut robot.joints[j].link;
        (link.a, link.alpha) = after.map_or((0.0, 0.0), |after| (after.a, after.alpha));
    }
    Reading {
        robot,
        effect: &FRAME_MISTAKE,
        key: "a_mm and alpha_deg".into(),
        log_prior: 0.0,
        estimates: Vec::new(),
        cure: "Write a_mm and alpha_deg of each joint with the joint before it".into(),
        why: "the table is in Craig's convention, in which they come before the joint",
    }
}
