//! Numbers of a law besides the first that is not linear: of the shape of its loop, or the exponent
//! beyond a threshold, or how a wave changes.

use super::bouc_wen::LoopShape;
use super::choice::Choice;
use super::form::Form;
use super::memory::Memory;
use super::stops::Stops;

/// Shapes of a first look at a loop.
const SHARPNESSES: [f64; 3] = [1.0, 2.0, 5.0];
const BALANCES: [f64; 2] = [0.55, 0.9];

/// Exponents beyond a threshold, and those of a first look: from a root to a fourth power.
const BEYOND: (f64, f64) = (0.5, 4.0);
const FIRST_BEYOND: [f64; 3] = [0.67, 1.5, 2.5];
/// Widths of a rounded threshold, shares of X: a corner is within the scatter of readings, and a
/// wide one is a straight line.
const ROUGH: (f64, f64) = (0.02, 0.3);
const FIRST_ROUGH: [f64; 2] = [0.05, 0.14];

/// Half of what a frequency changes by from zero to X, as a share of the mean one: at an end it is
/// 2.6 times that at the other. Those of a first look: over as many cycles as there may be two
/// neighbours are still in step for most of them.
const CHIRP: (f64, f64) = (-0.45, 0.45);
const FIRST_CHIRP: [f64; 6] = [-0.4, -0.24, -0.08, 0.08, 0.24, 0.4];
/// How many times as large a wave is at X as at zero, and those of a first look.
const SWELL: (f64, f64) = (0.1, 10.0);
const FIRST_SWELL: [f64; 2] = [0.3, 3.0];

/// What the prior of each is beside that of a corner, or of a wave that does not change.
const NO_CORNER: f64 = 0.25;

/// A number of a shape, for people.
pub(super) struct OfShape {
    pub symbol: String,
    pub name: String,
    pub value: f64,
    /// From where to where it may be; nothing where that depends on the others.
    pub range: Option<(f64, f64)>,
    /// True where it has the unit of the variable.
    pub is_width: bool,
}

impl Choice {
    /// True where its number that is not linear is not the only one.
    pub fn has_shape(self) -> bool {
        !self.shape().is_empty()
    }

    /// The others, each where its prior is even.
    pub fn shape(self) -> Vec<f64> {
        [self.memory.shape(), self.form.shape()].concat()
    }

    /// The same law with others.
    pub fn shaped(self, numbers: &[f64]) -> Choice {
        Choice { form: self.form.shaped(numbers), memory: self.memory.shaped(numbers), ..self }
    }

    /// What its prior is beside that of another law of its place.
    pub fn share(self) -> f64 {
        self.form.share() * self.memory.share()
    }

    /// From where to where they may be.
    pub fn shape_ranges(self) -> Vec<(f64, f64)> {
        [self.memory.shape_ranges(), self.form.shape_ranges()].concat()
    }

    /// Laws of a first look.
    pub fn first_shapes(self) -> Vec<Choice> {
        let of_form = self.form.first_shapes().into_iter().map(|form| Choice { form, ..self });
        let of_memory = self.memory.first_shapes().into_iter().map(|memory| Choice { memory, ..self });
        of_form.chain(of_memory).collect()
    }

    /// For people; `width` is that of a memory, `largest` X, both in the unit of the variable.
    pub fn of_shape(self, (width, largest): (f64, f64)) -> Vec<OfShape> {
        let mut all = self.memory.of_shape(width);
        match self.form {
            Form::PowerBeyond(p) => all.push(OfShape::plain("p", "exponent", p, None)),
            Form::Rough(v) => {
                all.push(OfShape { is_width: true, ..OfShape::plain("v", "width", v * largest, None) })
            }
            Form::Chirp(q) => all.push(OfShape::plain("q", "change of the frequency", q, None)),
            Form::Swell(g) => all.push(OfShape::plain("g", "growth", g, None)),
            _ => {}
        }
        all
    }
}

impl Form {
    /// A corner is what most things have that touch, and most waves go on as they began; how else
    /// is known of few.
    fn share(self) -> f64 {
        if self.shape().is_empty() { 1.0 } else { NO_CORNER }
    }

    /// See [`Choice::shape`].
    pub(super) fn shape(self) -> Vec<f64> {
        match self {
            Form::PowerBeyond(number) | Form::Rough(number) => vec![number.ln()],
            Form::Chirp(q) => vec![q],
            Form::Swell(g) => vec![g.ln_1p()],
            _ => Vec::new(),
        }
    }

