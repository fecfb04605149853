//! Laws of a rod's file: formulas for what its beam model leaves out.
//!
//! ```text
//! place        what the formula adds                                   in
//! rod          to the load F that bends the rod, y = C·(F + ΔF)        N
//!              or, over other variables than the load, to the deflection, a share of it   %
//! clamp        to the displacement along the load                      µm
//! root, joint  to the turn about the moment there                      µrad
//! slide        to the last change of the deflection, a share of it     %
//! dx, dy, dz   to what a sensor shows                                  µm
//! ```

mod place;

use std::fmt;

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
    /// The time since the load was changed.
    SinceChange,
    /// The change of the load over the time that it took, positive where the load grew.
    LoadingSpeed,
}

/// How what went before acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LawMemory {
    /// The formula's variable is what a play leaves of it; the constant `r` is half the play's
    /// width, in the unit of the variable.
    Stop,
    /// The formula's variable is where a play leaves it; the constant `r` is half the play's width.
    Play,
    /// The formula's variable is what two plays leave of it: the share `w1` of the one of half
    /// width `r1`, all else of that of half width `r`.
    TwoStops,
    /// The same of three plays, `r1` with `w1`, `r2` with `w2`, and `r`.
    ThreeStops,
    /// The formula's variable is z of a Bouc–Wen loop, dz/dx = 1 − (s·sgn(z·dx) + 1 − s)·|z/r|ⁿ;
    /// the constants `r`, in the unit of the variable, `n` and `s` = β/(β + γ).
    BoucWen,
    /// The formula's variable is what it lacks of its lagged self; the constant `tau` is the lag's
    /// time, s.
    Lag,
}

/// A constant that a memory needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemoryConstant {
    /// In files.
    pub name: &'static str,
    /// Its least and largest value; nothing where all above 0 are possible.
    pub range: Option<(f64, f64)>,
}

impl MemoryConstant {
    /// True for a value that it can have.
    pub fn may_be(&self, value: f64) -> bool {
        match self.range {
            None => value > 0.0,
            Some((low, high)) => low <= value && value <= high,
        }
    }

    /// `r > 0`, `n from 1 to 8`.
    pub fn description(&self) -> String {
        match self.range {
            None => format!("{} > 0", self.name),
            Some((low, high)) => format!("{} from {low} to {high}", self.name),
        }
    }
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

/// What a sensor should have shown: y of y + Δy(y) = what it showed, by small steps, so that a wave
/// steeper than 1 ends at one of its roots.
pub(crate) fn should_show(showed: f64, law: impl Fn(f64) -> f64) -> f64 {
    const ROUNDS: usize = 60;
    const STEP: f64 = 0.3;
    let mut y = showed;
    for _ in 0..ROUNDS {
        y += STEP * (showed - law(y) - y);
    }
    // a law that grows without bounds has no such y
    if y.is_finite() { y } else { showed }
}

impl LawVariable {
    /// All of them.
    pub const ALL: [LawVariable; 8] = [
        LawVariable::Load,
        LawVariable::AlongPositive,
        LawVariable::AlongNegative,
        LawVariable::LoadBefore,
        LawVariable::Moment,
        LawVariable::Reading,
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
            LawVariable::SinceChange => "t",
            LawVariable::LoadingSpeed => "v",
        }
    }

    /// For people.
    pub fn unit(self) -> &'static str {
        match self {
            LawVariable::Moment => "N·m",
            LawVariable::Reading => "µm",
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

impl LawMemory {
    /// All of them.
    pub const ALL: [LawMemory; 6] = [
        LawMemory::Stop,
        LawMemory::Play,
        LawMemory::TwoStops,
        LawMemory::ThreeStops,
        LawMemory::BoucWen,
        LawMemory::Lag,
    ];

    /// In files.
    pub fn key(self) -> &'static str {
        match self {
            LawMemory::Stop => "stop",
            LawMemory::Play => "play",
            LawMemory::TwoStops => "two_stops",
            LawMemory::ThreeStops => "three_stops",
            LawMemory::BoucWen => "bouc_wen",
            LawMemory::Lag => "lag",
        }
    }

    /// All keys, in a sentence: `"stop", "play" or "lag"`.
    pub fn keys() -> String {
        let quoted: Vec<String> =
            LawMemory::ALL.iter().map(|memory| format!("\"{}\"", memory.key())).collect();
        match quoted.split_last() {
            Some((last, others)) => format!("{} or {last}", others.join(", ")),
            None => String::new(),
        }
    }

    /// The constants that are its own.
    pub fn constants(self) -> &'static [MemoryConstant] {
        const fn own(name: &'static str, range: Option<(f64, f64)>) -> MemoryConstant {
            MemoryConstant { name, range }
        }
        const R: MemoryConstant = own("r", None);
        const FIRST: [MemoryConstant; 2] = [own("r1", None), own("w1", Some((0.0, 1.0)))];
        const SECOND: [MemoryConstant; 2] = [own("r2", None), own("w2", Some((0.0, 1.0)))];
        match self {
            LawMemory::Stop | LawMemory::Play => &[R],
            LawMemory::TwoStops => const { &[R, FIRST[0], FIRST[1]] },
            LawMemory::ThreeStops => const { &[R, FIRST[0], FIRST[1], SECOND[0], SECOND[1]] },
            LawMemory::BoucWen => const { &[R, own("n", Some((1.0, 8.0))), own("s", Some((0.5, 1.0)))] },
            LawMemory::Lag => const { &[own("tau", None)] },
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
            RodLawPlace::Rod if self.variable == LawVariable::Load => "N",
            RodLawPlace::Rod | RodLawPlace::Slide => "%",
            RodLawPlace::Clamp | RodLawPlace::Sensor(_) => "µm",
            RodLawPlace::Root | RodLawPlace::Bend | RodLawPlace::Joint(_) => "µrad",
        }
    }

    /// Symbol of what the formula adds to.
    pub fn result(&self) -> &'static str {
        match &self.place {
            RodLawPlace::Rod if self.variable == LawVariable::Load => "ΔF",
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
        f.write_str(match self.memory {
            Some(LawMemory::Stop) => ", of what a play leaves of it",
            Some(LawMemory::Play) => ", of where a play leaves it",
            Some(LawMemory::TwoStops) => ", of what two plays leave of it",
            Some(LawMemory::ThreeStops) => ", of what three plays leave of it",
            Some(LawMemory::BoucWen) => ", of what a Bouc–Wen loop makes of it",
            Some(LawMemory::Lag) => ", of what it lacks of its lagged self",
            None => "",
        })
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
