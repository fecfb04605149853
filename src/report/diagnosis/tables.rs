//! What every diagnosis shows alike: what was found, where a mismatch lives, whether it helps, how
//! likely each effect is.

use super::headline::um;
use super::subject::Subject;
use crate::inference::{
    Effect, Estimate, Evidence, Finding, HeldOut as HeldOutErrors, LackOfFit, Location, NAMED, Rank, Ranked,
    Structure, UNKNOWN, ranking,
};
use crate::report::chart::Figure;
use crate::report::pictures::diagnosis::{Candidate, Class, HeldOut, held_out, ranking as bars, to_one};
use crate::report::table::{Column, Table};
use crate::report::{Block, Section};
use crate::units::{UM, significant, with_ends};

/// Distances from chance, in standard deviations, from which on structure is called weak and
/// strong.
const WEAK: f64 = 3.0;
const STRONG: f64 = 6.0;

/// A probability; what is less than one in 10^12 is never.
fn chance(p: f64) -> String {
    if p < 1e-12 { "< 1e-12".into() } else { significant(p, 1) }
}

/// What an effect is called among others.
pub fn named(effect: &Effect) -> String {
    // it explains much because it may be anything: no cause
    if effect == &UNKNOWN { "any smooth curve".into() } else { effect.title() }
}

/// All numbers that were found; effect, place and chance stand in the first row of each finding.
pub fn parameters(findings: &[Finding]) -> Table {
    let columns = vec![
        Column::text("effect"),
        Column::text("where"),
        Column::text("parameter"),
        Column::units(),
        Column::in_row_unit("value"),
        Column::in_row_unit("from"),
        Column::in_row_unit("to"),
        Column::number("p", ""),
    ];
    let caption =
        "Parameters with 95 % intervals. p: the probability that noise alone looks as much like the effect.";
    let mut table = Table::new("findings", caption, columns);
    for finding in findings {
        if finding.estimates.is_empty() {
            // a wrong sign has a place and no number
            let (effect, place) = (finding.effect.title(), finding.location.to_string());
            let none = String::new;
            let p = chance(finding.p_value);
            table.row([effect, place, none(), none(), none(), none(), none(), p]);
        }
        for (k, estimate) in finding.estimates.iter().enumerate() {
            let first = |text: String| if k == 0 { text } else { String::new() };
            let numbers = [estimate.value, estimate.low, estimate.high];
            let [value, low, high] = with_ends(numbers.map(|x| x / estimate.unit.si), 4);
            table.row([
                first(finding.effect.title()),
                first(finding.location.to_string()),
                meaning(finding, estimate),
                estimate.unit.symbol.to_owned(),
                value,
                low,
                high,
                first(chance(finding.p_value)),
            ]);
        }
    }
    table
}

/// What a parameter is, by its effect's record: `friction force`; of a vector its axis as well.
fn meaning(finding: &Finding, estimate: &Estimate) -> String {
    let name = estimate.name.as_str();
    for (names, meaning) in finding.effect.parameters {
        match names.iter().position(|one| *one == name) {
            Some(axis) if names.len() == 3 => return format!("{meaning}, {}", ["x", "y", "z"][axis]),
            Some(_) => return (*meaning).to_owned(),
            None => {}
        }
    }
    name.trim_end_matches(estimate.unit.suffix).trim_end_matches('_').replace('_', " ")
}

/// What else a finding may be (causes beyond those of its sentence), and where else.
pub fn alternatives(causes: &[String], places: &[Location]) -> String {
    /// Most other places that are listed.
    const PLACES: usize = 4;
    let mut words = String::new();
    if !causes.is_empty() {
        words += &format!(" It may also be {}.", causes.join(", or "));
    }
    if !places.is_empty() {
        let more = if places.len() > PLACES { " …" } else { "" };
        let places: Vec<String> = places.iter().take(PLACES).map(ToString::to_string).collect();
        words += &format!(" It may be elsewhere: {}{more}.", places.join("; "));
    }
    words
}

/// Covariates that are reported: one that has the values of another is that other one.
pub fn covariates(evidence: &Evidence) -> Vec<usize> {
    let all = &evidence.covariates;
    let is_new = |k: &usize| all[..*k].iter().all(|other| other.values != all[*k].values);
    (0..all.len()).filter(is_new).collect()
}

