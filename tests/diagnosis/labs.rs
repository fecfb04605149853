//! Recordings as labs make them: loads that go up and down, displacements that are imposed,
//! sessions, times of hanging. They are made here by closed-form mechanics of a straight tube that
//! share nothing with the program's; moduli are off as any rod's are.

use rodcal::rig::readings::Readings;
use rodcal::statistics::Random;
use serde_json::Value;

use super::{Answer, interval};

/// A straight tube of 600 mm, 12 × 8 mm.
pub const ROD: &str = "name = \"straight\"
[geometry]
l1_mm = 300.0
l2_mm = 300.0
gamma_deg = 180.0
[material.steel]
youngs_modulus_gpa = 200.0
shear_modulus_gpa = 77.0
density_kg_m3 = 7930.0
[pipe1]
material = \"steel\"
outer_diameter_mm = 12.0
inner_diameter_mm = 8.0
[pipe2]
material = \"steel\"
outer_diameter_mm = 12.0
inner_diameter_mm = 8.0
";
pub const LENGTH: f64 = 0.6;
const SEEDS: std::ops::Range<u64> = 0..2;

/// Moduli, Pa, off by 0.7 and 1.2 % (1 σ), and the noise.
pub struct Lab {
    random: Random,
    e: f64,
    g: f64,
}

impl Lab {
    pub fn new(seed: u64) -> Lab {
        let mut random = Random::seeded(seed, 14);
        let (e, g) = (200e9 * (1.0 + 0.007 * random.normal()), 77e9 * (1.0 + 0.012 * random.normal()));
        Lab { random, e, g }
    }

    pub fn noise(&mut self, sd: f64) -> f64 {
        sd * self.random.normal()
    }

    /// Deflection at a station per load at the tip, m/N, with a compliant root (rad/(N·m)):
    /// Euler–Bernoulli with Timoshenko's shear, κ by Cowper (J. Appl. Mech. 33 (1966) 335–340).
    pub fn compliance(&self, s: f64, root: f64) -> f64 {
        let (outer, inner) = (0.012f64, 0.008f64);
        let second = std::f64::consts::PI / 64.0 * (outer.powi(4) - inner.powi(4));
        let area = std::f64::consts::PI / 4.0 * (outer.powi(2) - inner.powi(2));
        let (nu, m2) = (self.e / (2.0 * self.g) - 1.0, (inner / outer).powi(2));
        let kappa = 6.0 * (1.0 + nu) * (1.0 + m2).powi(2)
            / ((7.0 + 6.0 * nu) * (1.0 + m2).powi(2) + (20.0 + 12.0 * nu) * m2);
        s * s * (3.0 * LENGTH - s) / (6.0 * self.e * second) + s / (kappa * self.g * area) + root * LENGTH * s
    }
}

/// `y,5` or `-y,5`.
fn signed(load: f64) -> String {
    format!("{},{:.5}", if load < 0.0 { "-y" } else { "y" }, load.abs())
}

/// Four cycles to and fro, or up and down on one side, from 0 in even steps, as shares of the
/// largest.
fn cycles(steps: usize, is_one_sided: bool) -> Vec<f64> {
    let share = |k: usize| {
        let t = (k % steps) as f64 / steps as f64;
        match (is_one_sided, t) {
            (true, t) => 1.0 - (1.0 - 2.0 * t).abs(),
            (false, t) if t < 0.25 => 4.0 * t,
            (false, t) if t < 0.75 => 2.0 - 4.0 * t,
            (false, t) => 4.0 * t - 4.0,
        }
    };
    (1..=4 * steps).map(share).collect()
}

