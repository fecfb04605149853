//! What `design poses` says: JSON, tables and pictures of a [`PoseStudy`].

mod figures;

use serde_json::{Map, Value, json};

use super::method;
use super::table::{Column, Table};
use super::{Block, Card, Report, Section, Tone, forecast};
use crate::calibration::campaign::GroupName;
use crate::delimited::{cell, visible};
use crate::design::{Known, Obstacle, PoseCriterion, PoseStudy, Source};
use crate::robot::Motion;
use crate::units::{DEG, MM, UM, significant};

/// Parameters that a table shows: those that gain least.
const PARAMETERS: usize = 10;

/// The JSON of `rodcal design poses --json`.
pub fn json(study: &PoseStudy) -> Value {
    let names = columns(study);
    let poses = rows(study).map(|(names_of, q)| {
        let mut object = Map::new();
        for (key, value) in names.iter().zip(names_of) {
            object.insert(key.clone(), value.into());
        }
        for (key, value) in names.iter().skip(object.len()).zip(&q) {
            object.insert(key.clone(), json!(value));
        }
        Value::Object(object)
    });
    let [o1, o2, o3, o4, o5] = study.observability.indices;
    let refused: Map<String, Value> = Obstacle::ALL
        .into_iter()
        .map(|obstacle| (obstacle.key().to_owned(), json!(refused(study, obstacle))))
        .collect();
    let parameters = study.known.iter().map(|known| {
        let unit = known.parameter.unit();
        json!({
            "name": known.parameter.to_string(),
            "unit": unit.suffix,
            "before": known.before / unit.si,
            "after": known.after / unit.si,
        })
    });
    json!({
        "poses": poses.collect::<Vec<_>>(),
        "criterion": study.wanted.criterion.key(),
        "value": study.value,
        "value_random_median": study.value_random,
        "value_is_better": if study.wanted.criterion.is_larger_better() { "larger" } else { "smaller" },
        "worth_random_poses": study.worth,
        "unseen_combinations": study.unseen_combinations,
        "observability": {
            "o1": o1, "o2": o2, "o3": o3, "o4": o4, "o5": o5, "condition": study.observability.condition,
        },
        "candidates": study.candidates.poses.len(),
        "looked_at": study.candidates.tried,
        "alike": study.candidates.alike,
        "refused": refused,
        "parameters": parameters.collect::<Vec<_>>(),
        "noise_um": study.budget.noise / UM,
        "unseen": study.unseen,
        "aligned": study.is_aligned,
        "forecast_um": forecast::json(&study.forecast),
        "forecast_random_um": forecast::json(&study.forecast_random),
    })
}

fn refused(study: &PoseStudy, obstacle: Obstacle) -> usize {
    study.candidates.refused.iter().map(|of_place| of_place[obstacle as usize]).sum()
}

/// Columns of a recording that name a pose and its place, then its joints.
fn columns(study: &PoseStudy) -> Vec<String> {
    let of_place: &[&str] = match study.places.first().map(|place| &place.name) {
        None | Some(GroupName::Tracked) => &["pose"],
        Some(GroupName::Clamp(_)) => &["pose", "clamp"],
        Some(GroupName::Socket { .. }) => &["pose", "placement", "socket"],
    };
    let joints = study.setup.robot.joints.iter().zip(1..).map(|(joint, number)| joint.column(number).0);
    of_place.iter().map(|name| (*name).to_owned()).chain(joints).collect()
}

/// Names and joint values (in the units of their columns, as written) of the chosen poses.
fn rows<'s>(study: &'s PoseStudy) -> impl Iterator<Item = (Vec<String>, Vec<f64>)> + 's {
    study.chosen.iter().zip(1..).map(|((place, q), number): (_, usize)| {
        let mut names = vec![number.to_string()];
        match &study.places[*place].name {
            GroupName::Tracked => {}
            GroupName::Clamp(id) => names.push(id.clone()),
            GroupName::Socket { placement, socket } => names.extend([placement.clone(), socket.clone()]),
        }
        let values = q.iter().zip(&study.setup.robot.joints).map(|(q, joint)| {
            let unit = if joint.motion == Motion::Revolute { DEG } else { MM };
            (q / unit * 1e4).round() / 1e4
        });
        (names, values.collect())
    })
}

