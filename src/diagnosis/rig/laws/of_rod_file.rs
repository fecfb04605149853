//! What the laws of the rod's file add to a recording, and how well that is known.
//!
//! Places and variables are those of `sites.rs`, where laws are proposed: what a diagnosis
//! wrote is read as it was meant. Each constant is a nominal number, known to its standard
//! uncertainty.

use nalgebra::DVector;

use super::measures::{SiteVariable, place_in_file};
use super::remembered::remembered;
use super::sites::sites;
use crate::diagnosis::rig::model::RigModel;
use crate::diagnosis::rig::model::nominal::KnownNumber;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::law::Site;
use crate::inference::{Evidence, NominalParameter};
use crate::rod::law::{ROUNDS, STEP, should_show};
use crate::rod::{LawConstant, LawVariable, Rod, RodLaw};

/// Takes what the laws of the rod's file add out of the data; which of them these readings have no
/// data for.
pub fn take_out(model: &mut RigModel, evidence: &mut Evidence, rod: &Rod) -> Vec<RodLaw> {
    let all = sites(model, &DVector::zeros(model.data.len()));
    let mut unused = Vec::new();
    let mut adds = DVector::zeros(model.data.len());
    let mut predicted = adds.clone();
    for (number, law) in rod.laws.iter().enumerate() {
        let variable = SiteVariable::OfFile(law.variable).measure();
        let is_its = |site: &&Site| {
            place_in_file(&site.location).as_ref() == Some(&law.place) && site.variable == variable
        };
        let Some(site) = all.iter().find(is_its) else {
            unused.push(law.clone());
            continue;
        };
        let own_deflection = hung_compliance(model, site, law.variable);
        let added = |changed: Option<(usize, f64)>, argument: Argument| {
            let value = |k: usize, own: &LawConstant| match changed {
                Some((other, by)) if other == k => own.value + by,
                _ => own.value,
            };
            added(law, (site, own_deflection.as_deref()), &value, argument)
        };
        adds += added(None, Argument::Recorded);
        predicted += added(None, Argument::Predicted);
        for (k, own) in law.constants.iter().enumerate().filter(|(_, own)| own.standard_uncertainty > 0.0) {
            let u = own.standard_uncertainty;
            let column =
                0.5 * (added(Some((k, u)), Argument::Recorded) - added(Some((k, -u)), Argument::Recorded));
            if column.iter().all(|value| value.is_finite()) && column.amax() > 0.0 {
                let unit = if own.unit.is_empty() { String::new() } else { format!(", {}", own.unit) };
                model.known_numbers.push(KnownNumber::LawConstant(number, k));
                evidence.nominal_numbers.push(NominalParameter {
                    name: format!("{} of the law at {}{unit}", own.name, law.place.description()),
                    unit: "",
                    si: 1.0,
                    value: own.value,
                    standard_uncertainty: u,
                });
                let last = evidence.nominal.ncols();
                let nominal = std::mem::take(&mut evidence.nominal);
                evidence.nominal = nominal.insert_column(last, 0.0);
                evidence.nominal.set_column(last, &column);
            }
        }
    }
    // a formula may be no number where it was not recorded
    for add in adds.iter_mut().chain(predicted.iter_mut()).filter(|add| !add.is_finite()) {
        *add = 0.0;
    }
    model.law_adds = predicted.iter().copied().collect();
    model.data.iter_mut().zip(adds.iter()).for_each(|(datum, add)| datum.measured -= add);
    evidence.residual -= adds;
    unused
}

/// What a sensor's law is a function of.
#[derive(Clone, Copy, PartialEq)]
enum Argument {
    /// What was recorded, without the law itself.
    Recorded,
    /// What is predicted.
    Predicted,
}

/// Of a law of the deflection under loads that hang: what each newton there adds to its variable,
/// m/N.
fn hung_compliance(model: &RigModel, site: &Site, variable: LawVariable) -> Option<Vec<f64>> {
    let is_hung = variable == LawVariable::Deflection && model.data.iter().all(|d| d.imposed.is_none());
    let compliance = |(u, d): (&f64, &Datum)| if d.load > 0.0 { u / d.load } else { 0.0 };
    is_hung.then(|| site.values.iter().zip(&model.data).map(compliance).collect())
}

/// What a law adds to each datum, m; where it changes its own variable by so much per newton, at
/// what that is with it.
fn added(
    law: &RodLaw,
    (site, compliance): (&Site, Option<&[f64]>),
    value: &dyn Fn(usize, &LawConstant) -> f64,
    argument: Argument,
) -> DVector<f64> {
    let values: Vec<f64> = law.constants.iter().enumerate().map(|(k, own)| value(k, own)).collect();
    let at = |x: f64, side: f64| {
        let named = |own: &LawConstant| {
            law.constants.iter().position(|other| other.name == own.name).map_or(own.value, |k| values[k])
        };
        law.with(x, side, named) * site.result.si
    };
    let own = |name: &str| law.constants.iter().position(|own| own.name == name).map_or(0.0, |k| values[k]);
    let si = site.variable.si;
    let side = |i: usize| site.moves.get(i).copied().unwrap_or(1.0);
    let mut with_law = site.clone();
    let mut followed = remembered(law.memory, site, own);
    // u of u = C·(F + ΔF(u))
    for _ in 0..compliance.map_or(0, |_| ROUNDS) {
        for (i, u) in with_law.values.iter_mut().enumerate() {
            let more = compliance.map_or(0.0, |compliance| compliance[i]) * at(followed[i] / si, side(i));
            *u += STEP * (site.values[i] + more - *u);
        }
        followed = remembered(law.memory, &with_law, own);
    }
    let weights = &site.directions[0].1;
    let at_datum = |i: usize| {
        let side = side(i);
        if weights[i] == 0.0 || !followed[i].is_finite() {
            return 0.0;
        }
        match site.recorded.as_ref().filter(|own| argument == Argument::Recorded && !own.with_law) {
            // y of y + Δy(y) = what was recorded
            Some(recorded) => {
                let y = should_show(recorded.data[i] / si, |y| weights[i] * at(y, side) / si);
                weights[i] * at(y, side)
            }
            None => weights[i] * at(followed[i] / si, side),
        }
    };
    DVector::from_fn(followed.len(), |i, _| at_datum(i))
}
