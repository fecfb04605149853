//! The pictures: from plain numbers to a [`Figure`]. Those of a rod and its rig are here, those of
//! a robot's calibration in [`calibration`], those of a diagnosis in [`diagnosis`].

pub mod calibration;
pub mod diagnosis;
mod rod_shape;

pub use rod_shape::{RodShape, ShapeCase, Station, StationKind, Stretch, rod_shape};

use serde::Serialize;

use super::chart::{Axis, Bar, Chart, Colour, Dash, Direction, Figure, Mark, Marker, Point, Range, Style};
use super::scale::{drawable, extent, typeset};
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

/// Deflection over load, one panel per rod: lines of the models and of the fit, readings with
/// standard errors, and the load at which the fit crosses the load axis (what friction takes off
/// every load).
pub fn load_deflection(rods: &[LoadDeflection], unit: LoadUnit) -> Figure {
    let (symbol, newtons) = match unit {
        LoadUnit::Newton => ("N", 1.0),
        LoadUnit::Kilogram => ("kg", STANDARD_GRAVITY),
    };
    let panel = |rod: &LoadDeflection| {
        let largest =
            extent(rod.readings.iter().chain(&rod.unloading).map(|r| r.load_n)).map_or(0.0, |(_, high)| high);
        let end_n = if largest > 0.0 { 1.06 * largest } else { 10.0 };
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
        let point =
            |r: &MeanReading| Point { x: r.load_n / newtons, y: r.mean_um, error: r.standard_error_um };
        let mut points = |what: &str, readings: &[MeanReading], style: Style| {
            let any_error = readings.iter().any(|r| r.standard_error_um > 0.0);
            let label = if any_error { format!("{what}, mean ± standard error") } else { what.into() };
            let points = readings.iter().map(point).collect();
            chart.marks.push(Mark::Points { label, points, style });
        };
        points("readings", &rod.readings, Style::nth(0));
        if !rod.unloading.is_empty() {
            points("readings, unloading", &rod.unloading, Style::nth(0).marker(Marker::Triangle));
        }
        chart.marks.extend(crossing);
        chart
    };
    Figure {
        name: "load-deflection".into(),
        panels: rods.iter().map(panel).collect(),
        columns: rods.len().min(2),
        ..Figure::default()
    }
}

/// What several terms are worth in one quantity.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Contributions {
    /// The quantity, for example "C22".
    pub title: String,
    /// Unit of the values, for example "µm/N" or "%".
    pub unit: String,
    /// Name and value of each term, top to bottom.
    pub terms: Vec<(String, f64)>,
}

/// Horizontal bars, one panel per quantity, every bar with its number.
pub fn contributions(groups: &[Contributions]) -> Figure {
    let columns = groups.len().clamp(1, 2);
    let panel = |(i, group): (usize, &Contributions)| {
        // Beside a panel with the same terms their names need not be repeated.
        let names_of = |g: &Contributions| g.terms.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        let repeats = i % columns > 0 && names_of(&groups[i - 1]) == names_of(group);
        let compound = group.unit.contains(['/', '·', ' ']);
        let unit = if compound { format!("({})", group.unit) } else { group.unit.clone() };
        let mut chart = Chart::new(&group.title, format!("contribution / {unit}"), "");
        let row = |i: usize| -(i as f64);
        let name = |(i, (name, _)): (usize, &(String, f64))| {
            (row(i), if repeats { String::new() } else { name.clone() })
        };
        chart.y = Axis { names: group.terms.iter().enumerate().map(name).collect(), ..Axis::default() };
        let bar = |(i, (_, value)): (usize, &(String, f64))| Bar {
            from: row(i) - 0.33,
            to: row(i) + 0.33,
            value: *value,
            text: if value.is_finite() { typeset(&significant(*value, 2)) } else { "unknown".into() },
        };
        chart.with(Mark::Bars {
            label: String::new(),
            bars: group.terms.iter().enumerate().map(bar).collect(),
            direction: Direction::Right,
            style: Style::nth(0).colour(Colour::Blue),
        })
    };
    Figure {
        name: "contributions".into(),
        panels: groups.iter().enumerate().map(panel).collect(),
        columns,
        ..Figure::default()
    }
}

