//! Places where a law may act, each with the number that it may be a function of.

use super::form::Form;
use crate::inference::Location;

/// A quantity: how it is written and said, and its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// In formulas: `F`.
    pub symbol: &'static str,
    /// In sentences: `load`.
    pub name: String,
    /// Unit for people; nothing for a plain number.
    pub unit: &'static str,
    /// What one unit is in SI.
    pub si: f64,
}

/// Data that follow one another, for laws that remember.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// In their order.
    pub instants: Vec<Instant>,
    /// The variable before the first of them.
    pub start: f64,
}

/// What was read at once.
#[derive(Debug, Clone, PartialEq)]
pub struct Instant {
    /// Numbers of the data that were read then, from 0.
    pub data: Vec<usize>,
    /// Time since the variable was changed to what it is, s; NaN where nobody knows.
    pub elapsed: f64,
    /// −1 where the variable is the size of what points against its course, or else 1.
    pub sense: f64,
}

/// A variable that data show.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// All data as they were recorded, SI.
    pub data: Vec<f64>,
    /// The datum that shows the variable of each, and the sign with which; nothing where none does.
    pub by: Vec<Option<(usize, f64)>>,
    /// True where the variable is shown with what the law adds to it, and not without.
    pub with_law: bool,
}

impl Recorded {
    /// Of a sensor whose law is a function of what it should show.
    pub fn by_itself(data: Vec<f64>) -> Recorded {
        let by = (0..data.len()).map(|i| Some((i, 1.0))).collect();
        Recorded { data, by, with_law: false }
    }
}

/// A place with a variable.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Site {
    /// The part of rig, rod or robot that the law changes.
    pub location: Location,
    /// What the law changes there: `displacement along the load`.
    pub result: Measure,
    /// What it is a function of.
    pub variable: Measure,
    /// A name (nothing where there is one only), and what one SI unit of the result does to each
    /// datum: an amplitude each.
    pub directions: Vec<(String, Vec<f64>)>,
    /// The variable at each datum, SI; NaN where the law has nothing to say.
    pub values: Vec<f64>,
    /// Where the variable is what data show: `values` are the predicted ones, whose scale is as
    /// uncertain as the model's.
    pub recorded: Option<Recorded>,
    /// For each datum 1 where the load went up to it, −1 where it came down; nothing where the
    /// variable is no load.
    pub moves: Vec<f64>,
    /// See [`Course`]; nothing where a law can not remember.
    pub courses: Vec<Course>,
    /// Forms that have a meaning there.
    pub forms: &'static [Form],
    /// Those of them that are rare there: a solid part gives way as what holds it does, but seldom.
    pub rare: &'static [Form],
}

/// What a rare form's prior is beside that of another.
const RARE: f64 = 0.2;
/// Values of a variable that differ by less than this share of its range are the same.
const SAME: f64 = 1e-6;

impl Site {
    /// A place where a law of these `forms` changes `result` as a function of `variable`, by
    /// `directions` (a name and a number per datum each), the variable being `values` (SI, one per
    /// datum): without memory, and predicted rather than recorded.
    pub fn new(
        location: Location,
        result: Measure,
        variable: Measure,
        directions: Vec<(String, Vec<f64>)>,
        values: Vec<f64>,
        forms: &'static [Form],
    ) -> Site {
        let (moves, courses) = (vec![0.0; values.len()], Vec::new());
        Site {
            location,
            result,
            variable,
            directions,
            values,
            recorded: None,
            moves,
            courses,
            forms,
            rare: &[],
        }
    }

    /// What the prior of a form is there beside that of one that is not rare.
    pub fn share(&self, form: Form) -> f64 {
        if self.rare.iter().any(|own| own.is(form)) { RARE } else { 1.0 }
    }

    /// True where the law is of what gives way.
    pub fn gives_way(&self) -> bool {
        self.forms == Form::GIVING_WAY
    }

    /// Data that the law concerns.
    pub fn concerned(&self) -> impl Iterator<Item = usize> + '_ {
        let acts = |i: usize| self.directions.iter().any(|(_, weights)| weights[i] != 0.0);
        (0..self.values.len()).filter(move |&i| self.values[i].is_finite() && acts(i))
    }

    /// Least and largest value.
    pub fn range(&self) -> (f64, f64) {
        let values = self.concerned().map(|i| self.values[i]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)))
    }

    /// X, the largest size.
    pub fn largest(&self) -> f64 {
        let (low, high) = self.range();
        low.abs().max(high.abs())
    }

    /// How many different values there are.
    pub fn levels(&self) -> usize {
        let mut values: Vec<f64> = self.concerned().map(|i| self.values[i]).collect();
        values.sort_by(f64::total_cmp);
        let (low, high) = self.range();
        values.dedup_by(|a, b| (*a - *b).abs() <= SAME * (high - low));
        values.len()
    }
}
