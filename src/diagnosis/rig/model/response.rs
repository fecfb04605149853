//! What the rod, or the lines, show under loads that effects have changed.

use nalgebra::DVector;

use super::cases::Shown;
use super::{Body, RigModel};
use crate::diagnosis::rig::mechanics::state::State;
use crate::diagnosis::rig::mechanics::structure::{Parts, Structure};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::parallel::checkpoint;

impl RigModel {
    /// How far the rod deflects at each datum, m: the prediction, or the reading's share in a line
    /// through the origin.
    pub(in crate::diagnosis::rig) fn deflections(&self) -> Vec<f64> {
        match self.body {
            Body::Rod(_) => self.data.iter().map(|d| d.predicted).collect(),
            Body::Lines(count) => {
                let measured: Vec<f64> = self.data.iter().map(|d| d.measured).collect();
                let loads: Vec<f64> = self.data.iter().map(Datum::drive).collect();
                let slopes = self.slopes(count, &loads, &measured);
                loads.iter().zip(&self.place).map(|(load, &line)| load * slopes[line]).collect()
            }
        }
    }

    /// Slope of each line through the origin, m/N; 0 where nothing pulls.
    pub(in crate::diagnosis::rig) fn slopes(
        &self,
        count: usize,
        loads: &[f64],
        readings: &[f64],
    ) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); count];
        for ((&load, reading), &line) in loads.iter().zip(readings).zip(&self.place) {
            sums[line].0 += load * reading;
            sums[line].1 += load * load;
        }
        sums.into_iter().map(|(xy, xx)| if xx > 0.0 { xy / xx } else { 0.0 }).collect()
    }

    /// True where data of one case show the same but for their history: no load that was hung or
    /// imposed one after another, and no joint of one session.
    pub(in crate::diagnosis::rig) fn is_by_case(&self, state: &State<'_>) -> bool {
        self.course.hung.is_empty() && self.course.imposed.is_empty() && state.of_sessions.is_empty()
    }

    /// What each case of a rod shows, without shifts.
    pub(in crate::diagnosis::rig) fn shown(&self, structure: &Structure, state: &State<'_>) -> Vec<Shown> {
        let compliance = structure.softened(&state.softening);
        let of_case = |&first: &usize| {
            let datum = &self.data[first];
            let pull = state.bare(datum, None);
            let along = |displacement| state.read(datum.channel, &displacement);
            let slope = along(compliance[self.place[first]] * pull.direction);
            Shown { slope, load: pull.load, play: along(pull.direction) * pull.play }
        };
        self.cases.first.iter().map(of_case).collect()
    }

    /// By how much the readings of a rod by its cases differ between two states, without shifts, m.
    pub(in crate::diagnosis::rig) fn difference_by_case(
        &self,
        structure: &Structure,
        more: &State<'_>,
        less: &State<'_>,
    ) -> DVector<f64> {
        let shown = [more, less].map(|state| self.shown(structure, state));
        let of_case = |case: usize, loads: [f64; 2]| {
            shown[0][case].reading(loads[0]) - shown[1][case].reading(loads[1])
        };
        let plain = |case: usize| [shown[0][case].load, shown[1][case].load];
        let cases = self.cases.of_datum.iter();
        if more.remembers() {
            let of_datum = |(i, &case): (usize, &usize)| {
                let [with_more, with_less] = plain(case);
                of_case(case, [more.with_history(with_more, i), less.with_history(with_less, i)])
            };
            return DVector::from_iterator(self.data.len(), cases.enumerate().map(of_datum));
        }
        let differences: Vec<f64> = (0..shown[0].len()).map(|case| of_case(case, plain(case))).collect();
        DVector::from_iterator(self.data.len(), cases.map(|&case| differences[case]))
    }

    /// The readings of a rod by its cases, without shifts, m.
    pub(in crate::diagnosis::rig) fn displaced_by_case(
        &self,
        structure: &Structure,
        state: &State<'_>,
    ) -> Vec<f64> {
        let shown = self.shown(structure, state);
        if !state.remembers() {
            let readings: Vec<f64> = shown.iter().map(|case| case.reading(case.load)).collect();
            return self.cases.of_datum.iter().map(|&case| readings[case]).collect();
        }
        let reading = |(i, &case): (usize, &usize)| {
            let own = &shown[case];
            own.reading(state.with_history(own.load, i))
        };
        self.cases.of_datum.iter().enumerate().map(reading).collect()
    }

    /// The readings of a rod, without shifts, m.
    pub(in crate::diagnosis::rig) fn displaced(&self, structure: &Structure, state: &State<'_>) -> Vec<f64> {
        if self.is_by_case(state) {
            return self.displaced_by_case(structure, state);
        }
        let common = structure.softened(&state.softening);
        let mut of_session: Vec<Option<Parts>> = Vec::new();
        for &(session, _, _) in &state.of_sessions {
            of_session.resize(of_session.len().max(session + 1), None);
            let joints = state.of_sessions.iter().filter(|(own, _, _)| *own == session);
            let mut softening = state.softening.clone();
            softening.joints.extend(joints.map(|&(_, joint, by)| (joint, by)));
            of_session[session] = Some(structure.softened(&softening));
        }
        let mut pulls = state.pulls(&self.data, &self.course);
        let compliance = |i: usize| {
            let own = of_session.get(self.data[i].session_number).and_then(Option::as_ref);
            own.unwrap_or(&common)[self.place[i]]
        };
        // what a sensor along the load shows per newton
        let along = |i: usize| {
            let datum = &self.data[i];
            state.read(datum.channel, &(compliance(i) * state.along(datum)))
        };
        let met = state.met(&self.data, &self.course, self.step, &along);
        state.pull_beside(&mut pulls, &self.data, &self.course, &met);
        let reading = |(i, datum): (usize, &Datum)| {
            let pull = &pulls[i];
            let bent = compliance(i) * (pull.direction * pull.load);
            state.read(datum.channel, &(bent + pull.direction * pull.play))
        };
        let mut readings: Vec<f64> = self.data.iter().enumerate().map(reading).collect();
        for (i, met) in met {
            let (datum, along) = (&self.data[i], along(i));
            let per_newton = datum.imposed.map_or(along, |imposed| imposed.per_newton);
            readings[i] = match along == 0.0 {
                true => 0.0,
                false => per_newton * state.measured_load(i, datum, &met, along),
            };
        }
        readings
    }

    pub(in crate::diagnosis::rig) fn changed(&self, state: &State<'_>) -> DVector<f64> {
        checkpoint();
        let mut change = DVector::zeros(self.data.len());
        for (action, value) in &state.additions {
            action.add_to(change.as_mut_slice(), *value);
        }
        state.add_own(change.as_mut_slice());
        state.add_recovery(change.as_mut_slice());
        match &self.body {
            _ if !state.is_changed => {}
            Body::Rod(structure) => {
                let readings = self.displaced(structure, state);
                for ((change, reading), datum) in change.iter_mut().zip(readings).zip(&self.data) {
                    *change += reading - datum.predicted;
                }
            }
            Body::Lines(count) => {
                // of an imposed displacement a line is the load per displacement: c₀ the compliance
                // that its unit is
                let unit = |i: usize| self.data[i].imposed.map_or(1.0, |imposed| imposed.per_newton);
                let measured: Vec<f64> = self.data.iter().map(|d| d.measured).collect();
                let drives: Vec<f64> = self.data.iter().map(Datum::drive).collect();
                let stiffness = self.slopes(*count, &drives, &measured);
                let compliance =
                    |i: usize| unit(i) / stiffness[self.place[i]].abs().max(f64::MIN_POSITIVE.sqrt());
                let met = state.met(&self.data, &self.course, self.step, &compliance);
                let mut pulls = state.pulls(&self.data, &self.course);
                state.pull_beside(&mut pulls, &self.data, &self.course, &met);
                let mut felt: Vec<f64> = Vec::with_capacity(self.data.len());
                for (i, (datum, pull)) in self.data.iter().zip(&pulls).enumerate() {
                    felt.push(pull.load * f64::from(datum.direction.sign));
                    change[i] += pull.direction[datum.channel.index()] * pull.play;
                }
                for (i, met) in met {
                    let datum = &self.data[i];
                    let load = state.measured_load(i, datum, &met, unit(i));
                    let besides = state.measured_load(i, datum, &met.unbent(), unit(i));
                    felt[i] = unit(i) * (load - besides);
                    change[i] += unit(i) * besides;
                }
                let left: Vec<f64> =
                    self.data.iter().zip(change.iter()).map(|(d, c)| d.measured - c).collect();
                let slopes = self.slopes(*count, &felt, &left);
                for (i, datum) in self.data.iter().enumerate() {
                    change[i] += slopes[self.place[i]] * (felt[i] - datum.drive_as_read());
                }
            }
        }
        change
    }
}
