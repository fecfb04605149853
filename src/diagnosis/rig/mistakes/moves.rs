//! Mistakes of labels and units: everything that may have been written or wired wrongly, as a list.

use super::super::effects::mistakes::{SIGN_MISTAKE, SWAP_MISTAKE, UNIT_MISTAKE};
use super::change::{Change, Move, exact};
use super::lines::Line;
use crate::inference::Effect;
use crate::rig::readings::LoadColumn;
use crate::spatial::Axis;
use crate::units::STANDARD_GRAVITY;

/// A unit that a column may have instead of its own.
struct Unit {
    name: &'static str,
    /// True value over the one that was read.
    factor: f64,
    log_prior: f64,
    /// What to do with the column.
    cure: &'static str,
    /// How near to the factor the readings must come, as a ratio.
    within: f64,
}

/// The physics that remains may stand beside a unit's factor: a modulus may be 25 % off.
pub(super) const BESIDE: f64 = 1.25;
/// Where a rod that is softer or stiffer comes near the factor itself, less may.
const BESIDE_PHYSICS: f64 = 1.2;
pub(super) const HARDLY_BESIDE: f64 = 1.1;
const VERY_NEAR: f64 = 1.05;

const fn unit(name: &'static str, factor: f64, log_prior: f64, cure: &'static str) -> Unit {
    Unit { name, factor, log_prior, cure, within: BESIDE }
}

const POUND: f64 = 4.448_221_615_260_5;

/// Instead of newtons.
const FOR_NEWTONS: [Unit; 7] = [
    unit("kilograms", STANDARD_GRAVITY, 0.0, "multiply load_n by 9.80665 (or name the column load_kg)"),
    unit("grams", 1e-3 * STANDARD_GRAVITY, -0.5, "multiply load_n by 0.00980665"),
    Unit { within: BESIDE_PHYSICS, ..unit("pounds (lbf)", POUND, 0.0, "multiply load_n by 4.4482216") },
    Unit {
        within: HARDLY_BESIDE,
        ..unit("ounces (ozf)", POUND / 16.0, -2.0, "multiply load_n by 0.27801385")
    },
    unit("kilonewtons", 1e3, -2.0, "multiply load_n by 1000"),
    unit("millinewtons", 1e-3, -1.5, "divide load_n by 1000"),
    unit("newtons that were converted once more", 1.0 / STANDARD_GRAVITY, -0.5, "divide load_n by 9.80665"),
];

/// Instead of kilograms.
const FOR_KILOGRAMS: [Unit; 4] = [
    unit("newtons", 1.0 / STANDARD_GRAVITY, 0.0, "divide load_kg by 9.80665 (or name the column load_n)"),
    unit("grams", 1e-3, -0.3, "divide load_kg by 1000"),
    unit("tonnes", 1e3, -2.0, "multiply load_kg by 1000"),
    unit("kilograms that were divided by g", STANDARD_GRAVITY, -1.5, "multiply load_kg by 9.80665"),
];

/// Instead of micrometres.
const FOR_MICROMETRES: [Unit; 7] = [
    unit("millimetres", 1e3, 0.0, "multiply by 1000"),
    unit("inches", 25.4e3, -1.0, "multiply by 25400"),
    unit("thousandths of an inch (mil)", 25.4, -1.0, "multiply by 25.4"),
    unit("nanometres", 1e-3, -1.5, "divide by 1000"),
    unit("metres", 1e6, -1.0, "multiply by 1000000"),
    unit("centimetres", 1e4, -2.0, "multiply by 10000"),
    unit("hundredths of a millimetre", 10.0, -1.5, "multiply by 10"),
];

/// Pounds for kilograms are within what a rod does: joints alone make some twice as soft as their
/// pipes.
const LIKE_A_ROD: [(&str, f64); 1] = [("pounds (lb)", 0.453_592_37)];

