//! Laws of a rod's file: formulas for what its beam model leaves out.
//!
//! ```text
//! place        what the formula adds                                   in
//! rod          to the load F that bends the rod, y = C·(F + ΔF)        N
//!              over the load, or over the deflection along it, y = C·(F + ΔF(y))
//!              or, over other variables, to the deflection, a share of it   %
//! clamp        to the displacement along the load                      µm
//! root, joint  to the turn about the moment there                      µrad
//! slide        to the last change of the deflection, a share of it     %
//! dx, dy, dz   to what a sensor shows                                  µm
//! ```

mod memory;
mod place;

use std::fmt;

pub use self::memory::{LawMemory, MemoryConstant};
pub use self::place::RodLawPlace;
use crate::expression::{Expression, Fault};

/// 1 on the way up, −1 on the way down, in formulas.
pub(crate) const SIDE: &str = "side";
/// A number that was read again is no other.
const BEYOND: f64 = 1.0 + 1e-9;

/// What a law is a function of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LawVariable {
    /// The size of the load.
    Load,
    /// The load along the positive axes.
    AlongPositive,
    /// The load along the negative axes.
    AlongNegative,
    /// The load that hung before.
    LoadBefore,
    /// The moment at the place.
    Moment,
    /// What the sensor should show.
    Reading,
    /// How far the rod is deflected along the load, where that acts.
    Deflection,
    /// The time since the load was changed.
    SinceChange,
    /// The change of the load over the time that it took, positive where the load grew.
    LoadingSpeed,
}

/// A number of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct LawConstant {
    /// In the formula.
    pub name: String,
    /// In the unit.
    pub value: f64,
    /// In the unit; 0 is exact.
    pub standard_uncertainty: f64,
    /// Its correlation coefficients with the constants before it (GUM 5.2.2); nothing where it has
    /// none.
    pub correlation: Vec<f64>,
    /// For people: the formula's own units say what it is.
    pub unit: String,
}

/// A law of a rod's file.
#[derive(Debug, Clone)]
pub struct RodLaw {
    /// Where it acts.
    pub place: RodLawPlace,
    /// What it is a function of.
    pub variable: LawVariable,
    /// In the variable, `side` and the constants; see the [module](self) for its unit.
    pub formula: String,
    /// What it remembers.
    pub memory: Option<LawMemory>,
    /// Its numbers.
    pub constants: Vec<LawConstant>,
    /// From where to where the variable was recorded, in its unit.
    pub range: (f64, f64),
    /// Where it comes from.
    pub source: Option<String>,
    expression: Expression,
}

impl PartialEq for RodLaw {
    /// The expression is that of the formula.
    fn eq(&self, other: &RodLaw) -> bool {
        (&self.place, self.variable, &self.formula, self.memory)
            == (&other.place, other.variable, &other.formula, other.memory)
            && (&self.constants, self.range, &self.source) == (&other.constants, other.range, &other.source)
    }
}

/// How often, and by which part of what is missing, a value that depends on itself is corrected:
/// by small steps, so that what is steeper than 1 ends at one of its roots.
pub(crate) const ROUNDS: usize = 60;
pub(crate) const STEP: f64 = 0.3;

/// What a sensor should have shown: y of y + Δy(y) = what it showed.
pub(crate) fn should_show(showed: f64, law: impl Fn(f64) -> f64) -> f64 {
    let mut y = showed;
    for _ in 0..ROUNDS {
        y += STEP * (showed - law(y) - y);
    }
    // a law that grows without bounds has no such y
    if y.is_finite() { y } else { showed }
}

impl LawVariable {
    /// All of them.
    pub const ALL: [LawVariable; 9] = [
        LawVariable::Load,
        LawVariable::AlongPositive,
        LawVariable::AlongNegative,
        LawVariable::LoadBefore,
        LawVariable::Moment,
        LawVariable::Reading,
        LawVariable::Deflection,
        LawVariable::SinceChange,
        LawVariable::LoadingSpeed,
    ];

