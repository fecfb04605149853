//! What the `compliance` command says: JSON, tables and pictures of a [`Study`].

mod known;
mod laws;
mod numbers;
pub(super) mod steps;

use known::Known;
pub(super) use numbers::in_um;
pub use numbers::{number, rows};

use nalgebra::Matrix3;
use serde_json::{Value, json};

use super::method;
use super::pictures::{RodShape, ShapeCase, rod_shape};
use super::rod_drawing::drawing;
use super::sensitivities::{self, OnePercent};
use super::table::{Column, Table};
use super::{Block, Card, Report, Section, swing};
use crate::beam::{NaturalMode, settling_time};
use crate::compliance::{
    Compliance, LINEAR_SHARE, Mode, Sensitivity, Shape, StationResponse, Strength, Study, TipLoad,
};
use crate::rod::{NominalNumber, Rod};
use crate::units::{GRAM, MM, MPA, UM, URAD, significant};

const AXES: [&str; 3] = ["x", "y", "z"];

/// The JSON of `rodcal compliance --json`.
pub fn json(study: &Study) -> Value {
    let compliance = study.compliance();
    let steps: Vec<Value> = study
        .steps
        .iter()
        .map(|step| {
            json!({
                "term": step.term,
                "cf_um_per_n": rows(&step.added.force, UM),
                "cg_um_per_g": rows(&step.added.gravity, UM),
                "c_rod_um": step.total.index(study.contact_force) / UM,
            })
        })
        .collect();
    json!({
        "rod": study.rod.name,
        "rod_source": study.rod.source,
        "mode": mode_name(study.mode),
        "theory": theory(study),
        "elements": study.elements,
        "cf_um_per_n": rows(&compliance.force, UM),
        "cg_um_per_g": rows(&compliance.gravity, UM),
        "c_rod_um": study.index() / UM,
        "contact_force_n": study.contact_force,
        "tip_mm": (study.rod.tip() / MM).as_slice(),
        "mass_g": study.rod.mass() / GRAM,
        "natural_frequencies_hz": study.shape.modes.iter().map(|mode| mode.frequency).collect::<Vec<_>>(),
        "settling_times_s": study.damping_ratio.map(|ratio| {
            let time = |mode: &NaturalMode| settling_time(mode.frequency, ratio, swing::SHARE);
            study.shape.modes.iter().map(time).collect::<Vec<_>>()
        }),
        "contributions": steps,
        "sensitivities": study.sensitivities.iter().map(sensitivity_json).collect::<Vec<_>>(),
        "one_percent_more": sensitivities::json(&one_percent_more(study), &PERCENTS),
        "laws": laws::json(study),
        "stations": study.stations.map(|stations| json!({
            "load_station_mm": stations.load / MM,
            "read_station_mm": stations.read / MM,
            "displacement_um_per_n": rows(&stations.motion.translation, UM),
            "rotation_urad_per_n": rows(&stations.motion.rotation, URAD),
        })),
        "warnings": warnings(study),
    })
}

/// The report of `rodcal compliance`.
pub fn report(study: &Study) -> Report {
    let rod = &study.rod;
    Report {
        title: format!("Compliance of rod {}", rod.name),
        headline: headline(study),
        warnings: warnings(study),
        sections: sections(study),
        cards: cards(study),
        method: method::paragraphs(method::COMPLIANCE),
        ..Report::default()
    }
}

