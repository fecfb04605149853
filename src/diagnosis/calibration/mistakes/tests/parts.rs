//! Mistakes that concern some rows alone.

use super::*;

pub fn in_rows(campaign: &Campaign, rows: std::ops::Range<usize>, change: impl Fn(&mut [f64])) -> Campaign {
    let mut wrong = campaign.clone();
    wrong.measurements.joint_values.chunks_mut(6).skip(rows.start).take(rows.len()).for_each(change);
    wrong
}

/// The one finding, its cure, and the campaign that was meant.
pub fn only(campaign: &Campaign) -> (&'static str, String, Campaign) {
    let mended = mended(campaign);
    let cures: Vec<&str> = mended.found.iter().map(|finding| finding.description.observed.as_str()).collect();
    let [finding] = &mended.found[..] else { panic!("{cures:?}") };
    assert!(mended.is_changed && mended.suspicions[0].spoils_fit);
    (finding.effect.name, finding.description.observed.clone(), mended.campaign)
}

#[test]
fn joints_in_another_unit_or_sign_from_some_row_on() {
    let right = tracked(60, 7);
    let wrong = in_rows(&right, 40..60, |q| q.iter_mut().for_each(|q| *q *= DEG));
    let (effect, cure, meant) = only(&wrong);
    assert_eq!(effect, "unit_mistake");
    assert_eq!(cure, "Multiply q1_deg … q6_deg by 180/π from pose 41 to pose 60");
    let off = meant.measurements.joint_values.iter().zip(&right.measurements.joint_values);
    assert!(off.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-12);
    // and in the middle, where both ends are right
    let wrong = in_rows(&right, 25..40, |q| q[4] = -q[4]);
    let (effect, cure, meant) = only(&wrong);
    assert_eq!((effect, cure.as_str()), ("sign_mistake", "Multiply q5_deg by −1 from pose 26 to pose 40"));
    assert_eq!(meant.measurements.joint_values, right.measurements.joint_values);
}

#[test]
fn rows_displaced_from_some_row_on() {
    let right = tracked(60, 7);
    let mut wrong = right.clone();
    // the position of row 35 was recorded twice
    points(&mut wrong)[36..].copy_from_slice(&points(&mut right.clone())[35..59]);
    let (effect, cure, meant) = only(&wrong);
    assert_eq!(effect, "row_mistake");
    assert_eq!(cure, "Move x_mm, y_mm and z_mm 1 row up from pose 37 to pose 59");
    assert_eq!(meant.measurements.len(), 59);
    // a cell was left out of one column
    let wrong = (35..59).rev().fold(right.clone(), |mut wrong, row| {
        let q = &mut wrong.measurements.joint_values;
        q[6 * (row + 1) + 2] = q[6 * row + 2];
        wrong
    });
    let (effect, cure, _) = only(&wrong);
    assert_eq!(effect, "row_mistake");
    assert_eq!(cure, "Move q3_deg 1 row up from pose 37 to pose 59");
}

/// A fiftieth of a degree slips by itself: that is an event, and left to the effects.
#[test]
fn nobody_makes_a_step_of_a_fiftieth_of_a_degree() {
    let (half, fifth) = (0..29, 48..60);
    for rows in [half, fifth] {
        let by = |degrees: f64| in_rows(&tracked(60, 7), rows.clone(), |q| q[1] += degrees * DEG);
        assert_eq!(found(&by(0.022)), []);
        let place = format!("q2_deg, from pose {} to pose {}", rows.start + 1, rows.end);
        assert_eq!(found(&by(0.5)), one("offset_mistake", &place));
    }
}

#[test]
fn a_zero_that_stepped_is_no_drift_and_no_slip() {
    let wrong = in_rows(&tracked(60, 7), 38..60, |q| q[3] += 0.5 * DEG);
    let mended = mended(&wrong);
    assert_eq!(mended.found.len(), 1);
    assert_eq!(mended.found[0].effect.name, "offset_mistake");
    assert_eq!(mended.found[0].location.to_string(), "q4_deg, from pose 39 to pose 60");
    assert!((mended.found[0].estimates[0].value + 0.5).abs() < 0.005, "{:?}", mended.found[0].estimates);
}

