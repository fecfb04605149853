//! The readings without what is the rig's, as a file.

use nalgebra::DVector;

use super::written_item::WrittenItem;
use crate::diagnosis::rig::model::RigModel;
use crate::spatial::Direction;
use crate::units::UM;

/// So many steps of what is written make a newton, and a micrometre: a nanometre is less than any
/// sensor reads. A quotient of whole numbers is the number that its digits say.
const STEPS_OF_LOAD: f64 = 1e6;
const STEPS_OF_OFFSET: f64 = 1e3;

/// The readings less `of_rig`, as a file.
pub(super) fn without(
    model: &RigModel,
    of_rig: &DVector<f64>,
    undone: &[String],
    [removed, left_out]: [&[WrittenItem]; 2],
) -> String {
    let mut readings = model.readings().clone();
    for (datum, change) in model.data().iter().zip(of_rig.iter()) {
        if let Some(imposed) = datum.imposed {
            // the load that the rod alone would need; it may have turned round
            let row = &mut readings.rows[datum.row - 1];
            let load = datum.signed_load() - change / imposed.per_newton;
            let sign = if load < 0.0 { -1 } else { 1 };
            row.direction = Direction { sign, ..row.direction };
            row.load = (load.abs() * STEPS_OF_LOAD).round() / STEPS_OF_LOAD;
            continue;
        }
        if let Some(offset) = &mut readings.rows[datum.row - 1].offset[datum.channel.index()] {
            let steps = ((*offset - change) / UM * STEPS_OF_OFFSET).round();
            // as a file is read: its digits, times the unit
            *offset = steps / STEPS_OF_OFFSET * UM;
        }
    }
    let listed = |what: &str, list: &[String]| match list {
        [] => format!("{what}: nothing."),
        list => format!("{what}: {}.", list.join("; ")),
    };
    let texts = |items: &[WrittenItem]| items.iter().map(WrittenItem::to_string).collect::<Vec<_>>();
    let source = readings.source.as_deref().map(|source| format!("Recorded: {source}"));
    let mut above = vec![
        format!(
            "CORRECTED, not as recorded: the readings of {} without the effects of a diagnosis",
            readings.file
        ),
        listed("Mistakes undone", undone),
        listed("Removed, effects of the rig", &texts(removed)),
        listed(
            "Removed, so that the compliance at small loads directly after loading remains",
            &texts(left_out),
        ),
    ];
    above.extend(source);
    readings.to_csv(&above)
}