    /// In files.
    pub fn key(self) -> &'static str {
        match self {
            LawVariable::Load => "load",
            LawVariable::AlongPositive => "load_along_positive_axes",
            LawVariable::AlongNegative => "load_along_negative_axes",
            LawVariable::LoadBefore => "load_before",
            LawVariable::Moment => "moment",
            LawVariable::Reading => "reading",
            LawVariable::Deflection => "deflection",
            LawVariable::SinceChange => "time_since_change_s",
            LawVariable::LoadingSpeed => "loading_speed_n_per_s",
        }
    }

    /// In sentences.
    pub fn description(self) -> &'static str {
        match self {
            LawVariable::Load => "load",
            LawVariable::AlongPositive => "load along the positive axes",
            LawVariable::AlongNegative => "load along the negative axes",
            LawVariable::LoadBefore => "load that hung before",
            LawVariable::Moment => "moment",
            LawVariable::Reading => "reading",
            LawVariable::Deflection => "deflection along the load",
            LawVariable::SinceChange => "time since the load was changed",
            LawVariable::LoadingSpeed => "speed of loading",
        }
    }

    /// In formulas.
    pub fn symbol(self) -> &'static str {
        match self {
            LawVariable::Load | LawVariable::AlongPositive | LawVariable::AlongNegative => "F",
            LawVariable::LoadBefore => "F'",
            LawVariable::Moment => "M",
            LawVariable::Reading => "y",
            LawVariable::Deflection => "u",
            LawVariable::SinceChange => "t",
            LawVariable::LoadingSpeed => "v",
        }
    }

    /// For people.
    pub fn unit(self) -> &'static str {
        match self {
            LawVariable::Moment => "N·m",
            LawVariable::Reading | LawVariable::Deflection => "µm",
            LawVariable::SinceChange => "s",
            LawVariable::LoadingSpeed => "N/s",
            LawVariable::Load
            | LawVariable::AlongPositive
            | LawVariable::AlongNegative
            | LawVariable::LoadBefore => "N",
        }
    }

    /// True where values of both signs are usual: a law is odd in it.
    pub(crate) fn has_both_signs(self) -> bool {
        matches!(self, LawVariable::Reading | LawVariable::LoadingSpeed)
    }

    /// True where a law of the rod adds to the load that bends it, N: over all else it adds a share
    /// of the deflection.
    pub(crate) fn adds_load(self) -> bool {
        matches!(self, LawVariable::Load | LawVariable::Deflection)
    }

    /// True where a law of this variable may act at a place.
    pub fn is_at(self, place: &RodLawPlace) -> bool {
        match place {
            RodLawPlace::Rod => !matches!(self, LawVariable::Moment | LawVariable::Reading),
            RodLawPlace::Clamp => self == LawVariable::Load,
            RodLawPlace::Slide => self == LawVariable::SinceChange,
            RodLawPlace::Sensor(_) => self == LawVariable::Reading,
            RodLawPlace::Root | RodLawPlace::Bend | RodLawPlace::Joint(_) => self == LawVariable::Moment,
        }
    }
}

impl RodLaw {
    /// A law at a place, its formula read.
    ///
    /// # Errors
    /// A [`Fault`] of the formula with its place in it.
    pub fn new(
        place: RodLawPlace,
        variable: LawVariable,
        formula: impl Into<String>,
        constants: Vec<LawConstant>,
        range: (f64, f64),
    ) -> Result<RodLaw, Fault> {
        let formula = formula.into();
        let names = [variable.symbol(), SIDE].into_iter();
        let names: Vec<&str> = names.chain(constants.iter().map(|own| own.name.as_str())).collect();
        let expression = Expression::new(&formula, &names)?;
        Ok(RodLaw { place, variable, formula, memory: None, constants, range, source: None, expression })
    }

    /// The law at x, in the units of its file; `side` is 1 on the way up and −1 on the way down.
    pub fn at(&self, x: f64, side: f64) -> f64 {
        self.with(x, side, |own| own.value)
    }

    /// The same with other values of the constants.
    pub fn with(&self, x: f64, side: f64, value: impl Fn(&LawConstant) -> f64) -> f64 {
        let mut values = vec![x, side];
        values.extend(self.constants.iter().map(value));
        self.expression.at(&values)
    }

    /// What a law of the rod does to its tip is known wherever the rod is; a law of the rig (clamp,
    /// slide, sensors) stays there.
    pub fn is_of_rod(&self) -> bool {
        self.place.is_of_rod()
    }

