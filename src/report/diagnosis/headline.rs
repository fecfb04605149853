//! The first lines of a diagnosis: what was found, and what it is worth.

use super::law;
pub use super::lengths::{size, um};
use super::subject::Subject;
use crate::diagnosis::Limitation;
use crate::inference::{Diagnosis, Finding, Kind, Location, Part, WrittenTo};
use crate::units::{capital, significant, uncapital};

/// So many findings are said in full; more are named.
const IN_FULL: usize = 2;
/// So many more are named; the others are counted.
const NAMED: usize = 3;
/// From so many times the scatter of readings on the scatter of zeros is said.
const FAR_APART: f64 = 4.0;
/// Who stated a noise wants to know where so many times as much comes from.
const MORE_THAN_STATED: f64 = 1.5;
/// Held-out data are predicted so many times worse than others are fitted, and with at least this
/// share of the error without any finding: that confirms hardly more than that something is there.
const MUCH_WORSE: f64 = 2.0;
const HARDLY_BETTER: f64 = 0.5;
/// Findings that predict held-out data better by no more than this share of the error are said
/// behind what nothing explains.
const MINOR: f64 = 0.05;
/// Correlation of neighbours in a run from which on it is said.
const RESEMBLING: f64 = 0.3;
/// So many rivals are said at once.
pub const RIVALS_SAID: usize = 2;

/// What was found, and what it does to the errors.
pub fn headline(subject: &Subject) -> String {
    // residuals of a fit that stopped somewhere say little, and agree with nothing
    let words = match subject.limits.contains(&Limitation::NotConverged) {
        true if !subject.diagnosis.is_mismatch() => Limitation::NotConverged.to_string(),
        true => format!("{} {}", Limitation::NotConverged, answer(subject)),
        false => answer(subject),
    };
    let words = match &subject.uneven {
        Some(uneven) => format!("{words} {}", uneven.words),
        None => words,
    };
    let words = match &subject.elsewhere {
        // why they do not agree is said first
        Some(own) if own.is_mismatch && !subject.diagnosis.is_mismatch() => format!("{} {words}", own.words),
        Some(own) => format!("{words} {}", own.words),
        None => words,
    };
    match &subject.doubtful {
        Some(doubtful) => format!("{doubtful} {words}"),
        None => words,
    }
}

/// What is said of residuals.
fn answer(subject: &Subject) -> String {
    let diagnosis = subject.diagnosis;
    let findings = &diagnosis.findings;
    let law = subject.law.as_ref().and_then(law::brief).map_or_else(String::new, |law| format!(" {law}"));
    let remains = subject.remainder.as_ref().map(|left| format!("{}{law}", left.sentence));
    // beside a law the numbers are others than beside the curve that they were found with
    let nominal = subject.nominal.as_ref().filter(|_| law.is_empty());
    let nominal = nominal.map_or_else(String::new, |words| format!(" {words}"));
    if findings.is_empty() {
        return match remains {
            Some(remains) => format!("{remains}{nominal} {}", capital(scatter(subject))),
            None => format!(
                "{}: {}the residual, {} µm{}, is {}.{}{}",
                subject.agrees,
                match nominal.trim() {
                    "" => String::new(),
                    words => uncapital(words).trim_end_matches('.').to_owned() + "; ",
                },
                um(diagnosis.error_of_others()),
                subject.per,
                scatter_of(subject),
                zeros(diagnosis).unwrap_or_default(),
                of_neighbours(subject).unwrap_or_default()
            ),
        };
    }
    let said: Vec<String> = (findings.iter().take(IN_FULL))
        .map(|finding| sentence(subject, finding) + &or_its_like(finding))
        .collect();
    // what may as well not be there is not said first
    let mut words = match unconfirmed(subject) {
        Some(words) => format!("{words} {}", said.join(" ")),
        None => said.join(" "),
    };
    let others = &findings[IN_FULL.min(findings.len())..];
    let named: Vec<String> = others.iter().take(NAMED).map(cause_at).collect();
    if !named.is_empty() {
        let more = match others.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!("; and {more} more"),
        };
        words += &format!(" Also found: {}{more}.", named.join("; "));
    }
    words += &worth(subject);
    match remains {
        Some(remains) if are_minor(subject) => {
            format!("{remains} Beside it, and perhaps a part of it: {}{nominal}", uncapital(&words))
        }
        Some(remains) => format!("{words} {remains}{nominal}"),
        None => words + &nominal,
    }
}

