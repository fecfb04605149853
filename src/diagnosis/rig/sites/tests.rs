//! Laws on a published recording, with nothing of the library to explain it.

use super::super::wanted::Wanted;
use super::*;
use crate::inference::diagnose;
use crate::inference::law::propose;
use crate::rig::readings::Readings;

/// NIST StRD Pontius, and its certified B1 and B2 (inches, lbf).
const LOAD_CELL: &str = include_str!("../../../../stiffness_data/nist-load-cell.csv");
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
