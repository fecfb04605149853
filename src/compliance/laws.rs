//! What the laws of a rod's file add to its displacement under a load that hangs now.
//!
//! ```text
//! rod, load          C·F̂·ΔF(|F|)                      F̂ = F/|F|
//! rod, deflection    C·F̂·ΔF(u)                        u = F̂ᵀ·C_F·F̂·(|F| + ΔF(u)), C_F where the load acts
//! rod, load along    C·F·s(±F)                        where the load is along one axis
//! root, joint        (θ(|M|)·M̂) × (p − x)             M the moment at x, p what is read
//! clamp, load        F̂·Δu(|F|)                        of the rig
//! sensor             Δy(y)                            of the rig: see `rig::fit`
//! ```
//!
//! M is that of the load and of the weight beyond x. A law was recorded from the zero of a rod that
//! bore its weight already: it is taken to be one of the moment, whatever the moment is of.

use nalgebra::{Matrix3, Vector3};

use super::Compliance;
use crate::rod::constants::covariance;
use crate::rod::law::should_show;
use crate::rod::{LawVariable, Rod, RodLaw, RodLawPlace};
use crate::units::{PERCENT, STANDARD_GRAVITY, UM, URAD};

/// The laws of a rod between a station that is loaded and one that is read.
#[derive(Debug, Clone)]
pub struct StaticLaws {
    acting: Vec<Acting>,
}

#[derive(Debug, Clone)]
struct Acting {
    law: RodLaw,
    /// From a joint to what is loaded and to what is read, m; nothing of other places.
    levers: Option<[Vector3<f64>; 2]>,
    /// What the rod's weight turns the joint by, kg·m: Σ m·(x_m − x).
    moved: Vector3<f64>,
}

impl StaticLaws {
    /// Those that are the rod's own, at its tip: what it has wherever it is mounted.
    pub fn of_tip(rod: &Rod) -> StaticLaws {
        let tip = rod.length();
        let mut laws = StaticLaws::between(rod, tip, tip);
        laws.acting.retain(|acting| acting.law.is_of_rod());
        laws
    }

    /// All but those of sensors, between two stations, m.
    pub fn between(rod: &Rod, load: f64, read: f64) -> StaticLaws {
        let acting = |law: &RodLaw| {
            if !law.is_static() {
                return None;
            }
            let station = match &law.place {
                RodLawPlace::Rod | RodLawPlace::Clamp | RodLawPlace::Slide => None,
                RodLawPlace::Root => Some(0.0),
                RodLawPlace::Bend => Some(rod.bend_middle()),
                RodLawPlace::Joint(name) => Some(rod.joints.iter().find(|own| own.name == *name)?.station),
                RodLawPlace::Sensor(_) => return None,
            };
            // what is beyond a joint alone is turned by it, and turns it
            if station.is_some_and(|station| station > load.min(read)) {
                return None;
            }
            let levers = station.map(|station| {
                let lever = |s: f64| rod.point(s) - rod.point(station);
                [lever(load), lever(read)]
            });
            let moved = station.map_or_else(Vector3::zeros, |station| static_moment(rod, station));
            Some(Acting { law: law.clone(), levers, moved })
        };
        StaticLaws { acting: rod.laws.iter().filter_map(acting).collect() }
    }

    /// True where there are none.
    pub fn is_empty(&self) -> bool {
        self.acting.is_empty()
    }

    /// The laws themselves.
    pub fn laws(&self) -> impl Iterator<Item = &RodLaw> {
        self.acting.iter().map(|acting| &acting.law)
    }

    /// What they add to the displacement where the load acts, under a force (N) and gravity (in g),
    /// all in {T}, m; `compliance` is the rod's without them, there, m/N.
    pub fn displacement(
        &self,
        compliance: &Matrix3<f64>,
        force: &Vector3<f64>,
        gravity: &Vector3<f64>,
    ) -> Vector3<f64> {
        self.displacement_between([compliance, compliance], force, gravity)
    }

