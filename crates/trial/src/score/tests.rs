use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::*;
use crate::ground_truth::{Concealed, Detectability, Parameter, PredictionQuery};
use crate::place::Place;

/// A place by its words.
fn place(location: &str) -> Place {
    match (location.strip_prefix("station "), location) {
        (Some(station), _) => {
            let station_mm = station.strip_suffix(" mm").and_then(|mm| mm.parse().ok());
            Place { station_mm, ..Place::default() }
        }
        (_, "sleeve") => Place::named("sleeve"),
        (_, "load_n" | "load_kg") => Place::key(location),
        _ => Place::part(location),
    }
}

fn concealed(effect: &str, location: &str, parameter: (&str, f64), separation: f64) -> Concealed {
    Concealed {
        effect: effect.into(),
        location: location.into(),
        place: place(location),
        parameters: vec![Parameter { name: parameter.0.into(), value: parameter.1, with_numbers: None }],
        size_over_noise: 4.0,
        detectability: Detectability {
            against_none: 2.0 * separation,
            against_rival: separation,
            against_pair: None,
            best_rival: "load_offset".into(),
            class: Vec::new(),
            places: vec![place(location)],
            stations_mm: (effect == "joint_compliance").then_some([190.0, 230.0]),
        },
    }
}

fn truth(case: usize, kind: Kind, effects: Vec<Concealed>) -> GroundTruth {
    GroundTruth {
        case: format!("rig/case-{case:04}"),
        kind,
        conflict: None,
        effects,
        companions: Vec::new(),
        numbers_off: 1.0,
        noise_um: 1.0,
        noise_shape: "normal".into(),
        quantum_um: 0.0,
        readings: 10,
        protocol: String::new(),
        joints: BTreeMap::from([("sleeve".to_owned(), 205.0)]),
        geometric_um: 0.0,
        oracle_gain: Some(0.8),
        seed: None,
        residuals: Vec::new(),
        query: None,
    }
}

fn kind(effect: &str) -> &'static str {
    if effect.ends_with("_mistake") { "mistake" } else { "physics" }
}

fn answer(case: usize, findings: &[(&str, &str, Value)], unexplained: bool) -> Answer {
    let findings: Vec<Value> = findings
        .iter()
        .map(|(effect, location, parameter)| {
            json!({"effect": effect, "location": location, "place": place(location), "kind": kind(effect),
                   "parameters": [parameter], "indistinguishable_from": ["friction"]})
        })
        .collect();
    let unexplained = unexplained.then(|| json!({"location": "load"}));
    Answer {
        case: format!("rig/case-{case:04}"),
        answer: json!({"verdict": "mismatch", "findings": findings, "unexplained": unexplained,
                       "heldout_before_um": 2.0, "heldout_after_um": 1.0}),
        sha256: BTreeMap::new(),
        predicted_um: None,
    }
}

fn example() -> (Vec<GroundTruth>, Vec<Answer>) {
    let friction = || concealed("friction", "slide", ("force_n", 1.0), 20.0);
    let joint = || concealed("joint_compliance", "station 205.0 mm", ("bending_urad_per_nm", 5.0), 8.0);
    let force = |lo: f64, hi: f64| json!({"name": "force_n", "value": 1.0, "lo": lo, "hi": hi});
    let none = || json!({"name": "um", "value": 0.0, "lo": 0.0, "hi": 0.0});
    let truths = vec![
        truth(1, Kind::Clean, vec![]),
        truth(2, Kind::Clean, vec![]),
        truth(3, Kind::Single, vec![friction()]),
        truth(4, Kind::Single, vec![friction()]),
        truth(5, Kind::Single, vec![joint()]),
        truth(6, Kind::Single, vec![concealed("creep", "rod", ("per_decade", 0.1), 1.0)]),
        truth(7, Kind::Pair, vec![friction(), joint()]),
        truth(8, Kind::Unknown, vec![concealed("sensor ripple", "dy", ("amplitude_um", 5.0), 9.0)]),
        truth(9, Kind::Unknown, vec![concealed("Hertzian seat", "rod", ("um", 5.0), 9.0)]),
        truth(10, Kind::Clean, vec![]),
    ];
    let answers = vec![
        answer(1, &[], false),
        answer(2, &[("slip", "y", none())], false),
        answer(3, &[("friction", "slide", force(0.9, 1.1))], false),
        answer(4, &[("load_offset", "hanger", force(0.9, 1.1))], false),
        answer(5, &[("joint_compliance", "sleeve", none())], false),
        answer(6, &[], false),
        answer(
            7,
            &[("joint_compliance", "station 400.0 mm", none()), ("friction", "slide", force(1.1, 1.2))],
            false,
        ),
        answer(8, &[], true),
        answer(9, &[("backlash", "clamp", none())], false),
    ];
    (truths, answers)
}

