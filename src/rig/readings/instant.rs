//! Readings of one instant: what several sensors showed at the same moment, one row each.

use std::collections::HashMap;

use super::{Direction, Phase, Reading, Readings};

/// The readings of one instant.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Instant {
    /// Indices into [`Readings::rows`], ascending; at least one.
    pub rows: Vec<usize>,
}

/// What the rows of one instant share.
#[derive(PartialEq, Eq, Hash)]
struct Key<'r> {
    session: Option<&'r str>,
    trial: Option<&'r str>,
    phase: Option<Phase>,
    direction: Direction,
    load: u64,
    load_station: Option<u64>,
    time: Option<u64>,
}

impl Readings {
    /// The rows grouped by instant, each row in one group, in the order of their first rows.
    ///
    /// Rows of one session, trial, phase, direction, load, load station and time are readings of
    /// one instant, wherever they stand in the file: what they share (friction, creep, a slip)
    /// happened once. Where rows have no time, those that follow each other directly are one
    /// instant, up to the row that reads a channel at a station again: that is a repeat.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// // two stations, read at the same time, one row each
    /// let text = "axis,load_n,read_station_mm,time_s,dz_um\n\
    ///             z,1,200,0,2\nz,2,200,60,4\nz,1,400,0,9\nz,2,400,60,18\n";
    /// let instants = Readings::from_text("rig.csv", text)?.instants();
    /// let rows: Vec<Vec<usize>> = instants.into_iter().map(|instant| instant.rows).collect();
    /// assert_eq!(rows, [[0, 2], [1, 3]]);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn instants(&self) -> Vec<Instant> {
        instants(&self.rows)
    }
}

/// See [`Readings::instants`].
pub(crate) fn instants(rows: &[Reading]) -> Vec<Instant> {
    let mut instants: Vec<Instant> = Vec::new();
    let mut timed: HashMap<Key<'_>, usize> = HashMap::new();
    // the instant that the row above belongs to, where neither has a time
    let mut open: Option<(Key<'_>, usize)> = None;
    for (index, row) in rows.iter().enumerate() {
        let key = key(row);
        let known = match row.time {
            Some(_) => timed.get(&key).copied(),
            None => open.as_ref().filter(|(above, _)| *above == key).map(|&(_, instant)| instant),
        };
        let is_new = |instant: usize| -> bool {
            let of_instant: &Vec<usize> = &instants[instant].rows;
            of_instant.iter().all(|&other| !repeats(&rows[other], row))
        };
        let found = known.filter(|&instant| row.time.is_some() || is_new(instant));
        let instant = found.unwrap_or_else(|| {
            instants.push(Instant { rows: Vec::new() });
            instants.len() - 1
        });
        instants[instant].rows.push(index);
        open = None;
        match row.time {
            Some(_) => drop(timed.insert(key, instant)),
            None => open = Some((key, instant)),
        }
    }
    instants
}

fn key(row: &Reading) -> Key<'_> {
    // −0 and 0 are one load
    let bits = |value: f64| (value + 0.0).to_bits();
    Key {
        session: row.session.as_deref(),
        trial: row.trial.as_deref(),
        phase: row.phase,
        direction: row.direction,
        load: bits(row.load),
        load_station: row.load_station.map(bits),
        time: row.time.map(bits),
    }
}

/// True where both rows read the same channel at the same station, or the load was hung anew.
fn repeats(above: &Reading, row: &Reading) -> bool {
    let hung_anew = above.loaded_at.zip(row.loaded_at).is_some_and(|(a, b)| a != b);
    let same_channel = above.offset.iter().zip(row.offset).any(|(a, b)| a.is_some() && b.is_some());
    hung_anew || (same_channel && above.read_station == row.read_station)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn instants(text: &str) -> Vec<Vec<usize>> {
        let readings = Readings::from_text("f", text).unwrap();
        readings.instants().into_iter().map(|instant| instant.rows).collect()
    }

    #[test]
    fn what_differs_in_anything_that_happens_once_is_another_instant() {
        let header = "axis,load_n,read_station_mm,load_station_mm,time_s,trial,phase,session,dz_um\n";
        let first = "z,5,200,500,0,1,load,a,1\n";
        for other in [
            "-z,5,300,500,0,1,load,a,1",
            "z,6,300,500,0,1,load,a,1",
            "z,5,300,400,0,1,load,a,1",
            "z,5,300,500,1,1,load,a,1",
            "z,5,300,500,0,2,load,a,1",
            "z,5,300,500,0,1,unload,a,1",
            "z,5,300,500,0,1,load,b,1",
        ] {
            let text = format!("{header}{first}{other}\nz,7,200,500,9,1,load,a,2\n");
            assert_eq!(instants(&text), [[0], [1], [2]], "{other}");
        }
        let same = format!("{header}{first}z,5,300,500,0,1,load,a,1\nz,7,200,500,9,1,load,a,2\n");
        assert_eq!(instants(&same), [vec![0, 1], vec![2]]);
    }

    /// Any order of the rows gives the same groups.
    #[test]
    fn with_times_the_order_of_the_rows_does_not_matter() {
        let mut rows = Vec::new();
        for time in 0..4 {
            for (station, channel) in [(200, "1,"), (200, ",1"), (400, "1,2"), (200, "3,")] {
                rows.push(format!("z,{},{station},{},{channel}\n", 1 + time / 2, 60 * time));
            }
        }
        let text =
            |rows: &[String]| format!("axis,load_n,read_station_mm,time_s,dy_um,dz_um\n{}", rows.concat());
        let groups = |rows: &[String]| -> Vec<Vec<String>> {
            let found = instants(&text(rows)).into_iter();
            let named = found.map(|group| group.into_iter().map(|row| rows[row].clone()).collect());
            let mut groups: Vec<Vec<String>> = named.collect();
            groups.iter_mut().for_each(|group| group.sort());
            groups.sort();
            groups
        };
        let expected = groups(&rows);
        assert_eq!(expected.iter().map(Vec::len).collect::<Vec<_>>(), [4; 4]);
        for step in [3, 5, 7, 11, 13] {
            let shuffled: Vec<String> = (0..16).map(|k| rows[k * step % 16].clone()).collect();
            assert_eq!(groups(&shuffled), expected);
        }
    }

    #[test]
    fn without_times_neighbours_are_one_instant_until_a_channel_is_read_again() {
        let text = "axis,load_n,read_station_mm,dy_um,dz_um\n\
                    z,5,200,1,\nz,5,200,,1\nz,5,400,1,1\n\
                    z,5,200,1,1\nz,5,400,1,1\n\
                    z,9,200,1,1\nz,5,400,1,1\n";
        assert_eq!(instants(text), [vec![0, 1, 2], vec![3, 4], vec![5], vec![6]]);
        let hung_anew =
            "axis,load_n,loaded_at_s,read_station_mm,dz_um\nz,5,0,200,1\nz,5,9,400,1\nz,6,20,200,1\n";
        assert_eq!(instants(hung_anew), [[0], [1], [2]]);
    }
}
