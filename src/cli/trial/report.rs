//! The report of a trial: targets that are missed, rates, what was taken for what, and how large an effect must be.

use std::collections::BTreeSet;

use serde_json::Value;

use rodcal::report::chart::{Axis, Chart, Colour, Figure, Mark, Marker, Point, Range, Style};
use rodcal::report::table::{Column, Table};
use rodcal::report::{Block, Report, Section};

/// Half the size of a circle that stands for all cases of a row, CSS pixels.
const FULL_PX: f64 = 9.0;
/// Beyond these ends a bin has none: where it is drawn.
const OPEN: f64 = 3.0;
/// Failures that are listed.
const MOST_FAILURES: usize = 200;

/// The report of a score, as [`rodcal_trial::score`] makes it.
pub fn report(score: &Value) -> Report {
    let halves: Vec<(&str, &Value)> =
        ["rig", "calibration"].into_iter().filter_map(|half| Some((half, score.get(half)?))).collect();
    let missed: Vec<String> = halves
        .iter()
        .flat_map(|(half, of)| texts(&of["missed_targets"]).map(move |words| format!("{half}: {words}")))
        .collect();
    let cases = score["cases"].as_u64().unwrap_or(0);
    let headline = match missed.len() {
        0 => format!("{cases} cases with concealed effects: every target is met."),
        n => format!("{cases} cases with concealed effects: {n} targets are missed. {}.", missed.join(". ")),
    };
    Report {
        title: "Concealed-effect trial".into(),
        headline,
        warnings: Vec::new(),
        sections: halves.into_iter().map(|(half, of)| section(half, of)).collect(),
        provenance: vec![("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into())],
    }
}

fn texts(of: &Value) -> impl Iterator<Item = &str> {
    of.as_array().into_iter().flatten().filter_map(Value::as_str)
}

fn section(half: &str, score: &Value) -> Section {
    let heading = match half {
        "rig" => "Rods at a stiffness rig",
        _ => "Calibrations of arms",
    };
    let mut blocks = vec![Block::Table(rates(half, score))];
    blocks.extend(
        [confusion(half, score), bins(half, score), power(half, score)]
            .into_iter()
            .flatten()
            .map(Block::Figure),
    );
    blocks.push(Block::Table(failures(half, score)));
    Section::new(heading, blocks)
}

fn rates(half: &str, score: &Value) -> Table {
    let rows = [
        ("clean: something named", "/clean/false_names_rate", "≤ 2 %"),
        ("clean: called unexplained", "/clean/false_unexplained_rate", ""),
        ("one identifiable effect: name right", "/single/name_ok_rate", ""),
        ("one identifiable effect: name and place right", "/single/location_ok_rate", "≥ 90 %"),
        ("one detectable effect, something named: truth in its class", "/single/in_class_rate", "≥ 95 %"),
        ("two identifiable effects: both found", "/pairs/both_found_rate", "≥ 60 %"),
        ("unknown physics, identifiable: called unexplained", "/unknown/called_unknown_rate", "≥ 90 %"),
        ("unknown physics, identifiable: wrongly named", "/unknown/wrongly_named_rate", "≤ 5 %"),
        ("right when it names", "/right_when_named", "≥ 95 %"),
        ("right, or in its class, when it names", "/class_right_when_named", ""),
        ("95 % intervals that hold the truth", "/coverage_rate", "90 to 98 %"),
        (
            "ambiguous, truth in its class: settled by the proposed measurement",
            "/next_measurement_ok/rate",
            "",
        ),
    ];
    let percent =
        |value: &Value| value.as_f64().map_or("–".into(), |share| format!("{:.1}", 100.0 * share));
    let row = |(what, at, target): (&str, &str, &str)| {
        let rate = score.pointer(at).cloned().unwrap_or_default();
        vec![
            what.to_owned(),
            format!("{} of {}", rate["count"], rate["of"]),
            percent(&rate["share"]),
            percent(&rate["lo"]),
            percent(&rate["hi"]),
            target.to_owned(),
        ]
    };
    let mut rows: Vec<Vec<String>> = rows.into_iter().map(row).collect();
    rows.push(vec![
        "held-out gain over the oracle's".into(),
        String::new(),
        percent(&score["gain_over_oracle"]),
        String::new(),
        String::new(),
        "≥ 90 %".into(),
    ]);
    let of = &score["counterfactual"];
    let number = |value: &Value| value.as_f64().map_or("–".into(), |ratio| format!("{:.0}", 100.0 * ratio));
    if of["n"].as_u64().is_some_and(|n| n > 0) {
        rows.push(vec![
            "error of what was asked, over the oracle's: median, quartiles".into(),
            format!("{} of {}", of["answered"], of["n"]),
            number(&of["median"]),
            number(&of["quartiles"][0]),
            number(&of["quartiles"][1]),
            String::new(),
        ]);
    }
    Table {
        name: format!("{half}-rates"),
        caption: "What was asked and how often it was so, with Wilson's 95 % intervals.".into(),
        columns: vec![
            Column::text("what"),
            Column::text("cases"),
            Column::number("share", "%"),
            Column::number("from", "%"),
            Column::number("to", "%"),
            Column::text("target"),
        ],
        rows,
        notes: Vec::new(),
    }
}

/// Truth against answer: circles as large as the share of their row.
fn confusion(half: &str, score: &Value) -> Option<Figure> {
    let rows = score["confusion"].as_object()?;
    let all: BTreeSet<&str> = rows
        .iter()
        .flat_map(|(truth, row)| {
            row.as_object().into_iter().flatten().map(|(k, _)| k.as_str()).chain([truth.as_str()])
        })
        .collect();
    // what is an answer comes first, in the same order along both axes
    let is_answer = |name: &str| rows.values().any(|row| row.get(name).is_some());
    let mut names: Vec<&str> = all.iter().copied().filter(|name| is_answer(name)).collect();
    let answers = names.len();
    names.extend(all.iter().copied().filter(|name| !is_answer(name)));
    let is_outside =
        |truth: &str| score["outside"].as_array().is_some_and(|all| all.iter().any(|name| name == truth));
    let place = |name: &str| names.iter().position(|known| *known == name).map(|k| k as f64 + 1.0);
    let mut chart = Chart::new("", "answer, by its number", "truth");
    for (truth, row) in rows {
        let row = row.as_object()?;
        let total: f64 = row.values().filter_map(Value::as_f64).sum();
        for (answer, count) in row {
            let count = count.as_f64()?;
            let (x, y) = (place(answer)?, -place(truth)?);
            let is_right = answer == truth || (answer == "unexplained" && is_outside(truth));
            let colour = if is_right { Colour::Blue } else { Colour::Vermilion };
            let marker = if is_right { Marker::Circle } else { Marker::Square };
            let size = FULL_PX * (count / total.max(1.0)).sqrt().max(0.2);
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
    chart.x.names = (0..answers).map(|k| (number(k), (k + 1).to_string())).collect();
    let truths = (0..names.len()).filter(|&k| rows.contains_key(names[k]));
    chart.y.names =
        (0..names.len()).map(|k| (-number(k), format!("{} {}", k + 1, names[k].replace('_', " ")))).collect();
    chart.y.range = Range::Fixed(-(names.len() as f64) - 0.6, -0.4);
    chart.height_px = Some(26.0 * names.len() as f64);
    let of = truths.count();
    Some(Figure::from(chart).named(format!("{half}-confusion")).captioned(format!(
        "What was taken for what: {of} truths that could have been identified, and the strongest finding. The numbers are cases; \
         a circle or a square is as large as its share of the row. To physics outside the library `unexplained` is the right answer."
    )))
}

/// From, to, share, its interval.
fn points<'a>(of: &'a Value, rate: &'a str) -> impl Iterator<Item = [f64; 4]> + 'a {
    of.as_array().into_iter().flatten().filter_map(move |bin| {
        let (from, to) = (bin["from"].as_f64(), bin["to"].as_f64());
        let from = from.or(to.map(|to| to / OPEN))?;
        let to = to.unwrap_or(from * OPEN);
        let number = |key: &str| bin[rate][key].as_f64();
        Some([(from * to).sqrt(), number("share")?, number("lo")?, number("hi")?])
    })
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

fn bins(half: &str, score: &Value) -> Option<Figure> {
    let points: Vec<[f64; 4]> = points(&score["bins"], "location_ok_rate").collect();
    if points.len() < 2 {
        return None;
    }
    let chart = Chart::new("", "expected log Bayes factor of the oracle", "name and place right");
    let chart = curve(chart, &points).with(Mark::Vertical { at: 5.0, text: "identifiable".into() });
    Some(Figure::from(chart).named(format!("{half}-detectability")).captioned(
        "Cases with one effect: share whose name and place are right, against what could have been known at best. Points stand \
         in the middle of their bins; bins without an end are drawn as wide as a factor of 3.",
    ))
}

fn power(half: &str, score: &Value) -> Option<Figure> {
    let mut panels = Vec::new();
    for (effect, of) in score["power"].as_object()? {
        let points: Vec<[f64; 4]> = points(of, "name_ok_rate").collect();
        let mut chart = Chart::new(effect.replace('_', " "), "size over noise", "name right");
        chart.x = Axis { range: Range::Fixed(0.02, 100.0), ..chart.x };
        chart.height_px = Some(110.0);
        if !points.is_empty() {
            panels.push(curve(chart, &points));
        }
    }
    (!panels.is_empty()).then(|| {
        Figure { panels, columns: 3, shared_legend: true, ..Figure::default() }
            .named(format!("{half}-power"))
            .captioned(
                "Probability of the right name against the root mean square of what an effect does to the readings, over their \
                 noise. All cases with one effect count, those that nobody could have identified as well.",
            )
    })
}

fn failures(half: &str, score: &Value) -> Table {
    let of = score["failures"].as_array().map_or(&[][..], Vec::as_slice);
    let joined = |value: &Value| texts(value).collect::<Vec<_>>().join("; ");
    let row = |failure: &Value| {
        vec![
            failure["case"].as_str().unwrap_or_default().to_owned(),
            failure["what"].as_str().unwrap_or_default().to_owned(),
            joined(&failure["truth"]),
            joined(&failure["said"]),
        ]
    };
    let left_out = of.len().saturating_sub(MOST_FAILURES);
    Table {
        name: format!("{half}-failures"),
        caption: "Cases that somebody should look at.".into(),
        columns: ["case", "what", "truth", "said"].map(Column::text).to_vec(),
        rows: of.iter().take(MOST_FAILURES).map(row).collect(),
        notes: (left_out > 0).then(|| format!("{left_out} more are in the JSON.")).into_iter().collect(),
    }
}
