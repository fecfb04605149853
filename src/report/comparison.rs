//! What `rodcal compare` says: JSON, tables and pictures of all modes of a campaign.

use serde_json::{Value, json};

use super::calibration::{self, convergence, mode_residuals};
use super::length::length;
use super::method;
use super::pictures::calibration::{
    MethodErrors, ModeComparison, ModeResiduals, PoseError, cumulative_errors, error_distribution,
    error_over_workspace, mode_comparison, residuals_by_group,
};
use super::table::{Column, Table};
use super::{Block, Card, Report, Section, Tone};
use crate::calibration::campaign::Targets;
use crate::calibration::{Calibration, Campaign, Comparison, Difference, Mode};
use crate::units::{MM, UM, significant, with_ends};

/// The JSON of `rodcal compare --json`.
pub fn json(campaign: &Campaign, comparison: &Comparison) -> Value {
    let modes: Vec<Value> = comparison
        .calibrations
        .iter()
        .enumerate()
        .map(|(index, calibrated)| {
            let cv = comparison.cross_validations.as_ref().map(|all| &all[index]);
            let mut object = calibration::json(campaign, calibrated, cv);
            let (low, high) = comparison.intervals[index];
            object["mean_error_um"] = (comparison.summary(index).mean / UM).into();
            object["mean_error_interval_um"] = json!([low / UM, high / UM]);
            object
        })
        .collect();
    let differences: Vec<Value> = comparison
        .differences
        .iter()
        .map(|d| {
            json!({
                "mode": d.mode.name(),
                "against": d.against.name(),
                "mean_um": d.mean / UM,
                "lo_um": d.interval.0 / UM,
                "hi_um": d.interval.1 / UM,
                "significant": d.is_significant,
            })
        })
        .collect();
    json!({
        "modes": modes,
        "differences": differences,
        "judged_by": judged_by(campaign, comparison),
        "draws": comparison.draws,
        "verdict": verdict(campaign, comparison),
    })
}