    /// The same of what is read elsewhere; the rod's compliance from the load to there, and where
    /// the load acts.
    pub fn displacement_between(
        &self,
        compliance: [&Matrix3<f64>; 2],
        force: &Vector3<f64>,
        gravity: &Vector3<f64>,
    ) -> Vector3<f64> {
        self.acting.iter().map(|acting| acting.displacement(compliance, force, gravity)).sum()
    }

    /// The compliance that a load of this size (N) along each axis, and 1 g along each axis, meet:
    /// displacement over load, m/N and m per g. With laws it depends on the load.
    pub fn secant(&self, linear: &Compliance, load: f64) -> Compliance {
        let mut secant = *linear;
        let none = Vector3::zeros();
        for axis in 0..3 {
            let unit = Vector3::ith(axis, 1.0);
            let under_load = self.displacement(&linear.force, &(unit * load), &none);
            let under_weight = self.displacement(&linear.force, &none, &unit);
            secant.force.set_column(axis, &(linear.force.column(axis) + under_load / load));
            secant.gravity.set_column(axis, &(linear.gravity.column(axis) + under_weight));
        }
        secant
    }

    /// Standard uncertainty of [`StaticLaws::secant`] that the constants of the laws bring with
    /// them, to first order:
    ///
    /// ```text
    /// u² = J·Σ·Jᵀ       Σ = covariance of a law's constants, J by central differences over ±u
    /// ```
    pub fn secant_uncertainty(&self, linear: &Compliance, load: f64) -> Compliance {
        let zero = Compliance { force: Matrix3::zeros(), gravity: Matrix3::zeros() };
        let mut square = zero;
        for (number, acting) in self.acting.iter().enumerate() {
            let constants = &acting.law.constants;
            let by_unit: Vec<Compliance> = constants
                .iter()
                .enumerate()
                .map(|(k, own)| {
                    let u = own.standard_uncertainty;
                    let shifted = |sign: f64| {
                        let mut laws = self.clone();
                        laws.acting[number].law.constants[k].value += sign * u;
                        laws.secant(linear, load)
                    };
                    let [more, less] = [1.0, -1.0].map(shifted);
                    let slope = |a: f64, b: f64| if u > 0.0 { 0.5 * (a - b) / u } else { 0.0 };
                    Compliance {
                        force: more.force.zip_map(&less.force, slope),
                        gravity: more.gravity.zip_map(&less.gravity, slope),
                    }
                })
                .collect();
            let covariance = covariance(constants);
            for (i, a) in by_unit.iter().enumerate() {
                for (j, b) in by_unit.iter().enumerate() {
                    square.force += a.force.component_mul(&b.force) * covariance[(i, j)];
                    square.gravity += a.gravity.component_mul(&b.gravity) * covariance[(i, j)];
                }
            }
        }
        let root = |entry: f64| entry.max(0.0).sqrt();
        Compliance { force: square.force.map(root), gravity: square.gravity.map(root) }
    }

    /// The largest load at the tip (N) that the laws were recorded with, each by its own variable;
    /// `compliance` is the rod's there, m/N.
    pub fn recorded_load(&self, compliance: &Matrix3<f64>) -> Option<f64> {
        let stiffest = compliance.diagonal().min();
        let of_acting = |acting: &Acting| match (acting.levers, acting.law.variable) {
            (Some([lever, _]), _) => acting.law.range.1 / lever.norm(),
            (None, LawVariable::Deflection) => acting.law.range.1 * UM / stiffest,
            (None, _) => acting.law.range.1,
        };
        self.acting.iter().map(of_acting).filter(|load| load.is_finite()).reduce(f64::max)
    }

    /// Those that a load and gravity take beyond what was recorded: law and value of its variable;
    /// `compliance` is the rod's where the load acts, m/N.
    pub fn beyond(
        &self,
        compliance: &Matrix3<f64>,
        force: &Vector3<f64>,
        gravity: &Vector3<f64>,
    ) -> Vec<(&RodLaw, f64)> {
        let beyond = |acting: &'_ Acting| {
            acting.variable(compliance, force, gravity).filter(|&x| acting.law.is_beyond(x))
        };
        self.acting.iter().filter_map(|acting| Some((&acting.law, beyond(acting)?))).collect()
    }
}