/// Weights that go up and down without a `phase`: friction (N), play (m), stations (m); a time in
/// every row.
fn hung(seed: u64, is_one_sided: bool, friction: f64, play: f64, stations: &[f64]) -> String {
    let mut lab = Lab::new(seed);
    let zeros: Vec<f64> = stations.iter().map(|_| lab.noise(2e-6)).collect();
    let mut text = "axis,load_n,time_s,read_station_mm,dy_um\n".to_owned();
    let mut felt = 0.0f64;
    for (k, share) in cycles(16, is_one_sided).into_iter().enumerate() {
        let load = 20.0 * share;
        felt = felt.max(load - friction).min(load + friction);
        for (station, zero) in stations.iter().zip(&zeros) {
            let side = if felt == 0.0 { 0.0 } else { felt.signum() };
            let y = lab.compliance(*station, 0.0) * felt + play * side + zero + lab.noise(2e-6);
            text += &format!("{},{},{},{:.2}\n", signed(load), 10 * k, station * 1e3, y * 1e6);
        }
    }
    text
}

/// An imposed displacement of 4 mm to and fro, in even steps or as a sine, with friction (N) and
/// play (m) in series.
fn imposed(seed: u64, is_sine: bool, friction: f64, play: f64) -> String {
    let mut lab = Lab::new(seed);
    let c = lab.compliance(LENGTH, 0.0);
    let sine = |k: usize| (2.0 * std::f64::consts::PI * k as f64 / 24.0).sin();
    let shares = if is_sine { (1..=96).map(sine).collect() } else { cycles(24, false) };
    let mut text = "# driven = \"displacement\"\naxis,load_n,time_s,dy_um\n".to_owned();
    let (mut before, mut rod) = (0.0f64, 0.0f64);
    for (k, share) in shares.into_iter().enumerate() {
        let u = 4e-3 * share;
        let held = rod.clamp(-friction * c, friction * c);
        let moved = held.max(u - play).min(u + play);
        let is_in_gap = (moved - u).abs() < play * (1.0 - 1e-9);
        let force = if is_in_gap { 0.0 } else { moved / c + friction * (u - before).signum() };
        (before, rod) = (u, moved);
        text += &format!("{},{k},{:.2}\n", signed(force + lab.noise(0.01)), u * 1e6);
    }
    text
}

/// Two sessions of three trials, read at two stations, with the root's compliance (rad/(N·m)) and
/// friction (N) of each.
fn sessions(seed: u64, roots: [f64; 2], friction: [f64; 2]) -> String {
    let mut lab = Lab::new(seed);
    let mut text = "session,trial,axis,load_n,time_s,read_station_mm,dy_um\n".to_owned();
    let mut time = 0;
    for (k, name) in ["before noon", "after noon"].into_iter().enumerate() {
        for trial in 1..=3 {
            let zeros = [lab.noise(2e-6), lab.noise(2e-6)];
            for load in [5.0, 10.0, 15.0, 20.0] {
                time += 60;
                for (station, zero) in [0.3, 0.6].into_iter().zip(zeros) {
                    let felt = load - friction[k];
                    let y = lab.compliance(station, roots[k]) * felt + zero + lab.noise(2e-6);
                    let station = station * 1e3;
                    text += &format!("{name},{trial},y,{load},{time},{station},{:.1}\n", y * 1e6);
                }
            }
            time += 300;
        }
    }
    text
}

/// Four trials of loads that are read several times; creep of 3 % per decade, t₀ 10 s, since the
/// load was hung (`loaded_at_s` stated) or since a moment before each trial.
fn creeping(seed: u64, rate: f64, is_stated: bool) -> String {
    let mut lab = Lab::new(seed);
    let c = lab.compliance(LENGTH, 0.0);
    let stated = if is_stated { ",loaded_at_s" } else { "" };
    let mut text = format!("trial,axis,load_n,time_s{stated},dy_um\n");
    let mut time = 0.0;
    for trial in 1..=4 {
        time += 500.0;
        let mut since = time;
        time += lab.random.uniform(5.0, 120.0);
        let zero = lab.noise(1e-6);
        for load in [5.0, 10.0, 15.0, 20.0] {
            if is_stated {
                since = time - 5.0;
            }
            for waited in [0.0, 20.0, 60.0, 120.0] {
                let now: f64 = time + waited;
                let grown = 1.0 + rate * (1.0 + (now - since) / 10.0).log10();
                let y = c * load * grown + zero + lab.noise(1e-6);
                let stated = if is_stated { format!(",{since:.2}") } else { String::new() };
                text += &format!("{trial},y,{load},{now:.2}{stated},{:.1}\n", y * 1e6);
            }
            time += 135.0;
        }
    }
    text
}

