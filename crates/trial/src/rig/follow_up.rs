//! Once more at the rig: what somebody proposes to measure next is done with the same rod, the same
//! effects and the same sensors, after everything that was done before.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::bench::Bench;
use super::drawing::rounded;
use super::protocol::{AXES, Columns, Loading, Protocol, Run, steps};
use super::{FOLLOW_UP, drawn};
use crate::Seed;
use rodcal_base::statistics::Random;
use rodcal_base::units::MM;

/// A measurement that is proposed, in the words of a diagnosis' JSON.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Proposed {
    /// Where the load pulls to: `y`, `-z`.
    pub direction: String,
    /// Loads in their order, N.
    pub loads_n: Vec<f64>,
    /// Read at the same loads, but the largest, on the way down.
    pub unloading: bool,
    /// Where the load hangs, mm; `None` is the tip.
    pub load_station_mm: Option<f64>,
    /// Where the sensors stand, mm; `None` is the tip.
    pub read_station_mm: Option<f64>,
    /// When each load is read after it was hung, s.
    pub waits_s: Vec<f64>,
    /// How often, each from a new zero.
    pub repeats: usize,
    /// `dx`, `dy`, `dz`.
    pub channels: Vec<String>,
}

/// A recording, and with what was measured next below it: two files.
#[derive(Debug, Clone, PartialEq)]
pub struct FollowUp {
    /// As it stands in the archive.
    pub before: String,
    /// The same with the new rows.
    pub after: String,
}

/// Deflection over length that no rig's sensor follows.
const FURTHEST: f64 = 0.05;
/// Readings that nobody would take.
const MOST_LOADINGS: usize = 500;
/// Time from the last run to the next, and from a load to its first reading, s.
const REST: f64 = 600.0;
const DWELL: f64 = 30.0;

/// Case `number` of the trial that belongs to `seed` with what is `proposed`; the numbers of before
/// are the same, the new ones have a noise of their own. Refuses, with the reason, what this rig
/// cannot do.
pub fn follow_up(
    seed: Seed,
    number: usize,
    residuals: &[f64],
    proposed: &Proposed,
) -> Result<FollowUp, &'static str> {
    let drawn = drawn(seed, number, residuals);
    let recorded = &drawn.bench.protocol;
    let new = planned(&drawn.bench, proposed)?;
    let mut random = Random::of_seed(seed.0, FOLLOW_UP + number as u64);
    let more = new.loadings.iter().map(|_| random.uniform(-1.0, 1.0));
    let whole = Bench {
        protocol: Protocol {
            loadings: recorded.loadings.iter().chain(&new.loadings).cloned().collect(),
            channels: recorded.channels.iter().chain(&new.channels).copied().collect(),
            ..recorded.clone()
        },
        sticking: drawn.bench.sticking.iter().copied().chain(more).collect(),
        ..drawn.bench.clone()
    };
    let readings = whole.readings(&drawn.effects);
    let readings = readings.get(drawn.readings.len()..).unwrap_or_default();
    let alone = Bench { protocol: new, ..drawn.bench.clone() };
    let shown = drawn.noise.shown(&alone, readings, &mut random);
    let before = recorded.csv(&drawn.right.shown);
    let after = joined(&before, &alone.protocol.csv(&shown));
    Ok(FollowUp { before, after })
}

/// What is done, after what was done.
fn planned(bench: &Bench, proposed: &Proposed) -> Result<Protocol, &'static str> {
    let recorded = &bench.protocol;
    let (sign, axis) = match proposed.direction.strip_prefix('-') {
        Some(axis) => (-1.0, axis),
        None => (1.0, proposed.direction.as_str()),
    };
    let axis = AXES.iter().position(|known| *known == axis).ok_or("no such direction")?;
    let channels =
        AXES.map(|channel| proposed.channels.iter().any(|name| name.strip_prefix('d') == Some(channel)));
    let stations = [proposed.load_station_mm, proposed.read_station_mm]
        .map(|station| station.map_or(recorded.tip, |mm| rounded(mm, 4) * MM));
    let passes = proposed.waits_s.len() * if proposed.unloading { 2 } else { 1 };
    let readings = proposed.loads_n.len().saturating_mul(passes).saturating_mul(proposed.repeats);
    let is_load = |load: &f64| load.is_finite() && *load >= 0.0;
    if !proposed.loads_n.iter().chain(&proposed.waits_s).all(is_load) || channels == [false; 3] {
        return Err("not a measurement");
    }
    if !(1..=MOST_LOADINGS).contains(&readings) {
        return Err("no readings, or too many");
    }
    if !stations.iter().all(|station| *station > 0.0 && *station <= recorded.tip) {
        return Err("a station that is not on the rod");
    }
    let largest = proposed.loads_n.iter().copied().fold(0.0, f64::max);
    if largest * bench.compliance()[axis] > FURTHEST * recorded.tip {
        return Err("the rod deflects further than a sensor follows");
    }
    let steps = steps(&proposed.loads_n, proposed.unloading);
    let last = recorded.loadings.last();
    let next =
        |number: fn(&Loading) -> usize| recorded.loadings.iter().map(|l| number(l) + 1).max().unwrap_or(0);
    let (trial, run) = (next(|l| l.trial), next(|l| l.run));
    let mut time = last.map_or(0.0, |l| l.time);
    let mut loadings = Vec::new();
    for repeat in 0..proposed.repeats {
        time += REST;
        let run = Run { axis, sign, trial: trial + repeat, run: run + repeat, zeroed: time, stations };
        for &step in &steps {
            let changed = time;
            for wait in &proposed.waits_s {
                time = rounded(changed + DWELL + wait, 1);
                loadings.push(run.loading(step, changed, time));
            }
        }
    }
    let is_waiting = proposed.waits_s.iter().any(|wait| *wait > 0.0);
    let columns = Columns {
        trial: true,
        phase: recorded.columns.phase || proposed.unloading,
        time: recorded.columns.time || is_waiting,
        ..recorded.columns
    };
    let channels = vec![channels; loadings.len()];
    Ok(Protocol { loadings, channels, columns, zeroed_once: false, ..recorded.clone() })
}

