//! Every effect is described, and the registry is all there is.

use crate::diagnosis::rig::RigModel;
use crate::diagnosis::rig::effects::registry;
use crate::inference::{
    Estimate, Finding, FindingPart, ForwardModel, Kind, Location, Reported, Term, WrittenTo,
};
use crate::rig::readings::Readings;
use crate::rod::Rod;
use crate::units::UM;

/// Readings that every effect of the registry has a meaning for.
fn everything() -> RigModel {
    let rod =
        include_str!("../../../../rods/5.toml").replace("bend_radius_mm = 0.0", "bend_radius_mm = 60.0");
    let rod = rod + "\n[[joint]]\nname = \"sleeve\"\nstation_mm = 300\nbending_urad_per_nm = 4.0\n";
    let rod = Rod::from_toml("rod", &rod).unwrap();
    let mut text = "axis,load_n,trial,phase,time_s,temperature_c,dx_um,dy_um,dz_um\n".to_owned();
    let mut time = 0.0;
    for axis in ["x", "y", "z"] {
        for trial in 1..4 {
            for (load, phase) in
                [(5.0, "load"), (10.0, "load"), (20.0, "load"), (10.0, "unload"), (5.0, "unload")]
            {
                time += 30.0;
                let temperature = 20.0 + time / 1000.0;
                text += &format!("{axis},{load},{trial},{phase},{time},{temperature},{load},{load},{load}\n");
            }
        }
    }
    RigModel::new(&Readings::from_text("f", &text).unwrap(), Some(&rod)).unwrap().0
}

/// A finding of one candidate, as large as is usual.
fn finding(model: &RigModel, index: usize) -> Finding {
    let candidate = &model.candidates()[index];
    let term = candidate.neutral(index);
    let location = model.location(&term);
    let estimates: Vec<Estimate> = candidate
        .parameters
        .iter()
        .map(|p| Estimate {
            name: p.name.clone(),
            unit: p.unit,
            value: p.neutral + 2.0 * p.size,
            low: p.neutral + p.size,
            high: p.neutral + 3.0 * p.size,
        })
        .collect();
    let part = FindingPart {
        term,
        location: location.clone(),
        estimates: estimates.clone(),
        first: 0,
        covariance: nalgebra::DMatrix::zeros(0, 0),
        coverage_factor: 2.0,
        p_value: 0.0,
        explains: 0.0,
        rivals: Vec::new(),
        takes_numbers_place: false,
        unnamed: None,
    };
    Finding::from_part(candidate.effect, location, estimates, part)
}

#[test]
fn every_effect_of_the_registry_is_met_and_described_with_its_number() {
    let model = everything();
    let mut met = Vec::new();
    for (index, candidate) in model.candidates().iter().enumerate().filter(|(_, c)| !c.is_nonparametric) {
        let effect = candidate.effect;
        let description = model.describe(&finding(&model, index)).to_string();
        assert!(description.contains('±') || description.contains(" to "), "{effect}: {description}");
        assert!(!description.contains("NaN"), "{effect}: {description}");
        // a mistake names the column of the file
        let names_keys = effect.kind == Kind::Mistake;
        assert!(names_keys || !description.contains('_'), "{effect}: {description}");
        assert!(names_keys || !(effect.cause_at)(&candidate.location).contains('_'));
        for parameter in &candidate.parameters {
            let is_listed =
                effect.parameters.iter().any(|(names, _)| names.contains(&parameter.name.as_str()));
            assert!(is_listed, "{effect} has {} beyond its record", parameter.name);
        }
        if !met.contains(&effect) {
            met.push(effect);
        }
    }
    let all = registry::ALL.into_iter().chain([&super::zeros::ZERO_NOT_TAKEN]);
    let listed: Vec<_> = all.map(|known| &known.effect).collect();
    assert!(listed.iter().all(|effect| met.contains(effect)), "{met:?}");
    assert_eq!(met.len(), listed.len());
}

