//! Effects on the reading: each belongs to its channel.

use super::*;
use crate::inference::diagnose as infer;
use crate::units::{DEG, UM};

#[test]
fn effects_on_the_reading_belong_to_their_channel() {
    let text = "axis,load_n,trial,temperature_c,dy_um,dz_um
y,0,1,20,0,0
y,5,1,20,230,0
y,10,1,21,460,0
y,15,1,22,690,0
z,5,1,23,0,200
";
    let rod = rod("");
    let model = model(text, &rod);
    let c = compliance(&rod);
    let (y, z) = (c[(1, 1)], c[(2, 2)]);
    assert_all(&one(&model, "sensor_scale", "dy", 1.02, Axis::Y), &[0.0, 0.1 * y, 0.2 * y, 0.3 * y, 0.0]);
    assert_all(&one(&model, "sensor_scale", "dy", 1.02, Axis::Z), &[0.0; 5]);
    let (sin, cos) = (3.0 * DEG).sin_cos();
    let turned = one(&model, "sensor_misalignment", "dz towards dy", 3.0 * DEG, Axis::Z);
    let along = 5.0 * z * (cos - 1.0);
    assert_all(&turned, &[0.0, 5.0 * y * sin, 10.0 * y * sin, 15.0 * y * sin, along]);
    assert_all(
        &one(&model, "backlash", "clamp", 12.0 * UM, Axis::Y),
        &[0.0, 12.0 * UM, 12.0 * UM, 12.0 * UM, 0.0],
    );
    assert_all(&one(&model, "backlash", "clamp", 12.0 * UM, Axis::Z), &[0.0, 0.0, 0.0, 0.0, 12.0 * UM]);
    assert_all(
        &one(&model, "thermal_drift", "dz", 4.0 * UM, Axis::Z),
        &[0.0, 0.0, 4.0 * UM, 8.0 * UM, 12.0 * UM],
    );
    let anew = one(&model, "thermal_drift", "dy, since the zero of each run", 4.0 * UM, Axis::Y);
    assert_all(&anew, &[0.0, 0.0, 4.0 * UM, 8.0 * UM, 0.0]);
    let slip = one(&model, "slip", "y, trial 1, after row 2", 30.0 * UM, Axis::Y);
    assert_all(&slip, &[0.0, 0.0, 30.0 * UM, 30.0 * UM, 0.0]);
    assert_all(&one(&model, "slip", "y, trial 1, after row 2, dz", 30.0 * UM, Axis::Y), &[0.0; 5]);
    assert_eq!(model.candidates().iter().filter(|c| c.effect.name == "slip").count(), 2);
}

/// A single run that is off, the first or the last, has a zero that is off: nothing slipped.
#[test]
fn what_slips_for_good_is_two_runs_at_least_on_either_side() {
    let run = |trial: usize| format!("y,5,{trial},230\ny,10,{trial},460\n");
    let slips = |runs: usize| {
        let text = "axis,load_n,trial,dy_um\n".to_owned() + &(1..=runs).map(run).collect::<String>();
        let model = model(&text, &rod(""));
        let slips = model.candidates().iter().filter(|c| c.effect.name == "slip");
        slips.map(|c| c.location.to_string()).collect::<Vec<_>>()
    };
    assert!(slips(3).is_empty());
    assert_eq!(slips(4), ["y, trial 2, after row 4, dy, for good"]);
}

/// However slowly: what is said is how far the readings have drifted from the first of the file to
/// the last; run by run since their own zero, which was a step before.
#[test]
fn a_drift_that_settles_has_come_as_far_as_is_said() {
    let text = "axis,load_n,trial,time_s,dy_um\ny,5,1,0,230\ny,10,1,300,460\ny,5,2,600,230\ny,10,2,900,460\n";
    let model = model(text, &rod(""));
    for (pace, share) in
        [("within half of the recording", 0.56), ("over the recording, more slowly towards its end", 1.8)]
    {
        let warm =
            |time: f64| (1.0 - f64::exp(-3.0 * time / (share * 900.0))) / (1.0 - f64::exp(-3.0 / share));
        let [second, third] = [300.0, 600.0].map(|time| 40.0 * UM * warm(time));
        let of_file = one(&model, "thermal_drift", &format!("dy, {pace}"), 40.0 * UM, Axis::Y);
        assert_all(&of_file, &[0.0, second, third, 40.0 * UM]);
        let of_runs = one(
            &model,
            "thermal_drift",
            &format!("dy, {pace}, each run from its own zero"),
            40.0 * UM,
            Axis::Y,
        );
        let last = 40.0 * UM - third;
        assert_all(&of_runs, &[second, 2.0 * second, last, 2.0 * last]);
    }
}

