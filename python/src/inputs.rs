//! Rods, readings, robots and campaigns as Python holds them.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use rodcal::calibration::campaign::Targets;
use rodcal::robot::corrections_from_csv;
use rodcal::{Result, files};

use crate::errors::IntoPython;

/// A rod with the text that it was read from.
#[pyclass(frozen, module = "rodcal._rodcal")]
pub struct Rod {
    pub rod: rodcal::rod::Rod,
    pub text: String,
    /// Its file, where it was read from one.
    pub path: Option<PathBuf>,
}

#[pymethods]
impl Rod {
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Rod> {
        let text = files::read_text(&path).or_raise(py)?;
        let rod = rodcal::rod::Rod::from_toml(&path.display().to_string(), &text).or_raise(py)?;
        Ok(Rod { rod, text, path: Some(path) })
    }

    #[staticmethod]
    fn from_text(py: Python<'_>, file: &str, text: String) -> PyResult<Rod> {
        let rod = rodcal::rod::Rod::from_toml(file, &text).or_raise(py)?;
        Ok(Rod { rod, text, path: None })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.rod.name
    }

    #[getter]
    fn length_m(&self) -> f64 {
        self.rod.length()
    }

    #[getter]
    fn mass_kg(&self) -> f64 {
        self.rod.mass()
    }

    #[getter]
    fn tip_m(&self) -> [f64; 3] {
        self.rod.tip().into()
    }

    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    #[getter]
    fn path(&self) -> Option<String> {
        self.path.as_ref().map(|path| path.display().to_string())
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.rod.warnings.iter().map(ToString::to_string).collect()
    }

    fn to_toml(&self) -> String {
        self.rod.to_toml(&[])
    }
}

/// Readings of a rig with the text that they were read from.
#[pyclass(frozen, module = "rodcal._rodcal")]
pub struct Readings {
    pub readings: rodcal::rig::readings::Readings,
    pub text: String,
}

#[pymethods]
impl Readings {
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Readings> {
        let readings = rodcal::rig::readings::Readings::read(&path).or_raise(py)?;
        Ok(Readings { readings, text: files::read_text(&path).or_raise(py)? })
    }

    #[staticmethod]
    fn from_text(py: Python<'_>, file: &str, text: String) -> PyResult<Readings> {
        let readings = rodcal::rig::readings::Readings::from_text(file, &text).or_raise(py)?;
        Ok(Readings { readings, text })
    }

    fn __len__(&self) -> usize {
        self.readings.rows.len()
    }

    #[getter]
    fn file(&self) -> &str {
        &self.readings.file
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.readings.warnings.iter().map(ToString::to_string).collect()
    }

    #[getter]
    fn text(&self) -> &str {
        &self.text
    }
}

/// A robot with the text that it was read from.
#[pyclass(frozen, module = "rodcal._rodcal")]
pub struct Robot {
    pub robot: rodcal::robot::Robot,
    pub file: String,
    pub text: String,
    pub links: [Option<String>; 2],
    /// Names and texts of what stands beside a URDF: effects and corrections.
    pub beside: [Option<(String, String)>; 2],
}

#[pymethods]
impl Robot {
    /// `effects` and `corrections` are names and texts of what stands beside a URDF.
    #[staticmethod]
    #[pyo3(signature = (file, text, base_link, tip_link, effects, corrections))]
    fn from_text(
        py: Python<'_>,
        file: String,
        text: String,
        base_link: Option<String>,
        tip_link: Option<String>,
        effects: Option<(String, String)>,
        corrections: Option<(String, String)>,
    ) -> PyResult<Robot> {
        let (base, tip) = (base_link.as_deref(), tip_link.as_deref());
        let robot = rodcal::robot::Robot::from_text(&file, &text, base, tip);
        let mut robot = robot.or_raise(py)?;
        if let Some((name, text)) = &effects {
            robot.add_beside(name, text).or_raise(py)?;
        }
        if let Some((name, text)) = &corrections {
            let more = corrections_from_csv(name, text, robot.joints.len()).or_raise(py)?;
            robot.effects.extend(more);
        }
        Ok(Robot { robot, file, text, links: [base_link, tip_link], beside: [effects, corrections] })
    }

    #[staticmethod]
    fn named(py: Python<'_>, name: &str) -> PyResult<Robot> {
        let (file, text) = rodcal::answer::named_robot(name).or_raise(py)?;
        Robot::from_text(py, file, text, None, None, None, None)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.robot.name
    }

    #[getter]
    fn file(&self) -> &str {
        &self.file
    }

    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    #[getter]
    fn beside(&self) -> Option<&str> {
        self.beside[0].as_ref().map(|(_, text)| text.as_str())
    }

    /// What [`Robot::from_text`] makes the same robot from, on another machine too.
    #[getter]
    #[allow(clippy::type_complexity)]
    fn texts(
        &self,
    ) -> (&str, &str, Option<&str>, Option<&str>, Option<(String, String)>, Option<(String, String)>) {
        let ([base, tip], [effects, corrections]) = (&self.links, self.beside.clone());
        let (base, tip) = (base.as_deref(), tip.as_deref());
        (&self.file, &self.text, base, tip, effects, corrections)
    }

