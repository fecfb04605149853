//! What a diagnosis must reach, and where it does not: met by the share itself, not by its
//! interval.

use std::fmt;

use serde::{Serialize, Serializer};
use serde_json::json;

use super::Part;
use super::rate::Rate;

/// What is measured against a target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measured {
    /// A share of cases.
    Rate(Rate),
    /// A number; `None` where no case has one.
    Number(Option<f64>),
}

impl Measured {
    /// The share or the number.
    pub fn value(&self) -> Option<f64> {
        match self {
            Measured::Rate(rate) => rate.share(),
            Measured::Number(number) => *number,
        }
    }
}

/// A number of a score that must not be below or above.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// What it counts.
    pub what: &'static str,
    of: fn(&Part) -> Measured,
    /// Least and most, both inclusive.
    pub from: f64,
    #[allow(missing_docs)]
    pub to: f64,
}

/// A target, and what a score has of it.
#[derive(Debug, Clone, Copy)]
pub struct Reached {
    /// What was to be reached.
    pub target: &'static Target,
    /// What was.
    pub measured: Measured,
}

/// A target that a score misses. Its `Display` is the sentence.
#[derive(Debug, Clone, Copy)]
pub struct Missed {
    /// What was to be reached.
    pub target: &'static Target,
    /// What was.
    pub share: f64,
}

const fn least(what: &'static str, from: f64, of: fn(&Part) -> Measured) -> Target {
    Target { what, of, from, to: 1.0 }
}

const fn most(what: &'static str, to: f64, of: fn(&Part) -> Measured) -> Target {
    Target { what, of, from: 0.0, to }
}

use Measured::{Number, Rate as Share};

static TARGETS: [Target; 13] = [
    least("clean recordings without any finding", 0.98, |part| Share(part.clean.silent)),
    least("right when it names", 0.95, |part| Share(part.right_or_inseparable)),
    least("name and place of one identifiable effect", 0.95, |part| Share(part.single.location_ok)),
    least("truth inside the reported class", 0.97, |part| Share(part.single.in_class)),
    least("both of two identifiable effects found", 0.85, |part| Share(part.pairs.both_found)),
    least("unknown physics called unexplained", 0.95, |part| Share(part.unknown.called_unknown)),
    most("unknown physics wrongly named", 0.02, |part| Share(part.unknown.wrongly_named)),
    Target {
        what: "95 % intervals that hold the truth",
        of: |part| Share(part.coverage.all),
        from: 0.92,
        to: 0.98,
    },
    least("mistakes named", 0.95, |part| Share(part.mistakes.named)),
    most("mistakes without any finding", 0.0, |part| Share(part.mistakes.silent)),
    most("mistakes named where none was made", 0.0, |part| Share(part.mistakes.invented)),
    most("misread readings reported as findings", 0.0, |part| Share(part.suspects.named)),
    Target {
        what: "held-out gain over the oracle's",
        of: |part| Number(part.gain_over_oracle),
        from: 0.95,
        to: f64::INFINITY,
    },
];

/// Every target that a case speaks about, missed ones first.
pub fn reached(part: &Part) -> Vec<Reached> {
    let of_target = |target: &'static Target| Reached { target, measured: (target.of)(part) };
    let all = TARGETS.iter().map(of_target).filter(|reached| reached.measured.value().is_some());
    let (missed, met): (Vec<Reached>, Vec<Reached>) = all.partition(|reached| reached.missed().is_some());
    missed.into_iter().chain(met).collect()
}

impl Target {
    /// `at least 95.0 %`.
    pub fn wanted(&self) -> String {
        match (self.from, self.to) {
            (from, to) if from > 0.0 && to < 1.0 => format!("{} to {}", percent(from), percent(to)),
            (from, _) if from > 0.0 => format!("at least {}", percent(from)),
            (_, 0.0) => "none".into(),
            (_, to) => format!("at most {}", percent(to)),
        }
    }
}

impl Reached {
    /// The target, if it is missed.
    pub fn missed(&self) -> Option<Missed> {
        let share = self.measured.value()?;
        let Target { from, to, .. } = *self.target;
        (share < from || share > to).then_some(Missed { target: self.target, share })
    }
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

impl fmt::Display for Missed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}, wanted {}", self.target.what, percent(self.share), self.target.wanted())
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

/// `    clean recordings without any finding    36 of 40, 90.0 % (76.9 to 96.0); wanted at least 98.0 %`.
impl fmt::Display for Reached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.missed().is_some() { "missed" } else { "met" };
        write!(f, "{verdict:6} {:44} ", self.target.what)?;
        match &self.measured {
            Share(rate) => write!(f, "{rate}")?,
            Number(number) => write!(f, "{}", percent(number.unwrap_or(f64::NAN)))?,
        }
        write!(f, "; wanted {}", self.target.wanted())
    }
}

impl PartialEq for Reached {
    fn eq(&self, other: &Reached) -> bool {
        self.target.what == other.target.what && self.measured == other.measured
    }
}

/// `{"what", "count", "of", "share", "lo", "hi", "from", "to", "met"}`.
impl Serialize for Reached {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (count, interval) = match &self.measured {
            Share(rate) => (Some(rate), rate.interval()),
            Number(_) => (None, None),
        };
        json!({
            "what": self.target.what,
            "count": count.map(|rate| rate.count), "of": count.map(|rate| rate.of),
            "share": self.measured.value(), "lo": interval.map(|ends| ends[0]), "hi": interval.map(|ends| ends[1]),
            "from": self.target.from, "to": if self.target.to.is_finite() { Some(self.target.to) } else { None },
            "met": self.missed().is_none(),
        })
        .serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Clean, Coverage};
    use super::*;

    #[test]
    fn what_is_missed_comes_first_and_what_nobody_asked_is_not_there() {
        let part = Part {
            clean: Clean { silent: Rate { count: 97, of: 100 }, ..Clean::default() },
            coverage: Coverage { all: Rate { count: 99, of: 100 }, ..Coverage::default() },
            right_or_inseparable: Rate { count: 96, of: 100 },
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
