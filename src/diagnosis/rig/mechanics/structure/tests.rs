//! Beside the beam model of the same rod.

use super::*;
use crate::material::Material;
use crate::rod::{Joint, NominalNumber};
use crate::section::Round;
use crate::spatial::Axis;
use approx::assert_relative_eq;

fn rod(bend: &str) -> Rod {
    let joint = "[[joint]]\nname = \"sleeve\"\nstation_mm = 205.0\nbending_urad_per_nm = 20\n";
    let text = include_str!("../../../../../rods/5.toml").replace("bend_radius_mm = 0.0 ", bend) + joint;
    Rod::from_toml("rod", &text).unwrap()
}

/// A sleeve whose E and G are not in the ratio of the pipes', in pipe II.
fn with_sleeve(rod: &Rod) -> Rod {
    let brass = Material::with_moduli("brass", 100e9, 30e9, 8500.0);
    rod.clone().with_sleeve("collar", 0.25, 0.33, Pipe::new(Round::tube(0.036, 0.032), brass))
}

fn pairs(rod: &Rod) -> Vec<(f64, f64)> {
    vec![(rod.length(), rod.length()), (0.3, rod.length()), (0.4, 0.1)]
}

fn assert_same(a: &Parts, b: &Parts, within: f64) {
    for (a, b) in a.iter().zip(b) {
        assert_relative_eq!(*a, *b, epsilon = within * a.amax());
    }
}

#[test]
fn nothing_wrong_is_the_rod_itself_to_the_last_digit() {
    let rod = rod("bend_radius_mm = 40\nbend_flexibility = 1.3");
    let structure = Structure::new(&rod, pairs(&rod)).unwrap();
    assert_eq!(structure.softened(&Softening::default()), responses(&rod, &pairs(&rod)).unwrap());
}

#[test]
fn everything_wrong_at_once_is_the_beam_model_of_that_rod() {
    let plain = rod("bend_radius_mm = 40\nbend_flexibility = 1.3");
    // in the sleeve κ follows E/G of two materials
    for (rod, within) in [(with_sleeve(&plain), 1e-8), (plain, 1e-11)] {
        let mut structure = Structure::new(&rod, pairs(&rod)).unwrap();
        let mut wrong = with_moduli(&rod, 0.7, 0.7 * 1.2);
        wrong.bend_flexibility = BendFlexibility::Factor(2.1);
        // on pipe I, within the bend and at its end
        let middle = (rod.bend_start() + rod.bend_end()) / 2.0;
        let mut joints = Vec::new();
        for station in [0.06, middle, rod.bend_end()] {
            let [bending, torsion] = structure.add_joint(station);
            joints.extend([(bending, 3e-5), (torsion, 5e-5)]);
            wrong.joints.push(Joint { name: "new".into(), station, bending: 3e-5, torsion: 5e-5 });
        }
        wrong.joints[0].bending = 5e-5;
        let [declared, _] = structure.add_joint(0.205);
        joints.push((declared, 3e-5));
        let softening =
            Softening { stiffness: 0.7, shear: 1.2, bend: 2.1 - 1.3, joints, ..Softening::default() };
        assert_same(&structure.softened(&softening), &responses(&wrong, &pairs(&rod)).unwrap(), within);
    }
}

#[test]
fn a_pipe_that_is_softer_by_itself_is_the_rod_with_its_moduli() {
    for rod in
        [with_sleeve(&rod("bend_radius_mm = 0.0 ")), rod("bend_radius_mm = 40\nbend_flexibility = 1.3")]
    {
        let structure = Structure::new(&rod, pairs(&rod)).unwrap();
        for pipe in WhichPipe::BOTH {
            let mut pipes = [1.0; 2];
            pipes[pipe as usize] = 0.6;
            let expected = responses(&with_stiffer(&rod, pipe, 0.6), &pairs(&rod)).unwrap();
            assert_same(&structure.softened(&Softening { pipes, ..Softening::default() }), &expected, 1e-9);
        }
        // both together are the whole but for the bend
        if rod.bend == rod.pipe1 {
            let both = structure.softened(&Softening { pipes: [0.6; 2], ..Softening::default() });
            let all = structure.softened(&Softening { stiffness: 0.6, ..Softening::default() });
            assert_same(&both, &all, 1e-9);
        }
    }
}

