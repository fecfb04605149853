//! Mistakes of whoever writes things down: units, signs, names, zeros, sensors, files. The rod and
//! what was done with it are right; the files are not. In a third of the cases it is a part of the
//! rows that is wrong (`part.rs`).

use super::actual::Actual;
use super::bench::Bench;
use super::drawing::{Drawing, rounded};
use super::protocol::{AXES, Cell};
use super::written::{self, Written};
use crate::chance::{happens, one_of};
use crate::effect_name::EffectName;
use crate::place::Place;
use rodcal_base::statistics::Random;
use rodcal_base::units::{STANDARD_GRAVITY, UM};

/// What is written wrongly; factors are true over written.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs, reason = "fields are in the words of their mistakes")]
pub enum Mistake {
    /// Loads in another unit.
    Loads { factor: f64 },
    /// Some channels in another unit.
    Readings { channels: Vec<usize>, factor: f64 },
    /// A channel the wrong way round.
    Flip(usize),
    /// Names of two channels exchanged.
    Channels([usize; 2]),
    /// Names of two axes of the loads exchanged.
    Axes([usize; 2]),
    /// L1 and L2 exchanged in the rod file.
    Legs,
    /// Radii for diameters in the rod file.
    Radii,
    /// A channel that shows the same value always, m.
    Stuck { channel: usize, at: f64 },
    /// A channel that is cut off on either side, m.
    Saturated { channel: usize, limit: f64 },
    /// A zero that was not taken: of a run, or of all; m.
    Zero { channel: usize, run: Option<usize>, by: f64 },
    /// Another rod's file; the right one stands beside it under this name.
    Rod { file: String, drawn: Box<Drawing> },
    /// One of the others, in these trials alone.
    InTrials { trials: Vec<usize>, what: Box<Mistake> },
    /// A load that was typed wrongly, N, and the right one.
    Typed { loading: usize, load: f64, right: f64 },
    /// The readings of a trial stand in the place of those of another one.
    Copied { from: usize, to: usize },
}

/// Kinds of mistakes of the whole recording, or of one zero, by number.
pub(super) const WHOLE: usize = 13;
/// What readings of the rod of the file must be off by, of their size, for a mistake to show.
const VISIBLE: f64 = 0.3;
/// What a sensor shows of the largest deflection of the recording, at least, for what it does to
/// matter.
const MOVES: f64 = 0.05;
/// Readings that a sensor cuts off at least.
const CUT: usize = 4;

pub(super) const POUND_FORCE: f64 = 4.448_221_615_260_5;
const POUND: f64 = 0.453_592_37;
/// mm, inches and thousandths of an inch, in µm.
pub(super) const LENGTHS: [f64; 3] = [1e3, 25.4e3, 25.4];