    fn shaped(self, numbers: &[f64]) -> Form {
        match (self, numbers) {
            (Form::PowerBeyond(_), &[p]) => Form::PowerBeyond(p.exp()),
            (Form::Rough(_), &[v]) => Form::Rough(v.exp()),
            (Form::Chirp(_), &[q]) => Form::Chirp(q),
            (Form::Swell(_), &[ratio]) => Form::Swell(ratio.exp_m1()),
            _ => self,
        }
    }

    fn shape_ranges(self) -> Vec<(f64, f64)> {
        match self {
            Form::PowerBeyond(_) => vec![(BEYOND.0.ln(), BEYOND.1.ln())],
            Form::Rough(_) => vec![(ROUGH.0.ln(), ROUGH.1.ln())],
            Form::Chirp(_) => vec![CHIRP],
            Form::Swell(_) => vec![(SWELL.0.ln(), SWELL.1.ln())],
            _ => Vec::new(),
        }
    }

    fn first_shapes(self) -> Vec<Form> {
        match self {
            Form::PowerBeyond(_) => FIRST_BEYOND.map(Form::PowerBeyond).to_vec(),
            Form::Rough(_) => FIRST_ROUGH.map(Form::Rough).to_vec(),
            Form::Chirp(_) => FIRST_CHIRP.map(Form::Chirp).to_vec(),
            Form::Swell(_) => FIRST_SWELL.map(|ratio| Form::Swell(ratio - 1.0)).to_vec(),
            _ => Vec::new(),
        }
    }
}

impl OfShape {
    fn plain(symbol: &str, name: &str, value: f64, range: Option<(f64, f64)>) -> OfShape {
        OfShape { symbol: symbol.into(), name: name.into(), value, range, is_width: false }
    }
}

impl Memory {
    /// What its prior is beside that of another one: that one part more slips at a load of its own
    /// is half as likely each time.
    fn share(self) -> f64 {
        match self {
            Memory::Stops(stops) => 0.5f64.powi(stops.count() as i32 - 1),
            _ => 1.0,
        }
    }

    /// Its numbers, each where its prior is even.
    fn shape(self) -> Vec<f64> {
        match self {
            Memory::BoucWen(LoopShape { sharpness, balance }) => vec![sharpness.ln(), balance],
            Memory::Stops(stops) => stops.numbers(),
            _ => Vec::new(),
        }
    }

    /// The same with other numbers.
    fn shaped(self, numbers: &[f64]) -> Memory {
        match (self, numbers) {
            (Memory::BoucWen(_), &[sharp, balance]) => {
                Memory::BoucWen(LoopShape { sharpness: sharp.exp(), balance })
            }
            (Memory::Stops(_), _) => Memory::Stops(Stops::of_numbers(numbers)),
            _ => self,
        }
    }

    /// From where to where they may be.
    fn shape_ranges(self) -> Vec<(f64, f64)> {
        match self {
            Memory::BoucWen(_) => {
                let (low, high) = LoopShape::SHARPNESS;
                vec![(low.ln(), high.ln()), LoopShape::BALANCE]
            }
            Memory::Stops(stops) => stops.ranges(),
            _ => Vec::new(),
        }
    }

    /// Those of a first look.
    fn first_shapes(self) -> Vec<Memory> {
        let of_sharpness = |sharpness: f64| BALANCES.map(|balance| LoopShape { sharpness, balance });
        match self {
            Memory::BoucWen(_) => {
                SHARPNESSES.into_iter().flat_map(of_sharpness).map(Memory::BoucWen).collect()
            }
            Memory::Stops(stops) => stops.first().into_iter().map(Memory::Stops).collect(),
            _ => Vec::new(),
        }
    }

    /// For people; `width` is its own number.
    fn of_shape(self, width: f64) -> Vec<OfShape> {
        let plain = OfShape::plain;
        match self {
            Memory::BoucWen(shape) => {
                vec![
                    plain("n", "sharpness", shape.sharpness, Some(LoopShape::SHARPNESS)),
                    plain("s", "share of β", shape.balance, Some(LoopShape::BALANCE)),
                ]
            }
            Memory::Stops(stops) => {
                let of_stop = |(k, (own, share)): (usize, (f64, f64))| {
                    let number = k + 1;
                    let (half, slope) =
                        (format!("half width {number}"), format!("share {number} of the slope"));
                    let half = plain(&format!("r{number}"), &half, own * width, None);
                    let slope = plain(&format!("w{number}"), &slope, share, None);
                    [OfShape { is_width: true, ..half }, slope]
                };
                stops.narrower().enumerate().flat_map(of_stop).collect()
            }
            _ => Vec::new(),
        }
    }
}