/// The load's column, and the units of it, with their factors, that softer or stiffer rods look
/// like.
pub(super) fn like_physics(column: LoadColumn) -> (&'static str, Vec<(&'static str, f64)>) {
    match column {
        LoadColumn::Newtons => {
            let near = FOR_NEWTONS.iter().filter(|unit| unit.within < BESIDE);
            ("load_n", near.map(|unit| (unit.name, unit.factor)).collect())
        }
        LoadColumn::Kilograms => ("load_kg", LIKE_A_ROD.to_vec()),
    }
}

/// Only in the rows of one axis.
const ONE_AXIS: f64 = -1.0;
const UNUSUAL: f64 = -1.0;

/// What of the file is measured.
pub(super) struct Labels {
    pub column: LoadColumn,
    pub axes: Vec<Axis>,
    pub channels: Vec<Axis>,
    /// True where a channel was read under loads along another axis.
    has_cross: bool,
}

impl Labels {
    pub fn of(lines: &[Line], column: LoadColumn) -> Labels {
        let axes_where = |is_of: &dyn Fn(&Line, Axis) -> bool| -> Vec<Axis> {
            Axis::ALL.into_iter().filter(|&axis| lines.iter().any(|line| is_of(line, axis))).collect()
        };
        Labels {
            column,
            axes: axes_where(&|line, axis| line.axis == axis),
            channels: axes_where(&|line, axis| line.channel == axis),
            has_cross: lines.iter().any(|line| line.axis != line.channel),
        }
    }

    /// All channels as they stand in the file: `dx_um, dy_um, dz_um`.
    fn all_channels(&self) -> String {
        columns(&self.channels)
    }
}

/// `dx_um, dz_um`.
fn columns(channels: &[Axis]) -> String {
    let names: Vec<String> = channels.iter().map(|channel| column(*channel)).collect();
    names.join(", ")
}

/// `dy_um`.
pub(super) fn column(channel: Axis) -> String {
    format!("d{channel}_um")
}

fn mask(of: &[Axis]) -> [bool; 3] {
    Axis::ALL.map(|axis| of.contains(&axis))
}

const ALL: [bool; 3] = [true; 3];

/// Every mistake of labels and units that these lines could show.
pub(super) fn all(labels: &Labels) -> Vec<Move> {
    let mut moves = load_units(labels, false);
    moves.extend(reading_units(labels));
    moves.extend(signs(labels));
    moves.extend(swaps(labels));
    moves
}

/// Every one that some trials could show which others are compared with: what softer or stiffer
/// rods look like too, and decimal places.
pub(super) fn in_trials(labels: &Labels) -> Vec<Move> {
    let mut moves = load_units(labels, true);
    moves.extend(reading_units(labels));
    moves.extend(decimals(labels));
    moves.extend(signs(labels));
    moves.extend(swaps(labels));
    moves
}

fn load_units(labels: &Labels, is_in_trials: bool) -> Vec<Move> {
    let (name, own, units): (_, _, &[Unit]) = match labels.column {
        LoadColumn::Newtons => ("load_n", "newtons", &FOR_NEWTONS),
        LoadColumn::Kilograms => ("load_kg", "kilograms", &FOR_KILOGRAMS),
    };
    let mut moves = Vec::new();
    for unit in units {
        // loads along one axis cannot separate a pound from a joint that yields, nor can sensors
        // along the loads only, unless it comes very near
        let is_near_physics = unit.within < BESIDE && !is_in_trials;
        let within = if is_near_physics && !labels.has_cross { VERY_NEAR } else { unit.within };
        let mut add = |axes: [bool; 3], location: String, whose: String, log_prior: f64, rows: &str| {
            moves.push(Move {
                effect: &UNIT_MISTAKE,
                looks_like: format!("{location} looks like {}", unit.name),
                observed: format!("{whose} are {}, not {own}: {}{rows}", unit.name, unit.cure),
                location,
                change: Change::load(axes, unit.factor),
                log_prior: unit.log_prior + log_prior,
                estimates: vec![exact("factor", unit.factor)],
                within,
            });
        };
        if is_near_physics && labels.axes.len() < 2 {
            continue;
        }
        add(ALL, name.to_owned(), "The loads".into(), 0.0, "");
        if labels.axes.len() > 1 && !is_near_physics {
            for &axis in &labels.axes {
                let (location, whose) = (format!("{name}, axis {axis}"), format!("The loads along {axis}"));
                add(mask(&[axis]), location, whose, ONE_AXIS, " in these rows");
            }
        }
    }
    moves
}

