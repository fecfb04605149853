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
    pub fn is_kept(&self, figures: &Figures) -> bool {
        self.excess(figures) <= SLACK
    }

    /// What the limit would have to be for a figure of this value, in four digits, on the safe
    /// side.
    pub fn relaxed_to(&self, value: f64) -> f64 {
        if value == 0.0 || !value.is_finite() {
            return value;
        }
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
    /// A sleeve would lie over the corner or bend, or beyond the tip.
    SleeveNotOnOnePipe,
    /// The wall of a sleeve would be where that of a tube is.
    SleeveInTheWay,
    /// A sleeve would be too far from any wall for a bond.
    SleeveLoose,
    /// The corner takes more of a pipe than there is: one pipe would end within the other, or
    /// within the flange.
    CornerDoesNotFit,
}

impl Impossible {
    /// All of them.
    pub const ALL: [Impossible; Impossible::COUNT] = [
        Impossible::BendDoesNotFit,
        Impossible::BendTighterThanTube,
        Impossible::StationBeyondTip,
        Impossible::SleeveNotOnOnePipe,
        Impossible::SleeveInTheWay,
        Impossible::SleeveLoose,
        Impossible::CornerDoesNotFit,
    ];

    /// Number of them.
    pub const COUNT: usize = 7;

    /// Its name in the JSON.
    pub fn key(self) -> &'static str {
        match self {
            Impossible::BendDoesNotFit => "bend_does_not_fit",
            Impossible::BendTighterThanTube => "bend_tighter_than_tube",
            Impossible::StationBeyondTip => "station_beyond_tip",
            Impossible::SleeveNotOnOnePipe => "sleeve_not_on_one_pipe",
            Impossible::SleeveInTheWay => "sleeve_in_the_way",
            Impossible::SleeveLoose => "sleeve_loose",
            Impossible::CornerDoesNotFit => "corner_does_not_fit",
        }
    }

    /// For people.
    pub fn description(self) -> &'static str {
        match self {
            Impossible::BendDoesNotFit => "the bend does not fit between the pipes",
            Impossible::BendTighterThanTube => "the bend is tighter than the tube is thick",
            Impossible::StationBeyondTip => "a mass or a joint would sit beyond the tip",
            Impossible::SleeveNotOnOnePipe => "a sleeve would not lie on one straight pipe",
            Impossible::SleeveInTheWay => "a sleeve fits neither over nor in the tube",
            Impossible::SleeveLoose => "a sleeve would be more than a millimetre away from the tube",
            Impossible::CornerDoesNotFit => {
                "a pipe is too short for the corner: one would end within the other"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::TipSolver;
    use crate::material::Material;
    use crate::rod::{Pipe, Rod};
    use crate::section::Round;

    /// √(x² + z²) of a straight rod misses the sum of its lengths by rounding.
    #[test]
    fn a_limit_that_is_met_exactly_is_kept() {
        let steel = Material::isotropic("steel", 200e9, 0.3, 7900.0);
        let tube = Pipe::new(Round::tube(0.030, 0.028), steel);
        let mut missed = 0;
        for (l1, l2) in (10..60).flat_map(|k| (10..60).map(move |j| (f64::from(k), f64::from(j)))) {
            let rod = Rod::new("straight", 0.01 * l1, 0.01 * l2, tube.clone());
            let figures = Figures::of(&rod.with_angle(std::f64::consts::PI), &mut TipSolver::default());
            let reach = figures.get(Figure::Reach).unwrap();
            let limit = |is_least: bool| Limit {
                key: "reach_mm",
                figure: Figure::Reach,
                value: 10.0 * (l1 + l2),
                is_least,
            };
            for limit in [limit(true), limit(false)] {
                assert!(limit.is_kept(&figures), "{l1} {l2} {reach}");
                assert!((limit.relaxed_to(reach) - limit.value).abs() < 1e-9, "{reach}");
            }
            missed += usize::from(reach < 10.0 * (l1 + l2));
        }
        assert!(missed > 0);
    }

    #[test]
    fn what_is_beyond_a_limit_breaks_it_and_is_rounded_to_the_safe_side() {
        let limit = |is_least| Limit { key: "max_mass_g", figure: Figure::Mass, value: 700.0, is_least };
        let weighing = |mass: f64| Figures([f64::NAN; 8]).with(Figure::Mass, mass);
        assert!(!limit(false).is_kept(&weighing(700.001)) && !limit(true).is_kept(&weighing(699.999)));
        assert!(!limit(false).is_kept(&weighing(f64::NAN)));
        assert!((limit(false).relaxed_to(712.34) - 712.4).abs() < 1e-9);
        assert!((limit(true).relaxed_to(0.071_239) - 0.071_23).abs() < 1e-12);
        assert_eq!(limit(true).relaxed_to(0.0), 0.0);
    }
}
