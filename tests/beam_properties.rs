//! What must hold for every chain, whatever its shape: symmetry, reciprocity, independence of
//! frame, mesh and direction. Stiffness-method programs fail some of these on members along an
//! axis; so they are drawn often.

#![allow(clippy::unwrap_used)]

use std::f64::consts::PI;

use nalgebra::{Matrix3, Rotation3, Vector3};
use proptest::prelude::*;
use rodcal::beam::{Chain, Load, Physics, Profile, RodModel};
use rodcal::compliance::Compliance;
use rodcal::rod::{Joint, LumpedMass, Pipe, Rod, Sleeve};
use rodcal::{material::Material, section::Round};

/// Relative to the largest entry of a block; observed 1e-14.
const ROUNDING: f64 = 1e-11;

#[derive(Debug, Clone, Copy)]
enum Piece {
    Straight(f64, usize),
    Arc(f64, f64, usize),
    Turn(Rotation3<f64>),
    Spring(f64, f64),
    Mass(f64),
}

fn profile() -> Profile {
    // principal axes differ, so that a section turned the wrong way shows
    Profile {
        axial: 2e-7,
        shear: [5e-7, 6e-7],
        bending: [2e-3, 5e-3],
        torsion: 4e-3,
        mass_per_length: 0.7,
        rotary_inertia: [0.0; 2],
    }
}

fn rotation() -> impl Strategy<Value = Rotation3<f64>> {
    let general =
        (-PI..PI, -1.5..1.5f64, -PI..PI).prop_map(|(r, p, y)| Rotation3::from_euler_angles(r, p, y));
    let along_an_axis = (0..4i32, 0..4i32, 0..4i32).prop_map(|(r, p, y)| {
        let quarter = |n: i32| f64::from(n) * PI / 2.0;
        Rotation3::from_euler_angles(quarter(r), quarter(p), quarter(y))
    });
    prop_oneof![general, along_an_axis]
}

fn pieces() -> impl Strategy<Value = Vec<Piece>> {
    let piece = prop_oneof![
        (0.01..0.6f64, 1..12usize).prop_map(|(l, n)| Piece::Straight(l, n)),
        (0.02..0.5f64, 0.05..3.0f64, 1..12usize).prop_map(|(r, a, n)| Piece::Arc(r, a, n)),
        rotation().prop_map(Piece::Turn),
        (0.0..1e-3f64, 0.0..1e-3f64).prop_map(|(b, t)| Piece::Spring(b, t)),
        (0.0..0.3f64).prop_map(Piece::Mass),
    ];
    prop::collection::vec(piece, 1..8).prop_filter("needs a length", |p| {
        p.iter().any(|p| matches!(p, Piece::Straight(..) | Piece::Arc(..)))
    })
}

fn draw(chain: &mut Chain, pieces: impl IntoIterator<Item = Piece>, refine: usize) {
    for piece in pieces {
        match piece {
            Piece::Straight(length, n) => chain.straight(&profile(), length, n * refine),
            Piece::Arc(radius, angle, n) => chain.arc(&profile(), radius, angle, n * refine),
            Piece::Turn(rotation) => chain.turn(&rotation),
            Piece::Spring(bending, torsion) => chain.spring(bending, torsion),
            Piece::Mass(mass) => chain.mass(mass),
        }
    }
}

fn chain(frame: Rotation3<f64>, position: Vector3<f64>, pieces: &[Piece], refine: usize) -> Chain {
    let mut chain = Chain::clamped_at(position, frame);
    draw(&mut chain, pieces.iter().copied(), refine);
    chain
}

/// Tip displacement under tip forces, tip moments and self-weight, and tip rotation under the same.
fn tip(chain: &Chain) -> [Matrix3<f64>; 6] {
    let node = chain.end();
    let response = chain.solve(&[Load::Force { node }, Load::Couple { node }, Load::SelfWeight]).unwrap();
    let m = [0, 1, 2].map(|load| *response.motion(node, load));
    [m[0].translation, m[1].translation, m[2].translation, m[0].rotation, m[1].rotation, m[2].rotation]
}

fn assert_same(a: &Matrix3<f64>, b: &Matrix3<f64>) -> Result<(), TestCaseError> {
    let scale = a.amax().max(b.amax());
    prop_assert!((a - b).amax() <= ROUNDING * scale, "{a}{b}");
    Ok(())
}

