//! What `design rod` says: JSON, tables and pictures of a [`Study`].

mod cells;
mod figures;
mod files;
mod for_robot;
mod overview;
mod refined;

use serde_json::{Map, Value, json};

use self::cells::{
    DIGITS, columns, count, figures_json, half_of, known_at, limit_name, limit_words, shape_cells,
    shape_columns, tube_of,
};
pub use self::files::files;
pub use self::for_robot::{for_robot_card, for_robot_headline, for_robot_json, for_robot_section};
use super::chart::Figure as Picture;
use super::method;
use super::sensitivities::{self, OnePercent};
use super::table::{Column, Table};
use super::{Block, Report, Section, swing};
use crate::design::{Design, Figure, Figures, Goal, Impossible, Limit, Shown, Study};
use crate::rod::NominalNumber;
use crate::units::{significant, with_uncertainty};

/// The JSON of `rodcal design rod --json`, all but the front ([`front_json`]).
pub fn json(study: &Study) -> Value {
    let found = &study.found;
    let mut because = Map::new();
    for (limit, count) in study.space.limits.iter().zip(&found.broken) {
        because.insert(limit.key.into(), (*count).into());
    }
    for (why, count) in Impossible::ALL.iter().zip(found.impossible).filter(|(_, count)| *count > 0) {
        because.insert(why.key().into(), count.into());
    }
    let relaxed = found.nearest.iter().flat_map(|nearest| &nearest.one_limit).map(|relaxed| {
        json!({
            "constraint": relaxed.limit.key,
            "stated": relaxed.limit.value,
            "needed": relaxed.to,
            "rod": rod_json(study, relaxed.design.index),
        })
    });
    json!({
        "design": study.space.file,
        "combinations": study.space.combinations(),
        "evaluated": found.evaluated,
        "feasible": found.feasible,
        "objectives": study.space.goals.iter().map(goal_json).collect::<Vec<_>>(),
        "front": Value::Null,
        "infeasible_because": because,
        "relax": relaxed.collect::<Vec<_>>(),
        "nearest": nearest_json(study),
        "refined": study.refined.as_ref().map(|found| refined::json(&study.space, found)),
        "base": study.base.as_ref().map(|base| {
            let mut object = figures_json(&Design { index: 0, figures: base.figures });
            object.insert("rod".into(), base.rod.name.clone().into());
            object.insert("bettered_by".into(), base.bettered_by.into());
            object.insert("breaks".into(), base.broken.clone().into());
            object
        }),
    })
}

/// The design that comes nearest to all limits together, and what each would have to be for it.
fn nearest_json(study: &Study) -> Value {
    let nearest = study.found.nearest.as_ref().and_then(|nearest| nearest.all_limits);
    let Some((design, worst)) = nearest else { return Value::Null };
    let needed = broken_by(study, &design)
        .map(|(limit, value)| json!({ "constraint": limit.key, "stated": limit.value, "needed": value }));
    json!({
        "rod": rod_json(study, design.index),
        "beyond_percent": 100.0 * worst,
        "constraints": needed.collect::<Vec<_>>(),
    })
}

/// Limits that a design breaks, each with its figure.
fn broken_by<'s>(study: &'s Study, design: &Design) -> impl Iterator<Item = (&'s Limit, f64)> {
    let figures = design.figures;
    let broken = study.space.limits.iter().filter(move |limit| !limit.is_kept(&figures));
    broken.map(move |limit| (limit, figures.get(limit.figure).unwrap_or(f64::NAN)))
}

fn goal_json(goal: &Goal) -> Value {
    json!({ if goal.is_maximised { "maximise" } else { "minimise" }: goal.figure.key() })
}

/// A design of the front in the JSON.
pub fn front_json(study: &Study, place: usize) -> Value {
    let design = &study.found.front[place];
    let mut object = Map::new();
    object.insert("rod".into(), rod_json(study, design.index));
    object.append(&mut figures_json(design));
    object.insert("tubes".into(), study.space.tubes_of(design.index).into());
    if let Some(known) = known_at(study, place) {
        let interval = |figure: Figure| {
            let (value, half) = (design.figures.get(figure)?, half_of(known, figure)?);
            Some((figure.key().to_owned(), json!([value - half, value + half])))
        };
        object.insert(
            "intervals".into(),
            Figure::ALL.into_iter().filter_map(interval).collect::<Map<_, _>>().into(),
        );
        object.insert("indistinguishable_from".into(), known.indistinguishable.clone().into());
    }
    if let Some(shown) = study.shown.iter().find(|shown| shown.place == place) {
        object.insert("sensitivities".into(), shown.slopes.iter().map(slopes_json(shown)).collect());
        let keys = COUNTED.map(|figure| format!("{}_percent", figure.key()));
        let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
        object.insert("one_percent_more".into(), sensitivities::json(&one_percent_more(shown), &keys));
    }
    object.into()
}

