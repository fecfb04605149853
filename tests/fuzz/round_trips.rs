//! What is built of any numbers is refused by name, or written and read as the same.

use rodcal::calibration::Campaign;
use rodcal::calibration::campaign::FileNames;
use rodcal::rig::readings::Readings;
use rodcal::robot::{Hayati, Joint, Motion, Robot};
use rodcal::rod::Rod;
use rodcal::statistics::Random;

use super::corpus;

/// A number of any size, denormals and zeros among them.
fn any(random: &mut Random) -> f64 {
    let sign = if random.index(3) == 0 { -1.0 } else { 1.0 };
    sign * match random.index(6) {
        0 => 0.0,
        1 => f64::from_bits(1 + random.index(1 << 20) as u64),
        2 => 10f64.powf(random.uniform(-308.0, -270.0)),
        3 => 10f64.powf(random.uniform(-30.0, 25.0)),
        _ => random.uniform(0.0, 1000.0),
    }
}

/// Relative to the larger of both, for a change of unit may cost the last bit.
fn is_same(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 4.0 * f64::EPSILON * a.abs().max(b.abs()) || a.abs().max(b.abs()) < 1e-300
}

#[test]
fn rods_of_any_numbers_are_refused_or_come_back() {
    let mut random = Random::seeded(1, 0);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..2000 {
        let mut rod = Rod::from_toml("f", corpus::ROD).unwrap();
        for number in [
            &mut rod.l1,
            &mut rod.l2,
            &mut rod.tip_mass,
            &mut rod.pipe1.material.youngs_modulus,
            &mut rod.pipe1.material.density,
        ] {
            if random.index(3) == 0 {
                *number = any(&mut random);
            }
        }
        rod.masses.clear();
        rod.joints.clear();
        let Ok(rod) = rod.checked() else {
            refused += 1;
            continue;
        };
        let text = rod.to_toml(&[]);
        // larger than a file may state
        let Ok(again) = Rod::from_toml("f", &text) else {
            assert!(
                text.contains('e')
                    && rod.l1.max(rod.l2).max(rod.tip_mass).max(rod.pipe1.material.density) > 1e20,
                "{text}"
            );
            continue;
        };
        for (a, b) in [
            (rod.l1, again.l1),
            (rod.l2, again.l2),
            (rod.tip_mass, again.tip_mass),
            (rod.pipe1.material.youngs_modulus, again.pipe1.material.youngs_modulus),
        ] {
            assert!(is_same(a, b), "{a:e} came back as {b:e}\n{text}");
        }
        read += 1;
    }
    assert!(read > 300 && refused > 300, "{read} read, {refused} refused");
}

#[test]
fn robots_of_any_numbers_come_back() {
    let mut random = Random::seeded(2, 0);
    for _ in 0..300 {
        let mut any = || any(&mut random).clamp(-1e20, 1e20);
        let link = Hayati { theta: any(), d: any(), a: any(), alpha: any(), beta: any() };
        let robot = Robot::new("=a\"\u{1b}\\µ", vec![Joint::new("\u{202e}j\n", Motion::Revolute, link)]);
        let text = robot.to_toml(&["a\nb".into()]).unwrap();
        let again = Robot::from_text("f", &text, None, None).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert_eq!((&again.name, &again.joints[0].name), (&robot.name, &robot.joints[0].name));
        let back = again.joints[0].link;
        for (a, b) in [
            (link.theta, back.theta),
            (link.d, back.d),
            (link.a, back.a),
            (link.alpha, back.alpha),
            (link.beta, back.beta),
        ] {
            assert!(is_same(a, b), "{a:e} came back as {b:e}\n{text}");
        }
    }
}

#[test]
fn readings_of_any_numbers_come_back() {
    let mut random = Random::seeded(3, 0);
    for _ in 0..300 {
        let mut readings = Readings::from_text("f", corpus::READINGS).unwrap();
        for row in &mut readings.rows {
            row.offset = row.offset.map(|_| Some(any(&mut random).clamp(-1e20, 1e20)));
            row.trial = Some(["=1+1", "-a", "a,b", "\"", "'x", " "][random.index(6)].trim().to_owned())
                .filter(|t| !t.is_empty());
        }
        let text = readings.to_csv(&[]);
        let again = Readings::from_text("f", &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert_eq!(again.rows.len(), readings.rows.len());
        for (row, back) in readings.rows.iter().zip(&again.rows) {
            assert_eq!(
                (row.trial.as_deref(), row.direction),
                (back.trial.as_deref(), back.direction),
                "{text}"
            );
            let pairs = row.offset.iter().zip(&back.offset);
            assert!(pairs.clone().all(|(a, b)| is_same(a.unwrap(), b.unwrap())), "{row:?} {back:?}");
        }
    }
}

#[test]
fn a_campaign_comes_back() {
    let open = |name: &str| match name {
        "readings.csv" => Ok(corpus::READINGS.to_owned()),
        "rod.toml" => Ok(corpus::ROD.to_owned()),
        _ => Ok(corpus::POSES.to_owned()),
    };
    let campaign = Campaign::from_texts("c", corpus::CAMPAIGN, &open).unwrap();
    let mut names = FileNames::new(&campaign.robot_file, "m.csv");
    (names.rod, names.rig) = (campaign.rod_file.clone(), Some("readings.csv".into()));
    let text = campaign.to_toml(&names, &["a\nrobot = 3".into()]);
    let measurements = campaign.measurements.to_csv(&campaign.robot, &[]);
    let again = Campaign::from_texts("c", &text, &|name| match name {
        "m.csv" => Ok(measurements.clone()),
        name => open(name),
    })
    .unwrap_or_else(|e| panic!("{e}\n{text}\n{measurements}"));
    assert_eq!(again.measurements.len(), campaign.measurements.len());
    assert!(measurements.contains("'=b,"), "{measurements}");
    assert_eq!(again.measurements.to_csv(&again.robot, &[]), measurements);
}
