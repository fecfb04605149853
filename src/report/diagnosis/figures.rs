//! A diagnosis as plain numbers for its pictures.

use nalgebra::DVector;

use super::branch_name;
use super::shared::covariates;
use crate::diagnosis::rig::{Datum, RigDiagnosis};
use crate::diagnosis::{Covariate, Finding, World, rms};
use crate::report::chart::Figure;
use crate::report::compliance::stations;
use crate::report::pictures::diagnosis::{BeforeAfter, Residual, ResidualPoint, before_after};
use crate::report::pictures::{RodShape, Station, StationKind, Stretch, rod_shape};
use crate::rig::readings::Axis;
use crate::rod::Rod;
use crate::units::{MM, UM};

/// Points of a centreline.
const POINTS: usize = 120;
/// So many lines of readings are told apart in one picture.
const MOST_SERIES: usize = 6;
/// Of many lines those are told apart that are off by so many times the noise.
const OFF: f64 = 1.5;
/// Name of all others.
const OTHERS: &str = "all other readings";

/// The covariate along which the residuals are most structured.
pub fn most_structured(found: &RigDiagnosis) -> Option<usize> {
    let z = |k: usize| found.diagnosis.structure_before[k].z;
    covariates(&found.evidence).into_iter().rev().max_by(|a, b| z(*a).total_cmp(&z(*b)))
}

/// What the strongest finding is seen along; without one, where the residuals are most structured. What follows sensor,
/// axis, or way up or down is seen over the load: there these are series.
fn seen_along(found: &RigDiagnosis) -> Covariate {
    let of_finding: &[&str] = match found.diagnosis.findings.first().map(|finding| found.effect(finding)) {
        Some("thermal_drift") => &["temperature", "time"],
        Some("creep") => &["time in the run"],
        Some("slip" | "outlier") => &["order"],
        Some(_) => &["signed load", "load"],
        None => &[],
    };
    let all = &found.evidence.covariates;
    let told = covariates(&found.evidence);
    let named = |name: &&str| told.iter().map(|&k| &all[k]).find(|covariate| covariate.name == **name);
    let plainest = || {
        let covariate = &all[most_structured(found)?];
        let is_group = ["channel", "axis", "phase"].contains(&covariate.name.as_str());
        (of_finding.is_empty() && !is_group).then_some(covariate)
    };
    of_finding.iter().find_map(named).or_else(plainest).cloned().unwrap_or_else(|| Covariate {
        name: "load".into(),
        unit: "N".into(),
        values: found.world.data().iter().map(|datum| datum.load).collect(),
    })
}

/// Residuals before and after along the number that they are best seen along.
pub fn residuals(found: &RigDiagnosis) -> Figure {
    let data = found.world.data();
    let covariate = seen_along(found);
    let (diagnosis, unexplained) = (&found.diagnosis, found.diagnosis.unexplained.as_ref());
    let point = |i: usize| {
        let of = ResidualPoint {
            x: covariate.values[i],
            before_um: diagnosis.before[i] / UM,
            after_um: diagnosis.after[i] / UM,
            unexplained_um: unexplained.map_or(0.0, |left| left.shape[i] / UM),
        };
        (!of.x.is_nan()).then_some(of)
    };
    let names: Vec<String> = data.iter().map(branch_name).collect();
    let shown = series(&names, &diagnosis.before, diagnosis.noise);
    let mut series = Vec::new();
    for is_context in [true, false] {
        let labels = if is_context { vec![OTHERS.to_owned()] } else { shown.clone() };
        series.extend(labels.into_iter().map(|label| {
            let is_of = |i: &usize| if is_context { !shown.contains(&names[*i]) } else { names[*i] == label };
            Residual { points: (0..data.len()).filter(is_of).filter_map(point).collect(), label, is_context }
        }));
    }
    series.retain(|series| !series.points.is_empty());
    let unit = if covariate.unit.is_empty() { String::new() } else { format!(" / {}", covariate.unit) };
    let plainest = most_structured(found).filter(|_| diagnosis.is_mismatch()).map_or_else(String::new, |k| {
        format!(" The mismatch is plainest along this number: {}.", along(&found.evidence.covariates[k].name))
    });
    before_after(&BeforeAfter {
        along: format!("{}{unit}", along(&covariate.name)),
        names: value_names(&covariate, data),
        series,
        noise_um: diagnosis.noise / UM,
        ..BeforeAfter::default()
    })
    .captioned(format!(
        "What the model leaves of the readings, before and after; lines show what the findings say, and what remains. What \
         is noise stays in the band.{plainest}"
    ))
}

