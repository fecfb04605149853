//! The pictures: from plain numbers to a [`Figure`]. Those of a rod and its rig are here, those of
//! a robot's calibration in [`calibration`], those of a diagnosis in [`diagnosis`].

pub mod calibration;
pub mod diagnosis;
mod load_deflection;
mod rod_shape;
mod waterfall;

pub use load_deflection::{LoadDeflection, LoadLine, LoadUnit, MeanReading, load_deflection};
pub use rod_shape::{RodShape, ShapeCase, Station, StationKind, Stretch, Tube, rod_shape};
pub use waterfall::{Rung, Waterfall, waterfall};

use serde::Serialize;

use super::chart::{Chart, Colour, Dash, Figure, Mark, Point, Range, Style};
use super::scale::{extent, typeset};
use crate::units::significant;

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
    fn nothing_to_show_is_shown_as_nothing() {
        residuals(&Residuals { noise_um: f64::NAN, ..Residuals::default() }).svg();
    }
}
