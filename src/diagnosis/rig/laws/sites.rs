//! Where on a rig a law may act that nobody has listed, and what it may be a function of.
//!
//! | place | what the law changes | functions of |
//! |---|---|---|
//! | rod | the load F that the rod follows, y = C·(F + ΔF) | load, deflection along it |
//! | clamp | displacement along the load | load |
//! | rod | the load, by friction | speed of loading |
//! | root, bend, declared joints | turn θ about the moment there, y = (θ·M/\|M\|) × lever | moment |
//! | rod | the deflection, by a share of it | load with its sign, load before, temperature, time, order |
//! | slide | the share of the last change of the load that shows | time since |
//! | sensor | what a channel shows | what it should show |
//! | sensors | offsets of all channels, under loads along all axes or along each | load |
//! | sensors | offsets of all channels | time, temperature, order |

use nalgebra::{DVector, Vector3};

use super::deflected::Deflected;
use super::measures::{SiteVariable, measure};
use crate::diagnosis::rig::mechanics::load_history::{instants, runs};
use crate::diagnosis::rig::model::{Body, RigModel};
use crate::diagnosis::rig::nonparametric::Before;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::law::{Course, Form, Instant, Measure, Recorded, Site};
use crate::inference::{Location, Part};
use crate::rod::{LawVariable, Rod};
use crate::spatial::Axis;
use crate::units::UM;

/// From zero on, of what is measured or hung: loads, readings. They may ripple.
const OF_A_LOAD: &[Form] = Form::FROM_ZERO;
/// Of what gives way under them.
const OF_A_CONTACT: &[Form] = Form::GIVING_WAY;
/// Of what comes to rest or to a stop: parts do, sensors seldom.
const OF_A_STOP: &[Form] = Form::TO_A_STOP;
/// With two signs, of which each may be another case.
const OF_A_SIDE: &[Form] = Form::FROM_ANYWHERE;
/// Of a distance: what pulls from there, is touched there, or is stretched from zero on.
const OF_A_DISTANCE: &[Form] = &[Form::Pull, Form::Threshold, Form::CONTACT, Form::ROUGH, Form::Power];
/// From the first reading on: time, order. What swings had begun before.
const OF_TIME: &[Form] = &[
    Form::Threshold,
    Form::Step,
    Form::Approach,
    Form::Decay,
    Form::Logarithm,
    Form::Polynomial(1),
    Form::Polynomial(2),
    Form::Polynomial(3),
    Form::Oscillation,
];
/// Where a displacement goes to and fro as often as this, and more: all but the last.
const OF_TIME_OF_CYCLES: &[Form] = OF_TIME.split_at(OF_TIME.len() - 1).0;
const CYCLES: usize = 2;
/// From anywhere on: temperature.
const OF_A_LEVEL: &[Form] = OF_A_SIDE;
/// Of two signs, and of several decades.
const OF_A_SPEED: &[Form] = &[Form::Approach, Form::Logarithm, Form::Power, Form::Polynomial(1)];
/// Friction: with the sign of the speed.
const OF_A_FRICTION: &[Form] =
    &[Form::Settling, Form::Approach, Form::Logarithm, Form::Power, Form::Polynomial(1)];
/// Times since: they fade.
const FADING: &[Form] = &[Form::Approach, Form::Decay, Form::Logarithm, Form::Power, Form::Polynomial(1)];

/// Pipes that turn by less are one, rad.
const LEAST_TURN: f64 = 1e-3;