/// Derivatives of the figures by one number of a design, per unit of its key.
fn slopes_json(shown: &Shown) -> impl Fn(&(NominalNumber, Figures)) -> Value {
    |(number, slopes)| {
        let mut object = sensitivities::number_json(number, shown.rod.value_of(number).unwrap_or(f64::NAN));
        let (_, si) = number.in_file();
        for figure in COUNTED {
            object.insert(figure.key().into(), slopes.get(figure).map(|slope| slope * si).into());
        }
        object.into()
    }
}

/// Figures whose derivatives are shown.
const COUNTED: [Figure; 7] = [
    Figure::CRod,
    Figure::CfMax,
    Figure::CgMax,
    Figure::Mass,
    Figure::Moment,
    Figure::FirstFrequency,
    Figure::Reach,
];

fn one_percent_more(shown: &Shown) -> Vec<OnePercent> {
    let of_figures =
        |figures: &Figures| COUNTED.map(|figure| figures.get(figure).unwrap_or(f64::NAN)).to_vec();
    let slopes: Vec<(NominalNumber, Vec<f64>)> =
        shown.slopes.iter().map(|(number, slopes)| (number.clone(), of_figures(slopes))).collect();
    sensitivities::one_percent_more(&shown.rod, &slopes, &of_figures(&shown.design.figures))
}

/// What 1 % more of each number does to the first, the middle and the last design that are shown.
fn what_counts(study: &Study) -> Section {
    let last = study.shown.len().saturating_sub(1);
    let mut picked = vec![0, last / 2, last];
    picked.dedup();
    let heads = COUNTED.map(|figure| figure.name_and_unit().0);
    let mut blocks = vec![Block::Paragraph(
        "Change of each figure by 1 % more of one number, all others kept; exact derivatives. The JSON has those of all \
         designs that are shown, in the units of the rod file."
            .into(),
    )];
    let mut panels = Vec::new();
    for shown in picked.into_iter().filter_map(|k| study.shown.get(k)) {
        let (rows, name) = (one_percent_more(shown), &shown.rod.name);
        let title = format!("{name}: {}", shown.tubes.join(" + "));
        panels.push(sensitivities::bars(title, &rows, &[(0, "c_rod"), (3, "mass"), (5, "first frequency")]));
        let (id, caption) = (format!("sensitivities-{}", shown.place + 1), format!("What counts, {name}."));
        blocks.push(Block::Table(sensitivities::table(&id, caption, &heads, &rows)));
    }
    let figure = Picture {
        name: "sensitivities".into(),
        caption: "What 1 % more of each number does: the numbers that count most.".into(),
        panels,
        columns: 1,
        shared_legend: true,
        ..Picture::default()
    };
    blocks.insert(1, Block::Figure(figure));
    Section::new("What counts", blocks)
}

/// The keys of a rod file.
fn rod_json(study: &Study, index: u64) -> Value {
    let text = study.space.rod(index).ok().map(|rod| rod.to_toml(&[]));
    text.and_then(|text| toml::from_str(&text).ok()).unwrap_or(Value::Null)
}

/// The report of `rodcal design rod`.
pub fn report(study: &Study) -> Report {
    let mut sections = Vec::new();
    if study.found.front.is_empty() {
        sections.push(Section::new("What stands in the way", nearest(study)));
    } else {
        sections.push(Section::new("The front", front(study)));
        sections.push(Section::new("To scale", vec![Block::Figure(figures::to_scale(study))]));
        sections.extend(study.refined.as_ref().map(|found| refined::section(study, found)));
        sections.push(what_counts(study));
        sections.extend(study.shown.first().and_then(|shown| swing::of_rod(&shown.rod)));
    }
    sections.push(Section::new("What was looked at", looked_at(study)));
    Report {
        title: format!("Rods for {}", study.space.file),
        headline: headline(study),
        cards: overview::cards(study),
        method: method::paragraphs(method::ROD_DESIGN),
        warnings: overview::warnings(study),
        sections,
        ..Report::default()
    }
}

