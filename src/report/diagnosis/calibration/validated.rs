//! What the findings are worth at the validation poses, of which no search has seen any.

use crate::diagnosis::Limitation;
use crate::diagnosis::calibration::{CalibrationDiagnosis, Validated};
use crate::inference::Finding;
use crate::report::diagnosis::headline::{from_to, size};
use crate::report::diagnosis::subject::Elsewhere;
use crate::units::significant;

/// What a report says of the validation; `None` where there is none, or nothing to say.
pub fn elsewhere(found: &CalibrationDiagnosis) -> Option<Elsewhere> {
    let (validated, words) = (found.model.validated.as_ref()?, sentence(found)?);
    let (before, after) = validated.means();
    let own = validated.own.as_ref().filter(|own| !own.events.is_empty());
    let detail = match own {
        Some(own) => format!("{} without errors of their own", size(own.mean())),
        None => "of poses that no search has seen".to_owned(),
    };
    let value = after.map_or_else(|| size(before), |after| format!("{} → {}", size(before), size(after)));
    Some(Elsewhere { words, value, detail, is_far: validated.is_far(), is_mismatch: validated.is_mismatch() })
}

/// `At the 62 validation poses, which no search has seen, the error falls from 403 to 290 µm on
/// average.`
fn sentence(found: &CalibrationDiagnosis) -> Option<String> {
    let is_fitted = !found.limits.contains(&Limitation::NotConverged);
    let validated = found.model.validated.as_ref().filter(|_| is_fitted)?;
    let (before, after) = validated.means();
    let poses = format!("At the {} validation poses, which no search has seen,", validated.before.len());
    let there = match after {
        Some(after) if validated.is_worse() => {
            format!("with what was found the error grows {} on average", from_to(before, after))
        }
        Some(after) if after < before && size(after) != size(before) => {
            format!("the error falls {} on average", from_to(before, after))
        }
        Some(after) => {
            let (before, after) = (size(before), size(after));
            format!("the error is {before} on average, and {after} with what was found")
        }
        None => format!("the error is {} on average", size(before)),
    };
    let is_lost = after.is_none() && found.diagnosis.findings.iter().any(Finding::is_of_model);
    let is_written = if is_lost { "; nothing of what was found can be written for them" } else { "" };
    let far = far(validated);
    // as little as was expected says nothing more of no finding
    if after.is_none() && !is_lost && far.is_empty() {
        return None;
    }
    Some(format!("{poses} {there}{is_written}{far}."))
}

/// Said where the error is far from what poses of the recording lead to expect.
fn far(validated: &Validated) -> String {
    if !validated.is_far() {
        return String::new();
    }
    let (expected, (before, after)) = (validated.expected, validated.means());
    let whose = if validated.is_held_out { "the poses held out" } else { "the poses of the calibration" };
    let times = times(after.unwrap_or(before) / expected);
    let times = format!(": {times} times that of {whose} ({})", size(expected));
    let unlike = "which say nothing of poses like these";
    let Some(own) = &validated.own else { return format!("{times}, {unlike}") };
    let events = match own.events.is_empty() {
        true => String::new(),
        false => {
            let (events, left) = (own.events.join("; "), size(own.mean()));
            let perhaps = if own.explain(expected) { "" } else { " perhaps" };
            format!(". They show{perhaps} errors of their own: {events}. Without these the error is {left}")
        }
    };
    if own.explain(expected) {
        return times + &events;
    }
    let rest = match (own.of_robot.is_empty(), own.unexplained.as_deref()) {
        (false, _) => format!("here the robot shows {}", own.of_robot.join("; ")),
        (true, Some("")) => "an error that no effect explains".to_owned(),
        (true, Some(follows)) => format!("an unexplained error {follows}"),
        (true, None) => {
            let scatter = size(own.scatter);
            return format!(
                "{times}{events}. They scatter by {scatter} per coordinate and follow nothing that was recorded: they were measured less \
                 accurately, or the robot is wrong there in a way that so few poses do not show"
            );
        }
    };
    match events.is_empty() {
        true => format!("{times}, {unlike}: {rest}"),
        false => format!("{times}{events}; {rest}"),
    }
}

/// How many times; of an error that has nothing to do with the other, no number says more.
fn times(ratio: f64) -> String {
    if ratio < 1e3 { significant(ratio, 2) } else { "over 1000".to_owned() }
}

