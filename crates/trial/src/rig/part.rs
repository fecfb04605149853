//! Which mistake a case holds: one of the whole recording, or of a part of its rows. That is some
//! trials in another unit, with two names exchanged or with a sign reversed, one load that was
//! typed wrongly, a trial that was copied.

use super::drawing::Drawing;
use super::mistake::{LENGTHS, Mistake, POUND_FORCE, WHOLE, of_kind, pair};
use super::protocol::Protocol;
use super::setup::Needs;
use super::written::Written;
use crate::chance::{happens, one_of};
use rodcal_base::statistics::Random;
use rodcal_base::units::STANDARD_GRAVITY;

/// Kinds of mistakes, by number: of the whole recording, then of a part of it.
pub const MISTAKES: usize = WHOLE + OF_A_PART;
const OF_A_PART: usize = 6;
/// Draws before the next kind is tried.
const TRIES: usize = 20;
/// Of the numbers of two trials so many differ, or nobody could say that one is a copy.
const DIFFERENT: f64 = 0.8;
/// What a channel shows of the largest deflection at least, to say anything of a load.
const SHOWS: f64 = 0.05;
/// A load that was typed wrongly is off by a fifth at least.
const TYPED: f64 = 0.2;

/// What a protocol must have for a mistake of this number to show.
pub fn needs(number: usize) -> Needs {
    let needs = Needs::default();
    match number {
        5 | 6 => Needs { two_channels: true, two_axes: true, ..needs },
        // along one axis another unit of the loads, or another rod, is a rod of another stiffness
        0 | 12 => Needs { two_axes: true, ..needs },
        10 => Needs { trials: true, ..needs },
        // two channels show a load along z of a rod that is bent; two axes can be exchanged
        13.. => Needs { trials: true, two_channels: true, two_axes: true, ..needs },
        _ => needs,
    }
}

/// A mistake of a kind, or of one of the next where that does not show; `other` draws another rod.
pub fn draw(
    number: usize,
    written: &Written,
    mut other: impl FnMut(&mut Random) -> Drawing,
    random: &mut Random,
) -> Mistake {
    for number in number..number + MISTAKES {
        for _ in 0..TRIES {
            let drawn = match number % MISTAKES {
                whole if whole < WHOLE => of_kind(whole, written, &mut other, random),
                part => of_part(part - WHOLE, written, random),
            };
            if let Some(mistake) = drawn.filter(|mistake| mistake.shows(written)) {
                return mistake;
            }
        }
    }
    Mistake::Readings { channels: written.protocol.read_channels(), factor: LENGTHS[0] }
}

/// A mistake of this number; nothing where the recording has no place for it.
fn of_part(number: usize, written: &Written, random: &mut Random) -> Option<Mistake> {
    let protocol = &written.protocol;
    let count = trials(protocol);
    if count < 3 {
        return None;
    }
    let (axes, channels) = (protocol.axes(), protocol.read_channels());
    let what = match number {
        0 => {
            let units: &[f64] = match protocol.columns.kilograms {
                true => &[1.0 / STANDARD_GRAVITY, 1e-3],
                false => &[STANDARD_GRAVITY, POUND_FORCE],
            };
            Mistake::Loads { factor: one_of(random, units, STANDARD_GRAVITY) }
        }
        1 => Mistake::Readings { channels, factor: one_of(random, &LENGTHS, 1e3) },
        2 => Mistake::Flip(one_of(random, &axes, 0)),
        3 if happens(random, 0.5) => Mistake::Axes(pair(&axes, random)?),
        3 => Mistake::Channels(pair(&channels, random)?),
        4 => return typed(written, random),
        _ => return copied(written, random),
    };
    let most = (count - 1) / 2;
    let many = 1 + random.index(most);
    let first = random.index(count - many + 1);
    Some(Mistake::InTrials { trials: (first..first + many).collect(), what: Box::new(what) })
}

fn trials(protocol: &Protocol) -> usize {
    protocol.loadings.iter().map(|l| l.trial + 1).max().unwrap_or(0)
}

/// A load that two channels show: its decimal point elsewhere, or two digits exchanged.
fn typed(written: &Written, random: &mut Random) -> Option<Mistake> {
    let protocol = &written.protocol;
    let cells = protocol.cells();
    let largest = written.shown.iter().fold(0.0, |most: f64, shown| most.max(shown.abs()));
    let show = |loading: usize| {
        let of_loading = cells.iter().zip(&written.shown).filter(|(cell, _)| cell.loading == loading);
        of_loading.filter(|(_, shown)| shown.abs() > SHOWS * largest).count()
    };
    let shown: Vec<usize> = (0..protocol.loadings.len()).filter(|&loading| show(loading) > 1).collect();
    let loading = *shown.get(random.index(shown.len()))?;
    let right = protocol.loadings[loading].load;
    let exchanged = |load: f64| {
        let digits: Vec<char> = format!("{load}").chars().collect();
        let [first, second, rest @ ..] = &digits[..] else { return load };
        let other: String = [*second, *first].iter().chain(rest).collect();
        other.parse().unwrap_or(load)
    };
    let unit = if protocol.columns.kilograms { STANDARD_GRAVITY } else { 1.0 };
    let as_written = (right / unit * 1e6).round() / 1e6;
    let wrong = unit * one_of(random, &[10.0 * as_written, 0.1 * as_written, exchanged(as_written)], right);
    ((wrong / right - 1.0).abs() > TYPED).then_some(Mistake::Typed { loading, load: wrong, right })
}

