//! A number of a law, for people.

/// A number of a law with its 95 % interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// Symbol in formulas: `c1`.
    pub symbol: String,
    /// What it is called in sentences.
    pub name: String,
    /// Unit for people; nothing for a plain number.
    pub unit: String,
    /// Estimate, in the unit.
    pub value: f64,
    /// Lower end of the 95 % interval, in the unit.
    pub low: f64,
    /// Upper end of the 95 % interval, in the unit.
    pub high: f64,
    /// Other values within the interval that these data do not distinguish from it, each apart from
    /// the rest: periods that every reading meets alike.
    pub also: Vec<f64>,
    /// The end of the interval that these data do not determine: it is where the search ended.
    pub open: Option<OpenEnd>,
}

/// An end of an interval that is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OpenEnd {
    /// It may be as small as it likes.
    Low,
    /// It may be as large as it likes.
    High,
}