/// `poses.csv`: the chosen poses as `measurements.csv` has them, without positions.
pub fn files(study: &PoseStudy) -> Vec<(String, Vec<u8>)> {
    let mut text = format!(
        "# PLANNED for {}: {} poses by {}\n{}\n",
        visible(&study.campaign.file),
        study.chosen.len(),
        study.wanted.criterion.name(),
        columns(study).join(",")
    );
    for (names, q) in rows(study) {
        let cells: Vec<String> =
            names.iter().map(|name| cell(name)).chain(q.iter().map(|q| format!("{q:.4}"))).collect();
        text += &format!("{}\n", cells.join(","));
    }
    vec![("poses.csv".into(), text.into_bytes())]
}

fn warnings(study: &PoseStudy) -> Vec<String> {
    let mut warnings: Vec<String> = study.campaign.warnings.iter().map(ToString::to_string).collect();
    if study.unseen_combinations > 0 {
        warnings.push(format!(
            "{} of the {} parameters cannot be seen from any pose at {}: {} is that of the others, and the calibration \
             leaves them as they are. More clamps would show them",
            match study.unseen_combinations {
                1 => "One combination".to_owned(),
                count => format!("{count} combinations"),
            },
            study.known.len(),
            if study.places.len() == 1 { "one clamp".to_owned() } else { format!("{} clamps", study.places.len()) },
            study.wanted.criterion.name(),
        ));
    }
    warnings
}

/// The report of `rodcal design poses`.
pub fn report(study: &PoseStudy) -> Report {
    let pair = [
        ("these poses".to_owned(), &study.forecast),
        ("as many random poses, one draw".to_owned(), &study.forecast_random),
    ];
    let sections = vec![
        Section::new(
            "The plan",
            vec![
                Block::Figure(figures::plan(study)),
                Block::Figure(figures::joints(study)),
                Block::Table(places(study)),
            ],
        ),
        Section::new("What they are worth", worth(study)),
        Section::new(
            "What to expect",
            vec![
                Block::Paragraph(assumptions(study)),
                Block::Figure(forecast::stacked(&pair)),
                Block::Table(forecast::table("forecast", "calibrated with", &pair)),
            ],
        ),
        Section::new("The poses", vec![Block::Table(poses(study))]),
    ];
    Report {
        title: format!("Poses for {}", study.campaign.file),
        headline: headline(study),
        cards: cards(study),
        method: method::paragraphs(method::POSE_DESIGN),
        warnings: warnings(study),
        sections,
        ..Report::default()
    }
}

/// What there is to measure, what it is worth, and what to expect.
fn cards(study: &PoseStudy) -> Vec<Card> {
    let um = |size: f64| format!("{} µm", significant(size / UM, 3));
    let detail = match study.places.len() {
        1 => format!("of {} candidates", study.candidates.poses.len()),
        count => format!("at {count} places, of {} candidates", study.candidates.poses.len()),
    };
    let (worth, tone) = match study.worth {
        Some(times) if times >= 1.02 => (format!("{} times", significant(times, 2)), Tone::Good),
        Some(_) => ("no more".to_owned(), Tone::Attention),
        None => ("over 20 times".to_owned(), Tone::Good),
    };
    let criterion = study.wanted.criterion.name();
    let mode = format!("after calibration in mode {}", study.forecast.mode.name());
    vec![
        Card::new("Poses", study.chosen.len().to_string(), detail),
        Card::new("Worth in random poses", worth, format!("by {criterion}")).toned(tone),
        Card::new("Mean error to be expected", um(study.forecast.mean), mode),
        Card::new(
            "95 % of unseen poses are better than",
            um(study.forecast.p95),
            "where the robot will be used",
        ),
    ]
}

/// How much better the chosen poses are than random ones, and what to expect of them.
pub fn headline(study: &PoseStudy) -> String {
    let places = match study.places.len() {
        1 => String::new(),
        count => format!(" at {count} places"),
    };
    let worth = match study.worth {
        Some(times) if times >= 1.02 => {
            format!("worth {} times as many random poses", significant(times, 2))
        }
        Some(_) => "no better than random poses".to_owned(),
        None => "worth more than 20 times as many random poses".to_owned(),
    };
    let um = |size: f64| significant(size / UM, 3);
    format!(
        "{} poses{places}, chosen by {} from {} candidates, are {worth}. Forecast after calibration in mode {}: the tip is \
         wrong by {} µm on average, by less than {} µm at 95 % of unseen poses.",
        study.chosen.len(),
        study.wanted.criterion.name(),
        study.candidates.poses.len(),
        study.forecast.mode.name(),
        um(study.forecast.mean),
        um(study.forecast.p95)
    )
}

/// What the forecast stands on.
fn assumptions(study: &PoseStudy) -> String {
    let (budget, unseen) = (study.budget.clone(), study.unseen.clone());
    let has_clamps = !study.campaign.clamps.is_empty();
    forecast::Basis { budget, unseen, is_aligned: study.is_aligned, has_clamps }.description()
}

