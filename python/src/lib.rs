//! The part of the Python package `rodcal` that is written in Rust: `rodcal._rodcal`.
//!
//! It holds inputs and answers of the library and turns them into Python's objects; names, units,
//! defaults and documentation stand in the package's Python files. Everything that takes time runs
//! without Python's lock, and Ctrl-C stops it (`work.rs`).

mod answer;
mod arguments;
mod calibration;
mod design;
mod errors;
mod inputs;
mod parts;
mod rods;
mod space;
mod work;

use pyo3::prelude::*;

/// What the package's Python files import.
#[pymodule]
fn _rodcal(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<answer::Answer>()?;
    module.add_class::<calibration::Predicted>()?;
    module.add_class::<inputs::Rod>()?;
    module.add_class::<inputs::Readings>()?;
    module.add_class::<inputs::Robot>()?;
    module.add_class::<inputs::Campaign>()?;
    module.add_function(wrap_pyfunction!(errors::visible, module)?)?;
    module.add_function(wrap_pyfunction!(inputs::read_text, module)?)?;
    module.add_function(wrap_pyfunction!(rods::compliance, module)?)?;
    module.add_function(wrap_pyfunction!(rods::rig_fit, module)?)?;
    module.add_function(wrap_pyfunction!(rods::diagnose_rig, module)?)?;
    module.add_function(wrap_pyfunction!(calibration::calibrate, module)?)?;
    module.add_function(wrap_pyfunction!(calibration::compare, module)?)?;
    module.add_function(wrap_pyfunction!(calibration::diagnose_calibration, module)?)?;
    module.add_function(wrap_pyfunction!(calibration::predict, module)?)?;
    module.add_function(wrap_pyfunction!(calibration::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(design::design_rod, module)?)?;
    module.add_function(wrap_pyfunction!(design::design_poses, module)?)?;
    module.add_function(wrap_pyfunction!(design::design_rig, module)?)?;
    module.add_function(wrap_pyfunction!(design::forecast, module)?)?;
    module.add_function(wrap_pyfunction!(parts::design_parts, module)?)?;
    module.add_function(wrap_pyfunction!(parts::design_part, module)?)?;
    module.add_function(wrap_pyfunction!(parts::compare_part, module)?)?;
    module.add_function(wrap_pyfunction!(parts::folds, module)?)?;
    module.add_function(wrap_pyfunction!(parts::calibrate_part, module)?)?;
    Ok(())
}
