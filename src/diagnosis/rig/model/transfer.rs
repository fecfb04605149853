//! What was found in one recording, in the model of other readings: what the rod and the rig would
//! show there.

use nalgebra::DVector;

use super::wanted::{Wanted, is_same};
use super::{RigDiagnosis, RigModel};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::diagnosis::rig::write_back::as_found;
use crate::error::Result;
use crate::inference::{Candidate, ForwardModel, Term};
use crate::rig::readings::Readings;

/// Terms in a model that is not their own.
pub struct Transferred {
    /// The effects that have a meaning there.
    pub terms: Vec<Term>,
    /// For each of their parameters its place among those of the whole
    /// hypothesis; `None` for one that its own readings could not show, and that stays neutral.
    pub known: Vec<Option<usize>>,
}

impl RigModel {
    /// Terms of `from` in this model. What happened once (a slip, a zero that was not taken) does
    /// not happen again.
    pub(in crate::diagnosis::rig) fn transferred(&self, from: &RigModel, terms: &[Term]) -> Transferred {
        let (mut transferred, mut known, mut first) = (Vec::new(), Vec::new(), 0);
        for effect in terms {
            let old = &from.candidates[effect.candidate];
            let same = self.candidates.iter().enumerate().find(|(_, new)| is_same(new, old));
            if let Some((index, new)) = same {
                let mut values = Vec::new();
                for parameter in &new.parameters {
                    let place = old.parameters.iter().position(|q| q.name == parameter.name);
                    values.push(place.map_or(parameter.neutral, |k| effect.values[k]));
                    known.push(place.map(|k| first + k));
                }
                transferred.push(Term { candidate: index, values });
            }
            first += effect.values.len();
        }
        Transferred { terms: transferred, known }
    }
}

impl RigDiagnosis {
    /// What would be read where other readings are `asked` for, m, without noise: the model of the
    /// rod with all findings, and with what large deflections add to second order. One number for
    /// each offset of `asked`, row by row, dx before dy before dz; the offsets that stand there do
    /// not matter.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let rod = Rod::read("rods/5.toml".as_ref())?;
    /// let readings = Readings::read("stiffness_data/5.csv".as_ref())?;
    /// let found = diagnosis::rig::diagnose(&readings, Some(&rod))?;
    /// // what 10 N along y would read; the 0 says which offset is asked for
    /// let asked = Readings::from_text("asked.csv", "axis,load_n,dy_um\ny,5,0\ny,10,0\n")?;
    /// let predicted = found.predicted(&asked)?;
    /// // 46.3 µm/N, less the 0.9 N that friction holds back
    /// assert!((predicted[1] - 46.3e-6 * (10.0 - 0.9)).abs() < 5e-6, "{predicted:?}");
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`RigModel::new`]. Without a rod nothing is known of the slope of another line:
    /// [`crate::Error::NotApplicable`].
    pub fn predicted(&self, asked: &Readings) -> Result<Vec<f64>> {
        let Some(rod) = self.model.rod() else {
            return Err(crate::Error::NotApplicable {
                what: "a prediction of other readings".into(),
                why: "a straight line says nothing of another one".into(),
                hint: "give the rod's file".into(),
            });
        };
        let parts = self.diagnosis.findings.iter().flat_map(|finding| &finding.parts);
        let found: Vec<Term> = parts.map(|part| part.term.clone()).collect();
        let found_ones: Vec<&Candidate> =
            found.iter().map(|term| &self.model.candidates[term.candidate]).collect();
        let (model, evidence, _) =
            RigModel::with_effects(asked, Some(rod), &Wanted::LikeAnd(&found_ones, &self.model.own))?;
        let change = model.response(&model.transferred(&self.model, &found).terms);
        // what large deflections add is known of the rod as it was found: nobody fits it
        let as_found = as_found(&self.model, rod, &self.diagnosis.findings);
        let large = model.large_deflections(&as_found)?;
        let nominal = &evidence.nominal * self.nominal_factors(&model);
        let law = |i: usize| model.law_adds.get(i).copied().unwrap_or(0.0);
        let of_datum =
            |(i, datum): (usize, &Datum)| datum.predicted + large[i] + nominal[i] + change[i] + law(i);
        // in the order of the file that asks
        let mut rows: Vec<(usize, Datum)> = model.data.iter().cloned().enumerate().collect();
        rows.sort_by_key(|(_, datum)| (datum.row, datum.channel));
        Ok(rows.iter().map(|(i, datum)| of_datum((*i, datum))).collect())
    }

    /// Factors of the nominal numbers of `asked` as these readings gave them, in standard
    /// uncertainties; 0 for a number that they have not.
    fn nominal_factors(&self, asked: &RigModel) -> DVector<f64> {
        let (factors, _) = &self.diagnosis.nominal_factors;
        let known = &self.model.known_numbers;
        let factor = |number| known.iter().position(|own| own == number).map_or(0.0, |k| factors[k]);
        DVector::from_iterator(asked.known_numbers.len(), asked.known_numbers.iter().map(factor))
    }
}

