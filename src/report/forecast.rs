//! What a forecast says: its parts as JSON, as a table and stacked.

use serde_json::{Map, Value, json};

use super::chart::{Axis, Bar, Chart, Colour, Dash, Direction, Figure, Mark, Range, Style};
use super::method;
use super::table::{Column, Table};
use super::{Block, Card, Report, Section, proxy};
use crate::calibration::Campaign;
use crate::design::{Budget, Forecast, Part, RodForecast, proxies};
use crate::units::{UM, significant};

/// `mean`, `p95`, `rms`, the interval of the mean and the parts.
pub fn json(forecast: &Forecast) -> Value {
    let parts: Map<String, Value> = Part::ALL
        .into_iter()
        .map(|part| (part.key().to_owned(), json!(forecast.parts[part as usize] / UM)))
        .collect();
    json!({
        "mode": forecast.mode.name(),
        "mean": forecast.mean / UM,
        "p95": forecast.p95 / UM,
        "rms": forecast.rms / UM,
        "mean_interval": forecast.interval.map(|bound| bound / UM),
        "parts": parts,
    })
}

/// The parts that any of these forecasts has.
fn parts(all: &[(String, &Forecast)]) -> Vec<Part> {
    let has = |part: &Part| all.iter().any(|(_, forecast)| forecast.parts[*part as usize] > 1e-9);
    Part::ALL.into_iter().filter(has).collect()
}

/// Forecasts with their names, one per row.
pub fn table(name: &str, first: &str, all: &[(String, &Forecast)]) -> Table {
    let mut columns = vec![Column::text(first)];
    columns.extend(["mean", "95 %", "rms"].map(|name| Column::number(name, "µm")));
    let caption = "Error of the tip at unseen poses. Mean: in brackets the interval that the mean of one campaign lies in with \
                   95 %. 95 %: all but one pose in twenty are better. Then the root mean square.";
    let mut table = Table::new(name, caption, columns);
    for (name, forecast) in all {
        let um = |size: f64| significant(size / UM, 3);
        let [low, high] = forecast.interval;
        table.row([
            name.clone(),
            format!("{} ({} to {})", um(forecast.mean), um(low), um(high)),
            um(forecast.p95),
            um(forecast.rms),
        ]);
    }
    table
}

/// The parts of the same forecasts, one per column: with the whole they would be too wide to read.
pub fn parts_table(name: &str, first: &str, all: &[(String, &Forecast)]) -> Table {
    let mut columns = vec![Column::text(first)];
    columns.extend(parts(all).into_iter().map(|part| Column::number(part.description(), "µm")));
    let caption =
        "Root mean square of each part of the error alone: their squares add up to that of the whole.";
    let mut table = Table::new(name, caption, columns);
    for (name, forecast) in all {
        let um = |part: Part| significant(forecast.parts[part as usize] / UM, 3);
        let cells = parts(all).into_iter().map(um);
        table.row(std::iter::once(name.clone()).chain(cells).collect::<Vec<_>>());
    }
    table
}

/// Parts below this share of the whole are not drawn: a hundredth of its square.
const SEEN: f64 = 0.1;

/// The root mean square of each forecast, divided by what its parts have of the mean square.
pub fn stacked(all: &[(String, &Forecast)]) -> Figure {
    const COLOURS: [(Colour, Dash); 7] = [
        (Colour::Blue, Dash::Solid),
        (Colour::SkyBlue, Dash::Dashed),
        (Colour::Green, Dash::DashDot),
        (Colour::Vermilion, Dash::LongDash),
        (Colour::Orange, Dash::Dashed),
        (Colour::Grey, Dash::Solid),
        (Colour::Purple, Dash::Dotted),
    ];
    let mut chart = Chart::new("", "root mean square error / µm", "");
    let at = |k: usize| -(k as f64);
    chart.y = Axis {
        names: all.iter().enumerate().map(|(k, (name, _))| (at(k), name.clone())).collect(),
        range: Range::Fixed(at(all.len()) + 0.4, 0.6),
        ..Axis::default()
    };
    chart.x.range = Range::AutoWithZero;
    chart.height_px = Some(24.0 * all.len() as f64 + 30.0);
    // what nobody would see is left to the table
    let is_seen = |part: &Part| all.iter().any(|(_, f)| f.parts[*part as usize] > SEEN * f.rms);
    let shown: Vec<Part> = parts(all).into_iter().filter(is_seen).collect();
    // from the top down: what is drawn later stands in front
    for (place, part) in shown.iter().enumerate().rev() {
        let bar = |(k, (_, forecast)): (usize, &(String, &Forecast))| {
            let below: f64 = shown[..=place].iter().map(|part| forecast.parts[*part as usize].powi(2)).sum();
            let is_whole = place + 1 == shown.len();
            Bar {
                from: at(k) - 0.3,
                to: at(k) + 0.3,
                value: if forecast.rms > 0.0 { below / forecast.rms / UM } else { 0.0 },
                text: if is_whole { significant(forecast.rms / UM, 3) } else { String::new() },
                ..Bar::default()
            }
        };
        let (colour, dash) = COLOURS[*part as usize];
        chart.marks.push(Mark::Bars {
            label: part.description().into(),
            bars: all.iter().enumerate().map(bar).collect(),
            direction: Direction::Right,
            style: Style::nth(0).colour(colour).dash(dash),
        });
    }
    Figure::from(chart).named("error-budget").captioned(
        "Root mean square of the tip's error at unseen poses. Each part is as long as its share of the mean square.",
    )
}

