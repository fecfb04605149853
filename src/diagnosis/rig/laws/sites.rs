//! Where on a rig a law may act that nobody has listed, and what it may be a function of.
//!
//! | place | what the law changes | functions of |
//! |---|---|---|
//! | rod | the load F that the rod follows, y = C·(F + ΔF) | load |
//! | clamp | displacement along the load | load |
//! | rod | the load, by friction | speed of loading |
//! | root, bend, declared joints | turn θ about the moment there, y = (θ·M/\|M\|) × lever | moment |
//! | rod | the deflection, by a share of it | load with its sign, load before, temperature, time, order |
//! | slide | the share of the last change of the load that shows | time since |
//! | sensor | what a channel shows | what it should show |
//! | sensors | offsets of all channels | time, temperature, order |

use std::collections::BTreeMap;

use nalgebra::{DVector, Vector3};

use super::measures::{SiteVariable, measure};
use crate::diagnosis::rig::mechanics::load_history::{instants, runs};
use crate::diagnosis::rig::model::{Body, RigModel};
use crate::diagnosis::rig::nonparametric::Before;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::law::{Course, Form, Instant, Measure, Site};
use crate::inference::{Location, Part};
use crate::rod::{LawVariable, Rod};
use crate::spatial::Axis;
use crate::units::UM;

/// From zero on, of what is measured or hung: loads, readings. They may ripple.
const OF_A_LOAD: &[Form] = Form::FROM_ZERO;
/// Of what gives way under them.
const OF_A_CONTACT: &[Form] = Form::GIVING_WAY;
/// Of what comes to rest or to a stop: parts do, sensors seldom.
const OF_A_STOP: &[Form] = &[
    Form::Power,
    Form::PowerAfterGap,
    Form::Saturation,
    Form::Rounded,
    Form::Threshold,
    Form::Step,
    Form::Approach,
    Form::Logarithm,
];
/// With two signs, of which each may be another case.
const OF_A_SIDE: &[Form] = Form::FROM_ANYWHERE;
/// From the first reading on: time, order. What swings had begun before.
const OF_TIME: &[Form] = &[
    Form::Threshold,
    Form::Step,
    Form::Approach,
    Form::Decay,
    Form::Logarithm,
    Form::Oscillation,
    Form::Polynomial(1),
    Form::Polynomial(2),
    Form::Polynomial(3),
];
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

/// All places, given what is known to change each datum, m. Nothing where the displacement was
/// imposed.
pub fn sites(model: &RigModel, change: &DVector<f64>) -> Vec<Site> {
    let data = &model.data;
    if data.iter().any(|d| d.imposed.is_some()) {
        return Vec::new();
    }
    let bare = model.deflections();
    // what each datum shows by what is known
    let known: Vec<f64> = bare.iter().zip(change.iter()).map(|(u, more)| u + more).collect();
    let slopes = slopes(data, &bare, change);
    let loads: Vec<f64> = data.iter().map(|d| d.load).collect();
    let recording = Recording { data, moves: moves(data), by_load: courses(data, |_| 0.0) };
    let newton = || (Location::Part(Part::Rod), measure("ΔF", "effective load", "N", 1.0));
    let of_load = (slopes.clone(), loads.clone());
    let mut sites = vec![recording.of_load(newton(), LawVariable::Load, of_load, OF_A_LOAD)];
    let sign = |d: &Datum| if d.channel == d.direction.axis { f64::from(d.direction.sign) } else { 0.0 };
    sites.push(recording.of_load(
        (Location::Part(Part::Clamp), measure("Δu", "displacement along the load", "µm", UM)),
        LawVariable::Load,
        (data.iter().map(sign).collect(), loads),
        OF_A_CONTACT,
    ));
    if let (Some(rod), Body::Rod(_)) = (&model.rod, &model.body) {
        let declared = rod.joints.iter().map(|joint| (Location::Named(joint.name.clone()), joint.station));
        let bend = (rod.turn().abs() > LEAST_TURN).then(|| (Location::Part(Part::Bend), rod.bend_middle()));
        let places = std::iter::once((Location::Part(Part::Root), 0.0)).chain(bend).chain(declared);
        for (location, station) in places {
            let (weights, moments) = data.iter().map(|d| turned(d, rod, station)).unzip();
            // a bend is of one piece
            let rare = if location == Location::Part(Part::Bend) { OF_A_CONTACT } else { &[] };
            let turn = (location, measure("Δθ", "turn", "µrad", 1e-6));
            let site = recording.of_load(turn, LawVariable::Moment, (weights, moments), OF_A_CONTACT);
            sites.push(Site { rare, ..site });
        }
    }
    sites.extend(recording.shares(&known));
    if let Some(speeds) = Before::of(data).speeds(data) {
        let ((location, result), speed) = (newton(), SiteVariable::OfFile(LawVariable::LoadingSpeed));
        let directions = vec![(String::new(), slopes)];
        sites.push(Site::new(location, result, speed.measure(), directions, speeds, OF_A_FRICTION));
    }
    for channel in Axis::ALL {
        let weight = |d: &Datum| f64::from(u8::from(d.channel == channel));
        let site = Site {
            location: Location::Channel { channel, form: None },
            result: measure("Δy", "reading", "µm", UM),
            variable: SiteVariable::OfFile(LawVariable::Reading).measure(),
            directions: vec![(String::new(), data.iter().map(weight).collect())],
            values: known.clone(),
            recorded: Some(data.iter().map(|d| d.measured).collect()),
            moves: Vec::new(),
            courses: Vec::new(),
            forms: OF_A_LOAD,
            rare: OF_A_STOP,
        };
        sites.push(site);
    }
    sites.extend(recording.drifts());
    sites
}

