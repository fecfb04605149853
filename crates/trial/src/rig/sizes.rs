//! How large an effect is: the numbers that somebody who knows its law and its place has to find
//! out.

use super::bench::Bench;
use super::effect::{Dimension, Effect};
use rodcal_base::units::{DEG, UM};

/// Largest force of friction or of a load's offset, N, and largest share of the smallest load.
const FORCE: (f64, f64) = (2.0, 0.7);

/// Of one pipe's stiffness, of a length and of a rod's whole length, as shares.
pub(super) const PIPE: f64 = 0.5;
pub(super) const LENGTH: f64 = 0.1;
pub(super) const POINT: f64 = 0.12;
/// Of the angle between the pipes, rad.
pub(super) const ANGLE: f64 = 6.0 * DEG;

impl Effect {
    /// Its sizes, 0 for no effect, each with the upper end of the range that it is drawn from.
    /// Nothing for what belongs to single rows and for physics that no library has.
    pub(super) fn sizes(&self, bench: &Bench) -> Vec<(f64, f64)> {
        let (full, smallest) = (bench.full_scale, bench.protocol.smallest_load());
        let [bends, twists] = bench.drawing.rotation();
        match *self {
            Effect::StiffnessScale(factor) => vec![(factor - 1.0, 0.4)],
            Effect::ShearModulus(factor) => vec![(factor - 1.0, 0.6)],
            Effect::Joint { bending, torsion, .. } | Effect::Root { bending, torsion } => {
                vec![(bending, bends), (torsion, twists)]
            }
            Effect::Bend(factor) => {
                let oval = bench.drawing.tubes[0].ovalisation(bench.drawing.bend_radius);
                vec![(factor - 1.0, 2.0 * (oval - 1.0))]
            }
            Effect::PipeStiffness { factor, .. } => vec![(factor - 1.0, PIPE)],
            Effect::Dimension { which: Dimension::Leg(_), stated, by } => vec![(by, LENGTH * stated)],
            Effect::Dimension { which: Dimension::Angle, by, .. } => vec![(by, ANGLE)],
            Effect::Point { by, .. } => vec![(by, POINT * bench.drawing.length())],
            Effect::Friction { force, .. } => vec![(force, FORCE.0.min(FORCE.1 * smallest))],
            Effect::LoadOffset { force, .. } => vec![(force, FORCE.0)],
            Effect::Backlash { play, .. } => vec![(play, 100.0 * UM)],
            Effect::Creep { per_decade, .. } => vec![(per_decade, 0.1)],
            Effect::Hysteresis { fraction, .. } => vec![(fraction, 0.1)],
            Effect::Cubic(k) => vec![(k, 0.2 / (full * full))],
            Effect::Quadratic(k) => vec![(k, 0.2 / full)],
            Effect::SensorScale { factor, .. } => vec![(factor - 1.0, 0.2)],
            Effect::SensorMisalignment { angle, .. } | Effect::LoadMisalignment { angle, .. } => {
                vec![(angle, 10.0 * DEG)]
            }
            Effect::SensorBlock(turn) | Effect::LoadFrame(turn) => {
                turn.map(|angle| (angle, 10.0 * DEG)).to_vec()
            }
            Effect::Drift { rate, by_time, .. } => {
                vec![(rate, 50.0 * UM / if by_time { 3600.0 } else { 1.0 })]
            }
            Effect::DriftOfAll { rates, by_time } => {
                rates.map(|rate| (rate, 50.0 * UM / if by_time { 3600.0 } else { 1.0 })).to_vec()
            }
            _ => Vec::new(),
        }
    }

    /// The same effect with its `which`-th size changed by so much.
    pub(super) fn resized(&self, which: usize, by: f64) -> Effect {
        let mut effect = self.clone();
        match &mut effect {
            Effect::Joint { torsion, .. } | Effect::Root { torsion, .. } if which == 1 => *torsion += by,
            Effect::Joint { bending: size, .. }
            | Effect::Root { bending: size, .. }
            | Effect::StiffnessScale(size)
            | Effect::ShearModulus(size)
            | Effect::Bend(size)
            | Effect::PipeStiffness { factor: size, .. }
            | Effect::Dimension { by: size, .. }
            | Effect::Point { by: size, .. }
            | Effect::Friction { force: size, .. }
            | Effect::LoadOffset { force: size, .. }
            | Effect::Backlash { play: size, .. }
            | Effect::Creep { per_decade: size, .. }
            | Effect::Hysteresis { fraction: size, .. }
            | Effect::Cubic(size)
            | Effect::Quadratic(size)
            | Effect::SensorScale { factor: size, .. }
            | Effect::SensorMisalignment { angle: size, .. }
            | Effect::LoadMisalignment { angle: size, .. }
            | Effect::Drift { rate: size, .. } => *size += by,
            Effect::SensorBlock(sizes)
            | Effect::LoadFrame(sizes)
            | Effect::DriftOfAll { rates: sizes, .. } => {
                sizes[which] += by;
            }
            _ => {}
        }
        effect
    }

