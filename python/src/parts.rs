//! Parts of what takes long, which other machines look at, and what the whole is made of again
//! (`rodcal/distributed.py`). A part gives the same wherever it is done.

use pyo3::prelude::*;
use rodcal::answer::DesignRod;
use rodcal::calibration::{self, Compensation, Draws, Options, default_mode, folds_of, predict_held_out};
use rodcal::design::{DesignSpace, PART, Search, Searched};

use crate::arguments::within;
use crate::calibration::{compared, mode_named, robust_named};
use crate::errors::{IntoPython, wrong};
use crate::inputs::Campaign;
use crate::space::Design;
use crate::work::{Progress, run};

/// Which rods a search looks at.
fn searched(py: Python<'_>, space: &DesignSpace, samples: Option<u64>, seed: u64) -> PyResult<Searched> {
    DesignRod::default().with_seed(seed).searched(space, samples).or_raise(py)
}

/// What other machines need of a design: its text and that of its catalogue; how many rods a search
/// of it looks at, and of how many a part has a multiple.
#[pyfunction]
pub fn design_parts(
    py: Python<'_>,
    design: Design,
    samples: Option<u64>,
    seed: u64,
) -> PyResult<(String, Option<String>, u64, u64)> {
    let (space, text, tubes) = design.read(py)?;
    let searched = searched(py, &space, samples, seed)?;
    let count = Search::new(&space, searched).or_raise(py)?.count();
    Ok((text, tubes, count, PART))
}

/// The rods from `first` to below `last`, as the text of a search that is done.
#[pyfunction]
pub fn design_part(
    py: Python<'_>,
    design: Design,
    samples: Option<u64>,
    seed: u64,
    first: u64,
    last: u64,
) -> PyResult<String> {
    let space = design.space(py)?;
    let searched = searched(py, &space, samples, seed)?;
    run(py, None, Progress::default(), |_| {
        let mut search = Search::part(&space, searched, first..last)?;
        while !search.is_done() {
            search.go_on(&|_| {})?;
        }
        Ok(search.to_text())
    })
}

/// Takes in the parts of a search: `parts` gives first, last and text of each, in order.
pub fn take_in<'s>(
    py: Python<'_>,
    search: &mut Search<'s>,
    searched: Searched,
    space: &'s DesignSpace,
    parts: &Bound<'_, PyAny>,
) -> PyResult<()> {
    for part in parts.try_iter()? {
        let (first, last, text): (u64, u64, String) = part?.extract()?;
        let merged = py.detach(|| {
            let part = Search::part_from_text(space, searched, first..last, "<part>", &text)?;
            search.take_in(part)
        });
        merged.or_raise(py)?;
    }
    match search.is_done() {
        true => Ok(()),
        false => {
            let found = format!("of {} rods", search.done());
            Err(wrong(py, "parts", found, format!("of all {}", search.count())))
        }
    }
}

/// Mean error of every mode in the draws from `first` to below `last`, m; nothing of a draw in
/// which a fit fails.
#[pyfunction]
pub fn compare_part(
    py: Python<'_>,
    campaign: &Bound<'_, Campaign>,
    robust: &str,
    draws: usize,
    seed: u64,
    first: usize,
    last: usize,
) -> PyResult<Vec<Option<Vec<f64>>>> {
    let campaign = &campaign.get().campaign;
    let options = compared(py, robust, draws, seed)?;
    let last = within(py, "last", last, first, draws)?;
    run(py, None, Progress::default(), |_| Ok(Draws::new(campaign, &options)?.means(first..last, &|_| {})))
}

/// How many folds a cross-validation has where so many are asked for.
#[pyfunction]
pub fn folds(py: Python<'_>, campaign: &Bound<'_, Campaign>, folds: usize) -> PyResult<usize> {
    let folds = within(py, "folds", folds, 2, 1000)?;
    let fold = folds_of(&campaign.get().campaign, folds).or_raise(py)?;
    Ok(fold.iter().max().map_or(0, |last| last + 1))
}

/// Row and deviation in m of every pose of the folds from `first` to below `last`, each from a
/// calibration without its fold.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn calibrate_part(
    py: Python<'_>,
    campaign: &Bound<'_, Campaign>,
    mode: Option<&str>,
    robust: &str,
    prune: bool,
    folds: usize,
    first: usize,
    last: usize,
) -> PyResult<Vec<(usize, [f64; 3])>> {
    let campaign = &campaign.get().campaign;
    let mode = mode_named(py, mode)?.unwrap_or_else(|| default_mode(campaign));
    let options = Options::default().with_robust(robust_named(py, robust)?).with_pruning(prune);
    let predicted = run(py, None, Progress::default(), |_| {
        let calibrated = calibration::calibrate(campaign, mode, &options)?;
        let compensation = Compensation::new(campaign, mode)?;
        predict_held_out(campaign, &calibrated, &compensation, folds, first..last, &options)
    })?;
    Ok(predicted.into_iter().map(|(row, deviation)| (row, deviation.into())).collect())
}
