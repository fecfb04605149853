//! The physics of a stiffness rig: what could have made its readings differ from the rod's model.
//!
//! Three stages act one after another, so that effects combine as they would on the bench (friction on a rod whose modulus
//! is off too): a nominal load becomes a force, a force becomes a displacement, a displacement becomes a reading. Formulae:
//! `action.rs` (stages), `slide.rs` (friction and play along a course), `structure.rs` (compliance), `load_history.rs` (creep,
//! hysteresis). What was recorded when, in which session and run, and which way the load went: `chronicle.rs`. Which effects there are and how
//! large they usually are: `effects/`. The rivals that stand for physics nobody has named: `nonparametric.rs`.
//!
//! Without a rod (`linear`) each line of readings has a slope c that nobody knows. The evidence leaves it to the engine as
//! a nuisance, and an effect that scales with the displacement takes the slope that fits best with that effect in place
//! (G. H. Golub, V. Pereyra, *SIAM J. Numer. Anal.* 10 (1973) 413–432: separable least squares),
//!
//! ```text
//! change = c·(h − F) + shifts,   c = Σ h·(y − shifts)/Σ h²        h the load that is felt, F the nominal one
//! ```
//!
//! which is exact once the engine has fitted its own multiple of F.
//!
//! Where the displacement is imposed and the load is measured (`driven = "displacement"`), the loads are what is compared: the
//! same chain, solved for the load, of which each newton counts as c₀ = max|u|/max|F| metres, so that loads and the readings
//! of other sensors stand in one unit.

mod action;
mod as_measured;
mod cases;
mod chronicle;
mod correction;
mod datum;
pub mod effects;
mod evidence;
mod feasible;
mod forward_model;
mod limits;
mod load_history;
mod mistakes;
mod next;
mod nominal;
mod nonparametric;
mod response;
mod slide;
mod structure;
#[cfg(test)]
mod tests;
mod transfer;

use nalgebra::{DMatrix, DVector};

use self::action::{Action, State};
use self::cases::Cases;
use self::effects::{Context, registry, zeros::ZERO_NOT_TAKEN};
use self::slide::Course;
use self::structure::Structure;
use crate::error::{Error, Place, Result};
use crate::inference::{
    Candidate, Diagnosed, Effect, Evidence, NotTestable, Parameter, UNKNOWN, diagnose as infer, rms,
};
use crate::rig::readings::Readings;
use crate::rod::Rod;
pub use correction::Correction;
pub use datum::Datum;
pub use mistakes::suspected;

/// Most rows of readings that are diagnosed.
const MOST_ROWS: usize = 100_000;
/// What changes no reading by more than this share of the largest changes nothing.
const NOTHING: f64 = 1e-9;
/// The parameter of a joint that may be anywhere.
const STATION: &str = "station_mm";

/// A rig's diagnosis.
pub type RigDiagnosis = Diagnosed<RigModel>;

/// Diagnoses `readings` against the FEA model of `rod` as its file gives it, or, without a rod,
/// against straight lines through the origin.
///
/// # Errors
/// See [`RigModel::new`].
pub fn diagnose(readings: &Readings, rod: Option<&Rod>) -> Result<RigDiagnosis> {
    diagnose_among(readings, rod, &[])
}

/// Diagnoses `readings` as [`diagnose`] does, where they may also be those of one of `others`: rods
/// with the names of their files, such as all that stand beside the given one.
///
/// Mistakes are looked for first. They stand before all other findings, which are those of the corrected readings and the
/// corrected rod.
///
/// # Errors
/// [`Error::Input`] for more than 100 000 rows; see also [`RigModel::new`].
pub fn diagnose_among(
    readings: &Readings,
    rod: Option<&Rod>,
    others: &[(String, Rod)],
) -> Result<RigDiagnosis> {
    check_size(readings)?;
    let mended = mistakes::mended(readings, rod, others)?;
    let (mended_readings, mended_rod) = match mended.has_data {
        true => (&mended.readings, mended.rod.as_ref()),
        false => (readings, rod),
    };
    let (mut model, evidence, not_testable) =
        RigModel::with_effects(mended_readings, mended_rod, &Wanted::All)?;
    let mut diagnosis = infer(&model, &evidence);
    as_measured::resize(&model, &evidence, &mut diagnosis);
    if mended.has_data {
        for k in 0..diagnosis.findings.len() {
            let next = next::next_measurement(&model, &evidence, &diagnosis, &diagnosis.findings[k])?;
            let finding = &mut diagnosis.findings[k];
            finding.next = next;
            let units = mistakes::lookalikes(&model, finding);
            if !units.is_empty() {
                // a unit is looked up, which is sooner done than any measurement
                finding.next = finding.direct_check(&units.iter().collect::<Vec<_>>());
                finding.rivals.splice(0..0, units);
            }
        }
    } else {
        // nothing is left that physics could be seen in
        diagnosis.findings.clear();
        diagnosis.discrepancy = None;
    }
    if !mended.found.is_empty() {
        diagnosis.findings.splice(0..0, mended.found);
        model.as_recorded = Some(Box::new(AsRecorded::new(readings, rod)));
    }
    let limits = limits::limits(&model, &evidence);
    Ok(Diagnosed { absorbed: Vec::new(), not_testable, limits, diagnosis, evidence, model })
}

