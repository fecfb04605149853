//! Mistakes of the rod file: a key in another unit, a radius for a diameter, two lengths exchanged,
//! another rod's file; and stations of the readings in another unit.

use super::super::effects::mistakes::{ROD_MISTAKE, SWAP_MISTAKE, UNIT_MISTAKE};
use super::change::{Change, Move, exact};
use super::moves::BESIDE;
use super::physics::Verdict;
use crate::inference::Effect;
use crate::rod::{Pipe, Rod};
use crate::section::Section;
use crate::units::{GPA, MM, significant};

/// Other units of a length: true over recorded, name, ln of the prior.
const LENGTHS: [(f64, &str, f64); 5] = [
    (1e3, "metres", -0.5),
    (25.4, "inches", -0.5),
    (10.0, "centimetres", -1.0),
    (1e-3, "micrometres", -2.0),
    (0.1, "tenths of a millimetre", -2.5),
];
const RADIUS: (f64, &str, f64) = (2.0, "radii", -0.5);
/// Of a modulus.
const MODULI: [(f64, &str, f64); 4] = [
    (1e-3, "megapascals", -0.5),
    (1e-9, "pascals", -0.5),
    (6.894_757, "Msi (10⁶ psi)", -0.5),
    (1e3, "terapascals", -2.0),
];
/// A key is right more often than a column.
const KEY: f64 = -0.5;
/// Another rod is no unit: what remains must be as files are.
const OTHER: f64 = 1.1;
/// Ln of the prior of another rod.
const OTHER_ROD: f64 = -2.0;
/// Of the rods that are tried in full, how many there are at most, and how far behind the given one
/// the slopes may see them.
const MOST_OTHERS: usize = 4;
const FAR_BEHIND: f64 = 10.0;

/// A rod that may have been meant, with what must be done to the stations of the readings.
pub(super) struct Body {
    pub rod: Rod,
    /// Factors on the stations of load and sensor.
    pub stations: [f64; 2],
}

/// A rod that may have been meant, tried in full: one of another file, or the given one with two of
/// its parts exchanged.
#[derive(Debug, Clone)]
pub(in crate::diagnosis::rig) struct OtherRod {
    pub rod: Rod,
    pub effect: &'static Effect,
    /// The file, or the keys that are exchanged.
    pub location: String,
    /// What is said of it, with the correction.
    pub words: String,
    pub log_prior: f64,
}

/// The given rod with its lengths, or its pipes, exchanged.
fn exchanged(rod: &Rod) -> Vec<OtherRod> {
    let of_location = |location: &str, meant: Rod, log_prior: f64| OtherRod {
        rod: meant,
        effect: &SWAP_MISTAKE,
        location: location.into(),
        words: format!("{location} are swapped in the rod file: exchange them"),
        log_prior,
    };
    let mut found = Vec::new();
    if rod.l1 != rod.l2 {
        let meant = Rod { l1: rod.l2, l2: rod.l1, ..rod.clone() };
        found.push(of_location("l1_mm and l2_mm", meant, 0.0));
    }
    if rod.pipe1 != rod.pipe2 {
        let meant = Rod { pipe1: rod.pipe2.clone(), pipe2: rod.pipe1.clone(), ..rod.clone() };
        found.push(of_location("pipe1 and pipe2", meant, -1.0));
    }
    found
}

/// Moves with their rods: the body of the k-th is number k + 1.
pub(super) fn all(rod: &Rod, others: &[(String, Rod)], has_stations: [bool; 2]) -> Vec<(Body, Move)> {
    let mut found = Vec::new();
    let mut add = |body: Body,
                   effect: &'static Effect,
                   location: String,
                   observed: String,
                   factor: Option<f64>,
                   prior: f64| {
        let looks_like = match effect {
            effect if effect == &UNIT_MISTAKE && location.contains(',') => {
                format!("{location} look as if they were in another unit")
            }
            effect if effect == &UNIT_MISTAKE => format!("{location} looks as if it were in another unit"),
            effect if effect == &SWAP_MISTAKE => format!("{location} look swapped"),
            _ => format!("the readings look like those of {location}"),
        };
        let change = Change::body(found.len() + 1);
        let within = match effect {
            effect if effect == &ROD_MISTAKE => OTHER,
            // there is no number in it that anything had to come near to
            effect if effect == &SWAP_MISTAKE => f64::INFINITY,
            _ => BESIDE,
        };
        let estimates = factor.map(|factor| exact("factor", factor)).into_iter().collect();
        found.push((
            body,
            Move { effect, location, change, log_prior: prior, estimates, observed, looks_like, within },
        ));
    };
    let own = |rod: Rod| Body { rod, stations: [1.0; 2] };
    for OtherRod { rod, effect, location, words, log_prior } in exchanged(rod) {
        add(own(rod), effect, location, words, None, log_prior);
    }
    for (keys, factor, unit, prior, meant) in in_other_units(rod) {
        let words = format!("{keys} {}: {}", is_in(unit, &keys), cure(factor, &keys));
        add(own(meant), &UNIT_MISTAKE, keys, words, Some(factor), prior + KEY);
    }
    for (k, column) in
        ["load_station_mm", "read_station_mm"].into_iter().enumerate().filter(|(k, _)| has_stations[*k])
    {
        for (factor, unit, prior) in LENGTHS {
            let mut stations = [1.0; 2];
            stations[k] = factor;
            let words = format!("{column} is in {unit}, not in millimetres: {}", cure(factor, column));
            add(
                Body { rod: rod.clone(), stations },
                &UNIT_MISTAKE,
                column.into(),
                words,
                Some(factor),
                prior,
            );
        }
    }
    for (file, other) in others.iter().filter(|(_, other)| !is_alike(other, rod)) {
        add(own(other.clone()), &ROD_MISTAKE, file.clone(), meant(file, other, rod), None, OTHER_ROD);
    }
    found
}