/// Residuals of a fit over the load.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Residuals {
    /// Which rod and fit.
    pub title: String,
    /// Name of each series with its load (N) and residual (µm), for example one series per
    /// direction.
    pub series: Vec<(String, Vec<[f64; 2]>)>,
    /// Half width of the band within which noise alone would keep them, µm; 0 draws none.
    pub noise_um: f64,
    /// What the band is, for example "± 2 standard deviations of repeated readings".
    pub noise_label: String,
}

/// Residuals as points around zero, on the band of the noise.
pub fn residuals(data: &Residuals) -> Figure {
    let loads = data.series.iter().flat_map(|(_, points)| points.iter().map(|p| p[0]));
    let (low, high) = extent(loads).unwrap_or((0.0, 1.0));
    let air = if high > low { 0.05 * (high - low) } else { 1.0 };
    let mut chart = Chart::new(&data.title, "load / N", "residual / µm");
    // without repeats there is no noise to compare with
    if data.noise_um > 0.0 {
        chart.marks.push(Mark::Band {
            label: data.noise_label.clone(),
            points: [low - air, high + air].map(|x| [x, -data.noise_um, data.noise_um]).to_vec(),
            style: Style::nth(0).colour(Colour::SkyBlue),
        });
    }
    chart.marks.push(Mark::Line {
        label: String::new(),
        points: vec![[low - air, 0.0], [high + air, 0.0]],
        style: Style::nth(0).colour(Colour::Grey).width(1.0).dash(Dash::Solid),
    });
    chart.x.range = Range::Fixed(low - air, high + air);
    for (i, (label, points)) in data.series.iter().enumerate() {
        let points = points.iter().map(|[x, y]| Point { x: *x, y: *y, error: 0.0 }).collect();
        chart.marks.push(Mark::Points { label: label.clone(), points, style: Style::nth(i) });
    }
    Figure::from(chart).named("residuals")
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
        };
        LoadDeflection {
            title: "5# steel".into(),
            lines: vec![line("Meas", 33.0, -29.7, true), line("FEA", 32.6, 0.0, false)],
            readings: vec![MeanReading { load_n: 9.8, mean_um: 293.7, standard_error_um: 1.5 }],
            ..LoadDeflection::default()
        }
    }

    #[test]
    fn readings_on_the_way_down_are_drawn_too() {
        let down = MeanReading { load_n: 4.9, mean_um: 191.4, standard_error_um: 0.0 };
        let figure =
            |unloading| load_deflection(&[LoadDeflection { unloading, ..steel() }], LoadUnit::Newton);
        assert!(figure(vec![down]).svg().contains("readings, unloading"));
        assert!(!figure(vec![]).svg().contains("unloading"));
    }

    #[test]
    fn a_noise_that_is_not_known_has_no_band() {
        let data = |noise_um| Residuals {
            series: vec![("dz".into(), vec![[5.0, 1.0], [10.0, -1.0]])],
            noise_um,
            noise_label: "band".into(),
            ..Residuals::default()
        };
        assert!(residuals(&data(2.0)).svg().contains("band"));
        assert!(!residuals(&data(0.0)).svg().contains("band"));
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
    fn a_bar_too_short_to_see_still_shows_its_number() {
        let terms = vec![("shear".into(), 0.0021), ("bend".into(), -3.0), ("joint".into(), f64::NAN)];
        let svg = contributions(&[Contributions { title: "C22".into(), unit: "µm/N".into(), terms }]).svg();
        assert!(["0.0021", "−3.0", "unknown", "shear"].iter().all(|text| svg.contains(text)), "{svg}");
    }

    #[test]
    fn nothing_to_show_is_shown_as_nothing() {
        load_deflection(&[], LoadUnit::Newton).svg();
        load_deflection(&[LoadDeflection::default()], LoadUnit::Newton).svg();
        contributions(&[Contributions::default()]).svg();
        residuals(&Residuals { noise_um: f64::NAN, ..Residuals::default() }).svg();
    }
}