#[test]
fn one_number_that_was_typed_wrongly() {
    let right = tracked(60, 7);
    let mut wrong = right.clone();
    let at = 6 * 22 + 1;
    let degrees = (right.measurements.joint_values[at] / DEG * 100.0).round() / 100.0;
    // files have decimals: the pose was sent to these
    let mut right = right;
    right.measurements.joint_values[at] = degrees * DEG;
    wrong.measurements.joint_values[at] = -degrees * DEG;
    let (effect, cure, meant) = only(&wrong);
    assert_eq!(effect, "typing_mistake");
    assert!(cure.ends_with(" as q2_deg of pose 23"), "{cure}");
    assert!((meant.measurements.joint_values[at] - right.measurements.joint_values[at]).abs() < 1e-9);
    // ten degrees too many, with what is carried; and no whole turn more, which brings it home too
    for too_many in [10.0, 20.0] {
        let at = 6 * 22 + 4;
        let mut right = right.clone();
        right.measurements.joint_values[at] = 99.05 * DEG;
        let angles = right.measurements.joint_values.clone();
        points(&mut right)[22] = Pose::from_xyz_rpy(BASE.0, BASE.1)
            .point(&robot(1.0, 7).flange_at(&angles[6 * 22..][..6]).point(&TOOL.into()));
        let mut wrong = right.clone();
        wrong.measurements.joint_values[at] += too_many * DEG;
        let (_, cure, meant) = only(&wrong);
        assert!(cure.contains("as q5_deg of pose 23"), "{cure}");
        assert!((meant.measurements.joint_values[at] - 99.05 * DEG).abs() < 1e-9, "{cure}");
    }
    // the point of another pose, to the last digit
    let mut wrong = right.clone();
    let other = points(&mut wrong)[30];
    points(&mut wrong)[44] = other;
    let (effect, cure, meant) = only(&wrong);
    assert_eq!((effect, cure.as_str()), ("copy_mistake", "Leave out pose 45, or measure anew"));
    assert_eq!(meant.measurements.len(), 59);
    // nobody knows what this one was
    let mut wrong = right.clone();
    points(&mut wrong)[44] += Vector3::new(0.217, -0.131, 0.089);
    assert_eq!(only(&wrong).0, "outlier");
}

#[test]
fn rows_that_stand_twice_are_left_out() {
    let right = tracked(60, 7);
    let rows: Vec<usize> = (0..60).chain(10..20).collect();
    let mut wrong = right.clone();
    wrong.measurements = right.measurements.subset(&rows);
    for (number, row) in wrong.measurements.rows.iter_mut().enumerate() {
        row.pose = (number + 1).to_string();
    }
    let (effect, cure, meant) = only(&wrong);
    assert_eq!((effect, cure.as_str()), ("copy_mistake", "Leave out pose 61 to pose 70, or measure anew"));
    assert_eq!(meant.measurements.joint_values, right.measurements.joint_values);
}

/// A clamp that stands 1 mm beside its place in the campaign pulls a base along that may move.
#[test]
fn a_clamp_beside_its_place_is_no_base_that_moved() {
    let mut wrong = tx90();
    let last = wrong.measurements.groups.len() - 1;
    let rows: Vec<usize> =
        (0..wrong.measurements.len()).filter(|&row| wrong.measurements.rows[row].group == last).collect();
    let aside = wrong.measurements.device(rows[0]).rotation * Vector3::new(MM, 0.0, 0.0);
    rows.into_iter().for_each(|row| points(&mut wrong)[row] += aside);
    assert_eq!(found(&wrong), []);
}

/// Rows in the wrong clamp scatter by centimetres: however little they count, nothing is explained.
#[test]
fn what_counts_little_is_not_explained() {
    let mut wrong = tx90();
    let rows: Vec<usize> = (0..wrong.measurements.len()).step_by(3).collect();
    wrong.measurements = wrong.measurements.subset(&rows);
    points(&mut wrong)[3] += Vector3::new(0.5, 0.2, 0.1);
    points(&mut wrong)[4] += Vector3::new(-0.3, 0.2, 0.4);
    let found =
        crate::diagnosis::calibration::diagnose_as_recorded(&wrong, Mode::Fea, &Options::default()).unwrap();
    assert!(found.is_implausible());
    assert!(found.diagnosis.discrepancy.is_some());
}

/// Sensors show what the ball does to them; the campaign asks for what they do to the ball.
#[test]
fn a_contact_force_the_other_way_round() {
    let right = tx90();
    let wrong = Campaign { contact_force: right.contact_force.map(|force| -force), ..right.clone() };
    let (effect, cure, meant) = only(&wrong);
    assert_eq!((effect, cure.as_str()), ("sign_mistake", "Multiply contact_force_n by −1"));
    assert_eq!(meant.contact_force, right.contact_force);
}