    #[getter]
    fn links(&self) -> (Option<&str>, Option<&str>) {
        (self.links[0].as_deref(), self.links[1].as_deref())
    }

    /// The columns of its joint values: `q1_deg`, `q3_mm`.
    #[getter]
    fn columns(&self) -> Vec<String> {
        columns(&self.robot)
    }
}

fn columns(robot: &rodcal::robot::Robot) -> Vec<String> {
    robot.joints.iter().zip(1..).map(|(joint, number)| joint.column(number).0).collect()
}

/// The text of a file; what cannot be read is the package's own exception.
#[pyfunction]
pub fn read_text(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    files::read_text(&path).or_raise(py)
}

/// A campaign, read or built.
#[pyclass(frozen, module = "rodcal._rodcal")]
pub struct Campaign {
    pub campaign: rodcal::calibration::Campaign,
    /// Read from a file of its own, beside which others may stand.
    pub is_file: bool,
    /// What it was read from: its text, the texts that it names, and whether it is a plan.
    text: String,
    texts: BTreeMap<String, String>,
    is_plan: bool,
}

impl Campaign {
    /// The content of a file that it names.
    pub fn content(&self, name: &str) -> Result<Vec<u8>> {
        match self.texts.get(name) {
            Some(text) => Ok(text.clone().into_bytes()),
            None => {
                let directory = Path::new(&self.campaign.file).parent().unwrap_or(Path::new(""));
                files::read_bytes(&directory.join(name))
            }
        }
    }

    fn of(
        file: &str,
        text: String,
        open: &dyn Fn(&str) -> Result<String>,
        is_plan: bool,
        is_file: bool,
    ) -> Result<Campaign> {
        let texts = RefCell::new(BTreeMap::new());
        let opened = |name: &str| -> Result<String> {
            let text = open(name)?;
            texts.borrow_mut().insert(name.to_owned(), text.clone());
            Ok(text)
        };
        let campaign = match is_plan {
            true => rodcal::calibration::Campaign::plan_from_texts(file, &text, &opened),
            false => rodcal::calibration::Campaign::from_texts(file, &text, &opened),
        }?;
        Ok(Campaign { campaign, is_file, text, texts: texts.into_inner(), is_plan })
    }
}

#[pymethods]
impl Campaign {
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, is_plan: bool) -> PyResult<Campaign> {
        let directory = path.parent().unwrap_or(Path::new(""));
        let open = |name: &str| files::read_text(&directory.join(name));
        let file = path.display().to_string();
        let read = files::read_text(&path).and_then(|text| Campaign::of(&file, text, &open, is_plan, true));
        read.or_raise(py)
    }

    /// Of a campaign's text and the texts that it names; what is none of those is a file.
    #[staticmethod]
    fn from_texts(
        py: Python<'_>,
        file: &str,
        text: &str,
        texts: BTreeMap<String, String>,
        is_plan: bool,
    ) -> PyResult<Campaign> {
        let open = |name: &str| -> Result<String> {
            texts.get(name).cloned().map_or_else(|| files::read_text(Path::new(name)), Ok)
        };
        Campaign::of(file, text.to_owned(), &open, is_plan, false).or_raise(py)
    }

    /// What [`Campaign::from_texts`] makes the same campaign from, on another machine too.
    #[getter]
    fn texts(&self) -> (&str, &str, BTreeMap<String, String>, bool) {
        (&self.campaign.file, &self.text, self.texts.clone(), self.is_plan)
    }

    #[getter]
    fn file(&self) -> &str {
        &self.campaign.file
    }

    /// The links of its URDF that it names.
    #[getter]
    fn links(&self) -> (Option<&str>, Option<&str>) {
        (self.campaign.base_link.as_deref(), self.campaign.tip_link.as_deref())
    }

    #[getter]
    fn robot(&self) -> &str {
        &self.campaign.robot.name
    }

    #[getter]
    fn rod(&self) -> Option<&str> {
        self.campaign.rod.as_ref().map(|rod| rod.name.as_str())
    }

    /// The columns of its robot's joint values.
    #[getter]
    fn columns(&self) -> Vec<String> {
        columns(&self.campaign.robot)
    }

    #[getter]
    fn mode(&self) -> &'static str {
        rodcal::calibration::default_mode(&self.campaign).name()
    }

    #[getter]
    fn pose_names(&self) -> Vec<String> {
        let recording = &self.campaign.measurements;
        (0..recording.len()).map(|row| recording.pose_name(row)).collect()
    }

    #[getter]
    fn poses(&self) -> usize {
        self.campaign.measurements.len()
    }

    #[getter]
    fn validation_poses(&self) -> usize {
        self.campaign.validation.as_ref().map_or(0, |recording| recording.len())
    }

    #[getter]
    fn has_points(&self) -> bool {
        matches!(self.campaign.measurements.targets, Targets::Points(_))
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.campaign.warnings.iter().map(ToString::to_string).collect()
    }
}
