//! A form with a memory at a site: its columns.

use nalgebra::DMatrix;

use super::form::{Form, FormConstant};
use super::memory::Memory;
use super::site::Site;

/// Points of a first look at the number of a memory.
const POINTS: usize = 21;

/// Columns of one and then of the other.
pub(super) fn beside_each_other(one: &DMatrix<f64>, other: &DMatrix<f64>) -> DMatrix<f64> {
    let (count, more) = (one.ncols(), other.ncols());
    let mut both = one.clone().resize_horizontally(count + more, 0.0);
    both.columns_mut(count, more).copy_from(other);
    both
}

/// One law among all.
#[derive(Debug, Clone, Copy)]
pub(super) struct Choice {
    /// Number of the site.
    pub site: usize,
    pub form: Form,
    pub memory: Memory,
}

/// Columns of a law, and the amplitude (SI of the result) that each unit of their factors is.
pub(super) struct LawColumns {
    pub columns: DMatrix<f64>,
    pub amplitudes: Vec<f64>,
}

impl Choice {
    /// All that the data of a site determine.
    pub fn all(number: usize, site: &Site) -> Vec<Choice> {
        let (levels, largest) = (site.levels(), site.largest());
        if levels < 3 || !(largest > 0.0 && largest.is_finite()) {
            return Vec::new();
        }
        let mut all = Vec::new();
        for memory in Memory::ALL.into_iter().filter(|memory| memory.range(site).is_some()) {
            for &form in site.forms {
                let is_of = match memory {
                    // of what has one sign only a level is a zero
                    Memory::None => form != Form::Settling || site.range().0 < 0.0,
                    Memory::Side => !matches!(
                        form,
                        Form::PowerAfterGap
                            | Form::Rounded
                            | Form::Threshold
                            | Form::PowerBeyond(_)
                            | Form::Rough(_)
                            | Form::Harmonic
                            | Form::Chirp(_)
                            | Form::Swell(_)
                            | Form::Oscillation
                            | Form::Pull
                            | Form::PullBelow
                            | Form::PullAbove
                    ),
                    Memory::Stop
                    | Memory::Play
                    | Memory::Stops(_)
                    | Memory::BoucWen(_)
                    | Memory::Lag
                    | Memory::Lagged => form == Form::Polynomial(1),
                };
                let choice = Choice { site: number, form, memory };
                if is_of && !choice.grid(site).is_empty() {
                    all.push(choice);
                }
            }
        }
        all
    }

    /// True for the same law, whatever its numbers.
    pub fn is(&self, other: &Choice) -> bool {
        self.site == other.site && self.form.is(other.form) && self.memory.is(other.memory)
    }

    /// What its number that is not linear is.
    pub fn constant(self) -> Option<FormConstant> {
        match self.memory {
            Memory::Stop | Memory::Play | Memory::Stops(_) => Some(FormConstant::Play),
            Memory::BoucWen(_) => Some(FormConstant::Yield),
            Memory::Lag | Memory::Lagged => Some(FormConstant::Lag),
            Memory::None | Memory::Side => self.form.constant(),
        }
    }

    /// Coordinates of a first look at it.
    pub fn grid(self, site: &Site) -> Vec<f64> {
        match self.memory.range(site) {
            None => Vec::new(),
            Some((low, high)) if self.memory.has_constant() => {
                let (low, high) = (low.ln(), high.ln());
                (0..POINTS).map(|k| low + (high - low) * k as f64 / (POINTS - 1) as f64).collect()
            }
            Some(_) => {
                let ((low, high), largest) = (site.range(), site.largest());
                // a load that is never zero in a file was zero before
                let low = if low > 0.0 { 0.0 } else { low };
                self.form.grid((low / largest, high / largest), site.levels())
            }
        }
    }

    /// The number at a coordinate, in the form's scale.
    pub fn at(self, coordinate: f64) -> f64 {
        if self.memory.has_constant() { coordinate.exp() } else { self.form.at_coordinate(coordinate) }
    }

    /// Columns at a coordinate, each of the root mean square `size` where it acts.
    pub fn columns(self, site: &Site, coordinate: f64, size: f64) -> LawColumns {
        let s = self.at(coordinate);
        let (followed, sign) = self.memory.remembered(site, s);
        let (largest, count) = (site.largest(), self.form.count());
        let acts = |i: usize| site.directions.iter().any(|(_, weights)| weights[i] != 0.0);
        // data of one moment follow each other: their value is the same
        let (mut before, mut functions_there) = (f64::NAN, [0.0; 3]);
        let at = |(i, &x): (usize, &f64)| {
            if !x.is_finite() || !acts(i) {
                return [0.0; 3];
            }
            if x != before {
                (before, functions_there) = (x, self.form.functions(x / largest, s));
            }
            functions_there
        };
        let functions: Vec<[f64; 3]> = followed.iter().enumerate().map(at).collect();
        let mut columns = DMatrix::zeros(followed.len(), site.directions.len() * count);
        let mut amplitudes = Vec::with_capacity(columns.ncols());
        for (d, (_, weights)) in site.directions.iter().enumerate() {
            for (j, mut column) in columns.columns_mut(d * count, count).column_iter_mut().enumerate() {
                let (mut square, mut concerned) = (0.0, 0.0f64);
                for (i, value) in column.iter_mut().enumerate() {
                    let way = sign.map_or(1.0, |moves| moves[i]);
                    *value = weights[i] * way * functions[i][j];
                    square += value.powi(2);
                    concerned += f64::from(u8::from(weights[i] != 0.0));
                }
                let rms = (square / concerned.max(1.0)).sqrt();
                let scale = if rms > 0.0 { size / rms } else { 0.0 };
                column *= scale;
                amplitudes.push(scale);
            }
        }
        LawColumns { columns, amplitudes }
    }
}
