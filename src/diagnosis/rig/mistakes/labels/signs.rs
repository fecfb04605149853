//! Channels and loads with the wrong sign.

use super::in_file::{ALL, Labels, UNUSUAL, mask, relabelled};
use crate::diagnosis::rig::effects::mistakes::SIGN_MISTAKE;
use crate::diagnosis::rig::mistakes::possible::PossibleMistake;
use crate::diagnosis::rig::mistakes::relabelling::Relabelling;
use crate::diagnosis::rig::recording::columns::{axis_rows, column};
use crate::inference::Key;

pub(super) fn signs(labels: &Labels) -> Vec<PossibleMistake> {
    let mut found = Vec::new();
    let mut add = |location: Key, observed, looks_like, relabelling, log_prior| {
        found.push(relabelled(&SIGN_MISTAKE, location, observed, looks_like, relabelling, log_prior));
    };
    for &channel in &labels.channels {
        let name = column(channel);
        add(
            Key::new(&name),
            format!("{name} has the wrong sign: multiply it by −1"),
            format!("{name} looks as if its sign were wrong"),
            Relabelling::reading(ALL, mask(&[channel]), -1.0),
            0.0,
        );
    }
    for &axis in &labels.axes {
        add(
            Key::new(axis_rows(axis)),
            format!(
                "Loads along {axis} pull the other way: write -{axis} for {axis}, and {axis} for -{axis}, in the column axis"
            ),
            format!("loads along {axis} look as if they pulled the other way"),
            Relabelling::load(mask(&[axis]), -1.0),
            -0.3,
        );
        if labels.has_cross && labels.channels.contains(&axis) {
            let both = Relabelling {
                load: Relabelling::load(mask(&[axis]), -1.0).load,
                ..Relabelling::reading(ALL, mask(&[axis]), -1.0)
            };
            let name = column(axis);
            add(
                Key::new(format!("{} and {name}", axis_rows(axis))),
                format!(
                    "The {axis} axis of the rig points the other way than the rod's: change the sign of {name}, and of {axis} in the column axis"
                ),
                format!("the {axis} axis looks as if it pointed the other way"),
                both,
                UNUSUAL,
            );
        }
    }
    if labels.channels.len() > 1 {
        let names = labels.all_channels();
        add(
            Key::new(&names),
            format!(
                "All readings have the wrong sign: multiply {names} by −1 (or turn every direction in the column axis round)"
            ),
            "all readings look as if their sign were wrong".into(),
            Relabelling::reading(ALL, ALL, -1.0),
            0.0,
        );
    }
    found
}
