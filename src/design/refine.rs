//! From a design of the front to the best one between the grid's values, and back to tubes that can
//! be bought.
//!
//! The goal, or a weighted geometric mean of several, is bettered while no other goal loses and all
//! limits are kept. What the design file gives as a range may take any value between its ends, what
//! it gives as a list stays; outer diameter and wall may take any value between those of the
//! catalogue's tubes of that material (`variable`). A sequence of linear programs leads to a local
//! optimum (`sequence`), from this and other designs of the front, from rods all over the grid and,
//! once these have ended, from the ends of every range: the best is taken, and how many searches
//! came to it is said. Then the tubes of the catalogue are tried in
//! turn, and everything else once more with each.

mod sequence;
mod variable;
mod weights;

use self::sequence::Search;
use self::variable::{Variable, diameters, lengths, moved};
pub use self::weights::weights;
use super::figure::{Design, Figure, Figures};
use super::space::DesignSpace;
use crate::error::Result;
use crate::parallel::in_parallel;
use crate::rod::Rod;
use crate::section::Section;

/// Other designs of the front that the search starts from, evenly from end to end.
const STARTS: usize = 15;
/// Rods all over the grid that it starts from too: a front of one goal is a single design.
const SCATTERED: usize = 32;
/// Times that it goes from the best so far to the ends of all ranges.
const MOST_ROUNDS: usize = 3;
/// So many tubes are all tried; of more the nearest ones, of pairs of tubes the nearest to each.
const ALL_TUBES: usize = 200;
const TUBES: usize = 8;
const TUBES_OF_TWO: usize = 4;
/// Shapes that every tube is tried with, and by which share their lengths differ at least.
const SHAPES: usize = 4;
const OTHER_SHAPE: f64 = 0.05;
/// A gain that is none, and a share by which one end is as good as another.
const NOTHING: f64 = 1e-5;
const SAME: f64 = 1e-4;

/// A design between the values of the grid.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Better {
    /// The rod between the values of the grid.
    pub rod: Rod,
    /// Names of its tubes, one where they are the same; none of tubes that the catalogue does not
    /// have.
    pub tubes: Vec<String>,
    /// Figures of that rod, each in the unit of its key.
    pub figures: Figures,
    /// By which share its goal, or the weighted geometric mean of its goals, is better than that of
    /// the design it came from.
    pub gained: f64,
}

/// What became of a design of the front.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Refined {
    /// Place of the design on the front, from 0.
    pub place: usize,
    /// Figures of the design that the search started from, each in the unit of its key.
    pub from: Figures,
    /// What each goal weighed, 1 in all; those of no weight might not lose.
    pub weights: Vec<f64>,
    /// The best with any tube; none where nothing is gained.
    pub continuous: Option<Better>,
    /// The best with tubes of the catalogue; none where nothing is gained.
    pub catalogue: Option<Better>,
    /// Searches for the best with any tube, from rods all over the grid and from the ends of
    /// ranges, and how many of them led to it.
    pub starts: (usize, usize),
    /// Whether every tube of the catalogue was tried.
    pub is_every_tube: bool,
}

