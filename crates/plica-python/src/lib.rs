//! The native part of the Python module `plica`: cases, studies, runs and states as plain data.
//!
//! The classes and messages that users see are in the Python files beside it. This module takes and returns texts, numbers
//! and arrays of bytes, and never prints.

mod case;
mod mode;
mod monitor;
mod run;
mod stability;
mod state;
mod study;

use plica::measure::Shape;
use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("STARTER", plica::case::STARTER)?;
    let shapes = Shape::ALL.map(|shape| shape.to_string());
    module.add("SHAPES", shapes.to_vec())?;
    module.add_function(wrap_pyfunction!(case::problems, module)?)?;
    module.add_function(wrap_pyfunction!(case::edited, module)?)?;
    module.add_function(wrap_pyfunction!(case::about, module)?)?;
    module.add_function(wrap_pyfunction!(case::schema, module)?)?;
    module.add_function(wrap_pyfunction!(run::run, module)?)?;
    module.add_function(wrap_pyfunction!(stability::stability, module)?)?;
    module.add_class::<mode::Mode>()?;
    module.add_class::<run::Run>()?;
    module.add_class::<state::State>()?;
    module.add_class::<study::Study>()?;
    Ok(())
}