/// The report of `rodcal compare`.
pub fn report(campaign: &Campaign, comparison: &Comparison) -> Report {
    let mut warnings: Vec<String> = Vec::new();
    for calibrated in &comparison.calibrations {
        for warning in calibration::warnings(campaign, calibrated) {
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
    }
    Report {
        title: format!("Compensation modes of {}", campaign.robot.name),
        headline: verdict(campaign, comparison),
        warnings,
        sections: sections(campaign, comparison),
        cards: cards(campaign, comparison),
        method: method::paragraphs(method::COMPARISON),
        ..Report::default()
    }
}

/// The mean error of each mode; the best is that of the smallest.
fn cards(campaign: &Campaign, comparison: &Comparison) -> Vec<Card> {
    let on = judged_by(campaign, comparison);
    let means: Vec<f64> = (0..comparison.calibrations.len()).map(|k| comparison.summary(k).mean).collect();
    let least = means.iter().copied().fold(f64::INFINITY, f64::min);
    let card = |(calibration, &mean): (&Calibration, &f64)| {
        let is_best = mean == least && means.len() > 1;
        let differs = comparison
            .differences
            .iter()
            .any(|d| d.is_significant && (d.mode == calibration.mode || d.against == calibration.mode));
        let detail = match (is_best, differs) {
            (true, true) => format!("smallest mean error on {on}"),
            (true, false) => format!("smallest mean error on {on}, but no significant difference"),
            (false, _) => format!("mean error on {on}"),
        };
        let tone = if is_best && differs { Tone::Good } else { Tone::Neutral };
        Card::new(format!("Mode {}", calibration.mode.name()), length(mean), detail).toned(tone)
    };
    comparison.calibrations.iter().zip(&means).map(card).collect()
}

fn judged_by(campaign: &Campaign, comparison: &Comparison) -> String {
    match (&comparison.cross_validations, &campaign.measurements.targets) {
        (None, Targets::Points(_)) => "validation poses".into(),
        (None, Targets::Sockets(_)) => "validation sockets".into(),
        (Some(all), _) => format!("held-out poses ({} folds)", all.first().map_or(0, |cv| cv.folds)),
    }
}

/// One or two sentences: which mode is better, if any differs by more than chance.
pub fn verdict(campaign: &Campaign, comparison: &Comparison) -> String {
    let name = &campaign.robot.name;
    let on = judged_by(campaign, comparison);
    let means: Vec<String> = comparison
        .calibrations
        .iter()
        .enumerate()
        .map(|(index, c)| format!("{} {}", c.mode.name(), length(comparison.summary(index).mean)))
        .collect();
    let means = means.join(", ");
    if comparison.calibrations.len() < 2 {
        return format!(
            "{name}: only mode none is possible, for the campaign names no rod; mean error on {on}: {means}."
        );
    }
    let better: Vec<String> =
        comparison.differences.iter().filter(|d| d.is_significant).map(better_than).collect();
    let largest = comparison.differences.iter().max_by(|a, b| a.mean.abs().total_cmp(&b.mean.abs()));
    match (better.as_slice(), largest) {
        ([], Some(d)) => {
            let [mean, low, high] = um_with_ends(d.mean, d.interval);
            format!(
                "{name}: no difference between the modes is significant. Mean errors on {on}: {means}; the \
                 largest difference, {} less {}, is {mean} µm with a 95 % interval of {low} to {high} µm.",
                d.mode.name(),
                d.against.name()
            )
        }
        (better, _) => format!("{name}: {}. Mean errors on {on}: {means}.", better.join("; ")),
    }
}

/// What no compensation at all is worth beside `mode`: nothing where either was not compared.
pub fn without_compensation(comparison: &Comparison, mode: Mode) -> Option<String> {
    let index = comparison.calibrations.iter().position(|c| c.mode == Mode::None)?;
    let pair = [mode, Mode::None];
    let is_pair = |d: &&Difference| pair.contains(&d.mode) && pair.contains(&d.against);
    let difference = comparison.differences.iter().find(is_pair)?;
    let mean = length(comparison.summary(index).mean);
    let said =
        if difference.is_significant { "a significant difference" } else { "no significant difference" };
    Some(format!("Without compensation {mean}: {said}."))
}

fn better_than(d: &Difference) -> String {
    let (better, worse, sign) =
        if d.mean < 0.0 { (d.mode, d.against, -1.0) } else { (d.against, d.mode, 1.0) };
    let (low, high) = (sign * d.interval.0, sign * d.interval.1);
    let [by, low, high] = um_with_ends(d.mean.abs(), (low.min(high), low.max(high)));
    format!("{} is better than {} by {by} µm (95 % interval {low} to {high} µm)", better.name(), worse.name())
}

/// A mean and the ends of its interval, µm.
fn um_with_ends(mean: f64, (low, high): (f64, f64)) -> [String; 3] {
    with_ends([mean, low, high].map(|metres| metres / UM), 3).map(|number| number.replace('-', "−"))
}

/// For sentences, with the true minus.
fn um(metres: f64) -> String {
    significant(metres / UM, 3).replace('-', "−")
}

/// The body of [`report`].
pub fn sections(campaign: &Campaign, comparison: &Comparison) -> Vec<Section> {
    let recording = &campaign.measurements;
    let by_mode = |index: usize| {
        let calibrated = &comparison.calibrations[index];
        let errors_mm = comparison.errors(index).iter().map(|error| error / MM).collect();
        MethodErrors { label: format!("mode {}", calibrated.mode.name()), errors_mm }
    };
    let methods: Vec<MethodErrors> = (0..comparison.calibrations.len()).map(by_mode).collect();
    let residuals: Vec<ModeResiduals> = comparison
        .calibrations
        .iter()
        .map(|c| mode_residuals(&format!("mode {}", c.mode.name()), recording, c))
        .collect();
    let calibrations: Vec<&Calibration> = comparison.calibrations.iter().collect();
    vec![
        Section::new(
            "Modes side by side",
            vec![
                Block::Paragraph(format!(
                    "Every mode is calibrated on the same {} poses and compared by its errors on {}. \
                     Intervals come from a paired bootstrap over poses ({} draws): poses are drawn \
                     again, and {}.",
                    recording.len(),
                    judged_by(campaign, comparison),
                    comparison.draws,
                    match comparison.cross_validations {
                        None => "the calibration and its validation are repeated on them",
                        Some(_) => "their held-out errors are compared",
                    }
                )),
                Block::Table(modes_table(comparison)),
                Block::Table(differences_table(comparison)),
                Block::Figure(mode_comparison(&compared(comparison))),
            ],
        ),
        Section::new(
            "Errors of each mode",
            vec![
                Block::Figure(error_distribution(&methods)),
                Block::Figure(cumulative_errors(&methods)),
                Block::Figure(error_over_workspace(&best_over_workspace(comparison))),
            ],
        ),
        Section::new(
            "Residuals and convergence",
            vec![Block::Figure(residuals_by_group(&residuals)), Block::Figure(convergence(&calibrations))],
        ),
    ]
}

/// The default mode's errors over the workspace: that of the last mode, which knows most.
fn best_over_workspace(comparison: &Comparison) -> Vec<PoseError> {
    let last = comparison.calibrations.len().saturating_sub(1);
    let Some(calibrated) = comparison.calibrations.get(last) else { return Vec::new() };
    let tips = match (&comparison.cross_validations, &calibrated.validation) {
        (None, Some(validation)) => &validation.tips,
        _ => &calibrated.tips,
    };
    tips.iter()
        .zip(comparison.errors(last))
        .map(|(tip, error)| PoseError { at_mm: (tip / MM).into(), error_mm: error / MM })
        .collect()
}

/// Every mode with its difference to the first.
fn compared(comparison: &Comparison) -> Vec<ModeComparison> {
    let first = comparison.calibrations.first().map(|c| c.mode);
    comparison
        .calibrations
        .iter()
        .enumerate()
        .map(|(index, calibrated)| {
            let (low, high) = comparison.intervals[index];
            let to_first =
                comparison.differences.iter().find(|d| d.mode == calibrated.mode && Some(d.against) == first);
            ModeComparison {
                name: calibrated.mode.name().into(),
                mean_mm: comparison.summary(index).mean / MM,
                mean_interval_mm: Some([low / MM, high / MM]),
                difference_mm: to_first.map_or(0.0, |d| d.mean / MM),
                difference_interval_mm: to_first.map(|d| [d.interval.0 / MM, d.interval.1 / MM]),
            }
        })
        .collect()
}

fn modes_table(comparison: &Comparison) -> Table {
    let mut columns =
        vec![Column::text("mode"), Column::text("rod's deflection"), Column::number("residual rms", "µm")];
    columns.extend(["mean", "95 % from", "to", "max", "median", "SD"].map(|name| Column::number(name, "µm")));
    let mut table = Table::new("modes", "Errors of each mode.", columns);
    for (index, calibrated) in comparison.calibrations.iter().enumerate() {
        let summary = comparison.summary(index);
        let [mean, low, high] = um_with_ends(summary.mean, comparison.intervals[index]);
        let residual = crate::calibration::Summary::of(&calibrated.residuals());
        let words = match calibrated.mode {
            Mode::None => "assumed rigid",
            Mode::Calc => "closed form",
            Mode::Fea => "beam model",
            Mode::Meas => "measured on a rig",
        };
        let [rms, max, median, sd] = [residual.rms, summary.max, summary.median, summary.sd].map(um);
        let numbers = vec![rms, mean, low, high, max, median, sd];
        table.row([vec![calibrated.mode.name().to_owned(), words.to_owned()], numbers].concat());
    }
    table
}

fn differences_table(comparison: &Comparison) -> Table {
    let mut columns = vec![Column::text("mode"), Column::text("less")];
    columns.extend(["difference", "95 % from", "to"].map(|name| Column::number(name, "µm")));
    columns.push(Column::text("significant"));
    let mut table = Table::new(
        "differences",
        "Differences of the mean errors; negative where the first mode is better.",
        columns,
    );
    for d in &comparison.differences {
        let [mean, low, high] = um_with_ends(d.mean, d.interval);
        table.row([
            d.mode.name().to_owned(),
            d.against.name().to_owned(),
            mean,
            low,
            high,
            if d.is_significant { "yes" } else { "no" }.to_owned(),
        ]);
    }
    table
}