/// A mistake of this number; nothing where the recording has no place for it.
pub(super) fn of_kind(
    number: usize,
    written: &Written,
    other: &mut dyn FnMut(&mut Random) -> Drawing,
    random: &mut Random,
) -> Option<Mistake> {
    let protocol = &written.protocol;
    let (axes, channels) = (protocol.axes(), protocol.read_channels());
    // a channel along a load: the others may have nothing to show
    let along = |random: &mut Random| one_of(random, &axes, 0);
    let largest = |channel: usize| {
        let of_channel =
            protocol.cells().into_iter().zip(&written.shown).filter(|(c, _)| c.channel == channel);
        of_channel.fold(0.0, |most: f64, (_, shown)| most.max(shown.abs()))
    };
    let sign = |random: &mut Random| if happens(random, 0.5) { -1.0 } else { 1.0 };
    Some(match number {
        0 => {
            let units: &[f64] = match protocol.columns.kilograms {
                true => &[1.0 / STANDARD_GRAVITY, 1e-3, POUND],
                false => &[STANDARD_GRAVITY, STANDARD_GRAVITY, 1e-3 * STANDARD_GRAVITY, POUND_FORCE],
            };
            Mistake::Loads { factor: one_of(random, units, STANDARD_GRAVITY) }
        }
        1 => Mistake::Readings { channels, factor: one_of(random, &LENGTHS, 1e3) },
        2 => Mistake::Readings { channels: vec![along(random)], factor: one_of(random, &LENGTHS, 1e3) },
        3 | 4 => Mistake::Flip(along(random)),
        5 => Mistake::Channels(pair(&channels, random)?),
        6 => Mistake::Axes(pair(&axes, random)?),
        7 => Mistake::Legs,
        8 => Mistake::Radii,
        9 => {
            let channel = along(random);
            let at = rounded(random.uniform(-0.5, 0.5) * largest(channel) / UM, 1) * UM;
            Mistake::Stuck { channel, at }
        }
        10 => {
            let channel = along(random);
            let of_run = |l: &&super::protocol::Loading| l.axis == channel;
            let runs: Vec<usize> = protocol.loadings.iter().filter(of_run).map(|l| l.run).collect();
            let run = happens(random, 0.5).then(|| one_of(random, &runs, 0));
            let by = sign(random) * random.uniform(0.4, 1.5) * largest(channel);
            Mistake::Zero { channel, run, by: rounded(by / UM, 1) * UM }
        }
        11 => {
            let channel = along(random);
            let limit = rounded(random.uniform(0.4, 0.85) * largest(channel) / UM, 0) * UM;
            Mistake::Saturated { channel, limit }
        }
        _ => {
            let file = one_of(random, &["rod-2.toml", "rod-3.toml"], "rod-2.toml").into();
            Mistake::Rod { file, drawn: Box::new(other(random)) }
        }
    })
}

/// Two of these, in their order.
pub(super) fn pair(choices: &[usize], random: &mut Random) -> Option<[usize; 2]> {
    let first = random.index(choices.len());
    let second = (first + 1 + random.index(choices.len().checked_sub(1)?)) % choices.len();
    let (a, b) = (*choices.get(first)?, *choices.get(second)?);
    (a != b).then_some([a.min(b), a.max(b)])
}

impl Mistake {
    /// Its name.
    pub fn name(&self) -> EffectName {
        match self {
            Mistake::Loads { .. } | Mistake::Readings { .. } | Mistake::Radii => EffectName::UnitMistake,
            Mistake::Flip(_) => EffectName::SignMistake,
            Mistake::Channels(_) | Mistake::Axes(_) | Mistake::Legs => EffectName::SwapMistake,
            Mistake::Stuck { .. } => EffectName::StuckSensor,
            Mistake::Saturated { .. } => EffectName::SaturatedSensor,
            Mistake::Zero { .. } => EffectName::OffsetMistake,
            Mistake::Rod { .. } => EffectName::RodMistake,
            Mistake::InTrials { what, .. } => what.name(),
            Mistake::Typed { .. } => EffectName::TypingMistake,
            Mistake::Copied { .. } => EffectName::CopyMistake,
        }
    }

    /// Columns, keys or files as they stand there.
    pub fn place(&self, written: &Written) -> Place {
        let column = |channel: &usize| format!("d{}_um", AXES[*channel]);
        let pipe = |pipe: &str| format!("{pipe}.outer_diameter_mm, {pipe}.inner_diameter_mm");
        Place::key(&match self {
            Mistake::Loads { .. } if written.protocol.columns.kilograms => "load_kg".into(),
            Mistake::Loads { .. } => "load_n".into(),
            Mistake::Readings { channels, .. } => channels.iter().map(column).collect::<Vec<_>>().join(", "),
            Mistake::Flip(channel)
            | Mistake::Stuck { channel, .. }
            | Mistake::Saturated { channel, .. }
            | Mistake::Zero { channel, .. } => column(channel),
            Mistake::Channels([a, b]) => format!("{} and {}", column(a), column(b)),
            Mistake::Axes([a, b]) => format!("axis {} and {}", AXES[*a], AXES[*b]),
            Mistake::Legs => "l1_mm and l2_mm".into(),
            Mistake::Radii => format!("{}, {}", pipe("pipe1"), pipe("pipe2")),
            Mistake::Rod { file, .. } => file.clone(),
            Mistake::InTrials { trials, what } => {
                let whole = what.place(written).key.map(String::from).unwrap_or_default();
                written::in_trials(&whole, trials, &written.protocol)
            }
            Mistake::Typed { loading, .. } => {
                let column = if written.protocol.columns.kilograms { "load_kg" } else { "load_n" };
                format!("{column}, row {}", loading + 1)
            }
            Mistake::Copied { to, .. } => format!("trial {}", to + 1),
        })
    }

