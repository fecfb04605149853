//! The pictures of a rig's fit, from results to plain numbers.

use crate::beam::Physics;
use crate::compliance::{Compliance, Step, standard_uncertainty, steps};
use crate::report::chart::Figure;
use crate::report::compliance::in_um;
use crate::report::compliance::steps::ladder;
use crate::report::pictures::{self, LoadDeflection, LoadLine, LoadUnit, MeanReading, Residuals, Waterfall};
use crate::rig::line::{Line, Point};
use crate::rig::readings::Phase;
use crate::rig::{Fit, Measured};
use crate::rod::Rod;
use crate::statistics::{Estimate, HALF_95};
use crate::units::UM;

/// Points of a band.
const POINTS: usize = 16;

/// One panel for each line along its load, in the manner of the paper's Fig. 8.
pub(super) fn load_deflection(fit: &Fit, rod: Option<&Rod>) -> Figure {
    let uncertainty = Uncertainty::of(fit, rod);
    let panels: Vec<LoadDeflection> =
        shown(fit).into_iter().map(|k| panel(k, fit, rod, &uncertainty)).collect();
    let mut caption = String::from(
        "Load and deflection: averages with standard errors, the fitted line with its 95 % band",
    );
    caption += match uncertainty.fea {
        Some(_) => {
            ", and the models with the bands that the uncertainties of the rod's numbers give them. Below: readings \
             less the fitted line."
        }
        None if rod.is_some() => " and the models. Below: readings less the fitted line.",
        None => ". Below: readings less the fitted line.",
    };
    pictures::load_deflection(&panels, LoadUnit::Newton).captioned(caption)
}

/// Calc, what each term of the model adds, FEA, and what the readings add: the entries of C^F along
/// the loads.
pub(super) fn waterfall(fit: &Fit, rod: Option<&Rod>) -> Option<Figure> {
    let (measured, rod) = (fit.measured.as_ref()?, rod?);
    // readings that were taken stay shown where the steps cannot be computed
    let steps = steps(rod, &measured.physics, measured.elements).ok()?;
    let along = measured.ratios.iter().filter(|ratio| ratio.channel == ratio.load);
    let mut quantities: Vec<_> = along
        .map(|ratio| {
            let at = (ratio.channel.index(), ratio.load.index());
            let slope = ratio.value.times(measured.model.force[at] / UM);
            ladder(&format!("C^F {}", ratio.name()), "µm/N", &steps, |c| in_um(c.force[at]), Some(&slope))
        })
        .collect();
    (!quantities.is_empty()).then(|| {
        quantities.push(rod_ratio(measured, &steps));
        let figure = pictures::waterfall(&quantities);
        let caption = format!("From the closed form over the model to the readings. {}", figure.caption);
        figure.captioned(caption)
    })
}

/// Eq 21: the entries that r_rod is made of, over what they are by FEA.
fn rod_ratio(measured: &Measured, steps: &[Step]) -> Waterfall {
    let ratios = measured.ratios_of_rod();
    let sum = |c: &Compliance| -> f64 {
        ratios.iter().map(|ratio| c.force[(ratio.channel.index(), ratio.load.index())]).sum()
    };
    let names: Vec<String> = ratios.iter().map(|ratio| format!("C^F {}", ratio.name())).collect();
    let title = format!("r_rod: {}, over FEA", names.join(" + "));
    let fea = sum(&measured.model);
    ladder(&title, "", steps, |c| sum(c) / fea, Some(&measured.rod_ratio))
}

/// Residuals of all lines, where not each of them has a strip of its own.
pub(super) fn residuals(fit: &Fit) -> Option<Figure> {
    let series = |line: &Line| {
        let points = line.points.iter().map(|p| [p.load, p.residual / UM]).collect();
        (line.key.label(), points)
    };
    (shown(fit).len() < fit.lines.len()).then(|| {
        pictures::residuals(&Residuals {
            title: "Residuals of the lines".into(),
            series: fit.lines.iter().map(series).collect(),
            noise_um: fit.lines.iter().map(noise_um).fold(0.0, f64::max),
            noise_label: "± 2 standard errors of an average, from repeats".into(),
        })
        .captioned("Averages less the fitted line. Pure noise would lie within the band and follow no curve.")
    })
}

