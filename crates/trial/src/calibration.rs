//! Trials of a calibration: arms, fixtures, recordings and what may be wrong with them.
//!
//! Kinematics, statics and the rod are this room's own; the fitter shares none of them.

mod arm;
mod beyond;
mod conflict;
mod draw;
mod effect;
mod follow_up;
mod geometry;
mod inverse_kinematics;
mod mistake;
mod noise;
mod nuisance;
mod numbers;
mod oracle;
mod prediction_query;
mod rivals;
mod rod;
mod setup;
mod site;
mod text;

use std::collections::BTreeMap;

use nalgebra::Vector3;

use self::conflict::Conflict;
use self::effect::Effect;
pub use self::follow_up::{Proposed, follow_up};
use self::mistake::Mistake;
use self::oracle::Oracle;
use self::prediction_query::Query;
use self::rod::Rod;
use self::setup::Needs;
use self::site::{Devices, Site};
use self::text::Written;
use super::Case;
use crate::chance::{happens, log_uniform};
use crate::ground_truth::{Concealed, GroundTruth, Kind, Parameter};
use crate::{Source, Suite};
use rodcal_base::statistics::Random;
use rodcal_base::units::UM;

/// Streams of random numbers that the rig does not use: of the cases, and of what came later than
/// these.
const STREAM: u64 = 1 << 32;
const QUERY: u64 = 4 << 32;
const FOLLOW_UP: u64 = 5 << 32;

/// Shares of clean, single, several, unknown and mistaken cases.
const SHARES: [(Kind, f64); 5] = [
    (Kind::Clean, 0.2),
    (Kind::Single, 0.37),
    (Kind::Pair, 0.15),
    (Kind::Unknown, 0.13),
    (Kind::Mistake, 0.15),
];
/// How often a single effect is below its detection limit, and how far at most.
const BELOW: (f64, f64) = (0.3, 0.1);
/// Multiples of its detection limit from which an effect of several is drawn, and unknown physics.
const FAINTEST: [f64; 2] = [3.0, 2.0];
/// So often an effect is drawn anew until its detection limit is below this share of its largest
/// size.
const DRAWN: usize = 5;
const SEEN: f64 = 0.25;
/// Multiples of its detection limit of an effect that another one imitates.
const CONFLICT: [f64; 2] = [3.0, 30.0];
/// How often several effects are three.
const THREE: f64 = 0.25;
/// How often files of other rods stand beside that of a case.
const BESIDE: f64 = 0.25;

/// A case as it was drawn.
struct Drawn {
    kind: Kind,
    conflict: Option<Conflict>,
    site: Site,
    effects: Vec<Effect>,
    /// Errors of the rows, m.
    noise: Vec<Vector3<f64>>,
    /// As it should have been written down.
    right: Written,
    mistake: Option<Mistake>,
}

/// Case number `number` of a trial.
pub fn case(source: &Source, number: usize) -> Case {
    let drawn = drawn(source, number);
    let query =
        prediction_query::draw(&drawn.site, &mut Random::of_seed(source.seed.0, QUERY + number as u64));
    let written = drawn.mistake.as_ref().map(|mistake| mistake.applied_to(&drawn.right));
    let mut files = text::files(written.as_ref().unwrap_or(&drawn.right));
    files.extend(query.files());
    let truth = ground_truth(format!("calibration/case-{number:04}"), &drawn, &query);
    let residuals = source.residuals.clone();
    Case { files, truth: GroundTruth { seed: Some(source.seed), residuals, ..truth } }
}

fn drawn(source: &Source, number: usize) -> Drawn {
    let mut random = Random::of_seed(source.seed.0, STREAM + number as u64);
    let random = &mut random;
    let conflict = (source.suite == Suite::Conflicts).then(|| Conflict::of(number));
    let kind = if conflict.is_some() { Kind::Single } else { drawn_kind(random) };
    let (numbers, needs) = match conflict {
        Some(conflict) => (Vec::new(), conflict.needs()),
        None => numbers(kind, random),
    };
    let mut site = setup::draw(needs, &source.residuals, random);
    let effects = effects(kind, conflict, &numbers, &site, random);
    let noise = site.errors(0, random);
    let read = setup::measured(&mut site, &effects, 0, &noise);
    let guess = text::guess(&site, random);
    let mut right = Written { site: site.clone(), guess, read, others: Vec::new() };
    if site.rod.is_some() && happens(random, BESIDE) {
        right.others.push(("rod-3.toml".into(), Rod::drawing(random)));
    }
    let mistake = (kind == Kind::Mistake).then(|| mistake::draw(&right, random));
    Drawn { kind, conflict, site, effects, noise, right, mistake }
}

