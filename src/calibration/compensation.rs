//! Deflection of the rod at each pose (Eqs 12–14 and 19) and torques on the joints.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};

use super::campaign::{Campaign, Recording};
use super::problem::Pass;
use crate::beam::Physics;
use crate::compliance::{Compliance, DEFAULT_ELEMENTS, StaticLaws, closed_form};
use crate::error::{Error, Result};
use crate::rig;
use crate::robot::{Body, Kinematics, Loads, Robot, Setup};
use crate::rod::{Rod, RodLaw};
use crate::spatial::times;
use crate::statistics::Random;
use crate::units::{STANDARD_GRAVITY, significant};

/// Times that torques and the joints that they turn are computed from each other; each time their
/// error falls by the share by which a joint deflects, below 10⁻³.
pub const TORQUE_ROUNDS: usize = 3;

/// How the rod's deflection is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Mode {
    /// It is assumed rigid.
    None,
    /// The paper's closed form.
    Calc,
    /// The beam finite-element model.
    Fea,
    /// Measured on a rig.
    Meas,
}

impl Mode {
    /// All, in the paper's order.
    pub const ALL: [Mode; 4] = [Mode::None, Mode::Calc, Mode::Fea, Mode::Meas];

    /// `none`, `calc`, `fea`, `meas`.
    pub fn name(self) -> &'static str {
        match self {
            Mode::None => "none",
            Mode::Calc => "calc",
            Mode::Fea => "fea",
            Mode::Meas => "meas",
        }
    }
}

/// The loads that a campaign knows, and the rod's compliance in one mode.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Compensation {
    /// The mode.
    pub mode: Mode,
    /// C^F and C^g of the rod; `None` for a rigid one.
    pub compliance: Option<Compliance>,
    /// What the laws of the rod's file add; `None` where there are none, and in Calc mode.
    pub laws: Option<StaticLaws>,
    /// The rod as a body on the flange.
    pub payload: Option<Body>,
    /// Force on the ball in the device frame, N.
    pub contact_force: Vector3<f64>,
    /// Other known displacements of the tip at each row, in {W}, m; empty where
    /// nothing is.
    pub displaced: Vec<Vector3<f64>>,
    /// What else hangs on the flange, under which the rod does not bend.
    pub(crate) carried: Vec<Carried>,
}

/// A load on the flange at some rows of a recording.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Carried {
    /// Where it hangs, from 0.
    pub rows: Range<usize>,
    /// Mass, kg.
    pub mass: f64,
    /// First moment about the flange's origin, mass times centre, in {T}, kg·m.
    pub moment: Vector3<f64>,
}

/// A body without mass has no centre: so light is one that has a first moment all the same, kg.
const LIGHTEST: f64 = 1e-6;

/// A body with so much more mass (kg) and first moment (kg·m).
fn heavier(body: Option<Body>, mass: f64, moment: &Vector3<f64>) -> Body {
    let known = body.unwrap_or(Body { mass: 0.0, centre: Vector3::zeros() });
    let sum = known.mass + mass;
    let all = if sum.abs() < LIGHTEST { LIGHTEST } else { sum };
    Body { mass: all, centre: (known.centre * known.mass + moment) / all }
}

impl Compensation {
    /// The same with another contact force on the ball.
    pub fn with_contact_force_times(&self, factor: f64) -> Self {
        Compensation { contact_force: self.contact_force * factor, ..self.clone() }
    }

    /// The same with so much more at `tip` (in {T}, m), kg; less where it is negative.
    ///
    /// ```text
    /// C^g + m·g·C^F
    /// ```
    pub(crate) fn with_tip_heavier_by(&self, mass: f64, tip: &Vector3<f64>) -> Self {
        let more = |compliance: &Compliance| Compliance {
            gravity: compliance.gravity + compliance.force * (mass * STANDARD_GRAVITY),
            ..*compliance
        };
        Compensation {
            compliance: self.compliance.as_ref().map(more),
            ..self.with_payload_heavier_by(mass, tip)
        }
    }

    /// The same with so much more at a point of the flange or of what is on it (in {T}, m), kg,
    /// under which the rod does not bend.
    pub(crate) fn with_payload_heavier_by(&self, mass: f64, point: &Vector3<f64>) -> Self {
        let body = heavier(self.payload, mass, &(point * mass));
        Compensation { payload: Some(body).filter(|body| body.mass > LIGHTEST), ..self.clone() }
    }

