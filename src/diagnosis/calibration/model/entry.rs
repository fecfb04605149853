//! A candidate with the columns that its parameters make of a recording.

use std::sync::Arc;

use nalgebra::DVector;

use super::law::Law;
use crate::inference::{Candidate, Effect, Location, Parameter, Pattern, StoredColumn};
use crate::units::Unit;

/// ∂response/∂parameter: data from `first` on, m per unit of the parameter; zero elsewhere. Of a
/// pattern, rows from `first` on, and what each of them counts.
///
/// Columns of one change from different rows on share their values: of thousands of places where a
/// base may have moved, only one is held.
#[derive(Debug, Clone)]
pub struct Column {
    first: usize,
    all: Arc<[f64]>,
    /// How many of `all` stand before `first`.
    skip: usize,
    /// Where in `all` those of the column end.
    end: usize,
    pattern: Option<Pattern>,
}

/// A candidate with how it acts and with what each of its parameters does.
pub struct Entry {
    pub candidate: Candidate,
    pub law: Law,
    pub columns: Vec<Column>,
}

impl Column {
    pub fn new(first: usize, values: Vec<f64>, pattern: Option<Pattern>) -> Column {
        Column { first, end: values.len(), all: values.into(), skip: 0, pattern }
    }

    /// Its values, from its first on.
    fn values(&self) -> &[f64] {
        &self.all[self.skip..self.end]
    }

    /// The same from a row on.
    fn starting_at(&self, row: usize) -> Column {
        let first = self.place(row);
        let skip = (self.skip + first.saturating_sub(self.first)).min(self.end);
        Column { first: first.max(self.first), skip, ..self.clone() }
    }

    /// The same before a row.
    fn ending_at(&self, row: usize) -> Column {
        let end = self.skip + self.place(row).saturating_sub(self.first);
        Column { end: end.min(self.end), ..self.clone() }
    }

    /// Where the numbers of a row stand.
    fn place(&self, row: usize) -> usize {
        if self.pattern.is_some() { row } else { 3 * row }
    }

    /// Adds `value` times the column to a recording.
    pub fn add_to(&self, response: &mut DVector<f64>, value: f64) {
        self.add_to_slice(response.as_mut_slice(), value);
    }

    /// The same, its data one after another.
    pub fn add_to_slice(&self, response: &mut [f64], value: f64) {
        let Some(pattern) = &self.pattern else {
            let slots = response.iter_mut().skip(self.first);
            slots.zip(self.values()).for_each(|(slot, v)| *slot += value * v);
            return;
        };
        let first = pattern.block * self.first;
        let slots = response[first..].chunks_mut(pattern.block);
        for ((slots, weight), along) in
            slots.zip(self.values()).zip(pattern.values[first..].chunks(pattern.block))
        {
            slots.iter_mut().zip(along).for_each(|(slot, along)| *slot += value * (weight * along));
        }
    }

    /// As the engine sees it, for a parameter of such a size.
    pub fn stored(&self, size: f64) -> StoredColumn<'_> {
        let (first, values) = (self.first, self.values().into());
        StoredColumn { factor: size, first, values, pattern: self.pattern.as_ref() }
    }

    pub fn is_zero(&self) -> bool {
        self.values().iter().all(|&v| v == 0.0)
    }
}

impl Entry {
    /// A candidate as likely as its effect's others, of an effect that acts in one way only.
    pub fn new(effect: &'static Effect, location: Location, parameters: Vec<(Parameter, Column)>) -> Entry {
        let (parameters, columns) = parameters.into_iter().unzip();
        let candidate = Candidate::new(effect, location, parameters);
        Entry { candidate, law: Law::Only, columns }
    }

    /// The same from a row on, at another place.
    pub fn starting_at(&self, row: usize, location: Location) -> Entry {
        let columns = self.columns.iter().map(|column| column.starting_at(row)).collect();
        Entry { candidate: Candidate { location, ..self.candidate.clone() }, law: self.law.clone(), columns }
    }

    /// The same before a row, at another place.
    pub fn ending_at(&self, row: usize, location: Location) -> Entry {
        let columns = self.columns.iter().map(|column| column.ending_at(row)).collect();
        Entry { candidate: Candidate { location, ..self.candidate.clone() }, law: self.law.clone(), columns }
    }

    /// The same by one of several laws.
    pub fn by(self, law: Law) -> Entry {
        Entry { law, ..self }
    }

    /// Without parameters that do nothing; `None` where none is left.
    pub fn felt(self) -> Option<Entry> {
        // the terms of a gear's error are distinguished by their number
        let keeps_all = self.law.gear().is_some() && self.columns.iter().any(|column| !column.is_zero());
        let is_kept: Vec<bool> = self.columns.iter().map(|column| keeps_all || !column.is_zero()).collect();
        let law = self.law.of_parameters(&is_kept);
        let parameters = self.candidate.parameters.into_iter().zip(self.columns).zip(is_kept);
        let (parameters, columns): (Vec<_>, Vec<_>) =
            parameters.filter(|(_, is_kept)| *is_kept).map(|(own, _)| own).unzip();
        let candidate = Candidate { parameters, ..self.candidate };
        (!columns.is_empty()).then_some(Entry { candidate, columns, law })
    }
}

/// A parameter without effect at zero and without bounds.
pub fn linear(name: impl Into<String>, size: f64) -> Parameter {
    let name = name.into();
    let bounds = (f64::NEG_INFINITY, f64::INFINITY);
    Parameter { unit: Unit::of_key(&name), name, neutral: 0.0, size, bounds }
}

/// The same of what nature has no less of than `least`: play, friction, what gives way.
pub fn at_least(least: f64, parameter: Parameter) -> Parameter {
    Parameter { bounds: (least, f64::INFINITY), ..parameter }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three numbers for each of four rows, with a pattern and without.
    #[test]
    fn a_column_from_a_row_on_is_the_rest_of_it() {
        let added = |column: &Column| {
            let mut response = DVector::zeros(12);
            column.add_to(&mut response, 2.0);
            response
        };
        let along: Vec<f64> = (0..12).map(f64::from).collect();
        let pattern = Pattern { block: 3, values: along.clone().into() };
        let plain = Column::new(3, along[3..].to_vec(), None);
        let weighted = Column::new(1, vec![1.0; 3], Some(pattern));
        for column in [plain, weighted] {
            let from =
                |row: usize| DVector::from_fn(12, |i, _| if i < 3 * row { 0.0 } else { 2.0 * along[i] });
            assert_eq!(added(&column), from(1));
            for row in 1..4 {
                assert_eq!(added(&column.starting_at(row)), from(row));
                assert_eq!(
                    column.starting_at(row).stored(1.0).values.len(),
                    column.values().len() * (4 - row) / 3
                );
            }
            // and again
            assert_eq!(added(&column.starting_at(2).starting_at(3)), from(3));
            for row in 1..4 {
                let before = added(&column.ending_at(row));
                assert_eq!(before + added(&column.starting_at(row)), from(1));
                assert_eq!(added(&column.ending_at(row).starting_at(row)).amax(), 0.0);
            }
        }
    }
}
