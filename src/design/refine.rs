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
mod tests;
