//! What `design rig` says: the measurements, what they will tell, a picture of them, and readings
//! to be filled in.

use nalgebra::Matrix3;
use serde_json::{Value, json};

use super::diagnosis::load_plan;
use super::method;
use super::pictures::{RodShape, ShapeCase, Station, StationKind, rod_shape};
use super::rod_drawing::drawing;
use super::scale::superscript;
use super::table::{Column, Table};
use super::{Block, Card, Report, Section, Tone};
use crate::beam::{Load, Physics, RodModel};
use crate::delimited::visible;
use crate::diagnosis::rig::planned::{Bench, Distinguished, PlannedLoads, RigPlan};
use crate::inference::LoadPlan;
use crate::rod::Rod;
use crate::units::{MM, UM, significant};

/// The JSON of `rodcal design rig --json`.
pub fn json(plan: &RigPlan, rod: &Rod, bench: &Bench) -> Value {
    let measurement = |one: &PlannedLoads| {
        let mut object = load_plan(&one.loads);
        object["words"] = one.description.clone().into();
        object["minutes"] = one.minutes.into();
        object
    };
    let distinguished = plan.distinguished.iter().map(|one| {
        let places = one.places.iter().map(|(place, now, best)| {
            json!({ "location": place.to_string(), "log_odds": now, "log_odds_of_everything": best })
        });
        json!({
            "effect": one.effect.name,
            "against": one.against.map(|effect| effect.name),
            "places": places.collect::<Vec<_>>(),
        })
    });
    json!({
        "rod": rod.name,
        "largest_load_n": bench.largest_load,
        "noise_um": bench.noise / UM,
        "measurements": plan.measurements.iter().map(measurement).collect::<Vec<_>>(),
        "minutes": plan.minutes,
        "is_least_proven": plan.is_least,
        "log_odds_wanted": plan.wanted.is_finite().then_some(plan.wanted),
        "distinguished": distinguished.collect::<Vec<_>>(),
        "r_rod": plan.ratio.map(|ratio| json!({
            "width_asked_percent": 100.0 * ratio.asked,
            "width_expected_percent": 100.0 * ratio.expected,
        })),
    })
}

/// The report of `rodcal design rig`.
pub fn report(plan: &RigPlan, rod: &Rod, bench: &Bench) -> Report {
    let mut sections = vec![Section::new("What to measure", measurements(plan, rod))];
    if !plan.distinguished.is_empty() {
        sections.push(Section::new("What it will show", will_tell(plan)));
    }
    let assumed = format!(
        "Assumed: loads to {} N, noise of {} µm of a reading and of the zero of each run, effects of their usual sizes (the odds of \
         smaller ones are smaller), the \
         rod's nominal numbers as uncertain as its file says. Time: 10 minutes for a new place of load or sensors, 2 for a new zero, half \
         a minute for a reading, and waiting.",
        significant(bench.largest_load, 3),
        significant(bench.noise / UM, 3)
    );
    sections.push(Section::new("What was assumed", vec![Block::Paragraph(assumed)]));
    Report {
        title: format!("Rig measurements for rod {}", rod.name),
        headline: headline(plan),
        cards: cards(plan),
        method: method::paragraphs(method::RIG_DESIGN),
        warnings: not_distinguished(plan),
        sections,
        ..Report::default()
    }
}

/// What it takes, what it gives, and whether less would do.
fn cards(plan: &RigPlan) -> Vec<Card> {
    if plan.measurements.is_empty() {
        return Vec::new();
    }
    let readings: usize = plan.measurements.iter().map(|one| readings(&one.loads)).sum();
    let effort = match plan.measurements.len() {
        1 => "1 measurement".to_owned(),
        count => format!("{count} measurements"),
    };
    let mut cards =
        vec![Card::new("Time", format!("{:.0} min", plan.minutes), format!("{effort}, {readings} readings"))];
    cards.push(match plan.ratio {
        Some(ratio) => Card::new(
            "95 % interval of r_rod",
            format!("{} %", significant(100.0 * ratio.expected, 2)),
            format!("asked for: {} %", significant(100.0 * ratio.asked, 3)),
        ),
        None => {
            let (count, short) = comparisons(plan);
            let tone = if short == 0 { Tone::Good } else { Tone::Attention };
            let detail = format!("odds of {} : 1 or more to be expected", odds_wanted(plan));
            Card::new("Distinguished", format!("{} of {count}", count - short), detail).toned(tone)
        }
    });
    if plan.ratio.is_none() {
        let (value, detail) = match plan.is_least {
            true => ("proven", "no plan of less time is enough"),
            false => ("not proven", "nothing of it can be left out"),
        };
        cards.push(Card::new("Least effort", value, detail));
    }
    cards
}

