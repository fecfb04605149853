//! How well the figures of a design are known, and which designs cannot be distinguished.
//!
//! Every nominal number of the rod (E, G, ρ, diameters, lengths, …) has a standard uncertainty u; a
//! figure y moves with it by s = u·∂y/∂x. The standard uncertainty of y is √Σ s² (GUM, JCGM
//! 100:2008, 5.1.2). Two designs of one material share its moduli and its density, and with them
//! what these do: of their difference only the rest counts. Lengths and diameters are made anew for
//! each.

use super::figure::{Design, Figure, Figures, Goal};
use crate::rod::{NominalNumber, Rod};
use crate::statistics::HALF_95;

/// How well the figures of one design are known.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Intervals {
    /// For each nominal number how far it moves each figure, in the order of [`Figure::ALL`].
    shifts: Vec<(NominalNumber, [f64; 8])>,
    /// Half of each figure's 95 % interval, in the unit of its key; 0 of a price.
    pub half: Figures,
}

impl Intervals {
    /// Of one rod, whose figures have these derivatives ([`Figures::slopes`]).
    pub fn of(rod: &Rod, slopes: &[(NominalNumber, Figures)]) -> Intervals {
        let known = rod.nominal_numbers();
        let mut shifts = Vec::new();
        for (number, slopes) in slopes {
            let Some(nominal) = known.iter().find(|nominal| nominal.number == *number) else { continue };
            let by = slopes.0.map(|slope| slope * nominal.standard_uncertainty);
            shifts.push((number.clone(), by.map(|by| if by.is_finite() { by } else { 0.0 })));
        }
        let half = |k: usize| HALF_95 * shifts.iter().map(|(_, shift)| shift[k].powi(2)).sum::<f64>().sqrt();
        Intervals { half: Figures(std::array::from_fn(half)), shifts }
    }

    /// Half of the 95 % interval of the difference of two designs in one figure.
    fn half_of_difference(&self, other: &Intervals, figure: Figure) -> f64 {
        let k = figure as usize;
        let is_shared = |number: &NominalNumber| {
            matches!(
                number,
                NominalNumber::YoungsModulus(_)
                    | NominalNumber::ShearModulus(_)
                    | NominalNumber::Density(_)
                    | NominalNumber::ShearCoefficient(_)
                    | NominalNumber::TipMass
            )
        };
        let of_other = |number: &NominalNumber| {
            let same = other.shifts.iter().find(|(known, _)| known == number && is_shared(number));
            same.map(|(_, shift)| shift[k])
        };
        let own =
            self.shifts.iter().map(|(number, shift)| (shift[k] - of_other(number).unwrap_or(0.0)).powi(2));
        let has = |number: &NominalNumber| self.shifts.iter().any(|(known, _)| known == number);
        let others = other.shifts.iter().filter(|(number, _)| !(is_shared(number) && has(number)));
        HALF_95 * (own.sum::<f64>() + others.map(|(_, shift)| shift[k].powi(2)).sum::<f64>()).sqrt()
    }
}

