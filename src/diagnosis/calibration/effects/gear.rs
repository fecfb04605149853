//! Errors of gears and encoders as functions of the joint's own angle.
//!
//! ```text
//! harmonic   Jⱼ·(a·sin(n·qⱼ) + b·cos(n·qⱼ))     n cycles per revolution, whole numbers
//! harmonics  the same with n and 2·n together    one gear, one cause
//! wave       Jⱼ·((a + c·u)·sin(n·qⱼ) + (b + d·u)·cos(n·qⱼ))     u ∝ qⱼ − q̄ⱼ, n scanned: gear.rs
//! curve      Jⱼ·f(qⱼ)                            f a smooth curve: cosines.rs
//! ```
//!
//! Two cycles per revolution can be told apart over a range of ρ revolutions if they differ by 1/ρ
//! or so; the scan has steps of half of that, of one half at most, up to 40; c and d reach what
//! lies between. Beyond, only what gears in use have: a strain-wave gear of ratio i has errors of i
//! and 2·i cycles per revolution of its output, and the joint's motor with i.

use std::f64::consts::TAU;

use super::super::model::CalibrationModel;
use super::super::model::cosines::Cosines;
use super::super::model::entry::{Column, linear};
use super::super::model::gear::{CYCLES_OF_PART, Gear, RECORDED_HALF_PEAK_TO_PEAK, RECORDED_RMS};
use super::super::model::law::Law;
use super::super::write_back::correction_table::table;
use super::{CalibrationEffect, Context, Entry, JOINT_ANGLE, Transfer, along, joint_by, law, no_event, nth};
use crate::calibration::campaign::Campaign;
use crate::inference::{
    Candidate, Effect, Estimate, Finding, FindingPart, JointVariable, Kind, NotTestable, Quantity, Reported,
    WrittenTo,
};
use crate::robot;
use crate::units::{capital, significant};

/// Last frequency of the scan, cycles per revolution, and its widest step.
const SCAN: (f64, f64) = (40.0, 0.5);
/// Ratios of strain-wave gears that arms are built with.
const RATIOS: [f64; 8] = [50.0, 51.0, 80.0, 100.0, 101.0, 120.0, 121.0, 160.0];
/// Up to so many cycles per revolution the first overtone is looked for with a harmonic.
const MOST_DOUBLED: u32 = 6;
/// How many times as usual as any other one an error of one and two cycles per revolution is.
const ECCENTRIC: f64 = 5.0;
/// Length scales ℓ of curves, rad, as 1/ℓ: their spectrum falls to 1/√e of its amplitude at √2/ℓ
/// cycles per revolution.
const CURVES: [f64; 5] = [2.0, 4.0, 8.0, 16.0, 32.0];
/// Beyond so many cosines there is no curve: over a wide range a scan sees what is fine. Nor is
/// there one of more than this many for every pose: it would go through them all.
const MOST_COSINES: (usize, f64) = (160, 0.5);

/// A gear or an encoder with an error over its joint's own angle.
pub static TRANSMISSION_ERROR: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "transmission_error",
        kind: Kind::Physics,
        summary: "an error of gear or encoder over the joint's angle",
        formula: "Jⱼ·f(qⱼ): f is a wave of a gear's whole harmonics and ratios, or one with its first overtone, a wave scanned up to \
                  40 cycles per revolution, or a smooth curve of one of five length scales",
        prior: "150 µrad rms: a UR5 shows 60 to 110 µrad, a UR10 220 to 400",
        parameters: &[
            (&["cycles_per_rev"], "frequency of the strongest wave"),
            (&["amplitude_urad"], "its amplitude; of a curve, of a wave of the same rms"),
            (&["second_cycles_per_rev"], "frequency of the next wave"),
            (&["second_amplitude_urad"], "its amplitude"),
            (&["third_cycles_per_rev"], "frequency of the third wave"),
            (&["third_amplitude_urad"], "its amplitude"),
            (&["fourth_cycles_per_rev"], "frequency of the fourth wave"),
            (&["fourth_amplitude_urad"], "its amplitude"),
            (&[RECORDED_RMS], "root mean square of the whole error over the recorded angles"),
            (&[RECORDED_HALF_PEAK_TO_PEAK], "half the way from its lowest value to its highest"),
        ],
        needs: "a joint that turns",
        cause: "an error of its gear or encoder",
        cause_at: |location| format!("an error of the gear or encoder of {}", location.place()),
        written_to: WrittenTo::Model,
        reported: Reported::ByPlace,
        seen_along: |location| along(location, JointVariable::Angle),
        direct_check: None,
    },
    candidates: all,
    estimates: frequency_and_amplitude,
    observed,
    write,
    transfer: Transfer::Made(elsewhere),
    event: no_event,
};

