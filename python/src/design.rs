//! What is asked about rods, poses and loads that do not exist yet.

use pyo3::prelude::*;
use rodcal::answer;
use rodcal::design::{
    Budget, PoseCriterion, PoseLimits, PoseStep, Search, Source, TableHeight, Wanted, Where,
};
use rodcal::diagnosis::rig::planned::Bench;
use rodcal::units::{DEG, MM, UM};

use crate::answer::Answer;
use crate::arguments::{choice, finite, positive, within};
use crate::calibration::mode_named;
use crate::errors::{IntoPython, wrong};
use crate::inputs::{Campaign, Rod};
use crate::parts::take_in;
use crate::space::Design;
use crate::work::{Progress, run};

#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn design_rod(
    py: Python<'_>,
    design: Design,
    base: Option<&Bound<'_, Rod>>,
    samples: Option<u64>,
    refine: Option<usize>,
    refine_goal: Option<String>,
    seed: u64,
    campaign: Option<&Bound<'_, Campaign>>,
    count: Option<usize>,
    parts: Option<&Bound<'_, PyAny>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let space = design.space(py)?;
    let count = count.map(|count| within(py, "count", count, 1, 20_000)).transpose()?;
    let asked = answer::DesignRod::default()
        .with_base(base.map(|rod| rod.get().rod.clone()))
        .with_refined(
            refine.map(|number| within(py, "refine", number, 1, u32::MAX as usize)).transpose()?,
            refine_goal,
        )
        .for_campaign(campaign.map(|campaign| (&campaign.get().campaign, count)))
        .with_seed(seed);
    let searched = asked.searched(&space, samples).or_raise(py)?;
    let mut search = Search::new(&space, searched).or_raise(py)?;
    if let Some(parts) = parts {
        take_in(py, &mut search, searched, &space, parts)?;
    }
    let counted = Progress::of(search.count());
    run(py, progress, counted, |progress| {
        while !search.is_done() {
            search.go_on(&|more| progress.more(more))?;
        }
        let found = search.found()?;
        answer::design_rod(space.clone(), found, &asked)
    })
    .map(Answer)
}

/// What a forecast assumes: noise, repeatability and instrument in µm, and where.
#[derive(FromPyObject)]
pub struct Expected {
    #[pyo3(item)]
    noise_um: Option<f64>,
    #[pyo3(item)]
    repeatability_um: Option<f64>,
    #[pyo3(item)]
    instrument_um: f64,
    #[pyo3(item)]
    at: Option<(String, String)>,
    #[pyo3(item)]
    volume_mm: Option<[f64; 6]>,
}

impl Expected {
    fn place(&self, py: Python<'_>) -> PyResult<Where> {
        match (&self.at, self.volume_mm) {
            (Some(_), Some(_)) => {
                let expected = "poses or a volume";
                Err(wrong(py, "at", "given beside volume_mm".into(), expected.into()))
            }
            (Some((name, text)), None) => Ok(Where::File(name.clone(), text.clone())),
            (None, Some([x0, x1, y0, y1, z0, z1])) => {
                let is_box = [x0, x1, y0, y1, z0, z1].iter().all(|x| x.is_finite());
                if !(is_box && x0 < x1 && y0 < y1 && z0 < z1) {
                    let expected = "(x0, x1, y0, y1, z0, z1) in mm, each first one below its second";
                    let found = format!("{:?}", self.volume_mm.unwrap_or_default());
                    return Err(wrong(py, "volume_mm", found, expected.into()));
                }
                Ok(Where::Volume([x0, y0, z0].map(|x| x * MM), [x1, y1, z1].map(|x| x * MM)))
            }
            (None, None) => Ok(Where::Validation),
        }
    }

    fn check(&self, py: Python<'_>) -> PyResult<()> {
        self.noise_um.map(|noise| positive(py, "noise_um", noise)).transpose()?;
        let repeatability = self.repeatability_um.unwrap_or_default();
        within(py, "repeatability_um", repeatability, 0.0, 1e6)?;
        within(py, "instrument_um", self.instrument_um, 0.0, 1e6).map(drop)
    }

    fn budget(&self, campaign: &rodcal::calibration::Campaign) -> rodcal::Result<Budget> {
        let metres = |um: f64| um * UM;
        let [noise, repeatability] = [self.noise_um, self.repeatability_um].map(|um| um.map(metres));
        Budget::of(campaign, noise, repeatability, metres(self.instrument_um))
    }
}

