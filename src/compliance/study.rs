//! Both modes of a rod side by side, with what lies between them and how the rod bends.

use nalgebra::{Matrix3, Vector3};

use super::laws::StaticLaws;
use super::sensitivity::{Sensitivity, sensitivities};
use super::steps::{Step, steps};
use super::strength::{Overload, overload};
use super::{Compliance, closed_form};
use crate::beam::{Load, Motion, NaturalMode, Physics, RodModel};
use crate::error::Result;
use crate::rod::Rod;
use crate::units::STANDARD_GRAVITY;

/// How a rod's compliance is found without measuring it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// The paper's closed form, Eqs 15 and 17.
    Calc,
    /// The beam finite-element model of the rod as built.
    Fea,
}

/// All that the `compliance` command finds out about a rod.
///
/// ```
/// use rodcal::compliance::{Mode, Study};
/// use rodcal::prelude::{DEFAULT_ELEMENTS, Physics, Rod, paper_contact_force};
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let study = Study::new(rod, Mode::Fea, Physics::default(), DEFAULT_ELEMENTS, paper_contact_force())?;
/// assert!((study.index() / 403.7e-6 - 1.0).abs() < 0.015); // Table 2
/// assert!(study.calc?.index(1.97) < study.fea.index(1.97)); // what Calc leaves out is softness
/// # Ok::<(), rodcal::Error>(())
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct Study {
    /// The rod.
    pub rod: Rod,
    /// Which of the two the user asked for.
    pub mode: Mode,
    /// Physics of the FEA mode.
    pub physics: Physics,
    /// Number of elements of the FEA mode.
    pub elements: usize,
    /// Size of the contact force F in c_rod, N.
    pub contact_force: f64,
    /// Calc mode, or why it does not apply to this rod.
    pub calc: Result<Compliance>,
    /// FEA mode. With laws of the rod's file: at the contact force and 1 g.
    pub fea: Compliance,
    /// FEA mode without these laws.
    pub linear: Compliance,
    /// The laws of the rod's file that its tip follows.
    pub laws: StaticLaws,
    /// From Calc to FEA, one left-out term after another.
    pub steps: Vec<Step>,
    /// The rod undeformed and deformed.
    pub shape: Shape,
    /// How all of it follows the numbers of the rod; none where numbers are beyond double
    /// precision.
    pub sensitivities: Vec<Sensitivity>,
    /// What breaks it, or bends it for good, under one g and the contact force.
    pub overload: Option<Overload>,
    /// What one station does under a force at another, where that was asked for.
    pub stations: Option<StationResponse>,
    /// Damping ratio ζ of settling times, where it is known.
    pub damping_ratio: Option<f64>,
}

/// Displacement and rotation at one station under a force at another (FEA model), in {T}.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct StationResponse {
    /// Station of the force, m.
    pub load: f64,
    /// Station that is read, m.
    pub read: f64,
    /// m/N and rad/N; column: axis of the force.
    pub motion: Motion,
}

/// Centreline and displacements of the FEA model, for pictures, in {T}.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Shape {
    /// Points of the undeformed centreline from flange to tip, m.
    pub centreline: Vec<Vector3<f64>>,
    /// Displacement of each point per unit force at the tip, m/N; column: axis of the force.
    pub under_force: Vec<Matrix3<f64>>,
    /// Displacement of each point per g, m; column: axis of gravity.
    pub under_gravity: Vec<Matrix3<f64>>,
    /// The slowest natural modes of the whole rod, a displacement for each point; none of a rod
    /// without mass.
    pub modes: Vec<NaturalMode>,
}

