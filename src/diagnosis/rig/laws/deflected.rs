//! What each datum has of load and deflection, whichever of the two was set.
//!
//! Weights are hung and deflections read, or displacements are imposed and loads read. A place
//! changes the deflection at a load, w metres for a unit of its law; where the displacement u was
//! imposed, the load is what gives way to it:
//!
//! ```text
//! u = C·F + w·g      →      c₀·F = c₀·u/C − (c₀/C)·w·g
//! ```
//!
//! where c₀ is what a newton of what was measured counts, so that one list of places serves both.
//! Beside an imposed displacement other sensors show C′·F + w·g of the load that was measured, as
//! they do under hung ones.

use std::collections::BTreeMap;

use nalgebra::DVector;

use crate::diagnosis::rig::model::RigModel;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::law::Site;
use crate::rod::Rod;
use crate::spatial::Axis;

/// Stations so near to each other are one, m: none is stated to a nanometre.
const SAME: f64 = 1e-9;

/// One number for each datum.
pub struct Deflected {
    /// 1 or −1: which way along the axis of the load.
    pub sense: Vec<f64>,
    /// The load that way, N: what hung, or what bends the rod as far as was imposed. A law of the
    /// load as it was measured would explain its noise by itself.
    pub load: Vec<f64>,
    /// What the sensor's place is displaced by, as far as that is known, m.
    pub read: Vec<f64>,
    /// What a newton more that way displaces it by, m/N.
    pub slope: Vec<f64>,
    /// The deflection along the load where it acts, m; NaN where nothing reads it.
    pub along: Vec<f64>,
    /// The datum of its instant that reads it, and its sign there.
    pub along_by: Vec<Option<(usize, f64)>>,
    /// The datum that has drive and history of its instant: itself, but beside what was imposed.
    pub driven: Vec<usize>,
    /// What was measured, per metre of deflection at the same load: 1, or −c₀/C.
    per_metre: Vec<f64>,
    /// True where displacements were imposed.
    pub is_imposed: bool,
}

type Line = (Axis, Axis, [u64; 2]);

impl Deflected {
    /// Of a recording, given what is known to change each datum, m.
    pub fn new(model: &RigModel, change: &DVector<f64>) -> Deflected {
        let data = &model.data;
        let bare = model.deflections();
        let known: Vec<f64> = bare.iter().zip(change.iter()).map(|(u, more)| u + more).collect();
        let mut all = Deflected {
            sense: data.iter().map(|d| f64::from(d.direction.sign)).collect(),
            load: data.iter().map(|d| d.load).collect(),
            slope: slopes(data, &bare, change),
            along: vec![f64::NAN; data.len()],
            along_by: vec![None; data.len()],
            driven: (0..data.len()).collect(),
            per_metre: vec![1.0; data.len()],
            is_imposed: data.iter().any(|d| d.imposed.is_some()),
            read: known,
        };
        match all.is_imposed {
            true => all.impose(model),
            false => all.find_along(model),
        }
        all
    }

    /// Where displacements were imposed.
    fn impose(&mut self, model: &RigModel) {
        let data = &model.data;
        // u² and u·c₀·F of each line
        let mut sums: BTreeMap<Line, [f64; 2]> = BTreeMap::new();
        for (d, known) in data.iter().zip(&self.read) {
            if let Some(imposed) = d.imposed {
                let sum = sums.entry(d.line_key()).or_default();
                sum[0] += imposed.displacement.powi(2);
                sum[1] += imposed.displacement * known;
            }
        }
        for (i, d) in data.iter().enumerate() {
            let Some(imposed) = d.imposed else { continue };
            let [square, product] = sums[&d.line_key()];
            // c₀/C; nothing is known of a line that was not displaced
            let ratio = if square > 0.0 { product / square } else { 0.0 };
            let compliance = if ratio == 0.0 { 0.0 } else { imposed.per_newton / ratio };
            let u = imposed.set;
            let sense = if u == 0.0 { self.sense[i] } else { u.signum() };
            self.sense[i] = sense;
            self.read[i] = u;
            self.along[i] = u.abs();
            self.load[i] = if compliance == 0.0 { 0.0 } else { sense * u / compliance };
            self.slope[i] = sense * compliance;
            self.per_metre[i] = -ratio;
        }
        for &(i, imposed) in &model.course.beside {
            let sense = self.sense[imposed];
            self.slope[i] *= self.sense[i] * sense;
            self.sense[i] = sense;
            self.load[i] = self.load[imposed];
            self.along[i] = self.along[imposed];
            self.driven[i] = imposed;
        }
    }

