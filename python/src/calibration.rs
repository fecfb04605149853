//! What is asked of a campaign and of a calibrated robot.

use std::sync::OnceLock;

use nalgebra::Vector3;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rodcal::answer;
use rodcal::calibration::simulate::{Plan, planned_poses};
use rodcal::calibration::{
    Calibration, CompareOptions, CrossValidation, Draws, Mode, Options, Robust, default_mode,
};
use rodcal::diagnosis::calibration::Neighbours;
use rodcal::files::{self, Existing};
use rodcal::limits;
use rodcal::report::prediction::Prediction;
use rodcal::robot::PredictionQuery;
use rodcal::units::{MM, UM};

use crate::answer::{Answer, by_name, python};
use crate::arguments::{choice, within};
use crate::errors::{IntoPython, wrong};
use crate::inputs::{Campaign, Robot, Rod};
use crate::work::{Progress, run};

/// How the rod's deflection is known; the campaign's default where nothing is said.
pub fn mode_named(py: Python<'_>, mode: Option<&str>) -> PyResult<Option<Mode>> {
    let modes = [("none", Mode::None), ("calc", Mode::Calc), ("fea", Mode::Fea), ("meas", Mode::Meas)];
    mode.map(|mode| choice(py, "mode", mode, &modes)).transpose()
}

pub fn robust_named(py: Python<'_>, robust: &str) -> PyResult<Robust> {
    let weights = [("none", Robust::None), ("huber", Robust::Huber), ("tukey", Robust::Tukey)];
    choice(py, "robust", robust, &weights)
}

/// What stands beside a campaign of files.
fn neighbours(campaign: &Campaign) -> Neighbours {
    match campaign.is_file {
        true => answer::neighbours(&campaign.campaign),
        false => Neighbours::default(),
    }
}

/// Rows of three numbers as an array of n rows, which takes over their memory.
fn rows<'py>(py: Python<'py>, rows: &[Vector3<f64>], unit: f64) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let numbers: Vec<f64> = rows.iter().flat_map(|row| (row / unit).data.0[0]).collect();
    numbers.into_pyarray(py).reshape([rows.len(), 3])
}

#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn calibrate<'py>(
    py: Python<'py>,
    campaign: &Bound<'py, Campaign>,
    mode: Option<&str>,
    robust: &str,
    prune: bool,
    folds: Option<usize>,
    held_out: Option<Vec<(usize, [f64; 3])>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Answer, Bound<'py, PyDict>)> {
    let own = campaign.get();
    let campaign = &own.campaign;
    let mode = mode_named(py, mode)?.unwrap_or_else(|| default_mode(campaign));
    let options = Options::default().with_robust(robust_named(py, robust)?).with_pruning(prune);
    let folds = folds.map(|folds| within(py, "folds", folds, 2, 1000)).transpose()?;
    let (answer, calibration) = run(py, progress, Progress::of_jobs(), |_| match &held_out {
        None => answer::calibrate(campaign, mode, &options, folds, &neighbours(own)),
        Some(predicted) => {
            let predicted = predicted.iter().map(|(row, m)| (*row, Vector3::from(*m))).collect::<Vec<_>>();
            let of_calibration =
                |_: &Calibration, folds| CrossValidation::of(campaign, folds, predicted.clone());
            answer::calibrate_held_out(campaign, mode, &options, folds, &neighbours(own), &of_calibration)
        }
    })?;
    let arrays = PyDict::new(py);
    arrays.set_item("deviations_um", rows(py, &calibration.deviations, UM)?)?;
    arrays.set_item("deflections_um", rows(py, &calibration.deflections, UM)?)?;
    arrays.set_item("tips_mm", rows(py, &calibration.tips, MM)?)?;
    Ok((Answer(answer), arrays))
}

#[pyfunction]
pub fn compare(
    py: Python<'_>,
    campaign: &Bound<'_, Campaign>,
    robust: &str,
    draws: usize,
    seed: u64,
    drawn: Option<Vec<Option<Vec<f64>>>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let campaign = &campaign.get().campaign;
    let options = compared(py, robust, draws, seed)?;
    if let Some(drawn) = drawn.as_ref().filter(|drawn| drawn.len() != draws) {
        return Err(wrong(py, "drawn", format!("{} draws", drawn.len()), draws.to_string()));
    }
    let counted = Progress::of(options.draws as u64);
    run(py, progress, counted, |progress| match drawn {
        None => answer::compare(campaign, &options, &|_| progress.more(1)),
        Some(drawn) => Ok(answer::compare_drawn(campaign, Draws::new(campaign, &options)?, drawn)),
    })
    .map(Answer)
}

