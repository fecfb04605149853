//! Other rods that may have been meant: another file's, one with two lengths exchanged, one with a
//! key in another unit ([`keys`]); and stations of the readings in another unit.

mod keys;
mod workshop;

use self::keys::{KEY, in_other_units, station_units};
use self::workshop::is_possible;
use super::labels::BESIDE;
use super::physics::Verdict;
use super::possible::PossibleMistake;
use super::relabelling::Relabelling;
use crate::diagnosis::rig::effects::mistakes::{ANGLE_MISTAKE, ROD_MISTAKE, SWAP_MISTAKE};
use crate::inference::{Effect, Key};
use crate::rod::Rod;
use crate::section::Section;

/// Another rod is no unit: what remains must be as files are.
const OTHER: f64 = 1.1;
/// Ln of the prior of another rod.
const OTHER_ROD: f64 = -2.0;
/// Of the rods that are tried in full, which pay for how far they are off, by how much they may be
/// (twice what the wall of a thin tube makes likely), how many there are at most, and how far
/// behind the given one the slopes may see them.
const OTHER_IN_FULL: f64 = 1.25;
const MOST_OTHERS: usize = 4;
const FAR_BEHIND: f64 = 10.0;

/// How far the angle of a rod may be from that of its file, and how much likelier the slopes must
/// be with it (ln).
const ANGLES_DEG: i32 = 60;
const LIKELIER: f64 = 3.0;
/// Ln of the prior of another angle.
const OTHER_ANGLE: f64 = -3.0;

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
    pub location: Key,
    /// What is said of it, with the correction.
    pub observed: String,
    pub log_prior: f64,
}

/// The given rod with its lengths, the sides of its sections, or its pipes exchanged.
fn exchanged(rod: &Rod) -> Vec<OtherRod> {
    let with = |keys: &str, meant: Rod, log_prior: f64| OtherRod {
        rod: meant,
        effect: &SWAP_MISTAKE,
        location: Key::new(keys),
        observed: format!("{keys} are swapped in the rod file: exchange them"),
        log_prior,
    };
    let mut found = Vec::new();
    if rod.l1 != rod.l2 {
        let meant = Rod { l1: rod.l2, l2: rod.l1, ..rod.clone() };
        found.push(with("l1_mm and l2_mm", meant, 0.0));
    }
    let mut turned = rod.clone();
    turned.pipes_mut().for_each(|pipe| pipe.section = pipe.section.turned());
    if turned != *rod {
        let has_sides = turned.pipes_mut().any(|pipe| matches!(pipe.section, Section::Rectangle(_)));
        let keys = if has_sides { "width_mm and height_mm" } else { "iy_mm4 and iz_mm4" };
        found.push(with(keys, turned, 0.0));
    }
    if rod.pipe1 != rod.pipe2 {
        let meant = Rod { pipe1: rod.pipe2.clone(), pipe2: rod.pipe1.clone(), ..rod.clone() };
        found.push(with("pipe1 and pipe2", meant, -1.0));
    }
    found
}

/// The rod of another file.
fn of_file((file, other): &(String, Rod), rod: &Rod) -> OtherRod {
    OtherRod {
        rod: other.clone(),
        effect: &ROD_MISTAKE,
        location: Key::new(file),
        observed: format!(
            "The readings are those of rod {} ({file}), not of rod {}: use {file}",
            other.name, rod.name
        ),
        log_prior: OTHER_ROD,
    }
}

impl OtherRod {
    /// The given rod with another angle between its pipes, degrees.
    fn of_angle(rod: &Rod, degrees: f64) -> OtherRod {
        let file = rod.gamma.to_degrees();
        OtherRod {
            rod: Rod { gamma: degrees.to_radians(), ..rod.clone() },
            effect: &ANGLE_MISTAKE,
            location: Key::new("gamma_deg"),
            observed: format!(
                "The angle between the pipes is {degrees:.0}°, not {}°: write gamma_deg = {degrees:.1} once a \
                 measurement confirms it",
                (100.0 * file).round() / 100.0
            ),
            log_prior: OTHER_ANGLE,
        }
    }

    /// True for the given rod with another angle.
    pub(in crate::diagnosis::rig) fn is_angled(&self) -> bool {
        self.effect == &ANGLE_MISTAKE
    }

