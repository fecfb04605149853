//! Tables of a score: by detectability, by size, truth against answer, and what went wrong.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;

use serde::{Serialize, Serializer};

use super::diagnosis::Finding;
use super::rate::Rate;
use super::scored_case::ScoredCase;
use super::verdict::Verdict;
use crate::effect_name::EffectName;
use crate::ground_truth::{Concealed, Kind, Parameter};

/// Edges of the bins of detectability, expected log Bayes factor.
const DETECTABILITY: [f64; 7] = [0.5, 2.0, 5.0, 10.0, 30.0, 100.0, 1000.0];
/// Edges of the bins of size over noise.
const SIZE: [f64; 6] = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0];

fn bin(edges: &[f64], value: f64) -> usize {
    edges.iter().take_while(|edge| value >= **edge).count()
}

fn limits(edges: &[f64], bin: usize) -> [Option<f64>; 2] {
    [bin.checked_sub(1).and_then(|k| edges.get(k)).copied(), edges.get(bin).copied()]
}

/// Cases with one effect whose detectability is in a bin.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bin {
    /// Lower edge, expected log Bayes factor of the oracle; `None` for the lowest bin.
    pub from: Option<f64>,
    /// Upper edge; `None` for the highest bin.
    pub to: Option<f64>,
    /// Cases in it.
    pub n: usize,
    /// Of those: the name was right.
    pub name_ok: usize,
    /// The name and the place.
    pub location_ok: usize,
    /// The same over all cases of the bin.
    pub location_ok_rate: Rate,
    /// The truth was in the reported class.
    pub in_class: usize,
    /// Nothing was named.
    pub missed: usize,
}

/// Singles by what the oracle could know.
pub fn bins(cases: &[ScoredCase<'_>]) -> Vec<Bin> {
    let mut rates = vec![[Rate::default(); 4]; DETECTABILITY.len() + 1];
    for case in cases.iter().filter(|case| case.truth.kind == Kind::Single) {
        let Some(concealed) = case.truth.effects.first() else { continue };
        let [name, place, class, missed] =
            &mut rates[bin(&DETECTABILITY, concealed.detectability.separation())];
        name.add(case.name_ok());
        place.add(case.location_ok());
        class.add(case.in_class());
        missed.add(case.sought().next().is_none());
    }
    let of_bin = |(k, [name, place, class, missed]): (usize, &[Rate; 4])| {
        let [from, to] = limits(&DETECTABILITY, k);
        Bin {
            from,
            to,
            n: name.total,
            name_ok: name.count,
            location_ok: place.count,
            location_ok_rate: *place,
            in_class: class.count,
            missed: missed.count,
        }
    };
    rates.iter().enumerate().map(of_bin).collect()
}

/// Cases with one effect of a name whose size over noise is in a bin.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PowerBin {
    /// Lower edge, size over noise; `None` for the lowest bin.
    pub from: Option<f64>,
    /// Upper edge; `None` for the highest bin.
    pub to: Option<f64>,
    /// Cases in it.
    pub n: usize,
    /// Of those: the name was right.
    pub name_ok: usize,
    /// The same over all cases of the bin.
    pub name_ok_rate: Rate,
}

