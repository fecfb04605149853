//! A choice of poses with all that is said of it.

use nalgebra::DMatrix;

use super::candidates::{Candidates, Source};
use super::criterion::PoseCriterion;
use super::limits::{PoseLimits, Surroundings};
use super::order;
use super::random::{Beside, beside};
use super::seen::seen;
use crate::calibration::campaign::{Campaign, Group, GroupName};
use crate::calibration::{
    Compensation, Mode, Observability, Planned, default_mode, free_parameters, places, planned_setup,
};
use crate::design::forecast::{Budget, Forecast, Forecaster, Where};
use crate::error::{Error, Result};
use crate::optimal_design::{Measurements, choose, value};
use crate::robot::{Parameter, Setup};

/// What is known before the first pose where a criterion knows nothing: a share of what all
/// candidates say, for poses to be chosen one after another; and what is left of it in the value,
/// which is that of the poses alone.
const FAINT: f64 = 1e-13;
const OF_FAINT: f64 = 0.01;

/// What is asked for.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Wanted {
    /// So many poses in all, spread evenly over the places.
    pub count: usize,
    /// What they shall be good for.
    pub criterion: PoseCriterion,
    /// What there is to choose from.
    pub source: Source,
    /// What every pose has to keep.
    pub limits: PoseLimits,
    /// How the rod will be compensated; the campaign's default where nothing is said.
    pub mode: Option<Mode>,
    /// Where the robot will be used.
    pub at: Where,
    /// Every random number comes from it.
    pub seed: u64,
}

impl Wanted {
    /// So many poses of a source by a criterion, within the usual limits, in the campaign's own
    /// mode, for its validation poses, seed 1.
    pub fn new(count: usize, criterion: PoseCriterion, source: Source) -> Wanted {
        let limits = PoseLimits::default();
        Wanted { count, criterion, source, limits, mode: None, at: Where::Validation, seed: 1 }
    }

    /// Within these limits.
    pub fn with_limits(self, limits: PoseLimits) -> Wanted {
        Wanted { limits, ..self }
    }

    /// With the rod compensated so; `None` is the campaign's own mode.
    pub fn with_mode(self, mode: Option<Mode>) -> Wanted {
        Wanted { mode, ..self }
    }

    /// For a robot that is used there.
    pub fn used_at(self, at: Where) -> Wanted {
        Wanted { at, ..self }
    }

    /// With every random number from this seed.
    pub fn with_seed(self, seed: u64) -> Wanted {
        Wanted { seed, ..self }
    }
}

/// How well one parameter will be known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// The parameter of robot, base or tool.
    pub parameter: Parameter,
    /// Standard uncertainty before it, SI.
    pub before: f64,
    /// Standard uncertainty after the calibration with the chosen poses, SI.
    pub after: f64,
}

/// Chosen poses and what they are worth.
#[non_exhaustive]
pub struct PoseStudy<'c> {
    /// The campaign.
    pub campaign: &'c Campaign,
    /// What was asked for.
    pub wanted: Wanted,
    /// The robot where it stands.
    pub setup: Setup<'c>,
    /// Where the ball is held.
    pub places: Vec<Group>,
    /// What there was to choose from.
    pub candidates: Candidates,
    /// Index of the place and joint values (rad or m), place after place, in the order in which
    /// they are best measured.
    pub chosen: Vec<(usize, Vec<f64>)>,
    /// Value of the criterion.
    pub value: f64,
    /// Median value of as many random poses of the same candidates.
    pub value_random: f64,
    /// So many times as many random poses are worth as much; `None` beyond 20.
    pub worth: Option<f64>,
    /// Combinations of the parameters that no pose shows at these places, and that O1 and O4 leave
    /// out.
    pub unseen_combinations: usize,
    /// Observability of the chosen poses.
    pub observability: Observability,
    /// Parameters by what will be known of them.
    pub known: Vec<Known>,
    /// What is to be expected of the calibration.
    pub forecast: Forecast,
    /// And of one with as many random poses.
    pub forecast_random: Forecast,
    /// What the forecast assumes.
    pub budget: Budget,
    /// Where the robot will be used, in words.
    pub unseen: String,
    /// Whether base and tool are aligned anew there.
    pub is_aligned: bool,
}

