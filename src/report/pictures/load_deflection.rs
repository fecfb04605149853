//! Deflection over load: models, fit and readings, and what the fit leaves.

use serde::Serialize;

use super::super::chart::{Chart, Colour, Figure, Mark, Marker, Point, Range, Style};
use super::super::scale::{drawable, extent, typeset};
use crate::units::{STANDARD_GRAVITY, significant};

/// Deflection over load at one station of one rod.
#[derive(Debug, Clone, Default, Serialize)]
pub struct LoadDeflection {
    /// Which rod and direction, for example "5# steel, load and reading along y".
    pub title: String,
    /// Straight lines to draw: models and the fit through the readings.
    pub lines: Vec<LoadLine>,
    /// What was read at each load.
    pub readings: Vec<MeanReading>,
    /// What was read on the way back down, where it was.
    pub unloading: Vec<MeanReading>,
    /// Half width of the band within which noise alone would keep the residuals, µm; 0 draws none.
    pub noise_um: f64,
}

/// A straight line deflection = intercept + slope × load.
#[derive(Debug, Clone, Default, Serialize)]
pub struct LoadLine {
    /// Where the line comes from, for example "FEA"; the slope is added to it in the legend.
    pub label: String,
    /// Compliance, µm/N.
    pub slope_um_per_n: f64,
    /// Deflection at no load, µm.
    pub intercept_um: f64,
    /// The fit through the readings: drawn solid, with the load at which it crosses the load axis
    /// marked.
    pub is_fit: bool,
    /// Where the line lies with a probability of 95 %: load (N), lowest and highest deflection
    /// (µm). None draws no band.
    pub band: Vec<[f64; 3]>,
}

/// The mean of repeated readings at one load.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct MeanReading {
    /// Load, N.
    pub load_n: f64,
    /// Mean deflection, µm.
    pub mean_um: f64,
    /// Standard error of the mean, µm; 0 draws no error bar.
    pub standard_error_um: f64,
    /// The mean less the fitted line at this load, µm.
    pub residual_um: f64,
}

/// In which unit loads are shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub enum LoadUnit {
    /// Newtons.
    #[default]
    Newton,
    /// Kilograms of hung weights, under standard gravity.
    Kilogram,
}

/// Deflection over load, one panel per rod: lines of the models and of the fit with their bands,
/// readings with standard errors, and the load at which the fit crosses the load axis (what
/// friction takes off every load). A strip below each shows what the fit leaves.
pub fn load_deflection(rods: &[LoadDeflection], unit: LoadUnit) -> Figure {
    let columns = rods.len().clamp(1, 2);
    let mut panels = Vec::new();
    for row in rods.chunks(columns) {
        // a strip stands below its own lines, also where a row has room left
        let empty = || Chart { frameless: true, ..Chart::default() };
        panels.extend(row.iter().map(|rod| lines(rod, unit)));
        panels.extend((row.len()..columns).map(|_| empty()));
        panels.extend(row.iter().map(|rod| strip(rod, unit)));
    }
    Figure { name: "load-deflection".into(), panels, columns, by_column: true, ..Figure::default() }
}

/// What the bands are, in the legend.
const BAND: &str = "95\u{a0}% interval of each line";
/// Height of the strip of residuals, px.
const STRIP_PX: f64 = 80.0;

impl LoadUnit {
    /// Symbol, and what one of it is in newtons.
    fn of(self) -> (&'static str, f64) {
        match self {
            LoadUnit::Newton => ("N", 1.0),
            LoadUnit::Kilogram => ("kg", STANDARD_GRAVITY),
        }
    }
}

impl LoadDeflection {
    /// Where the load axis ends, N.
    fn end_n(&self) -> f64 {
        let largest = extent(self.readings.iter().chain(&self.unloading).map(|r| r.load_n))
            .map_or(0.0, |(_, high)| high);
        if largest > 0.0 { 1.06 * largest } else { 10.0 }
    }

    /// Both sets of readings as points of some quantity.
    fn points(&self, newtons: f64, quantity: fn(&MeanReading) -> f64) -> Vec<Mark> {
        let mut marks = Vec::new();
        let mut add = |what: &str, readings: &[MeanReading], style: Style| {
            let any_error = readings.iter().any(|r| r.standard_error_um > 0.0);
            let label = if any_error { format!("{what}, mean ± standard error") } else { what.into() };
            let point =
                |r: &MeanReading| Point { x: r.load_n / newtons, y: quantity(r), error: r.standard_error_um };
            let points = readings.iter().map(point).collect();
            marks.push(Mark::Points { label, points, style });
        };
        add("readings", &self.readings, Style::nth(0));
        if !self.unloading.is_empty() {
            add("readings, unloading", &self.unloading, Style::nth(0).marker(Marker::Triangle));
        }
        marks
    }
}

