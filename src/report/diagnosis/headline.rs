//! The first lines of a diagnosis: what was found, and what it is worth.

use super::remainder::remainder;
use crate::diagnosis::rig::{RigDiagnosis, cause_at};
use crate::diagnosis::{Finding, Words, rms};
use crate::units::{UM, significant};

/// So many findings are said at once; more are counted.
const SAID: usize = 2;
/// So many rivals are said at once.
pub const RIVALS_SAID: usize = 2;

/// One sentence on what was found, and one on what it does to the errors.
pub fn headline(found: &RigDiagnosis) -> String {
    let diagnosis = &found.diagnosis;
    let noise = um(diagnosis.noise);
    let findings = &diagnosis.findings;
    let remains = remainder(found).map(|left| left.sentence);
    if findings.is_empty() {
        let with_noise = |words: String| format!("{words} Noise is {noise} µm.");
        return remains.map(with_noise).unwrap_or_else(|| {
            format!(
                "The readings agree with the model: what is left, {} µm, is noise ({noise} µm).",
                um(rms(&diagnosis.before))
            )
        });
    }
    let said: Vec<String> = findings.iter().take(SAID).map(|finding| sentence(found, finding)).collect();
    let mut words = said.join(" ");
    let more = findings.len().saturating_sub(SAID);
    if more > 0 {
        words += &format!(" And {more} more {}.", if more == 1 { "effect" } else { "effects" });
    }
    let it = if findings.len() > 1 { "them" } else { "it" };
    // a single event says nothing about readings that were held out
    let is_event = |finding: &Finding| ["slip", "outlier"].contains(&found.effect(finding));
    words += &match &diagnosis.proof {
        _ if findings.iter().all(is_event) => format!(
            " Taking {it} into account lowers the error from {} to {} µm; noise is {noise} µm.",
            um(rms(&diagnosis.before)),
            um(rms(&diagnosis.after))
        ),
        Some(proof) if um(proof.after) != um(proof.before) && proof.after < proof.before => format!(
            " Taking {it} into account lowers the held-out error from {} to {} µm; noise is {noise} µm.",
            um(proof.before),
            um(proof.after)
        ),
        Some(proof) => format!(
            " Held-out readings do not confirm {it}: their error is {} µm before and {} µm after.",
            um(proof.before),
            um(proof.after)
        ),
        None => format!(
            " Taking {it} into account lowers the error from {} to {} µm (nothing could be held out); noise is {noise} µm.",
            um(rms(&diagnosis.before)),
            um(rms(&diagnosis.after))
        ),
    };
    match remains {
        Some(remains) => format!("{words} {remains}"),
        None => words,
    }
}

/// A finding with what cannot be told from it.
pub fn sentence(found: &RigDiagnosis, finding: &Finding) -> String {
    let Words { observed, cause } = found.world.words(finding);
    let others = found.other_effects(finding);
    if others.is_empty() {
        return format!("{observed}: {cause}.");
    }
    let said =
        others.iter().take(RIVALS_SAID).map(|(effect, place)| format!(", or {}", cause_at(effect, place)));
    let more = if others.len() > RIVALS_SAID { ", or others" } else { "" };
    format!("{observed}: {cause}{}{more}; these readings cannot tell.", said.collect::<String>())
}

/// A length in µm with as many digits as are read.
pub fn um(length: f64) -> String {
    significant(length / UM, if length.abs() < 0.995e-4 { 2 } else { 3 })
}
