//! What a reader in a hurry takes away of a search, and what to know before trusting it.

use super::cells::{count, tube_of};
use crate::compliance::{LINEAR_SHARE, paper_contact_force};
use crate::design::{Design, Figure, Study};
use crate::report::{Card, Tone};
use crate::units::{UM, significant};

/// How many there are, what the best can do, and where the rod to compare with stands.
pub fn cards(study: &Study) -> Vec<Card> {
    let found = &study.found;
    let looked_at = count(found.evaluated, "rod");
    let kept = Card::new("Keep all limits", found.feasible.to_string(), format!("of {looked_at}"));
    let Some(first) = found.front.first() else { return vec![kept.toned(Tone::Attention)] };
    let front = found.front.len().to_string();
    let mut cards = vec![
        kept,
        Card::new("On the front", front, "no other rod is as good in every goal and better in one"),
    ];
    for goal in &study.space.goals {
        let value = |design: &Design| design.figures.get(goal.figure).unwrap_or(f64::NAN);
        let is_better = |one: &Design, than: &Design| match goal.is_maximised {
            true => value(one) > value(than),
            false => value(one) < value(than),
        };
        let best = found.front.iter().fold(first, |best, one| if is_better(one, best) { one } else { best });
        let ((name, unit), most) =
            (goal.figure.name_and_unit(), if goal.is_maximised { "largest" } else { "smallest" });
        let value = format!("{} {unit}", significant(value(best), 3)).trim_end().to_owned();
        cards.push(Card::new(format!("{name}, {most}"), value, tube_of(study, best)));
    }
    if let Some(base) = &study.base {
        let (value, tone) = match base.bettered_by {
            0 => ("none is better in every goal".to_owned(), Tone::Good),
            count => (format!("{} better in every goal", are(count)), Tone::Attention),
        };
        let detail = if base.broken.is_empty() { "it keeps all limits" } else { "it breaks a limit" };
        cards.push(Card::new(format!("Rod {}", base.rod.name), value, detail).toned(tone));
    }
    cards
}

/// `1 rod is`, `3 rods are`.
fn are(number: usize) -> String {
    format!("{} {}", count(number as u64, "rod"), if number == 1 { "is" } else { "are" })
}

/// One sentence each.
pub fn warnings(study: &Study) -> Vec<String> {
    let mut warnings: Vec<String> = study.space.warnings.iter().map(ToString::to_string).collect();
    if study.found.evaluated < study.space.combinations() {
        warnings.push(format!(
            "{} of {} combinations were looked at: better rods may be among the others",
            study.found.evaluated,
            study.space.combinations()
        ));
    }
    let soft = study.found.front.iter().filter(|design| is_beyond_linear(study, design)).count();
    if soft > 0 {
        warnings.push(format!(
            "{soft} of the {} of the front bend{} by more than {:.0} % of the length under one g or the contact force: too far \
             for the linear model, and most likely a size in another unit",
            count(study.found.front.len() as u64, "design"),
            if soft == 1 { "s" } else { "" },
            100.0 * LINEAR_SHARE
        ));
    }
    warnings
}

/// Whether a design bends farther than the beam model may be believed.
fn is_beyond_linear(study: &Study, design: &Design) -> bool {
    let entry = |figure: Figure| design.figures.get(figure).unwrap_or(0.0) * UM;
    let most = entry(Figure::CgMax).max(entry(Figure::CfMax) * paper_contact_force());
    study.space.rod(design.index).is_ok_and(|rod| most > LINEAR_SHARE * rod.length())
}
