//! A law that is proposed, as data, or why none is.

use nalgebra::{DMatrix, DVector};

use super::constant::Constant;
use super::form::{Form, FormConstant};
use super::memory::Memory;
use super::site::{Measure, Site};
use crate::inference::{Location, Term};

/// What was made of what is left.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Proposed {
    /// The law, if there is one.
    pub law: std::result::Result<Law, Refusal>,
    /// Along which variable, and where, a smooth curve explains most.
    pub lives: Option<(Location, Measure)>,
    /// Held-out error with the findings alone, and with what the search for a law finds without
    /// each fold besides, m; `None` where nothing was held out.
    pub held_out: Option<(f64, f64)>,
}

/// Why there is no law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// None is likelier than chance by the odds of a name.
    Chance,
    /// A smooth curve is likelier than the likeliest of all laws, by so many times (ln).
    Curve(f64),
    /// Held-out errors are not lowered, or by less than 5 % of their square.
    HeldOut,
    /// Nothing could be held out.
    NoFolds,
    /// What is left unexplained is so little beside the scatter that no law could lower held-out
    /// errors by enough.
    Little,
}

/// Cosine between what two laws add from which on one repeats the other.
const SAME: f64 = 0.9;

/// A law with its numbers.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Law {
    /// Where, and the number it is a function of.
    pub site: Site,
    /// What it looks like.
    pub form: Form,
    /// What it remembers.
    pub memory: Memory,
    /// Its amplitudes, one for each function and direction, direction by direction.
    pub amplitudes: Vec<Constant>,
    /// Its number that is not linear.
    pub constant: Option<(FormConstant, Constant)>,
    /// The others that are not linear: the shape of its loop, the exponent or width of a contact.
    pub of_shape: Vec<Constant>,
    /// Correlation coefficients of all constants, in their order.
    pub correlation: DMatrix<f64>,
    /// The same as numbers: amplitudes (SI) of each direction's functions, s.
    pub values: (Vec<f64>, f64),
    /// Ln of its odds against nothing, and against the likeliest smooth curve.
    pub log_odds: (f64, f64),
    /// Its own held-out error, m.
    pub held_out: Option<f64>,
    /// Root mean square of what it explains, m.
    pub explains: f64,
    /// Noise of a datum beside it, m.
    pub noise: f64,
    /// What it adds to each datum, m.
    pub adds: Vec<f64>,
    /// What is left of each datum beside it, m.
    pub left: Vec<f64>,
    /// All else, as it is beside it.
    pub beside: Beside,
    /// Laws that these data do not distinguish from it, the likeliest first.
    pub rivals: Vec<LawRival>,
    /// What would distinguish it from the likeliest rival at its place.
    pub next: Option<NextRecord>,
    /// Half again beyond the data: the variable there (SI), and how far off the law may be, m, but
    /// for a straight line: from rivals at its place, from a wave with another of its periods, and
    /// by two standard deviations of what its own constants leave open; `None` of a straight line,
    /// and of a law that remembers, where they have no rival.
    pub further: Option<(f64, f64)>,
    /// How far off a law with a loop may be along a way within its data that turns round elsewhere,
    /// m, but for a straight line: from rivals of any memory at its place, and by two standard
    /// deviations of what its own constants leave open.
    pub another_way: Option<f64>,
    /// Data as it sees them: what is left but for the law.
    pub points: Vec<Point>,
    /// A smooth curve through them.
    pub curve: Vec<Point>,
    /// Where, and along which variable, another law is named beside it.
    pub more: Option<(Location, Measure)>,
    /// Another law, where two are proposed: each is then as it is beside the other.
    pub second: Option<Box<Second>>,
}

/// A law that is proposed beside another one.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Second {
    /// The law that acts beside the first one.
    pub law: Law,
    /// Held-out error with the first law, and with what the search for another one finds without
    /// each fold besides, m.
    pub held_out: (f64, f64),
}

/// Findings and numbers of files as they are beside a law.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Beside {
    /// Terms of the findings, with their values beside the law.
    pub terms: Vec<Term>,
    /// Factors of the background of the settled evidence, among which nominal numbers are.
    pub background: Vec<f64>,
}

/// A law that may be there instead.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LawRival {
    /// Place and variable of the other law.
    pub site: Site,
    /// What it looks like.
    pub form: Form,
    /// What it remembers.
    pub memory: Memory,
    /// Its number that is not linear.
    pub constant: Option<(FormConstant, Constant)>,
    /// Amplitudes (SI) and s.
    pub values: (Vec<f64>, f64),
    /// How many times the law is likelier.
    pub odds: f64,
    /// Its own held-out error, m.
    pub held_out: Option<f64>,
}

/// Where two laws part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextRecord {
    /// Number of the rival.
    pub rival: usize,
    /// The variable there, SI.
    pub at: f64,
    /// True where it is beyond what was recorded.
    pub is_beyond: bool,
    /// How far they are apart there, m, but for a straight line that zeros and stiffnesses take up.
    pub apart: f64,
}

/// A point of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Number of the direction.
    pub direction: usize,
    /// What the law follows, SI.
    pub x: f64,
    /// The result there, SI.
    pub value: f64,
}

impl Proposed {
    /// Those that are proposed, in their order.
    pub fn laws(&self) -> impl Iterator<Item = &Law> {
        self.law.iter().flat_map(Law::all)
    }