/// What nobody should use.
pub fn warning(validated: &Validated) -> Option<String> {
    let (before, after) = validated.means();
    after.filter(|_| validated.is_worse()).map(|after| {
        format!(
            "the corrected robot is worse at the validation poses: {} on average, {} without the findings; do not use it",
            size(after),
            size(before)
        )
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::super::figures::tests::with_diagnosed;
    use super::*;
    use crate::diagnosis::calibration::OwnDiagnosis;
    use crate::report::diagnosis::calibration::{json, report};
    use crate::units::UM;

    fn um(mean: f64) -> Vec<f64> {
        vec![0.8 * mean * UM, 1.2 * mean * UM]
    }

    #[test]
    fn what_findings_are_worth_at_the_validation_is_said() {
        with_diagnosed(&|row| Vector3::z() * (5.0 * UM * row as f64), |_, found| {
            let own = found.model.validated.as_ref().expect("the campaign has validation poses");
            assert!(!own.is_worse() && !own.is_far() && own.after.is_some(), "{own:?}");
            let mut found = found.clone();
            let mut all = |before: f64,
                           after: Option<f64>,
                           causes: Option<(&str, f64)>,
                           of_robot: &[&str],
                           unexplained: Option<&str>| {
                let own = causes.map(|(event, left)| OwnDiagnosis {
                    events: if event.is_empty() { Vec::new() } else { vec![event.into()] },
                    errors: um(left),
                    of_robot: of_robot.iter().map(ToString::to_string).collect(),
                    unexplained: unexplained.map(str::to_owned),
                    scatter: 35.0 * UM,
                });
                let (before, after) = (um(before), after.map(um));
                let expected = 81.0 * UM;
                let validated = Validated { before, after, expected, is_held_out: true, own };
                found.model.validated = Some(validated);
                let (said, json) = (sentence(&found).unwrap(), json(&found));
                assert!(json["headline"].as_str().unwrap().ends_with(&said));
                let warnings = report(&found).warnings;
                let warned = warnings.iter().find(|warning| warning.contains("validation")).cloned();
                let events = json["distances"]["validation_events"].as_array().unwrap().len();
                (said.replace("At the 2 validation poses, which no search has seen, ", ""), warned, events)
            };
            let mut said = |before, after, causes| all(before, after, causes, &[], Some(""));
            let falls = said(136.0, Some(83.0), None);
            assert_eq!(falls, ("the error falls from 136 to 83 µm on average.".into(), None, 0));
            assert_eq!(
                said(136.0, Some(136.1), None).0,
                "the error is 136 µm on average, and 136 µm with what was found."
            );
            let nowhere =
                "the error is 136 µm on average; nothing of what was found can be written for them.";
            assert_eq!(said(136.0, None, None).0, nowhere);
            let worse = said(78.0, Some(606.0), None);
            assert_eq!(
                worse.0,
                "with what was found the error grows from 78 to 606 µm on average: 7.5 times that of the poses held out \
                 (81 µm), which say nothing of poses like these."
            );
            let warning = "the corrected robot is worse at the validation poses: 606 µm on average, 78 µm without the findings; do not use it";
            assert_eq!(worse.1.as_deref(), Some(warning));
            assert_eq!(
                said(403.0, Some(252.0), Some(("a shift", 158.0))),
                (
                    "the error falls from 403 to 252 µm on average: 3.1 times that of the poses held out (81 µm). They show \
                     errors of their own: a shift. Without these the error is 158 µm."
                        .into(),
                    None,
                    1
                )
            );
            let moved = |rest: &str| {
                let far = "the error falls from 403 to 252 µm on average: 3.1 times that of the poses held out (81 µm)";
                format!("{far}{rest}")
            };
            let mut far = |event: &str, left: f64, of_robot: &[&str], unexplained: Option<&str>| {
                all(403.0, Some(252.0), Some((event, left)), of_robot, unexplained).0
            };
            let events =
                ". They show perhaps errors of their own: a shift. Without these the error is 200 µm";
            let slow = Some("follows the order");
            for (said, rest) in [
                (far("a shift", 200.0, &["play (joint 3)"], slow), format!("{events}; here the robot shows play (joint 3).")),
                (far("a shift", 200.0, &[], slow), format!("{events}; an unexplained error follows the order.")),
                (
                    far("", 252.0, &[], Some("")),
                    ", which say nothing of poses like these: an error that no effect explains.".into(),
                ),
                (
                    far("", 252.0, &[], None),
                    ". They scatter by 35 µm per coordinate and follow nothing that was recorded: they were measured less \
                     accurately, or the robot is wrong there in a way that so few poses do not show."
                        .into(),
                ),
            ] {
                assert_eq!(said, moved(&rest));
            }
        });
    }

    /// Poses that are explained, and a validation that is not.
    #[test]
    fn a_validation_that_contradicts_the_poses_is_a_mismatch_and_said_first() {
        with_diagnosed(&|_| Vector3::zeros(), |_, found| {
            assert_eq!(json(found)["verdict"], "consistent");
            let mut found = found.clone();
            let mut verdict = |before: f64, events: &[&str]| {
                let own = OwnDiagnosis {
                    events: events.iter().map(ToString::to_string).collect(),
                    errors: um(before),
                    of_robot: Vec::new(),
                    unexplained: None,
                    scatter: before * UM,
                };
                let (before, expected) = (um(before), 30.0 * UM);
                let validated =
                    Validated { before, after: None, expected, is_held_out: true, own: Some(own) };
                found.model.validated = Some(validated);
                let (json, cards) = (json(&found), report(&found).cards);
                let card = cards.into_iter().find(|card| card.label == "Validation error").unwrap();
                let is_first = json["headline"].as_str().unwrap().starts_with("At the 2 validation poses");
                (json["verdict"].as_str().unwrap().to_owned(), is_first, card.value)
            };
            let mismatch = |value: &str| ("mismatch".to_owned(), true, value.to_owned());
            assert_eq!(verdict(100.0, &["a shift"]), mismatch("100 µm"));
            assert_eq!(verdict(900.0, &[]), mismatch("900 µm"));
            // a device that measures less accurately
            assert_eq!(verdict(100.0, &[]), ("consistent".to_owned(), false, "100 µm".to_owned()));
        });
    }
}
