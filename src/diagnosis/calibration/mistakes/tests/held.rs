//! Displays that stood still for a while, or are at the end of their range.

use super::*;
use crate::units::significant;

/// The campaign with other displacements; what each was, and its row.
fn shown(campaign: &Campaign, change: impl Fn(usize, Vector3<f64>) -> Vector3<f64>) -> Campaign {
    let row = std::cell::Cell::new(0);
    let next = |seen| {
        row.set(row.get() + 1);
        change(row.get() - 1, seen)
    };
    with_positions(campaign, next)
}

fn displacement(campaign: &Campaign, row: usize) -> Vector3<f64> {
    let Targets::Points(points) = &campaign.measurements.targets else { panic!("no points") };
    campaign.measurements.device(row).inverse().point(&points[row])
}

#[test]
fn a_device_that_stood_still_for_a_while() {
    let right = tx90();
    let stays = displacement(&right, 20);
    let rows = 20..32;
    let one_axis = shown(&right, |row, mut seen| {
        seen.y = if rows.contains(&row) { stays.y } else { seen.y };
        seen
    });
    let mended_one = mended(&one_axis);
    assert_eq!(found(&one_axis), one("stuck_sensor", "y_mm, pose 21 to pose 32"));
    assert_eq!(mended_one.found[0].description.observed, "Leave out pose 21 to pose 32, or measure anew");
    assert!((mended_one.found[0].estimates[0].value - stays.y / MM).abs() < 1e-9);
    assert_eq!(mended_one.campaign.measurements.len(), right.measurements.len() - rows.len());
    assert!(mended_one.has_data);
    // all of it
    let whole = shown(&right, |row, seen| if rows.contains(&row) { stays } else { seen });
    assert_eq!(found(&whole), one("stuck_sensor", "x_mm, y_mm, z_mm, pose 21 to pose 32"));
}

#[test]
fn a_device_at_the_end_of_its_range() {
    let right = tx90();
    let limit = 0.25 * MM;
    let cut = shown(&right, |_, mut seen| {
        seen.x = seen.x.clamp(-limit, limit);
        seen
    });
    let at = (0..60).filter(|&row| displacement(&right, row).x.abs() > limit).count();
    assert!((10..30).contains(&at), "{at}");
    let mended = mended(&cut);
    assert_eq!(found(&cut), one("saturated_sensor", "x_mm"));
    let observed = &mended.found[0].description.observed;
    assert!(observed.ends_with("or use a sensor of a longer range"), "{observed}");
    assert_eq!(mended.campaign.measurements.len(), 60 - at);
}

#[test]
fn of_a_device_that_hardly_moved_nothing_else_is_said() {
    let stays = displacement(&tx90(), 20);
    let stuck = shown(&tx90(), |row, mut seen| {
        seen.z = if row >= 20 { stays.z } else { seen.z };
        seen
    });
    assert_eq!(found(&stuck), one("stuck_sensor", "z_mm"));
    let mended = mended(&stuck);
    assert!(!mended.has_data && !mended.is_changed);
    let why = format!("it stays at {} mm, in 40 of 60 rows", significant(stays.z / MM, 4));
    assert_eq!(mended.found[0].description.cause, why);
}

/// A display of few digits shows the same again and again; and what shows the same where it is
/// right is not wrong.
#[test]
fn equal_displacements_that_are_right() {
    let coarse = 0.1 * MM;
    let few_digits = shown(&tx90(), |_, seen| seen.map(|x| (x / coarse).round() * coarse));
    assert_eq!(found(&few_digits), []);
    let mut sorted = tx90();
    let mut order: Vec<usize> = (0..60).collect();
    order.sort_by(|&a, &b| displacement(&sorted, a).z.total_cmp(&displacement(&sorted, b).z));
    let recording = sorted.measurements.clone();
    let Targets::Points(from) = &recording.targets else { panic!("no points") };
    for (to, &row) in order.iter().enumerate() {
        points(&mut sorted)[to] = from[row];
        sorted.measurements.joint_values[6 * to..6 * to + 6].copy_from_slice(recording.joints(row));
        sorted.measurements.rows[to] = recording.rows[row].clone();
    }
    let level = displacement(&sorted, 32).z;
    let held = shown(&sorted, |row, mut seen| {
        seen.z = if (29..36).contains(&row) { level } else { seen.z };
        seen
    });
    assert_eq!(found(&held), []);
}
