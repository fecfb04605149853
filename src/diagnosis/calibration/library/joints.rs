//! What a joint and its link do besides their geometry.
//!
//! ```text
//! joint_compliance             leverⱼ·c·τⱼ
//! joint_nonlinear_stiffness    leverⱼ·k₂·τⱼ|τⱼ|   or   leverⱼ·k₃·τⱼ³
//! backlash                     leverⱼ·½b·sign(τⱼ)   or, where friction holds the joint, ½b·(direction it came from)
//! encoder_scale                leverⱼ·(s − 1)·qⱼ
//! wrist_coupling, I to J       lever_J·k·q_I
//! link_flexibility             (k·M⊥) × (tip − oⱼ)            M⊥: moment beyond the joint, without what acts about its axis
//! ```
//!
//! Where a robot's masses are unknown its torques are a sum over its links, τⱼ = Σ_k m_k·zⱼ·((p_k − oⱼ) × g), and the compliance
//! has one parameter for every frame beyond the joint: c·m_k·g, rad per metre of horizontal lever.

use nalgebra::Vector3;

use super::{COUPLING, ENCODER_SCALE, JOINT_ANGLE, NotTestable, YIELDING, lack};
use crate::diagnosis::EffectParameter;
use crate::diagnosis::calibration::posture::Posture;
use crate::diagnosis::calibration::scene::{Column, Entry, Scene, entry, linear};
use crate::units::URAD_PER_NM;

const URAD: f64 = 1e-6;
/// Torque relative to the robot's largest below which a joint counts as unloaded.
const NO_TORQUE: f64 = 1e-3;
/// Distance below which frames are at one point and weights have no lever, m.
const ONE_POINT: f64 = 0.01;
/// Joints of a wrist.
const WRIST: usize = 3;

pub(super) fn all(scene: &Scene, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let mut entries = Vec::new();
    let largest: Vec<f64> =
        (0..scene.joint_count()).map(|j| scene.largest(|posture| posture.torque[j])).collect();
    let most = largest.iter().fold(0.0, |a: f64, &b| a.max(b));
    let is_loaded = |&j: &usize| scene.has_masses && most > 0.0 && largest[j] > NO_TORQUE * most;
    let loaded: Vec<usize> = scene.revolute().into_iter().filter(is_loaded).collect();
    if loaded.is_empty() {
        for effect in ["joint_nonlinear_stiffness", "link_flexibility", "gravity_tilt", "backlash"] {
            lacks.push(lack(effect, "the robot file has no masses, so that no torque is known"));
        }
        entries.extend(scene.revolute().into_iter().filter_map(|j| compliance_without_masses(scene, j)));
    }
    for j in loaded {
        entries.extend(of_torque(scene, j, largest[j]));
        entries.extend(link(scene, j));
    }
    for j in scene.revolute() {
        let came_from = scene.turn(j, |_, posture| 0.5 * posture.approach[j]);
        entries.push(one("backlash", format!("joint {}, by approach", j + 1), play(), came_from));
        let mut factor = linear("factor", 1.0, ENCODER_SCALE);
        factor.neutral = 1.0;
        let scaled = scene.turn(j, |_, posture| posture.joints[j]);
        entries.push(one("encoder_scale", format!("joint {}", j + 1), factor, scaled));
    }
    entries.extend(couplings(scene));
    entries
}

fn one(effect: &str, location: String, parameter: EffectParameter, column: Column) -> Entry {
    entry(effect, location, vec![(parameter, column)])
}

fn play() -> EffectParameter {
    linear("play_urad", URAD, JOINT_ANGLE)
}

