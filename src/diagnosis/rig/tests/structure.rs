//! Effects on the structure: joints, moduli, the bend, what follows load, time and temperature.

use approx::assert_relative_eq;

use super::*;
use crate::inference::diagnose as infer;
use crate::rod::Joint;
use crate::units::{UM, URAD_PER_NM};

#[test]
fn effects_on_the_structure_equal_the_beam_model_of_the_changed_rod() {
    let rod = rod(
        "[[joint]]\nname = \"sleeve\"\nstation_mm = 400\nbending_urad_per_nm = 10\ntorsion_urad_per_nm = 4\n",
    );
    let model = model(UP_AND_DOWN, &rod);
    let base = compliance(&rod)[(1, 1)];
    let of_changed = |changed: &Rod| {
        let more = compliance(changed)[(1, 1)] - base;
        [-5.0 * more, -20.0 * more, -5.0 * more, 0.0]
    };
    let moduli = |e: f64, g: f64| {
        let mut changed = rod.clone();
        for pipe in [&mut changed.pipe1, &mut changed.bend, &mut changed.pipe2] {
            pipe.material.youngs_modulus *= e;
            pipe.material.shear_modulus *= g;
        }
        changed
    };
    assert_all(&one(&model, "stiffness_scale", "rod", 0.8, Axis::Y), &of_changed(&moduli(0.8, 0.8)));
    assert_all(&one(&model, "shear_modulus", "rod", 0.6, Axis::Y), &of_changed(&moduli(1.0, 0.6)));
    let mut first = rod.clone();
    for pipe in [&mut first.pipe1, &mut first.bend] {
        pipe.material.youngs_modulus *= 0.8;
        pipe.material.shear_modulus *= 0.8;
    }
    let mut second = rod.clone();
    second.pipe2.material.youngs_modulus *= 1.4;
    second.pipe2.material.shear_modulus *= 1.4;
    assert_all(&one(&model, "pipe_stiffness", "pipe 1", 0.8, Axis::Y), &of_changed(&first));
    assert_all(&one(&model, "pipe_stiffness", "pipe 2", 1.4, Axis::Y), &of_changed(&second));
    let joint = |station: f64| {
        let mut changed = rod.clone();
        let name = "new".into();
        changed.joints.push(Joint {
            name,
            station,
            bending: 50.0 * URAD_PER_NM,
            torsion: 30.0 * URAD_PER_NM,
        });
        changed
    };
    let values = [50.0 * URAD_PER_NM, 30.0 * URAD_PER_NM];
    for (effect, location, station) in [
        ("joint_compliance", "station 60.0 mm", 0.06),
        ("joint_compliance", "station 100.0 mm", 0.1),
        ("root_compliance", "root", 0.0),
    ] {
        let terms = [term(&model, effect, location, &values)];
        assert_all(&response(&model, &terms, Axis::Y), &of_changed(&joint(station)));
    }
    // a load at the tip does not twist pipe II: only bending can be found there
    let mut declared = rod.clone();
    declared.joints[0].bending = 25.0 * URAD_PER_NM;
    let sleeve = find(&model, "joint_compliance", "sleeve");
    assert_eq!(model.candidates()[sleeve].parameters.len(), 1);
    assert_eq!(model.candidates()[sleeve].parameters[0].neutral, 10.0 * URAD_PER_NM);
    assert_all(
        &one(&model, "joint_compliance", "sleeve", 25.0 * URAD_PER_NM, Axis::Y),
        &of_changed(&declared),
    );
}

/// Walls of one pipe that are thinner than the file's: it is this pipe, or a connection that these
/// readings cannot tell from it.
#[test]
fn a_pipe_with_other_walls_is_found() {
    let file = Rod::from_toml("rod", include_str!("../../../../rods/5.toml")).unwrap();
    for pipe in ["pipe 1", "pipe 2"] {
        let mut actual = file.clone();
        let own = if pipe == "pipe 1" { &mut actual.pipe1 } else { &mut actual.pipe2 };
        own.section = crate::section::Round::tube(32e-3, 30.4e-3).into();
        let c = compliance(&actual) / UM;
        let mut random = crate::statistics::Random::seeded(8, 0);
        let mut text = "axis,load_n,trial,dx_um,dy_um,dz_um\n".to_owned();
        for (trial, axis) in (1..5).flat_map(|trial| (0..3).map(move |axis| (trial, axis))) {
            for load in [5.0, 10.0, 15.0, 20.0] {
                let [x, y, z] = [0, 1, 2].map(|channel| c[(channel, axis)] * load + random.normal());
                text += &format!("{},{load},{trial},{x:.1},{y:.1},{z:.1}\n", ["x", "y", "z"][axis]);
            }
        }
        let readings = Readings::from_text("f", &text).unwrap();
        let (made, evidence) = RigModel::new(&readings, Some(&file)).unwrap();
        let found = infer(&made, &evidence).findings;
        assert_eq!(found.len(), 1, "{found:#?}");
        let finding = &found[0];
        let is_pipe = |effect: &str, place: String| (effect, place.as_str()) == ("pipe_stiffness", pipe);
        if pipe == "pipe 2" && finding.effect.name == "joint_compliance" {
            let mut rivals = finding.rivals.iter();
            assert!(rivals.any(|rival| is_pipe(rival.effect.name, rival.location.to_string())));
            continue;
        }
        assert!(is_pipe(finding.effect.name, finding.location.to_string()), "{finding:#?}");
        let thinner = actual.pipe1.section.second_moment().min(actual.pipe2.section.second_moment());
        let factor = thinner / file.pipe1.section.second_moment();
        let estimate = &finding.estimates[0];
        assert!(estimate.low < factor && factor < estimate.high, "{factor} {estimate:?}");
    }
}

