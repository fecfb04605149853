//! A world with its columns at neutral values at hand, whole or of some of the data.

use nalgebra::{DMatrix, DVector};

use super::{Candidate, Chosen, World};

/// A world of which the linear part is computed once.
pub struct Linearised<'a> {
    world: &'a dyn World,
    /// Each candidate's [`World::columns`] at its neutral values, alone.
    pub neutral: Vec<DMatrix<f64>>,
    /// The data, where these are not all.
    rows: Option<&'a [usize]>,
}

impl<'a> Linearised<'a> {
    /// Of all data.
    pub fn new(world: &'a dyn World) -> Self {
        let of = |(index, candidate): (usize, &Candidate)| world.columns(&[candidate.neutral(index)], 0);
        Linearised { world, neutral: world.candidates().iter().enumerate().map(of).collect(), rows: None }
    }

    /// Of the data `rows`.
    pub fn part(&self, rows: &'a [usize]) -> Linearised<'a> {
        let neutral = self.neutral.iter().map(|columns| columns.select_rows(rows)).collect();
        Linearised { world: self.world, neutral, rows: Some(rows) }
    }
}

impl World for Linearised<'_> {
    fn candidates(&self) -> &[Candidate] {
        self.world.candidates()
    }

    fn change(&self, story: &[Chosen]) -> DVector<f64> {
        let whole = self.world.change(story);
        match self.rows {
            Some(rows) => whole.select_rows(rows),
            None => whole,
        }
    }

    fn is_linear(&self) -> bool {
        self.world.is_linear()
    }

    fn place(&self, chosen: &Chosen) -> String {
        self.world.place(chosen)
    }

    fn columns(&self, story: &[Chosen], position: usize) -> DMatrix<f64> {
        let whole = self.world.columns(story, position);
        match self.rows {
            Some(rows) => whole.select_rows(rows),
            None => whole,
        }
    }
}
