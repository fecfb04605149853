//! How much each sensor scatters, beside the others: one that is far worse has a noise of its own.
//!
//! What repeats is no noise, and neither is what is smooth, so that the scatter of a sensor is the
//! smallest of three, each without a model. Readings yⱼ of two runs one after the other, under the
//! same loads, differ by dⱼ, and so do the two ways of one run; and of one way through the loads x
//! each reading has neighbours on both sides of it:
//!
//! ```text
//! e = (dⱼ₊₁ − dⱼ)/2                                            t = (xⱼ − xⱼ₋₁)/(xⱼ₊₁ − xⱼ₋₁)
//! e = (yⱼ − (1 − t)·yⱼ₋₁ − t·yⱼ₊₁)/√(1 + (1 − t)² + t²)
//! ```
//!
//! have the standard deviation of one reading (T. Gasser, L. Sroka, C. Jennen-Steinmetz, Biometrika
//! 73 (1986) 625–633), which is the upper quartile of their sizes over that of a normal number, a
//! few far off or not. A sensor that scatters under loads along one axis only does not scatter:
//! something else does.

use std::collections::BTreeMap;
use std::hash::Hash;

use super::datum::{Datum, Imposed};
use super::resolution::resolution;
use crate::diagnosis::rig::numbering::numbered;
use crate::rig::readings::{Axis, RigHeader};

/// Fewer such differences do not say what a sensor scatters by, but that it scatters by less.
const FEWEST: usize = 20;
const FEWEST_AGAINST: usize = 8;
/// Within this factor all sensors scatter alike: what is fitted to them knows of single ones that
/// are off.
const ALIKE: f64 = 1.5;
/// And within so many standard deviations of a quartile of n differences, 0.91/√n and more for
/// those that have readings in common: 1 of 2000, for each recording has some sensors.
const SURE: f64 = 3.5;
const OF_QUARTILE: f64 = 1.2;
/// Upper quartile of the size of a normal number.
const NORMAL: f64 = 1.1503;
/// Without one axis it scatters less than this share of what it does along all: not the sensor.
const ALONG_ONE: f64 = 0.5;
/// No sensor is trusted farther beyond the usual one.
const SUREST: f64 = 0.1;
/// A reading is no surer than this share of the step that its display shows.
const OF_STEP: f64 = 0.5;

/// Noise of each datum over the usual one; 1 of all where none is known to differ. Loads that were
/// measured are readings of a sensor of their own. What the header states of offsets and loads is
/// known.
pub fn spread(data: &[Datum], header: &RigHeader) -> Vec<f64> {
    if let Some(spread) = stated(data, header) {
        return spread;
    }
    let stiff = stiff(data);
    let sensor = numbers(data, &stiff, Datum::sensor);
    let channel = numbers(data, &stiff, |datum| datum.channel);
    let of_number = |numbers: &[usize], number: usize| {
        scatter(
            &data.iter().zip(numbers).filter(|(_, own)| **own == number).map(|(d, _)| d).collect::<Vec<_>>(),
        )
    };
    let count = sensor.iter().max().map_or(0, |last| last + 1);
    let of_sensor = |k: usize| {
        let first = sensor.iter().position(|number| *number == k)?;
        of_number(&sensor, k).or_else(|| of_number(&channel, channel[first]))
    };
    let scatters: Vec<Option<Scatter>> = (0..count).map(of_sensor).collect();
    let Some(usual) = usual(&scatters, &sensor) else { return stiff };
    let beside = |number: usize| scatters[number].as_ref().map_or(1.0, |scatter| scatter.beside(&usual));
    sensor.iter().zip(stiff).map(|(&number, stiff)| beside(number).max(stiff)).collect()
}

/// The number of the sensor of each datum, and the least and the most that the noise of that can
/// be, m: it is no surer than its display, and none of its differences scatters by less, but by
/// chance.
pub fn sensors(data: &[Datum]) -> (Vec<usize>, Vec<(f64, f64)>) {
    let sensor = numbers(data, &stiff(data), Datum::sensor);
    let count = sensor.iter().max().map_or(0, |last| last + 1);
    let range = |number: usize| {
        let own: Vec<&Datum> =
            data.iter().zip(&sensor).filter(|(_, own)| **own == number).map(|(d, _)| d).collect();
        let most = lists(&own).iter().map(Scatter::most).fold(f64::INFINITY, f64::min);
        (OF_STEP * resolution(own), most)
    };
    let ranges: Vec<(f64, f64)> = (0..count).map(range).collect();
    let noise_range = sensor.iter().map(|&number| ranges[number]).collect();
    (sensor, noise_range)
}

