//! Whether any of very many designs betters another one, without looking at all of them.
//!
//! The designs of a front hang in a tree (ND-tree: A. Jaszkiewicz, T. Lust, *IEEE Trans. Evol.
//! Comput.* 22 (2018) 778–791). A node knows the least and the largest cost in each goal of what
//! hangs below it. Where its least costs are not as good as those of a design in every goal nothing
//! below it betters that, and where its largest costs are better everything below does.

use crate::design::figure::Design;

/// Goals at most: one for each figure.
pub(super) const GOALS: usize = 8;
/// Designs of a leaf, and nodes below a node.
const LEAF: usize = 24;
const BRANCHES: usize = 6;

/// What a design costs in each goal, less is better; 0 beyond the goals.
pub(super) type Costs = [f64; GOALS];

/// A design and what it costs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) costs: Costs,
    pub(super) design: Design,
}

/// Designs none of which betters another.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    least: Costs,
    largest: Costs,
    count: usize,
    below: Below,
}

#[derive(Debug, Clone)]
enum Below {
    Leaf(Vec<Entry>),
    Branches(Vec<Tree>),
}

/// As good in every goal.
fn is_as_good(a: &Costs, b: &Costs) -> bool {
    a.iter().zip(b).all(|(a, b)| a <= b)
}

/// As good in every goal and better in one.
fn betters(a: &Costs, b: &Costs) -> bool {
    is_as_good(a, b) && a != b
}

impl Tree {
    /// A leaf.
    pub(super) fn leaf(entries: Vec<Entry>) -> Tree {
        let [mut least, mut largest] = [[f64::INFINITY; GOALS], [f64::NEG_INFINITY; GOALS]];
        entries.iter().for_each(|entry| widen(&mut least, &mut largest, [&entry.costs; 2]));
        Tree { least, largest, count: entries.len(), below: Below::Leaf(entries) }
    }

    /// Number of designs.
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// Whether a design betters what costs so much. That one is looked at first the next time: who
    /// bettered one design is likely to better the next.
    pub(super) fn betters(&mut self, costs: &Costs) -> bool {
        if self.count == 0 || !is_as_good(&self.least, costs) {
            return false;
        }
        if betters(&self.largest, costs) {
            return true;
        }
        // designs of one cost
        if self.least == self.largest {
            return false;
        }
        match &mut self.below {
            Below::Leaf(entries) => {
                let better = entries.iter().position(|entry| betters(&entry.costs, costs));
                better.inspect(|&better| entries.swap(0, better)).is_some()
            }
            Below::Branches(branches) => {
                let better = branches.iter_mut().position(|branch| branch.betters(costs));
                better.inspect(|&better| branches.swap(0, better)).is_some()
            }
        }
    }

    /// Takes away all designs that these costs better.
    pub(super) fn prune(&mut self, costs: &Costs) {
        if self.count == 0 || !is_as_good(costs, &self.largest) {
            return;
        }
        if betters(costs, &self.least) {
            *self = Tree::leaf(Vec::new());
            return;
        }
        match &mut self.below {
            Below::Leaf(entries) => {
                entries.retain(|entry| !betters(costs, &entry.costs));
                *self = Tree::leaf(std::mem::take(entries));
            }
            Below::Branches(branches) => {
                branches.iter_mut().for_each(|branch| branch.prune(costs));
                branches.retain(|branch| branch.count > 0);
                *self = Tree::joined(std::mem::take(branches));
            }
        }
    }

    /// Takes in a design that none betters and that betters none.
    pub(super) fn insert(&mut self, entry: Entry) {
        widen(&mut self.least, &mut self.largest, [&entry.costs; 2]);
        self.count += 1;
        let scale = self.scale();
        match &mut self.below {
            Below::Leaf(entries) => {
                entries.push(entry);
                if entries.len() > LEAF && self.least != self.largest {
                    *self = Tree::joined(split(std::mem::take(entries), &scale));
                }
            }
            Below::Branches(branches) => {
                let far = |branch: &Tree| distance(&branch.middle(), &entry.costs, &scale);
                let nearest = branches.iter_mut().min_by(|a, b| far(a).total_cmp(&far(b)));
                if let Some(branch) = nearest {
                    branch.insert(entry);
                }
            }
        }
    }

    /// All designs, in no particular order.
    pub(super) fn collect(&self, into: &mut Vec<Entry>) {
        match &self.below {
            Below::Leaf(entries) => into.extend(entries),
            Below::Branches(branches) => branches.iter().for_each(|branch| branch.collect(into)),
        }
    }

    fn joined(branches: Vec<Tree>) -> Tree {
        let mut tree = Tree::leaf(Vec::new());
        for branch in &branches {
            widen(&mut tree.least, &mut tree.largest, [&branch.least, &branch.largest]);
            tree.count += branch.count;
        }
        // an empty one is a leaf
        if tree.count > 0 {
            tree.below = Below::Branches(branches);
        }
        tree
    }

    fn middle(&self) -> Costs {
        std::array::from_fn(|k| 0.5 * (self.least[k] + self.largest[k]))
    }

    /// Over the range of each goal; 0 where there is none.
    fn scale(&self) -> Costs {
        std::array::from_fn(|k| {
            let scale = (self.largest[k] - self.least[k]).recip();
            if scale.is_finite() { scale } else { 0.0 }
        })
    }
}

fn widen(least: &mut Costs, largest: &mut Costs, [low, high]: [&Costs; 2]) {
    for k in 0..GOALS {
        least[k] = least[k].min(low[k]);
        largest[k] = largest[k].max(high[k]);
    }
}

fn distance(a: &Costs, b: &Costs, scale: &Costs) -> f64 {
    (0..GOALS).map(|k| ((a[k] - b[k]) * scale[k]).powi(2)).sum()
}

/// Leaves about a few of the entries, each the farthest one from those before it.
fn split(entries: Vec<Entry>, scale: &Costs) -> Vec<Tree> {
    let mut centres: Vec<Costs> = entries.iter().take(1).map(|entry| entry.costs).collect();
    while centres.len() < BRANCHES {
        let far = |entry: &Entry| {
            centres.iter().map(|centre| distance(centre, &entry.costs, scale)).fold(f64::INFINITY, f64::min)
        };
        let Some(next) = entries.iter().max_by(|a, b| far(a).total_cmp(&far(b))) else { break };
        centres.push(next.costs);
    }
    let mut about: Vec<Vec<Entry>> = vec![Vec::new(); centres.len()];
    for entry in entries {
        let far = |k: usize| distance(&centres[k], &entry.costs, scale);
        let nearest = (0..centres.len()).min_by(|&a, &b| far(a).total_cmp(&far(b)));
        about[nearest.unwrap_or_default()].push(entry);
    }
    about.into_iter().filter(|entries| !entries.is_empty()).map(Tree::leaf).collect()
}