    /// What hangs on the flange at a row.
    fn payload_at(&self, row: usize) -> Option<Body> {
        let there = self.carried.iter().filter(|carried| carried.rows.contains(&row));
        there.fold(self.payload, |body, carried| Some(heavier(body, carried.mass, &carried.moment)))
    }

    /// The same where all of a rod but what is at its tip is heavier by so many times its mass;
    /// lighter where that is negative.
    ///
    /// ```text
    /// C^g + x·(C^g − m_tip·g·C^F)
    /// ```
    pub(crate) fn with_rod_heavier_by(&self, share: f64, rod: &Rod) -> Self {
        let body = without_tip(rod);
        let more = |compliance: &Compliance| Compliance {
            gravity: compliance.gravity + by_own_weight(compliance, rod) * share,
            ..*compliance
        };
        Compensation {
            compliance: self.compliance.as_ref().map(more),
            ..self.with_payload_heavier_by(share * body.mass, &body.centre)
        }
    }

    /// Of a campaign in a mode.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
    /// let fea = Compensation::new(&campaign, Mode::Fea)?.compliance.expect("there is a rod");
    /// let meas = Compensation::new(&campaign, Mode::Meas)?.compliance.expect("there are readings");
    /// // its true rod is 1.013 times as compliant as its model
    /// assert!((meas.gravity[(2, 2)] / fea.gravity[(2, 2)] - 1.013).abs() < 0.01);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NotApplicable`] where the campaign lacks the files that the mode needs; what the
    /// beam model and the rig fit refuse.
    pub fn new(campaign: &Campaign, mode: Mode) -> Result<Self> {
        let lacks = |what: &str, key: &str| Error::NotApplicable {
            what: format!("mode {} for {}", mode.name(), campaign.file),
            why: format!("the campaign names no {what}"),
            hint: format!("add `{key} = \"…\"` to the campaign, or choose another mode"),
        };
        let rod = || campaign.rod.as_ref().ok_or_else(|| lacks("rod", "rod"));
        let compliance = match mode {
            Mode::None => None,
            Mode::Calc => Some(closed_form::compliance(rod()?)?),
            Mode::Fea => Some(Compliance::of_model(rod()?, &Physics::default(), DEFAULT_ELEMENTS)?),
            Mode::Meas => {
                let rod = rod()?;
                let readings = campaign.readings.as_ref().ok_or_else(|| lacks("rig readings", "rig"))?;
                let fit = rig::fit(readings, Some(rod), &rig::Options::default())?;
                fit.measured.map(|measured| measured.compliance)
            }
        };
        let is_whole = matches!(mode, Mode::Fea | Mode::Meas);
        let laws = campaign.rod.as_ref().filter(|_| is_whole).map(StaticLaws::of_tip);
        Ok(Compensation {
            mode,
            compliance,
            laws: laws.filter(|laws| !laws.is_empty()),
            payload: campaign.rod.as_ref().map(|rod| Body { mass: rod.mass(), centre: rod.centre_of_mass() }),
            contact_force: campaign.contact_force.unwrap_or_default(),
            displaced: Vec::new(),
            carried: Vec::new(),
        })
    }

    /// For poses measured with a short rigid rod and without contact: nothing bends, only the links
    /// weigh.
    pub fn bare() -> Self {
        Compensation {
            mode: Mode::None,
            compliance: None,
            laws: None,
            payload: None,
            contact_force: Vector3::zeros(),
            displaced: Vec::new(),
            carried: Vec::new(),
        }
    }

    /// What deflects the tip at each row of a recording, in {W}, m.
    pub fn deflections(&self, setup: &Setup, recording: &Recording) -> Vec<Vector3<f64>> {
        self.tips(setup, recording).into_iter().map(|(_, deflection)| deflection).collect()
    }

    /// Where the tip is at each row of a recording, and what has deflected it from where the joints
    /// bring it under their loads, in {W}, m.
    pub(crate) fn tips(&self, setup: &Setup, recording: &Recording) -> Vec<(Vector3<f64>, Vector3<f64>)> {
        let mut pass = Pass::at_rest(recording);
        for _ in 0..TORQUE_ROUNDS {
            self.update(setup, recording, &mut pass);
        }
        let mut kinematics = Kinematics::new(setup);
        let in_world = |row: usize| {
            kinematics.update(recording.joints(row), pass.torque(recording, row));
            let deflection = kinematics.flange.rotation * pass.deflection[row];
            (kinematics.tip + deflection, deflection)
        };
        (0..recording.len()).map(in_world).collect()
    }