fn drawn_kind(random: &mut Random) -> Kind {
    let mut drawn = random.uniform(0.0, 1.0);
    for (kind, share) in SHARES {
        if drawn < share {
            return kind;
        }
        drawn -= share;
    }
    Kind::Clean
}

/// Effects by number, and what they need of a recording together.
fn numbers(kind: Kind, random: &mut Random) -> (Vec<usize>, Needs) {
    match kind {
        Kind::Clean | Kind::Mistake | Kind::Suspect => (Vec::new(), Needs::default()),
        Kind::Unknown => {
            let number = random.index(beyond::BEYOND);
            (vec![number], beyond::needs(number))
        }
        Kind::Single => {
            let number = random.index(draw::LIBRARY);
            (vec![number], draw::needs(number))
        }
        Kind::Pair => {
            let count = if happens(random, THREE) { 3 } else { 2 };
            let (mut numbers, mut needs) = (Vec::new(), Needs::default());
            while numbers.len() < count {
                let number = random.index(draw::LIBRARY);
                if let Some(both) = needs.and(draw::needs(number)).filter(|_| !numbers.contains(&number)) {
                    numbers.push(number);
                    needs = both;
                }
            }
            (numbers, needs)
        }
    }
}

/// The effects of these numbers, as large as the kind of the case wants them.
fn effects(
    kind: Kind,
    conflict: Option<Conflict>,
    numbers: &[usize],
    site: &Site,
    random: &mut Random,
) -> Vec<Effect> {
    if kind == Kind::Clean || kind == Kind::Mistake {
        return Vec::new();
    }
    let oracle = Oracle::new(site);
    if let Some(conflict) = conflict {
        let largest = conflict.effect(site, random);
        let share = log_uniform(random, CONFLICT[0], CONFLICT[1]) * oracle.limit(&largest);
        return vec![if conflict.is_scaled() { largest.scaled(share.min(1.0)) } else { largest }];
    }
    let of_number = |&number: &usize| {
        let mut draw = || match kind {
            Kind::Unknown => beyond::beyond(number, site, random),
            _ => draw::library(number, site, random),
        };
        // at another joint or in another direction it may be seen
        let tried: Vec<(f64, Effect)> = (0..DRAWN)
            .map(|_| draw())
            .map(|largest| (oracle.limit(&largest), largest))
            .scan(false, |is_seen, tried| (!std::mem::replace(is_seen, tried.0 < SEEN)).then_some(tried))
            .collect();
        let (limit, largest) = tried.into_iter().next_back()?;
        let limit = limit.clamp(1e-4, 1.0);
        let (least, most) = match kind {
            Kind::Single if happens(random, BELOW.0) => (BELOW.1 * limit, limit),
            Kind::Single => (limit, 1.0),
            Kind::Pair => ((FAINTEST[0] * limit).min(0.5), 1.0),
            _ => ((FAINTEST[1] * limit).min(0.5), 1.0),
        };
        Some(largest.scaled(log_uniform(random, least, most)))
    };
    numbers.iter().filter_map(of_number).collect()
}

