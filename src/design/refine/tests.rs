//! Refined designs against a fine grid, and where they may end.

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
    let space = space("{ from = 100, to = 250, step = 50 }", "max_mass_g = 700\nmin_first_frequency_hz = 40");
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
    let (reach, best) = (start.figures.get(Figure::Reach).unwrap(), any.figures.get(Figure::CRod).unwrap());
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
        let reached =
            |better: &Option<Better>| score(better.as_ref().map_or(&start.figures, |better| &better.figures));
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
    let tubes =
        "name,material,outer_diameter_mm,inner_diameter_mm\na,steel,20,16\nb,steel,30,27\nc,steel,50,48\n";
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
        let space =
            DesignSpace::from_toml("d.toml", &text, &|name| Ok((name.to_owned(), tubes.clone()))).unwrap();
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
