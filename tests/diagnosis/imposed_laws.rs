//! Laws of recordings in which the displacement was imposed: a straight tube, its tip moved up and
//! down, and something that resists besides.

use rodcal::rig::readings::Readings;
use rodcal::rod::{LawMemory, LawVariable, Rod, RodLawPlace};
use serde_json::Value;

use super::Answer;
use super::labs::{LENGTH, Lab, ROD};

/// Steps of 0.2 mm up to 4 mm.
const STEPS: i32 = 20;
/// Noise of a load, N.
const NOISE: f64 = 0.01;

/// Three times up and down, `wait` seconds at each displacement; `more` is what is needed besides
/// the rod's own load, N, at a displacement (mm), a new one of each run.
fn imposed<More: FnMut(f64, f64) -> f64>(seed: u64, wait: impl Fn(i32) -> f64, more: fn() -> More) -> String {
    let mut lab = Lab::new(seed);
    let c = lab.compliance(LENGTH, 0.0);
    let mut text = "# driven = \"displacement\"\ntrial,axis,phase,load_n,time_s,dy_um\n".to_owned();
    let mut time = 0.0;
    for trial in 1..=3 {
        let mut more = more();
        for k in 1..2 * STEPS {
            let u = 0.2 * f64::from(if k > STEPS { 2 * STEPS - k } else { k });
            let phase = if k > STEPS { "unload" } else { "load" };
            let waited = wait(k);
            time += waited;
            let force = u * 1e-3 / c + more(u, waited) + lab.noise(NOISE);
            assert!(force > 0.0);
            text += &format!("{trial},y,{phase},{force:.5},{time},{:.1}\n", u * 1e3);
        }
    }
    text
}

/// Once a second.
fn evenly(_: i32) -> f64 {
    1.0
}

fn law(answer: &Answer) -> &Value {
    let law = &answer.json["law"];
    assert_eq!(law["proposed"], true, "{} {law}", answer.json["headline"]);
    law
}

/// The law, or what the recording does not distinguish from it, as one of the deflection.
fn of_deflection(law: &Value) -> bool {
    let is_own = |name: &Value| name == "deflection along the load";
    let rivals = law["rivals"].as_array().unwrap();
    is_own(&law["variable"]["name"]) || rivals.iter().any(|rival| is_own(&rival["variable"]))
}

fn assert_holds(law: &Value, symbol: &str, truth: f64) {
    let all = law["constants"].as_array().unwrap();
    let own = all.iter().find(|own| own["symbol"] == symbol).unwrap_or_else(|| panic!("{symbol}: {law}"));
    let [low, high] = ["lo", "hi"].map(|key| own[key].as_f64().unwrap());
    assert!(low * 0.99 < truth && truth < high * 1.01, "{symbol}: {own}");
}

/// A bar beside the rod that is touched from a deflection on: 2 N/mm beyond 2.3 mm.
fn touched() -> impl FnMut(f64, f64) -> f64 {
    |u, _| 2.0 * (u - 2.3).max(0.0)
}

#[test]
fn a_stop_is_a_law_of_the_deflection() {
    let answer = Answer::of(Some(ROD), &imposed(3, evenly, touched));
    let law = law(&answer);
    assert!(of_deflection(law), "{law}");
    assert_eq!(law["form"], "threshold with slope", "{law}");
    let errors = ["heldout_without_um", "heldout_um"].map(|key| law[key].as_f64().unwrap());
    assert!(errors[1] < 0.2 * errors[0], "{errors:?}");
}