/// All places, given what is known to change each datum, m.
pub fn sites(model: &RigModel, change: &DVector<f64>) -> Vec<Site> {
    let data = &model.data;
    let deflected = Deflected::new(model, change);
    let recording = Recording { data, deflected: &deflected, moves: moves(data, &deflected) };
    let newton = || (Location::Part(Part::Rod), measure("ΔF", "effective load", "N", 1.0));
    let mut sites = vec![recording.of_deflection(newton())];
    let of_load = (deflected.slope.clone(), deflected.load.clone());
    sites.push(recording.of_load(newton(), LawVariable::Load, of_load, OF_A_LOAD));
    let sign = |(d, sense): (&Datum, &f64)| if d.channel == d.direction.axis { *sense } else { 0.0 };
    sites.push(recording.of_load(
        (Location::Part(Part::Clamp), measure("Δu", "displacement along the load", "µm", UM)),
        LawVariable::Load,
        (data.iter().zip(&deflected.sense).map(sign).collect(), deflected.load.clone()),
        OF_A_CONTACT,
    ));
    if let (Some(rod), Body::Rod(_)) = (&model.rod, &model.body) {
        let declared = rod.joints.iter().map(|joint| (Location::Named(joint.name.clone()), joint.station));
        let bend = (rod.turn().abs() > LEAST_TURN).then(|| (Location::Part(Part::Bend), rod.bend_middle()));
        let places = std::iter::once((Location::Part(Part::Root), 0.0)).chain(bend).chain(declared);
        for (location, station) in places {
            let turned = |(i, d)| turned(d, rod, station, deflected.signed_load(i), deflected.sense[i]);
            let (weights, moments) = data.iter().enumerate().map(turned).unzip();
            // a bend is of one piece
            let rare = if location == Location::Part(Part::Bend) { OF_A_CONTACT } else { &[] };
            let turn = (location, measure("Δθ", "turn", "µrad", 1e-6));
            let site = recording.of_load(turn, LawVariable::Moment, (weights, moments), OF_A_CONTACT);
            sites.push(Site { rare, ..site });
        }
    }
    sites.extend(recording.shares());
    if let Some(speeds) = recording.speeds() {
        let ((location, result), speed) = (newton(), SiteVariable::OfFile(LawVariable::LoadingSpeed));
        let directions = vec![(String::new(), deflected.slope.clone())];
        sites.push(Site::new(location, result, speed.measure(), directions, speeds, OF_A_FRICTION));
    }
    for channel in Axis::ALL {
        let weight = |d: &Datum| f64::from(u8::from(d.channel == channel));
        let site = Site {
            location: Location::Channel { channel, form: None },
            result: measure("Δy", "reading", "µm", UM),
            variable: SiteVariable::OfFile(LawVariable::Reading).measure(),
            directions: vec![(String::new(), data.iter().map(weight).collect())],
            values: deflected.read.clone(),
            recorded: Some(Recorded::by_itself(data.iter().map(|d| d.measured).collect())),
            moves: Vec::new(),
            courses: Vec::new(),
            forms: OF_A_LOAD,
            rare: OF_A_STOP,
        };
        sites.push(site);
    }
    sites.extend(recording.under_loads());
    sites.extend(recording.drifts());
    if deflected.is_imposed {
        // the zero of the load cell
        let of_load = |common: Common| {
            let (directions, variable) =
                (vec![(String::new(), deflected.slope.clone())], common.variable.measure());
            let (location, result) = newton();
            let site = Site::new(location, result, variable, directions, common.values, common.forms);
            Site { moves: Vec::new(), courses: common.courses, ..site }
        };
        sites.extend(recording.common().into_iter().map(of_load));
    }
    sites.into_iter().map(|site| deflected.as_measured(site)).collect()
}

/// How far a datum moves by a turn of 1 rad at a station about the moment there of a load, N along
/// the positive axis, or of one of that sense; and that moment, N·m.
fn turned(datum: &Datum, rod: &Rod, station: f64, load: f64, sense: f64) -> (f64, f64) {
    let tip = rod.length();
    let at = |s: Option<f64>| s.unwrap_or(tip).min(tip);
    let (loaded, read) = (at(datum.load_station), at(datum.read_station));
    if station > loaded.min(read) {
        return (0.0, 0.0);
    }
    let lever = |s: f64| rod.point(s) - rod.point(station);
    // at no load, that of the load that hung there or will
    let newton = Vector3::ith(datum.direction.axis.index(), sense);
    let moment = lever(loaded).cross(&newton);
    let size = moment.norm();
    match size > 0.0 {
        true => ((moment / size).cross(&lever(read))[datum.channel.index()], size * load.abs()),
        false => (0.0, 0.0),
    }
}

