//! Sign and size of every effect against a hand computation on rod 5#, and files of all kinds.

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};

use super::diagnose::MOST_ROWS;
use super::*;
use crate::beam::{Physics, RodModel};
use crate::inference::{Candidate, DERIVATIVE_STEP, ForwardModel, Term, diagnose as infer};
use crate::rig::readings::{Axis, Readings};
use crate::rod::{Joint, Rod};
use crate::units::{DEG, UM, URAD_PER_NM};

const ROD: &str = include_str!("../../../rods/5.toml");

fn rod(more: &str) -> Rod {
    Rod::from_toml("rod", &(ROD.to_owned() + more)).unwrap()
}

fn readings(text: &str) -> Readings {
    Readings::from_text("f", text).unwrap()
}

fn model(text: &str, rod: &Rod) -> RigModel {
    RigModel::new(&readings(text), Some(rod)).unwrap().0
}

/// Two rows up and two down along −y, read in all channels; the readings are zero.
const UP_AND_DOWN: &str = "axis,load_n,phase,dx_um,dy_um,dz_um
-y,5,load,0,0,0
-y,20,load,0,0,0
-y,5,unload,0,0,0
-y,0,unload,0,0,0
";

/// Displacement at the tip per force at the tip, m/N.
fn compliance(rod: &Rod) -> nalgebra::Matrix3<f64> {
    let model = RodModel::new(rod, &Physics::default(), 1, &[]).unwrap();
    model.force_response(rod.length(), rod.length()).unwrap().translation
}

fn find(model: &RigModel, effect: &str, location: &str) -> usize {
    let is_it = |c: &Candidate| c.effect.name == effect && c.location.to_string() == location;
    model.candidates().iter().position(is_it).unwrap_or_else(|| {
        let of: Vec<_> = model.candidates().iter().filter(|c| c.effect.name == effect).collect();
        panic!("no {effect} at {location}: {of:#?}")
    })
}

fn term(model: &RigModel, effect: &str, location: &str, values: &[f64]) -> Term {
    Term { candidate: find(model, effect, location), values: values.to_vec() }
}

/// Change of the readings of one channel, m.
fn response(model: &RigModel, terms: &[Term], channel: Axis) -> Vec<f64> {
    let change = model.response(terms);
    model.data().iter().zip(change.iter()).filter(|(d, _)| d.channel == channel).map(|(_, c)| *c).collect()
}

fn one(model: &RigModel, effect: &str, location: &str, value: f64, channel: Axis) -> Vec<f64> {
    response(model, &[term(model, effect, location, &[value])], channel)
}

fn assert_all(found: &[f64], expected: &[f64]) {
    let scale = expected.iter().fold(1e-9, |s: f64, e| s.max(e.abs()));
    assert_eq!(found.len(), expected.len());
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() <= 1e-9 * scale, "{found:?} is not {expected:?}");
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

#[test]
fn the_base_prediction_is_the_beam_model() {
    let rod = rod("");
    let (model, evidence) = RigModel::new(&readings(UP_AND_DOWN), Some(&rod)).unwrap();
    let c = compliance(&rod)[(1, 1)];
    let y: Vec<f64> = model.data().iter().filter(|d| d.channel == Axis::Y).map(|d| d.predicted).collect();
    assert_all(&y, &[-5.0 * c, -20.0 * c, -5.0 * c, 0.0]);
    assert_eq!(evidence.residual[1], -model.data()[1].predicted);
    assert_eq!(evidence.nuisance.ncols(), 0);
    assert_relative_eq!(c, 45.6 * UM, max_relative = 0.02);
}

#[test]
fn effects_on_the_load_have_the_sign_and_size_of_a_hand_computation() {
    let rod = rod("");
    let model = model(UP_AND_DOWN, &rod);
    let c = compliance(&rod);
    let y = c[(1, 1)];
    // along −y the offsets are negative: less load is a positive change
    assert_all(&one(&model, "friction", "slide", 1.0, Axis::Y), &[y, y, -y, -y]);
    assert_all(&one(&model, "friction", "slide", 7.0, Axis::Y), &[5.0 * y, 7.0 * y, -7.0 * y, -7.0 * y]);
    assert_all(&one(&model, "load_offset", "hanger", 2.0, Axis::Y), &[-2.0 * y, -2.0 * y, -2.0 * y, 0.0]);
    let (sin, cos) = (2.0 * DEG).sin_cos();
    let turned = |load: f64| -load * sin * c[(2, 2)];
    let z = one(&model, "load_misalignment", "y towards z", 2.0 * DEG, Axis::Z);
    assert_all(&z, &[turned(5.0), turned(20.0), turned(5.0), 0.0]);
    let along = one(&model, "load_misalignment", "y towards z", 2.0 * DEG, Axis::Y);
    assert_relative_eq!(along[1], -20.0 * y * (cos - 1.0), max_relative = 1e-9);
}