/// How far a datum moves by a turn of 1 rad at a station about the moment there, and that moment,
/// N·m.
fn turned(datum: &Datum, rod: &Rod, station: f64) -> (f64, f64) {
    let tip = rod.length();
    let at = |s: Option<f64>| s.unwrap_or(tip).min(tip);
    let (load, read) = (at(datum.load_station), at(datum.read_station));
    if station > load.min(read) {
        return (0.0, 0.0);
    }
    let lever = |s: f64| rod.point(s) - rod.point(station);
    // at no load, that of the load that hung there or will
    let newton = Vector3::ith(datum.direction.axis.index(), f64::from(datum.direction.sign));
    let moment = lever(load).cross(&newton);
    let size = moment.norm();
    match size > 0.0 {
        true => ((moment / size).cross(&lever(read))[datum.channel.index()], size * datum.load),
        false => (0.0, 0.0),
    }
}

/// What a newton that bends the rod moves each datum by, m/N: what it shows without findings and
/// nominal numbers at this load, and on average what these `change` of that. Friction, loops and
/// offsets among them are no compliance.
fn slopes(data: &[Datum], bare: &[f64], change: &DVector<f64>) -> Vec<f64> {
    type Place = (Axis, Axis, [u64; 2]);
    let place = |d: &Datum| -> Place { (d.direction.axis, d.channel, d.stations()) };
    // bare·F, change·F and F² of each
    let mut sums: BTreeMap<Place, [f64; 3]> = BTreeMap::new();
    for (i, d) in data.iter().enumerate() {
        let (load, sum) = (d.signed_load(), sums.entry(place(d)).or_default());
        sum[0] += bare[i] * load;
        sum[1] += change[i] * load;
        sum[2] += load * load;
    }
    let slope = |(i, d): (usize, &Datum)| {
        let [own, more, square] = sums[&place(d)];
        if square == 0.0 {
            return 0.0;
        }
        let own = if d.load > 0.0 { bare[i] / d.signed_load() } else { own / square };
        f64::from(d.direction.sign) * (own + more / square)
    };
    data.iter().enumerate().map(slope).collect()
}

/// 1 for what was reached on the way up, −1 on the way down.
fn moves(data: &[Datum]) -> Vec<f64> {
    data.iter().map(|d| if d.is_unloading() { -1.0 } else { 1.0 }).collect()
}