/// The JSON of `rodcal compare --forecast --json`.
pub fn comparison_json(campaign: &Campaign, rods: &[RodForecast], basis: &Basis) -> Value {
    let all: Vec<Value> = rods
        .iter()
        .map(|rod| {
            json!({
                "rod": rod.rod,
                "c_rod_um": (!rod.rod.is_empty()).then_some(rod.c_rod / UM),
                "poses": rod.poses,
                "recorded_poses": rod.is_recorded,
                "rig_assumed": rod.is_rig_assumed,
                "modes": rod.modes.iter().map(json).collect::<Vec<_>>(),
            })
        })
        .collect();
    let best = best(rods).map(|(rod, forecast)| json!({ "rod": rod.rod, "mode": forecast.mode.name() }));
    json!({
        "campaign": campaign.file,
        "noise_um": basis.budget.noise / UM,
        "repeatability_um": basis.budget.repeatability / UM,
        "clamp_um": basis.budget.clamps / UM,
        "instrument_um": basis.budget.instrument / UM,
        "unseen": basis.unseen,
        "forecasts": all,
        "best": best,
        "c_rod_as_proxy": proxy::json(&proxies(&by_c_rod(rods))),
    })
}

fn by_c_rod(rods: &[RodForecast]) -> Vec<(f64, &[Forecast])> {
    rods.iter().map(|rod| (rod.c_rod, rod.modes.as_slice())).collect()
}

/// What forecasts of several rods stand on.
#[derive(Debug, Clone)]
pub struct Basis {
    /// What is wrong, and by how much.
    pub budget: Budget,
    /// Where the robot will be used, in words.
    pub unseen: String,
    /// Whether base and tool are aligned anew there.
    pub is_aligned: bool,
    /// False where no clamp holds the ball: then none can be wrong.
    pub has_clamps: bool,
}

impl Basis {
    /// In sentences.
    pub fn description(&self) -> String {
        let aligned = if self.is_aligned { "; base and tool are aligned anew there" } else { "" };
        let um = |size: f64| significant(size / UM, 3);
        let clamps = match self.budget.clamps > 0.0 {
            _ if !self.has_clamps => String::new(),
            true => format!(", clamp places known to {} µm", um(self.budget.clamps)),
            false => ", clamp places known exactly (if they are not, the section [noise] of the campaign file can say how well)".to_owned(),
        };
        let instrument = match self.budget.instrument > 0.0 {
            true => format!(", an instrument that is wrong by {} µm", um(self.budget.instrument)),
            false => ", without the scatter of an instrument that measures the error there".to_owned(),
        };
        format!(
            "At {}{aligned}. {}; repeatability {} µm{clamps}{instrument}. Errors that no parameter of the calibration has \
             (gears, play, warmth) are not in the forecast: diagnose finds them in a recording.",
            self.unseen,
            self.budget.noise_source,
            um(self.budget.repeatability)
        )
    }
}

/// The smallest mean; of equal ones the first.
fn best(rods: &[RodForecast]) -> Option<(&RodForecast, &Forecast)> {
    let all = rods.iter().flat_map(|rod| rod.modes.iter().map(move |forecast| (rod, forecast)));
    all.min_by(|a, b| a.1.mean.total_cmp(&b.1.mean))
}

fn named_rod(rod: &RodForecast) -> String {
    if rod.rod.is_empty() { "no rod".into() } else { format!("rod {}", rod.rod) }
}

/// Means that differ by less than this share are as good as equal: a campaign's chance is larger.
const EQUAL: f64 = 0.05;

