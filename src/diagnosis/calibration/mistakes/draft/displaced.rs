//! Changes of some rows of a draft alone, and rows that stand some rows away from where they
//! belong.

use super::{Cell, Draft, DraftChange, Rows};

impl Draft {
    /// What acts on rows one by one, or displaces them, in some rows alone.
    pub fn apply_within(&mut self, rows: Rows, change: &DraftChange) {
        let is_within = |at: usize| rows.contain(self.rows[at], self.group[at]);
        let inside: Vec<usize> = (0..self.len()).filter(|&at| is_within(at)).collect();
        if let DraftChange::Rows { by, with_clamps } = change {
            return self.displace_some(&inside, *by, *with_clamps);
        }
        if let DraftChange::Column { cell, by } = change {
            return self.displace_column(&inside, *cell, *by);
        }
        let mut changed = self.part(&inside);
        changed.apply(change);
        for (k, &at) in inside.iter().enumerate() {
            self.joints[at * self.joint_count..][..self.joint_count].copy_from_slice(changed.joints(k));
            self.group[at] = changed.group[k];
            if let Some(seen) = changed.seen.get(k) {
                self.seen[at] = *seen;
            }
        }
    }

    pub fn number_mut(&mut self, at: usize, cell: Cell) -> &mut f64 {
        match cell {
            Cell::Joint(joint) => &mut self.joints[at * self.joint_count + joint],
            Cell::Axis(axis) => &mut self.seen[at][axis],
        }
    }

    /// Rows whose number has none to be taken from, and rows outside whose number is another row's
    /// now, have none of their own, and go.
    pub fn displace_column(&mut self, inside: &[usize], cell: Cell, by: isize) {
        let recorded: Vec<f64> = (0..self.len()).map(|at| *self.number_mut(at, cell)).collect();
        let (mut is_kept, mut is_inside) = (vec![true; self.len()], vec![false; self.len()]);
        inside.iter().for_each(|&at| is_inside[at] = true);
        for &at in inside {
            let Some(from) = at.checked_add_signed(by).filter(|&from| from < recorded.len()) else {
                is_kept[at] = false;
                continue;
            };
            *self.number_mut(at, cell) = recorded[from];
            is_kept[from] &= is_inside[from];
        }
        let kept: Vec<usize> = (0..self.len()).filter(|&at| is_kept[at]).collect();
        *self = self.part(&kept);
    }

    /// Rows outside whose position is another row's now have none of their own, and go.
    fn displace_some(&mut self, inside: &[usize], by: isize, with_clamps: bool) {
        let source = |at: usize| at.checked_add_signed(by).filter(|&at| at < self.len());
        let mut taken = vec![false; self.len()];
        let mut from: Vec<Option<usize>> = (0..self.len()).map(Some).collect();
        for &at in inside {
            from[at] = source(at);
            from[at].into_iter().for_each(|at| taken[at] = true);
        }
        let is_elsewhere = |(at, from): &(usize, &mut Option<usize>)| taken[*at] && **from == Some(*at);
        from.iter_mut().enumerate().filter(is_elsewhere).for_each(|(_, from)| *from = None);
        let kept: Vec<usize> = (0..self.len()).filter(|&at| from[at].is_some()).collect();
        let there = |&at: &usize| from[at].unwrap_or(at);
        let seen = match self.has_sockets() {
            true => Vec::new(),
            false => kept.iter().map(|at| self.seen[there(at)]).collect(),
        };
        let group = kept.iter().map(|at| self.group[if with_clamps { there(at) } else { *at }]).collect();
        *self = Draft { seen, group, ..self.part(&kept) };
    }

    /// All positions some rows away from their angles; rows without one go.
    pub fn displace(&mut self, by: isize, with_clamps: bool) {
        let count = self.len() as isize;
        let kept: Vec<usize> =
            (0..count).filter(|i| (0..count).contains(&(i + by))).map(|i| i as usize).collect();
        let there = |&row: &usize| (row as isize + by) as usize;
        let seen = match self.has_sockets() {
            true => Vec::new(),
            false => kept.iter().map(|row| self.seen[there(row)]).collect(),
        };
        let group = kept.iter().map(|row| self.group[if with_clamps { there(row) } else { *row }]).collect();
        *self = Draft { seen, group, ..self.part(&kept) };
    }

    /// All positions in reverse order, the joint values where they are.
    pub fn reverse(&mut self, with_clamps: bool) {
        self.seen.reverse();
        if with_clamps {
            self.group.reverse();
        }
    }
}
