use super::*;
use crate::beam::{Physics, RodModel};
use crate::diagnosis::rig::diagnose;
use crate::diagnosis::rig::measurements::feasible::Measurement;
use crate::inference::LoadPlan;
use crate::rig::readings::{Axis, Reading, Readings};
use crate::units::UM;

const BENCH: Bench = Bench { largest_load: 10.0, noise: 1e-6, is_at_tip: false };

fn rod() -> Rod {
    Rod::read("rods/2.toml".as_ref()).unwrap()
}

fn effects(names: [&str; 2]) -> [&'static Effect; 2] {
    names.map(|name| effect_named(name).unwrap())
}

/// Repeats of each measurement of the menu.
fn counts(plan: &RigPlan, menu: &Menu) -> Vec<usize> {
    let planned = |one: &Measurement| {
        let same = |planned: &&PlannedLoads| {
            LoadPlan { repeats: one.plan.repeats, ..planned.loads.clone() } == one.plan
        };
        plan.measurements.iter().find(same).map_or(0, |planned| planned.loads.repeats)
    };
    menu.measurements.iter().map(planned).collect()
}

/// Where a joint is near the flange it takes several measurements together.
#[test]
fn what_can_be_distinguished_is() {
    let rod = Rod::read("rods/5.toml".as_ref()).unwrap();
    let between = effects(["joint_compliance", "root_compliance"]);
    let plan = plan(&rod, &between, 20.0, &BENCH).unwrap();
    let all = || plan.distinguished.iter().flat_map(|one| &one.places);
    assert!(all().any(|(_, _, best)| *best < plan.wanted) && all().any(|(_, now, _)| *now > plan.wanted));
    for (place, now, best) in all() {
        let is_hard = *best < REASONABLE * plan.wanted;
        assert!(is_hard || *now >= plan.wanted - 1e-9, "{place}: {now} {best}");
    }
}

#[test]
fn a_plan_is_no_more_than_is_needed_and_keeps_what_it_promises() {
    let between = effects(["friction", "root_compliance"]);
    let rod = rod();
    let plan = plan(&rod, &between, 20.0, &BENCH).unwrap();
    assert!(!plan.measurements.is_empty() && plan.minutes > 0.0);
    for one in &plan.distinguished {
        for (place, now, best) in &one.places {
            assert!(*now >= plan.wanted.min(*best) - 1e-9 || *best < plan.wanted, "{place}: {now} {best}");
        }
    }
    // one repeat less of anything tells less than was asked for
    let menu = Menu::new(&rod, &between, &BENCH).unwrap();
    let counts = counts(&plan, &menu);
    for k in (0..counts.len()).filter(|&k| counts[k] > 0) {
        let fewer = one_less(&counts, k);
        let all = menu.log_odds(&vec![MOST_REPEATS; counts.len()]);
        let is_missed =
            |(log_odds, best): (&f64, &f64)| *best >= REASONABLE * plan.wanted && *log_odds < plan.wanted;
        assert!(menu.log_odds(&fewer).iter().zip(&all).any(is_missed), "{k}");
    }
}