    /// Where weights were hung: by the sensors along them, where they hang.
    fn find_along(&mut self, model: &RigModel) {
        type Place = (Axis, i64);
        let data = &model.data;
        // a station at the tip may be stated, or not
        let tip = model.rod.as_ref().map_or(f64::INFINITY, Rod::length);
        let station = |station: Option<f64>| (station.unwrap_or(tip).min(tip) / SAME).round() as i64;
        let place = |d: &Datum| -> Place { (d.direction.axis, station(d.load_station)) };
        let mut compliance: BTreeMap<Place, f64> = BTreeMap::new();
        let mut shown: BTreeMap<(usize, usize, Place), usize> = BTreeMap::new();
        for (i, d) in data.iter().enumerate() {
            if d.channel == d.direction.axis && station(d.load_station) == station(d.read_station) {
                compliance.insert(place(d), self.sense[i] * self.slope[i]);
                shown.insert((d.run, d.order, place(d)), i);
            }
        }
        for (i, d) in data.iter().enumerate() {
            if let Some(compliance) = compliance.get(&place(d)) {
                self.along[i] = compliance * self.load[i];
            }
            let by = shown.get(&(d.run, d.order, place(d)));
            self.along_by[i] = by.map(|&k| (k, self.sense[k]));
        }
    }

    /// The load along the positive axis, N.
    pub fn signed_load(&self, i: usize) -> f64 {
        self.sense[i] * self.load[i]
    }

    /// A number of each datum as that has it which was driven.
    pub fn as_driven(&self, values: &[f64]) -> Vec<f64> {
        self.driven.iter().map(|&i| values[i]).collect()
    }

    /// The site with what a unit of its law does to what was measured, its directions being what
    /// it does to the deflection.
    pub fn as_measured(&self, mut site: Site) -> Site {
        if self.is_imposed {
            for (_, weights) in &mut site.directions {
                weights.iter_mut().zip(&self.per_metre).for_each(|(weight, per_metre)| *weight *= per_metre);
            }
            // the drive is exact: nothing stands for it
            site.recorded = None;
        }
        site
    }
}

/// What a newton that bends the rod, the way the load points, moves each datum by, m/N: what it
/// shows without findings and nominal numbers at this load, and on average what these `change` of
/// that. Friction, loops and offsets among them are no compliance.
fn slopes(data: &[Datum], bare: &[f64], change: &DVector<f64>) -> Vec<f64> {
    // bare·F, change·F and F² of each
    let mut sums: BTreeMap<Line, [f64; 3]> = BTreeMap::new();
    for (i, d) in data.iter().enumerate() {
        let (load, sum) = (d.signed_load(), sums.entry(d.line_key()).or_default());
        sum[0] += bare[i] * load;
        sum[1] += change[i] * load;
        sum[2] += load * load;
    }
    let slope = |(i, d): (usize, &Datum)| {
        let [own, more, square] = sums[&d.line_key()];
        if square == 0.0 {
            return 0.0;
        }
        let own = if d.load > 0.0 { bare[i] / d.signed_load() } else { own / square };
        f64::from(d.direction.sign) * (own + more / square)
    };
    data.iter().enumerate().map(slope).collect()
}
