//! A model is built: its data, its ideal rod or lines, and the candidates that these readings can
//! show.

use nalgebra::{DMatrix, DVector};

use super::cases::Cases;
use super::first_sight;
use super::nominal;
use super::wanted::Wanted;
use super::{Body, RigModel};
use crate::diagnosis::rig::effects::entry::{Context, Entry};
use crate::diagnosis::rig::effects::registry;
use crate::diagnosis::rig::laws::of_rod_file;
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mechanics::slide;
use crate::diagnosis::rig::mechanics::slide::Course;
use crate::diagnosis::rig::mechanics::state::State;
use crate::diagnosis::rig::mechanics::structure;
use crate::diagnosis::rig::mechanics::structure::Structure;
use crate::diagnosis::rig::nonparametric;
use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::own_effect;
use crate::diagnosis::rig::recording::datum;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::diagnosis::rig::recording::evidence;
use crate::diagnosis::rig::recording::settings::settings;
use crate::error::Result;
use crate::inference::{Candidate, Effect, Evidence, NotTestable, Parameter, UNKNOWN};
use crate::rig::readings::Readings;
use crate::rod::Rod;

/// What changes no reading by more than this share of the largest changes nothing.
const NOTHING: f64 = 1e-9;

impl RigModel {
    /// The model of `readings`: against the FEA model of `rod` as its file gives it, or against
    /// straight lines through the origin where there is none.
    ///
    /// # Errors
    /// [`crate::Error::Input`] for a station that is not on the rod; what the beam model refuses.
    pub fn new(readings: &Readings, rod: Option<&Rod>) -> Result<(RigModel, Evidence)> {
        let (model, evidence, _) = RigModel::with_effects(readings, rod, &Wanted::All)?;
        Ok((model, evidence))
    }

    /// The model with some of its candidates only; and the effects that have none.
    pub(in crate::diagnosis::rig) fn with_effects(
        readings: &Readings,
        rod: Option<&Rod>,
        wanted: &Wanted<'_>,
    ) -> Result<(RigModel, Evidence, Vec<NotTestable>)> {
        RigModel::bent_as(readings, rod, wanted, rod)
    }