impl<'c> PoseStudy<'c> {
    /// Chooses poses for a campaign. `progress` is called for every candidate that is looked at,
    /// and then for every pose that is taken or held against the others.
    ///
    /// ```
    /// use rodcal::design::{Budget, PoseCriterion, PoseStudy, Source, Wanted};
    /// use rodcal::prelude::*;
    ///
    /// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
    /// let budget = Budget::of(&campaign, Some(17.6e-6), Some(30e-6), 0.0)?;
    /// let wanted = Wanted::new(20, PoseCriterion::O1, Source::Generated(100));
    /// let study = PoseStudy::new(&campaign, wanted, budget, &|_| {})?;
    /// assert_eq!((study.chosen.len(), study.places.len()), (20, 5));
    /// assert!(study.value > 1.05 * study.value_random); // O1 of these poses and of random ones
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] for fewer poses than a calibration needs; [`Error::NotApplicable`] for
    /// places that no pose reaches, or that have fewer candidates than poses; what candidates and
    /// forecast are refused for.
    pub fn new(
        campaign: &'c Campaign,
        wanted: Wanted,
        budget: Budget,
        progress: &(dyn Fn(PoseStep) + Sync),
    ) -> Result<Self> {
        let setup = planned_setup(campaign)?;
        let mode = wanted.mode.unwrap_or_else(|| default_mode(campaign));
        let compensation = Compensation::new(campaign, mode)?;
        let free = free_parameters(campaign, &setup, &compensation);
        let (places, are_unknown) = places(campaign, &setup);
        if places.is_empty() {
            return Err(Error::NotApplicable {
                what: format!("choosing poses for {}", campaign.file),
                why: "where its sockets are is known from a recording alone, and there is none".into(),
                hint: "record some poses, or state clamps".into(),
            });
        }
        if are_unknown && wanted.criterion == PoseCriterion::O4 {
            return Err(Error::NotApplicable {
                what: "criterion o4 with sockets".into(),
                why: "what poses say of sockets whose places are unknown does not add up pose by pose".into(),
                hint: "choose by o1, d, a or forecast".into(),
            });
        }
        let needed = (free.len() + if are_unknown { 3 * places.len() } else { 0 }) / 3 + 1;
        if wanted.count < needed {
            return Err(Error::Argument {
                name: "--count",
                found: wanted.count.to_string(),
                expected: format!("at least {needed} poses, for {} unknown numbers", free.len()),
            });
        }
        let around = Surroundings::new(campaign, &setup, &places, wanted.limits);
        let candidates =
            Candidates::new(&around, &wanted.source, wanted.seed, &|_| progress(PoseStep::Candidate))?;
        let quotas = quotas(wanted.count, &places, &candidates)?;
        let forecaster = Forecaster::new(campaign, setup.clone(), budget, &wanted.at)?;

        let all = Planned::new(setup.clone(), &free, &compensation, &places, are_unknown, &candidates.poses);
        let known = forecaster.known_before();
        let (measurements, before) = scaled(&all, &free, &known, &wanted, forecaster.budget.noise);
        let columns = measurements.columns();
        let unseen_combinations = all.rows().first().map_or(0, |block| block.ncols()) - columns;
        let criterion =
            wanted.criterion.of_design(columns, &forecaster.weight(columns + unseen_combinations));
        let numerical = || Error::Numerical {
            what: "the choice of poses",
            why: "the information of the poses is not positive definite".into(),
        };
        let mut chosen = choose(&measurements, &quotas, &before, &criterion, &|| progress(PoseStep::Choice))
            .ok_or_else(numerical)?;
        let before = if wanted.criterion.is_index() { before * OF_FAINT } else { before };
        let own = value(&measurements, &chosen, &before, &criterion).ok_or_else(numerical)?;
        let Beside { median, worth } = beside(&measurements, &quotas, &before, &criterion, own);
        // ln |M| of the places alone: as many rows of one as there are poses
        let constant = match are_unknown {
            true => quotas.iter().map(|&quota| 3.0 * (quota.max(1) as f64).ln()).sum(),
            false => 0.0,
        };
        let shown = |value: f64| {
            let m = if wanted.criterion.is_index() { free.len() - unseen_combinations } else { columns };
            let constant = if wanted.criterion.is_index() { constant } else { 0.0 };
            wanted.criterion.shown(value, m, wanted.count, constant)
        };
        chosen.sort_by_key(|&index| measurements.group(index));
        let poses_of = |chosen: &[usize]| -> Vec<(usize, Vec<f64>)> {
            chosen.iter().map(|&index| candidates.poses[index].clone()).collect()
        };
        let ordered = in_order(poses_of(&chosen), places.len());
        let random = poses_of(&crate::optimal_design::anything(&measurements, &quotas, 1_000));
        let planned = Planned::new(setup.clone(), &free, &compensation, &places, are_unknown, &ordered);
        let (by_noise, faint) = in_noise(&planned, &known, 1.0, forecaster.budget.noise);
        let everything: Vec<usize> = (0..by_noise.len()).collect();
        let (covariance, _) =
            crate::linalg::positive_definite_inverse(&by_noise.information(&everything, &faint))
                .ok_or_else(numerical)?;
        let of_parameter = |(k, &parameter): (usize, &Parameter)| Known {
            parameter,
            before: known[k],
            after: known[k] * covariance[(k, k)].max(0.0).sqrt(),
        };
        Ok(PoseStudy {
            value: shown(own),
            value_random: shown(median),
            worth,
            unseen_combinations,
            observability: planned.observability()?,
            known: free.iter().enumerate().map(of_parameter).collect(),
            forecast: forecaster.forecast(&ordered, mode)?,
            forecast_random: forecaster.forecast(&random, mode)?,
            budget: forecaster.budget.clone(),
            unseen: forecaster.unseen.description.clone(),
            is_aligned: forecaster.unseen.is_aligned,
            chosen: ordered,
            campaign,
            wanted,
            setup: setup.clone(),
            places: places.clone(),
            candidates,
        })
    }
}