/// Beside every plan of three measurements at the tip; and more of any never tells less.
#[test]
fn the_least_plan_is_that_of_all() {
    let between = effects(["friction", "root_compliance"]);
    let bench = Bench { is_at_tip: true, ..BENCH };
    let menu = Menu::new(&rod(), &between, &bench).unwrap();
    let count = menu.measurements.len();
    let found = plan(&rod(), &between, 20.0, &bench).unwrap();
    assert!(found.is_least);
    let wanted = 20f64.ln();
    let all = menu.log_odds(&vec![MOST_REPEATS; count]);
    let is_asked: Vec<bool> = all.iter().map(|best| *best >= REASONABLE * wanted).collect();
    let is_enough = |counts: &[usize]| {
        menu.log_odds(counts)
            .iter()
            .zip(&is_asked)
            .all(|(log_odds, is_asked)| !is_asked || *log_odds >= wanted)
    };
    let planned = counts(&found, &menu);
    let mut used: Vec<usize> = (0..count).filter(|&k| planned[k] > 0).collect();
    used.extend((0..count).filter(|&k| planned[k] == 0).take(3 - used.len().min(3)));
    let mut best = f64::INFINITY;
    let numbers: Vec<usize> = [0].into_iter().chain((FEWEST..=MOST_REPEATS).step_by(3)).collect();
    let mut counts = vec![0; count];
    for code in 0..numbers.len().pow(used.len() as u32) {
        for (place, &k) in used.iter().enumerate() {
            counts[k] = numbers[code / numbers.len().pow(place as u32) % numbers.len()];
        }
        let now = menu.log_odds(&counts);
        if let Some(&k) = used.iter().find(|&&k| counts[k] > FEWEST) {
            let fewer = menu.log_odds(&one_less(&counts, k));
            assert!(fewer.iter().zip(&now).all(|(fewer, now)| *fewer <= now + 1e-6), "{counts:?}");
        }
        if is_enough(&counts) {
            best = best.min(menu.minutes(&counts));
        }
    }
    let labour: Vec<Vec<f64>> = (0..count)
        .map(|k| {
            let is_used = |repeats: &usize| *repeats == 0 || used.contains(&k) && numbers.contains(repeats);
            let minutes = menu.labours(k).into_iter().enumerate();
            minutes.map(|(r, minutes)| if is_used(&r) { minutes } else { f64::INFINITY }).collect()
        })
        .collect();
    let found = least(&labour, 1e9, 100_000, &is_enough);
    assert!(found.is_proven && best.is_finite());
    assert_eq!(menu.minutes(&found.better.unwrap()), best);
}

/// Recorded as planned with a root that gives way, the diagnosis names it.
#[test]
fn what_was_planned_for_is_then_found() {
    let between = effects(["stiffness_scale", "root_compliance"]);
    let rod = Rod::read("rods/5.toml".as_ref()).unwrap();
    let plan = plan(&rod, &between, 20.0, &BENCH).unwrap();
    let root = crate::rod::Joint { name: "root".into(), station: 0.0, bending: 60e-6, torsion: 60e-6 };
    let soft = rod.clone().with_joint(root);
    let mut random = crate::statistics::Random::seeded(3, 1);
    let mut rows = Vec::new();
    for (k, one) in plan.measurements.iter().enumerate() {
        let tip = soft.length();
        let [load_at, read_at] =
            [one.loads.load_station, one.loads.read_station].map(|station| station.unwrap_or(tip));
        let model = RodModel::new(&soft, &Physics::WHOLE, 1, &[load_at, read_at]).unwrap();
        let motion = model.force_response(load_at, read_at).unwrap().translation;
        for trial in 0..one.loads.repeats {
            for &load in &one.loads.loads {
                let mut row = Reading::new(one.loads.direction, load);
                let signed = load * f64::from(one.loads.direction.sign);
                for channel in Axis::ALL {
                    let slope = motion[(channel.index(), one.loads.direction.axis.index())];
                    row = row.with_offset(channel, slope * signed + UM * random.normal());
                }
                rows.push(Reading {
                    trial: Some(format!("{k} {trial}")),
                    load_station: one.loads.load_station,
                    read_station: one.loads.read_station,
                    ..row
                });
            }
        }
    }
    let readings = Readings::from_rows(rows).unwrap();
    let found = diagnose(&readings, Some(&rod)).unwrap().diagnosis;
    assert_eq!(found.findings.len(), 1, "{:?}", found.findings);
    let finding = &found.findings[0];
    let is_named = finding.effect.name == "root_compliance"
        || finding.rivals.iter().any(|rival| rival.effect.name == "root_compliance");
    assert!(is_named && finding.rivals.iter().all(|rival| rival.effect.name != "stiffness_scale"));
}

#[test]
fn what_no_load_shows_is_refused() {
    let bent = effects(["bend_flexibility", "root_compliance"]);
    let error = plan(&rod(), &bent, 20.0, &BENCH).unwrap_err().to_string();
    assert!(error.starts_with("a plan that shows bend_flexibility is not possible"), "{error}");
    assert_eq!(effect_named("gremlins"), None);
}