fn rod() -> impl Strategy<Value = Rod> {
    let pipe = |outer: f64, wall: f64| Pipe {
        section: Round::tube(outer, outer * (1.0 - wall)).into(),
        material: Material::isotropic("steel", 193e9, 0.29, 7930.0),
    };
    (0.1..0.8f64, 0.1..0.8f64, 0.3..PI, 0.0..1.0f64, 0.01..0.05f64, 0.05..1.0f64, 0.0..1.0f64).prop_map(
        move |(l1, l2, gamma, bend, outer, wall, at)| {
            let mut rod = Rod::new("drawn", l1, l2, pipe(outer, wall))
                .with_angle(gamma)
                .with_pipe2(pipe(outer * 0.8, wall))
                .with_tip_mass(0.1);
            rod.bend_radius = if bend < 0.01 { 0.0 } else { bend * l1.min(l2) / ((PI - gamma) / 2.0).tan() };
            rod.bend = pipe(outer, wall / 2.0);
            let station = at * rod.length();
            rod.masses.push(LumpedMass::new("ring", station, 0.05));
            let (from, to) = (rod.bend_end(), rod.length());
            let collar = Pipe { section: Round::tube(outer, outer * 0.8).into(), ..rod.pipe1.clone() };
            let [begins, ends] = [0.5 * at, 0.5 * at + 0.4].map(|share| from + share * (to - from));
            rod.sleeves.push(Sleeve::new("collar", begins, ends, collar));
            rod.joints.push(Joint::new("sleeve", station, 1e-5, 2e-5));
            rod
        },
    )
}

/// An arc so short that it is lost between two stations must still turn the rod.
#[test]
fn a_bend_of_a_nanometre_is_a_sharp_corner() {
    let text = include_str!("../rods/5.toml");
    let rod = |radius: &str| Rod::from_toml("rod", &text.replace("bend_radius_mm = 0.0", radius)).unwrap();
    let of_rod = |rod: &Rod| Compliance::of_model(rod, &Physics::default(), 20).unwrap();
    let sharp = of_rod(&rod("bend_radius_mm = 0.0"));
    for radius in ["1e-7", "1e-6", "1e-5", "1e-4", "1e-3"] {
        let bent = of_rod(&rod(&format!("bend_radius_mm = {radius}")));
        assert!((bent.force - sharp.force).amax() < 1e-5 * sharp.force.amax(), "bend radius {radius} mm");
    }
}