/// True where what was named is hardly confirmed: held-out data are predicted hardly better with
/// it, or most searches that leave a part of the data out do not find any of it again.
fn are_minor(subject: &Subject) -> bool {
    let findings = &subject.diagnosis.findings;
    let is_lost =
        |finding: &Finding| finding.found_in_folds.is_some_and(|(found, searches)| 2 * found < searches);
    let is_hardly_better =
        subject.errors.held_out.is_some_and(|(before, after)| after > (1.0 - MINOR) * before);
    let is_named = findings.iter().any(|finding| finding.kind() == Kind::Mistake);
    !is_named && !take_numbers_place(findings) && (is_hardly_better || findings.iter().all(is_lost))
}

/// How the data scatter: noise only where somebody stated it; what repeats show; else of unknown
/// origin.
fn scatter(subject: &Subject) -> String {
    let (test, noise) = (&subject.diagnosis.noise_test, noise(subject));
    match (test.stated, &subject.diagnosis.lack_of_fit_after) {
        (Some(stated), _) => format!("noise is {noise} (stated: {} µm).", um(stated)),
        (None, Some(_)) => format!("the repeats scatter by {noise}{}.", subject.per),
        (None, None) => format!("{noise}{} of unexplained scatter remain.", subject.per),
    }
}

/// The same of what is left: `the scatter of the repeats`.
fn scatter_of(subject: &Subject) -> String {
    let (test, noise) = (&subject.diagnosis.noise_test, noise(subject));
    let without = match subject.diagnosis.suspects.len() {
        0 => String::new(),
        1 => " without the suspect reading".to_owned(),
        count => format!(" without {count} suspect {}", subject.noun),
    };
    let is_uneven = subject.uneven.is_some();
    match (test.stated, &subject.diagnosis.lack_of_fit_after) {
        (Some(stated), _) if is_uneven => {
            format!("noise of the sensors (most of them {noise}{without}; stated: {} µm)", um(stated))
        }
        (Some(stated), _) => format!("noise ({noise}{without}; stated: {} µm)", um(stated)),
        (None, Some(_)) if is_uneven => format!("as large as the repeats of each sensor scatter{without}"),
        (None, Some(_)) => format!("as large as the scatter of the repeats ({noise}){without}"),
        (None, None) => "unexplained scatter (nothing was repeated)".to_owned(),
    }
}

/// `1.6 µm`; where it is far more than was stated, and does not contradict that, what of it is
/// whose.
fn noise(subject: &Subject) -> String {
    let diagnosis = subject.diagnosis;
    let (test, ratio) = (&diagnosis.noise_test, diagnosis.shared_ratio);
    // beside a law as much is left as it leaves
    let laws = subject.law.iter().flat_map(|own| own.proposed.laws());
    let noise = laws.map(|law| law.noise).fold(diagnosis.noise, f64::min);
    let is_more = test.stated.is_some_and(|stated| noise > MORE_THAN_STATED * stated);
    if !is_more || test.is_contradicted() || ratio <= 0.0 {
        return format!("{} µm", um(noise));
    }
    // σ² of a reading is that of its run's zero and its own
    let own = noise / (1.0 + ratio).sqrt();
    format!("{} µm of the readings and {} µm of the zeros of the runs", um(own), um(own * ratio.sqrt()))
}