    /// The `given` rod with the angle, of those up to five degrees away, that is likeliest, and
    /// what `look` says of it: ln of how likely it is, and what else. Those between may be less
    /// likely, for each has its own effects.
    pub(in crate::diagnosis::rig) fn sharpened<T>(
        self,
        given: &Rod,
        look: impl Fn(&Rod) -> Option<(f64, T)>,
    ) -> Option<(OtherRod, f64, T)> {
        const WITHIN_DEG: i32 = 5;
        let middle = self.rod.gamma.to_degrees();
        let angles = (-WITHIN_DEG..=WITHIN_DEG).map(|by| OtherRod::of_angle(given, middle + f64::from(by)));
        let looked = angles.filter(|other| is_possible(&other.rod)).filter_map(|other| {
            let (likely, besides) = look(&other.rod)?;
            Some((other, likely, besides))
        });
        looked.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn mistake(self) -> (Body, PossibleMistake) {
        let OtherRod { rod, effect, location, observed, log_prior } = self;
        let (looks_like, within) = match effect == &ROD_MISTAKE {
            true => (format!("the readings look like those of {location}"), OTHER),
            // there is no number in it that anything had to come near to
            false => (format!("{location} look swapped"), f64::INFINITY),
        };
        let relabelling = Relabelling::default();
        let mistake = PossibleMistake {
            effect,
            location,
            relabelling,
            log_prior,
            estimates: Vec::new(),
            observed,
            or_else: None,
            looks_like,
            within,
        };
        (Body { rod, stations: [1.0; 2] }, mistake)
    }
}

/// Mistakes with their rods: the body of the k-th is number k + 1.
pub(super) fn all(
    rod: &Rod,
    others: &[(String, Rod)],
    has_stations: [bool; 2],
) -> Vec<(Body, PossibleMistake)> {
    let mut found: Vec<(Body, PossibleMistake)> = exchanged(rod).into_iter().map(OtherRod::mistake).collect();
    for meant in in_other_units(rod) {
        let mistake = meant.unit.mistake(&meant.keys, KEY);
        found.push((Body { rod: meant.rod, stations: [1.0; 2] }, mistake));
    }
    for k in (0..2).filter(|k| has_stations[*k]) {
        for (factor, mistake) in station_units(k) {
            let mut stations = [1.0; 2];
            stations[k] = factor;
            found.push((Body { rod: rod.clone(), stations }, mistake));
        }
    }
    let others = others.iter().filter(|(_, other)| !is_alike(other, rod));
    found.extend(others.map(|other| of_file(other, rod).mistake()));
    for (k, (_, mistake)) in found.iter_mut().enumerate() {
        mistake.relabelling = Relabelling::body(k + 1);
    }
    found
}

/// Rods that may have been meant: those that a load distinguishes from `rod`, and on which the
/// slopes have about the size that they should; the likeliest first, by what the slopes say of each
/// (`verdict_of`).
pub(super) fn likely(
    rod: &Rod,
    others: &[(String, Rod)],
    verdict_of: impl Fn(&Rod) -> Option<Verdict>,
) -> Vec<OtherRod> {
    let Some(own) = verdict_of(rod) else { return Vec::new() };
    let file = rod.gamma.to_degrees().round();
    let angles = (-ANGLES_DEG..=ANGLES_DEG).filter(|by| *by != 0).map(|by| file + f64::from(by));
    let bent = angles.map(|degrees| OtherRod::of_angle(rod, degrees)).filter(|other| is_possible(&other.rod));
    let bent = bent.filter_map(|other| Some((verdict_of(&other.rod)?.log_evidence, other)));
    let bent = bent.max_by(|a, b| a.0.total_cmp(&b.0));
    let bent = bent.filter(|(evidence, _)| *evidence > own.log_evidence + LIKELIER);
    let all = exchanged(rod).into_iter().filter(|other| is_possible(&other.rod));
    let known =
        all.chain(others.iter().map(|other| of_file(other, rod))).filter(|other| !is_alike(&other.rod, rod));
    let known = known.filter_map(|other| {
        let verdict = verdict_of(&other.rod)?;
        // of one file's numbers none is nearer by chance
        let within: f64 = if other.effect == &ROD_MISTAKE { OTHER_IN_FULL } else { BESIDE };
        let is_likely = verdict.log_scale_of_known.abs() <= within.ln()
            && verdict.log_evidence > own.log_evidence - FAR_BEHIND;
        is_likely.then_some((verdict.log_evidence, other))
    });
    let mut known: Vec<(f64, OtherRod)> = known.chain(bent).collect();
    known.sort_by(|a, b| b.0.total_cmp(&a.0));
    known.into_iter().take(MOST_OTHERS).map(|(_, other)| other).collect()
}

/// True where no load distinguishes the two.
fn is_alike(a: &Rod, b: &Rod) -> bool {
    let tubes = |rod: &Rod| [rod.pipe1.clone(), rod.bend.clone(), rod.pipe2.clone()];
    (a.l1, a.l2, a.gamma, a.bend_radius) == (b.l1, b.l2, b.gamma, b.bend_radius)
        && a.bend_flexibility == b.bend_flexibility
        && tubes(a) == tubes(b)
        && a.joints == b.joints
        && a.sleeves == b.sleeves
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rods whose numbers are twice as far off as their files make likely are compared in full, and
    /// those are not that are no likelier than what a unit would have to mend.
    #[test]
    fn rods_a_fifth_off_are_tried_in_full() {
        let read = |file: &str| Rod::read(file.as_ref()).unwrap();
        let (given, other) = (read("rods/2.toml"), read("rods/5.toml"));
        let tried = |factor: f64| {
            let verdict = |rod: &Rod| {
                let log_scale = if rod.l2 == other.l2 { factor.ln() } else { 0.0 };
                Some(Verdict { log_evidence: 0.0, log_scale, log_scale_of_known: log_scale })
            };
            let found = likely(&given, &[("5.toml".to_owned(), other.clone())], verdict);
            found.iter().any(|own| own.effect == &ROD_MISTAKE)
        };
        assert_eq!([0.7, 0.85, 1.0, 1.2, 1.4].map(tried), [false, true, true, true, false]);
    }
    /// Wherever it is within five degrees of where the slopes have it, beyond less likely ones too.
    #[test]
    fn an_angle_is_the_likeliest_of_all_nearby() {
        let given = Rod::read("rods/2.toml".as_ref()).unwrap();
        let found = |best: i32| {
            let look = |rod: &Rod| {
                let angle = rod.gamma.to_degrees().round();
                let hill = |at: f64, top: f64| top - (angle - at).powi(2);
                Some((hill(130.0, -1.0).max(hill(f64::from(best), 0.0)), angle))
            };
            let (other, likely, angle) = OtherRod::of_angle(&given, 130.0).sharpened(&given, look).unwrap();
            assert!((other.rod.gamma.to_degrees() - angle).abs() < 1e-9 && likely <= 0.0);
            angle as i32
        };
        assert_eq!([130, 132, 126, 134, 140].map(found), [130, 132, 126, 134, 130]);
        let is_none = OtherRod::of_angle(&given, 130.0).sharpened(&given, |_| None::<(f64, ())>).is_none();
        assert!(is_none);
    }
}