/// Refines the design at `place` of a front, bettering its goals by their [`weights`].
///
/// ```
/// use rodcal::design::{DesignSpace, Searched, refine, search, weights};
///
/// let space = DesignSpace::from_toml("design.toml", "
///     [geometry]
///     l1_mm = { from = 150, to = 300, step = 50 }
///     l2_mm = 400
///     [catalogue]
///     file = \"builtin\"
///     [constraints]
///     min_reach_mm = 440
///     [objectives]
///     minimise = [\"c_rod_um\"]
/// ", &|_| unreachable!())?;
/// let front = search(&space, Searched::All, &|_| {})?.front;
/// let refined = refine(&space, &front, 0, &weights(&space, None)?)?.expect("there is a design 0");
/// let better = refined.catalogue.expect("the shortest rod of that reach is between the steps");
/// // √(440² − 400²) mm
/// assert!((better.rod.l1 - 0.1833).abs() < 1e-3 && better.gained > 0.0, "{better:?}");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// What the beam model refuses.
pub fn refine(
    space: &DesignSpace,
    front: &[Design],
    place: usize,
    weights: &[f64],
) -> Result<Option<Refined>> {
    let Some(design) = front.get(place) else { return Ok(None) };
    let mut refined = Refined {
        place,
        from: design.figures,
        weights: weights.to_vec(),
        continuous: None,
        catalogue: None,
        starts: (0, 0),
        is_every_tube: space.is_one_tube && space.tubes.len() <= ALL_TUBES,
    };
    let search =
        |tubes: [usize; 2]| Search { space, from: &design.figures, weights, price: prices(space, tubes) };
    let own = search(space.choice(design.index).tubes);
    let worth = |figures: &Figures| if own.is_kept(figures) { own.gain(figures) } else { f64::NEG_INFINITY };

    // no rod of the grid is better than the best of its front
    let of_grid = (0..front.len()).fold(place, |best, k| {
        let (new, known) = (worth(&front[k].figures), worth(&front[best].figures));
        if new > known { k } else { best }
    });
    let mut starts: Vec<u64> =
        starts(front, [place, of_grid]).into_iter().map(|place| front[place].index).collect();
    let others: Vec<u64> = scattered(space).filter(|index| !starts.contains(index)).collect();
    starts.extend(others);
    let found = in_parallel(starts.len(), |k| from_grid(space, starts[k], &search));
    let mut ends = Vec::new();
    for found in found {
        ends.extend(found?);
    }
    // from the best of them to the ends of every range, as long as that betters
    for _ in 0..MOST_ROUNDS {
        let gain = |end: &End| worth(&end.figures);
        let Some(best) = ends.iter().max_by(|a, b| gain(a).total_cmp(&gain(b))) else { break };
        let (known, variables) = (gain(best), variables(space, &best.rod));
        let found = in_parallel(2 * variables.len(), |k| {
            from_end_of_range(best, &variables, k / 2, k % 2 == 1, &search(best.tubes))
        });
        let found: Vec<End> = found.into_iter().collect::<Result<_>>()?;
        let is_better = found.iter().any(|end| gain(end) > known + SAME);
        ends.extend(found);
        if !is_better {
            break;
        }
    }
    // the first of equal ones is the design's own
    let gains: Vec<f64> = ends.iter().map(|end: &End| worth(&end.figures)).collect();
    let most = gains.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let Some(best) = ends.iter().zip(&gains).find(|(_, gain)| **gain >= most - SAME).map(|(end, _)| end)
    else {
        return Ok(Some(refined));
    };
    refined.starts = (ends.len(), gains.iter().filter(|gain| **gain >= most - SAME).count());

    let better = |rod: Rod, tubes: Vec<String>, figures: Figures| {
        let gained = worth(&figures);
        (gained > NOTHING).then_some(Better { rod, tubes, figures, gained })
    };
    let of_catalogue = if refined.is_every_tube {
        (0..space.tubes.len()).map(|tube| [tube; 2]).collect()
    } else {
        nearest(space, [space.choice(design.index).tubes, best.tubes], &best.rod)
    };
    // with another tube another end may be the better one
    let shapes = shapes(&ends, best, &gains, &lengths(space, &best.rod));
    let tried = in_parallel(of_catalogue.len() * shapes.len(), |k| {
        let (tubes, shape) = (of_catalogue[k / shapes.len()], shapes[k % shapes.len()]);
        let [first, second] = tubes.map(|tube| space.tubes[tube].pipe.clone());
        let with = Rod { pipe1: first.clone(), bend: first, pipe2: second, ..shape.clone() };
        search(tubes).best(&with, &lengths(space, &with))
    });
    let of_shapes = of_catalogue.iter().flat_map(|tubes| std::iter::repeat_n(tubes, shapes.len()));
    for (tubes, found) in of_shapes.zip(tried) {
        let (rod, figures) = found?;
        let known = refined.catalogue.as_ref().map_or(0.0, |known| known.gained);
        let new = better(rod, names(space, *tubes), figures);
        if new.as_ref().is_some_and(|new| new.gained > known) {
            refined.catalogue = new;
        }
    }
    let grid = &front[of_grid];
    if worth(&grid.figures) > refined.catalogue.as_ref().map_or(0.0, |known| known.gained)
        && let Ok(rod) = space.rod(grid.index)
    {
        refined.catalogue = better(rod, names(space, space.choice(grid.index).tubes), grid.figures);
    }
    let tubes = if best.is_of_catalogue { names(space, best.tubes) } else { Vec::new() };
    refined.continuous = better(best.rod.clone(), tubes, best.figures);
    // what can be bought is one of those that could be
    let known = refined.continuous.as_ref().map_or(0.0, |known| known.gained);
    if refined.catalogue.as_ref().is_some_and(|bought| bought.gained > known) {
        refined.continuous.clone_from(&refined.catalogue);
    }
    Ok(Some(refined))
}

