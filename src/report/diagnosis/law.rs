//! The law of what is left, as a section and as JSON.

mod expression;

use serde_json::{Value, json};

use self::expression::{Expression, expression};
use super::lengths::um;
use super::place::place;
use super::subject::{LawNote, LawSubject};
use crate::inference::law::{Constant, Law, LawRival, Memory, OpenEnd, Proposed, Refusal, Site};
use crate::inference::{Location, Quantity, WrittenTo};
use crate::report::pictures::diagnosis::{LawPanel, law_picture};
use crate::report::scale::superscript;
use crate::report::table::{Column, Table};
use crate::report::{Block, Section};
use crate::units::{UM, significant};

/// Rivals that are said.
const SAID: usize = 2;
/// Letters of a result's name that fit beside a picture.
const LONGEST: usize = 20;
/// Points of a line in a picture, and how far beyond the data it is drawn, as a share of them.
const DRAWN: (usize, f64) = (160, 0.3);

/// The section of the report.
pub fn section(subject: &LawSubject) -> Section {
    let heading = "A law for it";
    let law = match &subject.proposed.law {
        Err(refusal) => {
            return Section::new(heading, vec![Block::Paragraph(refused(*refusal, subject))]);
        }
        Ok(law) => law,
    };
    let of_law = |(k, law): (usize, &Law)| {
        let note = subject.notes.get(k)?;
        let mut points = vec![summary(law, k, subject.proposed)];
        points.extend(alternatives(law, subject));
        points.extend(next(law));
        points.extend(note.remark.clone());
        points.extend(more(law, note));
        points.push(range(law, subject, note));
        let name = if k == 0 { "law" } else { "second-law" };
        let figure = picture(law, name, subject.noun);
        Some(vec![Block::List(points), Block::Table(table(law, name)), Block::Figure(figure)])
    };
    Section::new(heading, law.all().enumerate().filter_map(of_law).flatten().collect())
}

/// The key `law` of the JSON; null where nothing is left to look for one in.
pub fn json(subject: Option<&LawSubject>) -> Value {
    let Some(subject) = subject else { return Value::Null };
    let proposed = subject.proposed;
    let um = |error: f64| error / UM;
    let lives = proposed.lives.as_ref().map(|(location, variable)| {
        json!({ "location": location.to_string(), "place": place(location), "variable": variable.name, "unit": variable.unit })
    });
    let mut json = json!({
        "proposed": proposed.law.is_ok(),
        "refused": proposed.law.as_ref().err().map(|refusal| refused(*refusal, subject)),
        "lives": lives,
        "heldout_without_um": proposed.held_out.map(|(without, _)| um(without)),
        "heldout_with_um": proposed.held_out.map(|(_, with)| um(with)),
    });
    let (Ok(law), Some(note)) = (&proposed.law, subject.notes.first()) else { return json };
    let second = law.second.as_ref().zip(subject.notes.get(1)).map(|(second, note)| {
        let (without, with) = second.held_out;
        let mut json = of_law(&second.law, 1, subject, note);
        json["heldout_without_um"] = json!(um(without));
        json["heldout_with_um"] = json!(um(with));
        json
    });
    let mut more = of_law(law, 0, subject, note);
    more["second"] = json!(second);
    if let (Value::Object(json), Value::Object(more)) = (&mut json, more) {
        json.extend(more);
    }
    json
}

/// A law that is proposed.
fn of_law(law: &Law, number: usize, subject: &LawSubject, note: &LawNote) -> Value {
    let um = |error: f64| error / UM;
    let Expression { text, latex } = expression(&law.site, law.form, law.memory);
    let (low, high) = law.site.range();
    let variable = &law.site.variable;
    json!({
        "words": summary(law, number, subject.proposed),
        "expression": { "text": text, "latex": latex },
        "location": law.site.location.to_string(),
        "place": place(&law.site.location),
        "changes": { "symbol": law.site.result.symbol, "name": law.site.result.name, "unit": law.site.result.unit },
        "variable": { "symbol": variable.symbol, "name": variable.name, "unit": variable.unit },
        "form": law.form.name(),
        "memory": law.memory.name(),
        "constants": law.constants().map(constant).collect::<Vec<_>>(),
        "intervals_of_this_form_alone": is_of_form_alone(law),
        "correlation": law.correlation.row_iter().map(|row| row.iter().copied().collect()).collect::<Vec<Vec<f64>>>(),
        "range": [low / variable.si, high / variable.si],
        "explains_rms_um": um(law.explains),
        "heldout_um": law.held_out.map(um),
        "log_odds": law.log_odds.0,
        "log_odds_over_curve": law.log_odds.1,
        "rivals": law.rivals.iter().map(rival).collect::<Vec<_>>(),
        "next_record": next(law),
        "beyond": law.further.map(|(at, apart)| json!({
            "at": at / variable.si,
            "apart_um": um(apart),
            "may_be_used": law.holds_beyond(),
        })),
        "another_way": law.another_way.map(|apart| json!({
            "apart_um": um(apart),
            "may_be_used": law.holds_another_way(),
        })),
        "more_left": law.more.as_ref().map(|(location, variable)| {
            json!({ "location": location.to_string(), "place": place(location), "variable": variable.name, "unit": variable.unit })
        }),
        "remark": note.remark,
        "written_to": match note.written_to {
            WrittenTo::Model => Some(subject.files[0]),
            WrittenTo::Recording => Some(subject.files[1]),
            WrittenTo::Nowhere => None,
        },
    })
}

