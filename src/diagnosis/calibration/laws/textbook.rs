//! What textbooks call a law of a robot that looks like the one that was found: a remark, never a
//! name.

use crate::inference::law::{Form, FormConstant, Law, Memory};

/// Degrees of a turn.
const TURN: f64 = 360.0;

/// The nearest mechanism, in a sentence.
pub fn remark(law: &Law) -> Option<String> {
    let symbol = law.site.variable.symbol;
    if let (Some((FormConstant::Period, period)), "q") = (&law.constant, symbol) {
        let (most, least) = (TURN / period.low, TURN / period.high);
        let times = (TURN / period.value).round();
        let is_whole = least <= times && times <= most && most - least < 1.0 && times >= 1.0;
        return is_whole.then(|| match times as u32 {
            1 => "Once per turn is what an eccentric wheel or scale does.".to_owned(),
            2 => "Twice per turn is what an oval wheel or a wave generator does.".to_owned(),
            many => format!("{many} times per turn is what the teeth or the input of a gear do."),
        });
    }
    let remark = match (law.form, law.memory, symbol) {
        (_, Memory::Lag | Memory::Lagged, _) => {
            "A first-order lag behind the temperature is what a body does that warms through."
        }
        (Form::Approach | Form::Decay, _, "t" | "n") => {
            "An exponential in time is what warming up with one time constant does."
        }
        (Form::Saturation, _, "τ" | "g") => {
            "Growth up to one load is what a part does that comes to a stop there: play with a spring."
        }
        (Form::PullBelow | Form::PullAbove, ..) => {
            "The inverse square of a distance is what the pole of a magnet pulls with (Coulomb)."
        }
        (Form::Threshold, _, "τ" | "g") => {
            "A slope from one load on is what a contact does that opens or closes there."
        }
        _ => return None,
    };
    Some(remark.to_owned())
}
