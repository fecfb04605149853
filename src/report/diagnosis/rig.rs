//! What is a rig's own in the report of its diagnosis.

mod correction;
mod figures;
mod lines;
mod scatter;

use nalgebra::DVector;
use serde_json::{Value, json};

use self::lines::{branch_name, line_name};
use super::headline::um;
use super::remainder::{Remainder, Sample};
use super::subject::{Errors, LawNote, LawSubject, Subject};
use super::{json as whole_json, report as whole_report};
use crate::diagnosis::rig::{Correction, Datum, RigDiagnosis, remark};
use crate::inference::{
    Discrepancy, ForwardModel, Location, NominalEstimate, Plan, Quantity, ShownBy, Variable, rms,
};
use crate::report::{Block, Report};
use crate::units::{UM, significant};

/// Most samples of the shape along one line.
const SAMPLES: usize = 12;

/// The report of `rodcal diagnose rig`; with the corrected rod, where there is one.
pub fn report(found: &RigDiagnosis, correction: Option<&Correction>) -> Report {
    whole_report(subject(found, correction))
}

/// The JSON of `rodcal diagnose rig --json`.
pub fn json(found: &RigDiagnosis, correction: Option<&Correction>) -> Value {
    whole_json(&subject(found, correction))
}

/// One sentence on what was found, and one on what it does to the errors.
pub fn headline(found: &RigDiagnosis) -> String {
    super::headline::headline(&subject(found, None))
}

fn subject<'a>(found: &'a RigDiagnosis, correction: Option<&Correction>) -> Subject<'a> {
    let (model, diagnosis) = (&found.model, &found.diagnosis);
    let (rod, readings) = (model.rod(), model.readings());
    let name = rod.map_or("a straight line".to_owned(), |rod| format!("rod {}", rod.name));
    let of_rod = rod.map_or(&[][..], |rod| &rod.warnings).iter().map(ToString::to_string);
    let of_readings = readings.warnings.iter().map(|warning| format!("{}: {warning}", readings.file));
    let unused = model.unused_laws().iter().map(|law| {
        format!("the rod file's law {law} is not used: the readings do not have what it is a function of")
    });
    let places = rod.and_then(|rod| figures::places(found, rod)).map(Block::Figure);
    Subject {
        evidence: &found.evidence,
        diagnosis,
        candidates: model.candidates(),
        not_testable: &found.not_testable,
        absorbed: &found.absorbed,
        limits: &found.limits,
        title: format!("Diagnosis of the readings of {name}"),
        noun: "readings",
        per: "",
        agrees: "The readings agree with the model",
        errors: Errors {
            averaged: "",
            before: model.recorded_error().unwrap_or_else(|| diagnosis.error_before()),
            after: diagnosis.error_after(),
            held_out: diagnosis.held_out.as_ref().map(|errors| (errors.before, errors.after)),
        },
        before_correction: model.recorded_error(),
        // units of the rod file's keys are among the mistakes
        doubtful: None,
        nominal: nominal(found),
        uneven: scatter::uneven(found),
        elsewhere: None,
        suspect: Box::new(|datum| {
            let datum = &model.data()[datum];
            json!({ "row": datum.row, "channel": format!("d{}", datum.channel) })
        }),
        remainder: remainder(found),
        law: found.law.as_ref().map(|proposed| LawSubject {
            proposed,
            noun: "readings",
            notes: proposed
                .laws()
                .map(|law| LawNote { written_to: found.law_destination(law), remark: remark(law) })
                .collect(),
            files: ["rod", "readings"],
        }),
        warnings: of_rod.chain(of_readings).chain(unused).collect(),
        head: vec![("rod", json!(rod.map(|rod| &rod.name))), ("readings", json!(readings.file))],
        more: vec![
            ("correction", json!(correction.map(correction::json))),
            ("measured_load", json!(measured_load(found))),
        ],
        of_findings: Vec::new(),
        details: Vec::new(),
        sessions: (
            "Each session predicted from the others, the search for effects included; rms of a reading. What belongs to \
             one session is no part of it.",
            "model as it is",
        ),
        session_name: Box::new(|session| model.session(session).to_owned()),
        plan: Box::new(|plan| match plan {
            Plan::Loads(plan) => super::json::load_plan(plan),
            Plan::Poses(_) => Value::Null,
        }),
        source: readings.source.clone(),
        places: std::iter::once(Block::Figure(figures::residuals(found))).chain(places).collect(),
        held_out: loads_in_newtons(found).map(Block::Paragraph).into_iter().collect(),
        consequences: correction.map(correction::section),
        count: model.data().len(),
    }
}

