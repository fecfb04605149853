//! Laws on a published recording, with nothing of the library to explain it.

use super::*;
use crate::diagnosis::rig::model::wanted::Wanted;
use crate::inference::law::propose;
use crate::inference::{ForwardModel, diagnose};
use crate::rig::readings::Readings;

/// NIST StRD Pontius, and its certified B1 and B2 (inches, lbf).
const LOAD_CELL: &str = include_str!("../../../../../stiffness_data/nist-load-cell.csv");
const CERTIFIED: (f64, f64) = (7.32059160401003e-7, -3.16081871345029e-15);
const POUND_FORCE: f64 = 4.4482216152605;

#[test]
fn the_load_cell_of_nist_is_quadratic_in_its_load() {
    let readings = Readings::from_text("f", LOAD_CELL).unwrap();
    let (model, evidence, _) = RigModel::with_effects(&readings, None, &Wanted::Like(&[])).unwrap();
    let diagnosis = diagnose(&model, &evidence);
    assert!(diagnosis.findings.is_empty() && diagnosis.discrepancy.is_some());
    let found = propose(&model, &diagnosis, &|change| sites(&model, change)).unwrap();
    let law = found.law.unwrap();
    // one axis and one sensor: what follows the load follows the reading, and the place is open
    let of_load = |site: &Site| site.variable.name == "load" && site.result.unit == "N";
    let quadratic = |form: Form| matches!(form, Form::Power | Form::Polynomial(2));
    let rival = || law.rivals.iter().find(|rival| of_load(&rival.site) && quadratic(rival.form));
    let largest = readings.rows.iter().fold(0.0, |most: f64, row| most.max(row.load));
    let at = |share: f64| match of_load(&law.site) && quadratic(law.form) {
        true => law.at(0, share * largest),
        false => rival().unwrap().at(0, share * largest),
    };
    // B2/B1: the slope of the line is fitted beside the law
    let second = 2.0 * (at(1.0) - 2.0 * at(0.5)) / largest.powi(2);
    let expected = CERTIFIED.1 / CERTIFIED.0 / POUND_FORCE;
    assert!((second / expected - 1.0).abs() < 0.05, "{second} for {expected}");
}

/// A rod with a joint, loaded up and down with times and temperatures.
const UP_AND_DOWN: &str = "axis,load_n,phase,time_s,temperature_c,dx_um,dy_um,dz_um
y,5,load,0,20,1,2,3
y,10,load,60,21,1,2,3
y,5,unload,200,23,1,2,3
z,5,load,300,22,1,2,3
z,10,load,400,20,1,2,3
z,5,unload,600,25,1,2,3
";

/// The column of a law: what it does to the data, but for its size.
fn column(site: &Site, form: Form, s: f64, sides: bool) -> DVector<f64> {
    let entry = |i: usize| {
        let side = if sides { site.moves[i] } else { 1.0 };
        let x = site.values[i] / site.largest();
        site.directions[0].1[i] * side * form.functions(x, s)[form.count() - 1]
    };
    DVector::from_fn(site.values.len(), |i, _| entry(i))
}

/// Existing effects are points of the grammar: their columns are those of a law, but for the size.
#[test]
fn the_library_is_a_part_of_the_grammar() {
    let text = include_str!("../../../../../rods/5.toml");
    let rod = Rod::from_toml("rod", &(text.to_owned() + JOINT)).unwrap();
    let readings = Readings::from_text("f", UP_AND_DOWN).unwrap();
    let (model, _) = RigModel::new(&readings, Some(&rod)).unwrap();
    let all = sites(&model, &DVector::zeros(model.data.len()));
    let line = Form::Polynomial(1);
    for (effect, parameters, place, variable, form, s, sides) in [
        ("stiffness_scale", &["factor"][..], "rod", "load", line, 0.0, false),
        ("nonlinear_stiffness", &["per_n"], "rod", "load", Form::Power, 2.0, false),
        ("nonlinear_stiffness", &["per_n2"], "rod", "load", Form::Power, 3.0, false),
        ("load_offset", &["force_n"], "rod", "load", Form::Step, 0.0, false),
        ("friction", &["force_n"], "rod", "load", Form::Step, 0.0, true),
        ("backlash", &["play_um"], "clamp", "load", Form::Step, 0.0, false),
        ("root_compliance", &["bending", "torsion"], "root", "moment", line, 0.0, false),
        ("joint_compliance", &["bending", "torsion"], "sleeve", "moment", line, 0.0, false),
        ("sensor_scale", &["factor"], "dy", "reading", line, 0.0, false),
        ("thermal_drift", &["um_per_k"], "sensors", "temperature above the lowest", line, 0.0, false),
    ] {
        let of_effect = model.candidates.iter().enumerate().filter(|(_, candidate)| {
            let is_place = match (effect, &candidate.location) {
                ("joint_compliance" | "sensor_scale", location) => location.to_string() == place,
                _ => true,
            };
            candidate.effect.name == effect && is_place
        });
        let site =
            all.iter().find(|site| site.location.to_string() == place && site.variable.name == variable);
        let law = column(site.unwrap_or_else(|| panic!("{place}, {variable}")), form, s, sides);
        let parallel = |(index, candidate): (usize, &crate::inference::Candidate)| {
            let columns = model.columns(&[candidate.neutral(index)], 0);
            let mut sum = DVector::zeros(law.len());
            for (k, parameter) in candidate.parameters.iter().enumerate() {
                if parameters.iter().any(|name| parameter.name.starts_with(name)) {
                    sum += columns.column(k) / parameter.size;
                }
            }
            sum.dot(&law).abs() / (sum.norm() * law.norm())
        };
        let best = of_effect.map(parallel).filter(|c| c.is_finite()).fold(0.0, f64::max);
        assert!(best > 1.0 - 1e-6, "{effect} {parameters:?}: {best}");
    }
}

const JOINT: &str = "
[[joint]]
name = \"sleeve\"
station_mm = 140.0
bending_urad_per_nm = 0.0
torsion_urad_per_nm = 0.0
";