    /// The same effect with this share of its size.
    pub(super) fn scaled(&self, share: f64) -> Effect {
        let mut effect = self.clone();
        match &mut effect {
            Effect::StiffnessScale(factor)
            | Effect::ShearModulus(factor)
            | Effect::Bend(factor)
            | Effect::PipeStiffness { factor, .. }
            | Effect::SensorScale { factor, .. } => *factor = 1.0 + share * (*factor - 1.0),
            Effect::GapCloses { share: stiff, .. } => *stiff = 1.0 + share * (*stiff - 1.0),
            Effect::Joint { bending, torsion, .. } | Effect::Root { bending, torsion } => {
                *bending *= share;
                *torsion *= share;
            }
            Effect::Dimension { by: size, .. }
            | Effect::Point { by: size, .. }
            | Effect::Friction { force: size, .. }
            | Effect::LoadOffset { force: size, .. }
            | Effect::Backlash { play: size, .. }
            | Effect::Creep { per_decade: size, .. }
            | Effect::Hysteresis { fraction: size, .. }
            | Effect::Cubic(size)
            | Effect::Quadratic(size)
            | Effect::SensorMisalignment { angle: size, .. }
            | Effect::LoadMisalignment { angle: size, .. }
            | Effect::Drift { rate: size, .. }
            | Effect::Slip { by: size, .. }
            | Effect::Shift { by: size, .. }
            | Effect::Ripple { amplitude: size, .. }
            | Effect::Seat(size)
            | Effect::RunningIn { share: size, .. }
            | Effect::LooseClamp(size)
            | Effect::Waviness { amplitude: size, .. }
            | Effect::LoadBefore(size)
            | Effect::SpeedOfLoading(size)
            | Effect::Damping { share: size, .. }
            | Effect::SlippingClamp { per_newton: size, .. } => *size *= share,
            Effect::SensorBlock(sizes)
            | Effect::LoadFrame(sizes)
            | Effect::DriftOfAll { rates: sizes, .. }
            | Effect::Oscillation { amplitude: sizes, .. } => {
                sizes.iter_mut().for_each(|size| *size *= share)
            }
            Effect::Outlier(cells) => cells.iter_mut().for_each(|(_, size)| *size *= share),
            Effect::WearingFriction { first, last } => {
                *first *= share;
                *last *= share;
            }
            // a limit has no size of its own
            Effect::Saturation { .. } => {}
        }
        effect
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::bench::tests::bench;
    use crate::rig::{beyond, draw};
    use rodcal_base::statistics::Random;

    #[test]
    fn every_effect_of_the_library_has_its_sizes_within_the_range() {
        let (bench, mut random) = (bench(), Random::seeded(3, 0));
        for number in (0..draw::LIBRARY - 1).filter(|number| *number != 4) {
            let effect = draw::library(number, &bench, &mut random);
            let sizes = effect.sizes(&bench);
            assert!(!sizes.is_empty(), "{effect:?}");
            for (k, (size, most)) in sizes.into_iter().enumerate() {
                // torsion goes up to three times bending's share
                assert!(size.abs() <= 3.0 * most, "{effect:?}");
                let larger = effect.resized(k, most).sizes(&bench)[k].0;
                assert!((larger - size - most).abs() < 1e-12 * most, "{effect:?}");
            }
        }
        assert!(Effect::Outlier(vec![(0, 1.0)]).sizes(&bench).is_empty());
    }

    #[test]
    fn half_an_effect_does_half_as_much() {
        let (bench, mut random) = (bench(), Random::seeded(4, 0));
        let clean = bench.readings(&[]);
        let library = (0..draw::LIBRARY).filter(|number| *number != 4);
        let of_library = library.map(|number| draw::library(number, &bench, &mut random).scaled(0.1));
        let mut effects: Vec<Effect> = of_library.collect();
        let mut random = Random::seeded(5, 0);
        effects
            .extend((0..beyond::BEYOND).map(|number| beyond::draw(number, &bench, &mut random).scaled(0.1)));
        for effect in effects {
            let added = |share: f64| -> Vec<f64> {
                let with = bench.readings(&[effect.scaled(share)]);
                with.iter().zip(&clean).map(|(a, b)| a - b).collect()
            };
            let (whole, half) = (added(1.0), added(0.5));
            let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            let off: Vec<f64> = half.iter().zip(&whole).map(|(half, whole)| half - 0.5 * whole).collect();
            // a slide turns round within its presliding: more than half
            let within = if matches!(effect, Effect::Friction { .. }) { 0.2 } else { 0.05 };
            assert!(norm(&off) <= within * norm(&whole), "{effect:?} {} {}", norm(&off), norm(&whole));
        }
    }
}
