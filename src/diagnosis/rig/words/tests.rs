//! Every effect has its words.

use super::*;
use crate::diagnosis::rig::RigWorld;
use crate::rig::readings::Readings;
use crate::rod::Rod;

/// Readings that every effect of the library has a meaning for.
fn everything() -> RigWorld {
    let rod =
        include_str!("../../../../rods/5.toml").replace("bend_radius_mm = 0.0", "bend_radius_mm = 60.0");
    let rod = rod + "\n[[joint]]\nname = \"sleeve\"\nstation_mm = 300\nbending_urad_per_nm = 4.0\n";
    let rod = Rod::from_toml("rod", &rod).unwrap();
    let mut text = "axis,load_n,trial,phase,time_s,temperature_c,dx_um,dy_um,dz_um\n".to_owned();
    let mut time = 0.0;
    for axis in ["x", "y", "z"] {
        for trial in 1..4 {
            for (load, phase) in
                [(5.0, "load"), (10.0, "load"), (20.0, "load"), (10.0, "unload"), (5.0, "unload")]
            {
                time += 30.0;
                let temperature = 20.0 + time / 1000.0;
                text += &format!("{axis},{load},{trial},{phase},{time},{temperature},{load},{load},{load}\n");
            }
        }
    }
    RigWorld::new(&Readings::from_text("f", &text).unwrap(), Some(&rod)).unwrap().0
}

fn finding(world: &RigWorld, candidate: usize) -> Finding {
    let chosen = world.candidates()[candidate].neutral(candidate);
    let parameters = world.candidates()[candidate].parameters.iter();
    Finding {
        place: world.place(&chosen),
        chosen,
        parameters: parameters
            .map(|p| (p.neutral + 2.0 * p.size, p.neutral + p.size, p.neutral + 3.0 * p.size))
            .collect(),
        first: 0,
        reach: 2.0,
        p_value: 0.0,
        rms: 0.0,
        rivals: Vec::new(),
    }
}

#[test]
fn every_effect_of_the_library_has_words_and_its_number() {
    let world = everything();
    let mut effects = Vec::new();
    for (index, candidate) in world.candidates().iter().enumerate().filter(|(_, c)| !c.is_unknown) {
        let effect = candidate.effect.as_str();
        assert!(cause(effect).is_some(), "{effect} has no words");
        let words = world.words(&finding(&world, index)).to_string();
        assert!(words.contains('±') || words.contains(" to "), "{effect}: {words}");
        assert!(!words.contains("NaN") && !words.contains('_'), "{effect}: {words}");
        assert!(!cause_at(effect, &candidate.location).contains('_'));
        if !effects.contains(&effect) {
            effects.push(effect);
        }
    }
    assert_eq!(effects.len(), 17, "{effects:?}");
}

#[test]
fn the_words_say_what_a_mechanic_would() {
    let world = everything();
    let say = |effect: &str, location: &str| {
        let index = world.candidates().iter().position(|c| c.effect == effect && c.location == location);
        world.words(&finding(&world, index.unwrap_or_else(|| panic!("{effect} {location}")))).to_string()
    };
    assert_eq!(
        say("friction", "slide, loads along y"),
        "Loads along y are felt 2.0 ± 1.0 N too small while loading and as much too large while unloading: \
         friction in the slide"
    );
    assert!(say("joint_compliance", "sleeve").starts_with("The joint \"sleeve\" yields"));
    assert!(say("thermal_drift", "dy").starts_with("Sensor dy drifts by 10 ± 5 µm per kelvin"));
    assert!(say("nonlinear_stiffness", "rod").contains("grows softer with the load, by 10 ± 5 % at 20.0 N"));
}

#[test]
fn what_remains_is_said_by_what_it_follows() {
    assert_eq!(unexplained_at("load, dy under loads along y"), "follows the load (dy under loads along y)");
    assert_eq!(unexplained_at("time, all deflections"), "follows the time (all readings alike)");
    assert_eq!(unexplained_at("slope of each line"), "makes some lines steeper or flatter than others");
}
