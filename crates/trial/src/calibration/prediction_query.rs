//! Poses that are asked for and not measured: where the ball would have been, free in space, with
//! another force on it and, on a rod, with a heavier ball.
//!
//! A campaign of its own beside the recorded one, without points. Its clock goes on after the
//! recording, in a room that may have become warmer. It begins with the first recorded pose, so
//! that the move that led there is known, and what it asks depends on the protocol alone: it says
//! nothing of the effect.

use nalgebra::{DMatrix, DVector, Vector3};

use super::arm::turned;
use super::draw::direction;
use super::effect::Effect;
use super::numbers::{drives, numbers};
use super::rod::Rod;
use super::setup::pose;
use super::site::{Devices, Row, Site};
use super::{nuisance, text};
use crate::ground_truth::PredictionQuery;
use crate::rig::drawing::{Drawing, rounded};
use rodcal_base::linalg::transposed_product;
use rodcal_base::statistics::Random;
use rodcal_base::units::UM;

/// Poses.
const COUNT: usize = 30;
/// Force on the ball, N, and mass that a ball has more, kg.
const FORCE: (f64, f64) = (1.0, 3.0);
const HEAVIER: (f64, f64) = (0.05, 0.3);
/// How much warmer or colder the room became, K.
const WARMER: f64 = 3.0;
/// Standard deviation of the size of an effect of which nothing is known, noises.
const ANY_SIZE: f64 = 1e4;

/// What is asked.
pub struct Query {
    /// The first recorded row, and all that are asked for.
    site: Site,
    /// Force on the ball as the file states it, N: in the world, or in {0} where nobody knows that.
    force: Vector3<f64>,
}

/// What is asked of whoever recorded at `recorded`.
pub fn draw(recorded: &Site, random: &mut Random) -> Query {
    let force = (direction(random) * random.uniform(FORCE.0, FORCE.1)).map(|f| rounded(f, 2));
    let heavier = rounded(random.uniform(HEAVIER.0, HEAVIER.1), 3);
    let rod = recorded.rod.as_ref().map(|rod| {
        let tip_mass = rounded(rod.drawing.tip_mass + heavier, 3);
        Rod::of(Drawing { tip_mass, ..rod.drawing.clone() }, rod.actual.clone())
    });
    let first = recorded.rows[0].clone();
    let (mut time, warmer) =
        (recorded.rows.last().map_or(0.0, |row| row.time), random.uniform(-WARMER, WARMER));
    let temperature = rounded(recorded.rows.last().map_or(20.0, |row| row.temperature) + warmer, 2);
    let mut site = Site {
        rod,
        // free in space
        devices: Devices::Tracker(match recorded.devices {
            Devices::Tracker(at) => at,
            _ => Vector3::zeros(),
        }),
        clamp_sd: None,
        clamps_off: Vec::new(),
        contact: if recorded.has_sockets() { turned(&recorded.base, &force) } else { force },
        rows: vec![Row { group: 0, ..first.clone() }],
        ..recorded.clone()
    };
    for k in 0..COUNT {
        time = rounded(time + random.uniform(15.0, 45.0), 1);
        site.rows.push(Row { q: first.q.clone(), group: 0, aside: Vector3::zeros(), time, temperature });
        if k > 0 {
            site.rows[k + 1].q = pose(&site, k + 1, random);
        }
    }
    Query { site, force }
}

impl Query {
    /// The files that ask.
    pub fn files(&self) -> Vec<(String, String)> {
        text::query(&self.site, &self.force)
    }

    /// Where the ball would be, and what an oracle says that knows which effects there are and
    /// where, and fits their numbers, together with all that the calibration is free to change and
    /// the numbers of the files, each known as these state, to a recording with this `noise`: to
    /// first order, from the truth.
    pub fn truth(&self, recorded: &Site, effects: &[Effect], noise: &[Vector3<f64>]) -> PredictionQuery {
        let truth = self.queried(&afterwards(effects));
        let is_known = !effects.is_empty() && !effects.iter().any(Effect::is_beyond);
        let error = is_known.then(|| self.error(recorded, effects, noise)).flatten();
        let um = |all: DVector<f64>| -> Vec<f64> { all.iter().map(|m| rounded(m / UM, 5)).collect() };
        PredictionQuery {
            oracle_um: error.map(|error| um(&truth + error)),
            true_um: um(truth),
            is_any_frame: recorded.has_sockets(),
        }
    }

