//! What the `rig fit` command says: JSON, tables and pictures of a rig [`Fit`].

mod figures;

use serde_json::{Map, Value, json};

use super::compliance::{matrices, rows};
use super::method;
use super::table::{Column, Table};
use super::{Block, Card, Report, Section, Tone};
use crate::compliance::paper_contact_force;
use crate::rig::line::{LackOfFit, Line};
use crate::rig::readings::Readings;
use crate::rig::{Fit, Measured};
use crate::rod::Rod;
use crate::statistics::Estimate;
use crate::units::{MM, UM, decimals_of, fixed, significant};

/// No sensor and no weight shows so little, in the units of the tables.
const NOTHING: f64 = 1e-9;

/// The JSON of `rodcal rig fit --json`.
pub fn json(fit: &Fit, readings: &Readings, rod: Option<&Rod>) -> Value {
    let measured = fit.measured.as_ref();
    let by_name = |part: fn(&Estimate) -> Value| -> Value {
        let ratios = measured.map_or(&[][..], |m| &m.ratios);
        ratios.iter().map(|ratio| (ratio.name(), part(&ratio.value))).collect::<Map<_, _>>().into()
    };
    json!({
        "rod": rod.map(|rod| &rod.name),
        "rod_source": rod.and_then(|rod| rod.source.as_ref()),
        "readings_source": readings.source,
        "slopes": fit.lines.iter().map(line_json).collect::<Vec<_>>(),
        "r": by_name(|r| json!(r.value)),
        "r_std_error": by_name(|r| json!(r.std_error)),
        "r_dof": by_name(|r| json!(r.dof)),
        "r_rod": measured.map(|m| m.rod_ratio.value),
        "r_rod_std_error": measured.and_then(|m| m.rod_ratio.std_error),
        "r_rod_dof": measured.map(|m| m.rod_ratio.dof),
        "r_rod_half_width_95": measured.and_then(|m| m.rod_ratio.half_width_95()),
        "cf_um_per_n": measured.map(|m| rows(&m.compliance.force, UM)),
        "cf_std_error_um_per_n": measured.map(|m| rows(&m.std_error.force, UM)),
        "cf_is_measured": measured.map(|m| {
            m.is_measured.row_iter().map(|row| row.iter().copied().collect::<Vec<_>>()).collect::<Vec<_>>()
        }),
        "cg_um_per_g": measured.map(|m| rows(&m.compliance.gravity, UM)),
        "cg_std_error_um_per_g": measured.map(|m| rows(&m.std_error.gravity, UM)),
        "c_rod_um": measured.map(|m| m.compliance.index(paper_contact_force()) / UM),
        "warnings": warnings(fit, readings, rod),
    })
}

fn line_json(line: &Line) -> Value {
    let um = |estimate: &Estimate| estimate.value / UM;
    let error_um = |estimate: &Estimate| estimate.std_error.map(|error| error / UM);
    json!({
        "axis": line.key.direction.to_string(),
        "channel": format!("d{}", line.key.channel),
        "um_per_n": um(&line.slope),
        "std_error": error_um(&line.slope),
        "half_width_95": line.slope.half_width_95().map(|w| w / UM),
        "dof": line.slope.dof,
        "intercept_um": um(&line.intercept),
        "intercept_std_error_um": error_um(&line.intercept),
        "load_offset_n": line.load_offset.map(|e| e.value),
        "load_offset_std_error_n": line.load_offset.and_then(|e| e.std_error),
        "friction_n": line.friction.map(|e| e.value),
        "friction_std_error_n": line.friction.and_then(|e| e.std_error),
        "n": line.count,
        "residual_sd_um": line.residual_sd.map(|sd| sd / UM),
        "noise_um": line.noise_sd.map(|sd| sd / UM),
        "trials_differ": line.trials_differ,
        "lack_of_fit": line.lack_of_fit.map(lack_of_fit_json),
        "quadratic": line.quadratic.map(|curve| {
            let [b0, b1, b2] = curve.coefficients;
            json!({
                "b0_um": um(&b0), "b1_um_per_n": um(&b1), "b2_um_per_n2": um(&b2),
                "b0_std_error_um": error_um(&b0),
                "b1_std_error_um_per_n": error_um(&b1),
                "b2_std_error_um_per_n2": error_um(&b2),
                "residual_sd_um": curve.residual_sd.map(|sd| sd / UM),
                "lack_of_fit": curve.lack_of_fit.map(lack_of_fit_json),
            })
        }),
        "load_station_mm": line.key.load_station.map(|s| s / MM),
        "read_station_mm": line.key.read_station.map(|s| s / MM),
        "distrusted_lines": line.downweighted,
    })
}