/// One table below another one of the same format: all columns of both, blanks where a table has
/// none.
fn joined(above: &str, below: &str) -> String {
    let is_row = |line: &&str| !line.starts_with('#');
    let header = |text: &str| text.lines().find(is_row).unwrap_or_default().to_owned();
    let (first, second) = (header(above), header(below));
    let mut columns: Vec<&str> = first.split(',').collect();
    columns.extend(second.split(',').filter(|name| first.split(',').all(|known| known != *name)));
    let comments: String =
        above.lines().filter(|line| !is_row(line)).map(|line| line.to_owned() + "\n").collect();
    let mut text = comments + &columns.join(",") + "\n";
    for (header, table) in [(&first, above), (&second, below)] {
        for row in table.lines().filter(is_row).skip(1) {
            let cells: BTreeMap<&str, &str> = header.split(',').zip(row.split(',')).collect();
            let row: Vec<&str> =
                columns.iter().map(|name| cells.get(name).copied().unwrap_or_default()).collect();
            text += &(row.join(",") + "\n");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground_truth::Kind;
    use crate::rig::case;

    fn proposed() -> Proposed {
        Proposed {
            direction: "-x".into(),
            loads_n: vec![1.0, 2.0],
            unloading: true,
            load_station_mm: Some(60.0),
            read_station_mm: None,
            waits_s: vec![0.0, 60.0],
            repeats: 2,
            channels: vec!["dx".into(), "dz".into()],
        }
    }

    #[test]
    fn the_recording_is_the_sealed_one_and_the_new_rows_are_below_it() {
        for number in 1..12 {
            let sealed = case(Seed(5), number, &[]);
            // where the files are wrong nothing is proposed
            if sealed.truth.kind == Kind::Mistake {
                continue;
            }
            let sealed = sealed.files[1].1.clone();
            let measured = follow_up(Seed(5), number, &[], &proposed()).unwrap();
            assert_eq!(measured.before, sealed);
            let rows = |text: &str| text.lines().filter(|line| !line.starts_with('#')).count();
            assert_eq!(rows(&measured.after), rows(&sealed) + 12);
            let last = measured.after.lines().last().unwrap();
            assert!(last.starts_with("-x,") && last.contains("unload") && last.contains("60"), "{last}");
            assert_eq!(measured, super::follow_up(Seed(5), number, &[], &proposed()).unwrap());
        }
    }

    #[test]
    fn what_no_rig_can_do_is_refused_with_the_reason() {
        let refused = |proposed: Proposed| follow_up(Seed(5), 1, &[], &proposed).unwrap_err();
        assert_eq!(refused(Proposed { direction: "up".into(), ..proposed() }), "no such direction");
        assert_eq!(refused(Proposed { channels: vec![], ..proposed() }), "not a measurement");
        assert_eq!(refused(Proposed { loads_n: vec![f64::NAN], ..proposed() }), "not a measurement");
        assert_eq!(refused(Proposed { repeats: 0, ..proposed() }), "no readings, or too many");
        assert!(refused(Proposed { load_station_mm: Some(1e4), ..proposed() }).contains("not on the rod"));
        assert!(refused(Proposed { loads_n: vec![1e4], ..proposed() }).contains("deflects further"));
    }

    #[test]
    fn tables_are_joined_by_their_columns() {
        assert_eq!(joined("# s\na,b\n1,2\n", "# t\na,c\n3,4\n"), "# s\na,b,c\n1,2,\n3,,4\n");
    }
}
