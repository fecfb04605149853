//! What to give up where no design keeps all limits.

use super::figure::{Design, Figures};
use super::limits::Limit;

/// One limit that is in the way alone: all others can be kept.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Relaxed {
    /// The limit.
    pub limit: Limit,
    /// What it would have to be at least, in the unit of its key.
    pub to: f64,
    /// A design that then keeps all.
    pub design: Design,
}

/// The designs that come nearest to keeping all limits.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Nearest {
    /// Limits that alone are in the way, in the order of the design file's limits.
    pub one_limit: Vec<Relaxed>,
    /// The design whose worst limit is broken by the smallest share, with that share.
    pub all_limits: Option<(Design, f64)>,
}

impl Nearest {
    /// True where a design with these figures, which breaks `broken`, would be nearer than what is
    /// known.
    pub(super) fn would_take(&self, broken: &[&Limit], figures: &Figures) -> bool {
        let is_less = match broken {
            [only] => self.would_relax(only, figures),
            _ => false,
        };
        is_less || self.all_limits.as_ref().is_none_or(|(_, least)| worst(broken, figures) < *least)
    }

    fn would_relax(&self, limit: &Limit, figures: &Figures) -> bool {
        let to = figures.get(limit.figure).unwrap_or(f64::NAN);
        match self.one_limit.iter().find(|known| known.limit.key == limit.key) {
            Some(known) if limit.is_least => to > known.to,
            Some(known) => to < known.to,
            None => to.is_finite(),
        }
    }

    /// Remembers a design that breaks `broken` and no other limit, if it is nearer than those
    /// before.
    pub(super) fn offer(&mut self, design: Design, broken: &[&Limit]) {
        if let [only] = broken {
            let to = design.figures.get(only.figure).unwrap_or(f64::NAN);
            self.relax(Relaxed { limit: **only, to, design });
        }
        self.approach(design, worst(broken, &design.figures));
    }

    fn relax(&mut self, new: Relaxed) {
        if !new.to.is_finite() {
            return;
        }
        match self.one_limit.iter_mut().find(|known| known.limit.key == new.limit.key) {
            Some(known) => {
                let is_nearer = if new.limit.is_least { new.to > known.to } else { new.to < known.to };
                if is_nearer || (new.to == known.to && new.design.index < known.design.index) {
                    *known = new;
                }
            }
            None => self.one_limit.push(new),
        }
    }

    fn approach(&mut self, design: Design, worst: f64) {
        let is_nearer = |(known, least): &(Design, f64)| {
            worst < *least || (worst == *least && design.index < known.index)
        };
        if worst.is_finite() && self.all_limits.as_ref().is_none_or(is_nearer) {
            self.all_limits = Some((design, worst));
        }
    }

    /// The nearest of both.
    pub(super) fn merge(&mut self, other: Nearest) {
        other.one_limit.into_iter().for_each(|relaxed| self.relax(relaxed));
        if let Some((design, worst)) = other.all_limits {
            self.approach(design, worst);
        }
    }
}

/// Largest share by which figures are beyond limits.
fn worst(broken: &[&Limit], figures: &Figures) -> f64 {
    broken.iter().map(|limit| limit.excess(figures)).fold(0.0, f64::max)
}