/// The same poses under the loads of another campaign, as rod and calibrated drives give way.
fn under(campaign: &Campaign, loads: &Campaign) -> Campaign {
    let options = Options::default();
    let found = crate::diagnosis::calibration::diagnose_as_recorded(campaign, Mode::Fea, &options).unwrap();
    let (before, after) = (found.predicted(campaign).unwrap(), found.predicted(loads).unwrap());
    let mut moved = campaign.clone();
    points(&mut moved).iter_mut().zip(before.iter().zip(&after)).for_each(|(x, (a, b))| *x += b - a);
    moved
}

/// Clamps that stand on one edge feel the force on the device along the vertical, and so they feel
/// what hangs on the tip: a force the other way round, or 0.78 kg.
#[test]
fn a_heavier_tip_and_a_force_the_other_way_round() {
    let force = Vector3::repeat(2.2);
    let pushed = Campaign { contact_force: Some(force), ..tx90() };
    let even = Campaign { contact_force: Some(force), ..under(&tx90(), &pushed) };
    assert_eq!(found(&even), []);
    let heavier_by = |mass: f64| {
        let mut heavier = even.clone();
        heavier.rod.as_mut().unwrap().tip_mass += mass;
        under(&even, &heavier)
    };
    let has_rival = |campaign: &Campaign| {
        let [mistake] = &mended(campaign).found[..] else { panic!("one mistake") };
        assert_eq!(mistake.effect.name, "sign_mistake");
        mistake.rivals.iter().any(|rival| rival.effect.name == "tip_mass")
    };
    // another mass is another one; nearly that one may be either
    assert_eq!(found(&heavier_by(0.9)), []);
    assert!(has_rival(&heavier_by(0.85)));
    // the other way the tip would weigh less than nothing
    assert!(!has_rival(&Campaign { contact_force: Some(-force), ..even.clone() }));
}

/// A third of the positions belong to nothing, in which the calibration still fails: what is seen
/// beside that is not sure enough to be written into a file.
#[test]
fn what_a_calibration_does_not_confirm_is_not_said() {
    let mut wrong = in_rows(&tracked(60, 7), 40..60, |q| q[4] = -q[4]);
    let mut random = Random::seeded(5, 1);
    for row in (0..60).step_by(3) {
        points(&mut wrong)[row] += Vector3::from_fn(|_, _| 0.4 * random.normal());
    }
    let mended = mended(&wrong);
    assert!(!mended.is_changed, "{:?}", mended.suspicions);
    assert!(mended.found.is_empty());
}

/// The zero of the first joint steps as the base would turn, and is said so.
#[test]
fn a_step_of_the_first_joint_may_be_the_base() {
    let mended = mended(&in_rows(&tracked(60, 7), 20..40, |q| q[0] += 2.0 * DEG));
    let [finding] = &mended.found[..] else { panic!("{:?}", mended.suspicions) };
    assert_eq!(finding.location.to_string(), "q1_deg, from pose 21 to pose 40");
    assert!(finding.rivals.iter().any(|rival| rival.effect.name == "base_shift"));
}

/// In a clamp any displacement is small: a row that is far out comes near when its numbers become
/// small, or a neighbour's, whatever happened to it.
#[test]
fn a_disturbed_row_in_a_clamp_is_no_other_unit_and_no_other_row() {
    let mut wrong = tx90();
    for (row, way) in [(20, [0.031, -0.022, 0.011]), (37, [0.004, 0.009, -0.006]), (52, [-0.02, 0.0, 0.09])] {
        points(&mut wrong)[row] += Vector3::from(way);
    }
    assert!(found(&wrong).iter().all(|(effect, _)| effect == "outlier"), "{:?}", found(&wrong));
}

/// Of two clamps one that stands beside its place looks like gravity along another axis.
#[test]
fn one_of_two_clamps_beside_its_place_is_no_other_gravity() {
    let right = tx90();
    let clamp_of = |campaign: &Campaign, row: usize| campaign.measurements.rows[row].group;
    let rows: Vec<usize> = (0..right.measurements.len()).filter(|&row| clamp_of(&right, row) < 2).collect();
    let robot_file = "tx90.toml".to_owned();
    let mut wrong = Campaign { measurements: right.measurements.subset(&rows), robot_file, ..right };
    for row in 0..wrong.measurements.len() {
        if clamp_of(&wrong, row) == 1 {
            let aside = wrong.measurements.device(row).rotation * Vector3::new(0.0, 0.0, -3.0) * MM;
            points(&mut wrong)[row] += aside;
        }
    }
    assert!(found(&wrong).iter().all(|(_, place)| place != "gravity_m_s2"), "{:?}", found(&wrong));
}

