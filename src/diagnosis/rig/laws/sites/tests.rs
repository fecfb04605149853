//! Laws on a published recording, with nothing of the library to explain it.

use std::collections::BTreeSet;

use super::*;
use crate::diagnosis::rig::effects::registry;
use crate::diagnosis::rig::model::wanted::Wanted;
use crate::inference::law::points::{GrammarPoint, likeness};
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

/// A rod with a joint and a bend, loaded up and down along each axis, at times and temperatures.
fn up_and_down() -> (Readings, Rod) {
    up_and_down_with("", |_, _| "1,2,3".to_owned())
}

/// The same with a header, and what is read under a load along an axis.
fn up_and_down_with(header: &str, read: impl Fn(&str, f64) -> String) -> (Readings, Rod) {
    let mut text = format!("{header}axis,load_n,phase,time_s,temperature_c,dx_um,dy_um,dz_um\n");
    let mut time = 0.0;
    for axis in ["x", "y", "z"] {
        for (k, load) in [2.0, 3.0, 6.0, 7.0, 10.0, 7.0, 6.0, 3.0, 2.0].into_iter().enumerate() {
            let phase = if k < 5 { "load" } else { "unload" };
            time += 20.0 + 7.0 * load;
            let temperature = 20.0 + (time / 90.0f64).sin();
            text += &format!("{axis},{load},{phase},{time},{temperature},{}\n", read(axis, load));
        }
    }
    let rod =
        include_str!("../../../../../rods/5.toml").replace("bend_radius_mm = 0.0", "bend_radius_mm = 40.0");
    (Readings::from_text("f", &text).unwrap(), Rod::from_toml("rod", &(rod + JOINT)).unwrap())
}

/// What the effects of the library are in the grammar.
const POINTS: [(&str, &str, &str, Form, bool); 20] = [
    ("stiffness_scale", "rod", "load", Form::Polynomial(1), false),
    ("nonlinear_stiffness", "rod", "load", Form::Polynomial(2), false),
    ("nonlinear_stiffness", "rod", "load", Form::Polynomial(3), false),
    ("load_offset", "rod", "load", Form::Step, false),
    ("friction", "rod", "load", Form::Step, true),
    ("pulley_friction", "rod", "load", Form::Polynomial(1), true),
    ("hysteresis", "rod", "load", Form::Polynomial(2), true),
    ("sensor_lag", "slide", "time since the load was changed", Form::Polynomial(1), false),
    ("backlash", "clamp", "load", Form::Step, false),
    ("root_compliance", "root", "moment", Form::Polynomial(1), false),
    ("joint_compliance", "sleeve", "moment", Form::Polynomial(1), false),
    ("creep", "rod", "time since the load was changed", Form::Logarithm, false),
    ("thermal_softening", "rod", "temperature above the lowest", Form::Polynomial(1), false),
    ("sensor_scale", "dx", "reading", Form::Polynomial(1), false),
    ("sensor_scale", "dy", "reading", Form::Polynomial(1), false),
    ("sensor_scale", "dz", "reading", Form::Polynomial(1), false),
    // under loads along y that is all that is displaced: elsewhere axes share it
    ("load_point", "dy", "reading", Form::Polynomial(1), false),
    ("sensor_point", "dy", "reading", Form::Polynomial(1), false),
    ("thermal_drift", "sensors", "temperature above the lowest", Form::Polynomial(1), false),
    ("slip", "sensors", "number of readings before", Form::Step, false),
];

/// What the others say that no function of one variable at one place does: how a load or a
/// displacement is shared among axes, or the compliance along the rod.
const NO_POINTS: [&str; 6] = [
    "load_misalignment",
    "sensor_misalignment",
    "shear_modulus",
    "bend_flexibility",
    "pipe_stiffness",
    "rod_dimension",
];

