//! `diagnosis::rig::diagnose` against recordings made by the trials' generator, which shares no
//! physics with it, and against readings written by hand.

#![allow(clippy::unwrap_used)]

mod applied_laws;
mod beyond;
mod beyond_the_data;
mod clean;
mod confused;
mod effects;
mod imposed_laws;
mod labs;
mod laws;
mod own;
mod poor;
mod same;

use rodcal::diagnosis::rig::{RigDiagnosis, diagnose};
use rodcal::report;
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
use rodcal_trial::rig::{CaseSpec, Effect, SimulatedCase};
use serde_json::Value;

/// A diagnosis with its JSON.
struct Answer {
    found: RigDiagnosis,
    json: Value,
}

impl Answer {
    fn of(rod: Option<&str>, readings: &str) -> Answer {
        let rod = rod.map(|text| Rod::from_toml("rod.toml", text).unwrap());
        let readings = Readings::from_text("readings.csv", readings).unwrap();
        let found = diagnose(&readings, rod.as_ref()).unwrap();
        let json = report::diagnosis::rig::json(&found, found.correction().unwrap().as_ref());
        Answer { found, json }
    }

    fn of_case(case: &SimulatedCase) -> Answer {
        Answer::of(Some(&case.rod), &case.readings)
    }

    /// Of `spec` with `effects`.
    fn simulated(spec: &CaseSpec, effects: &[Effect], seed: u64) -> Answer {
        Answer::of_case(&spec.simulated(effects, seed))
    }

    fn findings(&self) -> &[Value] {
        self.json["findings"].as_array().unwrap()
    }

    /// Names of the findings, strongest first.
    fn effects(&self) -> Vec<&str> {
        self.findings().iter().map(|finding| finding["effect"].as_str().unwrap()).collect()
    }

    fn finding(&self, effect: &str) -> &Value {
        let found = self.findings().iter().find(|finding| finding["effect"] == effect);
        found.unwrap_or_else(|| panic!("no {effect}: {}", self.json["headline"]))
    }

    /// The names that a finding goes by: its own, and those that cannot be told from it.
    fn class(&self, position: usize) -> Vec<&str> {
        let finding = &self.findings()[position];
        let others = finding["indistinguishable_from"].as_array().unwrap();
        [&finding["effect"]].into_iter().chain(others).map(|name| name.as_str().unwrap()).collect()
    }

    fn is_consistent(&self) -> bool {
        self.json["verdict"] == "consistent"
    }
}

/// Value and interval of a parameter.
fn interval(finding: &Value, name: &str) -> [f64; 3] {
    let parameters = finding["parameters"].as_array().unwrap();
    let parameter = parameters.iter().find(|parameter| parameter["name"] == name);
    let parameter = parameter.unwrap_or_else(|| panic!("no {name} in {finding}"));
    ["lo", "value", "hi"].map(|key| parameter[key].as_f64().unwrap())
}
