//! What a display makes of a displacement that came by another one: play of a stylus, lag.

use super::entry::{
    Context, Entry, RigEffect, Usual, alternative, candidate, number, of_action, out_of_the_readings,
    parameter, size,
};
use super::places::measured_channels;
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mechanics::display::{Display, Follows};
use crate::diagnosis::rig::model::RigModel;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Candidate, Effect, Finding, Kind, Location, Part, Reported, Variable, WrittenTo};
use crate::units::UM;

/// Play of a stylus, a lever or a dial as a share of the largest reading.
const PLAY: f64 = 0.01;
/// And at most.
const MOST_PLAY: f64 = 0.5;
/// Share of a change that is still to come when a display is read.
const LAG: f64 = 0.03;
/// What lacks a third of each change was not read.
const MOST_LAG: f64 = 0.3;
/// How often displays have a play, as it was at the zero or as the run before has left it, and how
/// often they are read too soon, for another effect of the library: friction, which that looks like
/// where loads go in even steps, is in every slide.
const OFTEN: [f64; 3] = [0.08, 0.08, 0.04];
/// Words for the second and the third of these.
const FORMS: [&str; 2] = ["play on the side where the run before has left it", "read too soon"];

/// A display that follows late.
pub static SENSOR_LAG: RigEffect = RigEffect {
    effect: Effect {
        name: "sensor_lag",
        kind: Kind::Physics,
        summary: "a display follows late: after its play, or read before it has settled",
        formula: "y ← min(max(y, u − p/2), u + p/2) along a run, p the whole play; or y = u − λ·(u − u′), u′ before",
        prior: "play of 1 % of the largest reading: dial gauges reverse to 1 to 5 µm; or λ 3 %",
        parameters: &[
            (&["play_um"], "whole play"),
            (&["fraction"], "share of each change that is not shown yet"),
        ],
        needs: "a rod file; loads that go up and down (column `phase`)",
        cause: "a display that follows late",
        cause_at: |location| format!("a display that follows late ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| vec![Variable::Phase, Variable::Load],
        direct_check: None,
    },
    usual: &[Usual::Share(PLAY), Usual::Share(LAG)],
    needs_rod: true,
    candidates: displays,
    missing: |_| "no unloading was recorded",
    observed: |finding, model| {
        let display = match &finding.location {
            Location::Channel { channel, .. } => format!("Display d{channel}"),
            _ if model.per_newton().is_some() => "The load cell".to_owned(),
            _ => "Every display".to_owned(),
        };
        let is_late = |action: &Action| match action {
            Action::Display(display) => display.follows() == Follows::Later,
            _ => false,
        };
        match of_action(finding, model, is_late) {
            Some(share) => {
                let share = share.map(|share| 100.0 * share).with_unit("%");
                let or =
                    if may_be(finding, model, false) { ", or it has a play as large as that" } else { "" };
                format!(
                    "{display} lags: {share} of each change of the load is not shown yet when it is read{or}"
                )
            }
            None => {
                let play = match model.per_newton() {
                    None => size(finding, "play_um", "µm"),
                    Some(per_newton) => {
                        number(finding, "play_um").map(|play| play * UM / per_newton).size().with_unit("N")
                    }
                };
                let or = if may_be(finding, model, true) { ", or is read too soon" } else { "" };
                format!("{display} follows the rod only after a play of {play}{or}")
            }
        }
    },
    write: out_of_the_readings,
};

/// True where it may as well be the other way to be late, which in even steps is the same.
fn may_be(finding: &Finding, model: &RigModel, is_later: bool) -> bool {
    let rivals = finding.parts.iter().flat_map(|part| &part.rivals).filter_map(|rival| rival.term.as_ref());
    rivals.flat_map(|term| &model.actions[term.candidate]).any(|action| match action {
        Action::Display(display) => (display.follows() == Follows::Later) == is_later,
        _ => false,
    })
}

/// All displays alike, and each by itself, in each form; where displacements were imposed, the load
/// cell, whose load is what is compared. Nothing where no load is taken off again: what is missing
/// then is an offset.
fn displays(context: &mut Context) -> Vec<Entry> {
    let data = context.data;
    if !data.iter().any(|d| d.is_unloading()) {
        return Vec::new();
    }
    let is_imposed = data.iter().any(|d| d.imposed.is_some());
    let largest = context.largest_reading();
    let play = || parameter("play_um", 0.0, PLAY * largest, (0.0, MOST_PLAY * largest));
    let lag = || parameter("fraction", 0.0, LAG, (0.0, MOST_LAG));
    let forms = [
        (None, Follows::BehindPlay, play()),
        (Some(FORMS[0]), Follows::BehindPlayOfBefore, play()),
        (Some(FORMS[1]), Follows::Later, lag()),
    ];
    let channels = measured_channels(data);
    let mut entries = Vec::new();
    for ((form, follows, usual), often) in forms.into_iter().zip(OFTEN) {
        let mut add = |location: Location, weight: f64, is_its: &dyn Fn(&Datum) -> bool| {
            let display = Display::of(data, follows, is_its);
            let candidate = candidate(&SENSOR_LAG.effect, location, vec![usual.clone()]);
            let candidate = Candidate { weight, ..candidate };
            entries.push(alternative((candidate, vec![Action::Display(display.into())])));
        };
        let all = match form {
            None => Location::Part(Part::Sensors),
            Some(form) => Location::Form { part: Part::Sensors, form: form.into() },
        };
        add(all, often, &|d| !is_imposed || d.imposed.is_some());
        for &channel in channels.iter().filter(|_| channels.len() > 1 && !is_imposed) {
            let weight = often / channels.len() as f64;
            add(Location::Channel { channel, form }, weight, &|d| d.channel == channel);
        }
    }
    entries
}