/// What is left unexplained, as a share of the deflections, beside which nothing is said of the
/// stiffness: readings that are not of this rod say nothing of its moduli.
const NOT_OF_THE_ROD: f64 = 0.2;
/// So many standard uncertainties of the stiffness, or of a number, are still within what the file
/// says.
const FAR: f64 = 2.0;
/// Numbers that a sentence lists.
const FEW: usize = 3;

/// `The stiffness is 0.4 ± 0.1 % above that of the rod file, within the standard uncertainty of E
/// of steel (1 %).`
fn nominal(found: &RigDiagnosis) -> Option<String> {
    let moved = found.diagnosis.nominal.first()?;
    // said already
    if found.diagnosis.discrepancy.as_ref().is_some_and(|left| left.shown_by == ShownBy::Numbers) {
        return None;
    }
    let (factors, covariance) = &found.diagnosis.nominal_factors;
    let predicted = found.model.data().iter().map(|datum| datum.predicted);
    let predicted = DVector::from_iterator(found.model.data().len(), predicted);
    let unexplained = found.diagnosis.discrepancy.as_ref().map_or(0.0, |discrepancy| discrepancy.rms);
    if unexplained > NOT_OF_THE_ROD * rms(&predicted) {
        return None;
    }
    // share of the deflections that the numbers add, and its gradient to their factors; of an
    // imposed displacement it is the load that they add to, and a stiffer rod needs more
    let sign = |datum: &Datum| if datum.imposed.is_some() { -1.0 } else { 1.0 };
    let deflected = found.model.data().iter().map(|datum| sign(datum) * datum.predicted);
    let deflected = DVector::from_iterator(found.model.data().len(), deflected);
    let gradient = found.evidence.nominal.tr_mul(&deflected) / predicted.norm_squared();
    let value = -100.0 * gradient.dot(factors);
    // what the file says of it, in the same numbers
    let stated = 100.0 * gradient.norm();
    let half = 196.0 * gradient.dot(&(covariance * &gradient)).max(0.0).sqrt();
    let word = if value >= 0.0 { "above" } else { "below" };
    let share = Quantity { value, low: value - half, high: value + half }.size().with_unit("%");
    let number = &moved.number;
    // a share of a diameter is no share of the stiffness
    let known = format!("{} {}", significant(number.standard_uncertainty / number.si, 2), number.unit);
    let others = if found.diagnosis.nominal.len() > 1 { " and of other numbers" } else { "" };
    if value.abs() > FAR * stated {
        return Some(format!(
            "This takes a stiffness {share} {word} that of the rod file, {} times as far off as the file's numbers make \
             likely ({} %): check {}.",
            significant(value.abs() / stated, 2),
            significant(stated, 2),
            number.name
        ));
    }
    Some(format!(
        "The stiffness is {share} {word} that of the rod file, within the standard uncertainty of {} \
         ({known}){others}.",
        number.name
    ))
}

/// Where the displacement was imposed: what a newton counts, and the errors of the loads in
/// newtons.
fn measured_load(found: &RigDiagnosis) -> Option<Value> {
    let per_newton = found.model.per_newton()?;
    let (diagnosis, newtons) = (&found.diagnosis, |error: f64| error / per_newton);
    Some(json!({
        "um_per_n": per_newton / UM,
        "displacement_as": found.model.displacements_count_as(),
        "rms_before_n": newtons(rms(&diagnosis.before)),
        "rms_after_n": newtons(rms(&diagnosis.after)),
        "noise_n": newtons(diagnosis.noise),
    }))
}