/// Of three clamps one that stands beside its place makes a part of the rows, or all that the
/// devices show, look wrong: that is left to the effects.
#[test]
fn one_of_three_clamps_beside_its_place_is_no_mistake() {
    let right = tx90();
    let clamp_of = |campaign: &Campaign, row: usize| campaign.measurements.rows[row].group;
    let rows: Vec<usize> = (0..right.measurements.len()).filter(|&row| clamp_of(&right, row) < 3).collect();
    // a robot file of one's own may have numbers in another unit, or gravity the other way round
    let robot_file = "tx90.toml".to_owned();
    let three = Campaign { measurements: right.measurements.subset(&rows), robot_file, ..right };
    // parts of the rows, parts, parts, then all of them
    for (clamp, by) in
        [(0, [0.9, 0.0, 0.0]), (0, [0.0, 1.5, 0.0]), (1, [0.4, 0.0, 0.0]), (1, [0.0, 0.9, 0.0])]
    {
        let mut wrong = three.clone();
        for row in 0..wrong.measurements.len() {
            if clamp_of(&wrong, row) == clamp {
                let aside = wrong.measurements.device(row).rotation * Vector3::from(by) * MM;
                points(&mut wrong)[row] += aside;
            }
        }
        assert_eq!(found(&wrong), [], "clamp {clamp} by {by:?}");
    }
}

/// A milliradian over a day that warms and cools: of some rows it looks like another zero.
#[test]
fn a_zero_that_drifts_with_the_temperature_is_no_mistake_of_some_rows() {
    let mut wrong = tracked(60, 7);
    let kelvin = |row: f64| 2.5 * (1.0 - (-row / 9.0).exp()) + 0.5 * (row / 7.0).sin();
    for (row, own) in wrong.measurements.rows.iter_mut().enumerate() {
        own.temperature = Some(20.0 + kelvin(row as f64));
    }
    for (row, q) in wrong.measurements.joint_values.chunks_mut(6).enumerate() {
        q[3] -= 2e-3 * (kelvin(row as f64) - 2.3);
    }
    assert_eq!(found(&wrong), []);
}

/// Clamps in blocks of the order: of two of them a turn about their line is open, and a clamp that
/// was knocked besides turns the base far away by millimetres.
#[test]
fn a_small_move_that_few_clamps_leave_open_is_left_to_the_effects() {
    let mut wrong = tx90();
    let mut order: Vec<usize> = (0..wrong.measurements.len()).collect();
    order.sort_by_key(|&row| wrong.measurements.rows[row].group);
    wrong.measurements = wrong.measurements.subset(&order);
    let count = order.len();
    let groups: Vec<usize> = wrong.measurements.rows.iter().map(|row| row.group).collect();
    for (row, point) in points(&mut wrong).iter_mut().enumerate() {
        if row >= count / 2 {
            *point += Vector3::new(0.2, -0.2, 0.15) * MM;
        }
        if groups[row] == 4 && row >= count - count / 7 {
            *point += Vector3::new(-0.3, 0.5, 0.3) * MM;
        }
    }
    assert_eq!(found(&wrong), []);
}

/// One clamp after the other: what is wrong in the middle is seen from both ends.
#[test]
fn all_signs_of_the_middle_rows() {
    let mut right = tx90();
    let mut order: Vec<usize> = (0..right.measurements.len()).collect();
    order.sort_by_key(|&row| right.measurements.rows[row].group);
    right.measurements = right.measurements.subset(&order);
    let wrong = in_rows(&right, 26..58, |q| q.iter_mut().for_each(|q| *q = -*q));
    assert_eq!(found(&wrong)[0], ("sign_mistake".into(), "q1_deg … q6_deg, from pose 27 to pose 58".into()));
}

/// A coupling that slips by a milliradian or two does so by itself; by more somebody set it anew.
#[test]
fn a_zero_that_slips_a_little_is_no_mistake() {
    for (degrees, is_mistake) in [(0.12, false), (0.4, true)] {
        let wrong = in_rows(&tx90(), 30..60, |q| q[2] -= degrees * DEG);
        let named = found(&wrong);
        let is_zero = |(effect, _): &(String, String)| effect == "offset_mistake";
        assert_eq!(named.iter().any(is_zero), is_mistake, "{degrees}: {named:?}");
    }
}