/// Refuses what would take more memory or time than anybody has.
fn check_size(readings: &Readings) -> Result<()> {
    match readings.rows.get(MOST_ROWS) {
        None => Ok(()),
        Some(row) => Err(Error::Input {
            at: Place { file: readings.file.clone(), line: row.line, column: 0 },
            found: format!("{} rows of readings", readings.rows.len()),
            expected: format!("at most {MOST_ROWS} for a diagnosis"),
            hint: Some("diagnose some of the trials at a time".into()),
        }),
    }
}

/// Readings of a rig with all the physics that might be in them.
#[derive(Debug, Clone)]
pub struct RigModel {
    readings: Readings,
    rod: Option<Rod>,
    as_recorded: Option<Box<AsRecorded>>,
    data: Vec<Datum>,
    body: Body,
    /// For each datum the pair of stations (with a rod) or the line (without).
    place: Vec<usize>,
    /// Which data follow which, and the usual step of an imposed displacement (m).
    course: Course,
    step: f64,
    cases: Cases,
    candidates: Vec<Candidate>,
    /// For each candidate what its parameters do.
    actions: Vec<Vec<Action>>,
}

/// Which candidates a model shall have.
enum Wanted<'a> {
    All,
    /// Those that are the same things at the same places as these.
    Like(&'a [&'a Candidate]),
}

impl Wanted<'_> {
    /// False where no candidate of an effect is wanted.
    fn includes(&self, effect: &Effect) -> bool {
        match self {
            Wanted::All => true,
            Wanted::Like(these) => these.iter().any(|candidate| candidate.effect == effect),
        }
    }

    fn has(&self, candidate: &Candidate) -> bool {
        match self {
            Wanted::All => true,
            Wanted::Like(these) => these.iter().any(|known| transfer::is_same(candidate, known)),
        }
    }
}

/// Readings and rod before mistakes were undone, where there were any.
#[derive(Debug, Clone)]
struct AsRecorded {
    readings: Readings,
    rod: Option<Rod>,
    /// Root mean square of what the rod's model leaves, m; `None` where the two cannot be compared.
    error: Option<f64>,
}

impl AsRecorded {
    fn new(readings: &Readings, rod: Option<&Rod>) -> Self {
        let error = RigModel::with_effects(readings, rod, &Wanted::Like(&[]));
        let error = error.ok().map(|(_, evidence, _)| rms(&evidence.residual));
        AsRecorded { readings: readings.clone(), rod: rod.cloned(), error }
    }
}

/// True for a parameter that does nothing where the first of its effect does nothing.
fn is_dependent(action: &Action) -> bool {
    matches!(action, Action::Onset(_) | Action::Presliding | Action::SliderPlay)
}

/// What turns a force into a displacement.
#[derive(Debug, Clone)]
enum Body {
    Rod(Box<Structure>),
    /// So many lines of unknown slopes.
    Lines(usize),
}

impl RigModel {
    /// The model of `readings`: against the FEA model of `rod` as its file gives it, or against straight lines through the
    /// origin where there is none.
    ///
    /// # Errors
    /// [`crate::Error::Input`] for a station that is not on the rod; what the beam model refuses.
    pub fn new(readings: &Readings, rod: Option<&Rod>) -> Result<(RigModel, Evidence)> {
        let (model, evidence, _) = RigModel::with_effects(readings, rod, &Wanted::All)?;
        Ok((model, evidence))
    }