    /// What the laws of the rod's file add at most (m) over a recording, and those that are beyond
    /// what they were recorded with, in words; `None` without laws.
    pub fn use_of_laws(&self, setup: &Setup, recording: &Recording) -> Option<(f64, Vec<String>)> {
        let (laws, compliance) = (self.laws.as_ref()?, self.compliance.as_ref()?);
        let mut kinematics = Kinematics::new(setup);
        let gravity = setup.base().rotation * setup.robot.gravity / STANDARD_GRAVITY;
        let mut most = 0.0f64;
        let mut beyond: Vec<(&RodLaw, f64)> = Vec::new();
        for row in 0..recording.len() {
            kinematics.update(recording.joints(row), &[]);
            let r = &kinematics.flange.rotation;
            let force = r.tr_mul(&times(&recording.device(row).rotation, &self.contact_force));
            let gravity = r.tr_mul(&gravity);
            most = most.max(laws.displacement(&compliance.force, &force, &gravity).norm());
            for (law, x) in laws.beyond(&compliance.force, &force, &gravity) {
                let x = x.abs();
                match beyond.iter_mut().find(|(known, _)| *known == law) {
                    Some((_, largest)) => *largest = largest.max(x),
                    None => beyond.push((law, x)),
                }
            }
        }
        let farthest = |(law, x): (&RodLaw, f64)| format!("{}, at {}", law, significant(x, 3));
        Some((most, beyond.into_iter().map(farthest).collect()))
    }

    /// Fills in deflection (of rod, links and base) and torque of every row for the present
    /// `setup`; gives the largest change of a deflection, m.
    pub(super) fn update(&self, setup: &Setup, recording: &Recording, pass: &mut Pass) -> f64 {
        let robot = setup.robot;
        let n = recording.joint_count;
        let mut kinematics = Kinematics::new(setup);
        let gravity = setup.base().rotation * robot.gravity;
        let mut change = 0.0f64;
        for row in 0..recording.len() {
            let torque = &mut pass.torque[row * n..][..n];
            kinematics.update(recording.joints(row), torque);
            let tip_force = times(&recording.device(row).rotation, &self.contact_force);
            let loads = Loads { gravity, payload: self.payload_at(row), tip_force };
            kinematics.torques(&loads, torque);
            let displaced = self.displaced.get(row).copied().unwrap_or_default();
            let structure = kinematics.structural_deflection(&loads);
            let deflection = self.deflection(&kinematics, &gravity, &tip_force)
                + kinematics.flange.rotation.tr_mul(&(displaced + structure));
            change = change.max((deflection - pass.deflection[row]).norm());
            pass.deflection[row] = deflection;
        }
        change
    }

    /// C^g·g_T + C^F·F_T and what laws add to it, m in {T}, under gravity (m/s²) and a force on the
    /// tip (N), both in {W}.
    fn deflection(
        &self,
        kinematics: &Kinematics,
        gravity: &Vector3<f64>,
        force: &Vector3<f64>,
    ) -> Vector3<f64> {
        let Some(compliance) = &self.compliance else { return Vector3::zeros() };
        let r = &kinematics.flange.rotation;
        // g_T = Rᵀ·g, F_T = Rᵀ·F (Eqs 12–14); C^g is per g (Eq 19)
        let gravity = r.tr_mul(gravity) / STANDARD_GRAVITY;
        let force = r.tr_mul(force);
        let linear = times(&compliance.gravity, &gravity) + times(&compliance.force, &force);
        match &self.laws {
            Some(laws) => linear + laws.displacement(&compliance.force, &force, &gravity),
            None => linear,
        }
    }
}

/// What a rod is as a body on the flange, without what is at its tip.
pub(crate) fn without_tip(rod: &Rod) -> Body {
    let bare = Rod { tip_mass: 0.0, ..rod.clone() };
    Body { mass: bare.mass(), centre: bare.centre_of_mass() }
}

/// What of C^g is the weight of the rod itself, not of what is at its tip, m per g:
/// C^g − m_tip·g·C^F.
pub(crate) fn by_own_weight(compliance: &Compliance, rod: &Rod) -> Matrix3<f64> {
    compliance.gravity - compliance.force * (rod.tip_mass * STANDARD_GRAVITY)
}