/// A step on the way to a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PoseStep {
    /// A candidate was looked at.
    Candidate,
    /// A pose was taken, or held against all others of its place.
    Choice,
}

/// How many poses each place gets: as equally many as can be, the first ones one more.
fn quotas(count: usize, places: &[Group], candidates: &Candidates) -> Result<Vec<usize>> {
    let (share, more) = (count / places.len(), count % places.len());
    let quotas: Vec<usize> = (0..places.len()).map(|place| share + usize::from(place < more)).collect();
    let lacks = quotas.iter().enumerate().filter_map(|(place, &quota)| {
        let there = candidates.poses.iter().filter(|(own, _)| *own == place).count();
        let name = match &places[place].name {
            GroupName::Tracked => "the robot".to_owned(),
            name => name.to_string(),
        };
        (there < quota).then(|| format!("{name} has {there} candidates for {quota} poses"))
    });
    let lacks: Vec<String> = lacks.collect();
    match lacks.is_empty() {
        true => Ok(quotas),
        false => Err(Error::NotApplicable {
            what: format!("choosing {count} poses"),
            why: lacks.join("; "),
            hint: "ask for fewer poses, more candidates (--generate), or smaller changes (--change-deg)"
                .into(),
        }),
    }
}

/// The candidates as measurements, and what is known before, both in the units of the criterion.
fn scaled(
    all: &Planned,
    free: &[Parameter],
    known: &[f64],
    wanted: &Wanted,
    noise: f64,
) -> (Measurements, DMatrix<f64>) {
    if !wanted.criterion.is_index() {
        return in_noise(all, known, 1.0, noise);
    }
    // millimetres per millimetre, milliradian and µrad/(N·m)
    let units: Vec<f64> = free.iter().map(|&parameter| Planned::unit(parameter)).collect();
    let (measurements, _) = in_noise(all, &units, crate::units::MM, crate::units::MM);
    let measurements = match seen(&measurements) {
        Some(basis) => measurements.in_basis(&basis),
        None => measurements,
    };
    let norms = measurements.column_norms();
    let faint = norms.iter().map(|norm| FAINT * norm * norm);
    let before = DMatrix::from_diagonal(&nalgebra::DVector::from_iterator(norms.len(), faint));
    (measurements, before)
}