    /// The same, where the rod bends as `bent` does: this one with what is known to be softer.
    /// Large deflections and what a nominal number is worth are those of that rod; where nothing is
    /// known yet, of one as stiff as the readings are at first sight.
    pub(in crate::diagnosis::rig) fn bent_as(
        readings: &Readings,
        rod: Option<&Rod>,
        wanted: &Wanted<'_>,
        bent: Option<&Rod>,
    ) -> Result<(RigModel, Evidence, Vec<NotTestable>)> {
        let data = datum::recorded(readings);
        let (body, place) = match rod {
            Some(rod) => {
                structure::check_stations(readings, rod)?;
                let tip = rod.length();
                let at = |station: Option<f64>| station.unwrap_or(tip).min(tip);
                let pair = |d: &Datum| (at(d.load_station), at(d.read_station));
                let bits = |(load, read): (f64, f64)| (load.to_bits(), read.to_bits());
                let place = numbered(data.iter().map(pair).map(bits));
                let mut pairs = Vec::new();
                for (datum, &number) in data.iter().zip(&place) {
                    if number == pairs.len() {
                        pairs.push(pair(datum));
                    }
                }
                (Body::Rod(Box::new(Structure::new(rod, pairs)?)), place)
            }
            None => {
                let line = numbered(data.iter().map(Datum::line_key));
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
            bent: Vec::new(),
            known_numbers: Vec::new(),
            cases: Cases::of(&data, &place),
            data,
            body,
            place,
            candidates: Vec::new(),
            actions: Vec::new(),
            law_adds: Vec::new(),
            unused_laws: Vec::new(),
            own: wanted.own().to_vec(),
        };
        let nuisance = match &model.body {
            Body::Rod(structure) => {
                let ideal = model.displaced(structure, &State::default());
                model.data.iter_mut().zip(&ideal).for_each(|(datum, y)| datum.predicted = *y);
                DMatrix::zeros(model.data.len(), 0)
            }
            Body::Lines(_) => evidence::slopes(&model.data, &model.place),
        };
        let stiffness = first_sight::stiffness(&model.data);
        let bent = bent.map(|bent| match rod {
            Some(rod) if bent == rod && stiffness != 1.0 => structure::with_moduli(rod, stiffness, stiffness),
            _ => bent.clone(),
        });
        let large = bent.as_ref().map(|bent| model.large_deflections(bent)).transpose()?;
        let errors = settings(&readings.rows, readings.header.driven).errors;
        let mut evidence = evidence::of_data(&model.data, &readings.header, nuisance, large, &errors);
        evidence.stated_noise = model.stated_noise();
        if let Some(rod) = rod {
            let stations = |rod: &Rod, d: &Datum| {
                let tip = rod.length();
                let at = |station: Option<f64>| station.unwrap_or(tip).min(tip);
                (at(d.load_station), at(d.read_station))
            };
            let bent = bent.as_ref().unwrap_or(rod);
            let numbers = nominal::all(&model.data, rod, bent, &readings.header, &stations)?;
            (model.bent, model.known_numbers) = (numbers.deflections, numbers.known);
            (evidence.nominal_numbers, evidence.nominal) = (numbers.parameters, numbers.columns);
            model.unused_laws = of_rod_file::take_out(&mut model, &mut evidence, rod);
        }
        let not_testable = model.add_candidates(wanted)?;
        Ok((model, evidence, not_testable))
    }

    /// What the rod's file says of each datum: beam model, large deflections and laws, m.
    ///
    /// # Errors
    /// What the beam model refuses.
    pub fn by_file(&self) -> Result<Vec<f64>> {
        let large = match &self.rod {
            Some(rod) => self.large_deflections(rod)?,
            None => DVector::zeros(self.data.len()),
        };
        let laws = self.law_adds.iter().copied().chain(std::iter::repeat(0.0));
        let parts = self.data.iter().zip(large.iter()).zip(laws);
        Ok(parts.map(|((datum, large), law)| datum.predicted + large + law).collect())
    }

    /// What large deflections of `rod` add to each datum, m.
    pub(in crate::diagnosis::rig) fn large_deflections(&self, rod: &Rod) -> Result<DVector<f64>> {
        let Body::Rod(structure) = &self.body else { return Ok(DVector::zeros(self.data.len())) };
        let second = structure.second_order(rod)?;
        let of_datum = |(d, &place): (&Datum, &usize)| {
            let more = second[place][(d.channel.index(), d.direction.axis.index())] * d.load.powi(2);
            // an imposed displacement needs so much less load
            match d.imposed {
                Some(imposed) if imposed.displacement != 0.0 => -more * d.predicted / imposed.displacement,
                _ => more,
            }
        };
        Ok(DVector::from_iterator(self.data.len(), self.data.iter().zip(&self.place).map(of_datum)))
    }

    /// Fills in the effects and their nonparametric rivals, without what can do nothing to these
    /// readings; the effects that then have no candidate.
    ///
    /// # Errors
    /// As [`own_effect::candidate::entry`].
    fn add_candidates(&mut self, wanted: &Wanted<'_>) -> Result<Vec<NotTestable>> {
        let deflections = self.deflections();
        let mut of_own = Vec::new();
        for effect in &self.own {
            of_own.push((effect.effect, own_effect::candidate::entry(effect, self)?));
        }
        let stiffness = first_sight::stiffness(&self.data);
        let at_first_sight = first_sight::ratio(&self.data);
        let mut context = Context {
            load_column: self.readings.load_column,
            data: &self.data,
            body: &mut self.body,
            rod: self.rod.as_ref(),
            stiffness,
            at_first_sight,
        };
        let has_rod = context.rod.is_some();
        let mut entries = Vec::new();
        for effect in registry::terms().filter(|effect| has_rod || !effect.needs_rod) {
            if wanted.includes(&effect.effect) {
                entries.extend((effect.candidates)(&mut context));
            }
        }
        let missing = registry::ALL.map(|effect| match has_rod || !effect.needs_rod {
            true => (effect.missing)(&context),
            false => "it needs a rod file",
        });
        let is_without = |(_, entry): &&(_, Option<Entry>)| entry.is_none();
        let without: Vec<&'static Effect> =
            of_own.iter().filter(is_without).map(|(effect, _)| *effect).collect();
        entries.extend(of_own.into_iter().filter_map(|(_, entry)| entry));
        if wanted.includes(&UNKNOWN) {
            entries.extend(nonparametric::all(&self.data, &deflections, (&self.body, &self.place)));
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
                    // where a joint is matters as soon as it gives way, when a load was hung as
                    // soon as there is creep
                    matches!(action, Action::Station(_))
                        || action.is_dependent()
                        || self.is_felt(action, parameter, nothing)
                })
                .unzip();
            let is_second = |action: &Action| matches!(action, Action::Station(_)) || action.is_dependent();
            if actions.iter().any(|action| !is_second(action)) {
                self.candidates.push(Candidate { parameters, ..candidate });
                self.actions.push(actions);
            }
        }
        let is_candidate = |effect: &Effect| self.candidates.iter().any(|known| known.effect == effect);
        let own_missing = "the readings do not have what it is a function of, at its place";
        let own_missing = without.into_iter().map(|effect| (effect, own_missing));
        let not_testable = registry::ALL
            .into_iter()
            .zip(missing)
            .map(|(effect, reason)| (&effect.effect, reason))
            .filter(|(effect, _)| !is_candidate(effect))
            .chain(own_missing)
            .map(|(effect, reason)| NotTestable { effect, reason: reason.into() })
            .collect();
        Ok(not_testable)
    }

    /// False for what changes nothing (m) to first order: a twist under loads that do not twist.
    fn is_felt(&self, action: &Action, parameter: &Parameter, nothing: f64) -> bool {
        let Parameter { neutral, size, bounds, .. } = *parameter;
        // a parameter at its bound can only go one way, and a second-order effect goes the same way
        // twice
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