    /// The model with some of its candidates only; and the effects that have none.
    fn with_effects(
        readings: &Readings,
        rod: Option<&Rod>,
        wanted: &Wanted<'_>,
    ) -> Result<(RigModel, Evidence, Vec<NotTestable>)> {
        let data = datum::recorded(readings);
        let (body, place) = match rod {
            Some(rod) => {
                structure::check_stations(readings, rod)?;
                let tip = rod.length();
                let at = |station: Option<f64>| station.unwrap_or(tip).min(tip);
                let pair = |d: &Datum| (at(d.load_station), at(d.read_station));
                let bits = |(load, read): (f64, f64)| (load.to_bits(), read.to_bits());
                let place = datum::numbered(data.iter().map(pair).map(bits));
                let mut pairs = Vec::new();
                for (datum, &number) in data.iter().zip(&place) {
                    if number == pairs.len() {
                        pairs.push(pair(datum));
                    }
                }
                (Body::Rod(Box::new(Structure::new(rod, pairs)?)), place)
            }
            None => {
                let line = datum::numbered(data.iter().map(Datum::line_key));
                (Body::Lines(line.iter().max().map_or(0, |last| last + 1)), line)
            }
        };
        let course = Course::of(&data);
        let mut model = RigModel {
            step: slide::usual_step(&data, &course),
            course,
            readings: readings.clone(),
            rod: rod.cloned(),
            as_recorded: None,
            cases: Cases::of(&data, &place),
            data,
            body,
            place,
            candidates: Vec::new(),
            actions: Vec::new(),
        };
        let nuisance = match &model.body {
            Body::Rod(structure) => {
                let ideal = model.displaced(structure, &State::default());
                model.data.iter_mut().zip(&ideal).for_each(|(datum, y)| datum.predicted = *y);
                DMatrix::zeros(model.data.len(), 0)
            }
            Body::Lines(_) => evidence::slopes(&model.data, &model.place),
        };
        let large = match &model.body {
            Body::Rod(structure) => {
                let second = structure.second_order()?;
                let of = |(d, &place): (&Datum, &usize)| {
                    let more = second[place][(d.channel.index(), d.direction.axis.index())] * d.load.powi(2);
                    // an imposed displacement needs so much less load
                    match d.imposed {
                        Some(imposed) if imposed.displacement != 0.0 => {
                            -more * d.predicted / imposed.displacement
                        }
                        _ => more,
                    }
                };
                Some(DVector::from_iterator(model.data.len(), model.data.iter().zip(&model.place).map(of)))
            }
            Body::Lines(_) => None,
        };
        let mut evidence = evidence::of(&model.data, nuisance, large);
        evidence.stated_noise = model.stated_noise();
        if let Some(rod) = rod {
            let stations = |rod: &Rod, d: &Datum| {
                let tip = rod.length();
                let at = |station: Option<f64>| station.unwrap_or(tip).min(tip);
                (at(d.load_station), at(d.read_station))
            };
            let (numbers, columns) = nominal::all(&model.data, rod, &readings.header, &stations)?;
            (evidence.nominal_numbers, evidence.nominal) = (numbers, columns);
        }
        let not_testable = model.add_candidates(wanted);
        Ok((model, evidence, not_testable))
    }

    /// Name of a session, by its number in [`Evidence::session`].
    pub fn session(&self, number: usize) -> &str {
        let of_session = self.data.iter().find(|datum| datum.session_number == number);
        of_session.and_then(|datum| datum.session.as_deref()).unwrap_or("without a name")
    }

    /// The data in the order of recording, which is that of the evidence.
    pub fn data(&self) -> &[Datum] {
        &self.data
    }

    /// The readings, without the mistakes that were found.
    pub fn readings(&self) -> &Readings {
        &self.readings
    }

    /// The rod, where there is one, without the mistakes that were found.
    pub fn rod(&self) -> Option<&Rod> {
        self.rod.as_ref()
    }

    /// The readings as they were given, mistakes included.
    pub fn recorded(&self) -> &Readings {
        self.as_recorded.as_ref().map_or(&self.readings, |given| &given.readings)
    }