/// How modes are compared.
pub fn compared(py: Python<'_>, robust: &str, draws: usize, seed: u64) -> PyResult<CompareOptions> {
    let calibration = Options::default().with_robust(robust_named(py, robust)?);
    let draws = within(py, "draws", draws, 50, 100_000)?;
    Ok(CompareOptions::default().with_calibration(calibration).with_draws(draws).with_seed(seed))
}

#[pyfunction]
pub fn diagnose_calibration(
    py: Python<'_>,
    campaign: &Bound<'_, Campaign>,
    mode: Option<&str>,
    apply: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let own = campaign.get();
    let content = |name: &str| own.content(name);
    let apply = apply.then_some(&content as &(dyn Fn(&str) -> rodcal::Result<Vec<u8>> + Sync));
    let campaign = &own.campaign;
    let mode = mode_named(py, mode)?.unwrap_or_else(|| default_mode(campaign));
    run(py, progress, Progress::of_jobs(), |_| {
        let apply = apply.map(|content| content as &dyn Fn(&str) -> rodcal::Result<Vec<u8>>);
        answer::diagnose_calibration(campaign, mode, &neighbours(own), apply)
    })
    .map(Answer)
}

/// Tips at poses; report and JSON are made where somebody asks for them.
#[pyclass(frozen, module = "rodcal._rodcal")]
pub struct Predicted {
    robot: rodcal::robot::Robot,
    prediction: Prediction,
    answer: OnceLock<rodcal::answer::Answer>,
}

#[pymethods]
impl Predicted {
    #[getter]
    fn tips_mm<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let tips: Vec<Vector3<f64>> = self.prediction.tips.iter().map(|(_, tip, _)| *tip).collect();
        rows(py, &tips, MM)
    }

    #[getter]
    fn sd_mm<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let sd: Option<Vec<Vector3<f64>>> = self.prediction.tips.iter().map(|(_, _, sd)| *sd).collect();
        sd.map(|sd| rows(py, &sd, MM)).transpose()
    }

    #[getter]
    fn ratios<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.prediction.ratios.clone().map(|ratios| ratios.into_pyarray(py))
    }

    /// What `restored` takes beside the robot: joint values (rad or m), tool (m), whether aligned.
    #[allow(clippy::type_complexity)]
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyArray2<f64>>, (f64, f64, f64), bool)> {
        let Prediction { tips, tool, is_aligned, .. } = &self.prediction;
        let width = self.robot.joints.len();
        let values: Vec<f64> = tips.iter().flat_map(|(query, ..)| query.joints.iter().copied()).collect();
        let tool = (tool.x, tool.y, tool.z);
        Ok((values.into_pyarray(py).reshape([tips.len(), width])?, tool, *is_aligned))
    }

    /// The same tips again, of one that was pickled.
    #[staticmethod]
    fn restored(
        py: Python<'_>,
        robot: &Bound<'_, Robot>,
        joints: PyReadonlyArray2<'_, f64>,
        tool: [f64; 3],
        aligned: bool,
    ) -> PyResult<Predicted> {
        let robot = robot.get().robot.clone();
        let joints = joints.as_array();
        let poses = joints.rows().into_iter().enumerate();
        let poses =
            poses.map(|(row, own)| PredictionQuery::new((row + 1).to_string(), own.to_vec())).collect();
        let prediction = Prediction::new(&robot, tool.into(), poses, aligned).or_raise(py)?;
        Ok(Predicted { robot, prediction, answer: OnceLock::new() })
    }

    fn answer(&self) -> Answer {
        let answer =
            self.answer.get_or_init(|| answer::predicted(self.robot.clone(), self.prediction.clone()));
        Answer(answer.clone())
    }
}

