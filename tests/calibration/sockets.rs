//! Sockets: nothing but joint angles, weights, and a plate with two holes that was put down four
//! times.

use nalgebra::{Isometry3, Vector3};
use rodcal::calibration::campaign::Targets;
use rodcal::calibration::{Calibration, Campaign, Mode, Options, calibrate};
use rodcal::diagnosis::calibration::{Mended, Neighbours, mend};

use super::arms::{self, SEVEN};
use super::lab::{Dice, Lab, read};
use super::recovery::{named, spoil, worst_error};

/// Between the two sockets of the plate, m.
const DISTANCE: f64 = 0.05;
/// Gravity has no torque on the first joint, and the masses of the last two lie on their axes.
const RHO: &str = "a1 alpha1 theta2 d2 a2 alpha2 c2 theta3 d3 a3 alpha3 c3 theta4 d4 a4 alpha4 c4 theta5 d5 a5 alpha5 c5 \
                   theta6 d6 a6 alpha6 theta7 tool_x tool_z";
/// Where the plate was put down, m.
const PLACES: [[f64; 3]; 4] = [[0.45, 0.1, 0.3], [0.3, -0.45, 0.4], [-0.35, 0.4, 0.6], [0.5, 0.3, 0.8]];

/// A robot of seven joints with its ball in each socket 12 times.
fn recorded() -> (Lab, String) {
    let mut dice = Dice(29);
    let mut lab = Lab::new(arms::robot(SEVEN), Isometry3::identity(), Vector3::zeros());
    spoil(&mut lab, &named(RHO, 7), &mut dice);
    let mut csv = format!("pose,placement,socket{}\n", lab.header());
    let mut pose = 0;
    for (placement, middle) in PLACES.into_iter().enumerate() {
        let along = dice.vector(1.0).normalize() * (DISTANCE / 2.0);
        for (socket, side) in [1.0, -1.0].into_iter().enumerate() {
            let target = Vector3::from(middle) + along * side;
            let mut found = 0;
            while found < 12 {
                let start = lab.anywhere(&mut dice);
                let Some(q) = lab.reach(&target, &start) else { continue };
                csv += &format!("{pose},{placement},{socket}{}\n", lab.cells(&q));
                found += 1;
                pose += 1;
            }
        }
    }
    (lab, csv)
}

fn campaign(csv: &str) -> Campaign {
    apart(50.0, csv)
}

/// The campaign with a distance of the sockets, mm.
fn apart(distance: f64, csv: &str) -> Campaign {
    let text =
        format!("robot = \"robot.urdf\"\nmeasurements = \"m.csv\"\n[sockets]\ndistance_mm = {distance}\n");
    read(&[("campaign.toml", &text), ("robot.urdf", SEVEN), ("m.csv", csv)])
}

/// Mistakes and where they are.
fn mistakes(campaign: &Campaign) -> (Mended, Vec<(String, String)>) {
    let mended = mend(campaign, Mode::None, &Neighbours::default(), &Options::default()).unwrap();
    let named =
        |finding: &rodcal::inference::Finding| (finding.effect.name.to_owned(), finding.location.to_string());
    let found = mended.found.iter().map(named).collect();
    (mended, found)
}

fn one(effect: &str, location: &str) -> Vec<(String, String)> {
    vec![(effect.to_owned(), location.to_owned())]
}

fn calibrated(campaign: &Campaign) -> Calibration<'_> {
    let found =
        calibrate(campaign, Mode::None, &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert!(found.is_converged, "{} {:?}", found.fit.reason, found.passes);
    found
}

#[test]
fn sockets_give_the_truth_back() {
    let (lab, csv) = recorded();
    let campaign = campaign(&csv);
    let found = calibrated(&campaign);
    let mut free: Vec<String> = found.parameters.iter().map(|p| p.parameter.to_string()).collect();
    let mut rho: Vec<String> = named(RHO, 7).iter().map(ToString::to_string).collect();
    free.sort();
    rho.sort();
    assert_eq!(free, rho);
    assert!(found.held.is_empty());
    // how large the robot is, the drawing knows as well as the distance does: within what both
    // leave uncertain
    let (error, name) = worst_error(&lab, &found);
    let own = found.parameters.iter().find(|p| p.parameter.to_string() == name);
    let sd = own.and_then(|p| p.std_error).unwrap();
    assert!(error < sd, "{name} is off by {error:e} of {sd:e}");
    // the sockets are where they were, too
    for (socket, at) in found.sockets.chunks(2).zip(PLACES) {
        let middle = |axis: usize| (socket[0][axis].0 + socket[1][axis].0) / 2.0;
        for (axis, &truth) in at.iter().enumerate() {
            let sd = socket[0][axis].1.unwrap();
            assert!((middle(axis) - truth).abs() < sd, "{} {truth} {sd:e}", middle(axis));
        }
    }
}