fn reading_units(labels: &Labels) -> Vec<Move> {
    let mut moves = Vec::new();
    for unit in &FOR_MICROMETRES {
        let mut add = |axes: [bool; 3], channels: &[Axis], rows: Option<Axis>, log_prior: f64| {
            let names = columns(channels);
            let (verb, it) = if channels.len() == 1 { ("is", "it") } else { ("are", "them") };
            let (under, place) = match rows {
                Some(axis) => (format!(" under loads along {axis}"), format!("{names}, axis {axis}")),
                None => (String::new(), names.clone()),
            };
            // `multiply by 1000` → `multiply them by 1000`
            let cure = unit.cure.replacen(" by", &format!(" {it} by"), 1);
            moves.push(Move {
                effect: &UNIT_MISTAKE,
                looks_like: format!(
                    "{place} {} like {}",
                    if channels.len() == 1 { "looks" } else { "look" },
                    unit.name
                ),
                observed: format!("{names}{under} {verb} in {}, not in micrometres: {cure}", unit.name),
                location: place,
                change: Change::reading(axes, mask(channels), unit.factor),
                log_prior: unit.log_prior + log_prior,
                estimates: vec![exact("factor", unit.factor)],
                within: unit.within,
            });
        };
        add(ALL, &labels.channels, None, 0.0);
        if labels.channels.len() > 1 {
            labels.channels.iter().for_each(|&channel| add(ALL, &[channel], None, 0.0));
        }
        if labels.axes.len() > 1 && labels.has_cross {
            for &axis in &labels.axes {
                add(mask(&[axis]), &labels.channels, Some(axis), ONE_AXIS);
            }
        }
    }
    moves
}

/// A decimal point that slipped, or a display in another range.
fn decimals(labels: &Labels) -> Vec<Move> {
    const DECIMALS: [(f64, f64, &str); 4] = [
        (10.0, -1.0, "multiply them by 10"),
        (0.1, -1.0, "divide them by 10"),
        (100.0, -2.0, "multiply them by 100"),
        (0.01, -2.0, "divide them by 100"),
    ];
    let mut moves = Vec::new();
    for (factor, log_prior, cure) in DECIMALS {
        let size = if factor > 1.0 { "small" } else { "large" };
        let times = if !(0.05..50.0).contains(&factor) { 100 } else { 10 };
        let mut add = |location: String, change: Change, whose: &str, log_prior: f64| {
            moves.push(Move {
                effect: &UNIT_MISTAKE,
                looks_like: format!("{location} looks {times} times too {size}"),
                observed: format!(
                    "{whose} are {times} times too {size} (a decimal point, or another range): {cure}"
                ),
                location,
                change,
                log_prior,
                estimates: vec![exact("factor", factor)],
                within: HARDLY_BESIDE,
            });
        };
        add(load_column(labels.column).into(), Change::load(ALL, factor), "the loads", log_prior + UNUSUAL);
        let mut of = |channels: &[Axis]| {
            let names = columns(channels);
            let change = Change::reading(ALL, mask(channels), factor);
            add(names.clone(), change, &format!("the readings {names}"), log_prior);
        };
        of(&labels.channels);
        if labels.channels.len() > 1 {
            labels.channels.iter().for_each(|&channel| of(&[channel]));
        }
    }
    moves
}

/// `load_n` or `load_kg`.
pub(super) fn load_column(column: LoadColumn) -> &'static str {
    match column {
        LoadColumn::Newtons => "load_n",
        LoadColumn::Kilograms => "load_kg",
    }
}

/// A sign or a name: there is no number in it, so that nothing has to come near to one.
fn relabelled(
    effect: &'static Effect,
    location: String,
    observed: String,
    looks_like: String,
    change: Change,
    log_prior: f64,
) -> Move {
    Move {
        effect,
        location,
        change,
        log_prior,
        estimates: Vec::new(),
        observed,
        looks_like,
        within: f64::INFINITY,
    }
}