/// Rods that may have been meant: those that a load distinguishes from `rod`, and on which the
/// slopes have about the size that they should; the likeliest first, by the density of the slopes
/// `of`.
pub(super) fn likely(
    rod: &Rod,
    others: &[(String, Rod)],
    of: impl Fn(&Rod) -> Option<Verdict>,
) -> Vec<OtherRod> {
    let Some(own) = of(rod) else { return Vec::new() };
    let of_file = |(file, other): &(String, Rod)| OtherRod {
        rod: other.clone(),
        effect: &ROD_MISTAKE,
        location: file.clone(),
        words: meant(file, other, rod),
        log_prior: OTHER_ROD,
    };
    let all = exchanged(rod).into_iter().filter(|other| is_possible(&other.rod));
    let known = all.chain(others.iter().map(of_file)).filter(|other| !is_alike(&other.rod, rod));
    let known = known.filter_map(|other| {
        let verdict = of(&other.rod)?;
        // of one file's numbers none is nearer by chance
        let within: f64 = if other.effect == &ROD_MISTAKE { OTHER } else { BESIDE };
        let is_likely = verdict.log_scale_of_known.abs() <= within.ln()
            && verdict.log_evidence > own.log_evidence - FAR_BEHIND;
        is_likely.then_some((verdict.log_evidence, other))
    });
    let mut known: Vec<(f64, OtherRod)> = known.collect();
    known.sort_by(|a, b| b.0.total_cmp(&a.0));
    known.into_iter().take(MOST_OTHERS).map(|(_, other)| other).collect()
}

/// What is said of readings of another rod.
fn meant(file: &str, other: &Rod, rod: &Rod) -> String {
    format!("The readings are those of rod {} ({file}), not of rod {}: use {file}", other.name, rod.name)
}

/// Nothing that a load could tell.
fn is_alike(a: &Rod, b: &Rod) -> bool {
    let tubes = |rod: &Rod| [rod.pipe1.clone(), rod.bend.clone(), rod.pipe2.clone()];
    (a.l1, a.l2, a.gamma, a.bend_radius) == (b.l1, b.l2, b.gamma, b.bend_radius)
        && a.bend_flexibility == b.bend_flexibility
        && tubes(a) == tubes(b)
        && a.joints == b.joints
}

/// `are radii, not diameters`.
fn is_in(unit: &str, keys: &str) -> String {
    let is_one = !keys.contains(',');
    let verb = if is_one { "is" } else { "are" };
    match unit {
        "radii" if is_one => "is a radius, not a diameter".into(),
        "radii" => "are radii, not diameters".into(),
        "radians" => format!("{verb} in radians, not in degrees"),
        _ if keys.contains("modulus") => format!("{verb} in {unit}, not in gigapascals"),
        _ => format!("{verb} in {unit}, not in millimetres"),
    }
}

fn cure(factor: f64, keys: &str) -> String {
    let it = if keys.contains(',') { "them" } else { "it" };
    let number = |x: f64| if x.fract() == 0.0 { format!("{x}") } else { significant(x, 5) };
    match factor >= 1.0 {
        true => format!("multiply {it} by {}", number(factor)),
        false => format!("divide {it} by {}", number((1.0 / factor).round())),
    }
}

