//! Trials of a calibration: arms, fixtures, recordings and what may be wrong with them.
//!
//! Kinematics, statics and the rod are this room's own; the fitter shares none of them.

mod again;
mod arm;
mod asked;
mod draw;
mod effect;
mod oracle;
mod rod;
mod setup;
mod site;
mod taken_up;
mod text;

use std::collections::BTreeMap;

use nalgebra::Vector3;

pub use self::again::{Proposed, again};
use self::asked::Question;
use self::effect::Effect;
use self::oracle::Oracle;
use self::setup::Needs;
use self::site::{Devices, Site};
use super::Case;
use crate::truth::{Concealed, Kind, Parameter, Truth};
use rodcal_base::statistics::Random;
use rodcal_base::units::UM;

/// Streams of random numbers that the rig does not use: of the cases, and of what came later than these.
const STREAM: u64 = 1 << 32;
const ASKED: u64 = 4 << 32;
const AGAIN: u64 = 5 << 32;

/// A case as it was drawn.
struct Drawn {
    kind: Kind,
    site: Site,
    effects: Vec<Effect>,
    /// Errors of the rows, m.
    noise: Vec<Vector3<f64>>,
    /// What was read, m.
    read: Vec<Vector3<f64>>,
    /// Where the file has the base.
    guess: [Vector3<f64>; 2],
}

/// Case number `number` of the trial that belongs to `seed`.
pub fn case(seed: u64, number: usize) -> Case {
    let drawn = drawn(seed, number);
    let asked = asked::draw(&drawn.site, &mut Random::seeded(seed, ASKED + number as u64));
    let mut files = text::files(&drawn.site, &drawn.guess, &drawn.read);
    files.extend(asked.files());
    let truth = truth(format!("calibration/case-{number:04}"), &drawn, &asked);
    Case { files, truth: Truth { seed: Some(seed), ..truth } }
}

fn drawn(seed: u64, number: usize) -> Drawn {
    let mut random = Random::seeded(seed, STREAM + number as u64);
    let kind = Kind::drawn(&mut random);
    let (numbers, needs) = numbers(kind, &mut random);
    let mut site = setup::draw(needs, &mut random);
    let faintest = if kind == Kind::Pair { 0.5 } else { 0.0 };
    let effects: Vec<Effect> = numbers
        .into_iter()
        .map(|number| match kind {
            Kind::Unknown => draw::beyond(number, &site, &mut random),
            _ => draw::library(number, &site, faintest, &mut random),
        })
        .collect();
    let noise = setup::noise(&site, 0, &mut random);
    let read = setup::measured(&mut site, &effects, 0, &noise);
    let guess = text::guess(&site, &mut random);
    Drawn { kind, site, effects, noise, read, guess }
}

/// Effects by number, and what they need of a recording together.
fn numbers(kind: Kind, random: &mut Random) -> (Vec<usize>, Needs) {
    match kind {
        Kind::Clean | Kind::Mistake | Kind::Suspect => (Vec::new(), Needs::default()),
        Kind::Unknown => {
            let number = random.index(draw::BEYOND);
            (vec![number], draw::needs_beyond(number))
        }
        Kind::Single => {
            let number = random.index(draw::LIBRARY);
            (vec![number], draw::needs(number))
        }
        Kind::Pair => loop {
            let first = random.index(draw::LIBRARY);
            let second = (first + 1 + random.index(draw::LIBRARY - 1)) % draw::LIBRARY;
            if let Some(needs) = draw::needs(first).and(draw::needs(second)) {
                return (vec![first, second], needs);
            }
        },
    }
}

fn truth(case: String, drawn: &Drawn, asked: &Question) -> Truth {
    let Drawn { kind, site, effects, noise, .. } = drawn;
    let oracle = (!effects.is_empty()).then(|| Oracle::new(site));
    let of = |(which, effect): (usize, &Effect)| {
        let alone = site.added(std::slice::from_ref(effect), &[]);
        let parameter =
            |(name, value): (&str, f64)| Parameter { name: name.into(), value, with_numbers: None };
        let place = draw::place(effect, site);
        Some(Concealed {
            effect: effect.name(site.has_sockets()).into(),
            location: place.to_string(),
            place,
            parameters: effect.parameters().into_iter().map(parameter).collect(),
            size_over_noise: (alone.norm_squared() / alone.len() as f64).sqrt() / site.noise,
            detectability: oracle.as_ref()?.detectability(effects, which),
        })
    };
    let mut concealed: Vec<Concealed> = effects.iter().enumerate().filter_map(of).collect();
    concealed.sort_by(|a, b| b.size_over_noise.total_cmp(&a.size_over_noise));
    let left = oracle.as_ref().map(|oracle| oracle.share_left(effects));
    Truth {
        case,
        kind: *kind,
        effects: concealed,
        companions: Vec::new(),
        numbers_off: 0.0,
        noise_um: site.noise / UM,
        noise_shape: site.shape.map_or("normal".into(), |dof| format!("student-t ({dof})")),
        quantum_um: 0.0,
        readings: 3 * site.rows.len(),
        protocol: description(site),
        joints: BTreeMap::new(),
        geometric_um: 0.0,
        oracle_gain: left
            .filter(|_| !effects.iter().any(Effect::is_of_one_run))
            .map(|left| left / (left + 1.0)),
        seed: None,
        residuals: Vec::new(),
        asked: Some(asked.truth(site, effects, noise)),
    }
}

fn description(site: &Site) -> String {
    let device = match &site.devices {
        Devices::Clamps(clamps) => format!("{} clamps", clamps.len()),
        Devices::Tracker(_) => "a tracker".into(),
        Devices::Sockets(sockets, _) => format!("{} sockets", sockets.len()),
    };
    let rod = if site.rod.is_some() { "a rod" } else { "no rod" };
    let masses = if site.has_masses { "masses" } else { "no masses" };
    format!("{} poses, {}, {device}, {rod}, {masses}", site.rows.len(), site.arm_name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_clean_case_has_no_effect() {
        for number in 0..12 {
            let case = case(1, number);
            assert_eq!(case.truth.kind == Kind::Clean, case.truth.effects.is_empty());
            assert!(case.truth.effects.iter().all(|e| e.size_over_noise > 0.0), "{:?}", case.truth);
        }
    }
}