fn constant(constant: &Constant) -> Value {
    json!({
        "symbol": constant.symbol,
        "name": constant.name,
        "unit": constant.unit,
        "value": constant.value,
        "lo": constant.low,
        "hi": constant.high,
        "also": constant.also,
        "open": constant.open.map(|end| if end == OpenEnd::High { "hi" } else { "lo" }),
    })
}

fn rival(rival: &LawRival) -> Value {
    let Expression { text, .. } = expression(&rival.site, rival.form, rival.memory);
    json!({
        "expression": text,
        "location": rival.site.location.to_string(),
        "place": place(&rival.site.location),
        "variable": rival.site.variable.name,
        "form": rival.form.name(),
        "memory": rival.memory.name(),
        "constant": rival.constant.as_ref().map(|(_, own)| constant(own)),
        "odds": rival.odds,
        "heldout_um": rival.held_out.map(|error| error / UM),
    })
}

/// `at the clamp`, `at dz`.
fn at(site: &Site) -> String {
    let article = if matches!(site.location, Location::Part(_)) { "the " } else { "" };
    let plain = site.location.to_string();
    format!("at {article}{plain}")
}

fn quantity(constant: &Constant) -> String {
    let Constant { value, low, high, unit, .. } = constant;
    match constant.open {
        Some(OpenEnd::High) => return format!("{} or more", with_unit(significant(*low, 3), unit)),
        Some(OpenEnd::Low) => return format!("{} or less", with_unit(significant(*high, 3), unit)),
        None => {}
    }
    if constant.also.is_empty() {
        return Quantity { value: *value, low: *low, high: *high }.with_unit(unit);
    }
    let others: Vec<String> = constant.also.iter().map(|other| significant(*other, 3)).collect();
    with_unit(format!("{} (or {})", significant(*value, 3), others.join(", ")), unit)
}