/// Is the scatter neither stated nor shown by repeats? It is then estimated from the residual,
/// which the fit has made smaller than it.
pub fn is_scatter_estimated(subject: &Subject) -> bool {
    subject.diagnosis.noise_test.stated.is_none() && subject.diagnosis.lack_of_fit_after.is_none()
}

/// Zeros that differ far more than readings do: nothing that was looked for, and no agreement
/// either.
fn zeros(diagnosis: &Diagnosis) -> Option<String> {
    let ratio = diagnosis.shared_ratio;
    (ratio > FAR_APART * FAR_APART).then_some(())?;
    // σ² of a reading is that of its run's zero and its own
    let own = diagnosis.noise / (1.0 + ratio).sqrt();
    Some(format!(
        " Most of it is from run to run: the zeros of the runs scatter by {} µm, readings within a run by {} µm. \
         Look for what moves between runs.",
        um(own * ratio.sqrt()),
        um(own)
    ))
}

/// Errors that neighbours have in common, too few or over too short a time to be something that
/// moves.
fn of_neighbours(subject: &Subject) -> Option<String> {
    let correlation = subject.diagnosis.settled.0.correlation.filter(|own| *own >= RESEMBLING);
    if let Some(correlation) = correlation {
        return Some(format!(
            " {} of a run that follow one another resemble each other (correlation {}): look for what changes \
             within some of them, as a draught or the temperature does.",
            capital(subject.noun),
            significant(correlation, 2)
        ));
    }
    let in_common = |limit: &Limitation| match limit {
        Limitation::CorrelatedPoses(share, length) => Some((*share, *length)),
        _ => None,
    };
    let (share, length) = subject.limits.iter().find_map(in_common)?;
    Some(format!(
        " {} % of its variance is common to {} that follow one another, over about {} of them.",
        significant(100.0 * share, 2),
        subject.noun,
        significant(length, 2)
    ))
}

/// False for a mistake that nothing can undo but another recording.
pub fn is_undone(finding: &Finding) -> bool {
    finding.kind() != Kind::Mistake || finding.written_to != WrittenTo::Nowhere
}

/// What the findings do to the errors.
fn worth(subject: &Subject) -> String {
    let errors = subject.errors;
    let averaged = errors.averaged;
    let scatter = scatter(subject);
    let (mistakes, findings): (Vec<_>, Vec<_>) =
        subject.diagnosis.findings.iter().partition(|finding| finding.kind() == Kind::Mistake);
    if findings.is_empty() {
        let it = if mistakes.len() > 1 { "they are" } else { "it is" };
        let (before, after) = (size(errors.before), size(errors.after));
        if !mistakes.iter().any(|mistake| is_undone(mistake)) {
            return format!(" Until {it} corrected, these {} say nothing else.", subject.noun);
        }
        return match errors.after < errors.before && before != after {
            true => {
                let falls = from_to(errors.before, errors.after);
                format!(" Once {it} corrected, the residual falls {falls}{averaged}; {scatter}")
            }
            false => format!(" Once {it} corrected, the residual is {after}{averaged}; {scatter}"),
        };
    }
    // with mistakes, what was held out is that of the corrected recording
    let it = match (mistakes.is_empty(), findings.len()) {
        (true, 1) => "it",
        (true, _) => "them",
        (false, 1) => "the other finding",
        (false, _) => "the other findings",
    };
    // this error is that of the readings as they were recorded
    let correction = if mistakes.is_empty() { "" } else { "the correction and " };
    let fitted = |why: &str| {
        let falls = from_to(errors.before, errors.after);
        format!(" With {correction}{it}, the error falls {falls}{averaged}{why}; {scatter}")
    };
    // a single event says nothing about data that were held out
    let are_events = findings.iter().all(|finding| finding.kind() == Kind::Event);
    match errors.held_out {
        _ if are_events => fitted(""),
        Some((before, after)) if um(after) != um(before) && after < before => format!(
            " With {it}, the held-out error falls {}{averaged}{}; {scatter}",
            from_to(before, after),
            only_in_part(subject, it, (before, after))
        ),
        Some(_) if mistakes.is_empty() && take_numbers_place(&subject.diagnosis.findings) => format!(
            " Held-out {} do not distinguish {it} from numbers of the file that would be off by much more than \
             their uncertainties. {}",
            subject.noun,
            capital(&scatter)
        ),
        // said before all else
        Some(_) if mistakes.is_empty() => format!(" {}", capital(&scatter)),
        Some((before, after)) => format!(
            " Held-out {} do not confirm {it}: their error is {} before and {} after{averaged}.",
            subject.noun,
            size(before),
            size(after)
        ),
        None => fitted(" (nothing could be held out)"),
    }
}