/// Keys, factor, unit, ln of the prior, and the rod that was meant.
type Meant = (String, f64, &'static str, f64, Rod);

fn in_other_units(rod: &Rod) -> Vec<Meant> {
    let mut found: Vec<Meant> = Vec::new();
    for (factor, unit, prior) in LENGTHS {
        for (l1, l2, keys) in
            [(factor, 1.0, "l1_mm"), (1.0, factor, "l2_mm"), (factor, factor, "l1_mm, l2_mm")]
        {
            let meant = Rod { l1: rod.l1 * l1, l2: rod.l2 * l2, ..rod.clone() };
            found.push((keys.into(), factor, unit, prior, meant));
        }
        if rod.bend_radius > 0.0 {
            let meant = Rod { bend_radius: rod.bend_radius * factor, ..rod.clone() };
            found.push(("bend_radius_mm".into(), factor, unit, prior, meant));
        }
    }
    let radians = 180.0 / std::f64::consts::PI;
    if rod.gamma.to_degrees() <= std::f64::consts::PI + 1e-3 {
        let meant = Rod { gamma: rod.gamma * radians, ..rod.clone() };
        found.push(("gamma_deg".into(), radians, "radians", 0.0, meant));
    }
    found.extend(diameters_in_other_units(rod));
    let mut materials: Vec<&str> = vec![&rod.pipe1.material.name];
    if rod.pipe2.material.name != rod.pipe1.material.name {
        materials.push(&rod.pipe2.material.name);
    }
    for material in materials {
        for (factor, unit, prior) in MODULI {
            for (e, g, key) in [
                (factor, factor, format!("material.{material}.youngs_modulus_gpa")),
                (factor, 1.0, format!("material.{material}.youngs_modulus_gpa")),
                (1.0, factor, format!("material.{material}.shear_modulus_gpa")),
            ] {
                let mut meant = rod.clone();
                for pipe in [&mut meant.pipe1, &mut meant.bend, &mut meant.pipe2] {
                    if pipe.material.name == material {
                        pipe.material.youngs_modulus *= e;
                        pipe.material.shear_modulus *= g;
                    }
                }
                found.push((key, factor, unit, prior, meant));
            }
        }
    }
    found.retain(|(_, _, _, _, meant)| is_possible(meant));
    found
}

/// Diameters of tubes; other sections have other keys.
fn diameters_in_other_units(rod: &Rod) -> Vec<Meant> {
    let mut found = Vec::new();
    if [&rod.pipe1, &rod.bend, &rod.pipe2].iter().any(|pipe| pipe.section.as_round().is_none()) {
        return found;
    }
    let is_solid = |pipe: &Pipe| pipe.section.as_round().is_some_and(|round| round.inner_diameter == 0.0);
    for (factor, unit, prior) in LENGTHS.into_iter().chain([RADIUS]) {
        for pipes in [[true, true], [true, false], [false, true]] {
            for (outer, inner) in [(factor, factor), (factor, 1.0), (1.0, factor)] {
                if outer != inner && [&rod.pipe1, &rod.pipe2].iter().any(|pipe| is_solid(pipe)) {
                    continue;
                }
                let of_pipe = |pipe: &Pipe| {
                    let mut pipe = pipe.clone();
                    if let Section::Round(round) = &mut pipe.section {
                        round.outer_diameter *= outer;
                        round.inner_diameter *= inner;
                    }
                    pipe
                };
                let mut meant = rod.clone();
                let mut keys = Vec::new();
                for (pipe, name) in [(&mut meant.pipe1, "pipe1"), (&mut meant.pipe2, "pipe2")] {
                    if !pipes[usize::from(name == "pipe2")] {
                        continue;
                    }
                    *pipe = of_pipe(pipe);
                    let wrong = [(outer, "outer"), (inner, "inner")];
                    let is_solid = is_solid(pipe);
                    let wrong =
                        wrong.into_iter().filter(|(f, which)| *f != 1.0 && !(is_solid && *which == "inner"));
                    keys.extend(wrong.map(|(_, which)| format!("{name}.{which}_diameter_mm")));
                }
                // the bend is pipe 1's unless the file says otherwise
                if pipes[0] && rod.bend.section == rod.pipe1.section {
                    meant.bend = of_pipe(&rod.bend);
                }
                found.push((keys.join(", "), factor, unit, prior, meant));
            }
        }
    }
    found
}

/// What a rod file would allow, and a workshop could make: a file that is corrected holds a real
/// rod.
fn is_possible(rod: &Rod) -> bool {
    let is_section = |section: &Section| match section {
        Section::Round(round) => {
            (1.0 * MM..300.0 * MM).contains(&round.outer_diameter)
                && round.inner_diameter >= 0.0
                && round.wall() > 0.05 * MM
        }
        _ => true,
    };
    let is_pipe = |pipe: &Pipe| {
        let material = &pipe.material;
        is_section(&pipe.section)
            && (1.0 * GPA..1000.0 * GPA).contains(&material.youngs_modulus)
            && (0.3 * GPA..500.0 * GPA).contains(&material.shear_modulus)
    };
    let is_length = |length: f64| (5.0 * MM..5000.0 * MM).contains(&length);
    is_pipe(&rod.pipe1)
        && is_pipe(&rod.pipe2)
        && is_pipe(&rod.bend)
        && is_length(rod.l1)
        && is_length(rod.l2)
        && rod.bend_start() > 0.0
        && rod.l2 > rod.tangent_length()
        && rod.gamma > 0.0
        && rod.gamma <= std::f64::consts::PI + 1e-9
        && rod.joints.iter().all(|joint| joint.station <= rod.length())
}