fn with_unit(number: String, unit: &str) -> String {
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// What is proposed, for the first lines of a report: the law with its numbers, what these data do
/// not distinguish from it, and what it is worth.
pub fn brief(subject: &LawSubject) -> Option<String> {
    let proposed = subject.proposed;
    let law = proposed.law.as_ref().ok()?;
    let (with, second) = match &law.second {
        Some(second) => ("both", format!(", and {}", formula(&second.law))),
        None => ("it", String::new()),
    };
    let worth =
        proposed.held_out.zip(proposed.held_out_with()).map_or_else(String::new, |(errors, after)| {
            format!(" With {with}, the held-out error falls from {} to {} µm.", um(errors.0), um(after))
        });
    let others = others(law, subject.noun);
    Some(format!("A law is proposed for it: {}{second}.{others}{worth}", formula(law)))
}

/// Where else the law may act, and what else it may look like, without numbers.
fn others(law: &Law, noun: &str) -> String {
    let is_here = |site: &Site| site.location == law.site.location && site.variable == law.site.variable;
    let mut names: Vec<String> = Vec::new();
    for rival in &law.rivals {
        let name = match rival.memory {
            _ if !is_here(&rival.site) => at(&rival.site),
            memory if memory.is(law.memory) => format!("of another form ({})", rival.form.name()),
            Memory::None => format!("without memory ({})", rival.form.name()),
            memory => format!("with another memory ({})", memory.name()),
        };
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let more = if names.len() > SAID { ", or others" } else { "" };
    names.truncate(SAID);
    match names.is_empty() {
        true => String::new(),
        false => format!(" These {noun} cannot distinguish it from one {}{more}.", names.join(" or ")),
    }
}

/// The formula, what it changes and where, and its numbers.
fn formula(law: &Law) -> String {
    let Expression { text, .. } = expression(&law.site, law.form, law.memory);
    let numbers: Vec<String> =
        law.constants().map(|own| format!("{} = {}", own.symbol, quantity(own))).collect();
    format!(
        "{text}, the {} as a function of the {}, {}, with {}",
        law.site.result.name,
        law.site.variable.name,
        at(&law.site),
        numbers.join(", ")
    )
}

/// The law, its numbers and what it is worth; the second one stands beside the first.
fn summary(law: &Law, number: usize, proposed: &Proposed) -> String {
    let first = proposed.law.as_ref().ok();
    let (start, with, worth) = match number {
        0 => ("A law is proposed for the unexplained error", "it", proposed.held_out),
        _ => {
            let second = first.and_then(|first| first.second.as_ref());
            ("Beside it a second law is proposed", "both", second.map(|second| second.held_out))
        }
    };
    let worth = worth.map_or_else(String::new, |(before, after)| {
        format!(" With {with}, the held-out error falls from {} to {} µm.", um(before), um(after))
    });
    format!("{start}: {}. It explains {} µm rms.{worth}", formula(law), um(law.explains))
}

/// `saturation at 14 N`.
fn called(rival: &LawRival, law: &Law) -> String {
    let number = rival.constant.as_ref().map_or_else(String::new, |(_, own)| {
        let range = |digits| {
            let (low, high) = (significant(own.low, digits), significant(own.high, digits));
            if low == high { low } else { format!("{low} to {high}") }
        };
        format!(", {} {}", own.name, with_unit(range(2), &own.unit))
    });
    let memory =
        if rival.memory == Memory::None { String::new() } else { format!(" with a {}", rival.memory.name()) };
    let elsewhere = match rival.site.location == law.site.location && rival.site.variable == law.site.variable
    {
        true => String::new(),
        false => format!(" over {} {}", rival.site.variable.name, at(&rival.site)),
    };
    format!("{}{memory}{elsewhere}{number}", rival.form.name())
}

/// What these readings do not distinguish from it.
fn alternatives(law: &Law, subject: &LawSubject) -> Option<String> {
    if law.rivals.is_empty() {
        return None;
    }
    let said: Vec<String> = law.rivals.iter().take(SAID).map(|rival| called(rival, law)).collect();
    let more = if law.rivals.len() > SAID { ", or others" } else { "" };
    let these = subject.noun;
    let of_form = match is_of_form_alone(law) {
        true => " Its numbers and their intervals are those of its own form: another form has others.",
        false => "",
    };
    Some(format!(
        "It may as well be: {}{more}. These {these} cannot distinguish them.{of_form}",
        said.join("; or ")
    ))
}

/// True where these data do not distinguish it from a form whose numbers are not its own: no
/// interval of a number says anything of that one.
fn is_of_form_alone(law: &Law) -> bool {
    law.rivals.iter().any(|rival| !rival.form.is_kin(law.form) || !rival.memory.is(law.memory))
}

/// The measurement that would distinguish a law from its rivals, in a sentence.
fn next(law: &Law) -> Option<String> {
    let next = law.next?;
    let variable = &law.site.variable;
    let value = with_unit(significant(next.at / variable.si, 2), variable.unit);
    let rival = law.rivals.get(next.rival)?;
    let where_to = if next.is_beyond { "beyond" } else { "at" };
    Some(format!(
        "To distinguish it from {}: record the {} {where_to} {value}, where the two are {} µm apart.",
        called(rival, law),
        variable.name,
        um(next.apart)
    ))
}

fn range(law: &Law, subject: &LawSubject, note: &LawNote) -> String {
    let ((low, high), variable) = (law.site.range(), &law.site.variable);
    let show = |value: f64, digits: usize| {
        let sign = if value < 0.0 { "−" } else { "" };
        format!("{sign}{}", significant(value.abs() / variable.si, digits))
    };
    let written = match note.written_to {
        WrittenTo::Model => "; --apply writes it".to_owned(),
        WrittenTo::Recording => format!(
            "; --apply takes it out of the {}, and no file gets it: its {} is known in this recording only",
            subject.files[1], variable.name
        ),
        WrittenTo::Nowhere => String::new(),
    };
    let beyond = match law.further {
        Some((at, apart)) if apart > law.noise => {
            let (noun, at) = (subject.noun, with_unit(show(at, 2), variable.unit));
            format!(": at {at} these {noun} leave up to {} µm open, so do not use it there", um(apart))
        }
        Some(_) if law.more.is_some() => {
            ": something else is left beside it, so do not use it there".to_owned()
        }
        _ => String::new(),
    };
    let elsewhere = match law.another_way.filter(|_| law.holds_another_way() == Some(false)) {
        Some(apart) => format!(
            " Where the {} turns round elsewhere than here, these {} leave up to {} µm open.",
            variable.name,
            subject.noun,
            um(apart)
        ),
        None => String::new(),
    };
    format!(
        "It is a proposal from {} between {} and {}; beyond that it is an extrapolation{beyond}.{elsewhere} It changes no finding{written}.",
        subject.noun,
        show(low, 3),
        with_unit(show(high, 3), variable.unit)
    )
}

/// What may be left beside it.
fn more(law: &Law, note: &LawNote) -> Option<String> {
    let (location, variable) = law.more.as_ref()?;
    let advice = match note.written_to {
        WrittenTo::Nowhere => "",
        WrittenTo::Model | WrittenTo::Recording => {
            " Write this law with --apply and diagnose again: that says whether there is another."
        }
    };
    Some(format!(
        "It may not be all: beside it something follows the {} ({location}).{advice}",
        variable.name
    ))
}

/// Why there is none.
fn refused(refusal: Refusal, subject: &LawSubject) -> String {
    let (proposed, noun) = (subject.proposed, subject.noun);
    let why = match refusal {
        Refusal::Chance => "none is 50 times more probable than chance".to_owned(),
        Refusal::Curve(by) => format!(
            "a smooth curve is {} more probable than any form that was tried, so that none of them is the law",
            match by.exp() {
                times if times < 1e4 => format!("{} times", significant(times, 2)),
                _ => format!("10{} times", superscript((by / std::f64::consts::LN_10).round() as i32)),
            }
        ),
        Refusal::HeldOut => format!("held-out {noun} are predicted no better with it, or hardly"),
        Refusal::Little => format!("what is left is too little beside the scatter of the {noun}"),
        Refusal::NoFolds => format!("no {noun} could be held out to confirm one"),
    };
    let lives = proposed.lives.as_ref().map_or_else(String::new, |(location, variable)| {
        format!(" A smooth curve explains most over {} ({location}).", variable.name)
    });
    format!("No law is proposed for the unexplained error: {why}.{lives}")
}

fn table(law: &Law, name: &str) -> Table {
    let columns = vec![
        Column::text("constant"),
        Column::text(""),
        Column::number("value", ""),
        Column::number("95 % from", ""),
        Column::number("to", ""),
        Column::text("unit"),
    ];
    let mut table = Table::new(name, "The constants of the proposed law.", columns);
    for own in law.constants() {
        let show = |value: f64| shown(value, 0.5 * (own.high - own.low));
        let unit = own.unit.clone();
        table.row([
            own.symbol.clone(),
            own.name.clone(),
            show(own.value),
            if own.open == Some(OpenEnd::Low) { String::new() } else { show(own.low) },
            if own.open == Some(OpenEnd::High) { String::new() } else { show(own.high) },
            unit,
        ]);
    }
    table
}

/// A number with as many digits as half of its interval has, and one more.
fn shown(value: f64, half: f64) -> String {
    const MOST: i32 = 6;
    let decimals = if half > 0.0 { 1 - half.log10().floor() as i32 } else { MOST + 1 };
    match decimals {
        ..=0 => format!("{value:.0}"),
        1..=MOST => format!("{value:.0$}", decimals as usize),
        _ => significant(value, 4),
    }
}

/// Data, smooth curve and law, direction by direction.
fn picture(law: &Law, name: &str, noun: &str) -> crate::report::chart::Figure {
    let (variable, result) = (&law.site.variable, &law.site.result);
    let label = |name: &str, unit: &str| {
        if unit.is_empty() { name.to_owned() } else { format!("{name} / {unit}") }
    };
    // what is too long for the side of a picture has its symbol
    let changed = match result.name.chars().count() {
        ..=LONGEST => format!("change of the {}", result.name),
        _ => result.symbol.to_owned(),
    };
    let panel = |(direction, (name, _)): (usize, &(String, Vec<f64>))| {
        let own = |points: &[crate::inference::law::Point]| -> Vec<[f64; 2]> {
            let along = points.iter().filter(|point| point.direction == direction);
            along.map(|point| [point.x / variable.si, point.value / result.si]).collect()
        };
        let data = own(&law.points);
        let ends =
            data.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[0]), b.max(p[0])));
        let line = |from: f64, to: f64| -> Vec<[f64; 2]> {
            let at = |k: usize| from + (to - from) * k as f64 / DRAWN.0 as f64;
            let value = |x: f64| [x, law.at(direction, x * variable.si) / result.si];
            (0..=DRAWN.0).map(at).map(value).collect()
        };
        let beyond = ends.1 + DRAWN.1 * (ends.1 - ends.0);
        LawPanel {
            title: name.clone(),
            x: label(&variable.name, variable.unit),
            y: label(&changed, result.unit),
            data,
            curve: own(&law.curve),
            law: line(ends.0, ends.1),
            extrapolated: line(ends.1, beyond),
        }
    };
    let panels: Vec<LawPanel> = law.site.directions.iter().enumerate().map(panel).collect();
    law_picture(&panels, name, noun).captioned(format!(
        "What the findings leave, as the law sees it. Points: {noun}; dashed: a smooth curve through them; \
         solid: the law; dotted: the law beyond the {noun}."
    ))
}
