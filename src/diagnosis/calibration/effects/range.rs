//! The distances that a tracker shows.

use nalgebra::Vector3;

use super::super::model::CalibrationModel;
use super::super::model::configuration::sight;
use super::super::model::entry::linear;
use super::{
    CalibrationEffect, Context, Entry, Transfer, first, first_value, lack, no_event, out_of_what_is_shown,
    own_parameters, single,
};
use crate::calibration::campaign::Campaign;
use crate::inference::{Effect, Finding, Kind, Location, NotTestable, Part, Reported, WrittenTo};
use crate::units::MM;

/// Error of the zero of a distance meter, or of the radius of a reflector, m.
const OFFSET: f64 = 0.5 * MM;
/// Cosine of the angle between the direction to any ball and that to their middle: a tracker stands
/// outside of what it sees.
const OUTSIDE: f64 = 0.3;
/// Distances that are all too long or too short.
pub static RANGE_OFFSET: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "range_offset",
        kind: Kind::Physics,
        summary: "a tracker's distances are all off by a constant",
        formula: "d·p/|p|: p is the ball as the tracker in the origin of {W} sees it, d how much too long \
                  distances are",
        prior: "0.5 mm: the zero of a distance meter is known to hundredths of a millimetre, and \
                another reflector than is set is millimetres off",
        parameters: &[(&["offset_um"], "shown less true distance")],
        needs: "points of a tracker that stands in the origin of {W}, outside of what it sees",
        cause: "the zero of the tracker's distances, or another reflector than is set",
        cause_at: |location| format!("the zero of the distances ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some(
            "Look which reflector is set; measure the distance of two points from between them and from \
             behind one of them.",
        ),
    },
    candidates: offsets,
    estimates: own_parameters,
    observed: offset_observed,
    write: write_offset,
    transfer: Transfer::Nothing,
    event: no_event,
};

fn offsets(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    if !context.is_tracked() {
        return Vec::new();
    }
    if context.recording.stations.len() > 1 || !is_outside(context) {
        lacks.push(lack(&RANGE_OFFSET, "no tracker stands in the origin of the world frame"));
        return Vec::new();
    }
    let column = context.column(|_, there| sight(&there.tip));
    vec![single(&RANGE_OFFSET, Location::Part(Part::Tracker), linear("offset_um", OFFSET), column)]
}

/// True where all balls lie to one side of the origin of {W}.
fn is_outside(context: &Context) -> bool {
    let seen: Vec<Vector3<f64>> = context.configurations.iter().map(|there| sight(&there.tip)).collect();
    let middle = sight(&seen.iter().sum());
    seen.iter().all(|seen| seen.dot(&middle) > OUTSIDE)
}

fn write_offset(finding: &Finding, model: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let offset = first_value(finding);
    out_of_what_is_shown(finding, model, extended, |ball| sight(ball) * offset)
}

fn offset_observed(finding: &Finding, _: &CalibrationModel) -> String {
    let off = first(finding).map(|um| um / 1000.0);
    let word = if off.value < 0.0 { "short" } else { "long" };
    format!("The distances that the tracker shows are all {} too {word}", off.size().with_unit("mm"))
}