    /// Coordinates of the rows that are asked for, m.
    fn queried(&self, effects: &[Effect]) -> DVector<f64> {
        of_query(&self.site.each(|row, q| self.site.ball(row, q, effects)))
    }

    /// J′·(AᵀA + 1)⁻¹·(Aᵀn + o): by how much the noise n, and the files' numbers that are off by o,
    /// mislead the oracle, m. A, J′: what its parameters do to the recorded and to these rows.
    fn error(&self, recorded: &Site, effects: &[Effect], noise: &[Vector3<f64>]) -> Option<DVector<f64>> {
        let (absorbed, mut off) = nuisance::columns(recorded);
        let rows = absorbed.nrows();
        let mut columns: Vec<DVector<f64>> = absorbed.column_iter().map(Into::into).collect();
        let numbers = numbers(&self.site, &drives(recorded));
        let mut queried: Vec<DVector<f64>> =
            numbers.into_iter().map(|number| of_query(&number.column)).collect();
        // where clamps and sockets are concerns no other pose
        queried.resize(columns.len(), DVector::zeros(3 * COUNT));
        let known = self.queried(&afterwards(effects));
        for (which, effect) in effects.iter().enumerate() {
            for larger in effect.larger() {
                let own = recorded.added(std::slice::from_ref(&larger), std::slice::from_ref(effect));
                let own = recorded.whitened(&own).resize_vertically(rows, 0.0);
                if own.norm() == 0.0 {
                    continue;
                }
                let scale = ANY_SIZE / own.norm();
                let mut all = effects.to_vec();
                all[which] = larger;
                columns.push(own * scale);
                queried.push((self.queried(&afterwards(&all)) - &known) * scale);
                off.push(0.0);
            }
        }
        let columns = DMatrix::from_columns(&columns);
        let normal = transposed_product(&columns, &columns) + DMatrix::identity(off.len(), off.len());
        // a ball is read off by its noise, or sits in a socket off by it
        let sign = if recorded.has_sockets() { -1.0 } else { 1.0 };
        let noise = DVector::from_iterator(3 * noise.len(), noise.iter().flat_map(|n| <[f64; 3]>::from(*n)));
        let noise = recorded.whitened(&noise).resize_vertically(rows, 0.0) * sign;
        let right = columns.tr_mul(&noise) + DVector::from_vec(off);
        let parameters = normal.cholesky()?.solve(&right);
        let mut error = DVector::zeros(3 * COUNT);
        for (column, parameter) in queried.iter().zip(parameters.iter()) {
            error += column * *parameter;
        }
        Some(error)
    }
}

/// What is left of effects after the recording.
fn afterwards(effects: &[Effect]) -> Vec<Effect> {
    effects.iter().filter_map(Effect::afterwards).collect()
}