/// Rows divided by the noise, columns in units of what is known before (`of_place`, m, of a place
/// that nobody knows), which is then the identity.
fn in_noise(all: &Planned, known: &[f64], of_place: f64, noise: f64) -> (Measurements, DMatrix<f64>) {
    let rows = all.rows();
    let columns = rows.first().map_or(0, |block| block.ncols());
    let mut measurements = Measurements::new(columns);
    let factors: Vec<f64> = (0..columns).map(|k| noise / known.get(k).copied().unwrap_or(of_place)).collect();
    for (block, row) in rows.iter().zip(&all.recording().rows) {
        measurements.push(row.group, block);
    }
    measurements.scale(&factors);
    (measurements, DMatrix::identity(columns, columns))
}

fn in_order(poses: Vec<(usize, Vec<f64>)>, places: usize) -> Vec<(usize, Vec<f64>)> {
    let mut of_place: Vec<Vec<Vec<f64>>> = vec![Vec::new(); places];
    for (place, q) in poses {
        of_place[place].push(q);
    }
    let sorted = of_place.into_iter().enumerate().flat_map(|(place, mut own)| {
        order::sort(&mut own);
        own.into_iter().map(move |q| (place, q))
    });
    sorted.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study(campaign: &Campaign, count: usize, criterion: PoseCriterion) -> PoseStudy<'_> {
        let budget = Budget::of(campaign, Some(17.6e-6), Some(30e-6), 0.0).unwrap();
        let wanted = Wanted {
            count,
            criterion,
            source: Source::Generated(300),
            limits: PoseLimits::default(),
            mode: None,
            at: Where::Validation,
            seed: 1,
        };
        PoseStudy::new(campaign, wanted, budget, &|_| {}).unwrap()
    }

    /// Of few clamps, too, where some combinations of the parameters are seen by no pose.
    #[test]
    fn the_value_is_the_index_of_the_poses_and_nothing_else() {
        for clamps in [5, 2, 1] {
            let mut campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref()).unwrap();
            campaign.clamps.truncate(clamps);
            campaign.measurements.rows.clear();
            for criterion in [PoseCriterion::O1, PoseCriterion::O4] {
                let study = study(&campaign, 40, criterion);
                let sigma = singular_values(&study);
                let n = sigma.len() - study.unseen_combinations;
                let (kept, left_out) = sigma.split_at(n);
                assert!(left_out.iter().all(|s| *s < 1e-5 * sigma[0]), "{clamps}: {sigma:?}");
                let expected = match criterion {
                    PoseCriterion::O1 => {
                        (kept.iter().map(|s| s.ln()).sum::<f64>() / n as f64).exp() / 40f64.sqrt()
                    }
                    _ => kept[n - 1].powi(2) / kept[0],
                };
                assert!(
                    (study.value / expected - 1.0).abs() < 1e-2,
                    "{clamps} {criterion:?}: {} {expected} {sigma:?}",
                    study.value
                );
                assert!(study.worth.is_some_and(|worth| worth >= 1.0), "{:?}", study.worth);
            }
        }
    }

    fn singular_values(study: &PoseStudy) -> Vec<f64> {
        let campaign = study.campaign;
        let mode = default_mode(campaign);
        let compensation = Compensation::new(campaign, mode).unwrap();
        let free = free_parameters(campaign, &study.setup, &compensation);
        let planned =
            Planned::new(study.setup.clone(), &free, &compensation, &study.places, false, &study.chosen);
        let rows = planned.rows();
        let j = DMatrix::from_fn(3 * rows.len(), free.len(), |i, k| {
            rows[i / 3][(i % 3, k)] * Planned::unit(free[k]) / crate::units::MM
        });
        crate::linalg::thin_svd(&j).unwrap().singular_values.iter().copied().collect()
    }
}