    /// True where the load that hangs now is all it takes to know what the law does.
    pub fn is_static(&self) -> bool {
        let of_now = !matches!(
            self.variable,
            LawVariable::LoadBefore | LawVariable::SinceChange | LawVariable::LoadingSpeed
        );
        let [up, down] = [1.0, -1.0].map(|side| self.at(self.range.1, side));
        of_now && self.memory.is_none() && up == down
    }

    /// Unit of what the formula adds, for people.
    pub fn unit(&self) -> &'static str {
        match &self.place {
            RodLawPlace::Rod if self.variable.adds_load() => "N",
            RodLawPlace::Rod | RodLawPlace::Slide => "%",
            RodLawPlace::Clamp | RodLawPlace::Sensor(_) => "µm",
            RodLawPlace::Root | RodLawPlace::Bend | RodLawPlace::Joint(_) => "µrad",
        }
    }

    /// Symbol of what the formula adds to.
    pub fn result(&self) -> &'static str {
        match &self.place {
            RodLawPlace::Rod if self.variable.adds_load() => "ΔF",
            RodLawPlace::Rod | RodLawPlace::Slide => "Δu/u",
            RodLawPlace::Clamp => "Δu",
            RodLawPlace::Sensor(_) => "Δy",
            RodLawPlace::Root | RodLawPlace::Bend | RodLawPlace::Joint(_) => "Δθ",
        }
    }

    /// True where x (in its unit) is beyond what was recorded. From zero on everything was: what a
    /// rod shows is an offset from the unloaded one.
    pub fn is_beyond(&self, x: f64) -> bool {
        x > self.range.1 * BEYOND || x < self.range.0.min(0.0) * BEYOND
    }
}

/// `ΔF = k*max(F - F_0, 0) in N at the rod, k = −0.34 N/N, F_0 = 7.7 N, for F from 1 to 10 N`.
impl fmt::Display for RodLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let significant = |x: f64| crate::units::significant(x, 3);
        write!(f, "{} = {} in {} at {}", self.result(), self.formula, self.unit(), self.place.description())?;
        for own in &self.constants {
            let number = format!(", {} = {} {}", own.name, significant(own.value), own.unit);
            f.write_str(number.trim_end())?;
        }
        let (symbol, unit, (low, high)) = (self.variable.symbol(), self.variable.unit(), self.range);
        write!(f, ", for {symbol} from {} to {} {unit}", significant(low), significant(high))?;
        f.write_str(self.memory.map_or("", LawMemory::description))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn constant(name: &str, value: f64) -> LawConstant {
        LawConstant {
            name: name.into(),
            value,
            standard_uncertainty: 0.0,
            correlation: Vec::new(),
            unit: String::new(),
        }
    }

    #[test]
    fn a_sensor_should_have_shown_what_with_its_law_it_showed() {
        for (amplitude, period) in [(5.0, 130.0), (10.0, 52.0)] {
            let law = |y: f64| amplitude * (std::f64::consts::TAU * y / period).sin();
            for showed in [0.0, 37.0, 210.0, 398.0] {
                let y = should_show(showed, law);
                assert!((y + law(y) - showed).abs() < 1e-3, "{showed}: {y}");
            }
        }
    }

    #[test]
    fn a_law_is_its_formula() {
        let constants = vec![constant("k", -0.5), constant("F_0", 4.0)];
        let law =
            RodLaw::new(RodLawPlace::Rod, LawVariable::Load, "k*max(F - F_0, 0)", constants, (1.0, 10.0))
                .unwrap();
        assert_eq!((law.at(3.0, 1.0), law.at(10.0, 1.0), law.unit()), (0.0, -3.0, "N"));
        assert!(law.is_of_rod() && law.is_static());
        assert!(!law.is_beyond(0.5) && law.is_beyond(10.1) && law.is_beyond(-0.1));
        let sided =
            RodLaw::new(RodLawPlace::Clamp, LawVariable::Load, "2*side*F", Vec::new(), (1.0, 10.0)).unwrap();
        assert!(!sided.is_of_rod() && !sided.is_static());
        let fault =
            RodLaw::new(RodLawPlace::Rod, LawVariable::Load, "k*M", Vec::new(), (0.0, 1.0)).unwrap_err();
        assert_eq!(fault.found, "\"k\"");
    }
}