/// The sections of [`report`], for reports that hold more than one rod.
pub fn sections(study: &Study) -> Vec<Section> {
    let rod = &study.rod;
    let mut tables = vec![Block::Paragraph(
        "The tip's deflection in the tool frame is C^g·g + C^F·F, with gravity g in units of g and the contact \
         force F in newtons, both in the tool frame. Rows: axis of the offset; columns: axis of the load."
            .into(),
    )];
    tables.extend(
        rod.source.iter().map(|source| Block::Paragraph(format!("Source of the rod's numbers: {source}"))),
    );
    match &study.calc {
        Ok(calc) => tables.push(matrices("calc", "Calc: closed form, Eqs 15 and 17.", calc)),
        Err(why) => tables.push(Block::Paragraph(format!("{why}."))),
    }
    tables.push(matrices("fea", &format!("FEA: beam model, {}.", physics_name(study)), &study.fea));
    tables.extend(laws::blocks(study));
    tables.extend(study.stations.as_ref().map(station_table));
    let force_cases = AXES.map(|axis| format!("1 N along +{}", axis.to_uppercase()));
    let gravity_cases = AXES.map(|axis| format!("1 g along +{}", axis.to_uppercase()));
    let mut sections = vec![
        Section::new(format!("Compliance of the tip, rod {}", rod.name), tables),
        Section::new(
            format!("What each left-out term is worth, rod {}", rod.name),
            vec![
                Block::Paragraph(
                    "From the closed form to the model as built: each row adds its term to all above it, \
                     so that the rows add up to FEA exactly."
                        .into(),
                ),
                Block::Table(steps::table(study)),
                Block::Figure(
                    steps::figure(study)
                        .captioned(format!("Rod {}: what Calc leaves out, term by term.", rod.name)),
                ),
            ],
        ),
        Section::new(
            format!("Shape, rod {}", rod.name),
            vec![
                shape_figure(rod, &study.shape, &gravity_cases, &study.shape.under_gravity).named_block(
                    "shape-gravity",
                    "Deflection under one g along each axis of the tool frame.",
                ),
                shape_figure(rod, &study.shape, &force_cases, &study.shape.under_force).named_block(
                    "shape-force",
                    "Deflection under 1 N at the tip along each axis of the tool frame.",
                ),
            ],
        ),
    ];
    sections.extend(what_counts(study));
    sections.extend(swing::section(
        &study.rod,
        &study.shape.centreline,
        &study.shape.modes,
        study.damping_ratio,
    ));
    sections
}

/// Figures of [`one_percent_more`], in its order.
const PERCENTS: [&str; 5] = [
    "c_rod_um_percent",
    "cf_max_um_per_n_percent",
    "cg_max_um_per_g_percent",
    "mass_g_percent",
    "first_frequency_hz_percent",
];

/// Derivatives of everything by one number, per unit of its key.
fn sensitivity_json(one: &Sensitivity) -> Value {
    let (_, si) = one.number.in_file();
    let mut object = sensitivities::number_json(&one.number, one.value);
    let rows_of = |matrix: &Matrix3<f64>| json!(rows(&(matrix * si), UM));
    object.insert("cf_um_per_n".into(), rows_of(&one.compliance.force));
    object.insert("cg_um_per_g".into(), rows_of(&one.compliance.gravity));
    object.insert("c_rod_um".into(), (one.index * si / UM).into());
    object.insert("mass_g".into(), (one.mass * si / GRAM).into());
    object.insert("first_frequency_hz".into(), (one.frequency * si).into());
    object.into()
}

fn one_percent_more(study: &Study) -> Vec<OnePercent> {
    let largest = |matrix: &Matrix3<f64>| {
        let at = (0..9).max_by(|&a, &b| matrix[a].abs().total_cmp(&matrix[b].abs())).unwrap_or(0);
        (at, matrix[at])
    };
    let ((force_at, force), (gravity_at, gravity)) = (largest(&study.fea.force), largest(&study.fea.gravity));
    let frequency = study.shape.modes.first().map_or(f64::INFINITY, |mode| mode.frequency);
    let figures = [study.fea.index(study.contact_force), force, gravity, study.rod.mass(), frequency];
    let slopes: Vec<(NominalNumber, Vec<f64>)> = study
        .sensitivities
        .iter()
        .map(|one| {
            let (force, gravity) = (one.compliance.force[force_at], one.compliance.gravity[gravity_at]);
            (one.number.clone(), vec![one.index, force, gravity, one.mass, one.frequency])
        })
        .collect();
    sensitivities::one_percent_more(&study.rod, &slopes, &figures)
}

