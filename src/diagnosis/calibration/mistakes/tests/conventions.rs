//! Angles and links that are given in another way than the robot file's.

use super::*;

fn zero_and_degrees(campaign: &Campaign) -> (Vec<(String, String)>, f64) {
    let all = mended(campaign).found;
    let places = all.iter().map(|found| (found.effect.name.to_owned(), found.location.to_string()));
    (places.collect(), all.first().and_then(|found| found.estimates.first()).map_or(f64::NAN, |e| e.value))
}

/// With the zero of the file a fit in clamps ends in another minimum, and the base seemed to move.
#[test]
fn a_zero_that_is_off_by_any_angle_in_all_rows() {
    for (joint, degrees) in [(3, 30.0), (2, -47.0)] {
        for right in [tx90(), tracked(60, 7)] {
            let wrong = with_joints(&right, |q| q[joint] -= degrees * DEG);
            let (places, value) = zero_and_degrees(&wrong);
            assert_eq!(places, one("offset_mistake", &format!("q{}_deg", joint + 1)), "{degrees}");
            assert!((value - degrees).abs() < 0.5, "{value} for {degrees}");
        }
    }
}

#[test]
fn one_joint_in_parts_of_a_degree() {
    for factor in [10.0, 1000.0] {
        for right in [tx90(), tracked(60, 7)] {
            let wrong = with_joints(&right, |q| q[3] *= factor);
            let (places, value) = zero_and_degrees(&wrong);
            assert_eq!(places, one("unit_mistake", "q4_deg"), "{factor}");
            assert!((value * factor - 1.0).abs() < 1e-9, "{value}");
        }
    }
}

/// As arms show it whose third axis is driven from the foot.
#[test]
fn an_angle_that_is_counted_from_the_foot() {
    for sign in [1.0, -1.0] {
        let wrong = with_joints(&tracked(60, 7), |q| q[2] += sign * q[1]);
        let mended = mended(&wrong);
        let [found] = &mended.found[..] else { panic!("{:?}", mended.found.len()) };
        assert_eq!((found.effect.name, found.location.to_string().as_str()), ("frame_mistake", "q3_deg"));
        let right = tracked(60, 7).measurements.joint_values;
        let off = mended.campaign.measurements.joint_values.iter().zip(&right).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12);
    }
}

#[test]
fn a_number_of_a_link_that_was_typed_wrongly() {
    type Slip = fn(&mut Hayati);
    let slips: [(usize, Slip, &str, &str); 4] = [
        (3, |link| link.alpha = -link.alpha, "sign_mistake", "alpha_deg of joint 4"),
        (4, |link| link.d = -link.d, "sign_mistake", "d_mm of joint 5"),
        (1, |link| link.a *= 0.1, "typing_mistake", "a_mm of joint 2"),
        (2, |link| link.alpha += 90.0 * DEG, "typing_mistake", "alpha_deg of joint 3"),
    ];
    for (joint, slip, effect, place) in slips {
        let mut wrong = tracked(60, 7);
        slip(&mut wrong.robot.joints[joint].link);
        let mended = mended(&wrong);
        let places: Vec<_> = mended.found.iter().map(|f| (f.effect.name, f.location.to_string())).collect();
        assert_eq!(places, [(effect, place.to_owned())]);
        let numbers = |link: Hayati| [link.d, link.a, link.alpha];
        let right = numbers(tracked(60, 7).robot.joints[joint].link);
        let meant = numbers(mended.campaign.robot.joints[joint].link);
        assert!(meant.iter().zip(right).all(|(meant, right)| (meant - right).abs() < 1e-12), "{meant:?}");
    }
}

#[test]
fn a_table_in_which_links_come_before_their_joint() {
    let mut wrong = tracked(60, 7);
    for j in (0..6usize).rev() {
        let before = j.checked_sub(1).map(|before| wrong.robot.joints[before].link);
        let link = &mut wrong.robot.joints[j].link;
        (link.a, link.alpha) = before.map_or((0.0, 0.0), |before| (before.a, before.alpha));
    }
    assert_eq!(found(&wrong), one("frame_mistake", "a_mm and alpha_deg"));
}

/// Only the stated base says so, and a clamp that stands aside explains nothing of that.
#[test]
fn the_zero_of_the_first_joint_beside_a_clamp_that_stands_aside() {
    let mut wrong = with_joints(&tx90(), |q| q[0] += 180.0 * DEG);
    let clamps: Vec<usize> = wrong.measurements.rows.iter().map(|row| row.group).collect();
    for (point, clamp) in points(&mut wrong).iter_mut().zip(clamps) {
        if clamp == 1 {
            *point += Vector3::new(0.2, -0.1, 0.1) * MM;
        }
    }
    let (places, value) = zero_and_degrees(&wrong);
    assert_eq!((&places[0], value), (&one("offset_mistake", "q1_deg")[0], 180.0), "{places:?}");
}
