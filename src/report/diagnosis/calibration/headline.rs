//! The first lines of a calibration's diagnosis: what was found, and what it is worth.

use super::Distances;
use super::remainder::remainder;
use crate::diagnosis::calibration::{CalibrationDiagnosis, Mismatch, cause_at};
use crate::diagnosis::{Words, rms};
use crate::report::diagnosis::headline::{RIVALS_SAID, um};

/// So many findings are said besides the first; more are counted.
const SAID: usize = 4;
/// Share of the held-out error that must vanish to be a proof.
const PROVED: f64 = 0.02;

/// What was found, and what it does to the errors.
pub fn headline(found: &CalibrationDiagnosis) -> String {
    let diagnosis = &found.diagnosis;
    let noise = um(diagnosis.noise);
    let remains = remainder(found).map(|left| left.sentence);
    let Some((first, others)) = found.mismatches.split_first() else {
        return match remains {
            Some(remains) => format!("{remains} Noise is {noise} µm per coordinate."),
            None => format!(
                "The calibrated robot explains the poses: what is left, {} µm per coordinate, is noise ({noise} µm).",
                um(rms(&diagnosis.before))
            ),
        };
    };
    let mut words = sentence(found, first);
    let named: Vec<String> =
        others.iter().take(SAID).map(|other| cause_at(&other.effect, &other.location)).collect();
    if !named.is_empty() {
        let more = match others.len().saturating_sub(SAID) {
            0 => String::new(),
            more => format!("; and {more} more"),
        };
        words += &format!(" Found besides: {}{more}.", named.join("; "));
    }
    words += &worth(found);
    match remains {
        Some(remains) => format!("{words} {remains}"),
        None => words,
    }
}

/// What the story does to errors, of held-out poses where there are some.
fn worth(found: &CalibrationDiagnosis) -> String {
    let diagnosis = &found.diagnosis;
    let is_event =
        |m: &Mismatch| ["clamp_shift", "socket_shift", "base_shift", "outlier"].contains(&m.effect.as_str());
    let it = if found.mismatches.len() > 1 { "them" } else { "it" };
    match Distances::of(found).held_out_means() {
        Some((before, after)) if after < (1.0 - PROVED) * before => {
            format!(
                " With {it}, held-out poses are predicted to {} µm on average instead of {} µm.",
                um(after),
                um(before)
            )
        }
        Some((before, after)) if !found.mismatches.iter().all(is_event) => format!(
            " Held-out poses do not confirm {it}: their mean error is {} µm before and {} µm after.",
            um(before),
            um(after)
        ),
        _ => format!(
            " Taking {it} into account lowers the error per coordinate from {} to {} µm.",
            um(rms(&diagnosis.before)),
            um(rms(&diagnosis.after))
        ),
    }
}

/// A mismatch with what cannot be told from it.
pub fn sentence(found: &CalibrationDiagnosis, mismatch: &Mismatch) -> String {
    let Words { observed, cause } = found.words(mismatch);
    let others = other_effects(found, mismatch);
    if others.is_empty() {
        return format!("{observed}: {cause}.");
    }
    let said: String = others
        .iter()
        .take(RIVALS_SAID)
        .map(|(effect, place)| format!(", or {}", cause_at(effect, place)))
        .collect();
    let more = if others.len() > RIVALS_SAID { ", or others" } else { "" };
    format!("{observed}: {cause}{said}{more}; these poses cannot tell.")
}

/// Other effects that stand for a mismatch as well, each with its likeliest place.
pub fn other_effects(found: &CalibrationDiagnosis, mismatch: &Mismatch) -> Vec<(String, String)> {
    let mut others: Vec<(String, String)> = Vec::new();
    for (effect, place) in found.others(mismatch) {
        if effect != mismatch.effect && others.iter().all(|(known, _)| *known != effect) {
            others.push((effect, place));
        }
    }
    others
}

/// Other places where the effect of a mismatch may be as well.
pub fn other_places(found: &CalibrationDiagnosis, mismatch: &Mismatch) -> Vec<String> {
    let others = found.others(mismatch).into_iter();
    others.filter(|(effect, _)| *effect == mismatch.effect).map(|(_, place)| place).collect()
}
