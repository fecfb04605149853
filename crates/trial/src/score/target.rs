//! One target, and what a score has of it.

use std::fmt;

use serde::{Serialize, Serializer};
use serde_json::json;

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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// What it counts.
    pub what: &'static str,
    /// Least that reaches it.
    pub from: f64,
    /// Most that reaches it.
    pub to: f64,
}

/// A target, and what a score has of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    /// What was to be reached.
    pub target: &'static Target,
    /// What the score has of it.
    pub measured: Measured,
}

/// A target that a score misses. Its `Display` is the sentence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Missed {
    /// What was to be reached.
    pub target: &'static Target,
    /// The share that was reached.
    pub share: f64,
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

/// The sentence.
impl Serialize for Missed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// `met    clean recordings without any finding`, and below it, so that a terminal of 80 columns has
/// room, `       40 of 40, 100.0 % (91.2 to 100.0); wanted at least 98.0 %`.
impl fmt::Display for Reached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.missed().is_some() { "missed" } else { "met" };
        write!(f, "{verdict:6} {}\n       ", self.target.what)?;
        match &self.measured {
            Measured::Rate(rate) => write!(f, "{rate}")?,
            Measured::Number(number) => write!(f, "{}", percent(number.unwrap_or(f64::NAN)))?,
        }
        write!(f, "; wanted {}", self.target.wanted())
    }
}

/// `{"what", "count", "of", "share", "lo", "hi", "from", "to", "met"}`.
impl Serialize for Reached {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (count, interval) = match &self.measured {
            Measured::Rate(rate) => (Some(rate), rate.interval()),
            Measured::Number(_) => (None, None),
        };
        json!({
            "what": self.target.what,
            "count": count.map(|rate| rate.count), "of": count.map(|rate| rate.total),
            "share": self.measured.value(), "lo": interval.map(|ends| ends[0]), "hi": interval.map(|ends| ends[1]),
            "from": self.target.from, "to": if self.target.to.is_finite() { Some(self.target.to) } else { None },
            "met": self.missed().is_none(),
        })
        .serialize(serializer)
    }
}
