//! Campaigns that name another rod of the folder, as long as the one that was on the robot.

use super::*;
use crate::diagnosis::Limitation;
use crate::inference::Finding;

/// The rod of [`ROD`] of aluminium.
fn of_aluminium() -> String {
    with([("gpa = 193.0", "gpa = 70.0"), ("ratio = 0.29", "ratio = 0.33"), ("m3 = 7930.0", "m3 = 2700.0")])
}

fn with<const N: usize>(keys: [(&str, &str); N]) -> String {
    let other = keys.iter().fold(ROD.to_owned(), |text, (old, new)| text.replace(old, new));
    assert!(keys.iter().all(|(_, key)| other.contains(key)));
    other
}

/// What is said of a campaign that was recorded with `actual` and has the file `stated`, in whose
/// folder there is `other`: findings with their rivals, and which rods these poses cannot
/// distinguish.
fn said(actual: &str, stated: &str, other: &str, noise: f64) -> (Vec<Finding>, Vec<Limitation>) {
    let plan = Plan { poses_per_clamp: 20, sensor_noise: 0.0, repeatability: 0.0, ..Plan::default() };
    let campaign = with_rods(actual, stated, plan);
    let campaign = recorded(&campaign, &|_| Vector3::zeros(), noise, 4);
    let rods = vec![("other.toml".to_owned(), Rod::from_toml("other", other).unwrap())];
    let neighbours = Neighbours { rods, ..Neighbours::default() };
    assert!(suspected(&campaign, Mode::Fea, &neighbours).unwrap().is_empty());
    let mended = mend(&campaign, Mode::Fea, &neighbours, &Options::default()).unwrap();
    let found = mended.diagnose().unwrap();
    let is_of_rod = |limit: &&Limitation| matches!(limit, Limitation::AnotherRod(..));
    (found.diagnosis.findings.clone(), found.limits.iter().filter(is_of_rod).cloned().collect())
}

fn names(findings: &[Finding]) -> Vec<String> {
    findings.iter().map(|own| format!("{} {}", own.effect, own.location)).collect()
}

#[test]
fn a_rod_of_another_material_is_meant_where_the_poses_tell() {
    // the search for mistakes alone sees nothing of it beside so much noise
    let other = of_aluminium();
    let (found, open) = said(&other, ROD, &other, 200.0 * UM);
    assert_eq!((names(&found), open), (vec!["rod_mistake other.toml".to_owned()], vec![]));
    assert_eq!(found[0].description.observed, "Write rod = \"other.toml\"");
    // nothing where it was the stated one
    let (found, open) = said(ROD, ROD, &other, 30.0 * UM);
    assert_eq!((names(&found), open), (vec![], vec![]));
}

#[test]
fn a_rod_that_the_poses_do_not_tell_is_said() {
    let softer = with([("gpa = 193.0", "gpa = 160.0")]);
    for stated in [ROD, &softer] {
        let other = if stated == ROD { &softer } else { ROD };
        let (found, open) = said(ROD, stated, other, 40.0 * UM);
        assert_eq!(names(&found), Vec::<String>::new());
        assert!(matches!(&open[..], [Limitation::AnotherRod(file, _)] if file == "other.toml"), "{open:?}");
    }
}