/// Displacements that are imposed and held three times over, the load falling by `rate` per decade.
fn held(seed: u64, rate: f64) -> String {
    let mut lab = Lab::new(seed);
    let c = lab.compliance(LENGTH, 0.0);
    let levels = [0.0, 2e-3, 4e-3, 2e-3];
    let mut text = "# driven = \"displacement\"\ntrial,axis,load_n,time_s,loaded_at_s,dy_um\n".to_owned();
    for trial in 0..3 {
        for hold in 0..3 {
            let set = 4000 * trial + 610 * hold;
            for waited in [5, 10, 20, 40, 60, 90, 120, 180, 240, 300, 400, 600] {
                let left = |at: usize| {
                    1.0 - rate * (1.0 + f64::from(waited + 610 * (hold - at as i32)) / 10.0).log10()
                };
                let steps = (0..=hold as usize).map(|at| (levels[at + 1] - levels[at]) / c * left(at));
                let force: f64 = steps.sum::<f64>() + lab.noise(0.01);
                let u = levels[hold as usize + 1] * 1e6;
                text += &format!("{trial},{},{},{set},{u:.1}\n", signed(force), set + waited);
            }
        }
    }
    text
}

/// A friction damper of 14 kN under a sine of 20 mm, without a rod; its play is crossed at every
/// turn.
fn damper(seed: u64, friction: f64, play: f64, stiffness: f64) -> String {
    let mut lab = Lab::new(seed);
    let mut text = "# driven = \"displacement\"\naxis,load_n,time_s,dx_um\n".to_owned();
    let (mut before, mut slider) = (0.0f64, 0.0f64);
    for k in 1..=120 {
        let u = 20e-3 * (2.0 * std::f64::consts::PI * f64::from(k) / 40.0).sin();
        let moved = slider.max(u - play).min(u + play);
        let rubs = if play > 0.0 && moved == slider { 0.0 } else { (u - before).signum() };
        (before, slider) = (u, moved);
        let force = friction * rubs + stiffness * u + lab.noise(70.0);
        let axis = if force < 0.0 { "-x" } else { "x" };
        text += &format!("{axis},{:.1},{},{:.1}\n", force.abs(), 0.05 * f64::from(k), u * 1e6);
    }
    text
}

fn of_rod(text: &str) -> Answer {
    Answer::of(Some(ROD), text)
}

/// The rod that needs more load for its displacement is the stiffer one.
#[test]
fn a_stiffer_rod_is_said_to_be_stiffer_where_the_displacement_is_imposed() {
    for (youngs, word) in [("195.0", "above"), ("205.0", "below")] {
        let file = ROD.replace("200.0", youngs);
        let answer = Answer::of(Some(&file), &imposed(0, false, 0.0, 0.0));
        let headline = answer.json["headline"].as_str().unwrap();
        assert!(headline.contains(&format!("% {word} that of the rod file")), "{youngs}: {headline}");
    }
}

/// Of `texts` all are consistent: not one of these few may be named.
fn assert_silent(texts: impl Iterator<Item = String>, what: &str) {
    for (seed, text) in texts.enumerate() {
        let answer = of_rod(&text);
        assert!(answer.is_consistent(), "{what} {seed}: {}", answer.json["headline"]);
    }
}

