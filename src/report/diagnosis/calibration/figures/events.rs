//! What happened while the poses were recorded, for the picture of their order.

use crate::diagnosis::calibration::CalibrationDiagnosis;
use crate::report::pictures::diagnosis::Event;

/// Where a row, from 0, stands along the order: the first is 1, as in words.
pub fn place(row: usize) -> f64 {
    row as f64 + 1.0
}

/// Shifts, each before the first row that it changes, and outliers.
pub fn all(found: &CalibrationDiagnosis) -> Vec<Event> {
    let mut events: Vec<Event> = found
        .happened()
        .into_iter()
        .map(|happened| Event {
            at: place(happened.row) - if happened.stays { 0.5 } else { 0.0 },
            text: happened.label,
        })
        .collect();
    events.sort_by(|a, b| a.at.total_cmp(&b.at));
    events
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::report::chart::Mark;
    use crate::report::diagnosis::calibration::figures::{seen, tests::with_diagnosed};

    #[test]
    fn a_shift_is_marked_between_the_rows_and_a_misread_pose_at_its_own() {
        // the fourth clamp of five holds rows 36 to 47
        let by = |row: usize| match row {
            42..48 => Vector3::new(0.0, 1e-3, 0.0),
            20 => Vector3::new(1.5e-3, 0.0, 0.0),
            _ => Vector3::zeros(),
        };
        with_diagnosed(&by, |campaign, found| {
            let marked = |event: &Event| (event.at, event.text.clone());
            let events: Vec<(f64, String)> = all(found).iter().map(marked).collect();
            let pose = &campaign.measurements.rows[20].pose;
            assert_eq!(events.len(), 2, "{events:?}");
            assert!(events[0].0 == 21.0 && events[0].1.contains(pose.as_str()), "{events:?}");
            assert!(events[1].0 == 42.5 && events[1].1.ends_with(" moved"), "{events:?}");
            let figures = seen(found);
            let order = figures.last().unwrap();
            let is_event = |mark: &&Mark| matches!(mark, Mark::Event { .. });
            for panel in &order.panels {
                assert_eq!(panel.marks.iter().filter(is_event).count(), 2);
            }
            let svg = order.svg();
            assert!(events.iter().all(|(_, text)| svg.contains(text.as_str())));
        });
    }
}
