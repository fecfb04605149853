//! What is written back to the rod: its compliance as its file gives it, by the paper's one ratio,
//! and with the physics found.

use serde_json::{Value, json};

use crate::compliance::{Compliance, paper_contact_force};
use crate::diagnosis::rig::{Correction, WrittenItem};
use crate::report::compliance::{matrices, rows};
use crate::report::table::{Column, Table};
use crate::report::{Block, Section};
use crate::units::{UM, significant};

pub fn json(correction: &Correction) -> Value {
    let of_compliance = |compliance: &Compliance| {
        json!({
            "cf_um_per_n": rows(&compliance.force, UM),
            "cg_um_per_g": rows(&compliance.gravity, UM),
            "c_rod_um": compliance.index(paper_contact_force()) / UM,
        })
    };
    let texts = |items: &[WrittenItem]| items.iter().map(WrittenItem::to_string).collect::<Vec<_>>();
    json!({
        "fea": of_compliance(&correction.before),
        "corrected": of_compliance(&correction.after),
        "r_rod": correction.by_ratio.as_ref().map(|(ratio, _)| ratio),
        "r_rod_times_fea": correction.by_ratio.as_ref().map(|(_, compliance)| of_compliance(compliance)),
        "entered": texts(&correction.entered),
        "removed": texts(&correction.removed),
        "left_out": texts(&correction.left_out),
    })
}

pub fn section(correction: &Correction) -> Section {
    let mut blocks = vec![Block::Paragraph(
        "With --apply the findings are written into files: effects of the rod, and better values of its \
         numbers, into its rod file; effects of the rig are removed from the readings. The compliance under gravity, C^g, then \
         follows from these effects and not from one factor r_rod."
            .into(),
    )];
    let lists = [
        ("Written into the rod file", &correction.entered),
        ("Removed from the readings", &correction.removed),
        ("Not written, because neither file has a key for it", &correction.left_out),
    ];
    let points: Vec<String> = lists
        .into_iter()
        .flat_map(|(what, items)| items.iter().map(move |item| format!("{what}: {}", item.description())))
        .collect();
    if !points.is_empty() {
        blocks.push(Block::List(points));
    }
    blocks.push(Block::Table(table(correction)));
    blocks.push(matrices("corrected", "The corrected rod (FEA with the findings).", &correction.after));
    Section::new("The corrected rod", blocks)
}

/// The diagonals and c_rod by each way.
fn table(correction: &Correction) -> Table {
    let mut columns = vec![Column::text("compliance")];
    for (matrix, unit) in [("C^F", "µm/N"), ("C^g", "µm/g")] {
        columns.extend(["11", "22", "33"].map(|entry| Column::number(format!("{matrix} {entry}"), unit)));
    }
    columns.push(Column::number("c_rod", "µm"));
    let mut table =
        Table::new("correction", "The rod by its file, by one ratio, and with the findings.", columns);
    let mut row = |name: String, compliance: &Compliance| {
        let diagonals = [&compliance.force, &compliance.gravity].map(|matrix| matrix.diagonal());
        let mut cells = vec![name];
        cells.extend(
            diagonals
                .iter()
                .flat_map(|d| d.iter().map(|value| significant(value / UM, 4)).collect::<Vec<_>>()),
        );
        cells.push(significant(compliance.index(paper_contact_force()) / UM, 4));
        table.row(cells);
    };
    row("FEA, rod file".into(), &correction.before);
    if let Some((ratio, compliance)) = &correction.by_ratio {
        row(format!("r_rod × FEA, r_rod = {}", significant(*ratio, 4)), compliance);
    }
    row("FEA, corrected rod".into(), &correction.after);
    table
}
