//! How effects are said to people who know mechanics: what was observed, with numbers, and what that is called.

#[cfg(test)]
mod tests;

use super::datum::Datum;
use super::{Body, RigWorld};
use crate::diagnosis::{Finding, Quantity, Words, World};
use crate::units::{MM, significant};

/// The parameter of a joint that may be anywhere.
const STATION: &str = "station_mm";

/// What an effect of the library is called; `None` for a name that is not in it.
pub fn cause(effect: &str) -> Option<&'static str> {
    Some(match effect {
        "stiffness_scale" => "its moduli or walls are not those of its file",
        "shear_modulus" => "its shear modulus",
        "joint_compliance" => "a connection that yields",
        "root_compliance" => "a flange or adapter that yields",
        "bend_flexibility" => "its pipe becomes oval there",
        "friction" => "friction in the slide",
        "load_offset" => "an offset of the load (hanger or tare)",
        "backlash" => "play in the clamp",
        "creep" => "creep",
        "hysteresis" => "hysteresis",
        "nonlinear_stiffness" => "a stiffness that depends on the load",
        "sensor_scale" => "the scale of the sensor",
        "sensor_misalignment" => "a sensor that is not square to the rod",
        "load_misalignment" => "a load that is not square to the rod",
        "thermal_drift" => "thermal drift",
        "slip" => "something slipped",
        "outlier" => "a misread or disturbed reading",
        _ => return None,
    })
}

/// An effect at its place where it is named without numbers, among others that it may be mistaken for.
pub fn cause_at(effect: &str, place: &str) -> String {
    let under = place.split_once(", ").map_or_else(String::new, |(_, loads)| format!(" under {loads}"));
    match effect {
        "stiffness_scale" => "moduli or walls that are not those of the rod file".into(),
        "shear_modulus" => "another shear modulus".into(),
        "joint_compliance" if place.starts_with("station ") => format!("a connection that yields at {place}"),
        "joint_compliance" => format!("the joint \"{place}\" yielding"),
        "bend_flexibility" => "a bend whose pipe becomes oval".into(),
        "friction" | "backlash" => cause(effect).unwrap_or_default().to_owned() + &under,
        "load_offset" => format!("an offset of the load{under}"),
        "sensor_scale" => format!("the scale of sensor {place}"),
        "sensor_misalignment" => format!("sensor {place} (not square to the rod)"),
        "load_misalignment" => format!("loads turned, {place}"),
        "thermal_drift" => format!("drift of {place}"),
        "slip" => format!("a slip ({place})"),
        "outlier" => format!("{place} misread"),
        "nonlinear_stiffness" | "creep" | "hysteresis" | "root_compliance" => {
            cause(effect).unwrap_or_default().into()
        }
        _ => format!("{} ({place})", effect.replace('_', " ")),
    }
}

/// Where something remains that no effect explains, from the place of its curve: what it follows, and in which readings.
pub fn unexplained_at(place: &str) -> String {
    if place.starts_with("slope") {
        return "makes some lines steeper or flatter than others".into();
    }
    let (name, readings) = place.split_once(", ").unwrap_or((place, "all readings"));
    let follows = match name {
        "load" => "follows the load",
        "unloading" => "follows the load while unloading",
        "position in the run" => "follows the position in the run",
        "order" => "follows the order of the readings",
        "time" => "follows the time",
        "temperature" => "follows the temperature",
        _ => return format!("follows the {name} ({readings})"),
    };
    let readings = if readings == "all deflections" { "all readings alike" } else { readings };
    format!("{follows} ({readings})")
}

impl RigWorld {
    /// A finding of this world in words.
    pub fn words(&self, finding: &Finding) -> Words {
        let effect = self.candidates()[finding.chosen.candidate].effect.as_str();
        let observed = self.observed(effect, finding);
        let cause = cause(effect).map_or_else(|| effect.replace('_', " "), str::to_owned);
        Words { observed, cause }
    }

    /// A parameter of a finding in the unit of its name.
    fn quantity(&self, finding: &Finding, name: &str) -> Option<Quantity> {
        let parameters = &self.candidates()[finding.chosen.candidate].parameters;
        let k = parameters.iter().position(|parameter| parameter.name == name)?;
        let (unit, (value, low, high)) = (parameters[k].unit, self.interval(finding, k)?);
        Some(Quantity { value: value / unit, low: low / unit, high: high / unit })
    }