    /// Held-out error with all laws that are proposed.
    pub fn held_out_with(&self) -> Option<f64> {
        let of_second = self.law.as_ref().ok().and_then(|law| law.second.as_ref());
        of_second.map(|second| second.held_out.1).or(self.held_out.map(|(_, with)| with))
    }
}

/// cos of the angle between what is the same but for a factor.
const ALIKE: f64 = 0.999;

impl Law {
    /// True where place, variable, form and memory are those of another law, and so is what it
    /// adds, but for a factor. Waves of two frequencies are two laws, and so are lags of two times
    /// that are known apart.
    pub fn repeats(&self, other: &Law) -> bool {
        let [a, b] = [self, other].map(|law| DVector::from_column_slice(&law.adds));
        let is_apart = |(a, b): (&Constant, &Constant)| a.high < b.low || b.high < a.low;
        let constants = [self, other].map(|law| law.constant.as_ref().map(|(_, constant)| constant));
        let are_two = self.memory.has_constant() && constants[0].zip(constants[1]).is_some_and(is_apart);
        (&self.site.location, &self.site.variable, &self.site.result)
            == (&other.site.location, &other.site.variable, &other.site.result)
            && self.form.is(other.form)
            && self.memory == other.memory
            && !are_two
            && a.dot(&b).abs() > SAME * a.norm() * b.norm()
    }

    /// True where another law bends over the same number, but for a factor, at a place that does
    /// the same to the data, and neither has a memory, a wave or a corner of its own.
    pub(super) fn is_of_curve_with(&self, other: &Law) -> bool {
        let bends = |law: &Law| law.memory == Memory::None && law.form.is_gradual();
        let is_alike = |a: &[f64], b: &[f64]| {
            let known = || a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite());
            let product: f64 = known().map(|(a, b)| a * b).sum();
            let squares = known().fold((0.0, 0.0), |(x, y), (a, b)| (x + a * a, y + b * b));
            product.abs() > ALIKE * (squares.0 * squares.1).sqrt()
        };
        let weights = [self, other].map(|law| law.site.directions.iter().flat_map(|(_, own)| own.clone()));
        let [own, others] = weights.map(Iterator::collect::<Vec<f64>>);
        bends(self)
            && bends(other)
            && own.len() == others.len()
            && is_alike(&self.site.values, &other.site.values)
            && is_alike(&own, &others)
    }

    /// Its intervals by this factor as wide, about its numbers.
    pub(super) fn widen(&mut self, factor: f64) {
        let of_form = self.constant.iter_mut().map(|(_, constant)| constant);
        for own in self.amplitudes.iter_mut().chain(of_form) {
            own.low = own.value - factor * (own.value - own.low);
            own.high = own.value + factor * (own.high - own.value);
        }
    }

    /// Of its numbers alone, for tests of what is made of them.
    #[cfg(test)]
    pub fn of_numbers(
        site: Site,
        form: Form,
        (amplitudes, constant): (Vec<Constant>, Option<(FormConstant, Constant)>),
        values: (Vec<f64>, f64),
    ) -> Law {
        Law {
            site,
            form,
            memory: Memory::None,
            amplitudes,
            constant,
            of_shape: Vec::new(),
            correlation: DMatrix::zeros(0, 0),
            values,
            log_odds: (0.0, 0.0),
            held_out: None,
            explains: 0.0,
            noise: 0.0,
            adds: Vec::new(),
            left: Vec::new(),
            beside: Beside::default(),
            rivals: Vec::new(),
            next: None,
            further: None,
            another_way: None,
            points: Vec::new(),
            curve: Vec::new(),
            more: None,
            second: None,
        }
    }

    /// Whether it may be used half again beyond its data: what is open there is within the noise,
    /// and nothing is left beside it, which would go on too.
    pub fn holds_beyond(&self) -> Option<bool> {
        self.further.map(|(_, apart)| apart <= self.noise && self.more.is_none())
    }

    /// Whether it may be used along another way than the recorded ones: what is open there is
    /// within the noise.
    pub fn holds_another_way(&self) -> Option<bool> {
        self.another_way.map(|apart| apart <= self.noise)
    }

    /// It, and the one that is proposed beside it.
    pub fn all(&self) -> impl Iterator<Item = &Law> {
        std::iter::once(self).chain(self.second.iter().map(|second| &second.law))
    }

    /// All of its constants.
    pub fn constants(&self) -> impl Iterator<Item = &Constant> {
        let of_form = self.constant.iter().map(|(_, constant)| constant);
        self.amplitudes.iter().chain(of_form).chain(&self.of_shape)
    }

    /// The law at x (SI) in a direction, SI; what a memory makes of the variable is x.
    pub fn at(&self, direction: usize, x: f64) -> f64 {
        at(self.form, &self.values, self.site.largest(), direction, x)
    }
}

impl LawRival {
    /// See [`Law::at`].
    pub fn at(&self, direction: usize, x: f64) -> f64 {
        at(self.form, &self.values, self.site.largest(), direction, x)
    }
}

fn at(form: Form, (amplitudes, s): &(Vec<f64>, f64), largest: f64, direction: usize, x: f64) -> f64 {
    let functions = form.functions(x / largest, *s);
    let own = amplitudes.iter().skip(direction * form.count()).take(form.count());
    own.zip(functions).map(|(amplitude, function)| amplitude * function).sum()
}
