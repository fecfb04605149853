//! Laws of a robot's file: formulas for what geometry and effects leave out.
//!
//! ```text
//! place           what the formula adds                                              in
//! joint N         to the joint's value                                               µrad, µm
//! axis of joint N to the place of the joint's axis, in the frame of the link before  µm
//! link N          to the turn of the link that joint N moves, about its own axes     µrad
//! tool            to the tip, in {T}                                                 µm
//! ```
//!
//! With `per_joint` a formula is multiplied by the value of that joint, rad or m.

use std::fmt;

use crate::expression::{Expression, Fault};
use crate::rod::LawConstant;
use crate::rod::law::SIDE;
use crate::units::{DEG, MM, UM};

/// What a formula's unit is in SI, whichever it is: µm, µrad.
const MICRO: f64 = UM;
const AXES: [&str; 3] = ["x", "y", "z"];
/// A number that was read again is no other.
const BEYOND: f64 = 1e-9;
/// Where in its range a law is compared with itself.
const TRIED: usize = 8;

/// Where a law acts; joints count from 0, from 1 in names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LawPlace {
    /// A joint's value.
    Joint(usize),
    /// The place of a joint's axis, in the frame that carries it: a bearing that wobbles.
    Axis(usize),
    /// The turn of the link that a joint moves, about the axes of its distal frame.
    Link(usize),
    /// The tip in {T}.
    Tool,
}

/// What a law of a robot is a function of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum JointLawVariable {
    /// The angle of a joint.
    Angle(usize),
    /// The position of a prismatic joint.
    Position(usize),
    /// The sum of the angles of a joint and the next one.
    Sum(usize),
    /// The angle of a joint less that of the next one.
    Difference(usize),
    /// The torque of a joint.
    Torque(usize),
    /// The weight along an axis of {T}, in g.
    Weight(usize),
}

/// A law of a robot's file.
#[derive(Debug, Clone)]
pub struct RobotLaw {
    /// Where it acts.
    pub place: LawPlace,
    /// The joint whose value multiplies it.
    pub per_joint: Option<usize>,
    /// What it is a function of.
    pub variable: JointLawVariable,
    /// One of a joint; along x, y, z of any other place.
    pub formulas: Vec<String>,
    /// Its numbers.
    pub constants: Vec<LawConstant>,
    /// From where to where the variable was recorded, in its unit.
    pub range: (f64, f64),
    /// Where it comes from.
    pub source: Option<String>,
    expressions: Vec<Expression>,
    is_sided: bool,
}

impl PartialEq for RobotLaw {
    /// The expressions are those of the formulas.
    fn eq(&self, other: &RobotLaw) -> bool {
        (self.place, self.per_joint, self.variable, &self.formulas)
            == (other.place, other.per_joint, other.variable, &other.formulas)
            && (&self.constants, self.range, &self.source) == (&other.constants, other.range, &other.source)
    }
}

impl LawPlace {
    /// All places of a robot with so many joints.
    pub fn all(joints: usize) -> impl Iterator<Item = LawPlace> {
        let of_joint = |joint| [LawPlace::Joint(joint), LawPlace::Axis(joint), LawPlace::Link(joint)];
        (0..joints).flat_map(of_joint).chain([LawPlace::Tool])
    }

    /// How many formulas a law has there.
    pub fn formulas(self) -> usize {
        match self {
            LawPlace::Joint(_) => 1,
            LawPlace::Axis(_) | LawPlace::Link(_) | LawPlace::Tool => 3,
        }
    }

    /// What a law changes there, in sentences.
    pub fn changes(self, per_joint: Option<usize>) -> String {
        let per = per_joint.map_or_else(String::new, |joint| format!(" per radian of joint {}", joint + 1));
        match self {
            LawPlace::Joint(_) | LawPlace::Link(_) => format!("turn of {self}{per}"),
            LawPlace::Axis(joint) => format!("displacement of the axis of joint {}{per}", joint + 1),
            LawPlace::Tool => format!("displacement of the tool{per}"),
        }
    }

    /// Unit of a formula there, for people.
    pub fn unit(self) -> &'static str {
        match self {
            LawPlace::Joint(_) | LawPlace::Link(_) => "µrad",
            LawPlace::Axis(_) | LawPlace::Tool => "µm",
        }
    }
}

