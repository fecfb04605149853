//! Sleeves that stiffen: a second pipe over, or in, a stretch of a straight pipe.
//!
//! Both are taken as bonded all along and concentric, so that they share every strain and their
//! stiffnesses EA, κGA, EI and GJ add up (J. M. Gere, *Mechanics of Materials*, 6th ed., § 6.2,
//! composite beams). At the ends of a real sleeve the adhesive takes about a diameter to hand the
//! load over: the sleeve bears a little less than that.

use super::{Pipe, Rod, Sleeve};
use crate::dual::Number;
use crate::section::Section;
use crate::units::MM;

/// What a stretch may miss of the pipe that holds it, m: stations of files are rounded.
const ROUNDED: f64 = 1e-6;

/// How far a press fit may overlap, m, on the diameter.
const PRESS_FIT: f64 = 0.1e-3;
/// What a bond fills, m, on the diameter: adhesives bear up to about a millimetre of thickness.
const MOST_GAP: f64 = 2e-3;

impl<T: Number> Rod<T> {
    /// The pipe at a station, m; at the corner or an end of the bend that beyond it.
    pub fn pipe_at(&self, station: T) -> &Pipe<T> {
        match station.value() {
            at if at < self.bend_start().value() => &self.pipe1,
            at if at < self.bend_end().value() => &self.bend,
            _ => &self.pipe2,
        }
    }

    /// The pipe at a station (m) and the sleeves that bear with it: all that shares the load there.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let steel = Material::isotropic("steel", 193e9, 0.29, 7930.0);
    /// let collar = Pipe::new(Round::tube(0.020, 0.016), steel.clone());
    /// let rod = Rod::new("L", 0.150, 0.525, Pipe::new(Round::tube(0.016, 0.012), steel))
    ///     .with_sleeve("collar", 0.100, 0.140, collar)
    ///     .checked()?;
    /// assert_eq!(rod.bearing_at(0.120).count(), 2);
    /// assert_eq!(rod.bearing_at(0.145).count(), 1);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    pub fn bearing_at(&self, station: T) -> impl Iterator<Item = &Pipe<T>> {
        let at = station.value();
        let is_straight = at < self.bend_start().value() || at >= self.bend_end().value();
        let covers = move |sleeve: &&Sleeve<T>| sleeve.from.value() <= at && at < sleeve.to.value();
        let sleeves = self.sleeves.iter().filter(move |_| is_straight).filter(covers);
        std::iter::once(self.pipe_at(station)).chain(sleeves.map(|sleeve| &sleeve.pipe))
    }

    /// The stretches between which what bears does not change, m: the pipes', cut where a sleeve
    /// begins or ends. A corner or bend without length is none.
    pub fn stretches(&self) -> Vec<[T; 2]> {
        let mut cuts = vec![T::zero(), self.bend_start(), self.bend_end(), self.length()];
        cuts.extend(self.sleeves.iter().flat_map(|sleeve| [sleeve.from, sleeve.to]));
        cuts.sort_by(|a, b| a.value().total_cmp(&b.value()));
        cuts.windows(2)
            .filter(|ends| ends[1].value() > ends[0].value())
            .map(|ends| [ends[0], ends[1]])
            .collect()
    }

    /// All pipes: pipe 1, the bend's, pipe 2 and the sleeves'.
    pub fn pipes_mut(&mut self) -> impl Iterator<Item = &mut Pipe<T>> {
        let sleeves = self.sleeves.iter_mut().map(|sleeve| &mut sleeve.pipe);
        [&mut self.pipe1, &mut self.bend, &mut self.pipe2].into_iter().chain(sleeves)
    }

    /// Stations of what sits along the rod: masses, joints and both ends of sleeves.
    pub fn stations_mut(&mut self) -> impl Iterator<Item = &mut T> {
        let masses = self.masses.iter_mut().map(|mass| &mut mass.station);
        let joints = self.joints.iter_mut().map(|joint| &mut joint.station);
        let sleeves = self.sleeves.iter_mut().flat_map(|sleeve| [&mut sleeve.from, &mut sleeve.to]);
        masses.chain(joints).chain(sleeves)
    }
}

/// What of a sleeve does not fit its rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Misfit {
    /// It does not lie on one straight pipe.
    Stretch,
    /// Its wall would be where that of the pipe, or of a sleeve before it, is.
    Wall,
    /// It is nowhere near the wall of the pipe, nor of another sleeve: nothing bonds it.
    Loose,
}