/// Largest torque that links and payload put on each joint over the workspace, N·m; at least 1e-9.
pub(super) fn largest_torques(robot: &Robot, setup: &Setup, payload: Body) -> Vec<f64> {
    let mut random = Random::seeded(0, 0);
    let mut kinematics = Kinematics::new(setup);
    let gravity = setup.base().rotation * robot.gravity;
    let loads = Loads { gravity, payload: Some(payload), tip_force: Vector3::zeros() };
    let (mut torque, mut largest) = (vec![0.0; robot.joints.len()], vec![1e-9f64; robot.joints.len()]);
    for _ in 0..200 {
        let q: Vec<f64> = robot.joints.iter().map(|_| random.uniform(-3.0, 3.0)).collect();
        kinematics.update(&q, &[]);
        kinematics.torques(&loads, &mut torque);
        for (largest, torque) in largest.iter_mut().zip(&torque) {
            *largest = largest.max(torque.abs());
        }
    }
    largest
}

/// The modes that a campaign's files allow, in the paper's order; Calc only where the closed form
/// applies to the rod.
///
/// ```
/// use rodcal::calibration::modes;
/// use rodcal::prelude::*;
///
/// let mut campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// assert_eq!(modes(&campaign), Mode::ALL);
/// campaign.readings = None;
/// assert_eq!(modes(&campaign), [Mode::None, Mode::Calc, Mode::Fea]);
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn modes(campaign: &Campaign) -> Vec<Mode> {
    Mode::ALL.into_iter().filter(|&mode| Compensation::new(campaign, mode).is_ok()).collect()
}

/// The mode without `--mode`: meas with rig readings, else fea with a rod, else none.
///
/// ```
/// use rodcal::prelude::*;
///
/// let mut campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// assert_eq!(default_mode(&campaign), Mode::Meas);
/// campaign.readings = None;
/// assert_eq!(default_mode(&campaign), Mode::Fea);
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn default_mode(campaign: &Campaign) -> Mode {
    match (&campaign.rod, &campaign.readings) {
        (Some(_), Some(_)) => Mode::Meas,
        (Some(_), None) => Mode::Fea,
        _ => Mode::None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::simulate::{Plan, campaign_files, simulate};
    use crate::calibration::{Options, calibrate};
    use crate::rod::Rod;
    use crate::units::UM;

    /// A root that gives way until it comes to a stop, at the robot under weight and contact force:
    /// with the law nothing is left, and a warning says what it does.
    #[test]
    fn a_law_of_the_root_bends_the_rod_at_the_robot() {
        const LAW: &str = "\n[[law]]\nplace = \"root\"\nvariable = \"moment\"\nrange = [0.0, 8.0]\n\
            formula = \"a*min(M/1.5, 1)\"\n[[law.constant]]\nname = \"a\"\nvalue = 400.0\n";
        let plain = include_str!("../../rods/5.toml");
        let text = plain.to_owned() + LAW;
        let robot =
            Robot::from_text("tx90.toml", include_str!("../../robots/tx90.toml"), None, None).unwrap();
        let rod = Rod::from_toml("rod", &text).unwrap();
        let model = Compliance::of_model(&rod, &Physics::default(), DEFAULT_ELEMENTS).unwrap();
        let plan = Plan { poses_per_clamp: 8, sensor_noise: 0.0, repeatability: 0.0, ..Plan::default() };
        let simulation = simulate(&robot, &rod, &model, &plan).unwrap();
        let files = campaign_files(&simulation, "builtin:tx90", "rod.toml");
        let rms = |rod: &str| {
            let find = |wanted: &str| match wanted {
                "rod.toml" => rod.to_owned(),
                _ => files.iter().find(|(name, _)| name == wanted).unwrap().1.clone(),
            };
            let campaign =
                Campaign::from_texts("campaign.toml", &find("campaign.toml"), &|name| Ok(find(name)))
                    .unwrap();
            let calibration = calibrate(&campaign, Mode::Fea, &Options::default()).unwrap();
            let is_warned =
                calibration.warnings.iter().any(|warning| warning.to_string().contains("laws of the rod"));
            (calibration.rms() / UM, is_warned)
        };
        let ((with, is_warned), (without, _)) = (rms(&text), rms(plain));
        assert!(with < 0.5 && without > 5.0 && is_warned, "{with} {without} µm");
    }
}