fn signs(labels: &Labels) -> Vec<Move> {
    let mut moves = Vec::new();
    let mut add = |location, observed, looks_like, change, log_prior| {
        moves.push(relabelled(&SIGN_MISTAKE, location, observed, looks_like, change, log_prior));
    };
    for &channel in &labels.channels {
        let name = column(channel);
        add(
            name.clone(),
            format!("{name} has the wrong sign: multiply it by −1"),
            format!("{name} looks as if its sign were wrong"),
            Change::reading(ALL, mask(&[channel]), -1.0),
            0.0,
        );
    }
    for &axis in &labels.axes {
        add(
            format!("axis {axis}"),
            format!(
                "Loads along {axis} pull the other way: write -{axis} for {axis}, and {axis} for -{axis}, in the column axis"
            ),
            format!("loads along {axis} look as if they pulled the other way"),
            Change::load(mask(&[axis]), -1.0),
            -0.3,
        );
        if labels.has_cross && labels.channels.contains(&axis) {
            let both = Change {
                load: Change::load(mask(&[axis]), -1.0).load,
                ..Change::reading(ALL, mask(&[axis]), -1.0)
            };
            let name = column(axis);
            add(
                format!("axis {axis} and {name}"),
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
            names.clone(),
            format!(
                "All readings have the wrong sign: multiply {names} by −1 (or turn every direction in the column axis round)"
            ),
            "all readings look as if their sign were wrong".into(),
            Change::reading(ALL, ALL, -1.0),
            0.0,
        );
    }
    moves
}

fn swaps(labels: &Labels) -> Vec<Move> {
    let [x, y, z] = Axis::ALL;
    let mut moves = Vec::new();
    for (a, b) in [(x, y), (y, z), (x, z)] {
        let mut swapped = [0, 1, 2];
        swapped.swap(a.index(), b.index());
        let (is_channel, is_axis) =
            (|of: Axis| labels.channels.contains(&of), |of: Axis| labels.axes.contains(&of));
        let mut add = |location, observed, looks_like, change, log_prior| {
            moves.push(relabelled(&SWAP_MISTAKE, location, observed, looks_like, change, log_prior));
        };
        let (first, second) = (column(a), column(b));
        if is_channel(a) || is_channel(b) {
            let observed = match (is_channel(a), is_channel(b)) {
                (true, true) => format!("The columns {first} and {second} are swapped: exchange their names"),
                (true, false) => format!("The column {first} holds {second}: name it {second}"),
                _ => format!("The column {second} holds {first}: name it {first}"),
            };
            let change = Change { channel: swapped, ..Change::default() };
            let looks_like = format!("{first} and {second} look swapped");
            add(format!("{first} and {second}"), observed, looks_like, change, 0.0);
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
            let change = Change { axis: swapped, ..Change::default() };
            let looks_like = format!("loads along {a} and {b} look swapped");
            add(format!("axis {a} and {b}"), observed, looks_like, change, -0.3);
        }
        if (is_channel(a) || is_channel(b)) && (is_axis(a) || is_axis(b)) {
            let change = Change { axis: swapped, channel: swapped, ..Change::default() };
            add(
                format!("axis {a} and {b}, {first} and {second}"),
                format!(
                    "The rig's axes {a} and {b} are swapped against the rod's: exchange {a} and {b} in the column axis, and the names of {first} and {second}"
                ),
                format!("the axes {a} and {b} look swapped"),
                change,
                UNUSUAL,
            );
        }
    }
    for turned in [[1, 2, 0], [2, 0, 1]] {
        if labels.channels.len() < 3 {
            continue;
        }
        let name = |k: usize| column(Axis::ALL[turned[k]]);
        moves.push(relabelled(
            &SWAP_MISTAKE,
            labels.all_channels(),
            format!(
                "The columns dx_um, dy_um and dz_um are mixed up: they hold {}, {} and {}",
                name(0),
                name(1),
                name(2)
            ),
            "dx_um, dy_um and dz_um look mixed up".into(),
            Change { channel: turned, ..Change::default() },
            UNUSUAL,
        ));
    }
    moves
}
