//! What happens to a load before the rod feels it: friction, offset, play, direction.

use super::entry::{
    Context, Entry, RigEffect, Usual, along_the_load, candidate, entry, number, of_action,
    out_of_the_readings, parameter, preferring, size,
};
use super::places::{loaded_axes, sessions};
use crate::diagnosis::rig::mechanics::action::{Action, Scope};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Candidate, Effect, Finding, Kind, Location, Parameter, Part, Reported, WrittenTo};
use crate::spatial::Axis;
use crate::units::{DEG, UM, significant};

/// Friction of a slide as a share of the largest load.
const SLIDE: f64 = 0.05;
/// What a pulley holds back of a load.
const PULLEY: f64 = 0.03;
/// What friction holds back of a hung load, or a tare takes away from it, at most, as a share of
/// the largest load: of what a slide holds whole nothing is known, and any rod would fit it.
const MOST_OF_LOAD: f64 = 0.5;
/// Weight of a hanger that was forgotten, or error of a tare, as a share of the largest load.
const TARE: f64 = 0.05;
/// Travel over which friction turns round as a share of the largest displacement.
const PRESLIDING: f64 = 0.05;
/// Plays of friction that are tried, as shares of the largest displacement, and how far from one of
/// them another one begins.
const PLAYS: [f64; 10] = [0.01, 0.015, 0.025, 0.04, 0.06, 0.09, 0.13, 0.2, 0.3, 0.45];
const SPAN: f64 = 1.35;
/// Play as a share of the largest displacement at most.
const MOST_PLAY: f64 = 0.9;
/// How often friction that turns round over a travel is met for one that turns round at once.
const RARE: f64 = 0.2;
/// Play of a clamp or of a threaded holder as a share of the largest reading.
const PLAY: f64 = 0.025;
/// What the eye allows when a load or a sensor is set up, rad.
pub(super) const ALIGNMENT: f64 = 1.0 * DEG;
/// Beyond this nobody would call it the same axis, rad.
const MOST_MISALIGNED: f64 = 30.0 * DEG;
pub(super) const WIDEST: (f64, f64) = (-MOST_MISALIGNED, MOST_MISALIGNED);

/// Friction of the slide that guides the load.
pub static FRICTION: RigEffect = RigEffect {
    effect: Effect {
        name: "friction",
        kind: Kind::Physics,
        summary: "friction in the slide holds back part of each load",
        formula: "F = load − f while loading (not below zero), load + f while unloading (not above what was felt \
            at the turn)",
        prior: "5 % of the largest load: the paper's lines cross the load axis at 0.9 to 1.1 of 20 N",
        parameters: &[
            (&["force_n"], "friction force"),
            (&["presliding_um"], "travel over which friction turns round, where the displacement is imposed"),
            (&["play_um"], "play on either side that the motion crosses at every turn, likewise"),
        ],
        needs: "loads; unloading distinguishes it from an offset",
        cause: "friction in the slide",
        cause_at: |location| "friction in the slide".to_owned() + &under(location),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(SLIDE)],
    needs_rod: false,
    candidates: |context| {
        let largest = context.largest_load();
        let is_imposed = context.data.iter().any(|d| d.imposed.is_some());
        let most = if is_imposed { largest } else { MOST_OF_LOAD * largest };
        let force = || parameter("force_n", 0.0, SLIDE * largest, (0.0, most));
        let mut entries = of_axes(context.data, Part::Slide, &|location, scope| {
            entry(&FRICTION, location, force(), Action::Friction(scope))
        });
        let at_turns = at_turns(context, &force());
        entries[0].0.is_alternative = !at_turns.is_empty();
        entries.extend(at_turns);
        entries
    },
    missing: |_| "no load was applied",
    observed: |finding, model| {
        let (load, force) = (each_load(finding), size(finding, "force_n", "N"));
        if model.data().iter().any(|d| d.imposed.is_some()) {
            let over = of_action(finding, model, |action| matches!(action, Action::Presliding))
                .map_or_else(String::new, |travel| {
                    format!(" over {} of travel", travel.size().with_unit("µm"))
                });
            let play = of_action(finding, model, |action| matches!(action, Action::SliderPlay));
            let play = play.map_or_else(String::new, |play| {
                format!(", behind a play of {} on either side", play.size().with_unit("µm"))
            });
            return format!("Friction of {force} resists the motion and turns round with it{over}{play}");
        }
        match model.data().iter().any(Datum::is_unloading) {
            true => format!(
                "About {force} of {load} does not reach the rod while loading, and as much remains on it \
                 while unloading"
            ),
            false => format!("About {force} of {load} does not reach the rod (no unloading was recorded)"),
        }
    },
    write: out_of_the_readings,
};