/// Of more numbers only those are shown that something follows.
const MANY: usize = 12;

/// How much what is left follows each number of the recording.
pub fn locate(subject: &Subject) -> Block {
    let (noun, diagnosis) = (subject.noun, subject.diagnosis);
    let given_others = &diagnosis.structure_given_others;
    let has_others = given_others.iter().any(Option::is_some);
    let said = match has_others {
        true => " Given the others: before what is seen along that variable, all other findings known.",
        false => "",
    };
    let mut columns = vec![
        Column::text("along"),
        Column::text("before"),
        Column::number("strength", ""),
        Column::number("z", ""),
        Column::text("after"),
        Column::number("strength", ""),
        Column::number("z", ""),
    ];
    if has_others {
        columns.extend([
            Column::text("given the others"),
            Column::number("strength", ""),
            Column::number("z", ""),
        ]);
    }
    let mut table = Table::new(
        "locate",
        format!(
            "How clearly the residuals of the {noun} follow each variable of the recording. Strength: \
             0 not at all, 1 completely; z: distance from the value expected by chance, in standard \
             deviations.{said}"
        ),
        columns,
    );
    for k in covariates(subject.evidence) {
        let variable = subject.evidence.covariates[k].variable;
        let (before, after) = (&diagnosis.structure_before[k], &diagnosis.structure_after[k]);
        let cells =
            |s: &Structure| [word(s.z).to_owned(), format!("{:.2}", s.strength), format!("{:.1}", s.z)];
        let mut row = vec![variable.title(noun)];
        row.extend(cells(before).into_iter().chain(cells(after)));
        if has_others {
            row.extend(given_others[k].as_ref().map_or_else(|| [const { String::new() }; 3], &cells));
        }
        table.row(row);
    }
    let all = table.rows.len();
    if all <= MANY {
        return Block::Table(table);
    }
    // an arm has dozens of numbers that nothing follows
    table.rows.retain(|row| row[1] != "none" || row[4] != "none");
    match table.rows.len() {
        0 => Block::Paragraph(format!(
            "Tested one by one, the residuals follow none of {all} variables: order, place in the \
             workspace, angles, torques and moves of joints."
        )),
        some => {
            table.notes.push(format!("The residuals follow none of {} other variables.", all - some));
            Block::Table(table)
        }
    }
}

fn word(z: f64) -> &'static str {
    match z {
        z if z >= STRONG => "clear",
        z if z >= WEAK => "weak",
        _ => "none",
    }
}

/// Errors before and after, held-out ones included.
pub fn held_out_section(subject: &Subject) -> Section {
    let (noun, diagnosis) = (subject.noun, subject.diagnosis);
    let mut table = Table::new(
        "errors",
        format!(
            "Residuals of the {noun}. Held out: each part of the {noun} is predicted from the others, \
             the search for effects included. F compares the averages of repeats with their scatter; a \
             p below 0.001 means that the model leaves something out."
        ),
        vec![
            Column::text("model"),
            Column::number("rms", "µm"),
            Column::number("held out", "µm"),
            Column::number("scatter", "µm"),
            Column::number("F", ""),
            Column::number("p", ""),
        ],
    );
    let held_out = |which: fn(&HeldOutErrors) -> f64| {
        diagnosis.held_out.as_ref().map_or("–".to_owned(), |errors| um(which(errors)))
    };
    let test = |test: &Option<LackOfFit>| match test {
        Some(test) => [significant(test.f, 3), significant(test.p_value, 2)],
        None => ["–".to_owned(), "–".to_owned()],
    };
    let mut row = |name: &str, rms: f64, held_out: String, noise: String, [f, p]: [String; 2]| {
        table.row([name.to_owned(), um(rms), held_out, noise, f, p]);
    };
    row(
        "as it is",
        diagnosis.error_before(),
        held_out(|p| p.before),
        String::new(),
        test(&diagnosis.lack_of_fit_before),
    );
    row(
        "with the findings",
        diagnosis.error_after(),
        held_out(|p| p.after),
        um(diagnosis.noise),
        test(&diagnosis.lack_of_fit_after),
    );
    let mut blocks = Vec::new();
    if let Some(errors) = &diagnosis.held_out {
        let interval = errors.gain_interval.map_or_else(String::new, |(low, high)| {
            format!(" (95 % interval {} to {} %)", percent(low), percent(high))
        });
        let words = format!("The squared held-out error falls by {} %{interval}.", percent(errors.gain));
        if !diagnosis.findings.is_empty() {
            blocks.push(Block::Paragraph(words));
            blocks.push(Block::Figure(held_out_picture((noun, subject.per), errors, diagnosis.noise)));
        }
    }
    blocks.push(Block::Table(table));
    Section::new("Does it help?", blocks)
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share).replace('-', "−")
}