#[test]
fn pipes_that_are_softer_everywhere_are_a_softer_rod_and_a_soft_end_is_not_seen_before_it() {
    let rod = Rod { joints: Vec::new(), ..with_sleeve(&rod("bend_radius_mm = 0.0 ")) };
    let structure = Structure::new(&rod, pairs(&rod)).unwrap();
    let softer = structure.softened(&Softening { stiffness: 1.0 / 1.1, ..Softening::default() });
    // but for shear and extension, which matter near the root
    for (k, more) in structure.varying(&|_| 0.1).into_iter().take(2).enumerate() {
        let expected = softer[k] - structure.whole[k];
        assert!((more - expected).amax() < 0.02 * expected.amax(), "{more} {expected}");
    }
    let soft_end = structure.varying(&|station| if station > 0.35 { 0.1 } else { 0.0 });
    assert!(soft_end[0].amax() > 0.0 && soft_end[1].amax() == 0.0 && soft_end[2].amax() == 0.0);
}

#[test]
fn a_corner_has_no_arc_and_the_rotation_is_that_of_a_moment() {
    let rod = rod("bend_radius_mm = 0.0 ");
    let structure = Structure::new(&rod, pairs(&rod)).unwrap();
    assert!(!structure.has_arc());
    let section = rod.pipe1.section.second_moment();
    assert_relative_eq!(structure.rotation()[0], 0.675 / (193e9 * section), max_relative = 1e-12);
    // 80 mm of it are stiffened
    let sleeved = Structure::new(&with_sleeve(&rod), pairs(&rod)).unwrap();
    let both = 193e9 * section + 100e9 * Round::tube(0.036, 0.032).second_moment();
    let expected = 0.595 / (193e9 * section) + 0.080 / both;
    assert_relative_eq!(sleeved.rotation()[0], expected, max_relative = 1e-12);
}

/// Softer, with a joint in the bend and one in pipe II: what a variation must go along with.
fn weakened(structure: &mut Structure, rod: &Rod) -> (Softening, Rod) {
    let mut weak = with_moduli(rod, 0.8, 0.8 * 0.9);
    let mut joints = Vec::new();
    for station in [rod.bend_start(), 0.35] {
        let [bending, torsion] = structure.add_joint(station);
        joints.extend([(bending, 3e-5), (torsion, 2e-5)]);
        weak.joints.push(Joint { name: "new".into(), station, bending: 3e-5, torsion: 2e-5 });
    }
    (Softening { stiffness: 0.8, shear: 0.9, joints, ..Softening::default() }, weak)
}

#[test]
fn a_length_or_an_angle_that_is_another_one_is_the_beam_model_of_that_rod() {
    let rod = rod("bend_radius_mm = 40\nbend_flexibility = 1.3");
    let tips = vec![(rod.length(), rod.length()), (0.3, rod.length())];
    for (number, value, by, most, within) in [
        (NominalNumber::LengthL1, rod.l1, 0.012, 0.03, 1e-9),
        (NominalNumber::LengthL2, rod.l2, -0.037, 0.13, 1e-9),
        (NominalNumber::Angle, rod.gamma, 0.06, 0.26, 2e-3),
    ] {
        let mut structure = Structure::new(&rod, tips.clone()).unwrap();
        // with joints that were there before the variation, and one that came after it
        let (mut softening, weak) = weakened(&mut structure, &rod);
        let own = structure.add_variation(Varied::Number(number.clone(), value), most).unwrap();
        let [late, _] = structure.add_joint(0.55);
        let unvaried = structure.softened(&softening);
        softening.variants.push(variant(own, value + by));
        softening.joints.push((late, 0.0));

        let mut other = weak.with(&number, value + by);
        let stations = weak.joints.iter().map(|joint| variation::moved(&weak, &other, joint.station));
        let stations: Vec<f64> = stations.collect();
        other.joints.iter_mut().zip(stations).for_each(|(joint, station)| joint.station = station);
        let expected = responses(&other, &[(other.length(), other.length()), (0.3, other.length())]).unwrap();
        for ((varied, expected), before) in structure.softened(&softening).iter().zip(&expected).zip(unvaried)
        {
            let change = (expected - before).amax();
            assert!((varied - expected).amax() < within * change, "{number}: {varied} {expected}");
        }
        // at the file's own value it is the structure itself
        softening.variants = vec![variant(own, value)];
        assert_same(&structure.softened(&softening), &unvaried_of(&structure, &softening), 1e-14);
    }
}

