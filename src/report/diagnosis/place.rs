//! A place as JSON, so that nobody has to read its text back.

use serde_json::{Value, json};

use crate::inference::{Location, RunName};
use crate::units::MM;

/// The keys say what they are; joints, rows and poses are counted from 1.
pub fn place(location: &Location) -> Value {
    match location {
        Location::Part(part) => json!({ "part": part.to_string() }),
        Location::UnderLoads { part, axis } => {
            json!({ "part": part.to_string(), "loads_along": axis.to_string() })
        }
        Location::InSession { part, session } => {
            json!({ "part": part.to_string(), "session": session })
        }
        Location::Form { part, form } => json!({ "part": part.to_string(), "form": form }),
        Location::Named(name) => json!({ "name": name }),
        Location::Key(key) => json!({
            "key": key.to_string(),
            "names": key.names,
            "rows": key.rows,
        }),
        Location::Station(station) => json!({ "station_mm": station / MM }),
        Location::Channel { channel, form } => {
            json!({ "channel": format!("d{channel}"), "form": form })
        }
        Location::SensorTurn { from, towards } => {
            json!({ "channel": format!("d{from}"), "towards": format!("d{towards}") })
        }
        Location::LoadTurn { from, towards } => {
            json!({ "loads_along": from.to_string(), "towards": towards.to_string() })
        }
        Location::LoadFrame { axes: [a, b], about } => json!({
            "loads_along": [a.to_string(), b.to_string()],
            "about": about.to_string(),
        }),
        Location::AfterRow { run, row, channel, for_good } => {
            let (trial, number) = match &run.name {
                Some(RunName::Trial(name)) => (Some(name), None),
                Some(RunName::Number(number)) => (None, Some(number)),
                None => (None, None),
            };
            json!({
                "loads_along": run.axis.to_string(),
                "trial": trial,
                "run": number,
                "after_row": row,
                "channel": channel.map(|channel| format!("d{channel}")),
                "for_good": for_good,
            })
        }
        Location::Reading { row, channel } => {
            json!({ "row": row, "channel": format!("d{channel}") })
        }
        Location::Joint { joint, form } => json!({ "joint": joint + 1, "form": form }),
        Location::AllJoints => json!({ "joint": "all" }),
        Location::Coupling { from, to } => json!({ "joint": to + 1, "driven_by": from + 1 }),
        Location::AllClamps => json!({ "name": "all clamps" }),
        Location::Shift { what, row, after } => {
            json!({ "name": what, "after_row": row + 1, "after": after })
        }
        Location::JointAfter { joint, row, after } => {
            json!({ "joint": joint + 1, "after_row": row + 1, "after": after })
        }
        Location::Pose { row, name } => json!({ "row": row + 1, "pose": name }),
        Location::Several(all) => json!({ "all": all.iter().map(place).collect::<Vec<_>>() }),
        Location::Curve { label, along, .. } => {
            json!({ "curve": label, "along": along.map(|along| along.to_string()) })
        }
    }
}