    /// Value and 95 % interval of the `k`-th parameter of a finding, SI. Of a joint that nobody declared the interval also
    /// holds what the joint would be at the other stations that the readings do not tell from its own.
    pub fn interval(&self, finding: &Finding, k: usize) -> Option<(f64, f64, f64)> {
        let own = *finding.parameters.get(k)?;
        let of_candidate = |candidate: usize| &self.candidates()[candidate];
        let is_scanned =
            |candidate: usize| of_candidate(candidate).parameters.iter().any(|p| p.name == STATION);
        let name = &of_candidate(finding.chosen.candidate).parameters.get(k)?.name;
        if !is_scanned(finding.chosen.candidate) {
            return Some(own);
        }
        let half = if name == STATION { 0.0 } else { (own.2 - own.1) / 2.0 };
        let others = finding.rivals.iter().map(|rival| &rival.chosen).filter(|c| is_scanned(c.candidate));
        let values = others.filter_map(|chosen| {
            let parameters = &of_candidate(chosen.candidate).parameters;
            chosen.values.get(parameters.iter().position(|parameter| parameter.name == *name)?).copied()
        });
        let least = of_candidate(finding.chosen.candidate).parameters[k].bounds.0;
        let least = if name == STATION { f64::NEG_INFINITY } else { least };
        let widened = |(value, low, high): (f64, f64, f64), other: f64| {
            (value, low.min(other - half).max(least), high.max(other + half))
        };
        Some(values.fold(own, widened))
    }

    /// Where along the rod a joint that nobody declared may be, m; `None` for everything else.
    pub fn stretch(&self, finding: &Finding) -> Option<(f64, f64)> {
        let parameters = &self.candidates()[finding.chosen.candidate].parameters;
        let (_, low, high) = self.interval(finding, parameters.iter().position(|p| p.name == STATION)?)?;
        Some((low, high))
    }

    fn observed(&self, effect: &str, finding: &Finding) -> String {
        let place = finding.place.as_str();
        let of = |name: &str| {
            self.quantity(finding, name).unwrap_or(Quantity {
                value: f64::NAN,
                low: f64::NAN,
                high: f64::NAN,
            })
        };
        let say = |name: &str, unit: &str| of(name).size().say(unit);
        let is_positive = |name: &str| of(name).value >= 0.0;
        let loads = match place.split_once(", loads along ") {
            Some((_, axis)) => format!("Loads along {axis}"),
            None => "Loads".to_owned(),
        };
        match effect {
            "friction" => {
                let force = say("force_n", "N");
                match self.data.iter().any(Datum::is_unloading) {
                    true => format!(
                        "{loads} are felt {force} too small while loading and as much too large while unloading"
                    ),
                    false => format!("{loads} are felt {force} too small (nothing was read while unloading)"),
                }
            }
            "load_offset" => {
                let word = if is_positive("force_n") { "larger" } else { "smaller" };
                format!("{loads} are {} {word} than stated", say("force_n", "N"))
            }
            "backlash" => format!("{loads} move the rod {} before it bends", say("play_um", "µm")),
            "stiffness_scale" => format!("The rod is {} than its model everywhere", softer(of("factor"))),
            "shear_modulus" => {
                format!("The rod is {} in torsion and shear than its model", softer(of("factor")))
            }
            "joint_compliance" | "root_compliance" => self.observed_joint(effect, finding),
            "bend_flexibility" => format!("The bend is {} times as flexible as a beam", say("factor", "")),
            "sensor_scale" => {
                let excess = of("factor").map(|factor| 100.0 * (factor - 1.0));
                let word = if excess.value >= 0.0 { "much" } else { "little" };
                format!("Sensor {place} shows {} too {word}", excess.size().say("%"))
            }
            "sensor_misalignment" => {
                let (from, towards) = place.split_once(" towards ").unwrap_or((place, "the others"));
                let word = if is_positive("angle_deg") { "towards" } else { "away from" };
                format!("Sensor {from} is turned by {} {word} {towards}", say("angle_deg", "°"))
            }
            "load_misalignment" => match place.split_once(" towards ") {
                Some((from, towards)) => {
                    let word = if is_positive("angle_deg") { "towards" } else { "away from" };
                    format!("Loads along {from} pull {} {word} {towards}", say("angle_deg", "°"))
                }
                None => format!(
                    "Loads along {} are turned by {}",
                    place.replace(" about ", ", about "),
                    of("angle_deg").say("°")
                ),
            },
            "nonlinear_stiffness" => self.observed_curvature(finding),
            "creep" => {
                let since = place.split(", ").nth(1).unwrap_or("under load");
                let growth = of("per_decade").map(|share| 100.0 * share).say("%");
                format!("Deflections grow by {growth} with every tenfold time {since}")
            }
            "hysteresis" => {
                let at = if place.contains("open") { "zero load" } else { "half load" };
                let share = of("fraction").map(|share| 100.0 * share).say("%");
                format!(
                    "On the way down more deflection is left than on the way up, at {at} by {share} of full scale"
                )
            }
            "thermal_drift" => {
                let (channel, since) = place.split_once(", ").unwrap_or((place, ""));
                let drift = match self.quantity(finding, "um_per_k") {
                    Some(drift) => drift.say("µm per kelvin"),
                    None => of("um_per_h").say("µm per hour"),
                };
                let since = if since.is_empty() { String::new() } else { format!(" {since}") };
                format!("Sensor {channel} drifts by {drift}{since}")
            }
            "slip" => format!("Readings jump by {} ({place})", of("um").say("µm")),
            "outlier" => format!("The reading of {place} is off by {}", of("um").say("µm")),
            _ => format!("{} at {place}", effect.replace('_', " ")),
        }
    }