impl Acting {
    fn moment(&self, force: &Vector3<f64>, gravity: &Vector3<f64>) -> Vector3<f64> {
        // M = (p − x) × F + Σ m·(x_m − x) × g
        let of_load = self.levers.map_or_else(Vector3::zeros, |[load, _]| load.cross(force));
        of_load + self.moved.cross(&(gravity * STANDARD_GRAVITY))
    }

    /// The variable in its unit; `None` of a load along no axis.
    fn variable(
        &self,
        compliance: &Matrix3<f64>,
        force: &Vector3<f64>,
        gravity: &Vector3<f64>,
    ) -> Option<f64> {
        let along = |sign: f64| {
            let largest = force.iter().copied().reduce(|a, b| if b.abs() > a.abs() { b } else { a })?;
            (force.norm() == largest.abs()).then_some(sign * largest)
        };
        match self.law.variable {
            LawVariable::Load => Some(force.norm()),
            LawVariable::AlongPositive => along(1.0),
            LawVariable::AlongNegative => along(-1.0),
            LawVariable::Moment => Some(self.moment(force, gravity).norm()),
            LawVariable::Deflection => {
                let along = force.try_normalize(0.0).unwrap_or_default();
                let per_newton = along.dot(&(compliance * along)) / UM;
                // u of u − C·ΔF(u) = C·F
                Some(should_show(per_newton * force.norm(), |u| -per_newton * self.law.at(u, 1.0)))
            }
            _ => None,
        }
    }

    fn displacement(
        &self,
        [compliance, at_load]: [&Matrix3<f64>; 2],
        force: &Vector3<f64>,
        gravity: &Vector3<f64>,
    ) -> Vector3<f64> {
        let Some(x) = self.variable(at_load, force, gravity) else { return Vector3::zeros() };
        let value = self.law.at(x, 1.0);
        // a formula may be no number where it was not recorded, which `beyond` says
        if !value.is_finite() {
            return Vector3::zeros();
        }
        let along = |vector: Vector3<f64>| vector.try_normalize(0.0).unwrap_or_default();
        match (self.levers, &self.law.place) {
            (Some([_, read]), _) => (along(self.moment(force, gravity)) * (value * URAD)).cross(&read),
            (None, RodLawPlace::Clamp) => along(*force) * (value * UM),
            (None, _) if self.law.variable.adds_load() => compliance * along(*force) * value,
            (None, _) => compliance * force * (value * PERCENT),
        }
    }
}