    /// Its numbers, by their names at the boundary.
    pub fn parameters(&self) -> Vec<(&'static str, f64)> {
        match self {
            Mistake::Loads { factor } | Mistake::Readings { factor, .. } => vec![("factor", *factor)],
            Mistake::Radii => vec![("factor", 2.0)],
            Mistake::Zero { by, .. } => vec![("um", by / UM)],
            Mistake::Stuck { at, .. } => vec![("um", at / UM)],
            Mistake::Saturated { limit, .. } => vec![("um", limit / UM)],
            Mistake::InTrials { what, .. } => what.parameters(),
            Mistake::Typed { right, .. } => vec![("n", *right)],
            _ => Vec::new(),
        }
    }

    /// What is written with it.
    pub fn applied_to(&self, written: &Written) -> Written {
        let mut wrong = written.clone();
        let cells = written.protocol.cells();
        let change = |shown: &mut Vec<f64>, wrong: &dyn Fn(&Cell, f64) -> f64| {
            cells.iter().zip(shown).for_each(|(cell, value)| *value = wrong(cell, *value));
        };
        match self {
            Mistake::Loads { factor } => {
                wrong.protocol.loadings.iter_mut().for_each(|l| l.load /= factor);
            }
            Mistake::Readings { channels, factor } => change(&mut wrong.shown, &|cell, value| {
                if channels.contains(&cell.channel) { value / factor } else { value }
            }),
            Mistake::Flip(channel) => change(&mut wrong.shown, &|cell, value| {
                if cell.channel == *channel { -value } else { value }
            }),
            Mistake::Stuck { channel, at } => change(&mut wrong.shown, &|cell, value| {
                if cell.channel == *channel { *at } else { value }
            }),
            Mistake::Saturated { channel, limit } => change(&mut wrong.shown, &|cell, value| {
                if cell.channel == *channel { value.clamp(-limit, *limit) } else { value }
            }),
            Mistake::Zero { channel, run, by } => change(&mut wrong.shown, &|cell, value| {
                let is_run = run.is_none_or(|run| run == written.protocol.loadings[cell.loading].run);
                if cell.channel == *channel && is_run { value + by } else { value }
            }),
            Mistake::Channels(pair) => {
                let mut values = written.shown.iter();
                wrong.shown.clear();
                for read in &mut wrong.protocol.channels {
                    let mut row = [0, 1, 2].map(|k| read[k].then(|| values.next().copied()).flatten());
                    row.swap(pair[0], pair[1]);
                    read.swap(pair[0], pair[1]);
                    wrong.shown.extend(row.into_iter().flatten());
                }
            }
            Mistake::Axes([a, b]) => {
                for loading in &mut wrong.protocol.loadings {
                    loading.axis = match loading.axis {
                        axis if axis == *a => *b,
                        axis if axis == *b => *a,
                        axis => axis,
                    };
                }
            }
            Mistake::Legs => wrong.drawing.legs.reverse(),
            Mistake::Radii => {
                for tube in &mut wrong.drawing.tubes {
                    (tube.outer, tube.inner) = (tube.outer / 2.0, tube.inner / 2.0);
                }
            }
            Mistake::Rod { file, drawn } => {
                let right = std::mem::replace(&mut wrong.drawing, (**drawn).clone());
                wrong.others.retain(|(name, _)| name != file);
                wrong.others.push((file.clone(), right));
            }
            Mistake::InTrials { trials, what } => {
                let is_of = |k: usize| trials.contains(&written.protocol.loadings[k].trial);
                wrong = written::merged(written, &what.applied_to(written), is_of);
            }
            Mistake::Typed { loading, load, .. } => wrong.protocol.loadings[*loading].load = *load,
            Mistake::Copied { from, to } => wrong = written::copy(written, *from, *to),
        }
        wrong
    }