fn lines(rod: &LoadDeflection, unit: LoadUnit) -> Chart {
    let ((symbol, newtons), end_n) = (unit.of(), rod.end_n());
    let mut chart = Chart::new(&rod.title, format!("load / {symbol}"), "deflection / µm");
    chart.x.range = Range::Fixed(0.0, end_n / newtons);
    chart.y.range = Range::AutoWithZero;
    let (mut models, mut crossing) = (0, Vec::new());
    for line in &rod.lines {
        let style = if line.is_fit {
            Style::nth(0)
        } else {
            models += 1;
            Style::nth(models)
        };
        if !line.band.is_empty() {
            let points =
                line.band.iter().map(|[load_n, low, high]| [load_n / newtons, *low, *high]).collect();
            // once for all of them: each has the colour of its line
            let label = if line.is_fit { BAND.into() } else { String::new() };
            chart.marks.push(Mark::Band { label, points, style });
        }
        // The load-axis intercept: only the fit has one that means anything.
        let start_n = -line.intercept_um / line.slope_um_per_n;
        let crosses = line.is_fit && drawable(start_n) && start_n > 0.0 && start_n < end_n;
        let from_n = if crosses { start_n } else { 0.0 };
        let at = |load_n: f64| [load_n / newtons, line.intercept_um + line.slope_um_per_n * load_n];
        chart.marks.push(Mark::Line {
            label: format!("{}, {}\u{a0}µm/N", line.label, typeset(&significant(line.slope_um_per_n, 3))),
            points: vec![at(from_n), at(end_n)],
            style,
        });
        if crosses {
            let amount = typeset(&significant(start_n, 2));
            crossing.push(Mark::Points {
                label: String::new(),
                points: vec![Point { x: start_n / newtons, y: 0.0, error: 0.0 }],
                style: style.marker(Marker::Diamond),
            });
            crossing.push(Mark::Note {
                at: [start_n / newtons, 0.0],
                text: format!("crosses at {amount}\u{a0}N"),
            });
        }
    }
    chart.marks.extend(rod.points(newtons, |r| r.mean_um));
    chart.marks.extend(crossing);
    chart
}

/// What the fit leaves, on the band of noise alone.
fn strip(rod: &LoadDeflection, unit: LoadUnit) -> Chart {
    let ((symbol, newtons), end_n) = (unit.of(), rod.end_n());
    let mut chart = Chart::new("readings less the fit", format!("load / {symbol}"), "residual / µm");
    chart.height_px = Some(STRIP_PX);
    chart.x.range = Range::Fixed(0.0, end_n / newtons);
    chart.y.range = Range::AutoWithZero;
    if rod.noise_um > 0.0 {
        chart.marks.push(Mark::Band {
            label: "± 2 standard errors, from repeats".into(),
            points: [0.0, end_n / newtons].map(|x| [x, -rod.noise_um, rod.noise_um]).to_vec(),
            style: Style::nth(0).colour(Colour::SkyBlue),
        });
    }
    chart.marks.push(Mark::Horizontal { at: 0.0, text: String::new() });
    // the panel above explains the points
    let unlabelled = |mark: Mark| match mark {
        Mark::Points { points, style, .. } => Mark::Points { label: String::new(), points, style },
        other => other,
    };
    chart.marks.extend(rod.points(newtons, |r| r.residual_um).into_iter().map(unlabelled));
    chart
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steel() -> LoadDeflection {
        let line = |label: &str, slope_um_per_n, intercept_um, is_fit| LoadLine {
            label: label.into(),
            slope_um_per_n,
            intercept_um,
            is_fit,
            band: if is_fit { vec![[0.0, -40.0, -20.0], [10.0, 290.0, 310.0]] } else { Vec::new() },
        };
        LoadDeflection {
            title: "5# steel".into(),
            lines: vec![line("Meas", 33.0, -29.7, true), line("FEA", 32.6, 0.0, false)],
            readings: vec![MeanReading {
                load_n: 9.8,
                mean_um: 293.7,
                standard_error_um: 1.5,
                residual_um: -0.6,
            }],
            ..LoadDeflection::default()
        }
    }

    #[test]
    fn readings_on_the_way_down_are_drawn_too() {
        let down = MeanReading { load_n: 4.9, mean_um: 191.4, standard_error_um: 0.0, residual_um: 2.0 };
        let figure =
            |unloading| load_deflection(&[LoadDeflection { unloading, ..steel() }], LoadUnit::Newton);
        assert!(figure(vec![down]).svg().contains("readings, unloading"));
        assert!(!figure(vec![]).svg().contains("unloading"));
    }

    #[test]
    fn the_fit_is_marked_where_it_meets_the_load_axis() {
        let svg = load_deflection(&[steel()], LoadUnit::Newton).svg();
        assert!(svg.contains("crosses at 0.90\u{a0}N") && svg.contains("FEA, 32.6\u{a0}µm/N"), "{svg}");
    }

    #[test]
    fn loads_in_kilograms_keep_the_compliance_per_newton() {
        let svg = load_deflection(&[steel()], LoadUnit::Kilogram).svg();
        assert!(svg.contains("load / kg") && svg.contains("33.0\u{a0}µm/N"), "{svg}");
    }

    #[test]
    fn bands_are_drawn_and_named_and_a_strip_below_shows_the_residuals() {
        let rod = LoadDeflection { noise_um: 3.0, ..steel() };
        let figure = load_deflection(&[rod.clone(), rod.clone(), rod], LoadUnit::Newton);
        // two rows of panels above their strips; the third rod stands by itself
        let titles: Vec<&str> = figure.panels.iter().map(|p| p.title.as_str()).collect();
        let strip = "readings less the fit";
        assert_eq!(titles, ["5# steel", "5# steel", strip, strip, "5# steel", "", strip]);
        let Mark::Points { points, .. } = &figure.panels[2].marks[2] else { panic!("points") };
        assert_eq!((points[0].y, points[0].error), (-0.6, 1.5));
        let svg = figure.svg();
        assert_eq!(svg.matches(BAND).count(), 3, "{svg}");
    }

    #[test]
    fn nothing_draws() {
        load_deflection(&[], LoadUnit::Newton).svg();
        load_deflection(&[LoadDeflection::default()], LoadUnit::Newton).svg();
    }
}