/// What a finding says of a joint's gear or encoder as a whole, in the units of the answers.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GearError {
    /// The joint, from 0.
    pub joint: usize,
    /// Root mean square of the whole error over the recorded angles, µrad.
    pub rms: Option<Quantity>,
    /// Half the way from its lowest value to its highest, µrad.
    pub half_peak_to_peak: Option<Quantity>,
    /// For each part the frequencies of its waves, cycles per revolution; none of a curve.
    pub cycles_per_rev_of_parts: Vec<Vec<f64>>,
}

impl GearError {
    /// `None` where the finding is about something else.
    pub fn of(finding: &Finding) -> Option<GearError> {
        let cycles = |part: &FindingPart| {
            let is_cycles = |own: &&Estimate| CYCLES_OF_PART.contains(&own.name.as_str());
            part.estimates.iter().filter(is_cycles).map(|own| own.value).collect()
        };
        Some(GearError {
            joint: gear_joint(finding)?,
            rms: finding.quantity(RECORDED_RMS),
            half_peak_to_peak: finding.quantity(RECORDED_HALF_PEAK_TO_PEAK),
            cycles_per_rev_of_parts: finding.parts.iter().map(cycles).collect(),
        })
    }
}

/// The joint, from 0, whose gear a finding is about.
pub(in crate::diagnosis::calibration) fn gear_joint(finding: &Finding) -> Option<usize> {
    let is_gear = *finding.effect == TRANSMISSION_ERROR.effect && finding.is_of_model();
    finding.location.joint().filter(|_| is_gear)
}

pub(in crate::diagnosis::calibration) fn all(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    let of_joint = |j: usize| {
        let (steps, half_step) = scan(context, j);
        let whole = (1..=SCAN.0 as usize).map(|n| n as f64).chain(ratios());
        let single = whole.map(move |n| harmonic(context, j, n));
        let doubles = (1..=MOST_DOUBLED).map(f64::from).chain(RATIOS);
        let both = doubles.map(move |n| harmonics(context, j, [n, 2.0 * n]));
        let waves = steps.into_iter().map(move |n| wave(context, j, n, half_step));
        let curves = CURVES.into_iter().filter_map(move |cycles| curve(context, j, cycles));
        single.chain(both).chain(waves).chain(curves)
    };
    context.revolute().into_iter().flat_map(of_joint).collect()
}

/// Cycles per revolution of a joint's waves, and half their step.
fn scan(context: &Context, j: usize) -> (Vec<f64>, f64) {
    let (low, high) = context.range(j);
    let turns = (high - low) / TAU;
    // an integer number of steps per cycle, so that whole numbers are in the scan
    let per_cycle = (2.0 * turns).ceil().max(1.0 / SCAN.1);
    let steps = (1..=(SCAN.0 * per_cycle) as usize).map(|k| k as f64 / per_cycle);
    (steps.collect(), 0.5 / per_cycle)
}

/// Frequencies of gears in use beyond the scan, cycles per revolution.
fn ratios() -> Vec<f64> {
    let mut ratios: Vec<f64> = RATIOS.iter().flat_map(|ratio| [*ratio, 2.0 * ratio]).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.dedup();
    ratios
}