#[test]
fn every_record_is_complete() {
    for known in registry::ALL {
        let effect = &known.effect;
        for text in [effect.summary, effect.formula, effect.prior, effect.needs, effect.cause] {
            assert!(!text.is_empty(), "{effect}");
        }
        assert!(!effect.parameters.is_empty(), "{effect}");
        // one knock may move every channel
        let reported = if *effect == super::events::SLIP.effect { Reported::ByRow } else { Reported::Alone };
        assert_eq!(effect.reported, reported, "{effect}");
        assert_eq!(registry::ALL.iter().filter(|other| &other.effect == effect).count(), 1);
    }
}

/// The prior in description has the number that candidates are made with.
#[test]
fn a_prior_says_its_number() {
    for known in registry::ALL {
        assert!(!known.usual.is_empty(), "{}", known.effect);
        for usual in known.usual.iter().map(ToString::to_string) {
            let prior = known.effect.prior;
            let ends_a_number = |at: usize| prior[..at].ends_with(|c: char| c.is_ascii_digit() || c == '.');
            let is_said = prior.match_indices(&usual).any(|(at, _)| !ends_a_number(at));
            assert!(is_said, "{}: {usual} in \"{prior}\"", known.effect);
        }
    }
}

/// Each term goes where its record says; what is the rod's own changes the rod.
#[test]
fn what_is_written_back_goes_where_the_record_says() {
    let model = everything();
    let rod = model.rod().unwrap();
    let named = model.candidates().iter().enumerate().filter(|(_, candidate)| !candidate.is_nonparametric);
    for (index, candidate) in named {
        let values = candidate.parameters.iter().map(|p| (p.neutral + p.size).min(p.bounds.1)).collect();
        let mut written = rod.clone();
        let destination = registry::write(&Term { candidate: index, values }, &model, &mut written);
        // a rod file has no sessions
        let is_of_session = matches!(candidate.location, Location::InSession { .. });
        let expected = if is_of_session { WrittenTo::Recording } else { candidate.effect.written_to };
        assert_eq!(destination, expected, "{} {}", candidate.effect, candidate.location);
        assert_eq!(written != *rod, destination == WrittenTo::Model, "{}", candidate.effect);
    }
}

#[test]
fn the_descriptions_say_what_a_mechanic_would() {
    let model = everything();
    let description_of = |effect: &str, location: &str| {
        let is_it =
            |c: &crate::inference::Candidate| c.effect.name == effect && c.location.to_string() == location;
        let index = model.candidates().iter().position(is_it);
        let index = index.unwrap_or_else(|| panic!("{effect} {location}"));
        model.describe(&finding(&model, index)).to_string()
    };
    assert_eq!(
        description_of("friction", "slide, loads along y"),
        "About 2.0 ± 1.0 N of each load along y does not reach the rod while loading, and as much remains on it \
         while unloading: friction in the slide"
    );
    assert!(description_of("joint_compliance", "sleeve").starts_with("The joint \"sleeve\" gives way by"));
    let drift = description_of("thermal_drift", "dy");
    let stated: f64 = drift.split(' ').nth(4).and_then(|number| number.parse().ok()).unwrap();
    let is_drift = |c: &&crate::inference::Candidate| c.effect.name == "thermal_drift";
    let size = model.candidates().iter().find(is_drift).unwrap().parameters[0].size / UM;
    assert!(drift.starts_with("Sensor dy drifts by") && drift.contains("µm per kelvin"), "{drift}");
    // the finding is made twice its size
    assert!((stated - 2.0 * size).abs() < 0.1 * size, "{drift}: {size}");
    assert!(
        description_of("nonlinear_stiffness", "rod")
            .contains("is 10 ± 5 % softer at 20.0 N than at small loads")
    );
}

#[test]
fn what_remains_is_said_by_what_it_follows() {
    let model = everything();
    let followed = |wanted: &str| {
        model.candidates().iter().find_map(|candidate| match &candidate.location {
            Location::Curve { label, follows, .. } if label == wanted => Some(follows.clone()),
            _ => None,
        })
    };
    let of_line = followed("load, dy under loads along y");
    assert_eq!(of_line.as_deref(), Some("follows the load (dy under loads along y)"));
    assert_eq!(followed("time, all deflections").as_deref(), Some("follows the time (all readings alike)"));
    let slopes = followed("slope of each line");
    assert_eq!(slopes.as_deref(), Some("makes some lines steeper or flatter than others"));
}