impl Rod {
    /// What of the first sleeve that does not fit is amiss.
    pub(crate) fn misfit(&self) -> Option<Misfit> {
        let misfit = |(k, sleeve): (usize, &Sleeve)| {
            let Sleeve { from, to, pipe, .. } = sleeve;
            if !self.holds(*from, *to) {
                return Some(Misfit::Stretch);
            }
            let walls = self.walls(&self.sleeves[..k], *from, *to);
            match walls.map(|(_, section)| section).any(|other| is_through(&pipe.section, other)) {
                true => Some(Misfit::Wall),
                false => self.gap(sleeve).map(|_| Misfit::Loose),
            }
        };
        self.sleeves.iter().enumerate().find_map(misfit)
    }

    /// The gap (m, on the diameter) between a sleeve of this rod and the wall that is nearest to
    /// it, where a bond does not fill it. Of rounds.
    pub(super) fn gap(&self, sleeve: &Sleeve) -> Option<f64> {
        let walls = self.walls(&self.sleeves, sleeve.from, sleeve.to);
        let others = walls.filter(|(other, _)| other.is_none_or(|other| !std::ptr::eq(other, sleeve)));
        let gaps = others.map(|(_, other)| gap(&sleeve.pipe.section, other).unwrap_or(0.0));
        let least = gaps.fold(f64::INFINITY, f64::min);
        (least > MOST_GAP).then_some(least)
    }

    fn holds(&self, from: f64, to: f64) -> bool {
        let within = |a: f64, b: f64| from >= a - ROUNDED && to <= b + ROUNDED;
        from < to && (within(0.0, self.bend_start()) || within(self.bend_end(), self.length()))
    }

    /// Why a stretch from station `from` to `to` (m) cannot carry a sleeve: what would be right.
    pub(super) fn no_stretch(&self, from: f64, to: f64) -> Option<String> {
        if self.holds(from, to) {
            return None;
        }
        // as a drawing has it: 150, not 150.000
        let mm = |station: f64| (station / MM * 1e3).round() / 1e3;
        Some(format!(
            "a stretch of one straight pipe, 0 to {} mm or {} to {} mm, its end beyond its beginning",
            mm(self.bend_start()),
            mm(self.bend_end()),
            mm(self.length())
        ))
    }

    /// A pipe or one of the sleeves `others` whose wall would be where that of `section` is, along
    /// a stretch from `from` to `to` (m), by its name. Of rounds; other sections are not compared.
    pub(super) fn in_the_way(
        &self,
        others: &[Sleeve],
        section: &Section,
        from: f64,
        to: f64,
    ) -> Option<String> {
        let (sleeve, _) = self.walls(others, from, to).find(|(_, other)| is_through(section, other))?;
        Some(match sleeve {
            Some(sleeve) => format!("sleeve \"{}\"", sleeve.name),
            None if is_on_first(self, from, to) => "pipe1".to_owned(),
            None => "pipe2".to_owned(),
        })
    }

    /// Sections along a stretch: the pipe's, then those of the sleeves `others` that are there.
    fn walls<'r>(
        &'r self,
        others: &'r [Sleeve],
        from: f64,
        to: f64,
    ) -> impl Iterator<Item = (Option<&'r Sleeve>, &'r Section)> {
        let pipe = if is_on_first(self, from, to) { &self.pipe1 } else { &self.pipe2 };
        let overlaps = move |sleeve: &&Sleeve| sleeve.from < to - ROUNDED && sleeve.to > from + ROUNDED;
        let sleeves = others.iter().filter(overlaps).map(|sleeve| (Some(sleeve), &sleeve.pipe.section));
        std::iter::once((None, &pipe.section)).chain(sleeves)
    }
}

fn is_on_first(rod: &Rod, from: f64, to: f64) -> bool {
    0.5 * (from + to) < rod.bend_start()
}

/// Between two tubes of which one is in the other, on the diameter, m.
fn gap(one: &Section, other: &Section) -> Option<f64> {
    let (a, b) = (one.as_round()?, other.as_round()?);
    Some((a.inner_diameter - b.outer_diameter).max(b.inner_diameter - a.outer_diameter))
}

/// True where two tubes would have to go through one another.
fn is_through(one: &Section, other: &Section) -> bool {
    match (one.as_round(), other.as_round()) {
        (Some(a), Some(b)) => {
            a.inner_diameter + PRESS_FIT < b.outer_diameter && b.inner_diameter + PRESS_FIT < a.outer_diameter
        }
        _ => false,
    }
}
