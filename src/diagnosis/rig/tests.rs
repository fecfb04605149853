//! Sign and size of every effect against a hand computation on rod 5#, by family; here what all of
//! them share.

mod files;
mod geometry;
mod imposed;
mod load;
mod named;
mod reading;
mod scatter;
mod sessions;
mod stations;
mod structure;

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector};

use super::*;
use crate::beam::{Physics, RodModel};
use crate::inference::{Candidate, DERIVATIVE_STEP, ForwardModel, Term};
use crate::rig::readings::{Axis, Readings};
use crate::rod::Rod;
use crate::units::UM;

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
        let there: Vec<_> = model.candidates().iter().filter(|c| c.effect.name == effect).collect();
        panic!("no {effect} at {location}: {there:#?}")
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
                assert!(p.size > 0.0 && p.size.is_finite() && p.unit.si > 0.0, "{candidate:?}");
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
        "pulley_friction",
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
        let places = model.candidates().iter().filter(|c| c.effect.name == effect);
        assert!(places.clone().count() > 0, "{effect}");
        assert!(places.into_iter().all(|c| c.is_nonparametric == (effect == "unknown")));
    }
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
    let is_wanted = |d: &Datum| d.direction.axis == Axis::Z && d.channel == Axis::Z;
    for shape in [|load: f64| f64::from(u8::from(load >= 10.0)), |load: f64| (load - 10.0).max(0.0)] {
        let values = model.data().iter().map(|d| if is_wanted(d) { shape(d.load) } else { 0.0 });
        let target = DVector::from_iterator(model.data().len(), values);
        let fit = crate::linalg::least_squares(&basis, &target).unwrap();
        assert!((&basis * fit - target).amax() < 1e-12);
    }
}
