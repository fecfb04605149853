//! What the scatter of the poses is made of.

use serde_json::{Value, json};

use crate::diagnosis::calibration::{ScatterSource, ScatterSources, Source};
use crate::report::diagnosis::headline::um;
use crate::report::diagnosis::subject::Uneven;
use crate::units::{DEG, UM, significant};

/// As a sentence and as JSON.
pub fn uneven(scatter: &ScatterSources) -> Uneven {
    let parts: Vec<String> = scatter.sources.iter().map(words).collect();
    Uneven {
        key: "sources",
        words: format!(
            "The scatter is made of {}, and of {} µm along every axis; the poses count by it.",
            parts.join(", "),
            um(scatter.own)
        ),
        all: scatter.sources.iter().map(source).chain([everything_else(scatter)]).collect(),
    }
}

/// For example `99 µrad of the angle of joint 2 (84 % of its square)`.
fn words(own: &ScatterSource) -> String {
    let [urad, um] = [own.size, own.size].map(|size| significant(size / UM, 2));
    let what = match own.source {
        Source::Written => {
            format!("steps of up to {}° that the angles are written in", significant(own.size / DEG, 2))
        }
        Source::Joints => format!("{urad} µrad of the angle of each joint"),
        Source::Angle(joint) => format!("{urad} µrad of the angle of joint {}", joint + 1),
        Source::Way(joint) => format!("{um} µm of the way of joint {}", joint + 1),
        Source::Device(axis) => format!("{um} µm along {axis} of the device"),
        Source::Range => format!("{um} µm along the line of sight from the origin of {{W}}"),
        Source::Sight => {
            format!("{urad} µrad of the direction in which the ball is seen from the origin of {{W}}")
        }
    };
    format!("{what} ({} % of its square)", significant(100.0 * own.share, 2))
}

fn source(own: &ScatterSource) -> Value {
    let (name, key, size) = match own.source {
        Source::Written => ("written angles".to_owned(), "step_deg", own.size / DEG),
        Source::Joints => ("all joints".to_owned(), "sd_urad", own.size / UM),
        Source::Angle(joint) => (format!("joint {}", joint + 1), "sd_urad", own.size / UM),
        Source::Way(joint) => (format!("joint {}", joint + 1), "sd_um", own.size / UM),
        Source::Device(axis) => (format!("device, {axis}"), "sd_um", own.size / UM),
        Source::Range => ("line of sight".to_owned(), "sd_um", own.size / UM),
        Source::Sight => ("direction of sight".to_owned(), "sd_urad", own.size / UM),
    };
    json!({ "source": name, key: size, "share": own.share })
}

fn everything_else(scatter: &ScatterSources) -> Value {
    let share: f64 = scatter.sources.iter().map(|own| own.share).sum();
    json!({ "source": "every axis", "sd_um": scatter.own / UM, "share": 1.0 - share })
}