/// How many rods there are to choose from, and what they come to.
pub fn headline(study: &Study) -> String {
    let found = &study.found;
    let all = count(found.evaluated, "rod");
    if found.front.is_empty() {
        return nothing_fits(study, &all);
    }
    let spans = study.space.goals.iter().map(|goal| {
        let values = || found.front.iter().filter_map(|design| design.figures.get(goal.figure));
        let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let (name, unit) = goal.figure.name_and_unit();
        let number = |value: f64| significant(value, 3);
        let span = if low == high { number(low) } else { format!("{} to {}", number(low), number(high)) };
        format!("{name} {span} {unit}").trim_end().to_owned()
    });
    let spans: Vec<String> = spans.collect();
    let front = match found.front.len() {
        1 => "one of them is as good as any other in every goal".to_owned(),
        count => format!("{count} of them form the Pareto front"),
    };
    format!("Of {all} {} all limits, and {front}: {}.", verb(found.feasible), spans.join(", "))
}

/// What would have to give where no rod keeps all limits.
fn nothing_fits(study: &Study, all: &str) -> String {
    let relax = |(limit, to): (&Limit, f64)| format!("{} to {}", limit.key, needed(limit, to));
    let nearest = study.found.nearest.as_ref();
    let one_limit = nearest.iter().flat_map(|nearest| &nearest.one_limit);
    let one_limit: Vec<String> = one_limit.map(|one| relax((&one.limit, one.to))).collect();
    if !one_limit.is_empty() {
        return format!("None of {all} keeps all limits. One would do: relax {}.", one_limit.join(", or "));
    }
    match nearest.and_then(|nearest| nearest.all_limits) {
        Some((design, _)) => format!(
            "None of {all} keeps all limits, and none would with only one of them given up. The nearest needs several at \
             once: relax {}.",
            broken_by(study, &design).map(relax).collect::<Vec<_>>().join(" and ")
        ),
        None => {
            let reasons = Impossible::ALL.iter().zip(study.found.impossible).filter(|(_, count)| *count > 0);
            let reasons: Vec<String> =
                reasons.map(|(why, count)| format!("{} ({count})", why.description())).collect();
            format!("None of {all} can be built: {}.", reasons.join("; "))
        }
    }
}

fn verb(feasible: u64) -> String {
    if feasible == 1 { "1 keeps".into() } else { format!("{feasible} keep") }
}

/// A limit that would do, rounded to the safe side.
fn needed(limit: &Limit, to: f64) -> String {
    significant(limit.relaxed_to(to), DIGITS)
}

fn front(study: &Study) -> Vec<Block> {
    let goals = study.space.goals.iter().map(|goal| {
        let (name, _) = goal.figure.name_and_unit();
        format!("{} {name}", if goal.is_maximised { "larger" } else { "smaller" })
    });
    let goals: Vec<String> = goals.collect();
    let mut blocks = vec![Block::Paragraph(format!(
        "No other rod that was looked at is as good in every goal ({} is better) and better in one.",
        goals.join(", ")
    ))];
    if study.shown.len() < study.found.front.len() {
        let known = match study.known.len() == study.found.front.len() {
            true => ", with the intervals of each",
            false => "",
        };
        let only = match study.known.len() == study.found.front.len() {
            true => "",
            false => {
                " Intervals are those of the designs that are shown, which are compared with each other alone."
            }
        };
        blocks.push(Block::Paragraph(format!(
            "{} of {} designs are shown, evenly from end to end; all of them{known} stand in designs.csv and in the JSON.{only}",
            study.shown.len(),
            study.found.front.len()
        )));
    }
    blocks.extend(figures::front(study).map(Block::Figure));
    blocks.push(Block::Table(front_table(study)));
    if let Some(base) = &study.base {
        let breaks = match base.broken.is_empty() {
            true => "It keeps all limits.".to_owned(),
            false => {
                let broken = study.space.limits.iter().filter(|limit| base.broken.contains(&limit.key));
                format!("It breaks: {}.", broken.map(limit_words).collect::<Vec<_>>().join("; "))
            }
        };
        let better = match base.bettered_by {
            0 => "no design of the front is better in every goal".to_owned(),
            1 => "one design of the front is at least as good in every goal".to_owned(),
            count => format!("{count} designs of the front are at least as good in every goal"),
        };
        blocks.push(Block::Paragraph(format!("Beside rod {}: {better}. {breaks}", base.rod.name)));
    }
    blocks
}

