//! What a diagnosis must reach, and where it does not: METHOD's targets, met by the share itself, not by its interval.

use std::fmt;

use serde::{Serialize, Serializer};

use super::Part;

/// A number of a score that must not be below or above.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// What it counts.
    pub what: &'static str,
    /// The number; `None` where no case speaks about it.
    of: fn(&Part) -> Option<f64>,
    /// Least and most, both inclusive.
    pub from: f64,
    #[allow(missing_docs)]
    pub to: f64,
}

/// A target that a score misses. Its `Display` is the sentence.
#[derive(Debug, Clone, Copy)]
pub struct Missed {
    /// What was to be reached.
    pub target: &'static Target,
    /// What was.
    pub share: f64,
}

const fn least(what: &'static str, from: f64, of: fn(&Part) -> Option<f64>) -> Target {
    Target { what, of, from, to: 1.0 }
}

const fn most(what: &'static str, to: f64, of: fn(&Part) -> Option<f64>) -> Target {
    Target { what, of, from: 0.0, to }
}

static TARGETS: [Target; 9] = [
    most("false names on clean data", 0.02, |part| part.clean.false_names.share()),
    least("right when it names", 0.95, |part| part.right_when_named.share()),
    least("name and place of one identifiable effect", 0.9, |part| part.single.location_ok.share()),
    least("truth inside the reported class", 0.95, |part| part.single.in_class.share()),
    least("unknown physics called unexplained", 0.9, |part| part.unknown.called_unknown.share()),
    most("unknown physics wrongly named", 0.05, |part| part.unknown.wrongly_named.share()),
    least("both of two identifiable effects found", 0.6, |part| part.pairs.both_found.share()),
    Target {
        what: "95 % intervals that hold the truth",
        of: |part| part.coverage.all.share(),
        from: 0.9,
        to: 0.98,
    },
    Target {
        what: "held-out gain over the oracle's",
        of: |part| part.gain_over_oracle,
        from: 0.9,
        to: f64::INFINITY,
    },
];

/// The targets that a score misses; what no case speaks about is not missed.
pub fn missed(part: &Part) -> Vec<Missed> {
    let of_target = |target: &'static Target| {
        let share = (target.of)(part)?;
        (share < target.from || share > target.to).then_some(Missed { target, share })
    };
    TARGETS.iter().filter_map(of_target).collect()
}

impl fmt::Display for Missed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        let Target { what, from, to, .. } = *self.target;
        write!(f, "{what}: {}, wanted ", percent(self.share))?;
        match (from, to) {
            (from, to) if from > 0.0 && to < 1.0 => write!(f, "{} to {}", percent(from), percent(to)),
            (from, _) if from > 0.0 => write!(f, "at least {}", percent(from)),
            (_, to) => write!(f, "at most {}", percent(to)),
        }
    }
}

impl PartialEq for Missed {
    fn eq(&self, other: &Missed) -> bool {
        self.target.what == other.target.what && self.share == other.share
    }
}

/// The sentence.
impl Serialize for Missed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Clean, Coverage, Rate};
    use super::*;

    #[test]
    fn what_is_missed_is_said_and_what_nobody_asked_is_not() {
        let part = Part {
            clean: Clean { false_names: Rate { count: 3, of: 100 }, ..Clean::default() },
            coverage: Coverage { all: Rate { count: 99, of: 100 }, ..Coverage::default() },
            gain_over_oracle: Some(0.95),
            ..Part::default()
        };
        assert_eq!(
            missed(&part).iter().map(Missed::to_string).collect::<Vec<_>>(),
            [
                "false names on clean data: 3.0 %, wanted at most 2.0 %",
                "95 % intervals that hold the truth: 99.0 %, wanted 90.0 % to 98.0 %"
            ]
        );
    }
}