/// For each measured load how much more it scatters than a displacement by that alone: along an
/// axis on which the rod is far stiffer it is the displacement that scatters, as much as the others
/// do at least. 1 of all else.
fn stiff(data: &[Datum]) -> Vec<f64> {
    let stiffer = stiffer(data).map(|stiffer| if stiffer > ALIKE { stiffer } else { 1.0 });
    let of_datum = |d: &Datum| if d.imposed.is_some() { stiffer[d.direction.axis.index()] } else { 1.0 };
    data.iter().map(of_datum).collect()
}

/// The number of what each datum was read by: `own` of an offset; there is one load cell, but loads
/// along a stiff axis are numbered apart.
fn numbers<K: Eq + Hash>(data: &[Datum], stiff: &[f64], own: impl Fn(&Datum) -> K) -> Vec<usize> {
    numbered(
        data.iter().zip(stiff).map(|(d, stiff)| {
            (d.imposed.is_none().then(|| own(d)), (*stiff > 1.0).then_some(d.direction.axis))
        }),
    )
}

/// By axis how much more a measured load, as it counts, is than the displacement that was imposed:
/// c/C, C the compliance along it; 1 where none was.
fn stiffer(data: &[Datum]) -> [f64; 3] {
    let largest = |axis: Axis, value: fn(&Datum) -> f64| {
        let own = data.iter().filter(|d| d.imposed.is_some() && d.direction.axis == axis);
        own.fold(0.0, |most: f64, datum| most.max(value(datum).abs()))
    };
    Axis::ALL.map(|axis| {
        let imposed = largest(axis, Datum::drive);
        if imposed > 0.0 { largest(axis, |datum| datum.measured) / imposed } else { 1.0 }
    })
}

/// What the header says of both, where both were read: √((c·s_F)² + (c/C·s)²)/s of a load, c what a
/// newton counts, C the compliance along its axis; c·s_F/s where that is known from several
/// readings, whose error is none of a single one.
fn stated(data: &[Datum], header: &RigHeader) -> Option<Vec<f64>> {
    let (noise, load_noise) = (header.noise.filter(|noise| *noise > 0.0)?, header.load_noise?);
    data.iter().any(|datum| datum.imposed.is_none()).then_some(())?;
    let stiffer = stiffer(data);
    let of_datum = |datum: &Datum| {
        let of_displacement = stiffer[datum.direction.axis.index()] * noise;
        let of_load = |imposed: Imposed| {
            let of_displacement = if imposed.known.has_noise_of_reading() { of_displacement } else { 0.0 };
            (imposed.per_newton * load_noise).hypot(of_displacement) / noise
        };
        datum.imposed.map_or(1.0, of_load)
    };
    Some(data.iter().map(of_datum).collect())
}

/// The scatter of one sensor.
struct Scatter {
    /// One standard deviation, m.
    sigma: f64,
    /// Differences that it was found from.
    count: usize,
}

impl Scatter {
    /// What it is at most, but by chance.
    fn most(&self) -> f64 {
        self.sigma * (SURE * OF_QUARTILE / (self.count as f64).sqrt()).exp()
    }

    /// Over that of another one; 1 where the two may be the same.
    fn beside(&self, other: &Scatter) -> f64 {
        let ratio = self.sigma / other.sigma;
        let chance = SURE * OF_QUARTILE * ((self.count as f64).recip() + (other.count as f64).recip()).sqrt();
        if ratio.ln().abs() > ALIKE.ln().max(chance) { ratio.max(SUREST) } else { 1.0 }
    }
}