fn of_torque(scene: &Scene, j: usize, largest: f64) -> [Entry; 4] {
    let name = format!("joint {}", j + 1);
    let turn = |of: fn(f64) -> f64| scene.turn(j, move |_, posture| of(posture.torque[j]));
    let compliance = linear("compliance_urad_per_nm", URAD_PER_NM, YIELDING / largest);
    let quadratic = linear("urad_per_nm2", URAD, YIELDING / largest.powi(2));
    let cubic = linear("urad_per_nm3", URAD, YIELDING / largest.powi(3));
    let (nonlinear, cubic_name) = ("joint_nonlinear_stiffness", format!("{name}, cubic"));
    let sign = |torque: f64| if torque == 0.0 { 0.0 } else { 0.5 * torque.signum() };
    [
        one("joint_compliance", name.clone(), compliance, turn(|torque| torque)),
        one(nonlinear, name.clone(), quadratic, turn(|torque| torque * torque.abs())),
        one(nonlinear, cubic_name, cubic, turn(|torque| torque.powi(3))),
        one("backlash", name, play(), turn(sign)),
    ]
}

fn link(scene: &Scene, j: usize) -> Option<Entry> {
    let across = |moment: &Vector3<f64>, axis: &Vector3<f64>| moment - axis * axis.dot(moment);
    let largest = scene.largest(|posture| across(&posture.moment[j], &posture.axis[j]).norm());
    let column = scene.column(|_, posture| {
        across(&posture.moment[j], &posture.axis[j]).cross(&(posture.tip - posture.origin[j]))
    });
    let bending = linear("bending_urad_per_nm", URAD_PER_NM, YIELDING / largest.max(f64::MIN_POSITIVE));
    (largest > 0.0).then(|| one("link_flexibility", format!("joint {}", j + 1), bending, column))
}

fn compliance_without_masses(scene: &Scene, j: usize) -> Option<Entry> {
    let down = scene.postures.first()?.gravity.try_normalize(0.0)?;
    let beyond: Vec<Option<usize>> = (j + 1..scene.joint_count()).map(Some).chain([None]).collect();
    let point =
        |posture: &Posture, frame: Option<usize>| frame.map_or(posture.flange.origin, |k| posture.origin[k]);
    // frames that are always at one point are one; the outermost stands for all
    let differs = |(at, frame): (usize, &Option<usize>)| {
        let apart = |posture: &Posture| {
            beyond[at + 1..]
                .iter()
                .map(|other| (point(posture, *other) - point(posture, *frame)).norm())
                .fold(f64::INFINITY, f64::min)
        };
        scene.postures.iter().any(|posture| apart(posture) > ONE_POINT)
    };
    let frames: Vec<Option<usize>> = beyond
        .iter()
        .enumerate()
        .filter(|&(at, frame)| differs((at, frame)))
        .map(|(_, frame)| *frame)
        .collect();
    let parameters: Vec<(EffectParameter, Column)> = frames
        .into_iter()
        .filter_map(|frame| {
            // horizontal lever of a force down at the frame, m
            let arm = |posture: &Posture| posture.torque_of(j, &point(posture, frame), &down);
            let largest = scene.largest(arm);
            let name = frame.map_or("flange_urad_per_m".into(), |k| format!("joint_{}_urad_per_m", k + 1));
            let column = scene.turn(j, |_, posture| arm(posture));
            let mut yielding = linear(name, URAD, YIELDING / largest.max(ONE_POINT));
            // drives yield with their torque, never against it
            yielding.bounds.0 = 0.0;
            (largest > ONE_POINT).then_some((yielding, column))
        })
        .collect();
    let location = format!("joint {}, masses unknown", j + 1);
    (!parameters.is_empty()).then(|| entry("joint_compliance", location, parameters))
}

/// Neighbours among the last joints, either driving the other.
fn couplings(scene: &Scene) -> Vec<Entry> {
    let count = scene.joint_count();
    let turning = scene.revolute();
    let pairs = (count.saturating_sub(WRIST)..count.saturating_sub(1)).flat_map(|k| [(k, k + 1), (k + 1, k)]);
    let both = pairs.filter(|(i, j)| turning.contains(i) && turning.contains(j));
    both.map(|(i, j)| {
        let column = scene.turn(j, |_, posture| posture.joints[i]);
        let fraction = linear("fraction", 1.0, COUPLING);
        one("wrist_coupling", format!("joint {} to {}", i + 1, j + 1), fraction, column)
    })
    .collect()
}