fn ground_truth(case: String, drawn: &Drawn, query: &Query) -> GroundTruth {
    let Drawn { kind, site, effects, noise, .. } = drawn;
    let mut oracle = (!effects.is_empty()).then(|| Oracle::new(site));
    if let Some(oracle) = &mut oracle {
        oracle.compare(effects);
    }
    let sd = site.scatter.sd.hypot(site.scatter.step / 12f64.sqrt());
    let concealed_effect = |(which, effect): (usize, &Effect)| {
        let alone = site.added(std::slice::from_ref(effect), &[]);
        let place = draw::place(effect, site);
        Some(Concealed {
            effect: effect.name(site.has_sockets()),
            location: place.to_string(),
            place,
            parameters: with_places(site, effect, parameters(effect.parameters())),
            size_over_noise: (alone.norm_squared() / alone.len() as f64).sqrt() / sd,
            detectability: oracle.as_ref()?.detectability(effects, which),
        })
    };
    let mut concealed: Vec<Concealed> = effects.iter().enumerate().filter_map(concealed_effect).collect();
    concealed.sort_by(|a, b| b.size_over_noise.total_cmp(&a.size_over_noise));
    concealed.extend(drawn.mistake.as_ref().map(|mistake| {
        Concealed::mistake(mistake.name(), mistake.place(site), parameters(mistake.parameters()))
    }));
    let left = oracle.as_ref().map(|oracle| oracle.share_left(effects));
    GroundTruth {
        case,
        kind: *kind,
        conflict: drawn.conflict.map(|conflict| conflict.name().to_owned()),
        effects: concealed,
        companions: Vec::new(),
        numbers_off: site.times,
        noise_um: sd / UM,
        noise_shape: site.scatter.description(),
        quantum_um: site.scatter.step / UM,
        readings: 3 * site.rows.len(),
        protocol: description(site),
        joints: BTreeMap::new(),
        geometric_um: 0.0,
        oracle_gain: left
            .filter(|_| !effects.iter().any(Effect::is_of_one_run))
            .map(|left| left / (left + 1.0)),
        seed: None,
        residuals: Vec::new(),
        query: Some(query.truth(site, effects, noise)),
    }
}

/// Where a clamp stands nobody can separate from how far its place was off before.
fn with_places(site: &Site, effect: &Effect, mut parameters: Vec<Parameter>) -> Vec<Parameter> {
    if let Effect::ClampPose { group, by, .. } = effect {
        let whole = by + site.clamps_off[*group];
        for (parameter, all) in parameters.iter_mut().zip(whole.iter()) {
            parameter.with_numbers = Some(all / UM);
        }
    }
    parameters
}

fn parameters(numbers: Vec<(&str, f64)>) -> Vec<Parameter> {
    numbers
        .into_iter()
        .map(|(name, value)| Parameter { name: name.into(), value, with_numbers: None })
        .collect()
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
    use crate::effect_name::EffectName;

    fn case(suite: Suite, number: usize) -> Case {
        super::case(&Source { seed: crate::Seed(1), suite, residuals: Vec::new() }, number)
    }

    #[test]
    fn a_case_is_what_its_kind_says() {
        let mut kinds = std::collections::BTreeSet::new();
        for number in 0..16 {
            let truth = case(Suite::Calibration, number).truth;
            let expected = match truth.kind {
                Kind::Clean | Kind::Suspect => 0..=0,
                Kind::Single | Kind::Unknown | Kind::Mistake => 1..=1,
                Kind::Pair => 2..=3,
            };
            assert!(expected.contains(&truth.effects.len()), "{truth:?}");
            assert!(truth.effects.iter().all(|e| e.size_over_noise > 0.0), "{truth:?}");
            assert!([1.0, 2.0].contains(&truth.numbers_off) && truth.conflict.is_none());
            let is_unknown = truth.kind == Kind::Unknown;
            assert!(truth.effects.iter().all(|e| e.detectability.against_pair.is_some() == is_unknown));
            kinds.insert(format!("{:?}", truth.kind));
        }
        assert_eq!(kinds.len(), 5);
    }

    #[test]
    fn both_sides_of_a_conflict_are_drawn_in_turn() {
        let names: Vec<(String, EffectName)> = (0..4)
            .map(|number| case(Suite::Conflicts, number).truth)
            .map(|truth| (truth.conflict.unwrap(), truth.effects[0].effect.clone()))
            .collect();
        let expected =
            [EffectName::ReadbackLag, EffectName::Backlash, EffectName::TipMass, EffectName::JointCompliance];
        assert!(names.iter().map(|(_, effect)| effect).eq(&expected), "{names:?}");
        assert_eq!((&names[0].0, names[1].0 == names[2].0), (&names[1].0, false));
    }
}
