//! What to give up where no design keeps all limits.

use super::figure::Figures;
use super::front::Design;
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
    /// The design whose worst limit is broken by the smallest share, with that share; frequencies
    /// are not looked at where another limit is broken.
    pub all_limits: Option<(Design, f64)>,
}

impl Nearest {
    /// True where giving up `limit` alone for a design with these figures would ask for less than
    /// what is known.
    pub(super) fn would_relax(&self, limit: &Limit, figures: &Figures) -> bool {
        let to = figures.get(limit.figure).unwrap_or(f64::NAN);
        match self.one_limit.iter().find(|known| known.limit.key == limit.key) {
            Some(known) if limit.is_least => to > known.to,
            Some(known) => to < known.to,
            None => to.is_finite(),
        }
    }

    /// Remembers a design that breaks `broken`, if it is nearer than those before; `is_all` where
    /// those are all that it breaks.
    pub(super) fn offer(&mut self, design: Design, broken: &[&Limit], is_all: bool) {
        if let ([only], true) = (broken, is_all) {
            let to = design.figures.get(only.figure).unwrap_or(f64::NAN);
            self.relax(Relaxed { limit: **only, to, design });
        }
        let worst = broken.iter().map(|limit| limit.excess(&design.figures)).fold(0.0, f64::max);
        self.approach(design, worst);
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