/// The best of all, and what it is wrong by most.
fn cards(rods: &[RodForecast]) -> Vec<Card> {
    let Some((rod, least)) = best(rods) else { return Vec::new() };
    let um = |size: f64| format!("{} µm", significant(size / UM, 3));
    let [low, high] = least.interval;
    let largest =
        Part::ALL.into_iter().max_by(|a, b| least.parts[*a as usize].total_cmp(&least.parts[*b as usize]));
    let with = format!("{}, mode {}", named_rod(rod), least.mode.name());
    let mut cards = vec![
        Card::new(
            "Mean error, smallest of all",
            um(least.mean),
            format!("95 % interval {} to {}; {with}", um(low), um(high)),
        ),
        Card::new("95 % of unseen poses are better than", um(least.p95), with),
    ];
    cards.extend(
        largest.map(|part| Card::new("Largest part", um(least.parts[part as usize]), part.description())),
    );
    cards
}

/// The report of `rodcal compare --forecast`.
pub fn comparison(campaign: &Campaign, rods: &[RodForecast], basis: &Basis) -> Report {
    let all: Vec<(String, &Forecast)> = rods
        .iter()
        .flat_map(|rod| {
            rod.modes.iter().map(move |forecast| {
                (format!("{} {}", rod.rod, forecast.mode.name()).trim().to_owned(), forecast)
            })
        })
        .collect();
    let um = |size: f64| significant(size / UM, 3);
    let mut headline = String::new();
    if let Some((rod, least)) = best(rods) {
        let is_equal = |other: &Forecast| other.mean <= least.mean * (1.0 + EQUAL);
        let named = |is_asked: &dyn Fn(&Forecast) -> bool| -> Vec<String> {
            let asked = all.iter().filter(|(_, other)| is_asked(other) && !std::ptr::eq(*other, least));
            asked.map(|(name, other)| format!("{name} ({} µm)", um(other.mean))).collect()
        };
        let (equal, worse) = (named(&|other| is_equal(other)), named(&|other| !is_equal(other)));
        let name = format!("{} in mode {}", named_rod(rod), least.mode.name());
        let size = format!(
            "{} µm in the mean, less than {} µm at 95 % of unseen poses",
            um(least.mean),
            um(least.p95)
        );
        headline = match (equal.len(), worse.len()) {
            (0, 0) => format!("Forecast: with {name} the error is {size}."),
            (_, 0) => {
                format!(
                    "Forecast: no rod or mode is better than another by 5 %. With {name} the error is {size}."
                )
            }
            (0, _) => format!("Forecast: {name} leaves the smallest error, {size}."),
            (a, b) if a > b => format!(
                "Forecast: with {name}, as with all others within 5 % but {}, the error is {size}.",
                worse.join(", ")
            ),
            _ => format!(
                "Forecast: {name} leaves the smallest error, {size}. As good within 5 %: {}.",
                equal.join(", ")
            ),
        };
    }
    let poses: Vec<String> = rods
        .iter()
        .map(|rod| {
            let how = if rod.is_recorded { "as recorded" } else { "chosen by O1" };
            format!("{}: {} {how}", named_rod(rod), rod.poses)
        })
        .collect();
    let mut blocks = vec![
        Block::Paragraph(basis.description()),
        Block::Paragraph(format!("Poses: {}.", poses.join("; "))),
        Block::Figure(stacked(&all)),
        Block::Table(table("forecast", "rod and mode", &all)),
        Block::Table(parts_table("forecast-parts", "rod and mode", &all)),
    ];
    let proxies = proxy::sentences(&proxies(&by_c_rod(rods)));
    if !proxies.is_empty() {
        blocks.push(Block::Paragraph("Would c_rod have ranked these rods as their errors do?".into()));
        blocks.push(Block::List(proxies));
    }
    let assumed: Vec<&str> =
        rods.iter().filter(|rod| rod.is_rig_assumed).map(|rod| rod.rod.as_str()).collect();
    if !assumed.is_empty() {
        blocks.push(Block::Paragraph(format!(
            "No rig readings of rod {}: mode meas assumes that they will give r_rod to 1 %; the other modes are judged by the \
             standard uncertainties of the rod file. A rod that is softer than its drawing for other reasons is worse in the \
             modes calc and fea than this forecast says.",
            assumed.join(", ")
        )));
    }
    Report {
        title: format!("Forecast for {}", campaign.robot.name),
        headline,
        warnings: Vec::new(),
        sections: vec![Section::new("What to expect", blocks)],
        cards: cards(rods),
        method: method::paragraphs(method::FORECAST),
        ..Report::default()
    }
}