/// A sensor that shows almost twice as much may do so, beside the shear of rod 5#, which its dy
/// follows; one that shows nearly three times as much is in another unit, or shows something else.
#[test]
fn a_sensor_has_no_scale_beyond_two() {
    let rod = rod("");
    let mut text = "axis,load_n,trial,dx_um,dy_um,dz_um\n".to_owned();
    for axis in ["x", "y", "z"] {
        for trial in 1..4 {
            for load in [5, 10, 15, 20] {
                text += &format!("{axis},{load},{trial},0,0,0\n");
            }
        }
    }
    let empty = readings(&text);
    let (base, _) = RigModel::new(&empty, Some(&rod)).unwrap();
    let may_be_scale = |shows: f64| {
        let mut random = crate::statistics::Random::seeded(2, 6);
        let mut shown = empty.clone();
        for datum in base.data() {
            let factor = if datum.channel == Axis::Y { shows } else { 1.0 };
            let value = factor * datum.predicted + UM * random.normal();
            shown.rows[datum.row - 1].offset[datum.channel.index()] = Some(value);
        }
        let (model, evidence) = RigModel::new(&shown, Some(&rod)).unwrap();
        let findings = infer(&model, &evidence).findings;
        assert!(!findings.is_empty(), "{shows}");
        findings.iter().any(|finding| {
            let rivals = finding.rivals.iter().map(|rival| rival.effect.name);
            rivals.chain([finding.effect.name]).any(|name| name == "sensor_scale")
        })
    };
    assert!(may_be_scale(1.8) && !may_be_scale(2.7));
}

/// Two axes up and down, three times; what is shown of a displacement, by the displacement before.
fn shown(compliance: &nalgebra::Matrix3<f64>, mut show: impl FnMut(f64, f64) -> f64) -> String {
    let mut text = "axis,load_n,trial,phase,dy_um,dz_um\n".to_owned();
    let mut count = 0.0f64;
    for trial in 1..=3 {
        for (axis, k) in [("y", 1), ("z", 2)] {
            let mut before = 0.0;
            for load in [2.0, 4.0, 7.0, 9.0, 12.0, 9.0, 7.0, 4.0, 2.0, 0.0] {
                let u = compliance[(k, k)] * load / UM;
                let phase = if u < before || load == 0.0 { "unload" } else { "load" };
                count += 1.0;
                // a hundredth of a step of noise, and the other channel at rest
                let (own, other) = (show(u, before) + (7.3 * count).sin(), (5.1 * count).sin());
                let (y, z) = if k == 1 { (own, other) } else { (other, own) };
                before = u;
                if load > 0.0 {
                    text += &format!("{axis},{load},{trial},{phase},{y:.2},{z:.2}\n");
                }
            }
        }
    }
    text
}

#[test]
fn play_of_the_displays_is_no_friction_and_friction_is_no_play() {
    let rod = rod("");
    let c = compliance(&rod);
    let named = |text: &str| {
        let found = crate::diagnosis::rig::diagnose(&readings(text), Some(&rod)).unwrap();
        let findings = &found.diagnosis.findings;
        assert_eq!(findings.len(), 1, "{text}");
        let size = findings[0].estimates[0].quantity();
        (findings[0].effect.name, size)
    };
    // each display stays 10 µm behind on either side
    let play = |u: f64, before: f64| if u > before { u - 10.0 } else { u + 10.0 };
    let (name, size) = named(&shown(&c, play));
    assert_eq!(name, "sensor_lag");
    assert!(size.low < 20.0 && 20.0 < size.high && size.high - size.low < 4.0, "{size:?}");
    // 0.3 N of friction: more along y, where the rod is softer
    let rubbing = |u: f64, before: f64| if u > before { -0.3 } else { 0.3 };
    let mut axis = 0;
    let friction = |u: f64, before: f64| {
        let k = 1 + axis / 10 % 2;
        axis += 1;
        u + rubbing(u, before) * c[(k, k)] / UM
    };
    assert_eq!(named(&shown(&c, friction)).0, "friction");
}