proptest! {
    #[test]
    fn compliance_is_symmetric_and_positive(pieces in pieces()) {
        let [uf, um, _, rf, rm, _] = tip(&chain(Rotation3::identity(), Vector3::zeros(), &pieces, 1));
        assert_same(&uf, &uf.transpose())?;
        assert_same(&rm, &rm.transpose())?;
        assert_same(&um, &rf.transpose())?;
        prop_assert!(uf.symmetric_eigenvalues().min() >= -ROUNDING * uf.amax());
    }

    #[test]
    fn any_two_stations_are_reciprocal(pieces in pieces(), a in 0.0..1.0f64, b in 0.0..1.0f64) {
        let chain = chain(Rotation3::identity(), Vector3::zeros(), &pieces, 1);
        let node = |at: f64| (at * chain.end() as f64).round() as usize;
        let response = chain.solve(&[Load::Force { node: node(a) }, Load::Couple { node: node(b) }]).unwrap();
        let (by_force, by_couple) = (response.motion(node(b), 0).rotation, response.motion(node(a), 1).translation);
        prop_assert!((by_force - by_couple.transpose()).amax() <= ROUNDING * by_force.amax().max(1e-12));
    }

    #[test]
    fn turning_the_whole_chain_in_space_turns_its_compliance(pieces in pieces(), turn in rotation(), shift in -9.0..9.0f64) {
        let here = tip(&chain(Rotation3::identity(), Vector3::zeros(), &pieces, 1));
        let there = tip(&chain(turn, Vector3::new(shift, -shift, 2.0 * shift), &pieces, 1));
        for (a, b) in here.iter().zip(&there) {
            // coordinates of 18 m leave fewer digits for levers of centimetres
            prop_assert!((turn * a * turn.inverse() - b).amax() <= 1e-9 * a.amax(), "{a}{b}");
        }
    }

    #[test]
    fn the_number_of_elements_does_not_matter(pieces in pieces(), refine in 2..60usize) {
        let coarse = tip(&chain(Rotation3::identity(), Vector3::zeros(), &pieces, 1));
        let fine = tip(&chain(Rotation3::identity(), Vector3::zeros(), &pieces, refine));
        for (a, b) in coarse.iter().zip(&fine) {
            assert_same(a, b)?;
        }
    }

    /// Held at the other end, the two ends move by the same amount relative to each other.
    #[test]
    fn the_direction_of_the_mesh_does_not_matter(pieces in pieces()) {
        let forward = chain(Rotation3::identity(), Vector3::zeros(), &pieces, 1);
        let about = Rotation3::from_axis_angle(&Vector3::x_axis(), PI);
        // where the pieces lead
        let mut heading = Rotation3::identity();
        for piece in &pieces {
            heading *= match *piece {
                Piece::Arc(_, angle, _) => Rotation3::from_axis_angle(&Vector3::y_axis(), angle),
                Piece::Turn(rotation) => rotation,
                _ => Rotation3::identity(),
            };
        }
        let mut backward = Chain::clamped_at(forward.position(forward.end()), heading * about);
        let reversed = pieces.iter().rev().map(|piece| match *piece {
            Piece::Turn(rotation) => Piece::Turn(about * rotation.inverse() * about),
            other => other,
        });
        draw(&mut backward, reversed, 1);
        prop_assert!(backward.position(backward.end()).norm() < 1e-12, "the way back leads home");

        let [uf, um, _, rf, rm, _] = tip(&forward);
        // the tip's compliance, moved to the root as if rigidly attached to the tip: u + θ×d, M =
        // d×F
        let d = -forward.position(forward.end());
        let lever = d.cross_matrix();
        let moved = uf + um * lever - lever * (rf + rm * lever);
        let home = tip(&backward)[0];
        let scale = moved.amax().max(uf.amax());
        prop_assert!((moved - home).amax() <= ROUNDING * scale, "{moved}{home}");
    }

    /// A spring at the root turns everything beyond it like a rigid body.
    #[test]
    fn a_soft_root_adds_a_rigid_rotation(pieces in pieces(), softness in 1e-6..1e-2f64) {
        let stiff = tip(&chain(Rotation3::identity(), Vector3::zeros(), &pieces, 1));
        let mut with_spring = vec![Piece::Spring(softness, softness)];
        with_spring.extend(&pieces);
        let chain = chain(Rotation3::identity(), Vector3::zeros(), &with_spring, 1);
        let lever = chain.position(chain.end()).cross_matrix();
        let soft = tip(&chain);
        // Δu = θ×p with θ = s·(p×F): −[p]·s·[p]
        let rigid = -lever * lever * softness;
        prop_assert!((soft[0] - stiff[0] - rigid).amax() <= ROUNDING * soft[0].amax());
    }

    #[test]
    fn a_rod_has_its_tip_its_mass_and_no_dependence_on_elements(rod in rod(), elements in 1..400usize) {
        let model = RodModel::new(&rod, &Physics::default(), elements, &[]).unwrap();
        let tip = model.tip();
        prop_assert!((model.chain.position(tip) - rod.tip()).norm() < 1e-12);
        prop_assert!((model.chain.station(tip) - rod.length()).abs() < 1e-12);
        let weight = model.chain.resultant(Load::SelfWeight, 0);
        prop_assert!((weight.force[(0, 0)] - rod.mass()).abs() < 1e-12 * rod.mass());
        let (one, many) = (Compliance::of_model(&rod, &Physics::default(), 1).unwrap(),
            Compliance::of_model(&rod, &Physics::default(), elements).unwrap());
        assert_same(&one.force, &many.force)?;
        assert_same(&one.gravity, &many.gravity)?;
    }

    #[test]
    fn a_force_anywhere_read_anywhere_is_reciprocal(rod in rod(), a in 0.0..1.0f64, b in 0.0..1.0f64) {
        let (a, b) = (a * rod.length(), b * rod.length());
        let model = RodModel::new(&rod, &Physics::default(), 20, &[a, b]).unwrap();
        let (ab, ba) = (model.force_response(a, b).unwrap(), model.force_response(b, a).unwrap());
        assert_same(&ab.translation, &ba.translation.transpose())?;
    }
}