/// One socket of each placement: nothing tells a robot from one twice as large, and the user is
/// told so.
#[test]
fn without_a_distance_the_size_of_the_robot_is_unknown() {
    let (_, csv) = recorded();
    let one_of_each = |line: &&str| line.split(',').nth(2).is_none_or(|socket| socket != "1");
    let rows: Vec<String> = csv.lines().filter(one_of_each).map(|line| format!("{line}\n")).collect();
    let campaign = campaign(&rows.concat());
    assert!(!campaign.warnings.is_empty());
    let words = campaign.warnings[0].to_string();
    assert!(words.contains("distance"), "{words}");
    let found = calibrated(&campaign);
    assert_eq!(found.held.len(), 1);
    // a change of all lengths in proportion
    let held = &found.held[0];
    let changes: Vec<f64> = held.direction.iter().zip(&held.ranges).map(|(v, range)| v * range).collect();
    let index = |name: &str| found.parameters.iter().position(|p| p.parameter.to_string() == name).unwrap();
    let ratio = changes[index("d3")] / changes[index("d5")];
    let expected = found.setup.links[2].d / found.setup.links[4].d;
    assert!((ratio / expected - 1.0).abs() < 0.02, "{ratio} {expected}");
    for name in ["d3", "d5"] {
        assert!(!found.parameters[index(name)].identifiable, "{name}");
    }
    assert!(found.parameters[index("theta4")].identifiable);
    assert!(held.relative_error > 100.0, "{}", held.relative_error);
}

#[test]
fn a_distance_of_the_sockets_in_another_unit_is_a_mistake_and_the_right_one_is_none() {
    let (_, csv) = recorded();
    assert_eq!(mistakes(&campaign(&csv)).1, []);
    for (stated, factor) in [(5.0, 10.0), (0.05, 1000.0), (1.9685, 25.4)] {
        let (mended, found) = mistakes(&apart(stated, &csv));
        assert_eq!(found, one("unit_mistake", "sockets.distance_mm"), "{stated} mm");
        assert_eq!(mended.found[0].estimates[0].value, factor);
        let Targets::Sockets(distances) = &mended.campaign.measurements.targets else { panic!("sockets") };
        assert!(distances.iter().all(|own| (own.value - DISTANCE).abs() < 1e-5), "{distances:?}");
    }
}

#[test]
fn another_distance_of_the_sockets_is_named_with_the_one_that_drawing_and_angles_say() {
    let (_, csv) = recorded();
    let (mended, found) = mistakes(&apart(45.0, &csv));
    assert_eq!(found, one("distance_mistake", "sockets.distance_mm"));
    let mm = &mended.found[0].estimates[0];
    assert!(mm.low < 50.0 && 50.0 < mm.high && mm.high - mm.low < 1.5, "{mm:?}");
    // within what the drawing leaves open nothing is said
    assert_eq!(mistakes(&apart(49.8, &csv)).1, []);
}

#[test]
fn names_of_sockets_a_row_away_from_their_angles_are_rows_displaced() {
    let (_, csv) = recorded();
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.splitn(4, ',').collect()).collect();
    for by in [1usize, 2] {
        let mut displaced = csv.lines().next().unwrap().to_owned() + "\n";
        for (pose, cells) in rows[1..].iter().enumerate().skip(by) {
            let named = &rows[1 + pose - by];
            displaced += &format!("{},{},{},{}\n", cells[0], named[1], named[2], cells[3]);
        }
        let (mended, found) = mistakes(&campaign(&displaced));
        assert_eq!(found, one("row_mistake", "placement, socket"), "by {by}");
        assert_eq!(mended.found[0].estimates[0].value, by as f64);
    }
}
