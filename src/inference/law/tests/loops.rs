//! Laws with a loop along a way that nobody recorded.

use super::another_way::way;
use super::*;
use crate::linalg::least_squares;

/// Up to 12 N and down, with a smaller loop within, three times.
fn loads() -> Vec<f64> {
    let up = (1..=12).map(f64::from);
    let within = (5..=11).rev().chain(6..=12).map(f64::from);
    let down = (0..=11).rev().map(f64::from);
    up.chain(within).chain(down).collect()
}

fn looped() -> Site {
    let run = loads();
    let count = 3 * run.len();
    let course = |trial: usize| {
        let instant = |i: usize| Instant { data: vec![trial * run.len() + i], elapsed: 1.0, sense: 1.0 };
        Course { instants: (0..run.len()).map(instant).collect(), start: 0.0 }
    };
    let [own] = site(&DVector::zeros(0)).try_into().unwrap();
    let moves = (0..count).map(|i| if i % run.len() == 0 { 1.0 } else { 0.0 });
    let moves = moves.enumerate().map(|(i, first)| {
        let k = i % run.len();
        if first > 0.0 || run[k] > run[k - 1] { 1.0 } else { -1.0 }
    });
    Site {
        directions: vec![(String::new(), vec![1.0; count])],
        values: run.repeat(3),
        moves: moves.collect(),
        courses: (0..3).map(course).collect(),
        forms: Form::GIVING_WAY,
        ..own
    }
}

/// What a memory makes of a site, in so many units.
fn made(memory: Memory, constant: f64, site: &Site) -> DVector<f64> {
    DVector::from_vec(memory.remembered(site, constant).0) * 4.0
}

/// What three stops do where the load turns round elsewhere is as near to the law, of whatever
/// memory, as it says of itself: 20 recordings, 17 at least.
#[test]
fn a_law_with_a_loop_says_how_far_off_it_may_be_elsewhere() {
    let site = looped();
    let truth = (Memory::Stops(Stops::new(&[(0.12, 0.4), (0.4, 0.35)])), 0.5);
    let run = loads().len();
    let wave =
        |row: usize, k: usize| (std::f64::consts::PI * k as f64 * (row % run) as f64 / run as f64).cos();
    let (mut held, mut known) = (0, 0);
    for seed in 0..20 {
        let mut model = Columns::new(3 * run);
        let slope = DMatrix::from_fn(3 * run, 1, |row, _| site.values[row] / 12.0);
        model.add("slope", "here", slope, false);
        model.add("curve", "load", DMatrix::from_fn(3 * run, 8, wave), true);
        let mut random = Random::seeded(40 + seed, 0);
        let read = made(truth.0, truth.1, &site).map(|own| own + random.normal());
        let evidence = Evidence {
            replicate_group: (0..3 * run).map(|row| row % run).collect(),
            fold: (0..3 * run).map(|row| row / run).collect(),
            ..Evidence::new(read)
        };
        let found = propose(&model, &diagnose(&model, &evidence), &|_| vec![site.clone()]);
        let Some(Ok(law)) = found.map(|found| found.law) else { continue };
        let Some(open) = law.another_way else { continue };
        let off = |site: &Site| {
            let followed = law.memory.remembered(site, law.values.1).0.into_iter();
            let own = DVector::from_iterator(site.values.len(), followed.map(|x| law.at(0, x)));
            own - made(truth.0, truth.1, site)
        };
        // zeros and stiffnesses take up a straight line
        let line = |site: &Site| {
            DMatrix::from_fn(site.values.len(), 2, |i, j| if j == 0 { 1.0 } else { site.values[i] })
        };
        let taken = least_squares(&line(&site), &off(&site)).unwrap();
        let elsewhere = way(&site);
        known += 1;
        held += usize::from((off(&elsewhere) - line(&elsewhere) * taken).amax() <= open);
    }
    assert!(known >= 15 && held * 20 >= 17 * known, "{held} of {known}");
}