/// A trial that stands in the place of another one, to the last digit.
fn copied(written: &Written, random: &mut Random) -> Option<Mistake> {
    let protocol = &written.protocol;
    let count = trials(protocol);
    let to = 1 + random.index(count - 1);
    let mistake = Mistake::Copied { from: random.index(to), to };
    if !protocol.columns.trial {
        return None;
    }
    let copy = mistake.applied_to(written);
    let of_trial = |cell: &super::protocol::Cell| protocol.loadings[cell.loading].trial == to;
    let pairs = protocol.cells().into_iter().zip(written.shown.iter().zip(&copy.shown));
    let own: Vec<bool> = pairs.filter(|(cell, _)| of_trial(cell)).map(|(_, (a, b))| a != b).collect();
    let different = own.iter().filter(|differs| **differs).count() as f64;
    (different > DIFFERENT * own.len() as f64).then_some(mistake)
}

#[cfg(test)]
mod tests {
    use super::super::bench::Bench;
    use super::super::bench::tests::bench;
    use super::super::drawing::tests::l_shape;
    use super::*;
    use rodcal_base::units::UM;

    fn written() -> Written {
        let mut bench = bench();
        let first = bench.protocol.loadings[0].trial;
        let count = bench.protocol.loadings.iter().take_while(|l| l.trial == first).count();
        bench.protocol.loadings.truncate(count);
        bench.protocol.channels.truncate(count);
        bench.sticking = vec![0.0; 4 * count];
        let of_one = bench.protocol.loadings.clone();
        let channels = bench.protocol.channels.clone();
        for trial in 1..4 {
            bench.protocol.loadings.extend(of_one.iter().map(|l| super::super::protocol::Loading {
                trial,
                run: l.run + 10 * trial,
                ..l.clone()
            }));
            bench.protocol.channels.extend(channels.iter().copied());
        }
        let shown = bench.readings(&[]);
        let shown = shown.iter().enumerate().map(|(k, shown)| shown + (k as f64).sin() * UM).collect();
        Written { drawing: bench.drawing, others: Vec::new(), protocol: bench.protocol, shown }
    }

    #[test]
    fn a_part_of_the_rows_is_wrong_and_the_others_are_as_they_were() {
        let written = written();
        for number in 0..OF_A_PART {
            for seed in 0..20 {
                let Some(mistake) = of_part(number, &written, &mut Random::seeded(seed, number as u64))
                else {
                    assert!(number > 2, "{number}");
                    continue;
                };
                let wrong = mistake.applied_to(&written);
                let same = |k: usize| {
                    let row = |written: &Written| {
                        let cells = written.protocol.cells().into_iter().zip(&written.shown);
                        let own = cells.filter(|(cell, _)| cell.loading == k);
                        own.map(|(cell, shown)| (cell.channel, shown.to_bits())).collect::<Vec<_>>()
                    };
                    (&wrong.protocol.loadings[k], row(&wrong))
                        == (&written.protocol.loadings[k], row(&written))
                };
                let changed: Vec<usize> =
                    (0..written.protocol.loadings.len()).filter(|&k| !same(k)).collect();
                let trial = |k: &usize| written.protocol.loadings[*k].trial;
                assert!(!changed.is_empty(), "{mistake:?}");
                match &mistake {
                    Mistake::InTrials { trials, .. } => {
                        assert!(changed.iter().all(|k| trials.contains(&trial(k))), "{mistake:?}");
                        assert!(2 * trials.len() < 4);
                    }
                    Mistake::Typed { loading, .. } => assert_eq!(changed, [*loading]),
                    Mistake::Copied { to, .. } => assert!(changed.iter().all(|k| trial(k) == *to)),
                    other => panic!("{other:?}"),
                }
            }
        }
    }

    #[test]
    fn a_copy_is_the_other_trial_to_the_last_digit() {
        let written = written();
        let copy = super::super::written::copy(&written, 0, 2);
        let readings = |trial: usize| -> Vec<f64> {
            let cells = copy.protocol.cells().into_iter().zip(&copy.shown);
            let own = cells.filter(|(cell, _)| copy.protocol.loadings[cell.loading].trial == trial);
            own.map(|(_, shown)| *shown).collect()
        };
        assert!(readings(2) == readings(0) && readings(1) != readings(0));
    }

    #[test]
    fn a_mistake_of_every_kind_shows_and_changes_the_files() {
        let bench_of = bench();
        let shown = bench_of.readings(&[]);
        let written =
            Written { drawing: bench_of.drawing, others: Vec::new(), protocol: bench_of.protocol, shown };
        let other = |_: &mut Random| Drawing { legs: [0.3, 0.3], ..l_shape(0.0) };
        let mut names = std::collections::BTreeSet::new();
        for number in 0..MISTAKES {
            for seed in 0..8 {
                let mistake = draw(number, &written, other, &mut Random::seeded(seed, number as u64));
                assert!(mistake.shows(&written) && mistake.applied_to(&written) != written, "{mistake:?}");
                assert!(!mistake.place(&written).is_nowhere());
                names.insert(mistake.name());
            }
        }
        assert!(names.len() >= 7, "{names:?}");
        // undone by its factor
        let wrong = Mistake::Loads { factor: STANDARD_GRAVITY }.applied_to(&written);
        let ratio = written.protocol.loadings[0].load / wrong.protocol.loadings[0].load;
        assert!((ratio - STANDARD_GRAVITY).abs() < 1e-12);
        // legs of one length may be exchanged
        let equal = Bench { drawing: other(&mut Random::seeded(0, 0)), ..bench() };
        let shown = equal.readings(&[]);
        assert!(!Mistake::Legs.shows(&Written { drawing: equal.drawing, shown, ..written }));
    }
}