/// True where without any of them the numbers of the file would be as far off as they cannot be.
/// Held-out data are then predicted as well by these, and say nothing.
fn take_numbers_place(findings: &[Finding]) -> bool {
    let mut physics = findings.iter().filter(|finding| finding.kind() == Kind::Physics).peekable();
    physics.peek().is_some()
        && physics.all(|finding| finding.parts.iter().any(|part| part.takes_numbers_place))
}

/// Said where held-out data are predicted no better with what was found. A single event says
/// nothing of them, and a mistake is corrected before anything is held out.
fn unconfirmed(subject: &Subject) -> Option<String> {
    let findings = &subject.diagnosis.findings;
    let is_physics = |finding: &&Finding| finding.kind() == Kind::Physics;
    let count = findings.iter().filter(is_physics).count();
    if count == 0
        || take_numbers_place(findings)
        || findings.iter().any(|finding| finding.kind() == Kind::Mistake)
    {
        return None;
    }
    let (before, after) = subject.errors.held_out?;
    if um(after) != um(before) && after < before {
        return None;
    }
    let it = if findings.len() == 1 { "this" } else { "these" };
    Some(format!(
        "Possible, but held-out {} do not confirm {it} (their error is {} before and {} after{}):",
        subject.noun,
        size(before),
        size(after),
        subject.errors.averaged
    ))
}

/// Said where held-out data, which `it` predicts better than nothing does, are predicted much worse
/// than the fit explains the others, and nothing else says that something is missing. What happened
/// once is held out with the data that show it.
fn only_in_part(subject: &Subject, it: &str, (before, after): (f64, f64)) -> String {
    let fitted = subject.errors.after;
    let findings = &subject.diagnosis.findings;
    let is_said = subject.diagnosis.discrepancy.is_some()
        || findings.iter().any(|finding| finding.kind() == Kind::Event);
    if is_said || after < MUCH_WORSE * fitted || after < HARDLY_BETTER * before {
        return String::new();
    }
    let noun = subject.noun;
    // of a fit that leaves as good as nothing no number says more
    let times = match after / fitted {
        times if times < 1e3 => significant(times, 2),
        _ => "over 1000".to_owned(),
    };
    format!(
        ", {times} times the residual of the fit ({} µm): held-out {noun} confirm {it} only in part",
        um(fitted)
    )
}

/// A finding with what these data cannot distinguish from it.
pub fn sentence(subject: &Subject, finding: &Finding) -> String {
    let description = &finding.description;
    let mut said = finding.other_causes();
    if said.is_empty() {
        return format!("{description}.");
    }
    if said.len() > RIVALS_SAID {
        said.truncate(RIVALS_SAID);
        said.push("others".into());
    }
    let (said, noun) = (said.join(", or "), subject.noun);
    match finding.kind() {
        // what is wrong ends with what to do about it, which a rival is no other end of
        Kind::Mistake => {
            format!("{description}. It may also be {said}; these {noun} cannot distinguish them.")
        }
        _ => format!("{description}, or {said}; these {noun} cannot distinguish them."),
    }
}

