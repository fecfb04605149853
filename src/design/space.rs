//! The design space: a design file, checked.

mod file;

use super::catalogue::Tube;
use super::figure::{Figure, Goal};
use super::limits::{Impossible, Limit};
use super::values::{USUAL_SPEED, duration};
use crate::error::{Error, Place};
use crate::rod::sleeve::Misfit;
use crate::rod::{BendFlexibility, Joint, LumpedMass, Rod, Sleeve, Warning};

/// Most combinations of one search.
pub const MOST_RODS: u64 = 2_000_000_000;
/// Times as long a rod takes whose frequency is asked for.
const WITH_FREQUENCY: f64 = 30.0;

/// What may vary, what must hold, what counts.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DesignSpace {
    /// Name of the file.
    pub file: String,
    /// Texts of the file and of its catalogue.
    pub(super) content: String,
    /// Where the key with the most values stands.
    pub(super) longest: Place,
    /// Values of L1, m.
    pub l1: Vec<f64>,
    /// Values of L2, m.
    pub l2: Vec<f64>,
    /// Values of γ, rad.
    pub gamma: Vec<f64>,
    /// Values of the bend radius, m.
    pub bend_radius: Vec<f64>,
    /// Values of the mass at the tip, kg.
    pub tip_mass: Vec<f64>,
    /// Ends of L1, L2, γ, bend radius and tip mass, SI, where they were given as ranges, between
    /// which other values make sense too; the steps of the grid may end before.
    pub ranges: [Option<[f64; 2]>; 5],
    /// How much more flexible bends are than beams.
    pub bend_flexibility: BendFlexibility,
    /// Tubes to choose from.
    pub tubes: Vec<Tube>,
    /// Both pipes from one tube.
    pub is_one_tube: bool,
    /// Masses on every rod.
    pub masses: Vec<LumpedMass>,
    /// Joints of every rod.
    pub joints: Vec<Joint>,
    /// Sleeves on every rod.
    pub sleeves: Vec<Sleeve>,
    /// What a rod may have or not: each selection of them is a combination.
    pub optional_sleeves: Vec<Sleeve>,
    /// What must hold.
    pub limits: Vec<Limit>,
    /// What counts.
    pub goals: Vec<Goal>,
    /// What the reader of the file wants its user to know.
    pub warnings: Vec<Warning>,
}

/// One combination.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Choice {
    /// Of the optional sleeves, bit k for the k-th.
    pub sleeves: u32,
    pub tubes: [usize; 2],
    pub gamma: f64,
    pub bend_radius: f64,
    pub tip_mass: f64,
    pub l1: f64,
    pub l2: f64,
}

impl DesignSpace {
    /// Number of combinations.
    pub fn combinations(&self) -> u64 {
        let tubes = self.tubes.len() as u128;
        let others = [&self.gamma, &self.bend_radius, &self.tip_mass, &self.l1, &self.l2];
        let all = others.iter().map(|values| values.len() as u128).product::<u128>()
            * if self.is_one_tube { tubes } else { tubes * tubes }
            * self.selections() as u128;
        u64::try_from(all).unwrap_or(u64::MAX)
    }

    /// Selections of the optional sleeves; the reader takes few enough of them.
    fn selections(&self) -> usize {
        1 << self.optional_sleeves.len()
    }

    /// The error of more rods than a search takes: how many, how long they would take, and where
    /// the longest range stands.
    pub fn too_much(&self) -> Option<Error> {
        let all = self.combinations();
        if all <= MOST_RODS {
            return None;
        }
        let is_frequency_asked = self.goals.iter().any(|goal| goal.figure == Figure::FirstFrequency);
        let each = if is_frequency_asked { WITH_FREQUENCY } else { 1.0 } / USUAL_SPEED;
        let counts = [
            ("l1_mm", self.l1.len()),
            ("l2_mm", self.l2.len()),
            ("gamma_deg", self.gamma.len()),
            ("bend_radius_mm", self.bend_radius.len()),
            ("mass_g", self.tip_mass.len()),
            ("tubes", if self.is_one_tube { self.tubes.len() } else { self.tubes.len().pow(2) }),
            ("selections of sleeves", self.selections()),
        ];
        let counts = counts.iter().filter(|(_, count)| *count > 1);
        let counts: Vec<String> = counts.map(|(key, count)| format!("{count} {key}")).collect();
        Some(Error::Input {
            at: self.longest.clone(),
            found: format!(
                "{} are {all} rods, {} of computing",
                counts.join(" × "),
                duration(all as f64 * each)
            ),
            expected: format!("at most {MOST_RODS}"),
            hint: Some("take larger steps, or --samples N".into()),
        })
    }