fn lack_of_fit_json(test: LackOfFit) -> Value {
    json!({ "f": test.f, "p_value": test.p_value, "dof_fit": test.dof_fit, "dof_repeats": test.dof_repeats })
}

/// The report of `rodcal rig fit`.
pub fn report(fit: &Fit, readings: &Readings, rod: Option<&Rod>) -> Report {
    let name = rod.map_or("a straight line".to_owned(), |rod| format!("rod {}", rod.name));
    Report {
        title: format!("Rig readings of {name}"),
        headline: headline(fit, rod),
        warnings: warnings(fit, readings, rod),
        sections: sections(fit, readings, rod),
        cards: cards(fit, rod),
        method: method::paragraphs(method::RIG_FIT),
        ..Report::default()
    }
}

/// One sentence: what the readings say.
pub fn headline(fit: &Fit, rod: Option<&Rod>) -> String {
    match (&fit.measured, rod) {
        (Some(m), Some(rod)) => {
            let (name, r) = (&rod.name, &m.rod_ratio);
            if !(r.value.is_finite() && r.value > 0.0 && (1.0 / r.value).is_finite()) {
                return format!(
                    "The readings say nothing of rod {name}: they and its model are too far apart."
                );
            }
            let (ratio, word) = if r.value >= 1.0 { (r.value, "softer") } else { (1.0 / r.value, "stiffer") };
            let by = match ratio <= 2.0 {
                true => format!("{} %", significant(100.0 * (ratio - 1.0), 2)),
                false => format!("{} times", significant(ratio, 3)),
            };
            let agrees = r.half_width_95().is_some_and(|w| (r.value - 1.0).abs() <= w);
            let verdict = match agrees {
                true => format!("Rod {name} is as stiff as its model, within the uncertainty"),
                false => format!("Rod {name} is {by} {word} than its model"),
            };
            format!("{verdict}: r_rod = {}{}.", as_known(r), interval(r))
        }
        _ => {
            let words =
                |line: &Line| format!("{}: {} µm/N{}", line.key.label(), line.slope.show(UM), verdict(line));
            format!("{}.", fit.lines.iter().map(words).collect::<Vec<_>>().join("; "))
        }
    }
}

fn cards(fit: &Fit, rod: Option<&Rod>) -> Vec<Card> {
    let mut cards = Vec::new();
    if let (Some(measured), Some(_)) = (&fit.measured, rod) {
        let ratio = &measured.rod_ratio;
        let half = ratio.half_width_95();
        let tone = match half.is_some_and(|w| (ratio.value - 1.0).abs() <= w) {
            true => Tone::Good,
            false => Tone::Attention,
        };
        let detail = half
            .map_or_else(|| "no interval".to_owned(), |w| format!("95 % interval {}", ends(ratio.value, w)));
        cards.push(Card::new("r_rod, measured over modelled", as_known(ratio), detail).toned(tone));
    }
    let curved = fit.lines.iter().filter(|line| line.lack_of_fit.is_some_and(|test| test.is_significant()));
    let curved: Vec<String> = curved.map(|line| line.key.label()).collect();
    let count = fit.lines.len();
    let lines = if count == 1 { "1 line".to_owned() } else { format!("{count} lines") };
    cards.push(match curved.is_empty() {
        true => Card::new("Lines", lines, "none is curved beyond its scatter"),
        false => {
            Card::new("Lines", lines, format!("not straight: {}", curved.join(", "))).toned(Tone::Attention)
        }
    });
    cards
}

fn interval(estimate: &Estimate) -> String {
    match estimate.half_width_95() {
        Some(w) => format!(" (95 % interval {})", ends(estimate.value, w)),
        None => " (no repeats and no third load: no uncertainty)".into(),
    }
}

/// The value with as many decimals as the ends of its interval have. No standard error beside it:
/// a ± would be read as that interval.
fn as_known(estimate: &Estimate) -> String {
    match estimate.half_width_95().and_then(decimals_of) {
        Some(decimals) => fixed(estimate.value, decimals),
        None => four(estimate.value),
    }
}

