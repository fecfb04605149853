//! What a reader in a hurry takes away from a calibration.

use crate::calibration::{
    Accuracy, AccuracyVerdict, Calibration, Campaign, CrossValidation, Summary, accuracy,
};
use crate::report::length::length;
use crate::report::{Card, Tone};
use crate::units::{UM, significant};

/// The fit, the errors before and after, at poses that it has not seen, and the verdict.
pub(super) fn cards(
    campaign: &Campaign,
    calibration: &Calibration,
    cross_validation: Option<&CrossValidation>,
) -> Vec<Card> {
    let residual = Summary::of(&calibration.residuals());
    let before = calibration.before.as_ref();
    let was = before.map_or_else(String::new, |before| format!("{} → ", length(before.residual.rms)));
    let mut cards = vec![
        fit(calibration),
        Card::new(
            "Residual at the poses of the fit, rms",
            format!("{was}{}", length(residual.rms)),
            format!("{} poses, {} parameters", residual_count(calibration), calibration.parameters.len()),
        ),
    ];
    let unseen = |label: &str, was: Option<&Summary>, now: &Summary, poses: usize| {
        let was = was.map_or_else(String::new, |was| format!("{} → ", length(was.mean)));
        let detail = format!("{poses} poses; at most {}", length(now.max));
        Card::new(label, format!("{was}{}", length(now.mean)), detail)
    };
    if let Some(validation) = &calibration.validation {
        let was = before.and_then(|before| before.validation.as_ref());
        cards.push(unseen(
            "Error at validation poses, mean",
            was,
            &validation.summary,
            validation.errors.len(),
        ));
    }
    if let Some(cv) = cross_validation {
        cards.push(unseen("Error at held-out poses, mean", None, &cv.summary, cv.errors.len()));
    }
    cards.push(verdict(campaign, &accuracy(campaign.accuracy.as_ref(), calibration, cross_validation)));
    cards
}

fn residual_count(calibration: &Calibration) -> usize {
    calibration.deviations.len()
}

/// It ran.
fn fit(calibration: &Calibration) -> Card {
    let card = |value: &str, detail: String, tone| Card::new("The fit", value, detail).toned(tone);
    if !calibration.is_converged {
        return card("did not converge", calibration.fit.reason.to_string(), Tone::Bad);
    }
    if !calibration.is_plausible() {
        let share = 100.0 * calibration.rms() / calibration.reach;
        let share = crate::units::significant(share, 2);
        return card("not plausible", format!("it leaves {share} % of the arm's reach"), Tone::Bad);
    }
    let unknown = match calibration.held.len() {
        0 => "all parameters identified".to_owned(),
        1 => "1 combination of parameters not identified".to_owned(),
        count => format!("{count} combinations of parameters not identified"),
    };
    card("converged", unknown, Tone::Good)
}

/// What the campaign asks for: `mean at most 46 µm`.
fn asked(campaign: &Campaign) -> Vec<String> {
    let limits = campaign.accuracy.as_ref();
    [("mean", limits.and_then(|limits| limits.mean)), ("largest", limits.and_then(|limits| limits.max))]
        .into_iter()
        .filter_map(|(name, limit)| Some(format!("{name} at most {}", length(limit?))))
        .collect()
}

/// Which poses a verdict stands on.
fn judged_by(judged: &Accuracy) -> &'static str {
    match judged.judged_by {
        Some("validation") => "validation poses",
        _ => "held-out poses",
    }
}

/// The verdict as a sentence, where the campaign asks for one.
pub fn verdict_sentence(campaign: &Campaign, judged: &Accuracy) -> Option<String> {
    let limits = campaign.accuracy.as_ref()?;
    let verdict = match judged.verdict {
        AccuracyVerdict::Pass => "pass",
        AccuracyVerdict::Fail => "FAIL",
        AccuracyVerdict::NotEvaluated => {
            let asked = asked(campaign).join(", ");
            return Some(format!(
                "Accuracy: not evaluated, there are no validation poses and none were held out (asked: {asked})."
            ));
        }
    };
    let errors = judged.errors?;
    let compared: Vec<String> = [("mean", errors.mean, limits.mean), ("largest", errors.max, limits.max)]
        .into_iter()
        .filter_map(|(name, error, limit)| Some((name, apart(error, limit?))))
        .map(|(name, [error, limit])| format!("{name} {error} µm, asked at most {limit} µm"))
        .collect();
    Some(format!("Accuracy at the {}: {verdict}, {}.", judged_by(judged), compared.join("; ")))
}

/// Two lengths in µm with as many digits as it takes to see that they differ: a mean of 46.004 µm
/// is not within 46 µm.
fn apart(one: f64, other: f64) -> [String; 2] {
    const DIGITS: std::ops::Range<usize> = 3..10;
    let with = |digits: usize| [one, other].map(|x| significant(x / UM, digits));
    let differ = DIGITS.map(with).find(|[one, other]| one != other);
    differ.unwrap_or_else(|| with(DIGITS.start))
}

/// It predicts.
fn verdict(campaign: &Campaign, judged: &Accuracy) -> Card {
    let limits = campaign.accuracy.as_ref();
    let (asked, by) = (asked(campaign), judged_by(judged));
    let label = "Accuracy";
    match judged.verdict {
        AccuracyVerdict::Pass => {
            Card::new(label, "pass", format!("{}, at {by}", asked.join(", "))).toned(Tone::Good)
        }
        AccuracyVerdict::Fail => {
            Card::new(label, "fail", format!("asked: {}, at {by}", asked.join(", "))).toned(Tone::Bad)
        }
        AccuracyVerdict::NotEvaluated if limits.is_some() => {
            Card::new(label, "not evaluated", "no validation poses, and none were held out")
        }
        AccuracyVerdict::NotEvaluated => Card::new(label, "not evaluated", "the campaign states no limits"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_that_is_hardly_missed_is_seen_to_be_missed() {
        assert_eq!(apart(46.004e-6, 46e-6), ["46.004", "46.000"]);
        assert_eq!(apart(108.4e-6, 46e-6), ["108", "46.0"]);
        assert_eq!(apart(46e-6, 46e-6), ["46.0", "46.0"]);
    }
}