/// What poses have to keep: the angles in degrees, the clearance in mm; the table's height in mm,
/// "none", or nothing for the lowest that is known.
#[derive(FromPyObject)]
pub struct Limits {
    #[pyo3(item)]
    cone_deg: f64,
    #[pyo3(item)]
    clear_mm: f64,
    #[pyo3(item)]
    change_deg: f64,
    #[pyo3(item)]
    table_mm: Option<f64>,
    #[pyo3(item)]
    has_table: bool,
}

impl Limits {
    fn limits(&self, py: Python<'_>) -> PyResult<PoseLimits> {
        let table = match (self.has_table, self.table_mm) {
            (false, _) => TableHeight::Nowhere,
            (true, None) => TableHeight::Lowest,
            (true, Some(height)) => TableHeight::At(finite(py, "table_mm", height)? * MM),
        };
        Ok(PoseLimits::default()
            .with_cone(within(py, "cone_deg", self.cone_deg, 0.0, 180.0)? * DEG)
            .with_clearance(within(py, "clear_mm", self.clear_mm, 0.0, 1e6)? * MM)
            .with_change(within(py, "change_deg", self.change_deg, 0.0, 180.0)? * DEG)
            .with_table(table))
    }
}

#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn design_poses(
    py: Python<'_>,
    campaign: &Bound<'_, Campaign>,
    count: usize,
    criterion: &str,
    candidates: Option<(String, String)>,
    generate: usize,
    limits: Limits,
    mode: Option<&str>,
    expected: Expected,
    seed: u64,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    let criteria = [
        ("o1", PoseCriterion::O1),
        ("o4", PoseCriterion::O4),
        ("d", PoseCriterion::D),
        ("a", PoseCriterion::A),
        ("forecast", PoseCriterion::Forecast),
    ];
    expected.check(py)?;
    let count = within(py, "count", count, 1, 20_000)?;
    let criterion = choice(py, "criterion", criterion, &criteria)?;
    let source = match candidates {
        Some((name, text)) => Source::File(name, text),
        None => Source::Generated(within(py, "generate", generate, 1, 200_000)?),
    };
    let wanted = Wanted::new(count, criterion, source)
        .with_limits(limits.limits(py)?)
        .with_mode(mode_named(py, mode)?)
        .used_at(expected.place(py)?)
        .with_seed(seed);
    let campaign = &campaign.get().campaign;
    run(py, progress, Progress::default(), |progress| {
        let tell = |_: PoseStep| progress.more(1);
        answer::design_poses(campaign, wanted, expected.budget(campaign)?, &tell)
    })
    .map(Answer)
}

#[pyfunction]
pub fn forecast(
    py: Python<'_>,
    campaign: &Bound<'_, Campaign>,
    rods: Vec<Bound<'_, Rod>>,
    count: Option<usize>,
    expected: Expected,
    seed: u64,
    progress: Option<Py<PyAny>>,
) -> PyResult<Answer> {
    expected.check(py)?;
    let at = expected.place(py)?;
    let count = count.map(|count| within(py, "count", count, 1, 20_000)).transpose()?;
    let rods: Vec<rodcal::rod::Rod> = rods.iter().map(|rod| rod.get().rod.clone()).collect();
    let campaign = &campaign.get().campaign;
    run(py, progress, Progress::of_jobs(), |_| {
        let budget = expected.budget(campaign)?.with_seed(seed);
        answer::forecast(campaign, &rods, budget, &at, count)
    })
    .map(Answer)
}

#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn design_rig(
    py: Python<'_>,
    rod: &Bound<'_, Rod>,
    between: Vec<String>,
    r_rod_width_percent: Option<f64>,
    odds: f64,
    max_load_n: f64,
    noise_um: f64,
    at_tip: bool,
) -> PyResult<Answer> {
    let width = r_rod_width_percent.map(|percent| positive(py, "r_rod_width_percent", percent));
    let width = width.transpose()?.map(|percent| percent / 100.0);
    if width.is_some() != between.is_empty() {
        let expected = "effects to be distinguished, or r_rod_width_percent";
        return Err(wrong(py, "between", format!("{between:?}"), expected.into()));
    }
    if !(odds.is_finite() && odds > 1.0) {
        return Err(wrong(py, "odds", odds.to_string(), "odds > 1, such as 20".into()));
    }
    let bench = Bench {
        largest_load: positive(py, "max_load_n", max_load_n)?,
        noise: positive(py, "noise_um", noise_um)? * UM,
        is_at_tip: at_tip,
    };
    let rod = &rod.get().rod;
    run(py, None, Progress::default(), |_| answer::design_rig(rod, &between, width, odds, &bench)).map(Answer)
}
