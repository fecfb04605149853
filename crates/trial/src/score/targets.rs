//! What a diagnosis must reach, and where it does not: met by the share itself, not by its
//! interval.

use super::data::Part;
use super::target::{Measured, Reached, Target};

/// A target, and how it is measured.
type OfPart = (Target, fn(&Part) -> Measured);

const fn least(what: &'static str, from: f64, measure: fn(&Part) -> Measured) -> OfPart {
    (Target { what, from, to: 1.0 }, measure)
}

const fn most(what: &'static str, to: f64, measure: fn(&Part) -> Measured) -> OfPart {
    (Target { what, from: 0.0, to }, measure)
}

use Measured::{Number, Rate as Share};

static TARGETS: [OfPart; 13] = [
    least("clean recordings without any finding", 0.98, |part| Share(part.clean.silent)),
    least("right, or not distinguishable, when it names", 0.95, |part| Share(part.right_or_inseparable)),
    least("name and place of one identifiable effect", 0.95, |part| Share(part.single.location_ok)),
    least("truth inside the reported class", 0.97, |part| Share(part.single.in_class)),
    least("both of two identifiable effects found", 0.85, |part| Share(part.pairs.both_found)),
    least("unknown physics called unexplained", 0.95, |part| Share(part.unknown.called_unknown)),
    most("unknown physics wrongly named", 0.02, |part| Share(part.unknown.wrongly_named)),
    (Target { what: "95 % intervals that hold the truth", from: 0.92, to: 0.98 }, |part| {
        Share(part.coverage.all)
    }),
    least("mistakes named", 0.95, |part| Share(part.mistakes.named)),
    most("mistakes without any finding", 0.0, |part| Share(part.mistakes.silent)),
    most("mistakes named where none was made", 0.0, |part| Share(part.mistakes.invented)),
    most("misread readings reported as findings", 0.0, |part| Share(part.suspects.named)),
    (Target { what: "held-out gain over the oracle's", from: 0.95, to: f64::INFINITY }, |part| {
        Number(part.gain_over_oracle)
    }),
];

/// Every target that a case speaks about, missed ones first.
pub fn reached(part: &Part) -> Vec<Reached> {
    let of_target = |(target, measure): &'static OfPart| Reached { target, measured: measure(part) };
    let all = TARGETS.iter().map(of_target).filter(|reached| reached.measured.value().is_some());
    let (missed, met): (Vec<Reached>, Vec<Reached>) = all.partition(|reached| reached.missed().is_some());
    missed.into_iter().chain(met).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Clean, Coverage, Rate};
    use super::*;

    #[test]
    fn what_is_missed_comes_first_and_what_nobody_asked_is_not_there() {
        let part = Part {
            clean: Clean { silent: Rate { count: 97, total: 100 }, ..Clean::default() },
            coverage: Coverage { all: Rate { count: 99, total: 100 }, ..Coverage::default() },
            right_or_inseparable: Rate { count: 96, total: 100 },
            gain_over_oracle: Some(0.96),
            ..Part::default()
        };
        let reached = reached(&part);
        assert_eq!(reached.len(), 4);
        let missed: Vec<String> =
            reached.iter().filter_map(Reached::missed).map(|missed| missed.to_string()).collect();
        assert_eq!(
            missed,
            [
                "clean recordings without any finding: 97.0 %, wanted at least 98.0 %",
                "95 % intervals that hold the truth: 99.0 %, wanted 92.0 % to 98.0 %"
            ]
        );
        assert!(reached[..2].iter().all(|reached| reached.missed().is_some()));
        let json = serde_json::to_value(reached[0]).unwrap();
        assert_eq!((&json["count"], &json["met"]), (&97.into(), &false.into()));
        assert!((json["lo"].as_f64().unwrap() - 0.9155).abs() < 5e-4, "{json}");
    }
}
