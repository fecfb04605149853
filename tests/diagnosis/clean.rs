//! Where nothing is wrong, nothing is found.

use rodcal::parallel::in_parallel;
use rodcal::units::UM;
use rodcal_trial::rig::Order;

use super::Answer;

/// Recordings of each kind.
const SEEDS: usize = 40;

/// 300 recordings with normal noise and a display in steps. At most 2 % are to be found wrong: of
/// 300 with that rate more than 12 are in one of 100 times (binomial, 99 %).
#[test]
fn clean_recordings_stay_clean() {
    let orders = [
        Order { axes: vec![1, 2], ..Order::default() },
        Order {
            axes: vec![1, 2],
            unloading: false,
            trials: 4,
            noise: 3.0 * UM,
            quantum: UM,
            ..Order::default()
        },
        // the display is coarser than the noise
        Order {
            axes: vec![1, 2],
            unloading: false,
            all_channels: false,
            noise: UM,
            quantum: 2.0 * UM,
            ..Order::default()
        },
    ];
    let wrong: Vec<String> = in_parallel(orders.len() * SEEDS, |k| {
        let seed = 1000 + k as u64;
        let answer = Answer::made(&orders[k / SEEDS], &[], seed);
        (!answer.is_consistent()).then(|| format!("seed {seed}: {}", answer.json["headline"]))
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(wrong.len() <= 5, "{} of 120: {wrong:#?}", wrong.len());
}