fn variant(variation: usize, value: f64) -> Variant {
    Variant { variation, value, axes: [true; 3] }
}

fn unvaried_of(structure: &Structure, softening: &Softening) -> Parts {
    structure.softened(&Softening { variants: Vec::new(), ..softening.clone() })
}

#[test]
fn a_load_or_a_sensor_elsewhere_along_the_rod_is_the_beam_model_there() {
    let rod = rod("bend_radius_mm = 0.0 ");
    let tip = rod.length();
    for (end, station, by) in [
        (End::Load, tip, -0.06),
        (End::Reading, tip, -0.02),
        (End::Load, 0.4, 0.03),
        (End::Reading, 0.4, -0.05),
    ] {
        let mut structure = Structure::new(&rod, vec![(tip, tip), (0.4, tip), (tip, 0.4)]).unwrap();
        let (mut softening, weak) = weakened(&mut structure, &rod);
        let own = structure.add_variation(Varied::Along(end, station), 0.1).unwrap();
        let before = structure.softened(&softening);
        softening.variants.push(variant(own, by));
        let moved = |[load, read]: [f64; 2]| {
            let shift = |at: f64, own: End| if at == station && own == end { at + by } else { at };
            (shift(load, End::Load), shift(read, End::Reading))
        };
        let expected = responses(&weak, &[[tip, tip], [0.4, tip], [tip, 0.4]].map(moved)).unwrap();
        let mut is_moved = false;
        for ((varied, expected), before) in structure.softened(&softening).iter().zip(&expected).zip(before) {
            let change = (expected - before).amax();
            is_moved |= change > 0.0;
            // of the change, where another joint passes by, and nothing where it is another station
            assert!(
                (varied - expected).amax() <= 0.01 * change + 1e-15,
                "{end:?} {station}: {} of {change}",
                (varied - expected).amax()
            );
        }
        assert!(is_moved);
    }
}

#[test]
fn beside_the_rod_a_load_twists_it_and_a_reading_is_its_reciprocal() {
    let rod = rod("bend_radius_mm = 0.0 ");
    let (tip, arm) = (rod.length(), 0.015);
    let beside = |end: End, axis: Axis, mask: [bool; 3]| {
        let mut structure = Structure::new(&rod, vec![(tip, 0.4), (0.4, tip)]).unwrap();
        let own = structure.add_variation(Varied::Beside(end, tip, axis), 0.02).unwrap();
        let variants = vec![Variant { axes: mask, ..variant(own, arm) }];
        structure.softened(&Softening { variants, ..Softening::default() })
    };
    for axis in Axis::ALL {
        let [load, read] = [End::Load, End::Reading].map(|end| beside(end, axis, [true; 3]));
        assert_relative_eq!(load[0], read[1].transpose(), epsilon = 1e-12 * load[0].amax());
    }
    // a load along y above pipe II twists it, and bends pipe I about x: by hand
    let centre = responses(&rod, &[(tip, tip)]).unwrap()[0];
    let mut structure = Structure::new(&rod, vec![(tip, tip)]).unwrap();
    let own = structure.add_variation(Varied::Beside(End::Load, tip, Axis::Z), 0.02).unwrap();
    let lifted =
        structure.softened(&Softening { variants: vec![variant(own, arm)], ..Softening::default() })[0];
    let ei = stiffness(&rod, 0.1)[0];
    // the moment about x is −e·F: pipe I turns by that over EI, and pipe II about its own axis
    let bent = arm * rod.l1 * rod.l1 / (2.0 * ei);
    let joint = rod.joints[0].torsion;
    assert!(joint == 0.0);
    assert_relative_eq!(lifted[(1, 1)] - centre[(1, 1)], bent, max_relative = 1e-9);
    // and only loads along y do so where only they are beside it
    let only = beside(End::Load, Axis::Z, [false, true, false])[0];
    let mut others = responses(&rod, &[(tip, 0.4)]).unwrap()[0];
    others.set_column(1, &only.column(1));
    assert_relative_eq!(only, others, epsilon = 1e-15);
}
