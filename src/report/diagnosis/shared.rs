//! What every diagnosis says alike: where a mismatch lives, whether the story helps, how likely each effect is.

use serde_json::{Value, json};

use super::headline::um;
use super::ranking::{Ranked, ranking};
use super::spoken;
use crate::diagnosis::{Covariate, Diagnosis, Evidence, LackOfFit, Proof, Structure, World, rms};
use crate::report::chart::Figure;
use crate::report::pictures::diagnosis::{Candidate, Class, HeldOut, held_out, ranking as ranking_picture};
use crate::report::table::{Column, Table};
use crate::report::{Block, Section};
use crate::units::{UM, significant};

/// Distances from chance, in standard deviations, from which on structure is called weak and strong.
const WEAK: f64 = 3.0;
const STRONG: f64 = 6.0;

/// A probability; what is less than one in 10^12 is never.
fn chance(p: f64) -> String {
    if p < 1e-12 { "< 1e-12".into() } else { significant(p, 1) }
}

/// A parameter as it is told: name, its unit in SI, value and 95 % interval, SI.
pub type Told<'a> = (&'a str, f64, [f64; 3]);

/// Adds the parameters of one finding; effect, place and chance stand in the first row only.
pub fn add_parameters<'a>(
    table: &mut Table,
    effect: &str,
    place: &str,
    p_value: f64,
    parameters: impl Iterator<Item = Told<'a>>,
) {
    for (k, (name, unit, numbers)) in parameters.enumerate() {
        let first = |text: String| if k == 0 { text } else { String::new() };
        let [value, low, high] = numbers.map(|x| significant(x / unit, 4));
        table.row([
            first(spoken(effect)),
            first(place.to_owned()),
            name.to_owned(),
            value,
            low,
            high,
            first(chance(p_value)),
        ]);
    }
}

/// The table of all parameters that were found, without rows; see [`add_parameters`].
pub fn parameters() -> Table {
    let columns = vec![
        Column::text("effect"),
        Column::text("where"),
        Column::text("parameter"),
        Column::number("value", ""),
        Column::number("from", ""),
        Column::number("to", ""),
        Column::number("chance", ""),
    ];
    let caption = "Parameters, in the units of their names, with 95 % intervals. Chance: the probability that noise alone \
                   looks as much like it.";
    Table::new("findings", caption, columns)
}

/// What else a finding may be (causes beyond those of its sentence), and where else.
pub fn alternatives(causes: &[String], places: &[impl AsRef<str>]) -> String {
    /// Most other places that are listed.
    const PLACES: usize = 4;
    let mut words = String::new();
    if !causes.is_empty() {
        words += &format!(" It may also be {}.", causes.join(", or "));
    }
    if !places.is_empty() {
        let more = if places.len() > PLACES { " …" } else { "" };
        let places: Vec<&str> = places.iter().take(PLACES).map(AsRef::as_ref).collect();
        words += &format!(" It may be elsewhere: {}{more}.", places.join("; "));
    }
    words
}

/// Covariates that are told: one that has the values of another is that other one.
pub fn covariates(evidence: &Evidence) -> Vec<usize> {
    let all = &evidence.covariates;
    let is_new = |k: &usize| all[..*k].iter().all(|other| other.values != all[*k].values);
    (0..all.len()).filter(is_new).collect()
}

/// How much what is left follows each number of the recording; `along` says a covariate's name.
pub fn locate(noun: &str, evidence: &Evidence, diagnosis: &Diagnosis, along: impl Fn(&str) -> &str) -> Table {
    let mut table = Table::new(
        "locate",
        format!(
            "How much the {noun}' distance from the model follows each number of the recording. Strength: 0 none, 1 nothing \
             else; z: standard deviations from what chance gives."
        ),
        vec![
            Column::text("along"),
            Column::text("before"),
            Column::number("strength", ""),
            Column::number("z", ""),
            Column::text("after"),
            Column::number("strength", ""),
            Column::number("z", ""),
        ],
    );
    for k in covariates(evidence) {
        let covariate = &evidence.covariates[k];
        let (before, after) = (&diagnosis.structure_before[k], &diagnosis.structure_after[k]);
        let cells =
            |s: &Structure| [word(s.z).to_owned(), format!("{:.2}", s.strength), format!("{:.1}", s.z)];
        let mut row = vec![along(&covariate.name).to_owned()];
        row.extend(cells(before).into_iter().chain(cells(after)));
        table.row(row);
    }
    table
}

fn word(z: f64) -> &'static str {
    match z {
        z if z >= STRONG => "strong",
        z if z >= WEAK => "weak",
        _ => "none",
    }
}

