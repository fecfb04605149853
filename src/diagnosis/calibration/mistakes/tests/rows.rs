//! Positions that stand in other rows than the angles that belong to them.

use super::*;

#[test]
fn positions_some_rows_away_from_their_angles() {
    for by in [1, -2] {
        let mut wrong = tracked(60, 7);
        let count = wrong.measurements.len() as isize;
        let there = |row: isize| (row - by).rem_euclid(count) as usize;
        let old = points(&mut wrong).clone();
        for (row, point) in points(&mut wrong).iter_mut().enumerate() {
            *point = old[there(row as isize)];
        }
        let mended = mended(&wrong);
        assert_eq!(mended.found[0].effect.name, "row_mistake");
        assert_eq!(mended.found[0].estimates[0].value, by as f64);
        // the rows whose positions are lost are left out
        assert_eq!(mended.campaign.measurements.len() as isize, count - by.abs());
    }
}

#[test]
fn positions_in_reverse_order() {
    let right = tracked(60, 7);
    let mut wrong = right.clone();
    points(&mut wrong).reverse();
    assert_eq!(found(&wrong), one("row_mistake", "x_mm, y_mm, z_mm"));
    assert_eq!(points(&mut mended(&wrong).campaign), points(&mut right.clone()));
    // the clamps with them
    let right = tx90();
    let mut wrong = right.clone();
    points(&mut wrong).reverse();
    let groups: Vec<usize> = right.measurements.rows.iter().map(|row| row.group).collect();
    wrong.measurements.rows.iter_mut().zip(groups.iter().rev()).for_each(|(row, group)| row.group = *group);
    assert_eq!(found(&wrong), one("row_mistake", "clamp, x_mm, y_mm, z_mm"));
}

/// A column that was pasted one row too low, or too high.
#[test]
fn a_whole_column_in_other_rows_than_the_others() {
    let right = tracked(60, 7);
    for by in [1, -1] {
        let there = |row: isize| (row + by).rem_euclid(60) as usize;
        let mut angles = right.clone();
        let mut places = right.clone();
        for row in 0..60 {
            let of_joint = right.measurements.joints(there(row as isize))[3];
            angles.measurements.joint_values[6 * row + 3] = of_joint;
            points(&mut places)[row].y = points(&mut right.clone())[there(row as isize)].y;
        }
        for (wrong, place) in [(angles, "q4_deg"), (places, "y_mm")] {
            let mended = mended(&wrong);
            assert_eq!(found(&wrong), one("row_mistake", place));
            assert_eq!(mended.found[0].estimates[0].value, -by as f64);
            // the row whose number is lost is left out
            assert_eq!(mended.campaign.measurements.len(), 59);
        }
    }
}