/// The interval lies within ± `most` of the value, which lies in twice the interval but for 2 %:
/// what the moduli are off by is no part of it.
fn assert_found(finding: &Value, name: &str, truth: f64, most: f64) {
    let [low, _, high] = interval(finding, name);
    let wide = 0.5 * (high - low) + 0.02 * truth;
    assert!(low - wide <= truth && truth <= high + wide, "{name} {truth}: {low} to {high}");
    assert!((low - truth).abs() < most && (high - truth).abs() < most, "{name} {truth}: {low} to {high}");
}

#[test]
fn clean_recordings_of_every_kind_are_silent() {
    assert_silent(SEEDS.map(|seed| hung(seed, false, 0.0, 0.0, &[LENGTH])), "to and fro");
    assert_silent(SEEDS.map(|seed| hung(seed, true, 0.0, 0.0, &[LENGTH])), "up and down");
    assert_silent(SEEDS.map(|seed| hung(seed, false, 0.0, 0.0, &[0.3, LENGTH])), "two stations");
    assert_silent(SEEDS.map(|seed| imposed(seed, false, 0.0, 0.0)), "imposed in steps");
    assert_silent(SEEDS.map(|seed| imposed(seed, true, 0.0, 0.0)), "an imposed sine");
    assert_silent(SEEDS.map(|seed| held(seed, 0.0)), "held");
    assert_silent(SEEDS.map(|seed| sessions(seed, [0.0; 2], [0.0; 2])), "two sessions");
    assert_silent(SEEDS.map(|seed| creeping(seed, 0.0, true)), "times of hanging");
    assert_silent(SEEDS.map(|seed| creeping(seed, 0.0, false)), "several readings of a load");
}

#[test]
fn friction_and_play_act_at_every_turn_of_a_load() {
    for seed in SEEDS {
        for is_one_sided in [false, true] {
            let answer = of_rod(&hung(seed, is_one_sided, 1.2, 0.0, &[LENGTH]));
            assert_eq!(answer.effects(), ["friction"], "{}", answer.json["headline"]);
            assert_found(answer.finding("friction"), "force_n", 1.2, 0.05);
        }
        let both = of_rod(&hung(seed, false, 1.2, 30e-6, &[LENGTH]));
        assert_eq!(both.effects(), ["friction", "backlash"], "{}", both.json["headline"]);
        assert_found(both.finding("backlash"), "play_um", 30.0, 6.0);
        let stations = of_rod(&hung(seed, false, 1.2, 0.0, &[0.3, LENGTH]));
        assert_eq!(stations.effects(), ["friction"], "{}", stations.json["headline"]);
    }
}

#[test]
fn friction_and_play_are_found_under_an_imposed_displacement() {
    for seed in SEEDS {
        for is_sine in [false, true] {
            let rubbing = of_rod(&imposed(seed, is_sine, 0.6, 0.0));
            assert_eq!(rubbing.effects(), ["friction"], "{}", rubbing.json["headline"]);
            assert_found(rubbing.finding("friction"), "force_n", 0.6, 0.02);
            let both = of_rod(&imposed(seed, is_sine, 0.6, 150e-6));
            assert_eq!(both.effects()[0], "friction", "{}", both.json["headline"]);
            let loose =
                both.findings().iter().find(|finding| finding["parameters"].to_string().contains("play_um"));
            assert_found(loose.unwrap(), "play_um", 150.0, 15.0);
            assert!(both.json["unexplained"].is_null(), "{}", both.json["headline"]);
            // what a user reads is newtons
            let noise = both.json["measured_load"]["noise_n"].as_f64().unwrap();
            assert!((0.007..0.013).contains(&noise), "{noise} N");
        }
        let loose = of_rod(&imposed(seed, false, 0.0, 150e-6));
        assert_eq!(loose.effects(), ["backlash"], "{}", loose.json["headline"]);
        assert_found(loose.finding("backlash"), "play_um", 150.0, 15.0);
    }
}

