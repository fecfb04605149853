//! Displacement sensors of clamps that show too much, something of another axis, or no straight
//! line; and what is none of them.

use nalgebra::{Matrix3, Rotation3, Unit};

use super::*;
use crate::inference::Finding;

/// A coordinate's noise, m: displacements are some 0.1 mm.
const NOISE: f64 = 5.0 * UM;

/// The campaign as a device shows it, which makes `shown` of the true displacement in its frame.
fn shown(campaign: &Campaign, shown: &dyn Fn(Vector3<f64>) -> Vector3<f64>, seed: u64) -> Campaign {
    let recording = &campaign.measurements;
    let Targets::Points(points) = &recording.targets else { panic!("no points") };
    let by = |row: usize| {
        let device = recording.device(row);
        let true_one = device.inverse().point(&points[row]);
        device.rotation * (shown(true_one) - true_one)
    };
    recorded(campaign, &by, NOISE, seed)
}

/// The campaign with more noise.
fn noisy(campaign: &Campaign, noise: f64, seed: u64) -> Campaign {
    recorded(campaign, &|_| Vector3::zeros(), noise, 100 + seed)
}

fn diagnosed(campaign: &Campaign) -> (Vec<Finding>, Option<String>) {
    let found = diagnose_as_recorded(campaign, Mode::Fea, &Options::default()).unwrap();
    let left = found.diagnosis.discrepancy.and_then(|left| left.location);
    (found.diagnosis.findings, left.map(|location| location.to_string()))
}

fn assert_number(finding: &Finding, name: &str, expected: f64) {
    let number = finding.estimates.iter().find(|estimate| estimate.name == name).unwrap();
    // 95 % intervals, widened to what three standard deviations are
    let half = 0.75 * (number.high - number.low);
    assert!((number.value - expected).abs() < half, "{name}: {} of {expected}, ± {half}", number.value);
    assert!(half < 0.02, "{name}: ± {half}");
}

#[test]
fn a_sensor_that_shows_too_much_is_named_with_its_axis_and_factor() {
    let campaign = clamps(30);
    for (axis, name, factor) in [(1, "y", 1.15), (2, "z", 0.88)] {
        let matrix = Matrix3::from_diagonal(&Vector3::from_fn(|k, _| if k == axis { factor } else { 1.0 }));
        let wrong = shown(&campaign, &|u| matrix * u, 3 + axis as u64);
        let (findings, left) = diagnosed(&wrong);
        assert_eq!((findings.len(), &left), (1, &None), "{left:?}");
        assert_eq!(findings[0].effect.name, "sensor_scale");
        assert_eq!(findings[0].location.to_string(), format!("all clamps, axis {name}"));
        assert_number(&findings[0], "factor", factor);
        let word = if factor > 1.0 { "% too high" } else { "% too low" };
        assert!(findings[0].description.observed.ends_with(word), "{}", findings[0].description.observed);
    }
}

/// A column of what was recorded would have its error in common with the residual, and show
/// ε²/(u² + ε²) of it as a scale: 3 % here.
#[test]
fn the_error_of_a_reading_is_no_scale() {
    let campaign = clamps(100);
    let named_of = |factor: f64, seed: u64| {
        let matrix = Matrix3::from_diagonal(&Vector3::new(1.0, factor, 1.0));
        diagnosed(&noisy(&shown(&campaign, &|u| matrix * u, seed), 16.0 * UM, seed)).0
    };
    assert!(named_of(1.0, 1).is_empty());
    let findings = named_of(1.2, 2);
    assert_eq!((findings.len(), findings[0].effect.name), (1, "sensor_scale"));
    assert_number(&findings[0], "factor", 1.2);
}

/// Half way between the two is right where half of the scatter is the readings'. Where all of it
/// is, what is left of their error in the column is a number of its own, or it would be a scale or
/// a spring.
#[test]
fn scatter_that_is_all_of_the_readings_is_no_scale() {
    let campaign = clamps(200);
    let findings = diagnosed(&noisy(&campaign, 34.0 * UM, 1)).0;
    let names = findings.iter().map(|finding| format!("{} {}", finding.effect, finding.location));
    assert_eq!(names.collect::<Vec<_>>(), [""; 0]);
}

/// Neither is that of a joint, which a column of what was predicted would have in common with it.
#[test]
fn the_error_of_an_angle_is_no_scale() {
    for step in [0.01, 0.1] {
        let mut campaign = recorded(&clamps(30), &|_| Vector3::zeros(), NOISE, 1);
        campaign.measurements.joint_values.iter_mut().for_each(|q| {
            *q = (q.to_degrees() / step).round() * f64::to_radians(step);
        });
        let names: Vec<&str> = diagnosed(&campaign).0.iter().map(|finding| finding.effect.name).collect();
        assert!(names.is_empty(), "{step}: {names:?}");
    }
}

#[test]
fn cross_talk_is_named_with_its_axes_and_taken_out_of_the_points() {
    let campaign = clamps(30);
    let mut matrix = Matrix3::identity();
    matrix[(0, 1)] = 0.12;
    let wrong = shown(&campaign, &|u| matrix * u, 5);
    let found = diagnose_as_recorded(&wrong, Mode::Fea, &Options::default()).unwrap();
    let finding = &found.diagnosis.findings[0];
    assert_eq!(found.diagnosis.findings.len(), 1);
    let place = finding.location.to_string();
    assert_eq!((finding.effect.name, place.as_str()), ("sensor_scale", "all clamps, y into x"));
    assert_number(finding, "x_per_y", 0.12);
    let observed = &finding.description.observed;
    assert!(observed.contains("along x also shows") && observed.contains("along y"), "{observed}");
    let mut extended = wrong.clone();
    let record = registry::record(finding.effect).unwrap();
    (record.write)(finding, &found.model, &mut extended);
    let right = shown(&campaign, &|u| u, 5);
    let points = |campaign: &Campaign| match &campaign.measurements.targets {
        Targets::Points(points) => points.clone(),
        Targets::Sockets(_) => Vec::new(),
    };
    let off = |one: &Campaign| -> f64 {
        points(one).iter().zip(points(&right)).map(|(one, right)| (one - right).norm_squared()).sum()
    };
    assert!(off(&extended) < 0.05 * off(&wrong), "{} of {}", off(&extended), off(&wrong));
}