#[test]
fn a_small_trial_is_counted_by_hand() {
    let (truths, answers) = example();
    let score = score(&truths, &answers, &[]);
    let Part { cases, clean, single, pairs, unknown, .. } = &score.whole;
    let rate = |count, total| Rate { count, total };
    assert_eq!((*cases, score.unanswered), (9, 1));
    assert_eq!(clean.false_names, rate(1, 2));
    // a sleeve at 205 mm is where the joint is; the class of the wrong name holds friction
    assert_eq!((single.n, single.name_ok, single.location_ok), (4, rate(2, 3), rate(2, 3)));
    assert_eq!(single.in_class, rate(3, 3));
    assert_eq!(pairs.both_found, rate(1, 1));
    assert_eq!((unknown.called_unknown, unknown.wrongly_named), (rate(1, 2), rate(1, 2)));
    // one interval holds 1.0 and one does not; the joint's number was not said
    assert_eq!(score.whole.coverage.all.share(), Some(0.5));
    assert_eq!(score.whole.right_when_named.count, 3);
    assert!((score.whole.gain_over_oracle.unwrap() - 0.75 / 0.8).abs() < 1e-12);
    // nobody was asked for other readings, and nothing was measured once more
    assert_eq!(score.whole.counterfactual_over_oracle, None);
    let next = &score.whole.next_measurement_ok;
    assert_eq!((next.settled, &next.not_done), (rate(0, 0), &BTreeMap::from([("not asked".to_owned(), 4)])));
    assert_eq!((score.rig.as_ref(), score.calibration.as_ref()), (Some(&score.whole), None));
}

/// Scores of former versions are compared with those of today: keys stay, and their order.
#[test]
fn as_json_a_score_has_the_keys_that_it_always_had() {
    let (truths, answers) = example();
    let json = score(&truths, &answers, &[]).json().unwrap();
    let keys = |value: &Value| -> Vec<String> { value.as_object().unwrap().keys().cloned().collect() };
    let part = [
        "cases",
        "failed",
        "clean",
        "single",
        "pairs",
        "unknown",
        "below",
        "mistakes",
        "suspects",
        "right_when_named",
        "right_or_inseparable",
        "class_right_when_named",
        "coverage",
        "coverage_rate",
        "coverage_by_parameter",
        "gain_over_oracle",
        "counterfactual_over_oracle",
        "counterfactual",
        "next_measurement_ok",
        "bins",
        "confusion",
        "outside",
        "power",
        "failures",
        "targets",
        "missed_targets",
    ];
    assert_eq!(keys(&json), [&part[..], &["unanswered", "rig", "remarks"]].concat());
    assert_eq!(keys(&json["rig"]), part);
    assert_eq!(json["single"]["identifiable"], 3);
    assert_eq!(json["clean"]["false_names_rate"]["share"], 0.5);
    let missed = "clean recordings without any finding: 50.0 %, wanted at least 98.0 %";
    assert_eq!(json["missed_targets"][0], missed);
    let text = score(&truths, &answers, &[]).text();
    let (first, rest) = text.split_once('\n').unwrap();
    assert!(first.contains("have no answer: the score is of the other"), "{first}");
    assert!(rest.starts_with(&format!("MISSED rig: {missed}\n")), "{rest}");
}

#[test]
fn a_mistake_is_named_something_else_or_passed_over() {
    let unit = || concealed("unit_mistake", "load_n", ("factor", 9.80665), 20.0);
    let mut truths: Vec<GroundTruth> = (1..=4).map(|case| truth(case, Kind::Mistake, vec![unit()])).collect();
    truths.push(truth(5, Kind::Clean, vec![]));
    let factor = |value: f64| json!({"name": "factor", "value": value, "lo": value, "hi": value});
    let answers = vec![
        answer(1, &[("unit_mistake", "load_n", factor(9.80665))], false),
        answer(2, &[("unit_mistake", "load_n", factor(1000.0))], false),
        answer(3, &[], false),
        answer(4, &[("unit_mistake", "load_kg", factor(9.80665))], false),
        answer(5, &[("unit_mistake", "load_n", factor(25.4))], false),
    ];
    let part = score(&truths, &answers, &[]).whole;
    let rate = |count, total| Rate { count, total };
    let Mistakes { named, placed, as_other, silent, invented, .. } = &part.mistakes;
    assert_eq!((*named, *placed), (rate(2, 4), rate(1, 4)));
    assert_eq!((*as_other, *silent, *invented), (rate(1, 4), rate(1, 4), rate(1, 1)));
    // whether it is right to name is asked of recordings without a mistake
    assert_eq!(part.right_when_named, rate(0, 1));
    let what: Vec<&str> = part.failures.iter().map(|failure| failure.what).collect();
    let expected =
        ["mistake, something else", "mistake, silent", "mistake, wrong place", "a mistake that nobody made"];
    assert_eq!(what, expected);
}