    /// The combination of a number below [`DesignSpace::combinations`].
    pub(super) fn choice(&self, index: u64) -> Choice {
        let mut rest = index;
        let mut next = |count: usize| {
            let digit = rest % count as u64;
            rest /= count as u64;
            digit as usize
        };
        let l2 = self.l2[next(self.l2.len())];
        let l1 = self.l1[next(self.l1.len())];
        let tip_mass = self.tip_mass[next(self.tip_mass.len())];
        let bend_radius = self.bend_radius[next(self.bend_radius.len())];
        let gamma = self.gamma[next(self.gamma.len())];
        let second = next(self.tubes.len());
        let first = if self.is_one_tube { second } else { next(self.tubes.len()) };
        let sleeves = next(self.selections()) as u32;
        Choice { sleeves, tubes: [first, second], gamma, bend_radius, tip_mass, l1, l2 }
    }

    /// The rod of a combination, or why it is none.
    ///
    /// # Errors
    /// Why it is none.
    pub fn rod(&self, index: u64) -> std::result::Result<Rod, Impossible> {
        let choice = self.choice(index);
        let [first, second] = choice.tubes.map(|tube| self.tubes[tube].pipe.clone());
        let mut rod = Rod::new(format!("design {index}"), choice.l1, choice.l2, first).with_pipe2(second);
        self.furnish(&mut rod, &choice);
        self.shape(&choice, &mut rod);
        self.possible(&rod)?;
        Ok(rod)
    }

    /// Names of a combination's tubes, one where they are the same.
    pub fn tubes_of(&self, index: u64) -> Vec<String> {
        let [first, second] = self.choice(index).tubes;
        let name = |tube: usize| self.tubes[tube].name.clone();
        if first == second { vec![name(first)] } else { vec![name(first), name(second)] }
    }

    /// Puts on `rod` what sits on every one, and the optional sleeves of a choice.
    pub(super) fn furnish(&self, rod: &mut Rod, choice: &Choice) {
        rod.masses.clone_from(&self.masses);
        rod.joints.clone_from(&self.joints);
        rod.sleeves.clone_from(&self.sleeves);
        let optional = self.optional_sleeves.iter().enumerate();
        let chosen = optional.filter(|(k, _)| choice.sleeves >> k & 1 == 1);
        rod.sleeves.extend(chosen.map(|(_, sleeve)| sleeve.clone()));
    }

    /// Gives `rod` the shape of a choice; its tubes, and what sits on it, stay.
    pub(super) fn shape(&self, choice: &Choice, rod: &mut Rod) {
        rod.l1 = choice.l1;
        rod.l2 = choice.l2;
        rod.gamma = choice.gamma;
        rod.bend_radius = choice.bend_radius;
        rod.bend_flexibility = self.bend_flexibility;
        rod.tip_mass = choice.tip_mass;
    }

    pub(super) fn possible(&self, rod: &Rod) -> std::result::Result<(), Impossible> {
        if rod.bend_radius > 0.0 && rod.tangent_length() > rod.l1.min(rod.l2) {
            return Err(Impossible::BendDoesNotFit);
        }
        if rod.bend_radius > 0.0 && rod.turn() > 0.0 && rod.bend_radius < rod.bend.section.height() / 2.0 {
            return Err(Impossible::BendTighterThanTube);
        }
        if rod.bend_radius == 0.0 && !has_room_for_corner(rod) {
            return Err(Impossible::CornerDoesNotFit);
        }
        let mut stations =
            self.masses.iter().map(|mass| mass.station).chain(self.joints.iter().map(|joint| joint.station));
        let length = if self.masses.len() + self.joints.len() > 0 { rod.length() } else { 0.0 };
        match stations.any(|station| station > length) {
            true => Err(Impossible::StationBeyondTip),
            false => match rod.misfit() {
                None => Ok(()),
                Some(Misfit::Stretch) => Err(Impossible::SleeveNotOnOnePipe),
                Some(Misfit::Wall) => Err(Impossible::SleeveInTheWay),
                Some(Misfit::Loose) => Err(Impossible::SleeveLoose),
            },
        }
    }

    /// Price of the pipes of a combination: each to the corner, along its centreline.
    pub(super) fn price(&self, choice: &Choice) -> f64 {
        let [first, second] = choice.tubes.map(|tube| self.tubes[tube].price_per_m.unwrap_or(f64::NAN));
        first * choice.l1 + second * choice.l2
    }
}

/// Whether a sharp corner leaves something of both pipes: along its inner side it takes ½D·cot(½γ)
/// of each, as a bend of radius ½D would, D of the thicker pipe.
fn has_room_for_corner(rod: &Rod) -> bool {
    let half = 0.5 * rod.pipe1.section.height().max(rod.pipe2.section.height());
    half <= rod.l1.min(rod.l2) * (0.5 * rod.gamma).tan()
}