#[test]
fn under_a_held_displacement_the_load_falls() {
    for seed in SEEDS {
        let answer = of_rod(&held(seed, 0.03));
        assert_eq!(answer.effects(), ["creep"], "{}", answer.json["headline"]);
        assert_found(answer.finding("creep"), "per_decade", 0.03, 0.003);
        assert!(answer.json["headline"].as_str().unwrap().contains("the load falls by"));
    }
}

#[test]
fn a_root_that_differs_by_session_is_named_with_its_session() {
    for seed in SEEDS {
        let answer = of_rod(&sessions(seed, [0.0, 40e-6], [0.0; 2]));
        assert_eq!(answer.effects(), ["root_compliance"], "{}", answer.json["headline"]);
        let finding = answer.finding("root_compliance");
        assert_eq!(finding["location"], "root, session after noon");
        assert_found(finding, "bending_urad_per_nm", 40.0, 3.0);
        let friction = of_rod(&sessions(seed, [0.0; 2], [0.0, 1.0]));
        assert_eq!(friction.effects().len(), 1, "{}", friction.json["headline"]);
        // without a way down the two cannot be told apart
        let class = friction.class(0);
        assert!(class.contains(&"friction") && class.contains(&"load_offset"), "{class:?}");
        assert!(friction.findings()[0]["location"].as_str().unwrap().ends_with("session after noon"));
    }
}

#[test]
fn creep_is_measured_since_each_load_was_hung_or_since_a_moment_nobody_knows() {
    for seed in SEEDS {
        for is_stated in [true, false] {
            let answer = of_rod(&creeping(seed, 0.03, is_stated));
            assert_eq!(answer.effects(), ["creep"], "{is_stated} {}", answer.json["headline"]);
            assert_found(answer.finding("creep"), "per_decade", 0.03, 0.006);
        }
    }
}

/// A smooth curve along the run follows anything that repeats; the law says it with one number or
/// two.
#[test]
fn a_friction_damper_is_a_friction_damper() {
    for (seed, stiffness) in SEEDS.zip([0.0, 2e5]) {
        let answer = Answer::of(None, &damper(seed, 14e3, 0.0, stiffness));
        assert_eq!(answer.effects(), ["friction"], "{}", answer.json["headline"]);
        assert_found(answer.finding("friction"), "force_n", 14e3, 100.0);
        let loose = Answer::of(None, &damper(seed, 14e3, 1.5e-3, 0.0));
        assert_eq!(loose.effects()[0], "friction", "{}", loose.json["headline"]);
        assert!(loose.json["unexplained"].is_null(), "{}", loose.json["headline"]);
        assert_found(loose.finding("friction"), "force_n", 14e3, 500.0);
        // at a turn the readings are 0.2, 1 and 2.2 mm of travel behind it, then 3.8: the gap of 3
        // mm ends between two of them
        let [low, value, high] = interval(loose.finding("friction"), "play_um");
        assert!(
            low < 1.5e3 && high > 1.5e3 && (1.09e3..1.91e3).contains(&value),
            "{low} to {high} of 1500 µm"
        );
    }
    let undeclared = damper(0, 14e3, 0.0, 2e5).replace("# driven = \"displacement\"\n", "");
    let limits = Answer::of(None, &undeclared).found.limits;
    assert!(
        limits.iter().any(|limit| limit.to_string().contains("was the displacement imposed")),
        "{limits:?}"
    );
}

/// Rows and cells of a recording that says its times.
fn rows(text: &str) -> (String, Vec<String>) {
    let (table, above): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| !line.starts_with('#'));
    let head = [&above[..], &table[..1]].concat().join("\n") + "\n";
    (head, table[1..].iter().map(|row| (*row).to_owned() + "\n").collect())
}

fn assert_same_answer(a: &Answer, b: &Answer) {
    for key in ["verdict", "headline", "noise_um", "rms_after_um", "heldout_after_um", "unexplained"] {
        assert_eq!(a.json[key], b.json[key], "{key}");
    }
    // the rows have other numbers, all else is the same to the last digit
    for (a, b) in a.findings().iter().zip(b.findings()) {
        for key in ["effect", "location", "parameters", "indistinguishable_from", "p_value"] {
            assert_eq!(a[key], b[key], "{key}");
        }
    }
}