/// Without the first row, which was recorded.
fn of_query(all: &DVector<f64>) -> DVector<f64> {
    all.rows(3, all.len() - 3).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::draw::{LIBRARY, library, needs};
    use crate::calibration::setup;

    /// A site that can carry an effect of the library, and the effect.
    fn site(effect: usize, seed: u64) -> (Site, Effect) {
        let mut random = Random::seeded(seed, 0);
        let mut site = setup::draw(needs(effect), &[], &mut random);
        site.scatter.step = 0.0;
        let effect = library(effect, &site, &mut random).scaled(0.1);
        (site, effect)
    }

    /// A site whose files are right.
    fn as_its_files(mut site: Site) -> Site {
        site.real.iter_mut().for_each(|link| link.compliance = 0.0);
        site.nominal = site.real.clone();
        site.clamps_off.iter_mut().for_each(|off| *off = Vector3::zeros());
        site.rod = site.rod.map(|rod| Rod::of(rod.drawing, Default::default()));
        site
    }

    fn norm(coordinates_um: &[f64], others: &[f64]) -> f64 {
        coordinates_um.iter().zip(others).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn what_is_asked_was_not_recorded() {
        for seed in 0..4 {
            let (site, _) = site(11, seed);
            let query = draw(&site, &mut Random::seeded(seed, 1));
            let rows = &query.site.rows[1..];
            assert_eq!((rows.len(), &rows[0].q), (COUNT, &site.rows[0].q));
            assert!(rows[1..].iter().all(|row| site.rows.iter().all(|known| known.q != row.q)));
            assert!(rows[0].time > site.rows.last().unwrap().time);
            assert!(query.site.contact.norm() > 0.9 && query.site.contact != site.contact);
            let mass = |site: &Site| site.rod.as_ref().unwrap().drawing.tip_mass;
            assert!(mass(&query.site) > mass(&site) + 0.04);
            let files = query.files();
            assert_eq!(files.len(), 3);
            assert!(files.iter().all(|(_, text)| text.starts_with("# SIMULATED")));
        }
    }

    #[test]
    fn an_oracle_is_misled_by_the_files_numbers_and_in_proportion_to_the_noise() {
        // every third effect: 15 is the one that shows in no position
        for effect in (0..LIBRARY).step_by(3).filter(|effect| *effect != 15) {
            let (mut site, effect) = site(effect, 3);
            let query = draw(&site, &mut Random::seeded(3, 1));
            let effects = [effect];
            let noise = site.errors(0, &mut Random::seeded(4, 0));
            let says = |site: &Site, times: f64| {
                let noise: Vec<_> = noise.iter().map(|n| n * times).collect();
                query.truth(site, &effects, &noise)
            };
            let [none, once, twice] = [0.0, 1.0, 2.0].map(|times| says(&site, times).oracle_um.unwrap());
            let moved = norm(&once, &none);
            assert!(moved > 1.0, "{effects:?} {moved}");
            assert!((norm(&twice, &none) / moved - 2.0).abs() < 1e-3, "{effects:?}");
            // with files that are right nothing misleads but noise
            site = as_its_files(site);
            let right = says(&site, 0.0);
            let error = norm(&right.true_um, &right.oracle_um.unwrap());
            assert!(error < 1e-3, "{effects:?}: {error}");
        }
    }

    #[test]
    fn noise_that_looks_like_another_arm_is_taken_for_it() {
        // measured by a tracker, so that noise is what a coordinate is more by
        let (mut site, effect) = (0..20)
            .map(|seed| site(0, seed))
            .find(|(s, _)| matches!(s.devices, Devices::Tracker(_)))
            .unwrap();
        site.scatter.sd = 1e-6;
        site = as_its_files(site);
        let query = draw(&site, &mut Random::seeded(3, 1));
        let mut other = site.clone();
        other.real[2].numbers[0] += 2e-5;
        other.tool.y += 3e-5;
        let Effect::Transmission { joint, mut waves, beat } = effect.clone() else { panic!("a gear") };
        waves[0][1] += 1e-5;
        let larger = Effect::Transmission { joint, waves, beat };
        let ball = |site: &Site, row: usize, effect: &Effect| {
            site.ball(row, &site.rows[row].q, std::slice::from_ref(effect))
        };
        let noise: Vec<Vector3<f64>> =
            (0..site.rows.len()).map(|row| ball(&other, row, &larger) - ball(&site, row, &effect)).collect();
        let truth = query.truth(&site, &[effect], &noise);
        let other_query = Query {
            site: Site { real: other.real, tool: other.tool, ..query.site.clone() },
            force: query.force,
        };
        let others = other_query.truth(&site, &[larger], &noise).true_um;
        let moved = norm(&truth.true_um, &others);
        let left = norm(&truth.oracle_um.unwrap(), &others);
        assert!(moved > 100.0 && left < 0.01 * moved, "{left} of {moved}");
    }
}