#[cfg(test)]
mod tests {
    use crate::diagnosis::rig::diagnose;
    use crate::diagnosis::rig::model::RigModel;
    use crate::diagnosis::rig::model::wanted::Wanted;
    use crate::error::Error;
    use crate::inference::{Finding, ForwardModel, Kind};
    use crate::rig::readings::Readings;
    use crate::rod::Rod;
    use crate::units::UM;

    const ASKED: &str = "axis,load_n,dx_um,dy_um,dz_um\nx,3,0,0,0\n-y,4,,0,\n-y,8,,0,\n";

    /// Readings of rod 5 under loads along y that friction of 0.5 N takes its share of.
    fn recorded(rod: &Rod) -> Readings {
        let mut text = "axis,load_n,trial,phase,dy_um\n".to_owned();
        for trial in 0..3 {
            for (load, phase) in [(4, "load"), (8, "load"), (12, "load"), (8, "unload"), (4, "unload")] {
                text += &format!("y,{load},{trial},{phase},0\n");
            }
        }
        let mut readings = Readings::from_text("f", &text).unwrap();
        let (model, _, _) = RigModel::with_effects(&readings, Some(rod), &Wanted::Like(&[])).unwrap();
        for (k, (row, datum)) in readings.rows.iter_mut().zip(model.data()).enumerate() {
            let taken = if datum.is_unloading() { 0.5 } else { -0.5 };
            let noise = [0.3, -0.4, 0.1, 0.2, -0.3, 0.15, -0.05][k % 7] * UM;
            row.offset[1] = Some(datum.predicted * (1.0 + taken / datum.load) + noise);
        }
        readings
    }

    #[test]
    fn what_is_found_under_one_load_is_predicted_under_another() {
        let rod = Rod::from_toml("rod", include_str!("../../../../rods/5.toml")).unwrap();
        let asked = Readings::from_text("asked", ASKED).unwrap();
        let found = diagnose(&recorded(&rod), Some(&rod)).unwrap();
        let name = |finding: &Finding| finding.effect.name;
        assert_eq!(found.diagnosis.findings.iter().map(name).collect::<Vec<_>>(), ["friction"]);
        let predicted = found.predicted(&asked).unwrap();
        assert_eq!(predicted.len(), 5);
        let (model, _, _) = RigModel::with_effects(&asked, Some(&rod), &Wanted::Like(&[])).unwrap();
        let share = |k: usize| predicted[k] / model.data()[k].predicted;
        // of 8 N half a newton does not arrive; friction of all loads takes its share along x too
        assert!((share(4) - 7.5 / 8.0).abs() < 2e-3 && (share(0) - 2.5 / 3.0).abs() < 5e-3, "{predicted:?}");
        // what stands in the file that asks does not matter
        let other = Readings::from_text("asked", &ASKED.replace("x,3,0", "x,3,99")).unwrap();
        assert_eq!(found.predicted(&other).unwrap(), predicted);
    }

    #[test]
    fn every_effect_is_transferred_to_itself_and_what_happened_once_is_not() {
        let rod = Rod::from_toml("rod", include_str!("../../../../rods/5.toml")).unwrap();
        let (model, _) = RigModel::new(&recorded(&rod), Some(&rod)).unwrap();
        for (index, candidate) in model.candidates().iter().enumerate() {
            let own = candidate.neutral(index);
            let transferred = model.transferred(&model, std::slice::from_ref(&own));
            let is_left = candidate.effect.kind != Kind::Physics || candidate.is_nonparametric;
            let expected = if is_left { vec![] } else { vec![own] };
            assert_eq!(transferred.terms, expected, "{candidate:?}");
            assert!(transferred.known.iter().all(Option::is_some));
        }
    }

    #[test]
    fn a_straight_line_predicts_nothing() {
        let rod = Rod::from_toml("rod", include_str!("../../../../rods/5.toml")).unwrap();
        let found = diagnose(&recorded(&rod), None).unwrap();
        let asked = Readings::from_text("asked", ASKED).unwrap();
        assert!(matches!(found.predicted(&asked), Err(Error::NotApplicable { .. })));
    }
}