#[test]
fn with_times_rows_may_stand_in_any_order() {
    for text in [
        hung(1, false, 1.2, 30e-6, &[0.3, LENGTH]),
        imposed(2, true, 0.6, 150e-6),
        sessions(3, [30e-6, 70e-6], [0.5; 2]),
        creeping(1, 0.03, true),
    ] {
        let (head, rows) = rows(&text);
        let plain = of_rod(&text);
        assert!(!plain.is_consistent());
        for step in [7, 53] {
            // a step that has no divisor in common with the number of rows meets each of them once
            let step = (step..).find(|step| gcd(*step, rows.len()) == 1).unwrap();
            let shuffled: Vec<&str> = (0..rows.len()).map(|k| &rows[k * step % rows.len()][..]).collect();
            assert_same_answer(&plain, &of_rod(&(head.clone() + &shuffled.concat())));
        }
    }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// With times or without, one row for all channels, one for each, station after station or all of
/// an instant together.
#[test]
fn one_row_per_station_or_channel_is_the_same_recording() {
    let mut lab = Lab::new(5);
    let mut readings: Vec<[f64; 6]> = Vec::new();
    for trial in 1..=3 {
        for (k, load) in [4.0, 8.0, 12.0, 16.0, 12.0, 8.0, 4.0].into_iter().enumerate() {
            for station in [0.3, 0.6] {
                let felt = load + if k > 3 { 0.8 } else { -0.8 };
                let y = lab.compliance(station, 0.0) * felt + lab.noise(2e-6);
                let z = lab.noise(2e-6);
                let time = 1000.0 * f64::from(trial) + 60.0 * k as f64;
                readings.push([f64::from(trial), load, time, station * 1e3, y * 1e6, z * 1e6]);
            }
        }
    }
    for has_time in [true, false] {
        let time = |row: &[f64; 6]| if has_time { format!("{},", row[2]) } else { String::new() };
        let head = format!(
            "trial,axis,load_n,{}read_station_mm,dy_um,dz_um\n",
            if has_time { "time_s," } else { "" }
        );
        let cells = |row: &[f64; 6], y: bool, z: bool| {
            let cell =
                |is_read: bool, value: f64| if is_read { format!("{value:.2}") } else { String::new() };
            let [trial, load, _, station, dy, dz] = *row;
            format!("{trial},y,{load},{}{station},{},{}\n", time(row), cell(y, dy), cell(z, dz))
        };
        let all: String = readings.iter().map(|row| cells(row, true, true)).collect();
        let per_channel: String =
            readings.iter().map(|row| cells(row, true, false) + &cells(row, false, true)).collect();
        let mut blocks = readings.clone();
        blocks.sort_by(|a, b| a[3].total_cmp(&b[3]));
        let by_station: String = blocks.iter().map(|row| cells(row, true, true)).collect();
        let plain = of_rod(&(head.clone() + &all));
        assert_eq!(plain.effects(), ["friction"], "{has_time} {}", plain.json["headline"]);
        for other in [per_channel, by_station] {
            assert_same_answer(&plain, &of_rod(&(head.clone() + &other)));
        }
    }
}

/// What `--apply` writes of a displacement-driven recording is that recording without its friction.
#[test]
fn corrected_loads_are_those_of_the_rod_alone() {
    let answer = of_rod(&imposed(1, false, 0.6, 0.0));
    let corrected = answer.found.correction().unwrap().unwrap();
    let again = Answer::of(Some(&corrected.rod_toml), &corrected.readings_csv);
    assert!(again.is_consistent(), "{}", again.json["headline"]);
    let readings = Readings::from_text("corrected.csv", &corrected.readings_csv).unwrap();
    assert!(corrected.readings_csv.contains("driven = \"displacement\""));
    assert_eq!(readings.rows.len(), 96);
}