#[test]
fn misread_readings_are_remarks_and_never_findings() {
    let at = |row: usize| Concealed {
        place: Place { row: Some(row), channel: Some("dy".into()), ..Place::default() },
        ..concealed("outlier", "row", ("um", 50.0), 20.0)
    };
    let truths: Vec<GroundTruth> =
        (1..=3).map(|case| truth(case, Kind::Suspect, vec![at(4), at(9)])).collect();
    let with = |case: usize, rows: &[usize], findings: &[(&str, &str, Value)]| {
        let mut answer = answer(case, findings, false);
        let suspects: Vec<Value> =
            rows.iter().map(|row| json!({"row": row, "channel": "dy", "sigma": 9.0})).collect();
        answer.answer["suspects"] = suspects.into();
        answer
    };
    let none = json!({"name": "um", "value": 0.0, "lo": 0.0, "hi": 0.0});
    let answers = vec![with(1, &[9, 4], &[]), with(2, &[4], &[]), with(3, &[4, 9], &[("slip", "y", none)])];
    let suspects = score(&truths, &answers, &[]).whole.suspects;
    assert_eq!(suspects.remarked, Rate { count: 2, total: 3 });
    assert_eq!(suspects.named, Rate { count: 1, total: 3 });
}

#[test]
fn below_the_limit_silence_is_right_and_what_accompanies_an_effect_is_not_asked() {
    let number = json!({"name": "um", "value": 0.0, "lo": 0.0, "hi": 0.0});
    let faint = |case| truth(case, Kind::Single, vec![concealed("creep", "rod", ("per_decade", 0.1), 1.0)]);
    let companion = |kind: Kind, case: usize, effect: &str| GroundTruth {
        companions: vec![concealed("friction", "slide", ("force_n", 1.0), 9.0)],
        ..truth(case, kind, vec![concealed(effect, "rod", ("um", 5.0), 9.0)])
    };
    let truths = vec![
        faint(1),
        faint(2),
        faint(3),
        companion(Kind::Single, 4, "creep"),
        companion(Kind::Unknown, 5, "Hertzian seat"),
        GroundTruth { numbers_off: 2.0, ..truth(6, Kind::Clean, vec![]) },
    ];
    let answers = vec![
        answer(1, &[], false),
        answer(2, &[("creep", "rod", number.clone())], false),
        answer(3, &[("hysteresis", "rod", number.clone())], false),
        answer(4, &[("friction", "slide", number.clone()), ("creep", "rod", number.clone())], false),
        answer(5, &[("friction", "slide", number.clone())], true),
        answer(6, &[("stiffness_scale", "rod", number)], false),
    ];
    let part = score(&truths, &answers, &[]).whole;
    let rate = |count, total| Rate { count, total };
    let Below { silent, silent_or_right, wrongly_named } = part.below;
    assert_eq!((silent, silent_or_right, wrongly_named), (rate(1, 3), rate(2, 3), rate(1, 3)));
    assert_eq!((part.single.location_ok, part.unknown.called_unknown), (rate(1, 1), rate(1, 1)));
    assert_eq!((part.unknown.wrongly_named, part.clean.silent_twice), (rate(0, 1), rate(1, 1)));
    assert_eq!((part.clean.silent, part.right_when_named), (rate(0, 0), rate(4, 5)));
}

#[test]
fn a_class_is_right_where_the_oracle_cannot_distinguish_it() {
    let friction = |class: &[&str]| {
        let friction = concealed("friction", "slide", ("force_n", 1.0), 2.0);
        let class = class.iter().map(|name| EffectName::from(*name)).collect();
        Concealed { detectability: Detectability { class, ..friction.detectability }, ..friction }
    };
    let truths = vec![
        truth(1, Kind::Single, vec![friction(&["load_offset"])]),
        truth(2, Kind::Single, vec![friction(&[])]),
    ];
    let number = json!({"name": "um", "value": 0.0, "lo": 0.0, "hi": 0.0});
    let answers = [1, 2].map(|case| answer(case, &[("load_offset", "hanger", number.clone())], false));
    let part = score(&truths, &answers, &[]).whole;
    assert_eq!((part.right_when_named.count, part.right_or_inseparable.count), (0, 1));
    assert_eq!(part.class_right_when_named.count, 2);
}