    /// A joint by its name, its station or the root; only what differs from the rod file, unless nothing does for sure.
    fn observed_joint(&self, effect: &str, finding: &Finding) -> String {
        let parameters = &self.candidates()[finding.chosen.candidate].parameters;
        let mut sure = Vec::new();
        let mut all = Vec::new();
        for (name, word) in [("bending_urad_per_nm", "in bending"), ("torsion_urad_per_nm", "in torsion")] {
            let Some(parameter) = parameters.iter().find(|parameter| parameter.name == name) else {
                continue;
            };
            let Some(yields) = self.quantity(finding, name) else { continue };
            let of_file = parameter.neutral / parameter.unit;
            let instead = match of_file > 0.0 {
                true => format!(" instead of {}", significant(of_file, 3)),
                false => String::new(),
            };
            let words = format!("{} {word}{instead}", yields.say("µrad/(N·m)"));
            if yields.low > of_file || yields.high < of_file {
                sure.push(words.clone());
            }
            all.push(words);
        }
        let amount = if sure.is_empty() { all } else { sure }.join(" and ");
        let place = &finding.place;
        let what = match self.stretch(finding) {
            _ if effect == "root_compliance" => "The rod's root".to_owned(),
            Some((low, high)) => {
                let declared: String = finding
                    .rivals
                    .iter()
                    .filter(|rival| {
                        let candidate = &self.candidates()[rival.chosen.candidate];
                        candidate.effect == effect && candidate.parameters.iter().all(|p| p.name != STATION)
                    })
                    .map(|rival| format!(", or the joint \"{}\"", rival.place))
                    .collect();
                let (low, high) = (low / MM, high / MM);
                format!("Something at {place} (between {low:.0} and {high:.0} mm{declared})")
            }
            None if place.starts_with("station ") => format!("Something at {place}"),
            None => format!("The joint \"{place}\""),
        };
        format!("{what} yields {amount}")
    }

    /// By how much the stiffness has changed at the largest load.
    fn observed_curvature(&self, finding: &Finding) -> String {
        let largest = self.data.iter().fold(0.0, |max: f64, datum| max.max(datum.load));
        let quadratic = self.quantity(finding, "per_n2").map(|k| k.map(|k| 100.0 * k * largest * largest));
        let linear = self.quantity(finding, "per_n").map(|k| k.map(|k| 100.0 * k * largest));
        let body = match self.body {
            Body::Rod(_) => "The rod",
            Body::Lines(_) => "What is loaded",
        };
        let Some(change) = quadratic.or(linear) else { return format!("{body} is not linear") };
        let word = if change.value >= 0.0 { "softer" } else { "stiffer" };
        format!("{body} grows {word} with the load, by {} at {}", change.size().say("%"), newtons(largest))
    }
}

/// A force with a unit that keeps its number short.
fn newtons(force: f64) -> String {
    let (unit, name) = match force {
        force if force >= 1e6 => (1e6, "MN"),
        force if force >= 1e4 => (1e3, "kN"),
        _ => (1.0, "N"),
    };
    format!("{} {name}", significant(force / unit, 3))
}

/// `12 ± 2 % softer`, of a factor on a modulus.
fn softer(factor: Quantity) -> String {
    let excess = factor.map(|factor| 100.0 * (1.0 / factor - 1.0));
    let word = if excess.value >= 0.0 { "softer" } else { "stiffer" };
    format!("{} {word}", excess.size().say("%"))
}
