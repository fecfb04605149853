//! What a tracker, a camera or a measuring machine shows of places.

use super::scatter::{as_it_is, seen};
use super::*;

/// The only finding, its place, its first estimate with its interval, and how it is said; nothing
/// may be left.
fn only(place: &dyn Fn(&Vector3<f64>) -> Vector3<f64>) -> (String, [f64; 3], String) {
    let campaign = seen(&as_it_is, &|tip, _| place(tip), 21);
    let found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
    let [finding] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
    assert!(found.diagnosis.discrepancy.is_none() && finding.others().is_empty(), "{:?}", finding.rivals);
    let own = finding.estimates[0].quantity();
    let place = format!("{} {}", finding.effect.name, finding.location);
    (place, [own.low, own.value, own.high], finding.description.to_string())
}

#[test]
fn distances_that_are_all_too_long_are_the_trackers() {
    let (place, [low, value, high], said) = only(&|tip| tip.normalize() * 4.76e-3);
    assert_eq!(place, "range_offset tracker");
    assert!(low < 4760.0 && 4760.0 < high && high - low < 500.0, "{low} {value} {high}");
    let start = format!("The distances that the tracker shows are all {:.2} ± ", value / 1000.0);
    assert!(said.starts_with(&start) && said.contains(" mm too long: the zero of"), "{said}");
}

#[test]
fn axes_of_a_device_are_unequal_or_oblique() {
    let (place, [low, value, high], said) = only(&|tip| Vector3::y() * (-5e-4 * tip.y));
    assert_eq!(place, "device_axes tracker, scale along y");
    assert!(low < -500.0 && -500.0 < high && high - low < 150.0, "{low} {value} {high}");
    assert!(said.contains("the scale along y is ") && said.contains(" µm/m too small: "), "{said}");
    let (place, [low, value, high], said) = only(&|tip| Vector3::new(2.5e-4 * tip.z, 0.0, 2.5e-4 * tip.x));
    assert_eq!(place, "device_axes tracker, z and x not square");
    assert!(low < 500.0 && 500.0 < high && high - low < 150.0, "{low} {value} {high}");
    assert!(said.contains("z and x are ") && said.contains(" µrad from square: "), "{said}");
    // several at once are one finding
    let (place, _, said) = only(&|tip| Vector3::new(8e-4 * tip.x + 3e-4 * tip.y, 3e-4 * tip.x, 0.0));
    assert!(
        place.starts_with("device_axes tracker, scale along x") && place.contains("not square"),
        "{place}"
    );
    assert!(said.contains("the scale along x is ") && said.contains("x and y are "), "{said}");
}

/// Longer links show the same.
#[test]
fn a_common_scale_is_no_finding() {
    let campaign = seen(&as_it_is, &|tip, _| tip * 3e-4, 22);
    let found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
    assert!(!found.diagnosis.is_mismatch(), "{:?}", found.diagnosis.findings);
}

#[test]
fn in_the_midst_of_what_is_seen_stands_no_tracker() {
    let names = |campaign: &Campaign| {
        let calibration = calibrate(campaign, Mode::None, &Options::default()).unwrap();
        let prepared = Prepared::new(campaign, calibration).unwrap();
        let is_offset = |name: &str| name == "range_offset";
        let has = prepared.model.candidates().iter().any(|own| is_offset(own.effect.name));
        (has, prepared.not_testable.iter().any(|not| is_offset(not.effect.name)))
    };
    assert_eq!(names(&tracked(60, &|_, tip| *tip)), (false, true));
    assert_eq!(names(&seen(&as_it_is, &|_, _| Vector3::zeros(), 23)), (true, false));
}

/// Columns against places that are seen elsewhere.
#[test]
fn columns_are_what_the_device_shows() {
    let campaign = seen(&as_it_is, &|_, _| Vector3::zeros(), 24);
    let calibration = calibrate(&campaign, Mode::None, &Options::default()).unwrap();
    let context = Context::new(&campaign, &calibration).unwrap();
    type Shown = Box<dyn Fn(&Vector3<f64>) -> Vector3<f64>>;
    let cases: [(&str, &str, Shown); 4] = [
        ("range_offset", "tracker", Box::new(|tip| tip.normalize())),
        ("device_axes", "tracker, scale along z", Box::new(move |tip| Vector3::z() * tip.z)),
        (
            "device_axes",
            "tracker, y and z not square",
            Box::new(move |tip| Vector3::new(0.0, tip.z, tip.y) * 0.5),
        ),
        (
            "device_axes",
            "tracker, z and x not square",
            Box::new(move |tip| Vector3::new(tip.z, 0.0, tip.x) * 0.5),
        ),
    ];
    let all = entries(&context);
    for (effect, location, shown) in cases {
        let is_it = |entry: &&Entry| {
            entry.candidate.effect.name == effect && entry.candidate.location.to_string() == location
        };
        let entry = all.iter().find(is_it).unwrap_or_else(|| panic!("{effect} {location}"));
        let mut column = DVector::zeros(3 * campaign.measurements.len());
        entry.columns[0].add_to(&mut column, 1.0);
        for (row, there) in context.configurations.iter().enumerate() {
            let own = column.fixed_rows::<3>(3 * row).into_owned();
            assert!((own - shown(&there.tip)).norm() < 1e-12, "{effect} {location}: {own}");
        }
    }
}

/// The validation was seen by the same device.
#[test]
fn what_a_device_shows_wrongly_is_taken_out_of_the_validation_too() {
    let wrong = |tip: &Vector3<f64>| {
        tip.normalize() * 5e-3 + Vector3::y() * (6e-4 * tip.x) + Vector3::x() * (6e-4 * tip.y)
    };
    let shown = |seed: u64, place: &dyn Fn(&Vector3<f64>) -> Vector3<f64>| {
        seen(&as_it_is, &|tip, _| place(tip), seed)
    };
    let validation = Some(shown(25, &wrong).measurements);
    let campaign = Campaign { validation, ..shown(26, &wrong) };
    let mut found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
    assert_eq!(found.diagnosis.findings.len(), 2, "{:?}", found.diagnosis.findings);
    look_at_validation(&mut found).unwrap();
    let validated = found.model.validated.unwrap();
    let (before, after) = validated.means();
    assert!(before > 150.0 * UM && after.unwrap() < 60.0 * UM, "{before} {after:?}");
}
