//! Terms as they are reported.

use crate::inference::columns::linearised::Linearised;
use crate::inference::held_out::Theme;
use crate::inference::model::effect::Reported;
use crate::inference::search::Search;
use crate::inference::search::parts::explained;
use crate::inference::{Finding, FindingPart, ForwardModel, HeldOut, Hypothesis, Kind, Term};

/// Parts as they are reported, the strongest first: the waves of one gear, what one knock did to
/// each channel, all misread poses, are one finding. `base` is the root mean square that the base
/// model leaves.
pub fn findings(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: &Hypothesis,
    held_out: Option<&HeldOut>,
    base: f64,
    parts: Vec<(Theme, FindingPart)>,
) -> Vec<Finding> {
    let mut findings: Vec<(Theme, Finding)> = Vec::new();
    for (theme, part) in parts {
        let effect = model.candidates()[part.term.candidate].effect;
        let location = part.location.place();
        let is_same = |(_, known): &&mut (Theme, Finding)| {
            known.effect == effect
                && match effect.reported {
                    Reported::Alone => false,
                    Reported::ByPlace => known.location == location,
                    Reported::ByRow => known.location.is_after_row_of(&location),
                    Reported::Together => true,
                }
        };
        match findings.iter_mut().find(is_same) {
            Some((_, known)) => {
                if effect.reported == Reported::Together {
                    known.location = known.location.clone().and(location);
                }
                known.p_value = known.p_value.min(part.p_value);
                known.parts.push(part);
            }
            None => {
                findings.push((theme, Finding::from_part(effect, location, Vec::new(), part)));
            }
        }
    }
    for (theme, finding) in &mut findings {
        finding.explains = match &finding.parts[..] {
            [part] => part.explains,
            parts => {
                let is_other = |term: &&Term| !parts.iter().any(|part| part.term.candidate == term.candidate);
                let others: Vec<Term> = hypothesis.terms.iter().filter(is_other).cloned().collect();
                explained(search, &search.fit(&others), hypothesis)
            }
        };
        finding.estimates = model.estimates(&finding.parts, hypothesis);
        finding.place = model.place_among_estimates(&finding.parts);
        finding.rivals = finding.parts.iter().flat_map(|part| part.rivals.clone()).collect();
        finding.rivals.sort_by(|a, b| a.odds.total_cmp(&b.odds));
        finding.unnamed = finding.parts.iter().find_map(|part| part.unnamed.clone());
        finding.found_in_folds = held_out.map(|held_out| held_out.found(model.candidates(), *theme));
        finding.held_out_loss = held_out.map(|held_out| held_out.loss(*theme));
        finding.description = model.describe(finding);
    }
    let mut findings: Vec<Finding> = findings.into_iter().map(|(_, finding)| finding).collect();
    // by what held-out data lose without it; of what happened once they know nothing
    let strength = |finding: &Finding| {
        let explained = (finding.explains / base.max(f64::MIN_POSITIVE)).powi(2);
        match finding.kind() {
            Kind::Event => explained,
            Kind::Physics | Kind::Mistake => finding.held_out_loss.unwrap_or(explained),
        }
    };
    // a mistake is undone before anything else is believed
    let is_physics = |finding: &Finding| finding.kind() != Kind::Mistake;
    findings.sort_by(|a, b| is_physics(a).cmp(&is_physics(b)).then(strength(b).total_cmp(&strength(a))));
    findings
}
