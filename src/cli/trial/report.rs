//! The report of a trial: targets that are missed, rates, what was taken for what, and how large an
//! effect must be.

use std::collections::BTreeSet;
use std::fmt::Display;

use rodcal::report::chart::{Axis, Chart, Colour, Figure, Mark, Marker, Point, Range, Style};
use rodcal::report::runs::name_and_unit;
use rodcal::report::table::{Column, Table};
use rodcal::report::{Block, Card, Report, Section, Tone};
use rodcal::units::significant;
use rodcal_trial::ground_truth::Concealed;
use rodcal_trial::score::{Failure, Measured, Part, Rate, Reached, Score, Verdict};

/// Half the size of a circle that stands for all cases of a row, CSS pixels.
const FULL_PX: f64 = 9.0;
/// Beyond these ends a bin has none: where it is drawn.
const OPEN: f64 = 3.0;
/// Failures that are listed.
const MOST_FAILURES: usize = 200;

/// The report of a score.
pub fn report(score: &Score) -> Report {
    let missed: Vec<String> = score
        .suites()
        .flat_map(|(suite, part)| part.missed_targets.iter().map(move |missed| format!("{suite}: {missed}")))
        .collect();
    let cases = score.whole.cases;
    let headline = match missed.len() {
        0 => format!("{cases} cases with concealed effects: every target is met."),
        1 => format!("{cases} cases with concealed effects: 1 target is missed. {}.", missed.join(". ")),
        n => format!("{cases} cases with concealed effects: {n} targets are missed. {}.", missed.join(". ")),
    };
    let headline = score.remarks.iter().cloned().chain([headline]).collect::<Vec<_>>().join(" ");
    let mut report = Report::new("Concealed-effect trial", headline);
    report.cards = cards(score);
    report.sections = score.suites().map(|(suite, part)| section(suite, part)).collect();
    report.provenance = vec![("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into())];
    report
}

/// How many cases, and of each suite how many targets are met and how often it is right when it
/// names something.
fn cards(score: &Score) -> Vec<Card> {
    let mut cards =
        vec![Card::new("Cases", score.whole.cases.to_string(), "with concealed effects, or with none")];
    for (suite, part) in score.suites() {
        let (all, missed) = (part.targets.len(), part.missed_targets.len());
        let tone = if missed == 0 { Tone::Good } else { Tone::Attention };
        let (right, alike) = (part.right_when_named, part.right_or_inseparable);
        let detail = match right.share() {
            Some(_) => format!(
                "right in {} of {} cases in which it names an effect; right, or not distinguishable, in {}",
                right.count, right.total, alike.count
            ),
            None => "no effect was named".into(),
        };
        let label = format!("Targets met: {}", heading(suite).to_lowercase());
        cards.push(Card::new(label, format!("{} of {all}", all - missed.min(all)), detail).toned(tone));
    }
    cards
}

fn heading(suite: &str) -> &'static str {
    match suite {
        "rig" => "Rods at a stiffness rig",
        _ => "Calibrations of arms",
    }
}

fn section(suite: &str, part: &Part) -> Section {
    let mut blocks = vec![Block::Table(targets(suite, part)), Block::Table(rates(suite, part))];
    blocks.extend(conflicts(suite, part).map(Block::Table));
    // without a truth that can be named there is nothing to confuse
    let confused = (!part.confusion.is_empty()).then(|| confusion(suite, part));
    let figures = [confused, bins(suite, part), power(suite, part)];
    blocks.extend(figures.into_iter().flatten().map(Block::Figure));
    blocks.push(match part.failures.is_empty() {
        true => Block::Paragraph("No case needs inspection.".into()),
        false => Block::Table(failures(suite, &part.failures)),
    });
    Section::new(heading(suite), blocks)
}

/// What must be reached, missed targets first.
fn targets(suite: &str, part: &Part) -> Table {
    let row = |reached: &Reached| {
        let mut row = match reached.measured {
            Measured::Rate(rate) => cells(reached.target.what, rate),
            Measured::Number(number) => {
                vec![reached.target.what.into(), String::new(), percent(number), String::new(), String::new()]
            }
        };
        row.push(reached.target.wanted());
        row.push(if reached.missed().is_some() { "missed" } else { "met" }.into());
        row
    };
    Table {
        name: format!("{suite}-targets"),
        caption:
            "Targets with Wilson's 95 % intervals, missed ones first. A share meets its target by itself, \
                  not by its interval."
                .into(),
        columns: [rate_columns(), vec![Column::text("wanted"), Column::text("target")]].concat(),
        rows: part.targets.iter().map(row).collect(),
        ..Table::default()
    }
}

fn rate_columns() -> Vec<Column> {
    vec![
        Column::text("what"),
        Column::text("cases"),
        Column::number("share", "%"),
        Column::number("from", "%"),
        Column::number("to", "%"),
    ]
}

fn percent(share: Option<f64>) -> String {
    share.map_or("–".to_owned(), |share| format!("{:.1}", 100.0 * share))
}

/// A rate in the columns of [`rate_columns`].
fn cells(what: &str, rate: Rate) -> Vec<String> {
    let [lo, hi] = rate.interval().map_or([None; 2], |ends| ends.map(Some));
    let count = format!("{} of {}", rate.count, rate.total);
    vec![what.to_owned(), count, percent(rate.share()), percent(lo), percent(hi)]
}

/// Everything else that is counted.
fn rates(suite: &str, part: &Part) -> Table {
    let Part { clean, single, pairs, unknown, below, mistakes, suspects, .. } = part;
    let rates = [
        ("clean, numbers off by what the file states: silent", clean.silent),
        ("clean, numbers off by twice that: silent", clean.silent_twice),
        ("clean: something named", clean.false_names),
        ("clean: called unexplained", clean.false_unexplained),
        ("one identifiable effect: name right", single.name_ok),
        ("one identifiable effect: name and place right", single.location_ok),
        ("one detectable effect, something named: truth in its class", single.in_class),
        ("one effect below the detection limit: silent", below.silent),
        ("one effect below the detection limit: silent, or truth in its class", below.silent_or_right),
        ("two identifiable effects: both found", pairs.both_found),
        ("unknown physics, identifiable: called unexplained", unknown.called_unknown),
        ("unknown physics, identifiable: wrongly named", unknown.wrongly_named),
        ("mistakes: named", mistakes.named),
        ("mistakes: named, and what they concern", mistakes.placed),
        ("mistakes: taken for something else", mistakes.as_other),
        ("mistakes: silent", mistakes.silent),
        ("no mistake: one named", mistakes.invented),
        ("misread readings: all called suspect", suspects.remarked),
        ("misread readings: something named", suspects.named),
        ("right when it names", part.right_when_named),
        ("right, or not distinguishable, when it names", part.right_or_inseparable),
        ("right, or in its class, when it names", part.class_right_when_named),
        ("95 % intervals that hold the truth", part.coverage.all),
        (
            "ambiguous, truth in its class: settled by the proposed measurement",
            part.next_measurement_ok.settled,
        ),
    ];
    let mut rows: Vec<Vec<String>> =
        rates.iter().filter(|(_, rate)| rate.total > 0).map(|(what, rate)| cells(what, *rate)).collect();
    let predictions = &part.counterfactual;
    let number = |ratio: Option<f64>| ratio.map_or("–".into(), |ratio| format!("{:.0}", 100.0 * ratio));
    if predictions.n > 0 {
        rows.push(vec![
            "error of what was asked, over the oracle's: median, quartiles".into(),
            format!("{} of {}", predictions.answered, predictions.n),
            number(predictions.median),
            number(predictions.quartiles[0]),
            number(predictions.quartiles[1]),
        ]);
    }
    Table {
        name: format!("{suite}-rates"),
        caption: "Rates with Wilson's 95 % intervals.".into(),
        columns: rate_columns(),
        rows,
        ..Table::default()
    }
}

/// Truth against answer: circles as large as the share of their row.
fn confusion(suite: &str, part: &Part) -> Figure {
    let rows = &part.confusion;
    // what is an answer comes first, in the same order along both axes
    let answered: BTreeSet<&Verdict> = rows.values().flat_map(|row| row.keys()).collect();
    let unanswered = rows.keys().filter(|truth| !answered.contains(truth));
    let names: Vec<&Verdict> = answered.iter().copied().chain(unanswered).collect();
    let answers = answered.len();
    let place = |name: &Verdict| names.iter().position(|known| *known == name).map(|k| k as f64 + 1.0);
    let mut chart = Chart::new("", "answer", "truth");
    for (truth, row) in rows {
        let total: f64 = row.values().map(|&count| count as f64).sum();
        for (answer, &count) in row {
            let (Some(x), Some(y)) = (place(answer), place(truth).map(|y| -y)) else { continue };
            let is_right = answer.is_right(truth, |effect| part.outside.contains(effect));
            let colour = if is_right { Colour::Blue } else { Colour::Vermilion };
            let marker = if is_right { Marker::Circle } else { Marker::Square };
            let size = FULL_PX * (count as f64 / total.max(1.0)).sqrt().max(0.2);
            let style = Style::nth(0).colour(colour).marker(marker).size(size);
            let label = if is_right { "right" } else { "another name" };
            chart = chart.with(Mark::Points {
                label: label.into(),
                points: vec![Point { x, y, error: 0.0 }],
                style,
            });
            chart = chart.with(Mark::Note { at: [x, y], text: format!("{count}") });
        }
    }
    let number = |k: usize| k as f64 + 1.0;
    chart.x.range = Range::Fixed(0.4, answers as f64 + 0.6);
    chart.x.names = (0..answers).map(|k| (number(k), spaced(names[k]))).collect();
    chart.x.names_upwards = true;
    chart.y.names = (0..names.len()).map(|k| (-number(k), spaced(names[k]))).collect();
    chart.y.range = Range::Fixed(-(names.len() as f64) - 0.6, -0.4);
    chart.height_px = Some(26.0 * names.len() as f64);
    let truths = rows.len();
    Figure::from(chart).named(format!("{suite}-confusion")).captioned(format!(
        "Confusion matrix: {truths} identifiable truths against the strongest finding. The numbers are \
         cases; a circle or a square is as large as its share of the row. For physics outside the \
         library, unexplained is the right answer."
    ))
}

/// A name as people write it.
fn spaced(name: &impl Display) -> String {
    name.to_string().replace('_', " ")
}

/// What was answered to effects that imitate each other.
fn conflicts(suite: &str, part: &Part) -> Option<Table> {
    let rows = part.conflicts.iter().flat_map(|(pair, counts)| {
        counts.iter().map(move |(truth, answers)| {
            let mut cells: Vec<(&String, &usize)> = answers.iter().collect();
            cells.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
            let cells: Vec<String> =
                cells.iter().map(|(answer, count)| format!("{count} {answer}")).collect();
            let cases: usize = answers.values().sum();
            [pair.clone(), truth.clone(), cases.to_string(), cells.join(", ")]
                .map(|cell| cell.replace('_', " "))
                .to_vec()
        })
    });
    let rows: Vec<Vec<String>> = rows.collect();
    (!rows.is_empty()).then(|| Table {
        name: format!("{suite}-conflicts"),
        caption: "Effects that imitate each other: what was concealed, and what was said. In brackets: the truth, where it is not \
                  the strongest finding but one that is indistinguishable from it."
            .into(),
        columns: vec![
            Column::text("pair"),
            Column::text("concealed"),
            Column::number("cases", ""),
            Column::text("answers"),
        ],
        rows,
        ..Table::default()
    })
}

/// Where a bin is drawn, its share and the interval of that; `None` of an empty bin.
fn point(from: Option<f64>, to: Option<f64>, rate: &Rate) -> Option<[f64; 4]> {
    let from = from.or(to.map(|to| to / OPEN))?;
    let to = to.unwrap_or(from * OPEN);
    let [low, high] = rate.interval()?;
    Some([(from * to).sqrt(), rate.share()?, low, high])
}

fn curve(mut chart: Chart, points: &[[f64; 4]]) -> Chart {
    chart.x.log = true;
    chart.y.range = Range::Fixed(0.0, 1.0);
    let style = Style::nth(2);
    chart
        .with(Mark::Band {
            label: "95 % interval".into(),
            points: points.iter().map(|[x, _, low, high]| [*x, *low, *high]).collect(),
            style,
        })
        .with(Mark::Line {
            label: "share".into(),
            points: points.iter().map(|[x, y, ..]| [*x, *y]).collect(),
            style,
        })
        .with(Mark::Points {
            label: String::new(),
            points: points.iter().map(|[x, y, ..]| Point { x: *x, y: *y, error: 0.0 }).collect(),
            style,
        })
}

fn bins(suite: &str, part: &Part) -> Option<Figure> {
    let points: Vec<[f64; 4]> =
        part.bins.iter().filter_map(|bin| point(bin.from, bin.to, &bin.location_ok_rate)).collect();
    if points.len() < 2 {
        return None;
    }
    let chart = Chart::new("", "expected log Bayes factor of the oracle", "name and place right");
    let chart = curve(chart, &points).with(Mark::Vertical { at: 5.0, text: "identifiable".into() });
    Some(Figure::from(chart).named(format!("{suite}-detectability")).captioned(
        "Cases with one effect: share whose name and place are right, against the evidence that an \
         oracle would have. Points stand in the middle of their bins; bins without an end are drawn as \
         wide as a factor of 3.",
    ))
}

fn power(suite: &str, part: &Part) -> Option<Figure> {
    let mut panels = Vec::new();
    for (effect, bins) in &part.power {
        let points: Vec<[f64; 4]> =
            bins.iter().filter_map(|bin| point(bin.from, bin.to, &bin.name_ok_rate)).collect();
        let mut chart = Chart::new(spaced(effect), "size over noise", "name right");
        chart.x = Axis { range: Range::Fixed(0.02, 100.0), ..chart.x };
        chart.height_px = Some(110.0);
        if !points.is_empty() {
            panels.push(curve(chart, &points));
        }
    }
    (!panels.is_empty()).then(|| {
        Figure::new(panels, 3).with_shared_legend().named(format!("{suite}-power")).captioned(
            "Probability of the right name against the rms change of the readings by the effect, \
                 over their noise. All cases with one effect count, also those that are not \
                 identifiable.",
        )
    })
}

/// "friction at y (force 0.520 N)".
fn with_units(truth: &Concealed) -> String {
    let what = spaced(&format!("{} at {}", truth.effect, truth.location));
    let said = truth.parameters.iter().map(|parameter| {
        let (words, unit) = name_and_unit(&parameter.name);
        format!("{words} {} {unit}", significant(parameter.value, 3)).trim_end().to_owned()
    });
    match said.collect::<Vec<_>>() {
        numbers if numbers.is_empty() => what,
        numbers => format!("{what} ({})", numbers.join(", ")),
    }
}

fn failures(suite: &str, failures: &[Failure]) -> Table {
    let row = |failure: &Failure| {
        let truth: Vec<String> = failure.truth.iter().map(with_units).collect();
        let said = spaced(&failure.said.join("; "));
        vec![failure.case.clone(), failure.what.to_owned(), truth.join("; "), said]
    };
    let left_out = failures.len().saturating_sub(MOST_FAILURES);
    Table {
        name: format!("{suite}-failures"),
        caption: "Cases to inspect.".into(),
        columns: ["case", "what", "truth", "said"].map(Column::text).to_vec(),
        rows: failures.iter().take(MOST_FAILURES).map(row).collect(),
        notes: (left_out > 0).then(|| format!("{left_out} more are in the JSON.")).into_iter().collect(),
        ..Table::default()
    }
}

#[cfg(test)]
mod tests {
    use rodcal_trial::effect_name::EffectName;
    use rodcal_trial::ground_truth::Parameter;

    use super::*;

    #[test]
    fn what_was_concealed_is_said_in_words_with_units() {
        let truth = |effect: EffectName, location: &str, parameters: &[(&str, f64)]| {
            let parameter =
                |&(name, value): &(&str, f64)| Parameter { name: name.into(), value, with_numbers: None };
            let parameters = parameters.iter().map(parameter).collect();
            let concealed = Concealed::mistake(effect, Default::default(), parameters);
            Concealed { location: location.into(), ..concealed }
        };
        for (truth, words) in [
            (
                truth(EffectName::JointCompliance, "station 3", &[("bending_urad_per_nm", 53.52)]),
                "joint compliance at station 3 (bending 53.5 µrad/(N·m))",
            ),
            (
                truth(EffectName::Backlash, "y", &[("lost_um", 2.5), ("ratio", 0.1)]),
                "backlash at y (lost 2.50 µm, ratio 0.100)",
            ),
            (truth(EffectName::CopyMistake, "row 3", &[]), "copy mistake at row 3"),
        ] {
            assert_eq!(with_units(&truth), words);
        }
    }
}
