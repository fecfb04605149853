//! The reader of campaign files: the keys, and the files that they name.

mod keys;

use std::path::Path;

use nalgebra::Vector3;
use toml::Spanned;

use self::keys::{REQUIRED, RawAccuracy, RawBase, RawCampaign, RawClamp, Recorded, above_the_sections};
use super::constraints::parameter_constraints;
use super::layout::{Clamp, Role, Seen, Sockets};
use super::{AccuracyLimits, Campaign, Refit, Warning, checks, recording};
use crate::error::{Error, Result};
use crate::files;
use crate::limits;
use crate::rig::readings::Readings;
use crate::robot::{Robot, is_urdf};
use crate::rod::Rod;
use crate::spatial::Pose;
use crate::toml_text::{Number, TomlText};
use crate::units::{DEG, MM, UM};

/// Bytes of the name of a file, at most.
const LONGEST_NAME: usize = 1000;
/// Of the known distance between two sockets, unless the file states it, m: what a milled plate
/// keeps easily.
const DISTANCE_SD: f64 = 0.1 * MM;

/// What `robot` begins with where it names a robot that the program carries.
const BUILTIN: &str = "builtin:";

impl Campaign {
    /// Reads and checks a campaign file and all files that it names; their paths are relative to
    /// its directory.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
    /// assert_eq!((campaign.measurements.len(), campaign.measurements.groups.len()), (60, 5));
    /// assert_eq!(default_mode(&campaign), Mode::Meas); // it has readings of its rod
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`] where it cannot be read; [`Error::Syntax`] or [`Error::Input`] with line and
    /// column of whichever file is wrong otherwise.
    pub fn read(path: &Path) -> Result<Campaign> {
        let directory = path.parent().unwrap_or(Path::new(""));
        let open = |name: &str| files::read_text(&directory.join(name));
        Campaign::from_texts(&path.display().to_string(), &files::read_text(path)?, &open)
    }

    /// Reads and checks the text of a campaign file; `file` names it in errors, and `open` gives
    /// the text of a file by the name that the campaign has for it.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let text = "robot = 'builtin:tx90'\nmeasurements = 'tracker.csv'\n[noise]\nposition_um = 20\n";
    /// let rows = "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,x_mm,y_mm,z_mm\n\
    ///             home,0,0,90,0,0,0,900,-50,350\n";
    /// let campaign = Campaign::from_texts("campaign.toml", text, &|_name| Ok(rows.to_owned()))?;
    /// assert!(campaign.noise.is_some_and(|sd| (sd - 20e-6).abs() < 1e-18));
    /// assert_eq!(campaign.measurements.joints(0)[2], 90f64.to_radians());
    /// let Targets::Points(points) = &campaign.measurements.targets else { unreachable!() };
    /// assert!((points[0].x - 0.9).abs() < 1e-15);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Campaign::read`].
    pub fn from_texts(file: &str, text: &str, open: &dyn Fn(&str) -> Result<String>) -> Result<Campaign> {
        let toml = TomlText::new(file, text);
        let raw: RawCampaign = toml.parse(REQUIRED).map_err(above_the_sections)?;
        let _: Recorded = toml.parse(REQUIRED)?;
        Reader { file, toml, open, warnings: Vec::new(), is_plan: false }.campaign(&raw)
    }

    /// Reads a campaign that may not have been recorded yet: `measurements` and `validation` may be
    /// missing, or name files that do not exist. What is not there is empty.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let plan = Campaign::read_plan("campaigns/tx90-5/campaign.toml".as_ref())?;
    /// assert_eq!((plan.clamps.len(), plan.measurements.len()), (5, 60)); // it was recorded meanwhile
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Campaign::read`].
    pub fn read_plan(path: &Path) -> Result<Campaign> {
        let directory = path.parent().unwrap_or(Path::new(""));
        let open = |name: &str| files::read_text(&directory.join(name));
        Campaign::plan_from_texts(&path.display().to_string(), &files::read_text(path)?, &open)
    }

    /// Reads the text of a campaign that may not have been recorded yet, as
    /// [`Campaign::from_texts`] reads that of one that was.
    ///
    /// # Errors
    /// As [`Campaign::read`].
    pub fn plan_from_texts(
        file: &str,
        text: &str,
        open: &dyn Fn(&str) -> Result<String>,
    ) -> Result<Campaign> {
        let toml = TomlText::new(file, text);
        let raw: RawCampaign = toml.parse(REQUIRED).map_err(above_the_sections)?;
        Reader { file, toml, open, warnings: Vec::new(), is_plan: true }.campaign(&raw)
    }
}

struct Reader<'a> {
    file: &'a str,
    toml: TomlText<'a>,
    open: &'a dyn Fn(&str) -> Result<String>,
    warnings: Vec<Warning>,
    /// Whether recordings may be missing.
    is_plan: bool,
}

/// A file that the campaign names, as the user would name it.
struct Named {
    file: String,
    text: String,
}

impl Reader<'_> {
    fn campaign(mut self, raw: &RawCampaign) -> Result<Campaign> {
        // all that the campaign's own text can be blamed for comes before the files that it names
        let contact_force = self.optional(raw.contact_force_n.as_ref(), "contact_force_n", FORCE)?;
        let tool = self.optional(raw.tool.as_ref().map(|tool| &tool.xyz_mm), "tool.xyz_mm", POSITION)?;
        let base = self.base(raw.base.as_ref())?;
        let clamps = self.clamps(&raw.clamp)?;
        let sockets = self.sockets(raw)?;
        let refit = self.refit(raw)?;
        let stated = |key: &str, number: Option<&Number>| {
            number.map(|number| Ok(self.toml.positive(key, number)? * UM)).transpose()
        };
        let of_noise = raw.noise.as_ref();
        let noise = stated("noise.position_um", of_noise.and_then(|noise| noise.position_um.as_ref()))?;
        let clamp_uncertainty = stated("noise.clamp_um", of_noise.and_then(|noise| noise.clamp_um.as_ref()))?;
        let limits = |limits: &RawAccuracy| -> Result<AccuracyLimits> {
            let mean = stated("accuracy.mean_um", limits.mean_um.as_ref())?;
            Ok(AccuracyLimits { mean, max: stated("accuracy.max_um", limits.max_um.as_ref())? })
        };
        let accuracy = raw.accuracy.as_ref().map(limits).transpose()?;
        let accuracy = accuracy.filter(|limits| limits.mean.is_some() || limits.max.is_some());
        if let (Some(rig), None) = (&raw.rig, &raw.rod) {
            let expected = "a rod (`rod = \"FILE\"`) whose readings these are";
            return Err(self.toml.is("rig", rig, expected));
        }

        let (robot, robot_file) = self.robot(raw)?;
        let constraints = parameter_constraints(self.toml, &raw.parameters, &raw.prior, robot.joints.len())?;
        let rod = match &raw.rod {
            Some(name) => Some(self.rod(name)?),
            None => None,
        };
        let readings = match &raw.rig {
            Some(name) => Some(self.named("rig", name).and_then(|n| Readings::from_text(&n.file, &n.text))?),
            None => None,
        };

        let seen = match sockets {
            Some(sockets) => Seen::Sockets(sockets),
            None if clamps.is_empty() => Seen::World,
            None => Seen::Clamps(&clamps),
        };
        let measurements = match &raw.measurements {
            Some(name) => self.recording("measurements", name, &robot, seen, Role::Measurements)?,
            None => None,
        };
        let nothing = || super::Recording {
            targets: match sockets {
                Some(_) => super::Targets::Sockets(Vec::new()),
                None => super::Targets::Points(Vec::new()),
            },
            ..super::Recording::new(robot.joints.len())
        };
        let measurements = measurements.unwrap_or_else(nothing);
        let validation = match &raw.validation {
            Some(name) => {
                let seen = if sockets.is_some() { seen } else { Seen::World };
                self.recording("validation", name, &robot, seen, Role::Validation)?
            }
            None => None,
        };

        let mut campaign = Campaign {
            file: self.file.to_owned(),
            robot,
            robot_file: raw.robot.get_ref().clone(),
            robot_text: robot_file.text,
            effects_file: raw.effects.as_ref().map(|name| name.get_ref().clone()),
            rod_file: raw.rod.as_ref().map(|name| name.get_ref().clone()),
            base_link: raw.base_link.clone(),
            tip_link: raw.tip_link.clone(),
            tool_is_given: tool.is_some(),
            tool: tool.or(rod.as_ref().map(Rod::tip)).unwrap_or_default(),
            rod,
            readings,
            contact_force,
            base: base.unwrap_or_default(),
            base_is_given: raw.base.is_some(),
            clamps: clamps.iter().map(Clamp::group).collect(),
            measurements,
            validation,
            refit,
            noise,
            clamp_uncertainty,
            accuracy,
            constraints,
            warnings: Vec::new(),
        };
        campaign.take_up_moves();
        let guess = Pose::from_xyz_rpy(
            [campaign.base[0], campaign.base[1], campaign.base[2]],
            [campaign.base[3], campaign.base[4], campaign.base[5]],
        );
        let recordings = std::iter::once(&mut campaign.measurements).chain(&mut campaign.validation);
        for recording in recordings.filter(|recording| !recording.is_empty()) {
            recording.align_stations(&campaign.robot, guess, campaign.tool)?;
        }
        if !campaign.measurements.is_empty() {
            self.warnings.extend(checks::about(&campaign, &clamps));
        }
        campaign.warnings = self.warnings;
        Ok(campaign)
    }

    /// A rod, and what its file's reader warns of.
    fn rod(&mut self, name: &Spanned<String>) -> Result<Rod> {
        let Named { file, text } = self.named("rod", name)?;
        let rod = Rod::from_toml(&file, &text)?;
        let of_rod =
            |warning: &crate::rod::Warning| Warning::Rod { file: file.clone(), warning: warning.clone() };
        self.warnings.extend(rod.warnings.iter().map(of_rod));
        Ok(rod)
    }

    /// The file that `name`, the value of `key`, stands for.
    fn named(&self, key: &str, name: &Spanned<String>) -> Result<Named> {
        // every error of that file repeats it
        if name.get_ref().len() > LONGEST_NAME {
            let found = format!("`{key}` has {} bytes", name.get_ref().len());
            return Err(self.toml.wrong(name, found, "the name of a file, of at most 1000 bytes"));
        }
        let directory = Path::new(self.file).parent().unwrap_or(Path::new(""));
        let file = directory.join(name.get_ref()).display().to_string();
        let text = (self.open)(name.get_ref()).map_err(|error| match error {
            // where it is named is what has to be changed, most likely
            Error::File { source, .. } => {
                let found = format!("`{key}` is {}: {source}", self.toml.source(name));
                let hint = "a path is relative to the directory of the campaign file".to_owned();
                self.toml.wrong(name, found, "a file that can be read").with_hint(Some(hint))
            }
            error => error,
        })?;
        Ok(Named { file, text })
    }

    fn robot(&mut self, raw: &RawCampaign) -> Result<(Robot, Named)> {
        let named = match raw.robot.get_ref().strip_prefix(BUILTIN) {
            None => self.named("robot", &raw.robot)?,
            Some(name) => {
                let (file, text) = Robot::builtin(name).ok_or_else(|| {
                    self.toml.is("robot", &raw.robot, "\"builtin:tx90\", or the path of a robot's file")
                })?;
                Named { file: file.to_owned(), text: text.to_owned() }
            }
        };
        let (base_link, tip_link) = (raw.base_link.as_deref(), raw.tip_link.as_deref());
        let mut robot = Robot::from_text(&named.file, &named.text, base_link, tip_link)?;
        if let Some(effects) = &raw.effects {
            let beside = self.named("effects", effects)?;
            robot.add_beside(&beside.file, &beside.text)?;
        }
        let is_table = !is_urdf(&named.text);
        if is_table && (base_link.is_some() || tip_link.is_some()) {
            self.warnings.push(Warning::LinksWithoutUrdf);
        }
        Ok((robot, named))
    }

    fn recording(
        &mut self,
        key: &str,
        name: &Spanned<String>,
        robot: &Robot,
        seen: Seen<'_>,
        role: Role,
    ) -> Result<Option<super::Recording>> {
        if self.is_plan && is_missing((self.open)(name.get_ref())) {
            return Ok(None);
        }
        let Named { file, text } = self.named(key, name)?;
        let (recording, warnings) = recording::read(&file, &text, robot, seen, role)?;
        self.warnings.extend(warnings);
        Ok(Some(recording))
    }

    fn base(&self, raw: Option<&RawBase>) -> Result<Option<[f64; 6]>> {
        let Some(raw) = raw else { return Ok(None) };
        let xyz = self.optional(raw.xyz_mm.as_ref(), "base.xyz_mm", POSITION)?.unwrap_or_default();
        let rpy = self.optional(raw.rpy_deg.as_ref(), "base.rpy_deg", ANGLES)?.unwrap_or_default();
        Ok(Some([xyz.x, xyz.y, xyz.z, rpy.x, rpy.y, rpy.z]))
    }

    fn clamps(&self, raw: &[RawClamp]) -> Result<Vec<Clamp>> {
        limits::check(self.toml.file(), raw.len(), limits::CLAMPS, "clamps")?;
        let mut clamps: Vec<Clamp> = Vec::new();
        for clamp in raw {
            let id = clamp.id.get_ref().trim();
            if id.is_empty() {
                let expected = "the clamp's name, as in the column clamp of the measurements";
                return Err(self.toml.is("clamp.id", &clamp.id, expected));
            }
            if clamps.iter().any(|other| other.id == id) {
                let found = format!("a second clamp has the id {}", self.toml.source(&clamp.id));
                return Err(self.toml.wrong(&clamp.id, found, "an id of its own for each clamp"));
            }
            let xyz = self.three("clamp.xyz_mm", &clamp.xyz_mm, POSITION)?;
            let rpy = self.optional(clamp.rpy_deg.as_ref(), "clamp.rpy_deg", ANGLES)?.unwrap_or_default();
            clamps.push(Clamp { id: id.to_owned(), device: Pose::from_xyz_rpy(xyz.into(), rpy.into()) });
        }
        Ok(clamps)
    }

    fn sockets(&self, raw: &RawCampaign) -> Result<Option<Sockets>> {
        let Some(sockets) = &raw.sockets else { return Ok(None) };
        let distance = self.toml.positive("sockets.distance_mm", &sockets.distance_mm)? * MM;
        let sd = match &sockets.distance_sd_mm {
            Some(sd) => self.toml.positive("sockets.distance_sd_mm", sd)? * MM,
            None => DISTANCE_SD,
        };
        if let Some(clamp) = raw.clamp.first() {
            let found = "the file has [[clamp]] and [sockets]".to_owned();
            let expected = "clamps where positions were measured, or sockets where only distances are known";
            return Err(self.toml.wrong(&clamp.id, found, expected));
        }
        Ok(Some(Sockets { distance, sd }))
    }

    fn refit(&mut self, raw: &RawCampaign) -> Result<Refit> {
        let default = if raw.sockets.is_some() { Refit::Nothing } else { Refit::BaseTool };
        let Some(refit) = &raw.validation_refit else { return Ok(default) };
        match refit.get_ref().as_str() {
            "base-tool" if raw.sockets.is_some() => {
                self.warnings.push(Warning::RefitWithSockets);
                Ok(Refit::Nothing)
            }
            "base-tool" => Ok(Refit::BaseTool),
            "none" => Ok(Refit::Nothing),
            _ => Err(self.toml.is("validation_refit", refit, "\"base-tool\" or \"none\"")),
        }
    }

    fn optional(
        &self,
        list: Option<&Spanned<Vec<Number>>>,
        key: &str,
        what: Triple,
    ) -> Result<Option<Vector3<f64>>> {
        list.map(|list| self.three(key, list, what)).transpose()
    }

    fn three(&self, key: &str, list: &Spanned<Vec<Number>>, what: Triple) -> Result<Vector3<f64>> {
        let [x, y, z] = list.get_ref().as_slice() else {
            return Err(self.toml.is(key, list, what.expected));
        };
        let number = |number| Ok(self.toml.finite(key, number)? * what.unit);
        Ok(Vector3::new(number(x)?, number(y)?, number(z)?))
    }
}

/// True for a file that nobody has written yet.
fn is_missing(opened: Result<String>) -> bool {
    matches!(opened, Err(Error::File { source, .. }) if source.kind() == std::io::ErrorKind::NotFound)
}

/// Three numbers of one unit.
#[derive(Clone, Copy)]
struct Triple {
    expected: &'static str,
    unit: f64,
}

const POSITION: Triple = Triple { expected: "three numbers [x, y, z] in mm", unit: MM };
const ANGLES: Triple = Triple { expected: "three angles [roll, pitch, yaw] in degrees", unit: DEG };
const FORCE: Triple = Triple { expected: "three numbers [x, y, z] in N, the force on the ball", unit: 1.0 };