/// Friction of the pulleys over which loads pull.
pub static PULLEY_FRICTION: RigEffect = RigEffect {
    effect: Effect {
        name: "pulley_friction",
        kind: Kind::Physics,
        summary: "friction of a pulley holds back a share of each load",
        formula: "F = load·(1 − μ) while loading, load·(1 + μ) while unloading (not above what was felt at \
            the turn)",
        prior: "3 % of each load: a pulley on a rolling bearing takes 1 to 3 %, on a plain one 5 to 10 %",
        parameters: &[(&["fraction"], "μ: what friction holds back, over the load")],
        needs: "loads that were taken off again; without that it is the stiffness",
        cause: "friction of a pulley",
        cause_at: |location| "friction of a pulley".to_owned() + &under(location),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: Some("Turn the pulley a little by hand under the load, and read again."),
    },
    usual: &[Usual::Share(PULLEY)],
    needs_rod: false,
    candidates: |context| {
        let is_hung = |d: &Datum| d.imposed.is_none() && (d.is_unloading() || d.motion.is_some());
        if !context.data.iter().any(is_hung) {
            return Vec::new();
        }
        of_axes(context.data, Part::Pulley, &|location, scope| {
            let share = parameter("fraction", 0.0, PULLEY, (0.0, MOST_OF_LOAD));
            entry(&PULLEY_FRICTION, location, share, Action::PulleyFriction(scope))
        })
    },
    missing: |_| "no load was taken off again: it would be the stiffness",
    observed: |finding, _| {
        format!(
            "About {} of {} does not reach the rod while loading, and as much remains on it while unloading",
            number(finding, "fraction").map(|share| 100.0 * share).with_unit("%"),
            each_load(finding)
        )
    },
    write: out_of_the_readings,
};

/// A hanger that was not counted, or a tare that is off.
pub static LOAD_OFFSET: RigEffect = RigEffect {
    effect: Effect {
        name: "load_offset",
        kind: Kind::Physics,
        summary: "a hanger or a tare adds to every load",
        formula: "F = load + f, for every load but zero",
        prior: "5 % of the largest load, as the paper's friction, which its lines cannot distinguish \
            from it",
        parameters: &[(&["force_n"], "added force")],
        needs: "loads",
        cause: "an offset of the load (hanger or tare)",
        cause_at: |location| "an offset of the load".to_owned() + &under(location),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(TARE)],
    needs_rod: false,
    candidates: |context| {
        let largest = context.largest_load();
        of_axes(context.data, Part::Hanger, &|location, scope| {
            let most = MOST_OF_LOAD * largest;
            let force = parameter("force_n", 0.0, TARE * largest, (-most, largest));
            entry(&LOAD_OFFSET, location, force, Action::LoadOffset(scope))
        })
    },
    missing: |_| "no load was applied",
    observed: |finding, model| {
        if model.data().iter().any(|d| d.imposed.is_some()) {
            let error = number(finding, "force_n").map(|force| -force).with_unit("N");
            return format!("The load cell shows {error} too much{}", under(&finding.location));
        }
        let word = if number(finding, "force_n").value >= 0.0 { "larger" } else { "smaller" };
        let force = size(finding, "force_n", "N");
        format!("The true value of {} is {force} {word} than stated", each_load(finding))
    },
    write: out_of_the_readings,
};

/// Play of the clamp.
pub static BACKLASH: RigEffect = RigEffect {
    effect: Effect {
        name: "backlash",
        kind: Kind::Physics,
        summary: "play before the rod bends",
        formula: "y = bending + p towards the load, for every load but zero",
        prior: "2.5 % of the largest reading: 20 µm of play of a clamp where a rod bends by 0.8 mm",
        parameters: &[(&["play_um"], "free travel")],
        needs: "a channel along a load",
        cause: "play in the clamp",
        cause_at: |location| "play in the clamp".to_owned() + &under(location),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(PLAY)],
    needs_rod: false,
    candidates: |context| {
        let largest = context.largest_reading();
        let most = most_play(context.data);
        of_axes(context.data, Part::Clamp, &|location, scope| {
            let play = parameter("play_um", 0.0, PLAY * largest, (0.0, most));
            entry(&BACKLASH, location, play, Action::Play(scope))
        })
    },
    missing: |_| "no channel was read along a load",
    observed: |finding, _| {
        let (under, play) = (under(&finding.location), size(finding, "play_um", "µm"));
        format!("The rod moves freely by {play} before it bends{under}")
    },
    write: out_of_the_readings,
};

