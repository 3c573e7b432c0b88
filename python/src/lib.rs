//! The native part of the `spandrel` Python package: the in-process vehicle, batched environments and the scorer. All
//! calls that block or compute release the GIL.

mod assessment;
mod batch;
mod commands;
mod environment;
mod errors;
mod flight;
mod hover;
mod inspect;
mod job;
mod links;
mod state;

use pyo3::prelude::*;

/// Native module of the `spandrel` package.
#[pymodule]
fn _spandrel(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    errors::register(module)?;
    module.add_class::<flight::Flight>()?;
    module.add_class::<state::State>()?;
    module.add_class::<batch::Batch>()?;
    module.add_function(wrap_pyfunction!(assessment::assess, module)?)?;
    module.add_function(wrap_pyfunction!(job::scenarios, module)?)?;
    module.add_function(wrap_pyfunction!(job::vehicles, module)?)
}