/// What 1 % more of each number does; nothing where that is not known.
fn what_counts(study: &Study) -> Option<Section> {
    let (rod, rows) = (&study.rod, one_percent_more(study));
    if rows.is_empty() {
        return None;
    }
    let caption = format!(
        "Rod {}: change of each figure (beam model) by 1 % more of one number, all others kept; exact derivatives.",
        rod.name
    );
    let heads = ["c_rod", "largest C^F", "largest C^g", "mass", "first frequency"];
    let chart = sensitivities::bars(
        format!("Rod {}", rod.name),
        &rows,
        &[(0, "c_rod"), (3, "mass"), (4, "first frequency")],
    );
    let figure = super::chart::Figure::from(chart)
        .named_block("sensitivities", "What 1 % more of each number does: the numbers that count most.");
    let table = Block::Table(sensitivities::table("sensitivities", caption, &heads, &rows));
    Some(Section::new(format!("What counts, rod {}", rod.name), vec![table, figure]))
}

/// One sentence: how much the rod bends.
pub fn headline(study: &Study) -> String {
    if let Some(words) = beyond_linear(study) {
        return words;
    }
    if let Some(words) = overloaded(study) {
        return words;
    }
    let mode = match study.mode {
        Mode::Calc => "the closed form".to_owned(),
        Mode::Fea => format!("the beam model ({})", physics_name(study)),
    };
    let known = Known::of(study);
    format!(
        "Rod {} bends at its tip by up to {} µm per newton and {} µm under one g; its compliance index c_rod is {} µm by \
         {mode}.{}",
        study.rod.name,
        known.force,
        known.gravity,
        known.index,
        laws::sentence(study)
    )
}

/// Why no number of this rod holds, where it bends too far.
fn beyond_linear(study: &Study) -> Option<String> {
    let (load, share) = study.beyond_linear()?;
    let load = match load {
        TipLoad::OneG => "its own weight".to_owned(),
        TipLoad::ContactForce => format!("{} N", significant(study.contact_force, 3)),
    };
    let far = match share {
        ..10.0 => format!("by {:.0} % of its length", 100.0 * share),
        1e6.. => "by more than a million times its length".to_owned(),
        _ => format!("by {share:.0} times its length"),
    };
    Some(format!(
        "Rod {} is beyond this model: under {load} its tip would move {far}. Deflections are proportional to \
         loads up to about {:.0} % of the length; beyond that the numbers below do not hold. Is a length, \
         a diameter or a modulus in another unit?",
        study.rod.name,
        100.0 * LINEAR_SHARE
    ))
}

/// What the rod does not bear, where it bends little enough.
fn overloaded(study: &Study) -> Option<String> {
    let found = study.overload.as_ref()?;
    let three = |number: f64| significant(number, 3);
    let stress = format!(
        "under its own weight and {} N, each along its worst axis, the stress reaches {} MPa at station {} mm",
        three(study.contact_force),
        three(found.stress / MPA),
        significant(found.station / MM, 4)
    );
    let (name, limit) = (&study.rod.name, three(found.limit / MPA));
    Some(match &found.kind {
        Strength::Material(material) => format!(
            "Rod {name} would stay bent: {stress}, and {material} yields at {limit} MPa. The numbers below are those of a rod \
             that springs back."
        ),
        Strength::Wall(diameter, wall) => format!(
            "The wall of rod {name} would buckle: {stress}, and a tube of {} mm with a wall of {} mm bears about {limit} MPa. The \
             numbers below are those of a tube that keeps its shape. Is a diameter wrong?",
            three(diameter / MM),
            three(wall / MM)
        ),
    })
}

fn cards(study: &Study) -> Vec<Card> {
    if let Some((_, share)) = study.beyond_linear() {
        let share = if share < 1e6 { format!("{:.0} %", 100.0 * share) } else { "> 100 million %".into() };
        return vec![Card::new("Deflection over length", share, "beyond the linear model")];
    }
    if let (Some(found), Some(_)) = (&study.overload, overloaded(study)) {
        let megapascals = |stress: f64| format!("{} MPa", significant(stress / MPA, 3));
        let limit = match &found.kind {
            Strength::Material(material) => format!("{material} yields at {}", megapascals(found.limit)),
            Strength::Wall(..) => format!("the wall bears about {}", megapascals(found.limit)),
        };
        return vec![Card::new("Largest stress", megapascals(found.stress), limit)];
    }
    let known = Known::of(study);
    let mode = match study.mode {
        Mode::Calc => "closed form",
        Mode::Fea => "beam model",
    };
    let mut cards = vec![
        Card::new("Compliance index c_rod", format!("{} µm", known.index), mode),
        Card::new(
            "Tip per newton, at most",
            format!("{} µm/N", known.force),
            "contact force along the worst axis",
        ),
        Card::new("Tip under one g, at most", format!("{} µm", known.gravity), "weight of rod and tip"),
    ];
    let frequency = known
        .frequency
        .map(|hz| Card::new("First natural frequency", format!("{hz} Hz"), "clamped at the flange"));
    cards.extend(frequency);
    cards
}