/// Σ m·(x_m − x) of all that is beyond a station, kg·m.
fn static_moment(rod: &Rod, station: f64) -> Vector3<f64> {
    const PARTS: usize = 64;
    let origin = rod.point(station);
    let is_arc = |middle: f64| (rod.bend_start()..rod.bend_end()).contains(&middle);
    let mut moment = Vector3::zeros();
    for [from, to] in rod.stretches() {
        let from = from.max(station);
        // straight pieces by their middle, arcs by many
        let parts = if is_arc(0.5 * (from + to)) { PARTS } else { 1 };
        let step = (to - from) / parts as f64;
        for middle in (0..parts).filter(|_| step > 0.0).map(|k| from + (k as f64 + 0.5) * step) {
            let mass: f64 = rod.bearing_at(middle).map(|pipe| pipe.mass_per_length() * step).sum();
            moment += (rod.point(middle) - origin) * mass;
        }
    }
    for mass in rod.masses.iter().filter(|mass| mass.station > station) {
        moment += (rod.point(mass.station) - origin) * mass.mass;
    }
    moment + (rod.tip() - origin) * rod.tip_mass
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::Physics;
    use crate::compliance::{Compliance, DEFAULT_ELEMENTS};
    use crate::rod::{Joint, LawConstant, Pipe};
    use crate::section::Round;

    fn rod() -> Rod {
        Rod::from_toml("rod", include_str!("../../rods/5.toml")).unwrap().with_mass("ring", 0.3, 0.2)
    }

    fn proportional(place: RodLawPlace, variable: LawVariable, slope: f64) -> RodLaw {
        let constant = LawConstant {
            name: "c".into(),
            value: slope,
            standard_uncertainty: 0.1 * slope,
            correlation: Vec::new(),
            unit: String::new(),
        };
        let formula = format!("c*{}", variable.symbol());
        RodLaw::new(place, variable, formula, vec![constant], (0.0, 10.0)).unwrap()
    }

    /// A sleeve weighs on what is before it, and by what of it is beyond, on what is within.
    #[test]
    fn what_is_beyond_a_station_has_its_moment() {
        let bare = rod();
        let collar = Pipe::new(Round::tube(0.036, 0.032), bare.pipe1.material.clone());
        let sleeved = bare.clone().with_sleeve("collar", 0.25, 0.35, collar.clone());
        let more = |station: f64| static_moment(&sleeved, station) - static_moment(&bare, station);
        for (station, from) in [(0.05, 0.25), (0.25, 0.25), (0.28, 0.28), (0.36, 0.36)] {
            let length = f64::max(0.35 - from, 0.0);
            let middle = bare.point(0.5 * (from + 0.35)) - bare.point(station);
            let expected = middle * (collar.mass_per_length() * length);
            assert!((more(station) - expected).norm() < 1e-15, "{station}");
        }
    }

    /// A turn that is proportional to the moment is a compliant joint, under loads and weight.
    #[test]
    fn a_proportional_turn_is_a_joint() {
        for (place, station) in [("root", 0.0), ("sleeve", 0.4)] {
            let joint = |compliance| Joint {
                name: "sleeve".into(),
                station,
                bending: compliance,
                torsion: compliance,
            };
            let of_rod =
                |rod: &Rod| Compliance::of_model(rod, &Physics::default(), DEFAULT_ELEMENTS).unwrap();
            let (plain, soft) = (rod().with_joint(joint(0.0)), rod().with_joint(joint(20e-6)));
            let mut with_law = plain.clone();
            with_law.laws.push(proportional(RodLawPlace::named(place), LawVariable::Moment, 20.0));
            let laws = StaticLaws::of_tip(&with_law);
            let (force, gravity) = (Vector3::new(1.0, -2.0, 3.0), Vector3::new(0.3, 0.5, -0.8));
            let (before, after) = (of_rod(&plain), of_rod(&soft));
            let expected = (after.force - before.force) * force + (after.gravity - before.gravity) * gravity;
            let found = laws.displacement(&before.force, &force, &gravity);
            assert!((found - expected).norm() < 1e-6 * expected.norm(), "{found} for {expected}");
        }
    }

    #[test]
    fn a_share_of_the_load_is_a_share_of_the_deflection() {
        let compliance = Compliance::of_model(&rod(), &Physics::default(), DEFAULT_ELEMENTS).unwrap().force;
        let mut with_law = rod();
        with_law.laws.push(proportional(RodLawPlace::Rod, LawVariable::Load, 0.1));
        with_law.laws.push(proportional(RodLawPlace::Clamp, LawVariable::Load, 5.0));
        let force = Vector3::new(1.0, -2.0, 2.0);
        let laws = StaticLaws::of_tip(&with_law);
        let found = laws.displacement(&compliance, &force, &Vector3::zeros());
        assert!((found - compliance * force * 0.1).norm() < 1e-15);
        // each constant to a tenth of it
        let linear = Compliance { force: compliance, gravity: Matrix3::zeros() };
        let u = laws.secant_uncertainty(&linear, 2.0);
        assert!(
            (u.force - compliance.abs() * 0.01).amax() < 1e-12 && u.gravity.amax() < 1e-15,
            "{}",
            u.force
        );
        assert!(laws.beyond(&compliance, &force, &Vector3::zeros()).is_empty());
        assert_eq!(laws.beyond(&compliance, &(force * 4.0), &Vector3::zeros())[0].1, 12.0);
        // of the rig 5 µm/N along the load besides
        let tip = with_law.length();
        let of_rig = StaticLaws::between(&with_law, tip, tip);
        let more = of_rig.displacement(&compliance, &force, &Vector3::zeros()) - found;
        assert!((more - force * 5e-6).norm() < 1e-15);
    }
}
