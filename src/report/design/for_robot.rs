//! Designs for one robot: JSON, and a table by the accuracy that it will have.

use serde_json::{Map, Value, json};

use crate::calibration::Mode;
use crate::design::{ForRobot, Forecast, Proxy, Ranked};
use crate::report::chart::{Chart, Figure, Mark, Marker, Point, Style};
use crate::report::table::{Column, Table};
use crate::report::{Block, Card, Section, Tone, forecast, proxy};
use crate::units::{UM, significant};

/// What the JSON has of the designs for one robot.
pub fn for_robot_json(found: &ForRobot) -> Value {
    let ranked = found.ranked.iter().map(|one| {
        let mut object = Map::new();
        object.insert("rod".into(), one.name.clone().into());
        object.insert("c_rod_um".into(), (one.c_rod / UM).into());
        match &one.forecast {
            Ok(of_rod) => {
                object.insert("poses".into(), of_rod.poses.into());
                let modes = of_rod.modes.iter().map(forecast::json).collect::<Vec<_>>();
                object.insert("modes".into(), modes.into());
            }
            Err(words) => _ = object.insert("refused".into(), words.clone().into()),
        }
        Value::Object(object)
    });
    let [designs, front] = found.of_front;
    json!({ "designs_ranked": designs, "front": front, "ranked": ranked.collect::<Vec<_>>(), "c_rod_as_proxy": proxy::json(&found.proxies) })
}

/// Designs by the accuracy that the robot will have.
pub fn for_robot_section(found: &ForRobot) -> Section {
    let um = |size: f64| significant(size / UM, 3);
    let heads = vec![
        Column::text("rod"),
        Column::number("c_rod", "µm"),
        Column::number("none", "µm"),
        Column::number("fea", "µm"),
        Column::number("meas", "µm"),
        Column::text("cannot be measured"),
    ];
    let caption = "Root mean square of the tip's error at unseen poses after calibration with each rod, by mode, best in mode fea \
                   first; poses chosen by O1 for each rod.";
    let mut table = Table::new("for-robot", caption, heads);
    for one in &found.ranked {
        let of_mode = |mode: Mode| one.of(mode).map_or("–".to_owned(), |forecast| um(forecast.rms));
        let mut cells = vec![one.name.clone(), um(one.c_rod)];
        cells.extend([Mode::None, Mode::Fea, Mode::Meas].map(of_mode));
        cells.push(one.forecast.as_ref().err().cloned().unwrap_or_default());
        table.row(cells);
    }
    let mut blocks = vec![Block::Paragraph(
        "Only designs of this front were ranked. It is that of the objectives of the design file, none of which is this \
         robot's error: a rod that is not on it may be better for this robot."
            .into(),
    )];
    let proxies = proxy::sentences(&found.proxies);
    if !proxies.is_empty() {
        blocks.push(Block::List(proxies));
    }
    blocks.extend(picture(found).map(Block::Figure));
    blocks.push(Block::Table(table));
    Section::new("For this robot", blocks)
}

/// The first rod of the table, the mode that it is first in, what is to be expected, and how many
/// other rods cannot be distinguished from it.
fn best(found: &ForRobot) -> Option<(&str, &Forecast, usize)> {
    let first = found.ranked.first()?;
    let least = first.of(Mode::Fea).or_else(|| first.of(Mode::None))?;
    let as_good = |one: &&Ranked| one.of(least.mode).is_some_and(|other| other.is_as_good_as(least));
    Some((&first.name, least, found.ranked[1..].iter().filter(as_good).count()))
}

/// What is to be expected of the robot, for the headline: nothing where no rod can be measured.
pub fn for_robot_headline(found: &ForRobot) -> String {
    let Some((name, least, as_good)) = best(found) else {
        return String::new();
    };
    let um = |size: f64| significant(size / UM, 3);
    let [ranked, front] = found.of_front;
    let designs = match ranked == front {
        true => format!("the {front} designs of the front"),
        false => format!("{ranked} designs of a front of {front}"),
    };
    let designs = if front == 1 { "the one design of the front".to_owned() } else { designs };
    let as_good = match as_good {
        0 => String::new(),
        1 => ", one other as good as far as the forecast can tell".to_owned(),
        n => format!(", {n} others as good as far as the forecast can tell"),
    };
    let best = format!(
        "Of {designs}, {name} leaves this robot the smallest error in mode {}: {} µm rms{as_good}",
        least.mode.name(),
        um(least.rms),
    );
    let (alike, apart): (Vec<&Proxy>, Vec<&Proxy>) =
        found.proxies.iter().partition(|proxy| proxy::is_alike(proxy));
    let apart = apart.iter().map(|proxy| {
        let [low, high] = proxy.rms;
        format!("; in mode {} it depends on the rod: {} to {} µm", proxy.mode.name(), um(low), um(high))
    });
    let names: Vec<&str> = alike.iter().map(|proxy| proxy.mode.name()).collect();
    let alike = match names.len() {
        0 => String::new(),
        1 => format!(". In mode {} no rod is better than another by 5 %", names[0]),
        _ => format!(". In modes {} no rod is better than another by 5 %", names.join(" and ")),
    };
    format!("{best}{}{alike}.", apart.collect::<String>())
}

/// The least error as a card.
pub fn for_robot_card(found: &ForRobot) -> Option<Card> {
    let (name, least, _) = best(found)?;
    let detail = format!("{name}, mode {}", least.mode.name());
    let refused = found.ranked.iter().filter(|one| one.forecast.is_err()).count();
    let card =
        Card::new("Least error of this robot, rms", format!("{} µm", significant(least.rms / UM, 3)), detail);
    Some(if refused > 0 { card.toned(Tone::Attention) } else { card })
}

/// Error against c_rod, a mark for each mode.
fn picture(found: &ForRobot) -> Option<Figure> {
    // from the largest mark to the smallest, so that each is seen beside those that lie on it
    const MARKERS: [(Marker, f64); 4] =
        [(Marker::Circle, 7.0), (Marker::Square, 4.5), (Marker::Triangle, 4.5), (Marker::Plus, 3.5)];
    let mut chart = Chart::new("", "c_rod / µm", "root mean square error / µm");
    let indices = || found.ranked.iter().map(|one| one.c_rod);
    let (low, high) = indices().fold((f64::INFINITY, 0.0f64), |(a, b), c| (a.min(c), b.max(c)));
    if low > 0.0 && high > 20.0 * low {
        chart.x = chart.x.log();
    }
    for (mode, (marker, size)) in Mode::ALL.into_iter().zip(MARKERS) {
        let at = |rms: f64, c_rod: f64| Point { x: c_rod / UM, y: rms / UM, error: 0.0 };
        let points = found.ranked.iter().filter_map(|one| Some(at(one.of(mode)?.rms, one.c_rod)));
        let points: Vec<Point> = points.collect();
        if !points.is_empty() {
            let label = format!("mode {}", mode.name());
            chart = chart.with(Mark::Points {
                label,
                points,
                style: Style::nth(mode as usize).marker(marker).size(size),
            });
        }
    }
    let caption = "What is to be expected of the robot with each rod, against how compliant the rod is. Where modes are as good, \
                   their marks lie on one another.";
    (!chart.marks.is_empty()).then(|| Figure::from(chart).named("for-robot").captioned(caption))
}