impl Study {
    /// Studies `rod` with both modes; the one asked for must apply.
    ///
    /// # Errors
    /// As [`closed_form::compliance`] in Calc mode, [`Compliance::of_model`] in both.
    pub fn new(rod: Rod, mode: Mode, physics: Physics, elements: usize, contact_force: f64) -> Result<Self> {
        let calc = match (mode, closed_form::compliance(&rod)) {
            (Mode::Calc, Err(why)) => return Err(why),
            (_, calc) => calc,
        };
        let linear = Compliance::of_model(&rod, &physics, elements)?;
        let mut steps = steps(&rod, &physics, elements)?;
        let laws = StaticLaws::of_tip(&rod);
        let fea = match laws.is_empty() || contact_force <= 0.0 {
            true => linear,
            false => laws.secant(&linear, contact_force),
        };
        if fea != linear {
            steps.push(Step::of_laws(&linear, fea));
        }
        Ok(Study {
            fea,
            linear,
            laws,
            steps,
            shape: Shape::new(&rod, &physics)?,
            // numbers beyond double precision bend too far before they break
            overload: overload(&rod, contact_force).unwrap_or_default(),
            sensitivities: sensitivities(&rod, &physics, contact_force).unwrap_or_default(),
            rod,
            mode,
            physics,
            elements,
            contact_force,
            calc,
            stations: None,
            damping_ratio: None,
        })
    }

    /// Adds what station `read` does under a force at station `load` (both m, from the flange).
    ///
    /// # Errors
    /// [`crate::Error::Argument`] for a station that is not on the rod.
    pub fn with_stations(mut self, load: f64, read: f64) -> Result<Self> {
        let model = RodModel::new(&self.rod, &self.physics, self.elements, &[load, read])?;
        let motion = model.force_response(load, read)?;
        self.stations = Some(StationResponse { load, read, motion });
        Ok(self)
    }

    /// The compliance of the mode that was asked for.
    pub fn compliance(&self) -> &Compliance {
        match (&self.calc, self.mode) {
            (Ok(calc), Mode::Calc) => calc,
            _ => &self.fea,
        }
    }

    /// c_rod of the mode that was asked for, m.
    pub fn index(&self) -> f64 {
        self.compliance().index(self.contact_force)
    }

    /// What takes the tip beyond [`LINEAR_SHARE`] of the rod's length, if anything does: the larger
    /// of one g and the contact force, each along its worst axis.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let mut rod = Rod::read("rods/5.toml".as_ref())?;
    /// rod.l2 = 40.0; // m
    /// let physics = Physics::default();
    /// let study = rodcal::compliance::Study::new(
    ///     rod, rodcal::compliance::Mode::Fea, physics, DEFAULT_ELEMENTS, paper_contact_force(),
    /// )?;
    /// assert!(study.beyond_linear().is_some_and(|(_, share)| share > 0.1));
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn beyond_linear(&self) -> Option<(TipLoad, f64)> {
        let worst = |matrix: &Matrix3<f64>| matrix.column_iter().map(|c| c.norm()).fold(0.0, f64::max);
        let c = self.compliance();
        let gravity = worst(&c.gravity) / self.rod.length();
        let force = worst(&c.force) * self.contact_force / self.rod.length();
        let (load, share) =
            if gravity >= force { (TipLoad::OneG, gravity) } else { (TipLoad::ContactForce, force) };
        (share > LINEAR_SHARE).then_some((load, share))
    }
}

/// Deflection over length beyond which it is no longer taken to be proportional to its load: the
/// exact deflection of a cantilever leaves the linear one from there on (K. E. Bisshopp,
/// D. C. Drucker, *Quart. Appl. Math.* 3 (1945) 272–275).
pub const LINEAR_SHARE: f64 = 0.1;

/// What bends a rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TipLoad {
    /// Its own weight.
    OneG,
    /// The force on the ball.
    ContactForce,
}

impl Shape {
    fn new(rod: &Rod, physics: &Physics) -> Result<Self> {
        /// Enough for a smooth curve.
        const POINTS: usize = 60;
        const MODES: usize = 3;
        let model = RodModel::new(rod, physics, POINTS, &[])?;
        let chain = &model.chain;
        let response = chain.solve(&[Load::Force { node: model.tip() }, Load::SelfWeight])?;
        let nodes = 0..=chain.end();
        // numbers that are beyond double precision somewhere are no reason to say nothing of the
        // rest
        let whole = RodModel::new(rod, &Physics::WHOLE, POINTS, &[])?;
        let modes = whole.chain.natural_modes(MODES).unwrap_or_default();
        Ok(Shape {
            modes,
            centreline: nodes.clone().map(|node| chain.position(node)).collect(),
            under_force: nodes.clone().map(|node| response.motion(node, 0).translation).collect(),
            under_gravity: nodes
                .map(|node| response.motion(node, 1).translation * STANDARD_GRAVITY)
                .collect(),
        })
    }
}
