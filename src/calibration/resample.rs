//! Parts of a recording: folds that are held out, and poses drawn again.

use nalgebra::Vector3;

use super::campaign::{Distance, Group, GroupName, Recording, Row, Targets};
use crate::statistics::Random;

/// Fewest consecutive rows that are worth a block.
const LEAST_BLOCK: usize = 5;

impl Recording {
    /// The rows of these indices, in this order; an index may come again. Clamps, sockets
    /// and stations without a row are left out.
    pub fn subset(&self, rows: &[usize]) -> Recording {
        let mut place = vec![None; self.groups.len()];
        let mut groups = Vec::new();
        // in their own order, so that {W} stays that of the first
        let is_used = |&station: &usize| rows.iter().any(|&row| self.rows[row].station == station);
        let used: Vec<usize> = (0..self.stations.len()).filter(is_used).collect();
        let stations = used.iter().map(|&station| self.stations[station].clone()).collect();
        let mut kept = Vec::with_capacity(rows.len());
        for &row in rows {
            let mut entry = self.rows[row].clone();
            let old = entry.group;
            entry.group = *place[old].get_or_insert_with(|| {
                groups.push(self.groups[old].clone());
                groups.len() - 1
            });
            entry.station = used.iter().filter(|&&known| known < entry.station).count();
            kept.push(entry);
        }
        let targets = match &self.targets {
            Targets::Points(points) => Targets::Points(rows.iter().map(|&row| points[row]).collect()),
            Targets::Sockets(distances) => {
                let still = |distance: &Distance| match distance.between.map(|group| place[group]) {
                    [Some(a), Some(b)] => Some(Distance { between: [a, b], ..*distance }),
                    _ => None,
                };
                Targets::Sockets(distances.iter().filter_map(still).collect())
            }
        };
        Recording {
            file: self.file.clone(),
            source: self.source.clone(),
            joint_count: self.joint_count,
            joint_values: rows.iter().flat_map(|&row| self.joints(row).iter().copied()).collect(),
            joints_read: self
                .joints_read
                .as_ref()
                .map(|_| rows.iter().flat_map(|&row| self.read_joints(row).iter().copied()).collect()),
            rows: kept,
            groups,
            stations,
            targets,
        }
    }

    /// The name of a row's pose for people, with its clamp or socket.
    pub fn pose_name(&self, row: usize) -> String {
        let entry = &self.rows[row];
        match &self.groups[entry.group].name {
            GroupName::Tracked => entry.pose.clone(),
            group => format!("{} of {group}", entry.pose),
        }
    }

    /// Which fold each row belongs to, 0 … `folds` − 1: the rows of every clamp are cut into blocks
    /// of consecutive ones, four for every fold where they are long enough, and the blocks dealt to
    /// the folds in turn. Neighbours, which often share an error, are thereby held out together,
    /// and yet no fold is a corner of the workspace. Clamps that have fewer rows than there are
    /// folds are dealt row by row, each going on where the one before it ended: so there are as
    /// many folds as were asked for, where there are as many rows. With sockets whole placements
    /// are held out, as many folds as there are placements, where there are two or more.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let mut recording = Recording::new(1);
    /// for k in 0..10 {
    ///     recording.add(&[f64::from(k)], [0.0; 3].into())?;
    /// }
    /// assert_eq!(recording.folds(2), [0, 0, 0, 0, 0, 1, 1, 1, 1, 1]); // too few for shorter blocks
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn folds(&self, folds: usize) -> Vec<usize> {
        let placements = self.session_by_group();
        let count = placements.iter().max().map_or(0, |last| last + 1);
        if matches!(self.targets, Targets::Sockets(_)) && count > 1 {
            return self.rows.iter().map(|row| placements[row.group]).collect();
        }
        let mut size = vec![0usize; self.groups.len()];
        for row in &self.rows {
            size[row.group] += 1;
        }
        let mut seen = vec![0usize; self.groups.len()];
        let folds = folds.max(2);
        // where each group of few rows begins
        let mut dealt = 0;
        let begins: Vec<usize> = size
            .iter()
            .map(|&size| {
                let begin = dealt;
                dealt += if size < folds { size } else { 0 };
                begin
            })
            .collect();
        self.rows
            .iter()
            .map(|row| {
                let at = seen[row.group];
                seen[row.group] += 1;
                let size = size[row.group];
                if size < folds {
                    return (begins[row.group] + at) % folds;
                }
                let rounds = if size >= 4 * folds * LEAST_BLOCK { 4 } else { 1 };
                (at * folds * rounds / size) % folds
            })
            .collect()
    }

    /// As many rows as there are, drawn with replacement within each clamp or socket.
    pub fn bootstrap_rows(&self, random: &mut Random) -> Vec<usize> {
        let mut rows_by_group: Vec<Vec<usize>> = vec![Vec::new(); self.groups.len()];
        for (row, entry) in self.rows.iter().enumerate() {
            rows_by_group[entry.group].push(row);
        }
        let mut draw = |rows: &Vec<usize>| -> Vec<usize> {
            rows.iter().map(|_| rows[random.index(rows.len())]).collect()
        };
        rows_by_group.iter().flat_map(&mut draw).collect()
    }

    /// Each point less the mean of the points of its group.
    pub(crate) fn minus_group_means(&self, points: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        let mut sum = vec![(Vector3::zeros(), 0.0); self.groups.len()];
        for (point, row) in points.iter().zip(&self.rows) {
            sum[row.group].0 += point;
            sum[row.group].1 += 1.0;
        }
        let less = |(point, row): (&Vector3<f64>, &Row)| point - sum[row.group].0 / sum[row.group].1;
        points.iter().zip(&self.rows).map(less).collect()
    }

    /// What was set up in one piece, by its first group, in order of appearance: each clamp, each
    /// placement of sockets.
    pub(crate) fn sessions(&self) -> Vec<&GroupName> {
        let mut sessions: Vec<&GroupName> = Vec::new();
        for Group { name, .. } in &self.groups {
            if sessions.iter().all(|known| !known.is_set_up_with(name)) {
                sessions.push(name);
            }
        }
        sessions
    }

    /// Of every group the number of its session among [`Recording::sessions`].
    pub(crate) fn session_by_group(&self) -> Vec<usize> {
        let sessions = self.sessions();
        let is_own = |group: &Group| sessions.iter().position(|known| known.is_set_up_with(&group.name));
        self.groups.iter().map(|group| is_own(group).unwrap_or_default()).collect()
    }
}
