//! Readings that another rod explains better than the given one with all that may be wrong with it.
//!
//! Slopes alone distinguish rods that differ by a fifth (`mistakes/`). Where physics had to be
//! added to the given rod, or something is left, those of the other files that come near, and
//! the given one with its lengths or pipes exchanged, are compared in full: each with all effects,
//! by the probability that the recording then has.

use crate::diagnosis::rig::effects::load::LOAD_MISALIGNMENT;
use crate::diagnosis::rig::effects::sensor::SENSOR_MISALIGNMENT;
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mistakes::{Mended, ODDS, OtherRod, RARE};
use crate::diagnosis::rig::model::RigModel;
use crate::diagnosis::rig::model::wanted::Wanted;
use crate::inference::{
    Compared, Diagnosis, Evidence, Finding, ForwardModel, Kind, Location, Part, Rival, rms,
};
use crate::rod::Rod;
use crate::spatial::Axis;
use crate::units::DEG;

/// Ln of the odds within which two rods are indistinguishable: 20.
const ALIKE: f64 = 2.995_732;

/// What another rod leaves at most, as a share of what it explains: before any effect is added, and
/// unexplained beside all of them.
const CURED: f64 = 0.5;
const LITTLE: f64 = 0.1;

/// One of the other rods beside the given one.
pub struct Other {
    /// What it is.
    pub rod: OtherRod,
    /// Ln of the odds for it.
    pub log_odds: f64,
    /// How far what it says of the readings is from what the given one says, m (rms).
    pub explains: f64,
    /// What the readings do not distinguish from it.
    pub rivals: Vec<Rival>,
}

impl Other {
    /// True where that is the rod, beyond doubt.
    pub fn is_meant(&self) -> bool {
        self.log_odds > ODDS
    }
}

/// Does another rod, whose diagnosis this is and which explains `explains` (m, rms), cure a
/// recording: is what it leaves half of that at most before anything else is added, and little
/// where nothing explains it? Slopes are odds between rods, whatever else is wrong with both.
pub fn is_cured(explains: f64, diagnosis: &Diagnosis) -> bool {
    let left = diagnosis.discrepancy.as_ref().map_or(0.0, |left| left.rms);
    rms(&diagnosis.before) < CURED * explains && left < LITTLE * explains
}

/// The other rods that the readings may be of, the likeliest first; none where they agree with the
/// given one.
pub fn others(mended: &Mended, model: &RigModel, evidence: &Evidence, diagnosis: &Diagnosis) -> Vec<Other> {
    let mut found = Vec::new();
    let may_be_another = |finding: &Finding| is_of_the_rod(model, finding) || is_a_turn(model, finding);
    if diagnosis.discrepancy.is_none() && !diagnosis.findings.iter().any(may_be_another) {
        return found;
    }
    let Some(given) = mended.rod.as_ref().filter(|_| !mended.others.is_empty()) else { return found };
    let compared = Compared::new(model, evidence, diagnosis);
    let looked = |rod: &Rod| {
        let wanted = Wanted::AllAnd(&model.own);
        let (other, of_other, _) = RigModel::with_effects(&mended.readings, Some(rod), &wanted).ok()?;
        let is_alike = of_other.residual.len() == evidence.residual.len();
        is_alike.then(|| (compared.log_odds(&other, &of_other), of_other.residual))
    };
    for meant in mended.others.iter().cloned() {
        let looked = match meant.is_angled() {
            true => meant.sharpened(given, looked),
            false => looked(&meant.rod).map(|(log_odds, residual)| (meant, log_odds, residual)),
        };
        let Some((meant, log_odds, residual)) = looked else { continue };
        let log_odds = log_odds + meant.log_prior + RARE;
        let explains = rms(&(&evidence.residual - &residual));
        let mut rivals = Vec::new();
        if meant.is_angled() {
            let by = meant.rod.gamma - given.gamma;
            let turned = turned_in_mount(model, evidence, &compared, by);
            let lead = turned.map_or(f64::INFINITY, |turned| log_odds - turned - meant.log_prior - RARE);
            // what is likelier turned is named for that
            if lead < -ALIKE {
                continue;
            }
            rivals.extend((lead < ALIKE).then(|| turned_frames(lead.exp().max(1.0))).into_iter().flatten());
        }
        found.push(Other { rod: meant, log_odds, explains, rivals });
    }
    found.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    found
}

/// Where two rods are indistinguishable, what makes the given one fit has the other as its rival.
pub fn add_rivals(others: &[Other], model: &RigModel, diagnosis: &mut Diagnosis) {
    for finding in &mut diagnosis.findings {
        let (is_of_the_rod, is_a_turn) = (is_of_the_rod(model, finding), is_a_turn(model, finding));
        let explains = |other: &&Other| is_of_the_rod || (is_a_turn && other.rod.is_angled());
        for other in others.iter().filter(explains).filter(|other| other.log_odds > -ALIKE) {
            let location = Location::from(other.rod.location.clone());
            let odds = (-other.log_odds).exp().max(1.0);
            // a file is sooner looked at than anything is measured
            finding.rivals.insert(0, Rival::without_term(other.rod.effect, location, odds));
            // what is as likely as that rod is as likely as what is named
            let known = |rival: &Rival| finding.rivals.iter().any(|own| own.effect == rival.effect);
            let new: Vec<_> = other.rivals.iter().filter(|rival| !known(rival)).cloned().collect();
            finding.rivals.extend(new.into_iter().filter(|rival| rival.effect != finding.effect));
        }
    }
}