/// Both matrices of a compliance as one table.
pub fn matrices(name: &str, caption: &str, compliance: &Compliance) -> Block {
    let mut columns = vec![Column::text("offset along")];
    columns.extend(AXES.map(|axis| Column::number(format!("C^F load {axis}"), "µm/N")));
    columns.extend(AXES.map(|axis| Column::number(format!("C^g load {axis}"), "µm/g")));
    let mut table = Table::new(name, caption, columns);
    for (m, axis) in AXES.iter().enumerate() {
        let mut cells = vec![(*axis).to_owned()];
        cells.extend(
            [&compliance.force, &compliance.gravity].iter().flat_map(|c| (0..3).map(|n| number(c[(m, n)]))),
        );
        table.row(cells);
    }
    Block::Table(table)
}

/// Displacement and rotation at one station under a force at another.
fn station_table(response: &StationResponse) -> Block {
    let caption = format!(
        "Read at station {} mm, force at station {} mm (FEA).",
        significant(response.read / MM, 6),
        significant(response.load / MM, 6)
    );
    let mut columns = vec![Column::text("axis")];
    columns.extend(AXES.map(|axis| Column::number(format!("offset, load {axis}"), "µm/N")));
    columns.extend(AXES.map(|axis| Column::number(format!("rotation, load {axis}"), "µrad/N")));
    let mut table = Table::new("stations", caption, columns);
    for (m, axis) in AXES.iter().enumerate() {
        let mut cells = vec![(*axis).to_owned()];
        // µm and µrad are the same factor
        let both = [&response.motion.translation, &response.motion.rotation];
        cells.extend(both.iter().flat_map(|c| (0..3).map(|n| number(c[(m, n)]))));
        table.row(cells);
    }
    Block::Table(table)
}

/// A figure that becomes a block under its own name.
trait NamedBlock {
    fn named_block(self, name: &str, caption: &str) -> Block;
}

impl NamedBlock for super::chart::Figure {
    fn named_block(self, name: &str, caption: &str) -> Block {
        let caption = format!("{caption} {}", self.caption);
        Block::Figure(self.named(name).captioned(caption.trim()))
    }
}

fn shape_figure(
    rod: &Rod,
    shape: &Shape,
    labels: &[String; 3],
    displacements: &[Matrix3<f64>],
) -> super::chart::Figure {
    let cases = labels.iter().enumerate().map(|(axis, label)| ShapeCase {
        label: label.clone(),
        deflection_um: displacements.iter().map(|d| (d.column(axis) / UM).into()).collect(),
    });
    rod_shape(&RodShape {
        centreline_mm: shape.centreline.iter().map(|p| (p / MM).into()).collect(),
        cases: cases.collect(),
        ..drawing(rod)
    })
}

fn warnings(study: &Study) -> Vec<String> {
    let beyond = beyond_linear(study).or_else(|| overloaded(study)).into_iter();
    beyond.chain(study.rod.warnings.iter().map(ToString::to_string)).collect()
}

fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Calc => "calc",
        Mode::Fea => "fea",
    }
}

fn theory(study: &Study) -> &'static str {
    if study.physics.shear && study.mode == Mode::Fea { "timoshenko" } else { "euler-bernoulli" }
}

fn physics_name(study: &Study) -> String {
    let theory = if study.physics.shear { "Timoshenko" } else { "Euler–Bernoulli" };
    format!("{theory}, {} elements", study.elements)
}
