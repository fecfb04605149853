//! From Calc over FEA to Meas, one left-out term after another: as a table and as a waterfall.

use super::numbers::{DIGITS, in_um, number};
use crate::compliance::{Compliance, Step, Study};
use crate::report::chart::Figure;
use crate::report::pictures::{Rung, Waterfall, waterfall};
use crate::report::table::{Column, Table};
use crate::statistics::Estimate;
use crate::units::{UM, significant};

/// What each term adds, and where c_rod stands with it.
pub(super) fn table(study: &Study) -> Table {
    let mut table = Table::new(
        "left-out-terms",
        format!("Rod {}: compliance added by each term, and where c_rod stands with it.", study.rod.name),
        vec![
            Column::text("term"),
            Column::number("C^F 11", "µm/N"),
            Column::number("C^F 22", "µm/N"),
            Column::number("C^F 33", "µm/N"),
            Column::number("C^g 11", "µm/g"),
            Column::number("C^g 22", "µm/g"),
            Column::number("C^g 33", "µm/g"),
            Column::number("c_rod", "µm"),
        ],
    );
    let row = |term: &str, c: &Compliance, index: f64| {
        let diagonal = [c.force, c.gravity].map(|matrix| matrix.diagonal());
        let mut cells = vec![term.to_owned()];
        cells.extend(diagonal.iter().flat_map(|d| d.iter().map(|value| number(*value)).collect::<Vec<_>>()));
        cells.push(significant(index / UM, DIGITS));
        cells
    };
    for (i, step) in study.steps.iter().enumerate() {
        let term = if i == 0 { step.term.to_owned() } else { format!("+ {}", step.term) };
        table.row(row(&term, &step.added, step.total.index(study.contact_force)));
    }
    table.row(row("= FEA", &study.fea, study.fea.index(study.contact_force)));
    table
}

/// From Calc to FEA, the entries along the loads.
pub(super) fn figure(study: &Study) -> Figure {
    type Entry = fn(&Compliance) -> f64;
    let quantities: [(&str, &str, Entry); 4] = [
        ("C^F 22", "µm/N", |c| c.force[(1, 1)]),
        ("C^F 33", "µm/N", |c| c.force[(2, 2)]),
        ("C^g 22", "µm/g", |c| c.gravity[(1, 1)]),
        ("C^g 33", "µm/g", |c| c.gravity[(2, 2)]),
    ];
    let of_title = |(title, unit, entry): (&str, &str, Entry)| {
        ladder(title, unit, &study.steps, |c| in_um(entry(c)), None)
    };
    waterfall(&quantities.map(of_title))
}

/// One quantity: by Calc, what each term adds to it, by FEA, and where it was measured what the
/// readings add to that. `quantity`, linear in the compliance, and `measured` are in `unit`.
pub(in crate::report) fn ladder(
    title: &str,
    unit: &str,
    steps: &[Step],
    quantity: impl Fn(&Compliance) -> f64,
    measured: Option<&Estimate>,
) -> Waterfall {
    let total = |name: &str, value: f64, half_width: Option<f64>| Rung::Total {
        name: name.into(),
        value,
        half_width,
    };
    let mut rungs = Vec::new();
    for (i, step) in steps.iter().enumerate() {
        rungs.push(match i {
            0 => total(step.term, quantity(&step.total), None),
            _ => Rung::Term { name: step.term.into(), added: quantity(&step.added) },
        });
    }
    let model = steps.last().map_or(0.0, |step| quantity(&step.total));
    rungs.push(total("FEA", model, None));
    if let Some(measured) = measured {
        rungs.push(Rung::Remainder { name: "not in the model".into(), added: measured.value - model });
        rungs.push(total("Meas", measured.value, measured.half_width_95()));
    }
    Waterfall { title: title.into(), unit: unit.into(), rungs }
}
