//! Designs for one robot: JSON, and a table by the accuracy that it will have.

use serde_json::{Map, Value, json};

use crate::calibration::Mode;
use crate::design::ForRobot;
use crate::report::table::{Column, Table};
use crate::report::{Block, Section, forecast};
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
    let proxies = found.proxies.iter().map(|proxy| {
        json!({
            "mode": proxy.mode.name(),
            "spearman": proxy.r,
            "interval": proxy.interval,
            "rms_um": proxy.rms.map(|rms| rms / UM),
        })
    });
    json!({ "ranked": ranked.collect::<Vec<_>>(), "c_rod_as_proxy": proxies.collect::<Vec<_>>() })
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
    let mut blocks = Vec::new();
    let proxies = found.proxies.iter().map(|proxy| {
        let [low, high] = proxy.rms;
        let what = match (high <= low * EQUAL, proxy.interval) {
            (true, _) => "no rod is better than another by 5 %, so that c_rod need not be looked at",
            (_, [from, _]) if from > 0.5 => "c_rod is a good proxy",
            (_, [_, to]) if to < 0.5 => "c_rod is no proxy",
            _ => "these rods do not tell whether c_rod is a proxy",
        };
        format!(
            "Mode {}: {what}. Error {} to {} µm; it follows c_rod with a rank correlation of {:.2} ({:.2} to {:.2}).",
            proxy.mode.name(),
            um(low),
            um(high),
            proxy.r,
            proxy.interval[0],
            proxy.interval[1]
        )
    });
    let proxies: Vec<String> = proxies.collect();
    if !proxies.is_empty() {
        blocks.push(Block::List(proxies));
    }
    blocks.push(Block::Table(table));
    Section::new("For this robot", blocks)
}

/// Errors up to so many times the least are as good as that.
const EQUAL: f64 = 1.05;