#[pyfunction]
pub fn predict(
    py: Python<'_>,
    robot: &Bound<'_, Robot>,
    joints: PyReadonlyArray2<'_, f64>,
    tool_mm: Option<[f64; 3]>,
    aligned: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Predicted> {
    let robot = &robot.get().robot;
    let units: Vec<f64> = robot.joints.iter().zip(1..).map(|(joint, n)| joint.column(n).1).collect();
    let (count, width) = (joints.shape()[0], joints.shape()[1]);
    if width != units.len() || count == 0 {
        let expected = format!("an array of shape (n, {}), n ≥ 1", units.len());
        return Err(wrong(py, "joints", format!("of shape ({count}, {width})"), expected));
    }
    // what is aligned is held whole: as many poses as a file may have
    if aligned {
        limits::check("<joints>", count, limits::TABLE_ROWS, "rows").or_raise(py)?;
    }
    // a view of the caller's array, whatever its strides
    let view = joints.as_array();
    let values: Vec<f64> = view
        .rows()
        .into_iter()
        .flat_map(|row| row.iter().zip(&units).map(|(value, unit)| value * unit).collect::<Vec<f64>>())
        .collect();
    let is_value = |value: &f64| value.abs() <= limits::JOINT_VALUE as f64;
    if let Some(value) = view.iter().find(|value| !is_value(value)) {
        let expected = format!("numbers of at most {} in size", limits::JOINT_VALUE);
        return Err(wrong(py, "joints_deg", format!("{value} in one place"), expected));
    }
    if tool_mm.iter().flatten().any(|value| !value.is_finite()) {
        return Err(wrong(py, "tool_mm", "not finite".into(), "finite numbers".into()));
    }
    run(py, progress, Progress::of_jobs(), |_| {
        let moved = robot.after_moves(&values);
        let query =
            |(row, joints): (usize, &[f64])| PredictionQuery::new((row + 1).to_string(), joints.to_vec());
        let poses = moved.chunks(width).enumerate().map(query).collect();
        let tool = tool_mm.map(|xyz| xyz.map(|x| x * MM).into());
        let tool = tool.unwrap_or_else(|| robot.tip.map(|tip| tip.at).unwrap_or_default());
        let prediction = Prediction::new(robot, tool, poses, aligned)?;
        Ok(Predicted { robot: robot.clone(), prediction, answer: OnceLock::new() })
    })
}

#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn simulate<'py>(
    py: Python<'py>,
    robot: &Bound<'py, Robot>,
    rod: &Bound<'py, Rod>,
    seed: u64,
    poses: usize,
    validation: usize,
    r_rod: f64,
    planned: Option<(String, String)>,
    directory: Option<std::path::PathBuf>,
    is_forced: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyDict>)> {
    let (robot, rod) = (robot.get(), rod.get());
    if !(r_rod > 0.0 && r_rod <= 100.0) {
        let expected = "a number above 0 and up to 100";
        return Err(wrong(py, "r_rod", r_rod.to_string(), expected.into()));
    }
    let planned = match &planned {
        Some((name, text)) => planned_poses(&robot.robot, name, text).or_raise(py)?,
        None => Vec::new(),
    };
    let per_clamp = within(py, "poses", poses, 1, 1000)?;
    let plan = Plan::of_poses(per_clamp, within(py, "validation", validation, 4, 10_000)?);
    let mut plan = plan.with_seed(seed).with_rod_factor(r_rod);
    plan.planned = planned;
    let name = match (robot.file.starts_with("builtin:"), rodcal::robot::is_urdf(&robot.text)) {
        (true, _) => robot.file.clone(),
        (false, true) => "robot.urdf".to_owned(),
        (false, false) => "robot.toml".to_owned(),
    };
    let campaign = directory.as_deref().unwrap_or(std::path::Path::new("")).join("campaign.toml");
    let campaign = campaign.display().to_string();
    let existing = if is_forced { Existing::Replace } else { Existing::Keep };
    let simulated = run(py, progress, Progress::default(), |progress| {
        let tell = || progress.more(1);
        let named = (name, robot.text.clone());
        let rod = (&rod.rod, rod.text.clone());
        let simulated = answer::simulate(&robot.robot, named, rod, &plan, &campaign, &tell)?;
        if let Some(directory) = &directory {
            files::write_together(directory, &simulated.files, existing)?;
        }
        Ok(simulated)
    })?;
    Ok((python(py, &simulated.json)?, by_name(py, &simulated.files)?))
}
