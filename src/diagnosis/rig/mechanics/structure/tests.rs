//! Beside the beam model of the same rod.

use super::*;
use crate::material::Material;
use crate::rod::Joint;
use crate::section::Round;
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
