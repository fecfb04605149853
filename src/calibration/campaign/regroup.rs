//! Sockets that became others while a campaign was recorded.

use std::collections::BTreeMap;

use super::{Distance, Group, GroupName, Recording, Targets};

impl Recording {
    /// Makes the sockets of the rows that `is_moved` names others, whose place nobody knows: socket
    /// 0 of `front` becomes socket 0 of `front from row 42`. Distances within a plate that moved as
    /// a whole (`keeps_distances`) stay known.
    pub fn rename_groups(&mut self, is_moved: &dyn Fn(usize) -> bool, from: &str, keeps_distances: bool) {
        let mut renamed: BTreeMap<usize, usize> = BTreeMap::new();
        for row in 0..self.rows.len() {
            let own = self.rows[row].group;
            if !is_moved(row) {
                continue;
            }
            // all that is left of a socket is the same one under its name
            let stays = |&(at, other): &(usize, &super::Row)| other.group == own && !is_moved(at);
            let next = self.groups.len();
            let is_split =
                renamed.contains_key(&own) || self.rows.iter().enumerate().any(|pair| stays(&pair));
            let new = *renamed.entry(own).or_insert(if is_split { next } else { own });
            if new == next {
                let later = |name: &str| format!("{name} from {from}");
                let name = match &self.groups[own].name {
                    GroupName::Socket { placement, socket } => GroupName::socket(later(placement), socket),
                    GroupName::Clamp(id) => GroupName::Clamp(later(id)),
                    GroupName::Tracked => GroupName::Tracked,
                };
                self.groups.push(Group::new(name, self.groups[own].device));
            }
            self.rows[row].group = new;
        }
        let Targets::Sockets(distances) = &mut self.targets else { return };
        let known = distances.clone();
        if !keeps_distances {
            distances
                .retain(|distance| distance.between.iter().all(|group| renamed.get(group) != Some(group)));
            return;
        }
        for Distance { between: [a, b], value, sd } in known {
            if let (Some(&x), Some(&y)) = (renamed.get(&a), renamed.get(&b))
                && (x, y) != (a, b)
            {
                distances.push(Distance { between: [x, y], value, sd });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Recording, Row, Station};
    use super::*;

    /// Eight rows in turn in the two sockets of a plate.
    fn plate() -> Recording {
        let mut recording = Recording::new(1);
        let group =
            |k: usize| Group::new(GroupName::socket("front", k.to_string()), crate::spatial::Pose::IDENTITY);
        recording.groups = vec![group(0), group(1)];
        recording.stations = vec![Station::first("")];
        recording.joint_values = (0..8).map(f64::from).collect();
        let row = |k: usize| Row {
            pose: format!("{k}"),
            line: k + 2,
            group: k % 2,
            station: 0,
            time: None,
            temperature: None,
        };
        recording.rows = (0..8).map(row).collect();
        recording.targets = Targets::Sockets(vec![Distance { between: [0, 1], value: 0.05, sd: 1e-4 }]);
        recording
    }

    fn names(recording: &Recording) -> Vec<String> {
        recording.rows.iter().map(|row| recording.groups[row.group].name.to_string()).collect()
    }

    fn known(recording: &Recording) -> Vec<[usize; 2]> {
        let Targets::Sockets(distances) = &recording.targets else { unreachable!() };
        distances.iter().map(|distance| distance.between).collect()
    }

    #[test]
    fn a_plate_that_moved_is_another_plate_and_a_socket_another_socket() {
        let mut whole = plate();
        whole.rename_groups(&|row| row > 3, "row 5", true);
        assert_eq!(names(&whole)[3..6], ["front/1", "front from row 5/0", "front from row 5/1"]);
        assert_eq!(known(&whole), [[0, 1], [2, 3]]);
        // then one of its sockets, at once: its place to the other is no longer known
        whole.rename_groups(&|row| row > 3 && row % 2 == 0, "row 5", false);
        assert_eq!(known(&whole), [[0, 1]]);
        let mut one = plate();
        one.rename_groups(&|row| row > 3 && row % 2 == 0, "row 5", false);
        assert_eq!(names(&one)[3..6], ["front/1", "front from row 5/0", "front/1"]);
        assert_eq!(known(&one), [[0, 1]]);
    }
}
