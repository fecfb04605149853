//! What is asked of a rod and of its readings.

use pyo3::prelude::*;
use rodcal::answer::{self, ComplianceOptions, rods_beside};
use rodcal::beam::Physics;
use rodcal::compliance::{Mode, paper_contact_force};
use rodcal::least_squares::{Robust, RobustScale};
use rodcal::rig;
use rodcal::units::MM;

use crate::answer::Answer;
use crate::arguments::{choice, within};
use crate::errors::wrong;
use crate::inputs::{Readings, Rod};
use crate::work::{Progress, run};

/// Most elements of a beam model.
const MOST_ELEMENTS: usize = 1_000_000;

fn physics(py: Python<'_>, theory: &str) -> PyResult<Physics> {
    let shear = choice(py, "theory", theory, &[("timoshenko", true), ("euler-bernoulli", false)])?;
    Ok(Physics::default().with_shear(shear))
}

#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn compliance(
    py: Python<'_>,
    rod: &Bound<'_, Rod>,
    mode: &str,
    theory: Option<&str>,
    elements: usize,
    contact_force_n: Option<f64>,
    load_station_mm: Option<f64>,
    read_station_mm: Option<f64>,
    damping_percent: Option<f64>,
) -> PyResult<Answer> {
    let contact_force = contact_force_n.unwrap_or_else(paper_contact_force);
    if !(contact_force.is_finite() && contact_force >= 0.0) {
        let expected = "a force in N, 0 or more";
        return Err(wrong(py, "contact_force_n", contact_force.to_string(), expected.into()));
    }
    if let Some(percent) = damping_percent.filter(|percent| !(*percent > 0.0 && *percent < 100.0)) {
        return Err(wrong(py, "damping_percent", percent.to_string(), "above 0 and below 100".into()));
    }
    let options = ComplianceOptions::default()
        .with_mode(choice(py, "mode", mode, &[("fea", Mode::Fea), ("calc", Mode::Calc)])?)
        .with_physics(physics(py, theory.unwrap_or("timoshenko"))?)
        .with_elements(within(py, "elements", elements, 1, MOST_ELEMENTS)?)
        .with_contact_force(contact_force)
        .with_stations(load_station_mm.map(|mm| mm * MM), read_station_mm.map(|mm| mm * MM))
        .with_damping_ratio(damping_percent.map(|percent| 0.01 * percent));
    let rod = rod.get().rod.clone();
    run(py, None, Progress::default(), |_| answer::compliance(rod, &options)).map(Answer)
}

#[pyfunction]
pub fn rig_fit(
    py: Python<'_>,
    rod: Option<&Bound<'_, Rod>>,
    readings: &Bound<'_, Readings>,
    theory: &str,
    elements: usize,
    robust: &str,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let scale = RobustScale::Mad;
    let weights = [
        ("none", Robust::None),
        ("huber", Robust::Huber { k: 1.345, scale }),
        ("tukey", Robust::Tukey { c: 4.685, scale }),
    ];
    let options = rig::Options::default()
        .with_physics(physics(py, theory)?)
        .with_elements(within(py, "elements", elements, 1, MOST_ELEMENTS)?)
        .with_robust(choice(py, "robust", robust, &weights)?);
    let rod = rod.map(|rod| &rod.get().rod);
    let readings = &readings.get().readings;
    run(py, progress, Progress::of_jobs(), |_| answer::rig_fit(readings, rod, &options)).map(Answer)
}

#[pyfunction]
pub fn diagnose_rig(
    py: Python<'_>,
    rod: Option<&Bound<'_, Rod>>,
    readings: &Bound<'_, Readings>,
    apply: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let rod = rod.map(Bound::get);
    // a rod in memory stands beside nothing
    let beside = rod.and_then(|rod| rod.path.as_deref());
    let readings = &readings.get().readings;
    run(py, progress, Progress::of_jobs(), |_| {
        let others = beside.map(rods_beside).unwrap_or_default();
        let named = |what: &str| match what {
            "rod" => "rod-diagnosed.toml".to_owned(),
            _ => "readings-diagnosed.csv".to_owned(),
        };
        let apply = apply.then_some(&named as &dyn Fn(&str) -> String);
        answer::diagnose_rig(readings, rod.map(|rod| &rod.rod), &others, apply)
    })
    .map(Answer)
}