/// The lines of readings that are told apart: those that are off by more than noise, the worst if they are many; all of a
/// few lines.
fn series(names: &[String], residual: &DVector<f64>, noise: f64) -> Vec<String> {
    let labels = distinct(names);
    let rms_of = |label: &String| {
        let of_label: Vec<usize> = (0..names.len()).filter(|&i| names[i] == *label).collect();
        rms(&residual.select_rows(&of_label))
    };
    let mut worst: Vec<f64> = labels.iter().map(rms_of).collect();
    worst.sort_by(|a, b| b.total_cmp(a));
    let Some(&least) = worst.get(MOST_SERIES) else { return labels };
    let least = if worst[0] > OFF * noise { least.max(OFF * noise) } else { least };
    labels.into_iter().filter(|label| rms_of(label) > least).collect()
}

/// A covariate as it is said.
pub fn along(name: &str) -> &str {
    match name {
        "signed load" => "load with its sign",
        "phase" => "way up or down",
        "order" => "order of the readings",
        "time in the run" => "time since the run began",
        "channel" => "sensor",
        "axis" => "axis of the load",
        other => other,
    }
}

/// Names of values that are no amounts.
fn value_names(covariate: &Covariate, data: &[Datum]) -> Vec<(f64, String)> {
    let named: Vec<(f64, String)> = match covariate.name.as_str() {
        "phase" => vec![(-1.0, "up".into()), (1.0, "down".into())],
        "channel" => Axis::ALL.map(|axis| (axis.index() as f64, format!("d{axis}"))).into(),
        "axis" => Axis::ALL.map(|axis| (axis.index() as f64, axis.to_string())).into(),
        "trial" => {
            let name = |d: &Datum| d.trial.clone().unwrap_or_else(|| (d.trial_number + 1).to_string());
            let mut names: Vec<(f64, String)> =
                data.iter().map(|d| (d.trial_number as f64, name(d))).collect();
            names.sort_by(|a, b| a.0.total_cmp(&b.0));
            names.dedup_by(|a, b| a.0 == b.0);
            names
        }
        _ => Vec::new(),
    };
    named.into_iter().filter(|(value, _)| covariate.values.contains(value)).collect()
}

fn distinct(names: &[String]) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for name in names {
        if !found.contains(name) {
            found.push(name.clone());
        }
    }
    found
}

/// The rod with the places of the findings; `None` where no finding has one.
pub fn places(found: &RigDiagnosis, rod: &Rod) -> Option<Figure> {
    let located: Vec<Located> =
        found.diagnosis.findings.iter().filter_map(|finding| located(found, finding, rod)).collect();
    if located.is_empty() {
        return None;
    }
    let at_mm = |station: f64| -> [f64; 3] { (rod.point(station) / MM).into() };
    let line = |from: f64, to: f64| {
        let at = |k: usize| at_mm(from + (to - from) * k as f64 / (POINTS - 1) as f64);
        (0..POINTS).map(at).collect::<Vec<_>>()
    };
    let ring = |place: &Located| Station {
        label: place.label.clone(),
        at_mm: at_mm(place.at),
        kind: StationKind::Located,
    };
    let stretch = |place: &Located| {
        let (from, to) = place.between?;
        Some(Stretch { label: "where it may be".into(), points_mm: line(from, to) })
    };
    // a ring around a joint that is drawn already needs its name once
    let drawn =
        stations(rod).into_iter().map(|station| match located.iter().any(|l| l.label == station.label) {
            true => Station { label: String::new(), ..station },
            false => station,
        });
    let figure = rod_shape(&RodShape {
        title: format!("Rod {}", rod.name),
        centreline_mm: line(0.0, rod.length()),
        stations: drawn.chain(located.iter().map(ring)).collect(),
        stretches: located.iter().filter_map(stretch).collect(),
        ..RodShape::default()
    });
    let names: Vec<&str> = located.iter().map(|place| place.label.as_str()).collect();
    Some(
        figure
            .named("places")
            .captioned(format!("Where the rod yields more than its model says: {}.", names.join("; "))),
    )
}

/// A place on the rod, m from the flange.
struct Located {
    label: String,
    at: f64,
    between: Option<(f64, f64)>,
}

fn located(found: &RigDiagnosis, finding: &Finding, rod: &Rod) -> Option<Located> {
    let parameters = &found.world.candidates()[finding.chosen.candidate].parameters;
    let station = parameters.iter().position(|parameter| parameter.name == "station_mm");
    let label = finding.place.clone();
    match found.effect(finding) {
        "joint_compliance" => match station.and_then(|k| finding.parameters.get(k)) {
            Some(&(at, ..)) => Some(Located { label, at, between: found.world.stretch(finding) }),
            None => {
                let joint = rod.joints.iter().find(|joint| joint.name == finding.place)?;
                Some(Located { label, at: joint.station, between: None })
            }
        },
        "root_compliance" => Some(Located { label, at: 0.0, between: None }),
        "bend_flexibility" => {
            let (from, to) = (rod.bend_start(), rod.bend_end());
            Some(Located { label, at: 0.5 * (from + to), between: None })
        }
        _ => None,
    }
}