    /// True where the files do not fit each other: the readings of the rod of the file are far off.
    pub(super) fn shows(&self, written: &Written) -> bool {
        let wrong = self.applied_to(written);
        let tip = wrong.drawing.length();
        let cells = written.protocol.cells();
        if let Mistake::Saturated { channel, .. }
        | Mistake::Zero { channel, .. }
        | Mistake::Stuck { channel, .. } = self
        {
            // of a sensor that has nothing to show but its last digit nobody sees that it is stuck
            let size = |(_, shown): (&Cell, &f64)| shown.abs();
            let of_channel = cells.iter().zip(&written.shown).filter(|(cell, _)| cell.channel == *channel);
            let own = of_channel.map(size).fold(0.0, f64::max);
            if own < MOVES * cells.iter().zip(&written.shown).map(size).fold(0.0, f64::max) {
                return false;
            }
        }
        if let Mistake::Saturated { channel, limit } = self {
            let is_cut = |(cell, shown): &(&Cell, &f64)| cell.channel == *channel && shown.abs() > *limit;
            return cells.iter().zip(&written.shown).filter(is_cut).count() >= CUT;
        }
        if matches!(
            self,
            Mistake::Zero { .. } | Mistake::Stuck { .. } | Mistake::Typed { .. } | Mistake::Copied { .. }
        ) {
            return true;
        }
        if !wrong.drawing.is_possible() || !wrong.protocol.stations().iter().all(|station| *station < tip) {
            return false;
        }
        let sticking = vec![0.0; wrong.protocol.loadings.len()];
        let full_scale = wrong.protocol.largest_load();
        let expected = Bench {
            drawing: wrong.drawing,
            actual: Actual::default(),
            protocol: wrong.protocol,
            sticking,
            full_scale,
        };
        let norm = |values: &dyn Fn(f64, f64) -> f64, pairs: &[(f64, f64)]| {
            pairs.iter().map(|&(a, b)| values(a, b).powi(2)).sum::<f64>().sqrt()
        };
        // in some trials it must show in these
        let is_wrong = |cell: &Cell| match self {
            Mistake::InTrials { trials, .. } => {
                trials.contains(&expected.protocol.loadings[cell.loading].trial)
            }
            _ => true,
        };
        let readings = expected.readings(&[]).into_iter().zip(wrong.shown);
        let of_cells = expected.protocol.cells().into_iter().zip(readings);
        let own: Vec<(f64, f64)> =
            of_cells.filter(|(cell, _)| is_wrong(cell)).map(|(_, pair)| pair).collect();
        norm(&|a, b| a - b, &own) > VISIBLE * norm(&|a, _| a, &own).max(norm(&|_, b| b, &own))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::bench::tests::bench;

    fn written() -> Written {
        let bench = bench();
        let shown = bench.readings(&[]);
        Written { drawing: bench.drawing, others: Vec::new(), protocol: bench.protocol, shown }
    }

    #[test]
    fn exchanged_columns_and_axes_keep_every_number() {
        let mut written = written();
        for mistake in [Mistake::Channels([0, 2]), Mistake::Axes([1, 2])] {
            let twice = mistake.applied_to(&mistake.applied_to(&written));
            assert_eq!(twice, written, "{mistake:?}");
        }
        // the first row of dx holds what dz read, also where a channel is blank
        written.protocol.channels[0] = [true, true, false];
        written.shown.remove(2);
        let wrong = Mistake::Channels([0, 2]).applied_to(&written);
        assert_eq!(wrong.protocol.channels[0], [false, true, true]);
        assert_eq!(wrong.shown[..2], [written.shown[1], written.shown[0]]);
        assert_eq!(wrong.shown.len(), written.shown.len());
    }
}