/// The same as sentences.
fn loads_in_newtons(found: &RigDiagnosis) -> Option<String> {
    let per_newton = found.model.per_newton()?;
    let newtons = |error: f64| significant(error / per_newton, 2);
    let counts_as = found.model.displacements_count_as().map_or_else(String::new, |what| {
        format!(" The displacement is taken as {what}, because the loads do not follow each reading of it.")
    });
    Some(format!(
        "The displacement was imposed: the measured loads are compared with the model.{counts_as} One newton counts as {} µm, \
         the largest displacement over the largest load. In newtons: {} rms as it is, {} with the findings; the \
         scatter is {}.",
        significant(per_newton / UM, 3),
        newtons(rms(&found.diagnosis.before)),
        newtons(rms(&found.diagnosis.after)),
        newtons(found.diagnosis.noise),
    ))
}

/// What remains, if anything does.
fn remainder(found: &RigDiagnosis) -> Option<Remainder> {
    let left = found.diagnosis.discrepancy.as_ref()?;
    Some(match &left.location {
        Some(Location::Curve { label, follows, along }) => {
            of_curve(found, left, label, follows, along.unwrap_or(Variable::Load))
        }
        _ if left.shown_by == ShownBy::Numbers => of_numbers(found, left),
        _ => of_conditions(found, left),
    })
}

fn of_curve(
    found: &RigDiagnosis,
    left: &Discrepancy,
    label: &str,
    follows: &str,
    along: Variable,
) -> Remainder {
    let data = found.model.data();
    let values: Vec<f64> = match found.evidence.covariate(along) {
        Some(covariate) => covariate.values.clone(),
        None => data.iter().map(|datum| datum.load).collect(),
    };
    Remainder {
        location: label.to_owned(),
        sentence: format!(
            "An unexplained error {follows}: {} µm rms, up to {} µm.",
            um(left.rms),
            um(left.shape.amax())
        ),
        rms: left.rms,
        along,
        sample_of: "readings",
        coordinates: &["left"],
        samples: thinned(means(data, &values, left)),
    }
}

/// Where only numbers far from those of the rod file explain the readings.
fn of_numbers(found: &RigDiagnosis, left: &Discrepancy) -> Remainder {
    let moved = &found.diagnosis.nominal;
    let said = |moved: &NominalEstimate| {
        let number = &moved.number;
        let by = |value: f64| (value - number.value) / number.si;
        let (value, low, high) = (by(moved.estimate), by(moved.low), by(moved.high));
        let (off, word) = match value < 0.0 {
            true => (Quantity { value: -value, low: -high, high: -low }, "below"),
            false => (Quantity { value, low, high }, "above"),
        };
        let stated = significant(number.standard_uncertainty / number.si, 2);
        let off = off.with_unit(number.unit);
        format!("{} {off} {word} the file's (standard uncertainty {stated} {})", number.name, number.unit)
    };
    let is_far = |moved: &&NominalEstimate| moved.moved().abs() > FAR;
    let far: Vec<String> = moved.iter().filter(is_far).take(FEW).map(said).collect();
    let far = if far.is_empty() { moved.iter().take(1).map(said).collect() } else { far };
    let data = found.model.data();
    let loads: Vec<f64> = data.iter().map(|datum| datum.load).collect();
    Remainder {
        location: moved.first().map_or_else(String::new, |moved| moved.number.name.clone()),
        sentence: format!(
            "The model fits only with numbers farther from those of the rod file than it says they are known: {}. They change \
             the readings by {} µm rms: check them; if they are right, something that acts like them is missing.",
            far.join("; "),
            um(left.rms)
        ),
        rms: left.rms,
        along: Variable::Load,
        sample_of: "readings",
        coordinates: &["left"],
        samples: thinned(means(data, &loads, left)),
    }
}

