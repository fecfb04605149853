//! What the rod makes of its loads and of their history: curvature, creep, hysteresis.

use super::entry::{
    Context, Entry, RigEffect, Usual, along_the_load, alternative, entry, nowhere, number, of_action,
    parameter,
};
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mechanics::load_history::{
    Clock, History, Loop, Memory, Onset, creep, hysteresis, is_stated, onsets, warmth,
};
use crate::diagnosis::rig::mechanics::recovery::recovery;
use crate::diagnosis::rig::model::{Body, RigModel};
use crate::inference::{Effect, Finding, Kind, Location, Part, Reported, Variable, WrittenTo};
use crate::statistics::median;
use crate::units::significant;

/// Share of the displacement at the largest load that is not linear.
const CURVATURE: f64 = 0.05;
/// Creep of bondlines and laminates per decade of time.
const PER_DECADE: f64 = 0.03;
/// t₀ of creep, s: what a reading after so long is said to be without.
const CREEP_STARTS: [f64; 4] = [1.0, 10.0, 60.0, 600.0];
/// Growth of the deflection per kelvin.
const PER_KELVIN: f64 = 5e-4;
const MOST_PER_KELVIN: f64 = 0.02;
/// Most runs whose onset of creep is found, each for itself; and how long before its first reading,
/// in usual steps of time.
const MOST_ONSETS: usize = 12;
const ONSET_START: f64 = CREEP_STARTS[1];
const LATEST: f64 = 100.0;
/// Width of a hysteresis loop as a share of full scale.
const LOOP: f64 = 0.02;

/// Stiffness that follows the load.
pub static NONLINEAR_STIFFNESS: RigEffect = RigEffect {
    effect: Effect {
        name: "nonlinear_stiffness",
        kind: Kind::Physics,
        summary: "the stiffness depends on the load",
        formula: "u = C·F·(1 + k₂·F²), or u = C·F·(1 + k₁·|F|)",
        prior: "5 % of the displacement at the largest load",
        parameters: &[(&["per_n2"], "k₂, coefficient of F²"), (&["per_n"], "k₁, coefficient of |F|")],
        needs: "two sizes of load",
        cause: "a stiffness that depends on the load",
        cause_at: |_| "a stiffness that depends on the load".into(),
        written_to: WrittenTo::Nowhere,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(CURVATURE)],
    needs_rod: false,
    candidates: curvature,
    missing: |_| "only one size of load was applied",
    observed: observed_curvature,
    write: nowhere,
};

/// The deflection grows under a constant load.
pub static CREEP: RigEffect = RigEffect {
    effect: Effect {
        name: "creep",
        kind: Kind::Physics,
        summary: "the deflection grows with the logarithm of time",
        formula: "u = C·F·(1 + k·log₁₀(1 + t/t₀)), t₀ 1, 10, 60 or 600 s, by several clocks",
        prior: "3 % per decade of time: bondlines and laminates",
        parameters: &[
            (&["per_decade"], "k, growth per decade of time"),
            (&["onset_s"], "how long before the first reading of a run its load was hung, by that clock"),
        ],
        needs: "times that differ (column `time_s`); `loaded_at_s` says when each load was hung",
        cause: "creep",
        cause_at: |_| "creep".into(),
        written_to: WrittenTo::Nowhere,
        reported: Reported::Alone,
        seen_along: |_| vec![Variable::TimeInRun],
        direct_check: None,
    },
    usual: &[Usual::Share(PER_DECADE)],
    needs_rod: false,
    candidates: creeping,
    missing: |_| "no times were recorded (column `time_s`), or they do not differ",
    observed: |finding, model| {
        let since = match history(finding, model) {
            Some(History::Creep(clock, _)) => clock.name(),
            _ => "under load",
        };
        let growth = number(finding, "per_decade").map(|share| 100.0 * share).with_unit("%");
        match model.data().iter().any(|d| d.imposed.is_some()) {
            true => {
                format!("Under a held displacement the load falls by {growth} per decade of time {since}")
            }
            false => format!("The deflections grow by {growth} per decade of time {since}"),
        }
    },
    write: nowhere,
};