#[test]
fn effects_on_the_structure_equal_the_beam_model_of_the_changed_rod() {
    let rod = rod(
        "[[joint]]\nname = \"sleeve\"\nstation_mm = 400\nbending_urad_per_nm = 10\ntorsion_urad_per_nm = 4\n",
    );
    let model = model(UP_AND_DOWN, &rod);
    let base = compliance(&rod)[(1, 1)];
    let of = |changed: &Rod| {
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
    assert_all(&one(&model, "stiffness_scale", "rod", 0.8, Axis::Y), &of(&moduli(0.8, 0.8)));
    assert_all(&one(&model, "shear_modulus", "rod", 0.6, Axis::Y), &of(&moduli(1.0, 0.6)));
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
        assert_all(&response(&model, &terms, Axis::Y), &of(&joint(station)));
    }
    // a load at the tip does not twist pipe II: only bending can be found there
    let mut declared = rod.clone();
    declared.joints[0].bending = 25.0 * URAD_PER_NM;
    let sleeve = find(&model, "joint_compliance", "sleeve");
    assert_eq!(model.candidates()[sleeve].parameters.len(), 1);
    assert_eq!(model.candidates()[sleeve].parameters[0].neutral, 10.0 * URAD_PER_NM);
    assert_all(&one(&model, "joint_compliance", "sleeve", 25.0 * URAD_PER_NM, Axis::Y), &of(&declared));
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

#[test]
fn effects_combine_as_on_the_bench() {
    let rod = rod("");
    let model = model(UP_AND_DOWN, &rod);
    let y = compliance(&rod)[(1, 1)];
    let terms = [
        term(&model, "sensor_scale", "dy", &[1.1]),
        term(&model, "stiffness_scale", "rod", &[0.5]),
        term(&model, "friction", "slide", &[1.0]),
    ];
    let reads = |force: f64| -force * y / 0.5 * 1.1;
    let expected = [reads(4.0) + 5.0 * y, reads(19.0) + 20.0 * y, reads(6.0) + 5.0 * y, reads(1.0)];
    assert_all(&response(&model, &terms, Axis::Y), &expected);
}

/// Everything that a file can have.
fn full(trials: usize) -> String {
    let mut text = "axis,load_n,trial,phase,time_s,temperature_c,dx_um,dy_um,dz_um\n".to_owned();
    let mut time = 0;
    for axis in ["x", "-y", "z"] {
        for trial in 0..trials {
            for (load, phase) in [(5, "load"), (10, "load"), (15, "load"), (10, "unload"), (0, "unload")] {
                time += 30 + load;
                let celsius = 20.0 + (time as f64 / 500.0).sin();
                let (dx, dy, dz) = (load * 7, -load * 45, load * 39);
                text += &format!("{axis},{load},{trial},{phase},{time},{celsius},{dx},{dy},{dz}\n");
            }
        }
    }
    text
}

#[test]
fn neutral_values_change_nothing_and_typical_ones_something() {
    let text = ROD.replace("bend_radius_mm = 0.0 ", "bend_radius_mm = 60");
    let rod = Rod::from_toml("rod", &text).unwrap();
    for rod in [Some(&rod), None] {
        let model = RigModel::new(&readings(&full(3)), rod).unwrap().0;
        for (index, candidate) in model.candidates().iter().enumerate() {
            let neutral = candidate.neutral(index);
            assert_eq!(model.response(std::slice::from_ref(&neutral)).amax(), 0.0, "{candidate:?}");
            let values = candidate.parameters.iter().map(|p| p.neutral + p.size).collect();
            let change = model.response(&[Term { candidate: index, values }]);
            assert!(change.amax() > 0.0 && change.iter().all(|c| c.is_finite()), "{candidate:?}");
            for p in &candidate.parameters {
                assert!(p.size > 0.0 && p.size.is_finite() && p.unit > 0.0, "{candidate:?}");
                assert!(p.bounds.0 <= p.neutral && p.neutral + p.size <= p.bounds.1, "{candidate:?}");
            }
        }
    }
}

/// The engine's derivatives beside friction, a memory and a shift, evaluated by cases, against
/// differences of whole responses.
#[test]
fn derivatives_are_those_of_the_responses() {
    let rod = rod("");
    for rod in [Some(&rod), None] {
        let model = RigModel::new(&readings(&full(3)), rod).unwrap().0;
        let first = |effect: &str| {
            let candidate = model.candidates().iter().position(|c| c.effect.name == effect).unwrap();
            let parameters = &model.candidates()[candidate].parameters;
            Term { candidate, values: parameters.iter().map(|p| p.neutral + 0.5 * p.size).collect() }
        };
        let beside = [vec![], vec![first("friction")], vec![first("friction"), first("slip")]];
        let with_memory = [vec![first("creep")], vec![first("creep"), first("slip")]];
        for others in beside.into_iter().chain(with_memory) {
            for (candidate, own) in model.candidates().iter().enumerate() {
                let values: Vec<f64> = own.parameters.iter().map(|p| p.neutral + 0.3 * p.size).collect();
                let mut terms = others.clone();
                terms.push(Term { candidate, values });
                let position = others.len();
                let columns = model.columns(&terms, position);
                for (k, parameter) in own.parameters.iter().enumerate() {
                    let at = |change: f64| {
                        let mut moved = terms.clone();
                        moved[position].values[k] += change * parameter.size;
                        model.response(&moved)
                    };
                    let expected = (at(DERIVATIVE_STEP) - at(-DERIVATIVE_STEP)) / (2.0 * DERIVATIVE_STEP);
                    let off = (columns.column(k) - &expected).amax();
                    assert!(off <= 1e-7 * (expected.amax() + 1e-6), "{off} of {}: {own:?}", expected.amax());
                }
            }
        }
    }
}

#[test]
fn too_many_rows_are_refused_with_a_reason() {
    let mut many = readings(UP_AND_DOWN);
    let row = many.rows[1].clone();
    many.rows.resize(MOST_ROWS + 1, row);
    let refusal = diagnose(&many, Some(&rod(""))).unwrap_err().to_string();
    assert!(refusal.contains("100001 rows of readings") && refusal.contains("at most 100000"), "{refusal}");
}

#[test]
fn effects_and_places_are_named_once() {
    let model = model(&full(2), &rod(""));
    let mut names: Vec<_> = model
        .candidates()
        .iter()
        .map(|c| (c.effect.name, c.location.to_string(), &c.parameters[0].name))
        .collect();
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
    for effect in [
        "stiffness_scale",
        "shear_modulus",
        "joint_compliance",
        "root_compliance",
        "friction",
        "load_offset",
        "backlash",
        "creep",
        "hysteresis",
        "nonlinear_stiffness",
        "sensor_scale",
        "sensor_misalignment",
        "load_misalignment",
        "thermal_drift",
        "slip",
        "unknown",
    ] {
        let of = model.candidates().iter().filter(|c| c.effect.name == effect);
        assert!(of.clone().count() > 0, "{effect}");
        assert!(of.into_iter().all(|c| c.is_nonparametric == (effect == "unknown")));
    }
}

#[test]
fn what_was_not_recorded_is_no_candidate() {
    let text = "axis,load_n,dy_um\ny,5,230\ny,10,460\ny,15,690\n";
    let has = |model: &RigModel, effect: &str| model.candidates().iter().any(|c| c.effect.name == effect);
    let plain = model(text, &rod(""));
    for effect in ["creep", "hysteresis", "thermal_drift", "slip", "load_misalignment", "sensor_misalignment"]
    {
        assert!(!has(&plain, effect), "{effect}");
    }
    // with time but without temperature the drift is one per hour
    let timed = "axis,load_n,time_s,dy_um\ny,5,0,230\ny,10,1800,460\ny,15,3600,690\n";
    let timed = model(timed, &rod(""));
    assert_eq!(timed.candidates()[find(&timed, "thermal_drift", "dy")].parameters[0].name, "um_per_h");
    let per_hour = one(&timed, "thermal_drift", "dy", 10.0 * UM / 3600.0, Axis::Y);
    assert_all(&per_hour, &[0.0, 5.0 * UM, 10.0 * UM]);
}

#[test]
fn without_a_rod_slopes_are_fitted_with_the_effects() {
    // y = 20 µm/N · (F − 1) for loading
    let text = "axis,load_n,dz_um\n-z,5,-80\n-z,10,-180\n-z,15,-280\n-z,20,-380\nz,5,80\n";
    let (model, evidence) = RigModel::new(&readings(text), None).unwrap();
    for effect in ["stiffness_scale", "joint_compliance", "sensor_scale", "load_misalignment"] {
        assert!(model.candidates().iter().all(|c| c.effect.name != effect), "{effect}");
    }
    assert_eq!(evidence.nuisance.column(0).as_slice(), [-5.0, -10.0, -15.0, -20.0, 5.0]);
    assert_eq!(evidence.residual[0], -80.0 * UM);
    let terms = [term(&model, "friction", "slide", &[1.0])];
    // 20 µm/N · (−4 + 5) and so on
    let expected = [20.0, 20.0, 20.0, 20.0, -20.0].map(|um| um * UM);
    assert_all(&response(&model, &terms, Axis::Z), &expected);
}

#[test]
fn weird_files_are_models_too() {
    let base = rod("");
    let two = "axis,load_n,dy_um\ny,5,230\n-y,5,-230\n";
    let stations = "axis,load_n,load_station_mm,read_station_mm,dx_um,dz_um
-z,5,675,205,1,-8
-z,9,675.0005,205,,-14
-z,9,300,0,,0
x,0,,,0,0
x,9,0,,1,
";
    let huge = "axis,load_n,dz_um\nz,1e30,1e30\nz,1e-30,1e-30\nz,0,0\n";
    for text in [two, stations, huge, UP_AND_DOWN, &full(1), &full(7)] {
        for rod in [Some(&base), None] {
            let (model, evidence) = RigModel::new(&readings(text), rod).unwrap();
            let n = model.data().len();
            assert_eq!(
                (evidence.residual.len(), evidence.replicate_group.len(), evidence.fold.len()),
                (n, n, n)
            );
            assert!(evidence.covariates.iter().all(|c| c.values.len() == n));
            assert_eq!(model.response(&[]), DVector::zeros(n));
            assert_eq!(model.response(&[Term { candidate: 99999, values: vec![1.0] }]), DVector::zeros(n));
        }
    }
    let off = readings("axis,load_n,load_station_mm,dy_um\ny,5,700,1\ny,6,700,1\n");
    let error = RigModel::new(&off, Some(&base)).unwrap_err().to_string();
    assert_eq!(
        error,
        "f:2: load_station_mm is 700, expected a station on rod \"5#\", 0 to 675.000 mm (the tip)"
    );
}

#[test]
fn other_stations_have_the_compliance_of_their_place() {
    let rod = rod("");
    let text = "axis,load_n,load_station_mm,read_station_mm,dz_um\nz,5,300,,0\nz,10,300,,0\nz,10,,205,0\n";
    let model = model(text, &rod);
    let c = |load: f64, read: f64| {
        let model = RodModel::new(&rod, &Physics::default(), 1, &[load, read]).unwrap();
        model.force_response(load, read).unwrap().translation[(2, 2)]
    };
    let tip = rod.length();
    let found = one(&model, "load_offset", "hanger", 1.0, Axis::Z);
    assert_all(&found, &[c(0.3, tip), c(0.3, tip), c(tip, 0.205)]);
}

#[test]
fn a_step_at_one_load_and_a_bend_in_the_line_are_within_the_unknown() {
    let text = full(3);
    let model = model(&text, &rod(""));
    let unknown = model
        .candidates()
        .iter()
        .position(|c| c.location.to_string() == "load, dz under loads along z")
        .unwrap();
    let parameters = &model.candidates()[unknown].parameters;
    let columns: Vec<DVector<f64>> = (0..parameters.len())
        .map(|k| {
            let mut values = vec![0.0; parameters.len()];
            values[k] = 1.0;
            model.response(&[Term { candidate: unknown, values }])
        })
        .collect();
    let basis = DMatrix::from_columns(&columns);
    let is_of = |d: &Datum| d.direction.axis == Axis::Z && d.channel == Axis::Z;
    for shape in [|load: f64| f64::from(u8::from(load >= 10.0)), |load: f64| (load - 10.0).max(0.0)] {
        let values = model.data().iter().map(|d| if is_of(d) { shape(d.load) } else { 0.0 });
        let target = DVector::from_iterator(model.data().len(), values);
        let fit = crate::linalg::least_squares(&basis, &target).unwrap();
        assert!((&basis * fit - target).amax() < 1e-12);
    }
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