/// The ends of an interval, to two significant digits of half its width.
fn ends(value: f64, half: f64) -> String {
    match decimals_of(half) {
        Some(decimals) => format!("{} to {}", fixed(value - half, decimals), fixed(value + half, decimals)),
        None => format!("{} to {}", four(value - half), four(value + half)),
    }
}

fn four(value: f64) -> String {
    significant(value, 4)
}

fn verdict(line: &Line) -> String {
    match line.lack_of_fit {
        Some(test) if test.is_significant() => {
            format!(", but the readings do not lie on a straight line (lack of fit F = {})", four(test.f))
        }
        Some(test) => format!(", straight within its scatter (lack of fit F = {})", four(test.f)),
        None => String::new(),
    }
}

/// The sections of [`report`], for reports that hold more than one rod.
pub fn sections(fit: &Fit, readings: &Readings, rod: Option<&Rod>) -> Vec<Section> {
    let name = rod.map_or("straight line".to_owned(), |rod| format!("rod {}", rod.name));
    let mut lines = vec![Block::Paragraph(
        "Repeats are averaged first. Each line has an intercept: the point where it crosses the \
             load axis is the load that friction in the slide (or a tare) takes off. F compares the \
             averages' distance from the line with the scatter of repeats; a p below 0.01 means that \
             the line is not straight."
            .into(),
    )];
    lines.extend(
        readings.source.iter().map(|source| Block::Paragraph(format!("Source of the readings: {source}"))),
    );
    lines.push(Block::Table(lines_table(fit)));
    lines.extend(quadratic_table(fit).map(Block::Table));
    lines.push(Block::Figure(figures::load_deflection(fit, rod)));
    lines.extend(figures::waterfall(fit, rod).map(Block::Figure));
    lines.extend(figures::residuals(fit).map(Block::Figure));
    let mut sections = vec![Section::new(format!("Load–deflection lines, {name}"), lines)];
    if let (Some(measured), Some(rod)) = (&fit.measured, rod) {
        sections.push(measured_section(measured, readings, rod));
    }
    sections
}

fn lines_table(fit: &Fit) -> Table {
    let mut columns = vec![
        Column::text("line"),
        Column::number("slope", "µm/N"),
        Column::number("± s.e.", "µm/N"),
        Column::number("± 95 %", "µm/N"),
        Column::number("crosses at", "N"),
        Column::number("± s.e.", "N"),
        Column::number("noise", "µm"),
        Column::number("readings", ""),
        Column::number("F", ""),
        Column::number("p", ""),
    ];
    // only recordings with an unloading line have one
    let has_friction = fit.lines.iter().any(|line| line.friction.is_some());
    if has_friction {
        columns.push(Column::number("friction", "N"));
    }
    let caption = "Slopes with standard errors; the force counts along the positive axis.";
    let mut table = Table::new("lines", caption, columns);
    for line in &fit.lines {
        table.row([
            line.key.label(),
            known(&line.slope, UM),
            shown(line.slope.std_error, UM, 2),
            shown(line.slope.half_width_95(), UM, 2),
            line.load_offset.map_or("–".into(), |offset| known(&offset, 1.0)),
            shown(line.load_offset.and_then(|e| e.std_error), 1.0, 2),
            shown(line.noise_sd, UM, 2),
            line.count.to_string(),
            shown(line.lack_of_fit.map(|t| t.f), 1.0, 3),
            shown(line.lack_of_fit.map(|t| t.p_value), 1.0, 2),
            shown(line.friction.map(|e| e.value), 1.0, 3),
        ]);
        if line.trials_differ {
            table.notes.push(format!(
                "{}: trials differ by more than their scatter; the standard errors count whole trials.",
                line.key.label()
            ));
        }
    }
    table
}

/// An estimate in its unit, with the decimals of two digits of its standard error, which stands
/// beside it.
fn known(estimate: &Estimate, unit: f64) -> String {
    match estimate.std_error.and_then(|error| decimals_of(error / unit)) {
        Some(decimals) => fixed(estimate.value / unit, decimals),
        // what rounding leaves of nothing
        None if (estimate.value / unit).abs() < NOTHING => "0".to_owned(),
        None => significant(estimate.value / unit, 4),
    }
}

/// A number in its unit, or a dash where there is none.
fn shown(value: Option<f64>, unit: f64, digits: usize) -> String {
    value.map_or("–".into(), |v| significant(v / unit, digits))
}

