//! What becomes of the weights that hang on a rig: the force that the rod carries at each loading.

use nalgebra::Vector3;

use super::Bench;
use crate::rig::direction::direction;
use crate::rig::effect::Effect;
use crate::rig::load_history::{Plays, friction_after, slipped_after};
use crate::rig::protocol::Loading;

/// A travel over which friction turns round that no reading shows, m.
const AT_ONCE: f64 = 1e-9;

impl Bench {
    /// The force that the rod carries at each loading, N.
    pub(super) fn forces(&self, effects: &[Effect]) -> Vec<Vector3<f64>> {
        let mut felt = self.hanging(effects);
        for effect in effects {
            match *effect {
                Effect::Friction { axis, force, presliding, scatter } => {
                    self.rub(&mut felt, axis, &|_| force, (presliding, scatter));
                }
                Effect::Hysteresis { fraction, is_exercised } => self.lag(&mut felt, fraction, is_exercised),
                Effect::Damping { share, time } => self.damp(&mut felt, share, time),
                Effect::LoadBefore(share) => self.follow_load_before(&mut felt, share),
                Effect::WearingFriction { first, last } => {
                    let last_run = self.protocol.loadings.iter().map(|l| l.run).max().unwrap_or(0).max(1);
                    let force = |l: &Loading| first + (last - first) * l.run as f64 / last_run as f64;
                    self.rub(&mut felt, None, &force, (AT_ONCE, 0.0));
                }
                Effect::SpeedOfLoading(share) => self.hurry(&mut felt, share),
                _ => {}
            }
        }
        for effect in effects {
            for load in &mut felt {
                match *effect {
                    Effect::Cubic(k) => *load *= 1.0 + k * *load * *load,
                    Effect::Quadratic(k) => *load *= 1.0 + k * load.abs(),
                    Effect::GapCloses { load: closed, share } if *load > closed => {
                        *load = closed + share * (*load - closed);
                    }
                    _ => {}
                }
            }
        }
        let loadings = self.protocol.loadings.iter().zip(felt);
        loadings.map(|(loading, load)| direction(effects, loading) * load).collect()
    }

    /// What hangs there: the nominal load and what is wrong with it, N.
    fn hanging(&self, effects: &[Effect]) -> Vec<f64> {
        let of_loading = |loading: &Loading| {
            let offsets = effects.iter().map(|effect| match *effect {
                Effect::LoadOffset { axis, force } if loading.is_along(axis) => force,
                _ => 0.0,
            });
            // nothing hangs on an unloaded rod, no hanger either
            let scale = self.actual.load_scale();
            if loading.load > 0.0 { scale * loading.load + offsets.sum::<f64>() } else { 0.0 }
        };
        self.protocol.loadings.iter().map(of_loading).collect()
    }

    /// Friction takes its share of the loads on the way up and holds them on the way down.
    fn rub(
        &self,
        felt: &mut [f64],
        axis: Option<usize>,
        force: &dyn Fn(&Loading) -> f64,
        (presliding, scatter): (f64, f64),
    ) {
        let compliance = self.compliance();
        let (mut z, mut hung, mut held) = (0.0, 0.0, 0.0);
        let loadings = &self.protocol.loadings;
        for (index, loading) in loadings.iter().enumerate() {
            if self.is_first(index) {
                (z, hung, held) = (0.0, 0.0, 0.0);
            }
            if !loading.is_along(axis) {
                continue;
            }
            let hanging = felt[index];
            z = friction_after(z, force(loading), (hanging - hung) * compliance[loading.axis], presliding);
            let mut carried = hanging - z * (1.0 + scatter * self.sticking[index]);
            if loading.is_unloading {
                // a slide that sticks holds the rod where it was
                carried = carried.min(held);
            } else if loading.load == 0.0 || carried * hanging < 0.0 {
                carried = 0.0;
            }
            (hung, held, felt[index]) = (hanging, carried, carried);
        }
    }

    /// True where a load hangs on an empty hanger: the first of a run, or each one in any order.
    fn is_first(&self, index: usize) -> bool {
        let loadings = &self.protocol.loadings;
        let of_index = |index: usize| loadings.get(index).map(|l| (l.run, l.sign));
        index == 0 || of_index(index - 1) != of_index(index) || self.protocol.is_shuffled
    }

    /// How far what slips little by little has come at a loading since its run began, N.
    pub(super) fn slipped(&self, index: usize, numbers: (f64, f64, f64)) -> f64 {
        let first = (0..=index).rev().find(|&k| self.is_first(k)).unwrap_or(0);
        let (mut z, mut hung) = (0.0, 0.0);
        for loading in &self.protocol.loadings[first..=index] {
            z = slipped_after(z, loading.load - hung, numbers);
            hung = loading.load;
        }
        z
    }

    /// A part of each change of the load is still to come when the display is read.
    fn damp(&self, felt: &mut [f64], share: f64, time: f64) {
        let hanging = felt.to_vec();
        for (index, loading) in self.protocol.loadings.iter().enumerate() {
            let before = if self.is_first(index) { 0.0 } else { hanging[index - 1] };
            let waited = loading.time - loading.changed;
            felt[index] -= share * (hanging[index] - before) * (-waited / time).exp();
        }
    }

    /// What was loaded just before, of the same run, adds its share.
    fn follow_load_before(&self, felt: &mut [f64], share: f64) {
        let hanging = felt.to_vec();
        let loadings = &self.protocol.loadings;
        for index in 1..felt.len() {
            if loadings[index - 1].run == loadings[index].run {
                felt[index] *= 1.0 + share * hanging[index - 1] / self.full_scale;
            }
        }
    }

    /// A rod that is loaded fast is softer, or stiffer, by a share.
    fn hurry(&self, felt: &mut [f64], share: f64) {
        let (hanging, loadings) = (felt.to_vec(), &self.protocol.loadings);
        for index in 1..felt.len() {
            let (loading, before) = (&loadings[index], &loadings[index - 1]);
            if self.is_first(index) || before.run != loading.run {
                continue;
            }
            let took = (loading.time - before.time).max(1.0);
            let speed = (hanging[index] - hanging[index - 1]).abs() / took;
            felt[index] *= 1.0 + share * (1.0 + speed / (1e-3 * self.full_scale)).log10();
        }
    }

    fn lag(&self, felt: &mut [f64], fraction: f64, is_exercised: bool) {
        let new = || Plays::new(fraction, self.full_scale, is_exercised);
        let mut plays = [[new(), new()], [new(), new()], [new(), new()]];
        // what a run reads unloaded; of sensors that are zeroed once, what its axis read at first
        let mut zeros = [[None; 2]; 3];
        let mut last = usize::MAX;
        for (loading, load) in self.protocol.loadings.iter().zip(felt) {
            let way = usize::from(loading.sign < 0.0);
            let of_axis = &mut plays[loading.axis][way];
            let key = 2 * loading.run + way;
            if last != key && !self.protocol.zeroed_once {
                zeros[loading.axis][way] = None;
            }
            last = key;
            let zero: f64 = *zeros[loading.axis][way].get_or_insert_with(|| of_axis.load(0.0));
            *load = of_axis.load(*load) - zero;
        }
    }
}