/// For each design the other ones (by place) that differ from it in no goal by more than what is
/// known of the difference.
///
/// ```
/// use rodcal::design::{DesignSpace, Figures, Intervals, Searched, indistinguishable, search};
/// use rodcal::rod::Rod;
///
/// let space = DesignSpace::from_toml("design.toml", "
///     [geometry]
///     l1_mm = 150
///     l2_mm = [400, 525]
///     [catalogue]
///     file = \"builtin\"
///     [objectives]
///     minimise = [\"c_rod_um\"]
///     maximise = [\"reach_mm\"]
/// ", &|_| unreachable!())?;
/// let front = search(&space, Searched::All, &|_| {})?.front;
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let known = Intervals::of(&rod, &Figures::slopes(&rod)?);
/// // a tenth of a metre of reach is more than any tolerance of a length
/// let same = indistinguishable(&front, &vec![known; front.len()], &space.goals);
/// assert_eq!(same, [vec![], vec![]] as [Vec<usize>; 2]);
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn indistinguishable(designs: &[Design], intervals: &[Intervals], goals: &[Goal]) -> Vec<Vec<usize>> {
    let is_same = |a: usize, b: usize| {
        goals.iter().all(|goal| {
            let [x, y] = [a, b].map(|k| designs[k].figures.get(goal.figure).unwrap_or(f64::NAN));
            let [u, v] = [a, b].map(|k| intervals[k].half.get(goal.figure).unwrap_or(f64::NAN));
            // a difference is never known worse than by both together; most are farther apart
            let far = (x - y).abs();
            far <= u + v && far <= intervals[a].half_of_difference(&intervals[b], goal.figure)
        })
    };
    let count = designs.len().min(intervals.len());
    let equals_of = |a: usize| (0..count).filter(|&b| b != a && is_same(a, b)).collect();
    (0..count).map(equals_of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{DesignSpace, Searched, Study, search};

    fn space(l2: &str) -> DesignSpace {
        let text = format!(
            "[geometry]\nl1_mm = 150\nl2_mm = {l2}\n[catalogue]\nfile = \"t.csv\"\n[tip]\nmass_g = 60\n\
             [objectives]\nminimise = [\"c_rod_um\"]\nmaximise = [\"reach_mm\"]\n"
        );
        let tubes = "name,material,outer_diameter_mm,inner_diameter_mm\na,steel,32,30\n";
        DesignSpace::from_toml("d.toml", &text, &|name| Ok((name.to_owned(), tubes.to_owned()))).unwrap()
    }

    fn with_intervals(space: &DesignSpace) -> (Vec<Design>, Vec<Intervals>) {
        let designs = search(space, Searched::All, &|_| {}).unwrap().front;
        let of_design = |design: &Design| {
            let rod = space.rod(design.index).unwrap();
            Intervals::of(&rod, &Figures::slopes(&rod).unwrap())
        };
        let intervals = designs.iter().map(of_design).collect();
        (designs, intervals)
    }

    #[test]
    fn a_tip_is_as_far_as_its_two_lengths_say() {
        let (designs, intervals) = with_intervals(&space("525"));
        // an L: reach² = L1² + L2², each known to 0.3 mm
        let (l1, l2) = (150.0f64, 525.0f64);
        let reach = l1.hypot(l2);
        let half = HALF_95 * ((l1 * 0.3 / reach).powi(2) + (l2 * 0.3 / reach).powi(2)).sqrt();
        assert!((designs[0].figures.get(Figure::Reach).unwrap() - reach).abs() < 1e-9);
        assert!((intervals[0].half.get(Figure::Reach).unwrap() - half).abs() < 1e-5);
        // 30 µm of 1 mm of wall, and 1 % of E: some percent
        let share =
            intervals[0].half.get(Figure::CRod).unwrap() / designs[0].figures.get(Figure::CRod).unwrap();
        assert!((0.02..0.12).contains(&share), "{share}");
    }

    /// Of a long front not all designs are shown, and the one that cannot be distinguished is most
    /// likely among the others.
    #[test]
    fn a_design_is_compared_with_all_of_its_front() {
        let study =
            Study::new(space("{ from = 500, to = 510, step = 0.1 }"), Searched::All, None, &|_| {}).unwrap();
        assert_eq!((study.found.front.len(), study.known.len()), (101, 101));
        assert!(study.shown.len() < 50);
        for shown in &study.shown {
            // 0.1 mm are less than what 0.3 mm of either L2 leave
            let is_next = |place: &usize| place.abs_diff(shown.place) == 1;
            assert!(shown.indistinguishable.iter().any(is_next), "{}", shown.place);
            assert!(shown.indistinguishable.len() < 40);
        }
    }

    #[test]
    fn designs_of_one_material_differ_by_what_each_is_made_to() {
        let space = space("[525, 525.1, 600]");
        let (designs, intervals) = with_intervals(&space);
        assert_eq!(indistinguishable(&designs, &intervals, &space.goals), [vec![1], vec![0], vec![]]);
        // E is one and the same: the difference is better known than each by itself would let it
        let apart = intervals[0].half.get(Figure::CRod).unwrap() * 2f64.sqrt();
        assert!(intervals[0].half_of_difference(&intervals[1], Figure::CRod) < apart);
    }
}