#[test]
fn the_bend_is_there_where_there_is_an_arc() {
    let text = ROD.replace("bend_radius_mm = 0.0 ", "bend_radius_mm = 60\nbend_flexibility = 1.2");
    let bent = Rod::from_toml("rod", &text).unwrap();
    let model_of_arc = model(UP_AND_DOWN, &bent);
    let mut softer = bent.clone();
    softer.bend_flexibility = crate::rod::BendFlexibility::Factor(3.0);
    let more = compliance(&softer)[(1, 1)] - compliance(&bent)[(1, 1)];
    let found = one(&model_of_arc, "bend_flexibility", "bend", 3.0, Axis::Y);
    assert_all(&found, &[-5.0 * more, -20.0 * more, -5.0 * more, 0.0]);
    let sharp = model(UP_AND_DOWN, &rod(""));
    assert!(sharp.candidates().iter().all(|c| c.effect.name != "bend_flexibility"));
}

#[test]
fn effects_on_the_shape_follow_load_time_and_way() {
    let rod = rod("");
    let text = UP_AND_DOWN.replace("phase,", "phase,time_s,").replace("load,0", "load,0,0");
    let rows: Vec<String> = text
        .lines()
        .enumerate()
        .map(|(k, line)| line.replace("load,0,0,0,0", &format!("load,{},0,0,0", 9 * k)))
        .collect();
    let model = model(&rows.join("\n"), &rod);
    let y = compliance(&rod)[(1, 1)];
    let square = one(&model, "nonlinear_stiffness", "rod", 1e-3, Axis::Y);
    assert_all(&square, &[-5.0 * y * 0.025, -20.0 * y * 0.4, -5.0 * y * 0.025, 0.0]);
    let linear = model.candidates().iter().position(|c| c.parameters[0].name == "per_n").unwrap();
    let linear = response(&model, &[Term { candidate: linear, values: vec![1e-2] }], Axis::Y);
    assert_all(&linear, &[-5.0 * y * 0.05, -20.0 * y * 0.2, -5.0 * y * 0.05, 0.0]);
    let creep = one(&model, "creep", "rod, since the first reading, t0 1 s", 0.03, Axis::Y);
    assert_all(&creep[..2], &[0.0, -20.0 * y * 0.03]);
    let closed = one(&model, "hysteresis", "rod", 0.02, Axis::Y);
    assert_all(&closed, &[0.0, 0.0, -5.0 * y * 0.02 * 4.0 * 0.75, 0.0]);
    let open = one(&model, "hysteresis", "rod, open at zero", 0.02, Axis::Y);
    assert_all(&open, &[0.0, 0.0, -30.0 * y * 0.02, -40.0 * y * 0.02]);
}

/// Ten kelvins between the runs: each deflects by its own temperature, about the mean of all.
#[test]
fn a_warm_rod_is_softer_and_is_found_so() {
    let file = rod("");
    let (per_kelvin, slope) = (2e-3, compliance(&file)[(1, 1)]);
    let mut text = "axis,load_n,trial,temperature_c,dy_um\n".to_owned();
    let mut random = crate::statistics::Random::seeded(5, 0);
    for trial in 0..8 {
        let temperature = 20.0 + 10.0 * f64::from(trial % 2);
        for load in [5.0, 10.0, 15.0, 20.0] {
            let softer = 1.0 + per_kelvin * (temperature - 25.0);
            let shown = slope * load * softer / UM + random.normal();
            text += &format!("y,{load},{trial},{temperature},{shown:.1}\n");
        }
    }
    let (made, evidence) = RigModel::new(&readings(&text), Some(&file)).unwrap();
    let change = one(&made, "thermal_softening", "rod", per_kelvin, Axis::Y);
    for (datum, change) in made.data().iter().zip(&change) {
        let kelvins = if datum.temperature == Some(30.0) { 5.0 } else { -5.0 };
        assert_relative_eq!(*change, per_kelvin * kelvins * datum.predicted, max_relative = 1e-12);
    }
    let found = infer(&made, &evidence).findings;
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0].effect.name, "thermal_softening");
    let found = found[0].quantity("per_k").unwrap();
    assert!(found.low < per_kelvin && per_kelvin < found.high && found.high - found.low < 1e-3, "{found:?}");
}