fn front_table(study: &Study) -> Table {
    let figures = columns(study);
    let mut heads = vec![Column::text("design"), Column::text("tube")];
    heads.extend(shape_columns(study));
    heads.extend(figures.iter().map(|figure| {
        let (name, unit) = figure.name_and_unit();
        Column::number(name, unit)
    }));
    heads.push(Column::text("indistinguishable from"));
    let caption = "Designs of the front, best in the first goal first; ± is half of the 95 % interval from the standard \
         uncertainties of the rod's numbers. Designs that differ in no goal by more than is known of their difference \
         cannot be distinguished.";
    let mut table = Table::new("front", caption, heads);
    for shown in &study.shown {
        let mut cells = vec![(shown.place + 1).to_string(), shown.tubes.join(" + ")];
        cells.extend(shape_cells(study, &shown.rod));
        cells.extend(figures.iter().map(|figure| known(shown, *figure)));
        cells.push(places(&shown.indistinguishable));
        table.row(cells);
    }
    if let Some(base) = &study.base {
        let mut cells = vec![format!("rod {}", base.rod.name), String::new()];
        cells.extend(shape_cells(study, &base.rod));
        let value =
            |figure: &Figure| base.figures.get(*figure).map_or("–".to_owned(), |v| significant(v, DIGITS));
        cells.extend(figures.iter().map(value));
        cells.push(String::new());
        table.row(cells);
    }
    table
}

fn known(shown: &Shown, figure: Figure) -> String {
    let Some(value) = shown.design.figures.get(figure) else { return "–".into() };
    let half = shown.intervals.half.get(figure).unwrap_or(0.0);
    with_uncertainty(value, half, DIGITS)
}

/// `2, 3, 5 and 4 more`.
fn places(all: &[usize]) -> String {
    const NAMED: usize = 4;
    let named: Vec<String> = all.iter().take(NAMED).map(|place| (place + 1).to_string()).collect();
    match all.len().saturating_sub(NAMED) {
        0 => named.join(", "),
        more => format!("{} and {more} more", named.join(", ")),
    }
}

fn nearest(study: &Study) -> Vec<Block> {
    let Some(nearest) = &study.found.nearest else { return Vec::new() };
    let mut heads = vec![
        Column::text("limit"),
        Column::in_row_unit("stated"),
        Column::in_row_unit("needed"),
        Column::units(),
    ];
    heads.extend(shape_columns(study));
    let caption =
        "Limits that stand in the way alone: with what is needed here, the rod beside it keeps all others.";
    let mut table = Table::new("relax", caption, heads);
    for relaxed in &nearest.one_limit {
        let mut cells = vec![
            limit_name(&relaxed.limit),
            significant(relaxed.limit.value, DIGITS),
            needed(&relaxed.limit, relaxed.to),
            relaxed.limit.figure.name_and_unit().1.to_owned(),
        ];
        if let Ok(rod) = study.space.rod(relaxed.design.index) {
            cells.extend(shape_cells(study, &rod));
        }
        table.row(cells);
    }
    let mut blocks = Vec::new();
    if !nearest.one_limit.is_empty() {
        blocks.push(Block::Table(table));
    }
    if let Some((design, worst)) = &nearest.all_limits {
        let mut heads = vec![
            Column::text("limit"),
            Column::in_row_unit("stated"),
            Column::in_row_unit("this rod has"),
            Column::units(),
        ];
        heads.extend(shape_columns(study));
        let caption = format!(
            "The design whose worst limit is broken by the smallest share, {} %: tube {}.",
            significant(100.0 * worst, 2),
            tube_of(study, design)
        );
        let mut table = Table::new("nearest", caption, heads);
        for (limit, value) in broken_by(study, design) {
            let mut cells = vec![
                limit_name(limit),
                significant(limit.value, DIGITS),
                significant(value, DIGITS),
                limit.figure.name_and_unit().1.to_owned(),
            ];
            if let Ok(rod) = study.space.rod(design.index) {
                cells.extend(shape_cells(study, &rod));
            }
            table.row(cells);
        }
        blocks.push(Block::Table(table));
    }
    if blocks.is_empty() {
        blocks.push(Block::Paragraph("No combination can be built.".into()));
    }
    blocks
}

fn looked_at(study: &Study) -> Vec<Block> {
    let found = &study.found;
    let caption = "Rods by what they break. A rod counts for every limit that it breaks; its frequency is looked at only \
         where it keeps all others.";
    let mut table =
        Table::new("infeasible", caption, vec![Column::text("because of"), Column::number("rods", "")]);
    for (limit, count) in study.space.limits.iter().zip(&found.broken) {
        table.row(vec![limit_words(limit), count.to_string()]);
    }
    for (why, count) in Impossible::ALL.iter().zip(found.impossible).filter(|(_, count)| *count > 0) {
        table.row(vec![why.description().to_owned(), count.to_string()]);
    }
    let mut blocks = vec![Block::Paragraph(format!(
        "{} of {} were looked at, with tubes from a catalogue of {}; {} all limits.",
        found.evaluated,
        count(study.space.combinations(), "combination"),
        study.space.tubes.len(),
        verb(found.feasible)
    ))];
    if !study.space.limits.is_empty() || found.impossible.iter().any(|count| *count > 0) {
        blocks.push(Block::Table(table));
    }
    blocks
}