/// The best end and the next best ones of other lengths or other sleeves.
fn shapes<'e>(ends: &'e [End], best: &'e End, gains: &[f64], lengths: &[Variable]) -> Vec<&'e Rod> {
    let mut order: Vec<usize> = (0..ends.len()).filter(|&k| gains[k].is_finite()).collect();
    order.sort_by(|&a, &b| gains[b].total_cmp(&gains[a]));
    let is_other = |one: &Rod, other: &Rod| {
        let by = |length: &Variable| (length.value(one) / length.value(other)).ln().abs();
        one.sleeves != other.sleeves || lengths.iter().any(|length| by(length) > OTHER_SHAPE)
    };
    let mut shapes = vec![&best.rod];
    for k in order {
        if shapes.len() < SHAPES && shapes.iter().all(|known| is_other(&ends[k].rod, known)) {
            shapes.push(&ends[k].rod);
        }
    }
    shapes
}

/// Where a search ended.
struct End {
    rod: Rod,
    figures: Figures,
    /// Those that it began with, and whether it still has them.
    tubes: [usize; 2],
    is_of_catalogue: bool,
}

fn from_grid<'a>(
    space: &DesignSpace,
    index: u64,
    search: &impl Fn([usize; 2]) -> Search<'a>,
) -> Result<Option<End>> {
    let Ok(rod) = space.rod(index) else { return Ok(None) };
    let tubes = space.choice(index).tubes;
    let (best, figures) = search(tubes).best(&rod, &variables(space, &rod))?;
    let is_kept = best.pipe1.section == rod.pipe1.section && best.pipe2.section == rod.pipe2.section;
    Ok(Some(End { rod: best, figures, tubes, is_of_catalogue: is_kept }))
}

/// What may vary of a rod.
fn variables(space: &DesignSpace, rod: &Rod) -> Vec<Variable> {
    let mut all = lengths(space, rod);
    // a tube that nobody sells has no price
    if !space.goals.iter().any(|goal| goal.figure == Figure::Price) {
        all.extend(diameters(space, rod));
    }
    all
}

/// The best rod with one variable at an end of its range, then with it free again: that lies
/// beyond the ridge between two optima where any there is.
fn from_end_of_range(
    from: &End,
    variables: &[Variable],
    which: usize,
    is_upper: bool,
    search: &Search<'_>,
) -> Result<End> {
    let variable = &variables[which];
    let to = if is_upper { variable.high } else { variable.low };
    let there = moved(&from.rod, std::slice::from_ref(variable), &[(to / variable.value(&from.rod)).ln()]);
    let others: Vec<Variable> =
        variables.iter().enumerate().filter(|(k, _)| *k != which).map(|(_, other)| other.clone()).collect();
    let (held, _) = search.best(&there, &others)?;
    let (rod, figures) = search.best(&held, variables)?;
    let is_kept = rod.pipe1.section == from.rod.pipe1.section && rod.pipe2.section == from.rod.pipe2.section;
    Ok(End { rod, figures, tubes: from.tubes, is_of_catalogue: from.is_of_catalogue && is_kept })
}

/// Places on the front: these, then others evenly from end to end.
fn starts(front: &[Design], first: [usize; 2]) -> Vec<usize> {
    let last = front.len() - 1;
    let others: Vec<usize> = match front.len() {
        count if count <= STARTS + 1 => (0..count).collect(),
        _ => (0..STARTS).map(|k| k * last / (STARTS - 1)).collect(),
    };
    let mut all = first.to_vec();
    all.extend(others.into_iter().filter(|other| !first.contains(other)));
    all.dedup();
    all
}

/// Combinations all over the grid, whether they keep the limits or not: multiples of the golden
/// section leave no gap in what varies slowest (tubes, angles), nor in what varies fastest.
fn scattered(space: &DesignSpace) -> impl Iterator<Item = u64> {
    let golden = (5f64.sqrt() - 1.0) / 2.0;
    let count = space.combinations();
    let most = (SCATTERED as u64).min(count);
    (1..=most).map(move |k| ((k as f64 * golden).fract() * count as f64) as u64)
}

