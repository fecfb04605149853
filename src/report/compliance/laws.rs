//! The laws of a rod's file: what they do to its compliance, and at which load.

use nalgebra::Vector3;
use serde_json::{Value, json};

use super::numbers::{DIGITS, in_um, rows};
use crate::compliance::{Mode, Study};
use crate::report::Block;
use crate::report::table::{Column, Table};
use crate::rod::{LawConstant, RodLaw};
use crate::statistics::HALF_95;
use crate::units::{UM, significant, with_uncertainty};

/// All laws of the file, those that the numbers hold with the compliance over the load; null
/// without one.
pub fn json(study: &Study) -> Value {
    if study.rod.laws.is_empty() {
        return Value::Null;
    }
    let constant = |own: &LawConstant| {
        json!({
            "name": own.name,
            "value": own.value,
            "standard_uncertainty": own.standard_uncertainty,
            "correlation": own.correlation,
            "unit": own.unit,
        })
    };
    let law = |law: &RodLaw| {
        json!({
            "place": law.place.to_string(),
            "variable": law.variable.key(),
            "formula": law.formula,
            "unit": law.unit(),
            "constants": law.constants.iter().map(constant).collect::<Vec<_>>(),
            "range": [law.range.0, law.range.1],
            "source": law.source,
            "used": is_used(study) && study.laws.laws().any(|used| used == law),
        })
    };
    let at = |load: f64| {
        let secant = study.laws.secant(&study.linear, load);
        json!({
            "load_n": load,
            "cf_um_per_n": rows(&secant.force, UM),
            "u_cf_um_per_n": rows(&study.laws.secant_uncertainty(&study.linear, load).force, UM),
            "beyond_what_was_recorded": is_beyond(study, load),
        })
    };
    json!({
        "laws": study.rod.laws.iter().map(law).collect::<Vec<_>>(),
        "cf_um_per_n_without": rows(&study.linear.force, UM),
        "cg_um_per_g_without": rows(&study.linear.gravity, UM),
        "at_loads": loads(study).into_iter().map(at).collect::<Vec<_>>(),
    })
}

/// What they are, and the compliance over the load.
pub fn blocks(study: &Study) -> Vec<Block> {
    if !is_used(study) || study.laws.is_empty() {
        return Vec::new();
    }
    let laws: Vec<String> = study.laws.laws().map(RodLaw::to_string).collect();
    let words = format!(
        "The rod file has laws beside the beam model: {}. With them the deflection is not proportional to the load: \
         C^F and C^g above are deflection over load at a contact force of {} N and under 1 g. Derivatives, shapes and \
         natural frequencies are those of the beam model.",
        laws.join("; "),
        significant(study.contact_force, 3)
    );
    let columns = ["11", "22", "33"].map(|entry| Column::number(format!("C^F {entry}"), "µm/N"));
    let mut columns: Vec<Column> = std::iter::once(Column::number("load", "N")).chain(columns).collect();
    columns.push(Column::text(""));
    let caption = "Deflection over load along each axis of the tool frame, by the size of the load; ± is half \
                   of the 95 % interval that the constants of the laws bring with them.";
    let mut table = Table::new("compliance-over-load", caption, columns);
    for load in loads(study) {
        let secant = study.laws.secant(&study.linear, load);
        let mut cells = vec![significant(load, 3)];
        let u = study.laws.secant_uncertainty(&study.linear, load).force.diagonal();
        let with_u = |(entry, u): (&f64, &f64)| with_uncertainty(in_um(*entry), HALF_95 * in_um(*u), DIGITS);
        cells.extend(secant.force.diagonal().iter().zip(u.iter()).map(with_u));
        cells.push(if is_beyond(study, load) { "beyond what was recorded".into() } else { String::new() });
        table.row(cells);
    }
    vec![Block::Paragraph(words), Block::Table(table)]
}

/// For the headline; nothing without laws.
pub fn sentence(study: &Study) -> String {
    match (study.laws.is_empty(), is_used(study)) {
        (true, _) => String::new(),
        (false, true) => format!(
            " A law of its file makes C^F depend on the load: these numbers are those at {} N.",
            significant(study.contact_force, 3)
        ),
        (false, false) => " The law of its file is no part of the closed form.".into(),
    }
}

fn is_used(study: &Study) -> bool {
    study.mode == Mode::Fea
}

/// The contact force, and up to the largest load that was recorded; ascending.
fn loads(study: &Study) -> Vec<f64> {
    let largest = study.laws.recorded_load(&study.linear.force).filter(|load| *load > 0.0);
    let parts = largest.into_iter().flat_map(|load| [0.25, 0.5, 1.0].map(|share| share * load));
    let mut loads: Vec<f64> = parts.chain([study.contact_force]).filter(|load| *load > 0.0).collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    loads
}

fn is_beyond(study: &Study, load: f64) -> bool {
    let axes = (0..3).map(|axis| Vector3::ith(axis, load));
    axes.into_iter()
        .any(|force| !study.laws.beyond(&study.linear.force, &force, &Vector3::zeros()).is_empty())
}
