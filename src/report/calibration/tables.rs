//! The tables of a calibration's report.

use super::groups::group_summaries;
use crate::calibration::campaign::{Campaign, Recording, Targets};
use crate::calibration::{Calibration, CrossValidation, Estimated, Summary};
use crate::report::Block;
use crate::report::table::{Column, Table};
use crate::robot::Parameter;
use crate::units::{DEG, MM, UM, decimals_of, fixed, significant};

pub(super) const PARAMETERS_NOTE: &str = "Names are those of the Hayati table: theta, d, a, alpha, \
     beta of each link; c is a joint's compliance, base x, y, z the position of {0} in {W}, base rx, ry, rz \
     the correction to the base rotation, about the world axes, tool x, y, z the undeflected tip in {T}. \
     Standard errors follow from the scatter of the residuals, unless the campaign states the noise. \
     \"Not supported\": the correction is smaller than its standard error, so that these poses do not \
     show that the number differs from its nominal value.";

/// Decimals of a number of mm or degrees without a standard error.
const DECIMALS: usize = 4;

/// A number of micrometres for a table.
fn um(metres: f64) -> String {
    significant(metres / UM, 3)
}

pub(super) fn errors(calibration: &Calibration, cross_validation: Option<&CrossValidation>) -> Table {
    let columns = ["mean", "max", "median", "SD", "rms"].map(|name| Column::number(name, "µm"));
    let mut table = Table::new(
        "errors",
        "Distances of the tip from its measured position.",
        [vec![Column::text("of"), Column::number("poses", "")], columns.to_vec()].concat(),
    );
    let mut row = |name: &str, count: usize, summary: &Summary| {
        let numbers = [summary.mean, summary.max, summary.median, summary.sd, summary.rms].map(um);
        table.row([vec![name.to_owned(), count.to_string()], numbers.to_vec()].concat());
    };
    let residuals = calibration.residuals();
    if let Some(before) = &calibration.before {
        row("nominal robot, placed at the calibration's poses", residuals.len(), &before.residual);
    }
    row("residuals of the calibration", residuals.len(), &Summary::of(&residuals));
    if let Some(validation) = &calibration.validation {
        if let Some(before) = calibration.before.as_ref().and_then(|before| before.validation.as_ref()) {
            row("nominal robot, validation", validation.errors.len(), before);
        }
        row("validation", validation.errors.len(), &validation.summary);
    }
    if let Some(cv) = cross_validation {
        row(&format!("held-out poses, {} folds", cv.folds), cv.errors.len(), &cv.summary);
    }
    table
}

/// What the scatter of a coordinate is called: noise only where somebody states it.
fn scatter(calibration: &Calibration) -> &'static str {
    if calibration.noise.is_stated { "noise" } else { "scatter" }
}

pub(super) fn groups(recording: &Recording, calibration: &Calibration) -> Table {
    let scatter = scatter(calibration);
    let mut table = Table::new(
        "groups",
        format!(
            "Residuals by clamp or socket, and the {scatter} of one coordinate by which each is weighted."
        ),
        vec![
            Column::text("group"),
            Column::number("poses", ""),
            Column::number("mean", "µm"),
            Column::number("max", "µm"),
            Column::number("rms", "µm"),
            Column::number(scatter, "µm"),
        ],
    );
    for ((name, count, summary), &noise) in
        group_summaries(recording, calibration).into_iter().zip(&calibration.noise.of_group)
    {
        table.row([name, count.to_string(), um(summary.mean), um(summary.max), um(summary.rms), um(noise)]);
    }
    table
}

/// Value, correction and standard error, with as many decimals as the error deserves.
pub(super) fn parameters(calibration: &Calibration) -> Table {
    let mut table = Table::new(
        "parameters",
        "Calibrated parameters.",
        vec![
            Column::text("parameter"),
            Column::units(),
            Column::in_row_unit("nominal"),
            Column::in_row_unit("value"),
            Column::in_row_unit("correction"),
            Column::in_row_unit("std error"),
            Column::text(""),
        ],
    );
    for estimate in &calibration.parameters {
        let unit = estimate.parameter.unit();
        let error = estimate.std_error.map(|error| error / unit.si);
        let decimals = error.and_then(decimals_of).unwrap_or(DECIMALS);
        let show = |value: f64| fixed(value / unit.si, decimals);
        table.row([
            estimate.parameter.description(),
            unit.symbol.to_owned(),
            show(estimate.nominal),
            show(estimate.value),
            show(estimate.value - estimate.nominal),
            error.map_or("–".into(), |e| fixed(e, decimals)),
            match (estimate.identifiable, is_drawn(estimate) && !estimate.is_supported()) {
                (false, _) => "not identified",
                (true, true) => "not supported",
                (true, false) => "",
            }
            .to_owned(),
        ]);
    }
    table
}

