//! How effects are said to people who know robots: what was observed, with numbers, and what that is called.

use super::findings::{Mismatch, Number, size};
use super::result::CalibrationDiagnosis;
use crate::diagnosis::{Diagnosis, Quantity, Words, World};
use crate::units::UM;

/// Most outliers that are told one by one.
const TOLD: usize = 3;

/// What an effect of the library is called; `None` for a name that is not in it.
pub fn cause(effect: &str) -> Option<&'static str> {
    Some(match effect {
        "rod_stiffness" => "the rod's stiffness is not that of its model",
        "tip_mass" => "a mass that nobody told of",
        "payload_mass" => "a load that nobody told of",
        "transmission_error" => "an error of its gear or encoder",
        "backlash" => "play in its gear",
        "joint_compliance" => "its drive yields",
        "joint_nonlinear_stiffness" => "a stiffness that depends on the load",
        "encoder_scale" => "the scale of its encoder",
        "wrist_coupling" => "coupled wrist gears",
        "link_flexibility" => "a link that bends",
        "gravity_tilt" => "a base that yields to the arm's weight",
        "clamp_pose" => "a clamp that is not where the campaign says",
        "clamp_shift" => "the clamp was knocked or slipped",
        "socket_shift" => "the socket was knocked or slipped",
        "base_shift" => "the robot slipped on its base",
        "thermal_drift" => "drift, as of something that warms up",
        "contact_force_variation" => "a contact force that is not the stated one",
        "readback_lag" => "angles were read before the arm had settled",
        "outlier" => "misread or disturbed",
        _ => return None,
    })
}

/// An effect at its place where it is named without numbers, among others that it may be mistaken for.
pub fn cause_at(effect: &str, place: &str) -> String {
    match effect {
        "transmission_error" => format!("the gear or encoder of {}", joint_of(place)),
        "backlash" => format!("play in {}", joint_of(place)),
        "joint_compliance" => format!("{} yielding", joint_of(place)),
        "joint_nonlinear_stiffness" => format!("{} yielding out of proportion to its load", joint_of(place)),
        "encoder_scale" => format!("the encoder's scale in {place}"),
        "wrist_coupling" => format!("{place} coupled"),
        "link_flexibility" => format!("the link before {place} bending"),
        "gravity_tilt" => "the base tilting under the arm's weight".into(),
        "rod_stiffness" => "a rod of another stiffness".into(),
        "tip_mass" => "a mass at the tip".into(),
        "payload_mass" => "a load on the flange".into(),
        "clamp_pose" => format!("the place of {place}"),
        "clamp_shift" | "socket_shift" => format!("a shift ({place})"),
        "base_shift" => format!("a shift of the base ({place})"),
        "thermal_drift" => format!("drift ({place})"),
        "contact_force_variation" => format!("another contact force ({place})"),
        "readback_lag" => format!("angles read too early ({place})"),
        "outlier" => format!("{place} misread"),
        _ => format!("{} ({place})", effect.replace('_', " ")),
    }
}

/// `joint 3` of `joint 3, 18.5 cycles/rev`.
fn joint_of(place: &str) -> &str {
    place.split(", ").next().unwrap_or(place)
}

/// Where something remains that no effect explains, from the place of its curve.
pub fn unexplained_at(place: &str) -> String {
    match place.split_once(", ") {
        Some((name, "a curve in the world")) => format!("follows {}, along fixed directions", along(name)),
        Some((name, "a curve in the tool")) => {
            format!("follows {}, along directions that turn with the tool", along(name))
        }
        Some((joints, "a surface")) => format!("depends on {joints} together"),
        Some((joint, "a curve for either way")) => {
            format!("follows the angle of {joint}, another curve for either way of coming there")
        }
        Some((joint, "a curve for either load")) => {
            format!("follows the angle of {joint}, another curve for either way in which it is loaded")
        }
        Some(("order", again)) => format!("comes back {again}"),
        Some(("orientation", _)) => "follows how the tool is held".into(),
        Some((link, turned)) if link.starts_with("link ") => {
            let joints = turned.trim_start_matches("turned by ");
            format!("turns or bends {link} with {joints}")
        }
        _ if place == "over the workspace" => "follows the place in the workspace".into(),
        _ if place == "each clamp by itself" => "shifts whole clamps against one another".into(),
        _ => format!("is seen at {place}"),
    }
}

