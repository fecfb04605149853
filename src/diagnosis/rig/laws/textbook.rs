//! What textbooks call a law that looks like the one that was found: a remark, never a name.

use crate::inference::law::{Form, FormConstant, Law, Memory};

/// Exponents over a load or a moment, each with what has it.
const EXPONENTS: [(f64, &str, &str); 3] = [
    (
        2.0 / 3.0,
        "2/3",
        "that of a Hertzian contact of two curved bodies (K. L. Johnson, Contact Mechanics, 1985, ch. 4)",
    ),
    (2.0, "2", "that of a deflection to second order in the load"),
    (3.0, "3", "that of a spring with a cubic term (Duffing)"),
];
/// The same over the deflection, of what resists it.
const EXPONENTS_OF_DEFLECTION: [(f64, &str, &str); 2] = [
    (
        1.5,
        "3/2",
        "that of the force of a Hertzian contact over its approach (K. L. Johnson, Contact Mechanics, 1985, ch. 4)",
    ),
    (3.0, "3", "that of a spring with a cubic term (Duffing)"),
];
/// An exponent is known well enough for a remark within so much.
const KNOWN: f64 = 0.15;

/// The nearest mechanism, in a sentence.
pub fn remark(law: &Law) -> Option<String> {
    if let Some((FormConstant::Exponent, p)) = &law.constant {
        let half = 0.5 * (p.high - p.low);
        let known: &[_] = match law.site.variable.symbol {
            "F" | "M" => &EXPONENTS,
            "u" => &EXPONENTS_OF_DEFLECTION,
            _ => &[],
        };
        if half > KNOWN * p.value {
            return None;
        }
        let near = known.iter().find(|(exponent, ..)| p.low <= *exponent && *exponent <= p.high)?;
        return Some(format!("The exponent {:.2} ± {half:.2} agrees with {}: {}.", p.value, near.1, near.2));
    }
    let remark = match (law.form, law.memory, law.site.variable.symbol) {
        (_, Memory::Lag, "u") => {
            "A first-order lag of the deflection is what a spring bears behind a dashpot (Maxwell)."
        }
        (_, Memory::Lag, _) => {
            "A first-order lag is what a spring with a dashpot beside it does (Kelvin and Voigt)."
        }
        (_, Memory::Lagged, _) => {
            "Behind the temperature by one time constant is what a body does that warms through."
        }
        (_, Memory::BoucWen(_), _) => {
            "A loop of Bouc and Wen is what many small slips do together that begin one after the other."
        }
        (_, Memory::Stop, _) => {
            "A stop operator is what a spring with a dry slider in series does (Jenkins)."
        }
        (_, Memory::Play, _) => {
            "A play operator is what is moved through a clearance and held by friction there."
        }
        (_, Memory::Stops(_), _) => {
            "A few stop operators side by side are what a joint does that slips at a few places \
             (Prandtl and Ishlinskii)."
        }
        (Form::Approach | Form::Decay, _, "t") => {
            "An exponential in time is what one relaxation time does (Maxwell)."
        }
        (Form::Logarithm, _, "t") => "A logarithm of time is what primary creep often follows.",
        (Form::Decay | Form::Settling, Memory::Side, "F") | (Form::Settling, _, "v") => {
            "Friction that falls to a level is what a lubricated or a worn slide does (Stribeck)."
        }
        (Form::Harmonic | Form::Swell(_), _, "y") => {
            "A wave over the reading is what an encoder or an interferometer adds when it interpolates."
        }
        (Form::Chirp(_), _, "y") => {
            "A wave whose period changes along the reading is what a scale has whose pitch changes."
        }
        (Form::Pull, ..) => {
            "The inverse square of a distance is what the pole of a magnet pulls with (Coulomb)."
        }
        (Form::Threshold, _, "F" | "M") => {
            "A slope from one load on is what a contact does that opens or closes there."
        }
        (Form::Threshold, _, "u") => {
            "A slope from one deflection on is what something does that is touched there."
        }
        (Form::PowerBeyond(_), _, "F" | "M" | "u") => {
            "A power from somewhere on is what curved bodies do that touch there (Hertz)."
        }
        (Form::Rough(_), _, "F" | "M" | "u") => {
            "A slope that begins little by little is what rough surfaces do that meet (Greenwood and \
             Williamson)."
        }
        (Form::Saturation, _, "F" | "M") => {
            "Growth up to one load is what a part does that comes to a stop there."
        }
        _ => return None,
    };
    Some(remark.to_owned())
}
