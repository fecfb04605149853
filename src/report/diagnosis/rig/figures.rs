//! A diagnosis as plain numbers for its pictures.

use nalgebra::DVector;

use super::lines::branch_name;
use crate::diagnosis::rig::{Datum, RigDiagnosis};
use crate::inference::{Covariate, Finding, Location, Part, Variable, rms};
use crate::report::chart::Figure;
use crate::report::diagnosis::tables::covariates;
use crate::report::pictures::diagnosis::{BeforeAfter, Residual, ResidualPoint, before_after};
use crate::report::pictures::{RodShape, Station, StationKind, Stretch, rod_shape};
use crate::report::rod_drawing::{drawing, stations};
use crate::rod::Rod;
use crate::spatial::Axis;
use crate::units::{MM, UM};

/// What was recorded.
const NOUN: &str = "readings";
/// Points of a centreline.
const POINTS: usize = 120;
/// So many lines of readings are distinguished in one picture.
const MOST_SERIES: usize = 6;
/// Of many lines those are distinguished that are off by so many times the noise.
const OFF: f64 = 1.5;
/// Name of all others.
const OTHERS: &str = "all other readings";

/// The covariate along which the residuals are most structured.
pub fn most_structured(found: &RigDiagnosis) -> Option<usize> {
    let z = |k: usize| found.diagnosis.structure_before[k].z;
    covariates(&found.evidence).into_iter().rev().max_by(|a, b| z(*a).total_cmp(&z(*b)))
}

/// What the strongest finding is seen along; without one, where the residuals are most structured.
/// What follows sensor, axis, or way up or down is seen over the load: there these are series.
fn seen_along(found: &RigDiagnosis) -> Covariate {
    let all = &found.evidence.covariates;
    let reported = covariates(&found.evidence);
    let of_variable = |variable: Variable| reported.iter().map(|&k| &all[k]).find(|c| c.variable == variable);
    let left = found.diagnosis.discrepancy.as_ref().and_then(|left| left.location.as_ref());
    let structured = || most_structured(found).map(|k| &all[k]).filter(|c| !c.variable.is_group());
    let best = match (found.diagnosis.findings.first(), left) {
        (Some(finding), _) => {
            (finding.effect.seen_along)(&finding.location).into_iter().find_map(of_variable)
        }
        (None, Some(Location::Curve { along: Some(along), .. })) => of_variable(*along).or_else(structured),
        (None, _) => structured(),
    };
    best.cloned().unwrap_or_else(|| Covariate {
        variable: Variable::Load,
        values: found.model.data().iter().map(|datum| datum.load).collect(),
    })
}