/// A rod that is softer when it is warm.
pub static THERMAL_SOFTENING: RigEffect = RigEffect {
    effect: Effect {
        name: "thermal_softening",
        kind: Kind::Physics,
        summary: "the rod is softer when it is warmer",
        formula: "u = C·F·(1 + k·(T − T̄)), T̄ the mean temperature of the recording",
        prior: "0.05 % per kelvin: stainless steels lose 0.04 % (Ledbetter, J. Appl. Phys. 52, 1981, 1587)",
        parameters: &[(&["per_k"], "k, growth of the deflection per kelvin")],
        needs: "temperatures that differ (column `temperature_c`)",
        cause: "moduli that fall with temperature",
        cause_at: |_| "moduli that fall with temperature".into(),
        written_to: WrittenTo::Nowhere,
        reported: Reported::Alone,
        seen_along: |_| vec![Variable::Temperature],
        direct_check: None,
    },
    usual: &[Usual::Share(PER_KELVIN)],
    needs_rod: false,
    candidates: |context| {
        // a laminate may stiffen, and a plastic near its glass transition loses 1 to 2 % per kelvin
        let per_kelvin = parameter("per_k", 0.0, PER_KELVIN, (-MOST_PER_KELVIN, MOST_PER_KELVIN));
        let softening = |memory| {
            let action = Action::Memory(memory, History::Temperature);
            entry(&THERMAL_SOFTENING, Location::Part(Part::Rod), per_kelvin, action)
        };
        warmth(context.data).map(softening).into_iter().collect()
    },
    missing: |_| "no temperatures were recorded (column `temperature_c`), or they do not differ",
    observed: |finding, _| {
        let growth = number(finding, "per_k").map(|share| 100.0 * share).with_unit("%");
        format!("The deflections grow by {growth} per kelvin")
    },
    write: nowhere,
};

/// The way down is not the way up.
pub static HYSTERESIS: RigEffect = RigEffect {
    effect: Effect {
        name: "hysteresis",
        kind: Kind::Physics,
        summary: "unloading differs from loading, and not by friction",
        formula: "a loop h of full scale wide at half load, in ten forms",
        prior: "2 % of full scale: 0.1 % of a load cell, some per cent of bonds and clamps",
        parameters: &[(&["fraction"], "h, width of the loop over full scale")],
        needs: "unloading (column `phase`)",
        cause: "hysteresis",
        cause_at: |_| "hysteresis".into(),
        written_to: WrittenTo::Nowhere,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(LOOP)],
    needs_rod: false,
    candidates: lagging,
    missing: |_| "no readings were taken while unloading (column `phase`)",
    observed: |finding, model| {
        let is_open = matches!(history(finding, model), Some(History::Loop(Loop::Remanent)));
        let at = if is_open { "zero load" } else { "half load" };
        let share = number(finding, "fraction").map(|share| 100.0 * share).with_unit("%");
        format!("The unloading curve lies above the loading curve, by {share} of full scale at {at}")
    },
    write: nowhere,
};

/// Quadratic as a symmetric body's is, and linear as a load cell's (its curvature has a direction).
fn curvature(context: &mut Context) -> Vec<Entry> {
    let largest = context.largest_load();
    // at most nothing is left of the displacement, or ten times as much is there
    let share =
        |name: &str, scale: f64| parameter(name, 0.0, CURVATURE / scale, (-1.0 / scale, 10.0 / scale));
    let forms = [
        (share("per_n2", largest * largest), Action::PerLoadSquared),
        (share("per_n", largest), Action::PerLoad),
    ];
    let of_form = |(parameter, action)| {
        alternative(entry(&NONLINEAR_STIFFNESS, Location::Part(Part::Rod), parameter, action))
    };
    forms.map(of_form).into()
}