/// A rod that is turned about y in its mount: to it loads and sensors are turned together, which
/// the library has as two effects and prices as two.
fn turned_frames(odds: f64) -> [Rival; 2] {
    [(&LOAD_MISALIGNMENT, Part::LoadFrame), (&SENSOR_MISALIGNMENT, Part::Sensors)]
        .map(|(own, part)| Rival::without_term(&own.effect, Location::Part(part), odds))
}

/// Ln of the odds for such a rod, turned by about as much either way as its angle would have to be
/// another one (rad), before what is known of either; `None` where nothing was turned to it.
fn turned_in_mount(model: &RigModel, evidence: &Evidence, compared: &Compared, by: f64) -> Option<f64> {
    const BESIDE_DEG: i32 = 4;
    let frame = |is_it: &dyn Fn(&Action) -> bool| {
        let index =
            model.actions.iter().position(|actions| actions.len() > 1 && actions.iter().any(is_it))?;
        Some((index, model.actions[index].iter().position(is_it)?))
    };
    let frames = [
        frame(&|action| matches!(action, Action::TurnLoad(_, Axis::Z, Axis::X)))?,
        frame(&|action| matches!(action, Action::TurnSensors(Axis::Z, Axis::X)))?,
    ];
    let left = |angle: f64| {
        let terms = frames.map(|(index, number)| {
            let mut term = model.candidates[index].neutral(index);
            term.values[number] = angle;
            term
        });
        &evidence.residual - model.response(&terms)
    };
    let steps = (-BESIDE_DEG..=BESIDE_DEG).map(|step| by.abs() + f64::from(step) * DEG);
    let either_way = steps.flat_map(|angle| [angle, -angle]).map(left);
    let residual = either_way.min_by(|a, b| a.norm().total_cmp(&b.norm()))?;
    Some(compared.log_odds(model, &Evidence { residual, ..evidence.clone() }))
}

/// Loads and sensors that are turned: so is the plane of a rod with another angle.
fn is_a_turn(model: &RigModel, finding: &Finding) -> bool {
    let turns = |candidate: usize| model.actions[candidate].iter().any(|action| action.turns());
    finding.parts.iter().any(|part| turns(part.term.candidate))
}

fn is_of_the_rod(model: &RigModel, finding: &Finding) -> bool {
    let changes = |candidate: usize| model.actions[candidate].iter().any(|action| action.changes_the_rod());
    finding.kind() == Kind::Physics && finding.parts.iter().any(|part| changes(part.term.candidate))
}

#[cfg(test)]
mod tests {
    use crate::diagnosis::rig::{RigModel, diagnose};
    use crate::inference::{ForwardModel, Kind, Term};
    use crate::rig::readings::Readings;
    use crate::rod::Rod;
    use crate::statistics::Random;
    use crate::units::UM;

    const ROD: &str = "name = \"angled\"
[geometry]
l1_mm = 209.6
l2_mm = 152.7
gamma_deg = 136.8
[material.carbon]
youngs_modulus_gpa = 117.6
shear_modulus_gpa = 29.53
density_kg_m3 = 1600
[material.steel]
youngs_modulus_gpa = 195.9
shear_modulus_gpa = 75.93
density_kg_m3 = 7930
[pipe1]
material = \"carbon\"
outer_diameter_mm = 23.2
inner_diameter_mm = 18.6
[pipe2]
material = \"steel\"
outer_diameter_mm = 17.9
inner_diameter_mm = 14.3
[[joint]]
name = \"joint-a\"
station_mm = 268.1
bending_urad_per_nm = 0.0
torsion_urad_per_nm = 0.0
";

    /// Zeros that were taken once are off by some scatters, with whatever rod the readings are
    /// compared: a soft joint and loads that are turned are no exchanged lengths.
    #[test]
    fn zeros_speak_for_no_rod() {
        let rod = Rod::from_toml("rod", ROD).unwrap();
        let mut text = "axis,load_n,phase,trial,dy_um,dz_um\n".to_owned();
        for (trial, axis) in (1..=3).flat_map(|trial| ["y", "z"].map(|axis| (trial, axis))) {
            let up = [2, 4, 6, 8, 10, 12, 14, 16, 18];
            up.iter().for_each(|load| text += &format!("{axis},{load},load,{trial},0,0\n"));
            up[..8].iter().rev().for_each(|load| text += &format!("{axis},{load},unload,{trial},0,0\n"));
        }
        let mut readings = Readings::from_text("f", &text).unwrap();
        let (model, _) = RigModel::new(&readings, Some(&rod)).unwrap();
        let term = |effect: &str, place: &str, values: &[f64]| {
            let is_it =
                |c: &crate::inference::Candidate| c.effect.name == effect && c.location.to_string() == place;
            let candidate = model.candidates().iter().position(is_it).unwrap();
            Term { candidate, values: values.to_vec() }
        };
        let change = model.response(&[
            term("joint_compliance", "joint-a", &[444e-6, 1294e-6]),
            term("load_misalignment", "load frame", &[0.006, 0.0025, -0.112]),
        ]);
        let mut random = Random::seeded(1, 0);
        for (datum, change) in model.data().iter().zip(change.iter()) {
            let zero = if datum.channel == crate::spatial::Axis::Z { 4.0 * UM } else { 0.0 };
            let shown = datum.predicted + change + zero + UM * random.normal();
            readings.rows[datum.row - 1].offset[datum.channel.index()] = Some(shown);
        }
        let found = diagnose(&readings, Some(&rod)).unwrap();
        let names: Vec<&str> = found.diagnosis.findings.iter().map(|f| f.effect.name).collect();
        let is_mistake = found.diagnosis.findings.iter().any(|f| f.kind() == Kind::Mistake);
        assert!(!names.is_empty() && !is_mistake, "{names:?}");
    }
}
