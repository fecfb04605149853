//! Mistakes in some of the rows: found one after another and undone.

use super::labels::{self, Labels};
use super::lines::lines;
use super::mended::{Mended, Zero};
use super::{copies, displaced, entries, groups, increments, sensors, trials, weights};
use crate::diagnosis::rig::recording::datum;
use crate::error::Result;
use crate::inference::Location;

impl Mended {
    /// Trials that are copies.
    pub(super) fn copies(&mut self) {
        let data = datum::all(&self.readings.rows);
        for part in copies::found(&data) {
            self.leave_out(&data, &part);
            self.add_part(part);
        }
    }

    /// Readings that are increments.
    pub(super) fn increments(&mut self) -> Result<()> {
        let data = datum::all(&self.readings.rows);
        let all = lines(&data, |_| true);
        let Some(rod) = self.expected(&all)? else { return Ok(()) };
        let by_rod: Vec<f64> = rod.slopes.iter().map(|slope| slope / rod.scale).collect();
        if let Some(found) = increments::found(&data, &all, &by_rod) {
            for (datum, offset) in data.iter().zip(&found.offsets) {
                self.readings.rows[datum.row - 1].offset[datum.channel.index()] = Some(*offset);
            }
            self.add_part(found.part);
        }
        Ok(())
    }

    /// Loads that were typed wrongly.
    pub(super) fn entries(&mut self) {
        let data = datum::all(&self.readings.rows);
        for entry in entries::found(&data, &lines(&data, |_| true), self.readings.load_column) {
            match entry.load {
                Some(load) => entry.rows.iter().for_each(|&row| self.readings.rows[row].load = load),
                None => self.leave_out(&data, &entry.part),
            }
            self.add_part(entry.part);
        }
    }

    /// Readings and loads in other rows than those where they belong.
    pub(super) fn displaced(&mut self) {
        if let Some(found) = displaced::found(&self.readings.rows, self.readings.load_column) {
            self.readings.rows = found.rows;
            self.add_part(found.part);
        }
    }

    /// Units, signs and names of some trials.
    pub(super) fn trials(&mut self) -> Result<()> {
        let data = datum::all(&self.readings.rows);
        let all = lines(&data, |_| true);
        let by_rod = self.expected(&all)?;
        let by_rod: Option<Vec<f64>> =
            by_rod.map(|rod| rod.slopes.iter().map(|slope| slope / rod.scale).collect());
        let trials = trials::Table::of(&data, &all, by_rod.as_deref());
        if trials.is_alike() {
            return Ok(());
        }
        let possible = labels::in_trials(&Labels::of(&all, self.readings.load_column));
        for found in trials.found(&possible, self.readings.load_column) {
            let Some(relabelling) = found.relabelling else {
                self.leave_out(&data, &found.part);
                self.add_part(found.part);
                continue;
            };
            let mut rows: Vec<usize> = found.part.data.iter().map(|&i| data[i].row - 1).collect();
            rows.sort_unstable();
            rows.dedup();
            rows.into_iter().for_each(|row| relabelling.undo_in(&mut self.readings.rows[row]));
            self.add_part(found.part);
        }
        Ok(())
    }

    /// Sensors that are stuck or cut off, and signs of single runs.
    pub(super) fn sensors(&mut self) -> Result<()> {
        // a limit first: what stays at it looks frozen, and what is frozen for long looks stuck
        for kind in 0..3 {
            let data = datum::all(&self.readings.rows);
            let all = lines(&data, |_| true);
            let parts = match kind {
                0 => sensors::saturated(&data, &all, self.expected(&all)?.as_ref()),
                1 => sensors::frozen(&data, &all, self.expected(&all)?.as_ref()),
                _ => sensors::stuck(&data, &all, self.expected(&all)?.as_ref()),
            };
            for part in parts {
                self.leave_out(&data, &part);
                self.add_part(part);
            }
        }
        if !self.has_slope() {
            self.has_data = false;
            return Ok(());
        }
        let data = datum::all(&self.readings.rows);
        let all = lines(&data, |_| true);
        let expected = self.expected(&all)?;
        for part in groups::flipped(&data, &all, expected.as_ref().map(|rod| &rod.slopes[..])) {
            for &i in &part.data {
                let offset = &mut self.readings.rows[data[i].row - 1].offset[data[i].channel.index()];
                *offset = offset.map(|offset| -offset);
            }
            self.add_part(part);
        }
        Ok(())
    }

    /// A weight that is another one.
    pub(super) fn weights(&mut self) {
        let data = datum::all(&self.readings.rows);
        if let Some(part) = weights::found(&data, &lines(&data, |_| true), self.readings.load_column) {
            self.leave_out(&data, &part);
            self.add_part(part);
        }
    }

    /// Zeros that were not taken.
    pub(super) fn zeros(&mut self) {
        if self.rod.is_none() {
            return;
        }
        let data = datum::all(&self.readings.rows);
        for part in groups::offsets(&data, &lines(&data, |_| true)) {
            let zero = part.estimates.first().map_or(0.0, |estimate| estimate.value);
            let mut before = Vec::with_capacity(part.data.len());
            for &i in &part.data {
                let (row, channel) = (data[i].row - 1, data[i].channel.index());
                let offset = &mut self.readings.rows[row].offset[channel];
                before.push((row, channel, *offset));
                *offset = offset.map(|offset| offset - zero);
            }
            self.zeros.push(Zero { location: Location::from(part.location.clone()), before });
            self.add_part(part);
        }
    }
}