fn along(name: &str) -> String {
    match name {
        "order" => "the order of the poses".into(),
        name if name.starts_with("joint ") => format!("the angle of {name}"),
        name => format!("the {name}"),
    }
}

impl CalibrationDiagnosis<'_> {
    /// A mismatch in words.
    pub fn words(&self, mismatch: &Mismatch) -> Words {
        let cause = cause(&mismatch.effect).map_or_else(|| mismatch.effect.replace('_', " "), str::to_owned);
        Words { observed: self.observed(mismatch), cause }
    }

    fn observed(&self, mismatch: &Mismatch) -> String {
        let finding = &self.diagnosis.findings[mismatch.parts[0]];
        let candidate = &self.world.candidates()[finding.chosen.candidate];
        let is_curve = mismatch.effect == "transmission_error" && !candidate.location.ends_with("cycles/rev");
        let place = Place { name: &mismatch.location, detail: &finding.place, is_curve };
        match mismatch.effect.as_str() {
            "outlier" => self.outliers(mismatch),
            "clamp_pose"
            | "clamp_shift"
            | "socket_shift"
            | "base_shift"
            | "thermal_drift"
            | "contact_force_variation" => {
                let unit = candidate.parameters[0].unit;
                let (value, low, high) = size(&self.diagnosis, finding);
                let size = Quantity { value: value / unit, low: low / unit, high: high / unit };
                moved(&mismatch.effect, &place, size, &mismatch.parameters[0].name)
            }
            effect => of_joint_or_load(effect, &place, &mismatch.parameters),
        }
    }

    fn outliers(&self, mismatch: &Mismatch) -> String {
        let one = |&part: &usize| {
            let finding = &self.diagnosis.findings[part];
            format!("{} is off by {}", capital(&finding.place), sized(&self.diagnosis, finding))
        };
        let told: Vec<String> = mismatch.parts.iter().take(TOLD).map(one).collect();
        let more = match mismatch.parts.len().saturating_sub(TOLD) {
            0 => String::new(),
            more => format!(" and {more} more {} off", if more == 1 { "is" } else { "are" }),
        };
        told.join(", ").replace(", Pose", ", pose") + &more
    }
}

fn sized(diagnosis: &Diagnosis, finding: &crate::diagnosis::Finding) -> String {
    let (value, low, high) = size(diagnosis, finding);
    Quantity { value: value / UM, low: low / UM, high: high / UM }.say("µm")
}

/// Where an effect is, in full and in short.
struct Place<'a> {
    name: &'a str,
    detail: &'a str,
    is_curve: bool,
}

impl Place<'_> {
    fn named(&self) -> String {
        capital(self.name)
    }
}

/// What moved, by how much.
fn moved(effect: &str, place: &Place, size: Quantity, unit: &str) -> String {
    let (what, when) = place.name.split_once(", ").unwrap_or((place.name, ""));
    match effect {
        "clamp_pose" => format!("{} is {} from where the campaign has it", place.named(), size.say("µm")),
        "clamp_shift" | "socket_shift" => format!("{} moved by {} {when}", capital(what), size.say("µm")),
        "base_shift" => format!("The robot moved on its base by {} {}", size.say("µm"), place.name),
        "contact_force_variation" => {
            let at = if what.starts_with("all") { "In all clamps" } else { "At " };
            let at = if what.starts_with("all") { at.to_owned() } else { format!("{at}{what}") };
            format!("{at} the ball is pushed by {} more than stated", size.say("N"))
        }
        _ => {
            let unit = match unit {
                name if name.ends_with("um_per_k") => "µm per kelvin",
                name if name.ends_with("um_per_h") => "µm per hour",
                _ => "µm",
            };
            format!("The {what} drifts by {} {when}", size.say(unit))
        }
    }
}

