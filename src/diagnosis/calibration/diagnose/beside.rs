//! The robot about which effects are linear: calibrated beside what was found.
//!
//! A calibration that knows of no effect puts it into its parameters as well as it can: a heavier
//! tip becomes a softer wrist, a slipped tool turns joints by milliradians. Columns that are made
//! there are those of another robot. So the campaign is calibrated once more with what was found
//! taken out of its rows, and the search begins anew about that robot, of which nothing is taken
//! out then. A mass that hangs there is a load of that calibration: how far joints give way to it
//! depends on what they are calibrated to.

use nalgebra::{DVector, Vector3};

use super::super::model::CalibrationModel;
use super::super::model::context::{Context, plausible};
use super::super::model::law::Hung;
use super::prepared::Prepared;
use crate::calibration::{Calibration, Carried, Compensation, Mode, Noise, Robust, calibrate_from};
use crate::diagnosis::calibration::effects::payload;
use crate::error::Result;
use crate::inference::{Evidence, Hypothesis, Term, rms};
use crate::rod::Rod;
use crate::units::URAD;

/// A turn of a joint under its largest torque that changes columns, rad.
const TURNED: f64 = 20.0 * URAD;
/// Share by which the residual of a robot that is calibrated again may differ from what the linear
/// model says of it.
const LINEAR: f64 = 0.1;

/// What acts on the rod and the arm beside what the campaign says.
pub struct Loads {
    /// Masses that nobody stated, kg, and how many times its mass a rod has too much.
    pub hung: Vec<(Hung, f64)>,
    /// What hangs on the flange, always or from some row on.
    pub carried: Vec<Carried>,
    /// What else displaces the tip at each row, m; empty where nothing does.
    pub displaced: Vec<Vector3<f64>>,
}

/// A robot that was calibrated with loads.
pub struct Beside<'c> {
    /// That calibration.
    pub calibration: Calibration<'c>,
    /// The same with the rows as if there were none.
    pub about: Calibration<'c>,
    /// What hung on its flange: its drives have turned by that too.
    pub carried: Vec<Carried>,
}

/// The robot that is calibrated beside a hypothesis, and the one about which that was found.
pub enum Again<'c> {
    /// It is the same for all that its columns show.
    Same,
    /// It is another one that leaves what the hypothesis says.
    Near(Beside<'c>),
    /// It leaves something else: the hypothesis is farther from the one than it is linear.
    Far(Beside<'c>),
}

impl<'c> Again<'c> {
    /// Where it is another one.
    pub fn another(self) -> Option<Beside<'c>> {
        match self {
            Again::Same => None,
            Again::Near(beside) | Again::Far(beside) => Some(beside),
        }
    }
}

/// True where a calibration takes a mass into account as its candidate does: not on a rod that it
/// assumes to be rigid, which bends under it all the same.
pub fn is_load(model: &CalibrationModel, own: Hung) -> bool {
    own.rows_on_flange(0).is_some() || model.campaign.rod.is_none() || model.calibration.mode != Mode::None
}

impl<'c> Beside<'c> {
    /// A robot as it was calibrated.
    pub fn as_calibrated(calibration: Calibration<'c>) -> Beside<'c> {
        Beside { about: calibration.clone(), calibration, carried: Vec::new() }
    }
}

impl Loads {
    /// One mass; of a rod so many times its own more.
    pub fn one(own: Hung, mass: f64) -> Loads {
        let moment = Vector3::zeros();
        let Some(rows) = own.rows_on_flange(usize::MAX) else {
            return Loads { hung: vec![(own, mass)], ..Loads::none() };
        };
        Loads { carried: vec![Carried { rows, mass, moment }], ..Loads::none() }
    }

    fn none() -> Loads {
        Loads { hung: Vec::new(), carried: Vec::new(), displaced: Vec::new() }
    }

    /// Of what was found.
    pub fn of(model: &CalibrationModel, terms: &[Term]) -> Loads {
        let rows = model.campaign.measurements.len();
        let carried = |term: &Term| {
            let candidate = &model.terms.candidates[term.candidate];
            payload::carried(candidate, model.law(term.candidate), term, rows)
        };
        let mass = |term: &Term| {
            let own = model.law(term.candidate).hung()?;
            let neutral = model.terms.candidates[term.candidate].parameters[0].neutral;
            let is_its = own.rows_on_flange(rows).is_none() && is_load(model, own);
            is_its.then(|| (own, term.values.first().map_or(0.0, |value| value - neutral)))
        };
        let is_other = |term: &&Term| mass(term).is_none() && carried(term).is_none();
        let others: Vec<Term> = terms.iter().filter(is_other).cloned().collect();
        Loads {
            hung: terms.iter().filter_map(mass).collect(),
            carried: terms.iter().filter_map(carried).collect(),
            displaced: model.by_row(&model.terms.response(&others)),
        }
    }

