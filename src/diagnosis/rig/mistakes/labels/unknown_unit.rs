//! Readings, or loads, in a unit that no list has: counts of a converter, an amplifier in another
//! range, a conversion that was typed wrongly.

use super::in_file::{ALL, Labels, UNUSUAL, mask};
use super::units::BESIDE;
use crate::diagnosis::rig::effects::mistakes::UNIT_MISTAKE;
use crate::diagnosis::rig::mistakes::possible::PossibleMistake;
use crate::diagnosis::rig::mistakes::relabelling::Relabelling;
use crate::diagnosis::rig::recording::columns::{columns, load_column};
use crate::inference::{Effect, Estimate, Finding, Key, Location};
use crate::spatial::Axis;
use crate::units::significant;

/// Ln of the density of a factor that may be anything from a millionth to a million, over that of
/// one that is known, within the 2 % that a rod's own stiffness leaves of it:
/// 0.02·√(2π)/ln 10¹².
const ANY_FACTOR: f64 = -6.3;
/// A rod whose stiffness alone is so far from its file's may have other walls, or be of another
/// material: farther, a unit is looked for.
pub(in crate::diagnosis::rig::mistakes) const BEYOND_A_ROD: f64 = 3.0;
/// And a sensor among others may be this far off its scale, at most.
const BEYOND_A_SENSOR: f64 = 2.0;

/// One factor on the readings of all channels, or of one, that is none of a unit's; `log_scale`
/// says what the lines of some channels have in common, measured over expected: ln.
pub(in crate::diagnosis::rig::mistakes) fn unknown_units(
    labels: &Labels,
    log_scale: impl Fn(&[Axis]) -> f64,
) -> Vec<PossibleMistake> {
    let each = labels.channels.iter().map(std::slice::from_ref);
    let each = each.filter(|_| labels.channels.len() > 1);
    let all = std::iter::once(&labels.channels[..]).chain(each);
    all.filter_map(|channels| unknown_unit(labels, channels, log_scale(channels))).collect()
}

fn unknown_unit(labels: &Labels, channels: &[Axis], log_scale: f64) -> Option<PossibleMistake> {
    let is_one_of_several = channels.len() < labels.channels.len();
    let beyond = if is_one_of_several { BEYOND_A_SENSOR } else { BEYOND_A_ROD };
    if log_scale.abs() < beyond.ln() {
        return None;
    }
    let names = columns(channels);
    let (factor, times) = ((-log_scale).exp(), significant(log_scale.abs().exp(), 2));
    let size = if log_scale < 0.0 { "small" } else { "large" };
    let [is, looks] = if channels.len() == 1 { ["is", "looks"] } else { ["are", "look"] };
    // one channel's says nothing of the loads
    let and_loads = match is_one_of_several {
        true => String::new(),
        false => format!(" and of {}", load_column(labels.load_column)),
    };
    Some(PossibleMistake {
        effect: &UNIT_MISTAKE,
        location: Key::new(&names),
        relabelling: Relabelling::reading(ALL, mask(channels), factor),
        log_prior: UNUSUAL + ANY_FACTOR,
        // the rod itself may be stiffer or softer than its file says
        estimates: vec![Estimate::as_written("factor", factor, factor / BESIDE, factor * BESIDE)],
        observed: format!(
            "{names} {is} about {times} times too {size} for these loads on this rod, which no usual unit is: \
             look up the unit and the amplification of {names}{and_loads}",
        ),
        or_else: None,
        looks_like: format!("{names} {looks} {times} times too {size}"),
        within: BESIDE,
    })
}

impl PossibleMistake {
    /// The channels whose scale this only knows from their own readings.
    pub fn channels_of_unknown_unit(&self) -> impl Iterator<Item = usize> {
        let is_unknown = is_unknown(self.effect, &self.estimates);
        (0..3).filter(move |&channel| is_unknown && self.relabelling.reading[0][channel] != 1.0)
    }
}

/// True for a factor that only the rod itself says: of no unit that has a name, and in all rows, so
/// that no others say it.
pub fn is_unknown_unit(finding: &Finding) -> bool {
    let is_everywhere = matches!(&finding.location, Location::Key(key) if key.rows.is_empty());
    is_everywhere && is_unknown(finding.effect, &finding.estimates)
}

/// True for a unit whose factor is one that a rod of other walls, or of another material, has.
pub fn is_like_a_rod(finding: &Finding) -> bool {
    let is_near = |factor: &Estimate| factor.value.ln().abs() < BEYOND_A_ROD.ln();
    *finding.effect == UNIT_MISTAKE && finding.estimates.iter().any(is_near)
}

fn is_unknown(effect: &Effect, estimates: &[Estimate]) -> bool {
    *effect == UNIT_MISTAKE && estimates.iter().any(|factor| factor.low < factor.high)
}