/// Every effect by itself.
pub fn evidence(subject: &Subject) -> Section {
    let ranked = ranking(subject.candidates, subject.diagnosis);
    let mut table = Table::new(
        "ranking",
        "Every effect by itself against noise alone, at its best place. An effect with small odds by itself may be \
         adopted for what another one leaves unexplained.",
        vec![
            Column::text("effect"),
            Column::text("where"),
            Column::number("odds", ""),
            Column::text("verdict"),
        ],
    );
    for ranked in &ranked {
        let odds = ranked.log_odds / std::f64::consts::LN_10;
        let verdict = match ranked.rank {
            Rank::Adopted if ranked.effect == &UNKNOWN => "remains",
            Rank::Adopted => "adopted",
            Rank::Rival => "indistinguishable",
            Rank::Rejected => "rejected",
        };
        let odds = if odds.is_finite() { to_one(odds) } else { "–".into() };
        table.row([named(ranked.effect), ranked.location.to_string(), odds, verdict.into()]);
    }
    let blocks = vec![Block::Figure(candidates(&ranked)), Block::Table(table)];
    Section::new("What else it might be", blocks)
}

/// Bars beyond what was found, and what may be it instead.
const MOST_BARS: usize = 14;

/// How likely each effect is by itself.
fn candidates(ranked: &[Ranked]) -> Figure {
    let candidate = |ranked: &Ranked| Candidate {
        name: named(ranked.effect),
        log10_odds: ranked.log_odds / std::f64::consts::LN_10,
        class: match ranked.rank {
            Rank::Adopted => Class::Adopted,
            Rank::Rival => Class::Rival,
            Rank::Rejected => Class::Rejected,
        },
    };
    let is_rejected = |ranked: &&Ranked| ranked.rank == Rank::Rejected;
    let mut room = MOST_BARS.saturating_sub(ranked.iter().filter(|one| !is_rejected(one)).count());
    let drawn = ranked.iter().filter(|one| {
        let is_drawn = !is_rejected(one) || room > 0;
        room -= usize::from(is_rejected(one) && is_drawn);
        is_drawn
    });
    let candidates: Vec<Candidate> = drawn.map(candidate).collect();
    let rest = match ranked.len() - candidates.len() {
        0 => String::new(),
        more => format!(" The table has {more} less likely ones too."),
    };
    bars(&candidates, NAMED).captioned(format!(
        "How likely each effect is by itself, at its best place, against noise alone. An effect with large odds is rejected \
         where an adopted one explains the same data better.{rest}"
    ))
}

/// How well each session is predicted from the others.
pub fn replication(subject: &Subject) -> Table {
    let (caption, as_it_is) = subject.sessions;
    let columns = vec![
        Column::text("left out"),
        Column::number(as_it_is, "µm"),
        Column::number("with the findings of the others", "µm"),
    ];
    let mut table = Table::new("replication", caption, columns);
    for session in &subject.diagnosis.sessions {
        let name = (subject.session_name)(session.session);
        table.row(vec![name, um(session.before), um(session.after)]);
    }
    table
}

/// What held-out data say.
fn held_out_picture((noun, per): (&str, &str), errors: &HeldOutErrors, noise: f64) -> Figure {
    // after² = before²·(1 − gain)
    let after = |gain: f64| errors.before * (1.0 - gain).max(0.0).sqrt() / UM;
    held_out(
        (noun, per),
        &HeldOut {
            before_um: errors.before / UM,
            after_um: errors.after / UM,
            after_95_um: errors.gain_interval.map(|(low, high)| (after(high), after(low))),
            noise_um: noise / UM,
        },
    )
    .captioned(format!(
        "Error of held-out {noun}, root mean square{per}: {} µm before, {} µm after. No model predicts better than the \
         scatter.",
        um(errors.before),
        um(errors.after)
    ))
}