/// Errors before and after, held-out ones included.
pub fn proof(noun: &str, diagnosis: &Diagnosis) -> Section {
    let mut table = Table::new(
        "errors",
        format!(
            "What is left of the {noun}. Held out: parts of the {noun} are predicted from the others, the search for effects \
             included. F compares the averages of repeats with their scatter; a p below 0.001 says that something is left \
             out."
        ),
        vec![
            Column::text("model"),
            Column::number("rms", "µm"),
            Column::number("held out", "µm"),
            Column::number("noise", "µm"),
            Column::number("F", ""),
            Column::number("p", ""),
        ],
    );
    let held_out =
        |of: fn(&Proof) -> f64| diagnosis.proof.as_ref().map_or("–".to_owned(), |proof| um(of(proof)));
    let test = |test: &Option<LackOfFit>| match test {
        Some(test) => [significant(test.f, 3), significant(test.p_value, 2)],
        None => ["–".to_owned(), "–".to_owned()],
    };
    let mut row = |name: &str, rms: f64, held_out: String, noise: String, [f, p]: [String; 2]| {
        table.row([name.to_owned(), um(rms), held_out, noise, f, p]);
    };
    row(
        "as it is",
        rms(&diagnosis.before),
        held_out(|p| p.before),
        String::new(),
        test(&diagnosis.lack_of_fit_before),
    );
    row(
        "with what was found",
        rms(&diagnosis.after),
        held_out(|p| p.after),
        um(diagnosis.noise),
        test(&diagnosis.lack_of_fit_after),
    );
    let mut blocks = Vec::new();
    if let Some(proof) = &diagnosis.proof {
        let interval = proof.gain_interval.map_or_else(String::new, |(low, high)| {
            format!(" (95 % interval {} to {} %)", percent(low), percent(high))
        });
        let words = format!("Of the squares of held-out errors {} % vanish{interval}.", percent(proof.gain));
        if !diagnosis.findings.is_empty() {
            blocks.push(Block::Paragraph(words));
        }
        blocks.push(Block::Figure(proof_picture(noun, proof, diagnosis.noise)));
    }
    blocks.push(Block::Table(table));
    Section::new("Does it help?", blocks)
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share).replace('-', "−")
}

/// Every effect by itself.
pub fn evidence(ranked: &[Ranked]) -> Section {
    let mut table = Table::new(
        "ranking",
        "Every effect by itself against noise alone, at its best place. Odds are powers of ten: 2 is a hundred to one. \
         An effect that says little by itself may be adopted for what another one leaves.",
        vec![
            Column::text("effect"),
            Column::text("where"),
            Column::number("log10 of the odds", ""),
            Column::text("verdict"),
        ],
    );
    for ranked in ranked {
        let odds = ranked.log_odds / std::f64::consts::LN_10;
        let verdict = match ranked.class {
            Class::Adopted if ranked.effect == "unknown" => "remains",
            Class::Adopted => "adopted",
            Class::Rival => "cannot be told from it",
            Class::Rejected => "rejected",
        };
        let odds = if odds.is_finite() { format!("{odds:.1}") } else { "–".into() };
        table.row([spoken(&ranked.effect), ranked.place.clone(), odds, verdict.into()]);
    }
    Section::new("What else it might be", vec![Block::Figure(candidates(ranked)), Block::Table(table)])
}

/// How likely each effect is by itself.
fn candidates(ranked: &[Ranked]) -> Figure {
    let bars: Vec<Candidate> = ranked
        .iter()
        .map(|ranked| Candidate {
            name: spoken(&ranked.effect),
            log10_odds: ranked.log_odds / std::f64::consts::LN_10,
            class: ranked.class,
        })
        .collect();
    ranking_picture(&bars, crate::diagnosis::NAMED).captioned(
        "How likely each effect is by itself, at its best place, against noise alone: 2 is a hundred to one. An effect may \
         reach far and yet be rejected, where what was adopted explains the same readings better.",
    )
}

/// What held-out data say.
fn proof_picture(noun: &str, proof: &Proof, noise: f64) -> Figure {
    // after² = before²·(1 − gain)
    let after = |gain: f64| proof.before * (1.0 - gain).max(0.0).sqrt() / UM;
    held_out(noun, &HeldOut {
        before_um: proof.before / UM,
        after_um: proof.after / UM,
        after_95_um: proof.gain_interval.map(|(low, high)| (after(high), after(low))),
        noise_um: noise / UM,
    })
    .captioned(format!(
        "Error of {noun} that the fit had not seen: {} µm before, {} µm after. No model comes below the noise.",
        um(proof.before),
        um(proof.after)
    ))
}

/// What is left along each covariate.
pub fn locate_json(evidence: &Evidence, diagnosis: &Diagnosis) -> Vec<Value> {
    let structure = |structure: &Structure| json!({ "strength": structure.strength, "z": structure.z });
    let structures = diagnosis.structure_before.iter().zip(&diagnosis.structure_after);
    let of = |(covariate, (before, after)): (&Covariate, (&Structure, &Structure))| {
        json!({
            "covariate": covariate.name,
            "unit": covariate.unit,
            "before": structure(before),
            "after": structure(after),
        })
    };
    evidence.covariates.iter().zip(structures).map(of).collect()
}

/// Every effect by itself, the likeliest first.
pub fn ranking_json(world: &dyn World, diagnosis: &Diagnosis) -> Vec<Value> {
    let of_ranked = |ranked: Ranked| {
        json!({
            "effect": ranked.effect,
            "location": ranked.place,
            "log_odds": ranked.log_odds,
            "class": match ranked.class {
                Class::Adopted => "adopted",
                Class::Rival => "indistinguishable",
                Class::Rejected => "rejected",
            },
        })
    };
    ranking(world, diagnosis).into_iter().map(of_ranked).collect()
}

/// A test of the averages of repeats.
pub fn test_json(test: &LackOfFit) -> Value {
    json!({ "f": test.f, "p_value": test.p_value, "dof_fit": test.dof_fit, "dof_repeats": test.dof_repeats })
}