impl fmt::Display for LawPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LawPlace::Joint(joint) => write!(f, "joint {}", joint + 1),
            LawPlace::Axis(joint) => write!(f, "axis of joint {}", joint + 1),
            LawPlace::Link(joint) => write!(f, "link {}", joint + 1),
            LawPlace::Tool => f.write_str("tool"),
        }
    }
}

impl JointLawVariable {
    /// All variables of a robot of whose joints these are prismatic.
    pub fn all(is_prismatic: &[bool]) -> Vec<JointLawVariable> {
        use JointLawVariable::{Angle, Difference, Position, Sum, Torque, Weight};
        let own = is_prismatic.iter().enumerate();
        let own = own.map(|(joint, prismatic)| if *prismatic { Position(joint) } else { Angle(joint) });
        let count = is_prismatic.len();
        let pairs = (0..count.saturating_sub(1)).flat_map(|first| [Sum(first), Difference(first)]);
        let torques = (0..count).map(Torque);
        own.chain(pairs).chain(torques).chain((0..AXES.len()).map(Weight)).collect()
    }

    /// True where a law of this variable may act at a place: a weight moves the tool, a torque its
    /// own joint, all else anything but the tool.
    pub fn is_at(self, place: LawPlace) -> bool {
        match self {
            JointLawVariable::Weight(_) => place == LawPlace::Tool,
            JointLawVariable::Torque(joint) => place == LawPlace::Joint(joint),
            JointLawVariable::Angle(_)
            | JointLawVariable::Position(_)
            | JointLawVariable::Sum(_)
            | JointLawVariable::Difference(_) => place != LawPlace::Tool,
        }
    }

    /// In formulas.
    pub fn symbol(self) -> &'static str {
        match self {
            JointLawVariable::Weight(_) => "g",
            JointLawVariable::Torque(_) => "τ",
            JointLawVariable::Angle(_)
            | JointLawVariable::Position(_)
            | JointLawVariable::Sum(_)
            | JointLawVariable::Difference(_) => "q",
        }
    }

    /// Its unit for people, and in SI (of a weight in g).
    pub fn unit(self) -> (&'static str, f64) {
        match self {
            JointLawVariable::Weight(_) => ("g", 1.0),
            JointLawVariable::Torque(_) => ("N·m", 1.0),
            JointLawVariable::Position(_) => ("mm", MM),
            JointLawVariable::Angle(_) | JointLawVariable::Sum(_) | JointLawVariable::Difference(_) => {
                ("°", DEG)
            }
        }
    }

    /// Its value, SI: of joints at `q` (rad or m) under `torque` (N·m; may be empty, then none
    /// acts), where `weight` (in g) is along x, y, z of {T}. `None` of what is not given.
    pub fn value(self, q: &[f64], torque: &[f64], weight: &[f64]) -> Option<f64> {
        match self {
            JointLawVariable::Angle(joint) | JointLawVariable::Position(joint) => q.get(joint).copied(),
            JointLawVariable::Sum(first) => Some(q.get(first)? + q.get(first + 1)?),
            JointLawVariable::Difference(first) => Some(q.get(first)? - q.get(first + 1)?),
            JointLawVariable::Torque(joint) => torque.get(joint).copied(),
            JointLawVariable::Weight(axis) => weight.get(axis).copied(),
        }
    }
}

impl fmt::Display for JointLawVariable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            JointLawVariable::Angle(joint) => write!(f, "angle of joint {}", joint + 1),
            JointLawVariable::Position(joint) => write!(f, "position of joint {}", joint + 1),
            JointLawVariable::Sum(first) => {
                write!(f, "sum of the angles of joints {} and {}", first + 1, first + 2)
            }
            JointLawVariable::Difference(first) => {
                write!(f, "difference of the angles of joints {} and {}", first + 1, first + 2)
            }
            JointLawVariable::Torque(joint) => write!(f, "torque of joint {}", joint + 1),
            JointLawVariable::Weight(axis) => write!(f, "weight along {} of the tool", AXES[*axis]),
        }
    }
}