/// A run is zeroed before its first load is hung: where that was not written down, a usual step of
/// time before it was read; at its first reading, where that is of no load.
#[test]
fn a_drift_begins_where_its_run_was_zeroed() {
    let drift = |text: &str| {
        let model = model(text, &rod(""));
        one(&model, "thermal_drift", "dy, since the zero of each run", UM / 3600.0, Axis::Y)
    };
    let hour = |seconds: [f64; 4]| seconds.map(|own| own * UM / 3600.0);
    let rows = "y,5,1,100,230\ny,10,1,160,460\ny,5,2,600,230\ny,10,2,660,460\n";
    let expected = hour([60.0, 120.0, 60.0, 120.0]);
    assert_all(&drift(&format!("axis,load_n,trial,time_s,dy_um\n{rows}")), &expected);
    let zero_read = rows.replace("y,5,", "y,0,");
    let expected = hour([0.0, 60.0, 0.0, 60.0]);
    assert_all(&drift(&format!("axis,load_n,trial,time_s,dy_um\n{zero_read}")), &expected);
    let rows = "y,5,1,100,80,230\ny,10,1,160,150,460\ny,5,2,600,590,230\ny,10,2,660,650,460\n";
    let expected = hour([20.0, 80.0, 10.0, 70.0]);
    assert_all(&drift(&format!("axis,load_n,trial,time_s,loaded_at_s,dy_um\n{rows}")), &expected);
}

/// A thermometer that shows tenths has a room that warms up evenly between its steps, whatever
/// clock the runs have.
#[test]
fn temperatures_are_those_between_the_steps_of_the_display() {
    let warmed = |k: usize| 20.02 + 0.013 * k as f64;
    for (header, restarts) in [("time_s,", false), ("time_s,", true), ("", false)] {
        let mut text = format!("axis,load_n,trial,{header}temperature_c,dy_um\n");
        for k in 0..48 {
            let time = if restarts { k % 4 } else { k } * 60;
            let time = if header.is_empty() { String::new() } else { format!("{time},") };
            text += &format!("y,{},{},{time}{:.1},0\n", 3 * (1 + k % 4), 1 + k / 4, warmed(k));
        }
        let model = model(&text, &rod(""));
        for (k, datum) in model.data().iter().enumerate() {
            let off = datum.temperature.unwrap() - warmed(k);
            assert!(off.abs() < 0.02, "{header} {restarts} {k}: {off}");
        }
    }
}

/// A simulated recording of five runs up and down, of which the second has a zero that was not
/// taken, nearly as far off as the rod bends: no other run can confirm it, and it is named all the
/// same.
#[test]
fn a_zero_of_one_run_needs_no_other_run() {
    const ROD: &str = "name = \"two materials\"
[geometry]
l1_mm = 283.5
l2_mm = 134.6
gamma_deg = 149.3
[material.steel]
youngs_modulus_gpa = 204.5
shear_modulus_gpa = 79.26
density_kg_m3 = 7930
[material.carbon]
youngs_modulus_gpa = 61.2
shear_modulus_gpa = 16.6
density_kg_m3 = 1600
[pipe1]
material = \"steel\"
outer_diameter_mm = 20.3
inner_diameter_mm = 12.9
[pipe2]
material = \"carbon\"
outer_diameter_mm = 21.1
inner_diameter_mm = 16.5
[standard_uncertainty]
youngs_modulus_percent = 1.88
shear_modulus_percent = 3.76
shear_coefficient_percent = 5.64
diameter_mm = 0.05
length_mm = 0.5
";
    const RUNS: [[f64; 7]; 5] = [
        [96.0, 188.0, 334.0, 412.0, 336.0, 190.0, 94.0],
        [-282.4, -190.4, -40.4, 33.6, -42.4, -190.4, -282.4],
        [104.0, 192.0, 342.0, 416.0, 344.0, 194.0, 102.0],
        [102.0, 194.0, 338.0, 418.0, 342.0, 190.0, 100.0],
        [96.0, 190.0, 334.0, 416.0, 336.0, 190.0, 100.0],
    ];
    let steps =
        ["5.5,load", "10.6,load", "18.9,load", "23.1,load", "18.9,unload", "10.6,unload", "5.5,unload"];
    let mut text = "axis,load_n,phase,dy_um\n".to_owned();
    for (step, shown) in RUNS.iter().flat_map(|run| steps.iter().zip(run)) {
        text += &format!("y,{step},{shown}\n");
    }
    let rod = Rod::from_toml("rod", ROD).unwrap();
    let found = crate::diagnosis::rig::diagnose(&readings(&text), Some(&rod)).unwrap().diagnosis;
    let finding = &found.findings[0];
    let named = (finding.effect.name, finding.location.to_string());
    assert_eq!(named, ("offset_mistake", "dy_um, axis y, rows 8 to 14".into()));
    // 380 µm before the display rounded, and runs whose zeros scatter by 3 µm
    assert!((finding.estimates[0].value / UM + 380.4).abs() < 10.0);
}
