//! Columns and axes whose names are exchanged.

use super::in_file::{Labels, UNUSUAL, relabelled};
use crate::diagnosis::rig::effects::mistakes::SWAP_MISTAKE;
use crate::diagnosis::rig::mistakes::possible::PossibleMistake;
use crate::diagnosis::rig::mistakes::relabelling::Relabelling;
use crate::diagnosis::rig::recording::columns::column;
use crate::inference::Key;
use crate::spatial::Axis;

pub(super) fn swaps(labels: &Labels) -> Vec<PossibleMistake> {
    let [x, y, z] = Axis::ALL;
    let mut found = Vec::new();
    for (a, b) in [(x, y), (y, z), (x, z)] {
        let mut swapped = [0, 1, 2];
        swapped.swap(a.index(), b.index());
        let is_channel = |axis: Axis| labels.channels.contains(&axis);
        let is_axis = |axis: Axis| labels.axes.contains(&axis);
        let mut add = |location: String, observed, looks_like, relabelling, log_prior| {
            let location = Key::new(location);
            found.push(relabelled(&SWAP_MISTAKE, location, observed, looks_like, relabelling, log_prior));
        };
        let (first, second) = (column(a), column(b));
        if is_channel(a) || is_channel(b) {
            let observed = match (is_channel(a), is_channel(b)) {
                (true, true) => format!("The columns {first} and {second} are swapped: exchange their names"),
                (true, false) => format!("The column {first} holds {second}: name it {second}"),
                _ => format!("The column {second} holds {first}: name it {first}"),
            };
            let relabelling = Relabelling { channel: swapped, ..Relabelling::default() };
            let looks_like = format!("{first} and {second} look swapped");
            add(format!("{first} and {second}"), observed, looks_like, relabelling, 0.0);
        }
        if is_axis(a) || is_axis(b) {
            let observed = match (is_axis(a), is_axis(b)) {
                (true, true) => {
                    format!(
                        "Loads along {a} and {b} are swapped: write {b} for {a}, and {a} for {b}, in the column axis"
                    )
                }
                (true, false) => {
                    format!("The loads along {a} act along {b}: write {b} for {a} in the column axis")
                }
                _ => format!("The loads along {b} act along {a}: write {a} for {b} in the column axis"),
            };
            let relabelling = Relabelling { axis: swapped, ..Relabelling::default() };
            let looks_like = format!("loads along {a} and {b} look swapped");
            add(format!("axis {a} and {b}"), observed, looks_like, relabelling, -0.3);
        }
        if (is_channel(a) || is_channel(b)) && (is_axis(a) || is_axis(b)) {
            let relabelling = Relabelling { axis: swapped, channel: swapped, ..Relabelling::default() };
            add(
                format!("axis {a} and {b}, {first} and {second}"),
                format!(
                    "The rig's axes {a} and {b} are swapped against the rod's: exchange {a} and {b} in the column axis, and the names of {first} and {second}"
                ),
                format!("the axes {a} and {b} look swapped"),
                relabelling,
                UNUSUAL,
            );
        }
    }
    for turned in [[1, 2, 0], [2, 0, 1]] {
        if labels.channels.len() < 3 {
            continue;
        }
        let name = |k: usize| column(Axis::ALL[turned[k]]);
        found.push(relabelled(
            &SWAP_MISTAKE,
            Key::new(labels.all_channels()),
            format!(
                "The columns dx_um, dy_um and dz_um are mixed up: they hold {}, {} and {}",
                name(0),
                name(1),
                name(2)
            ),
            "dx_um, dy_um and dz_um look mixed up".into(),
            Relabelling { channel: turned, ..Relabelling::default() },
            UNUSUAL,
        ));
    }
    found
}
