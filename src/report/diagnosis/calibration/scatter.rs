//! What the scatter of the poses is made of.

use serde_json::{Value, json};

use crate::diagnosis::calibration::{ScatterSource, ScatterSources, Source};
use crate::report::diagnosis::headline::um;
use crate::report::diagnosis::subject::Uneven;
use crate::report::table::{Column, Table};
use crate::units::{DEG, UM, significant};

/// As a sentence, as JSON and as a table; of poses that were repeated, or not.
pub fn uneven(scatter: &ScatterSources, is_repeated: bool) -> Uneven {
    let all: Vec<Said> = scatter.sources.iter().map(said).collect();
    let parts: Vec<String> = all.iter().map(Said::words).collect();
    let rest = Said {
        share: 1.0 - scatter.sources.iter().map(|own| own.share).sum::<f64>(),
        ..of_every_axis(scatter)
    };
    let sources: Vec<Said> = all.into_iter().chain([rest]).collect();
    let is_of_joint =
        |own: &ScatterSource| matches!(own.source, Source::Joints | Source::Angle(_) | Source::Position(_));
    let open = match scatter.sources.iter().any(is_of_joint) && !is_repeated {
        true => {
            " An error of the joints that no curve describes would look the same: record some poses twice to \
             distinguish the two."
        }
        false => "",
    };
    Uneven {
        key: "sources",
        words: format!(
            "The scatter comes from {}, and from all axes alike ({} µm); each pose is weighted accordingly.{open}",
            parts.join(", "),
            um(scatter.own)
        ),
        all: sources.iter().map(Said::json).collect(),
        table: Some(table(&sources)),
    }
}

/// A source in words.
struct Said {
    /// As in the JSON and in the table.
    name: String,
    /// As in a sentence.
    source: String,
    /// Size in a unit, and the key of it.
    size: f64,
    unit: &'static str,
    key: &'static str,
    share: f64,
}

impl Said {
    /// For example `the angle of joint 2 (99 µrad, 84 % of the variance)`.
    fn words(&self) -> String {
        let size = match self.key {
            STEP => format!("up to {}°", short(self.size)),
            _ => format!("{} {}", significant(self.size, 2), self.unit),
        };
        format!("{} ({size}, {} % of the variance)", self.source, significant(100.0 * self.share, 2))
    }

    fn json(&self) -> Value {
        json!({ "source": self.name, self.key: self.size, "share": self.share })
    }
}

/// Key of the step of angles that are written in steps.
const STEP: &str = "step_deg";

fn said(own: &ScatterSource) -> Said {
    let angle = |name: String, source: String| (name, source, own.size / UM, "µrad", "sd_urad");
    let length = |name: String, source: String| (name, source, own.size / UM, "µm", "sd_um");
    let (name, source, size, unit, key) = match own.source {
        Source::Written => (
            "written angles".into(),
            "the steps that the angles are written in".into(),
            own.size / DEG,
            "°",
            STEP,
        ),
        Source::Joints => angle("all joints".into(), "the angles of all joints".into()),
        Source::Angle(joint) => {
            angle(format!("joint {}", joint + 1), format!("the angle of joint {}", joint + 1))
        }
        Source::Position(joint) => {
            length(format!("joint {}", joint + 1), format!("the position of joint {}", joint + 1))
        }
        Source::Device(axis) => length(format!("device, {axis}"), format!("the device along {axis}")),
        Source::Distance => {
            length("distance".into(), "the distance that the device in the origin of {W} shows".into())
        }
        Source::Direction => {
            angle("direction".into(), "the direction that the device in the origin of {W} shows".into())
        }
    };
    Said { name, source, size, unit, key, share: own.share }
}

fn of_every_axis(scatter: &ScatterSources) -> Said {
    let (name, source) = ("every axis".into(), "all axes alike".into());
    Said { name, source, size: scatter.own / UM, unit: "µm", key: "sd_um", share: 1.0 }
}

fn table(sources: &[Said]) -> Table {
    let columns = vec![
        Column::text("source of scatter"),
        Column::number("standard deviation, or step", ""),
        Column::text("unit"),
        Column::number("share of the variance", "%"),
    ];
    let caption = "What the scatter of the poses is made of, by the likeliest covariance.";
    let mut table = Table::new("scatter", caption, columns);
    for own in sources {
        let size = if own.key == STEP { short(own.size) } else { significant(own.size, 2) };
        table.row([own.name.clone(), size, own.unit.to_owned(), significant(100.0 * own.share, 2)]);
    }
    table
}

/// With two digits, without zeros behind the point.
fn short(number: f64) -> String {
    let digits = significant(number, 2);
    match digits.contains('.') {
        true => digits.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => digits,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::Axis;

    #[test]
    fn every_source_has_its_words() {
        let source = |source, size, share| ScatterSource { source, size, share };
        let all = ScatterSources {
            own: 20e-6,
            sources: vec![
                source(Source::Written, 0.05 * DEG, 0.3),
                source(Source::Joints, 40e-6, 0.2),
                source(Source::Angle(1), 99.4e-6, 0.1),
                source(Source::Position(2), 31e-6, 0.1),
                source(Source::Device(Axis::Z), 91e-6, 0.05),
                source(Source::Distance, 90e-6, 0.05),
                source(Source::Direction, 12e-6, 0.05),
            ],
        };
        let end = "(20 µm); each pose is weighted accordingly.";
        let doubt = " An error of the joints that no curve describes would look the same: record some poses twice to distinguish the two.";
        assert!(uneven(&all, false).words.ends_with(&format!("{end}{doubt}")));
        let said = uneven(&all, true);
        assert_eq!(
            said.words,
            "The scatter comes from the steps that the angles are written in (up to 0.05°, 30 % of the variance), \
             the angles of all joints (40 µrad, 20 % of the variance), the angle of joint 2 (99 µrad, 10 % of the \
             variance), the position of joint 3 (31 µm, 10 % of the variance), the device along z (91 µm, 5.0 % of \
             the variance), the distance that the device in the origin of {W} shows (90 µm, 5.0 % of the variance), \
             the direction that the device in the origin of {W} shows (12 µrad, 5.0 % of the variance), and from \
             all axes alike (20 µm); each pose is weighted accordingly."
        );
        let first = &said.all[0];
        assert!(first["source"] == "written angles" && first["share"] == 0.3, "{first}");
        assert!((first["step_deg"].as_f64().unwrap() - 0.05).abs() < 1e-12, "{first}");
        let last = &said.all[7];
        assert!(last["source"] == "every axis" && (last["share"].as_f64().unwrap() - 0.15).abs() < 1e-9);
        assert_eq!(said.table.unwrap().rows.len(), 8);
    }
}