/// Readings that a measurement takes, all sensors of one moment as one.
fn readings(plan: &LoadPlan) -> usize {
    plan.repeats * steps(plan).len() * plan.waits.len().max(1)
}

/// Comparisons of effects at places, and those that fall short of the odds wanted.
fn comparisons(plan: &RigPlan) -> (usize, usize) {
    let all = plan.distinguished.iter().flat_map(|one| &one.places);
    all.fold((0, 0), |(count, short), (_, now, _)| {
        (count + 1, short + usize::from(*now < plan.wanted * (1.0 - 1e-9)))
    })
}

/// `20`: what was typed has no zeros behind.
fn odds_wanted(plan: &RigPlan) -> String {
    let text = significant(plan.wanted.exp(), 3);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

fn headline(plan: &RigPlan) -> String {
    let effort = match plan.measurements.len() {
        0 => return "No measurement of this rig distinguishes these effects.".into(),
        1 => format!("One measurement of about {:.0} minutes", plan.minutes),
        count => format!("{count} measurements of about {:.0} minutes in all", plan.minutes),
    };
    if let Some(ratio) = plan.ratio {
        return format!(
            "{effort} give r_rod with a 95 % interval {} % wide (asked for: {} %).",
            significant(100.0 * ratio.expected, 2),
            significant(100.0 * ratio.asked, 3)
        );
    }
    let odds = odds_wanted(plan);
    let (count, short) = comparisons(plan);
    let distinguish = if plan.measurements.len() == 1 { "distinguishes" } else { "distinguish" };
    match short {
        0 => format!("{effort} {distinguish} these effects, with odds of {odds} : 1 or more to be expected."),
        _ => format!(
            "{effort} {distinguish} these effects in {} of {count} comparisons (effect, place, what else), with odds of {odds} : 1 or \
             more to be expected; {} would take more than reasonable effort.",
            count - short,
            if short == 1 { "the other one" } else { "the others" }
        ),
    }
}

/// What is not distinguished, in words.
fn not_distinguished(plan: &RigPlan) -> Vec<String> {
    let short = |one: &Distinguished| -> Vec<String> {
        let is_short = |now: f64| now < plan.wanted * (1.0 - 1e-9);
        one.places.iter().filter(|(_, now, _)| is_short(*now)).map(|(place, ..)| place.to_string()).collect()
    };
    let words = |one: &Distinguished| {
        let short = short(one);
        let from = one.against.map_or("nothing".to_owned(), |other| other.title());
        let places = match short.len() {
            0 => return None,
            count if count == one.places.len() => String::new(),
            1..=4 => format!(" at {}", short.join(", ")),
            count => format!(" at {}, {} and {} more places", short[0], short[1], count - 2),
        };
        Some(format!(
            "{}{places} cannot be distinguished from {from} with reasonable effort",
            one.effect.title()
        ))
    };
    plan.distinguished.iter().filter_map(words).collect()
}

fn measurements(plan: &RigPlan, rod: &Rod) -> Vec<Block> {
    let heads = vec![
        Column::number("", ""),
        Column::text("what to do"),
        Column::number("repeats", ""),
        Column::number("time", "min"),
    ];
    let mut table = Table::new("plan", "In this order; each repeat from a new zero.", heads);
    for (k, one) in plan.measurements.iter().enumerate() {
        table.row(vec![
            (k + 1).to_string(),
            one.description.clone(),
            one.loads.repeats.to_string(),
            format!("{:.0}", one.minutes),
        ]);
    }
    let least = match (plan.ratio, plan.is_least) {
        _ if plan.measurements.is_empty() => "",
        (Some(_), _) => {
            "Of lines of four to twelve loads, evenly up to the largest, and any number of repeats, none that is enough takes less \
             time. Other loads were not considered."
        }
        (None, true) => {
            "Proven to be the least effort: of the measurements that were considered, no plan of less time is enough."
        }
        (None, false) => {
            "Nothing of this can be left out. That no other plan takes less effort is not proven: there are too many to try."
        }
    };
    let mut blocks = vec![Block::Table(table)];
    if !least.is_empty() {
        blocks.push(Block::Paragraph(least.into()));
    }
    blocks.extend(picture(plan, rod).map(Block::Figure));
    blocks
}

/// Where loads hang and sensors stand, and how the rod bends there.
fn picture(plan: &RigPlan, rod: &Rod) -> Option<super::chart::Figure> {
    const POINTS: usize = 60;
    let tip = rod.length();
    let model = RodModel::new(rod, &Physics::WHOLE, POINTS, &[]).ok()?;
    let chain = &model.chain;
    let places = || (0..=chain.end()).map(|node| chain.position(node));
    let mut cases: Vec<ShapeCase> = Vec::new();
    let mut marks: Vec<(f64, StationKind, Vec<String>)> = Vec::new();
    for (k, one) in plan.measurements.iter().enumerate() {
        let at = |station: Option<f64>| station.unwrap_or(tip);
        let (load_at, read_at) = (at(one.loads.load_station), at(one.loads.read_station));
        for (station, kind) in [(load_at, StationKind::Load), (read_at, StationKind::Reading)] {
            let number = (k + 1).to_string();
            match marks.iter_mut().find(|(at, what, _)| (*at - station).abs() < MM && *what == kind) {
                Some((_, _, numbers)) => numbers.push(number),
                None => marks.push((station, kind, vec![number])),
            }
        }
        let with_load = RodModel::new(rod, &Physics::WHOLE, POINTS, &[load_at]).ok()?;
        let response = with_load.chain.solve(&[Load::Force { node: with_load.node_at(load_at) }]).ok()?;
        let (axis, sign) = (one.loads.direction.axis.index(), f64::from(one.loads.direction.sign));
        let largest = one.loads.loads.iter().copied().fold(0.0, f64::max) * sign;
        let label = format!("{} N along {}", significant(largest.abs(), 3), one.loads.direction);
        let of_node = |node: usize| -> Matrix3<f64> { response.motion(node, 0).translation };
        let near = |p: nalgebra::Vector3<f64>| {
            (0..=with_load.chain.end())
                .min_by(|&a, &b| {
                    let far = |node: usize| (with_load.chain.position(node) - p).norm();
                    far(a).total_cmp(&far(b))
                })
                .unwrap_or(0)
        };
        if cases.iter().all(|case| case.label != label) {
            let moved = places().map(|p| (of_node(near(p)).column(axis) * (largest / UM)).into());
            cases.push(ShapeCase { label, deflection_um: moved.collect() });
        }
    }
    // where a load hangs at a sensor one label is enough
    let beside = |station: f64, kind: StationKind| {
        let other = marks.iter().find(|(at, what, _)| (*at - station).abs() < MM && *what != kind);
        other.map(|(_, _, numbers)| numbers.join(", "))
    };
    let station = |(station, kind, numbers): &(f64, StationKind, Vec<String>)| {
        let numbers = numbers.join(", ");
        Station {
            label: match (kind, beside(*station, *kind)) {
                (StationKind::Load, None) => format!("load {numbers}"),
                (StationKind::Load, Some(read)) if read == numbers => format!("load and read {numbers}"),
                (StationKind::Load, Some(read)) => format!("load {numbers}, read {read}"),
                (_, None) => format!("read {numbers}"),
                (_, Some(_)) => String::new(),
            },
            at_mm: (rod.point(*station) / MM).into(),
            kind: *kind,
        }
    };
    let figure = rod_shape(&RodShape {
        centreline_mm: places().map(|p| (p / MM).into()).collect(),
        cases,
        stations: marks.iter().map(station).collect(),
        ..drawing(rod)
    });
    let caption = "Where loads hang and sensors stand, by the number of the measurement, and how the rod bends under the largest \
                   load of each.";
    let caption = format!("{caption} {}", figure.caption);
    Some(figure.named("rig-plan").captioned(caption))
}

fn will_tell(plan: &RigPlan) -> Vec<Block> {
    let heads = vec![
        Column::text("effect"),
        Column::text("distinguished from"),
        Column::text("at"),
        Column::number("odds", ": 1"),
        Column::number("odds of everything", ": 1"),
    ];
    let caption = "Odds to be expected of this plan, and of all measurements that the rig can make, each repeated twelve times: what is \
                   small there cannot be distinguished. Of each pair the places with the least and the largest odds.";
    let mut table = Table::new("odds", caption, heads);
    // no model of noise is right so far out
    let odds = |ln: f64| match ln / std::f64::consts::LN_10 {
        powers if powers > 6.0 => "over 10⁶".to_owned(),
        powers if powers > 4.0 => format!("10{}", superscript(powers.round() as i32)),
        _ => significant(ln.exp(), 2),
    };
    for one in &plan.distinguished {
        let mut places: Vec<_> = one.places.iter().collect();
        places.sort_by(|a, b| a.1.total_cmp(&b.1));
        let last = places.len().saturating_sub(1);
        let mut picked = vec![0, last];
        picked.dedup();
        for (place, now, best) in picked.into_iter().filter_map(|k| places.get(k)) {
            table.row(vec![
                one.effect.title(),
                one.against.map_or("nothing".into(), |other| other.title()),
                place.to_string(),
                odds(*now),
                odds(*best),
            ]);
        }
    }
    vec![Block::Table(table)]
}

/// The readings that the plan asks for, offsets left blank: for `rig fit` and `diagnose rig` once
/// they are filled in.
pub fn template(plan: &RigPlan, rod: &Rod) -> String {
    let mut text = format!(
        "# Rod {}: offsets in the tool frame, µm, from the unloaded, zeroed rod; a blank cell was not measured\n",
        visible(&rod.name)
    );
    let is_timed = plan.measurements.iter().any(|one| one.loads.waits.iter().any(|wait| *wait > 0.0));
    let has_stations = plan
        .measurements
        .iter()
        .any(|one| one.loads.load_station.is_some() || one.loads.read_station.is_some());
    text += "axis,load_n,trial,phase";
    text += ",time_s,temperature_c";
    text += if has_stations { ",load_station_mm,read_station_mm" } else { "" };
    text += ",dx_um,dy_um,dz_um\n";
    let mm = |station: Option<f64>| station.map_or(String::new(), |s| significant(s / MM, 6));
    let mut clock = 0.0;
    for (k, one) in plan.measurements.iter().enumerate() {
        for repeat in 1..=one.loads.repeats {
            for (load, phase) in steps(&one.loads) {
                for wait in &one.loads.waits {
                    text += &format!(
                        "{},{},{}.{repeat},{phase}",
                        one.loads.direction,
                        // no weights are finer
                        significant(load, 3),
                        k + 1
                    );
                    // without a plan for them, times and temperatures are still worth a note
                    text += &if is_timed { format!(",{},", clock + wait) } else { ",,".to_owned() };
                    if has_stations {
                        text += &format!(",{},{}", mm(one.loads.load_station), mm(one.loads.read_station));
                    }
                    text += ",,,\n";
                }
                clock += one.loads.waits.last().copied().unwrap_or_default() + 30.0;
            }
        }
    }
    text
}

fn steps(plan: &LoadPlan) -> Vec<(f64, &'static str)> {
    let mut steps: Vec<(f64, &'static str)> = plan.loads.iter().map(|load| (*load, "load")).collect();
    if plan.unloading {
        steps.extend(plan.loads.iter().rev().skip(1).map(|load| (*load, "unload")));
    }
    steps
}