    /// What a campaign compensates, with the masses among its loads.
    pub fn beside(&self, plain: Compensation, rod: Option<&Rod>, tool: &Vector3<f64>) -> Compensation {
        let carrying = Compensation { carried: self.carried.clone(), ..plain };
        self.hung.iter().fold(carrying, |loaded, (own, more)| match (own, rod) {
            (Hung::Tip, _) => loaded.with_tip_heavier_by(*more, tool),
            (Hung::Rod, Some(rod)) => loaded.with_rod_heavier_by(*more, rod),
            (Hung::Flange | Hung::FlangeFrom(_) | Hung::FlangeUntil(_), _) | (Hung::Rod, None) => loaded,
        })
    }
}

/// That robot, the rows as if nothing had been found. One whose calibration has not converged is
/// not known to be another.
pub fn calibrated_beside<'c>(
    prepared: &Prepared<'c>,
    hypothesis: &Hypothesis,
    by_linear_model: &DVector<f64>,
) -> Result<Again<'c>> {
    let model = &prepared.model;
    if hypothesis.terms.is_empty() && prepared.is_as_calibrated() {
        return Ok(Again::Same);
    }
    let loads = Loads::of(model, &hypothesis.terms);
    let Some(beside) = calibrated_with(model, &loads)? else { return Ok(Again::Same) };
    let recording = &model.campaign.measurements;
    let residual = |row: usize| -(model.weight(row) * beside.calibration.deviations[row]);
    let left = (0..recording.len()).flat_map(|row| <[f64; 3]>::from(residual(row)));
    let left = rms(&DVector::from_iterator(3 * recording.len(), left));
    let recorded = |all: &DVector<f64>| rms(&all.rows(0, prepared.evidence.recorded).into_owned());
    let expected = recorded(by_linear_model);
    let far = LINEAR * expected + recorded(&by_numbers(&prepared.evidence, hypothesis, by_linear_model));
    Ok(match (left - expected).abs() <= far {
        true if !turns(&prepared.context, &beside.calibration) => Again::Same,
        true => Again::Near(beside),
        false => Again::Far(beside),
    })
}

/// What the numbers of the files explain beside a hypothesis, of which a calibration knows nothing:
/// at the likeliest factors z of the columns N these draw as much as what is left does.
///
/// ```text
/// z = Nᵀ·left/σ²
/// ```
fn by_numbers(evidence: &Evidence, hypothesis: &Hypothesis, left: &DVector<f64>) -> DVector<f64> {
    let variance = hypothesis.sigma.powi(2).max(f64::MIN_POSITIVE);
    &evidence.nominal * (evidence.nominal.tr_mul(left) / variance)
}

/// A robot that is calibrated with these loads; `None` where that has not converged.
pub fn calibrated_with<'c>(model: &CalibrationModel<'c>, loads: &Loads) -> Result<Option<Beside<'c>>> {
    let (campaign, known) = (model.campaign, &model.calibration);
    let plain = Compensation::new(campaign, known.mode)?;
    let loaded = loads.beside(plain.clone(), campaign.rod.as_ref(), &known.setup.tool);
    let compensation = Compensation { displaced: loads.displaced.clone(), ..loaded.clone() };
    let free: Vec<_> = known.parameters.iter().map(|estimate| estimate.parameter).collect();
    let start = known.start.clone();
    let recording = &campaign.measurements;
    let beside = calibrate_from(campaign, recording, start, &free, &compensation, &known.options)?;
    if !beside.is_converged {
        return Ok(None);
    }
    let mut about = beside.clone();
    let [plain, loaded] = [plain, loaded].map(|compensation| compensation.tips(&beside.setup, recording));
    for (row, (plain, loaded)) in plain.iter().zip(&loaded).enumerate() {
        let displaced = loads.displaced.get(row).copied().unwrap_or_default();
        about.deviations[row] -= loaded.0 - plain.0 + displaced;
        about.deflections[row] -= loaded.1 - plain.1 + displaced;
    }
    Ok(Some(Beside { calibration: beside, about, carried: loads.carried.clone() }))
}

/// True where its drives are otherwise compliant than those that the columns were made with.
fn turns(context: &Context, beside: &Calibration) -> bool {
    let Some(there) = context.configurations.first() else { return false };
    let own = plausible(&beside.setup, &context.softest);
    own.iter()
        .zip(&there.compliance)
        .enumerate()
        .any(|(j, (own, used))| (own - used).abs() * context.largest(|there| there.torque[j]) > TURNED)
}

/// Noise of each clamp's or placement's rows in what a hypothesis leaves, where they scatter
/// unequally.
pub fn unequal(prepared: &Prepared, hypothesis: &Hypothesis, left: &DVector<f64>) -> Result<Option<Noise>> {
    let recording = &prepared.model.campaign.measurements;
    let rows = 0..recording.len();
    let left: Vec<Vector3<f64>> =
        rows.map(|row| left.fixed_rows::<3>(3 * row) / prepared.context.scale(row)).collect();
    let known = Noise { is_stated: false, ..prepared.model.calibration.noise.clone() };
    let rank = prepared.model.calibration.fit.covariance.rank + hypothesis.determined.round() as usize;
    let noise = known.estimate(recording, &left, rank.min(3 * recording.len() - 1), Robust::None)?;
    let first = noise.of_group.first().copied().unwrap_or_default();
    Ok(noise.of_group.iter().any(|sd| *sd != first).then_some(noise))
}