/// By how much the stiffness has changed at the largest load.
fn observed_curvature(finding: &Finding, model: &RigModel) -> String {
    let largest = super::entry::largest_load(model.data());
    // deflection over that of the linear rod
    let quadratic = of_action(finding, model, |action| matches!(action, Action::PerLoadSquared));
    let quadratic = quadratic.map(|k| k.map(|k| 1.0 + k * largest * largest));
    let linear = of_action(finding, model, |action| matches!(action, Action::PerLoad));
    let linear = linear.map(|k| k.map(|k| 1.0 + k * largest));
    let body = match model.body {
        Body::Rod(_) => "The rod",
        Body::Lines(_) => "The loaded part",
    };
    let Some(change) = quadratic.or(linear) else { return format!("{body} is not linear") };
    let (change, load) = (change.compared("softer", "stiffer"), newtons(largest));
    format!("{body} is {change} at {load} than at small loads")
}

/// Creep by each clock that may be meant.
fn creeping(context: &mut Context) -> Vec<Entry> {
    let clocks = if is_stated(context.data) { &Clock::STATED[..] } else { &Clock::ALL[..] };
    let mut known: Vec<Memory> = Vec::new();
    let mut entries = Vec::new();
    for t0 in CREEP_STARTS {
        // with an onset of its own for each run t₀ is a part of that
        for &clock in clocks.iter().filter(|clock| **clock != Clock::UnknownOnset || t0 == ONSET_START) {
            let Some(mut memory) = creep(context.data, clock, t0) else { continue };
            if let Clock::AllLoads(when) = clock {
                let Some(left) = recovery(context.data, when, t0, context.at_first_sight) else { continue };
                memory.recovery = left;
                memory.usual = median(&memory.relative).unwrap_or_default();
            }
            // two clocks that show the same time are one
            let is_free = clock == Clock::UnknownOnset;
            if known.contains(&memory) && !is_free {
                continue;
            }
            known.push(memory.clone());
            let form = format!("{}, t0 {t0} s", clock.name());
            let location = Location::Form { part: Part::Rod, form };
            let per_decade = parameter("per_decade", 0.0, PER_DECADE, (0.0, 1.0));
            let action = Action::Memory(memory, History::Creep(clock, t0));
            let (mut creep, mut actions) = alternative(entry(&CREEP, location, per_decade, action));
            if is_free {
                let onsets = onsets(context.data, t0, MOST_ONSETS);
                if onsets.is_empty() {
                    continue;
                }
                let onset = |onset: Onset| {
                    let usual = onset.usual;
                    let before = parameter("onset_s", usual, usual, (0.0, LATEST * usual));
                    (before, Action::Onset(onset))
                };
                let (parameters, more): (Vec<_>, Vec<_>) = onsets.into_iter().map(onset).unzip();
                creep.parameters.extend(parameters);
                actions.extend(more);
            }
            entries.push((creep, actions));
        }
    }
    entries
}

/// All loops of hysteresis that differ in these readings.
fn lagging(context: &mut Context) -> Vec<Entry> {
    let mut known: Vec<Memory> = Vec::new();
    let of_shape = |shape: Loop| {
        let location = match shape.name() {
            "" => Location::Part(Part::Rod),
            form => Location::Form { part: Part::Rod, form: form.into() },
        };
        let fraction = parameter("fraction", 0.0, LOOP, (0.0, 1.0));
        let memory = hysteresis(context.data, shape).filter(|memory| !known.contains(memory))?;
        known.push(memory.clone());
        let action = Action::Memory(memory, History::Loop(shape));
        Some(alternative(entry(&HYSTERESIS, location, fraction, action)))
    };
    Loop::ALL.into_iter().filter_map(of_shape).collect()
}

/// The law of a finding that remembers.
fn history(finding: &Finding, model: &RigModel) -> Option<History> {
    let candidate = finding.parts.first()?.term.candidate;
    model.actions[candidate].iter().find_map(|action| match action {
        Action::Memory(_, history) => Some(*history),
        _ => None,
    })
}

/// A force with a unit that keeps its number short.
fn newtons(force: f64) -> String {
    let (unit, name) = match force {
        force if force >= 1e6 => (1e6, "MN"),
        force if force >= 1e4 => (1e3, "kN"),
        _ => (1.0, "N"),
    };
    format!("{} {name}", significant(force / unit, 3))
}