/// Existing effects are points of the grammar: what they do to the data is what a law does. Those
/// that are none are listed, and are none.
#[test]
fn the_library_is_a_part_of_the_grammar() {
    let (readings, rod) = up_and_down();
    let (model, _) = RigModel::new(&readings, Some(&rod)).unwrap();
    let all = sites(&model, &DVector::zeros(model.data.len()));
    let largest = readings.rows.len() as f64;
    let shares: Vec<f64> = (0..readings.rows.len()).map(|k| (k as f64 - 0.5) / largest).collect();
    // t₀ of creep, s
    let waits = |site: &Site| [1.0, 10.0, 60.0, 600.0].map(|t0| t0 / site.largest());
    let like = |effect: &str, (place, variable, form, sides)| {
        let point = GrammarPoint { place, variable, form, sides };
        let constants = match form {
            Form::Step if variable == "load" => vec![0.0],
            Form::Step => shares.clone(),
            _ => all.iter().filter(|site| site.variable.name == variable).flat_map(waits).collect(),
        };
        let own = model.candidates.iter().enumerate().filter(|(_, own)| own.effect.name == effect);
        own.map(|(index, own)| model.columns(&[own.neutral(index)], 0))
            .filter(|columns| columns.norm() > 0.0 && columns.iter().all(|value| value.is_finite()))
            .map(|columns| likeness(&all, point, &constants, &columns))
            .fold(0.0, f64::max)
    };
    for (effect, place, variable, form, sides) in POINTS {
        let found = like(effect, (place, variable, form, sides));
        assert!(found > 1.0 - 1e-6, "{effect}, {place} over {variable}: {found}");
    }
    let points = POINTS.map(|point| (point.1, point.2, point.3, point.4));
    for effect in NO_POINTS {
        let most = points.iter().map(|point| like(effect, *point)).fold(0.0, f64::max);
        assert!(most < 1.0 - 1e-6, "{effect} is a point: {most}");
    }
    let known: BTreeSet<&str> = POINTS.iter().map(|point| point.0).chain(NO_POINTS).collect();
    assert_eq!(known, registry::ALL.iter().map(|own| own.effect.name).collect());
}

/// What they are where the displacement is imposed, and the load is what changes.
const POINTS_IMPOSED: [(&str, &str, &str, Form, bool); 8] = [
    ("stiffness_scale", "rod", "load", Form::Polynomial(1), false),
    ("nonlinear_stiffness", "rod", "load", Form::Polynomial(3), false),
    ("friction", "rod", "deflection along the load", Form::Step, true),
    ("root_compliance", "root", "moment", Form::Polynomial(1), false),
    ("joint_compliance", "sleeve", "moment", Form::Polynomial(1), false),
    ("creep", "rod", "time since the load was changed", Form::Logarithm, false),
    ("thermal_softening", "rod", "temperature above the lowest", Form::Polynomial(1), false),
    ("thermal_drift", "sensors", "temperature above the lowest", Form::Polynomial(1), false),
];

#[test]
fn an_imposed_displacement_has_the_same_grammar() {
    let along = |axis: &str, load: f64| match axis {
        "x" => format!("{},,", 10.0 * load),
        "y" => format!(",{},", 60.0 * load),
        _ => format!(",,{}", 50.0 * load),
    };
    let (readings, rod) = up_and_down_with("# driven = \"displacement\"\n", along);
    let (model, _) = RigModel::new(&readings, Some(&rod)).unwrap();
    let all = sites(&model, &DVector::zeros(model.data.len()));
    let waits = |site: &Site| [1.0, 10.0, 60.0, 600.0].map(|t0| t0 / site.largest());
    for (effect, place, variable, form, sides) in POINTS_IMPOSED {
        let point = GrammarPoint { place, variable, form, sides };
        let constants: Vec<f64> = match form {
            Form::Step => vec![0.0],
            _ => all.iter().filter(|site| site.variable.name == variable).flat_map(waits).collect(),
        };
        let own = model.candidates.iter().enumerate().filter(|(_, own)| own.effect.name == effect);
        let most = own
            .map(|(index, own)| model.columns(&[own.neutral(index)], 0))
            .map(|columns| likeness(&all, point, &constants, &columns))
            .fold(0.0, f64::max);
        assert!(most > 1.0 - 1e-6, "{effect}, {place} over {variable}: {most}");
    }
}

/// The sensor at the tip reads the deflection where the load acts, whether or not its place is
/// stated; one elsewhere does not, but has it of the same instant.
#[test]
fn a_tip_that_is_stated_is_the_tip() {
    let rod = Rod::from_toml("rod", include_str!("../../../../../rods/5.toml")).unwrap();
    for tip in ["", "675", "674.9999999"] {
        let rows: String = (1..=5).map(|k| format!("z,{k},{tip},{0}\nz,{k},410,{k}\n", 2 * k)).collect();
        let text = format!("axis,load_n,read_station_mm,dz_um\n{rows}");
        let readings = Readings::from_text("f", &text).unwrap();
        let (model, _) = RigModel::new(&readings, Some(&rod)).unwrap();
        let all = sites(&model, &DVector::zeros(model.data.len()));
        let site = all.iter().find(|site| site.variable.symbol == "u").unwrap();
        let by = &site.recorded.as_ref().unwrap().by;
        for (i, datum) in model.data.iter().enumerate() {
            let (tip, sign) = by[i].unwrap();
            assert!(sign == 1.0 && model.data[tip].row == 2 * datum.row.div_ceil(2) - 1, "{i}: {tip}");
            assert!((site.values[i] / model.data[tip].predicted - 1.0).abs() < 1e-9);
        }
    }
}

const JOINT: &str = "
[[joint]]
name = \"sleeve\"
station_mm = 140.0
bending_urad_per_nm = 0.0
torsion_urad_per_nm = 0.0
";