/// True for a number that a drawing has: a correction of it asks for data.
fn is_drawn(estimate: &Estimated) -> bool {
    !estimate.parameter.is_placement()
}

/// Where the robot stands and where the tip is, all six and three numbers of them, with the digits
/// that [`parameters`] has.
pub(super) fn placement(campaign: &Campaign, calibration: &Calibration) -> Table {
    let mut table = Table::new(
        "placement",
        "Base and tip as calibrated.",
        vec![
            Column::text(""),
            Column::number("x", "mm"),
            Column::number("y", "mm"),
            Column::number("z", "mm"),
            Column::number("roll", "°"),
            Column::number("pitch", "°"),
            Column::number("yaw", "°"),
        ],
    );
    if matches!(campaign.measurements.targets, Targets::Points(_)) {
        let base = calibration.setup.base();
        let place = along_axes(calibration, Parameter::BasePosition, (base.origin / MM).into(), MM);
        let turn = base.roll_pitch_yaw().map(|angle| angle / DEG);
        let turn = along_axes(calibration, Parameter::BaseRotation, turn, DEG);
        table.row([vec!["{0} in {W}".to_owned()], place, turn].concat());
    }
    let tool = along_axes(calibration, Parameter::Tool, (calibration.setup.tool / MM).into(), MM);
    table.row([vec!["tip in {T}".to_owned()], tool].concat());
    table
}

/// Three numbers in their unit, each with the decimals of the parameter of its axis; what was not
/// fitted is known by its file.
fn along_axes(
    calibration: &Calibration,
    of_axis: fn(usize) -> Parameter,
    values: [f64; 3],
    unit: f64,
) -> Vec<String> {
    let decimals = |axis: usize| {
        let fitted = calibration.parameters.iter().find(|estimate| estimate.parameter == of_axis(axis))?;
        decimals_of(fitted.std_error? / unit)
    };
    (0..3).map(|axis| fixed(values[axis], decimals(axis).unwrap_or(DECIMALS))).collect()
}

pub(super) fn correlations(calibration: &Calibration, limit: f64) -> Block {
    /// More than these nobody reads.
    const MOST: usize = 20;
    let pairs = calibration.correlations_above(limit);
    if pairs.is_empty() {
        return Block::Paragraph(format!("No two estimates correlate by more than {limit}."));
    }
    let caption = format!(
        "Estimates that correlate by more than {limit}: the poses distinguish them only \
            roughly."
    );
    let mut table = Table::new(
        "correlations",
        caption,
        vec![Column::text("parameter"), Column::text("with"), Column::number("correlation", "")],
    );
    for (a, b, value) in pairs.iter().take(MOST) {
        table.row([a.description(), b.description(), format!("{value:.3}")]);
    }
    if pairs.len() > MOST {
        table.notes.push(format!("and {} more", pairs.len() - MOST));
    }
    Block::Table(table)
}

pub(super) fn observability(calibration: &Calibration) -> Table {
    let mut table = Table::new(
        "observability",
        "How well the poses determine the parameters.",
        vec![Column::text("index"), Column::text("meaning"), Column::number("value", "")],
    );
    let show = |value: f64| if value.is_finite() { significant(value, 4) } else { "∞".into() };
    let [o1, o2, o3, o4, o5] = calibration.observability.indices;
    for (name, meaning, value) in [
        ("condition", "σ₁/σₘ, columns of norm 1", calibration.observability.condition),
        ("O1", "(Π σᵢ)^(1/m)/√n", o1),
        ("O2", "σₘ/σ₁", o2),
        ("O3", "σₘ", o3),
        ("O4", "σₘ²/σ₁", o4),
        ("O5", "1/Σ(1/σᵢ)", o5),
    ] {
        table.row([name.to_owned(), meaning.to_owned(), show(value)]);
    }
    table.notes.push(
        "O1 to O5 depend on units (here mm of residual per mm, mrad and µrad/(N·m)): compare ratios between sets of \
         poses of one robot only. The condition number has no unit."
            .into(),
    );
    table
}

pub(super) fn passes(calibration: &Calibration) -> Table {
    let mut table = Table::new(
        "passes",
        format!(
            "Compensation loop: deflections recomputed until they converge. Last fit: {}.",
            calibration.fit.reason
        ),
        vec![
            Column::number("pass", ""),
            Column::number("largest change of a deflection", "µm"),
            Column::number("rms", "µm"),
            Column::number(format!("{} of a coordinate", scatter(calibration)), "µm"),
        ],
    );
    for (index, pass) in (1..).zip(&calibration.passes) {
        table.row([index.to_string(), significant(pass.change / UM, 3), um(pass.rms), um(pass.noise)]);
    }
    table
}