/// Which other clamp, socket, joint or part it may be: the first sentence names none as if it were
/// sure.
fn or_its_like(finding: &Finding) -> String {
    let places = finding.other_places();
    if let Location::Form { part, .. } = &finding.location {
        return or_another_part(*part, &places);
    }
    let is_named = |place: &Location| matches!(place, Location::Named(_));
    if !is_named(&finding.location) || !places.iter().any(is_named) {
        return String::new();
    }
    let named: Vec<String> = places.iter().filter(|place| is_named(place)).map(ToString::to_string).collect();
    format!(" It may as well be {}.", named.join(", or "))
}

/// The same of parts, each of which has several forms of a law.
fn or_another_part(own: Part, places: &[Location]) -> String {
    let mut others: Vec<Part> = Vec::new();
    for place in places {
        match place {
            Location::Form { part, .. } if *part != own && !others.contains(part) => others.push(*part),
            _ => {}
        }
    }
    let others: Vec<String> = others.iter().map(|part| format!("the {part}")).collect();
    match others.is_empty() {
        true => String::new(),
        false => format!(" It may as well be {}.", others.join(", or ")),
    }
}

/// A finding without numbers.
pub fn cause_at(finding: &Finding) -> String {
    (finding.effect.cause_at)(&finding.location)
}

/// How an error falls: `from 109 to 51 µm`, `from 331 mm to 23 µm`.
pub fn from_to(before: f64, after: f64) -> String {
    let (first, last) = (size(before), size(after));
    match (first.split_once(' '), last.split_once(' ')) {
        (Some((number, unit)), Some((_, same))) if unit == same => format!("from {number} to {last}"),
        _ => format!("from {first} to {last}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::{Description, Rival, UNKNOWN};

    #[test]
    fn large_errors_are_said_in_millimetres() {
        assert_eq!(from_to(109e-6, 51e-6), "from 109 to 51 µm");
        assert_eq!(from_to(0.330972, 23e-6), "from 331 mm to 23 µm");
        assert_eq!(from_to(0.330972, 5.21e-3), "from 331 to 5.21 mm");
    }

    #[test]
    fn the_first_sentence_says_which_other_clamp_it_may_be() {
        let at = |place: &str| Location::Named(place.into());
        let found = |places: &[Location]| {
            let mut finding =
                Finding::without_terms(&UNKNOWN, at("clamp 2"), Vec::new(), Description::default());
            finding.rivals =
                places.iter().map(|place| Rival::without_term(&UNKNOWN, place.clone(), 1.0)).collect();
            or_its_like(&finding)
        };
        assert_eq!(found(&[]), "");
        assert_eq!(found(&[Location::Station(0.2)]), "");
        assert_eq!(found(&[at("clamp 3"), at("clamp 1")]), " It may as well be clamp 3, or clamp 1.");
    }

    /// What has no name is no less of a rival.
    #[test]
    fn a_cause_without_a_name_is_said_like_any_other() {
        let follows = "follows the load".to_owned();
        let curve = Location::Curve { label: "load".into(), follows, along: None };
        let at = Location::Named("clamp 2".into());
        let mut finding = Finding::without_terms(&UNKNOWN, at, Vec::new(), Description::default());
        assert!(finding.other_causes().is_empty());
        finding.unnamed = Some(Rival::without_term(&UNKNOWN, curve, 1.0));
        assert_eq!(finding.other_causes(), ["another cause that follows the load"]);
    }

    #[test]
    fn the_first_sentence_says_which_other_part_it_may_be_and_no_other_form_of_its_own() {
        let with = |part: Part, form: &str| Location::Form { part, form: form.into() };
        let places = [
            with(Part::Base, "with order"),
            with(Part::Tracker, "with order"),
            with(Part::Tracker, "with time"),
        ];
        let found = |places: &[Location]| or_another_part(Part::Base, places);
        assert_eq!(found(&places[..1]), "");
        assert_eq!(found(&places), " It may as well be the tracker.");
    }
}