/// Residuals before and after along the number that they are best seen along.
pub fn residuals(found: &RigDiagnosis) -> Figure {
    let data = found.model.data();
    let covariate = seen_along(found);
    let (diagnosis, unexplained) = (&found.diagnosis, found.diagnosis.discrepancy.as_ref());
    let point = |i: usize| {
        let point = ResidualPoint {
            x: covariate.values[i],
            before_um: diagnosis.before[i] / UM,
            after_um: diagnosis.after[i] / UM,
            unexplained_um: unexplained.map_or(0.0, |left| left.shape[i] / UM),
        };
        (!point.x.is_nan()).then_some(point)
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
    let variable = covariate.variable;
    let unit = if variable.unit().is_empty() { String::new() } else { format!(" / {}", variable.unit()) };
    let is_drawn = |k: &usize| found.evidence.covariates[*k].variable == variable;
    let plainest = most_structured(found).filter(|_| diagnosis.is_mismatch()).filter(is_drawn);
    let plainest = plainest.map_or("", |_| " Of all variables the residuals follow this one most clearly.");
    before_after(&BeforeAfter {
        along: format!("{}{unit}", variable.title(NOUN)),
        names: value_names(&covariate, data),
        series,
        noise_um: diagnosis.noise / UM,
        ..BeforeAfter::default()
    })
    .captioned(format!(
        "Residuals of the readings, before and after the findings are included. Lines: what the \
         findings explain, and the unexplained remainder. Pure noise would lie within the \
         band.{plainest}"
    ))
}

/// The lines of readings that are distinguished: those that are off by more than noise, the worst
/// if they are many; all of a few lines.
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

/// Names of values that are no amounts.
fn value_names(covariate: &Covariate, data: &[Datum]) -> Vec<(f64, String)> {
    let named: Vec<(f64, String)> = match covariate.variable {
        Variable::Phase => vec![(-1.0, "up".into()), (1.0, "down".into())],
        Variable::Channel => Axis::ALL.map(|axis| (axis.index() as f64, format!("d{axis}"))).into(),
        Variable::LoadAxis => Axis::ALL.map(|axis| (axis.index() as f64, axis.to_string())).into(),
        Variable::Trial => {
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
        found.diagnosis.findings.iter().filter_map(|finding| located(finding, rod)).collect();
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
        let (label, from, to) = place.stretch?;
        Some(Stretch { label: label.into(), points_mm: line(from, to) })
    };
    // pipe I, what there is of a bend, and pipe II: the corner is a point of the line
    let (start, end) = (rod.bend_start(), rod.bend_end());
    let mut whole = line(0.0, start);
    whole.extend(line(start, end).into_iter().skip(1).filter(|_| end > start));
    whole.extend(line(end, rod.length()).into_iter().skip(1));
    // a ring around a joint that is drawn already needs its name once
    let drawn =
        stations(rod).into_iter().map(|station| match located.iter().any(|l| l.label == station.label) {
            true => Station { label: String::new(), ..station },
            false => station,
        });
    let figure = rod_shape(&RodShape {
        centreline_mm: whole,
        stations: drawn.chain(located.iter().map(ring)).collect(),
        stretches: located.iter().filter_map(stretch).collect(),
        ..drawing(rod)
    });
    let names: Vec<&str> = located.iter().map(|place| place.label.as_str()).collect();
    let caption = format!("Where the rod differs from its model: {}. {}", names.join("; "), figure.caption);
    Some(figure.named("places").captioned(caption))
}

/// A place on the rod, m from the flange.
struct Located {
    label: String,
    at: f64,
    /// From where to where, and what that says.
    stretch: Option<(&'static str, f64, f64)>,
}

/// A ring around the place, where it is one of the rod.
fn located(finding: &Finding, rod: &Rod) -> Option<Located> {
    let label = finding.location.to_string();
    let whole = |from: f64, to: f64| (0.5 * (from + to), Some(("the whole pipe", from, to)));
    let (at, stretch) = match &finding.location {
        Location::Part(Part::Root) | Location::InSession { part: Part::Root, .. } => (0.0, None),
        Location::Part(Part::Pipe1 | Part::Length1) => whole(0.0, rod.bend_start()),
        Location::Part(Part::Pipe2 | Part::Length2) => whole(rod.bend_end(), rod.length()),
        Location::Part(Part::Bend | Part::Angle) => (0.5 * (rod.bend_start() + rod.bend_end()), None),
        Location::Station(at) => {
            let place = finding.place_estimate();
            (*at, place.map(|place| ("where it may be", place.low, place.high)))
        }
        Location::Named(name) => (rod.joints.iter().find(|joint| &joint.name == name)?.station, None),
        _ => return None,
    };
    Some(Located { label, at, stretch })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::{Physics, RodModel};
    use crate::diagnosis::rig::diagnose;
    use crate::rig::readings::Readings;
    use crate::section::Round;
    use crate::statistics::Random;

    /// Walls of pipe 1 that are thinner than the file's.
    #[test]
    fn a_pipe_that_differs_is_drawn_as_a_whole() {
        let file = Rod::from_toml("rod", include_str!("../../../../rods/5.toml")).unwrap();
        let mut actual = file.clone();
        actual.pipe1.section = Round::tube(32e-3, 30.4e-3).into();
        let model = RodModel::new(&actual, &Physics::WHOLE, 1, &[]).unwrap();
        let c = model.force_response(actual.length(), actual.length()).unwrap().translation / UM;
        let mut random = Random::seeded(8, 0);
        let mut text = "axis,load_n,trial,dx_um,dy_um,dz_um\n".to_owned();
        for (trial, axis) in (1..5).flat_map(|trial| (0..3).map(move |axis| (trial, axis))) {
            for load in [5.0, 10.0, 15.0, 20.0] {
                let [x, y, z] = [0, 1, 2].map(|channel| c[(channel, axis)] * load + random.normal());
                text += &format!("{},{load},{trial},{x:.1},{y:.1},{z:.1}\n", ["x", "y", "z"][axis]);
            }
        }
        let found = diagnose(&Readings::from_text("f", &text).unwrap(), Some(&file)).unwrap();
        let finding = found.diagnosis.findings.first().unwrap();
        let own = located(finding, &file).unwrap();
        assert_eq!((own.label.as_str(), own.stretch), ("pipe 1", Some(("the whole pipe", 0.0, file.l1))));
        let figure = places(&found, &file).unwrap();
        assert!(
            figure.caption.starts_with("Where the rod differs from its model: pipe 1."),
            "{}",
            figure.caption
        );
    }
}