/// 1 for what was reached on the way up, −1 on the way down.
fn moves(data: &[Datum], deflected: &Deflected) -> Vec<f64> {
    let side = |(i, d): (usize, &Datum)| match d.imposed.and(d.motion) {
        Some(motion) if motion.direction != 0.0 => motion.direction * deflected.sense[i],
        _ if d.is_unloading() => -1.0,
        _ => 1.0,
    };
    let sides: Vec<f64> = data.iter().enumerate().map(side).collect();
    deflected.as_driven(&sides)
}

/// Runs, with what was waited before each reading.
fn courses(data: &[Datum], deflected: &Deflected) -> Vec<Course> {
    let waits = Before::of(data).wait;
    let of_run = |run: Vec<usize>| {
        let mut before: Option<usize> = None;
        let instants = instants(data, &run).into_iter().map(|instant| {
            let own = deflected.driven[instant[0]];
            let is_same = |k: &usize| data[*k].drive() == data[own].drive();
            // at the same load it waits on since the reading before
            let elapsed = match before.filter(is_same).and_then(|k| data[own].time.zip(data[k].time)) {
                Some((now, then)) => now - then,
                None => waits.as_ref().map_or(f64::NAN, |waits| waits[own]),
            };
            before = Some(own);
            Instant { data: instant, elapsed, sense: deflected.sense[own] }
        });
        let instants = instants.collect();
        Course { instants, start: 0.0 }
    };
    runs(data).into_iter().map(of_run).collect()
}

/// A recording with what laws of several places need of it.
struct Recording<'a> {
    data: &'a [Datum],
    deflected: &'a Deflected,
    moves: Vec<f64>,
}