/// Twice the standard error of the average of fewest repeats, µm; 0 without repeats.
fn noise_um(line: &Line) -> f64 {
    let smallest = line.points.iter().map(|p| p.count).fold(f64::INFINITY, f64::min);
    2.0 * line.noise_sd.unwrap_or(0.0) / smallest.sqrt() / UM
}

/// The lines along their loads, or all where there are none.
fn shown(fit: &Fit) -> Vec<usize> {
    let is_along = |k: &usize| fit.lines[*k].key.channel == fit.lines[*k].key.direction.axis;
    let along: Vec<usize> = (0..fit.lines.len()).filter(is_along).collect();
    if along.is_empty() { (0..fit.lines.len()).collect() } else { along }
}

/// Standard uncertainties of the models, from those of the rod's numbers.
struct Uncertainty {
    calc: Option<Compliance>,
    fea: Option<Compliance>,
}

impl Uncertainty {
    fn of(fit: &Fit, rod: Option<&Rod>) -> Self {
        let of_physics = |physics: &Physics| standard_uncertainty(rod?, physics).ok();
        let fea = fit.measured.as_ref().and_then(|measured| of_physics(&measured.physics));
        // Calc is the beam in bending and torsion alone
        Uncertainty { calc: fea.and_then(|_| of_physics(&Physics::BENDING_AND_TORSION)), fea }
    }
}

fn panel(index: usize, fit: &Fit, rod: Option<&Rod>, uncertainty: &Uncertainty) -> LoadDeflection {
    let line = &fit.lines[index];
    let sign = f64::from(line.key.direction.sign);
    let entry = (line.key.channel.index(), line.key.direction.axis.index());
    let largest = line.points.iter().map(|p| p.load).fold(0.0, f64::max);
    let loads = (0..=POINTS).map(|k| 1.06 * largest * k as f64 / POINTS as f64);
    let is_at_tip = line.key.load_station.is_none() && line.key.read_station.is_none();
    let mut lines = Vec::new();
    let mut model = |label: &str, slope: f64, uncertainty: Option<Compliance>| {
        let band = uncertainty.filter(|_| is_at_tip).map(|u| {
            let half = HALF_95 * u.force[entry];
            let edge = |load: f64, slope: f64| sign * slope * load / UM;
            let around = |load: f64| {
                let (a, b) = (edge(load, slope - half), edge(load, slope + half));
                [load, a.min(b), a.max(b)]
            };
            loads.clone().map(around).collect()
        });
        lines.push(LoadLine {
            label: label.into(),
            slope_um_per_n: sign * slope / UM,
            intercept_um: 0.0,
            is_fit: false,
            band: band.unwrap_or_default(),
        });
    };
    if let Some(measured) = &fit.measured {
        if let Some(calc) = measured.calc.filter(|_| is_at_tip) {
            model("Calc", calc.force[entry], uncertainty.calc);
        }
        model("FEA", measured.predicted[index], uncertainty.fea);
    }
    let name = if rod.is_some() { "Meas" } else { "line" };
    let around = |load: f64| {
        let at = line.at(load);
        let half = at.half_width_95()?;
        Some([load, (at.value - half) / UM, (at.value + half) / UM])
    };
    let band: Option<Vec<[f64; 3]>> = loads.clone().map(around).collect();
    let fitted = |label: String, intercept: &Estimate, is_fit| LoadLine {
        label,
        slope_um_per_n: sign * line.slope.value / UM,
        intercept_um: intercept.value / UM,
        is_fit,
        band: band.clone().filter(|_| is_fit).unwrap_or_default(),
    };
    lines.push(fitted(name.into(), &line.intercept, true));
    lines.extend(line.unload_intercept.map(|b| fitted(format!("{name}, unloading"), &b, false)));
    let noise = line.noise_sd.unwrap_or(0.0);
    let readings = |phase: Phase| {
        let points = line.points.iter().filter(move |point| point.phase == phase);
        let mean = |point: &Point| MeanReading {
            load_n: point.load,
            mean_um: point.mean / UM,
            standard_error_um: noise / point.count.sqrt() / UM,
            residual_um: point.residual / UM,
        };
        points.map(mean).collect()
    };
    let prefix = rod.map_or(String::new(), |rod| format!("rod {}, ", rod.name));
    LoadDeflection {
        title: format!("{prefix}{}", line.key.label()),
        lines,
        readings: readings(Phase::Load),
        unloading: readings(Phase::Unload),
        noise_um: noise_um(line),
    }
}
