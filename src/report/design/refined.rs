//! What became of a design between the values of the grid: JSON, a table and rod files.

use serde_json::{Map, Value, json};

use super::cells::{DIGITS, columns, figures_json, shape_cells, shape_columns};
use crate::design::{Better, Design, DesignSpace, Figures, Goal, Refined, Study};
use crate::report::table::{Column, Table};
use crate::report::{Block, Section};
use crate::rod::{Pipe, Rod};
use crate::units::{MM, significant};

/// What the JSON has of it.
pub fn json(space: &DesignSpace, found: &Refined) -> Value {
    let of_better = |better: &Option<Better>| {
        better.as_ref().map(|better| {
            let mut object = figures_json(&Design { index: 0, figures: better.figures });
            let rod: Value = toml::from_str(&better.rod.to_toml(&[])).unwrap_or(Value::Null);
            object.insert("rod".into(), rod);
            object.insert("tubes".into(), better.tubes.clone().into());
            object.insert("gained_percent".into(), (100.0 * better.gained).into());
            object
        })
    };
    let weights = space.goals.iter().zip(&found.weights).filter(|(_, weight)| **weight > 0.0);
    let goal: Map<String, Value> =
        weights.map(|(goal, weight)| (goal.figure.key().to_owned(), (*weight).into())).collect();
    json!({
        "from_design": found.place + 1,
        "goal": goal,
        "starts": found.starts.0,
        "starts_that_led_there": found.starts.1,
        "every_tube_tried": found.is_every_tube,
        "continuous": of_better(&found.continuous),
        "catalogue": of_better(&found.catalogue),
    })
}

/// The design, the best that could be made and the best that can be bought.
pub fn section(study: &Study, found: &Refined) -> Section {
    let figures = columns(study);
    let mut heads = vec![Column::text(""), Column::text("tube")];
    heads.extend(shape_columns(study));
    heads.extend(figures.iter().map(|figure| {
        let (name, unit) = figure.name_and_unit();
        Column::number(name, unit)
    }));
    let word = goal_words(study, found);
    let caption = format!(
        "From design {}: {word} is improved, no other goal becomes worse, all limits are kept. Ranges of the design file and \
         sizes of tubes may take any value between their ends; then {} of the catalogue are tried.",
        found.place + 1,
        if found.is_every_tube { "all tubes" } else { "the nearest tubes" }
    );
    let mut table = Table::new("refined", caption, heads);
    let mut row = |name: &str, rod: &Rod, tube: String, values: &Figures| {
        let mut cells = vec![name.to_owned(), tube];
        cells.extend(shape_cells(study, rod));
        let value = |figure| values.get(figure).map_or("–".to_owned(), |v| significant(v, DIGITS));
        cells.extend(figures.iter().map(|figure| value(*figure)));
        table.row(cells);
    };
    if let Some(design) = study.found.front.get(found.place)
        && let Ok(rod) = study.space.rod(design.index)
    {
        let tubes = study.space.tubes_of(design.index).join(" + ");
        row(&format!("design {}", found.place + 1), &rod, tubes, &design.figures);
    }
    let named = |better: &Better| match better.tubes.is_empty() {
        true => sizes(&better.rod),
        false => better.tubes.join(" + "),
    };
    for (name, better) in [("any tube", &found.continuous), ("to be bought", &found.catalogue)] {
        if let Some(better) = better {
            row(name, &better.rod, named(better), &better.figures);
        }
    }
    let gained = |better: &Better| format!("{} %", significant(100.0 * better.gained, 2));
    let said = match (&found.continuous, &found.catalogue) {
        (None, _) => {
            format!("Nothing is gained: no rod was found that improves {word} and makes no other goal worse.")
        }
        (Some(any), Some(bought)) => format!(
            "{word} becomes {} better with tubes of the catalogue, {} if tubes of any size could be had.",
            gained(bought),
            gained(any)
        ),
        (Some(any), None) => format!(
            "{word} would become {} better with a tube that the catalogue does not have; with its tubes nothing is gained.",
            gained(any)
        ),
    };
    let said = match said.strip_prefix("the ") {
        Some(rest) => format!("The {rest}"),
        None => said,
    };
    Section::new(
        "Between the grid's values",
        vec![Block::Paragraph(format!("{said} {}", proven(study, found))), Block::Table(table)],
    )
}

/// What is bettered: "c_rod", or "the mean of c_rod (weight 0.67) and mass (weight 0.33)".
fn goal_words(study: &Study, found: &Refined) -> String {
    let weighed = study.space.goals.iter().zip(&found.weights).filter(|(_, weight)| **weight > 0.0);
    let words = |(goal, weight): (&Goal, &f64)| (goal.figure.name_and_unit().0, significant(*weight, 2));
    let all: Vec<(&str, String)> = weighed.map(words).collect();
    match &all[..] {
        [(only, _)] => (*only).to_owned(),
        several => {
            let each: Vec<String> =
                several.iter().map(|(word, weight)| format!("{word} (weight {weight})")).collect();
            format!("the weighted geometric mean of {}", each.join(" and "))
        }
    }
}

/// What is sure of the optimum and what is not.
fn proven(study: &Study, found: &Refined) -> String {
    let grid = match study.found.evaluated == study.space.combinations() {
        true => "No rod of the grid is better: all were looked at.",
        false => "Of the grid only some rods were looked at.",
    };
    let (count, led) = found.starts;
    let starts = match count {
        1 => "It was looked for from this design alone".to_owned(),
        _ => format!(
            "Of {count} searches, from all over the grid and from the ends of the ranges, {led} led to this rod"
        ),
    };
    format!("{grid} {starts}: that no better one exists between the grid's values is not proven.")
}

/// `steel 32.4x1.13`: material, outer diameter and wall of the tubes, mm.
fn sizes(rod: &Rod) -> String {
    let size = |pipe: &Pipe| match (pipe.section.as_round(), pipe.section.wall()) {
        (Some(round), Some(wall)) => format!(
            "{} {}x{}",
            pipe.material.name,
            significant(round.outer_diameter / MM, 4),
            significant(wall / MM, 3)
        ),
        _ => "–".to_owned(),
    };
    let mut sizes = vec![size(&rod.pipe1), size(&rod.pipe2)];
    sizes.dedup();
    sizes.join(" + ")
}

/// The rods as files.
pub fn files(found: &Refined, above: &[String]) -> Vec<(String, Vec<u8>)> {
    let all = [("refined-any-tube.toml", &found.continuous), ("refined.toml", &found.catalogue)];
    let file = |(name, better): (&str, &Option<Better>)| {
        let better = better.as_ref()?;
        let rod = Rod { name: format!("design {} refined", found.place + 1), ..better.rod.clone() };
        Some((name.to_owned(), rod.to_toml(above).into_bytes()))
    };
    all.into_iter().filter_map(file).collect()
}