/// The scatter of the reading in the middle, were all sorted by that of their sensors; of all
/// sensors that may have the same, together.
fn usual(scatters: &[Option<Scatter>], sensor: &[usize]) -> Option<Scatter> {
    let mut known: Vec<(&Scatter, usize)> = scatters
        .iter()
        .enumerate()
        .filter_map(|(k, own)| Some((own.as_ref()?, sensor.iter().filter(|number| **number == k).count())))
        .collect();
    known.sort_by(|a, b| a.0.sigma.total_cmp(&b.0.sigma));
    let all: usize = known.iter().map(|(_, count)| count).sum();
    let mut before = 0;
    let (middle, _) = *known.iter().find(|(_, count)| {
        before += count;
        2 * before >= all
    })?;
    let alike: Vec<&Scatter> =
        known.iter().map(|(own, _)| *own).filter(|own| own.beside(middle) == 1.0).collect();
    let count: usize = alike.iter().map(|own| own.count).sum();
    let square: f64 = alike.iter().map(|own| own.count as f64 * own.sigma.powi(2)).sum();
    Some(Scatter { sigma: (square / count as f64).sqrt(), count })
}

/// What the readings of one sensor scatter by, m: one standard deviation; `None` of too few.
pub fn scatter_of(own: &[&Datum]) -> Option<f64> {
    scatter(own).map(|scatter| scatter.sigma)
}

/// The same within a factor of two or so, of fewer readings.
pub fn about_scatter_of(own: &[&Datum]) -> Option<f64> {
    lists(own).iter().map(|scatter| scatter.sigma).min_by(f64::total_cmp)
}

/// Of the readings of one sensor; `None` of too few.
fn scatter(own: &[&Datum]) -> Option<Scatter> {
    let lists = lists(own);
    let is_enough = |scatter: &&Scatter| scatter.count >= FEWEST;
    let found = lists.iter().filter(is_enough).min_by(|a, b| a.sigma.total_cmp(&b.sigma))?;
    if lists.iter().any(|other| other.beside(found) < 1.0) {
        return None;
    }
    (found.sigma > 0.0).then_some(Scatter { ..*found })
}

/// What each kind of difference between the readings of one sensor scatters by, where there are
/// some.
fn lists(own: &[&Datum]) -> Vec<Scatter> {
    let by_axis = Axis::ALL.map(|axis| differences(axis, own));
    let of_list = |k: usize| {
        let of_axes = |left_out: Option<usize>| {
            let axes = (0..by_axis.len()).filter(|axis| Some(*axis) != left_out);
            quartile(&axes.flat_map(|axis| by_axis[axis][k].iter().copied()).collect::<Vec<f64>>())
        };
        let whole = of_axes(None)?;
        let others = (0..by_axis.len()).filter_map(|axis| of_axes(Some(axis)));
        let least = others.min_by(|a, b| a.sigma.total_cmp(&b.sigma));
        Some(least.filter(|least| least.beside(&whole) < ALONG_ONE).unwrap_or(whole))
    };
    let least = OF_STEP * resolution(own.iter().copied());
    let of_list = |k| of_list(k).map(|own| Scatter { sigma: own.sigma.max(least), ..own });
    (0..by_axis[0].len()).filter_map(of_list).collect()
}