    /// The rod as its file gives it, mistakes included.
    pub fn rod_of_file(&self) -> Option<&Rod> {
        self.as_recorded.as_ref().map_or(self.rod.as_ref(), |given| given.rod.as_ref())
    }

    /// Root mean square of what the model of the file leaves of the readings as they were given, m;
    /// `None` where no mistake was found, or where the two cannot be compared.
    pub fn recorded_error(&self) -> Option<f64> {
        self.as_recorded.as_ref()?.error
    }

    /// What a newton of a measured load counts, m/N; `None` where loads were set.
    pub fn per_newton(&self) -> Option<f64> {
        self.data.iter().find_map(|datum| datum.imposed).map(|imposed| imposed.per_newton)
    }

    /// Stated noise of a datum, m: where the load was measured, that of load and displacement together.
    fn stated_noise(&self) -> Option<f64> {
        let header = &self.readings.header;
        let of_load = self.per_newton().zip(header.load_noise).map(|(per_newton, noise)| per_newton * noise);
        match (header.noise, of_load) {
            (Some(a), Some(b)) => Some(a.hypot(b)),
            (a, b) => a.or(b),
        }
    }

    /// Fills in the effects and their nonparametric rivals, without what can do nothing to these
    /// readings; the effects that then have no candidate.
    fn add_candidates(&mut self, wanted: &Wanted<'_>) -> Vec<NotTestable> {
        let deflections = self.deflections();
        let mut context = Context { data: &self.data, body: &mut self.body, rod: self.rod.as_ref() };
        let has_rod = context.rod.is_some();
        let mut entries = Vec::new();
        let all = registry::ALL.into_iter().chain([&ZERO_NOT_TAKEN]);
        for effect in all.filter(|effect| has_rod || !effect.needs_rod) {
            if wanted.includes(&effect.effect) {
                entries.extend((effect.candidates)(&mut context));
            }
        }
        let missing = registry::ALL.map(|effect| match has_rod || !effect.needs_rod {
            true => (effect.missing)(&context),
            false => "it needs a rod file",
        });
        if wanted.includes(&UNKNOWN) {
            entries.extend(nonparametric::all(&self.data, &deflections, has_rod));
            nonparametric::retain_predictive(&mut entries, &self.data, &deflections);
        }
        entries.retain(|(candidate, _)| wanted.has(candidate));
        let scale = self.data.iter().fold(0.0, |s: f64, d| s.max(d.measured.abs()).max(d.predicted.abs()));
        let nothing = NOTHING * scale;
        for (candidate, actions) in entries {
            let (parameters, actions): (Vec<_>, Vec<_>) = candidate
                .parameters
                .into_iter()
                .zip(actions)
                .filter(|(parameter, action)| {
                    // where a joint is matters as soon as it gives way, when a load was hung as soon as there is creep
                    matches!(action, Action::Station(_))
                        || is_dependent(action)
                        || self.is_felt(action, parameter, nothing)
                })
                .unzip();
            let is_second = |action: &Action| matches!(action, Action::Station(_)) || is_dependent(action);
            if actions.iter().any(|action| !is_second(action)) {
                self.candidates.push(Candidate { parameters, ..candidate });
                self.actions.push(actions);
            }
        }
        let is_candidate = |effect: &Effect| self.candidates.iter().any(|known| known.effect == effect);
        registry::ALL
            .into_iter()
            .zip(missing)
            .map(|(effect, reason)| (&effect.effect, reason))
            .filter(|(effect, _)| !is_candidate(effect))
            .map(|(effect, reason)| NotTestable { effect, reason: reason.into() })
            .collect()
    }

    /// False for what changes nothing (m) to first order: a twist under loads that do not twist.
    fn is_felt(&self, action: &Action, parameter: &Parameter, nothing: f64) -> bool {
        let Parameter { neutral, size, bounds, .. } = *parameter;
        // a parameter at its bound can only go one way, and a second-order effect goes the same way twice
        let step = if neutral + size <= bounds.1 { size } else { bounds.1 - neutral };
        if let Some(largest) = action.largest_addition() {
            return 2.0 * step * largest > nothing;
        }
        let at = |value: f64| {
            let mut state = State::default();
            state.act(action, value);
            self.changed(&state)
        };
        (at(neutral + step) - at(neutral - step)).amax() > nothing
    }
}