#[test]
fn a_device_that_stands_turned_has_all_nine() {
    let turned = Rotation3::from_axis_angle(&Unit::new_normalize(Vector3::new(0.5, 1.0, -0.7)), 0.2);
    let wrong = shown(&clamps(30), &|u| turned * u, 5);
    let found = diagnose_as_recorded(&wrong, Mode::Fea, &Options::default()).unwrap();
    let finding = &found.diagnosis.findings[0];
    assert_eq!((finding.effect.name, finding.location.to_string()), ("sensor_scale", "all clamps".into()));
    assert_number(finding, "x_per_y", turned.matrix()[(0, 1)]);
    assert_number(finding, "y_per_y", turned.matrix()[(1, 1)]);
    let observed = &finding.description.observed;
    assert!(observed.contains("the largest of their nine errors"), "{observed}");
}

#[test]
fn what_shows_three_times_too_much_is_no_error_of_a_scale() {
    let matrix = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 3.0));
    let (findings, left) = diagnosed(&shown(&clamps(30), &|u| matrix * u, 5));
    assert!(findings.iter().all(|finding| finding.effect.name != "sensor_scale"));
    assert!(!findings.is_empty() || left.is_some());
}

#[test]
fn a_spring_of_the_device_is_no_scale_of_its_sensors() {
    let campaign = clamps(30);
    let (model, _) = modelled(&campaign, Mode::Fea);
    let index = find(&model, "contact_spring", "all clamps");
    let mut term = model.candidates()[index].neutral(index);
    term.values[0] = 250.0;
    let bent = model.response(&[term]);
    let sprung = recorded(&campaign, &|row| bent.fixed_rows::<3>(3 * row).into(), NOISE, 7);
    let (findings, left) = diagnosed(&sprung);
    let names: Vec<String> = findings.iter().map(|f| format!("{} {}", f.effect, f.location)).collect();
    assert_eq!((names, left), (vec!["contact_spring all clamps".to_owned()], None));
}

#[test]
fn a_sensor_that_is_not_linear_is_said_to_follow_its_displacement() {
    let campaign = clamps(30);
    let bent = |mut u: Vector3<f64>| {
        u.y += 30.0 * UM * (u.y / (40.0 * UM)).sin();
        u
    };
    let (_, left) = diagnosed(&shown(&campaign, &bent, 8));
    assert_eq!(left.as_deref(), Some("displacement along y of the clamps, a curve"));
}

/// A wave many times within the range, along another axis than the one that it follows.
#[test]
fn a_fine_error_of_a_sensor_is_said_to_follow_the_displacement() {
    let campaign = clamps(30);
    let bent = |mut u: Vector3<f64>| {
        u.x += 40.0 * UM * (u.z / (12.0 * UM)).sin();
        u
    };
    let (findings, left) = diagnosed(&shown(&campaign, &bent, 8));
    let left = left.unwrap_or_default();
    assert!(findings.is_empty() && left.starts_with("displacement along z of the clamps, "), "{left}");
}

#[test]
fn cross_talk_of_one_clamp_is_named_with_its_axes() {
    let campaign = clamps(30);
    let recording = &campaign.measurements;
    let Targets::Points(points) = &recording.targets else { panic!("no points") };
    let by = |row: usize| {
        let device = recording.device(row);
        let along_y = device.inverse().point(&points[row]).y;
        match recording.groups[recording.rows[row].group].name.to_string() == "clamp 4" {
            true => device.rotation.column(0) * (0.25 * along_y),
            false => Vector3::zeros(),
        }
    };
    let (findings, left) = diagnosed(&recorded(&campaign, &by, 0.5 * NOISE, 4));
    assert_eq!((findings.len(), &left), (1, &None), "{left:?}");
    assert_eq!(findings[0].effect.name, "sensor_scale");
    assert_eq!(findings[0].location.to_string(), "clamp 4, y into x");
    assert_number(&findings[0], "x_per_y", 0.25);
    let observed = &findings[0].description.observed;
    assert!(observed.contains("along x also shows") && observed.contains("along y"), "{observed}");
}

/// A guide of one clamp that is worn: what is shown along x has a curve of the displacement along
/// z, which is no place of the clamp and no scatter of its own.
#[test]
fn a_curve_of_one_clamp_across_its_axes_is_seen() {
    let campaign = clamps(30);
    let groups = &campaign.measurements.groups;
    let is_there = |row: usize| groups[campaign.measurements.rows[row].group].name.to_string() == "clamp 2";
    let Targets::Points(points) = &campaign.measurements.targets else { panic!("no points") };
    let by = |row: usize| {
        let device = campaign.measurements.device(row);
        let along: Vector3<f64> = device.rotation.column(0).into();
        let shown = device.inverse().point(&points[row]).z.abs();
        if is_there(row) { along * (0.6 * shown) } else { Vector3::zeros() }
    };
    let (findings, left) = diagnosed(&recorded(&campaign, &by, NOISE, 21));
    let names: Vec<&str> = findings.iter().map(|finding| finding.effect.name).collect();
    let place = "displacement along z at clamp 2, a curve along x".to_owned();
    assert_eq!((names, left), (vec![], Some(place)));
}