/// Where no curve describes it, the averages of the repeats say it.
fn of_conditions(found: &RigDiagnosis, left: &Discrepancy) -> Remainder {
    let data = found.model.data();
    let loads: Vec<f64> = data.iter().map(|datum| datum.load).collect();
    let samples = means(data, &loads, left);
    let worst = samples.iter().max_by(|a, b| a.left[0].abs().total_cmp(&b.left[0].abs()));
    let (location, average) = worst.map_or((String::new(), 0.0), |worst| {
        let place = format!("{:.4} N, {}", worst.value, worst.name).replace(".0000 N", " N");
        (place, worst.left[0])
    });
    let rms = um(left.rms);
    let stated = found.diagnosis.noise_test.stated.map_or_else(String::new, um);
    let said = match left.shown_by {
        ShownBy::StatedNoise => format!(
            "The readings differ from the model by more than the stated noise of {stated} µm, in a \
             shape that neither a smooth curve nor an effect of the library describes"
        ),
        ShownBy::Suspects => format!(
            "{} of {} readings are far off, too many, too close together or too alike for single mistakes, in a shape that neither a smooth \
             curve nor an effect of the library describes",
            found.diagnosis.suspects.len(),
            data.len()
        ),
        ShownBy::Size => "The readings differ from the model by more than such readings scatter, in a \
             shape that neither a smooth curve nor an effect of the library describes"
            .to_owned(),
        ShownBy::Repeats | ShownBy::Curve | ShownBy::Varying | ShownBy::Numbers | ShownBy::Neighbours => "Averages of repeated readings differ from the model by more \
             than their scatter, in a shape that neither a smooth curve nor an effect of the library describes"
            .to_owned(),
    };
    Remainder {
        sentence: format!("{said}: {rms} µm rms, most at {location} ({} µm).", um(average)),
        location,
        rms: left.rms,
        along: Variable::Load,
        sample_of: "readings",
        coordinates: &["left"],
        samples,
    }
}

/// The shape by line, thinned to what can be read.
fn thinned(all: Vec<Sample>) -> Vec<Sample> {
    let mut samples = Vec::new();
    for of_line in all.chunk_by(|a, b| a.name == b.name) {
        if of_line.iter().all(|sample| sample.left[0] == 0.0) {
            continue;
        }
        let step = (of_line.len() as f64 - 1.0) / (SAMPLES as f64 - 1.0);
        let is_short = of_line.len() <= SAMPLES;
        let at = |k: usize| if is_short { k } else { (k as f64 * step).round() as usize };
        let picked = (0..of_line.len().min(SAMPLES)).filter_map(|k| of_line.get(at(k)).cloned());
        samples.extend(picked);
    }
    samples
}

/// Mean of the shape for each line and value, lines in order of appearance, values ascending.
fn means(data: &[Datum], values: &[f64], left: &Discrepancy) -> Vec<Sample> {
    let has_down = data.iter().any(|datum| branch_name(datum) != line_name(datum));
    let name = |datum: &Datum| if has_down { branch_name(datum) } else { line_name(datum) };
    let mut lines: Vec<String> = Vec::new();
    data.iter().map(name).for_each(|line| {
        if !lines.contains(&line) {
            lines.push(line);
        }
    });
    let mut samples = Vec::new();
    for line in lines {
        let is_known = |i: &usize| name(&data[*i]) == line && !values[*i].is_nan();
        let rows = (0..data.len()).filter(is_known);
        let mut points: Vec<(f64, f64)> = rows.map(|i| (values[i], left.shape[i])).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        samples.extend(points.chunk_by(|a, b| a.0 == b.0).map(|same| {
            let mean = same.iter().map(|(_, y)| y).sum::<f64>() / same.len() as f64;
            let json = json!(line);
            Sample { name: line.clone(), json, value: same[0].0, left: vec![mean] }
        }));
    }
    samples
}
