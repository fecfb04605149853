//! Columns in another unit than their names say.

use self::Cure::{Divide, Multiply};
use super::in_file::{ALL, Labels, ONE_AXIS, UNUSUAL, mask};
use crate::diagnosis::rig::effects::mistakes::UNIT_MISTAKE;
use crate::diagnosis::rig::mistakes::possible::{PossibleMistake, exact};
use crate::diagnosis::rig::mistakes::relabelling::Relabelling;
use crate::diagnosis::rig::recording::columns::{axis_rows, columns, load_column};
use crate::inference::Key;
use crate::rig::readings::LoadColumn;
use crate::spatial::Axis;
use crate::units::{POUND, POUND_FORCE, STANDARD_GRAVITY};

/// A unit that a column may have instead of its own.
struct Unit {
    name: &'static str,
    /// True value over the one that was read.
    factor: f64,
    log_prior: f64,
    cure: Cure,
    /// What to do instead.
    or_else: Option<&'static str>,
    /// How near to the factor the readings must come, as a ratio.
    within: f64,
}

/// What to do with the column, by which number.
#[derive(Clone, Copy)]
enum Cure {
    Multiply(&'static str),
    Divide(&'static str),
}

impl Cure {
    /// `multiply load_n by 1000`.
    fn applied_to(self, what: &str) -> String {
        match self {
            Multiply(by) => format!("multiply {what} by {by}"),
            Divide(by) => format!("divide {what} by {by}"),
        }
    }
}

/// The physics that remains may stand beside a unit's factor: a modulus may be 25 % off.
pub const BESIDE: f64 = 1.25;
/// Where a rod that is softer or stiffer comes near the factor itself, less may.
const BESIDE_PHYSICS: f64 = 1.2;
pub const HARDLY_BESIDE: f64 = 1.1;
const VERY_NEAR: f64 = 1.05;

const fn unit(name: &'static str, factor: f64, log_prior: f64, cure: Cure) -> Unit {
    Unit { name, factor, log_prior, cure, or_else: None, within: BESIDE }
}

/// Instead of newtons.
const FOR_NEWTONS: [Unit; 7] = [
    Unit {
        or_else: Some("name the column load_kg"),
        ..unit("kilograms", STANDARD_GRAVITY, 0.0, Multiply("9.80665"))
    },
    unit("grams", 1e-3 * STANDARD_GRAVITY, -0.5, Multiply("0.00980665")),
    Unit { within: BESIDE_PHYSICS, ..unit("pounds (lbf)", POUND_FORCE, 0.0, Multiply("4.4482216")) },
    Unit { within: HARDLY_BESIDE, ..unit("ounces (ozf)", POUND_FORCE / 16.0, -2.0, Multiply("0.27801385")) },
    unit("kilonewtons", 1e3, -2.0, Multiply("1000")),
    unit("millinewtons", 1e-3, -1.5, Divide("1000")),
    unit("newtons that were converted once more", 1.0 / STANDARD_GRAVITY, -0.5, Divide("9.80665")),
];

/// Instead of kilograms.
const FOR_KILOGRAMS: [Unit; 5] = [
    Unit {
        or_else: Some("name the column load_n"),
        ..unit("newtons", 1.0 / STANDARD_GRAVITY, 0.0, Divide("9.80665"))
    },
    unit("grams", 1e-3, -0.3, Divide("1000")),
    unit("tonnes", 1e3, -2.0, Multiply("1000")),
    unit("kilograms that were divided by g", STANDARD_GRAVITY, -1.5, Multiply("9.80665")),
    // a rod 2.2 times as stiff as its file looks like them: very near, and with that as a rival
    Unit { within: VERY_NEAR, ..unit("pounds (lb)", POUND, 0.0, Multiply("0.45359237")) },
];

/// Instead of micrometres.
const FOR_MICROMETRES: [Unit; 7] = [
    unit("millimetres", 1e3, 0.0, Multiply("1000")),
    unit("inches", 25.4e3, -1.0, Multiply("25400")),
    unit("thousandths of an inch (mil)", 25.4, -1.0, Multiply("25.4")),
    unit("nanometres", 1e-3, -1.5, Divide("1000")),
    unit("metres", 1e6, -1.0, Multiply("1000000")),
    unit("centimetres", 1e4, -2.0, Multiply("10000")),
    unit("hundredths of a millimetre", 10.0, -1.5, Multiply("10")),
];

/// A unit that readings may have instead of micrometres.
pub struct ReadIn {
    pub name: &'static str,
    /// True value over the one that was read.
    pub factor: f64,
    /// `multiply them by 1000`.
    pub cure: String,
}

/// All of them.
pub fn of_readings() -> Vec<ReadIn> {
    let read_in =
        |unit: &Unit| ReadIn { name: unit.name, factor: unit.factor, cure: unit.cure.applied_to("them") };
    FOR_MICROMETRES.iter().map(read_in).collect()
}

/// Units of the loads, with their factors.
pub fn of_loads(column: LoadColumn) -> Vec<(&'static str, f64)> {
    let units: &[Unit] = match column {
        LoadColumn::Newtons => &FOR_NEWTONS,
        LoadColumn::Kilograms => &FOR_KILOGRAMS,
    };
    units.iter().map(|unit| (unit.name, unit.factor)).collect()
}

/// Units of the loads.
pub(super) fn load_units(labels: &Labels, is_in_trials: bool) -> Vec<PossibleMistake> {
    let (own, units): (_, &[Unit]) = match labels.load_column {
        LoadColumn::Newtons => ("newtons", &FOR_NEWTONS),
        LoadColumn::Kilograms => ("kilograms", &FOR_KILOGRAMS),
    };
    let column = load_column(labels.load_column);
    let mut found = Vec::new();
    for unit in units {
        // loads along one axis cannot separate a pound from a compliant joint, nor can sensors
        // along the loads only, unless it comes very near
        let is_near_physics = unit.within < BESIDE && !is_in_trials;
        let within = if is_near_physics && !labels.has_cross { VERY_NEAR } else { unit.within };
        let of_axes = |axes: [bool; 3], location: Key, whose: &str| PossibleMistake {
            effect: &UNIT_MISTAKE,
            looks_like: format!("{location} looks like {}", unit.name),
            observed: format!("{whose} are {}, not {own}: {}", unit.name, unit.cure.applied_to(column)),
            or_else: unit.or_else,
            location,
            relabelling: Relabelling::load(axes, unit.factor),
            log_prior: unit.log_prior,
            estimates: vec![exact("factor", unit.factor)],
            within,
        };
        if is_near_physics && labels.axes.len() < 2 {
            continue;
        }
        found.push(of_axes(ALL, Key::new(column), "The loads"));
        if labels.axes.len() > 1 && !is_near_physics {
            for &axis in &labels.axes {
                let whose = format!("The loads along {axis}");
                let of_axis = of_axes(mask(&[axis]), Key::new(column).rows(axis_rows(axis)), &whose);
                found.push(PossibleMistake {
                    observed: format!("{} in these rows", of_axis.observed_in_all_rows()),
                    or_else: None,
                    log_prior: unit.log_prior + ONE_AXIS,
                    ..of_axis
                });
            }
        }
    }
    found
}

/// Units of the readings.
pub(super) fn reading_units(labels: &Labels) -> Vec<PossibleMistake> {
    let mut found = Vec::new();
    for unit in &FOR_MICROMETRES {
        let mut add = |axes: [bool; 3], channels: &[Axis], rows: Option<Axis>, log_prior: f64| {
            let names = columns(channels);
            let (verb, it) = if channels.len() == 1 { ("is", "it") } else { ("are", "them") };
            let (under, location) = match rows {
                Some(axis) => (format!(" under loads along {axis}"), Key::new(&names).rows(axis_rows(axis))),
                None => (String::new(), Key::new(&names)),
            };
            let cure = unit.cure.applied_to(it);
            found.push(PossibleMistake {
                effect: &UNIT_MISTAKE,
                looks_like: format!(
                    "{location} {} like {}",
                    if channels.len() == 1 { "looks" } else { "look" },
                    unit.name
                ),
                observed: format!("{names}{under} {verb} in {}, not in micrometres: {cure}", unit.name),
                or_else: None,
                location,
                relabelling: Relabelling::reading(axes, mask(channels), unit.factor),
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
    found
}

/// Decimal points that slipped, or displays in another range: ln of how usual each is.
const DECIMALS: [(f64, f64, &str); 4] = [
    (10.0, -1.0, "multiply them by 10"),
    (0.1, -1.0, "divide them by 10"),
    (100.0, -2.0, "multiply them by 100"),
    (0.01, -2.0, "divide them by 100"),
];

/// A decimal point that slipped, or a display in another range, in all rows.
pub(super) fn decimals(labels: &Labels) -> Vec<PossibleMistake> {
    let mut found = Vec::new();
    for (factor, log_prior, cure) in DECIMALS {
        let loads = Key::new(load_column(labels.load_column));
        let of_all = Relabelling::load(ALL, factor);
        found.push(decimal(factor, cure, loads, of_all, "The loads", log_prior + UNUSUAL));
        let mut add_readings = |channels: &[Axis]| {
            let names = columns(channels);
            let relabelling = Relabelling::reading(ALL, mask(channels), factor);
            let whose = format!("The readings {names}");
            found.push(decimal(factor, cure, Key::new(&names), relabelling, &whose, log_prior));
        };
        add_readings(&labels.channels);
        if labels.channels.len() > 1 {
            labels.channels.iter().for_each(|&channel| add_readings(&[channel]));
        }
    }
    found
}

/// The same under the loads of one axis: the others show what is right.
pub(super) fn decimals_of_axes(labels: &Labels) -> Vec<PossibleMistake> {
    if labels.axes.len() < 2 {
        return Vec::new();
    }
    let names = labels.all_channels();
    let of_axis = |&axis: &Axis| {
        let of_factor = |&(factor, log_prior, cure): &(f64, f64, &str)| {
            let [loads, readings] = [load_column(labels.load_column), &names]
                .map(|columns| Key::new(columns).rows(axis_rows(axis)));
            let of_loads = Relabelling::load(mask(&[axis]), factor);
            let of_readings = Relabelling::reading(mask(&[axis]), mask(&labels.channels), factor);
            let (loads_of, readings_of) =
                (format!("The loads along {axis}"), format!("The readings under loads along {axis}"));
            let rare = log_prior + ONE_AXIS;
            // a channel that was read along its own axis alone is looked at as a channel
            let of_readings =
                labels.has_cross.then(|| decimal(factor, cure, readings, of_readings, &readings_of, rare));
            let of_loads = decimal(factor, cure, loads, of_loads, &loads_of, rare + UNUSUAL);
            std::iter::once(of_loads).chain(of_readings)
        };
        DECIMALS.iter().flat_map(of_factor).collect::<Vec<_>>()
    };
    labels.axes.iter().flat_map(of_axis).collect()
}

fn decimal(
    factor: f64,
    cure: &str,
    location: Key,
    relabelling: Relabelling,
    whose: &str,
    log_prior: f64,
) -> PossibleMistake {
    let size = if factor > 1.0 { "small" } else { "large" };
    let times = if !(0.05..50.0).contains(&factor) { 100 } else { 10 };
    PossibleMistake {
        effect: &UNIT_MISTAKE,
        looks_like: format!("{location} looks {times} times too {size}"),
        observed: format!("{whose} are {times} times too {size} (a decimal point, or another range): {cure}"),
        or_else: None,
        location,
        relabelling,
        log_prior,
        estimates: vec![exact("factor", factor)],
        within: HARDLY_BESIDE,
    }
}