fn quartile(differences: &[f64]) -> Option<Scatter> {
    let count = differences.len();
    (count >= FEWEST_AGAINST).then_some(())?;
    let mut sizes: Vec<f64> = differences.iter().map(|own| own.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    Some(Scatter { sigma: sizes[3 * count / 4] / NORMAL, count })
}

/// Of the readings under loads along an axis: about their neighbours, from run to run, and from
/// the way there to the way back.
fn differences(axis: Axis, own: &[&Datum]) -> [Vec<f64>; 3] {
    let mut ways: BTreeMap<_, Vec<&Datum>> = BTreeMap::new();
    for datum in own.iter().filter(|datum| datum.direction.axis == axis) {
        // there and back are two ways
        let is_back = datum.motion.map_or(datum.is_unloading(), |motion| motion.direction < 0.0);
        ways.entry((datum.stations(), is_back, datum.run)).or_default().push(datum);
    }
    for way in ways.values_mut() {
        way.sort_by(|a, b| a.drive().total_cmp(&b.drive()).then(a.order.cmp(&b.order)));
    }
    let smooth = ways.values().flat_map(|way| way.windows(3).map(of_neighbours)).collect();
    let mut repeats = Vec::new();
    let in_order: Vec<(_, &Vec<&Datum>)> = ways.iter().collect();
    for pair in in_order.windows(2) {
        let ((one, before), (other, after)) = (&pair[0], &pair[1]);
        if (one.0, one.1) == (other.0, other.1) {
            repeats.extend(of_repeats(before, after));
        }
    }
    let back = |(&(stations, is_back, run), there): (&(_, bool, usize), &Vec<&Datum>)| {
        let back = (!is_back).then(|| ways.get(&(stations, true, run))).flatten()?;
        Some(of_repeats(there, back))
    };
    let there_and_back: Vec<f64> = ways.iter().filter_map(back).flatten().collect();
    [smooth, repeats, there_and_back]
}

/// What a reading is off the line through its neighbours.
fn of_neighbours(three: &[&Datum]) -> f64 {
    let [x, y] = [Datum::drive, |datum: &Datum| datum.measured]
        .map(|value: fn(&Datum) -> f64| [value(three[0]), value(three[1]), value(three[2])]);
    let t = if x[2] > x[0] { (x[1] - x[0]) / (x[2] - x[0]) } else { 0.5 };
    (y[1] - (1.0 - t) * y[0] - t * y[2]) / (1.0 + (1.0 - t).powi(2) + t * t).sqrt()
}

/// What two ways through the same loads differ by, from load to load.
fn of_repeats(before: &[&Datum], after: &[&Datum]) -> Vec<f64> {
    let mut rest = after.iter().peekable();
    let mut differences = Vec::new();
    for one in before {
        while rest.peek().is_some_and(|other| other.drive() < one.drive()) {
            rest.next();
        }
        if let Some(other) = rest.next_if(|other| other.drive() == one.drive() && one.is_at_setting()) {
            differences.push(other.measured - one.measured);
        }
    }
    differences.windows(2).map(|pair| 0.5 * (pair[1] - pair[0])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;
    use crate::statistics::Random;

    /// A reading of a channel under a load (N) along an axis, in a trial.
    struct Read {
        trial: usize,
        axis: usize,
        channel: usize,
        load: f64,
    }

    /// By channel, of five trials along x, y and z: the first reading's. `noise` and `shape` are in
    /// µm.
    fn spread_of(noise: impl Fn(&Read) -> f64, shape: impl Fn(&Read) -> f64) -> [f64; 3] {
        spread_in(&recorded(5, 4, noise, shape))
    }

    /// Trials along x, y and z through loads that go up and down again.
    fn recorded(
        trials: usize,
        loads: usize,
        noise: impl Fn(&Read) -> f64,
        shape: impl Fn(&Read) -> f64,
    ) -> String {
        let mut random = Random::seeded(5, 0);
        let mut text = "trial,axis,load_n,phase,dx_um,dy_um,dz_um\n".to_owned();
        let up = (1..=loads).map(|load| (2 * load, "load"));
        let ways: Vec<_> = up.chain((1..loads).rev().map(|load| (2 * load, "unload"))).collect();
        for (trial, axis) in (0..trials).flat_map(|trial| (0..3).map(move |axis| (trial, axis))) {
            for &(load, phase) in &ways {
                text += &format!("{trial},{},{load},{phase}", Axis::ALL[axis]);
                for channel in 0..3 {
                    let read = Read { trial, axis, channel, load: load as f64 };
                    text += &format!(",{:.2}", shape(&read) + noise(&read) * random.normal());
                }
                text += "\n";
            }
        }
        text
    }

    fn spread_in(text: &str) -> [f64; 3] {
        let readings = Readings::from_text("f", text).unwrap();
        let data = datum::recorded(&readings);
        let spread = spread(&data, &readings.header);
        Axis::ALL.map(|axis| spread[data.iter().position(|d| d.channel == axis).unwrap()])
    }

    #[test]
    fn one_sensor_that_is_worse_has_a_noise_of_its_own() {
        let worse = |times: f64| move |read: &Read| if read.channel == 2 { times } else { 1.0 };
        let of_rod = |read: &Read| if read.channel == read.axis { 40.0 * read.load } else { 0.0 };
        assert_eq!(spread_of(worse(1.0), of_rod), [1.0; 3]);
        let [x, y, z] = spread_of(worse(6.0), of_rod);
        assert!(x == 1.0 && y == 1.0 && (4.5..8.0).contains(&z), "{z}");
    }

    #[test]
    fn what_repeats_is_no_noise_and_neither_is_what_one_axis_makes() {
        let even = |_: &Read| 1.0;
        // bent as no line is, the same in all trials
        let bent = |read: &Read| if read.channel == 2 { 60.0 * (1.3 * read.load).sin() } else { 0.0 };
        assert_eq!(spread_of(even, bent), [1.0; 3]);
        // and on both ways of a run
        assert_eq!(spread_in(&recorded(1, 10, even, bent)), [1.0; 3]);
        // where few loads were repeated, too
        assert_eq!(spread_in(&recorded(1, 6, even, bent)), [1.0; 3]);
        // each run with a zero and a slope of its own
        let drifting = |read: &Read| {
            let run = (3 * read.trial + read.axis) as f64;
            if read.channel == 2 { (40.0 + 5.0 * read.load) * (2.0 * run).sin() } else { 0.0 }
        };
        assert_eq!(spread_of(even, drifting), [1.0; 3]);
        // a rod that rattles along z is no sensor that does
        let rattles = |read: &Read| if read.channel == 2 && read.axis == 2 { 9.0 } else { 1.0 };
        assert_eq!(spread_of(rattles, |_| 0.0), [1.0; 3]);
    }

    /// Along an axis on which the rod is twenty times stiffer 0.5 µm of the displacement are as
    /// much as 10 µm along the other.
    #[test]
    fn loads_along_a_stiff_axis_scatter_by_the_displacement() {
        let mut random = Random::seeded(7, 0);
        let mut rows = String::new();
        for axis in [0, 2] {
            for k in [1, 2, 3, 4, 5, 4, 3, 2, 1].repeat(5) {
                let c = if axis == 0 { 2.5 } else { 50.0 };
                let (load, u) = (2.0 * f64::from(k) + 0.004 * random.normal(), 2.0 * c * f64::from(k));
                let read = |channel: usize, u: f64| if channel == axis { u } else { 0.0 };
                let [x, y, z] = [0, 1, 2].map(|channel| read(channel, u) + 0.5 * random.normal());
                rows += &format!("{},{load:.3},{x:.2},{y:.2},{z:.2}\n", Axis::ALL[axis]);
            }
        }
        let of_axis = |noise: &str| {
            let head = "axis,load_n,dx_um,dy_um,dz_um";
            let text = format!("# driven = displacement\n{noise}{head}\n{rows}");
            let readings = Readings::from_text("f", &text).unwrap();
            let data = datum::recorded(&readings);
            let spread = spread(&data, &readings.header);
            [Axis::X, Axis::Z].map(|axis| {
                spread[data.iter().position(|d| d.imposed.is_some() && d.direction.axis == axis).unwrap()]
            })
        };
        let [stiff, soft] = of_axis("");
        assert!((18.0..28.0).contains(&stiff) && soft == 1.0, "{stiff} {soft}");
        let [stiff, soft] = of_axis("# noise_um = 0.5\n# noise_n = 0.004\n");
        // settings that recur are known better than one reading says: what is left is the load's
        assert!((18.0..23.0).contains(&stiff) && (0.38..0.42).contains(&soft), "{stiff} {soft}");
    }

    #[test]
    fn a_load_cell_is_a_sensor_and_what_is_stated_of_both_is_known() {
        let mut random = Random::seeded(6, 0);
        let mut rows = String::new();
        for _ in 0..4 {
            for k in [1, 2, 3, 4, 3, 2, 1] {
                let (u, load) = (100.0 * f64::from(k), 2.0 * f64::from(k) + 0.1 * random.normal());
                let [x, y, z] = [0.0, 0.0, u].map(|at| at + 0.5 * random.normal());
                rows += &format!("z,{load:.3},{x:.2},{y:.2},{z:.2}\n");
            }
        }
        let text =
            |noise: &str| format!("# driven = displacement\n{noise}axis,load_n,dx_um,dy_um,dz_um\n{rows}");
        // 0.1 N of 50 µm/N, against 0.5 µm
        let [x, y, loads] = spread_in(&text(""));
        assert!(x == 1.0 && y == 1.0 && (7.0..13.0).contains(&loads), "{loads}");
        let [x, _, loads] = spread_in(&text("# noise_um = 2\n# noise_n = 0.03\n"));
        // means of what was imposed, whose own errors all loads of one share: 0.03 N of 50 µm/N
        assert!(x == 1.0 && (loads - 0.75).abs() < 0.03, "{loads}");
    }
}