/// A law of the deflection says the same of weights that are hung: y of y = C·(F + ΔF(y)).
#[test]
fn a_law_of_the_deflection_holds_for_weights_too() {
    let formula = "[[law]]\nplace = \"rod\"\nvariable = \"deflection\"\n\
                   formula = \"k*max(u - u_0, 0)\"\nrange = [200.0, 4000.0]\n\
                   constant = [{ name = \"k\", value = -0.002, unit = \"N/µm\" }, \
                   { name = \"u_0\", value = 2300.0, unit = \"µm\" }]\n";
    let rod = format!("{ROD}{formula}");
    let mut lab = Lab::new(4);
    let c = lab.compliance(LENGTH, 0.0) * 1e3;
    let mut text = "trial,axis,load_n,dy_um\n".to_owned();
    for trial in 1..=3 {
        for load in (1..=12).map(f64::from) {
            // beyond the stop (y/C + 2·(y − 2.3) = F) the bar bears too
            let free = c * load;
            let y = if free > 2.3 { (load + 2.0 * 2.3) / (1.0 / c + 2.0) } else { free };
            text += &format!("{trial},y,{load},{:.2}\n", y * 1e3 + lab.noise(1.5));
        }
    }
    for recording in [&text, &imposed(4, evenly, touched)] {
        let answer = Answer::of(Some(&rod), recording);
        let law = &answer.json["law"];
        assert!(answer.is_consistent() && law.is_null(), "{} {law}", answer.json["headline"]);
        assert!(!Answer::of(Some(ROD), recording).is_consistent());
    }
    // and `rig fit` takes it out of the weights' readings
    let readings = Readings::from_text("f", &text).unwrap();
    let ratio = |rod: &str| {
        let rod = Rod::from_toml("rod.toml", rod).unwrap();
        let fit = rodcal::rig::fit(&readings, Some(&rod), &rodcal::rig::Options::default()).unwrap();
        fit.measured.unwrap().rod_ratio.value
    };
    assert!(
        (ratio(&rod) - 1.0).abs() < 0.02 && (ratio(ROD) - 1.0).abs() > 0.05,
        "{} {}",
        ratio(&rod),
        ratio(ROD)
    );
}

/// Two contacts that slip after 0.3 and 1.2 mm (Prandtl and Ishlinskii), written and read again.
fn slipping() -> impl FnMut(f64, f64) -> f64 {
    let (mut before, mut held) = (0.0, [0.0f64; 2]);
    move |u, _| {
        for (own, width) in held.iter_mut().zip([0.3, 1.2]) {
            *own = (*own + u - before).clamp(-width, width);
        }
        before = u;
        0.5 * held[0] + 0.2 * held[1]
    }
}

#[test]
fn contacts_that_slip_are_written_and_read() {
    let before = Answer::of(Some(ROD), &imposed(5, evenly, slipping));
    let law = law(&before);
    let found = (&law["variable"]["name"], &law["memory"], &law["location"]);
    let expected = ("deflection along the load", "two stop operators", "rod");
    assert_eq!(found, (&expected.0.into(), &expected.1.into(), &expected.2.into()), "{law}");
    assert_holds(law, "r1", 300.0);
    assert_holds(law, "r", 1200.0);
    let correction = before.found.correction().unwrap().unwrap();
    let again = Rod::from_toml("rod.toml", &correction.rod_toml).unwrap();
    let [own] = &again.laws[..] else { panic!("{:?}", again.laws) };
    assert_eq!((&own.place, own.variable), (&RodLawPlace::Rod, LawVariable::Deflection));
    assert_eq!((own.memory, own.unit()), (Some(LawMemory::TwoStops), "N"));
    let after = Answer::of(Some(&correction.rod_toml), &correction.readings_csv);
    assert!(after.is_consistent() && after.json["law"].is_null(), "{}", after.json["headline"]);
    let rms = |answer: &Answer| answer.json["rms_before_um"].as_f64().unwrap();
    assert!(rms(&after) < 0.2 * rms(&before), "{} {}", rms(&before), rms(&after));
}

/// A spring of 0.5 N/mm behind a dashpot (Maxwell): what it bears dies away in 25 s.
fn relaxing() -> impl FnMut(f64, f64) -> f64 {
    let (mut before, mut bears) = (0.0, 0.0f64);
    move |u, waited| {
        bears = (bears + u - before) * (-waited / 25.0).exp();
        before = u;
        0.5 * bears
    }
}

#[test]
fn a_dashpot_is_a_lag_of_the_deflection() {
    let unevenly = |k: i32| [2.0, 5.0, 12.0, 30.0, 80.0][(7 * k % 5) as usize];
    let answer = Answer::of(Some(ROD), &imposed(6, unevenly, relaxing));
    let law = law(&answer);
    assert_eq!(
        (&law["memory"], &law["variable"]["symbol"]),
        (&"first-order lag".into(), &"u".into()),
        "{law}"
    );
    assert_holds(law, "tau", 25.0);
}

#[test]
fn where_nothing_resists_besides_there_is_no_law() {
    for seed in 10..14 {
        let answer = Answer::of(Some(ROD), &imposed(seed, evenly, || |_, _| 0.0));
        assert!(answer.is_consistent() && answer.json["law"].is_null(), "{}", answer.json["headline"]);
    }
}
