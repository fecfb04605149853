//! What a search finds.

use approx::assert_relative_eq;

use super::*;
use crate::beam::Physics;
use crate::compliance::{Compliance, DEFAULT_ELEMENTS, paper_contact_force};
use crate::design::Goal;
use crate::design::nearest::Relaxed;
use crate::units::UM;

const TEXT: &str = "
[geometry]
l1_mm = [100, 200, 300]
l2_mm = { from = 300, to = 600, step = 50 }
gamma_deg = [90, 120]
bend_radius_mm = [0, 10, 40, 120]
[catalogue]
file = \"tubes.csv\"
same_tube = false
[tip]
mass_g = [0, 60]
[constraints]
max_mass_g = 700
min_first_frequency_hz = 25
max_flange_moment_nm = 2.5
[objectives]
minimise = [\"c_rod_um\", \"price\"]
maximise = [\"reach_mm\"]
";
const TUBES: &str = "name,material,outer_diameter_mm,inner_diameter_mm,price_per_m
a,steel,25,22,10
b,aluminium,40,36,14
c,carbon-wrapped,30,28,60
";

fn space(text: &str) -> DesignSpace {
    DesignSpace::from_toml("design.toml", text, &|name| Ok((name.to_owned(), TUBES.to_owned()))).unwrap()
}

/// A sleeve over the end of the first pipe, where that is long enough and not too thick.
const SLEEVE: &str = "[[sleeve]]
name = \"collar\"
from_mm = 120
to_mm = 180
material = \"steel\"
outer_diameter_mm = 39
inner_diameter_mm = 31
";

#[test]
fn the_search_is_that_of_looking_at_every_rod() {
    let space = space(TEXT);
    assert_eq!(space.combinations(), 3 * 7 * 2 * 4 * 2 * 9);
    let impossible = looked_at_one_by_one(&space);
    assert!(impossible[0] > 0 && impossible[1] > 0);
}

/// Figures of rods with a sleeve are those of the whole model, and it fits or does not.
#[test]
fn a_sleeve_sits_on_every_rod_that_can_hold_it() {
    let with = space(&format!("{TEXT}{SLEEVE}"));
    let impossible = looked_at_one_by_one(&with);
    assert!(impossible[Impossible::SleeveNotOnOnePipe as usize] > 0);
    assert!(impossible[Impossible::SleeveInTheWay as usize] > 0);
    let bare = space(TEXT);
    let mut solver = TipSolver::default();
    let both = |index: u64| Some((with.rod(index).ok()?, bare.rod(index).ok()?));
    let mut compared = 0;
    for (sleeved, bare) in (0..with.combinations()).step_by(7).filter_map(both) {
        let own = Figures::of(&sleeved, &mut solver);
        let model = Compliance::of_model(&sleeved, &Physics::default(), DEFAULT_ELEMENTS).unwrap();
        let c_rod = model.index(paper_contact_force()) / UM;
        assert_relative_eq!(own.get(Figure::CRod).unwrap(), c_rod, max_relative = 1e-9);
        let without = Figures::of(&bare, &mut solver);
        assert!(own.get(Figure::Mass) > without.get(Figure::Mass));
        assert!(own.get(Figure::CRod) != without.get(Figure::CRod));
        assert_eq!(Rod::from_toml("written.toml", &sleeved.to_toml(&[])).unwrap().sleeves.len(), 1);
        compared += 1;
    }
    assert!(compared > 20, "{compared}");
}

/// Every selection of two of them is looked at, each with what always sits there before it.
#[test]
fn an_optional_sleeve_is_there_or_not() {
    // over the aluminium tube
    let collar = SLEEVE.replace("= 39", "= 45").replace("= 31", "= 41");
    let optional = collar.replace("[[sleeve]]", "[[optional_sleeve]]");
    // in its bore
    let stub = optional.replace("collar", "stub").replace("= 120", "= 0").replace("= 180", "= 90");
    let stub = stub.replace("steel", "carbon-wrapped").replace("= 45", "= 36").replace("= 41", "= 33");
    let (bare, chosen) = (space(TEXT), space(&format!("{TEXT}{optional}{stub}")));
    assert_eq!(chosen.combinations(), 4 * bare.combinations());
    let front = |space: &DesignSpace| search(space, Searched::All, &|_| {}).unwrap().front;
    for (selection, names) in
        [vec![], vec!["collar"], vec!["stub"], vec!["collar", "stub"]].iter().enumerate()
    {
        let one = bare.combinations();
        let rods = (0..one).filter_map(|index| chosen.rod(selection as u64 * one + index).ok());
        let rods: Vec<Rod> = rods.collect();
        assert!(rods.len() > 100, "{names:?}");
        let named = |rod: &Rod| rod.sleeves.iter().map(|sleeve| sleeve.name.clone()).collect::<Vec<_>>();
        assert!(rods.iter().all(|rod| named(rod) == *names));
    }
    looked_at_one_by_one(&chosen);
    // a stub is worth its weight on some rods and not on others
    let with = |design: &Design| !chosen.rod(design.index).unwrap().sleeves.is_empty();
    let (sleeved, all) = (front(&chosen).iter().filter(|design| with(design)).count(), front(&chosen).len());
    assert!(0 < sleeved && sleeved < all, "{sleeved} of {all}");
    // on every rod they are those that are not optional
    let always = space(&format!("{TEXT}{collar}"));
    let index = chosen.combinations() / 4 + 1000;
    assert_eq!(chosen.rod(index).ok().map(|rod| rod.sleeves), always.rod(1000).ok().map(|rod| rod.sleeves));
}

/// All combinations one by one, without anything that saves time; gives why some are no rods.
fn looked_at_one_by_one(space: &DesignSpace) -> [u64; Impossible::COUNT] {
    let count = space.combinations();
    let mut solver = TipSolver::default();
    let (mut front, mut feasible, mut impossible) = (Front::new(&space.goals), 0, [0; Impossible::COUNT]);
    for index in 0..count {
        match space.rod(index) {
            Err(why) => impossible[why as usize] += 1,
            Ok(rod) => {
                let figures = Figures::of(&rod, &mut solver).with_frequency(&rod).unwrap();
                let mut figures = figures;
                figures.set(Figure::Price, space.price(&space.choice(index)));
                if space.limits.iter().all(|limit| limit.is_kept(&figures)) {
                    feasible += 1;
                    front.offer(Design { index, figures });
                }
            }
        }
    }
    let found = search(space, Searched::All, &|_| {}).unwrap();
    assert_eq!((found.evaluated, found.feasible, found.impossible), (count, feasible, impossible));
    assert!(feasible > 100);
    assert_eq!(found.front, front.sorted());
    assert!(found.broken.iter().all(|count| *count > 0) && found.nearest.is_none());
    impossible
}

#[test]
fn where_nothing_fits_the_limit_that_would_do_is_named() {
    let text = TEXT.replace("max_mass_g = 700", "max_mass_g = 40");
    let tight = space(&text);
    let found = search(&tight, Searched::All, &|_| {}).unwrap();
    assert_eq!((found.feasible, found.front.len()), (0, 0));
    let nearest = found.nearest.unwrap();
    let relaxed = nearest.one_limit.iter().find(|one| one.limit.key == "max_mass_g").unwrap();
    // just below what is needed there is still nothing, just above there is
    for (limit, count) in [(relaxed.to * 0.999, 0), (relaxed.to * 1.001, 1)] {
        let text = TEXT.replace("max_mass_g = 700", &format!("max_mass_g = {limit}"));
        let found = search(&space(&text), Searched::All, &|_| {}).unwrap();
        assert_eq!(found.feasible.min(1), count, "{limit}");
    }
}

/// Also where several limits must give, one of them the frequency.
#[test]
fn the_nearest_design_is_that_of_looking_at_every_figure() {
    for (frequency, mass, moment) in [(1000, 400, 9.0), (900, 50, 0.2), (25, 50, 0.1), (60, 10, 9.0)] {
        let text = TEXT
            .replace("= 25", &format!("= {frequency}"))
            .replace("= 700", &format!("= {mass}"))
            .replace("= 2.5", &format!("= {moment}"));
        let space = space(&text);
        let (mut solver, mut nearest) = (TipSolver::default(), Nearest::default());
        for index in 0..space.combinations() {
            let Ok(rod) = space.rod(index) else { continue };
            let figures = Figures::of(&rod, &mut solver).with_frequency(&rod).unwrap();
            let figures = figures.with(Figure::Price, space.price(&space.choice(index)));
            let broken: Vec<&Limit> = space.limits.iter().filter(|limit| !limit.is_kept(&figures)).collect();
            assert!(!broken.is_empty());
            nearest.offer(Design { index, figures }, &broken);
        }
        let found = search(&space, Searched::All, &|_| {}).unwrap().nearest.unwrap();
        assert_eq!(found.all_limits, nearest.all_limits);
        let in_order = |mut all: Vec<Relaxed>| {
            all.sort_by_key(|one| one.limit.key);
            all
        };
        assert_eq!(in_order(found.one_limit), in_order(nearest.one_limit));
    }
}

/// A pipe of 50 mm has no room at a corner 5 mm above the flange.
#[test]
fn pipes_that_would_end_within_each_other_are_no_rods() {
    let space = space(
        "[geometry]\nl1_mm = [5, 19, 21, 100]\nl2_mm = 300\ngamma_deg = [30, 90, 180]\n[catalogue]\nfile = \"t\"\n\
         [objectives]\nminimise = [\"c_rod_um\"]\n",
    );
    let mut possible: Vec<(f64, f64, f64)> = (0..space.combinations())
        .filter_map(|index| space.rod(index).ok())
        .filter(|rod| rod.pipe1.section.height() > 0.035)
        .map(|rod| (rod.gamma, rod.l1, rod.pipe1.section.height()))
        .collect();
    possible.sort_by(|a, b| a.partial_cmp(b).unwrap());
    // tubes of 40 mm: at 30° the corner takes 74.6 mm of each pipe, at 90° 20 mm, straight on
    // nothing
    let expected = [
        (30.0, 100.0),
        (90.0, 21.0),
        (90.0, 100.0),
        (180.0, 5.0),
        (180.0, 19.0),
        (180.0, 21.0),
        (180.0, 100.0),
    ];
    let found: Vec<(f64, f64)> =
        possible.iter().map(|(gamma, l1, _)| (gamma.to_degrees().round(), (1e3 * l1).round())).collect();
    assert_eq!(found, expected);
}

#[test]
fn a_sample_is_spread_evenly_and_always_the_same() {
    let mut space = space(TEXT);
    space.goals.truncate(1);
    let searched = |samples, seed| search(&space, Searched::Samples(samples, seed), &|_| {}).unwrap();
    let (one, two) = (searched(200, 1), searched(200, 1));
    assert_eq!((one.evaluated, &one.front), (200, &two.front));
    assert!(one.feasible != searched(200, 2).feasible || one.front != searched(200, 2).front);
    assert_eq!(searched(1_000_000, 1).evaluated, space.combinations());
    assert!(search(&space, Searched::Samples(0, 1), &|_| {}).is_err());
}

#[test]
fn one_goal_gives_the_best_rod_and_its_equals() {
    let mut space = space(TEXT);
    space.goals = vec![Goal { figure: Figure::Reach, is_maximised: true }];
    space.limits.clear();
    let found = search(&space, Searched::All, &|_| {}).unwrap();
    // L1 300, L2 600 at 120°: with every tube, tip and bend that fits
    let reach = |design: &Design| design.figures.get(Figure::Reach).unwrap();
    assert!(found.front.len() > 10);
    assert!(
        found.front.iter().all(|design| (reach(design) - 793.725).abs() < 1e-3),
        "{}",
        reach(&found.front[0])
    );
}
