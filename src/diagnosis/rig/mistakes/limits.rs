//! Readings that stay at the end of a display's range, whatever the load.

use crate::rig::readings::Reading;
use crate::spatial::Axis;

/// So many readings of a channel, at least.
const FEWEST: usize = 4;

/// The rows without readings that are the largest of their channel, to the last digit, under loads
/// that differ: what is cut off there says nothing of where it belongs.
pub(super) fn without_limits(rows: &[Reading]) -> Vec<Reading> {
    let mut rows = rows.to_vec();
    for channel in Axis::ALL.map(Axis::index) {
        for end in [f64::max, f64::min] {
            let Some(limit) = rows.iter().filter_map(|row| row.offset[channel]).reduce(end) else { continue };
            let at: Vec<usize> =
                (0..rows.len()).filter(|&i| rows[i].offset[channel] == Some(limit)).collect();
            let is_beside =
                |i: usize| rows[i].direction == rows[at[0]].direction && rows[i].load != rows[at[0]].load;
            if limit != 0.0 && at.len() >= FEWEST && at.iter().any(|&i| is_beside(i)) {
                at.iter().for_each(|&i| rows[i].offset[channel] = None);
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::readings::Readings;

    #[test]
    fn what_ends_at_one_value_under_several_loads_is_left_out_and_repeats_are_not() {
        let kept = |last: [&str; 4]| {
            let [a, b, c, d] = last;
            let text = format!("axis,load_n,dy_um\ny,1,10\ny,2,20\ny,3,{a}\ny,4,{b}\ny,3,{c}\ny,4,{d}\n");
            let rows = without_limits(&Readings::from_text("f", &text).unwrap().rows);
            rows.iter().filter(|row| row.offset[1].is_some()).count()
        };
        assert_eq!(kept(["27", "27", "27", "27"]), 2);
        assert_eq!(kept(["-27", "-27", "-27", "-27"]), 2);
        assert_eq!(kept(["30", "40", "30", "40"]), 6);
        assert_eq!(kept(["27", "27", "27", "26"]), 6);
    }
}