#[test]
fn places_are_compared_as_data() {
    let truth = truth(1, Kind::Single, vec![]);
    let at = |value: Value| serde_json::from_value::<Place>(value).unwrap();
    let of_effect =
        |effect: &str, place: Place| Concealed { place, ..concealed(effect, "", ("um", 1.0), 9.0) };
    let is_same = |concealed: &Concealed, place: &Place| place::is_same(&truth, concealed, Some(place));
    let slip = of_effect("slip", at(json!({"loads_along": "y", "trial": "2", "after_row": 7})));
    assert!(is_same(&slip, &at(json!({"loads_along": "y", "trial": "2", "after_row": 9, "channel": null}))));
    assert!(!is_same(&slip, &at(json!({"loads_along": "y", "trial": "1", "after_row": 7}))));
    let between = at(json!({"loads_along": "y", "trial": "2", "after_row": 7, "channel": "dz"}));
    let slip = of_effect("slip", between.clone());
    assert!(is_same(&slip, &between) && !is_same(&slip, &Place { channel: None, ..between }));
    let frame = of_effect("load_misalignment", Place::part("load frame"));
    assert!(is_same(&frame, &at(json!({"loads_along": ["y", "z"], "about": "x"}))));
    assert!(!is_same(&frame, &at(json!({"loads_along": "y", "towards": "z"}))));
    let zero = of_effect("offset_mistake", Place::key("dy_um"));
    assert!(is_same(&zero, &Place::key("dy_um, axis y, trial 2")));
    assert!(!is_same(&zero, &Place::key("dy_um and dz_um")));
    // nothing that could be read is no place
    assert!(!place::is_same(&truth, &zero, None) && !is_same(&zero, &Place::default()));
}

#[test]
fn other_readings_are_scored_against_the_oracle() {
    let (mut truths, mut answers) = example();
    // of an identifiable case, of one that is not, and of one whose answer leaves a reading out
    for (k, predicted) in [(2, vec![1.2, 2.2]), (5, vec![9.0, 9.0]), (3, vec![1.0])] {
        let oracle_um = Some(vec![1.1, 2.1]);
        truths[k].query = Some(PredictionQuery { true_um: vec![1.0, 2.0], oracle_um, is_any_frame: false });
        answers[k].predicted_um = Some(predicted);
    }
    let part = score(&truths, &answers, &[]).whole;
    assert!((part.counterfactual_over_oracle.unwrap() - 2.0).abs() < 1e-9);
    let all = &part.counterfactual;
    assert_eq!((all.n, all.answered, all.worst[0].case.as_str()), (2, 1, "rig/case-0003"));
}

#[test]
fn what_was_measured_once_more_settles_or_does_not() {
    let (truths, answers) = example();
    let sealed = Sealed { truths, given: answers, names_manifest: true };
    let due: Vec<String> = sealed.pending().into_iter().map(|pending| pending.case).collect();
    assert_eq!(due, [3, 4, 5, 7].map(|case| format!("rig/case-{case:04}")));
    let diagnosed = |effect: &str, place: &str, others: &[&str]| {
        let finding =
            json!({"effect": effect, "place": self::place(place), "indistinguishable_from": others});
        Outcome::Diagnosed(json!({"verdict": "mismatch", "findings": [finding]}))
    };
    let outcomes = [
        Outcome::NotProposed,
        diagnosed("friction", "slide", &["backlash"]),
        diagnosed("joint_compliance", "sleeve", &["friction"]),
        Outcome::NotDone("the rod broke".into()),
    ];
    let outcomes: Vec<(String, Outcome)> = due.into_iter().zip(outcomes).collect();
    let score = sealed.score(&outcomes);
    let next = &score.whole.next_measurement_ok;
    // a rival that is new is another question
    assert_eq!((next.settled, next.not_proposed), (Rate { count: 1, total: 2 }, 1));
    assert_eq!(next.not_done, BTreeMap::from([("the rod broke".to_owned(), 1)]));
    assert_eq!(next.open[0].case, "rig/case-0005");
    let text = score.text();
    assert!(text.contains("1 more without a proposal; 1 not done (the rod broke)"), "{text}");
}

#[test]
fn the_order_of_answers_does_not_matter() {
    let (truths, mut answers) = example();
    let before = score(&truths, &answers, &[]);
    answers.reverse();
    assert_eq!(score(&truths, &answers, &[]), before);
}

#[test]
fn an_interval_without_an_end_goes_on_for_ever() {
    let truth = truth(1, Kind::Single, vec![concealed("friction", "slide", ("force_n", 1.0), 20.0)]);
    let open = json!({"name": "force_n", "value": 1.0, "lo": 0.9, "hi": null});
    let answer = answer(1, &[("friction", "slide", open)], false);
    let scored = ScoredCase::new(&truth, &answer);
    assert!(!scored.failed);
    assert_eq!(scored.covered(&truth.effects[0]), [("force_n".to_owned(), true)]);
}