impl RobotLaw {
    /// A law at a place, its formulas read: one of a joint, three of any other place.
    ///
    /// ```
    /// use rodcal::robot::{JointLawVariable, LawPlace, RobotLaw};
    ///
    /// let formulas = vec!["2*max(q - 10, 0)".to_owned()];
    /// let variable = JointLawVariable::Angle(1);
    /// let law = RobotLaw::new(LawPlace::Joint(3), None, variable, formulas, vec![], (-90.0, 90.0)).unwrap();
    /// let q = [0.0, 15f64.to_radians()];
    /// assert!((law.turn(&q, &[], 1.0) - 10e-6).abs() < 1e-15); // 10 µrad at 15°
    /// ```
    ///
    /// # Errors
    /// The number of the formula with its [`Fault`].
    pub fn new(
        place: LawPlace,
        per_joint: Option<usize>,
        variable: JointLawVariable,
        formulas: Vec<String>,
        constants: Vec<LawConstant>,
        range: (f64, f64),
    ) -> Result<RobotLaw, (usize, Fault)> {
        let names = [variable.symbol(), SIDE].into_iter();
        let names: Vec<&str> = names.chain(constants.iter().map(|own| own.name.as_str())).collect();
        let read =
            |(k, formula): (usize, &String)| Expression::new(formula, &names).map_err(|error| (k, error));
        let expressions = formulas.iter().enumerate().map(read).collect::<Result<_, _>>()?;
        let mut law = RobotLaw {
            place,
            per_joint,
            variable,
            formulas,
            constants,
            range,
            source: None,
            expressions,
            is_sided: false,
        };
        let tried = (0..=TRIED).map(|k| range.0 + (range.1 - range.0) * k as f64 / TRIED as f64);
        law.is_sided = tried.into_iter().any(|x| {
            let [up, down] = [1.0, -1.0].map(|side| law.formulas_at(x, side).collect::<Vec<_>>());
            up != down
        });
        Ok(law)
    }

    /// What its formulas are at x, in the units of its file; `side` is 1 where a joint came from
    /// below, −1 where it came from above, 0 where nobody knows.
    pub fn formulas_at(&self, x: f64, side: f64) -> impl Iterator<Item = f64> + '_ {
        let mut values = vec![x, side];
        values.extend(self.constants.iter().map(|own| own.value));
        self.expressions.iter().map(move |expression| expression.at(&values))
    }

    /// True where it follows the side that a joint came from.
    pub fn is_sided(&self) -> bool {
        self.is_sided
    }

    /// What a joint's law adds to its value, rad or m; see [`JointLawVariable::value`].
    pub fn turn(&self, q: &[f64], torque: &[f64], side: f64) -> f64 {
        self.along(q, torque, &[], side)[0]
    }

    /// What it adds along x, y, z of its place (a joint's stands first), SI. What is no number
    /// where it was not recorded adds nothing.
    pub fn along(&self, q: &[f64], torque: &[f64], weight: &[f64], side: f64) -> [f64; 3] {
        let mut added = [0.0; 3];
        let Some(x) = self.variable.value(q, torque, weight) else { return added };
        let per = self.per_joint.map_or(1.0, |joint| q.get(joint).copied().unwrap_or(0.0));
        let values = self.formulas_at(x / self.variable.unit().1, side);
        for (added, value) in added.iter_mut().zip(values).filter(|(_, value)| value.is_finite()) {
            *added = value * per * MICRO;
        }
        added
    }

    /// True where the variable (in its unit) is beyond what was recorded.
    pub fn is_beyond(&self, x: f64) -> bool {
        let (low, high) = self.range;
        let margin = BEYOND * (high - low);
        x < low - margin || x > high + margin
    }

    /// `turn of joint 4 per radian of joint 2: 8.3*q in µrad, for the angle of joint 3 from −80 to
    /// 80 °`.
    pub fn description(&self) -> String {
        let significant = |x: f64| crate::units::significant(x, 3);
        let number = |own: &LawConstant| format!(", {} = {} {}", own.name, significant(own.value), own.unit);
        let numbers: String = self.constants.iter().map(|own| number(own).trim_end().to_owned()).collect();
        let (low, high) = self.range;
        format!(
            "the {}, {} in {}{numbers}, for the {} from {} to {} {}",
            self.place.changes(self.per_joint),
            self.formulas.join("; "),
            self.place.unit(),
            self.variable,
            significant(low),
            significant(high),
            self.variable.unit().0
        )
    }
}