fn harmonic(context: &Context, j: usize, cycles: f64) -> Entry {
    let gear = Gear::Harmonic { joint: j, cycles_per_rev: cycles };
    terms(context, gear, format!("{cycles} cycles/rev"), &["sin_urad", "cos_urad"])
}

/// An error and its first overtone: an eccentric disc that is read at one place has errors of one
/// and two cycles per revolution, a strain-wave gear of i and 2·i.
fn harmonics(context: &Context, j: usize, cycles_per_rev: [f64; 2]) -> Entry {
    let gear = Gear::Harmonics { joint: j, cycles_per_rev };
    let [n, m] = cycles_per_rev;
    let names = ["sin_urad", "cos_urad", "sin_2_urad", "cos_2_urad"];
    let mut entry = terms(context, gear, format!("{n} and {m} cycles/rev"), &names);
    if n == 1.0 {
        entry.candidate.weight = ECCENTRIC;
    }
    entry
}

fn wave(context: &Context, j: usize, cycles: f64, half_step: f64) -> Entry {
    let (low, high) = context.range(j);
    let middle = 0.5 * (low + high);
    let gear = Gear::Wave { joint: j, cycles_per_rev: cycles, middle, half_step };
    let names = ["sin_urad", "cos_urad", "sin_urad_per_rad", "cos_urad_per_rad"];
    let form = format!("near {} cycles/rev", (cycles * 100.0).round() / 100.0);
    terms(context, gear, form, &names)
}

fn terms(context: &Context, gear: Gear, form: String, names: &[&str]) -> Entry {
    let parameter = |(k, name): (usize, &&str)| (linear(*name, JOINT_ANGLE), turned(context, &gear, k));
    let parameters = names.iter().enumerate().map(parameter).collect();
    let location = joint_by(gear.joint(), form);
    Entry::new(&TRANSMISSION_ERROR.effect, location, parameters).by(Law::Gear(gear))
}

/// What the `k`th parameter of a gear's error does.
fn turned(context: &Context, gear: &Gear, k: usize) -> Column {
    let joint = gear.joint();
    context.turn(joint, |_, there| gear.term(k, there.joints[joint]))
}

fn curve(context: &Context, j: usize, cycles: f64) -> Option<Entry> {
    let (low, high) = context.range(j);
    let scale = 1.0 / cycles;
    let cosines = Cosines::new((low, high), scale);
    // the constant is the joint's offset
    let per_pose = (MOST_COSINES.1 * context.configurations.len() as f64) as usize;
    if !(3..=MOST_COSINES.0.min(per_pose)).contains(&cosines.sizes.len()) {
        return None;
    }
    let sizes = cosines.sizes.clone();
    let gear = Gear::Curve { joint: j, cosines };
    let parameters = sizes.iter().enumerate().skip(1).map(|(k, size)| {
        let parameter = linear(format!("cosine_{k}_urad"), JOINT_ANGLE * size);
        (parameter, turned(context, &gear, k - 1))
    });
    let location = joint_by(j, format!("a smooth curve, scale {:.2}°", scale.to_degrees()));
    let entry = Entry::new(&TRANSMISSION_ERROR.effect, location, parameters.collect());
    Some(entry.by(Law::Gear(gear)))
}

/// The same function of the joint's angle in other poses, which may have another scan.
fn elsewhere(context: &Context, candidate: &Candidate, law: &Law) -> Entry {
    let columns = |gear: &Gear| {
        let parameters = candidate.parameters.iter().cloned().enumerate();
        parameters.map(|(k, parameter)| (parameter, turned(context, gear, k))).collect()
    };
    let parameters = law.gear().map_or_else(Vec::new, columns);
    Entry::new(candidate.effect, candidate.location.clone(), parameters).by(law.clone())
}

/// Names of the next waves' numbers begin with this.
const NEXT: [&str; 4] = ["", "second_", "third_", "fourth_"];