/// The curves through lines that are not straight.
fn quadratic_table(fit: &Fit) -> Option<Table> {
    let mut table = Table::new(
        "quadratic",
        "The same readings with a quadratic term, offset = b0 + b1·F + b2·F², for the lines that are not straight.",
        vec![
            Column::text("line"),
            Column::number("b0", "µm"),
            Column::number("b1", "µm/N"),
            Column::number("b2", "µm/N²"),
            Column::number("± s.e. of b2", "µm/N²"),
            Column::number("residual s.d.", "µm"),
            Column::number("F", ""),
        ],
    );
    let curved = fit.lines.iter().filter(|line| line.lack_of_fit.is_some_and(|t| t.is_significant()));
    for (line, curve) in curved.filter_map(|line| Some((line, line.quadratic?))) {
        let [b0, b1, b2] = curve.coefficients;
        table.row([
            line.key.label(),
            significant(b0.value / UM, 10),
            significant(b1.value / UM, 10),
            significant(b2.value / UM, 10),
            shown(b2.std_error, UM, 2),
            shown(curve.residual_sd, UM, 5),
            shown(curve.lack_of_fit.map(|t| t.f), 1.0, 3),
        ]);
    }
    (!table.rows.is_empty()).then_some(table)
}

fn measured_section(measured: &Measured, readings: &Readings, rod: &Rod) -> Section {
    let mut table = Table::new(
        "ratios",
        "Correction factors: measured over modelled compliance (Eqs 20, 21).",
        vec![
            Column::text("factor"),
            Column::number("value", ""),
            Column::number("± s.e.", ""),
            Column::number("± 95 %", ""),
        ],
    );
    let mut row = |name: String, estimate: &Estimate| {
        let (error, width) = (estimate.std_error, estimate.half_width_95());
        table.row([name, known(estimate, 1.0), shown(error, 1.0, 2), shown(width, 1.0, 2)]);
    };
    measured.ratios.iter().for_each(|ratio| row(format!("r{}", ratio.name()), &ratio.value));
    row("r_rod".into(), &measured.rod_ratio);
    let mut blocks = vec![
        Block::Paragraph(format!(
            "Measured from {}: entries of C^F that were read are the measured ones (by reciprocity also their \
             transposes); the others, and all of C^g, are r_rod times FEA. With these, c_rod is {} µm.",
            readings.file,
            four(measured.compliance.index(paper_contact_force()) / UM)
        )),
        Block::Table(table),
    ];
    blocks.push(matrices("meas", "Meas.", &measured.compliance));
    // two readings on a line leave nothing to know them by
    if measured.std_error.force.iter().chain(measured.std_error.gravity.iter()).any(|e| e.is_finite()) {
        blocks.push(matrices("meas-errors", "Standard errors of Meas.", &measured.std_error));
    }
    blocks.push(matrices("model", "FEA, for comparison.", &measured.model));
    Section::new(format!("Measured compliance, rod {}", rod.name), blocks)
}

fn warnings(fit: &Fit, readings: &Readings, rod: Option<&Rod>) -> Vec<String> {
    let about_rod = rod.map_or(&[][..], |rod| &rod.warnings).iter().map(ToString::to_string);
    let about_readings = readings.warnings.iter().map(|warning| format!("{}: {warning}", readings.file));
    about_rod.chain(about_readings).chain(fit.warnings.iter().map(ToString::to_string)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig;

    #[test]
    fn an_interval_has_two_digits_of_its_half_width() {
        assert_eq!(ends(1.3811, 0.1171), "1.26 to 1.50");
        assert_eq!(ends(1.0153, 0.0041), "1.0112 to 1.0194");
        assert_eq!(ends(110.3, 13.0), "97 to 123");
        assert_eq!(ends(1.0, 0.0), "1.000 to 1.000");
    }

    #[test]
    fn the_way_down_reaches_the_picture() {
        let up = "axis,load_n,phase,dz_um\nz,5,load,40\nz,10,load,90\nz,15,load,140\n";
        let picture = |text: &str| {
            let readings = Readings::from_text("rig.csv", text).unwrap();
            let fit = rig::fit(&readings, None, &rig::Options::default()).unwrap();
            report(&fit, &readings, None).figures().next().unwrap().svg()
        };
        assert!(!picture(up).contains("unloading"));
        let both = picture(&format!("{up}z,10,unload,110\nz,5,unload,60\n"));
        assert!(both.contains("readings, unloading") && both.contains("line, unloading, 10.0"), "{both}");
    }
}