fn of_joint_or_load(effect: &str, place: &Place, numbers: &[Number]) -> String {
    let nothing = Quantity { value: f64::NAN, low: f64::NAN, high: f64::NAN };
    let of = |index: usize| numbers.get(index).map_or(nothing, quantity);
    let first = of(0);
    let named = place.named();
    match effect {
        "transmission_error" => {
            let (cycles, amplitude) = (cycles(first.value), of(1).say("µrad"));
            match place.is_curve {
                true => format!(
                    "{named} turns by up to about {amplitude} more or less than it says, in a curve of mostly {cycles}"
                ),
                false => format!("{named} turns by up to {amplitude} more or less than it says, {cycles}"),
            }
        }
        "backlash" => {
            let by = if place.detail.ends_with("by approach") {
                "depending on the way it came from"
            } else {
                "and hangs to the side that its load pulls it to"
            };
            format!("{named} has {} of play, {by}", first.size().say("µrad"))
        }
        "joint_compliance" if numbers.len() > 1 || place.detail.ends_with("masses unknown") => {
            format!("{named} yields to the weight beyond it (the robot file has no masses)")
        }
        "joint_compliance" => {
            let word = if first.value >= 0.0 { "more" } else { "less" };
            format!("{named} yields {} {word} than modelled", first.size().say("µrad/(N·m)"))
        }
        "joint_nonlinear_stiffness" => {
            let (unit, law) = match place.detail.ends_with("cubic") {
                true => ("µrad/(N·m)³", "the third power of"),
                false => ("µrad/(N·m)²", "the square of"),
            };
            format!("{named} yields with {law} its load, {}", first.say(unit))
        }
        "encoder_scale" => {
            let excess = first.map(|factor| 1e6 * (factor - 1.0));
            let word = if excess.value >= 0.0 { "more" } else { "less" };
            format!("{named} turns {} µrad per radian {word} than its encoder says", excess.size().say(""))
        }
        "wrist_coupling" => {
            let (from, to) = place.name.trim_start_matches("joint ").split_once(" to ").unwrap_or(("", ""));
            let share = first.map(|share| 1e6 * share);
            format!("Joint {to} turns along by {} for every radian of joint {from}", share.say("µrad"))
        }
        "link_flexibility" => {
            format!("The link before {} bends by {} of moment there", place.name, first.say("µrad/(N·m)"))
        }
        "gravity_tilt" => format!("The base tilts by {} of the arm's moment", first.say("µrad/(N·m)")),
        "rod_stiffness" => {
            let under =
                place.name.split_once(", ").map_or_else(String::new, |(_, under)| format!(" {under}"));
            format!("The rod's stiffness is {} times that of its model{under}", first.say(""))
        }
        "tip_mass" => format!("{} more hang on the tip than stated", first.say("g")),
        "payload_mass" => format!("{} more hang on the flange than stated", first.say("kg")),
        "readback_lag" => {
            let of = if place.name.starts_with("joint") { place.name } else { "every joint" };
            format!(
                "When the angles were read, {} of the last move of {of} was still to come",
                first.map(|share| 100.0 * share).say("%")
            )
        }
        _ => format!("{} at {}", effect.replace('_', " "), place.name),
    }
}

fn quantity(number: &Number) -> Quantity {
    let unit = number.unit;
    Quantity { value: number.value / unit, low: number.low / unit, high: number.high / unit }
}

/// `once per revolution`, `18.5 times per revolution`.
fn cycles(cycles: f64) -> String {
    match cycles {
        1.0 => "once per revolution".into(),
        2.0 => "twice per revolution".into(),
        cycles => {
            format!("{} times per revolution", cycles_said(cycles))
        }
    }
}

/// With three digits, without zeros behind the point.
fn cycles_said(cycles: f64) -> String {
    let said = crate::units::significant(cycles, 3);
    match said.contains('.') {
        true => said.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => said,
    }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
