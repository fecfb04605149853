//! What a design must keep, and what no rod can be.

use super::figure::{Figure, Figures};

/// Share of a limit by which rounding may miss it: a reach of 100 mm and 600 mm is 700 mm.
const SLACK: f64 = 1e-9;

/// A limit on a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Limit {
    /// Its key in the design file.
    pub key: &'static str,
    /// Of which figure.
    pub figure: Figure,
    /// In the unit of the key.
    pub value: f64,
    /// True for a least value, false for a largest one.
    pub is_least: bool,
}

/// Keys of limits, which figure they hold, and whether they are least values. A tip's sag of 1 g is
/// C^g's largest entry.
pub(super) const KEYS: [(&str, Figure, bool); 6] = [
    ("max_mass_g", Figure::Mass, false),
    ("max_flange_moment_nm", Figure::Moment, false),
    ("max_tip_sag_um", Figure::CgMax, false),
    ("max_c_rod_um", Figure::CRod, false),
    ("min_reach_mm", Figure::Reach, true),
    ("min_first_frequency_hz", Figure::FirstFrequency, true),
];

impl Limit {
    /// How much the figure is beyond the limit, as a share of it; 0 or below where it is kept.
    pub(super) fn excess(&self, figures: &Figures) -> f64 {
        let value = figures.get(self.figure).unwrap_or(f64::NAN);
        match self.is_least {
            true => 1.0 - value / self.value,
            false => value / self.value - 1.0,
        }
    }

    /// True where the rod keeps it, to rounding; what has no value keeps nothing.
    pub(super) fn is_kept(&self, figures: &Figures) -> bool {
        self.excess(figures) <= SLACK
    }

    /// What the limit would have to be for a figure of this value, in four digits, on the safe side.
    pub fn relaxed_to(&self, value: f64) -> f64 {
        let step = 10f64.powf(value.abs().log10().floor() - 3.0);
        // what is a round number but for rounding stays one
        let steps = value / step;
        match self.is_least {
            true => (steps * (1.0 + SLACK)).floor() * step,
            false => (steps * (1.0 - SLACK)).ceil() * step,
        }
    }
}

/// Why a combination is no rod.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Impossible {
    /// The arc is longer than one of the pipes.
    BendDoesNotFit,
    /// The arc's radius is less than half of the tube.
    BendTighterThanTube,
    /// A mass or a joint would sit beyond the tip.
    StationBeyondTip,
}

impl Impossible {
    /// All of them.
    pub const ALL: [Impossible; 3] =
        [Impossible::BendDoesNotFit, Impossible::BendTighterThanTube, Impossible::StationBeyondTip];

    /// Its name in the JSON.
    pub fn key(self) -> &'static str {
        match self {
            Impossible::BendDoesNotFit => "bend_does_not_fit",
            Impossible::BendTighterThanTube => "bend_tighter_than_tube",
            Impossible::StationBeyondTip => "station_beyond_tip",
        }
    }

    /// For people.
    pub fn words(self) -> &'static str {
        match self {
            Impossible::BendDoesNotFit => "the bend does not fit between the pipes",
            Impossible::BendTighterThanTube => "the bend is tighter than the tube is thick",
            Impossible::StationBeyondTip => "a mass or a joint would sit beyond the tip",
        }
    }
}