/// A load that is not square to {T}.
pub static LOAD_MISALIGNMENT: RigEffect = RigEffect {
    effect: Effect {
        name: "load_misalignment",
        kind: Kind::Physics,
        summary: "a load is not aligned with the tool frame",
        formula: "d = nominal direction, turned by φ",
        prior: "1°: what the eye allows when a load is set up",
        parameters: &[
            (&["angle_deg"], "angle"),
            (&["about_x_deg"], "rotation of all loads about x"),
            (&["about_y_deg"], "rotation of all loads about y"),
            (&["about_z_deg"], "rotation of all loads about z"),
        ],
        needs: "a rod file; channels across the loads",
        cause: "a misaligned load",
        cause_at: |location| format!("misaligned loads ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Angle(ALIGNMENT)],
    needs_rod: true,
    candidates: load_turns,
    missing: |_| "no measured channel would show it",
    observed: |finding, _| {
        let angle = number(finding, "angle_deg");
        match &finding.location {
            Location::LoadTurn { from, towards } => {
                let word = if angle.value >= 0.0 { "towards" } else { "away from" };
                format!("Loads along {from} point {} {word} {towards}", angle.size().with_unit("°"))
            }
            Location::LoadFrame { axes: [a, b], about } => {
                format!("Loads along {a} and {b} are rotated about {about} by {}", angle.with_unit("°"))
            }
            _ => format!("All load directions are rotated together by {}", whole_turn(finding)),
        }
    },
    write: out_of_the_readings,
};

/// Friction of loads that are measured while the displacement goes to and fro: one that turns round
/// over some travel, and one behind a play that the motion crosses at every turn.
fn at_turns(context: &Context, force: &Parameter) -> Vec<Entry> {
    let largest = largest_imposed(context.data);
    let is_moving = context.data.iter().any(|d| d.imposed.is_some() && d.is_unloading());
    if largest == 0.0 || !is_moving {
        return Vec::new();
    }
    let scope = Scope { axes: [true; 3], session: None };
    let of_form = |form: String, weight: f64, travel: Parameter, action: Action| {
        let location = Location::Form { part: Part::Slide, form };
        let candidate = candidate(&FRICTION.effect, location, vec![force.clone(), travel]);
        let candidate = Candidate { is_alternative: true, weight, ..candidate };
        (candidate, vec![Action::Friction(scope), action])
    };
    let presliding = parameter("presliding_um", 0.0, PRESLIDING * largest, (0.0, largest));
    let mut entries = vec![of_form("with presliding".into(), RARE, presliding, Action::Presliding)];
    for share in PLAYS {
        let play = share * largest;
        // a reading is in the gap or beyond it: no step from here leads to a play of another size
        let travel = parameter("play_um", play, 0.25 * play, (play / SPAN, play * SPAN));
        let form = format!("with a play of about {} µm at every turn", significant(play / UM, 2));
        entries.push(of_form(form, RARE / PLAYS.len() as f64, travel, Action::SliderPlay));
    }
    entries
}

/// The largest displacement that was imposed, m.
fn largest_imposed(data: &[Datum]) -> f64 {
    data.iter().filter_map(|d| d.imposed).fold(0.0, |most: f64, u| most.max(u.displacement.abs()))
}

/// The largest play, m: what an imposed displacement never crosses is no play.
fn most_play(data: &[Datum]) -> f64 {
    match largest_imposed(data) {
        0.0 => f64::INFINITY,
        largest => MOST_PLAY * largest,
    }
}

/// A part as a whole, under the loads of each axis and in each session: a rig is set up anew for
/// each.
fn of_axes(data: &[Datum], part: Part, make: &dyn Fn(Location, Scope) -> Entry) -> Vec<Entry> {
    let axes = loaded_axes(data);
    let everywhere = Scope { axes: [true; 3], session: None };
    let mut entries = vec![make(Location::Part(part), everywhere)];
    if axes.len() > 1 {
        entries.extend(axes.into_iter().map(|axis| {
            let scope = Scope { axes: Axis::ALL.map(|other| other == axis), ..everywhere };
            make(Location::UnderLoads { part, axis }, scope)
        }));
    }
    entries.extend(sessions(data).into_iter().map(|(number, session)| {
        make(Location::InSession { part, session }, Scope { session: Some(number), ..everywhere })
    }));
    preferring(entries, |candidate| matches!(candidate.location, Location::Part(_)))
}

/// Pairs of an axis of `from` with each other axis.
pub(super) fn pairs(from: &[Axis]) -> Vec<(Axis, Axis)> {
    let others = |&a: &Axis| Axis::ALL.into_iter().filter(move |b| *b != a).map(move |b| (a, b));
    from.iter().flat_map(others).collect()
}

/// An angle by which something was set up wrongly.
pub(super) fn misalignment() -> Parameter {
    parameter("angle_deg", 0.0, ALIGNMENT, WIDEST)
}

/// Each load is set up by itself; where two axes were loaded their frame may be turned as a whole
/// besides.
fn load_turns(context: &mut Context) -> Vec<Entry> {
    let axes = loaded_axes(context.data);
    let single = pairs(&axes).into_iter().map(|(from, towards)| {
        let action = Action::TurnLoad(Axis::ALL.map(|a| a == from), from, towards);
        entry(&LOAD_MISALIGNMENT, Location::LoadTurn { from, towards }, misalignment(), action)
    });
    let both = pairs(&axes)
        .into_iter()
        .filter(|(from, towards)| from < towards && axes.contains(towards))
        .map(|(from, towards)| {
            let is_third = |axis: &Axis| *axis != from && *axis != towards;
            let about = Axis::ALL.into_iter().find(is_third).unwrap_or(from);
            let location = Location::LoadFrame { axes: [from, towards], about };
            let action = Action::TurnLoad([true; 3], from, towards);
            entry(&LOAD_MISALIGNMENT, location, misalignment(), action)
        });
    let whole = (axes.len() > 1).then(|| {
        let about = TURNS.map(|(name, from, towards)| {
            (parameter(name, 0.0, ALIGNMENT, WIDEST), Action::TurnLoad([true; 3], from, towards))
        });
        let (parameters, actions) = about.into_iter().unzip();
        let location = Location::Part(Part::LoadFrame);
        (candidate(&LOAD_MISALIGNMENT.effect, location, parameters), actions)
    });
    single.chain(both).chain(whole).collect()
}

/// A frame that is turned about each of its axes: name of the angle, from which axis towards which.
pub(super) const TURNS: [(&str, Axis, Axis); 3] =
    [("about_x_deg", Axis::Y, Axis::Z), ("about_y_deg", Axis::Z, Axis::X), ("about_z_deg", Axis::X, Axis::Y)];

/// The whole angle of a frame that is turned about several axes: `2.1 ± 0.1°`.
pub(super) fn whole_turn(finding: &Finding) -> String {
    let angles: Vec<_> = finding.estimates.iter().map(|estimate| estimate.quantity()).collect();
    let value = angles.iter().map(|angle| angle.value.powi(2)).sum::<f64>().sqrt();
    // the interval along the turn that was found
    let half = angles
        .iter()
        .map(|angle| angle.value / value.max(f64::MIN_POSITIVE) * 0.5 * (angle.high - angle.low))
        .map(|part| part * part)
        .sum::<f64>()
        .sqrt();
    crate::inference::Quantity { value, low: value - half, high: value + half }.with_unit("°")
}

/// `each load`, or `each load along y` where it is those of one axis only.
fn each_load(finding: &Finding) -> String {
    match &finding.location {
        Location::UnderLoads { axis, .. } => format!("each load along {axis}"),
        Location::InSession { session, .. } => format!("each load of session {session}"),
        _ => "each load".to_owned(),
    }
}

/// ` under loads along y`.
fn under(location: &Location) -> String {
    match location {
        Location::UnderLoads { axis, .. } => format!(" under loads along {axis}"),
        Location::InSession { session, .. } => format!(" in session {session}"),
        _ => String::new(),
    }
}