impl Recording<'_> {
    /// A law of a load or of what grows with it. It remembers the way of the loads that were hung.
    fn of_load(
        &self,
        (location, result): (Location, Measure),
        variable: LawVariable,
        (weights, values): (Vec<f64>, Vec<f64>),
        forms: &'static [Form],
    ) -> Site {
        Site {
            location,
            result,
            variable: SiteVariable::OfFile(variable).measure(),
            directions: vec![(String::new(), weights)],
            values,
            recorded: None,
            moves: self.moves.clone(),
            courses: if self.deflected.is_imposed { Vec::new() } else { self.one_by_one() },
            // nothing that gives way does so in waves
            forms,
            rare: &[],
        }
    }

    /// A law of the deflection along the load. It remembers the way of what was imposed. Under hung
    /// loads it is looked for as a law of a distance: all else is one of the load by another name.
    fn of_deflection(&self, (location, result): (Location, Measure)) -> Site {
        let Deflected { slope, along, .. } = self.deflected;
        let site = self.of_load(
            (location, result),
            LawVariable::Deflection,
            (slope.clone(), along.clone()),
            if self.deflected.is_imposed { OF_A_LOAD } else { OF_A_DISTANCE },
        );
        let data = self.data.iter().map(|d| d.measured).collect();
        let by = self.deflected.along_by.clone();
        Site { courses: self.one_by_one(), recorded: Some(Recorded { data, by, with_law: true }), ..site }
    }

    /// Its runs; nothing where one of them goes along several axes, which have no common course.
    fn one_by_one(&self) -> Vec<Course> {
        let courses = courses(self.data, self.deflected);
        let is_along_one = |course: &Course| {
            let mut axes = course.instants.iter().map(|instant| self.data[instant.data[0]].direction.axis);
            let first = axes.next();
            axes.all(|axis| Some(axis) == first)
        };
        if courses.iter().all(is_along_one) { courses } else { Vec::new() }
    }

    /// How fast the load was changed to what it is, N/s; nothing where that is always the same.
    fn speeds(&self) -> Option<Vec<f64>> {
        let mut speeds = Before::of(self.data).speeds(self.data)?;
        if self.deflected.is_imposed {
            for (i, (speed, d)) in speeds.iter_mut().zip(self.data).enumerate() {
                // m/s over m/N, the way the displacement points
                let slope = self.deflected.slope[i] * f64::from(d.direction.sign);
                *speed = if slope == 0.0 { 0.0 } else { *speed / slope };
            }
        }
        Some(self.deflected.as_driven(&speeds))
    }

    /// Laws that change the deflection by a share of it.
    fn shares(&self) -> Vec<Site> {
        let (data, deflected) = (self.data, self.deflected);
        let before = Before::of(data);
        let share = |part: Part, variable: SiteVariable, weights: Vec<f64>, values: Vec<f64>, forms| Site {
            location: Location::Part(part),
            result: measure("Δu/u", "deflection", "%", 0.01),
            variable: variable.measure(),
            directions: vec![(String::new(), weights)],
            values,
            recorded: None,
            moves: Vec::new(),
            courses: Vec::new(),
            forms,
            rare: &[],
        };
        let own = || deflected.read.clone();
        let mut sites = Vec::new();
        let loads: Vec<f64> = (0..data.len()).map(|i| deflected.signed_load(i)).collect();
        if loads.iter().any(|load| *load < 0.0) && loads.iter().any(|load| *load > 0.0) {
            // what is softer one way may be so either way
            for (sign, variable) in [(1.0, LawVariable::AlongPositive), (-1.0, LawVariable::AlongNegative)] {
                let values = loads.iter().map(|load| sign * load).collect();
                sites.push(share(Part::Rod, SiteVariable::OfFile(variable), own(), values, OF_A_SIDE));
            }
        }
        if !deflected.is_imposed && before.loads(data).is_some() {
            let variable = SiteVariable::OfFile(LawVariable::LoadBefore);
            let values = before.load.iter().map(|load| load.abs()).collect();
            sites.push(share(Part::Rod, variable, own(), values, OF_A_LOAD));
        }
        if let Some(speeds) = self.speeds() {
            let variable = SiteVariable::OfFile(LawVariable::LoadingSpeed);
            sites.push(share(Part::Rod, variable, own(), speeds, OF_A_SPEED));
        }
        if let (Some(wait), Some(_)) = (&before.wait, before.waits()) {
            let variable = SiteVariable::OfFile(LawVariable::SinceChange);
            let wait = deflected.as_driven(wait);
            sites.push(share(Part::Slide, variable, self.changes(&before), wait.clone(), FADING));
            sites.push(share(Part::Rod, variable, own(), wait, FADING));
        }
        for common in self.common() {
            let site = share(Part::Rod, common.variable, own(), common.values, common.forms);
            sites.push(Site { courses: common.courses, ..site });
        }
        sites
    }

    /// How far each sensor's place was displaced between the reading before and this one, m.
    fn changes(&self, before: &Before) -> Vec<f64> {
        let Deflected { slope, driven, .. } = self.deflected;
        let changes = before.changes(self.data, &self.deflected.read);
        let beside = |(i, &own): (usize, &usize)| match own == i || slope[own] == 0.0 {
            true => changes[i],
            false => slope[i] / slope[own] * changes[own],
        };
        driven.iter().enumerate().map(beside).collect()
    }

    /// Laws that add to all channels as a function of the load, wherever that pulls to, or under
    /// loads along each axis with sizes of their own: the stand of the sensors is moved by it, as
    /// the load points or one way whichever way that does. Of a single line that is the clamp.
    fn under_loads(&self) -> Vec<Site> {
        let Deflected { sense, load, .. } = self.deflected;
        let line = |d: &Datum| (d.channel, d.direction.axis);
        let mut lines: Vec<(Axis, Axis)> = self.data.iter().map(line).collect();
        lines.sort_unstable();
        lines.dedup();
        let mut channels: Vec<Axis> = lines.iter().map(|(channel, _)| *channel).collect();
        channels.dedup();
        let one_way = vec![1.0; sense.len()];
        let mut found = Vec::new();
        for (sides, said) in [(sense, ""), (&one_way, " (whichever way the load points)")] {
            if lines.len() < 2 || (!said.is_empty() && *sense == one_way) {
                continue;
            }
            let weights = |is_its: &dyn Fn(&Datum) -> bool| -> Vec<f64> {
                let weight = |(d, side): (&Datum, &f64)| if is_its(d) { *side } else { 0.0 };
                self.data.iter().zip(sides).map(weight).collect()
            };
            let site = |name: &str, directions| {
                let reading = measure("Δy", &format!("reading{name}{said}"), "µm", UM);
                let place = (Location::Part(Part::Sensors), reading);
                let plain = self.of_load(place, LawVariable::Load, (Vec::new(), load.clone()), OF_A_LOAD);
                Site { directions, ..plain }
            };
            let of_channel = |&own: &Axis| (format!("d{own}"), weights(&|d| d.channel == own));
            found.push(site("", channels.iter().map(of_channel).collect()));
            if channels.len() < lines.len() {
                let of_line = |&own: &(Axis, Axis)| {
                    let name = format!("d{},{}", own.0, own.1);
                    (name, weights(&|d| line(d) == own))
                };
                let (channel, axis) = lines[lines.len() - 1];
                let name = format!(" (d{channel},{axis}: d{channel} under loads along {axis})");
                found.push(site(&name, lines.iter().map(of_line).collect()));
            }
        }
        found
    }

    /// Laws that add to all channels, each with its own size.
    fn drifts(&self) -> Vec<Site> {
        let channels: Vec<Axis> =
            Axis::ALL.into_iter().filter(|axis| self.data.iter().any(|d| d.channel == *axis)).collect();
        let site_of = |common: Common| {
            let direction = |&channel: &Axis| {
                let name = if channels.len() > 1 { format!("d{channel}") } else { String::new() };
                let weight = |d: &Datum| f64::from(u8::from(d.channel == channel));
                (name, self.data.iter().map(weight).collect::<Vec<f64>>())
            };
            Site {
                location: Location::Part(Part::Sensors),
                result: measure("Δy", "reading", "µm", UM),
                variable: common.variable.measure(),
                directions: channels.iter().map(direction).collect(),
                values: common.values,
                recorded: None,
                moves: Vec::new(),
                courses: common.courses,
                forms: common.forms,
                rare: &[],
            }
        };
        self.common().into_iter().map(site_of).collect()
    }

    /// What all data have in common, as far as the recording has it: time, temperature, order.
    fn common(&self) -> Vec<Common> {
        let all = |value: &dyn Fn(&Datum) -> Option<f64>| -> Option<Vec<f64>> {
            let values: Vec<f64> = self.data.iter().map(value).collect::<Option<_>>()?;
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            Some(values.into_iter().map(|value| value - least).collect())
        };
        let plain = |variable, values, forms| Common { variable, values, forms, courses: Vec::new() };
        // what swings as the slide does follows the slide
        let is_cyclic = self.data.iter().any(|d| d.motion.is_some_and(|motion| motion.cycle >= CYCLES));
        let of_time = if is_cyclic && self.deflected.is_imposed { OF_TIME_OF_CYCLES } else { OF_TIME };
        let time = all(&|d| d.time).map(|t| plain(SiteVariable::Time, t, of_time));
        let order = all(&|d| Some(d.order as f64));
        let order = order.map(|n| plain(SiteVariable::Order, n, of_time));
        let temperature = all(&|d| d.temperature).map(|values| Common {
            courses: self.whole(values.first().copied().unwrap_or_default()).into_iter().collect(),
            ..plain(SiteVariable::Temperature, values, OF_A_LEVEL)
        });
        time.into_iter().chain(order).chain(temperature).collect()
    }

    /// The recording as one course, where its times are known.
    fn whole(&self, start: f64) -> Option<Course> {
        let mut before: Option<f64> = None;
        let by_instant = self.data.chunk_by(|a, b| a.order == b.order);
        let mut first = 0;
        let instant = |part: &[Datum]| {
            let own: Vec<usize> = (first..first + part.len()).collect();
            first += part.len();
            let now = part[0].time?;
            let elapsed = before.map_or(0.0, |before| now - before);
            before = Some(now);
            Some(Instant { data: own, elapsed, sense: 1.0 })
        };
        Some(Course { instants: by_instant.map(instant).collect::<Option<_>>()?, start })
    }
}

/// What all data have in common.
struct Common {
    variable: SiteVariable,
    values: Vec<f64>,
    forms: &'static [Form],
    courses: Vec<Course>,
}

#[cfg(test)]
mod tests;