/// Of all waves, the strongest part first.
fn frequency_and_amplitude(model: &CalibrationModel, parts: &[FindingPart]) -> Vec<Estimate> {
    let of_part = |part: &FindingPart| {
        let estimates = |gear: &Gear| gear.estimates(part, &model.angles(gear.joint()));
        model.gear_of(part).map_or_else(Vec::new, estimates)
    };
    let numbered = |(k, estimate): (usize, Estimate)| {
        let next = NEXT.get(k / 2)?;
        Some(Estimate { name: format!("{next}{}", estimate.name), ..estimate })
    };
    parts.iter().flat_map(of_part).enumerate().map_while(numbered).collect()
}

fn observed(finding: &Finding, model: &CalibrationModel) -> String {
    let named = capital(&finding.location);
    let up_to = if let Law::Gear(Gear::Curve { .. }) = law(finding, model) { "up to about" } else { "up to" };
    let wave = |k: usize| {
        let (frequency, amplitude) = (nth(finding, 2 * k), nth(finding, 2 * k + 1).with_unit("µrad"));
        let is_rough = frequency.high - frequency.value > ROUGH * frequency.value;
        let cycles = match law(finding, model) {
            Law::Gear(Gear::Wave { .. }) if is_rough => {
                format!("{} times per revolution", frequency.with_unit(""))
            }
            _ => cycles(frequency.value),
        };
        match law(finding, model) {
            Law::Gear(Gear::Curve { .. }) if k == 0 => format!("{amplitude}, mostly {cycles}"),
            _ if k == 0 => format!("{amplitude}, {cycles}"),
            _ => format!("of {amplitude}, {cycles}"),
        }
    };
    let gears = finding.parts.iter().filter_map(|part| model.gear_of(part));
    let count = gears.map(Gear::wave_count).sum::<usize>().min(NEXT.len());
    let waves: Vec<String> = (0..count).map(wave).collect();
    format!("{named} has an angle error of {up_to} {}", waves.join(", and "))
}

/// A frequency that is not known to this share of it is said with its interval.
const ROUGH: f64 = 0.1;

/// `once per revolution`, `18.5 times per revolution`.
fn cycles(cycles: f64) -> String {
    match cycles {
        1.0 => "once per revolution".into(),
        2.0 => "twice per revolution".into(),
        cycles => format!("{} times per revolution", three_digits(cycles)),
    }
}

/// With three digits, without zeros behind the point.
fn three_digits(cycles: f64) -> String {
    let digits = significant(cycles, 3);
    match digits.contains('.') {
        true => digits.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => digits,
    }
}

/// Waves as they are, curves as tables over the recorded angles.
fn write(finding: &Finding, model: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let of_part = |part: &FindingPart| {
        let values = &part.term.values;
        let Some(gear) = model.gear_of(part) else { return Vec::new() };
        match (gear, &values[..]) {
            (&Gear::Harmonic { joint, cycles_per_rev }, &[sine, cosine]) => {
                vec![robot::Effect::Harmonic { joint, cycles_per_rev, sine, cosine }]
            }
            (&Gear::Harmonics { joint, cycles_per_rev: [n, m] }, &[a, b, c, d]) => vec![
                robot::Effect::Harmonic { joint, cycles_per_rev: n, sine: a, cosine: b },
                robot::Effect::Harmonic { joint, cycles_per_rev: m, sine: c, cosine: d },
            ],
            (Gear::Harmonic { .. } | Gear::Harmonics { .. }, _) => Vec::new(),
            (gear @ (Gear::Wave { joint, .. } | Gear::Curve { joint, .. }), values) => {
                let highest = gear.highest(values.len());
                let rows = table(&model.angles(*joint), highest, |q| gear.turn(values, q));
                vec![robot::Effect::Table { joint: *joint, rows }]
            }
        }
    };
    extended.robot.effects.extend(finding.parts.iter().flat_map(of_part));
    WrittenTo::Model
}
