//! Numbers that a model has from files, and what a recording says of them.

/// A number of the model's file, or of the rig's set-up.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NominalParameter {
    /// For people: `E of steel`.
    pub name: String,
    /// Unit for people.
    pub unit: &'static str,
    /// What one unit is in SI.
    pub si: f64,
    /// Nominal value, SI.
    pub value: f64,
    /// Standard uncertainty, SI.
    pub standard_uncertainty: f64,
}

/// What a recording says of a nominal number.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NominalEstimate {
    /// The number.
    pub number: NominalParameter,
    /// Estimate and 95 % interval, SI.
    pub estimate: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl NominalEstimate {
    /// How far it moved, in standard uncertainties.
    pub fn moved(&self) -> f64 {
        (self.estimate - self.number.value) / self.number.standard_uncertainty
    }
}