fn names(space: &DesignSpace, tubes: [usize; 2]) -> Vec<String> {
    let mut names = tubes.map(|tube| space.tubes[tube].name.clone()).to_vec();
    names.dedup();
    names
}

fn prices(space: &DesignSpace, tubes: [usize; 2]) -> [f64; 2] {
    tubes.map(|tube| space.tubes[tube].price_per_m.unwrap_or(f64::NAN))
}

/// Combinations of tubes near those of `rod`, and the ones that designs had.
fn nearest(space: &DesignSpace, had: [[usize; 2]; 2], rod: &Rod) -> Vec<[usize; 2]> {
    let near = |pipe: &crate::rod::Pipe, count: usize| -> Vec<usize> {
        let ln = |section: &Section| {
            section.as_round().map_or([f64::NAN; 2], |round| [round.outer_diameter.ln(), round.wall().ln()])
        };
        let [outer, wall] = ln(&pipe.section);
        let far = |tube: usize| {
            let [o, w] = ln(&space.tubes[tube].pipe.section);
            (o - outer).powi(2) + (w - wall).powi(2)
        };
        let same = |tube: &usize| space.tubes[*tube].pipe.material.name == pipe.material.name;
        let mut tubes: Vec<usize> = (0..space.tubes.len()).filter(same).collect();
        tubes.sort_by(|&a, &b| far(a).total_cmp(&far(b)));
        tubes.truncate(count);
        tubes
    };
    let mut all = had.to_vec();
    match space.is_one_tube {
        true => all.extend(near(&rod.pipe1, TUBES).into_iter().map(|tube| [tube; 2])),
        false => {
            let second = near(&rod.pipe2, TUBES_OF_TWO);
            let pairs = |first: usize| second.iter().map(move |&second| [first, second]);
            all.extend(near(&rod.pipe1, TUBES_OF_TWO).into_iter().flat_map(pairs));
        }
    }
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::TipSolver;
    use crate::design::{Goal, Searched, search};
    use crate::section::Round;

    const TUBES: &str = "name,material,outer_diameter_mm,inner_diameter_mm\nthin,steel,30,28\nmiddle,steel,32,29\n\
                         wide,steel,36,34\n";

    fn space(l1: &str, limits: &str) -> DesignSpace {
        let text = format!(
            "[geometry]\nl1_mm = {l1}\nl2_mm = {{ from = 300, to = 600, step = 100 }}\n[catalogue]\nfile = \"t.csv\"\n\
             [tip]\nmass_g = 60\n[constraints]\n{limits}\n[objectives]\nminimise = [\"c_rod_um\"]\n\
             maximise = [\"reach_mm\"]\n"
        );
        DesignSpace::from_toml("d.toml", &text, &|name| Ok((name.to_owned(), TUBES.to_owned()))).unwrap()
    }

    /// Beside all rods of a grid of 1 mm and 0.05 mm.
    #[test]
    fn no_rod_of_a_fine_grid_is_better() {
        let space =
            space("{ from = 100, to = 250, step = 50 }", "max_mass_g = 700\nmin_first_frequency_hz = 40");
        let front = search(&space, Searched::All, &|_| {}).unwrap().front;
        let place = 7;
        let start = front[place];
        let refined = refine(&space, &front, place, &[1.0, 0.0]).unwrap().unwrap();
        let (any, bought) = (refined.continuous.unwrap(), refined.catalogue.unwrap());
        assert!(any.gained >= bought.gained && bought.gained > 0.002, "{} {}", any.gained, bought.gained);
        for better in [&any, &bought] {
            let of_figure = |figure: Figure| better.figures.get(figure).unwrap();
            assert!(of_figure(Figure::Reach) >= start.figures.get(Figure::Reach).unwrap() * (1.0 - 1e-9));
            assert!(space.limits.iter().all(|limit| limit.is_kept(&better.figures)));
            let again = Figures::of(&better.rod, &mut TipSolver::default());
            assert_eq!(again.get(Figure::CRod), better.figures.get(Figure::CRod));
        }
        assert!(any.tubes.is_empty() && bought.tubes.len() == 1);
        let (reach, best) =
            (start.figures.get(Figure::Reach).unwrap(), any.figures.get(Figure::CRod).unwrap());
        let mut solver = TipSolver::default();
        let mut checked = 0;
        for l1 in (100..=250).step_by(2) {
            let l1 = f64::from(l1) * 1e-3;
            let Some(l2) = (1e-6 * reach * reach - l1 * l1).max(0.0).sqrt().into() else { continue };
            if !(0.3..=0.6).contains(&l2) {
                continue;
            }
            for (outer, wall) in (0..=24).flat_map(|k| (0..=10).map(move |j| (k, j))) {
                let (outer, wall) = (0.030 + 0.00025 * f64::from(outer), 0.001 + 0.00005 * f64::from(wall));
                let mut rod = any.rod.clone();
                (rod.l1, rod.l2) = (l1, l2);
                let section = Round::tube(outer, outer - 2.0 * wall).into();
                for pipe in [&mut rod.pipe1, &mut rod.bend, &mut rod.pipe2] {
                    pipe.section = section;
                }
                let figures = Figures::of(&rod, &mut solver);
                if figures.get(Figure::Mass).unwrap() <= 700.0 {
                    checked += 1;
                    let c_rod = figures.get(Figure::CRod).unwrap();
                    assert!(c_rod > best * (1.0 - 1e-6), "{l1} {l2} {outer} {wall}: {c_rod} {best}");
                }
            }
        }
        assert!(checked > 500, "{checked}");
    }

    /// Goals that are weighed may make up for one another: then other designs of the front count
    /// too.
    #[test]
    fn no_rod_of_the_grid_is_better_by_any_weights() {
        let space = space("{ from = 100, to = 250, step = 50 }", "max_mass_g = 700");
        let front = search(&space, Searched::All, &|_| {}).unwrap().front;
        let mut gained = 0;
        for (asked, given) in
            [("c_rod_um", [1.0, 0.0]), ("reach_mm", [0.0, 1.0]), ("c_rod_um=3,reach_mm=1", [0.75, 0.25])]
        {
            let weights = weights(&space, Some(asked)).unwrap();
            assert_eq!(weights, given);
            let start = &front[3];
            let refined = refine(&space, &front, 3, &weights).unwrap().unwrap();
            let score = |figures: &Figures| {
                let ln = |figure: Figure| figures.get(figure).unwrap().ln();
                weights[0] * ln(Figure::CRod) - weights[1] * ln(Figure::Reach)
            };
            let may_be = |design: &&Design| {
                let is_no_worse = |goal: &Goal| goal.cost(&design.figures) <= goal.cost(&start.figures);
                space.goals.iter().zip(&weights).all(|(goal, weight)| *weight > 0.0 || is_no_worse(goal))
            };
            let best = front.iter().filter(may_be).map(|d| score(&d.figures)).fold(f64::INFINITY, f64::min);
            // where nothing is gained the design stays
            let reached = |better: &Option<Better>| {
                score(better.as_ref().map_or(&start.figures, |better| &better.figures))
            };
            let (any, bought) = (reached(&refined.continuous), reached(&refined.catalogue));
            assert!(any <= bought && bought <= best + 1e-4, "{asked}: {any} {bought} {best}");
            gained += usize::from(refined.continuous.is_some());
            assert!(refined.is_every_tube && refined.starts.0 > 3 && refined.starts.1 > 0);
        }
        assert!(gained >= 2, "{gained}");
        for wrong in ["mass_g", "c_rod_um=0", "c_rod_um=x", "c_rod_um,c_rod_um", ""] {
            let error = weights(&space, Some(wrong)).unwrap_err().to_string();
            assert!(error.contains("refine-goal"), "{error}");
        }
    }

    /// A front of one goal is one design, and from there alone the search ends at a worse optimum
    /// than from a grid ten times as fine: it has to begin elsewhere too.
    #[test]
    fn a_coarse_grid_leads_to_the_optimum_of_a_fine_one() {
        let text = |step: f64, gamma: f64| {
            format!(
                "[geometry]\nl1_mm = {{ from = 65, to = 265, step = {step} }}\nl2_mm = {{ from = 250, to = 550, step = {step} \
                 }}\ngamma_deg = {{ from = 90, to = 150, step = {gamma} }}\n[catalogue]\nfile = \"t.csv\"\n[tip]\nmass_g = \
                 60\n[constraints]\nmax_mass_g = 700\nmax_flange_moment_nm = 1.5\nmin_reach_mm = 480\n[objectives]\nminimise = \
                 [\"c_rod_um\"]\n",
            )
        };
        let tubes = "name,material,outer_diameter_mm,inner_diameter_mm\na,steel,20,16\nb,steel,30,27\nc,steel,50,48\n";
        let best = |step: f64, gamma: f64| {
            let read = |name: &str| Ok((name.to_owned(), tubes.to_owned()));
            let space = DesignSpace::from_toml("d.toml", &text(step, gamma), &read).unwrap();
            let front = search(&space, Searched::All, &|_| {}).unwrap().front;
            let refined = refine(&space, &front, 0, &[1.0]).unwrap().unwrap();
            assert!(front.len() == 1 && refined.starts.0 > 1, "{:?}", refined.starts);
            let figures = refined.continuous.map_or(front[0].figures, |better| better.figures);
            figures.get(Figure::CRod).unwrap()
        };
        let (coarse, fine) = (best(50.0, 20.0), best(5.0, 5.0));
        assert!(coarse <= fine * (1.0 + 1e-3), "{coarse} {fine}");
    }

    /// A wide angle lets L2 be short, a right one lets the rod be stiff: between the two is a
    /// ridge.
    #[test]
    fn no_end_of_a_range_is_better_than_what_is_found_within() {
        // the aluminium of the built-in catalogue
        let is_of_it = |line: &&str| line.starts_with("name") || line.contains(",aluminium,");
        let tubes: Vec<&str> = crate::design::catalogue::BUILT_IN_TEXT.lines().filter(is_of_it).collect();
        let tubes = tubes.join("\n");
        let best = |gamma: &str| {
            let text = format!(
                "[geometry]\nl1_mm = {{ from = 71, to = 311, step = 30 }}\nl2_mm = {{ from = 389, to = 549, step = 20 }}\ngamma_deg \
                 = {gamma}\n[catalogue]\nfile = \"t.csv\"\n[tip]\nmass_g = 23\n[constraints]\nmax_mass_g = 408\nmin_reach_mm = \
                 514\n[objectives]\nminimise = [\"c_rod_um\"]\n"
            );
            let space = DesignSpace::from_toml("d.toml", &text, &|name| Ok((name.to_owned(), tubes.clone())))
                .unwrap();
            let front = search(&space, Searched::All, &|_| {}).unwrap().front;
            let refined = refine(&space, &front, 0, &[1.0]).unwrap().unwrap();
            let figures = refined.continuous.map_or(front[0].figures, |better| better.figures);
            figures.get(Figure::CRod).unwrap()
        };
        let (right, wide) = (best("90"), best("133"));
        let both = best("{ from = 90, to = 133, step = 10.75 }");
        assert!(both <= right.min(wide) * (1.0 + 1e-4), "{both}: {right} {wide}");
    }

    /// The grid ends at 500 mm, the range at 590 mm.
    #[test]
    fn a_range_goes_to_its_end_though_its_steps_do_not() {
        let text = "[geometry]\nl1_mm = 100\nl2_mm = { from = 300, to = 590, step = 100 }\n[catalogue]\nfile = \"t.csv\"\n\
                    [objectives]\nmaximise = [\"reach_mm\"]\n";
        let space =
            DesignSpace::from_toml("d.toml", text, &|name| Ok((name.to_owned(), TUBES.to_owned()))).unwrap();
        let front = search(&space, Searched::All, &|_| {}).unwrap().front;
        let refined = refine(&space, &front, 0, &[1.0]).unwrap().unwrap();
        for better in [refined.continuous.unwrap(), refined.catalogue.unwrap()] {
            assert!((better.rod.l2 - 0.590).abs() < 1e-6, "{}", better.rod.l2);
        }
    }

    #[test]
    fn where_nothing_may_vary_nothing_is_gained() {
        let text = "[geometry]\nl1_mm = 150\nl2_mm = 500\n[catalogue]\nfile = \"t.csv\"\n[objectives]\n\
                    minimise = [\"c_rod_um\"]\n";
        let one = &TUBES[..TUBES.find("middle").unwrap()];
        let space =
            DesignSpace::from_toml("d.toml", text, &|name| Ok((name.to_owned(), one.to_owned()))).unwrap();
        let front = search(&space, Searched::All, &|_| {}).unwrap().front;
        let refined = refine(&space, &front, 0, &[1.0]).unwrap().unwrap();
        assert!(refined.continuous.is_none() && refined.catalogue.is_none());
    }
}