fn places(study: &PoseStudy) -> Table {
    let mut heads =
        vec![Column::text("place"), Column::number("chosen", ""), Column::number("candidates", "")];
    let met: Vec<Obstacle> =
        Obstacle::ALL.into_iter().filter(|obstacle| refused(study, *obstacle) > 0).collect();
    heads.extend(met.iter().map(|obstacle| Column::number(obstacle.short(), "")));
    let limits = &study.wanted.limits;
    let caption = format!(
        "Chosen poses and candidates by place, then configurations that were refused, by what they break first: out of reach, joint \
         limits, the cone of {}° about the clamp's axis, the block of {} mm about a clamp, the table. {} more had no joint that \
         differs by {}° from another one.",
        significant(limits.cone / DEG, 3),
        significant(limits.clear / MM, 3),
        study.candidates.alike,
        significant(limits.change / DEG, 3)
    );
    let mut table = Table::new("places", &caption, heads);
    for (place, group) in study.places.iter().enumerate() {
        let of_poses = |poses: &[(usize, Vec<f64>)]| poses.iter().filter(|(own, _)| *own == place).count();
        let name = if group.name.is_tracked() { "anywhere".to_owned() } else { group.name.to_string() };
        let mut cells = vec![
            name.to_owned(),
            of_poses(&study.chosen).to_string(),
            of_poses(&study.candidates.poses).to_string(),
        ];
        cells.extend(
            met.iter().map(|obstacle| study.candidates.refused[place][*obstacle as usize].to_string()),
        );
        table.row(cells);
    }
    table
}

fn worth(study: &PoseStudy) -> Vec<Block> {
    let (name, unit) = study.wanted.criterion.name_and_unit();
    let better = if study.wanted.criterion.is_larger_better() { "larger" } else { "smaller" };
    let number = |value: f64| format!("{} {unit}", significant(value, 4)).trim_end().to_owned();
    let same = match study.wanted.criterion {
        PoseCriterion::O1 | PoseCriterion::D => {
            " O1 and D are both determinants: D also counts what is known of the robot before."
        }
        _ => "",
    };
    let source = match &study.wanted.source {
        Source::Generated(_) => format!("{} random configurations", study.candidates.tried),
        Source::File(file, _) => format!("{} poses of {file}", study.candidates.tried),
    };
    let [o1, o2, o3, o4, o5] = study.observability.indices;
    let mut blocks = vec![
        Block::Paragraph(format!(
            "{name}: {}, {better} is better; as many random poses of the same candidates have {} (median of 101 plans).{same} \
             The candidates are from {source}.",
            number(study.value),
            number(study.value_random)
        )),
        Block::Paragraph(format!(
            "Observability: O1 {}, O2 {}, O3 {}, O4 {}, O5 {}, condition {} (of columns of norm 1).",
            significant(o1, 4),
            significant(o2, 3),
            significant(o3, 3),
            significant(o4, 3),
            significant(o5, 3),
            significant(study.observability.condition, 3)
        )),
    ];
    let mut known: Vec<&Known> = study.known.iter().collect();
    known.sort_by(|a, b| (b.after / b.before).total_cmp(&(a.after / a.before)));
    let heads = vec![
        Column::text("parameter"),
        Column::units(),
        Column::in_row_unit("before"),
        Column::in_row_unit("after"),
        Column::number("left", "%"),
    ];
    let caption = "Standard uncertainty of parameters before the calibration (robot file, class of the drives, range of a rough \
                   start) and after it; those that the poses show least.";
    let mut table = Table::new("parameters", caption, heads);
    for known in known.into_iter().take(PARAMETERS) {
        let unit = known.parameter.unit();
        table.row([
            known.parameter.description(),
            unit.symbol.to_owned(),
            significant(known.before / unit.si, 2),
            significant(known.after / unit.si, 2),
            significant(100.0 * known.after / known.before, 2),
        ]);
    }
    blocks.push(Block::Table(table));
    blocks
}

fn poses(study: &PoseStudy) -> Table {
    let names = columns(study);
    let heads = names.iter().map(|name| match name.starts_with('q') {
        true => Column::number(name.clone(), ""),
        false => Column::text(name.clone()),
    });
    let caption = "The poses in the order in which they are measured: at each place from one to the nearest that is left.";
    let mut table = Table::new("poses", caption, heads.collect());
    for (names, q) in rows(study) {
        table.row(names.into_iter().chain(q.iter().map(|q| format!("{q:.2}"))));
    }
    table
}