/// Probability of the right name against size over noise, for each effect.
pub fn power(cases: &[ScoredCase<'_>]) -> BTreeMap<EffectName, Vec<PowerBin>> {
    let mut rates: BTreeMap<&EffectName, Vec<Rate>> = BTreeMap::new();
    for case in cases.iter().filter(|case| case.truth.kind == Kind::Single) {
        let Some(concealed) = case.truth.effects.first() else { continue };
        let own = rates.entry(&concealed.effect).or_insert_with(|| vec![Rate::default(); SIZE.len() + 1]);
        own[bin(&SIZE, concealed.size_over_noise)].add(case.name_ok());
    }
    let of_effect = |(effect, rates): (&EffectName, Vec<Rate>)| {
        let of_bin = |(k, rate): (usize, &Rate)| {
            let [from, to] = limits(&SIZE, k);
            PowerBin { from, to, n: rate.total, name_ok: rate.count, name_ok_rate: *rate }
        };
        let bins = rates.iter().enumerate().filter(|(_, rate)| rate.total > 0);
        (effect.clone(), bins.map(of_bin).collect())
    };
    rates.into_iter().map(of_effect).collect()
}

/// Truth → answer → number of cases: clean ones, and identifiable ones with a single effect, an
/// unknown one or a mistake.
pub type Confusion = BTreeMap<Verdict, BTreeMap<Verdict, usize>>;

/// For each truth how often which answer came.
pub fn confusion(cases: &[ScoredCase<'_>]) -> Confusion {
    let mut counts = Confusion::new();
    for case in cases {
        let truth = match (case.truth.kind, case.truth.effects.first()) {
            (Kind::Clean, _) => Verdict::Nothing,
            (Kind::Single | Kind::Unknown | Kind::Mistake, Some(e)) if e.detectability.is_identifiable() => {
                Verdict::Named(e.effect.clone())
            }
            _ => continue,
        };
        *counts.entry(truth).or_default().entry(case.verdict()).or_default() += 1;
    }
    counts
}

/// Of each pair of effects that imitate each other: truth → answer → number of cases, in words.
pub type Conflicts = BTreeMap<String, BTreeMap<String, BTreeMap<String, usize>>>;

/// What was answered to effects that imitate each other, distinguishable or not. A name in brackets
/// is not the strongest finding but one that it cannot distinguish from that.
pub fn conflicts(cases: &[ScoredCase<'_>]) -> Conflicts {
    let mut counts = Conflicts::new();
    for case in cases {
        let Some(pair) = &case.truth.conflict else { continue };
        let Some(concealed) = case.truth.effects.first() else { continue };
        let truth = match concealed.detectability.is_identifiable() {
            true => concealed.effect.to_string(),
            false => format!("{}, not identifiable", concealed.effect),
        };
        let verdict = case.verdict();
        let is_named = verdict == Verdict::Named(concealed.effect.clone());
        let answer = match !is_named && case.in_class() {
            true => format!("{verdict} ({})", concealed.effect),
            false => verdict.to_string(),
        };
        *counts.entry(pair.clone()).or_default().entry(truth).or_default().entry(answer).or_default() += 1;
    }
    counts
}

/// Names of the effects that the library does not have: "unexplained" is the right answer to them.
pub fn outside(cases: &[ScoredCase<'_>]) -> BTreeSet<EffectName> {
    let unknown = cases.iter().filter(|case| case.truth.kind == Kind::Unknown);
    unknown.flat_map(|case| case.truth.effects.iter().map(|e| e.effect.clone())).collect()
}

/// As a table with a line for each truth.
pub fn confusion_text<T: Display>(heading: &str, counts: &BTreeMap<T, BTreeMap<T, usize>>) -> String {
    let mut text = format!("\n{heading:27} answers\n");
    for (truth, row) in counts {
        let total: usize = row.values().sum();
        let mut cells: Vec<(&T, &usize)> = row.iter().collect();
        cells.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
        let cells: Vec<String> = cells.iter().map(|(answer, count)| format!("{answer} {count}")).collect();
        text += &format!("{truth:23} {total:3}: {}\n", cells.join(", "));
    }
    text
}

/// A case that somebody should look at.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Failure {
    /// `rig/case-0001`.
    pub case: String,
    /// What went wrong: `single, wrong name`.
    pub what: &'static str,
    /// What was concealed, companions last; in JSON a sentence each.
    #[serde(serialize_with = "as_sentences")]
    pub truth: Vec<Concealed>,
    /// What was said.
    pub said: Vec<String>,
    /// A remainder was called unexplained.
    pub unexplained: bool,
    /// Least expected log Bayes factor of the concealed effects.
    pub separation: f64,
    /// Shape of the noise.
    pub noise: String,
    /// Loads, trials, axes.
    pub protocol: String,
    /// What the oracle would take the strongest effect for, if not for itself.
    pub best_rival: Option<String>,
}

/// Every case where something went wrong that need not have.
pub fn failures(cases: &[ScoredCase<'_>]) -> Vec<Failure> {
    let what = |case: &ScoredCase<'_>| -> Option<&'static str> {
        let is_identifiable = case.truth.effects.iter().all(|e| e.detectability.is_identifiable());
        let is_below = case.truth.effects.iter().all(|e| !e.detectability.is_detectable());
        let has_mistake = case.findings.iter().any(Finding::is_mistake);
        let is_named = case.sought().next().is_some();
        Some(match case.truth.kind {
            _ if case.failed => "failed",
            Kind::Mistake if case.is_silent() => "mistake, silent",
            Kind::Mistake if case.mistake_named().is_none() => "mistake, something else",
            Kind::Mistake if !case.mistake_placed() => "mistake, wrong place",
            Kind::Mistake => return None,
            _ if has_mistake => "a mistake that nobody made",
            Kind::Clean if is_named => "clean, named",
            Kind::Clean if case.is_unexplained => "clean, called unexplained",
            Kind::Suspect if is_named => "misread readings, named",
            Kind::Suspect if !case.all_remarked() => "misread readings, not remarked",
            Kind::Suspect => return None,
            Kind::Single if is_below && is_named && !case.in_class() => "below the limit, named",
            _ if !is_identifiable => return None,
            Kind::Single if !is_named && case.is_unexplained => "single, called unexplained",
            Kind::Single if !is_named => "single, missed",
            Kind::Single if !case.name_ok() => "single, wrong name",
            Kind::Single if !case.location_ok() => "single, wrong place",
            Kind::Single if case.has_more() => "single, more named",
            Kind::Pair if case.truth.effects.iter().any(|e| case.found(e).is_none()) => "pair, not both",
            Kind::Unknown if is_named => "unknown, named",
            Kind::Unknown if !case.is_unexplained => "unknown, missed",
            _ => return None,
        })
    };
    let failure = |case: &ScoredCase<'_>| {
        let said: Vec<String> =
            case.findings.iter().map(|f| format!("{} at {}", f.effect, f.location)).collect();
        let separations = case.truth.effects.iter().map(|e| e.detectability.separation());
        Some(Failure {
            case: case.truth.case.clone(),
            what: what(case)?,
            truth: case.truth.effects.iter().chain(&case.truth.companions).cloned().collect(),
            said,
            unexplained: case.is_unexplained,
            separation: separations.fold(f64::INFINITY, f64::min).min(1e300),
            noise: case.truth.noise_shape.clone(),
            protocol: case.truth.protocol.clone(),
            best_rival: case.truth.effects.first().map(|e| e.detectability.best_rival.clone()),
        })
    };
    cases.iter().filter_map(failure).collect()
}

/// `friction at y (force_n 5.200e-1)`.
fn as_sentences<S: Serializer>(truth: &[Concealed], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(truth.iter().map(|concealed| {
        let number = |p: &Parameter| format!("{} {:.3e}", p.name, p.value);
        let numbers: Vec<String> = concealed.parameters.iter().map(number).collect();
        format!("{} at {} ({})", concealed.effect, concealed.location, numbers.join(", "))
    }))
}