/// Runs, with what was waited before each reading.
fn courses(data: &[Datum], start: impl Fn(&[usize]) -> f64) -> Vec<Course> {
    let waits = Before::of(data).wait;
    let of_run = |run: Vec<usize>| {
        let mut before: Option<usize> = None;
        let instants = instants(data, &run).into_iter().map(|instant| {
            let own = instant[0];
            let is_same = |k: &usize| data[*k].drive() == data[own].drive();
            // at the same load it waits on since the reading before
            let elapsed = match before.filter(is_same).and_then(|k| data[own].time.zip(data[k].time)) {
                Some((now, then)) => now - then,
                None => waits.as_ref().map_or(f64::NAN, |waits| waits[own]),
            };
            before = Some(own);
            Instant { data: instant, elapsed, sense: f64::from(data[own].direction.sign) }
        });
        let instants = instants.collect();
        Course { instants, start: start(&run) }
    };
    runs(data).into_iter().map(of_run).collect()
}

/// A recording with what laws of several places need of it.
struct Recording<'a> {
    data: &'a [Datum],
    moves: Vec<f64>,
    by_load: Vec<Course>,
}

impl Recording<'_> {
    /// A law of a load or of what grows with it.
    fn of_load(
        &self,
        (location, result): (Location, Measure),
        variable: LawVariable,
        (weights, values): (Vec<f64>, Vec<f64>),
        forms: &'static [Form],
    ) -> Site {
        // loads along several axes have no common course
        let of_run = |course: &Course| {
            let mut axes = course.instants.iter().map(|instant| self.data[instant.data[0]].direction.axis);
            let first = axes.next();
            axes.all(|axis| Some(axis) == first)
        };
        let courses = if self.by_load.iter().all(of_run) { self.by_load.clone() } else { Vec::new() };
        Site {
            location,
            result,
            variable: SiteVariable::OfFile(variable).measure(),
            directions: vec![(String::new(), weights)],
            values,
            recorded: None,
            moves: self.moves.clone(),
            courses,
            // nothing that gives way does so in waves
            forms,
            rare: &[],
        }
    }

    /// Laws that change the deflection by a share of it.
    fn shares(&self, known: &[f64]) -> Vec<Site> {
        let data = self.data;
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
        let own = || known.to_vec();
        let mut sites = Vec::new();
        if data.iter().any(|d| d.drive() < 0.0) && data.iter().any(|d| d.drive() > 0.0) {
            // what is softer one way may be so either way
            for (sign, variable) in [(1.0, LawVariable::AlongPositive), (-1.0, LawVariable::AlongNegative)] {
                let values = data.iter().map(|d| sign * d.drive()).collect();
                sites.push(share(Part::Rod, SiteVariable::OfFile(variable), own(), values, OF_A_SIDE));
            }
        }
        if before.loads(data).is_some() {
            let variable = SiteVariable::OfFile(LawVariable::LoadBefore);
            let values = before.load.iter().map(|load| load.abs()).collect();
            sites.push(share(Part::Rod, variable, own(), values, OF_A_LOAD));
        }
        if let Some(speeds) = before.speeds(data) {
            let variable = SiteVariable::OfFile(LawVariable::LoadingSpeed);
            sites.push(share(Part::Rod, variable, own(), speeds, OF_A_SPEED));
        }
        if let (Some(wait), Some(_)) = (&before.wait, before.waits()) {
            let variable = SiteVariable::OfFile(LawVariable::SinceChange);
            let changes = before.changes(data, known);
            sites.push(share(Part::Slide, variable, changes, wait.clone(), FADING));
            sites.push(share(Part::Rod, variable, own(), wait.clone(), FADING));
        }
        for common in self.common() {
            let site = share(Part::Rod, common.variable, own(), common.values, common.forms);
            sites.push(Site { courses: common.courses, ..site });
        }
        sites
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
        let time = all(&|d| d.time).map(|t| plain(SiteVariable::Time, t, OF_TIME));
        let order = all(&|d| Some(d.order as f64));
        let order = order.map(|n| plain(SiteVariable::Order, n, OF_TIME));
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
